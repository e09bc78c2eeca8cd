//! A check that the mass matrix is positive definite, as the kinetic energy of bodies with mass
//! requires.

use crate::error::Error;
use crate::integrate::field::phase::Phase;
use crate::scalar::Float;
use crate::system::{Dynamics, Facts, System, check_inertia};

/// Returns `true` if [`inertia`] has to check the step with the number `accepted`.
///
/// It checks every step that ends on a kink and every 64th step. Above sixteen coordinates it
/// checks every N²/4-th step, rounded up to a power of two, so that the cost is negligible.
///
/// Pivots change their sign only at points with a singular mass matrix, which methods with step
/// control do not pass.
#[inline]
pub(crate) fn is_due<S: System<N>, const N: usize>(accepted: u64, on_kink: bool) -> bool {
    let every = if N <= 16 { 64 } else { (N * N / 4).next_power_of_two() as u64 };
    varies(&S::FACTS) && (on_kink || accepted.is_multiple_of(every))
}

/// Returns `true` if pivots may change their sign during an integration.
pub(crate) fn varies(facts: &Facts) -> bool {
    facts.derived && !facts.constant_mass_matrix
}

/// Returns an error if the mass matrix of the state has a negative pivot.
///
/// Systems written by hand need no mass matrix, and are not checked.
#[inline(never)]
pub(crate) fn inertia<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
) -> Result<(), Error> {
    // Saves the samples of the inputs.
    if !<D::System as System<N>>::FACTS.derived {
        return Ok(());
    }
    let Phase { dynamics, t, q, v, .. } = *phase;
    check_inertia(dynamics.system(), t, q, v, &phase.momentum_inputs())
}
