//! Live joints, which the program moves while the scene runs.

// Code for lanes must be compiled with the vector instructions of its caller.
#![allow(clippy::inline_always)]

use crate::error::SceneError;
use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::{Float, Octet, Real};
use pendulum_core::simd::{Work, widest};
use pendulum_core::time::Time;

/// The beginning of a live joint, for [`Scene::live`](crate::Scene::live): its first position, and
/// whether it follows the positions exactly or smoothly. Created from a position by `into`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Live<const D: usize> {
    pub(crate) position: [f64; D],
    pub(crate) smoothed: bool,
}

impl<const D: usize> Live<D> {
    /// Creates a joint that begins at rest and is exactly where it is told to be at the end of each
    /// frame.
    ///
    /// Within a frame, the joint follows the polynomial of degree five with the position, velocity
    /// and acceleration of both ends (quintic Hermite interpolation), so that its acceleration is
    /// continuous. Those of the end are the derivatives of the parabola through the last three
    /// positions p₀, p₁, p₂ over the real times: for the slopes d₁ and d₂ of frames of h₁ and h₂,
    /// the acceleration is a = 2(d₂ − d₁)/(h₁ + h₂) and the velocity d₂ + h₂a/2. Constant
    /// velocities and accelerations are exact after three positions. A sudden start reaches 1.52
    /// times the speed, and a sudden stop goes too far by 0.23 of the way of a frame: without a
    /// delay, no motion with a continuous acceleration avoids both.
    pub const fn new(position: [f64; D]) -> Self {
        Self { position, smoothed: false }
    }

    /// Creates a joint that follows the positions smoothly and is one frame late.
    ///
    /// With frames of one length h, its path is the uniform cubic B-spline with the positions as
    /// control points: at the end of a frame, it is at (p₀ + 4p₁ + p₂)/6 with the velocity
    /// (p₂ − p₀)/2h and the acceleration (p₀ − 2p₁ + p₂)/h² (de Boor, *A Practical Guide to
    /// Splines*). It never leaves the range of the last four positions. With frames of several
    /// lengths, the acceleration is still continuous, but the velocity follows the lengths, and the
    /// joint may leave the range: by at most 2 % of the way of a frame if lengths differ by at most
    /// a half.
    #[must_use]
    pub const fn smoothed(self) -> Self {
        Self { smoothed: true, ..self }
    }
}

impl<const D: usize> From<[f64; D]> for Live<D> {
    fn from(position: [f64; D]) -> Self {
        Self::new(position)
    }
}

/// Returns an error if a position of a joint is not finite.
pub(crate) fn check_position(joint: u32, position: &[f64]) -> Result<(), SceneError> {
    let wrong = position.iter().position(|x| !x.is_finite());
    wrong.map_or(Ok(()), |component| {
        Err(SceneError::Position { joint, component, value: position[component] })
    })
}

/// The motion of a joint in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece<const D: usize> {
    pub(super) begin: f64,
    pub(super) end: f64,
    pub(super) states: [Sample<f64, D>; 2],
    /// The coefficients of u³, u⁴ and u⁵ for the time from the beginning u = (t − begin)/h.
    high: [[f64; 3]; D],
}

impl<const D: usize> Piece<D> {
    pub(super) fn new(begin: f64, end: f64, states: [Sample<f64, D>; 2]) -> Self {
        let ([from, to], h) = (states, end - begin);
        let high = core::array::from_fn(|i| {
            let [v0, v1] = [from, to].map(|state| h * state.velocity[i]);
            let [a0, a1] = [from, to].map(|state| h * h * state.acceleration[i]);
            // What the terms up to u² lack at the end.
            let p = to.position[i] - from.position[i] - v0 - 0.5 * a0;
            let (v, a) = (v1 - v0 - a0, a1 - a0);
            [10.0 * p - 4.0 * v + 0.5 * a, 7.0 * v - 15.0 * p - a, 6.0 * p - 3.0 * v + 0.5 * a]
        });
        Self { begin, end, states, high }
    }

    pub(super) fn still(t: f64, position: [f64; D]) -> Self {
        Self { begin: t, end: t, states: [at_rest(position); 2], high: [[0.0; 3]; D] }
    }

    /// Returns `true` if the joint does not move in the frame.
    pub(super) fn is_still(&self) -> bool {
        self.states.map(|state| state == at_rest(self.states[0].position)) == [true; 2]
    }

    /// Returns the state at `t`; before the beginning and after the end, the joint rests.
    #[inline]
    pub(super) fn at(&self, t: Time, wanted: Derivatives) -> Sample<f64, D> {
        let [from, to] = &self.states;
        let (since, left) = (t.since(self.begin), -t.since(self.end));
        if since < 0.0 || left < 0.0 {
            return at_rest(if since < 0.0 { from.position } else { to.position });
        }
        // The end is exact, not only up to rounding.
        if left == 0.0 {
            return *to;
        }
        self.within(since, wanted)
    }

    /// Returns the state between the ends, `s` after the beginning.
    #[inline(always)]
    fn within<L: Real>(&self, s: L, wanted: Derivatives) -> Sample<L, D> {
        let (number, h) = (L::from_f64, L::from_f64(self.end - self.begin));
        let (from, u) = (&self.states[0], s / h);
        let mut sample = Sample::zero();
        for i in 0..D {
            let [c3, c4, c5] = self.high[i].map(number);
            let (v, a) = (number(from.velocity[i]), number(from.acceleration[i]));
            if wanted.contains(Derivatives::POSITION) {
                let high = u * u * u * (c3 + u * (c4 + u * c5));
                let low = s * (v + number(0.5) * s * a);
                sample.position[i] = number(from.position[i]) + (low + high);
            }
            if wanted.contains(Derivatives::VELOCITY) {
                let [c3, c4, c5] = [number(3.0) * c3, number(4.0) * c4, number(5.0) * c5];
                let high = u * u * (c3 + u * (c4 + u * c5));
                sample.velocity[i] = v + (s * a + high / h);
            }
            if wanted.contains(Derivatives::ACCELERATION) {
                let [c3, c4, c5] = [number(6.0) * c3, number(12.0) * c4, number(20.0) * c5];
                let high = u * (c3 + u * (c4 + u * c5));
                sample.acceleration[i] = a + high / (h * h);
            }
        }
        sample
    }

    /// Returns the states at eight times. Times beyond the ends are left to `other`.
    #[inline(always)]
    pub(super) fn in_lanes(
        &self,
        times: &[Time; 8],
        wanted: Derivatives,
        other: impl Fn(Time) -> Sample<f64, D>,
    ) -> Sample<Octet<f64>, D> {
        let mut lanes = self.within(Octet(times.map(|t| t.since(self.begin))), wanted);
        for (k, &t) in times.iter().enumerate() {
            if t.since(self.begin) < 0.0 || 0.0 <= t.since(self.end) {
                let own = other(t);
                for i in 0..D {
                    lanes.position[i].0[k] = own.position[i];
                    lanes.velocity[i].0[k] = own.velocity[i];
                    lanes.acceleration[i].0[k] = own.acceleration[i];
                }
            }
        }
        lanes
    }
}

/// The least number of times that are worth eight lanes.
const WORTH: usize = 3;

/// Samples a motion at several times, eight at once, with the bits of single samples.
pub(super) fn sample_several<T: Real, M, const D: usize>(
    motion: &M,
    times: &[Time],
    wanted: Derivatives,
    samples: &mut [Sample<T, D>],
) where
    M: Motion<T, D> + Motion<f64, D>,
{
    for (times, samples) in times.chunks(8).zip(samples.chunks_mut(8)) {
        if WORTH <= times.len() {
            widest(Several { motion, times, wanted, samples });
            continue;
        }
        for (sample, &t) in samples.iter_mut().zip(times) {
            *sample = motion.sample(t, Side::After, wanted);
        }
    }
}

struct Several<'a, M, T, const D: usize> {
    motion: &'a M,
    times: &'a [Time],
    wanted: Derivatives,
    samples: &'a mut [Sample<T, D>],
}

impl<T: Real, M: Motion<f64, D>, const D: usize> Work for Several<'_, M, T, D> {
    #[inline(always)]
    fn run(self) {
        let mut times = [self.times[0]; 8];
        times[..self.times.len()].copy_from_slice(self.times);
        let lanes = self.motion.sample_lanes(&times, self.wanted);
        for (k, sample) in self.samples.iter_mut().enumerate() {
            for d in 0..D {
                sample.position[d] = T::from_f64(lanes.position[d].0[k]);
                sample.velocity[d] = T::from_f64(lanes.velocity[d].0[k]);
                sample.acceleration[d] = T::from_f64(lanes.acceleration[d].0[k]);
            }
        }
    }
}

pub(super) fn at_rest<const D: usize>(position: [f64; D]) -> Sample<f64, D> {
    Sample { position, ..Sample::zero() }
}

/// The motion of a live joint: the last two frames, because the tick in which a frame begins lies
/// in both.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path<const D: usize> {
    pub(super) smoothed: bool,
    /// The position at the end of the coming frame, if the joint has been told.
    pub(super) told: Option<[f64; D]>,
    /// `true` if the next position may be a jump.
    pub(super) interrupted: bool,
    /// The positions at the ends of the last three frames.
    pub(super) samples: [[f64; D]; 3],
    pub(super) pieces: [Piece<D>; 2],
}

/// What a joint does at the beginning of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Course {
    /// It keeps resting or moving.
    Continues,
    /// It has been at rest.
    Starts,
    /// It is at another place, at rest.
    Jumps,
}

/// A live joint whose dimension is erased.
pub(crate) trait Steer {
    /// Returns an error if a position, whose components are finite, is none.
    fn check(&self, position: &[f64]) -> Result<(), SceneError> {
        let _ = position;
        Ok(())
    }
    /// Sets the position at the end of the coming frame.
    fn tell(&mut self, position: &[f64]);
    /// Sets the joint to rest at a position at the time `t`.
    fn place(&mut self, t: f64, position: &[f64]);
    /// Sets the joint to rest where it was last told to be.
    fn settle(&mut self, t: f64);
    /// The next position may be a jump: time has passed of which the joint knows nothing.
    fn interrupt(&mut self);
    /// Begins a frame. `ends` are the times at which the last two frames and this one end.
    fn frame(&mut self, ends: [f64; 3]) -> Course;
    /// Appends all numbers that the motion depends on.
    fn save(&self, numbers: &mut Vec<f64>);
    /// Reads these numbers from the beginning of `numbers`, and removes them there.
    fn restore(&mut self, numbers: &mut &[f64]);
}

impl<const D: usize> Path<D> {
    pub(crate) fn new(t: f64, live: &Live<D>) -> Self {
        let &Live { position, smoothed } = live;
        let pieces = [Piece::still(t, position); 2];
        Self { smoothed, told: None, interrupted: true, samples: [position; 3], pieces }
    }

    pub(super) fn put(&mut self, t: f64, position: [f64; D]) {
        (self.told, self.interrupted) = (None, false);
        (self.samples, self.pieces) = ([position; 3], [Piece::still(t, position); 2]);
    }

    /// Returns the index of the piece at `t`.
    pub(super) fn piece(&self, t: Time) -> usize {
        usize::from(0.0 <= t.since(self.pieces[1].begin))
    }

    /// Returns the state at `t`.
    #[inline]
    pub(super) fn at(&self, t: Time, wanted: Derivatives) -> Sample<f64, D> {
        self.pieces[self.piece(t)].at(t, wanted)
    }

    /// Returns the states at eight times.
    #[inline(always)]
    pub(super) fn in_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<f64>, D> {
        self.pieces[1].in_lanes(times, wanted, |t| self.at(t, wanted))
    }

    /// Returns `true` if `position`, `h` after the last one, continues the motion: it is no farther
    /// from where the velocity leads than the way of a frame.
    fn continues(&self, position: &[f64; D], velocity: &[f64; D], h: f64) -> bool {
        let [mut off, mut way] = [0.0; 2];
        for i in 0..D {
            let ahead = h * velocity[i];
            let by = position[i] - self.samples[2][i] - ahead;
            (off, way) = (off + by * by, way + ahead * ahead);
        }
        off <= way
    }

    /// Returns the state at the end of a frame of `h2` after one of `h1`, from the last samples.
    fn end(&self, h1: f64, h2: f64) -> Sample<f64, D> {
        let mut end = Sample::zero();
        let [p0, p1, p2] = &self.samples;
        for i in 0..D {
            let [d1, d2] = [(p1[i] - p0[i]) / h1, (p2[i] - p1[i]) / h2];
            let a = 2.0 * (d2 - d1) / (h1 + h2);
            end.acceleration[i] = a;
            (end.position[i], end.velocity[i]) = if self.smoothed {
                (p1[i] + h1 * h2 / 6.0 * a, (p2[i] - p0[i]) / (h1 + h2))
            } else {
                (p2[i], d2 + 0.5 * h2 * a)
            };
        }
        end
    }

    /// Begins a frame in the state `from`.
    pub(super) fn frame_from(
        &mut self,
        [before, begin, end]: [f64; 3],
        from: Sample<f64, D>,
    ) -> Course {
        let (told, rested) = (self.told.take(), self.pieces[1].is_still());
        let position = match told {
            None if rested => return Course::Continues,
            None => self.samples[2],
            Some(position) => position,
        };
        let h = end - begin;
        if told.is_some()
            && core::mem::take(&mut self.interrupted)
            && !self.continues(&position, &from.velocity, h)
        {
            self.put(begin, position);
            return Course::Jumps;
        }
        let to = if told.is_some() {
            let [_, p1, p2] = self.samples;
            self.samples = [p1, p2, position];
            // Before the first frame the joint rests, for whatever time.
            self.end(if before < begin { begin - before } else { h }, h)
        } else {
            self.samples = [position; 3];
            at_rest(position)
        };
        self.pieces = [self.pieces[1], Piece::new(begin, end, [from, to])];
        if rested && !self.pieces[1].is_still() { Course::Starts } else { Course::Continues }
    }

    /// Replaces all numbers that the motion depends on by what `visit` makes of them.
    pub(super) fn visit(&mut self, mut visit: impl FnMut(f64) -> f64) {
        let told = visit(f64::from(u8::from(self.told.is_some())));
        let position = self.told.unwrap_or([0.0; D]).map(&mut visit);
        self.told = (told != 0.0).then_some(position);
        self.interrupted = visit(f64::from(u8::from(self.interrupted))) != 0.0;
        self.samples = self.samples.map(|sample| sample.map(&mut visit));
        self.pieces = self.pieces.map(|Piece { begin, end, states, .. }| {
            let [begin, end] = [begin, end].map(&mut visit);
            let states = states.map(|state| state.map(&mut visit));
            if begin < end {
                Piece::new(begin, end, states)
            } else {
                Piece::still(begin, states[0].position)
            }
        });
    }
}

impl<const D: usize> Steer for Path<D> {
    fn tell(&mut self, position: &[f64]) {
        self.told.get_or_insert([0.0; D]).copy_from_slice(position);
    }

    fn place(&mut self, t: f64, position: &[f64]) {
        let mut copy = [0.0; D];
        copy.copy_from_slice(position);
        self.put(t, copy);
    }

    fn settle(&mut self, t: f64) {
        self.put(t, self.samples[2]);
        self.interrupted = true;
    }

    fn interrupt(&mut self) {
        self.interrupted = true;
    }

    fn frame(&mut self, ends: [f64; 3]) -> Course {
        self.frame_from(ends, self.pieces[1].states[1])
    }

    fn save(&self, numbers: &mut Vec<f64>) {
        let mut path = *self;
        path.visit(|number| {
            numbers.push(number);
            number
        });
    }

    fn restore(&mut self, numbers: &mut &[f64]) {
        self.visit(|number| numbers.split_off_first().copied().unwrap_or(number));
    }
}

impl<T: Real, const D: usize> Motion<T, D> for Path<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, t: Time, _: Side, wanted: Derivatives) -> Sample<T, D> {
        self.at(t, wanted).map(T::from_f64)
    }

    fn sample_all(&self, times: &[Time], wanted: Derivatives, samples: &mut [Sample<T, D>]) {
        sample_several(self, times, wanted, samples);
    }

    #[inline(always)]
    fn sample_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<T>, D>
    where
        T: Float,
    {
        let lanes = self.in_lanes(times, wanted);
        lanes.map(|lanes| Octet(lanes.0.map(T::from_f64)))
    }

    // Frames join with continuous accelerations, and ticks end with the last frame. Only a pendulum
    // that has been hidden asks for earlier times, at which the joint counts as at rest.
    fn next_kink(&self, t: f64) -> Option<f64> {
        let Piece { begin, states: [first, _], .. } = self.pieces[0];
        (t < begin && first != at_rest(first.position)).then_some(begin)
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let [begin, end] = [self.pieces[0].begin, self.pieces[1].end];
        let moving = self.pieces.iter().filter(|piece| !piece.is_still());
        let shortest = moving.map(|piece| piece.end - piece.begin).fold(f64::INFINITY, f64::min);
        Some((widths * shortest).max(0.5 * (t - begin.midpoint(end)).abs()))
    }

    // A joint that rests now does not for ever: whoever moves it wakes the pendulums on it.
    fn rest_until(&self, t: f64) -> f64 {
        let piece = &self.pieces[1];
        if piece.is_still() && piece.begin <= t { f64::INFINITY } else { t }
    }
}

#[cfg(test)]
pub(super) mod tests;
