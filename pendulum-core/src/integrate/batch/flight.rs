//! States of all lanes, and the steps between them.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would prevent vector instructions.
#![allow(clippy::needless_bitwise_bool)]

use super::problem::W;
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::{Float, Lanes, Real};
use crate::time::Time;

/// A number for each lane.
pub(super) type Wide<T> = Lanes<T, W>;

/// The states of all lanes.
#[derive(Clone, Copy)]
pub(super) struct Flight<T, const N: usize> {
    pub(super) q: Compensated<Wide<T>, N>,
    pub(super) v: Compensated<Wide<T>, N>,
    /// The high words of the times.
    pub(super) high: Wide<f64>,
    /// The low words of the times.
    pub(super) low: Wide<f64>,
    /// The times at which the series cease to be valid: the next break, or the end of the motion.
    pub(super) end: Wide<f64>,
    /// 1 for lanes with a motion, otherwise 0.
    pub(super) live: Wide<f64>,
}

/// A step in every lane.
#[derive(Clone, Copy)]
pub(super) struct Attempt<T, const N: usize> {
    pub(super) from: Flight<T, N>,
    /// The lengths wanted.
    pub(super) wanted: Wide<f64>,
    /// The lengths taken, in two words.
    pub(super) h: [Wide<f64>; 2],
    /// The reciprocals of the errors allowed.
    pub(super) weights: [[Wide<f64>; N]; 2],
    /// The accelerations at the ends, computed from the series.
    pub(super) ends: [Wide<T>; N],
    /// Not zero in lanes whose state at the end is not finite, or whose step is left to `Taylor`.
    pub(super) doubted: Wide<f64>,
    /// 1 in lanes whose step ends on a kink, otherwise 0.
    pub(super) kinked: Wide<f64>,
    /// `true` if a step is the first or the last one, or too short or too long.
    pub(super) unusual: bool,
}

impl<T, const N: usize> Attempt<T, N> {
    /// Returns the time at which the step of a lane starts.
    #[inline(always)]
    pub(super) fn start(&self, l: usize) -> Time {
        Time::from_words(self.from.high.0[l], self.from.low.0[l])
    }
}

/// Returns the lengths of steps in the scalar of the system.
#[inline(always)]
pub(super) fn length_of<T: Float>(h: &[Wide<f64>; 2]) -> Wide<T> {
    let mut length = Wide::from_f64(0.0);
    for l in 0..W {
        length.0[l] = T::from_f64(h[0].0[l]) + T::from_f64(h[1].0[l]);
    }
    length
}

/// Returns the interval of the step that a lane has taken.
pub(super) fn interval_of<T: Float, const N: usize>(
    from: &Flight<T, N>,
    to: &Flight<T, N>,
    h: [Wide<f64>; 2],
    l: usize,
) -> StepInterval {
    let [start, end] = [from, to].map(|lanes| Time::from_words(lanes.high.0[l], lanes.low.0[l]));
    StepInterval { start, end, h: h[0].0[l], low: h[1].0[l] }
}

/// Returns the state in a lane.
pub(super) fn endpoint<T: Float, const N: usize>(lanes: &Flight<T, N>, l: usize) -> Endpoint<T, N> {
    let sum = |sum: &Compensated<Wide<T>, N>| Compensated {
        high: sum.high.map(|x| x.0[l]),
        low: sum.low.map(|x| x.0[l]),
    };
    let t = Time::from_words(lanes.high.0[l], lanes.low.0[l]);
    Endpoint { t, q: sum(&lanes.q), v: sum(&lanes.v), a: None }
}
