//! Controllers: how long the next step is, and whether one is good enough.

use crate::error::{Error, Quantity};
use crate::integrate::field::Field;
use crate::integrate::method::{self, Method};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::stats::Stats;
use crate::integrate::step::gap;
use crate::scalar::Float;
use crate::system::Dynamics;
use crate::time::Time;

/// A controller of the steps of the method `M` on the dynamics `D`: it chooses lengths and judges
/// errors, and never steps.
pub trait Controller<M, D, const N: usize>: Copy + core::fmt::Debug
where
    M: Method<D, N>,
    D: Dynamics<N, Scalar: Float>,
{
    /// The error in the settings, if there is one.
    fn check(&self) -> Result<(), Error>;

    /// A lower bound of the number of steps over an interval.
    fn least_steps(&self, length: f64) -> f64;

    /// The relative tolerance, and the absolute ones of coordinates and of velocities; `None` for
    /// steps that no tolerance decides. Rebounds below them count as none.
    fn accuracy(&self) -> Option<(f64, [[f64; N]; 2])> {
        None
    }

    /// Takes one step from `context.from` towards `context.target`, not beyond it, and puts its end
    /// into `context.to`; steps of fixed length are taken as they are, others by
    /// [`StepLaw::take_step`].
    fn step(
        &self,
        state: &mut ControllerState,
        context: StepContext<'_, '_, D, M, N>,
    ) -> Result<StepInterval, Error>;
}

/// The law by which a controller chooses lengths and judges errors.
pub trait StepLaw<M, D, const N: usize>: Controller<M, D, N>
where
    M: Method<D, N>,
    D: Dynamics<N, Scalar: Float>,
{
    /// The length of the first attempt at a step from `context.from`, and the time not to go
    /// beyond.
    fn propose(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
    ) -> Result<Trial, Error>;

    /// The interval of the next attempt.
    fn interval(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &mut Trial,
    ) -> Result<StepInterval, Error>;

    /// Puts the end of a step over `interval` into `context.to`, and gives its error over the one
    /// allowed: NaN where the end is not finite.
    fn estimate(
        &self,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &Trial,
        interval: &StepInterval,
    ) -> f64;

    /// The verdict on an attempt with this error.
    fn judge(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &mut Trial,
        interval: &StepInterval,
        error: f64,
    ) -> Result<Verdict, Error>;

    /// Takes one step: the only loop over attempts.
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
pub struct Trial {
    /// The length wanted, without its sign.
    pub wanted: f64,
    /// The time not to go beyond; infinite if there is none.
    pub target: f64,
    /// The number of attempts rejected.
    pub rejected: u32,
    /// The cause of the last rejection, if its end was not finite.
    pub fault: Option<Error>,
}

impl Trial {
    /// Before the first attempt.
    #[inline]
    pub fn new(wanted: f64, target: f64) -> Self {
        Self { wanted, target, rejected: 0, fault: None }
    }
}

/// The verdict on an attempt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It is a step.
    Accept,
    /// It is none; the next attempt has this length.
    Reject {
        /// In seconds, without its sign.
        length: f64,
    },
}

/// The memory of a controller from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerState {
    /// The length of the steps towards `target`, or the next one that the error suggests; 0 before
    /// the first.
    pub(crate) h: f64,
    /// The number of equal steps left, and where it is not `h`, their length.
    pub(crate) left: u64,
    pub(crate) equal: f64,
    /// The time to which they lead.
    pub(crate) target: f64,
    /// The binary logarithm of the error of the last step.
    pub(crate) error: f64,
    /// The longest step over a motion of which nobody knows how fast it changes.
    pub(crate) unknown: f64,
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
        }
    }
}

impl ControllerState {
    /// Before the first step over an interval of this length.
    #[inline]
    pub(crate) fn over(length: f64) -> Self {
        // Part of a length of few units in the last place may be none, which is no length of a
        // step.
        Self { unknown: f64::max(gap::PART * length.abs(), f64::MIN_POSITIVE), ..Self::default() }
    }

    /// `wanted`, or less if a step from `t` of a method whose samples lie `width` of a
    /// step apart
    /// might miss what time alone does.
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
        let own = gap::longest(dynamics.system(), t, width);
        let driven = dynamics.longest_step(t.to_f64(), gap::APART / width, self.unknown);
        if driven <= 0.0 || driven.is_nan() {
            let required = "positive; it is what a motion or a tuple of motions answers";
            return Err(Error::Setting { name: "longest_step", value: driven, required });
        }
        let least = gap::least(t);
        let driven = if least < driven { driven } else { least };
        let longest = if driven < own { driven } else { own };
        if longest < wanted {
            if longest < 0.99 * self.equal {
                // Equal steps were planned before that was known.
                self.left = 0;
            }
            return Ok(longest);
        }
        Ok(wanted)
    }
}

/// One step under way.
#[derive(Debug)]
pub struct StepContext<'a, 'd, D, M, const N: usize>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// The method.
    pub method: &'a M,
    /// The accelerations.
    pub field: &'a mut Field<'d, D, N>,
    /// The state.
    pub from: &'a mut Endpoint<D::Scalar, N>,
    /// The state at the end of the step.
    pub to: &'a mut Endpoint<D::Scalar, N>,
    /// The workspace of the method.
    pub workspace: &'a mut M::Workspace,
    /// The time not to go beyond; infinite if there is none.
    pub target: f64,
    /// The counters.
    pub stats: &'a mut Stats,
}

impl<D, M, const N: usize> StepContext<'_, '_, D, M, N>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// The accelerations at the start, if they are numbers.
    pub(crate) fn started(&mut self) -> Result<[D::Scalar; N], Error> {
        let a = self.from.start_acceleration(self.field);
        if a.iter().all(|a| a.is_finite()) {
            return Ok(a);
        }
        let at_once = StepInterval::by(self.from.t, 0.0);
        Err(method::cause(self.method, self.field, &at_once, self.from, self.workspace))
    }

    /// Keeps the cause of an attempt whose end is not finite, or gives it at once if no shorter
    /// step gets around it.
    #[cold]
    pub(crate) fn note_fault(
        &mut self,
        trial: &mut Trial,
        interval: &StepInterval,
    ) -> Result<(), Error> {
        trial.fault = self.method.diagnose(self.field, interval, self.from, self.workspace);
        // A function may have left its domain, and a shorter step may stay inside; but no step is
        // short enough for an input that is not finite.
        if let Some(input @ Error::NotFinite { what: Quantity::Input { .. }, .. }) = &trial.fault {
            return Err(input.clone());
        }
        Ok(())
    }
}
