//! The automatic choice of a method.

use crate::error::Error;
use crate::integrate::field::Field;
use crate::integrate::field::contacts::has_contacts;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Memory, Method};
use crate::integrate::methods::dop853::Dop853;
use crate::integrate::methods::picard::{LaneDynamics, Picard};
use crate::integrate::methods::srkn14a::{self, Srkn14a};
use crate::integrate::methods::taylor::{Taylor, WorkspaceOf};
use crate::integrate::schemes::splitting::drift_kick_drift_in_two_words;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::controller::{Controller, ControllerState, StepContext, StepLaw};
use crate::jet::{JetDynamics, Jets, Unrolling};
use crate::scalar::Float;
use crate::system::{Dynamics, System};

/// The automatic choice of a method, based on properties of the system and on the tolerance.
/// [`Stats`](crate::integrate::Stats) contain the name of the chosen method.
///
/// | steps | choice |
/// |---|---|
/// | adaptive | [`Picard`] |
/// | | [`Taylor`] for linear systems without time and driven inputs, whose series converge everywhere |
/// | | [`Taylor`] back in time, for systems with series: every motion is [`Analytic`](crate::motion::Analytic) and the accelerations contain no `abs`, `sign`, `min` or `max` of a quantity that varies during the motion |
/// | fixed | [`Srkn14a`](crate::integrate::Srkn14a), which is symplectic, for velocity-free systems, [`Dop853`] for others |
/// | | [`Taylor`] back in time, for systems with series |
///
/// Scalars of two words cannot be evaluated in lanes. For them `Taylor` replaces `Picard` if the
/// system has series and the tolerance is small enough: any tolerance if the equations are short,
/// as for one pendulum; below 2e-7 if they are longer, as for two or three links; below 2e-14 if
/// they are long. Otherwise `Dop853` replaces it. While a limit is in contact, and with dry
/// friction, steps forward in time are taken by `Dop853`.
///
/// Stiffness cannot be detected in advance: for stiff springs and dampers set
/// [`Rodas4`](crate::integrate::Rodas4) or [`Gauss`](crate::integrate::Gauss), for long runs of a
/// conservative system with fixed steps `Gauss`. Systems written by hand have no recurrences on
/// which the choice depends, and require an explicit method too:
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Auto;

/// The methods that `Auto` chooses from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Dop853,
    Picard,
    Srkn14a,
    Taylor,
}

/// The workspaces of all methods that `Auto` chooses from.
#[derive(Clone, Debug)]
pub struct Workspace<R, P, X> {
    choice: Option<Choice>,
    /// The relative tolerance for which the method of adaptive steps was chosen.
    chosen_for: Option<f64>,
    dop853: R,
    picard: P,
    taylor: X,
}

/// The workspace for the dynamics `D`.
type AnyWorkspace<D, const N: usize> = Workspace<
    <Dop853 as Method<D, N>>::Workspace,
    <Picard as Method<D, N>>::Workspace,
    WorkspaceOf<D, N>,
>;

/// The choice for jets that are found at run time.
const TAYLOR: Taylor<false> = Taylor::new().unknown();

impl Auto {
    /// Returns the choice for adaptive steps.
    fn adaptive<D: JetDynamics<N, false, Scalar: Float>, const N: usize>(
        dynamics: &D,
        rtol: f64,
        backwards: bool,
    ) -> Choice {
        let facts = &<D::System as System<N>>::FACTS;
        let two_words = D::Scalar::EPSILON.to_f64() < 1e-17;
        let pays = if two_words {
            rtol < <D::System as Jets<N>>::Unrolling::PAYS_BELOW
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

/// Returns `true` if the motion has Taylor series: the accelerations are smooth and all motions
/// analytic.
fn goes_by_series<D: JetDynamics<N, false>, const N: usize>(dynamics: &D) -> bool {
    <D::System as System<N>>::FACTS.smooth && dynamics.is_analytic()
}

impl<D: JetDynamics<N, false> + LaneDynamics<N>, const N: usize> Method<D, N> for Auto {
    const NAME: &'static str = "Auto";
    type Workspace = AnyWorkspace<D, N>;

    fn workspace(&self, dynamics: &D) -> AnyWorkspace<D, N> {
        Workspace {
            choice: None,
            chosen_for: None,
            dop853: Dop853.workspace(dynamics),
            picard: Picard.workspace(dynamics),
            taylor: TAYLOR.workspace(dynamics),
        }
    }

    fn keeps_contacts(&self) -> bool {
        true
    }

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        workspace: &mut AnyWorkspace<D, N>,
    ) -> Endpoint<D::Scalar, N> {
        workspace.chosen_for = None;
        if interval.h < 0.0 && goes_by_series(field.dynamics) {
            workspace.choice = Some(Choice::Taylor);
            TAYLOR.attempt(field, interval, from, &mut workspace.taylor)
        } else if <D::System as System<N>>::FACTS.velocity_free && !field.contacts.any() {
            workspace.choice = Some(Choice::Srkn14a);
            Symplectic.attempt(field, interval, from, &mut ())
        } else {
            workspace.choice = Some(Choice::Dop853);
            Dop853.attempt(field, interval, from, &mut workspace.dop853)
        }
    }

    fn interpolant(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        workspace: &mut AnyWorkspace<D, N>,
    ) -> Interpolant<D::Scalar, N> {
        match workspace.choice {
            Some(Choice::Taylor) => {
                TAYLOR.interpolant(field, interval, from, to, &mut workspace.taylor)
            }
            Some(Choice::Picard) => {
                Picard.interpolant(field, interval, from, to, &mut workspace.picard)
            }
            Some(Choice::Srkn14a) => Symplectic.interpolant(field, interval, from, to, &mut ()),
            _ => Dop853.interpolant(field, interval, from, to, &mut workspace.dop853),
        }
    }

    fn stage(
        &self,
        index: usize,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &AnyWorkspace<D, N>,
    ) -> Option<(f64, Endpoint<D::Scalar, N>)> {
        if workspace.choice != Some(Choice::Dop853) {
            return None;
        }
        Method::<D, N>::stage(&Dop853, index, interval, from, &workspace.dop853)
    }

    fn diagnose(
        &self,
        field: &Field<'_, D, N>,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &AnyWorkspace<D, N>,
    ) -> Option<Error> {
        match workspace.choice {
            Some(Choice::Taylor) => TAYLOR.diagnose(field, interval, from, &workspace.taylor),
            Some(Choice::Picard) => Picard.diagnose(field, interval, from, &workspace.picard),
            Some(Choice::Srkn14a) => Symplectic.diagnose(field, interval, from, &()),
            _ => Dop853.diagnose(field, interval, from, &workspace.dop853),
        }
    }

    fn name(&self, workspace: &AnyWorkspace<D, N>) -> &'static str {
        match workspace.choice {
            None => "Auto",
            Some(Choice::Dop853) => <Dop853 as Method<D, N>>::NAME,
            Some(Choice::Picard) => <Picard as Method<D, N>>::NAME,
            Some(Choice::Srkn14a) => <Symplectic as Method<D, N>>::NAME,
            Some(Choice::Taylor) => <Taylor<false> as Method<D, N>>::NAME,
        }
    }

    fn moved(&self, dynamics: &D, workspace: &mut AnyWorkspace<D, N>, to: &Endpoint<D::Scalar, N>) {
        Method::<D, N>::moved(&Picard, dynamics, &mut workspace.picard, to);
    }

    fn remember(&self, workspace: &mut AnyWorkspace<D, N>, memory: &mut Memory) {
        const CHOICES: [Option<Choice>; 5] = [
            None,
            Some(Choice::Dop853),
            Some(Choice::Picard),
            Some(Choice::Srkn14a),
            Some(Choice::Taylor),
        ];
        let Workspace { choice, chosen_for, picard, taylor, .. } = workspace;
        let mut index = CHOICES.iter().position(|other| other == choice).unwrap_or(0);
        memory.count(&mut index, CHOICES.len() - 1);
        *choice = CHOICES[index];
        memory.maybe(chosen_for, || 0.0, Memory::number);
        Method::<D, N>::remember(&Picard, picard, memory);
        Method::<D, N>::remember(&TAYLOR, taylor, memory);
    }

    fn goes_back(&self, dynamics: &D) -> bool {
        goes_by_series(dynamics) || dynamics.kink_before(0.0).is_some()
    }

    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64> {
        if !backwards {
            return dynamics.next_kink(t);
        }
        if goes_by_series(dynamics) {
            return dynamics.last_kink(t);
        }
        dynamics.kink_before(t).filter(|kink| f64::NEG_INFINITY < *kink)
    }
}

impl<D, const N: usize> Controller<Auto, D, N> for AdaptiveStep<N>
where
    D: JetDynamics<N, false> + LaneDynamics<N>,
{
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    fn accuracy(&self) -> Option<(f64, [[f64; N]; 2])> {
        let (relative, (q, v)) = self.tolerances::<D::Scalar>();
        Some((relative, [q, v]))
    }

    /// Delegates the step to the chosen method.
    fn step(
        &self,
        state: &mut ControllerState,
        context: StepContext<'_, '_, D, Auto, N>,
    ) -> Result<StepInterval, Error> {
        let StepContext { field, from, to, workspace, target, stats, .. } = context;
        let dynamics = field.dynamics;
        let backwards = target < from.t.to_f64();
        let (rtol, _) = self.tolerances::<D::Scalar>();
        if const { has_contacts::<D, N>() } && field.contacts.any() {
            (workspace.choice, workspace.chosen_for) = (Some(Choice::Dop853), None);
        } else if workspace.chosen_for != Some(rtol)
            || backwards && workspace.choice != Some(Choice::Taylor) && goes_by_series(dynamics)
        {
            let choice = Auto::adaptive(dynamics, rtol, backwards);
            (workspace.choice, workspace.chosen_for) = (Some(choice), Some(rtol));
        }
        match workspace.choice {
            Some(Choice::Taylor) => {
                let (method, workspace) = (&TAYLOR, &mut workspace.taylor);
                let context = StepContext { method, field, from, to, workspace, target, stats };
                self.take_step(state, context)
            }
            Some(Choice::Picard) => {
                let (method, workspace) = (&Picard, &mut workspace.picard);
                let context = StepContext { method, field, from, to, workspace, target, stats };
                self.take_step(state, context)
            }
            _ => {
                Controller::<Dop853, D, N>::check(self)?;
                let (method, workspace) = (&Dop853, &mut workspace.dop853);
                let context = StepContext { method, field, from, to, workspace, target, stats };
                self.take_step(state, context)
            }
        }
    }
}

/// [`Srkn14a`] without the bound `VelocityFree`, for systems whose facts state that they are
/// velocity-free.
#[derive(Clone, Copy, Debug)]
struct Symplectic;

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Method<D, N> for Symplectic {
    const NAME: &'static str = srkn14a::NAME;
    type Workspace = ();

    fn workspace(&self, _: &D) {}

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        (): &mut (),
    ) -> Endpoint<D::Scalar, N> {
        drift_kick_drift_in_two_words(&Srkn14a::SPLITTING, field, interval, from)
    }
}
