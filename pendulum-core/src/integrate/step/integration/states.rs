//! Steps of a system with states, whose velocities are set to their rates at the end of each step.

use super::{Integration, check_start, onwards};
use crate::error::Error;
use crate::integrate::field::phase::has_states;
use crate::integrate::method::Method;
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::controller::Controller;
use crate::scalar::Float;
use crate::system::{Dynamics, System};

impl<const N: usize, D, M, C> Integration<'_, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Takes a step within which no rate of a state jumps, or one that is too short for the jump to
    /// matter.
    ///
    /// The derivative of a rate does not contain a jump, such as that of `atan2` behind a turn or
    /// of `sign` at a start where its argument is zero. The rate at the end shows it.
    #[inline(never)]
    pub(super) fn take_without_jumps(&mut self, mut target: f64) -> Result<StepInterval, Error>
    where
        C: Controller<M, D, N>,
    {
        let (plan, accepted) = (self.state, self.stats.accepted);
        loop {
            let interval = self.take_once(target)?;
            let jumped = self.project_end(interval.h)?;
            let part = (interval.start + 0.5 * interval.h).to_f64();
            if !jumped || part == interval.start.to_f64() || part == interval.end.to_f64() {
                return Ok(interval);
            }
            (self.end, self.state, self.stats.accepted) = (self.from, plan, accepted);
            self.stats.rejected += 1;
            target = part;
        }
    }

    /// Sets the velocities of the states at a start. Their rates may contain the first sample of a
    /// controller, which it takes otherwise when the first step begins.
    #[inline]
    pub(super) fn settle_start(&mut self) -> Result<(), Error> {
        if const { has_states::<D, N>() } {
            self.sample()?;
            self.end.settle(&*self.dynamics, onwards(self.backwards));
            check_start(&*self.dynamics, self.end.t, &self.end.q.high, &self.end.v.high)?;
        }
        Ok(())
    }

    /// Returns `true` if the rates of the states differ from the velocities `v` that a step of the
    /// length `h` has led to by far more than the tolerances allow.
    pub(super) fn has_jumped(&self, v: &[D::Scalar; N], h: f64) -> bool
    where
        C: Controller<M, D, N>,
    {
        /// The greatest differences in tolerances: of the rate, and of the state by this rate.
        const FAR: [f64; 2] = [100.0, 1.0];
        let Some((relative, absolute)) = self.controller.accuracy() else { return false };
        let Endpoint { q: Compensated { high: q, .. }, v: Compensated { high: rates, .. }, .. } =
            &self.end;
        (N - <D::System as System<N>>::FACTS.states..N).any(|i| {
            let change = (rates[i] - v[i]).to_f64().abs();
            let [q, v] = [(0, q[i]), (1, v[i])]
                .map(|(part, value)| absolute[part][i] + relative * value.to_f64().abs());
            FAR[0] * v < change && FAR[1] * q < h.abs() * change
        })
    }
}
