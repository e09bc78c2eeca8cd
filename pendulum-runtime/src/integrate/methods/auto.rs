//! The choice of a method.

use crate::error::Error;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Method, Suits};
use crate::integrate::methods::dop853::Dop853;
use crate::integrate::methods::picard::{LaneDynamics, Picard};
use crate::integrate::methods::srkn14a::{self, Srkn14a};
use crate::integrate::methods::taylor::{Taylor, WorkspaceOf};
use crate::integrate::schemes::splitting::drift_kick_drift_in_two_words;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::controller::{Control, ControllerState, StepContext};
use crate::integrate::step::diagnose;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::field::{Counted, Field};
use crate::integrate::step::interval::StepInterval;
use crate::integrate::step::stepper::Stepper;
use crate::jet::{Jets, Known, MaybeJets, Orders};
use crate::real::Float;
use crate::system::{Dynamics, System};

/// The method that what is known about the system and the tolerance decide; [`Stats`](crate::integrate::Stats)
/// say which it was.
///
/// | steps | choice |
/// |---|---|
/// | adaptive | [`Picard`] |
/// | | [`Taylor`] for linear systems without time and driven inputs, whose series converge everywhere |
/// | | [`Taylor`] back in time, where there are series: every motion is [`Analytic`](crate::motion::Analytic) and the accelerations contain no `abs`, `sign`, `min` or `max` of something that moves |
/// | fixed | [`Srkn14a`], which is symplectic, for velocity-free systems, [`Dop853`] for others |
/// | | [`Taylor`] back in time |
///
/// Scalars of two words stand in no lanes. `Taylor` takes the place of `Picard` there, for every
/// tolerance if the equations are short, as for one pendulum, below 2e-7 if they are longer, as for
/// two or three links, and below 2e-14 if they are long; else `Dop853`.
///
/// Nothing shows beforehand that a system is stiff: for stiff springs and dampers name
/// [`Rodas4`](crate::integrate::Rodas4) or [`Gauss`](crate::integrate::Gauss), for long runs of a conservative system
/// with fixed steps `Gauss`. Systems written by hand have no recurrences to choose by, and name a
/// method too:
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Auto;

/// What may be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Dop853,
    Picard,
    Srkn14a,
    Taylor,
}

/// Room for whatever is chosen.
#[derive(Clone, Debug)]
pub struct Workspace<R, P, X> {
    choice: Option<Choice>,
    /// The relative tolerance of the adaptive steps that it was chosen for.
    chosen_for: Option<f64>,
    dop853: R,
    picard: P,
    taylor: X,
}

/// The room for the dynamics `D`.
type AnyWorkspace<D, const N: usize> = Workspace<
    <Dop853 as Method>::Stages<<D as Dynamics<N>>::Scalar, N>,
    <Picard as Stepper<D, N>>::Stages,
    WorkspaceOf<D, N>,
>;

impl Auto {
    /// The choice for adaptive steps.
    fn adaptive<D: MaybeJets<N, Scalar: Float>, const N: usize>(
        dynamics: &D,
        rtol: f64,
        backwards: bool,
    ) -> Choice {
        let facts = &<D::System as System<N>>::FACTS;
        let two_words = D::Scalar::EPSILON.to_f64() < 1e-17;
        let pays = if two_words {
            rtol < <D::System as Jets<N>>::Orders::PAYS_BELOW
        } else {
            facts.linear && facts.autonomous
        };
        if (pays || backwards) && goes_by_series(dynamics) {
            Choice::Taylor
        } else if two_words {
            Choice::Dop853
        } else {
            Choice::Picard
        }
    }
}

/// Whether Taylor series are right.
fn goes_by_series<D: MaybeJets<N>, const N: usize>(dynamics: &D) -> bool {
    <D::System as System<N>>::FACTS.smooth && dynamics.is_analytic()
}

impl<D: MaybeJets<N> + LaneDynamics<N>, const N: usize> Stepper<D, N> for Auto {
    const NAME: &'static str = "Auto";
    type Stages = AnyWorkspace<D, N>;

    fn goes_back(&self, dynamics: &D) -> bool {
        goes_by_series(dynamics)
    }

    fn workspace(&self, dynamics: &D) -> AnyWorkspace<D, N> {
        let (dop853, taylor) = (Dop853::stages(), Taylor::new().workspace(&Known(dynamics)));
        Workspace {
            choice: None,
            chosen_for: None,
            dop853,
            picard: Picard.workspace(dynamics),
            taylor,
        }
    }

    fn name(&self, workspace: &AnyWorkspace<D, N>) -> &'static str {
        match workspace.choice {
            None => "Auto",
            Some(Choice::Dop853) => <Dop853 as Method>::NAME,
            Some(Choice::Picard) => <Picard as Stepper<D, N>>::NAME,
            Some(Choice::Srkn14a) => <Srkn14a as Method>::NAME,
            Some(Choice::Taylor) => <Taylor as Stepper<Known<'_, D>, N>>::NAME,
        }
    }

    #[inline]
    fn advance(
        &self,
        field: &mut Counted<'_, D>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        workspace: &mut AnyWorkspace<D, N>,
    ) -> Endpoint<D::Scalar, N> {
        workspace.chosen_for = None;
        if interval.h < 0.0 {
            // The stages of the others would see a kink at the start from the wrong side.
            workspace.choice = Some(Choice::Taylor);
            let known = Known(field.dynamics);
            let mut series = Counted::new(&known);
            let to = Taylor::new().advance(&mut series, interval, from, &mut workspace.taylor);
            field.evaluations += series.evaluations;
            to
        } else if <D::System as System<N>>::FACTS.velocity_free {
            workspace.choice = Some(Choice::Srkn14a);
            Symplectic.step(field, interval, from, &mut ())
        } else {
            workspace.choice = Some(Choice::Dop853);
            Dop853.step(field, interval, from, &mut workspace.dop853)
        }
    }

    fn within(
        &self,
        field: &mut Counted<'_, D>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        workspace: &mut AnyWorkspace<D, N>,
    ) -> Interpolant<D::Scalar, N> {
        match workspace.choice {
            Some(Choice::Taylor) => Taylor::new().within(
                &mut Counted::new(&Known(field.dynamics)),
                interval,
                from,
                to,
                &mut workspace.taylor,
            ),
            Some(Choice::Picard) => Picard.within(field, interval, from, to, &mut workspace.picard),
            Some(Choice::Srkn14a) => Symplectic.dense(field, interval, from, to, &mut ()),
            _ => Dop853.dense(field, interval, from, to, &mut workspace.dop853),
        }
    }

    fn fault(
        &self,
        dynamics: &D,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &AnyWorkspace<D, N>,
    ) -> Option<Error> {
        match workspace.choice {
            Some(Choice::Taylor) => {
                Taylor::new().fault(&Known(dynamics), interval, from, &workspace.taylor)
            }
            Some(Choice::Picard) => Picard.fault(dynamics, interval, from, &workspace.picard),
            Some(Choice::Srkn14a) => diagnose::fault(&Symplectic, dynamics, interval, from, &()),
            _ => diagnose::fault(&Dop853, dynamics, interval, from, &workspace.dop853),
        }
    }

    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64> {
        if backwards { dynamics.last_kink(t) } else { dynamics.next_kink(t) }
    }
}

impl<D: MaybeJets<N> + LaneDynamics<N>, const N: usize> Control<Auto, D, N> for AdaptiveStep<N> {
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    fn step(
        &self,
        memory: &mut ControllerState,
        course: StepContext<'_, '_, D, Auto, N>,
    ) -> Result<StepInterval, Error> {
        let StepContext { field, from, to, stages: workspace, target, stats, .. } = course;
        let dynamics = field.dynamics;
        let backwards = target < from.t.to_f64();
        let (rtol, _) = self.tolerances::<D::Scalar>();
        if workspace.chosen_for != Some(rtol)
            || backwards && workspace.choice != Some(Choice::Taylor)
        {
            let choice = Auto::adaptive(dynamics, rtol, backwards);
            (workspace.choice, workspace.chosen_for) = (Some(choice), Some(rtol));
        }
        if workspace.choice == Some(Choice::Taylor) {
            let known = Known(dynamics);
            let mut series = Counted::new(&known);
            let stages = &mut workspace.taylor;
            let taken = Control::step(
                self,
                memory,
                StepContext {
                    method: &Taylor::new(),
                    field: &mut series,
                    from,
                    to,
                    stages,
                    target,
                    stats,
                },
            );
            field.evaluations += series.evaluations;
            return taken;
        }
        if workspace.choice == Some(Choice::Picard) {
            return Control::step(
                self,
                memory,
                StepContext {
                    method: &Picard,
                    field,
                    from,
                    to,
                    stages: &mut workspace.picard,
                    target,
                    stats,
                },
            );
        }
        Control::<Dop853, D, N>::check(self)?;
        Control::step(
            self,
            memory,
            StepContext {
                method: &Dop853,
                field,
                from,
                to,
                stages: &mut workspace.dop853,
                target,
                stats,
            },
        )
    }
}

/// [`Srkn14a`] for systems of which only a value says that they are velocity-free.
#[derive(Clone, Copy, Debug)]
struct Symplectic;

impl Method for Symplectic {
    const NAME: &'static str = <Srkn14a as Method>::NAME;
    const ORDER: u32 = Srkn14a::ORDER;
    const DENSE_ORDER: u32 = Srkn14a::DENSE_ORDER;
    type Stages<T: Float, const N: usize> = ();

    fn stages<T: Float, const N: usize>() {}
}

impl<S: System<N, Scalar: Float>, const N: usize> Suits<S, N> for Symplectic {
    #[inline]
    fn step(
        &self,
        field: &mut impl Field<S, N>,
        interval: &StepInterval,
        from: &mut Endpoint<S::Scalar, N>,
        (): &mut (),
    ) -> Endpoint<S::Scalar, N> {
        drift_kick_drift_in_two_words(&srkn14a::SPLITTING, field, interval, from)
    }
}
