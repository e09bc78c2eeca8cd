//! Steps in which nothing happens, as most do.

use super::{EventDetector, POINTS, Place, side};
use crate::integrate::events::Condition;
use crate::integrate::events::root::stays_away;
use crate::integrate::step::interval::StepInterval;
use crate::scalar::Float;

impl<T: Float, const N: usize> EventDetector<'_, T, N> {
    /// Returns true if nothing happens in a step over `interval` without a kink, of which `put`
    /// puts the states at [`POINTS`] into a place; takes note of its end then, as a search that
    /// finds nothing.
    ///
    /// All events have functions.
    pub(crate) fn is_quiet(
        &mut self,
        interval: &StepInterval,
        mut room: Place<T, N>,
        put: impl Fn(usize, &mut Place<T, N>),
    ) -> bool {
        // The values at the ends; those of few events stand in a row.
        let mut last = [T::from_f64(0.0); 8];
        if last.len() < self.events.len() {
            return false;
        }
        for index in 0..self.events.len() {
            match self.quiet_end(index, interval, &mut room, &put) {
                Some(value) => last[index] = value,
                None => return false,
            }
        }
        self.found.clear();
        self.fresh = false;
        for (track, value) in self.tracks.iter_mut().zip(last) {
            track.value = value;
        }
        true
    }

    /// The value of a function at the end of a step in which it neither changes its sign nor dips
    /// towards zero.
    fn quiet_end(
        &self,
        index: usize,
        interval: &StepInterval,
        room: &mut Place<T, N>,
        put: impl Fn(usize, &mut Place<T, N>),
    ) -> Option<T> {
        let Condition::Root(function) = &self.events[index].condition else { return None };
        let at = |point: usize, room: &mut Place<T, N>| {
            put(point, room);
            function(room.t, &room.q, &room.v)
        };
        let track = &self.tracks[index];
        let start = (T::from_f64(POINTS[1]), track.value);
        let before = (T::from_f64(POINTS[0]), if self.fresh { start.1 } else { at(0, room) });
        if track.side == 0 || track.expected != 0 || side(before.1) == 0 {
            return None;
        }
        let mut points = [before, start];
        for i in 2..POINTS.len() {
            let point = (T::from_f64(POINTS[i]), at(i, room));
            if side(point.1) != track.side {
                return None;
            }
            let [first, middle] = points.map(|(theta, value)| (theta, value.abs()));
            let here = (point.0, point.1.abs());
            let lower = middle.1 <= here.1 && middle.1 < first.1;
            // The function may have been on the other side before the step.
            if lower
                && side(points[0].1) == track.side
                && !(i == 2 && (self.fresh || self.recent(index, interval)))
            {
                put(i - 1, room);
                let tolerance = self.tolerance(index, room).ok()?;
                if !stays_away(&[first, middle, here], tolerance) {
                    return None;
                }
            }
            points = [points[1], point];
        }
        Some(points[1].1)
    }
}
