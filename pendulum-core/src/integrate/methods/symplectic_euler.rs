//! The symplectic Euler method.

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::interpolant::hermite;
use crate::integrate::method::Method;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::Dynamics;

/// The symplectic (semi-implicit) Euler method: order 1, one evaluation per step, fixed step. It
/// serves as a baseline and is not recommended.
///
/// q̇₁ = q̇₀ + h a(t₀, q₀, q̇₀), then q₁ = q₀ + h q̇₁.
///
/// The method is symplectic only if the mass matrix is constant and the accelerations do not depend
/// on velocities. If the mass matrix depends on the coordinates, as for a double pendulum, or a
/// force depends on velocities, the map (q, q̇) ↦ (q₁, q̇₁) is not symplectic, the energy drifts,
/// and the error is large: for a double pendulum over 10 s it is 0.06 rad after 10⁵ evaluations,
/// whereas [`Dop853`](crate::integrate::Dop853) reaches 0.015 rad with 330. The method compiles for
/// such systems nevertheless, so that both cases can be compared.
///
/// Dense output is the cubic through the coordinates and velocities at both ends of a step.
///
/// Source: Hairer, Lubich and Wanner (2006), Geometric Numerical Integration, I.1.2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SymplecticEuler;

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Method<D, N> for SymplecticEuler {
    const NAME: &'static str = "SymplecticEuler";
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
        let h = interval.length::<D::Scalar>();
        let a = from.start_acceleration(field);
        let mut to = Endpoint { t: interval.end, a: None, ..*from };
        to.v.add(h, &a);
        to.q.add(h, &to.v.high);
        to
    }

    fn interpolant(
        &self,
        _: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        (): &mut (),
    ) -> Interpolant<D::Scalar, N> {
        hermite::cubic(interval, from, to)
    }
}
