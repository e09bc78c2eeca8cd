//! Bodies that move fast: looks at a bone within a tick.
//!
//! A body may pass a bone between two ticks, and the bone would be turned out on the wrong side, or
//! not at all. The tick is therefore divided until nothing can pass between two looks. Between two
//! of them, body and bone move relative to each other by no more than the way that is bounded by
//! what is seen at both: the difference of the places, and the speeds and accelerations there.
//!
//! - If the way is shorter than both gaps together, nothing is touched in between: the first part
//!   of it would have to use up the first gap, and the rest the second one. This is conservative
//!   advancement (Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996), from
//!   both ends.
//! - If it is at most half of the radii of body and bone together, what is touched is not passed:
//!   the line in the middle of the body is still on its side, and the bone is turned back to the
//!   side from which it came.
//!
//! Looks at every place of a fine grid would cost the same in every tick. Most ticks need only the
//! looks at their ends.

use super::gap::gap_of;
use super::{Body, Limit, Pose, ROUNDS, Shape, Vector, length, plus};
use pendulum_core::attitude::Attitude;
use pendulum_core::scalar::Real;

/// The greatest number of looks in a tick, and the shortest part of a tick between two of them. At
/// 24 ticks a second it is 0.3 µs, in which 1000 m/s is a third of a millimetre. What jumps within a
/// tick is not stopped by any number of looks.
const LOOKS: usize = 1 << 12;
const SHORTEST: f64 = 1.0 / 131_072.0;

/// The way in metres that is short for any body.
const SHORT: f64 = 1e-5;

/// The frame of a bone and the bodies that it does not enter, at a time within a tick.
#[derive(Debug, Default)]
pub(super) struct Look {
    pub(super) parent: Body,
    /// `None` for a body whose frame has been removed.
    pub(super) bodies: Vec<Option<Body>>,
}

/// Returns the distance of the farthest point of the middle of a shape from its frame, and the
/// radius; `None` for what has an inside of any depth.
pub(super) fn thin(shape: &Shape) -> Option<(f64, f64)> {
    match shape {
        Shape::Ball { center, radius } => Some((length(*center), *radius)),
        Shape::Capsule { ends, radius } => {
            Some((Real::max(length(ends[0]), length(ends[1])), *radius))
        }
        Shape::Half { .. } | Shape::Inside { .. } => None,
    }
}

/// Returns a bound of the way of a point of a body that turns by `turn` in `h` seconds between two
/// looks, relative to the joint of a bone; the point is at most `reach` from the frame of the body.
fn way([from, to]: [&Body; 2], [joint, after]: [&Body; 2], h: f64, turn: f64, reach: f64) -> f64 {
    let apart = |a: Vector, b: Vector| length(plus(a, -1.0, b));
    let shift = apart(plus(to.place, -1.0, from.place), plus(after.place, -1.0, joint.place));
    let speed = Real::max(apart(from.velocity, joint.velocity), apart(to.velocity, after.velocity));
    let bend = Real::max(
        apart(from.acceleration, joint.acceleration),
        apart(to.acceleration, after.acceleration),
    );
    let spin = h * Real::max(length(from.spin), length(to.spin));
    Real::max(shift, h * (speed + 0.5 * h * bend)) + reach * Real::max(turn, spin)
}

/// Returns `true` if a body may pass a bone between two looks, in `h` seconds, in which the tip
/// moves by `turned` relative to the joint. `gap` is no more than the gap of a shape at a look.
pub(super) fn may_pass(
    limit: &Limit,
    looks: [&Look; 2],
    turned: f64,
    h: f64,
    gap: impl Fn(&Shape, &Body, usize) -> f64,
) -> bool {
    limit.colliders.iter().enumerate().any(|(index, collider)| {
        let Some((reach, size)) = thin(&collider.shape) else { return false };
        let [Some(from), Some(to)] = looks.map(|look| look.bodies[index].as_ref()) else {
            return false;
        };
        let turn = to.turn * from.turn.inverse();
        let joints = looks.map(|look| &look.parent);
        // The chord of the turn is shorter than its arc by at most π/2.
        let way = |turn: f64| way([from, to], joints, h, turn, reach) + 1.6 * turned;
        let short = Real::max(0.5 * (size + limit.radius), SHORT);
        // A turn is at most π times the sine of its half, which needs no arc tangent.
        let [_, sine @ ..] = turn.to_quaternion();
        if way(3.15 * length(sine)) <= short {
            return false;
        }
        let way = way(turn.to_axis_angle().1);
        let gap = |body, look| gap(&collider.shape, body, look);
        short < way && gap(from, 0) + gap(to, 1) <= way
    })
}

/// Returns `true` if a body may pass a bone between two looks, at which it has these directions.
pub(super) fn may_cross(limit: &Limit, looks: [&Look; 2], bones: [Vector; 2], h: f64) -> bool {
    let turned = length(plus(bones[1], -1.0, bones[0]));
    may_pass(limit, looks, turned, h, |shape, body, look| {
        gap_of(shape, body, looks[look].parent.place, bones[look], limit.radius).gap
    })
}

impl Pose {
    /// Moves the bone, which was at `from` at the beginning of the tick, out of the way of bodies
    /// that may pass it otherwise, and returns `true` if it has met one. Without bodies it would
    /// turn steadily to where it is. `look` looks at a part of the tick; the first look is that at
    /// its beginning.
    ///
    /// What meets the bone pushes it aside and gives it no velocity: a ball that leaves the bone
    /// behind within a tick would have turned it about its joint many times.
    pub(super) fn sweep(
        &mut self,
        limit: &Limit,
        from: Attitude,
        tick: f64,
        [here, there]: [&mut Look; 2],
        look: impl Fn(f64, &mut Look),
    ) -> bool {
        let turn = (self.turn * from.inverse()).to_rotation_vector();
        let mut pose = Self { turn: from, spin: self.spin, length: self.length };
        let (mut s, mut h, mut met) = (0.0, 0.5, false);
        let mut looks = LOOKS;
        loop {
            looks -= 1;
            let last = looks == 0;
            let next = if last || 1.0 <= s + h { 1.0 } else { s + h };
            let turned = Attitude::from_rotation_vector(turn.map(|part| (next - s) * part));
            let after = turned * pose.turn;
            look(next, there);
            let bones = [pose.bone(), after * [0.0, self.length, 0.0]];
            let part = next - s;
            if !last && SHORTEST < part && may_cross(limit, [here, there], bones, part * tick) {
                h = 0.5 * part;
                continue;
            }
            pose.turn = after;
            let (rounds, _) = pose.leave(limit, &there.parent, &there.bodies);
            met |= 0 < rounds;
            core::mem::swap(here, there);
            (s, h) = (next, 2.0 * part);
            // Without room for the bone, further looks are of no use.
            looks = if rounds < ROUNDS { looks } else { 1 };
            if s == 1.0 {
                break;
            }
        }
        if met {
            self.turn = pose.turn;
        }
        met
    }
}
