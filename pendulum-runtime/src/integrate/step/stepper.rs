//! A method at work on some dynamics: what drivers and controls see of it.

use crate::error::Error;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Method, Suits};
use crate::integrate::step::diagnose;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::field::Counted;
use crate::integrate::step::interval::StepInterval;
use crate::real::Float;
use crate::system::Dynamics;

/// A method that can integrate the dynamics `D`.
///
/// Each [`Method`] that [`Suits`] the system can; a method that needs more than accelerations
/// implements this trait itself.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot integrate `{D}`",
    note = "without `.method(…)`, `solve` chooses for systems that `lagrangian!` has made; for others name a method, as `.method(Dop853)`"
)]
pub trait Stepper<D: Dynamics<N, Scalar: Float>, const N: usize>: Copy + core::fmt::Debug {
    /// The name.
    const NAME: &'static str;
    /// What one step leaves behind for error estimate and dense output.
    type Stages: Clone + core::fmt::Debug;

    /// Whether it goes back in time too.
    fn goes_back(&self, dynamics: &D) -> bool {
        let _ = dynamics;
        false
    }

    /// Room for the stages.
    fn workspace(&self, dynamics: &D) -> Self::Stages;

    /// The name of the method that has taken the steps, if that is another one.
    fn name(&self, stages: &Self::Stages) -> &'static str {
        let _ = stages;
        Self::NAME
    }

    /// Goes from `from` to the end of `interval`.
    fn advance(
        &self,
        field: &mut Counted<'_, D>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Stages,
    ) -> Endpoint<D::Scalar, N>;

    /// The motion within the step just taken.
    fn within(
        &self,
        field: &mut Counted<'_, D>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Stages,
    ) -> Interpolant<D::Scalar, N>;

    /// The first number in a step that is not finite, or what `stages` say of equations that were
    /// not solved, if there is one.
    fn fault(
        &self,
        dynamics: &D,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        stages: &Self::Stages,
    ) -> Option<Error>;

    /// The next kink after `t`, or the last one before it.
    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64>;
}

impl<M, D, const N: usize> Stepper<D, N> for M
where
    M: Method + Suits<D::System, N>,
    D: Dynamics<N, Scalar: Float>,
{
    const NAME: &'static str = M::NAME;
    type Stages = M::Stages<D::Scalar, N>;

    fn workspace(&self, _: &D) -> Self::Stages {
        M::stages()
    }

    #[inline]
    fn advance(
        &self,
        field: &mut Counted<'_, D>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Stages,
    ) -> Endpoint<D::Scalar, N> {
        self.step(field, interval, from, stages)
    }

    #[inline]
    fn within(
        &self,
        field: &mut Counted<'_, D>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Stages,
    ) -> Interpolant<D::Scalar, N> {
        self.dense(field, interval, from, to, stages)
    }

    fn fault(
        &self,
        dynamics: &D,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        stages: &Self::Stages,
    ) -> Option<Error> {
        diagnose::fault(self, dynamics, interval, from, stages)
    }

    fn kink(&self, dynamics: &D, t: f64, _: bool) -> Option<f64> {
        dynamics.next_kink(t)
    }
}
