//! Possible causes of a failed step: a singular mass matrix, and parameters.

use crate::error::{Error, Quantity};
use crate::integrate::field::phase::Phase;
use crate::integrate::linear::Factors;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, System, suspects};
use crate::time::Time;

/// Returns `true` if the mass matrix of the state is not singular, so that it leads from velocities
/// to momenta and back.
pub(crate) fn regular<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
) -> bool {
    let mass = phase.dynamics.system().mass_matrix(phase.at(&phase.momentum_inputs()));
    let momenta = Factors::<_, N, 1>::new(|_, _| {
        core::array::from_fn(|i| core::array::from_fn(|j| mass[(i, j)]))
    });
    let mut unit = [[D::Scalar::from_f64(1.0); N]];
    momenta.solve(&mut unit);
    unit[0].iter().all(|x| x.is_finite())
}

/// Returns the error for a number that is not finite, with the parameters that may be the cause.
pub(crate) fn not_finite<S: System<N, Scalar: Float>, const N: usize>(
    system: &S,
    t: Time,
    what: Quantity,
) -> Error {
    let suspects = if let Quantity::Acceleration(_) = what { suspects(system) } else { Vec::new() };
    Error::NotFinite { t: t.to_f64(), what, suspects }
}
