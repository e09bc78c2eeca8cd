//! The time that one step covers.

use crate::motion::Side;
use crate::time::Time;

/// One step in time, free of kinks inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Where it starts.
    pub start: Time,
    /// Where it ends.
    pub end: Time,
    /// Its length.
    pub h: f64,
}

impl Span {
    /// The step of length `h` from `start`.
    pub fn by(start: Time, h: f64) -> Self {
        Self { start, end: start + h, h }
    }

    /// The step from `start` to exactly `end`.
    pub fn to(start: Time, end: f64) -> Self {
        Self { start, end: Time::new(end), h: -start.since(end) }
    }

    /// The time `start + c h` and the side from which a kink there is seen: a stage looks into the step.
    #[inline]
    pub fn at(&self, c: f64) -> (Time, Side) {
        if c < 0.5 {
            (self.start + c * self.h, Side::After)
        } else if c < 1.0 {
            (self.start + c * self.h, Side::Before)
        } else {
            (self.end, Side::Before)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Span;
    use crate::motion::Side;
    use crate::time::Time;

    #[test]
    fn stages_look_into_the_step() {
        let span = Span::to(Time::new(0.1), 0.3);
        assert_eq!(span.at(0.0), (Time::new(0.1), Side::After));
        assert_eq!(span.at(0.4).1, Side::After);
        assert_eq!(span.at(0.6).1, Side::Before);
        assert_eq!(span.at(1.0), (Time::new(0.3), Side::Before));
    }

    #[test]
    fn the_end_is_exact_and_the_length_sees_both_words() {
        let start = Time::new(1e9) + 1e-9;
        let span = Span::to(start, 1e9 + 1.0);
        assert_eq!(span.end.to_f64(), 1e9 + 1.0);
        assert_eq!(span.end.low(), 0.0);
        assert_eq!(span.h, 1.0 - 1e-9);
    }
}
