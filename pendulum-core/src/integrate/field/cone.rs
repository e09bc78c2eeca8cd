//! Forces that oppose rates of vectors: Coulomb's disc in the plane, and his ball in space.

use crate::integrate::field::response::solved_where;
use crate::scalar::Float;
use crate::system::{Friction, MOST_FRICTIONS, MOST_LIMITS};
use core::ops::Range;
use nalgebra::SMatrix;

/// The greatest number of forces: one for each limit, one for each component of a friction.
pub(super) const FORCES: usize = MOST_LIMITS + MOST_FRICTIONS;
/// The number of sweeps. A stack of ten blocks takes about three hundred to rounding errors.
const SWEEPS: usize = 4096;

/// Returns the components of the rate to which the component `k` belongs.
pub(crate) fn group(facts: &[Friction], k: usize) -> Range<usize> {
    heads(facts).map(|head| head..after(facts, head)).find(|own| k < own.end).unwrap_or(k..k + 1)
}

/// Returns the first component of each rate.
pub(crate) fn heads(facts: &[Friction]) -> impl Iterator<Item = usize> {
    let next = move |head: &usize| Some(after(facts, *head));
    core::iter::successors(Some(0), next).take_while(move |head| *head < facts.len())
}

fn after(facts: &[Friction], head: usize) -> usize {
    facts.get(head).map_or(head + 1, |own| head + own.components.max(1))
}

/// Returns the length of a vector.
pub(crate) fn norm<T: Float>(values: &[T]) -> T {
    if let [value] = values {
        return value.abs();
    }
    let zero = T::from_f64(0.0);
    let most = values.iter().fold(zero, |most, value| most.max(value.abs()));
    if most <= zero {
        return most;
    }
    // Squares of small numbers would be zero.
    let squares = values.iter().fold(zero, |sum, value| sum + (*value / most) * (*value / most));
    most * squares.sqrt()
}

/// Returns the force x of at most `bound` that opposes a rate of `count` components, which is r
/// without it: r + G x is zero, or it is −λ x with λ > 0 and |x| is the bound.
///
/// The second is |(G + λ)⁻¹ r| = `bound`, the equation of trust regions. Newton's method for 1/|x|
/// converges to its root from below; J. J. Moré and D. C. Sorensen, SIAM J. Sci. Stat. Comput. 4
/// (1983) 553.
pub(super) fn opposing<T: Float>(
    count: usize,
    block: impl Fn(usize, usize) -> T,
    rate: impl Fn(usize) -> T,
    bound: T,
) -> [T; 3] {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    if bound <= zero {
        return [zero; 3];
    }
    let mut matrix = SMatrix::<T, 3, 3>::from_element(zero);
    let mut against = [zero; 3];
    for i in 0..count {
        against[i] = -rate(i);
        for j in 0..count {
            matrix[(i, j)] = block(i, j);
        }
    }
    let size = (0..count).fold(zero, |sum, i| sum + matrix[(i, i)]);
    let least = T::EPSILON.sqrt() * size;
    let solve = |shift: T, right: [T; 3]| {
        let mut matrix = matrix;
        for i in 0..count {
            matrix[(i, i)] += shift;
        }
        // A component that no force changes needs none.
        solved_where(matrix, right, |i, pivot| i < count && least < pivot)
    };
    let mut shift = (norm(&against) / bound - size).max(zero);
    let mut force = solve(shift, against);
    for _ in 0..64 {
        let length = norm(&force);
        if length <= bound {
            break;
        }
        let slope = solve(shift, force.map(|part| part / length));
        let slope = (0..count).fold(zero, |sum, i| sum + slope[i] * force[i] / length);
        let next = shift + (length / bound - one) / slope;
        if next <= shift {
            break;
        }
        shift = next;
        force = solve(shift, against);
    }
    force
}

/// The forces of limits and frictions: a matrix of their effects on the rates of all of them, and
/// the rates without them.
pub(super) struct Balance<T> {
    /// The number of limits, which come first.
    pub(super) limits: usize,
    pub(super) count: usize,
    pub(super) matrix: [[T; FORCES]; FORCES],
    pub(super) rates: [T; FORCES],
}

impl<T: Float> Balance<T> {
    /// Returns the rate of a force at `forces`, without the effect of those in `but`.
    pub(super) fn rate(&self, i: usize, forces: &[T; FORCES], but: &Range<usize>) -> T {
        let others = (0..self.count).filter(|j| !but.contains(j));
        others.fold(self.rates[i], |sum, j| sum + self.matrix[i][j] * forces[j])
    }

    /// Returns the forces after which no limit closes, each of which is zero where it opens, and
    /// which oppose the rates of the frictions, up to rounding errors; `None` if none are found.
    ///
    /// `groups` are the frictions, and `bound` is the bound of that which begins at an index. The
    /// sweeps of Gauss and Seidel set one force after the other as if the others were known. With
    /// contacts without friction they minimize a convex function; M. Jean, Comput. Methods Appl.
    /// Mech. Eng. 177 (1999) 235, uses them with friction. They end where a whole sweep changes
    /// nothing, which proves the laws of all.
    pub(super) fn solve(
        &self,
        groups: &[Range<usize>],
        bound: impl Fn(usize, &[T; FORCES]) -> T,
    ) -> Option<[T; FORCES]> {
        let zero = T::from_f64(0.0);
        let mut forces = [zero; FORCES];
        let mut worst = T::from_f64(f64::INFINITY);
        for _ in 0..SWEEPS {
            worst = zero;
            let mut set = |forces: &mut [T; FORCES], i: usize, force: T| {
                let size = (0..self.count).fold(self.rates[i].abs(), |sum, j| {
                    sum + (self.matrix[i][j] * forces[j]).abs()
                });
                let change = (self.matrix[i][i] * (force - forces[i])).abs() / size;
                // A rate of zero that no force changes has no size.
                worst = if zero < size { worst.max(change) } else { worst };
                forces[i] = force;
            };
            for i in 0..self.limits {
                let (rate, own) = (self.rate(i, &forces, &(i..i + 1)), self.matrix[i][i]);
                if rate < zero && own <= zero {
                    return None;
                }
                set(&mut forces, i, if rate < zero { -rate / own } else { zero });
            }
            for group in groups {
                let most = bound(group.start, &forces);
                let block = |i: usize, j: usize| self.matrix[group.start + i][group.start + j];
                let rate = |i: usize| self.rate(group.start + i, &forces, group);
                let force = opposing(group.len(), block, rate, most);
                for (i, force) in group.clone().zip(force) {
                    set(&mut forces, i, force);
                }
            }
            if worst <= T::from_f64(8.0) * T::EPSILON {
                break;
            }
        }
        (worst <= T::EPSILON.sqrt()).then_some(forces)
    }
}
