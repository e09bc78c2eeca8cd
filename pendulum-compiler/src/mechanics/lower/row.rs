//! Rows: scalar constraints and limits.

use crate::algebra::expr::Id;

/// A scalar constraint or limit.
#[derive(Debug)]
pub(crate) struct Row {
    /// The index of its statement among the constraints or among the limits.
    pub(crate) statement: usize,
    /// The name with component and index: `loop.x`, `rod[2]`.
    pub(crate) name: String,
    /// The left side minus the right side.
    pub(crate) value: Id,
    /// The restitution of a limit.
    pub(crate) restitution: Id,
}

/// The shape of a constraint, and the index of its first scalar.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shape {
    pub(super) first: usize,
    pub(super) members: Option<usize>,
    /// The number of components, or 0 for a scalar.
    pub(super) components: usize,
}
