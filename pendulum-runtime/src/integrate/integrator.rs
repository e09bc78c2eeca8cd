//! Integration step by step, by hand.

use crate::error::Error;
use crate::integrate::events::detector::EventDetector;
use crate::integrate::events::{Event, Occurrence, Status};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::Method;

use crate::integrate::events::observed::Observed;
use crate::integrate::field::contacts::Contacts;
use crate::integrate::field::first_in_state;
use crate::integrate::state::State;
use crate::integrate::state::impact::Impact;
use crate::integrate::state::saved::{Memory, Saved};
use crate::integrate::stats::Stats;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::controller::Controller;
use crate::integrate::step::held::Held;
use crate::integrate::step::integration::Integration;
use crate::integrate::times::direction;
use crate::scalar::Float;
use crate::system::{Dynamics, MOST_LIMITS, System};

/// An integration that goes on for as long as somebody asks for the next step; no step allocates.
///
/// [`new`](Self::new) borrows the system, [`owning`](Self::owning) keeps it, and
/// [`Solve::start`](crate::integrate::Solve::start) has the settings of a `solve`. Without the
/// interval of the latter, an adaptive step over a [`Function`](crate::motion::Function) without a
/// resolution is at most one second long.
///
/// ```
/// # use pendulum_runtime::{error::Error, integrate::Event, prelude::*};
/// lagrangian! {
///     pub struct Clapper { L: m, g: m/s^2 = 9.81 }
///     coordinate q: rad;
///     kinetic = L^2 * q̇^2 / 2;
///     potential = -g * L * cos(q);
/// }
///
/// struct Bell {
///     run: Integrator<'static, 1, Clapper<f64>, Dop853>,
/// }
///
/// impl Bell {
///     fn new(length: f64, edge: f64) -> Result<Self, Error> {
///         let strike = Event::new(move |_t, q, _v| q[0] - edge).rising().then(|state| state.v[0] *= -0.3);
///         let run = Integrator::owning(Clapper::new(length), Dop853, 0.0, [-0.8], [0.0])?;
///         Ok(Self { run: run.events([strike])? })
///     }
///
///     /// The angles after each sixtieth of a second.
///     fn angles(&mut self) -> impl Iterator<Item = Result<f64, Error>> {
///         let times = (1..).map(|tick| f64::from(tick) / 60.0);
///         self.run.states_at(times).map(|state| Ok(state?.q[0]))
///     }
/// }
///
/// assert!(Bell::new(0.4, 0.5).unwrap().angles().take(120).all(|angle| angle.unwrap() < 0.5 + 1e-6));
/// ```
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
    /// The events of the last call.
    found: Vec<Occurrence<D::Scalar, N>>,
    ended: Option<Status>,
    max_steps: u64,
    goal: Goal,
}

/// Times at which steps end.
#[derive(Clone, Debug)]
struct Goal {
    /// The stops in ascending order.
    stops: Vec<f64>,
    /// The end of the interval; infinite without one.
    end: f64,
    /// The direction of time: 1 or −1.
    onwards: f64,
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
        Self::holding(Held::borrowed(dynamics), method, t, q, v)
    }

    /// The same with a system that it keeps, so that a struct can hold both; it is `'static` unless
    /// the events borrow.
    pub fn owning(
        dynamics: D,
        method: M,
        t: f64,
        q: [D::Scalar; N],
        v: [D::Scalar; N],
    ) -> Result<Self, Error> {
        Self::holding(Held::owned(dynamics), method, t, q, v)
    }

    fn holding(
        dynamics: Held<'a, D>,
        method: M,
        t: f64,
        q: [D::Scalar; N],
        v: [D::Scalar; N],
    ) -> Result<Self, Error> {
        let integration = Integration::new(dynamics, method, AdaptiveStep::new(), t, q, v)?;
        Self::over(integration, &[], &[], f64::INFINITY, 10_000_000)
    }
}

impl<'a, const N: usize, D, M, C> Integrator<'a, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// An integration towards `end`.
    pub(crate) fn over(
        mut integration: Integration<'a, N, D, M, C>,
        events: &[Event<'a, D::Scalar, N>],
        stops: &[f64],
        end: f64,
        max_steps: u64,
    ) -> Result<Self, Error> {
        let mut detector = EventDetector::new(events);
        detector.begin(&mut integration)?;
        let mut stops = stops.to_vec();
        stops.sort_unstable_by(f64::total_cmp);
        let onwards = direction(integration.t(), end);
        let goal = Goal { stops, end, onwards };
        Ok(Self { integration, detector, found: Vec::new(), ended: None, max_steps, goal })
    }

    /// The dynamics that it integrates.
    pub fn dynamics(&self) -> &D {
        &self.integration.dynamics
    }

    /// Chooses the steps otherwise: with a [`FixedStep`](crate::integrate::FixedStep) or an
    /// [`AdaptiveStep`].
    pub fn control<B: Controller<M, D, N>>(
        self,
        control: B,
    ) -> Result<Integrator<'a, N, D, M, B>, Error> {
        control.check()?;
        let Self { integration, detector, found, ended, max_steps, goal } = self;
        let integration = integration.controlled(control);
        Ok(Integrator { integration, detector, found, ended, max_steps, goal })
    }

    /// Looks for events from here on, forwards and back in time; those that act have no way back.
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

    /// Takes one step: the longest that the control allows, but not over a kink, a stop, and the
    /// end of the interval, if it was [started](crate::integrate::Solve::start) with them.
    #[inline]
    pub fn step(&mut self) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        self.found.clear();
        self.ended = None;
        self.step_onwards()
    }

    /// Takes one step towards the end of the interval, or beyond it.
    #[inline]
    fn step_onwards(&mut self) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        let Goal { end, onwards, .. } = self.goal;
        let target = if self.is_at_end() { onwards * f64::INFINITY } else { end };
        self.step_towards(target)
    }

    /// Checks that there is a way back in time.
    #[cold]
    fn check_back(&self, t: f64) -> Result<(), Error> {
        if !self.integration.method.goes_back(&self.integration.dynamics) {
            return Err(Error::Interval { start: self.t(), end: t });
        }
        match self.detector.acting() {
            Some(event) => Err(Error::Backwards { t: self.t(), event }),
            None => Ok(()),
        }
    }

    /// Returns true if the end of the interval is reached.
    fn is_at_end(&self) -> bool {
        0.0 <= self.goal.onwards * self.integration.end.t.since(self.goal.end)
    }

    /// The next stop on the way to `target`, or `target`.
    #[inline]
    fn next_stop(&self, target: f64) -> f64 {
        let (stops, t) = (&self.goal.stops, self.integration.end.t);
        if stops.is_empty() {
            return target;
        }
        if 0.0 < t.since(target) {
            let below = stops.partition_point(|stop| 0.0 < t.since(*stop));
            return stops[..below].last().map_or(target, |stop| f64::max(*stop, target));
        }
        let passed = stops.partition_point(|stop| 0.0 <= t.since(*stop));
        stops.get(passed).map_or(target, |stop| f64::min(*stop, target))
    }

    #[inline]
    fn step_towards(&mut self, target: f64) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        let target = self.next_stop(target);
        let target = self.detector.next_time(self.t(), target);
        if target < self.t() {
            self.check_back(target)?;
        }
        self.integration.step(target)?;
        let ended = self.detector.observe(&mut self.integration);
        self.found.extend_from_slice(self.detector.found());
        self.ended = ended?;
        Ok(())
    }

    /// Takes steps until the time is exactly `t`, or a terminal event has happened; methods that
    /// can go back in time do so for an earlier time, unless an event acts.
    pub fn advance_to(&mut self, t: f64) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        self.found.clear();
        self.ended = None;
        if !t.is_finite() {
            return Err(Error::Interval { start: self.t(), end: t });
        }
        if t < self.t() {
            self.check_back(t)?;
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

    /// The steps from here on, each taken when it is asked for: the states at their ends.
    ///
    /// They end with the interval, if it was [started](crate::integrate::Solve::start) with one,
    /// with a terminal event, and with an error.
    pub fn steps(&mut self) -> Steps<'_, 'a, N, D, M, C> {
        Steps { run: self, over: false }
    }

    /// The states at `times`, in the order of the motion, each computed when it is asked for; the
    /// times may go on for ever, and change no step.
    ///
    /// They end with a terminal event that comes before the next time, and with an error: that of a
    /// step, or [`Error::Times`] for a time before the last step or beyond the end of the interval.
    pub fn states_at<I: IntoIterator<Item = f64>>(
        &mut self,
        times: I,
    ) -> StatesAt<'_, 'a, N, D, M, C, I::IntoIter> {
        StatesAt { run: self, times: times.into_iter(), index: 0, ended: false, over: false }
    }

    /// The state at a time in seconds within the last step; `None` outside, before the first step
    /// and after one that failed.
    ///
    /// Methods that need further evaluations for it take them now.
    pub fn at(&mut self, t: f64) -> Option<State<D::Scalar, N>> {
        self.integration.within(t)
    }

    /// Everything that the next steps need, with all bits: to go on later, or elsewhere, by
    /// [`restore`](Self::restore).
    ///
    /// The last step itself is no part of it, so that [`at`](Self::at) knows no step after
    /// `restore`. Neither is what lies outside of the integration: settings, and whatever events or
    /// controllers keep for themselves.
    pub fn save(&mut self) -> Saved {
        let mut memory = Memory::writer();
        self.remember(&mut memory);
        let system = <D::System as System<N>>::FACTS.name.to_owned();
        Saved { system, method: M::NAME.to_owned(), words: memory.into_words() }
    }

    /// Goes on from `saved`: the steps from there on have the bits that they would have had without
    /// the interruption.
    ///
    /// The integrator has to be built as the other was: with the same system, method, steps, events
    /// and stops. [`Error::Saved`] says if it obviously is not, and leaves it as it is. A
    /// controller that is [sampled](crate::system::Sampled) has a state that nobody can save:
    /// [`Error::SavedController`].
    pub fn restore(&mut self, saved: &Saved) -> Result<(), Error> {
        if D::SAMPLED {
            return Err(Error::SavedController);
        }
        if saved.system != <D::System as System<N>>::FACTS.name || saved.method != M::NAME {
            let Saved { system, method, .. } = saved.clone();
            return Err(Error::Saved { system, method });
        }
        let own = self.save();
        let mut memory = Memory::reader(saved.words.clone());
        self.remember(&mut memory);
        if !(memory.is_complete() && self.integration.end.is_finite()) {
            self.remember(&mut Memory::reader(own.words));
            let Saved { system, method, .. } = saved.clone();
            return Err(Error::Saved { system, method });
        }
        (self.ended, self.found) = (None, Vec::new());
        Ok(())
    }

    fn remember(&mut self, memory: &mut Memory) {
        self.integration.remember(memory);
        self.detector.remember(memory);
    }

    /// Puts the state elsewhere, or the same state to another time; what follows is as if the
    /// integration began there, with the first sample of a controller that is sampled.
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

    /// The impacts on the limits of the system in the last step.
    pub fn impacts(&self) -> &[Impact<D::Scalar, N>] {
        self.integration.impacts()
    }

    /// Returns true if the limit with this index in `FACTS.limits` is in contact at the state
    /// reached.
    pub fn in_contact(&self, limit: usize) -> bool {
        let [_, contacts] = Observed::contacts(&self.integration);
        limit < MOST_LIMITS && Contacts::from_bits(contacts).has(limit)
    }

    /// The index of the terminal event that has ended that call, or of the one that has come to
    /// rest.
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
        self.integration.interpolant().copied()
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

    /// The counters so far.
    pub fn stats(&self) -> Stats {
        self.integration.stats()
    }
}

/// The steps of an [`Integrator`], taken one by one.
#[derive(Debug)]
pub struct Steps<'r, 'a, const N: usize, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    run: &'r mut Integrator<'a, N, D, M, C>,
    over: bool,
}

impl<const N: usize, D, M, C> Iterator for Steps<'_, '_, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
    C: Controller<M, D, N>,
{
    type Item = Result<State<D::Scalar, N>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over || self.run.is_at_end() {
            return None;
        }
        let step = self.run.step();
        self.over = step.is_err() || self.run.ended.is_some();
        Some(step.map(|()| self.run.state()))
    }
}

/// The states of an [`Integrator`] at given times, computed one by one.
#[derive(Debug)]
pub struct StatesAt<'r, 'a, const N: usize, D, M, C, I>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    run: &'r mut Integrator<'a, N, D, M, C>,
    times: I,
    index: usize,
    /// A terminal event has happened in the last step.
    ended: bool,
    over: bool,
}

impl<const N: usize, D, M, C, I> StatesAt<'_, '_, N, D, M, C, I>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
    C: Controller<M, D, N>,
{
    /// The state at `t`; nothing if a terminal event comes before.
    fn state(&mut self, t: f64) -> Result<Option<State<D::Scalar, N>>, Error> {
        let (run, index) = (&mut *self.run, self.index);
        let onwards = run.goal.onwards;
        let refused = Error::Times { name: "states_at", index, time: t };
        if !(t.is_finite() && onwards * t <= onwards * run.goal.end) {
            return Err(refused);
        }
        while onwards * run.integration.end.t.since(t) < 0.0 {
            if self.ended {
                return Ok(None);
            }
            run.step()?;
            self.ended = run.ended.is_some();
        }
        let state = if run.t() == t { Some(run.state()) } else { run.at(t) };
        let facts = &<D::System as System<N>>::FACTS;
        let state = state.ok_or(refused)?;
        match first_in_state(facts, &state.q, &state.v) {
            Some(what) => Err(Error::NotFinite { t, what, suspects: Vec::new() }),
            None => Ok(Some(state)),
        }
    }
}

impl<const N: usize, D, M, C, I> Iterator for StatesAt<'_, '_, N, D, M, C, I>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
    C: Controller<M, D, N>,
    I: Iterator<Item = f64>,
{
    type Item = Result<State<D::Scalar, N>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over {
            return None;
        }
        let t = self.times.next()?;
        let state = self.state(t);
        self.index += 1;
        self.over = !matches!(state, Ok(Some(_)));
        state.transpose()
    }
}
