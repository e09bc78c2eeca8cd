//! Live joints that turn: attitudes as the four numbers of a quaternion.

// Code for lanes must be compiled with the vector instructions of its caller.
#![allow(clippy::inline_always)]

use crate::error::SceneError;
use crate::sampling::live::{Course, Live, Path, Steer, sample_several};
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::{Float, Octet, Real};
use pendulum_core::time::Time;

/// The motion of a live attitude: in each frame a path φ(t) of rotation vectors relative to the
/// attitude at its beginning, where φ = 0, φ̇ = ω and φ̈ = ω̇. The frames therefore join with a
/// continuous angular acceleration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    path: Path<3>,
    /// The attitudes from which both pieces of the path turn.
    bases: [[f64; 4]; 2],
    /// The attitudes at the ends of the last two frames.
    samples: [[f64; 4]; 2],
    /// The attitude at the end of the coming frame; it counts if the path is told.
    told: [f64; 4],
}

/// Returns the product of two quaternions.
#[inline(always)]
pub(crate) fn product<L: Real>([a, b, c, d]: [L; 4], [w, x, y, z]: [L; 4]) -> [L; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

/// Returns the rotation vector of the shortest turn from `base` to `attitude`, both of length one.
fn turn([w, x, y, z]: [f64; 4], attitude: [f64; 4]) -> [f64; 3] {
    let turn = product(attitude, [w, -x, -y, -z]);
    Attitude::from_quaternion(turn).to_rotation_vector()
}

fn unit(quaternion: &[f64]) -> [f64; 4] {
    let mut copy = [0.0; 4];
    copy.copy_from_slice(quaternion);
    Attitude::from_quaternion(copy).to_quaternion()
}

/// Returns the quaternion of a rotation vector φ, [cos(φ/2), sin(φ/2)/φ φ], with its derivatives.
///
/// With s = φ²/4, both functions of φ follow from k(s) = sin(√s)/√s, an entire function: it and its
/// derivatives are sums that need no case for small turns, and converge for turns of several times
/// 2π, which no frame makes. Derivatives outside of `wanted` are zero; `near` is `true` if no turn
/// is larger than a radian.
#[inline(always)]
fn exponential<L: Real>(
    path: &Sample<L, 3>,
    wanted: Derivatives,
    near: impl Fn(L) -> bool,
) -> Sample<L, 4> {
    let (phi, rate, change) = (&path.position, &path.velocity, &path.acceleration);
    let dot = |a: &[L; 3], b: &[L; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (number, half) = (L::from_f64, L::from_f64(0.5));
    let s = number(0.25) * dot(phi, phi);
    let (s1, s2) = (half * dot(phi, rate), half * (dot(rate, rate) + dot(phi, change)));
    let curved = wanted.contains(Derivatives::ACCELERATION);
    let ([mut k, mut k1, mut k2], small) = ([1.0, 0.0, 0.0].map(number), number(0.25) - s);
    for n in (1..if near(small) { FEW } else { FACTORS.len() }).rev() {
        if n + 1 == FEW {
            // In a turn by less than a radian, further terms are below 1e-20 of the sums.
            k = small.where_positive(number(1.0), k);
            k1 = small.where_positive(number(0.0), k1);
            k2 = small.where_positive(number(0.0), k2);
        }
        // k = 1 − s/(2·3) (1 − s/(4·5) (1 − …)), and the derivatives of this product.
        let factor = number(FACTORS[n]);
        if curved {
            k2 = factor * (number(2.0) * k1 + s * k2);
        }
        [k, k1] = [number(1.0) + factor * s * k, factor * (k + s * k1)];
    }
    // cos √s = k + 2 s k′, and its derivative is −k/2.
    let mut sample = Sample::zero();
    sample.position[0] = k + number(2.0) * s * k1;
    sample.velocity[0] = number(-0.5) * k * s1;
    for d in 0..3 {
        sample.position[d + 1] = half * k * phi[d];
        sample.velocity[d + 1] = half * (k1 * s1 * phi[d] + k * rate[d]);
    }
    if curved {
        sample.acceleration[0] = number(-0.5) * (k1 * s1 * s1 + k * s2);
        for d in 0..3 {
            let across = (k2 * s1 * s1 + k1 * s2) * phi[d] + number(2.0) * k1 * s1 * rate[d];
            sample.acceleration[d + 1] = half * (across + k * change[d]);
        }
    }
    sample
}

/// The factors −1/(2n(2n + 1)) between the terms of k, and the number of terms for small turns.
const FACTORS: [f64; 24] = {
    let (mut factors, mut n) = ([0.0; 24], 1);
    while n < 24 {
        factors[n] = -1.0 / (2 * n * (2 * n + 1)) as f64;
        n += 1;
    }
    factors
};
const FEW: usize = 10;

/// Returns the quaternion of a rotation vector with its derivatives.
fn turned(path: &Sample<f64, 3>, wanted: Derivatives) -> Sample<f64, 4> {
    exponential(path, wanted, |small| 0.0 < small)
}

/// Returns the derivatives of a rotation vector that those of its quaternion need.
fn lower(wanted: Derivatives) -> Derivatives {
    let below = Derivatives::POSITION.union(Derivatives::VELOCITY);
    if wanted.contains(Derivatives::ACCELERATION) { Derivatives::ALL } else { below }
}

/// Returns a turn after an attitude.
#[inline(always)]
fn behind<L: Real>(turn: &Sample<L, 4>, base: [L; 4]) -> Sample<L, 4> {
    Sample {
        position: product(turn.position, base),
        velocity: product(turn.velocity, base),
        acceleration: product(turn.acceleration, base),
    }
}

impl Turn {
    pub(crate) fn new(t: f64, attitude: Attitude, smoothed: bool) -> Self {
        let (start, base) = (Live::new([0.0; 3]), attitude.to_quaternion());
        let path = Path::new(t, &if smoothed { start.smoothed() } else { start });
        Self { path, bases: [base; 2], samples: [base; 2], told: base }
    }

    /// Sets the attitude to rest.
    fn put(&mut self, t: f64, attitude: [f64; 4]) {
        self.path.put(t, [0.0; 3]);
        (self.bases, self.samples) = ([attitude; 2], [attitude; 2]);
    }

    /// Returns the attitude at the end of the last frame, and the state there in rotation vectors
    /// relative to it.
    fn end(&self) -> ([f64; 4], Sample<f64, 3>) {
        let end = turned(&self.path.pieces[1].states[1], Derivatives::ALL);
        let [w, x, y, z] = end.position;
        let back = [w, -x, -y, -z];
        // ω = 2ė∘e⁻¹ and ω̇ = 2ë∘e⁻¹ + 2|ė|², of which the real part does not count.
        let twice = |rate: [f64; 4]| {
            let [_, x, y, z] = product(rate, back);
            [2.0 * x, 2.0 * y, 2.0 * z]
        };
        let (velocity, acceleration) = (twice(end.velocity), twice(end.acceleration));
        let attitude = if self.path.smoothed {
            unit(&product(end.position, self.bases[1]))
        } else {
            self.samples[1]
        };
        (attitude, Sample { position: [0.0; 3], velocity, acceleration })
    }
}

impl Steer for Turn {
    fn check(&self, position: &[f64]) -> Result<(), SceneError> {
        if unit(position).iter().all(|part| part.is_finite()) {
            return Ok(());
        }
        let required = "a quaternion whose length is neither zero nor infinite";
        Err(SceneError::Setting { name: "attitude", value: position[0], required })
    }

    fn tell(&mut self, position: &[f64]) {
        (self.told, self.path.told) = (unit(position), Some([0.0; 3]));
    }

    fn place(&mut self, t: f64, position: &[f64]) {
        self.put(t, unit(position));
    }

    fn settle(&mut self, t: f64) {
        self.put(t, self.samples[1]);
        self.path.interrupt();
    }

    fn interrupt(&mut self) {
        self.path.interrupt();
    }

    fn frame(&mut self, ends: [f64; 3]) -> Course {
        let told = self.path.told.is_some();
        if !told && self.path.pieces[1].is_still() {
            return Course::Continues;
        }
        let (base, from) = self.end();
        let [before, last] = self.samples;
        let goal = if told { self.told } else { last };
        // Of both signs, the one that the shortest turn leads to.
        let dot: f64 = base.iter().zip(goal).map(|(a, b)| a * b).sum();
        let goal = if dot < 0.0 { goal.map(|part| -part) } else { goal };
        self.path.samples = if self.path.smoothed {
            [[0.0; 3], turn(base, before), turn(base, last)]
        } else {
            // The last frame has turned from `before` to `last`.
            [[0.0; 3], self.path.samples[2].map(|part| -part), [0.0; 3]]
        };
        self.path.told = told.then(|| turn(base, goal));
        let course = self.path.frame_from(ends, from);
        if course == Course::Jumps {
            self.put(ends[1], goal);
        } else {
            (self.bases, self.samples) = ([self.bases[1], base], [last, goal]);
        }
        course
    }

    fn save(&self, numbers: &mut Vec<f64>) {
        self.path.save(numbers);
        numbers.extend(self.bases.iter().chain(&self.samples).chain([&self.told]).flatten());
    }

    fn restore(&mut self, numbers: &mut &[f64]) {
        self.path.restore(numbers);
        let Self { bases, samples, told, .. } = self;
        for own in bases.iter_mut().chain(samples).chain([told]).flatten() {
            *own = numbers.split_off_first().copied().unwrap_or(*own);
        }
    }
}

impl<T: Real> Motion<T, 4> for Turn {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, t: Time, _: Side, wanted: Derivatives) -> Sample<T, 4> {
        let sample = turned(&self.path.at(t, lower(wanted)), wanted);
        behind(&sample, self.bases[self.path.piece(t)]).map(T::from_f64)
    }

    fn sample_all(&self, times: &[Time], wanted: Derivatives, samples: &mut [Sample<T, 4>]) {
        sample_several(self, times, wanted, samples);
    }

    #[inline(always)]
    fn sample_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<T>, 4>
    where
        T: Float,
    {
        let path = self.path.in_lanes(times, lower(wanted));
        let sample = exponential(&path, wanted, |small| small.0.iter().all(|&small| 0.0 < small));
        let bases = times.map(|t| self.bases[self.path.piece(t)]);
        let base = core::array::from_fn(|d| Octet(bases.map(|base| base[d])));
        behind(&sample, base).map(|lanes| Octet(lanes.0.map(T::from_f64)))
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        Motion::<T, 3>::next_kink(&self.path, t)
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        Motion::<T, 3>::longest_step(&self.path, t, widths)
    }

    fn rest_until(&self, t: f64) -> f64 {
        Motion::<T, 3>::rest_until(&self.path, t)
    }
}

#[cfg(test)]
mod tests {
    use super::{Turn, turned};
    use crate::sampling::live::tests::lanes_have_the_bits_of_single_samples;
    use crate::sampling::live::{Live, Path, Steer};
    use pendulum_core::attitude::Attitude;
    use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
    use pendulum_core::time::Time;

    const AXIS: [f64; 3] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];

    fn at<M: Motion<f64, D>, const D: usize>(motion: &M, t: f64) -> Sample<f64, D> {
        motion.sample(Time::new(t), Side::After, Derivatives::ALL)
    }

    /// Lengths of frames between 1 and 3.
    fn frames() -> [f64; 40] {
        core::array::from_fn(|k| 2.0 + (1.7 * (k * k) as f64).sin())
    }

    /// Follows attitudes, and passes each frame, its times and the turn to `check`.
    fn follow(
        smoothed: bool,
        attitude: impl Fn(f64) -> Attitude,
        mut check: impl FnMut(usize, [f64; 2], &Turn),
    ) {
        let mut turn = Turn::new(0.0, attitude(0.0), smoothed);
        turn.path.interrupted = false;
        let [mut before, mut begin] = [0.0; 2];
        for (index, length) in frames().into_iter().enumerate() {
            let end = begin + length;
            // The sign of a quaternion has no effect.
            let sign = if index % 3 == 0 { -1.0 } else { 1.0 };
            turn.tell(&attitude(end).to_quaternion().map(|part| sign * part));
            turn.frame([before, begin, end]);
            check(index, [begin, end], &turn);
            (before, begin) = (begin, end);
        }
    }

    fn tumbling(t: f64) -> Attitude {
        Attitude::from_euler("zxz", [0.3 * t, 0.8 * (0.2 * t).sin(), 0.17 * t]).unwrap()
    }

    fn apart(a: [f64; 4], b: [f64; 4]) -> f64 {
        let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
        let sign = dot.signum();
        a.iter().zip(b).map(|(a, b)| (a - sign * b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn quaternions_of_rotation_vectors_are_exact_up_to_a_full_turn_and_more() {
        for angle in [0.0, 1e-9, 0.1, 1.0, 3.0, 6.0, 12.0] {
            let position = AXIS.map(|part| angle * part);
            let sample = Sample { position, ..Sample::zero() };
            let found = turned(&sample, Derivatives::ALL).position;
            let exact = Attitude::from_rotation_vector(position).to_quaternion();
            for d in 0..4 {
                assert!((found[d] - exact[d]).abs() < 1e-13, "{angle}: {found:?} {exact:?}");
            }
        }
    }

    #[test]
    fn turns_have_the_same_bits_in_lanes() {
        // Also turns by more than a radian in a frame, beside smaller ones.
        for quick in [1.0, 4.0] {
            let attitude = |t: f64| tumbling(quick * t);
            follow(false, attitude, |_, times, turn| {
                lanes_have_the_bits_of_single_samples(turn, times);
            });
        }
    }

    #[test]
    fn frames_end_at_their_attitudes() {
        follow(false, tumbling, |_, [_, end], turn| {
            assert!(apart(at(turn, end).position, tumbling(end).to_quaternion()) < 1e-15);
        });
    }

    #[test]
    fn turning_about_an_axis_is_exact_after_three_samples() {
        // Up to 2.6 rad in a frame.
        let attitude = |t: f64| Attitude::from_axis_angle(AXIS, 0.4 * t + 0.003 * t * t);
        follow(false, attitude, |index, [begin, end], turn| {
            for part in [0.0, 0.3, 0.8] {
                let t = begin + part * (end - begin);
                let off = apart(at(turn, t).position, attitude(t).to_quaternion());
                assert!(index < 3 || off < 1e-13, "{off}");
            }
        });
    }

    #[test]
    fn rates_and_their_derivatives_are_continuous_across_frames() {
        for smoothed in [false, true] {
            let mut last: Option<Sample<f64, 4>> = None;
            follow(smoothed, tumbling, |_, [begin, end], turn| {
                let now = at(turn, begin);
                if let Some(last) = last {
                    for d in 0..4 {
                        assert!((now.position[d] - last.position[d]).abs() < 1e-14);
                        assert!((now.velocity[d] - last.velocity[d]).abs() < 1e-14);
                        assert!((now.acceleration[d] - last.acceleration[d]).abs() < 1e-13);
                    }
                }
                last = Some(at(turn, end));
            });
        }
    }

    #[test]
    fn rates_are_derivatives_and_quaternions_have_length_one() {
        follow(false, tumbling, |_, [begin, end], turn| {
            let (t, h) = (begin + 0.37 * (end - begin), 1e-4);
            let [a, b, c] = [t - h, t, t + h].map(|t| at(turn, t));
            for d in 0..4 {
                let rate = (c.position[d] - a.position[d]) / (2.0 * h);
                assert!((rate - b.velocity[d]).abs() < 1e-7);
                let change = (c.velocity[d] - a.velocity[d]) / (2.0 * h);
                assert!((change - b.acceleration[d]).abs() < 1e-7);
            }
            let length: f64 = b.position.iter().map(|part| part * part).sum();
            assert!((length - 1.0).abs() < 1e-14);
        });
    }

    #[test]
    fn smoothed_turns_about_an_axis_have_the_smoothed_angle() {
        let angle = |t: f64| (0.3 * t).sin();
        let mut path = Path::new(0.0, &Live::new([0.0]).smoothed());
        path.interrupted = false;
        let mut before = 0.0;
        follow(
            true,
            |t| Attitude::from_axis_angle(AXIS, angle(t)),
            |_, [begin, end], turn| {
                path.tell(&[angle(end)]);
                path.frame([before, begin, end]);
                before = begin;
                let t = begin + 0.4 * (end - begin);
                let exact = Attitude::from_axis_angle(AXIS, at(&path, t).position[0]);
                assert!(apart(at(turn, t).position, exact.to_quaternion()) < 1e-13);
            },
        );
    }

    #[test]
    fn a_turn_that_is_not_told_stops_at_the_last_attitude() {
        let mut stopped = Turn::new(0.0, tumbling(0.0), false);
        let mut ends = [0.0; 3];
        follow(false, tumbling, |_, [begin, end], turn| {
            (stopped, ends) = (*turn, [begin, end, end + 1.0]);
        });
        stopped.frame(ends);
        let end = at(&stopped, ends[2]);
        assert!(apart(end.position, tumbling(ends[1]).to_quaternion()) < 1e-15);
        assert_eq!([end.velocity, end.acceleration], [[0.0; 4]; 2]);
    }
}
