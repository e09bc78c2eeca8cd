//! The leapfrog method.

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::interpolant::hermite;
use crate::integrate::method::Method;
use crate::integrate::schemes::splitting::{Splitting, drift_kick_drift};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::{Dynamics, VelocityFree};

/// The leapfrog (Störmer–Verlet) method in the order drift, kick, drift: order 2, one evaluation
/// per step, fixed step.
///
/// q½ = q₀ + h/2 q̇₀; q̇₁ = q̇₀ + h a(t + h/2, q½); q₁ = q½ + h/2 q̇₁. The method is symplectic and
/// reversible: the energy oscillates by O(h²) about its value and does not drift. The phase is off
/// by (h·ω)²/24 per radian, and this error accumulates with time. The method is unstable beyond h·ω
/// = 2. It evaluates accelerations only in the middle of a step, so that a kink at an end of a step
/// causes no error.
///
/// The method requires a constant mass matrix and accelerations without velocities, and does not
/// compile for other systems. Dense output is the cubic through the coordinates and velocities at
/// both ends of a step, which here is a parabola: order 2.
///
/// Source: Hairer, Lubich and Wanner (2003), Geometric numerical integration illustrated by the
/// Störmer–Verlet method, Acta Numerica 12, 399.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Leapfrog;

impl Leapfrog {
    /// The coefficients, with drifts outside.
    pub const SPLITTING: Splitting<2, 1> = Splitting::drifts_outside(&[0.5], &[1.0]);
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> Method<D, N>
    for Leapfrog
{
    const NAME: &'static str = "Leapfrog";
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
        drift_kick_drift(&Self::SPLITTING, field, interval, from)
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
