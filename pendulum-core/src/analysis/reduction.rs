//! Small motions on constraints: tangent directions and independent coordinates.

use crate::integrate::field::phase::{Phase, has_states};
use crate::scalar::Dual;
use crate::system::{At, Dynamics, Facts, Jacobians, Purpose, Samples, System};
use nalgebra::{DMatrix, SMatrix};

/// Singular values below this fraction of the largest, and pivots below this fraction of their row,
/// count as zero.
const RANK: f64 = 1e-11;

/// Returns the gradients C of the constraints, one per row. A row is NaN if the gradient of its
/// constraint vanishes, as when all bars of a linkage lie in a line.
///
/// A gradient counts as zero if a change of the coordinates by max(1, |q|) changes the constraint
/// by no more than the rounding error of its terms.
pub(super) fn gradients<D, const N: usize>(phase: &Phase<'_, D, N>) -> SMatrix<f64, N, N>
where
    D: Dynamics<N, Scalar = f64>,
{
    let facts: &Facts = &<D::System as System<N>>::FACTS;
    let (system, inputs) = (phase.dynamics.system(), phase.momentum_inputs());
    let at = phase.at(&inputs);
    let mut gradients = system.constraint_jacobian(at);
    let [scales, _] = system.misfit_scales(at);
    let reach = phase.q.iter().fold(1.0, |most: f64, q| most.max(q.abs()));
    for row in (0..facts.held_constraints()).filter(|&row| facts.constraints[row].holonomic) {
        if reach * gradients.row(row).amax() <= RANK * scales[row] {
            gradients.row_mut(row).fill(f64::NAN);
        }
    }
    gradients
}

/// Returns an orthonormal basis of the kernel of C L⁻ᵀ, one vector y per column, where L is the
/// Cholesky factor of the mass matrix: δ = L⁻ᵀ y fulfils the constraints.
pub(super) fn free_directions<const N: usize>(
    gradients: &SMatrix<f64, N, N>,
    factor: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let count = factor.nrows();
    let transposed = DMatrix::from_fn(count, N, |row, column| gradients[(column, row)]);
    let mut scaled = factor.solve_lower_triangular(&transposed)?.transpose();
    // The rows are scaled, because constraints can have any unit.
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

/// The independent coordinates and velocities of a state, and the dependence of all others on them.
#[derive(Clone, Debug)]
pub(super) struct Reduction {
    /// The indices of the independent coordinates and, in `velocities`, of the independent
    /// velocities.
    pub(super) coordinates: Vec<usize>,
    pub(super) velocities: Vec<usize>,
    /// The matrix that maps independent changes to (δq, δq̇).
    pub(super) all: DMatrix<f64>,
}

impl Reduction {
    /// Computes the reduction of small changes of a state.
    pub(super) fn new<D, const N: usize>(phase: &Phase<'_, D, N>) -> Self
    where
        D: Dynamics<N, Scalar = f64, System: Jacobians<N>>,
    {
        let facts: &Facts = &<D::System as System<N>>::FACTS;
        if facts.held_constraints() == 0 {
            let all: Vec<usize> = (0..N).collect();
            let (coordinates, velocities) = (all.clone(), all);
            let own = Self { coordinates, velocities, all: DMatrix::identity(2 * N, 2 * N) };
            return own.without_rates(&rates(phase), facts.states);
        }
        let masses = phase.dynamics.system().mass_matrix(phase.at(&phase.momentum_inputs()));
        let own = Self::on(facts, &masses, &gradients(phase), &slopes(phase));
        own.without_rates(&rates(phase), facts.states)
    }

    /// Returns the reduction without the velocities of the last `states` coordinates, whose changes
    /// are `rates` times those of coordinates and velocities.
    pub(super) fn without_rates<const N: usize>(
        mut self,
        rates: &[SMatrix<f64, N, N>; 2],
        states: usize,
    ) -> Self {
        // A state is in no row of a constraint, so that all rates are independent velocities.
        let kept = self.all.ncols() - states;
        self.velocities.truncate(self.velocities.len() - states);
        self.all = self.all.columns(0, kept).into_owned();
        for row in N - states..N {
            let change = |k: usize| rates[k / N][(row, k % N)];
            let change = DMatrix::from_fn(1, 2 * N, |_, k| change(k)) * &self.all;
            self.all.row_mut(N + row).copy_from(&change.row(0));
        }
        self
    }

    /// Computes the reduction from the mass matrix, the gradients C of the constraints and the
    /// [`slopes`]: δq fulfils the constraints of positions, and δq̇ fulfils C δq̇ + ∂(C q̇ + b)/∂q δq
    /// = 0 for all constraints.
    ///
    /// The dependent coordinates are the pivots of an elimination. Each pivot is the largest entry
    /// of its row in the metric of the diagonal of the mass matrix. The matrix is NaN if
    /// constraints depend on each other.
    pub(super) fn on<const N: usize>(
        facts: &Facts,
        masses: &SMatrix<f64, N, N>,
        gradients: &SMatrix<f64, N, N>,
        slopes: &SMatrix<f64, N, N>,
    ) -> Self {
        let held = facts.held_constraints();
        // Constraints of positions come first, because their dependent coordinates are also
        // dependent velocities.
        let mut rows: Vec<usize> = (0..held).collect();
        rows.sort_by_key(|&row| !facts.constraints[row].holonomic);
        let holonomic = rows.iter().filter(|&&row| facts.constraints[row].holonomic).count();
        let scale: Vec<f64> = (0..N).map(|j| masses[(j, j)].abs().sqrt()).collect();
        let right = |row: usize, j: usize| slopes[(rows[row], j)];
        let gradient = |row: usize, j: usize| gradients[(rows[row], j)];
        let (pivots, independent) = pivots(held, &scale, gradient);
        let free =
            |decided: &[usize]| -> Vec<usize> { (0..N).filter(|j| !decided.contains(j)).collect() };
        let (coordinates, velocities) = (free(&pivots[..holonomic]), free(&pivots));
        let positions = dependent(&pivots[..holonomic], &coordinates, N, gradient);
        let rates = dependent(&pivots, &velocities, N, gradient);
        // The part of the dependent velocities that depends on changes of the coordinates.
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

    /// Returns the rows of a matrix with 2n rows that belong to the independent coordinates and
    /// velocities.
    pub(super) fn rows(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let half = matrix.nrows() / 2;
        let own = self.coordinates.iter().copied();
        let own: Vec<usize> = own.chain(self.velocities.iter().map(|&row| half + row)).collect();
        matrix.select_rows(&own)
    }
}

/// Returns the derivatives of the rates of states by coordinates and by velocities; all other rows
/// are zero.
///
/// Does not compile if other constraints hold than those of rotations. The tangent space of a
/// constraint that contains a state would depend on the state.
pub(super) fn rates<D, const N: usize>(phase: &Phase<'_, D, N>) -> [SMatrix<f64, N, N>; 2]
where
    D: Dynamics<N, Scalar = f64, System: Jacobians<N>>,
{
    type Number = Dual<f64>;
    let mut rates = [SMatrix::zeros(); 2];
    if !const { has_linear_states::<D, N>() } {
        return rates;
    }
    let system = phase.dynamics.system().over(Number::constant);
    let inputs = phase.inputs(Purpose::Accelerations);
    let At { t, q, v, .. } = phase.at(&inputs);
    let inputs = inputs.map(Number::constant);
    let t = Number::constant(t);
    for k in 0..2 * N {
        let (mut q, mut v) = (q.map(Number::constant), v.map(Number::constant));
        if k < N {
            q[k].derivative = 1.0;
        } else {
            v[k - N].derivative = 1.0;
        }
        let [own, _] = system.state_rates(At { t, q: &q, v: &v, inputs: &inputs }, &v);
        for row in N - <D::System as System<N>>::FACTS.states..N {
            rates[k / N][(row, k % N)] = own[row].derivative;
        }
    }
    rates
}

/// Returns `true` if the dynamics `D` have states, in a system with a linear model.
pub(super) const fn has_linear_states<D: Dynamics<N>, const N: usize>() -> bool {
    let facts = &<D::System as System<N>>::FACTS;
    assert!(
        facts.only_rotations() || facts.states == 0,
        "the linear model of a `state` beside constraints is not written yet: use coordinates that fulfil them"
    );
    has_states::<D, N>()
}

/// Returns ∂(C q̇ + b)/∂q, one row per constraint.
pub(super) fn slopes<D, const N: usize>(phase: &Phase<'_, D, N>) -> SMatrix<f64, N, N>
where
    D: Dynamics<N, Scalar = f64, System: Jacobians<N>>,
{
    type Number = Dual<f64>;
    let system = phase.dynamics.system().over(Number::constant);
    let inputs = phase.momentum_inputs();
    let At { t, q, v, .. } = phase.at(&inputs);
    let inputs = inputs.map(Number::constant);
    let t = Number::constant(t);
    let mut slopes = SMatrix::zeros();
    for j in 0..N {
        let (mut q, v) = (q.map(Number::constant), v.map(Number::constant));
        q[j].derivative = 1.0;
        let [_, rates] = system.misfits(At { t, q: &q, v: &v, inputs: &inputs });
        for row in 0..N {
            slopes[(row, j)] = rates[row].derivative;
        }
    }
    slopes
}

/// Returns the column of the pivot of each row, with columns measured by `scale`, and `false` if a
/// row depends on previous rows.
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

/// Returns the product of C_d⁻¹ and `right`, where C_d consists of the columns of the pivots.
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

/// Returns the matrix that maps independent coordinates to all coordinates.
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
