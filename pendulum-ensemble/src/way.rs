//! Ways to solve the members of an ensemble.

use pendulum_core::error::Error;
use pendulum_core::integrate::controller::Controller;
use pendulum_core::integrate::members::{Members, Outcomes, Settings, WayDynamics, one_by_one};
use pendulum_core::integrate::method::Method;
use pendulum_core::integrate::{AdaptiveStep, Auto, FixedStep, LaneDynamics};
use pendulum_core::jet::JetDynamics;
use pendulum_core::scalar::Float;
use pendulum_core::system::{Dynamics, System};

/// A way to solve the members of an ensemble of `D` with the controller `C`.
#[diagnostic::on_unimplemented(
    message = "no method is chosen for the ensemble of `{D}`",
    note = "systems written by hand need a method: `.method(Dop853)`"
)]
pub trait Way<D: Dynamics<N>, C, const N: usize>: Copy + Sync {
    /// Checks the settings.
    #[doc(hidden)]
    fn check(&self, settings: &Settings<'_, D::Scalar, N, C>) -> Result<(), Error>;

    /// Solves all members returned by `members`, and passes their outcomes to `outcomes` as they
    /// end.
    #[doc(hidden)]
    fn solve_all(
        &self,
        settings: &Settings<'_, D::Scalar, N, C>,
        members: &mut Members<'_, D, N>,
        outcomes: &mut Outcomes<'_, D::Scalar, N>,
    );

    /// Returns the name of the method and of the way.
    #[doc(hidden)]
    fn name(&self, settings: &Settings<'_, D::Scalar, N, C>) -> String;
}

/// The way given in the table of the [module](super), which is the default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chosen;

/// The solution of members one by one, by the method `M`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OneByOne<M>(pub(super) M);

impl<D, M, C, const N: usize> Way<D, C, N> for OneByOne<M>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N> + Sync,
    C: Controller<M, D, N> + Sync,
{
    fn check(&self, settings: &Settings<'_, D::Scalar, N, C>) -> Result<(), Error> {
        settings.controller.check()
    }

    fn solve_all(
        &self,
        settings: &Settings<'_, D::Scalar, N, C>,
        members: &mut Members<'_, D, N>,
        outcomes: &mut Outcomes<'_, D::Scalar, N>,
    ) {
        one_by_one(self.0, settings, members, outcomes);
    }

    fn name(&self, _: &Settings<'_, D::Scalar, N, C>) -> String {
        M::NAME.into()
    }
}

impl<D, const N: usize> Way<D, FixedStep, N> for Chosen
where
    D: JetDynamics<N, false> + LaneDynamics<N>,
{
    fn check(&self, settings: &Settings<'_, D::Scalar, N, FixedStep>) -> Result<(), Error> {
        Way::<D, FixedStep, N>::check(&OneByOne(Auto), settings)
    }

    fn solve_all(
        &self,
        settings: &Settings<'_, D::Scalar, N, FixedStep>,
        members: &mut Members<'_, D, N>,
        outcomes: &mut Outcomes<'_, D::Scalar, N>,
    ) {
        OneByOne(Auto).solve_all(settings, members, outcomes);
    }

    fn name(&self, settings: &Settings<'_, D::Scalar, N, FixedStep>) -> String {
        Way::<D, FixedStep, N>::name(&OneByOne(Auto), settings)
    }
}

impl<D: WayDynamics<N>, const N: usize> Way<D, AdaptiveStep<N>, N> for Chosen {
    fn check(&self, settings: &Settings<'_, D::Scalar, N, AdaptiveStep<N>>) -> Result<(), Error> {
        Way::<D, AdaptiveStep<N>, N>::check(&OneByOne(Auto), settings)
    }

    fn solve_all(
        &self,
        settings: &Settings<'_, D::Scalar, N, AdaptiveStep<N>>,
        members: &mut Members<'_, D, N>,
        outcomes: &mut Outcomes<'_, D::Scalar, N>,
    ) {
        if D::goes_in_lanes(settings) {
            D::solve_in_lanes(settings, members, outcomes);
        } else {
            OneByOne(Auto).solve_all(settings, members, outcomes);
        }
    }

    fn name(&self, settings: &Settings<'_, D::Scalar, N, AdaptiveStep<N>>) -> String {
        if D::goes_in_lanes(settings) {
            let driven = !<D::System as System<N>>::FACTS.inputs.is_empty();
            let others = if driven { ", Auto without series" } else { "" };
            format!("Taylor in lanes{others}")
        } else {
            Way::<D, AdaptiveStep<N>, N>::name(&OneByOne(Auto), settings)
        }
    }
}
