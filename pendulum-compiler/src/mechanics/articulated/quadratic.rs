//! Quadratic forms: symmetric matrices that store only nonzero entries.

use crate::algebra::expr::{Graph, Id};
use std::collections::BTreeMap;

/// Expressions, one for each unknown, and for each pair of unknowns in ascending order.
pub(super) type Places = BTreeMap<usize, Id>;
pub(super) type Entries = BTreeMap<(usize, usize), Id>;

/// A symmetric matrix and the right sides of its equations.
#[derive(Debug, Default)]
pub(super) struct Quadratic {
    pub(super) entries: Entries,
    pub(super) right: Places,
}

impl Quadratic {
    pub(super) fn entry(&self, a: usize, b: usize) -> Id {
        self.entries.get(&(a.min(b), a.max(b))).copied().unwrap_or_default()
    }

    pub(super) fn right(&self, place: usize) -> Id {
        self.right.get(&place).copied().unwrap_or_default()
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
