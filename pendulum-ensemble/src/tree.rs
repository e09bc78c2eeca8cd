//! The binary tree by which shards are joined.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A tree of parts that wait for their siblings: parts 2k and 2k + 1 of a level are joined to part
/// k of the next level. A last part without a sibling moves to the next level unchanged.
///
/// If shards finish in order, at most as many parts wait as there are levels and threads.
pub(super) struct Tree<P> {
    leaves: usize,
    waiting: Mutex<BTreeMap<(u32, usize), P>>,
}

impl<P> Tree<P> {
    /// Creates a tree with the given number of leaves.
    pub(super) fn new(leaves: usize) -> Self {
        Self { leaves, waiting: Mutex::new(BTreeMap::new()) }
    }

    /// Adds a leaf, and joins all pairs of siblings that are complete.
    pub(super) fn add(&self, leaf: usize, part: P, join: impl Fn(P, P) -> P) {
        let (mut level, mut index, mut part) = (0, leaf, part);
        loop {
            let count = self.leaves.div_ceil(1 << level);
            if count == 1 || index ^ 1 < count {
                let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
                let Some(other) = waiting.remove(&(level, index ^ 1)) else {
                    waiting.insert((level, index), part);
                    return;
                };
                // Releases the lock, so that other threads can continue during the join.
                drop(waiting);
                part = if index % 2 == 0 { join(part, other) } else { join(other, part) };
            }
            (level, index) = (level + 1, index / 2);
        }
    }

    /// Returns the root. If leaves are missing, all parts are joined in the order of their indices.
    /// Returns `None` without leaves.
    pub(super) fn finish(self, join: impl Fn(P, P) -> P) -> Option<P> {
        let waiting = self.waiting.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut parts: Vec<_> =
            waiting.into_iter().map(|((level, index), part)| (index << level, part)).collect();
        parts.sort_unstable_by_key(|part| part.0);
        parts.into_iter().map(|(_, part)| part).reduce(join)
    }
}

#[cfg(test)]
mod tests {
    use super::Tree;

    fn joined(leaves: usize, order: impl Iterator<Item = usize>) -> Option<String> {
        let tree = Tree::new(leaves);
        let join = |a: String, b: String| format!("({a} {b})");
        for leaf in order {
            tree.add(leaf, leaf.to_string(), join);
        }
        tree.finish(join)
    }

    #[test]
    fn the_tree_does_not_depend_on_the_order() {
        assert_eq!(joined(0, 0..0), None);
        assert_eq!(joined(1, 0..1).unwrap(), "0");
        let seven = "(((0 1) (2 3)) ((4 5) 6))";
        assert_eq!(joined(7, 0..7).unwrap(), seven);
        assert_eq!(joined(7, (0..7).rev()).unwrap(), seven);
        assert_eq!(joined(7, [3, 6, 1, 5, 0, 2, 4].into_iter()).unwrap(), seven);
        for leaves in 1..70 {
            let forwards = joined(leaves, 0..leaves);
            // 31 is coprime to all other numbers of leaves.
            let step = if leaves % 31 == 0 { 1 } else { 31 };
            assert_eq!(forwards, joined(leaves, (0..leaves).map(|k| k * step % leaves)));
        }
    }

    #[test]
    fn few_parts_wait() {
        let tree = Tree::new(1 << 12);
        for leaf in 0..(1 << 12) - 1 {
            tree.add(leaf, 1, |a, b| a + b);
            assert!(tree.waiting.lock().unwrap().len() <= 12);
        }
    }
}
