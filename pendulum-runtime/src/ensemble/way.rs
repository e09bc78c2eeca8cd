//! Ways in which the members of an ensemble are solved.

use crate::error::Error;
use crate::integrate::batch::{Batch, Batched, Outcomes, Posed, Watch};
use crate::integrate::controller::Controller;
use crate::integrate::method::Method;
use crate::integrate::methods::auto::Auto;
use crate::integrate::methods::picard::LaneDynamics;
use crate::integrate::settings::Settings;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::fixed::FixedStep;
use crate::integrate::{Problem, solve};
use crate::jet::{Jets, MaybeJets};
use crate::scalar::Float;
use crate::sealed::Sealed;
use crate::system::{Controlled, Dynamics, Sampled, System};
use core::cell::RefCell;

/// A source of members: problems and their indices.
type Members<'a, D, const N: usize> = dyn FnMut() -> Option<(usize, Problem<D, N>)> + 'a;

/// A way in which the members of an ensemble of `D` are solved under the controller `C`.
#[diagnostic::on_unimplemented(
    message = "no way through an ensemble is chosen for `{D}`",
    note = "systems written by hand need a method: `.method(Dop853)`"
)]
pub trait Way<D: Dynamics<N>, C, const N: usize>: Copy + Sync + Sealed {
    /// The error in the settings, if there is one.
    #[doc(hidden)]
    fn check(&self, settings: &Settings<'_, D::Scalar, N, C>) -> Result<(), Error>;

    /// Solves all members that `members` gives, and gives their outcomes to `outcomes` as they end.
    #[doc(hidden)]
    fn solve_all(
        &self,
        settings: &Settings<'_, D::Scalar, N, C>,
        members: &mut Members<'_, D, N>,
        outcomes: &mut Outcomes<'_, D::Scalar, N>,
    );

    /// The name of the method, with that of the way.
    #[doc(hidden)]
    fn name(&self, settings: &Settings<'_, D::Scalar, N, C>) -> String;
}

/// The way that the table of the [module](super) gives, which is the default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chosen;

/// Each member by itself, by the method `M`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OneByOne<M>(pub(super) M);

impl Sealed for Chosen {}

impl<M> Sealed for OneByOne<M> {}

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
        while let Some((index, Problem { system, time, q, v })) = members() {
            let run = solve(&system, time, q, v).method(self.0).with_settings(settings);
            outcomes(index, run.run());
        }
    }

    fn name(&self, _: &Settings<'_, D::Scalar, N, C>) -> String {
        M::NAME.into()
    }
}

impl<D, const N: usize> Way<D, FixedStep, N> for Chosen
where
    D: MaybeJets<N> + LaneDynamics<N>,
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

/// Dynamics of which [`Chosen`] knows the way: everything that `lagrangian!` has made, with motions
/// and controllers.
#[diagnostic::on_unimplemented(
    message = "no way through an ensemble is chosen for `{Self}`",
    note = "systems written by hand need a method: `.method(Dop853)`"
)]
pub trait WayDynamics<const N: usize>: MaybeJets<N> + LaneDynamics<N> + Sized {
    /// Returns true if members go through lanes.
    #[doc(hidden)]
    fn goes_in_lanes(settings: &Settings<'_, Self::Scalar, N, AdaptiveStep<N>>) -> bool {
        let _ = settings;
        false
    }

    /// Solves all members in lanes.
    #[doc(hidden)]
    fn solve_in_lanes(
        settings: &Settings<'_, Self::Scalar, N, AdaptiveStep<N>>,
        members: &mut Members<'_, Self, N>,
        outcomes: &mut Outcomes<'_, Self::Scalar, N>,
    ) {
        OneByOne(Auto).solve_all(settings, members, outcomes);
    }
}

impl<D: Batched<N> + LaneDynamics<N>, const N: usize> WayDynamics<N> for D {
    fn goes_in_lanes(settings: &Settings<'_, D::Scalar, N, AdaptiveStep<N>>) -> bool {
        let facts = const { &<D::System as System<N>>::FACTS };
        let plain = facts.smooth && facts.constraints.is_empty() && facts.limits.is_empty();
        plain && Batch::can_keep(settings)
    }

    fn solve_in_lanes(
        settings: &Settings<'_, D::Scalar, N, AdaptiveStep<N>>,
        members: &mut Members<'_, D, N>,
        outcomes: &mut Outcomes<'_, D::Scalar, N>,
    ) {
        let batch = Batch::of(settings);
        let outcomes = RefCell::new(outcomes);
        let mut take = |index, outcome| (*outcomes.borrow_mut())(index, outcome);
        let mut problems = || {
            loop {
                let (index, problem) = members()?;
                if problem.system.is_analytic() {
                    return Some((index, Posed::Owned(problem)));
                }
                let (mut one, mut take) = (Some((index, problem)), |index, outcome| {
                    (*outcomes.borrow_mut())(index, outcome);
                });
                OneByOne(Auto).solve_all(settings, &mut || one.take(), &mut take);
            }
        };
        let Settings { output, dense, ref events, .. } = *settings;
        let watch = Watch { output, dense, events };
        batch.run_each::<D, true>(watch, &mut problems, &mut take);
    }
}

impl<S, M, F, U, const N: usize> WayDynamics<N> for Controlled<S, M, F, U>
where
    S: Jets<N>,
    Self: MaybeJets<N> + LaneDynamics<N>,
{
}

impl<S, M, C, U, const N: usize> WayDynamics<N> for Sampled<S, M, C, U>
where
    S: Jets<N>,
    Self: MaybeJets<N> + LaneDynamics<N>,
{
}
