//! A splitting method of Blanes and Moan with fourteen evaluations.

use crate::integrate::field::Field;
use crate::integrate::method::Method;
use crate::integrate::schemes::splitting::{Splitting, drift_kick_drift_in_two_words};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::{Dynamics, VelocityFree};

/// The symplectic Runge–Kutta–Nyström splitting of Blanes and Moan with fourteen evaluations per
/// step: order 6, fixed step.
///
/// It is the most accurate splitting method here, down to rounding: products are summed with both
/// of their words, so that only accelerations are rounded. The energy of a pendulum stays within
/// 3e-15 over 3·10⁶ steps, and its phase within 1e-11 s after 10⁵ s. The method is symplectic and
/// reversible: energy errors stay bounded, phase errors grow with time. Some of its drifts and
/// kicks go backwards. If steps are too long, the method fails abruptly.
///
/// The method requires a constant mass matrix and accelerations without velocities, and does not
/// compile for other systems. Dense output is the quintic through the coordinates, velocities and
/// accelerations at both ends of a step and takes one more evaluation per step; its order is 6 in
/// the coordinates and 5 in the velocities.
///
/// Source: Blanes and Moan (2002), Practical symplectic partitioned Runge–Kutta and
/// Runge–Kutta–Nyström methods, J. Comput. Appl. Math. 142, 313, table 3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Srkn14a;

impl Srkn14a {
    /// The coefficients, with drifts outside.
    pub const SPLITTING: Splitting<15, 14> = Splitting::drifts_outside(
        &[A1, A2, A3, A4, A5, A6, A7, 1.0 - 2.0 * (A1 + A2 + A3 + A4 + A5 + A6 + A7)],
        &[B1, B2, B3, B4, B5, B6, 0.5 - (B1 + B2 + B3 + B4 + B5 + B6)],
    );
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> Method<D, N>
    for Srkn14a
{
    const NAME: &'static str = NAME;
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
        drift_kick_drift_in_two_words(&Self::SPLITTING, field, interval, from)
    }
}

pub(crate) const NAME: &str = "Srkn14a";

const A1: f64 = 0.0378593198406116;
const A2: f64 = 0.102635633102435;
const A3: f64 = -0.0258678882665587;
const A4: f64 = 0.314241403071447;
const A5: f64 = -0.130144459517415;
const A6: f64 = 0.106417700369543;
const A7: f64 = -0.00879424312851058;

const B1: f64 = 0.09171915262446165;
const B2: f64 = 0.183983170005006;
const B3: f64 = -0.05653436583288827;
const B4: f64 = 0.004914688774712854;
const B5: f64 = 0.143761127168358;
const B6: f64 = 0.328567693746804;
