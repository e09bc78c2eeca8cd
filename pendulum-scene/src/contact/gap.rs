//! The distances of bones from the borders of shapes.

use super::{Body, Shape, Vector, cross, dot, length, plus};

/// The bone nearest to the border of what limits it.
pub(super) struct Nearest {
    /// The distance that is left; negative beyond the border.
    pub(super) gap: f64,
    /// The direction out of the collider, and the vector from the joint to the point of the bone.
    pub(super) normal: Vector,
    pub(super) arm: Vector,
    /// The axis about which a push along the normal turns the bone, and its square.
    pub(super) lever: Vector,
    pub(super) square: f64,
}

impl Nearest {
    fn new(gap: f64, normal: Vector, arm: Vector) -> Self {
        let lever = cross(arm, normal);
        Self { gap, normal, arm, lever, square: dot(lever, lever) }
    }
}

/// Returns the places, as fractions, at which two lines from `a` along `u` and from `b` along `w`
/// are nearest to each other.
fn nearest(a: Vector, u: Vector, b: Vector, w: Vector) -> [f64; 2] {
    let (from, uu, ww, uw) = (plus(a, -1.0, b), dot(u, u), dot(w, w), dot(u, w));
    let (fu, fw) = (dot(from, u), dot(from, w));
    let parallel = uu * ww - uw * uw;
    // Parallel lines are nearest everywhere: the middle is as good as any other place.
    let s = if 1e-12 * uu * ww < parallel { (uw * fw - ww * fu) / parallel } else { 0.5 };
    let s = s.clamp(0.0, 1.0);
    let t = if 0.0 < ww { ((fw + s * uw) / ww).clamp(0.0, 1.0) } else { 0.0 };
    // The first place for this second one, which may have been clamped.
    [((t * uw - fu) / uu).clamp(0.0, 1.0), t]
}

/// Returns the point of the line between two points that is nearest to `point`.
fn foot([a, b]: [Vector; 2], point: Vector) -> Vector {
    let (off, along) = (plus(point, -1.0, a), plus(b, -1.0, a));
    let square = dot(along, along);
    let t = if 0.0 < square { (dot(off, along) / square).clamp(0.0, 1.0) } else { 0.0 };
    plus(a, t, along)
}

/// Returns the distance of a point from the surface of a shape, negative where bones do not enter.
pub(super) fn room(shape: &Shape, body: &Body, x: Vector) -> f64 {
    let apart = |ends: [Vector; 2]| {
        let foot = foot(ends.map(|end| body.point(end)), x);
        length(plus(x, -1.0, foot))
    };
    match *shape {
        Shape::Ball { center, radius } => apart([center; 2]) - radius,
        Shape::Capsule { ends, radius } => apart(ends) - radius,
        Shape::Inside { ends, radius } => radius - apart(ends),
        Shape::Half { point, normal } => {
            dot(body.turn * normal, plus(x, -1.0, body.point(point))) / length(normal)
        }
    }
}

/// Returns where a bone from `x` to `x` + `bone` is nearest to the border of a shape, or to the
/// surface within it at the depth of the body.
pub(super) fn gap_of(shape: &Shape, body: &Body, x: Vector, bone: Vector, radius: f64) -> Nearest {
    let (ends, size, inside) = match *shape {
        Shape::Ball { center, radius } => ([center; 2], radius, false),
        Shape::Capsule { ends, radius } => (ends, radius, false),
        Shape::Inside { ends, radius } => (ends, radius, true),
        Shape::Half { point, normal } => {
            let normal = body.turn * normal.map(|part| part / length(normal));
            let off = plus(plus(x, 1.0, bone), -1.0, body.point(point));
            return Nearest::new(dot(normal, off) - radius + body.depth, normal, bone);
        }
    };
    let [a, b] = ends.map(|end| body.point(end));
    let along = plus(b, -1.0, a);
    let middle = |point: Vector| foot([a, b], point);
    // A joint inside is the concern of what moves it: then the tip counts, as for what is hollow.
    let (arm, on) = if inside || length(plus(x, -1.0, middle(x))) < size + radius {
        (bone, middle(plus(x, 1.0, bone)))
    } else {
        let [s, t] = nearest(x, bone, a, along);
        (bone.map(|part| s * part), plus(a, t, along))
    };
    let off = plus(plus(x, 1.0, arm), -1.0, on);
    let distance = length(off);
    // From the very middle, every way out is as good.
    let out = if 0.0 < distance { off.map(|part| part / distance) } else { [1.0, 0.0, 0.0] };
    let size = size + if inside { body.depth } else { -body.depth };
    if inside {
        return Nearest::new(size - radius - distance, out.map(|part| -part), arm);
    }
    Nearest::new(distance - size - radius, out, arm)
}
