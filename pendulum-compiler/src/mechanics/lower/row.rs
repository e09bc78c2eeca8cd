//! Rows: scalar constraints and limits.

use crate::algebra::expr::Id;

/// A scalar constraint or limit.
#[derive(Debug)]
pub(crate) struct Row {
    /// The index of its statement among the constraints, or among the limits.
    pub(crate) statement: usize,
    /// Its name with its component and its index: `loop.x`, `rod[2]`.
    pub(crate) name: String,
    /// The left side less the right one.
    pub(crate) value: Id,
    /// The restitution of a limit.
    pub(crate) restitution: Id,
}

/// The shape of a constraint, and the number of scalars before it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shape {
    pub(super) first: usize,
    pub(super) members: Option<usize>,
    /// 0 for a scalar.
    pub(super) components: usize,
}
