//! Small motions on the constraints: the directions that they leave, and independent coordinates.

use crate::motion::Side;
use crate::scalar::Dual;
use crate::system::{Dynamics, Facts, Jacobians, Purpose, System, scalar_time};
use crate::time::Time;
use nalgebra::{DMatrix, SMatrix};

/// Singular values below this part of the largest, and pivots below this part of their row, count
/// as zero.
const RANK: f64 = 1e-11;

/// The gradients C of the constraints, one in a row; no numbers for a constraint whose gradient
/// vanishes, as where all bars of a linkage lie in a line.
///
/// A change of the coordinates by their size, or by one, changes such a constraint by the rounding
/// of its terms.
pub(super) fn gradients<D, const N: usize>(
    dynamics: &D,
    time: Time,
    q: &[f64; N],
    v: &[f64; N],
) -> SMatrix<f64, N, N>
where
    D: Dynamics<N, Scalar = f64>,
{
    let facts: &Facts = &<D::System as System<N>>::FACTS;
    let (system, t) = (dynamics.system(), scalar_time(time));
    let inputs = dynamics.inputs(time, Side::After, Purpose::Momenta);
    let mut gradients = system.constraint_jacobian(t, q, v, &inputs);
    let [scales, _] = system.misfit_scales(t, q, v, &inputs);
    let reach = q.iter().fold(1.0, |most: f64, q| most.max(q.abs()));
    for row in (0..facts.held_constraints()).filter(|&row| facts.constraints[row].holonomic) {
        if reach * gradients.row(row).amax() <= RANK * scales[row] {
            gradients.row_mut(row).fill(f64::NAN);
        }
    }
    gradients
}

/// The directions y that C L⁻ᵀ leaves, orthonormal, a column each: δ = L⁻ᵀ y keeps the constraints,
/// where L is Cholesky's factor of the mass matrix.
pub(super) fn free_directions<const N: usize>(
    gradients: &SMatrix<f64, N, N>,
    factor: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let transposed = DMatrix::from_fn(N, N, |row, column| gradients[(column, row)]);
    let mut scaled = factor.solve_lower_triangular(&transposed)?.transpose();
    // A constraint may have any unit.
    for mut row in scaled.row_iter_mut() {
        let length = row.norm();
        if 0.0 < length {
            row.unscale_mut(length);
        }
    }
    let svd = scaled.svd(false, true);
    let rows = svd.v_t?;
    let largest = svd.singular_values.max();
    let free: Vec<_> = (0..N)
        .filter(|&row| svd.singular_values[row] <= RANK * largest)
        .map(|row| rows.row(row).transpose())
        .collect();
    Some(if free.is_empty() { DMatrix::zeros(N, 0) } else { DMatrix::from_columns(&free) })
}

/// Independent coordinates and velocities of a state, and what all others do with them.
#[derive(Clone, Debug)]
pub(super) struct Reduction {
    /// The independent coordinates and velocities, by their indices.
    pub(super) coordinates: Vec<usize>,
    pub(super) velocities: Vec<usize>,
    /// (δq, δq̇) from the independent ones.
    pub(super) all: DMatrix<f64>,
}

impl Reduction {
    /// δq keeps the constraints of positions, δq̇ those of velocities and the rates of the others:
    /// C δq̇ + ∂(C q̇ + b)/∂q δq = 0.
    ///
    /// The dependent coordinates are the pivots of an elimination that takes the largest in the
    /// metric of the diagonal of the mass matrix. Numbers are not finite where constraints depend
    /// on each other.
    pub(super) fn new<D, const N: usize>(
        dynamics: &D,
        time: Time,
        q: &[f64; N],
        v: &[f64; N],
    ) -> Self
    where
        D: Dynamics<N, Scalar = f64, System: Jacobians<N>>,
    {
        let facts: &Facts = &<D::System as System<N>>::FACTS;
        let (system, t, held) = (dynamics.system(), scalar_time(time), facts.held_constraints());
        if held == 0 {
            let all: Vec<usize> = (0..N).collect();
            let (coordinates, velocities) = (all.clone(), all);
            return Self { coordinates, velocities, all: DMatrix::identity(2 * N, 2 * N) };
        }
        let inputs = dynamics.inputs(time, Side::After, Purpose::Momenta);
        let gradients = gradients(dynamics, time, q, v);
        let masses = system.mass_matrix(t, q, v, &inputs);
        // Constraints of positions first: what they decide, decides the velocities, too.
        let mut rows: Vec<usize> = (0..held).collect();
        rows.sort_by_key(|&row| !facts.constraints[row].holonomic);
        let holonomic = rows.iter().filter(|&&row| facts.constraints[row].holonomic).count();
        let scale: Vec<f64> = (0..N).map(|j| masses[(j, j)].abs().sqrt()).collect();
        let slopes = slopes(dynamics, time, q, v);
        let right = |row: usize, j: usize| slopes[(rows[row], j)];
        let gradient = |row: usize, j: usize| gradients[(rows[row], j)];
        let (pivots, independent) = pivots(held, &scale, gradient);
        let free =
            |decided: &[usize]| -> Vec<usize> { (0..N).filter(|j| !decided.contains(j)).collect() };
        let (coordinates, velocities) = (free(&pivots[..holonomic]), free(&pivots));
        let positions = dependent(&pivots[..holonomic], &coordinates, N, gradient);
        let rates = dependent(&pivots, &velocities, N, gradient);
        // The dependent velocities that changes of the coordinates add.
        let by_q = DMatrix::from_fn(held, N, right) * &positions;
        let by_q = solved(&pivots, gradient, &by_q);
        let (first, second) = (coordinates.len(), velocities.len());
        let mut all = DMatrix::zeros(2 * N, first + second);
        all.view_mut((0, 0), (N, first)).copy_from(&positions);
        all.view_mut((N, first), (N, second)).copy_from(&rates);
        for (row, &place) in pivots.iter().enumerate() {
            all.view_mut((N + place, 0), (1, first)).copy_from(&-by_q.row(row));
        }
        if !independent {
            all.fill(f64::NAN);
        }
        Self { coordinates, velocities, all }
    }

    /// The rows of a matrix, 2n high, that belong to the independent coordinates and velocities.
    pub(super) fn rows(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let half = matrix.nrows() / 2;
        let own = self.coordinates.iter().copied();
        let own: Vec<usize> = own.chain(self.velocities.iter().map(|&row| half + row)).collect();
        matrix.select_rows(&own)
    }
}

/// ∂(C q̇ + b)/∂q, row by constraint.
fn slopes<D, const N: usize>(
    dynamics: &D,
    time: Time,
    q: &[f64; N],
    v: &[f64; N],
) -> SMatrix<f64, N, N>
where
    D: Dynamics<N, Scalar = f64, System: Jacobians<N>>,
{
    type Number = Dual<f64>;
    let system = dynamics.system().over(Number::constant);
    let inputs = dynamics.inputs(time, Side::After, Purpose::Momenta);
    let inputs = <D::System as Jacobians<N>>::inputs_over(&inputs, Number::constant);
    let t = Number::constant(scalar_time(time));
    let mut slopes = SMatrix::zeros();
    for j in 0..N {
        let (mut q, v) = (q.map(Number::constant), v.map(Number::constant));
        q[j].derivative = 1.0;
        let [_, rates] = system.misfits(t, &q, &v, &inputs);
        for row in 0..N {
            slopes[(row, j)] = rates[row].derivative;
        }
    }
    slopes
}

/// The column of the pivot of each row, where columns are measured by `scale`, and false if a row
/// depends on those before it.
fn pivots(rows: usize, scale: &[f64], entry: impl Fn(usize, usize) -> f64) -> (Vec<usize>, bool) {
    let columns = scale.len();
    let mut rest = DMatrix::from_fn(rows, columns, |row, j| entry(row, j) / scale[j]);
    let lengths: Vec<f64> = (0..rows).map(|row| rest.row(row).norm()).collect();
    let (mut pivots, mut independent) = (Vec::with_capacity(rows), true);
    for row in 0..rows {
        let size = |j: &usize| if pivots.contains(j) { -1.0 } else { rest[(row, *j)].abs() };
        let best = (0..columns).fold(0, |best, j| if size(&best) < size(&j) { j } else { best });
        independent &= RANK * lengths[row] < rest[(row, best)].abs();
        for below in row + 1..rows {
            let factor = rest[(below, best)] / rest[(row, best)];
            for j in 0..columns {
                let part = factor * rest[(row, j)];
                rest[(below, j)] -= part;
            }
        }
        pivots.push(best);
    }
    (pivots, independent)
}

/// C_d⁻¹ of a right side, for the columns d of the pivots.
fn solved(
    pivots: &[usize],
    entry: impl Fn(usize, usize) -> f64,
    right: &DMatrix<f64>,
) -> DMatrix<f64> {
    let count = pivots.len();
    if count == 0 {
        return right.clone();
    }
    let matrix = DMatrix::from_fn(count, count, |row, column| entry(row, pivots[column]));
    let lost = || DMatrix::from_element(count, right.ncols(), f64::NAN);
    matrix.lu().solve(right).unwrap_or_else(lost)
}

/// All coordinates from the independent ones.
fn dependent(
    pivots: &[usize],
    independent: &[usize],
    count: usize,
    entry: impl Fn(usize, usize) -> f64,
) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(count, independent.len());
    for (column, &place) in independent.iter().enumerate() {
        all[(place, column)] = 1.0;
    }
    let right = DMatrix::from_fn(pivots.len(), independent.len(), |row, column| {
        entry(row, independent[column])
    });
    let values = solved(pivots, entry, &right);
    for (row, &place) in pivots.iter().enumerate() {
        all.view_mut((place, 0), (1, independent.len())).copy_from(&-values.row(row));
    }
    all
}
