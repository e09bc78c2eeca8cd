//! Controllers, which choose the length of the next step and judge its error.

use crate::error::{Error, Quantity};
use crate::integrate::field::Field;
use crate::integrate::field::contacts::has_contacts;
use crate::integrate::method::{self, Method};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::stats::Stats;
use crate::integrate::step::gap;
use crate::scalar::Float;
use crate::system::Dynamics;
use crate::time::Time;

/// A controller of the steps of the method `M` on the dynamics `D`. It chooses lengths and judges
/// errors, and leaves the steps themselves to the method.
pub trait Controller<M, D, const N: usize>: Copy + core::fmt::Debug
where
    M: Method<D, N>,
    D: Dynamics<N, Scalar: Float>,
{
    /// Returns an error if a setting is invalid.
    fn check(&self) -> Result<(), Error>;

    /// Returns a lower bound of the number of steps over an interval of this length.
    fn least_steps(&self, length: f64) -> f64;

    /// Returns the relative tolerance, and the absolute tolerances of coordinates and of
    /// velocities; `None` for steps without tolerances. Rebounds below the tolerances are ignored.
    fn accuracy(&self) -> Option<(f64, [[f64; N]; 2])> {
        None
    }

    /// Takes one step from `context.from` towards `context.target`, but not beyond it, and stores
    /// the end in `context.to`.
    fn step(
        &self,
        state: &mut ControllerState,
        context: StepContext<'_, '_, D, M, N>,
    ) -> Result<StepInterval, Error>;
}

/// The rules by which a controller of adaptive steps chooses lengths and judges errors.
pub(crate) trait StepLaw<M, D, const N: usize>: Controller<M, D, N>
where
    M: Method<D, N>,
    D: Dynamics<N, Scalar: Float>,
{
    /// Returns the length of the first attempt at a step from `context.from`, and the time that the
    /// step must not pass.
    fn propose(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
    ) -> Result<Trial, Error>;

    /// Returns the interval of the next attempt.
    fn interval(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &mut Trial,
    ) -> Result<StepInterval, Error>;

    /// Stores the end of a step over `interval` in `context.to`, and returns its error relative to
    /// the error allowed; NaN if the end is not finite.
    fn estimate(
        &self,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &Trial,
        interval: &StepInterval,
    ) -> f64;

    /// Returns the verdict on an attempt with this error.
    fn judge(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &mut Trial,
        interval: &StepInterval,
        error: f64,
    ) -> Result<Verdict, Error>;

    /// Takes one step; contains the only loop over attempts.
    #[inline]
    fn take_step(
        &self,
        state: &mut ControllerState,
        mut context: StepContext<'_, '_, D, M, N>,
    ) -> Result<StepInterval, Error> {
        let mut trial = self.propose(state, &mut context)?;
        loop {
            let interval = self.interval(state, &mut context, &mut trial)?;
            let error = self.estimate(&mut context, &trial, &interval);
            match self.judge(state, &mut context, &mut trial, &interval, error)? {
                Verdict::Accept => {
                    context.stats.accepted += 1;
                    return Ok(interval);
                }
                Verdict::Reject { length } => {
                    context.stats.rejected += 1;
                    (trial.wanted, trial.rejected) = (length, trial.rejected + 1);
                }
            }
        }
    }
}

/// The attempts at one step.
#[derive(Debug)]
pub(crate) struct Trial {
    /// The length wanted, without its sign.
    pub(crate) wanted: f64,
    /// The time that the step must not pass; infinite if there is none.
    pub(crate) target: f64,
    /// The number of rejected attempts.
    pub(crate) rejected: u32,
    /// The cause of the last rejection, if the end of the attempt was not finite.
    pub(crate) fault: Option<Error>,
}

impl Trial {
    /// Creates a trial before the first attempt.
    #[inline]
    pub(crate) fn new(wanted: f64, target: f64) -> Self {
        Self { wanted, target, rejected: 0, fault: None }
    }
}

/// The verdict on an attempt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// The attempt becomes a step.
    Accept,
    /// The attempt is rejected, and the next attempt has another length.
    Reject {
        /// The length of the next attempt in seconds, without its sign.
        length: f64,
    },
}

/// The data that a controller passes from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerState {
    /// The length of the steps towards `target`, or the length of the next step as suggested by the
    /// error; 0 before the first step.
    pub(crate) h: f64,
    /// The number of equal steps left.
    pub(crate) left: u64,
    /// The length of the equal steps, if it differs from `h`.
    pub(crate) equal: f64,
    /// The time at which the equal steps end.
    pub(crate) target: f64,
    /// The binary logarithm of the error of the last step.
    pub(crate) error: f64,
    /// The maximum length of a step over a motion with an unknown time scale.
    pub(crate) unknown: f64,
    /// The maximum length of the next step after a step in a layer.
    pub(crate) reach: f64,
    /// The length of a straight step over a switch just ahead; 0 if there is none.
    pub(crate) ahead: f64,
}

impl Default for ControllerState {
    fn default() -> Self {
        Self {
            h: 0.0,
            left: 0,
            equal: 0.0,
            target: 0.0,
            error: 0.0,
            unknown: gap::WITHOUT_INTERVAL,
            reach: f64::INFINITY,
            ahead: 0.0,
        }
    }
}

impl ControllerState {
    /// Creates the state before the first step over an interval of this length.
    #[inline]
    pub(crate) fn over(length: f64) -> Self {
        // A fraction of a very short interval may be rounded to zero, which is no valid length of a
        // step.
        Self { unknown: f64::max(gap::PART * length.abs(), f64::MIN_POSITIVE), ..Self::default() }
    }

    /// Returns `wanted`, or less if a step from `t` might miss a feature of functions of time in
    /// the accelerations or in the gaps of limits. The samples of the method are `width` of a step
    /// apart.
    #[inline]
    pub(crate) fn within_sight<D, const N: usize>(
        &mut self,
        wanted: f64,
        dynamics: &D,
        t: Time,
        width: f64,
    ) -> Result<f64, Error>
    where
        D: Dynamics<N, Scalar: Float>,
    {
        let searched = const { has_contacts::<D, N>() } && width < gap::SEARCHED;
        let width = if searched { gap::SEARCHED } else { width };
        let own = gap::longest(dynamics.system(), t, width);
        let driven = dynamics.longest_step(t.to_f64(), gap::APART / width, self.unknown);
        if driven <= 0.0 || driven.is_nan() {
            let required = "positive; correct `longest_step` of the motion";
            return Err(Error::Setting { name: "longest_step", value: driven, required });
        }
        let least = gap::least(t);
        let driven = if least < driven { driven } else { least };
        let longest = if driven < own { driven } else { own };
        if longest < wanted {
            if longest < 0.99 * self.equal {
                // Equal steps were planned before this bound was known.
                self.left = 0;
            }
            return Ok(longest);
        }
        Ok(wanted)
    }
}

/// The data of the next step.
#[derive(Debug)]
pub struct StepContext<'a, 'd, D, M, const N: usize>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// The method.
    pub method: &'a M,
    /// The field of accelerations.
    pub field: &'a mut Field<'d, D, N>,
    /// The state at the start of the step.
    pub from: &'a mut Endpoint<D::Scalar, N>,
    /// The state at the end of the step.
    pub to: &'a mut Endpoint<D::Scalar, N>,
    /// The workspace of the method.
    pub workspace: &'a mut M::Workspace,
    /// The time that the step must not pass; infinite if there is none.
    pub target: f64,
    /// The counters of the integration.
    pub stats: &'a mut Stats,
}

impl<D, M, const N: usize> StepContext<'_, '_, D, M, N>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Returns the accelerations at the start, or an error if they are not finite.
    pub(crate) fn started(&mut self) -> Result<[D::Scalar; N], Error> {
        let a = self.from.start_acceleration(self.field);
        if a.iter().all(|a| a.is_finite()) {
            return Ok(a);
        }
        let at_once = StepInterval::by(self.from.t, 0.0);
        Err(method::cause(self.method, self.field, &at_once, self.from, self.workspace))
    }

    /// Stores the cause of an attempt whose end is not finite, or returns it as an error if no
    /// shorter step avoids it.
    #[cold]
    pub(crate) fn note_fault(
        &mut self,
        trial: &mut Trial,
        interval: &StepInterval,
    ) -> Result<(), Error> {
        trial.fault = self.method.diagnose(self.field, interval, self.from, self.workspace);
        // A function may have left its domain, and a shorter step may stay inside. But no step is
        // short enough for an input that is not finite.
        if let Some(input @ Error::NotFinite { what: Quantity::Input { .. }, .. }) = &trial.fault {
            return Err(input.clone());
        }
        Ok(())
    }
}
