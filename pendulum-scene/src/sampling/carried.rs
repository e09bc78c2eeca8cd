//! Joints that pendulums carry: an output of a pendulum is the motion of each.

use crate::sampling::live::{Course, Piece, at_rest};
use crate::sampling::world::World;
use core::any::Any;
use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;

/// The level, the group and the index of a pendulum. Level 0 has no joint that a pendulum carries;
/// other levels are one above the highest pendulum that carries a joint of theirs. A joint is
/// carried from its beginning by a pendulum that exists before it, so that no pendulum hangs on
/// itself.
pub(crate) type Place = (u32, u32, u32);

/// A joint that a pendulum carries.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ride {
    pub(crate) joint: u32,
    /// The index of the output.
    pub(crate) output: usize,
    /// The attitude of the joint relative to an output that is one.
    pub(crate) rest: Option<[f64; 4]>,
    /// An output that is an attitude, and what is added to the position along its axes.
    pub(crate) aside: Option<(usize, [f64; 3])>,
    /// The states at the beginning and at the end of the last tick. A joint of fewer than four
    /// components has the first ones.
    pub(crate) states: [Sample<f64, 4>; 2],
}

/// A pendulum that carries joints.
pub(crate) struct Carrier<T> {
    /// Computes the states of the joints at both ends of a tick, from the group of the pendulum and
    /// its index.
    pub(crate) frames: fn(&dyn Any, &World<T>, u32, i64, &mut Self),
    pub(crate) rides: Vec<Ride>,
    /// The numbers from which the states at the end of the last tick were computed, empty if the
    /// next tick does not begin with these states; and those of another state.
    pub(crate) known: [Vec<T>; 2],
}

/// The motion of a carried joint in the last tick.
///
/// It is the polynomial of degree five with the position, velocity and acceleration of the output
/// at both ends, so that ticks join with a continuous acceleration; it differs from the output by a
/// multiple of the sixth power of the tick. Pendulums on the joint thereby may have other steps
/// than the one that carries it. Earlier and later, the joint counts as at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried<const D: usize> {
    piece: Piece<D>,
}

impl<const D: usize> Carried<D> {
    pub(crate) fn new(t: f64) -> Self {
        Self { piece: Piece::still(t, [0.0; D]) }
    }

    /// Moves the joint through a tick.
    pub(crate) fn follow(
        &mut self,
        [begin, end]: [f64; 2],
        states: &[Sample<f64, 4>; 2],
    ) -> Course {
        let states = states.map(|state| Sample {
            position: core::array::from_fn(|i| state.position[i]),
            velocity: core::array::from_fn(|i| state.velocity[i]),
            acceleration: core::array::from_fn(|i| state.acceleration[i]),
        });
        let (rested, last) = (self.piece.is_still(), self.piece.states[1].position);
        self.piece = Piece::new(begin, end, states);
        if states[0].position != last {
            Course::Jumps
        } else if rested && !self.piece.is_still() {
            Course::Starts
        } else {
            Course::Continues
        }
    }
}

impl<T: Real, const D: usize> Motion<T, D> for Carried<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, t: Time, _: Side, wanted: Derivatives) -> Sample<T, D> {
        let begins = t.since(self.piece.begin) == 0.0;
        let state = if begins { self.piece.states[0] } else { self.piece.at(t, wanted) };
        state.map(T::from_f64)
    }

    // Only a pendulum that has been hidden asks for earlier times.
    fn next_kink(&self, t: f64) -> Option<f64> {
        let Piece { begin, states: [first, _], .. } = self.piece;
        (t < begin && first != at_rest(first.position)).then_some(begin)
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let Piece { begin, end, .. } = self.piece;
        if self.piece.is_still() {
            return Some(f64::INFINITY);
        }
        Some((widths * (end - begin)).max(0.5 * (t - begin.midpoint(end)).abs()))
    }

    // A joint that rests now does not for ever: whatever moves it wakes the pendulums on it.
    fn rest_until(&self, t: f64) -> f64 {
        if self.piece.is_still() && self.piece.begin <= t { f64::INFINITY } else { t }
    }
}
