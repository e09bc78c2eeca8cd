//! The search for steps with records to keep: output times and events.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would prevent vector instructions.
#![allow(clippy::needless_bitwise_bool)]

use super::flight::{Attempt, Wide, endpoint, interval_of, length_of};
use super::kernel::Run;
use super::lengths::any;
use super::problem::{Batched, W};
use crate::integrate::events::detector::quiet::{MOST, Start, clear};
use crate::integrate::events::detector::{POINTS, Place};
use crate::integrate::output::Output;
use crate::jet::LENGTH;
use crate::scalar::Real;
use crate::system::scalar_time;
use crate::time::Time;

/// The index of the last of [`POINTS`].
const LAST: usize = POINTS.len() - 1;
/// The indices of the [`POINTS`] other than the ends of a step.
const INNER: [usize; POINTS.len() - 2] = [0, 2, 3, 4, 5, 6, 7, 8, 9];

/// The coordinates and velocities of all lanes at several points of their steps.
type Places<T, const N: usize> = [[[Wide<T>; N]; 2]; POINTS.len()];

/// The values of a function at [`POINTS`].
type Values<T> = [Wide<T>; POINTS.len()];

impl<D: Batched<N>, const N: usize> Run<'_, D, N> {
    /// Returns a number other than zero for each lane with records to keep in its step.
    #[inline(always)]
    pub(super) fn detect(&mut self, doubted: Wide<f64>) -> Wide<f64> {
        let live = self.attempt.from.live;
        let mut seen = Wide::from_f64(0.0);
        let always = self.recording.dense | matches!(self.recording.output, Output::Steps);
        for l in 0..W {
            let ahead = self.onwards.0[l] * (self.output.0[l] - self.lanes.high.0[l]);
            seen.0[l] = if (ahead <= 0.0) | always { live.0[l] } else { 0.0 };
        }
        if self.recording.events.is_empty() {
            return seen;
        }
        // The detector may process each step only once: it records a quiet step with its end.
        let mut looked = Wide::from_f64(0.0);
        for l in 0..W {
            let sure = doubted.0[l] + self.attempt.kinked.0[l] == 0.0;
            looked.0[l] = if sure & (seen.0[l] == 0.0) { live.0[l] } else { 0.0 };
        }
        let quiet = if any(looked) { self.quiet(looked) } else { looked };
        for l in 0..W {
            seen.0[l] += looked.0[l] - quiet.0[l];
        }
        seen
    }

    /// Returns 1 for each of the lanes `looked` without an event in its step, otherwise 0. Stores
    /// the ends of these steps in the detectors.
    #[inline(always)]
    fn quiet(&mut self, looked: Wide<f64>) -> Wide<f64> {
        let zero = Wide::from_f64(0.0);
        let mut ends = [Wide::from_f64(0.0); MOST];
        if ends.len() < self.recording.events.len() {
            return zero;
        }
        let mut quiet = looked;
        let places = self.places();
        for index in 0..self.recording.events.len() {
            let mut signs = Wide::from_f64(0.0);
            let values = self.values(index, quiet, &places, &mut signs);
            let clear = clear(&values, &signs);
            let mut unclear = zero;
            for l in 0..W {
                unclear.0[l] =
                    if clear.0[l] == D::Scalar::from_f64(0.0) { quiet.0[l] } else { 0.0 };
            }
            if any(unclear) {
                self.look_closer(index, unclear, &places, &values, &mut quiet);
            }
            ends[index] = values[LAST];
        }
        self.pass(quiet, &ends);
        quiet
    }

    /// Computes the coordinates and velocities at all [`POINTS`] except the two ends, which are
    /// known.
    #[inline(always)]
    fn places(&self) -> Places<D::Scalar, N> {
        let zero = Wide::from_f64(0.0);
        let mut places = [[[zero; N]; 2]; POINTS.len()];
        let length = length_of::<D::Scalar>(&self.attempt.h);
        let passed = INNER.map(|point| Wide::from_f64(POINTS[point]) * length);
        let (path, order) = (&self.workspace.path, self.rule.order.min(LENGTH - 1));
        for i in 0..N {
            for (part, series) in [&path.q[i], &path.v[i]].into_iter().enumerate() {
                // The sums are computed side by side, so that each waits only for its own last
                // product.
                let mut sums = [zero; INNER.len()];
                for &coefficient in series[1..=order].iter().rev() {
                    sums = core::array::from_fn(|k| (sums[k] + coefficient) * passed[k]);
                }
                for (point, sum) in INNER.into_iter().zip(sums) {
                    places[point][part][i] = series[0] + sum;
                }
            }
        }
        places
    }

    /// Returns the values of a function in the lanes `looked`, and stores the sign before the step
    /// in `signs`; zero if that sign alone is not sufficient.
    #[inline(never)]
    fn values(
        &self,
        index: usize,
        looked: Wide<f64>,
        places: &Places<D::Scalar, N>,
        signs: &mut Wide<D::Scalar>,
    ) -> Values<D::Scalar> {
        let mut values = [Wide::from_f64(0.0); POINTS.len()];
        let Some(function) = self.recording.events[index].function() else { return values };
        let from = &self.attempt.from;
        let length = length_of::<D::Scalar>(&self.attempt.h);
        for l in 0..W {
            let Some(member) = &self.members[l] else { continue };
            if looked.0[l] == 0.0 {
                continue;
            }
            let Start { value, sign, fresh } = member.detector.start(index);
            (signs.0[l], values[0].0[l], values[1].0[l]) = (sign, value, value);
            let t = scalar_time::<D::Scalar>(Time::from_words(from.high.0[l], from.low.0[l]));
            // Writes numbers one by one into the same place: with a copy, the next load would wait.
            let mut place = Place { t, q: [t; N], v: [t; N] };
            for point in if fresh { &INNER[1..] } else { &INNER[..] } {
                place.t = t + D::Scalar::from_f64(POINTS[*point]) * length.0[l];
                let [q, v] = &places[*point];
                for i in 0..N {
                    (place.q[i], place.v[i]) = (q[i].0[l], v[i].0[l]);
                }
                values[*point].0[l] = function(place.t, &place.q, &place.v);
            }
            let end = Place::of(&endpoint(&self.lanes, l));
            values[LAST].0[l] = function(end.t, &end.q, &end.v);
        }
        values
    }

    /// Checks the lanes `unclear` one by one, and removes lanes with a possible event in their step
    /// from `quiet`.
    #[inline(never)]
    fn look_closer(
        &self,
        index: usize,
        unclear: Wide<f64>,
        places: &Places<D::Scalar, N>,
        values: &Values<D::Scalar>,
        quiet: &mut Wide<f64>,
    ) {
        let Attempt { from, h, .. } = &self.attempt;
        for l in 0..W {
            let Some(member) = self.members[l].as_ref().filter(|_| 0.0 < unclear.0[l]) else {
                continue;
            };
            let interval = interval_of(from, &self.lanes, *h, l);
            let (t, length) =
                (scalar_time::<D::Scalar>(interval.start), interval.length::<D::Scalar>());
            let place = |point: usize| match point {
                1 => Place::of(&endpoint(from, l)),
                LAST => Place::of(&endpoint(&self.lanes, l)),
                _ => Place {
                    t: t + D::Scalar::from_f64(POINTS[point]) * length,
                    q: places[point][0].map(|q| q.0[l]),
                    v: places[point][1].map(|v| v.0[l]),
                },
            };
            let values = values.map(|value| value.0[l]);
            if !member.detector.is_quiet(index, &interval, &values, place) {
                quiet.0[l] = 0.0;
            }
        }
    }

    /// Stores the values at the ends of steps without events in the detectors.
    #[inline(never)]
    fn pass(&mut self, quiet: Wide<f64>, ends: &[Wide<D::Scalar>; MOST]) {
        for l in 0..W {
            if let Some(member) = self.members[l].as_mut().filter(|_| 0.0 < quiet.0[l]) {
                member.detector.pass(|index| ends[index].0[l]);
            }
        }
    }
}
