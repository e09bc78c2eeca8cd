//! Bounds of bones: cones, hinges and twists relative to the frame.

use super::{Body, Pose, TOUCH, Vector, cross, dot, length, plus};
use crate::error::SceneError;
use core::f64::consts::{PI, TAU};
use pendulum_core::attitude::Attitude;
use pendulum_core::scalar::Real;

/// A bound of the turn of a bone relative to its frame, the attitude of rest. Angles are in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Bound {
    /// The largest angle between the bone and its direction at rest, up to π.
    Cone(f64),
    /// The largest angle of the twist about the bone itself, up to π: of what remains of the turn
    /// after the shortest turn between the directions.
    Twist(f64),
    /// The bone turns only about an axis of its frame, between two angles.
    Hinge {
        /// The axis, of any length.
        axis: [f64; 3],
        /// The least angle, from −π on.
        from: f64,
        /// The greatest angle, up to π.
        to: f64,
    },
}

impl Bound {
    /// Returns an error if the bound is none.
    pub(crate) fn check(self) -> Result<(), SceneError> {
        let angle = |value: f64, least: f64| {
            let required =
                if least == 0.0 { "between 0 and π" } else { "between −π and π, in order" };
            let fits = (least..=PI).contains(&value);
            fits.then_some(()).ok_or(SceneError::Setting { name: "angle", value, required })
        };
        match self {
            Self::Cone(most) | Self::Twist(most) => angle(most, 0.0),
            Self::Hinge { axis, from, to } => {
                let value = length(axis);
                if !(0.0 < value && value < f64::INFINITY) {
                    let required = "positive and finite";
                    return Err(SceneError::Setting { name: "axis", value, required });
                }
                angle(from, -PI)?;
                angle(to, from)
            }
        }
    }
}

/// Returns the angle of the part about an axis of the turn from a frame to a bone, from −π to π.
fn angle_about(axis: Vector, turn: Attitude, frame: Attitude) -> f64 {
    let [w, vector @ ..] = (frame.inverse() * turn).to_quaternion();
    let sine = dot(axis, vector);
    // Both signs are the same turn.
    2.0 * if w < 0.0 { Real::atan2(-sine, -w) } else { Real::atan2(sine, w) }
}

impl Pose {
    /// Returns how far the bone is within a cone or a twist, and the gradient: its product with the
    /// angular velocity relative to the frame is the rate of the distance.
    fn within(&self, parent: &Body, bound: Bound) -> Option<(f64, Vector)> {
        let [direction, middle] = [self.turn, parent.turn].map(|turn| turn * [0.0, 1.0, 0.0]);
        match bound {
            Bound::Cone(most) => {
                let axis = cross(direction, middle);
                let sine = length(axis);
                let angle = Real::atan2(sine, dot(direction, middle));
                let any = self.turn * [1.0, 0.0, 0.0];
                let axis = if 0.0 < sine { axis.map(|part| part / sine) } else { any };
                Some((most - angle, axis))
            }
            Bound::Twist(most) => {
                let twist = angle_about([0.0, 1.0, 0.0], self.turn, parent.turn);
                // The twist turns about the direction between both, and all the faster the more the
                // bone is bent; bent by half a turn, it has none.
                let sum = plus(direction, 1.0, middle);
                let share = 1.0 + dot(direction, middle);
                let sign = if twist < 0.0 { 1.0 } else { -1.0 };
                (1e-6 < share).then(|| (most - twist.abs(), sum.map(|part| sign * part / share)))
            }
            Bound::Hinge { .. } => None,
        }
    }

    /// Turns the bone by a share of the way into a bound, and returns `true` if it was beyond it.
    pub(super) fn bind(&mut self, parent: &Body, bound: Bound, share: f64) -> bool {
        if let Bound::Hinge { axis, from, to } = bound {
            let axis = axis.map(|part| part / length(axis));
            let angle = angle_about(axis, self.turn, parent.turn);
            // The nearer of both ends, around the circle.
            let apart = |end: f64| Real::min((angle - end).abs(), TAU - (angle - end).abs());
            let ends = if apart(from) < apart(to) { from } else { to };
            let angle = if (from..=to).contains(&angle) { angle } else { ends };
            let bound = parent.turn * Attitude::from_axis_angle(axis, angle);
            let back = bound * self.turn.inverse();
            let left = TOUCH < back.to_axis_angle().1;
            if left {
                let part = || back.to_rotation_vector().map(|part| share * part);
                if share == 1.0 { self.turn = bound } else { self.turn_by(part()) }
            }
            return left;
        }
        let Some((gap, gradient)) = self.within(parent, bound) else { return false };
        if gap < 0.0 {
            let square = dot(gradient, gradient);
            self.turn_by(gradient.map(|part| share * (0.5 * TOUCH - gap) / square * part));
        }
        gap < 0.0
    }

    /// Takes away the velocity with which the bone would leave a bound, and returns `true` if it
    /// touches it.
    pub(super) fn stay(&mut self, parent: &Body, bound: Bound) -> bool {
        let rates = plus(self.spin, -1.0, parent.spin);
        if let Bound::Hinge { axis, from, to } = bound {
            let axis = axis.map(|part| part / length(axis));
            let angle = angle_about(axis, self.turn, parent.turn);
            let axis = parent.turn * axis;
            let rate = dot(axis, rates);
            let below = rate < 0.0 && angle <= from + TOUCH;
            let out = below || (0.0 < rate && to - TOUCH <= angle);
            self.spin = plus(parent.spin, if out { 0.0 } else { rate }, axis);
            return true;
        }
        let Some((gap, gradient)) = self.within(parent, bound) else { return false };
        let rate = dot(gradient, rates);
        if gap <= TOUCH && rate < 0.0 {
            self.spin = plus(self.spin, -rate / dot(gradient, gradient), gradient);
        }
        gap <= TOUCH
    }
}
