//! The loop that all ways of integrating share: one step at a time, onto kinks and over them.

use crate::error::{Error, Part, Quantity};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::solution::{State, Stats};
use crate::integrate::step::controller::{Control, ControllerState, StepContext};
use crate::integrate::step::diagnose::blame;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::field::{Counted, coordinate, first_in_inputs, first_in_state};
use crate::integrate::step::gap::PART;
use crate::integrate::step::inertia::{inertia, is_due, varies};
use crate::integrate::step::interval::StepInterval;
use crate::integrate::step::short::{is_short, straight};
use crate::integrate::step::stepper::Stepper;
use crate::motion::Side;
use crate::real::Float;
use crate::system::{Dynamics, Purpose, System};
use crate::time::Time;

/// An integration under way, apart from the dynamics.
#[derive(Clone, Debug)]
pub(crate) struct Driver<T, const N: usize, M, C, R> {
    pub(crate) method: M,
    pub(crate) control: C,
    /// The state reached; at a kink the one beyond it.
    pub(crate) node: Endpoint<T, N>,
    pub(crate) stats: Stats,
    /// The last step and the node at its start; nothing before the first step and after one that
    /// failed.
    last: Option<StepInterval>,
    from: Endpoint<T, N>,
    /// The motion within it, once somebody has asked.
    within: Option<Interpolant<T, N>>,
    /// The node at its end on this side of the kink, if it ended on one.
    before_kink: Option<Endpoint<T, N>>,
    stages: R,
    memory: ControllerState,
    /// Whether the last step went back in time.
    backwards: bool,
    /// The next kink in that direction, infinite if there is none.
    kink: f64,
}

impl<T: Float, const N: usize, M: Copy, C, R> Driver<T, N, M, C, R> {
    /// At `q`, `v` and `t`, if they are finite and the mass matrix is positive there.
    pub(crate) fn new<D>(
        dynamics: &D,
        method: M,
        control: C,
        t: f64,
        q: [T; N],
        v: [T; N],
    ) -> Result<Self, Error>
    where
        D: Dynamics<N, Scalar = T>,
        M: Stepper<D, N, Stages = R>,
    {
        check_start(dynamics, Time::new(t), &q, &v)?;
        let node = Endpoint::new(Time::new(t), q, v);
        let kink = next_kink(&method, dynamics, t, false)?;
        let stats = Stats::new(M::NAME);
        let (stages, memory) = (method.workspace(dynamics), ControllerState::default());
        Ok(Self {
            method,
            control,
            node,
            stats,
            last: None,
            from: node,
            within: None,
            before_kink: None,
            stages,
            memory,
            backwards: false,
            kink,
        })
    }

    /// Puts the state elsewhere; counters stay, steps are chosen as at a start.
    pub(crate) fn reset<D>(
        &mut self,
        dynamics: &D,
        t: f64,
        q: [T; N],
        v: [T; N],
    ) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar = T>,
        M: Stepper<D, N, Stages = R>,
    {
        check_start(dynamics, Time::new(t), &q, &v)?;
        self.kink = next_kink(&self.method, dynamics, t, false)?;
        self.backwards = false;
        // A long step from a state that it was not chosen for may go over events.
        self.memory =
            ControllerState { unknown: self.memory.unknown, ..ControllerState::default() };
        self.node = Endpoint::new(Time::new(t), q, v);
        (self.last, self.within, self.before_kink) = (None, None, None);
        Ok(())
    }

    /// Moves the coordinates by `high + low`; what rounding has left off stays.
    pub(crate) fn displace<D>(
        &mut self,
        dynamics: &D,
        high: &[T; N],
        low: &[T; N],
    ) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar = T>,
    {
        let mut q = self.node.q;
        q.add_both(T::from_f64(1.0), high, low);
        check_start(dynamics, self.node.t, &q.high, &self.node.v.high)?;
        (self.node.q, self.node.a) = (q, None);
        (self.last, self.within, self.before_kink) = (None, None, None);
        Ok(())
    }

    /// The same integration under another control.
    pub(crate) fn controlled<B>(self, control: B) -> Driver<T, N, M, B, R> {
        let Self {
            method,
            node,
            stats,
            last,
            from,
            within,
            before_kink,
            stages,
            memory,
            backwards,
            kink,
            ..
        } = self;
        let memory = ControllerState { unknown: memory.unknown, ..ControllerState::default() };
        Driver {
            method,
            control,
            node,
            stats,
            last,
            from,
            within,
            before_kink,
            stages,
            memory,
            backwards,
            kink,
        }
    }

    /// The same integration, which is known to go over an interval of this length.
    pub(crate) fn over(mut self, length: f64) -> Self {
        // Part of a length of few units in the last place may be none, which is no length of a
        // step.
        self.memory.unknown = f64::max(PART * length, f64::MIN_POSITIVE);
        self
    }

    /// Takes one step towards `target`, which may be infinite, and over a kink if it ends on one.
    ///
    /// On failure the state is the one before the step.
    #[inline]
    pub(crate) fn step<D>(&mut self, dynamics: &D, target: f64) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar = T>,
        M: Stepper<D, N, Stages = R>,
        C: Control<M, D, N>,
    {
        let backwards = 0.0 < self.node.t.since(target);
        if backwards != self.backwards {
            self.turn(dynamics, backwards)?;
        }
        let kink_comes_first = if backwards { target < self.kink } else { self.kink < target };
        let target = if kink_comes_first { self.kink } else { target };
        let mut field = Counted::new(dynamics);
        let mut from = self.node;
        let course = StepContext {
            method: &self.method,
            field: &mut field,
            from: &mut from,
            to: &mut self.node,
            stages: &mut self.stages,
            target,
            stats: &mut self.stats,
        };
        let left = -course.from.t.since(target);
        let taken = if is_short::<T>(left) {
            short(course)
        } else {
            self.control.step(&mut self.memory, course)
        };
        self.stats.evaluations += field.evaluations;
        match taken.and_then(|interval| self.arrive(dynamics, &interval).map(|()| interval)) {
            Ok(interval) => (self.last, self.within, self.from) = (Some(interval), None, from),
            Err(error) => {
                self.node = from;
                // The stages are those of the step that failed.
                (self.last, self.within) = (None, None);
                return Err(error);
            }
        }
        if is_due::<D::System, N>(self.stats.accepted, self.before_kink.is_some()) {
            self.look(dynamics)
        } else {
            Ok(())
        }
    }

    /// Carries the state over the kink if a step over `interval` has ended on it.
    #[inline]
    fn arrive<D>(&mut self, dynamics: &D, interval: &StepInterval) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar = T>,
        M: Stepper<D, N, Stages = R>,
    {
        if interval.end == Time::new(self.kink) {
            let before = self.node;
            cross(dynamics, &mut self.node, self.backwards)?;
            self.kink = next_kink(&self.method, dynamics, self.kink, self.backwards)?;
            self.stats.kinks += 1;
            self.before_kink = Some(before);
        } else if self.before_kink.is_some() {
            self.before_kink = None;
        }
        Ok(())
    }

    /// Takes the last step back if the mass matrix is not positive at its end; it does not count
    /// then.
    // Out of the way of the steps.
    #[cold]
    #[inline(never)]
    pub(crate) fn look<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D) -> Result<(), Error> {
        if !varies(&<D::System as System<N>>::FACTS) {
            return Ok(());
        }
        let Endpoint { t, q, v, .. } = &self.node;
        let checked = inertia(dynamics, *t, onwards(self.backwards), &q.high, &v.high);
        if checked.is_err() {
            self.retreat();
            self.stats.accepted -= 1;
        }
        checked
    }

    /// Goes on in the other direction.
    #[cold]
    fn turn<D>(&mut self, dynamics: &D, backwards: bool) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar = T>,
        M: Stepper<D, N, Stages = R>,
    {
        self.kink = next_kink(&self.method, dynamics, self.t(), backwards)?;
        self.backwards = backwards;
        if let Some(before) = self.before_kink.take() {
            self.node = before;
        }
        Ok(())
    }

    /// The motion within the last step, if there was one; evaluates what the method needs for it.
    pub(crate) fn interpolant<D>(&mut self, dynamics: &D) -> Option<Interpolant<T, N>>
    where
        D: Dynamics<N, Scalar = T>,
        M: Stepper<D, N, Stages = R>,
    {
        let interval = self.last.as_ref()?;
        if self.within.is_some() {
            return self.within;
        }
        let to = self.before_kink.as_mut().unwrap_or(&mut self.node);
        if is_short::<T>(interval.h) {
            self.within = Some(Interpolant::linear(interval, &self.from, to));
            return self.within;
        }
        let mut field = Counted::new(dynamics);
        let interpolant =
            self.method.within(&mut field, interval, &mut self.from, to, &mut self.stages);
        self.stats.evaluations += field.evaluations;
        self.within = Some(interpolant);
        self.within
    }

    /// The accelerations at the state reached; the next step begins with them.
    pub(crate) fn accelerations<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D) -> [T; N] {
        let mut field = Counted::new(dynamics);
        let a = self.node.start_acceleration(&mut field);
        self.stats.evaluations += field.evaluations;
        a
    }

    /// The end of the last step; if that was on a kink, the states on both sides.
    pub(crate) fn ends(&self) -> (Endpoint<T, N>, Option<Endpoint<T, N>>) {
        self.before_kink.map_or((self.node, None), |before| (before, Some(self.node)))
    }

    /// Ends the last step at a state within.
    pub(crate) fn cut(&mut self, t: Time, state: &State<T, N>) {
        self.uncross();
        self.node = Endpoint::new(t, state.q, state.v);
    }

    /// Takes the last step back.
    pub(crate) fn retreat(&mut self) {
        self.uncross();
        self.node = self.from;
        (self.last, self.within) = (None, None);
    }

    /// Forgets that the last step ended on a kink, and the plan that led there.
    fn uncross(&mut self) {
        self.memory.left = 0;
        if let Some(before) = self.before_kink.take() {
            self.kink = before.t.to_f64();
            self.stats.kinks -= 1;
        }
    }

    /// The state on this side of a kink, if the last step has ended on one.
    pub(crate) fn before_kink(&self) -> Option<&Endpoint<T, N>> {
        self.before_kink.as_ref()
    }

    /// What it took so far, and which method took it.
    pub(crate) fn stats<D>(&self) -> Stats
    where
        D: Dynamics<N, Scalar = T>,
        M: Stepper<D, N, Stages = R>,
    {
        Stats { method: self.method.name(&self.stages), ..self.stats }
    }

    /// The time reached.
    pub(crate) fn t(&self) -> f64 {
        self.node.t.to_f64()
    }
}

/// A single step to a target so near that the scalar does not hold the distance.
#[cold]
fn short<D, M, T, const N: usize>(
    course: StepContext<'_, '_, D, M, N>,
) -> Result<StepInterval, Error>
where
    D: Dynamics<N, Scalar = T>,
    M: Stepper<D, N>,
    T: Float,
{
    let StepContext { method, field, from, to, stages, target, stats } = course;
    let interval = StepInterval::to(from.t, target);
    *to = straight(field, &interval, from);
    if !to.is_finite() {
        return Err(blame(method, field.dynamics, &interval, from, stages));
    }
    stats.accepted += 1;
    Ok(interval)
}

/// The side of the start of a step.
fn onwards(backwards: bool) -> Side {
    if backwards { Side::Before } else { Side::After }
}

/// Whether an integration can begin there.
pub(crate) fn check_start<D: Dynamics<N, Scalar = T>, T: Float, const N: usize>(
    dynamics: &D,
    time: Time,
    q: &[T; N],
    v: &[T; N],
) -> Result<(), Error> {
    let t = time.to_f64();
    if !t.is_finite() {
        return Err(Error::Interval { start: t, end: t });
    }
    for (part, values) in [(Part::Position, q), (Part::Velocity, v)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let coordinate = coordinate(&<D::System as System<N>>::FACTS, index);
            return Err(Error::InitialState { part, coordinate, value: values[index].to_f64() });
        }
    }
    inertia(dynamics, time, Side::After, q, v)
}

/// The first kink after `t`, or the last one before it; infinite if there is none.
fn next_kink<D, M, const N: usize>(
    method: &M,
    dynamics: &D,
    t: f64,
    backwards: bool,
) -> Result<f64, Error>
where
    D: Dynamics<N, Scalar: Float>,
    M: Stepper<D, N>,
{
    match method.kink(dynamics, t, backwards) {
        None => Ok(if backwards { f64::NEG_INFINITY } else { f64::INFINITY }),
        Some(kink) if t < kink && !backwards || kink < t && backwards => Ok(kink),
        Some(kink) => Err(Error::Kink { t, kink }),
    }
}

/// Carries the velocities over the kink at `node.t`.
fn cross<D, T, const N: usize>(
    dynamics: &D,
    node: &mut Endpoint<T, N>,
    backwards: bool,
) -> Result<(), Error>
where
    D: Dynamics<N, Scalar = T>,
    T: Float,
{
    let from = if backwards { Side::After } else { Side::Before };
    let v = dynamics.across_kink(node.t, from, &node.q.high, &node.v.high);
    let facts = &<D::System as System<N>>::FACTS;
    if let Some(velocity) = first_in_state(facts, &node.q.high, &v) {
        let input = |side| first_in_inputs(facts, &dynamics.inputs(node.t, side, Purpose::Momenta));
        let t = node.t.to_f64();
        return Err(match (input(Side::Before).or_else(|| input(Side::After)), velocity) {
            (Some(what), _) => Error::NotFinite { t, what, suspects: Vec::new() },
            // The state and the inputs are numbers.
            (None, Quantity::Velocity(coordinate)) => Error::NoVelocity { t, coordinate },
            (None, what) => Error::NotFinite { t, what, suspects: Vec::new() },
        });
    }
    for i in 0..N {
        // Where nothing jumps, the low words stay.
        if v[i] != node.v.high[i] {
            (node.v.high[i], node.v.low[i]) = (v[i], T::from_f64(0.0));
        }
    }
    node.a = None;
    Ok(())
}
