//! Reductions of mapped values.

/// A reduction of mapped members, first within a shard, then between shards.
#[derive(Clone, Copy)]
pub(super) struct Fold<'f, P, R> {
    /// Returns the part without members.
    pub(super) identity: &'f (dyn Fn() -> P + Sync),
    /// Adds the value of the member with the given index, which is greater than those in the part.
    pub(super) add: &'f (dyn Fn(P, usize, R) -> P + Sync),
    /// Joins two parts; the second has the greater indices.
    pub(super) merge: &'f (dyn Fn(P, P) -> P + Sync),
}

/// The indices and values of the members that were solved.
pub(super) type Indexed<R> = Vec<(usize, R)>;
