//! The linear equations of columns at the nodes of a step, and their solution.

// Compiled for several instruction sets, with the functions that call these.
#![allow(clippy::inline_always)]

use super::radau::{Column, NODES, Nodes, Rule};
use crate::integrate::linear::Factors;
use crate::scalar::{Float, Octet, Real};

/// The most sweeps of the iteration before the equations are solved by elimination, which takes the
/// time of about as many. Where a step of the motion converges within seven sweeps, the columns
/// converge to rounding within twice as many; a stiff spring in the columns takes up to thirty.
const SWEEPS: usize = 32;

/// The coefficients of the linear equations at the nodes of a step of length `h`.
pub(super) struct Equations<T, const N: usize, const K: usize> {
    pub(super) h: T,
    /// ∂q̈/∂q.
    pub(super) by_q: [Nodes<T, N>; N],
    /// ∂q̈/∂q̇.
    pub(super) by_v: [Nodes<T, N>; N],
    /// The derivatives by the parameter of each column.
    pub(super) constant: [Nodes<T, N>; K],
}

impl<T: Float, const N: usize, const K: usize> Equations<T, N, K> {
    /// Computes the accelerations `a` of all columns at the nodes.
    #[inline(always)]
    pub(super) fn solve(
        &self,
        rule: &Rule<T>,
        columns: &[Column<T, N>; K],
        a: &mut [Nodes<T, N>; K],
    ) {
        let mut factors = None;
        for (k, (column, a)) in columns.iter().zip(a).enumerate() {
            if factors.is_none() && self.iterate(rule, column, k, a) {
                continue;
            }
            let factors = factors.get_or_insert_with(|| self.factors(rule));
            let still = [Octet::splat(T::from_f64(0.0)); N];
            let right = self.swept(rule, column, k, &still);
            let mut solved = core::array::from_fn(|node| right.map(|right| right.0[node]));
            factors.solve(&mut solved);
            *a = core::array::from_fn(|i| Octet(solved.map(|a| a[i])));
        }
    }

    /// Computes the accelerations `a` of column `k` by sweeps. Returns `false` if these do not
    /// converge fast.
    #[inline(always)]
    fn iterate(
        &self,
        rule: &Rule<T>,
        column: &Column<T, N>,
        k: usize,
        a: &mut Nodes<T, N>,
    ) -> bool {
        let mut last = 0.0;
        *a = self.constant[k];
        for sweep in 0..SWEEPS {
            let new = self.swept(rule, column, k, a);
            let [mut change, mut size] = [Octet::splat(T::from_f64(0.0)); 2];
            for i in 0..N {
                change += (new[i] - a[i]).abs();
                size += new[i].abs();
            }
            let sum = |all: Octet<T>| all.0.into_iter().fold(0.0, |sum, x| sum + x.to_f64());
            let (change, size) = (sum(change), sum(size));
            *a = new;
            // The next change is to this one as this one is to the last.
            let negligible = 4.0 * T::EPSILON.to_f64() * size;
            if change <= negligible || 0 < sweep && change * change <= negligible * last {
                return true;
            }
            // Changes may grow at first. NaN fails the comparison.
            if !(sweep == 0 || change < 8.0 * last) {
                return false;
            }
            last = change;
        }
        false
    }

    /// Returns A δq + B δq̇ + c at the nodes, for column `k` with the accelerations `a`.
    #[inline(always)]
    fn swept(
        &self,
        rule: &Rule<T>,
        column: &Column<T, N>,
        k: usize,
        a: &Nodes<T, N>,
    ) -> Nodes<T, N> {
        let [q, v] = rule.at_nodes(self.h, column, a);
        let mut next = self.constant[k];
        for i in 0..N {
            for j in 0..N {
                next[i] += self.by_q[i][j] * q[j];
                next[i] += self.by_v[i][j] * v[j];
            }
        }
        next
    }

    /// Returns the factors of the equations of the accelerations at all nodes.
    #[inline(always)]
    fn factors(&self, rule: &Rule<T>) -> Factors<T, N, NODES> {
        Factors::new(|node, of| {
            let square = self.h * self.h * rule.twice[of].0[node];
            let once = self.h * rule.once[of].0[node];
            core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let own = T::from_f64(if (node, i) == (of, j) { 1.0 } else { 0.0 });
                    own - square * self.by_q[i][j].0[node] - once * self.by_v[i][j].0[node]
                })
            })
        })
    }
}
