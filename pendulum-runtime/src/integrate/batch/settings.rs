//! The settings of a batch.

use super::problem::{Batched, Problem};
use crate::error::Error;
use crate::integrate::events::Event;
use crate::integrate::methods::taylor::{Rule, Taylor};
use crate::integrate::output::Output;
use crate::integrate::settings::Settings;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::integration::check_start;
use crate::jet::Jets;
use crate::scalar::Float;
use crate::time::Time;

/// Many motions of one type of system by their [`Taylor`] series, side by side in the lanes of the
/// widest vectors that the machine has.
///
/// Parameters, intervals, start states and motions may differ from motion to motion, and each takes
/// its own steps: its solution has the same bits whatever its neighbours do. Where one ends, the
/// next one takes its lane. State and counters have the bits of
/// [`solve`](crate::integrate::solve)`(&system, time, q, v).method(Taylor::new())`.
///
/// As `Taylor` does, a batch compares the accelerations at the end of each step with those of its
/// series, at no further evaluation: they are the first coefficients of the next series. A motion
/// whose series does not hold, because it meets a wall, a contact or a kick, is left to `Taylor`
/// alone until series hold again, and comes back to its lane. The accelerations compared are
/// rounded otherwise than those of `Taylor`: a difference within rounding of what is allowed, which
/// is 30 times the error allowed, may be judged otherwise.
///
/// Each motion asks its own driven inputs for their series, at its own time. Steps end at the
/// [breaks](crate::motion::Analytic::next_break) of these motions, and at kinks velocities jump as
/// in `solve`.
///
/// Worth it from about four motions on; it suits every system that `lagrangian!` has made without
/// control inputs, constraints and limits.
///
/// A failure ends one motion only. A step allocates nothing; the end of a motion does.
///
/// ```
/// # use pendulum_runtime::{integrate::{Batch, Problem}, prelude::*};
/// # lagrangian! {
/// #     #[derive(Clone, Debug)]
/// #     pub struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }
/// #     coordinate θ: rad;
/// #     let y = L * [sin(θ), -cos(θ)];
/// #     kinetic = m/2 * |ẏ|^2;
/// #     potential = m*g*height(y);
/// # }
/// let swings: Vec<_> = (1..=100)
///     .map(|k| Problem { system: Pendulum::new(1.0, 0.5), time: (0.0, 10.0), q: [0.03 * f64::from(k)], v: [0.0] })
///     .collect();
/// for swing in Batch::new().rtol(1e-14).run(&swings).unwrap() {
///     println!("{:.12} rad", swing.unwrap().end.q[0]);
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Batch<const N: usize> {
    pub(super) method: Taylor,
    pub(super) control: AdaptiveStep<N>,
    pub(super) max_steps: u64,
}

impl<const N: usize> Default for Batch<N> {
    fn default() -> Self {
        Self { method: Taylor::new(), control: AdaptiveStep::new(), max_steps: 10_000_000 }
    }
}

impl<const N: usize> Batch<N> {
    /// The order that the tolerance asks for, `rtol` 1e-6 (1.2e-5 for `f32`), at most ten million
    /// steps for each motion.
    pub fn new() -> Self {
        Self::default()
    }

    /// The order instead, from 2 to 30, as [`Taylor::order`].
    pub fn order(mut self, order: usize) -> Self {
        self.method = self.method.order(order);
        self
    }

    /// The relative tolerance.
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.control = self.control.rtol(rtol);
        self
    }

    /// The absolute tolerance of all coordinates and velocities; without this call `rtol`.
    pub fn atol(mut self, atol: f64) -> Self {
        self.control = self.control.atol(atol);
        self
    }

    /// The absolute tolerances of each coordinate and of each velocity.
    pub fn atol_each(mut self, q: [f64; N], v: [f64; N]) -> Self {
        self.control = self.control.atol_each(q, v);
        self
    }

    /// The greatest length of the first step of each motion in seconds.
    pub fn first_step(mut self, step: f64) -> Self {
        self.control = self.control.first_step(step);
        self
    }

    /// The greatest length of a step in seconds.
    pub fn max_step(mut self, step: f64) -> Self {
        self.control = self.control.max_step(step);
        self
    }

    /// The number of steps after which a motion fails.
    pub fn max_steps(mut self, count: u64) -> Self {
        self.max_steps = count;
        self
    }

    /// The settings that an ensemble has.
    pub(crate) fn of<T>(settings: &Settings<'_, T, N, AdaptiveStep<N>>) -> Self {
        let Settings { controller, max_steps, .. } = *settings;
        Self { method: Taylor::new(), control: controller, max_steps }
    }

    /// Returns true if lanes can keep what these settings ask for.
    pub(crate) fn can_keep<T: Float>(settings: &Settings<'_, T, N, AdaptiveStep<N>>) -> bool {
        let Settings { stops, events, .. } = settings;
        stops.is_empty() && events.iter().all(Event::is_only_seen)
    }

    /// The rule that decides about the length of a step.
    pub(super) fn rule<D: Batched<N>>(&self) -> Rule {
        let (rtol, _) = self.control.tolerances::<D::Scalar>();
        Rule::new(self.method.order_for(rtol, D::System::PER_DIGIT), rtol)
    }

    /// Checks that a motion can begin; `true` if it ends where it begins.
    pub(super) fn begin<D: Batched<N>>(
        &self,
        problem: &Problem<D, N>,
        output: &Output<'_>,
    ) -> Result<bool, Error> {
        let (start, end) = problem.time;
        if !(end - start).is_finite() {
            return Err(Error::Interval { start, end });
        }
        output.check(start, end, false)?;
        let length = (end - start).abs();
        if (self.max_steps as f64) < self.control.least_steps_over(length)
            || self.max_steps == 0 && start != end
        {
            return Err(Error::MaxSteps { t: start, max_steps: self.max_steps });
        }
        check_start(&problem.system, Time::new(start), &problem.q, &problem.v)?;
        Ok(start == end)
    }
}
