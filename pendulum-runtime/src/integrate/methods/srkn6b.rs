//! A splitting method of Blanes and Moan with six evaluations.

use crate::integrate::field::Field;
use crate::integrate::method::Method;
use crate::integrate::schemes::splitting::{Splitting, kick_drift_kick};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::{Dynamics, VelocityFree};

/// The symplectic Runge–Kutta–Nyström splitting with six evaluations of Blanes and Moan: order 4,
/// fixed step.
///
/// Per evaluation it is ten to a hundred times more accurate than
/// [`Leapfrog`](crate::integrate::Leapfrog) and five times than Yoshida's methods of order 4.
/// Symplectic and reversible: energy errors stay bounded, phase errors grow with time. One of its
/// drifts goes backwards.
///
/// It is for systems with a constant mass matrix and accelerations without velocities, and compiles
/// for no others. Dense output is the quintic through coordinates, velocities and accelerations at
/// both ends and costs nothing.
///
/// Source: Blanes and Moan (2002), Practical symplectic partitioned Runge–Kutta and
/// Runge–Kutta–Nyström methods, J. Comput. Appl. Math. 142, 313, table 3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Srkn6b;

impl Srkn6b {
    /// The method.
    pub const fn new() -> Self {
        Self
    }
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
        kick_drift_kick(&SPLITTING, field, interval, from)
    }
}

pub(crate) const SPLITTING: Splitting<7, 6> =
    Splitting::kicks_outside(&[B1, B2, B3, 1.0 - 2.0 * (B1 + B2 + B3)], &[A1, A2, 0.5 - (A1 + A2)]);

const A1: f64 = 0.245298957184271;
const A2: f64 = 0.604872665711080;

const B1: f64 = 0.0829844064174052;
const B2: f64 = 0.396309801498368;
const B3: f64 = -0.0390563049223486;
