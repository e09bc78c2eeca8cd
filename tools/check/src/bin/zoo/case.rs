//! A problem: a system, a start and an interval, independent of their types.

use crate::random::Random;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use std::time::Duration;

/// A method under test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// The method chosen by `solve`.
    Default,
    /// `Picard`.
    Picard,
    /// `Taylor`.
    Taylor,
    /// `Dop853`.
    Dop853,
    /// `Rodas4`.
    Rodas4,
    /// `Dprkn12`.
    Dprkn12,
}

impl Method {
    /// All methods, in the order of the tables.
    pub(crate) const ALL: [Self; 6] =
        [Self::Default, Self::Picard, Self::Taylor, Self::Dop853, Self::Rodas4, Self::Dprkn12];

    /// Returns the smallest tolerance at which the method is measured. At smaller tolerances,
    /// methods of low order take millions of steps.
    pub(crate) fn least(self, scalar: Scalar) -> f64 {
        match self {
            Self::Rodas4 => 1e-9,
            Self::Dop853 if scalar == Scalar::Wide => 1e-18,
            _ => 0.0,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Picard => "Picard",
            Self::Taylor => "Taylor",
            Self::Dop853 => "Dop853",
            Self::Rodas4 => "Rodas4",
            Self::Dprkn12 => "Dprkn12",
        }
    }
}

/// The scalar of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    F32,
    F64,
    Wide,
}

impl Scalar {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Wide => "dd",
        }
    }

    pub(crate) fn epsilon(self) -> f64 {
        match self {
            Self::F32 => f64::from(f32::EPSILON),
            Self::F64 => f64::EPSILON,
            Self::Wide => DoubleDouble::EPSILON.to_f64(),
        }
    }

    /// Returns the range of tolerances.
    pub(crate) fn tolerances(self) -> (f64, f64) {
        match self {
            Self::F32 => (30.0 * self.epsilon(), 1e-3),
            Self::F64 => (1e-12, 1e-3),
            Self::Wide => (1e-26, 1e-6),
        }
    }

    /// Returns the nearest number of this type.
    pub(crate) fn round(self, x: f64) -> f64 {
        if self == Self::F32 { f64::from(x as f32) } else { x }
    }
}

/// A state, with coordinates before velocities.
pub(crate) type State = Vec<DoubleDouble>;

/// The result of an integration.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// The states at the output times, followed by the state at the end.
    pub(crate) states: Vec<State>,
    pub(crate) time: Duration,
    /// The numbers of steps and evaluations, and the chosen method.
    pub(crate) stats: String,
}

/// Settings for the reference only, because they use knowledge of the motion.
#[derive(Clone, Debug)]
pub(crate) struct Guide {
    /// The longest step.
    pub(crate) max_step: f64,
    /// The times at which steps end.
    pub(crate) stops: Vec<f64>,
    /// The smallest tolerance possible with the numbers of the problem.
    pub(crate) least: f64,
}

impl Guide {
    pub(crate) const FREE: Self = Self { max_step: 1e300, stops: Vec::new(), least: 0.0 };

    pub(crate) fn max_step(max_step: f64) -> Self {
        Self { max_step, ..Self::FREE }
    }

    pub(crate) fn between(&self, start: f64, end: f64) -> Vec<f64> {
        self.stops.iter().copied().filter(|stop| start < *stop && *stop < end).collect()
    }
}

/// The largest number of steps of a run.
pub(crate) const MOST: u64 = 2_000_000;

/// A problem, independent of its types.
pub(crate) trait Case {
    /// Returns the applicable methods.
    fn methods(&self, scalar: Scalar) -> &'static [Method];

    /// Returns the end of the interval, which begins at zero.
    fn end(&self) -> f64;

    /// Returns the start, with coordinates before velocities.
    fn start(&self) -> Vec<f64>;

    /// Describes the parameters and the motion, so that the run can be repeated.
    fn describe(&self) -> String;

    /// Runs a method with `rtol` and `atol` equal to the tolerance. Returns the states at `times`
    /// and at the end.
    fn run(
        &self,
        method: Method,
        scalar: Scalar,
        tolerance: f64,
        times: &[f64],
    ) -> Result<Run, String>;

    /// Returns the states at `times` in double-double.
    fn exact(&self, tolerance: f64, max_step: f64, times: &[f64]) -> Result<Vec<State>, String>;

    /// Returns `true` if the reference is a Taylor series.
    fn by_series(&self) -> bool;

    /// Integrates in `f64` with nearly full precision from a state at `t` to the end. Returns the
    /// final state, or every step if `steps` is set.
    fn flow(
        &self,
        t: f64,
        state: &[f64],
        steps: bool,
        tolerance: f64,
    ) -> Option<Vec<(f64, Vec<f64>)>>;

    /// Returns the settings of the reference.
    fn guide(&self) -> &Guide;
}

/// Returns the largest difference of a coordinate or velocity in units of 1 + its magnitude;
/// infinite if a difference is NaN.
pub(crate) fn distance(state: &State, exact: &State) -> f64 {
    let parts = state
        .iter()
        .zip(exact)
        .map(|(x, exact)| (*x - *exact).to_f64().abs() / (1.0 + exact.to_f64().abs()));
    parts.fold(0.0, |largest: f64, x| if x.is_nan() { f64::INFINITY } else { largest.max(x) })
}

/// The number of times at which the flow is disturbed; `DIRECTIONS` is the number of disturbances
/// at each.
const INSTANTS: usize = 8;
const DIRECTIONS: usize = 2;

/// Returns the largest factor by which a disturbance grows until the end; at least one.
///
/// The times divide the steps of a run into equal parts. They are denser where the motion changes
/// fast, because most local errors arise there.
pub(crate) fn amplification(case: &dyn Case, random: &mut Random) -> Option<f64> {
    const SIZE: f64 = 1e-9;
    const EXACT: f64 = 1e-14;
    let path = case.flow(0.0, &case.start(), true, 1e-9)?;
    let mut largest = 1.0;
    for instant in 0..INSTANTS {
        let (t, state) = &path[instant * (path.len() - 1) / INSTANTS];
        let undisturbed = case.flow(*t, state, false, EXACT)?.pop()?.1;
        for _ in 0..DIRECTIONS {
            let direction: Vec<f64> = state.iter().map(|_| random.within(-1.0, 1.0)).collect();
            let norm = direction.iter().fold(0.0, |norm: f64, x| norm.max(x.abs()));
            let other: Vec<f64> = state
                .iter()
                .zip(&direction)
                .map(|(x, d)| x + SIZE * (1.0 + x.abs()) * d / norm)
                .collect();
            let disturbed = case.flow(*t, &other, false, EXACT)?.pop()?.1;
            let parts =
                disturbed.iter().zip(&undisturbed).map(|(x, y)| (x - y).abs() / (1.0 + y.abs()));
            largest = parts.fold(largest, |largest: f64, x| largest.max(x / SIZE));
        }
    }
    Some(largest)
}
