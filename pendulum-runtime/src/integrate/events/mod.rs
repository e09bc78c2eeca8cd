//! What to look for on the way: roots of functions of the state, and known times.

pub(crate) mod detector;
pub(crate) mod root;

use crate::integrate::state::State;
use crate::scalar::Float;
use crate::time::Time;
use core::fmt;

/// A function of time, coordinates and velocities whose roots are events.
type Function<'a, T, const N: usize> = dyn Fn(T, &[T; N], &[T; N]) -> T + Sync + 'a;

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
///     let turns = Event::new(&|_t, _q: &[f64; 1], v: &[f64; 1]| v[0]).direction(Direction::Rising).terminal();
///     let solution = solve(system, (0.0, 10.0), [1.3], [0.0]).method(Dop853).rtol(1e-10).events(&[turns]).run()?;
///     Ok(solution.events.first().map(|turn| turn.state.t))
/// }
/// ```
#[derive(Clone, Copy)]
pub struct Event<'a, T, const N: usize> {
    pub(crate) condition: Condition<'a, T, N>,
    pub(crate) direction: Direction,
    pub(crate) terminal: Option<u64>,
    pub(crate) tolerance: Option<f64>,
}

/// When an event happens.
#[derive(Clone, Copy)]
pub(crate) enum Condition<'a, T, const N: usize> {
    /// At roots of a function.
    Root(&'a Function<'a, T, N>),
    /// At these times.
    Times(&'a [f64]),
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
    /// The state there; at a kink the one after it.
    pub state: State<T, N>,
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
    /// There was an error.
    Failed,
}

impl<'a, T: Float, const N: usize> Event<'a, T, N> {
    /// The roots of `function`, a continuous function of time, coordinates and velocities.
    ///
    /// If it gives something that is not a number, the integration ends with an error.
    pub const fn new(function: &'a Function<'a, T, N>) -> Self {
        Self {
            condition: Condition::Root(function),
            direction: Direction::Both,
            terminal: None,
            tolerance: None,
        }
    }

    /// Known times in ascending order: a step ends exactly at each of them, and nothing is
    /// searched.
    pub const fn at(times: &'a [f64]) -> Self {
        Self {
            condition: Condition::Times(times),
            direction: Direction::Both,
            terminal: None,
            tolerance: None,
        }
    }

    /// Counts sign changes in one direction only.
    pub const fn direction(mut self, direction: Direction) -> Self {
        self.direction = direction;
        self
    }

    /// Ends the integration at the event.
    pub const fn terminal(self) -> Self {
        self.terminal_after(1)
    }

    /// Ends the integration when the event happens for the `count`-th time.
    pub const fn terminal_after(mut self, count: u64) -> Self {
        self.terminal = Some(count);
        self
    }

    /// How near to zero an extremum of the function counts as a root at which it touches zero.
    ///
    /// Without this call it is what the function changes if each coordinate and velocity y changes
    /// by 1e-9·(1 + |y|) (for `f64`; √ε/16 in general), because the solution itself is no more
    /// exact as a rule. A dip through zero by less than this is one root too, not two. Zero finds
    /// only what crosses, and so does an event with a direction.
    pub const fn touching(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }
}

impl<T, const N: usize> fmt::Debug for Event<'_, T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { condition, direction, terminal, tolerance } = self;
        let mut event = f.debug_struct("Event");
        match condition {
            Condition::Root(_) => event.field("direction", direction).field("tolerance", tolerance),
            Condition::Times(times) => event.field("times", times),
        };
        event.field("terminal", terminal).finish()
    }
}
