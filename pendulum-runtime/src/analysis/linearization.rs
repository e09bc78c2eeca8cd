//! Small motions about a state: mass, damping and stiffness, and the normal modes.

use crate::analysis::reduction::{free_directions, gradients};
use crate::motion::Side;
use crate::system::{Dynamics, Jacobians, Purpose, System, feedback_jacobians, scalar_time};
use crate::time::Time;
use core::fmt;
use nalgebra::{DMatrix, DVector, SMatrix};

/// Small motions δ about a state at rest: M δ̈ + C δ̇ + K δ = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Linearization<const N: usize> {
    /// The mass matrix M.
    pub mass: SMatrix<f64, N, N>,
    /// The damping matrix C = −M ∂q̈/∂q̇.
    pub damping: SMatrix<f64, N, N>,
    /// The stiffness matrix K = −M ∂q̈/∂q.
    pub stiffness: SMatrix<f64, N, N>,
    /// The gradients of the constraints that the equations hold, one in a row; the rest is zero. A
    /// small motion δ keeps them: its product with each is zero. One that vanishes has no numbers.
    pub constraints: SMatrix<f64, N, N>,
}

/// The undamped vibrations about an equilibrium.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NormalModes {
    /// The squares ω² of the angular frequencies in (rad/s)², ascending; negative for a direction
    /// in which the state is unstable.
    pub squared_frequencies: Vec<f64>,
    /// Their shapes, a column each: coordinates with δᵀ M δ = 1.
    pub shapes: DMatrix<f64>,
}

/// Reason for which there are no normal modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ModeError {
    /// The mass matrix is not positive definite at the state.
    Mass,
    /// A mass, damping or stiffness is infinite or no number.
    NotFinite,
    /// The algorithm for the eigenvalues did not end.
    NoConvergence,
}

impl fmt::Display for ModeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mass => {
                "the mass matrix is not positive definite; linearize about a state at which every direction has inertia"
            }
            Self::NotFinite => "the linearization is not finite; check parameters and state",
            Self::NoConvergence => {
                "the eigenvalues did not converge; choose units in which masses, dampings and stiffnesses differ less"
            }
        })
    }
}

impl core::error::Error for ModeError {}

/// Linearizes the equations of motion about the state `q`, `v` at time `t`.
///
/// M is the mass matrix, C = −M ∂q̈/∂q̇ and K = −M ∂q̈/∂q. At an equilibrium (v = 0 and no
/// acceleration) they describe small motions.
///
/// Driven inputs stay as they are, and so do the values of a [sampled](crate::system::Sampled)
/// controller, which are those of its last run. A feedback law is linearized along with the system;
/// [`control_jacobian`](Jacobians::control_jacobian) is ∂q̈ by the control inputs. Limits have no
/// part in it: it describes the motion away from them.
///
/// With constraints δ lies in the plane that they leave, and there are as many modes as it has
/// dimensions. For a state that moves [`state_space`](crate::analysis::state_space) has the model
/// in independent coordinates.
///
/// ```
/// use pendulum_runtime::prelude::*;
/// use pendulum_runtime::analysis::{equilibrium, linearize};
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Bob { m: kg, L: m, g: m/s^2 = 9.81 }
///     coordinate x: m;
///     coordinate y: m;
///     kinetic = m/2*(ẋ^2 + ẏ^2);
///     potential = m*g*y;
///     constraint rod: |[x, y]| = L;
/// }
/// # }
/// # use system::Bob;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let bob = Bob::new(0.3, 2.0);
/// let q = equilibrium(&bob, 0.0, [0.1, -1.9])?;
/// let modes = linearize(&bob, 0.0, &q, &[0.0; 2]).normal_modes()?;
/// // One mode, ω² = g/L.
/// assert_eq!(modes.squared_frequencies.len(), 1);
/// assert!((modes.squared_frequencies[0] - 9.81 / 2.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
pub fn linearize<D, const N: usize>(
    dynamics: &D,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Linearization<N>
where
    D: Dynamics<N, Scalar = f64>,
    D::System: Jacobians<N>,
{
    let time = Time::new(t);
    let t = scalar_time(time);
    let system = dynamics.system();
    let inputs = dynamics.inputs_with(time, Side::After, Purpose::Accelerations, q, v);
    let momenta = dynamics.inputs(time, Side::After, Purpose::Momenta);
    let mass = system.mass_matrix(t, q, v, &momenta);
    let mut by_q = system.position_jacobian(t, q, v, &inputs);
    let mut by_v = system.velocity_jacobian(t, q, v, &inputs);
    if D::FEEDBACK {
        let [law_by_q, law_by_v] = feedback_jacobians(dynamics, time, q, v, &inputs);
        by_q += law_by_q;
        by_v += law_by_v;
    }
    let (damping, stiffness) = (-mass * by_v, -mass * by_q);
    let constraints = gradients(dynamics, time, q, v);
    Linearization { mass, damping, stiffness, constraints }
}

impl<const N: usize> Linearization<N> {
    /// The vibrations that M δ̈ + K δ = 0 has on the constraints, by Cholesky's factors of M and
    /// the eigenvalues of a symmetric matrix.
    ///
    /// # Errors
    /// A mass matrix that is not positive definite, numbers that are not finite.
    pub fn normal_modes(&self) -> Result<NormalModes, ModeError> {
        let mass = DMatrix::from_fn(N, N, |row, column| self.mass[(row, column)]);
        let stiffness = DMatrix::from_fn(N, N, |row, column| {
            0.5 * (self.stiffness[(row, column)] + self.stiffness[(column, row)])
        });
        if mass.iter().chain(stiffness.iter()).any(|entry| !entry.is_finite()) {
            return Err(ModeError::NotFinite);
        }
        let factor = mass.cholesky().ok_or(ModeError::Mass)?.l();
        // L⁻¹ K L⁻ᵀ has the eigenvalues ω² and the eigenvectors Lᵀ δ.
        let half = factor.solve_lower_triangular(&stiffness).ok_or(ModeError::Mass)?;
        let scaled = factor.solve_lower_triangular(&half.transpose()).ok_or(ModeError::Mass)?;
        let mut symmetric = 0.5 * (&scaled + scaled.transpose());
        let free = self.free_directions(&factor)?;
        if let Some(free) = &free {
            let own = free.transpose() * symmetric * free;
            symmetric = 0.5 * (&own + own.transpose());
        }
        let count = symmetric.nrows();
        if count == 0 {
            let (squared_frequencies, shapes) = (Vec::new(), DMatrix::zeros(N, 0));
            return Ok(NormalModes { squared_frequencies, shapes });
        }
        let eigen = symmetric.symmetric_eigen();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let vectors = match free {
            Some(free) => free * eigen.eigenvectors,
            None => eigen.eigenvectors,
        };
        let shapes = factor.transpose().solve_upper_triangular(&vectors).ok_or(ModeError::Mass)?;
        let columns: Vec<DVector<f64>> =
            order.iter().map(|&mode| shapes.column(mode).into_owned()).collect();
        let squared_frequencies = order.iter().map(|&mode| eigen.eigenvalues[mode]).collect();
        Ok(NormalModes { squared_frequencies, shapes: DMatrix::from_columns(&columns) })
    }

    /// The directions that the constraints leave, in coordinates scaled by the factor of the mass
    /// matrix; `None` without constraints.
    pub(super) fn free_directions(
        &self,
        factor: &DMatrix<f64>,
    ) -> Result<Option<DMatrix<f64>>, ModeError> {
        if self.constraints.iter().any(|entry| !entry.is_finite()) {
            return Err(ModeError::NotFinite);
        }
        if self.constraints.iter().all(|&entry| entry == 0.0) {
            return Ok(None);
        }
        free_directions(&self.constraints, factor).map(Some).ok_or(ModeError::Mass)
    }
}
