//! What decides about the length of steps: the interface that fixed and adaptive steps share.

use crate::error::Error;
use crate::integrate::solution::Stats;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::field::Counted;
use crate::integrate::step::gap::WITHOUT_INTERVAL;
use crate::integrate::step::interval::StepInterval;
use crate::integrate::step::stepper::Stepper;
use crate::real::Float;
use crate::system::Dynamics;

/// What decides about the length of the steps of the method `M` on the dynamics `D`.
pub trait Control<M, D, const N: usize>: Copy + core::fmt::Debug
where
    M: Stepper<D, N>,
    D: Dynamics<N, Scalar: Float>,
{
    /// Whether the settings make sense.
    fn check(&self) -> Result<(), Error>;

    /// A lower bound of the number of steps over an interval.
    fn least_steps(&self, length: f64) -> f64;

    /// Takes one step from `course.from` towards `course.target`, not beyond it, and puts its end
    /// into `course.to`; if it fails, nothing but that and caches has changed.
    fn step(
        &self,
        memory: &mut ControllerState,
        course: StepContext<'_, '_, D, M, N>,
    ) -> Result<StepInterval, Error>;
}

/// What a control remembers from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerState {
    /// The length of the steps towards `target`, or the next one that the error suggests; 0 before
    /// the first.
    pub(crate) h: f64,
    /// The number of equal steps left, and where it is not `h`, their length.
    pub(crate) left: u64,
    pub(crate) equal: f64,
    /// Where they lead.
    pub(crate) target: f64,
    /// The binary logarithm of the error of the last step.
    pub(crate) error: f64,
    /// The longest step over a motion of which nobody knows how fast it changes.
    pub(crate) unknown: f64,
}

impl Default for ControllerState {
    fn default() -> Self {
        Self { h: 0.0, left: 0, equal: 0.0, target: 0.0, error: 0.0, unknown: WITHOUT_INTERVAL }
    }
}

/// What a control works with.
#[derive(Debug)]
pub struct StepContext<'a, 'd, D, M, const N: usize>
where
    D: Dynamics<N, Scalar: Float>,
    M: Stepper<D, N>,
{
    /// The method.
    pub(crate) method: &'a M,
    /// The accelerations.
    pub(crate) field: &'a mut Counted<'d, D>,
    /// The state.
    pub(crate) from: &'a mut Endpoint<D::Scalar, N>,
    /// Where the state at the end of the step goes.
    pub(crate) to: &'a mut Endpoint<D::Scalar, N>,
    /// What the step leaves behind.
    pub(crate) stages: &'a mut M::Stages,
    /// The time not to go beyond; infinite if there is none.
    pub(crate) target: f64,
    /// The counters.
    pub(crate) stats: &'a mut Stats,
}
