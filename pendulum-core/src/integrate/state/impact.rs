//! Impacts on limits, as listed in solutions.

use crate::integrate::state::State;
use crate::time::Time;

/// An impact on a limit h(q, t) ≥ 0 of the system.
///
/// The impulse μ ≥ 0 acts along n = ∂h/∂q: M(q̇⁺ − q̇⁻) = nμ + Cᵀν, where ν are the impulses of the
/// constraints, with ḣ⁺ = −e ḣ⁻. Limits that close at the same time act in the order of
/// declaration, each on the velocities after the previous impact. The rounds are repeated until no
/// limit closes; after a hundred rounds the impacts are without rebound.
///
/// A dry friction whose force contains the reaction of the limit acts in the impact as well. Its
/// impulse is at most the same multiple of μ, and stops where its rate is zero, or where the energy
/// would grow. `impulse` is that of the limit alone.
///
/// A limit stays in contact if its rebound ḣ⁺ is below the tolerance of its rate (below rounding,
/// with fixed steps), or below the rounding error of the fastest ḣ⁻ before, and ḧ < 0 without the
/// contact. Then q̈ = q̈₀ + K nμ, where q̈₀ are the accelerations without the contact, K n = M⁻¹(n +
/// Cᵀν) satisfies the constraints and μ keeps ḧ = 0; each step ends on h = ḣ = 0. The contact ends,
/// without an impact, when μ falls below zero. Methods that do not support the force end with
/// [`Error::Contact`](crate::error::Error::Contact) when a contact begins.
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
    /// The time of the impact.
    pub time: Time,
    /// The state before the impact.
    pub state: State<T, N>,
    /// The state after the impact; for a limit that stays in contact, after all changes at that
    /// time.
    pub after: State<T, N>,
    /// The sum of the impulses of the limit at that time, an action per unit of the limit.
    pub impulse: T,
}
