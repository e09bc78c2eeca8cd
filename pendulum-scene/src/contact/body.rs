//! The bodies of frames at times, with their velocities, and what a center and the wind do.

use super::{Limit, Vector, cross, plus};
use crate::sampling::joint::Living;
use crate::sampling::world::World;
use pendulum_core::attitude::{Attitude, Rates};
use pendulum_core::scalar::Float;
use pendulum_core::time::Time;

/// A body at a time, with its velocities.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub(super) place: Vector,
    pub(super) turn: Attitude,
    pub(super) velocity: Vector,
    pub(super) acceleration: Vector,
    pub(super) spin: Vector,
    /// How deep a bone may be inside.
    pub(super) depth: f64,
}

impl Default for Body {
    fn default() -> Self {
        let [place, velocity, acceleration, spin] = [[0.0; 3]; 4];
        Self { place, turn: Attitude::identity(), velocity, acceleration, spin, depth: 0.0 }
    }
}

impl Body {
    /// Reads the position, its rate, and behind its acceleration the attitude and its rate.
    pub(super) fn new(numbers: &[f64; 21]) -> Self {
        let four = |at: usize| core::array::from_fn(|i| numbers[at + i]);
        let turn = Attitude::from_quaternion(four(9));
        let spin = Rates::from_derivative(turn, four(13)).in_space(turn);
        Self { turn, spin, ..Self::moving(numbers) }
    }

    /// Reads the position, its rate and its acceleration.
    pub(super) fn moving(numbers: &[f64]) -> Self {
        let three = |at: usize| core::array::from_fn(|i| numbers[at + i]);
        let [place, velocity, acceleration] = [0, 3, 6].map(three);
        Self { place, velocity, acceleration, ..Self::default() }
    }

    pub(super) fn point(&self, point: Vector) -> Vector {
        plus(self.place, 1.0, self.turn * point)
    }
}

impl<T: Float> World<T> {
    /// Returns the acceleration of a bone by its wind.
    pub(super) fn gust(&self, living: Living<'_>, limit: &Limit, t: f64) -> Vector {
        let Some(joint) = limit.wind.and_then(|wind| wind.of(living).ok()) else { return [0.0; 3] };
        let numbers: [T; 9] = self.numbers(&[joint], Time::new(t));
        let gust = [0, 1, 2].map(|i| numbers[i].to_f64());
        if gust.iter().all(|part| part.is_finite()) { gust } else { [0.0; 3] }
    }

    /// Returns the body of a frame on two joints.
    pub(super) fn body(&self, joints: &[u32], t: f64) -> Body {
        Body::new(&self.numbers(joints, Time::new(t)).map(T::to_f64))
    }

    /// Returns the acceleration of the joint of a bone as it is seen from its center, along the
    /// axes of space: r̈ − Ω̇ × r − 2Ω × (ṙ − Ω × r/2).
    pub(super) fn felt(&self, center: &[u32], t: f64, joint: &Body) -> Vector {
        let numbers: [f64; 21] = self.numbers(center, Time::new(t)).map(T::to_f64);
        let Body { place, turn, velocity, acceleration, spin, .. } = Body::new(&numbers);
        // The vector of 2q̈∘q⁻¹ = Ω̇ − |Ω|²/2.
        let rates = core::array::from_fn(|i| numbers[17 + i]);
        let change = Rates::from_derivative(turn, rates).in_space(turn);
        let off = plus(joint.place, -1.0, place);
        let rate = plus(plus(joint.velocity, -1.0, velocity), -0.5, cross(spin, off));
        let seen = plus(plus(joint.acceleration, -1.0, acceleration), -1.0, cross(change, off));
        plus(seen, -2.0, cross(spin, rate))
    }
}

/// The bodies of frames at both ends of a tick, by the joint of the position: the bones of a
/// character have the same colliders.
#[derive(Debug, Default)]
pub(super) struct Frames {
    /// The number of ticks that were seen, from one on.
    pub(super) round: u64,
    seen: Vec<Seen>,
}

/// A frame at both ends of the tick `round`, with its attitude on the joint `turn`.
#[derive(Clone, Copy, Debug)]
struct Seen {
    round: u64,
    turn: u32,
    ends: [Body; 2],
}

impl Frames {
    pub(super) fn ends<T: Float>(
        &mut self,
        world: &World<T>,
        joints: [u32; 2],
        times: [f64; 2],
    ) -> &[Body; 2] {
        let (round, [place, turn]) = (self.round, joints);
        if self.seen.len() < world.joints.len() {
            let unseen = Seen { round: 0, turn, ends: [Body::default(); 2] };
            self.seen.resize(world.joints.len(), unseen);
        }
        let seen = &mut self.seen[place as usize];
        if (seen.round, seen.turn) != (round, turn) {
            *seen = Seen { round, turn, ends: times.map(|t| world.body(&joints, t)) };
        }
        &seen.ends
    }
}
