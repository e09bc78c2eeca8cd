//! `solve`: a builder for one integration from start to end.

use crate::error::Error;
use crate::integrate::events::detector::EventDetector;
use crate::integrate::events::observed::Observed;
use crate::integrate::events::{Event, Occurrence, Status};
use crate::integrate::integrator::Integrator;
use crate::integrate::method::Method;
use crate::integrate::methods::auto::Auto;
use crate::integrate::observe::{Observers, OfSteps, Step};
use crate::integrate::output::{Output, Recorder};
use crate::integrate::pace::Pace;
use crate::integrate::settings::Settings;
use crate::integrate::solution::{Failure, RunNumber, Solution};
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::stats::Stats;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::controller::Controller;
use crate::integrate::step::fixed::FixedStep;
use crate::integrate::step::held::Held;
use crate::integrate::step::integration::Integration;
use crate::integrate::times::{direction, in_order};
use crate::scalar::Float;
use crate::system::{Dynamics, System};
use core::mem;
use core::ops::ControlFlow;

/// Integrates `dynamics` over the interval `time = (start, end)` in seconds from the coordinates
/// `q` and the velocities `v`.
///
/// Without further calls `solve` uses the method that [`Auto`] chooses, with `rtol` and `atol`
/// 1e-6, and returns the end state; [`Stats`] contain the name of the method. If motions have a
/// kink at the start, `v` is the velocity after the kink. An interval with `end < start` leads back
/// in time. Every method supports such an interval if the motions provide their
/// [kinks](crate::motion::Motion::kink_before), no event has an action, and the system has no
/// limits.
///
/// Steps over a [`Function`](crate::motion::Function) without a resolution are at most a fiftieth
/// of the interval long; see [`AdaptiveStep`].
pub fn solve<const N: usize, T, D: Dynamics<N, Scalar = T>>(
    dynamics: &D,
    time: (f64, f64),
    q: [T; N],
    v: [T; N],
) -> Solve<'_, N, D, T, Auto, AdaptiveStep<N>> {
    Solve {
        dynamics,
        time,
        q,
        v,
        method: Auto,
        settings: Settings::new(AdaptiveStep::new()),
        observers: Observers::none(),
    }
}

/// A builder for an integration, created by [`solve`], with the scalar `T` of the dynamics `D`.
// A bound on `D` would repeat what is wrong with it where the builder is used.
#[must_use = "nothing is integrated before `run`"]
#[derive(Debug)]
pub struct Solve<'a, const N: usize, D, T, M, C> {
    dynamics: &'a D,
    time: (f64, f64),
    q: [T; N],
    v: [T; N],
    method: M,
    settings: Settings<'a, T, N, C>,
    observers: Observers<'a, T, N>,
}

impl<'a, const N: usize, D: Dynamics<N, Scalar = T>, T: Float, M, C> Solve<'a, N, D, T, M, C> {
    /// Sets the method.
    pub fn method<B: Method<D, N>>(self, method: B) -> Solve<'a, N, D, T, B, C> {
        let Self { dynamics, time, q, v, settings, observers, .. } = self;
        Solve { dynamics, time, q, v, method, settings, observers }
    }

    /// Takes equal steps of at most `step` seconds; see [`FixedStep`].
    pub fn step(self, step: f64) -> Solve<'a, N, D, T, M, FixedStep> {
        self.control(FixedStep::new(step))
    }

    /// Takes `count` equal steps over the interval, or more if kinks or stops divide the interval.
    pub fn steps(self, count: u64) -> Solve<'a, N, D, T, M, FixedStep> {
        let length = (self.time.1 - self.time.0).abs();
        self.control(FixedStep::dividing(length, count))
    }

    /// Outputs the states at `times`, in the order of the motion, from dense output. Output times
    /// do not change the steps.
    pub fn t_eval(mut self, times: &'a [f64]) -> Self {
        self.settings.output = Output::Times(times);
        self
    }

    /// Outputs the states at `start`, `start + interval`, `start + 2 interval`, … up to the end,
    /// from dense output.
    pub fn every(mut self, interval: f64) -> Self {
        self.settings.output = Output::Every(interval);
        self
    }

    /// Outputs the states at the start and after every step; at a kink, the states on both sides.
    pub fn every_step(mut self) -> Self {
        self.settings.output = Output::Steps;
        self
    }

    /// Stores the motion within each step, so that [`Solution::at`] returns the state at any time.
    pub fn dense(mut self) -> Self {
        self.settings.dense = true;
        self
    }

    /// Makes steps end exactly at `times`, which are in the order of the motion.
    pub fn t_stops(mut self, times: &'a [f64]) -> Self {
        self.settings.stops = times;
        self
    }

    /// Detects events; a terminal event ends the integration. [`Solution::events`] contains the
    /// events found. Steps end at known times and at events with actions; other events do not
    /// change the steps.
    pub fn events(mut self, events: impl AsRef<[Event<'a, T, N>]>) -> Self {
        self.settings.events = events.as_ref().to_vec();
        self
    }

    /// Sets the number of steps, including rejected ones, after which the integration fails; the
    /// default is ten million. It fails before if the steps become shorter and shorter and those
    /// left would not suffice at the present pace.
    pub fn max_steps(mut self, count: u64) -> Self {
        self.settings.max_steps = count;
        self
    }

    /// Calls `look` after every step, for example to show progress, to log or to cancel. On
    /// [`ControlFlow::Break`] the integration ends with [`Status::Cancelled`] and the solution up
    /// to that step.
    ///
    /// ```
    /// # use core::ops::ControlFlow;
    /// # use pendulum_runtime::{integrate::*, system::*};
    /// fn shown<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<(), Failure<f64, 1>> {
    ///     let run = solve(system, (0.0, 10.0), [1.3], [0.0]).method(Dop853).on_step(|step| {
    ///         println!("{:3.0} %, {} steps", 100.0 * step.progress(), step.stats.accepted);
    ///         if step.stats.accepted < 5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    ///     });
    ///     let solution = run.run()?;
    ///     println!("{:?} at {} s", solution.status, solution.end.t);
    ///     Ok(())
    /// }
    /// ```
    pub fn on_step(
        mut self,
        look: impl FnMut(&mut Step<'_, T, N>) -> ControlFlow<()> + 'a,
    ) -> Self {
        self.observers.steps = Some(Box::new(look));
        self
    }

    /// Passes the states at the output times to `take`, one by one, and does not store them. The
    /// solution contains only the last state, so that the memory does not limit the number of
    /// states. On [`ControlFlow::Break`] the integration ends at the end of the step, with
    /// [`Status::Cancelled`].
    pub fn on_output(mut self, take: impl FnMut(State<T, N>) -> ControlFlow<()> + 'a) -> Self {
        self.observers.states = Some(Box::new(take));
        self
    }

    pub(crate) fn control<B>(self, controller: B) -> Solve<'a, N, D, T, M, B> {
        let Self { dynamics, time, q, v, method, settings, observers } = self;
        let settings = settings.with(controller);
        Solve { dynamics, time, q, v, method, settings, observers }
    }

    /// Replaces all settings.
    pub(crate) fn with_settings<B>(
        self,
        settings: Settings<'a, T, N, B>,
    ) -> Solve<'a, N, D, T, M, B> {
        let Self { dynamics, time, q, v, method, observers, .. } = self;
        Solve { dynamics, time, q, v, method, settings, observers }
    }
}

impl<const N: usize, D, T, M> Solve<'_, N, D, T, M, AdaptiveStep<N>> {
    /// Sets the relative tolerance; the default is 1e-6 (1.2e-5 for `f32`).
    ///
    /// Runge–Kutta methods return an error for less than ten machine epsilons of the scalar.
    /// [`Picard`](crate::integrate::Picard) and [`Taylor`](crate::integrate::Taylor), also if
    /// `Auto` chooses them, take any positive number; their errors do not fall below the rounding
    /// of a coordinate. The absolute tolerance has no such bound: for a motion that comes to rest,
    /// `rtol` 1e-20 takes many times the steps of 1e-14, unless [`atol`](Self::atol) is given.
    ///
    /// With scalars of two words, methods whose coefficients have the precision of `f64` reach no
    /// tolerance below 2.3e-15; smaller values count as 2.3e-15. Only
    /// [`Taylor`](crate::integrate::Taylor) reaches 5e-31.
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.settings.controller = self.settings.controller.rtol(rtol);
        self
    }

    /// Sets the absolute tolerance of all coordinates and velocities. The default is `rtol`, in the
    /// unit of each of them, as explained by [`AdaptiveStep`].
    pub fn atol(mut self, atol: f64) -> Self {
        self.settings.controller = self.settings.controller.atol(atol);
        self
    }

    /// Sets the absolute tolerances of each coordinate and of each velocity.
    pub fn atol_each(mut self, q: [f64; N], v: [f64; N]) -> Self {
        self.settings.controller = self.settings.controller.atol_each(q, v);
        self
    }

    /// Sets the length of the first step in seconds, which is chosen automatically by default.
    pub fn first_step(mut self, step: f64) -> Self {
        self.settings.controller = self.settings.controller.first_step(step);
        self
    }

    /// Sets the maximum length of a step in seconds.
    pub fn max_step(mut self, step: f64) -> Self {
        self.settings.controller = self.settings.controller.max_step(step);
        self
    }
}

impl<'a, const N: usize, D, T, M, C> Solve<'a, N, D, T, M, C>
where
    D: Dynamics<N, Scalar = T>,
    T: Float,
    C: Copy,
{
    /// Runs the integration.
    ///
    /// A method that does not support the system, or that lacks a step size, does not compile.
    ///
    /// # Errors
    /// Returns the error together with the solution up to the failure.
    pub fn run(mut self) -> Result<Solution<T, N>, Failure<T, N>>
    where
        M: Method<D, N>,
        C: Controller<M, D, N>,
    {
        let facts = const { &<D::System as System<N>>::FACTS };
        let Observers { mut steps, mut states } =
            mem::replace(&mut self.observers, Observers::none());
        let mut recorder =
            Recorder::new(self.settings.output, self.time, facts, states.as_deref_mut());
        let given = State { t: self.time.0, q: self.q, v: self.v };
        match self.check(recorder.streams()).and_then(|()| self.begin()) {
            Err(error) => Err(recorder.fail(error, given, 0, Stats::new(M::NAME))),
            Ok(mut integration) => {
                let ended = self.integrate(&mut integration, &mut recorder, steps.as_deref_mut());
                let (end, stats) = (State::from(&integration.end), integration.stats());
                let [_, touching] = integration.contacts();
                let run = RunNumber(integration.dynamics.recorded());
                match ended {
                    Err(error) => {
                        let mut failure = recorder.fail(error, end, touching, stats);
                        failure.partial.run = run;
                        Err(failure)
                    }
                    Ok(status) => {
                        Ok(Solution { run, ..recorder.finish(end, touching, status, stats) })
                    }
                }
            }
        }
    }

    /// Creates an [`Integrator`] at the start, with the same system, method, steps, events and
    /// stops, for a loop in the caller's code. The integrator takes the same steps as `run` up to
    /// the end of the interval and can continue beyond. It ignores the settings of the output.
    pub fn start(self) -> Result<Integrator<'a, N, D, M, C>, Error>
    where
        M: Method<D, N>,
        C: Controller<M, D, N>,
    {
        self.check(true)?;
        let integration = self.begin()?;
        let Settings { ref events, stops, max_steps, .. } = self.settings;
        Integrator::over(integration, events, stops, self.time.1, max_steps)
    }

    fn begin(&self) -> Result<Integration<'a, N, D, M, C>, Error>
    where
        M: Method<D, N>,
    {
        let (dynamics, (start, end)) = (Held::borrowed(self.dynamics), self.time);
        let (method, controller) = (self.method, self.settings.controller);
        let integration = Integration::new(dynamics, method, controller, start, self.q, self.v)?;
        Ok(integration.over((end - start).abs()))
    }

    fn integrate(
        &self,
        integration: &mut Integration<'_, N, D, M, C>,
        recorder: &mut Recorder<'_, '_, T, N>,
        mut look: Option<&mut OfSteps<'_, T, N>>,
    ) -> Result<Status, Error>
    where
        M: Method<D, N>,
        C: Controller<M, D, N>,
    {
        let end = self.time.1;
        let onwards = direction(self.time.0, end);
        let ahead = |at: &Endpoint<T, N>, t| onwards * at.t.since(t) < 0.0;
        let Settings { controller, dense, mut stops, ref events, max_steps, .. } = self.settings;
        let mut detector = EventDetector::new(events);
        detector.accuracy = controller.accuracy();
        let [_, touching] = integration.contacts();
        recorder.begin(State::from(&integration.end), touching, dense);
        recorder.impacts(integration.impacts());
        let frictions = const { <D::System as System<N>>::FACTS.frictions };
        recorder.modes(frictions, integration.t(), touching);
        detector.begin(integration)?;
        let mut pace = Pace::new(integration.t(), max_steps);
        while ahead(&integration.end, end) {
            let Stats { accepted, rejected, .. } = integration.stats;
            let (t, steps) = (integration.t(), accepted + rejected);
            for impact in integration.impacts() {
                pace.strike(steps, t, impact.impulse.to_f64());
            }
            if pace.fails(steps, t, end - t) {
                return Err(Error::MaxSteps { t, max_steps });
            }
            while let [stop, later @ ..] = stops
                && !ahead(&integration.end, *stop)
            {
                stops = later;
            }
            let stop = stops.first().copied().unwrap_or(end);
            integration.step(detector.next_time(integration.t(), stop))?;
            if !ahead(&integration.end, end) {
                integration.check_inertia()?;
            }
            let ended = detector.observe(integration);
            recorder.events(detector.found());
            recorder.impacts(integration.impacts());
            if !frictions.is_empty() {
                let [_, touching] = integration.contacts();
                recorder.modes(frictions, integration.t(), touching);
            }
            let ended = ended?;
            recorder.step(integration)?;
            if let Some(look) = &mut look
                && show(&mut **look, integration, detector.found(), self.time).is_break()
            {
                return Ok(ended.unwrap_or(Status::Cancelled));
            }
            if let Some(status) = ended {
                return Ok(status);
            }
            if recorder.cancelled {
                return Ok(Status::Cancelled);
            }
        }
        Ok(Status::Completed)
    }

    /// Checks the settings; `streamed` is `true` if the states are not stored.
    fn check(&self, streamed: bool) -> Result<(), Error>
    where
        M: Method<D, N>,
        C: Controller<M, D, N>,
    {
        let (start, end) = self.time;
        let Settings { controller, output, stops, ref events, max_steps, .. } = self.settings;
        if !((end - start).is_finite() && (start <= end || self.method.goes_back(self.dynamics))) {
            return Err(Error::Interval { start, end });
        }
        if end < start
            && let Some(event) = events.iter().position(|event| event.action.is_some())
        {
            return Err(Error::Backwards { t: start, event });
        }
        controller.check()?;
        output.check(start, end, streamed)?;
        in_order("t_stops", stops, start, end)?;
        if (max_steps as f64) < controller.least_steps((end - start).abs()) {
            return Err(Error::MaxSteps { t: start, max_steps });
        }
        Ok(())
    }
}

/// Passes the step that `integration` has just taken to an observer.
#[cold]
fn show<D, M, C, const N: usize>(
    look: &mut OfSteps<'_, D::Scalar, N>,
    integration: &mut Integration<'_, N, D, M, C>,
    events: &[Occurrence<D::Scalar, N>],
    interval: (f64, f64),
) -> ControlFlow<()>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    let (start, end) = (integration.last_start(), State::from(&integration.end));
    let stats = integration.stats();
    let within = &mut |t| integration.within(t);
    look(&mut Step { start, end, stats, events, interval, within })
}
