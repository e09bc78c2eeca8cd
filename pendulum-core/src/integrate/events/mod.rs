//! Events: roots of functions of the state, and known times, with their actions.

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

/// An event during an integration: a root of a function of time and state, or a known time.
///
/// Every step is searched for roots on the dense output of the method. A change of sign between two
/// of ten points, or a dip towards zero, indicates roots, even several in one step, and a
/// bracketing method finds them to the last digits. Oscillations shorter than an eighth of a step
/// can be missed; a `max_step` helps. The start itself is no event: an integration that continues
/// from an event does not find the event again.
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
/// An event with an action, given by [`then`](Self::then), changes the state, and the integration
/// continues from the new state:
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
/// Events at the same time (to the digits of the state) act in the order of the list, each on the
/// state after the previous action.
#[derive(Clone)]
pub struct Event<'a, T, const N: usize> {
    pub(crate) condition: Condition<'a, T, N>,
    pub(crate) direction: Direction,
    pub(crate) terminal: Option<u64>,
    pub(crate) tolerance: Option<f64>,
    pub(crate) action: Option<Arc<Action<'a, T, N>>>,
    pub(crate) rest_below: Option<f64>,
}

/// The condition for an event.
#[derive(Clone)]
pub(crate) enum Condition<'a, T, const N: usize> {
    /// Roots of a function.
    Root(Arc<Function<'a, T, N>>),
    /// Known times.
    Times(Arc<[f64]>),
}

/// The sign changes that count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// All sign changes, and roots at which the function touches zero and turns back.
    #[default]
    Both,
    /// Changes from negative to positive.
    Rising,
    /// Changes from positive to negative.
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
    /// The index of the event in the given list.
    pub event: usize,
    /// The time of the event, in two words.
    pub time: Time,
    /// The state at the event, before the action; at a kink, the state after the kink.
    pub state: State<T, N>,
    /// The state after the action; the same as `state` for an event without an action.
    pub after: State<T, N>,
}

/// The reason why an integration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Status {
    /// The integration has reached the end of the interval.
    Completed,
    /// The terminal event with this index has happened.
    Event(usize),
    /// The event with this index has come to [rest](Event::rest_below).
    Rest(usize),
    /// The function given by [`on_step`](super::Solve::on_step) or
    /// [`on_output`](super::Solve::on_output) has requested the end.
    Cancelled,
    /// The integration has failed with an error.
    Failed,
}

impl<'a, const N: usize> Event<'a, f64, N> {
    /// Creates an event at the roots of `function`, a continuous function of time, coordinates and
    /// velocities. The function may own its captures, by `move`.
    ///
    /// If the function returns NaN, the integration ends with an error. For scalars other than
    /// `f64` use [`of`](Self::of).
    pub fn new(function: impl Fn(f64, &[f64; N], &[f64; N]) -> f64 + Send + Sync + 'a) -> Self {
        Self::of(function)
    }
}

impl<'a, T: Float, const N: usize> Event<'a, T, N> {
    /// Creates an event at the roots of `function`, like [`new`](Event::new), for any scalar.
    pub fn of(function: impl Fn(T, &[T; N], &[T; N]) -> T + Send + Sync + 'a) -> Self {
        Self::from(Condition::Root(Arc::new(function)))
    }

    /// Creates an event at known times in ascending order. A step ends exactly at each of them,
    /// without a search.
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

    /// Counts sign changes in one direction only. The direction refers to increasing time, even if
    /// the integration goes back in time.
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

    /// Ends the integration at the event, after its action.
    pub fn terminal(self) -> Self {
        self.terminal_after(1)
    }

    /// Ends the integration when the event happens for the `count`-th time.
    pub fn terminal_after(mut self, count: u64) -> Self {
        self.terminal = Some(count);
        self
    }

    /// Sets the action, which changes the state at the event. A step ends at the event, and the
    /// integration continues from the new state. The dense output contains both states, on the two
    /// sides of the time. [`impact`](super::impact) and [`State::bounce`] compute the velocities
    /// after an impact.
    ///
    /// The action may read the time of the state; changes of the time are ignored.
    ///
    /// The action may cause these errors of the integration:
    ///
    /// - [`Error::Action`](crate::error::Error::Action): the action sets a number that is not
    ///   finite.
    /// - [`Error::Accumulation`](crate::error::Error::Accumulation): the event acts at shorter and
    ///   shorter intervals, towards a time that it never passes, like a ball that bounces with four
    ///   fifths of its speed. The error occurs if the times between acts have become shorter at
    ///   least five times in a row, down to a millionth of the first of them, or below the digits
    ///   of the state.
    /// - [`Error::EventStays`](crate::error::Error::EventStays): the action stops the motion
    ///   exactly at a zero of the function which the motion would otherwise pass, or the event acts
    ///   a thousand times in a row, each time within 1e-12 of the time reached.
    pub fn then(mut self, action: impl Fn(&mut State<T, N>) + Send + Sync + 'a) -> Self {
        self.action = Some(Arc::new(action));
        self
    }

    /// Ends the integration with [`Status::Rest`] at the first act with an impact speed below
    /// `speed`, instead of an error for acts that accumulate.
    ///
    /// The impact speed is |ġ|, the rate of the event's function just before the action, in the
    /// units of the function over seconds. For a distance from a wall it is the speed towards the
    /// wall. The last act still changes the state. The motion afterwards, along the wall or at
    /// rest, has other equations: a system without that coordinate continues from
    /// [`Solution::end`](super::Solution::end).
    pub fn rest_below(mut self, speed: f64) -> Self {
        self.rest_below = Some(speed);
        self
    }

    /// Sets the distance from zero within which an extremum of the function counts as a root.
    ///
    /// The default is the change of the function for a change of each coordinate and velocity y by
    /// 1e-9·(1 + |y|) (for `f64`; √ε/16 in general), or by 100·(`atol` + `rtol`·|y|) of the steps if
    /// this is less, because the solution itself usually has errors of this size. A dip through zero
    /// by less than the tolerance is also one root and not two.
    /// With zero, and for events with a direction, only crossings are found.
    pub fn touching(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }

    /// Returns the function of an event at roots.
    pub(crate) fn function(&self) -> Option<&Function<'a, T, N>> {
        match &self.condition {
            Condition::Root(function) => Some(function.as_ref()),
            Condition::Times(_) => None,
        }
    }

    /// Returns `true` if the event is at roots and has no action.
    pub(crate) fn is_only_seen(&self) -> bool {
        matches!(self.condition, Condition::Root(_)) && self.action.is_none()
    }

    /// Returns `true` if a step ends at the event.
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
