//! Quadratic forms: symmetric matrices that store only nonzero entries.

use crate::algebra::expr::{Graph, Id};
use std::collections::BTreeMap;

/// A symmetric matrix and the right sides of its equations.
#[derive(Debug, Default)]
pub(super) struct Quadratic {
    pub(super) entries: BTreeMap<(usize, usize), Id>,
    pub(super) right: BTreeMap<usize, Id>,
}

impl Quadratic {
    pub(super) fn entry(&self, a: usize, b: usize) -> Id {
        self.entries.get(&(a.min(b), a.max(b))).copied().unwrap_or_default()
    }

    pub(super) fn set(&mut self, key: (usize, usize), value: Id) {
        if value == Graph::ZERO {
            self.entries.remove(&key);
        } else {
            self.entries.insert(key, value);
        }
    }

    /// Returns the off-diagonal entries of a row.
    pub(super) fn row(&self, unknown: usize) -> Vec<(usize, Id)> {
        let other = |(&(a, b), &value): (&(usize, usize), &Id)| match (a == unknown, b == unknown) {
            (true, false) => Some((b, value)),
            (false, true) => Some((a, value)),
            _ => None,
        };
        self.entries.iter().filter_map(other).collect()
    }
}
