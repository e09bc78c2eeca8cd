//! The builder of an ensemble.

use super::mapped::Mapped;
use super::shards::Shards;
use super::way::{Chosen, OneByOne};
use core::fmt;
use core::marker::PhantomData;
use core::ops::Range;
use pendulum_core::integrate::members::{Output, Settings};
use pendulum_core::integrate::method::Method;
use pendulum_core::integrate::{AdaptiveStep, Event, FixedStep, Problem, Solution};
use pendulum_core::scalar::Float;
use pendulum_core::system::Dynamics;

/// An ensemble: many motions of one type of system, each created from its index.
///
/// ```
/// # use pendulum_runtime::{ensemble::Ensemble, integrate::Problem, prelude::*};
/// # mod system {
/// # pendulum_runtime::lagrangian! {
/// #     pub struct Pendulum { L: m, g: m/s^2 = 9.81 }
/// #     coordinate θ: rad;
/// #     let y = L * [sin(θ), -cos(θ)];
/// #     kinetic = |ẏ|^2/2;
/// #     potential = g*height(y);
/// # }
/// # }
/// # use system::Pendulum;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // The largest of a thousand amplitudes after ten seconds.
/// let swings = Ensemble::new(0..1000, |k| Problem {
///     system: Pendulum::new(0.5),
///     time: (0.0, 10.0),
///     q: [1e-3 * k as f64],
///     v: [0.0],
/// });
/// let largest = swings
///     .rtol(1e-9)
///     .map(|_, solution| solution.end.q[0].abs())
///     .reduce(|| 0.0, f64::max)?;
/// println!("{} rad, {} failed", largest.value, largest.tally.failed);
/// # Ok(())
/// # }
/// ```
#[must_use = "nothing is integrated before `map` and `reduce`, `collect` or `for_each`"]
pub struct Ensemble<'a, const N: usize, D: Dynamics<N>, G, W, C> {
    members: Range<usize>,
    problem: G,
    way: W,
    settings: Settings<'a, D::Scalar, N, C>,
    shard: Option<usize>,
    dynamics: PhantomData<fn() -> D>,
}

impl<const N: usize, D, G> Ensemble<'_, N, D, G, Chosen, AdaptiveStep<N>>
where
    D: Dynamics<N, Scalar: Float>,
    G: Fn(usize) -> Problem<D, N> + Sync,
{
    /// Creates an ensemble of the members with the given indices. `problem` creates the problem of
    /// a member from its index, and may be called several times for one index.
    ///
    /// By default, members are solved with `rtol` and `atol` 1e-6 by the method given in the table
    /// of the [module](super), and their solutions contain the end states.
    pub fn new(members: Range<usize>, problem: G) -> Self {
        Self {
            members,
            problem,
            way: Chosen,
            settings: Settings::new(AdaptiveStep::new()),
            shard: None,
            dynamics: PhantomData,
        }
    }
}

impl<'a, const N: usize, D, G, W, C> Ensemble<'a, N, D, G, W, C>
where
    D: Dynamics<N, Scalar: Float>,
{
    /// Solves the members one by one by `method`.
    pub fn method<M: Method<D, N>>(self, method: M) -> Ensemble<'a, N, D, G, OneByOne<M>, C> {
        let Self { members, problem, settings, shard, dynamics, .. } = self;
        Ensemble { members, problem, way: OneByOne(method), settings, shard, dynamics }
    }

    /// Takes equal steps of at most `step` seconds.
    pub fn step(self, step: f64) -> Ensemble<'a, N, D, G, W, FixedStep> {
        let Self { members, problem, way, settings, shard, dynamics } = self;
        let settings = settings.with(FixedStep::new(step));
        Ensemble { members, problem, way, settings, shard, dynamics }
    }

    /// Stores the states at these times, as
    /// [`Solve::t_eval`](pendulum_core::integrate::Solve::t_eval).
    pub fn t_eval(mut self, times: &'a [f64]) -> Self {
        self.settings.output = Output::Times(times);
        self
    }

    /// Stores the states at `start`, `start + interval`, …, as
    /// [`Solve::every`](pendulum_core::integrate::Solve::every).
    pub fn every(mut self, interval: f64) -> Self {
        self.settings.output = Output::Every(interval);
        self
    }

    /// Stores the states at the start and after every step.
    pub fn every_step(mut self) -> Self {
        self.settings.output = Output::Steps;
        self
    }

    /// Stores the motion within each step, for [`Solution::at`].
    pub fn dense(mut self) -> Self {
        self.settings.dense = true;
        self
    }

    /// Ends steps exactly at these times.
    pub fn t_stops(mut self, times: &'a [f64]) -> Self {
        self.settings.stops = times;
        self
    }

    /// Detects events in every member, as
    /// [`Solve::events`](pendulum_core::integrate::Solve::events).
    pub fn events(mut self, events: impl AsRef<[Event<'a, D::Scalar, N>]>) -> Self {
        self.settings.events = events.as_ref().to_vec();
        self
    }

    /// Sets the number of steps after which a member fails, ten million by default.
    pub fn max_steps(mut self, count: u64) -> Self {
        self.settings.max_steps = count;
        self
    }

    /// Sets the number of members of a shard, for ensembles whose members take unusually long or
    /// short times.
    ///
    /// By default the number is n/128 for n members, rounded up to a multiple of 8, from 8 to 1024.
    /// The bits of a reduction depend on this number, the bits of a list do not.
    pub fn shard(mut self, members: usize) -> Self {
        self.shard = Some(members);
        self
    }

    /// Maps each solution to a value, on the thread that solved it. Failed members are counted and
    /// not mapped.
    pub fn map<R, P, F>(self, map: F) -> Mapped<'a, N, D, G, W, C, F, P>
    where
        R: Send,
        F: Fn(usize, &Solution<D::Scalar, N>) -> R + Sync,
    {
        let shards = Shards::new(&self.members, self.shard);
        Mapped::new(shards, self.problem, self.way, self.settings, map)
    }
}

impl<const N: usize, D: Dynamics<N>, G, W> Ensemble<'_, N, D, G, W, AdaptiveStep<N>> {
    /// Sets the relative tolerance, 1e-6 by default (1.2e-5 for `f32`).
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.settings.controller = self.settings.controller.rtol(rtol);
        self
    }

    /// Sets the absolute tolerance of all coordinates and velocities, by default `rtol`.
    pub fn atol(mut self, atol: f64) -> Self {
        self.settings.controller = self.settings.controller.atol(atol);
        self
    }

    /// Sets the absolute tolerances of each coordinate and each velocity.
    pub fn atol_each(mut self, q: [f64; N], v: [f64; N]) -> Self {
        self.settings.controller = self.settings.controller.atol_each(q, v);
        self
    }

    /// Sets the length of the first step in seconds.
    pub fn first_step(mut self, step: f64) -> Self {
        self.settings.controller = self.settings.controller.first_step(step);
        self
    }

    /// Sets the greatest length of a step in seconds.
    pub fn max_step(mut self, step: f64) -> Self {
        self.settings.controller = self.settings.controller.max_step(step);
        self
    }
}

impl<const N: usize, D, G, W, C> fmt::Debug for Ensemble<'_, N, D, G, W, C>
where
    D: Dynamics<N>,
    W: fmt::Debug,
    C: fmt::Debug,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { members, way, settings, shard, .. } = self;
        let mut ensemble = f.debug_struct("Ensemble");
        ensemble.field("members", members).field("way", way).field("settings", settings);
        ensemble.field("shard", shard).finish_non_exhaustive()
    }
}
