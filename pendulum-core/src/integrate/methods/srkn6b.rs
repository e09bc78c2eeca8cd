//! A splitting method of Blanes and Moan with six evaluations.

use crate::integrate::field::Field;
use crate::integrate::method::Method;
use crate::integrate::schemes::splitting::{Splitting, kick_drift_kick};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::{Dynamics, VelocityFree};

/// The symplectic Runge–Kutta–Nyström splitting of Blanes and Moan with six evaluations per step:
/// order 4, fixed step.
///
/// For the same number of evaluations its error is ten to a hundred times smaller than that of
/// [`Leapfrog`](crate::integrate::Leapfrog) and five times smaller than that of Yoshida's methods
/// of order 4. It is symplectic and reversible: energy errors stay bounded, phase errors grow with
/// time. Two of its six drifts and two of its seven kicks go backwards.
///
/// The method requires a constant mass matrix and accelerations without velocities, and does not
/// compile for other systems. Dense output is the quintic through the coordinates, velocities and
/// accelerations at both ends of a step and takes no further evaluations.
///
/// Source: Blanes and Moan (2002), Practical symplectic partitioned Runge–Kutta and
/// Runge–Kutta–Nyström methods, J. Comput. Appl. Math. 142, 313, table 3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Srkn6b;

impl Srkn6b {
    /// The coefficients, with kicks outside.
    pub const SPLITTING: Splitting<7, 6> = Splitting::kicks_outside(
        &[B1, B2, B3, 1.0 - 2.0 * (B1 + B2 + B3)],
        &[A1, A2, 0.5 - (A1 + A2)],
    );
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> Method<D, N>
    for Srkn6b
{
    const NAME: &'static str = "Srkn6b";
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
        kick_drift_kick(&Self::SPLITTING, field, interval, from)
    }
}

const A1: f64 = 0.245298957184271;
const A2: f64 = 0.604872665711080;

const B1: f64 = 0.0829844064174052;
const B2: f64 = 0.396309801498368;
const B3: f64 = -0.0390563049223486;
