//! The classical Runge–Kutta method.

use crate::integrate::field::Field;
use crate::integrate::method::Method;
use crate::integrate::schemes::runge_kutta::Slopes;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::{Float, Real};
use crate::system::Dynamics;

/// The classical Runge–Kutta method: order 4, four evaluations per step, fixed step.
///
/// The method supports every system and is common in animation: with a step of a fortieth of a
/// period it keeps four digits over ten periods. It is not symplectic: the energy drifts with the
/// fifth power of the step, usually downwards. Beyond h·ω ≈ 2.8 it is unstable. It has no error
/// estimate, so that it cannot detect a step that is too long.
///
/// Dense output is the quintic through the coordinates, velocities and accelerations at both ends
/// of a step.
///
/// Source: Kutta (1901), Z. Math. Phys. 46, 435.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4;

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Method<D, N> for Rk4 {
    const NAME: &'static str = "Rk4";
    type Workspace = Slopes<D::Scalar, N, 4>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        Slopes::zero()
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
        k: &mut Slopes<D::Scalar, N, 4>,
    ) -> Endpoint<D::Scalar, N> {
        k.first(field, from);
        k.stage(field, interval, from, 1, 0.5, [(0, 0.5)]);
        k.stage(field, interval, from, 2, 0.5, [(1, 0.5)]);
        k.stage(field, interval, from, 3, 1.0, [(2, 1.0)]);
        // The weights are integers, and the sum is divided by six: rounded sixths do not add up to
        // 1.
        let (dq, dv) = k.weighted([(0, 1.0), (1, 2.0), (2, 2.0), (3, 1.0)]);
        let six = D::Scalar::from_f64(6.0);
        from.advanced(interval, &dq.map(|sum| sum / six), &dv.map(|sum| sum / six))
    }
}
