//! Handles of pendulums.

use core::cmp::Ordering;
use core::fmt;
use core::hash::{Hash, Hasher};
use core::marker::PhantomData;

/// A pendulum in a scene: its type and its number among those of its type.
pub struct Handle<S, const N: usize> {
    index: u32,
    kind: PhantomData<fn() -> S>,
}

impl<S, const N: usize> Handle<S, N> {
    /// The pendulum that was hung as number `index` of its type, from 0.
    pub const fn new(index: u32) -> Self {
        Self { index, kind: PhantomData }
    }

    /// Its number among those of its type, in the order of hanging.
    pub const fn index(self) -> u32 {
        self.index
    }
}

impl<S, const N: usize> Clone for Handle<S, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const N: usize> Copy for Handle<S, N> {}

impl<S, const N: usize> PartialEq for Handle<S, N> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

impl<S, const N: usize> Eq for Handle<S, N> {}

impl<S, const N: usize> PartialOrd for Handle<S, N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The order of hanging.
impl<S, const N: usize> Ord for Handle<S, N> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.index.cmp(&other.index)
    }
}

impl<S, const N: usize> Hash for Handle<S, N> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.index.hash(state);
    }
}

impl<S, const N: usize> fmt::Debug for Handle<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Handle").field(&self.index).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::Handle;
    use std::collections::{BTreeSet, HashSet};

    /// A type without any trait: handles need none of it.
    struct Bob;

    #[test]
    fn handles_are_keys_of_maps() {
        let handle = Handle::<Bob, 1>::new;
        let ordered: BTreeSet<_> = [handle(2), handle(0), handle(2)].into();
        assert!(ordered.into_iter().eq([handle(0), handle(2)]));
        assert_eq!(HashSet::from([handle(1), handle(1)]).len(), 1);
    }
}
