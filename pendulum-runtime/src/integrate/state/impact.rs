//! Impacts on limits, as solutions list them.

use crate::integrate::state::State;
use crate::time::Time;

/// An impact on a limit h(q, t) ≥ 0 of the system.
///
/// The impulse μ ≥ 0 acts along n = ∂h/∂q: M(q̇⁺ − q̇⁻) = nμ + Cᵀν, where ν are the impulses of the
/// constraints, with ḣ⁺ = −e ḣ⁻. Several limits that are closed at one time act in the order of
/// declaration, each on the velocities that the one before it has left, and again until none of
/// them closes; after a hundred rounds without rebound.
///
/// A limit whose rebound ḣ⁺ is below what the tolerances allow its rate (below rounding, with fixed
/// steps), while ḧ < 0 without it, stays in contact: then q̈ = q̈₀ + K nμ, where q̈₀ are the
/// accelerations without it, K n = M⁻¹(n + Cᵀν) keeps the constraints and μ keeps ḧ = 0; each step
/// ends on h = ḣ = 0. It lets go where μ falls below zero, which is no impact. Methods that do not
/// know the force end with [`Error::Contact`] where a contact begins.
///
/// Source: F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral Contacts (1996), chapter
/// 8.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "T: serde::Serialize")))]
#[non_exhaustive]
pub struct Impact<T, const N: usize> {
    /// The index of the limit in the order of declaration.
    pub limit: usize,
    /// The name of the limit.
    pub name: &'static str,
    /// When.
    pub time: Time,
    /// The state before it.
    pub state: State<T, N>,
    /// The state after it; where the limit stays in contact, after all that acted at that time.
    pub after: State<T, N>,
    /// The sum of its impulses at that time, an action per unit of the limit.
    pub impulse: T,
}
