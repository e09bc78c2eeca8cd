//! A block of the mass matrix, factored once for all orders.

use crate::jet::order::Order;
use crate::scalar::Real;

/// The factors M = L D Lᵀ of a symmetric positive definite matrix.
#[derive(Clone, Copy, Debug)]
pub struct Factors<T, const B: usize> {
    /// L, the unit lower triangle, below the diagonal.
    lower: [[T; B]; B],
    /// The reciprocals of D.
    reciprocal: [T; B],
    /// M⁻¹.
    inverse: [[T; B]; B],
}

impl<T: Real, const B: usize> Factors<T, B> {
    /// Creates zero factors, to be overwritten.
    pub fn zero() -> Self {
        let zero = T::from_f64(0.0);
        Self { lower: [[zero; B]; B], reciprocal: [zero; B], inverse: [[zero; B]; B] }
    }

    /// Factors the matrix with this lower triangle; the entries above its diagonal are not used.
    #[inline]
    pub fn new(mut matrix: [[T; B]; B]) -> Self {
        let mut reciprocal = [T::from_f64(0.0); B];
        for j in 0..B {
            reciprocal[j] = T::from_f64(1.0) / matrix[j][j];
            for i in (j + 1..B).rev() {
                let factor = matrix[i][j] * reciprocal[j];
                for k in j + 1..=i {
                    let part = factor * matrix[k][j];
                    matrix[i][k] -= part;
                }
                matrix[i][j] = factor;
            }
        }
        let mut factors = Self { lower: matrix, reciprocal, inverse: matrix };
        for j in 0..B {
            let mut unit = [T::from_f64(0.0); B];
            unit[j] = T::from_f64(1.0);
            factors.inverse[j] = factors.solve(unit);
        }
        factors
    }

    /// Computes M⁻¹ `right`, with less latency than [`solve`](Self::solve).
    #[inline]
    pub fn times_inverse(&self, right: [T; B]) -> [T; B] {
        core::array::from_fn(|i| {
            let mut parts = core::array::from_fn::<_, B, _>(|j| self.inverse[i][j] * right[j]);
            // Pairwise summation.
            let mut length = B;
            while 1 < length {
                let half = length.div_ceil(2);
                for j in half..length {
                    let part = parts[j];
                    parts[j - half] += part;
                }
                length = half;
            }
            parts[0]
        })
    }

    /// Computes the accelerations of an order: accurately for the first two orders, with low
    /// latency for the others.
    #[inline]
    pub fn accelerations<O: Order>(&self, right: [T; B], order: O) -> [T; B] {
        if order.index() < 2 { self.solve(right) } else { self.times_inverse(right) }
    }

    /// Solves M x = `right`.
    #[inline]
    pub fn solve(&self, mut right: [T; B]) -> [T; B] {
        for i in 0..B {
            for k in 0..i {
                let part = self.lower[i][k] * right[k];
                right[i] -= part;
            }
        }
        for i in (0..B).rev() {
            right[i] *= self.reciprocal[i];
            for k in i + 1..B {
                let part = self.lower[k][i] * right[k];
                right[i] -= part;
            }
        }
        right
    }
}

#[cfg(test)]
mod tests {
    use super::Factors;

    #[test]
    fn an_integer_matrix_is_solved_exactly() {
        // L = [1; 2 1; −1 3 1], D = (1, 2, 4).
        let matrix = [[1.0, 0.0, 0.0], [2.0, 6.0, 0.0], [-1.0, 4.0, 23.0]];
        let x = [3.0, -5.0, 7.0];
        let right = [
            1.0 * 3.0 - 2.0 * 5.0 - 7.0,
            2.0 * 3.0 - 6.0 * 5.0 + 4.0 * 7.0,
            -3.0 - 4.0 * 5.0 + 23.0 * 7.0,
        ];
        assert_eq!(Factors::new(matrix).solve(right), x);
    }
}
