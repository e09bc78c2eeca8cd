//! Linearization about a state: mass, damping and stiffness matrices, and normal modes.

use crate::analysis::reduction::{Reduction, free_directions, gradients, rates, slopes};
use crate::integrate::field::phase::Phase;
use crate::motion::Side;
use crate::system::{Dynamics, Facts, Jacobians, Purpose, System, feedback_jacobians};
use crate::time::Time;
use core::fmt;
use nalgebra::{DMatrix, DVector, SMatrix};

/// The equations of small motions δ about a state at rest: M δ̈ + C δ̇ + K δ = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Linearization<const N: usize> {
    /// The mass matrix M.
    pub mass: SMatrix<f64, N, N>,
    /// The damping matrix C = −M ∂q̈/∂q̇.
    pub damping: SMatrix<f64, N, N>,
    /// The stiffness matrix K = −M ∂q̈/∂q.
    pub stiffness: SMatrix<f64, N, N>,
    /// The gradients of the constraints, one per row; all other rows are zero. The product of each
    /// gradient with a small motion δ is zero. A gradient that vanishes is stored as NaN.
    pub constraints: SMatrix<f64, N, N>,
    /// ∂(C q̇ + b)/∂q: the rates at which small motions turn the gradients.
    slopes: SMatrix<f64, N, N>,
    /// The derivatives of the rates of states by coordinates and by velocities.
    rates: [SMatrix<f64, N, N>; 2],
    facts: &'static Facts,
}

/// The normal modes: undamped vibrations about an equilibrium.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NormalModes {
    /// The squares ω² of the angular frequencies in (rad/s)², ascending; negative in unstable
    /// directions.
    pub squared_frequencies: Vec<f64>,
    /// The shapes of the modes, one per column: coordinates δ with δᵀ M δ = 1.
    pub shapes: DMatrix<f64>,
}

/// An error of the computation of modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ModeError {
    /// The mass matrix is not positive definite at the state.
    Mass,
    /// A mass, damping or stiffness is infinite or NaN.
    NotFinite,
    /// The algorithm for the eigenvalues did not converge.
    NoConvergence,
    /// Forces across the velocities, as those of Coriolis in a turning frame, couple the vibrations.
    Gyroscopic,
    /// The forces have no potential, as those that follow a body or come from a controller, or the
    /// state is no equilibrium: the stiffness is not symmetric.
    Circulatory,
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
            Self::Gyroscopic => {
                "forces across the velocities, as in a turning frame, couple the vibrations; `damped_modes` has their frequencies"
            }
            Self::Circulatory => {
                "the stiffness is not symmetric: the state is no equilibrium, or forces have no potential; for those, use `damped_modes`"
            }
        })
    }
}

impl core::error::Error for ModeError {}

/// Linearizes the equations of motion about the state `q`, `v` at time `t`.
///
/// M is the mass matrix, C = −M ∂q̈/∂q̇ and K = −M ∂q̈/∂q. At an equilibrium (v = 0 and q̈ = 0)
/// these matrices describe small motions.
///
/// Driven inputs are constant, as are the values of a [sampled](crate::system::Sampled) controller,
/// which are the results of its last run. A feedback law is linearized together with the system.
/// [`control_jacobian`](Jacobians::control_jacobian) is ∂q̈ by the control inputs. Limits are
/// ignored: the result describes motions away from limits.
///
/// With constraints, δ lies in their tangent space, and the number of modes is its dimension. About
/// a moving state the tangent space turns:
/// [`damped_modes`](Linearization::damped_modes) then has the eigenvalues of
/// [`state_space`](crate::analysis::state_space), the model in independent coordinates.
///
/// The row of a state in M δ̈ + C δ̇ + K δ = 0 is the derivative of its rate, with the mass one.
/// [`damped_modes`](Linearization::damped_modes) counts each state once, and
/// [`normal_modes`](Linearization::normal_modes) holds the states.
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
///
/// The force of a dry friction has no derivative at rest. A program that linearizes a system with
/// friction does not compile:
///
/// ```compile_fail,E0080
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Brake { m: kg, F: N }
///     coordinate x: m;
///     kinetic = m/2*ẋ^2;
///     friction shoe: ẋ, force = F;
/// }
/// # }
/// # fn main() {
/// pendulum_runtime::analysis::linearize(&system::Brake::new(2.0, 1.0), 0.0, &[0.0], &[0.0]);
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
    const {
        assert!(
            <D::System as System<N>>::FACTS.frictions.is_empty(),
            "the force of a dry friction has no derivative at rest: leave the frictions out of the block that is linearized, and hold by a `constraint` what sticks"
        );
    }
    without_frictions(dynamics, t, q, v)
}

/// Linearizes the equations as [`linearize`] does, without the forces of dry frictions.
pub(super) fn without_frictions<D, const N: usize>(
    dynamics: &D,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> Linearization<N>
where
    D: Dynamics<N, Scalar = f64>,
    D::System: Jacobians<N>,
{
    let phase = Phase { dynamics, t: Time::new(t), side: Side::After, q, v };
    let system = dynamics.system();
    let mass = system.mass_matrix(phase.at(&phase.momentum_inputs()));
    let inputs = phase.inputs(Purpose::Accelerations);
    let at = phase.at(&inputs);
    let (mut by_q, mut by_v) = (system.position_jacobian(at), system.velocity_jacobian(at));
    if D::FEEDBACK {
        let [law_by_q, law_by_v] = feedback_jacobians(dynamics, phase.t, at);
        by_q += law_by_q;
        by_v += law_by_v;
    }
    let (damping, stiffness) = (-mass * by_v, -mass * by_q);
    let constraints = gradients(&phase);
    let facts = &<D::System as System<N>>::FACTS;
    let slopes = if facts.held_constraints() == 0 { SMatrix::zeros() } else { slopes(&phase) };
    let rates = rates(&phase);
    Linearization { mass, damping, stiffness, constraints, slopes, rates, facts }
}

impl<const N: usize> Linearization<N> {
    /// Computes the vibrations M δ̈ + K δ = 0 on the constraints, by the Cholesky factor of M and
    /// the eigenvalues of a symmetric matrix. Damping, the symmetric part of C, is left out.
    ///
    /// # Errors
    /// Returns an error if the mass matrix is not positive definite, if a value is not finite, or if
    /// the other part of C or of K is not zero: gyroscopic forces, which do no work, and circulatory
    /// ones, which have no potential, change frequencies.
    pub fn normal_modes(&self) -> Result<NormalModes, ModeError> {
        let n = N - self.facts.states;
        let own = |matrix: &SMatrix<f64, N, N>| DMatrix::from_fn(n, n, |i, j| matrix[(i, j)]);
        let [mass, stiffness, damping] = [&self.mass, &self.stiffness, &self.damping].map(own);
        if mass.iter().chain(stiffness.iter()).any(|entry| !entry.is_finite()) {
            return Err(ModeError::NotFinite);
        }
        let factor = mass.cholesky().ok_or(ModeError::Mass)?.l();
        let free = self.free_directions(&factor)?;
        // The symmetric and the other part of L⁻¹ X L⁻ᵀ on the constraints.
        let parts = |matrix: &DMatrix<f64>| {
            let half = factor.solve_lower_triangular(matrix)?;
            let mut scaled = factor.solve_lower_triangular(&half.transpose())?.transpose();
            if let Some(free) = &free {
                scaled = free.transpose() * scaled * free;
            }
            let other = scaled.transpose();
            Some([0.5 * (&scaled + &other), 0.5 * (scaled - other)])
        };
        // Of the stiffness, the eigenvalues are ω², and the eigenvectors Lᵀ δ.
        let [symmetric, circulating] = parts(&stiffness).ok_or(ModeError::Mass)?;
        let [_, across] = parts(&damping).ok_or(ModeError::Mass)?;
        // In 1/s, as the frequencies are, against which rounding is nothing.
        let rounding = 1e-9 * (symmetric.amax().sqrt() + self.damping.amax() / self.mass.amax());
        if rounding < across.amax() {
            return Err(ModeError::Gyroscopic);
        }
        if 1e-9 * symmetric.amax() + rounding * rounding < circulating.amax() {
            return Err(ModeError::Circulatory);
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
        let shapes = shapes.insert_rows(n, self.facts.states, 0.0);
        let columns: Vec<DVector<f64>> =
            order.iter().map(|&mode| shapes.column(mode).into_owned()).collect();
        let squared_frequencies = order.iter().map(|&mode| eigen.eigenvalues[mode]).collect();
        Ok(NormalModes { squared_frequencies, shapes: DMatrix::from_columns(&columns) })
    }

    /// Returns the independent coordinates and velocities if there are states, or if the tangent
    /// space of the constraints turns; `None` if δ̇ lies in the same space as δ.
    pub(super) fn reduction(&self) -> Option<Reduction> {
        let (facts, states) = (self.facts, self.facts.states);
        let turns = self.slopes.iter().any(|&slope| slope != 0.0);
        (turns || 0 < states).then(|| {
            Reduction::on(facts, &self.mass, &self.constraints, &self.slopes)
                .without_rates(&self.rates, states)
        })
    }

    /// Returns M q̈ or its derivatives by coordinates, with the rates of states in place of their
    /// derivatives, for equilibria: rates are zero there.
    pub(super) fn resting_stiffness(&self) -> SMatrix<f64, N, N> {
        let mut stiffness = self.stiffness;
        for row in N - self.facts.states..N {
            stiffness.set_row(row, &-self.rates[0].row(row));
        }
        stiffness
    }

    /// Returns a basis of the tangent space of the constraints, in coordinates scaled by the factor
    /// of the mass matrix; `None` without constraints.
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
