//! One problem: a system, a start and an interval, whatever their types.

use crate::random::Random;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use std::time::Duration;

/// The subject of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The method that `solve` chooses.
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
    /// All, in the order of the tables.
    pub(crate) const ALL: [Self; 6] =
        [Self::Default, Self::Picard, Self::Taylor, Self::Dop853, Self::Rodas4, Self::Dprkn12];

    /// The least tolerance at which it is measured: below, methods of low order take millions of
    /// steps.
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

/// The numbers that a run computes with.
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

    /// The tolerances that are asked for.
    pub(crate) fn tolerances(self) -> (f64, f64) {
        match self {
            Self::F32 => (30.0 * self.epsilon(), 1e-3),
            Self::F64 => (1e-12, 1e-3),
            Self::Wide => (1e-26, 1e-6),
        }
    }

    /// The nearest number of this type.
    pub(crate) fn round(self, x: f64) -> f64 {
        if self == Self::F32 { f64::from(x as f32) } else { x }
    }
}

/// A number with all its digits in two words.
pub(crate) trait Widened: Float {
    fn widened(self) -> DoubleDouble;
}

impl Widened for f32 {
    fn widened(self) -> DoubleDouble {
        DoubleDouble::from(f64::from(self))
    }
}

impl Widened for f64 {
    fn widened(self) -> DoubleDouble {
        DoubleDouble::from(self)
    }
}

impl Widened for DoubleDouble {
    fn widened(self) -> DoubleDouble {
        self
    }
}

/// A state, coordinates before velocities.
pub(crate) type State = Vec<DoubleDouble>;

/// The result of one integration.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// The states at the output times, the last one at the end; that alone if no others were asked
    /// for.
    pub(crate) states: Vec<State>,
    pub(crate) time: Duration,
    /// The steps, evaluations and the method that was chosen.
    pub(crate) stats: String,
}

/// Help for a reference, and for no method that is measured: it knows the future.
#[derive(Clone, Debug)]
pub(crate) struct Guide {
    /// The longest step.
    pub(crate) max_step: f64,
    /// Times at which steps end.
    pub(crate) stops: Vec<f64>,
    /// The least tolerance that the numbers of the problem permit.
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

/// The most steps of one run.
pub(crate) const MOST: u64 = 2_000_000;

/// A problem without its types.
pub(crate) trait Case {
    /// The methods that suit it.
    fn methods(&self, scalar: Scalar) -> &'static [Method];

    /// The end of the interval, which begins at zero.
    fn end(&self) -> f64;

    /// The start, coordinates before velocities.
    fn start(&self) -> Vec<f64>;

    /// The parameters and the motion, for who wants to repeat the run.
    fn describe(&self) -> String;

    /// The measurement with `rtol` and `atol` at this tolerance: at the end, and at other times if
    /// there are any.
    fn run(
        &self,
        method: Method,
        scalar: Scalar,
        tolerance: f64,
        times: &[f64],
    ) -> Result<Run, String>;

    /// The states at `times` in two words.
    fn exact(&self, tolerance: f64, max_step: f64, times: &[f64]) -> Result<Vec<State>, String>;

    /// Returns true if the reference is a Taylor series.
    fn by_series(&self) -> bool;

    /// The flow in `f64` with nearly all its digits: the state at the end from one at `t`; every
    /// step if asked for.
    fn flow(
        &self,
        t: f64,
        state: &[f64],
        steps: bool,
        tolerance: f64,
    ) -> Option<Vec<(f64, Vec<f64>)>>;

    /// The bounds of the reference.
    fn guide(&self) -> &Guide;
}

/// The greatest difference of any coordinate or velocity in units of 1 + its magnitude; infinite
/// where there is no number.
pub(crate) fn distance(state: &State, exact: &State) -> f64 {
    let parts = state
        .iter()
        .zip(exact)
        .map(|(x, exact)| (*x - *exact).to_f64().abs() / (1.0 + exact.to_f64().abs()));
    parts.fold(0.0, |largest: f64, x| if x.is_nan() { f64::INFINITY } else { largest.max(x) })
}

/// The number of instants at which the flow is disturbed, and of disturbances at each.
const INSTANTS: usize = 8;
const DIRECTIONS: usize = 2;

/// The greatest factor by which a disturbance grows until the end; at least one.
///
/// The instants divide the steps of a run into equal parts, so that they crowd where the motion
/// changes fast: there most local errors arise.
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
