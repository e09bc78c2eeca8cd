//! Linear complementarity problems: w = q + M z, where w ≥ 0, z ≥ 0, and wᵢ zᵢ = 0.

use crate::scalar::Float;
use crate::system::{MOST_FRICTIONS, MOST_LIMITS};

/// The greatest number of unknowns: a force for each limit, two for each friction.
pub(super) const MOST: usize = MOST_LIMITS + 2 * MOST_FRICTIONS;
/// The number of paths.
const PATHS: usize = 8;
/// The pivots below which a row does not bound a step, for matrices with a diagonal of one.
const LEAST: f64 = 1e-11;

/// The equations, solved for half of the variables.
struct Dictionary<T> {
    count: usize,
    /// For each row a coefficient for each column, that of the artificial variable last.
    rows: [[T; MOST + 1]; MOST],
    values: [T; MOST],
    /// The derivatives of the values by a small change of q, which keeps equal rows apart: the path
    /// then does not return to where it was.
    shades: [T; MOST],
    /// The variable of each row: wᵢ is i, zᵢ is i + `MOST`, the artificial variable 2 `MOST`.
    basic: [usize; MOST],
    /// The variable of each column.
    other: [usize; MOST + 1],
}

/// Returns w and z for the first `count` unknowns, or `None` if there seem to be none.
///
/// The path of C. E. Lemke, Management Science 11 (1965) 681, begins with an artificial force that
/// is great enough to keep all of w positive, and reduces it to zero. It ends in a solution if M is
/// copositive plus and there is one, as for contacts with friction of given magnitude, and for
/// every P matrix. Otherwise a path may end without one, and others are tried; R. W. Cottle, J.-S. Pang and R. E. Stone, The Linear Complementarity Problem
/// (1992), section 4.4.
pub(super) fn complementary<T: Float>(
    count: usize,
    matrix: &[[T; MOST]; MOST],
    q: &[T; MOST],
) -> Option<[[T; MOST]; 2]> {
    (0..PATHS).find_map(|path| along(path, count, matrix, q))
}

/// Follows a path; each path has other weights of the artificial force.
fn along<T: Float>(
    path: usize,
    count: usize,
    matrix: &[[T; MOST]; MOST],
    q: &[T; MOST],
) -> Option<[[T; MOST]; 2]> {
    let zero = T::from_f64(0.0);
    let mut rows = [[zero; MOST + 1]; MOST];
    for i in 0..count {
        rows[i][..count].copy_from_slice(&matrix[i][..count]);
        rows[i][count] = T::from_f64(1.0 + (0.7548776662466927 * (path * (i + 1)) as f64) % 1.0);
    }
    let mut other = core::array::from_fn(|column| MOST + column);
    other[count] = 2 * MOST;
    let basic = core::array::from_fn(|row| row);
    // Any numbers that no sum of a few others equals.
    let shades = core::array::from_fn(|i| T::from_f64(1.0 + (0.6180339887498949 * i as f64) % 1.0));
    let mut own = Dictionary { count, rows, values: *q, shades, basic, other };
    let ratio = |i: &usize| own.values[*i] / own.rows[*i][count];
    let first = (0..count).filter(|i| own.values[*i] < zero);
    let first = first.reduce(|a, b| if ratio(&b) < ratio(&a) { b } else { a });
    let Some(mut row) = first else { return Some([*q, [zero; MOST]]) };
    let mut column = count;
    // Far more exchanges than the path has; they end a cycle of rounding errors.
    for _ in 0..32 * MOST {
        let left = own.basic[row];
        own.exchange(row, column);
        if left == 2 * MOST {
            return Some(own.solution());
        }
        // The complement of the variable that has become zero grows.
        let next = if left < MOST { left + MOST } else { left - MOST };
        column = own.other[..=count].iter().position(|variable| *variable == next)?;
        row = own.bound(column)?;
    }
    None
}

impl<T: Float> Dictionary<T> {
    /// Returns the row that first becomes zero while the variable of `column` grows.
    fn bound(&self, column: usize) -> Option<usize> {
        let zero = T::from_f64(0.0);
        let slope = |i: usize| -self.rows[i][column];
        let mut first: Option<(usize, T)> = None;
        for i in (0..self.count).filter(|i| T::from_f64(LEAST) < slope(*i)) {
            let value = if self.values[i] < zero { zero } else { self.values[i] };
            let length = value / slope(i);
            let replaces = first.is_none_or(|(row, least)| {
                let equal = T::EPSILON * T::from_f64(16.0) * least;
                // Among equal rows, the artificial variable ends the path.
                let shade = |i: usize| self.shades[i] / slope(i);
                length < least - equal
                    || length <= least + equal
                        && self.basic[row] != 2 * MOST
                        && (self.basic[i] == 2 * MOST || shade(i) < shade(row))
            });
            if replaces {
                first = Some((i, length));
            }
        }
        first.map(|(row, _)| row)
    }

    /// Exchanges the variables of a row and a column.
    fn exchange(&mut self, row: usize, column: usize) {
        let count = self.count;
        let (mut pivotal, pivot) = (self.rows[row], self.rows[row][column]);
        for entry in &mut pivotal[..=count] {
            *entry = -*entry / pivot;
        }
        pivotal[column] = T::from_f64(1.0) / pivot;
        let (value, shade) = (-self.values[row] / pivot, -self.shades[row] / pivot);
        for i in (0..count).filter(|i| *i != row) {
            let factor = self.rows[i][column];
            for j in (0..=count).filter(|j| *j != column) {
                self.rows[i][j] += factor * pivotal[j];
            }
            self.rows[i][column] = factor * pivotal[column];
            self.values[i] += factor * value;
            self.shades[i] += factor * shade;
        }
        (self.rows[row], self.values[row], self.shades[row]) = (pivotal, value, shade);
        core::mem::swap(&mut self.basic[row], &mut self.other[column]);
    }

    fn solution(&self) -> [[T; MOST]; 2] {
        let mut both = [[T::from_f64(0.0); MOST]; 2];
        for row in 0..self.count {
            let variable = self.basic[row];
            both[variable / MOST][variable % MOST] = self.values[row];
        }
        both
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, complementary};

    fn solve<const K: usize>(matrix: [[f64; K]; K], q: [f64; K]) -> Option<[[f64; K]; 2]> {
        let (wide, mut right) = (vec![[0.0; MOST]; MOST], [0.0; MOST]);
        let mut wide: Box<[[f64; MOST]; MOST]> = wide.try_into().unwrap();
        for i in 0..K {
            wide[i][..K].copy_from_slice(&matrix[i]);
        }
        right[..K].copy_from_slice(&q);
        complementary(K, &wide, &right)
            .map(|both| both.map(|part| core::array::from_fn(|i| part[i])))
    }

    #[test]
    fn one_force_holds_what_would_close() {
        assert_eq!(solve([[2.0]], [3.0]), Some([[3.0], [0.0]]));
        assert_eq!(solve([[2.0]], [-3.0]), Some([[0.0], [1.5]]));
    }

    #[test]
    fn forces_without_room_leave_the_rates() {
        // Two frictions with the bound zero.
        let matrix = [
            [1.0, -0.0863, 1.0, 0.0],
            [-0.0863, 1.0, 0.0, 1.0],
            [-1.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.0],
        ];
        for rates in [[-0.0087, 0.3356], [-0.0087, -0.3356], [0.0, 0.2]] {
            let [w, z] = solve(matrix, [rates[0], rates[1], 0.0, 0.0]).unwrap();
            for i in 0..2 {
                assert!((w[i] - z[i + 2] - rates[i]).abs() < 1e-15, "{w:?} {z:?}");
            }
        }
    }

    #[test]
    fn a_foot_in_contact_and_one_above_have_one_rate() {
        let matrix = [
            [1.32495719093194, -0.5836116260067848, -0.5836116260067848, 0.0, 0.0],
            [-1.1404154600143035, 1.0, 1.0, 1.0, 0.0],
            [-1.1404154600143035, 1.0, 1.0, 0.0, 1.0],
            [1.1136076680150373, -1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -1.0, 0.0, 0.0],
        ];
        let q = [-6.809471633547821, 4.109283754256322e-11, -4.109283754256324e-11, 0.0, 0.0];
        let [w, z] = solve(matrix, q).unwrap();
        assert!((z[0] - 10.087).abs() < 1e-3 && z[3] > 0.2 && w[0] == 0.0, "{w:?} {z:?}");
    }

    #[test]
    fn a_force_that_closes_its_own_contact_has_no_solution() {
        assert_eq!(solve([[-1.0]], [-1.0]), None);
    }

    #[test]
    fn random_problems_with_positive_minors_are_solved() {
        let mut seed = 1_u64;
        let mut number = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..2000 {
            let root: [[f64; 5]; 5] = core::array::from_fn(|_| core::array::from_fn(|_| number()));
            let skew: [[f64; 5]; 5] = core::array::from_fn(|_| core::array::from_fn(|_| number()));
            let matrix: [[f64; 5]; 5] = core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let square: f64 = (0..5).map(|k| root[i][k] * root[j][k]).sum();
                    square + skew[i][j] - skew[j][i] + if i == j { 0.1 } else { 0.0 }
                })
            });
            let q: [f64; 5] = core::array::from_fn(|_| number());
            let [w, z] = solve(matrix, q).expect("a solution");
            for i in 0..5 {
                let sum: f64 = q[i] + (0..5).map(|j| matrix[i][j] * z[j]).sum::<f64>();
                assert!((sum - w[i]).abs() < 1e-9, "{sum} {}", w[i]);
                assert!(-1e-9 < w[i] && -1e-9 < z[i] && (w[i] * z[i]).abs() < 1e-9);
            }
        }
    }
}
