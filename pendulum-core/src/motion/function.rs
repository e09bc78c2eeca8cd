//! Motions given by functions of time.

use crate::motion::error::MotionError;
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;
use core::fmt;

/// A motion given by functions of the time in seconds: its position and, optionally, its
/// derivatives.
///
/// A motion without an acceleration cannot drive a system whose equations contain the acceleration:
/// this is a compile-time error.
///
/// ```
/// use pendulum_runtime::motion::Function;
/// let lift = Function::new(|t| [0.0, 0.5 * t * t]).velocity(|t| [0.0, t]).acceleration(|_| [0.0, 1.0]);
/// ```
///
/// A derivative with another number of components than the position does not compile:
///
/// ```compile_fail,E0080
/// # use pendulum_runtime::motion::{Derivatives, Function, Motion, Sample, Side};
/// let lift = Function::new(|t| [0.0, t]).velocity(|_| [1.0]);
/// let start = pendulum_runtime::time::Time::new(0.0);
/// let _: Sample<f64, 2> = lift.sample(start, Side::After, Derivatives::ALL);
/// ```
///
/// A method evaluates the functions a few times in each step, and cannot detect changes in between:
/// it would miss a kick of ten milliseconds while the pendulum rests and the steps are long.
/// Without [`resolution`](Self::resolution), steps are at most a fiftieth of the interval of
/// [`solve`](crate::integrate::solve), or one second in an
/// [`Integrator`](crate::integrate::Integrator), which has no end time.
///
/// ```
/// use pendulum_runtime::motion::{Function, MotionError};
/// # fn main() -> Result<(), MotionError> {
/// let push = |t: f64| (-((t - 40.0) / 0.01).powi(2)).exp();
/// let kick = Function::new(move |t| [0.1 * push(t)]).resolution(0.01)?;
/// # let _ = kick;
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Function<X, V = Missing, A = Missing> {
    position: X,
    velocity: V,
    acceleration: A,
    kinks: Vec<f64>,
    resolution: Option<f64>,
}

/// In place of a derivative that is missing.
type Missing = fn(f64) -> [f64; 0];

impl<X> Function<X> {
    /// Creates a motion with a position only.
    pub fn new<const D: usize>(position: X) -> Self
    where
        X: Fn(f64) -> [f64; D],
    {
        let missing: Missing = |_| [];
        let (velocity, acceleration) = (missing, missing);
        Self { position, velocity, acceleration, kinks: Vec::new(), resolution: None }
    }
}

impl<X, V, A> Function<X, V, A> {
    /// Sets the velocity.
    pub fn velocity<const D: usize, F: Fn(f64) -> [f64; D]>(
        self,
        velocity: F,
    ) -> Function<X, F, A> {
        let Self { position, acceleration, kinks, resolution, .. } = self;
        Function { position, velocity, acceleration, kinks, resolution }
    }

    /// Sets the acceleration.
    pub fn acceleration<const D: usize, F: Fn(f64) -> [f64; D]>(
        self,
        acceleration: F,
    ) -> Function<X, V, F> {
        let Self { position, velocity, kinks, resolution, .. } = self;
        Function { position, velocity, acceleration, kinks, resolution }
    }

    /// Sets the times at which a derivative jumps. At these times the functions return the values
    /// after the jump.
    ///
    /// The value before a jump is taken one unit in the last place earlier.
    #[must_use]
    pub fn kinks(mut self, kinks: &[f64]) -> Self {
        self.kinks = kinks.iter().copied().filter(|kink| kink.is_finite()).collect();
        self.kinks.sort_by(f64::total_cmp);
        self
    }
}

impl<X, V, A> Function<X, V, A> {
    /// Sets the shortest time in seconds within which the motion changes: w for exp(−((t −
    /// t₀)/w)²).
    ///
    /// It limits adaptive steps: the distance between samples of a step is at most 1.5 w, so the
    /// steps of [`Picard`](crate::integrate::Picard) are at most 16.4 w long, those of
    /// [`Dop853`](crate::integrate::Dop853) at most 5.6 w. It does not change fixed steps.
    ///
    /// # Errors
    /// If the time is not positive or not finite.
    pub fn resolution(self, seconds: f64) -> Result<Self, MotionError> {
        if 0.0 < seconds && seconds < f64::INFINITY {
            Ok(Self { resolution: Some(seconds), ..self })
        } else {
            Err(MotionError::Argument {
                name: "resolution",
                value: seconds,
                required: "a positive number of seconds, the shortest time in which the motion changes",
            })
        }
    }
}

impl<X, V, A> fmt::Debug for Function<X, V, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Function")
            .field("kinks", &self.kinks)
            .field("resolution", &self.resolution)
            .finish_non_exhaustive()
    }
}

impl<T: Real, X, V, A, const D: usize, const VD: usize, const AD: usize> Motion<T, D>
    for Function<X, V, A>
where
    X: Fn(f64) -> [f64; D],
    V: Fn(f64) -> [f64; VD],
    A: Fn(f64) -> [f64; AD],
{
    const HAS: Derivatives = {
        let velocity = if exists(VD, D) { Derivatives::VELOCITY } else { Derivatives::NONE };
        let acceleration =
            if exists(AD, D) { Derivatives::ACCELERATION } else { Derivatives::NONE };
        Derivatives::POSITION.union(velocity).union(acceleration)
    };

    #[inline]
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        let exact = t.to_f64();
        let at_kink = side == Side::Before
            && self.kinks.binary_search_by(|kink| kink.total_cmp(&exact)).is_ok();
        let t = if at_kink { exact.next_down() } else { exact };
        let mut sample = Sample::zero();
        if wanted.contains(Derivatives::POSITION) {
            sample.position = (self.position)(t).map(T::from_f64);
        }
        if wanted.contains(Derivatives::VELOCITY) {
            put(&mut sample.velocity, (self.velocity)(t));
        }
        if wanted.contains(Derivatives::ACCELERATION) {
            put(&mut sample.acceleration, (self.acceleration)(t));
        }
        sample
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let index = self.kinks.partition_point(|&kink| kink <= t);
        self.kinks.get(index).copied()
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        let index = self.kinks.partition_point(|&kink| kink < t);
        Some(self.kinks[..index].last().copied().unwrap_or(f64::NEG_INFINITY))
    }

    fn longest_step(&self, _: f64, widths: f64) -> Option<f64> {
        self.resolution.map(|resolution| widths * resolution)
    }
}

/// Returns `true` if a derivative of `count` components is not missing.
const fn exists(count: usize, components: usize) -> bool {
    assert!(
        count == 0 || count == components,
        "a derivative has another number of components than the position"
    );
    0 < count
}

/// Writes a derivative, unless it is missing.
fn put<T: Real, const D: usize, const K: usize>(components: &mut [T; D], values: [f64; K]) {
    if const { exists(K, D) } {
        for d in 0..D {
            components[d] = T::from_f64(values[d]);
        }
    }
}
