//! Motions of attitudes through keys.

use crate::attitude::{Attitude, product};
use crate::motion::error::MotionError;
use crate::motion::piecewise::checked;
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// A motion of an attitude through keys, as the four numbers of its unit quaternion. Between two
/// keys it takes the shorter of the two turns. It rests before the first key and after the last.
///
/// | motion | continuous | kinks |
/// |---|---|---|
/// | [`spline`](Self::spline) | angular acceleration | the first and the last key |
/// | [`slerp`](Self::slerp) | attitude | all keys |
///
/// An attitude that rests is [`Still`](super::Still), one that turns about an axis
/// [`Turning`](super::Turning).
///
/// ```
/// use pendulum_runtime::attitude::Attitude;
/// use pendulum_runtime::motion::{Attitudes, MotionError};
/// # fn main() -> Result<(), MotionError> {
/// let up = Attitude::identity();
/// let nod = Attitude::from_axis_angle([1.0, 0.0, 0.0], 0.5);
/// let shake = Attitude::from_axis_angle([0.0, 0.0, 1.0], -0.3);
/// let head = Attitudes::spline(&[0.0, 0.4, 1.0, 1.5], &[up, nod, shake, up])?;
/// # let _ = head;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// Every constructor returns an error if there are no keys, if the numbers of times and attitudes
/// differ, if the times do not increase, or if a number is not finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Attitudes {
    times: Vec<f64>,
    /// The quaternions of the keys, with signs by which the motion is continuous.
    keys: Vec<[f64; 4]>,
    /// The turn since the key along the axes of the solid, as a rotation vector: the coefficients
    /// of u, u² and u³ with the time u since the key.
    pieces: Vec<[[f64; 3]; 3]>,
    smooth: bool,
    /// The shortest time between two keys.
    finest: f64,
}

/// The limit on the sweeps over the keys. Thirty are sufficient for turns of a quarter between
/// keys.
const SWEEPS: usize = 1000;

impl Attitudes {
    /// Creates turns at constant rates about fixed axes (spherical linear interpolation): the
    /// angular velocity jumps at the keys.
    pub fn slerp(times: &[f64], attitudes: &[Attitude]) -> Result<Self, MotionError> {
        let mut motion = Self::through(times, attitudes)?;
        motion.smooth = false;
        Ok(motion)
    }

    /// Creates a curve whose angular acceleration is continuous, and zero at its ends. A key
    /// affects the whole curve, less with distance.
    ///
    /// Rotation vectors from key to key are cubics of time (Park and Ravani 1997). Their angular
    /// velocities at the keys solve the equations of continuity together, as those of a natural
    /// spline, because solving them from key to key would magnify errors. The curve does not depend
    /// on the axes of space.
    ///
    /// # Errors
    /// Also if the equations have no solution close to a spline: turns between keys of almost π may
    /// be too fast for keys at very unequal times.
    pub fn spline(times: &[f64], attitudes: &[Attitude]) -> Result<Self, MotionError> {
        let mut motion = Self::through(times, attitudes)?;
        let count = motion.pieces.len();
        if count < 2 {
            return Ok(motion);
        }
        let chords = motion.pieces.clone();
        let length = |piece: usize| times[piece + 1] - times[piece];
        let mut velocities: Vec<[f64; 3]> = Vec::with_capacity(count + 1);
        for key in 0..=count {
            velocities.push(chords[key.min(count - 1)][0]);
        }
        let fastest =
            chords.iter().flat_map(|chord| chord[0]).fold(0.0, |a: f64, b| a.max(b.abs()));
        let mut change = f64::INFINITY;
        // Gauss and Seidel: each sweep makes the accelerations at one key after the other agree.
        for _ in 0..SWEEPS {
            let before = change;
            change = 0.0;
            for key in 0..=count {
                let (mut jump, mut slope) = ([0.0; 3], 0.0);
                if key < count {
                    let h = length(key);
                    let piece = cubic(chords[key][0], h, velocities[key], velocities[key + 1]);
                    jump = piece[1].map(|part| -2.0 * part);
                    slope += 4.0 / h;
                }
                if 0 < key {
                    let h = length(key - 1);
                    let piece = cubic(chords[key - 1][0], h, velocities[key - 1], velocities[key]);
                    let acceleration = acceleration(&Turn::at(&piece, h));
                    jump = [0, 1, 2].map(|k| jump[k] + acceleration[k]);
                    slope += 4.0 / h;
                }
                for k in 0..3 {
                    let step = jump[k] / slope;
                    velocities[key][k] -= step;
                    change = if step.abs() <= change { change } else { step.abs() };
                }
            }
            // Rounding errors keep the change from falling below some units in the last place.
            let settled = before <= change && change <= 1e-12 * fastest;
            let lost = !change.is_finite() || 1e3 * fastest < change;
            if change <= f64::EPSILON * fastest || settled || lost {
                break;
            }
        }
        if change.is_nan() || 1e-12 * fastest < change {
            return Err(MotionError::Argument {
                name: "change of the angular velocity in the last iteration",
                value: change,
                required: "rounding; add keys, or keys at more equal times",
            });
        }
        for (key, piece) in motion.pieces.iter_mut().enumerate() {
            *piece = cubic(chords[key][0], length(key), velocities[key], velocities[key + 1]);
        }
        Ok(motion)
    }

    /// Returns turns at constant rates.
    fn through(times: &[f64], attitudes: &[Attitude]) -> Result<Self, MotionError> {
        let mut keys: Vec<[f64; 4]> = attitudes.iter().map(|key| key.to_quaternion()).collect();
        checked(times, &keys)?;
        for key in 1..keys.len() {
            let cosine: f64 = (0..4).map(|k| keys[key - 1][k] * keys[key][k]).sum();
            if cosine < 0.0 {
                keys[key] = keys[key].map(|part| -part);
            }
        }
        let finest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let mut pieces = Vec::with_capacity(keys.len() - 1);
        for (pair, time) in keys.windows(2).zip(times.windows(2)) {
            let [w, x, y, z] = pair[0];
            let turn = product([w, -x, -y, -z], pair[1]);
            let vector = Attitude::from_quaternion(turn).to_rotation_vector();
            let zero = [0.0; 3];
            pieces.push([vector.map(|part| part / (time[1] - time[0])), zero, zero]);
        }
        let times = times.to_vec();
        Ok(Self { times, keys, pieces, smooth: true, finest })
    }

    /// Returns the kinks, in order.
    fn kinks(&self) -> &[f64] {
        if self.pieces.is_empty() { &[] } else { &self.times }
    }

    /// Returns `true` if a key is a kink.
    fn is_kink(&self, key: usize) -> bool {
        !self.smooth || key == 0 || key == self.pieces.len()
    }
}

/// Returns the coefficients of u, u² and u³ of a rotation vector that begins at zero with the
/// angular velocity `first` and reaches `chord` times `h` with the angular velocity `last` after
/// the time `h`.
fn cubic(chord: [f64; 3], h: f64, first: [f64; 3], last: [f64; 3]) -> [[f64; 3]; 3] {
    let last = rate(chord.map(|part| part * h), last);
    let parts = [0, 1, 2].map(|k| {
        let (start, end) = (first[k] - chord[k], last[k] - chord[k]);
        [first[k], -(2.0 * start + end) / h, (start + end) / (h * h)]
    });
    [0, 1, 2].map(|order| parts.map(|part| part[order]))
}

/// Returns the rate of a rotation vector `r` by which a solid has the angular velocity `omega`
/// along its axes: ω + ½ r × ω + k r × (r × ω).
fn rate(r: [f64; 3], omega: [f64; 3]) -> [f64; 3] {
    let half = 0.5 * dot(r, r).sqrt();
    let [value, slope, _] = sinc_of_square(half);
    let once = cross(r, omega);
    let twice = cross(r, once);
    let factor = -0.5 * slope / value;
    [0, 1, 2].map(|k| omega[k] + 0.5 * once[k] + factor * twice[k])
}

/// A turn since a key: the quaternion and its derivatives.
struct Turn {
    position: [f64; 4],
    velocity: [f64; 4],
    acceleration: [f64; 4],
}

impl Turn {
    /// Evaluates the exponential function of half a rotation vector: (cos x, ½ r sinc x) with
    /// x = |r|/2, whose derivatives are those of functions of x², which have no singularity.
    fn at(&[a, b, c]: &[[f64; 3]; 3], u: f64) -> Self {
        let value = [0, 1, 2].map(|k| u * (a[k] + u * (b[k] + u * c[k])));
        let velocity = [0, 1, 2].map(|k| a[k] + u * (2.0 * b[k] + u * (3.0 * c[k])));
        let acceleration = [0, 1, 2].map(|k| 2.0 * b[k] + u * (6.0 * c[k]));
        let first = 0.5 * dot(value, velocity);
        let second = 0.5 * (dot(velocity, velocity) + dot(value, acceleration));
        let half = 0.5 * dot(value, value).sqrt();
        let [sinc, slope, curvature] = sinc_of_square(half);
        let rate = slope * first;
        let change = curvature * first * first + slope * second;
        let vector = |of: &dyn Fn(usize) -> f64| [0, 1, 2].map(|k| 0.5 * of(k));
        let [x, y, z] = vector(&|k| sinc * value[k]);
        let [dx, dy, dz] = vector(&|k| rate * value[k] + sinc * velocity[k]);
        let [ddx, ddy, ddz] =
            vector(&|k| change * value[k] + 2.0 * rate * velocity[k] + sinc * acceleration[k]);
        Self {
            position: [Real::cos(half), x, y, z],
            velocity: [-0.5 * sinc * first, dx, dy, dz],
            acceleration: [-0.5 * (slope * first * first + sinc * second), ddx, ddy, ddz],
        }
    }
}

/// Returns the angular acceleration along the axes of the solid, the vector of 2 q̄∘q̈.
fn acceleration(turn: &Turn) -> [f64; 3] {
    let [w, x, y, z] = turn.position;
    let [_, x, y, z] = product([w, -x, -y, -z], turn.acceleration);
    [2.0 * x, 2.0 * y, 2.0 * z]
}

/// Returns sinc x and its first and second derivative with respect to x².
///
/// From the equation of the spherical Bessel functions: −(sinc + sinc″)/4 and
/// (sinc + 2 sinc″ + sinc⁗)/32 with derivatives by x.
fn sinc_of_square(x: f64) -> [f64; 3] {
    let [value, second, fourth] = [0, 2, 4].map(|order| x.sinc(order));
    [value, -0.25 * (value + second), (value + 2.0 * second + fourth) / 32.0]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl<T: Real> Motion<T, 4> for Attitudes {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, 4> {
        let passed = self.times.partition_point(|&key| match side {
            Side::After => 0.0 <= t.since(key),
            Side::Before => 0.0 < t.since(key),
        });
        let mut sample = Sample::zero();
        let piece = passed.checked_sub(1).filter(|&piece| piece < self.pieces.len());
        let Some(piece) = piece else {
            if wanted.contains(Derivatives::POSITION) {
                let key = if passed == 0 { 0 } else { self.pieces.len() };
                sample.position = self.keys[key].map(T::from_f64);
            }
            return sample;
        };
        let turn = Turn::at(&self.pieces[piece], t.since(self.times[piece]));
        let since = |part| product(self.keys[piece], part).map(T::from_f64);
        if wanted.contains(Derivatives::POSITION) {
            sample.position = since(turn.position);
        }
        if wanted.contains(Derivatives::VELOCITY) {
            sample.velocity = since(turn.velocity);
        }
        if wanted.contains(Derivatives::ACCELERATION) {
            sample.acceleration = since(turn.acceleration);
        }
        sample
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let from = self.kinks().partition_point(|&key| key <= t);
        (from..self.kinks().len()).find(|&key| self.is_kink(key)).map(|key| self.times[key])
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        let count = self.kinks().partition_point(|&key| key < t);
        let last = (0..count).rev().find(|&key| self.is_kink(key));
        Some(last.map_or(f64::NEG_INFINITY, |key| self.times[key]))
    }

    // Steps end at all kinks, but not at keys without a kink.
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let within = self.times[0] <= t && t <= self.times[self.pieces.len()];
        Some(if self.smooth && within { widths * self.finest } else { f64::INFINITY })
    }

    fn rest_until(&self, t: f64) -> f64 {
        let rests = |piece: &[[f64; 3]; 3]| piece.iter().flatten().all(|&part| part == 0.0);
        let from = self.times.partition_point(|&key| key <= t).saturating_sub(1);
        let moving = (from..self.pieces.len()).find(|&piece| !rests(&self.pieces[piece]));
        match moving {
            None => f64::INFINITY,
            Some(piece) if t < self.times[piece] => self.times[piece],
            Some(_) => t,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Attitudes;
    use crate::attitude::{Attitude, Rates};
    use crate::motion::{Derivatives, Motion, MotionError, Sample, Side};
    use crate::time::Time;

    const TIMES: [f64; 6] = [0.25, 0.5, 1.25, 1.75, 3.0, 3.5];

    fn keys() -> [Attitude; 6] {
        let turns = [
            [0.0, 0.0, 0.0],
            [0.4, 0.1, -0.3],
            [1.0, -0.5, 0.2],
            [2.5, 0.3, 1.2],
            [-2.0, 1.0, 0.5],
            [0.1, 0.2, 3.0],
        ];
        turns.map(Attitude::from_rotation_vector)
    }

    fn at(motion: &Attitudes, t: f64, side: Side) -> Sample<f64, 4> {
        motion.sample(Time::new(t), side, Derivatives::ALL)
    }

    fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
        (0..4).map(|k| a[k] * b[k]).sum()
    }

    fn motions() -> [Attitudes; 2] {
        [Attitudes::slerp(&TIMES, &keys()).unwrap(), Attitudes::spline(&TIMES, &keys()).unwrap()]
    }

    #[test]
    fn values_are_unit_quaternions_with_their_identities() {
        for motion in motions() {
            for k in 0..400 {
                let sample = at(&motion, 0.2 + f64::from(k) / 120.0, Side::After);
                let Sample { position: q, velocity: v, acceleration: a } = sample;
                assert!((dot(q, q) - 1.0).abs() < 9e-16, "{k}");
                let speed = dot(v, v);
                assert!(dot(q, v).abs() < 1e-15 * (1.0 + speed.sqrt()), "{k}");
                let scale = 1.0 + speed + dot(a, a).sqrt();
                assert!((dot(q, a) + speed).abs() < 4e-15 * scale, "{k}");
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        for motion in motions() {
            for k in 0..60 {
                let t = 0.26 + f64::from(k) / 19.0;
                let h = 1e-3;
                let near =
                    [-2.0, -1.0, 1.0, 2.0].map(|step| at(&motion, t + step * h, Side::After));
                if TIMES.iter().any(|key| (key - t).abs() < 3.0 * h) {
                    continue;
                }
                let sample = at(&motion, t, Side::After);
                for d in 0..4 {
                    let slope = |of: fn(&Sample<f64, 4>) -> &[f64; 4]| {
                        let [a, b, c, e] = near.each_ref().map(|sample| of(sample)[d]);
                        (a - 8.0 * b + 8.0 * c - e) / (12.0 * h)
                    };
                    let velocity = slope(|sample| &sample.position);
                    assert!((velocity - sample.velocity[d]).abs() < 1e-8, "{t}");
                    let acceleration = slope(|sample| &sample.velocity);
                    assert!((acceleration - sample.acceleration[d]).abs() < 1e-7, "{t}");
                }
            }
        }
    }

    #[test]
    fn keys_are_met_by_the_shorter_turn() {
        for motion in motions() {
            for (&t, key) in TIMES.iter().zip(keys()) {
                for side in [Side::Before, Side::After] {
                    let cosine = dot(at(&motion, t, side).position, key.to_quaternion());
                    assert!((cosine.abs() - 1.0).abs() < 1e-15, "{t}");
                }
            }
        }
        let slerp = &motions()[0];
        for piece in 0..5 {
            let middle = 0.5 * (TIMES[piece] + TIMES[piece + 1]);
            let ends = [TIMES[piece], TIMES[piece + 1]].map(|t| at(slerp, t, Side::After).position);
            let middle = at(slerp, middle, Side::After).position;
            assert!((dot(ends[0], middle) - dot(middle, ends[1])).abs() < 1e-15);
            assert!(0.7 < dot(ends[0], middle));
        }
    }

    #[test]
    fn a_spline_has_continuous_angular_acceleration() {
        let motion = &motions()[1];
        let zero = Derivatives::ALL;
        for &t in &TIMES[1..5] {
            let [before, after] =
                [Side::Before, Side::After].map(|side| motion.sample(Time::new(t), side, zero));
            let (before, after): (Sample<f64, 4>, Sample<f64, 4>) = (before, after);
            for d in 0..4 {
                assert!((before.position[d] - after.position[d]).abs() < 1e-15, "{t}");
                assert!((before.velocity[d] - after.velocity[d]).abs() < 1e-14, "{t}");
                assert!((before.acceleration[d] - after.acceleration[d]).abs() < 1e-11, "{t}");
            }
        }
        // Without angular acceleration at the ends: q̈ = −|q̇|² q.
        for (t, side) in [(TIMES[0], Side::After), (TIMES[5], Side::Before)] {
            let Sample { position: q, velocity: v, acceleration: a } = at(motion, t, side);
            for d in 0..4 {
                assert!((a[d] + dot(v, v) * q[d]).abs() < 1e-11, "{t}");
            }
        }
        let kinks = |t| Motion::<f64, 4>::next_kink(motion, t);
        assert_eq!([kinks(0.0), kinks(0.25), kinks(3.5)], [Some(0.25), Some(3.5), None]);
        assert_eq!(Motion::<f64, 4>::kink_before(motion, 3.5), Some(0.25));
    }

    #[test]
    fn turns_about_one_axis_are_a_natural_spline_of_the_angle() {
        let angles = [0.0, 0.8, 0.3, 1.9, 1.0, 3.5];
        let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
        let turned = angles.map(|angle| Attitude::from_axis_angle(axis, angle));
        let motion = Attitudes::spline(&TIMES, &turned).unwrap();
        let angle = crate::motion::Curve::spline(&TIMES, &angles.map(|angle| [angle])).unwrap();
        for k in 0..60 {
            let t = 0.3 + f64::from(k) / 20.0;
            let sample = at(&motion, t, Side::After);
            let exact: Sample<f64, 1> = angle.sample(Time::new(t), Side::After, Derivatives::ALL);
            let attitude = Attitude::from_axis_angle(axis, exact.position[0]);
            let cosine = dot(sample.position, attitude.to_quaternion());
            assert!((cosine.abs() - 1.0).abs() < 1e-14, "{t}");
            let own = Attitude::from_quaternion(sample.position);
            let rates = Rates::from_derivative(own, sample.velocity).in_body(own);
            for d in 0..3 {
                assert!((rates[d] - axis[d] * exact.velocity[0]).abs() < 1e-12, "{t}");
            }
        }
    }

    #[test]
    fn a_spline_does_not_depend_on_the_axes_of_space() {
        let turn = Attitude::from_euler("zyx", [0.3, 1.0, -2.0]).unwrap();
        let turned = Attitudes::spline(&TIMES, &keys().map(|key| turn * key)).unwrap();
        for t in [0.3, 0.9, 1.5, 2.2, 3.3] {
            let found = at(&turned, t, Side::After).position;
            let own = Attitude::from_quaternion(at(&motions()[1], t, Side::After).position);
            assert!((dot(found, (turn * own).to_quaternion()).abs() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn slerps_turn_at_constant_rates_and_tell_their_kinks() {
        let motion = &motions()[0];
        let mut kinks = Vec::new();
        let mut t = 0.0;
        while let Some(kink) = Motion::<f64, 4>::next_kink(motion, t) {
            kinks.push(kink);
            t = kink;
        }
        assert_eq!(kinks, TIMES);
        let rates = |t: f64| {
            let sample = at(motion, t, Side::After);
            let own = Attitude::from_quaternion(sample.position);
            Rates::from_derivative(own, sample.velocity).in_body(own)
        };
        for d in 0..3 {
            assert!((rates(0.6)[d] - rates(1.2)[d]).abs() < 1e-14);
        }
    }

    #[test]
    fn an_attitude_rests_before_and_after_its_keys() {
        for motion in motions() {
            for t in [-1.0, 0.2, 3.6, 1e9] {
                let sample = at(&motion, t, Side::After);
                assert_eq!((sample.velocity, sample.acceleration), ([0.0; 4], [0.0; 4]));
            }
            assert_eq!(Motion::<f64, 4>::rest_until(&motion, 0.0), 0.25);
            assert_eq!(Motion::<f64, 4>::rest_until(&motion, 1.0), 1.0);
            assert_eq!(Motion::<f64, 4>::rest_until(&motion, 3.5), f64::INFINITY);
        }
        let one = Attitudes::spline(&[1.0], &keys()[..1]).unwrap();
        assert_eq!(Motion::<f64, 4>::next_kink(&one, 0.0), None);
        assert_eq!(at(&one, 5.0, Side::After).position, [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn keys_that_are_none_are_refused() {
        assert!(matches!(
            Attitudes::spline(&[], &[]),
            Err(MotionError::Argument { name: "number of keys", .. })
        ));
        let nan = Attitude::from_quaternion([0.0; 4]);
        assert_eq!(
            Attitudes::slerp(&[0.0, 1.0], &[keys()[0], nan]),
            Err(MotionError::NotFinite { key: 1 })
        );
        assert_eq!(
            Attitudes::slerp(&[1.0, 1.0], &keys()[..2]),
            Err(MotionError::NotIncreasing { key: 1, time: 1.0 })
        );
    }

    #[test]
    fn half_turns_at_unequal_times_are_continuous_or_refused() {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8], [0.0, 0.8, -0.6]];
        let mut attitude = Attitude::identity();
        let mut keys = vec![attitude];
        for k in 0..8 {
            attitude = attitude * Attitude::from_axis_angle(axes[k % 4], 3.1);
            keys.push(attitude);
        }
        let times = [0.0, 1.0, 1.01, 2.0, 2.5, 2.51, 4.0, 9.0, 9.001];
        match Attitudes::spline(&times, &keys) {
            Err(error) => assert!(error.to_string().contains("add keys"), "{error}"),
            Ok(motion) => {
                for &t in &times[1..8] {
                    let [a, b] = [Side::Before, Side::After].map(|side| at(&motion, t, side));
                    for d in 0..4 {
                        let size = 1.0 + a.acceleration[d].abs();
                        let apart = (a.acceleration[d] - b.acceleration[d]).abs();
                        assert!(apart < 1e-6 * size, "{t} {a:?} {b:?}");
                    }
                }
            }
        }
    }
}
