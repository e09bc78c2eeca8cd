//! Motions at other times: when they begin, how fast they pass, and how often.

use crate::motion::error::MotionError;
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// Any motion as a clip, with a start, a speed and a loop: x(s (t − t₀)).
///
/// Velocities are multiplied by the speed s, accelerations by its square, and kinks are at the
/// times at which they are passed. A clip has no Taylor series; [`Curve`](super::Curve), which has
/// methods of the same names, keeps its own.
///
/// Each sample asks the motion for its next kink, in order to take the right side of it. Put
/// [`Attenuated`](super::Attenuated), which has to search for its kinks, around a clip, not into it.
///
/// ```
/// use pendulum_runtime::motion::{Clip, MotionError, Sinusoid, Turning};
/// # fn main() -> Result<(), MotionError> {
/// // A nod of half a second, every half second from t = 3 s on at 80 % of its speed.
/// let nod = Turning::new([1.0, 0.0, 0.0], Sinusoid::new([0.3], 12.6, [0.0]));
/// let nods = Clip::new(nod).looped(0.5)?.starting(3.0)?.speed(0.8)?;
/// # let _ = nods;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip<M> {
    motion: M,
    start: f64,
    speed: f64,
    /// The period in the time of the motion, infinite without a loop.
    period: f64,
    /// `true` if the seam of the loop is a kink.
    seam: bool,
}

impl<M> Clip<M> {
    /// Creates a clip that is the motion itself.
    pub const fn new(motion: M) -> Self {
        Self { motion, start: 0.0, speed: 1.0, period: f64::INFINITY, seam: false }
    }

    /// Moves the clip in time, so that the time 0 of the motion is at `t`.
    ///
    /// # Errors
    /// If `t` is not finite.
    pub fn starting(self, t: f64) -> Result<Self, MotionError> {
        if !t.is_finite() {
            let required = "a finite time";
            return Err(MotionError::Argument { name: "start", value: t, required });
        }
        Ok(Self { start: t, ..self })
    }

    /// Passes the motion `speed` times as fast, with its time 0 at the same time.
    ///
    /// # Errors
    /// If the speed is not positive and finite.
    pub fn speed(self, speed: f64) -> Result<Self, MotionError> {
        if !(0.0 < speed && speed.is_finite()) {
            let required = "positive and finite, 1 for the motion as it is";
            return Err(MotionError::Argument { name: "speed", value: speed, required });
        }
        Ok(Self { speed, ..self })
    }

    /// Repeats the motion from its time 0 to `period` forever, before its start as well. The seam
    /// is a kink unless it is smooth.
    ///
    /// # Errors
    /// If the period is not positive and finite.
    pub fn looped<const D: usize>(self, period: f64) -> Result<Self, MotionError>
    where
        M: Motion<f64, D>,
    {
        if !(0.0 < period && period.is_finite()) {
            let required = "positive and finite to repeat";
            return Err(MotionError::Argument { name: "period", value: period, required });
        }
        let end = self.motion.sample(Time::new(period), Side::Before, Derivatives::ALL);
        let start = self.motion.sample(Time::new(0.0), Side::After, Derivatives::ALL);
        let parts =
            |sample: &Sample<f64, D>| [sample.position, sample.velocity, sample.acceleration];
        let smooth = parts(&end).iter().zip(&parts(&start)).all(|(a, b)| {
            let size = a.iter().chain(b).fold(0.0f64, |size, value| size.max(value.abs()));
            (0..D).all(|axis| (a[axis] - b[axis]).abs() <= 1e-9 * size)
        });
        Ok(Self { period, seam: !smooth, ..self })
    }

    fn is_looped(&self) -> bool {
        self.period < f64::INFINITY
    }

    /// Returns the rounding errors of times of the motion at `t`.
    fn slack(&self, t: f64) -> f64 {
        let period = if self.is_looped() { self.period } else { 0.0 };
        4.0 * f64::EPSILON * (self.speed * (t.abs() + self.start.abs()) + period)
    }

    /// Returns the time of the motion and the number of periods before it; at a kink of any period,
    /// the time of the kink itself.
    fn own<T: Real, const D: usize>(&self, t: Time, side: Side) -> (Time, f64)
    where
        M: Motion<T, D>,
    {
        let since = t + -self.start;
        let whole = if self.speed == 1.0 { since } else { Time::new(self.speed * since.to_f64()) };
        let slack = self.slack(t.to_f64());
        let (mut own, mut turns) = (whole, 0.0);
        if self.is_looped() {
            turns = (whole.to_f64() / self.period).floor();
            own = whole + -(turns * self.period);
            let begins = own.since(0.0) <= slack;
            if begins || own.since(self.period).abs() <= slack {
                let seam = if begins { turns } else { turns + 1.0 };
                return match side {
                    Side::After => (Time::new(0.0), seam),
                    Side::Before => (Time::new(self.period), seam - 1.0),
                };
            }
        }
        let near = self.motion.next_kink(own.to_f64() - slack);
        match near.filter(|&kink| own.since(kink).abs() <= slack) {
            Some(kink) => (Time::new(kink), turns),
            None => (own, turns),
        }
    }

    /// Returns the time at which a time of the motion is passed.
    fn when(&self, own: f64, turns: f64) -> f64 {
        if !self.is_looped() {
            return self.start + own / self.speed;
        }
        // The end of a period has the bits of the beginning of the next.
        let (own, turns) = if own == self.period { (0.0, turns + 1.0) } else { (own, turns) };
        self.start + (own + turns * self.period) / self.speed
    }
}

impl<T: Real, const D: usize, M: Motion<T, D>> Motion<T, D> for Clip<M> {
    const HAS: Derivatives = M::HAS;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        let (own, _) = self.own(t, side);
        let mut sample = self.motion.sample(own, side, wanted);
        let speed = T::from_f64(self.speed);
        sample.velocity = sample.velocity.map(|part| part * speed);
        sample.acceleration = sample.acceleration.map(|part| part * speed * speed);
        sample
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let (own, turns) = self.own(Time::new(t), Side::After);
        let mut from = own.to_f64();
        // A kink may be equal to `t` up to rounding.
        for turn in [turns, turns + 1.0, turns + 2.0] {
            while from < self.period {
                let inner = self.motion.next_kink(from).filter(|&kink| kink < self.period);
                let Some(kink) = inner.or(self.seam.then_some(self.period)) else { break };
                let at = self.when(kink, turn);
                if t < at {
                    return Some(at);
                }
                from = kink;
            }
            if !self.is_looped() {
                return None;
            }
            from = 0.0;
        }
        None
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        let (own, turns) = self.own(Time::new(t), Side::Before);
        let none = f64::NEG_INFINITY;
        let first = if self.is_looped() { 0.0 } else { none };
        let mut to = own.to_f64();
        for turn in [turns, turns - 1.0, turns - 2.0] {
            while first < to {
                let inner = self.motion.kink_before(to)?;
                let kink = if first < inner { inner } else { first };
                if kink == none || kink == first && !self.seam {
                    break;
                }
                let at = self.when(kink, turn);
                if at < t {
                    return Some(at);
                }
                to = kink;
            }
            if !self.is_looped() {
                break;
            }
            to = self.period;
        }
        Some(none)
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let (own, _) = self.own(Time::new(t), Side::After);
        let mut longest = self.motion.longest_step(own.to_f64(), widths)?;
        if self.is_looped() {
            // A step may go beyond the seam, in both directions.
            for end in [0.0, self.period] {
                longest = longest.min(self.motion.longest_step(end, widths)?);
            }
        }
        Some(longest / self.speed)
    }

    fn rest_until(&self, t: f64) -> f64 {
        let (own, turns) = self.own(Time::new(t), Side::After);
        let until = self.motion.rest_until(own.to_f64());
        if until == f64::INFINITY && (!self.is_looped() || self.motion.rest_until(0.0) == until) {
            return until;
        }
        // Limited to the current period; callers repeat the call at its end.
        let at = self.when(until.min(self.period), turns) - self.slack(t) / self.speed;
        if t < at { at } else { t }
    }
}

#[cfg(test)]
mod tests {
    use super::Clip;
    use crate::motion::{Curve, Derivatives, Function, Motion, Sample, Side, Sinusoid, Still};
    use crate::time::Time;

    fn at<const D: usize>(motion: &impl Motion<f64, D>, t: f64, side: Side) -> Sample<f64, D> {
        motion.sample(Time::new(t), side, Derivatives::ALL)
    }

    fn kinks(motion: &impl Motion<f64, 1>, from: f64, to: f64) -> Vec<f64> {
        let next = |t: &f64| motion.next_kink(*t).filter(|&kink| kink <= to);
        core::iter::successors(next(&from), next).collect()
    }

    fn zigzag() -> Curve<1> {
        Curve::linear(&[0.0, 0.3, 0.8, 1.1], &[[0.0], [1.0], [-0.5], [0.7]]).unwrap()
    }

    #[test]
    fn a_clip_is_the_motion_of_another_time() {
        let swing = Sinusoid::new([0.7], 3.0, [0.4]);
        let clip = Clip::new(swing).starting(5.2).unwrap().speed(0.4).unwrap();
        // A sinusoid of another frequency and phase.
        let exact = Sinusoid::new([0.7], 1.2, [0.4 - 1.2 * 5.2]);
        for k in -20..40 {
            let t = 0.37 * f64::from(k);
            let (found, exact) = (at(&clip, t, Side::After), at(&exact, t, Side::After));
            for (a, b) in [
                (found.position, exact.position),
                (found.velocity, exact.velocity),
                (found.acceleration, exact.acceleration),
            ] {
                assert!((a[0] - b[0]).abs() < 1e-13, "{t}");
            }
        }
    }

    #[test]
    fn a_clip_of_a_curve_is_the_curve_at_other_times() {
        let (clip, curve) = (Clip::new(zigzag()), zigzag());
        let clip = clip.looped(1.1).unwrap().speed(1.7).unwrap().starting(-2.3).unwrap();
        let curve = curve.speed(1.7).unwrap().starting(-2.3).unwrap().looped().unwrap();
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} is not {b}");
        let (found, exact) = (kinks(&clip, -9.0, 90.0), kinks(&curve, -9.0, 90.0));
        assert_eq!(found.len(), exact.len());
        for (&kink, &other) in found.iter().zip(&exact) {
            close(kink, other);
            // Both sides of each kink.
            for side in [Side::Before, Side::After] {
                let (a, b) = (at(&clip, kink, side), at(&curve, other, side));
                close(a.position[0], b.position[0]);
                close(a.velocity[0], b.velocity[0]);
            }
        }
        for pair in found.windows(2) {
            let between = 0.5 * (pair[0] + pair[1]);
            assert_eq!(Motion::<f64, 1>::kink_before(&clip, between), Some(pair[0]));
            close(Motion::<f64, 1>::kink_before(&clip, pair[1]).unwrap(), pair[0]);
            close(
                at(&clip, between, Side::After).position[0],
                at(&curve, between, Side::After).position[0],
            );
        }
    }

    #[test]
    fn a_smooth_seam_is_no_kink() {
        let wave = Sinusoid::new([0.7], core::f64::consts::TAU, [0.4]);
        let clip = Clip::new(wave).looped(1.0).unwrap();
        assert_eq!(kinks(&clip, -5.0, 5.0), [0.0f64; 0]);
        assert_eq!(Motion::<f64, 1>::kink_before(&clip, 5.0), Some(f64::NEG_INFINITY));
        // Half a period begins upwards and ends downwards.
        let clip = Clip::new(wave).looped(0.5).unwrap().starting(0.125).unwrap();
        assert_eq!(kinks(&clip, -0.5, 1.0), [-0.375, 0.125, 0.625]);
        for (side, sign) in [(Side::Before, -1.0), (Side::After, 1.0)] {
            let (clip, wave) = (at(&clip, 100.125, side), at(&wave, 0.0, side));
            assert!((clip.velocity[0] - sign * wave.velocity[0]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_clip_rests_when_its_motion_does() {
        let hop = Curve::linear(&[0.0, 1.0, 2.0, 3.0], &[[0.0], [0.0], [1.0], [1.0]]).unwrap();
        let clip = Clip::new(hop).starting(10.0).unwrap().speed(2.0).unwrap();
        let rest = |clip: &Clip<Curve<1>>, t| Motion::<f64, 1>::rest_until(clip, t);
        let near = |a: f64, b: f64| assert!(a <= b && b - a < 1e-12, "{a} is not {b}");
        near(rest(&clip, 0.0), 10.5);
        assert_eq!((rest(&clip, 10.7), rest(&clip, 11.0)), (10.7, f64::INFINITY));
        let looped = clip.looped(3.0).unwrap();
        near(rest(&looped, 10.1), 10.5);
        near(rest(&looped, 11.1), 11.5);
        near(rest(&looped, 31.1), 31.5);
        let still = Clip::new(Still::new([2.0])).looped(1.0).unwrap();
        assert_eq!(Motion::<f64, 1>::rest_until(&still, 0.3), f64::INFINITY);
    }

    #[test]
    fn steps_are_as_long_as_the_motion_allows() {
        let kick = Function::new(|t: f64| [t]).resolution(0.01).unwrap();
        let clip = Clip::new(kick).speed(4.0).unwrap();
        assert_eq!(Motion::<f64, 1>::longest_step(&clip, 0.3, 8.0), Some(0.02));
        let unknown = Clip::new(Function::new(|t: f64| [t])).looped(1.0).unwrap();
        assert_eq!(Motion::<f64, 1>::longest_step(&unknown, 0.3, 8.0), None);
        // A narrow piece at the end is seen from the beginning of the loop.
        let keys = Curve::spline(&[0.0, 1.0, 2.0, 2.01], &[[0.0], [1.0], [0.0], [0.0]]).unwrap();
        let looped = Clip::new(keys).looped(2.01).unwrap();
        assert!(Motion::<f64, 1>::longest_step(&looped, 0.1, 1.0).unwrap() < 0.011);
    }

    #[test]
    fn times_that_are_none_are_refused() {
        let clip = Clip::new(Sinusoid::new([0.7], 3.0, [0.4]));
        for wrong in [f64::NAN, f64::INFINITY] {
            assert!(clip.starting(wrong).is_err() && clip.speed(wrong).is_err());
            assert!(clip.looped(wrong).is_err());
        }
        for wrong in [0.0, -1.0] {
            assert!(clip.speed(wrong).is_err() && clip.looped(wrong).is_err());
        }
        // Times far beyond the precision of a period, and none at all.
        let looped = Clip::new(zigzag()).looped(1.1).unwrap();
        for t in [1e300, -1e300, f64::INFINITY, f64::NAN] {
            assert!(Motion::<f64, 1>::next_kink(&looped, t).is_none_or(|kink| t < kink));
            let _ = at(&looped, t, Side::Before);
        }
    }
}
