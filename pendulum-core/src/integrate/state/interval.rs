//! The time interval of a step.

// The steps of `Picard` are inlined into code that is compiled for several instruction sets.
#![allow(clippy::inline_always)]

use crate::motion::Side;
use crate::scalar::Float;
use crate::scalar::exact::two_sum;
use crate::time::Time;

/// The time interval of a step, without kinks inside.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepInterval {
    /// The time at the start of the step.
    pub start: Time,
    /// The time at the end of the step.
    pub end: Time,
    /// The length of the step in seconds.
    pub h: f64,
    /// The rounding error of `h`.
    pub low: f64,
}

impl StepInterval {
    /// Creates the step of length `h` from `start`.
    pub fn by(start: Time, h: f64) -> Self {
        Self { start, end: start + h, h, low: 0.0 }
    }

    /// Creates the step from `start` to exactly `end`.
    pub fn to(start: Time, end: f64) -> Self {
        let h = -start.since(end);
        let (difference, error) = two_sum(end, -start.to_f64());
        Self { start, end: Time::new(end), h, low: (difference - h) + (error - start.low()) }
    }

    /// Returns the length in the scalar of a system, with both words.
    #[inline(always)]
    pub fn length<T: Float>(&self) -> T {
        T::from_f64(self.h) + T::from_f64(self.low)
    }

    /// Returns the fraction of the step that has passed at `t`: 0 at the start, 1 at the end.
    pub fn fraction<T: Float>(&self, t: f64) -> T {
        // Lengths near the ends of the range of numbers are scaled to its middle, because some
        // scalars have a shorter range.
        let exponent = (self.h.to_bits() >> 52) & 0x7ff;
        let scale = if exponent.abs_diff(1023) < 64 {
            1.0
        } else {
            f64::from_bits((2046 - exponent.min(2045)) << 52)
        };
        let number = |x: f64| T::from_f64(scale * x);
        // The difference of the high words and its rounding error. A short scalar cannot represent
        // the times themselves.
        let passed = Time::new(t) + -self.start.to_f64();
        (number(passed.to_f64()) + (number(passed.low()) - number(self.start.low())))
            / (number(self.h) + number(self.low))
    }

    /// Returns the side of a kink at the start on which the step lies.
    #[inline]
    pub fn side(&self) -> Side {
        if self.h < 0.0 { Side::Before } else { Side::After }
    }

    /// Returns the time `start + c h`, and the side of a kink at that time that lies within the
    /// step.
    #[inline]
    pub fn at(&self, c: f64) -> (Time, Side) {
        // Back in time, the start of the step is its later end.
        let side = if (c < 0.5) == (self.h < 0.0) { Side::Before } else { Side::After };
        (if c < 1.0 { self.start + c * self.h } else { self.end }, side)
    }
}

#[cfg(test)]
mod tests {
    use super::StepInterval;
    use crate::motion::Side;
    use crate::scalar::{DoubleDouble, Float, Real};
    use crate::time::Time;

    #[test]
    fn stages_look_into_the_step() {
        let interval = StepInterval::to(Time::new(0.1), 0.3);
        assert_eq!(interval.at(0.0), (Time::new(0.1), Side::After));
        assert_eq!(interval.at(0.4).1, Side::After);
        assert_eq!(interval.at(0.6).1, Side::Before);
        assert_eq!(interval.at(1.0), (Time::new(0.3), Side::Before));
        let back = StepInterval::to(Time::new(0.3), 0.1);
        assert_eq!(back.at(0.0), (Time::new(0.3), Side::Before));
        assert_eq!(back.at(0.4).1, Side::Before);
        assert_eq!(back.at(0.6).1, Side::After);
        assert_eq!(back.at(1.0), (Time::new(0.1), Side::After));
    }

    #[test]
    fn the_part_that_has_passed_is_as_good_as_the_scalar() {
        let interval = StepInterval::by(Time::new(1e9) + 1e-9, 0.25);
        assert!((interval.fraction::<f32>(1e9 + 0.125) - 0.5).abs() < 1e-7);
        let exact =
            (DoubleDouble::from(0.125) - DoubleDouble::from(1e-9)) / DoubleDouble::from(0.25);
        assert!((interval.fraction::<DoubleDouble>(1e9 + 0.125) - exact).abs().to_f64() < 1e-31);
        // Lengths that the scalar cannot represent.
        for h in [5e-324, 1e-310, 1e-300, 1e-40, 1e40, 1e300, -1e-300] {
            let half = StepInterval::by(Time::new(0.0), h).fraction::<f32>(h / 2.0);
            assert!(half == if h == 5e-324 { 0.0 } else { 0.5 }, "{h:e}: {half}");
            assert_eq!(
                StepInterval::by(Time::new(0.0), h).fraction::<DoubleDouble>(h).to_f64(),
                1.0,
                "{h:e}"
            );
        }
        // A difference that one word cannot represent.
        let exact = DoubleDouble::from(1.0) - DoubleDouble::from(1e-17);
        assert!(
            (StepInterval::by(Time::new(1e-17), 1.0).fraction::<DoubleDouble>(1.0) - exact)
                .abs()
                .to_f64()
                < 1e-31
        );
    }

    #[test]
    fn the_end_is_exact_and_the_length_sees_both_words() {
        let start = Time::new(1e9) + 1e-9;
        let interval = StepInterval::to(start, 1e9 + 1.0);
        assert_eq!(interval.end.to_f64(), 1e9 + 1.0);
        assert_eq!(interval.end.low(), 0.0);
        assert_eq!(interval.h, 1.0 - 1e-9);
        let interval = StepInterval::to(Time::new(0.1), 1.0);
        assert_eq!((interval.start + interval.h) + interval.low, interval.end);
        assert_eq!((interval.h, interval.low), (0.9, -2.7755575615628914e-17));
    }
}
