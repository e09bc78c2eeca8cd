//! The integration of many motions at once by Taylor series.

mod detect;
mod fill;
mod flight;
mod in_lane;
mod kernel;
mod lengths;
mod member;
mod problem;
mod settings;
mod settle;

pub(crate) use member::Recording;
pub use problem::{Batched, Outcome, Outcomes, Problem};
pub(crate) use problem::{Posed, Problems};
pub use settings::Batch;

use crate::error::Error;
use crate::integrate::methods::taylor::Taylor;
use crate::integrate::output::Output;
use crate::integrate::solve::solve;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::controller::Controller;
use crate::jet::JetDynamics;
use crate::simd;
use crate::system::System;

impl<const N: usize> Batch<N> {
    /// Integrates each problem from its start to its end, and returns the outcomes in the same
    /// order.
    ///
    /// A motion that cannot begin or continue has its own [`Failure`](crate::integrate::Failure) as
    /// its outcome, with the error and the last good state.
    ///
    /// # Errors
    /// Returns an error only if a setting is out of its range.
    pub fn run<D: Batched<N> + JetDynamics<N>>(
        &self,
        problems: &[Problem<D, N>],
    ) -> Result<Vec<Outcome<D::Scalar, N>>, Error> {
        const {
            let facts = &<D::System as System<N>>::FACTS;
            assert!(
                facts.constraints.is_empty()
                    && facts.limits.is_empty()
                    && facts.frictions.is_empty(),
                "a batch does not support constraints, limits and dry friction; use `Ensemble`, which integrates such systems one by one"
            );
            assert!(
                facts.states == 0,
                "a batch does not support states; use `Ensemble`, which integrates such systems one by one"
            );
        };
        <AdaptiveStep<N> as Controller<Taylor, D, N>>::check(&self.control)?;
        let mut outcomes: Vec<_> = problems.iter().map(|_| None).collect();
        // Lanes take series from `Motion::analytic`. A motion that returns no series there has
        // series too, and `Taylor` uses them.
        for (problem, outcome) in problems.iter().zip(&mut outcomes) {
            let Problem { system, time, q, v } = problem;
            if !JetDynamics::<N, false>::is_analytic(system) {
                let alone = solve(system, *time, *q, *v).method(self.method).control(self.control);
                *outcome = Some(alone.max_steps(self.max_steps).run());
            }
        }
        let lanes = problems
            .iter()
            .enumerate()
            .filter(|(_, problem)| JetDynamics::<N, false>::is_analytic(&problem.system));
        let mut next = lanes.map(|(index, problem)| (index, Posed::Borrowed(problem)));
        self.run_each::<D>(
            Recording { output: Output::End, dense: false, events: &[] },
            &mut || next.next(),
            &mut |index, outcome| outcomes[index] = Some(outcome),
        );
        Ok(outcomes.into_iter().flatten().collect())
    }

    /// Integrates each problem from `problems`, and passes its outcome to `outcomes` when the
    /// motion ends.
    pub(crate) fn run_each<'a, D: Batched<N>>(
        &'a self,
        recording: Recording<'a, D::Scalar, N>,
        problems: &'a mut Problems<'a, D, N>,
        outcomes: &'a mut Outcomes<'a, D::Scalar, N>,
    ) {
        if let Some(mut run) = kernel::Run::new(self, recording, problems, outcomes) {
            simd::widest(kernel::Steps(&mut run));
        }
    }
}
