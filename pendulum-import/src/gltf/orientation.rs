//! The rotation in a node: of its channels, or of its matrix.

use super::node::{Local, Pose};
use super::track::{Track, Turn};
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Curve, Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;

/// The greatest cosine between columns of a matrix without shear. Matrices are products in single
/// precision, whose errors are a hundredth of it.
const SKEW: f64 = 1e-4;

/// Returns the rotations of nodes, from the first to the last that turns a vector of the node.
/// `chain` is the node, followed by its parents outwards.
///
/// The linear part of a node in the world is R S of each parent and of the node itself, in this
/// order. Lengths of scales do not turn. A matrix of signs is a half turn about a coordinate axis,
/// or the identity, times its determinant, which commutes with everything. What remains of a
/// mirrored node is −Q, and the rotation that has its second and third column is −Q diag(−1, 1, 1),
/// where −diag(−1, 1, 1) is the half turn about x.
///
/// Also returns which one is that of the node itself. The error is the place in the chain and the
/// reason.
pub(super) fn turns(chain: Vec<Local>) -> Result<(Vec<Turn>, usize), (usize, &'static str)> {
    let mut turns = Vec::new();
    let mut own = 0;
    let mut mirrored = false;
    for (link, local) in chain.into_iter().enumerate() {
        let fail = |what| (link, what);
        let (rotation, negative) = match local {
            Local::Parts(parts) => (parts.rotation, signs(&parts.scale).map_err(fail)?),
            Local::Matrix(rows) => {
                let (_, rotation, scale) = parts(&rows).map_err(fail)?;
                (Turn::Still(rotation), scale.map(|size| size < 0.0))
            }
        };
        let odd = negative.iter().filter(|&&negative| negative).count() % 2 == 1;
        mirrored ^= odd;
        // Of the signs times their determinant, the only positive one is the axis.
        let axis = negative.map(|negative| negative == odd);
        if axis != [true; 3] {
            turns.push(half_turn(axis));
        }
        if link == 0 {
            own = turns.len();
        }
        turns.push(rotation);
    }
    if mirrored {
        turns.insert(0, half_turn([true, false, false]));
        own += 1;
    }
    Ok((turns, own))
}

/// Returns the half turn about the only coordinate axis that is `true`.
fn half_turn(axis: [bool; 3]) -> Turn {
    let [x, y, z] = axis.map(|axis| f64::from(u8::from(axis)));
    Turn::Still([x, y, z, 0.0])
}

/// Returns the parts of a matrix; of a mirrored one, the scale of x is negative.
pub(super) fn parts(rows: &[[f64; 4]; 3]) -> Result<Pose, &'static str> {
    let column = |at: usize| rows.map(|row| row[at]);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let columns = [column(0), column(1), column(2)];
    let mut scale = columns.map(|column| Real::sqrt(dot(column, column)));
    if scale.iter().any(|&size| size < f64::MIN_POSITIVE || size == f64::INFINITY) {
        return Err("its matrix has a column of length zero");
    }
    let [x, y, z] = [0, 1, 2].map(|at| columns[at].map(|part| part / scale[at]));
    if [dot(x, y), dot(y, z), dot(z, x)].iter().any(|cosine| SKEW < cosine.abs()) {
        return Err("its matrix has shear");
    }
    let x = if dot(cross(x, y), z) < 0.0 {
        scale[0] = -scale[0];
        x.map(|part| -part)
    } else {
        x
    };
    let across = cross(x, y);
    let length = Real::sqrt(dot(across, across));
    let z = across.map(|part| part / length);
    let rotation = Attitude::from_matrix([x, cross(z, x), z].into());
    let [w, x, y, z] = rotation.map_err(|_| "its matrix is no rotation")?.to_quaternion();
    Ok((column(3), [x, y, z, w], scale))
}

/// Returns the axes along which a scale is negative.
fn signs(scale: &Track) -> Result<[bool; 3], &'static str> {
    let ranges = match scale {
        Track::Still(value) => value.map(|size| [size, size]),
        Track::Keyed(curve) => [0, 1, 2].map(|axis| range(curve, axis)),
    };
    if ranges.iter().any(|&[low, high]| low < 0.0 && 0.0 < high) {
        return Err("its scale changes its sign, as no rotation does");
    }
    Ok(ranges.map(|[low, _]| low < 0.0))
}

/// Returns the least and the greatest value of a component.
fn range(curve: &Curve<3>, axis: usize) -> [f64; 2] {
    let at = |t: f64| -> Sample<f64, 3> {
        curve.sample(Time::new(t), Side::After, Derivatives::POSITION)
    };
    let ends = [f64::MIN, f64::MAX].map(|t| at(t).position[axis]);
    let inside = curve.pieces().flat_map(|(piece, h)| {
        let [a, b, c, d] = piece.map(|coefficient| coefficient[axis]);
        // The roots of the derivative, without cancellation; NaN if there are none.
        let sum = -(c + Real::sqrt(c * c - 3.0 * b * d).copysign(c));
        [0.0, h, sum / (3.0 * d), b / sum]
            .into_iter()
            .filter(move |&u| 0.0 <= u && u <= h)
            .map(move |u| a + u * (b + u * (c + u * d)))
    });
    ends.into_iter()
        .chain(inside)
        .fold(ends, |[low, high], value| [Real::min(low, value), Real::max(high, value)])
}
