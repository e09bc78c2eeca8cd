//! Constraints and limits of a system: their names, kinds and units.

/// The greatest number of scalar limits of a system.
pub const MOST_LIMITS: usize = 16;

/// A scalar constraint g(q, t) = 0 or A(q, t) q̇ + b(q, t) = 0.
///
/// The forces Cᵀλ of its multiplier λ stand in the equations M q̈ = f + Cᵀλ, with C = ∂g/∂q or A;
/// along a motion that keeps it they do no work but that of its explicit time, −λ ∂g/∂t or −λ b.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Constraint {
    /// The name as written, with the component of a vector and the member of a family: `loop.x`,
    /// `rod[2]`, `joint[0].y`.
    pub name: &'static str,
    /// The unit of the two sides, empty where none is known.
    pub unit: &'static str,
    /// The unit of the multiplier λ, an energy per unit of a holonomic constraint and a power per
    /// unit of one of velocities; empty where none is known.
    pub reaction_unit: &'static str,
    /// It holds positions, and not velocities alone.
    pub holonomic: bool,
    /// It follows from the others: it is checked and not solved, and has no multiplier.
    pub redundant: bool,
}

/// A one-sided limit h(q, t) ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limit {
    /// The name as written, with the member of a family: `rail`, `floor[2]`.
    pub name: &'static str,
    /// The unit of the two sides, empty where none is known.
    pub unit: &'static str,
}

impl Constraint {
    /// A constraint that the equations hold; for systems written by hand.
    pub const fn new(name: &'static str, unit: &'static str, holonomic: bool) -> Self {
        Self { name, unit, reaction_unit: "", holonomic, redundant: false }
    }

    /// The same with the unit of its multiplier.
    pub const fn with_reaction_unit(self, reaction_unit: &'static str) -> Self {
        Self { reaction_unit, ..self }
    }

    /// The same constraint, which is checked and not solved.
    pub const fn redundant(self) -> Self {
        Self { redundant: true, ..self }
    }
}

impl Limit {
    /// A limit; for systems written by hand.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit }
    }
}
