//! A splitting method of Blanes and Moan with eleven evaluations.

use crate::integrate::method::Method;
use crate::integrate::schemes::splitting::{Splitting, kick_drift_kick};
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::field::Field;
use crate::integrate::step::interval::StepInterval;
use crate::scalar::Float;
use crate::system::{Dynamics, VelocityFree};

/// The symplectic Runge–Kutta–Nyström splitting with eleven evaluations of Blanes and Moan: order
/// 6, fixed step.
///
/// The method for long motions to errors of 1e-6 … 1e-12. Symplectic and reversible: energy errors
/// stay bounded, phase errors grow with time. Some of its drifts and kicks go backwards.
///
/// It is for systems with a constant mass matrix and accelerations without velocities, and compiles
/// for no others. Dense output is the quintic through coordinates, velocities and accelerations at
/// both ends and costs nothing; its order is 6 in the coordinates and 5 in the velocities.
///
/// Source: Blanes and Moan (2002), Practical symplectic partitioned Runge–Kutta and
/// Runge–Kutta–Nyström methods, J. Comput. Appl. Math. 142, 313, table 3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Srkn11b;

impl Srkn11b {
    /// The method.
    pub const fn new() -> Self {
        Self
    }
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> Method<D, N>
    for Srkn11b
{
    const NAME: &'static str = "Srkn11b";
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

const SPLITTING: Splitting<12, 11> = Splitting::kicks_outside(
    &[B1, B2, B3, B4, B5, 0.5 - (B1 + B2 + B3 + B4 + B5)],
    &[A1, A2, A3, A4, A5, 1.0 - 2.0 * (A1 + A2 + A3 + A4 + A5)],
);

const A1: f64 = 0.123229775946271;
const A2: f64 = 0.290553797799558;
const A3: f64 = -0.127049212625417;
const A4: f64 = -0.246331761062075;
const A5: f64 = 0.357208872795928;

const B1: f64 = 0.0414649985182624;
const B2: f64 = 0.198128671918067;
const B3: f64 = -0.0400061921041533;
const B4: f64 = 0.0752539843015807;
const B5: f64 = -0.0115113874206879;
