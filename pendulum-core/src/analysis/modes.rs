//! Damped modes: eigenvalues and shapes of small motions.

use crate::analysis::linearization::{Linearization, ModeError};
use crate::analysis::reduction::Reduction;
use core::fmt;
use nalgebra::linalg::{SVD, Schur, balancing};
use nalgebra::{Complex, DMatrix, DVector, SVector};

/// A damped mode: a solution δ = Re(c φ exp(λ t)) of M δ̈ + C δ̇ + K δ = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DampedMode<const N: usize> {
    /// The eigenvalue λ in 1/s; for a conjugate pair, the eigenvalue with positive imaginary part.
    pub eigenvalue: Complex<f64>,
    /// The shape φ with φᴴ M φ = 1, whose largest component is real and positive.
    pub shape: SVector<Complex<f64>, N>,
}

impl<const N: usize> DampedMode<N> {
    /// Returns the natural angular frequency |λ| in rad/s.
    pub fn frequency(&self) -> f64 {
        let Complex { re, im } = self.eigenvalue;
        let scale = re.abs().max(im.abs());
        if scale == 0.0 {
            return 0.0;
        }
        scale * ((re / scale) * (re / scale) + (im / scale) * (im / scale)).sqrt()
    }

    /// Returns the angular frequency Im λ of the damped vibration in rad/s; zero without a
    /// vibration.
    pub fn damped_frequency(&self) -> f64 {
        self.eigenvalue.im
    }

    /// Returns the damping ratio ζ = −Re λ/|λ|: 1 or −1 without a vibration, negative if the motion
    /// grows, zero for λ = 0.
    pub fn damping_ratio(&self) -> f64 {
        let frequency = self.frequency();
        if frequency == 0.0 { 0.0 } else { -self.eigenvalue.re / frequency }
    }

    /// Returns `true` if the motion grows.
    pub fn is_unstable(&self) -> bool {
        0.0 < self.eigenvalue.re
    }
}

/// Writes the frequency, the damping ratio and the eigenvalue.
impl<const N: usize> fmt::Display for DampedMode<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(4);
        let Complex { re, im } = self.eigenvalue;
        write!(
            f,
            "{:.digits$} rad/s, damping ratio {:.digits$}, λ = {re:.digits$}",
            self.frequency(),
            self.damping_ratio()
        )?;
        if im == 0.0 { Ok(()) } else { write!(f, " ± {im:.digits$}i") }
    }
}

/// The maximum number of sweeps of the QR algorithm per eigenvalue.
const SWEEPS: usize = 300;

/// The relative distance up to which eigenvalues share their space of shapes.
const SAME: f64 = 1e-6;

impl<const N: usize> Linearization<N> {
    /// Computes the modes of M δ̈ + C δ̇ + K δ = 0 on the constraints, in the order of their
    /// frequencies |λ|: a mode for each conjugate pair of eigenvalues and for each real eigenvalue.
    ///
    /// The λ are the eigenvalues of the first-order form
    ///
    /// ```text
    /// d/dt (δ, δ̇) = [0 I; −M⁻¹K −M⁻¹C] (δ, δ̇)
    /// ```
    ///
    /// with coordinates scaled by the Cholesky factor of M, after balancing, by the QR algorithm.
    /// About a state that moves on constraints, the form has the independent coordinates and
    /// velocities of [`state_space`](crate::analysis::state_space). Constraints of velocities leave
    /// more coordinates than velocities; a displacement that stays has λ = 0.
    ///
    /// A shape φ spans the kernel of λ²M + λC + K, by singular values. Eigenvalues that coincide, as
    /// at critical damping, are accurate to half of their digits, and their shapes may coincide as
    /// well.
    ///
    /// Source: Tisseur and Meerbergen (2001), The Quadratic Eigenvalue Problem, SIAM Review 43,
    /// sections 1.1 and 3.4.
    ///
    /// ```
    /// use pendulum_runtime::prelude::*;
    /// use pendulum_runtime::analysis::linearize;
    ///
    /// # mod system {
    /// pendulum_runtime::lagrangian! {
    ///     pub struct Damped { m: kg, c: N*s/m, k: N/m }
    ///     coordinate x: m;
    ///     kinetic = m/2*ẋ^2;
    ///     potential = k/2*x^2;
    ///     dissipation = c/2*ẋ^2;
    /// }
    /// # }
    /// # use system::Damped;
    /// let modes = linearize(&Damped::new(1.0, 0.4, 4.0), 0.0, &[0.0], &[0.0]).damped_modes()?;
    /// // ω = √(k/m), ζ = c/(2 m ω).
    /// assert!((modes[0].frequency() - 2.0).abs() < 1e-14);
    /// assert!((modes[0].damping_ratio() - 0.1).abs() < 1e-14);
    /// # Ok::<(), pendulum_runtime::analysis::ModeError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the mass matrix is not positive definite, if a value is not finite, or
    /// if an algorithm does not converge.
    pub fn damped_modes(&self) -> Result<Vec<DampedMode<N>>, ModeError> {
        let [mass, damping, stiffness] = [&self.mass, &self.damping, &self.stiffness]
            .map(|matrix| DMatrix::from_fn(N, N, |row, column| matrix[(row, column)]));
        if [&mass, &damping, &stiffness].iter().any(|m| m.iter().any(|entry| !entry.is_finite())) {
            return Err(ModeError::NotFinite);
        }
        let factor = mass.cholesky().ok_or(ModeError::Mass)?.l();
        // L⁻¹ X L⁻ᵀ.
        let scaled = |matrix: &DMatrix<f64>| {
            let half = factor.solve_lower_triangular(matrix)?;
            Some(factor.solve_lower_triangular(&half.transpose())?.transpose())
        };
        if let Some(reduction) = self.reduction() {
            let solved = |matrix: &DMatrix<f64>| {
                let half = factor.solve_lower_triangular(matrix)?;
                factor.transpose().solve_upper_triangular(&half)
            };
            let by_q = solved(&stiffness).ok_or(ModeError::Mass)?;
            let by_v = solved(&damping).ok_or(ModeError::Mass)?;
            return turning(&reduction, &factor, &first_order(&by_v, &by_q));
        }
        let mut damping = scaled(&damping).ok_or(ModeError::Mass)?;
        let mut stiffness = scaled(&stiffness).ok_or(ModeError::Mass)?;
        let free = self.free_directions(&factor)?;
        if let Some(free) = &free {
            damping = free.transpose() * damping * free;
            stiffness = free.transpose() * stiffness * free;
        }
        let (first_order, _) = balanced(first_order(&damping, &stiffness));
        let eigenvalues = eigenvalues(first_order)?;
        let mut modes = Vec::with_capacity(eigenvalues.len());
        for (index, &eigenvalue) in eigenvalues.iter().enumerate() {
            let before = alike(&eigenvalues[..index], eigenvalue);
            let (pencil, size) = pencil(&damping, &stiffness, eigenvalue);
            let scaled = kernel(&pencil, size, before).ok_or(ModeError::NoConvergence)?;
            let scaled = match &free {
                None => scaled,
                Some(free) => combined(free, &scaled),
            };
            modes.push(DampedMode { eigenvalue, shape: unscaled(&factor, &scaled) });
        }
        Ok(modes)
    }
}

/// Computes the modes on constraints whose tangent space turns; `first_order` is the matrix for
/// independent coordinates.
fn turning<const N: usize>(
    reduction: &Reduction,
    factor: &DMatrix<f64>,
    first_order: &DMatrix<f64>,
) -> Result<Vec<DampedMode<N>>, ModeError> {
    let matrix = reduction.rows(&(first_order * &reduction.all));
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return Err(ModeError::NotFinite);
    }
    let (matrix, scales) = balanced(matrix);
    let eigenvalues = eigenvalues(matrix.clone())?;
    let coordinates = reduction.all.rows(0, N).into_owned();
    let mut modes = Vec::with_capacity(eigenvalues.len());
    for (index, &eigenvalue) in eigenvalues.iter().enumerate() {
        let pencil = DMatrix::from_fn(matrix.nrows(), matrix.nrows(), |row, column| {
            let own = if row == column { eigenvalue } else { Complex::new(0.0, 0.0) };
            own - matrix[(row, column)]
        });
        let terms = eigenvalue.re.abs() + eigenvalue.im.abs() + matrix.amax();
        let before = alike(&eigenvalues[..index], eigenvalue);
        let mut small = kernel(&pencil, terms, before).ok_or(ModeError::NoConvergence)?;
        for (small, &scale) in small.iter_mut().zip(&scales) {
            *small *= scale;
        }
        let shape = combined(&coordinates, &small);
        // Lᵀ φ, so that φᴴ M φ = 1.
        let scaled = combined(&factor.transpose(), &shape);
        let norm = scaled.iter().map(size).sum::<f64>().sqrt();
        let scaled: Vec<_> = scaled.iter().map(|z| z / norm).collect();
        modes.push(DampedMode { eigenvalue, shape: unscaled(factor, &scaled) });
    }
    Ok(modes)
}

/// Returns [0 I; −K −C].
fn first_order(damping: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> DMatrix<f64> {
    let n = damping.nrows();
    let mut first_order = DMatrix::zeros(2 * n, 2 * n);
    first_order.view_mut((0, n), (n, n)).fill_with_identity();
    first_order.view_mut((n, 0), (n, n)).copy_from(&-stiffness);
    first_order.view_mut((n, n), (n, n)).copy_from(&-damping);
    first_order
}

/// Returns a balanced matrix, and the factors of its coordinates.
fn balanced(mut matrix: DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    if matrix.is_empty() {
        return (matrix, DVector::zeros(0));
    }
    let scales = balancing::balance_parlett_reinsch(&mut matrix);
    (matrix, scales)
}

/// Computes the eigenvalues that are real or have a positive imaginary part, in the order of their
/// sizes.
fn eigenvalues(matrix: DMatrix<f64>) -> Result<Vec<Complex<f64>>, ModeError> {
    let n = matrix.nrows();
    if n == 0 {
        return Ok(Vec::new());
    }
    let schur = Schur::try_new(matrix, f64::EPSILON, SWEEPS * n).ok_or(ModeError::NoConvergence)?;
    let all = schur.complex_eigenvalues();
    let mut all: Vec<_> = all.iter().copied().filter(|value| 0.0 <= value.im).collect();
    all.sort_by(|a, b| {
        size(a).total_cmp(&size(b)).then(b.im.total_cmp(&a.im)).then(b.re.total_cmp(&a.re))
    });
    Ok(all)
}

/// Returns |z|².
fn size(z: &Complex<f64>) -> f64 {
    z.re * z.re + z.im * z.im
}

/// Counts the eigenvalues that share their space of shapes with another.
fn alike(eigenvalues: &[Complex<f64>], eigenvalue: Complex<f64>) -> usize {
    let near =
        |other: &&Complex<f64>| size(&(*other - eigenvalue)) <= SAME * SAME * size(&eigenvalue);
    eigenvalues.iter().filter(near).count()
}

/// Returns λ² + λC + K, and the size of its terms.
fn pencil(
    damping: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    eigenvalue: Complex<f64>,
) -> (DMatrix<Complex<f64>>, f64) {
    let n = damping.nrows();
    let square = eigenvalue * eigenvalue;
    let pencil = DMatrix::from_fn(n, n, |row, column| {
        let own = if row == column { square } else { Complex::new(0.0, 0.0) };
        own + eigenvalue * damping[(row, column)] + stiffness[(row, column)]
    });
    let size = square.re.abs()
        + square.im.abs()
        + (eigenvalue.re.abs() + eigenvalue.im.abs()) * damping.amax()
        + stiffness.amax();
    (pencil, size)
}

/// Computes the vector x of norm 1 that minimizes |P x| for a matrix P whose terms have this size.
/// For repeated eigenvalues, `before` vectors orthogonal to x have been taken already.
fn kernel(pencil: &DMatrix<Complex<f64>>, size: f64, before: usize) -> Option<Vec<Complex<f64>>> {
    let n = pencil.nrows();
    if size == 0.0 {
        // Every vector is in the kernel.
        let unit = |row| Complex::new(if row == before % n { 1.0 } else { 0.0 }, 0.0);
        return Some((0..n).map(unit).collect());
    }
    let pencil = pencil.unscale(size);
    let svd = SVD::try_new(pencil, false, true, f64::EPSILON, SWEEPS * n)?;
    let rows = svd.v_t.as_ref()?;
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| svd.singular_values[a].total_cmp(&svd.singular_values[b]));
    // A defective eigenvalue has fewer shapes than its multiplicity.
    let shapes = order.iter().filter(|&&row| svd.singular_values[row] <= SAME).count().max(1);
    let row = order[before % shapes];
    Some((0..n).map(|column| rows[(row, column)].conj()).collect())
}

/// Returns the linear combination of the columns of a matrix.
fn combined(columns: &DMatrix<f64>, factors: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let zero = Complex::new(0.0, 0.0);
    let entry = |row: usize| {
        factors.iter().enumerate().fold(zero, |sum, (k, factor)| sum + factor * columns[(row, k)])
    };
    (0..columns.nrows()).map(entry).collect()
}

/// Returns L⁻ᵀ φ, scaled so that its largest component is real and positive.
fn unscaled<const N: usize>(
    factor: &DMatrix<f64>,
    scaled: &[Complex<f64>],
) -> SVector<Complex<f64>, N> {
    let mut shape = SVector::<Complex<f64>, N>::zeros();
    for i in (0..N).rev() {
        let sum = (i + 1..N).fold(scaled[i], |sum, k| sum - shape[k] * factor[(k, i)]);
        shape[i] = sum / factor[(i, i)];
    }
    // The first component among those whose sizes are equal up to rounding.
    let largest = shape.iter().map(size).fold(0.0, f64::max);
    let first = shape.iter().find(|component| 0.999_999 * largest <= size(component));
    let Some(&first) = first.filter(|_| 0.0 < largest) else { return shape };
    let turn = first.conj() / size(&first).sqrt();
    shape.map(|component| component * turn)
}
