//! The loop that all ways of integrating share: one step at a time, up to kinks and over them.

mod impacts;
mod kinks;
pub(in crate::integrate) mod limited;
mod memory;
mod observed;
mod parts;
mod states;

use crate::error::Error;
use crate::integrate::events::observed::Observed;
use crate::integrate::field::contacts::{self, has_contacts};
use crate::integrate::field::grasp::frictions;
use crate::integrate::field::inertia::{inertia, is_due, varies};
use crate::integrate::field::phase::{Phase, has_states};
use crate::integrate::field::{Field, PreparedOf};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::interpolant::within;
use crate::integrate::method::Method;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::stats::Stats;
use crate::integrate::step::arguments::Arguments;
use crate::integrate::step::contact;
use crate::integrate::step::controller::{Controller, ControllerState, StepContext};
use crate::integrate::step::held::Held;
use crate::integrate::step::limits::Limits;
use crate::integrate::step::projection::{self, Gradients};
use crate::integrate::step::short::{self, is_short};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, System, is_constrained};
use crate::time::Time;
use kinks::{next_kink, onwards};

pub(crate) use kinks::{check_start, cross};

/// An integration between two steps.
#[derive(Clone, Debug)]
pub(crate) struct Integration<'a, const N: usize, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    pub(crate) dynamics: Held<'a, D>,
    prepared: PreparedOf<D, N>,
    pub(crate) method: M,
    pub(crate) controller: C,
    /// The state reached; at a kink, the state beyond the kink.
    pub(crate) end: Endpoint<D::Scalar, N>,
    pub(crate) stats: Stats,
    /// The last step; `None` before the first step and after a failed step.
    last: Option<StepInterval>,
    /// The start of the last step.
    from: Endpoint<D::Scalar, N>,
    /// The motion within the last step, computed on first use.
    interpolant: Option<Interpolant<D::Scalar, N>>,
    /// The end of the last step before a kink, an impact or a jump, if the step ended on one of
    /// these.
    before_kink: Option<Endpoint<D::Scalar, N>>,
    workspace: M::Workspace,
    state: ControllerState,
    /// `true` if the last step went back in time.
    backwards: bool,
    /// The next kink in the direction of the integration, infinite if there is none.
    kink: f64,
    /// `true` if the last step ended on a kink.
    crossed: bool,
    /// The state of the limits.
    limits: Limits<D::Scalar, N>,
    /// The largest gradients of the constraints so far.
    gradients: Gradients<N>,
    /// The switches and layers along the last step.
    arguments: Arguments<D::Scalar>,
    /// `true` if the last step was a straight line over a switch.
    straight: bool,
}

impl<'a, const N: usize, D, M, C> Integration<'a, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Creates an integration at `q`, `v` and `t`. Returns an error if they are not finite or if
    /// the mass matrix is not positive there.
    pub(crate) fn new(
        mut dynamics: Held<'a, D>,
        method: M,
        controller: C,
        t: f64,
        q: [D::Scalar; N],
        v: [D::Scalar; N],
    ) -> Result<Self, Error> {
        check_start(&*dynamics, Time::new(t), &q, &v)?;
        let end = projection::start(&*dynamics, Time::new(t), Side::After, q, v)?;
        dynamics.begin(t);
        let stats = Stats::new(M::NAME);
        let mut integration = Self::resumed(dynamics, method, controller, end, stats, false)?;
        integration.settle_start()?;
        integration.check_limits()?;
        Ok(integration)
    }

    /// Creates an integration that continues from the state of another one without limits, with its
    /// counters.
    pub(crate) fn resumed(
        dynamics: Held<'a, D>,
        method: M,
        controller: C,
        end: Endpoint<D::Scalar, N>,
        stats: Stats,
        backwards: bool,
    ) -> Result<Self, Error> {
        let limits = Limits::new(contacts::limits::<D, N>(), frictions::<D, N>());
        let parts = (limits, Arguments::new::<D, N>());
        Self::assembled(dynamics, method, controller, (end, stats), backwards, parts)
    }

    /// Creates an integration from its state, its counters and the memory of its steps.
    fn assembled(
        dynamics: Held<'a, D>,
        method: M,
        controller: C,
        (end, stats): (Endpoint<D::Scalar, N>, Stats),
        backwards: bool,
        (limits, arguments): (Limits<D::Scalar, N>, Arguments<D::Scalar>),
    ) -> Result<Self, Error> {
        let kink = next_kink(&method, &*dynamics, end.t.to_f64(), backwards)?;
        let mut state = ControllerState::default();
        if 0 < stats.accepted {
            // The next step is not a first step.
            state.h = f64::MIN_POSITIVE;
        }
        Ok(Self {
            prepared: dynamics.system().prepare(),
            workspace: method.workspace(&dynamics),
            dynamics,
            method,
            controller,
            end,
            stats,
            last: None,
            from: end,
            interpolant: None,
            before_kink: None,
            state,
            backwards,
            kink,
            crossed: false,
            limits,
            gradients: Gradients::new(),
            arguments,
            straight: false,
        })
    }

    /// Returns the workspace of the method.
    pub(crate) fn workspace(&self) -> &M::Workspace {
        &self.workspace
    }

    /// Sets the state. The counters stay, and the steps are chosen as at a start.
    pub(crate) fn reset(
        &mut self,
        t: f64,
        q: [D::Scalar; N],
        v: [D::Scalar; N],
    ) -> Result<(), Error> {
        check_start(&*self.dynamics, Time::new(t), &q, &v)?;
        let end = projection::start(&*self.dynamics, Time::new(t), Side::After, q, v)?;
        self.dynamics.begin(t);
        self.kink = next_kink(&self.method, &*self.dynamics, t, false)?;
        self.backwards = false;
        // A long step, chosen for another state, might skip events.
        self.state = ControllerState { unknown: self.state.unknown, ..ControllerState::default() };
        self.workspace = self.method.workspace(&self.dynamics);
        self.end = end;
        (self.last, self.interpolant, self.before_kink) = (None, None, None);
        self.crossed = false;
        self.settle_start()?;
        self.check_limits()
    }

    /// Moves the coordinates by `high + low`, and keeps the low words.
    pub(crate) fn displace(
        &mut self,
        high: &[D::Scalar; N],
        low: &[D::Scalar; N],
    ) -> Result<(), Error> {
        let mut q = self.end.q;
        q.add_both(D::Scalar::from_f64(1.0), high, low);
        check_start(&*self.dynamics, self.end.t, &q.high, &self.end.v.high)?;
        projection::start(&*self.dynamics, self.end.t, Side::After, q.high, self.end.v.high)?;
        (self.end.q, self.end.a) = (q, None);
        self.end.settle(&*self.dynamics, onwards(self.backwards));
        (self.last, self.interpolant, self.before_kink) = (None, None, None);
        self.crossed = false;
        self.check_limits()
    }

    /// Returns the same integration with another controller.
    pub(crate) fn controlled<B>(self, controller: B) -> Integration<'a, N, D, M, B> {
        Integration {
            dynamics: self.dynamics,
            prepared: self.prepared,
            method: self.method,
            controller,
            end: self.end,
            stats: self.stats,
            last: self.last,
            from: self.from,
            interpolant: self.interpolant,
            before_kink: self.before_kink,
            workspace: self.workspace,
            state: ControllerState { unknown: self.state.unknown, ..ControllerState::default() },
            backwards: self.backwards,
            kink: self.kink,
            crossed: self.crossed,
            limits: self.limits,
            gradients: self.gradients,
            arguments: self.arguments,
            straight: self.straight,
        }
    }

    /// Returns the same integration, with this length of its interval for the bound on steps.
    pub(crate) fn over(mut self, length: f64) -> Self {
        self.state.unknown = ControllerState::over(length).unknown;
        self
    }

    /// Takes one step towards `target`, which may be infinite, and crosses the kink if the step
    /// ends on one.
    ///
    /// After a failure, the state is that before the step.
    #[inline]
    pub(crate) fn step(&mut self, target: f64) -> Result<(), Error>
    where
        C: Controller<M, D, N>,
    {
        let backwards = 0.0 < self.end.t.since(target);
        if backwards != self.backwards {
            self.turn(backwards)?;
        }
        self.sample()?;
        let kink_comes_first = if backwards { target < self.kink } else { self.kink < target };
        let target = if kink_comes_first { self.kink } else { target };
        self.from = self.end;
        let mut met = None;
        let taken = if const { has_contacts::<D, N>() } {
            self.step_to_limit(target, &mut met)
        } else {
            self.take(target)
        };
        match taken.and_then(|interval| self.arrive(&interval).map(|()| interval)) {
            Ok(interval) => (self.last, self.interpolant) = (Some(interval), None),
            Err(error) => {
                self.end = self.from;
                // The workspace belongs to the failed step.
                (self.last, self.interpolant) = (None, None);
                if const { has_contacts::<D, N>() } {
                    self.limits.undo();
                }
                return Err(error);
            }
        }
        if const { has_contacts::<D, N>() }
            && (met.is_some() || self.crossed && self.limits.is_close())
        {
            self.resolve_limits(met)?;
        }
        if is_due::<D::System, N>(self.stats.accepted, self.before_kink.is_some()) {
            self.check_inertia()
        } else {
            Ok(())
        }
    }

    /// Takes one step from `self.from` towards `target`, and moves its end onto constraints and
    /// contacts.
    #[inline]
    fn take_whole(&mut self, target: f64) -> Result<StepInterval, Error>
    where
        C: Controller<M, D, N>,
    {
        if const { has_states::<D, N>() } {
            return self.take_without_jumps(target);
        }
        let interval = self.take_once(target)?;
        self.project_end(interval.h)?;
        Ok(interval)
    }

    /// Takes one step from `self.from` towards `target`, whose end may be beside constraints and
    /// contacts.
    #[inline]
    fn take_once(&mut self, target: f64) -> Result<StepInterval, Error>
    where
        C: Controller<M, D, N>,
    {
        let mut field = Field::new(&*self.dynamics, &self.prepared);
        field.backwards = self.backwards;
        if const { has_contacts::<D, N>() } {
            field.contacts = self.limits.contacts();
        }
        let context = StepContext {
            method: &self.method,
            field: &mut field,
            from: &mut self.from,
            to: &mut self.end,
            workspace: &mut self.workspace,
            target,
            stats: &mut self.stats,
        };
        let left = -context.from.t.since(target);
        let taken = if is_short::<D::Scalar>(left) {
            short::take(context)
        } else {
            self.controller.step(&mut self.state, context)
        };
        self.stats.evaluations += field.evaluations;
        taken
    }

    /// Samples a sampled controller if a sample is due.
    #[inline]
    fn sample(&mut self) -> Result<(), Error> {
        let Endpoint { t, q, v, .. } = &self.end;
        if self.dynamics.sample(*t, &q.high, &v.high)? {
            self.end.a = None;
            self.end.settle(&*self.dynamics, onwards(self.backwards));
        }
        Ok(())
    }

    /// Moves the end of a step of the length `h` onto the constraints and the limits in contact, and
    /// sets the velocities of the states. Returns `true` if the rate of a state has jumped.
    #[inline]
    fn project_end(&mut self, h: f64) -> Result<bool, Error>
    where
        C: Controller<M, D, N>,
    {
        let mut moved = false;
        let side = onwards(self.backwards).opposite();
        if const { is_constrained::<D, N>() } {
            let Self { dynamics, end, stats, gradients, .. } = self;
            let stats = &mut stats.constraints;
            moved = projection::project_end(&**dynamics, end, side, stats, gradients)?;
        }
        if const { has_contacts::<D, N>() } {
            let contacts = self.limits.contacts();
            if contacts.hold() {
                contact::project_end(&*self.dynamics, &mut self.end, side, &contacts);
                contact::check_room(&self.end.phase(&*self.dynamics, side), &contacts)?;
                moved = true;
            }
        }
        let mut jumped = false;
        if const { has_states::<D, N>() } {
            let v = self.end.v.high;
            self.end.settle(&*self.dynamics, side);
            (jumped, moved) = (self.has_jumped(&v, h), true);
        }
        if moved {
            self.method.moved(&self.dynamics, &mut self.workspace, &self.end);
        }
        Ok(jumped)
    }

    /// Carries the state over the kink if a step over `interval` has ended on the kink.
    #[inline]
    fn arrive(&mut self, interval: &StepInterval) -> Result<(), Error> {
        if interval.end == Time::new(self.kink) {
            let before = self.end;
            cross(&*self.dynamics, &mut self.end, self.backwards)?;
            self.kink = next_kink(&self.method, &*self.dynamics, self.kink, self.backwards)?;
            self.stats.kinks += 1;
            self.before_kink = Some(before);
            self.crossed = true;
            return Ok(());
        }
        self.crossed = false;
        if self.before_kink.is_some() {
            self.before_kink = None;
        }
        Ok(())
    }

    /// Checks that the mass matrix is positive at the end of the last step. Otherwise takes the
    /// step back, and does not count it.
    // Separate from the code of the steps.
    #[cold]
    #[inline(never)]
    pub(crate) fn check_inertia(&mut self) -> Result<(), Error> {
        if !varies(&<D::System as System<N>>::FACTS) {
            return Ok(());
        }
        let checked = inertia(&self.end.phase(&*self.dynamics, onwards(self.backwards)));
        if checked.is_err() {
            self.retreat();
            self.stats.accepted -= 1;
        }
        checked
    }

    /// Reverses the direction of the integration.
    #[cold]
    fn turn(&mut self, backwards: bool) -> Result<(), Error> {
        self.kink = next_kink(&self.method, &*self.dynamics, self.t(), backwards)?;
        self.backwards = backwards;
        if let Some(before) = self.before_kink.take() {
            self.end = before;
        }
        Ok(())
    }

    /// Returns the motion within the last step, if any, and performs further evaluations if the
    /// method needs them.
    pub(crate) fn interpolant(&mut self) -> Option<&Interpolant<D::Scalar, N>> {
        let interval = self.last?;
        if self.interpolant.is_none() {
            let mut to = self.before_kink.unwrap_or(self.end);
            self.interpolant = Some(self.motion(&interval, &mut to));
            *self.before_kink.as_mut().unwrap_or(&mut self.end) = to;
        }
        self.interpolant.as_ref()
    }

    /// Returns the motion within the step just taken.
    fn motion(
        &mut self,
        interval: &StepInterval,
        to: &mut Endpoint<D::Scalar, N>,
    ) -> Interpolant<D::Scalar, N> {
        if is_short::<D::Scalar>(interval.h) || interval.h == 0.0 || self.straight {
            return Interpolant::linear(interval, &self.from, to);
        }
        let mut field = Field::new(&*self.dynamics, &self.prepared);
        field.backwards = self.backwards;
        if const { has_contacts::<D, N>() } {
            field.contacts = self.limits.began();
        }
        let mut interpolant =
            self.method.interpolant(&mut field, interval, &mut self.from, to, &mut self.workspace);
        self.stats.evaluations += field.evaluations;
        if const { is_constrained::<D, N>() || has_contacts::<D, N>() || has_states::<D, N>() } {
            interpolant.end_at(to);
        }
        interpolant
    }

    /// Returns the state at `t` within the last step, on the constraints, or `None` outside.
    pub(crate) fn within(&mut self, t: f64) -> Option<State<D::Scalar, N>> {
        let (start, end) = (self.last_start().t, State::from(&self.end));
        let mut state = within(start, end, t, || self.interpolant())?;
        if t != end.t {
            Observed::deliver(self, Time::new(t), &mut state);
        }
        Some(state)
    }

    /// Returns the accelerations at the state reached; the next step begins with them.
    pub(crate) fn accelerations(&mut self) -> [D::Scalar; N] {
        // The next step meets the same error, and returns it.
        let _ = self.sample();
        let mut field = Field::new(&*self.dynamics, &self.prepared);
        field.backwards = self.backwards;
        if const { has_contacts::<D, N>() } {
            field.contacts = self.limits.contacts();
        }
        let a = self.end.start_acceleration(&mut field);
        self.stats.evaluations += field.evaluations;
        a
    }

    /// Ends the last step at a state within the step.
    pub(crate) fn cut(&mut self, t: Time, state: &State<D::Scalar, N>) {
        self.uncross();
        self.end = Endpoint::new(t, state.q, state.v);
        self.end.settle(&*self.dynamics, onwards(self.backwards).opposite());
    }

    /// Sets another state at the same time: a jump at the end of the last step. The next steps are
    /// chosen as at a start.
    pub(crate) fn jump(&mut self, state: &State<D::Scalar, N>) -> Result<(), Error> {
        let (before, backwards) = (self.end, self.backwards);
        let side = onwards(backwards);
        let Self { dynamics, .. } = self;
        inertia(&Phase { dynamics: &**dynamics, t: before.t, side, q: &state.q, v: &state.v })?;
        let state = &projection::landed(&*self.dynamics, before.t, side, state)?;
        self.end.q.jump(&state.q);
        self.end.v.jump(&state.v);
        self.end.a = None;
        self.end.settle(&*self.dynamics, side);
        self.before_kink.get_or_insert(before);
        self.state = ControllerState { unknown: self.state.unknown, ..ControllerState::default() };
        self.check_limits()
    }

    /// Returns the state at the start of the last step.
    pub(crate) fn last_start(&self) -> State<D::Scalar, N> {
        State::from(&self.from)
    }

    /// Takes the last step back.
    pub(crate) fn retreat(&mut self) {
        self.uncross();
        self.end = self.from;
        (self.last, self.interpolant) = (None, None);
    }

    /// Undoes the crossing of a kink at the end of the last step, and the plan that led there.
    fn uncross(&mut self) {
        (self.state.left, self.state.ahead) = (0, 0.0);
        if let Some(before) = self.before_kink.take()
            && (self.crossed || const { !has_contacts::<D, N>() })
        {
            self.kink = before.t.to_f64();
            self.stats.kinks -= 1;
        }
        if const { has_contacts::<D, N>() } {
            self.crossed = false;
            self.limits.undo();
        }
    }

    /// Returns the counters so far, with the name of the method that took the steps.
    pub(crate) fn stats(&self) -> Stats {
        Stats { method: self.method.name(&self.workspace), ..self.stats }
    }

    /// Returns the time reached.
    pub(crate) fn t(&self) -> f64 {
        self.end.t.to_f64()
    }
}
