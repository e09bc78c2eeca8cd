//! Small motions about a state: mass, damping and stiffness, and the normal modes.

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
/// Driven inputs stay as they are. A feedback law is linearized along with the system;
/// [`control_jacobian`](Jacobians::control_jacobian) is ∂q̈ by the control inputs. A system with
/// constraints has fewer motions than coordinates, and is refused when it is compiled. Limits have no
/// part in it: it describes the motion away from them.
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
    const { without_constraints::<D::System, N>() };
    in_all_coordinates(dynamics, t, q, v)
}

/// Refuses systems with constraints: their small motions have fewer modes than coordinates.
pub(crate) const fn without_constraints<S: System<N>, const N: usize>() {
    assert!(
        S::FACTS.constraints.is_empty(),
        "the small motions of a system with constraints have fewer modes than it has coordinates: \
         write it in coordinates that fulfil the constraints"
    );
}

/// The linearization in all coordinates, also of a system with constraints.
pub(crate) fn in_all_coordinates<D, const N: usize>(
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
    Linearization { mass, damping, stiffness }
}

impl<const N: usize> Linearization<N> {
    /// The vibrations that M δ̈ + K δ = 0 has, by Cholesky's factors of M and the eigenvalues of a
    /// symmetric matrix.
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
        let symmetric = 0.5 * (&scaled + scaled.transpose());
        let eigen = symmetric.symmetric_eigen();
        let mut order: Vec<usize> = (0..N).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let shapes = factor
            .transpose()
            .solve_upper_triangular(&eigen.eigenvectors)
            .ok_or(ModeError::Mass)?;
        let columns: Vec<DVector<f64>> =
            order.iter().map(|&mode| shapes.column(mode).into_owned()).collect();
        let squared_frequencies = order.iter().map(|&mode| eigen.eigenvalues[mode]).collect();
        Ok(NormalModes { squared_frequencies, shapes: DMatrix::from_columns(&columns) })
    }
}
