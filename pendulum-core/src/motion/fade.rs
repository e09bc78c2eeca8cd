//! Motions that pass into others.

use crate::motion::error::MotionError;
use crate::motion::prescribed::{Motion, earlier};
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// A motion that passes into another one: a cross-fade of two clips.
///
/// The weight of the second motion is u³ (10 − 15 u + 6 u²), with u from 0 to 1 during the fade.
/// Its first two derivatives are zero at both ends, so that the fade adds no kinks to those of the
/// motions. A fade has no Taylor series.
///
/// ```
/// use pendulum_runtime::motion::{Clip, Curve, Fade, MotionError, Sinusoid};
/// # fn main() -> Result<(), MotionError> {
/// let walk = Curve::periodic(&[0.0, 0.5, 1.0], &[[0.0, 1.0], [0.1, 1.05], [0.0, 1.0]])?;
/// let stand = Sinusoid::new([0.0, 0.005], 2.0, [0.0, 0.0]).about([0.0, 1.0]);
/// // Who walks comes to a stand between 4 s and 4.3 s.
/// let hip = Fade::new(Clip::new(walk).speed(1.2)?, stand, 4.0, 0.3)?;
/// # let _ = hip;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fade<A, B> {
    from: A,
    to: B,
    start: f64,
    length: f64,
    /// The sign of the second quaternion in fades of attitudes, whose sums are normalized.
    sign: Option<f64>,
}

impl<A, B> Fade<A, B> {
    /// Creates a motion that is `from` until the time `start`, and `to` from `seconds` later on.
    ///
    /// # Errors
    /// If the start is not finite, or if the duration is not positive and finite.
    pub fn new(from: A, to: B, start: f64, seconds: f64) -> Result<Self, MotionError> {
        if !start.is_finite() {
            let required = "a finite time";
            return Err(MotionError::Argument { name: "start", value: start, required });
        }
        if !(0.0 < seconds && seconds.is_finite()) {
            let required = "positive and finite";
            return Err(MotionError::Argument { name: "duration", value: seconds, required });
        }
        Ok(Self { from, to, start, length: seconds, sign: None })
    }

    /// Creates a fade of two attitudes, for `driven` rotations: unit quaternions, of which the
    /// second has the sign that is nearer at the start. A quaternion that changes its sign at a kink,
    /// as at the seam of a loop of a whole turn, is the same attitude, and the fade goes on.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub fn attitudes(from: A, to: B, start: f64, seconds: f64) -> Result<Self, MotionError>
    where
        A: Motion<f64, 4>,
        B: Motion<f64, 4>,
    {
        let fade = Self::new(from, to, start, seconds)?;
        let t = Time::new(start);
        let from = fade.from.sample(t, Side::After, Derivatives::POSITION).position;
        let to = fade.to.sample(t, Side::After, Derivatives::POSITION).position;
        let apart = dot(&from, &to) < 0.0;
        Ok(Self { sign: Some(if apart { -1.0 } else { 1.0 }), ..fade })
    }

    fn end(&self) -> f64 {
        self.start + self.length
    }
}

fn dot<T: Real, const D: usize>(a: &[T; D], b: &[T; D]) -> T {
    (0..D).fold(T::from_f64(0.0), |sum, d| sum + a[d] * b[d])
}

/// Returns −1 if the quaternions of a motion change their sign at an odd number of kinks between the
/// time `start` and a side of `t`, else 1.
fn flipped<T: Real, const D: usize>(
    motion: &impl Motion<T, D>,
    start: f64,
    t: Time,
    side: Side,
) -> T {
    // Motions may take times within rounding of a kink for the kink: there, `t` itself decides.
    let near = 1e-9 * (1.0 + t.to_f64().abs());
    let next = |kink: &f64| motion.next_kink(*kink).filter(|&kink| t.since(kink) > -near);
    core::iter::successors(next(&start), next).fold(T::from_f64(1.0), |sign, kink| {
        let at = |t, side| motion.sample(t, side, Derivatives::POSITION).position;
        let before = at(Time::new(kink), Side::Before);
        let after =
            if near < t.since(kink) { at(Time::new(kink), Side::After) } else { at(t, side) };
        dot(&before, &after).where_positive(sign, -sign)
    })
}

/// Divides a vector by its length n, with q·q̈ = −|q̇|².
fn normalized<T: Real, const D: usize>(sum: &Sample<T, D>) -> Sample<T, D> {
    let length = dot(&sum.position, &sum.position).sqrt();
    let position = sum.position.map(|part| part / length);
    let rate = dot(&position, &sum.velocity);
    let velocity = core::array::from_fn(|d| (sum.velocity[d] - rate * position[d]) / length);
    let change = dot(&position, &sum.acceleration) + length * dot(&velocity, &velocity);
    let acceleration = core::array::from_fn(|d| {
        (sum.acceleration[d] - (rate + rate) * velocity[d] - change * position[d]) / length
    });
    Sample { position, velocity, acceleration }
}

impl<T: Real, const D: usize, A: Motion<T, D>, B: Motion<T, D>> Motion<T, D> for Fade<A, B> {
    const HAS: Derivatives = A::HAS.shared(B::HAS);

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        let sign = T::from_f64(self.sign.unwrap_or(1.0));
        let u = t.since(self.start) / self.length;
        if u <= 0.0 {
            return self.from.sample(t, side, wanted);
        }
        if 1.0 <= u {
            return self.to.sample(t, side, wanted).map(|part| sign * part);
        }
        let asked = wanted.with_lower();
        let mut from = self.from.sample(t, side, asked);
        let to = self.to.sample(t, side, asked).map(|part| sign * part);
        if self.sign.is_some() {
            let flip =
                flipped(&self.from, self.start, t, side) * flipped(&self.to, self.start, t, side);
            from = from.map(|part| flip * part);
        }
        let rest = 1.0 - u;
        let weight = T::from_f64(u * u * u * (10.0 + u * (6.0 * u - 15.0)));
        let rate = T::from_f64(30.0 * u * u * rest * rest / self.length);
        let change = 60.0 * u * rest * (rest - u) / (self.length * self.length);
        let (change, twice) = (T::from_f64(change), rate + rate);
        let mut sum = from;
        for d in 0..D {
            let [x, v, a] = [
                to.position[d] - from.position[d],
                to.velocity[d] - from.velocity[d],
                to.acceleration[d] - from.acceleration[d],
            ];
            sum.position[d] += weight * x;
            sum.velocity[d] += weight * v + rate * x;
            sum.acceleration[d] += weight * a + twice * v + change * x;
        }
        if self.sign.is_some() {
            sum = normalized(&sum);
        }
        let zero = [T::from_f64(0.0); D];
        let kept = |order, values| if wanted.contains(order) { values } else { zero };
        Sample {
            position: kept(Derivatives::POSITION, sum.position),
            velocity: kept(Derivatives::VELOCITY, sum.velocity),
            acceleration: kept(Derivatives::ACCELERATION, sum.acceleration),
        }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let from = self.from.next_kink(t).filter(|&kink| kink < self.end());
        let later = if self.start < t { t } else { self.start };
        earlier(from, self.to.next_kink(later))
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        let to = self.to.kink_before(t)?;
        let from = self.from.kink_before(if t < self.end() { t } else { self.end() })?;
        Some(if self.start < to && from < to { to } else { from })
    }

    // The fade itself is as wide as it lasts.
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let distance = (t - (self.start + 0.5 * self.length)).abs();
        let own = (widths * self.length).max(0.5 * distance);
        let motions = self.from.longest_step(t, widths)?.min(self.to.longest_step(t, widths)?);
        Some(own.min(motions))
    }

    fn rest_until(&self, t: f64) -> f64 {
        if self.end() <= t {
            return self.to.rest_until(t);
        }
        let rests = self.from.rest_until(t);
        if self.start <= t { t } else { rests.min(self.start) }
    }
}

#[cfg(test)]
mod tests {
    use super::Fade;
    use crate::attitude::{Attitude, Rates};
    use crate::motion::{
        Attitudes, Clip, Curve, Derivatives, Function, Motion, Sample, Side, Sinusoid, Still,
        Turning,
    };
    use crate::scalar::Real;
    use crate::time::Time;

    fn at<const D: usize>(motion: &impl Motion<f64, D>, t: f64, side: Side) -> Sample<f64, D> {
        motion.sample(Time::new(t), side, Derivatives::ALL)
    }

    fn swing() -> Sinusoid<1> {
        Sinusoid::new([0.7], 3.0, [0.4])
    }

    #[test]
    fn a_fade_is_each_motion_outside_of_it() {
        let fade = Fade::new(swing(), Still::new([2.0]), 1.0, 0.5).unwrap();
        for t in [-3.0, 0.99, 1.0] {
            assert_eq!(at(&fade, t, Side::After), at(&swing(), t, Side::After));
        }
        for t in [1.5, 1.51, 9.0] {
            assert_eq!(at(&fade, t, Side::Before), at(&Still::new([2.0]), t, Side::After));
        }
        // In the middle both count the same.
        let middle = 0.5 * (2.0 + at(&swing(), 1.25, Side::After).position[0]);
        assert!((at(&fade, 1.25, Side::After).position[0] - middle).abs() < 1e-15);
    }

    /// Checks derivatives by central differences, across the ends of the fade, too.
    fn consistent<const D: usize>(fade: &impl Motion<f64, D>) {
        let h = 1e-5;
        for k in 0..=140 {
            let t = 0.9 + 0.005 * f64::from(k);
            let [low, here, high] = [t - h, t, t + h].map(|t| at(fade, t, Side::After));
            for d in 0..D {
                let velocity = (high.position[d] - low.position[d]) / (2.0 * h);
                let acceleration = (high.velocity[d] - low.velocity[d]) / (2.0 * h);
                assert!((velocity - here.velocity[d]).abs() < 1e-6, "{t}");
                // The third derivative jumps at the ends.
                assert!((acceleration - here.acceleration[d]).abs() < 2e-2, "{t}");
                let inside = [1.0, 1.5].iter().all(|end: &f64| 2.0 * h < (t - end).abs());
                assert!(!inside || (acceleration - here.acceleration[d]).abs() < 1e-5, "{t}");
            }
            for wanted in [Derivatives::VELOCITY, Derivatives::ACCELERATION] {
                let some: Sample<f64, D> = fade.sample(Time::new(t), Side::After, wanted);
                let velocity = wanted == Derivatives::VELOCITY;
                assert_eq!(some.position, [0.0; D]);
                assert_eq!(some.velocity, if velocity { here.velocity } else { [0.0; D] });
                assert_eq!(some.acceleration, if velocity { [0.0; D] } else { here.acceleration });
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_position_and_continuous() {
        let path = Function::new(|t: f64| [1.0 - t * t]).velocity(|t: f64| [-2.0 * t]);
        let path = path.acceleration(|_: f64| [-2.0]);
        consistent(&Fade::new(swing(), path, 1.0, 0.5).unwrap());
    }

    #[test]
    fn attitudes_stay_of_unit_length() {
        let start = Attitude::from_euler("zxz", [0.3, 1.0, 2.0]).unwrap();
        let nod = Turning::new([1.0, -2.0, 2.0], swing()).starting_at(start);
        let roll = Turning::new([0.0, 0.0, 1.0], Sinusoid::new([4.0], 1.0, [0.0]));
        let fade = Fade::attitudes(nod, roll, 1.0, 0.5).unwrap();
        consistent(&fade);
        for k in 0..=100 {
            let Sample { position: q, velocity: v, .. } =
                at(&fade, 0.9 + 0.007 * f64::from(k), Side::After);
            let dot = |a: [f64; 4], b: [f64; 4]| (0..4).map(|d| a[d] * b[d]).sum::<f64>();
            assert!((dot(q, q) - 1.0).abs() < 1e-15 && dot(q, v).abs() < 1e-14);
        }
    }

    /// A whole turn is a quaternion of the opposite sign, so that a loop of it jumps at its seam.
    #[test]
    fn attitudes_of_loops_fade_over_their_seams() {
        let turn = |rate: f64| {
            let path = Function::new(move |t: f64| [rate * t]).velocity(move |_: f64| [rate]);
            let path = path.acceleration(|_: f64| [0.0]);
            Turning::new([0.0, 0.0, 1.0], path)
        };
        let tau = core::f64::consts::TAU;
        let spin = Clip::new(turn(tau)).looped(1.0).unwrap();
        let still = Still::new(Attitude::from_axis_angle([0.0, 0.0, 1.0], 0.3).to_quaternion());
        for (start, length) in [(0.8, 0.4), (2.9, 0.25), (0.95, 1.4)] {
            let there = Fade::attitudes(spin.clone(), still, start, length).unwrap();
            let back = Fade::attitudes(still, spin.clone(), start, length).unwrap();
            // The same without a loop: the quaternions of the turn do not jump.
            let whole = Fade::attitudes(turn(tau), still, start, length).unwrap();
            let whole_back = Fade::attitudes(still, turn(tau), start, length).unwrap();
            for k in 0..=200 {
                for side in [Side::Before, Side::After] {
                    let t = start - 0.1 + (length + 0.2) * f64::from(k) / 200.0;
                    for [a, b] in [
                        [at(&there, t, side), at(&whole, t, side)],
                        [at(&back, t, side), at(&whole_back, t, side)],
                    ] {
                        let sign = a.position[0].signum() * b.position[0].signum();
                        for d in 0..4 {
                            assert!((a.position[d] - sign * b.position[d]).abs() < 1e-12, "{t}");
                            assert!((a.velocity[d] - sign * b.velocity[d]).abs() < 1e-10, "{t}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn an_attitude_fades_the_shorter_way() {
        let from = Attitude::from_axis_angle([0.0, 1.0, 0.0], 0.2);
        let to = Attitude::from_axis_angle([0.0, 1.0, 0.0], 0.6);
        for sign in [-1.0, 1.0] {
            let still = |attitude: Attitude, sign: f64| {
                Still::new(attitude.to_quaternion().map(|part| sign * part))
            };
            let fade = Fade::attitudes(still(from, 1.0), still(to, sign), 0.0, 1.0).unwrap();
            let middle = at(&fade, 0.5, Side::After);
            let attitude = Attitude::from_quaternion(middle.position);
            let (axis, angle) = attitude.to_axis_angle();
            assert!((axis[1] - 1.0).abs() < 1e-15 && (angle - 0.4).abs() < 1e-15);
            let [x, speed, z] =
                Rates::from_derivative(attitude, middle.velocity).in_space(attitude);
            // 4 ẇ tan(Δ/4) with ẇ = 15/8 and the angle Δ = 0.4 between both.
            assert!((speed - 7.5 * Real::tan(0.1)).abs() < 1e-14, "{speed}");
            assert!(x.abs() < 1e-15 && z.abs() < 1e-15);
            assert_eq!(Attitude::from_quaternion(at(&fade, 2.0, Side::After).position), to);
        }
    }

    #[test]
    fn kinks_are_those_of_the_motion_that_counts() {
        let zigzag = |offset: f64| {
            let times: Vec<f64> = (0..10).map(|key| offset + f64::from(key)).collect();
            let values: Vec<[f64; 1]> = (0..10).map(|key| [f64::from(key % 2)]).collect();
            Curve::linear(&times, &values).unwrap()
        };
        let fade = Fade::new(zigzag(0.0), zigzag(0.5), 2.5, 1.5).unwrap();
        let next = |t: &f64| Motion::<f64, 1>::next_kink(&fade, *t);
        let found: Vec<f64> = core::iter::successors(next(&-1.0), next).collect();
        assert_eq!(found, [0.0, 1.0, 2.0, 3.0, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5]);
        for pair in found.windows(2) {
            assert_eq!(Motion::<f64, 1>::kink_before(&fade, pair[1]), Some(pair[0]));
        }
        assert_eq!(Motion::<f64, 1>::kink_before(&fade, 0.0), Some(f64::NEG_INFINITY));
        assert_eq!(Motion::<f64, 1>::kink_before(&fade, 99.0), Some(9.5));
    }

    #[test]
    fn a_fade_rests_and_is_stepped_as_its_motions() {
        let still = Attitudes::slerp(&[0.0], &[Attitude::identity()]).unwrap();
        let fade = Fade::attitudes(still.clone(), still, 3.0, 0.5).unwrap();
        let rest = |t| Motion::<f64, 4>::rest_until(&fade, t);
        assert_eq!([1.0, 3.2, 3.5].map(rest), [3.0, 3.2, f64::INFINITY]);
        let longest = |t| Motion::<f64, 4>::longest_step(&fade, t, 0.1).unwrap();
        assert!((longest(3.2) - 0.05).abs() < 1e-15 && (longest(1.25) - 1.0).abs() < 1e-15);
        let unknown = Fade::new(Function::new(|t: f64| [t]), swing(), 0.0, 1.0).unwrap();
        assert_eq!(Motion::<f64, 1>::longest_step(&unknown, 0.0, 1.0), None);
        assert_eq!(<Fade<Sinusoid<1>, Still<1>> as Motion<f64, 1>>::HAS, Derivatives::ALL);
    }

    #[test]
    fn times_that_are_none_are_refused() {
        let fade = |start, seconds| Fade::new(swing(), swing(), start, seconds).is_err();
        assert!(fade(f64::NAN, 1.0) && fade(f64::INFINITY, 1.0) && fade(0.0, 0.0));
        assert!(fade(0.0, -1.0) && fade(0.0, f64::NAN) && fade(0.0, f64::INFINITY));
    }
}
