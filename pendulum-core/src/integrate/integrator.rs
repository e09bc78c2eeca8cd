//! Integration step by step, on demand.

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

/// An integration that takes steps on demand. Steps do not allocate.
///
/// [`new`](Self::new) borrows the system, [`owning`](Self::owning) owns it, and
/// [`Solve::start`](crate::integrate::Solve::start) uses the settings of a `solve`. An integrator
/// from `new` or `owning` has no interval, and its adaptive steps over a
/// [`Function`](crate::motion::Function) without a resolution are at most one second long.
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
/// After an error, the state is that before the failed step.
#[derive(Clone, Debug)]
pub struct Integrator<'a, const N: usize, D, M, C = AdaptiveStep<N>>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    integration: Integration<'a, N, D, M, C>,
    detector: EventDetector<'a, D::Scalar, N>,
    /// The events found in the last call.
    found: Vec<Occurrence<D::Scalar, N>>,
    ended: Option<Status>,
    max_steps: u64,
    goal: Goal,
}

/// The times at which steps have to end.
#[derive(Clone, Debug)]
struct Goal {
    /// The stops in ascending order.
    stops: Vec<f64>,
    /// The end of the interval; infinite without an interval.
    end: f64,
    /// The direction of time: 1 or −1.
    onwards: f64,
}

impl<'a, const N: usize, D, M> Integrator<'a, N, D, M>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Creates an integrator at the coordinates `q` and velocities `v` at time `t`, with the
    /// default tolerances.
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

    /// Creates an integrator that owns its system, so that a struct can hold both. The integrator
    /// is `'static` unless the events borrow.
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
    /// Creates an integrator with the end `end` of the interval.
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

    /// Returns the dynamics.
    pub fn dynamics(&self) -> &D {
        &self.integration.dynamics
    }

    /// Sets the controller of the steps: a [`FixedStep`](crate::integrate::FixedStep) or an
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

    /// Detects events from the current state on, forward and back in time. With an event that has
    /// an action, the integrator cannot go back in time.
    ///
    /// A terminal event ends the step and the call that leads to it, with the state at the event.
    /// The next call continues from that state, or from the state set by [`reset`](Self::reset).
    pub fn events(mut self, events: impl AsRef<[Event<'a, D::Scalar, N>]>) -> Result<Self, Error> {
        self.detector = EventDetector::new(events.as_ref());
        self.detector.begin(&mut self.integration)?;
        Ok(self)
    }

    /// Sets the maximum number of steps in one call of [`advance_to`](Self::advance_to); the
    /// default is ten million.
    pub fn max_steps(mut self, count: u64) -> Self {
        self.max_steps = count;
        self
    }

    /// Takes one step, as long as the controller allows. The step does not pass a kink or a known
    /// time of an event. It does not pass a stop or the end of the interval either, if the
    /// integrator was [started](crate::integrate::Solve::start) with them.
    #[inline]
    pub fn step(&mut self) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        self.found.clear();
        self.ended = None;
        self.step_onwards()
    }

    /// Takes one step towards the end of the interval, or beyond the end once it is reached.
    #[inline]
    fn step_onwards(&mut self) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        let Goal { end, onwards, .. } = self.goal;
        let target = if self.is_at_end() { onwards * f64::INFINITY } else { end };
        self.step_towards(target)
    }

    /// Checks that the integration can go back in time to `t`.
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

    /// Returns `true` if the end of the interval is reached.
    fn is_at_end(&self) -> bool {
        0.0 <= self.goal.onwards * self.integration.end.t.since(self.goal.end)
    }

    /// Returns the next stop on the way to `target`, or `target`.
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
        if !self.detector.is_idle() {
            self.detector.accuracy = self.integration.controller.accuracy();
        }
        let ended = self.detector.observe(&mut self.integration);
        self.found.extend_from_slice(self.detector.found());
        self.ended = ended?;
        Ok(())
    }

    /// Takes steps until the time is exactly `t` or a terminal event happens.
    ///
    /// For a `t` before the current time the integration goes back in time. The method has to
    /// support this direction, no event may have an action, and the system may have no limits.
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

    /// Returns an iterator over the states at the ends of the next steps; each step is taken on
    /// demand.
    ///
    /// The iterator ends after a terminal event, after an error, and at the end of the interval if
    /// the integrator was [started](crate::integrate::Solve::start) with one.
    pub fn steps(&mut self) -> impl Iterator<Item = Result<State<D::Scalar, N>, Error>>
    where
        C: Controller<M, D, N>,
    {
        let mut over = false;
        core::iter::from_fn(move || {
            if over || self.is_at_end() {
                return None;
            }
            let step = self.step();
            over = step.is_err() || self.ended.is_some();
            Some(step.map(|()| self.state()))
        })
    }

    /// Returns an iterator over the states at `times`, in the order of the motion; each state is
    /// computed on demand. The iterator of times may be infinite. The times do not change the
    /// steps.
    ///
    /// The iterator ends before the first time beyond a terminal event, and after an error: the
    /// error of a step, or [`Error::Times`] for a time before the last step or beyond the end of
    /// the interval.
    pub fn states_at(
        &mut self,
        times: impl IntoIterator<Item = f64>,
    ) -> impl Iterator<Item = Result<State<D::Scalar, N>, Error>>
    where
        C: Controller<M, D, N>,
    {
        let (mut times, mut ended, mut over) = (times.into_iter().enumerate(), false, false);
        core::iter::from_fn(move || {
            if over {
                return None;
            }
            let (index, t) = times.next()?;
            let state = self.state_at(index, t, &mut ended);
            over = !matches!(state, Ok(Some(_)));
            state.transpose()
        })
    }

    /// Returns the state at `t`, the time with this index, or `None` if a terminal event comes
    /// first; `ended` says whether one has happened in the last step.
    fn state_at(
        &mut self,
        index: usize,
        t: f64,
        ended: &mut bool,
    ) -> Result<Option<State<D::Scalar, N>>, Error>
    where
        C: Controller<M, D, N>,
    {
        let onwards = self.goal.onwards;
        let refused = Error::Times { name: "states_at", index, time: t };
        if !(t.is_finite() && onwards * t <= onwards * self.goal.end) {
            return Err(refused);
        }
        while onwards * self.integration.end.t.since(t) < 0.0 {
            if *ended {
                return Ok(None);
            }
            self.step()?;
            *ended = self.ended.is_some();
        }
        let state = if self.t() == t { Some(self.state()) } else { self.at(t) };
        let facts = &<D::System as System<N>>::FACTS;
        let state = state.ok_or(refused)?;
        match first_in_state(facts, &state.q, &state.v) {
            Some(what) => Err(Error::NotFinite { t, what, suspects: Vec::new() }),
            None => Ok(Some(state)),
        }
    }

    /// Returns the state at the time `t` in seconds within the last step, or `None` outside that
    /// step, before the first step and after a failed step.
    ///
    /// If the method needs further evaluations for the interpolant, this call performs them.
    pub fn at(&mut self, t: f64) -> Option<State<D::Scalar, N>> {
        self.integration.within(t)
    }

    /// Saves all data that the next steps depend on, bit by bit, for a later
    /// [`restore`](Self::restore) into this or another integrator.
    ///
    /// The last step is not saved, so that [`at`](Self::at) returns `None` directly after
    /// `restore`. Data outside of the integration is not saved either: settings, and the internal
    /// data of events and controllers.
    pub fn save(&mut self) -> Saved {
        let mut memory = Memory::writer();
        self.remember(&mut memory);
        let system = <D::System as System<N>>::FACTS.name.to_owned();
        Saved { system, method: M::NAME.to_owned(), words: memory.into_words() }
    }

    /// Continues from `saved`: the following steps have the same bits as without the interruption.
    ///
    /// The integrator has to be built like the saved one, with the same system, method, steps,
    /// events and stops.
    ///
    /// # Errors
    /// Returns [`Error::Saved`] if `saved` has another system or method, or if its data do not fit,
    /// and leaves the integrator unchanged. Returns [`Error::SavedController`] for a controller
    /// that is [sampled](crate::system::Sampled), because the state of such a controller cannot be
    /// saved.
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

    /// Sets the time and the state. The integration continues as if it had begun there, with the
    /// first sample of a sampled controller.
    pub fn reset(&mut self, t: f64, q: [D::Scalar; N], v: [D::Scalar; N]) -> Result<(), Error> {
        self.integration.reset(t, q, v)?;
        self.detector.begin(&mut self.integration)
    }

    /// Moves the coordinates by `high + low` and keeps the low words of the state, which
    /// [`reset`](Self::reset) discards.
    ///
    /// This removes whole turns from an angle that grows without bound, and whose forces would
    /// otherwise lose a digit with every tenfold growth of the angle:
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

    /// Returns the events found in the last call of [`step`](Self::step) or
    /// [`advance_to`](Self::advance_to), in order.
    pub fn occurrences(&self) -> &[Occurrence<D::Scalar, N>] {
        &self.found
    }

    /// Returns the impacts on the limits of the system in the last step.
    pub fn impacts(&self) -> &[Impact<D::Scalar, N>] {
        self.integration.impacts()
    }

    /// Returns `true` if the limit with this index in `FACTS.limits` is in contact at the current
    /// state.
    pub fn in_contact(&self, limit: usize) -> bool {
        let [_, contacts] = Observed::contacts(&self.integration);
        limit < MOST_LIMITS && Contacts::from_bits(contacts).has(limit)
    }

    /// Returns the index of the terminal event that ended the last call, or of the event that came
    /// to rest.
    pub fn terminal_event(&self) -> Option<usize> {
        match self.ended {
            Some(Status::Event(event) | Status::Rest(event)) => Some(event),
            _ => None,
        }
    }

    /// Returns the motion within the last step, or `None` before the first step and after a failed
    /// step.
    ///
    /// If the method needs further evaluations for the interpolant, this call performs them.
    pub fn interpolant(&mut self) -> Option<Interpolant<D::Scalar, N>> {
        self.integration.interpolant().copied()
    }

    /// Returns the time reached.
    pub fn t(&self) -> f64 {
        self.integration.t()
    }

    /// Returns the coordinates.
    pub fn q(&self) -> &[D::Scalar; N] {
        &self.integration.end.q.high
    }

    /// Returns the velocities; at a kink, the velocities beyond the kink.
    pub fn v(&self) -> &[D::Scalar; N] {
        &self.integration.end.v.high
    }

    /// Returns the time, the coordinates and the velocities.
    pub fn state(&self) -> State<D::Scalar, N> {
        State::from(&self.integration.end)
    }

    /// Returns the counters of the integration so far.
    pub fn stats(&self) -> Stats {
        self.integration.stats()
    }
}
