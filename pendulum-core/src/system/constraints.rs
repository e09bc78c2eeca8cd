//! Constraints, limits and dry frictions of a system: their names, kinds and units.

/// The greatest number of scalar limits of a system.
pub const MOST_LIMITS: usize = 16;

/// The greatest number of scalar rates with dry friction of a system.
pub const MOST_FRICTIONS: usize = 16;

/// A scalar constraint g(q, t) = 0 or A(q, t) q̇ + b(q, t) = 0.
///
/// The multiplier λ of a constraint adds the forces Cᵀλ to the equations M q̈ = f + Cᵀλ, with C =
/// ∂g/∂q or C = A. Along a motion that satisfies the constraint, their power is −λ ∂g/∂t or −λ b.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Constraint {
    /// The name in the source, with the component of a vector and the index in a family: `loop.x`,
    /// `rod[2]`, `joint[0].y`.
    pub name: &'static str,
    /// The unit of both sides, empty if it is unknown.
    pub unit: &'static str,
    /// The unit of the multiplier λ, empty if it is unknown. It is an energy per `unit` for a
    /// holonomic constraint and a power per `unit` for a constraint on velocities.
    pub reaction_unit: &'static str,
    /// `true` for a constraint g(q, t) = 0 on positions, `false` for a constraint on velocities
    /// only.
    pub holonomic: bool,
    /// `true` if the constraint follows from the others. A redundant constraint has no multiplier:
    /// it is checked, but not solved for.
    pub redundant: bool,
}

/// A one-sided limit h(q, t) ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limit {
    /// The name in the source, with the index in a family: `rail`, `floor[2]`.
    pub name: &'static str,
    /// The unit of both sides, empty if it is unknown.
    pub unit: &'static str,
}

/// A scalar rate r = A(q, t) q̇ + b(q, t) with dry friction, or a component of such a rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Friction {
    /// The name in the source, with the component of a vector and the index in a family: `shoe`,
    /// `grip.x`, `joint[2]`.
    pub name: &'static str,
    /// The unit of the rate, empty if it is unknown.
    pub unit: &'static str,
    /// The unit of the force, a power per `unit`, empty if it is unknown.
    pub reaction_unit: &'static str,
    /// The number of components of the rate. The components of a vector follow one another: its
    /// force has the direction of the rate, and one bound on its magnitude.
    pub components: usize,
}

impl Constraint {
    /// Creates a constraint with a multiplier, for systems written by hand.
    pub const fn new(name: &'static str, unit: &'static str, holonomic: bool) -> Self {
        Self { name, unit, reaction_unit: "", holonomic, redundant: false }
    }

    /// Sets the unit of the multiplier.
    pub const fn with_reaction_unit(self, reaction_unit: &'static str) -> Self {
        Self { reaction_unit, ..self }
    }

    /// Marks the constraint as redundant: checked, but not solved for.
    pub const fn redundant(self) -> Self {
        Self { redundant: true, ..self }
    }
}

impl Limit {
    /// Creates a limit, for systems written by hand.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit }
    }
}

impl Friction {
    /// Creates a friction, for systems written by hand.
    pub const fn new(name: &'static str, unit: &'static str, components: usize) -> Self {
        Self { name, unit, reaction_unit: "", components }
    }

    /// Sets the unit of the force.
    pub const fn with_reaction_unit(self, reaction_unit: &'static str) -> Self {
        Self { reaction_unit, ..self }
    }
}
