//! Curves through keys.

use crate::motion::analytic::{Analytic, polynomial};
use crate::motion::error::MotionError;
use crate::motion::piecewise::{Kind, checked};
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::motion::series::Series;
use crate::motion::spline::{Ends, velocities};
use crate::scalar::Real;
use crate::time::Time;

/// A curve through keys, which are values at increasing times, in metres and seconds: a cubic
/// between each key and the next. It rests before the first key and after the last.
///
/// | curve | continuous | kinks |
/// |---|---|---|
/// | [`steps`](Self::steps) | – | keys at which the value jumps |
/// | [`linear`](Self::linear) | position | keys at which the line bends |
/// | [`catmull_rom`](Self::catmull_rom), [`hermite`](Self::hermite) | velocity | keys at which the acceleration jumps |
/// | [`spline`](Self::spline), [`clamped`](Self::clamped) | acceleration | the first and the last key, unless the curve rests there |
/// | [`periodic`](Self::periodic) | acceleration | none |
///
/// [`starting`](Self::starting), [`speed`](Self::speed) and [`looped`](Self::looped) determine when
/// the curve is passed.
///
/// ```
/// use pendulum_runtime::motion::{Curve, MotionError};
/// # fn main() -> Result<(), MotionError> {
/// // A step to the right and back that takes a second, begins at t = 5.2 s and is repeated forever.
/// let step = Curve::catmull_rom(&[0.0, 0.5, 1.0], &[[0.0, 0.0], [0.3, 0.1], [0.0, 0.0]])?;
/// let step = step.starting(5.2)?.looped()?;
///
/// // Frames of a captured motion, 120 in a second, at half their speed.
/// let frames = [[0.0], [0.1], [0.3], [0.2]];
/// let times: Vec<f64> = (0..frames.len()).map(|frame| frame as f64 / 120.0).collect();
/// let captured = Curve::spline(&times, &frames)?.speed(0.5)?;
/// # let _ = (step, captured);
/// # Ok(())
/// # }
/// ```
///
/// Second differences of captured motion are noise: a spline through every second or fourth frame
/// is smoother, and lines between all frames have small jumps of the velocity instead.
///
/// # Errors
/// Every constructor returns an error if there are no keys, if the numbers of times and values
/// differ, if the times do not increase, or if a number is not finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<const D: usize> {
    pub(super) times: Vec<f64>,
    /// Coefficients of 1, u, u², u³, with the time u since the key.
    pub(super) pieces: Vec<[[f64; D]; 4]>,
    /// The value at the last key.
    pub(super) last: [f64; D],
    pub(super) kind: Kind,
    pub(super) looped: bool,
    /// The times in the range of the keys at which position, velocity or acceleration jumps.
    pub(super) kinks: Vec<f64>,
    /// The shortest time between two keys.
    pub(super) finest: f64,
}

impl<const D: usize> Curve<D> {
    /// Creates a curve that holds the value of each key until the next key, and jumps there.
    pub fn steps(times: &[f64], values: &[[f64; D]]) -> Result<Self, MotionError> {
        checked(times, values)?;
        Ok(Self::constants(times, values))
    }

    /// Creates straight lines: the velocity jumps at the keys, and the acceleration is zero between
    /// them.
    ///
    /// Accelerations alone would miss such a motion. The integrators end steps at the keys and
    /// preserve the momenta across each jump.
    pub fn linear(times: &[f64], values: &[[f64; D]]) -> Result<Self, MotionError> {
        checked(times, values)?;
        Ok(Self::lines(times, values))
    }

    /// Creates a Catmull–Rom curve. A key affects the four pieces around it.
    ///
    /// The velocity at a key is that of the parabola through the key and its neighbours; at the
    /// ends, that of the nearest parabola (Catmull and Rom 1974, for keys at unequal times).
    pub fn catmull_rom(times: &[f64], values: &[[f64; D]]) -> Result<Self, MotionError> {
        checked(times, values)?;
        let count = times.len();
        let chord = |key: usize, d: usize| {
            (values[key + 1][d] - values[key][d]) / (times[key + 1] - times[key])
        };
        let mut velocities = vec![[0.0; D]; count];
        for (key, velocity) in velocities.iter_mut().enumerate() {
            for d in 0..D {
                velocity[d] = match count {
                    1 => 0.0,
                    2 => chord(0, d),
                    _ => {
                        let middle = key.clamp(1, count - 2);
                        let (before, after) =
                            (times[middle] - times[middle - 1], times[middle + 1] - times[middle]);
                        let (left, right) = (chord(middle - 1, d), chord(middle, d));
                        let curvature = (right - left) / (before + after);
                        left + curvature
                            * (times[key] - times[middle - 1] + (times[key] - times[middle]))
                    }
                };
            }
        }
        Ok(Self::cubics(times, values, &ends_of(&velocities), Kind::Cubic))
    }

    /// Creates cubics with given velocities: those of piece k at its start and at its end are
    /// `velocities[k]`.
    ///
    /// # Errors
    /// Also if there is not one pair of velocities fewer than keys, or if a velocity is not finite.
    pub fn hermite(
        times: &[f64],
        values: &[[f64; D]],
        velocities: &[[[f64; D]; 2]],
    ) -> Result<Self, MotionError> {
        checked(times, values)?;
        if velocities.len() + 1 != times.len() {
            return Err(MotionError::Argument {
                name: "number of pairs of velocities",
                value: velocities.len() as f64,
                required: "less by one than the number of keys",
            });
        }
        let finite = |pair: &[[f64; D]; 2]| pair.iter().flatten().all(|part| part.is_finite());
        if let Some(key) = velocities.iter().position(|pair| !finite(pair)) {
            return Err(MotionError::NotFinite { key });
        }
        let mut curve = Self::cubics(times, values, velocities, Kind::Cubic);
        if curve.kinks.len() < times.len() {
            // Steps do not end at all keys, and might miss pieces.
            curve.kind = Kind::Smooth;
        }
        Ok(curve)
    }

    /// Creates a natural cubic spline, with zero acceleration at its ends. A key affects the whole
    /// curve, less with distance.
    ///
    /// The velocities at the keys solve the tridiagonal system of de Boor (1978), chapter IV.
    pub fn spline(times: &[f64], values: &[[f64; D]]) -> Result<Self, MotionError> {
        checked(times, values)?;
        Ok(Self::through(times, values, &Ends::Natural))
    }

    /// Creates a cubic spline with the velocities `first` and `last` at its ends.
    pub fn clamped(
        times: &[f64],
        values: &[[f64; D]],
        first: [f64; D],
        last: [f64; D],
    ) -> Result<Self, MotionError> {
        checked(times, values)?;
        for (key, velocity) in [(0, first), (times.len() - 1, last)] {
            if velocity.iter().any(|part| !part.is_finite()) {
                return Err(MotionError::NotFinite { key });
            }
        }
        Ok(Self::through(times, values, &Ends::Clamped(first, last)))
    }

    /// Creates a cubic spline that repeats forever without a kink, such as a walk; the first and
    /// last values must be equal.
    ///
    /// # Errors
    /// Also if there are fewer than two keys, or if the first and last values differ by more than
    /// 10⁻⁹ of the greatest value.
    pub fn periodic(times: &[f64], values: &[[f64; D]]) -> Result<Self, MotionError> {
        checked(times, values)?;
        let mut values = values.to_vec();
        let last = values.len() - 1;
        for component in 0..D {
            let largest = values.iter().map(|value| value[component].abs()).fold(0.0, f64::max);
            let [first, last] = [values[0], values[last]].map(|value| value[component]);
            if 1e-9 * largest < (last - first).abs() {
                return Err(MotionError::Open { component, first, last });
            }
        }
        values[last] = values[0];
        let mut curve = Self::through(times, &values, &Ends::Periodic).looped()?;
        curve.kinks.clear();
        Ok(curve)
    }

    fn through(times: &[f64], values: &[[f64; D]], ends: &Ends<D>) -> Self {
        Self::cubics(times, values, &ends_of(&velocities(times, values, ends)), Kind::Smooth)
    }

    /// Moves the curve in time, so that its first key is at `t`.
    ///
    /// # Errors
    /// If `t` is not finite, or so late that two keys would be at the same time.
    pub fn starting(self, t: f64) -> Result<Self, MotionError> {
        if !t.is_finite() {
            let required = "a finite time";
            return Err(MotionError::Argument { name: "start", value: t, required });
        }
        let first = self.times[0];
        self.retimed(|key| t + (key - first), 1.0)
    }

    /// Passes the curve `speed` times as fast, with its first key at the same time.
    ///
    /// # Errors
    /// If the speed is not positive and finite, or so large that two keys would be at the same
    /// time.
    pub fn speed(self, speed: f64) -> Result<Self, MotionError> {
        if !(0.0 < speed && speed.is_finite()) {
            let required = "positive and finite, 1 for the curve as it is";
            return Err(MotionError::Argument { name: "speed", value: speed, required });
        }
        let first = self.times[0];
        self.retimed(|key| first + (key - first) / speed, speed)
    }

    /// Repeats the curve forever, before its first key as well. The last key closes the loop; the
    /// seam is a kink unless it is smooth.
    ///
    /// # Errors
    /// If there are fewer than two keys.
    pub fn looped(mut self) -> Result<Self, MotionError> {
        let count = self.times.len();
        if count < 2 {
            return Err(MotionError::Argument {
                name: "number of keys",
                value: count as f64,
                required: "2 or more to repeat; the last key closes the loop",
            });
        }
        self.close_loop();
        Ok(self)
    }
}

/// Returns the velocities at both ends of each piece from the velocities at the keys.
fn ends_of<const D: usize>(velocities: &[[f64; D]]) -> Vec<[[f64; D]; 2]> {
    velocities.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

impl<T: Real, const D: usize> Motion<T, D> for Curve<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        if wanted == Derivatives::ACCELERATION && self.kind.is_straight() {
            // Zero on every line, so the piece need not be found.
            return Sample::zero();
        }
        self.at(t, side, wanted)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.next(&self.kinks, t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        Some(self.last(&self.kinks, t).unwrap_or(f64::NEG_INFINITY))
    }

    // Steps end at all kinks, but not with every method at keys without a kink.
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let bounded = self.kind == Kind::Smooth;
        Some(if bounded { self.longest_within_keys(t, widths) } else { f64::INFINITY })
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        Some(self)
    }

    fn rest_until(&self, t: f64) -> f64 {
        self.rests_until(t)
    }
}

impl<T: Real, const D: usize> Analytic<T, D> for Curve<D> {
    fn series(
        &self,
        t: Time,
        side: Side,
        component: usize,
        count: usize,
        position: &mut Series<T>,
    ) {
        polynomial(self.cubic(t, side, component), count, position);
    }

    fn next_break(&self, t: f64) -> Option<f64> {
        self.next(&self.times, t)
    }

    fn last_break(&self, t: f64) -> Option<f64> {
        self.last(&self.times, t)
    }

    fn last_kink(&self, t: f64) -> Option<f64> {
        self.last(&self.kinks, t)
    }
}
