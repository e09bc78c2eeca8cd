//! The search of one step for the roots of one function.

use super::{EventDetector, NEAR, POINTS, Place, Track, occurrence, side};
use crate::error::Error;
use crate::integrate::events::Occurrence;
use crate::integrate::events::root::{Dip, Point, dip, root, stays_away};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::scalar::Float;

/// The time after a root at which the function shows its sign, as a fraction of the step.
const SHORTLY: f64 = 1e-7;

/// The function `index` on the motion within a step, which ends in `end`.
pub(super) struct Search<'s, 'a, T, const N: usize> {
    pub(super) detector: &'s mut EventDetector<'a, T, N>,
    pub(super) index: usize,
    pub(super) interpolant: &'s Interpolant<T, N>,
    pub(super) end: &'s Endpoint<T, N>,
}

impl<T: Float, const N: usize> Search<'_, '_, T, N> {
    fn track(&mut self) -> &mut Track<T> {
        &mut self.detector.tracks[self.index]
    }

    /// Searches a step for the roots of one function.
    pub(super) fn run(&mut self) -> Result<(), Error> {
        let zero = T::from_f64(0.0);
        let mut before: [Option<Point<T>>; 2] = [None; 2];
        let mut side_before = self.track().side;
        let mut falling: Option<Point<T>> = None;
        for (i, &theta) in POINTS.iter().enumerate() {
            let theta = T::from_f64(theta);
            let value = match i {
                // A function may be undefined before the start of the step.
                0 => match self.at(theta) {
                    Ok(value) if !self.detector.fresh => value,
                    _ => continue,
                },
                1 => self.track().value,
                10 => self.detector.value(self.index, &Place::of(self.end))?,
                _ => self.at(theta)?,
            };
            let mut point = (theta, value);
            if i == 1 && side_before == 0 {
                // A long step from a root may pass the next root: the side is determined soon after
                // the start.
                let soon = T::from_f64(NEAR);
                let place = Place::on(self.interpolant, soon);
                let Self { detector, index, .. } = &*self;
                if let (Ok(value), Ok(least)) =
                    (detector.value(*index, &place), detector.allowance(*index, &place))
                    && least < value.abs()
                {
                    (point, side_before) = ((soon, value), side(value));
                    self.show(point)?;
                }
            }
            if i == 1
                && self.detector.fresh
                && side_before != 0
                && let Ok(value) = self.at(T::from_f64(NEAR))
                && value.abs() < point.1.abs()
            {
                // The function falls towards zero from the start, as points before it would show.
                let near = (T::from_f64(NEAR), value);
                if side(near.1) == side_before {
                    falling = Some(near);
                } else {
                    let theta = self.root(point, near)?;
                    side_before = side(near.1);
                    self.push(theta, side_before);
                    point = near;
                }
            }
            let side_here = side(value);
            if 1 < i {
                match (side_before, before) {
                    (0, _) => {
                        side_before = side_here;
                        self.show(point)?;
                    }
                    (_, [_, Some(last)]) if side_here == -side_before => {
                        let theta = self.root(last, point)?;
                        self.push(theta, side_here);
                        side_before = side_here;
                    }
                    (_, [_, Some(_)]) if side_here == 0 => {
                        // A root exactly at this point: the value shortly afterwards shows if it is
                        // crossed.
                        let next = self
                            .at(theta + T::from_f64(SHORTLY))
                            .unwrap_or(T::from_f64(f64::from(-side_before)));
                        point.1 = next;
                        let crossed = side(next) != side_before;
                        self.push(theta, if crossed { -side_before } else { 0 });
                        side_before = side(next);
                    }
                    (_, [None, Some(start)]) => {
                        let least = falling.filter(|near| near.1.abs() <= value.abs());
                        if let Some(near) = least.filter(|near| side(near.1) == side_here) {
                            self.dip([start, near, point])?;
                        }
                    }
                    (_, [Some(first), Some(middle)])
                        if side(first.1) == side_here && side(middle.1) == side_here =>
                    {
                        let lower = middle.1.abs() <= value.abs() && middle.1.abs() < first.1.abs();
                        let recent =
                            || self.detector.recent(self.index, &self.interpolant.interval);
                        if lower && !(i == 2 && recent()) {
                            self.dip([first, middle, point])?;
                        }
                    }
                    _ => {}
                }
            }
            before = [before[1], Some(point)];
        }
        let track = self.track();
        track.value = before[1].map_or(zero, |point| point.1);
        track.side = side_before;
        Ok(())
    }

    /// Compares the first side of the function after an act, at `point`, with the expected side,
    /// and finds the root in between if the two sides differ.
    fn show(&mut self, mut point: Point<T>) -> Result<(), Error> {
        let (expected, here) = (self.track().expected, side(point.1));
        if here == 0 {
            return Ok(());
        }
        self.track().expected = 0;
        if expected != -here {
            return Ok(());
        }
        // The function has returned within less than the distance of two points.
        for _ in 0..60 {
            let theta = T::from_f64(0.5) * point.0;
            let value = self.at(theta)?;
            if side(value) == expected {
                let theta = self.root((theta, value), point)?;
                self.push(theta, here);
                return Ok(());
            }
            point = if side(value) == here { (theta, value) } else { point };
            if side(value) == 0 {
                break;
            }
        }
        let t = self.interpolant.interval.start.to_f64();
        Err(Error::Accumulation { t, event: self.index })
    }

    /// Searches a dip of |g| for a root or a pair of roots.
    fn dip(&mut self, points: [Point<T>; 3]) -> Result<(), Error> {
        let sign = T::from_f64(f64::from(side(points[0].1)));
        let tolerance =
            self.detector.tolerance(self.index, &Place::on(self.interpolant, points[1].0))?;
        let positive = points.map(|(theta, value)| (theta, sign * value));
        if stays_away(&positive, tolerance) {
            return Ok(());
        }
        match dip(&mut |theta| Ok(sign * self.at(theta)?), positive, tolerance)? {
            Dip::Away => {}
            Dip::Touches(theta) => self.push(theta, 0),
            Dip::Crosses(theta) => {
                let below = (theta, self.at(theta)?);
                for (from, to, here) in
                    [(points[0], below, side(below.1)), (below, points[2], side(points[2].1))]
                {
                    let theta = self.root(from, to)?;
                    self.push(theta, here);
                }
            }
        }
        Ok(())
    }

    fn root(&self, from: Point<T>, to: Point<T>) -> Result<T, Error> {
        root(&mut |theta| self.at(theta), from, to)
    }

    /// Adds an occurrence if its direction counts. `here` is the side after the root, 0 if the
    /// function only touches zero.
    fn push(&mut self, theta: T, here: i8) {
        let Self { index, interpolant, end, .. } = *self;
        if !self.detector.counts(index, here) {
            return;
        }
        // A dip around the start of a step may have its root before the start, where the
        // integration can no longer end.
        let zero = T::from_f64(0.0);
        let theta = if theta < zero && self.detector.events[index].stops() { zero } else { theta };
        let occurrence = if theta == T::from_f64(1.0) {
            occurrence(index, end)
        } else {
            let passed = theta * interpolant.interval.length();
            let high = passed.to_f64();
            let time = interpolant.interval.start + high + (passed - T::from_f64(high)).to_f64();
            let (q, v) = interpolant.at(theta);
            let state = State { t: time.to_f64(), q, v };
            Occurrence { event: index, time, state, after: state }
        };
        self.detector.found.push(occurrence);
    }

    /// Returns the value of the function on the dense output.
    fn at(&self, theta: T) -> Result<T, Error> {
        self.detector.value(self.index, &Place::on(self.interpolant, theta))
    }
}
