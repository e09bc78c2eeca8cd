//! The result of an integration.

use crate::error::Error;
use crate::integrate::events::{Occurrence, Status};
use crate::integrate::interpolant::dense::DenseOutput;
use crate::integrate::state::State;
use crate::integrate::state::impact::Impact;
use crate::integrate::state::slip::Slip;
use crate::integrate::stats::Stats;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::label::Source;
use core::fmt;
use core::iter::FusedIterator;
use core::ops::Range;

/// The motion over an interval, at the requested times.
///
/// At a kink the velocities have two values; a field with a single value contains the one after the
/// kink.
///
/// A solution iterates over its [`State`]s and returns columns by name; `Display` prints a short
/// table.
///
/// ```
/// use pendulum_runtime::prelude::*;
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Pendulum { L: m, g: m/s^2 = 9.81 }
///     coordinate θ: rad;
///     let y = L * [sin(θ), -cos(θ)];
///     kinetic = |ẏ|^2/2;
///     potential = g*height(y);
/// }
/// # }
/// # use system::Pendulum;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let pendulum = Pendulum::new(1.0);
/// let solution = solve(&pendulum, (0.0, 2.0), [0.5], [0.0]).every(0.5).run()?;
/// for state in &solution {
///     println!("{:.1} s: {:.4} rad", state.t, state.q[0]);
/// }
/// let fastest = solution.column("θ̇")?.into_iter().fold(0.0, |most: f64, v| most.max(v.abs()));
/// assert!(fastest < 2.0 * 9.81_f64.sqrt() * 0.25_f64.sin());
/// let energy = solution.energy(&pendulum);
/// assert!((energy[4] - energy[0]).abs() < 1e-5);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Solution<T, const N: usize> {
    /// The output times; without a request for output, only the last time reached.
    pub t: Vec<f64>,
    /// The coordinates at each output time.
    pub q: Vec<[T; N]>,
    /// The velocities at each output time.
    pub v: Vec<[T; N]>,
    /// The last state reached: at the end of the interval, at a terminal event, or before the step
    /// that failed.
    pub end: State<T, N>,
    /// The reason why the integration ended.
    pub status: Status,
    /// The events found, in order.
    pub events: Vec<Occurrence<T, N>>,
    /// The impacts on the limits of the system, in order.
    pub impacts: Vec<Impact<T, N>>,
    /// The intervals of stick and slip of the dry frictions of the system, in the order of their
    /// starts.
    pub frictions: Vec<Slip>,
    /// The counters of the integration.
    pub stats: Stats,
    pub(crate) dense: Option<DenseOutput<T, N>>,
    /// The limits in contact at each output time, one bit per limit, and the modes of the frictions;
    /// empty for systems without either.
    pub(crate) contacts: Vec<u64>,
    /// The names and units of coordinates and velocities.
    pub(crate) labels: Source,
    /// The number of the integration from [`Dynamics::recorded`].
    pub(crate) run: RunNumber,
}

/// The number of an integration within its program, which is not part of the result.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct RunNumber(pub(crate) u64);

impl fmt::Debug for RunNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("_")
    }
}

impl<T: Float, const N: usize> Solution<T, N> {
    /// Returns the state at the time `t` in seconds from the dense output; at a kink, the state
    /// after the kink.
    ///
    /// # Errors
    /// Returns [`Error::NoState`] outside of the interval and for a solution without
    /// [`dense`](crate::integrate::Solve::dense).
    pub fn at(&self, t: f64) -> Result<State<T, N>, Error> {
        self.at_side(t, Side::After)
    }

    /// Returns the state at the time `t` as [`at`](Self::at) does; at a kink, the state on the
    /// given side.
    ///
    /// # Errors
    /// Returns the errors of [`at`](Self::at).
    pub fn at_side(&self, t: f64, side: Side) -> Result<State<T, N>, Error> {
        let dense = self.dense.as_ref().ok_or(Error::NoState { t, dense: None })?;
        dense.at(t, side).ok_or_else(|| Error::NoState { t, dense: Some(dense.interval()) })
    }
}

/// Two solutions are equal if all numbers, the labels of the columns and the status are equal.
impl<T: PartialEq, const N: usize> PartialEq for Solution<T, N> {
    fn eq(&self, other: &Self) -> bool {
        // The pattern has no `..`, so that every field is considered here.
        let Self {
            t,
            q,
            v,
            end,
            status,
            events,
            impacts,
            frictions,
            stats,
            dense,
            contacts,
            labels,
            run: _,
        } = self;
        (t, q, v, end) == (&other.t, &other.q, &other.v, &other.end)
            && (status, events, stats) == (&other.status, &other.events, &other.stats)
            && (impacts, contacts) == (&other.impacts, &other.contacts)
            && *frictions == other.frictions
            && *dense == other.dense
            && labels.labels(N) == other.labels.labels(N)
    }
}

impl<T: Copy, const N: usize> Solution<T, N> {
    /// Returns the number of output times.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Returns `true` if there is no output time, for example after an error before the first one.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Returns the state at the output time with this index.
    pub fn get(&self, index: usize) -> Option<State<T, N>> {
        Some(State { t: *self.t.get(index)?, q: *self.q.get(index)?, v: *self.v.get(index)? })
    }

    /// Returns an iterator over the states at the output times, in order.
    pub fn iter(&self) -> States<'_, T, N> {
        States { solution: self, indices: 0..self.len() }
    }
}

/// An iterator over the states of a [`Solution`], in order.
#[derive(Clone, Debug)]
pub struct States<'a, T, const N: usize> {
    solution: &'a Solution<T, N>,
    indices: Range<usize>,
}

impl<T: Copy, const N: usize> Iterator for States<'_, T, N> {
    type Item = State<T, N>;

    fn next(&mut self) -> Option<State<T, N>> {
        self.solution.get(self.indices.next()?)
    }

    fn nth(&mut self, count: usize) -> Option<State<T, N>> {
        self.solution.get(self.indices.nth(count)?)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.indices.size_hint()
    }
}

impl<T: Copy, const N: usize> DoubleEndedIterator for States<'_, T, N> {
    fn next_back(&mut self) -> Option<State<T, N>> {
        self.solution.get(self.indices.next_back()?)
    }
}

impl<T: Copy, const N: usize> ExactSizeIterator for States<'_, T, N> {}

impl<T: Copy, const N: usize> FusedIterator for States<'_, T, N> {}

impl<'a, T: Copy, const N: usize> IntoIterator for &'a Solution<T, N> {
    type Item = State<T, N>;
    type IntoIter = States<'a, T, N>;

    fn into_iter(self) -> States<'a, T, N> {
        self.iter()
    }
}

/// An integration that stopped before its end, with the part of the solution computed before.
///
/// Both `Display` and `Debug` print the error; `{:?}` adds the last state and the counters.
#[derive(Clone)]
pub struct Failure<T, const N: usize> {
    /// The cause of the failure.
    pub error: Error,
    /// The solution up to the failure; its `end` is the last good state.
    pub partial: Box<Solution<T, N>>,
}

impl<T, const N: usize> fmt::Display for Failure<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl<T: fmt::Debug, const N: usize> fmt::Debug for Failure<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Solution { end: State { t, q, v }, stats, .. } = &*self.partial;
        write!(f, "{}\n  reached: t = {t:?}, q = {q:?}, v = {v:?}\n  {stats}", self.error)
    }
}

impl<T: fmt::Debug, const N: usize> std::error::Error for Failure<T, N> {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.error)
    }
}
