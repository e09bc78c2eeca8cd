//! Steps without events, which most steps are.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would prevent vector instructions.
#![allow(clippy::needless_bitwise_bool)]

use super::{EventDetector, POINTS, Place, side};
use crate::integrate::events::Condition;
use crate::integrate::events::root::stays_away;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::{Float, Lanes};

/// The maximum number of events whose values are stored in a row.
pub(crate) const MOST: usize = 8;

/// The value of a function at the start of a step.
pub(crate) struct Start<T> {
    pub(crate) value: T,
    /// The sign of the function; zero if it has just passed a root or has not yet shown the
    /// expected sign.
    pub(crate) sign: T,
    /// `true` if there are no usable values before the step.
    pub(crate) fresh: bool,
}

/// Returns 1 for each lane in which a function has no root, otherwise 0. In these lanes the
/// function has the sign `signs` at all [`POINTS`], and is at none of them nearer to zero than at
/// both neighbours.
///
/// The first two values, before and at the start of the step, may have any sign.
#[inline(always)]
pub(crate) fn clear<T: Float, const W: usize>(
    values: &[Lanes<T, W>; POINTS.len()],
    signs: &Lanes<T, W>,
) -> Lanes<T, W> {
    let zero = T::from_f64(0.0);
    let (mut first, mut middle) = (values[0], values[1]);
    let mut spoilt = Lanes::<T, W>::splat(zero);
    for l in 0..W {
        (first.0[l], middle.0[l]) = (first.0[l].abs(), middle.0[l].abs());
        spoilt.0[l] = first.0[l] * zero;
    }
    // The least value, and the greatest depth of a value below both of its neighbours.
    let (mut least, mut depth) = (first, Lanes::<T, W>::splat(T::from_f64(-1.0)));
    for value in &values[2..] {
        for l in 0..W {
            let here = value.0[l] * signs.0[l];
            let (fall, rise) = (first.0[l] - middle.0[l], here - middle.0[l]);
            let lower = if fall < rise { fall } else { rise };
            depth.0[l] = if depth.0[l] < lower { lower } else { depth.0[l] };
            least.0[l] = if here < least.0[l] { here } else { least.0[l] };
            spoilt.0[l] += here * zero;
            (first.0[l], middle.0[l]) = (middle.0[l], here);
        }
    }
    let mut clear = Lanes::<T, W>::splat(zero);
    for l in 0..W {
        let fine = (zero < least.0[l]) & (depth.0[l] < zero) & (spoilt.0[l] == zero);
        clear.0[l] = if fine { T::from_f64(1.0) } else { zero };
    }
    clear
}

impl<T: Float, const N: usize> EventDetector<'_, T, N> {
    /// Returns the function of an event at the start of the next step.
    pub(crate) fn start(&self, index: usize) -> Start<T> {
        let track = &self.tracks[index];
        let sign = if track.expected == 0 { f64::from(track.side) } else { 0.0 };
        Start { value: track.value, sign: T::from_f64(sign), fresh: self.fresh }
    }

    /// Returns `true` if a function with the given `values` at [`POINTS`] neither changes its sign
    /// nor dips towards zero in a step over `interval` without a kink.
    ///
    /// Without usable values before the step, the first of the values is that at the start.
    pub(crate) fn is_quiet(
        &self,
        index: usize,
        interval: &StepInterval,
        values: &[T; POINTS.len()],
        place: impl Fn(usize) -> Place<T, N>,
    ) -> bool {
        let track = &self.tracks[index];
        let timed = matches!(self.events[index].condition, Condition::Times(_));
        if timed || track.side == 0 || track.expected != 0 || side(values[0]) == 0 {
            return false;
        }
        for i in 2..POINTS.len() {
            if side(values[i]) != track.side {
                return false;
            }
            let [first, middle, here] =
                [i - 2, i - 1, i].map(|point| (T::from_f64(POINTS[point]), values[point].abs()));
            let lower = middle.1 <= here.1 && middle.1 < first.1;
            // Whether a function falls from such a start is not known here.
            if i == 2 && self.fresh && middle.1 <= here.1 {
                return false;
            }
            // The function may have been on the other side of zero before the step.
            if lower
                && side(values[i - 2]) == track.side
                && !(i == 2 && (self.fresh || self.recent(index, interval)))
            {
                let Ok(tolerance) = self.tolerance(index, &place(i - 1)) else { return false };
                if !stays_away(&[first, middle, here], tolerance) {
                    return false;
                }
            }
        }
        true
    }

    /// Records a step without events: stores the `values` of all functions at the end of the step,
    /// like a search that finds no event.
    pub(crate) fn pass(&mut self, values: impl Fn(usize) -> T) {
        self.found.clear();
        self.fresh = false;
        for (index, track) in self.tracks.iter_mut().enumerate() {
            track.value = values(index);
        }
    }
}
