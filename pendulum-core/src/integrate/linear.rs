//! Linear equations of a size known at compile time.

use crate::scalar::Float;

/// An N×N matrix of scalars of any type that implements [`Float`].
pub(crate) type Square<T, const N: usize> = [[T; N]; N];

/// The LU factors, with row interchanges, of a matrix of `S`×`S` blocks of `N`×`N` entries.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factors<T, const N: usize, const S: usize> {
    /// Entry (i, a), (j, b) as `rows[i][a][j][b]`.
    rows: [[[[T; N]; S]; N]; S],
    /// For each row, the index of the row interchanged with it.
    pivots: [[usize; N]; S],
}

impl<T: Float, const N: usize, const S: usize> Factors<T, N, S> {
    /// Factors the matrix of the blocks `block(i, j)`. The solutions for a singular matrix are not
    /// finite.
    pub(crate) fn new(mut block: impl FnMut(usize, usize) -> Square<T, N>) -> Self {
        let zero = T::from_f64(0.0);
        let mut factors = Self { rows: [[[[zero; N]; S]; N]; S], pivots: [[0; N]; S] };
        for i in 0..S {
            for j in 0..S {
                for (a, row) in block(i, j).into_iter().enumerate() {
                    factors.rows[i][a][j] = row;
                }
            }
        }
        for k in 0..S * N {
            let mut pivot = k;
            for row in k + 1..S * N {
                if factors.get(pivot, k).abs() < factors.get(row, k).abs() {
                    pivot = row;
                }
            }
            factors.pivots[k / N][k % N] = pivot;
            let top = factors.rows[pivot / N][pivot % N];
            factors.rows[pivot / N][pivot % N] = factors.rows[k / N][k % N];
            factors.rows[k / N][k % N] = top;
            let top = top.as_flattened();
            for row in factors.rows.as_flattened_mut().iter_mut().skip(k + 1) {
                let row = row.as_flattened_mut();
                let factor = row[k] / top[k];
                row[k] = factor;
                for (entry, above) in row.iter_mut().zip(top).skip(k + 1) {
                    *entry -= factor * *above;
                }
            }
        }
        factors
    }

    /// Replaces the right-hand side `x` by the solution.
    pub(crate) fn solve(&self, x: &mut [[T; N]; S]) {
        for k in 0..S * N {
            let pivot = self.pivots[k / N][k % N];
            let value = x[pivot / N][pivot % N];
            x[pivot / N][pivot % N] = x[k / N][k % N];
            x[k / N][k % N] = value;
        }
        let (x, rows) = (x.as_flattened_mut(), self.rows.as_flattened());
        for k in 0..S * N {
            for j in 0..k {
                let part = rows[k].as_flattened()[j] * x[j];
                x[k] -= part;
            }
        }
        for k in (0..S * N).rev() {
            for j in k + 1..S * N {
                let part = rows[k].as_flattened()[j] * x[j];
                x[k] -= part;
            }
            x[k] /= rows[k].as_flattened()[k];
        }
    }

    fn get(&self, row: usize, column: usize) -> T {
        self.rows[row / N][row % N][column / N][column % N]
    }
}

/// Returns the product of `matrix` and `x`.
pub(crate) fn times<T: Float, const N: usize>(matrix: &Square<T, N>, x: &[T; N]) -> [T; N] {
    matrix.map(|row| row.iter().zip(x).fold(T::from_f64(0.0), |sum, (a, x)| sum + *a * *x))
}

#[cfg(test)]
mod tests {
    use super::{Factors, times};

    #[test]
    fn a_matrix_of_blocks_with_zeros_on_its_diagonal() {
        let block = |i: usize, j: usize| {
            let entry = |a: usize, b: usize| {
                ((7 * (2 * i + a) + 5 * (2 * j + b)) * (2 * i + a + 1) % 11) as f64
            };
            [[if i == j { 0.0 } else { entry(0, 0) }, entry(0, 1)], [entry(1, 0), entry(1, 1)]]
        };
        let exact = [[1.0, -2.0], [3.0, 0.5], [-0.25, 4.0]];
        let mut x = [[0.0; 2]; 3];
        for i in 0..3 {
            for j in 0..3 {
                let part = times(&block(i, j), &exact[j]);
                (x[i][0], x[i][1]) = (x[i][0] + part[0], x[i][1] + part[1]);
            }
        }
        Factors::<f64, 2, 3>::new(block).solve(&mut x);
        for (x, exact) in x.iter().flatten().zip(exact.iter().flatten()) {
            assert!((x - exact).abs() < 1e-13, "{x} instead of {exact}");
        }
    }

    #[test]
    fn a_singular_matrix_has_no_finite_solution() {
        let mut x = [[1.0, 2.0]];
        Factors::<f64, 2, 1>::new(|_, _| [[1.0, 2.0], [2.0, 4.0]]).solve(&mut x);
        assert!(!x[0].iter().all(|x| x.is_finite()));
    }
}
