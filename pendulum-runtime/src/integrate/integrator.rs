//! Integration step by step, by hand.

use crate::error::Error;
use crate::integrate::events::detector::EventDetector;
use crate::integrate::events::{Event, Occurrence, Status};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::Method;
use crate::integrate::solution::Stats;
use crate::integrate::state::State;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::controller::Controller;
use crate::integrate::step::integration::Integration;
use crate::scalar::Float;
use crate::system::Dynamics;

/// An integration that goes on for as long as somebody asks for the next step; no step allocates.
///
/// It knows no interval: an adaptive step over a [`Function`](crate::motion::Function) without a
/// resolution is at most one second long.
///
/// After an error the state is the one before the failed step.
#[derive(Clone, Debug)]
pub struct Integrator<'a, const N: usize, D, M, C = AdaptiveStep<N>>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    integration: Integration<'a, N, D, M, C>,
    detector: EventDetector<'a, D::Scalar, N>,
    /// What happened in the last call.
    found: Vec<Occurrence<D::Scalar, N>>,
    ended: Option<Status>,
    max_steps: u64,
}

impl<'a, const N: usize, D, M> Integrator<'a, N, D, M>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// At the coordinates `q` and velocities `v` at time `t`, with the default tolerances.
    ///
    /// A method without error estimate needs a [`FixedStep`](crate::integrate::FixedStep) from
    /// [`control`](Self::control) before its first step.
    pub fn new(
        dynamics: &'a D,
        method: M,
        t: f64,
        q: [D::Scalar; N],
        v: [D::Scalar; N],
    ) -> Result<Self, Error> {
        Ok(Self {
            integration: Integration::new(dynamics, method, AdaptiveStep::new(), t, q, v)?,
            detector: EventDetector::new(&[]),
            found: Vec::new(),
            ended: None,
            max_steps: 10_000_000,
        })
    }
}

impl<'a, const N: usize, D, M, C> Integrator<'a, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Chooses the steps otherwise: with a [`FixedStep`](crate::integrate::FixedStep) or an [`AdaptiveStep`].
    pub fn control<B: Controller<M, D, N>>(
        self,
        control: B,
    ) -> Result<Integrator<'a, N, D, M, B>, Error> {
        control.check()?;
        let Self { integration, detector, found, ended, max_steps } = self;
        let integration = integration.controlled(control);
        Ok(Integrator { integration, detector, found, ended, max_steps })
    }

    /// Looks for events from here on, forwards in time.
    ///
    /// A terminal one ends the step and the call that leads to it, with the state at the event; the
    /// next call goes on from there, or from where [`reset`](Self::reset) has put the state.
    pub fn events(mut self, events: impl AsRef<[Event<'a, D::Scalar, N>]>) -> Result<Self, Error> {
        self.detector = EventDetector::new(events.as_ref());
        self.detector.begin(&mut self.integration)?;
        Ok(self)
    }

    /// The number of steps that one call of [`advance_to`](Self::advance_to) may take; ten million
    /// without this call.
    pub fn max_steps(mut self, count: u64) -> Self {
        self.max_steps = count;
        self
    }

    /// Takes one step: the longest that the control allows, but not over a kink.
    #[inline]
    pub fn step(&mut self) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        self.found.clear();
        self.ended = None;
        self.step_towards(f64::INFINITY)
    }

    #[inline]
    fn step_towards(&mut self, target: f64) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        let event = self.detector.next_time();
        self.integration.step(if event < target { event } else { target })?;
        let ended = self.detector.observe(&mut self.integration);
        self.found.extend_from_slice(self.detector.found());
        self.ended = ended?;
        Ok(())
    }

    /// Takes steps until the time is exactly `t`, or a terminal event has happened; methods that
    /// can go back in time do so for an earlier time, if there are no events to look for.
    pub fn advance_to(&mut self, t: f64) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        self.found.clear();
        self.ended = None;
        if !((self.t() <= t
            || self.integration.method.goes_back(self.integration.dynamics)
                && self.detector.is_idle())
            && t.is_finite())
        {
            return Err(Error::Interval { start: self.t(), end: t });
        }
        let steps = |stats: &Stats| stats.accepted + stats.rejected;
        let before = steps(&self.integration.stats);
        while self.t() != t && self.ended.is_none() {
            if self.max_steps <= steps(&self.integration.stats) - before {
                return Err(Error::MaxSteps { t: self.t(), max_steps: self.max_steps });
            }
            self.step_towards(t)?;
        }
        Ok(())
    }

    /// Puts the state elsewhere, or the same state to another time; what follows is as if the
    /// integration began there.
    pub fn reset(&mut self, t: f64, q: [D::Scalar; N], v: [D::Scalar; N]) -> Result<(), Error> {
        self.integration.reset(t, q, v)?;
        self.detector.begin(&mut self.integration)
    }

    /// Moves the coordinates by `high + low` and keeps what rounding has left off, which
    /// [`reset`](Self::reset) does not.
    ///
    /// This takes whole turns off an angle that grows for ever, whose forces would lose a digit
    /// with every ten turns:
    ///
    /// ```
    /// # use core::f64::consts::TAU;
    /// # use pendulum_runtime::{error::Error, integrate::*, integrate::method::*, system::*};
    /// # fn wind<'a, S, M, C>(run: &mut Integrator<'a, 1, S, M, C>) -> Result<(), Error>
    /// # where S: System<1, Scalar = f64, Inputs = ()>, M: Method<S, 1> {
    /// // 2π is this number and 2.449…e-16.
    /// let turns = (run.q()[0] / TAU).round();
    /// run.displace([-turns * TAU], [-turns * 2.4492935982947064e-16])?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn displace(&mut self, high: [D::Scalar; N], low: [D::Scalar; N]) -> Result<(), Error> {
        self.integration.displace(&high, &low)?;
        self.detector.begin(&mut self.integration)
    }

    /// The events that happened in the last call of [`step`](Self::step) or
    /// [`advance_to`](Self::advance_to), in order.
    pub fn occurrences(&self) -> &[Occurrence<D::Scalar, N>] {
        &self.found
    }

    /// The index of the terminal event that has ended that call, or of the one that has come to rest.
    pub fn terminal_event(&self) -> Option<usize> {
        match self.ended {
            Some(Status::Event(event) | Status::Rest(event)) => Some(event),
            _ => None,
        }
    }

    /// The motion within the last step; `None` before the first and after one that failed.
    ///
    /// Methods that need further evaluations for it take them now.
    pub fn interpolant(&mut self) -> Option<Interpolant<D::Scalar, N>> {
        self.integration.interpolant()
    }

    /// The time reached.
    pub fn t(&self) -> f64 {
        self.integration.t()
    }

    /// The coordinates.
    pub fn q(&self) -> &[D::Scalar; N] {
        &self.integration.end.q.high
    }

    /// The velocities; at a kink those beyond it.
    pub fn v(&self) -> &[D::Scalar; N] {
        &self.integration.end.v.high
    }

    /// Time, coordinates and velocities together.
    pub fn state(&self) -> State<D::Scalar, N> {
        State::from(&self.integration.end)
    }

    /// What it took so far.
    pub fn stats(&self) -> Stats {
        self.integration.stats()
    }
}
