//! The symmetric multistep methods of Quinlan and Tremaine.

mod history;

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Memory, Method};
use crate::integrate::methods::quinlan_tremaine::history::{History, Scheme, padded};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::{Dynamics, VelocityFree};

/// The explicit symmetric multistep method of Quinlan and Tremaine of order `P` = 8, 10 or 12: one
/// evaluation per step, fixed step.
///
/// Σ α_j q_{n+j} = h² Σ β_j a(q_{n+j}) with palindromic α and β, computed in sums of differences.
/// The method is symmetric in time and therefore neither damps nor excites: energy errors stay
/// bounded and phase errors only grow with time, as with symplectic methods, for a single
/// evaluation per step. Over long times no other method here takes so few evaluations for errors
/// from 1e-4 down to 1e-12: over 1000 s of a pendulum 15 evaluations per second give an error of
/// 3e-5, and 50 one of 4e-12. Use order 8 for errors above 1e-5 and order 12 below 1e-8.
///
/// The method has the limits of symmetric multistep methods. A step must be short for the fastest
/// part of the motion: h·ω below about 0.2 for order 12, 0.3 for order 10 and 0.5 for order 8.
/// Beyond these bounds, and near a few resonances below them (more for orbits and many coupled
/// frequencies), errors grow without warning, so compare with half the step. The first `P` − 1
/// steps after the start, after a kink and after a change of the step are taken by
/// [`Dop853`](crate::integrate::Dop853) in four parts each: for a motion with many kinks the method
/// has no advantage.
///
/// The method requires a constant mass matrix and accelerations without velocities, and does not
/// compile for other systems. Dense output is the polynomial through both ends and the last seven
/// accelerations, of order 9, and takes no further evaluations; in the first five steps after a
/// start, a kink or a change of the step it is the quintic through the coordinates, velocities and
/// accelerations at both ends.
///
/// Source: Quinlan and Tremaine (1990), Symmetric multistep methods for the numerical integration
/// of planetary orbits, Astron. J. 100, 1694, table 2; for the resonances Quinlan (1999), arXiv
/// astro-ph/9901136.
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(QuinlanTremaine::<8>::new()).step(0.01).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuinlanTremaine<const P: usize>;

impl<const P: usize> QuinlanTremaine<P> {
    /// Creates the method.
    pub const fn new() -> Self {
        Self
    }
}

impl<const P: usize> Scheme<P> for QuinlanTremaine<P> {
    const BETA: [f64; P] = padded(match P {
        8 => &BETA8,
        10 => &BETA10,
        12 => &BETA12,
        _ => panic!("`QuinlanTremaine<P>` has order 8, 10 or 12"),
    });
    const ALPHA: [f64; P] = padded(match P {
        8 => &ALPHA8,
        10 => &ALPHA10,
        12 => &ALPHA12,
        _ => panic!("`QuinlanTremaine<P>` has order 8, 10 or 12"),
    });
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize, const P: usize>
    Method<D, N> for QuinlanTremaine<P>
{
    const NAME: &'static str = match P {
        8 => "QuinlanTremaine<8>",
        10 => "QuinlanTremaine<10>",
        _ => "QuinlanTremaine<12>",
    };
    type Workspace = History<D::Scalar, N, P>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        History::new()
    }

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        history: &mut History<D::Scalar, N, P>,
    ) -> Endpoint<D::Scalar, N> {
        history.step::<Self, D, W>(field, interval, from)
    }

    fn interpolant(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        history: &mut History<D::Scalar, N, P>,
    ) -> Interpolant<D::Scalar, N> {
        history.interpolant(field, interval, from, to)
    }

    fn remember(&self, history: &mut Self::Workspace, memory: &mut Memory) {
        history.remember(memory);
    }
}

// Printed by tests/data/multistep.py.

const BETA8: [f64; 7] = [
    1.460896164021164,
    -1.9528769841269842,
    5.080109126984127,
    -4.176256613756614,
    5.080109126984127,
    -1.9528769841269842,
    1.460896164021164,
];

const ALPHA8: [f64; 6] = [0.0, 1.0, 1.0, 1.0, 0.0, 1.0];

const BETA10: [f64; 9] = [
    1.6500785383597885,
    -2.0054398148148147,
    9.885234788359789,
    -11.643237433862433,
    19.226727843915345,
    -11.643237433862433,
    9.885234788359789,
    -2.0054398148148147,
    1.6500785383597885,
];

const ALPHA10: [f64; 8] = [1.0, 2.0, 2.0, 3.0, 2.0, 2.0, 1.0, 1.0];

const BETA12: [f64; 11] = [
    1.7095686966390091,
    -4.3139136528980275,
    15.268517936056998,
    -30.598769390331892,
    51.011817167207795,
    -57.15444151334776,
    51.011817167207795,
    -30.598769390331892,
    15.268517936056998,
    -4.3139136528980275,
    1.7095686966390091,
];

const ALPHA12: [f64; 10] = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0];
