//! Functions of the state and known times to look for on the way, and what happens there.

pub(crate) mod detector;
pub(crate) mod observed;
pub(crate) mod root;

use crate::integrate::state::State;
use crate::scalar::Float;
use crate::time::Time;
use core::fmt;
use std::sync::Arc;

/// A function of time, coordinates and velocities whose roots are events.
type Function<'a, T, const N: usize> = dyn Fn(T, &[T; N], &[T; N]) -> T + Send + Sync + 'a;

/// A change of the state at an event.
type Action<'a, T, const N: usize> = dyn Fn(&mut State<T, N>) + Send + Sync + 'a;

/// Something that happens on the way: a function of time and state passes through zero, or a known
/// time comes.
///
/// Roots are looked for in every step, on the dense output of the method: between ten points a
/// change of sign or a dip towards zero gives away where they are, also several in one step, and a
/// bracketing method finds them to the last digits. Wiggles shorter than an eighth of a step stay
/// unseen; a `max_step` helps. The start itself is no event: an integration that goes on from an
/// event does not find it again.
///
/// ```
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn first_turn<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<Option<f64>, Failure<f64, 1>> {
///     let turn = Event::new(|_t, _q, v| v[0]).rising().terminal();
///     let solution = solve(system, (0.0, 10.0), [1.3], [0.0]).method(Dop853).rtol(1e-10).events([turn]).run()?;
///     Ok(solution.events.first().map(|turn| turn.state.t))
/// }
/// ```
///
/// An event [`then`](Self::then) changes the state, and the integration goes on from there:
///
/// ```
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn bounces<S: System<1, Scalar = f64, Inputs = ()>>(ball: &S, height: f64) -> Result<usize, Failure<f64, 1>> {
///     let floor = Event::new(move |_t, y, _v| y[0] - height).falling().then(|ball| ball.v[0] *= -0.8);
///     let motion = solve(ball, (0.0, 3.0), [1.0], [0.0]).method(Dop853).events([floor]).run()?;
///     Ok(motion.events.len())
/// }
/// ```
///
/// Events that happen at the same time (to the digits that the state has) act in the order of the
/// list, each on the state that the one before it has left.
#[derive(Clone)]
pub struct Event<'a, T, const N: usize> {
    pub(crate) condition: Condition<'a, T, N>,
    pub(crate) direction: Direction,
    pub(crate) terminal: Option<u64>,
    pub(crate) tolerance: Option<f64>,
    pub(crate) action: Option<Arc<Action<'a, T, N>>>,
    pub(crate) rest_below: Option<f64>,
}

/// When an event happens.
#[derive(Clone)]
pub(crate) enum Condition<'a, T, const N: usize> {
    /// At roots of a function.
    Root(Arc<Function<'a, T, N>>),
    /// At these times.
    Times(Arc<[f64]>),
}

/// The sign changes that count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// All of them, and roots at which the function touches zero and turns back.
    #[default]
    Both,
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
}

/// An event that has happened.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
#[non_exhaustive]
pub struct Occurrence<T, const N: usize> {
    /// The index of the event in the list given.
    pub event: usize,
    /// When, in two words.
    pub time: Time,
    /// The state there, before the event has acted; at a kink the one after it.
    pub state: State<T, N>,
    /// The state after the event has acted; the same as `state` if it does not act.
    pub after: State<T, N>,
}

/// Why an integration ended where it did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Status {
    /// The end of the interval is reached.
    Completed,
    /// The terminal event with this index has happened.
    Event(usize),
    /// The event with this index has come to [rest](Event::rest_below).
    Rest(usize),
    /// A function that looked on, given by [`on_step`](super::Solve::on_step) or
    /// [`on_output`](super::Solve::on_output), has asked for it.
    Cancelled,
    /// There was an error.
    Failed,
}

impl<'a, const N: usize> Event<'a, f64, N> {
    /// The roots of `function`, a continuous function of time, coordinates and velocities; it may
    /// own what it captures, by `move`.
    ///
    /// If it gives something that is not a number, the integration ends with an error. Scalars
    /// other than `f64` have [`of`](Self::of).
    pub fn new(function: impl Fn(f64, &[f64; N], &[f64; N]) -> f64 + Send + Sync + 'a) -> Self {
        Self::of(function)
    }
}

impl<'a, T: Float, const N: usize> Event<'a, T, N> {
    /// The roots of `function`, as [`new`](Event::new), over any scalar.
    pub fn of(function: impl Fn(T, &[T; N], &[T; N]) -> T + Send + Sync + 'a) -> Self {
        Self::from(Condition::Root(Arc::new(function)))
    }

    /// Known times in ascending order: a step ends exactly at each of them, and nothing is
    /// searched.
    pub fn at(times: impl AsRef<[f64]>) -> Self {
        Self::from(Condition::Times(Arc::from(times.as_ref())))
    }

    fn from(condition: Condition<'a, T, N>) -> Self {
        Self {
            condition,
            direction: Direction::Both,
            terminal: None,
            tolerance: None,
            action: None,
            rest_below: None,
        }
    }

    /// Counts sign changes in one direction only: that of time, also where an integration goes
    /// back.
    pub fn direction(mut self, direction: Direction) -> Self {
        self.direction = direction;
        self
    }

    /// Counts changes from negative to positive only.
    pub fn rising(self) -> Self {
        self.direction(Direction::Rising)
    }

    /// Counts changes from positive to negative only.
    pub fn falling(self) -> Self {
        self.direction(Direction::Falling)
    }

    /// Ends the integration at the event, after it has acted.
    pub fn terminal(self) -> Self {
        self.terminal_after(1)
    }

    /// Ends the integration when the event happens for the `count`-th time.
    pub fn terminal_after(mut self, count: u64) -> Self {
        self.terminal = Some(count);
        self
    }

    /// Changes the state at the event, from which the integration goes on; a step ends there. The
    /// dense output has both states, on the two sides of the time; [`impact`](super::impact) and
    /// [`State::bounce`] give the velocities after an impact.
    ///
    /// The time of the state is for reading: the integration stays at the time of the event.
    ///
    /// Errors of the integration that it may lead to:
    ///
    /// - [`Error::Action`](crate::error::Error::Action): it gives a number that is not finite.
    /// - [`Error::Accumulation`](crate::error::Error::Accumulation): the event acts again and
    ///   again, each time sooner, towards a time that it never passes, as a ball that bounces with
    ///   four fifths of its speed. That is so if the times between acts have grown shorter at least
    ///   five times in a row, down to a millionth of the first of them, or below the digits of the
    ///   state.
    /// - [`Error::EventStays`](crate::error::Error::EventStays): it stops the motion just where the
    ///   function is zero, and the motion would go on through, or it acts a thousand times in a row
    ///   within 1e-12 of the time reached.
    pub fn then(mut self, action: impl Fn(&mut State<T, N>) + Send + Sync + 'a) -> Self {
        self.action = Some(Arc::new(action));
        self
    }

    /// Ends the integration with [`Status::Rest`] at the first act whose impact speed is below
    /// `speed`, instead of an error where acts accumulate.
    ///
    /// The impact speed is |ġ|, the rate of the event's function just before it acts: for a
    /// distance from a wall the speed towards it, in the units of the function over seconds. The
    /// last act still changes the state. What follows, a motion along the wall or none, has other
    /// equations: a system without that coordinate goes on from
    /// [`Solution::end`](super::Solution::end).
    pub fn rest_below(mut self, speed: f64) -> Self {
        self.rest_below = Some(speed);
        self
    }

    /// Sets the distance from zero within which an extremum of the function counts as a root.
    ///
    /// Without this call it is what the function changes if each coordinate and velocity y changes
    /// by 1e-9·(1 + |y|) (for `f64`; √ε/16 in general), because the solution itself is no more
    /// exact as a rule. A dip through zero by less than this is one root too, not two. Zero finds
    /// only what crosses, and so does an event with a direction.
    pub fn touching(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }

    /// The function whose roots the event is.
    pub(crate) fn function(&self) -> Option<&Function<'a, T, N>> {
        match &self.condition {
            Condition::Root(function) => Some(function.as_ref()),
            Condition::Times(_) => None,
        }
    }

    /// Returns true if the event is a root that leaves the motion as it is.
    pub(crate) fn is_only_seen(&self) -> bool {
        matches!(self.condition, Condition::Root(_)) && self.action.is_none()
    }

    /// Returns true if a step ends at the event.
    pub(crate) fn stops(&self) -> bool {
        self.terminal.is_some() || self.action.is_some()
    }
}

impl<T, const N: usize> fmt::Debug for Event<'_, T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { condition, direction, terminal, tolerance, action, rest_below } = self;
        let mut event = f.debug_struct("Event");
        match condition {
            Condition::Root(_) => event.field("direction", direction).field("tolerance", tolerance),
            Condition::Times(times) => event.field("times", times),
        };
        event.field("terminal", terminal).field("acts", &action.is_some());
        event.field("rest_below", rest_below).finish()
    }
}
