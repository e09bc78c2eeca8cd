//! Dry friction of bones on colliders.
//!
//! A bone that touches a body may slip in two directions: across itself, and along the surface
//! towards or away from its joint. The second rate is that of the turn that would lift the bone, so
//! the contact itself rules it. Friction acts on the first one, by at most the coefficient times
//! what the contact has changed along the normal, as it does on both rates together (Coulomb): on a
//! surface that moves along the bone, little is left across.
//!
//! Velocities alone are not enough. In each tick a bone would slip by the way of its acceleration
//! and be stopped again: at 240 ticks a second it would creep down a slope by a centimetre in a
//! second. The way in the tick is therefore taken back by the same rule, where the depth that the
//! bone has left takes the place of the velocity. Both together are exact for constant forces.

use super::gap::{Nearest, gap_of};
use super::{Body, Collider, Limit, Pose, TOUCH, Vector, cross, dot, length, plus};
use pendulum_core::attitude::Attitude;
use pendulum_core::scalar::Real;

impl Nearest {
    /// Returns the turn, as a rotation vector, that takes away a slip across the bone as far as
    /// friction can: by `coefficient` times the push, which changes the slip along the normal by
    /// `change`.
    pub(super) fn grip(&self, slip: Vector, coefficient: f64, change: f64) -> Vector {
        let across = self.lever.map(|part| part / self.square.sqrt());
        let [off, other] = [across, cross(self.normal, across)].map(|axis| dot(slip, axis));
        let whole = (off * off + other * other).sqrt();
        let reach = dot(self.arm, self.arm);
        if !(0.0 < change && 0.0 < whole) {
            return [0.0; 3];
        }
        // A push along the normal turns the bone with the square of its lever, one across it with
        // that of the arm.
        let most = coefficient * change * reach / self.square * (off.abs() / whole);
        let by = Real::min(off.abs(), most) * if off < 0.0 { 1.0 } else { -1.0 };
        cross(self.arm, across).map(|part| by / reach * part)
    }
}

impl Pose {
    /// Turns the bone back by what it has slipped on bodies in the tick, in which it has turned
    /// from `was` to `entered` and then out of them. `starts` are the frame of the bone and the
    /// bodies at the beginning.
    pub(super) fn rub(
        &mut self,
        limit: &Limit,
        [was, entered]: [Attitude; 2],
        parents: [&Body; 2],
        bodies: &[Option<Body>],
        mut start: impl FnMut(&Collider) -> Option<Body>,
    ) {
        for (collider, body) in limit.colliders.iter().zip(bodies) {
            let (Some(body), Some(before)) = (body, start(collider)) else { continue };
            let shape = &collider.shape;
            let near = gap_of(shape, body, parents[1].place, self.bone(), limit.radius);
            if TOUCH < near.gap || near.square <= 1e-12 * self.length * self.length {
                continue;
            }
            let arm = |turn: Attitude| turn * [0.0, length(near.arm), 0.0];
            let depth = dot(near.normal, plus(near.arm, -1.0, arm(entered)));
            // Where the point of the body that is at the point of the bone now was.
            let now = plus(plus(parents[1].place, 1.0, near.arm), -1.0, body.place);
            let there = before.point(body.turn.inverse() * now);
            let here = plus(parents[0].place, 1.0, arm(was));
            self.turn_by(near.grip(plus(there, -1.0, here), limit.friction, depth));
        }
    }
}
