//! Equilibria, by Newton's method with the generated Jacobians.

use crate::analysis::linearization::without_frictions;
use crate::error::Coordinate;
use crate::integrate::field::contacts::Contacts;
use crate::integrate::field::grasp::{Grip, has_frictions};
use crate::integrate::field::phase::{Phase, has_states};
use crate::motion::Side;
use crate::system::{At, Dynamics, Jacobians, Purpose, System};
use crate::time::Time;
use core::fmt;
use nalgebra::{DMatrix, DVector, SVector};

/// An error of [`equilibrium`], with the reason and the point at which the search ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EquilibriumError<const N: usize> {
    /// The reason.
    pub reason: EquilibriumFailure,
    /// The time of the equilibrium.
    pub t: f64,
    /// The coordinates at which the search began.
    pub guess: [f64; N],
    /// The coordinates at which the search ended.
    pub q: [f64; N],
    /// The coordinate with the largest acceleration at `q`, or with an acceleration that is not
    /// finite.
    pub coordinate: Coordinate,
    /// The acceleration of this coordinate at `q`.
    pub acceleration: f64,
}

/// The reason of an [`EquilibriumError`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum EquilibriumFailure {
    /// The guess, an acceleration or a Jacobian is not finite.
    NotFinite,
    /// The remaining acceleration is independent of all coordinates.
    NoRestoringForce,
    /// No step in Newton's direction reduces the accelerations.
    Stalled,
    /// The maximum number of steps was reached.
    Slow,
}

impl<const N: usize> fmt::Display for EquilibriumError<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, t, guess, q, coordinate, acceleration } = self;
        match reason {
            EquilibriumFailure::NotFinite => write!(
                f,
                "at t = {t} and the guess {guess:?} the acceleration of {coordinate} or its derivatives are not finite; check guess, parameters and driven inputs"
            ),
            EquilibriumFailure::NoRestoringForce => write!(
                f,
                "at t = {t} nothing balances the acceleration {acceleration:e} of {coordinate} near {q:?}: no coordinate changes it; add the force that holds it, or guess elsewhere than {guess:?}"
            ),
            EquilibriumFailure::Stalled => write!(
                f,
                "at t = {t} the search from {guess:?} ended at {q:?}, where {coordinate} is still accelerated by {acceleration:e} and no step makes that less; guess elsewhere"
            ),
            EquilibriumFailure::Slow => write!(
                f,
                "at t = {t} the search from {guess:?} came to {q:?} in {STEPS} steps, where {coordinate} is still accelerated by {acceleration:e}; guess nearer to the equilibrium"
            ),
        }
    }
}

impl<const N: usize> core::error::Error for EquilibriumError<N> {}

/// The maximum number of steps.
const STEPS: u32 = 200;

/// The maximum number of halvings of a step.
const HALVES: u32 = 40;

/// Singular values below this fraction of the largest count as zero.
const RANK: f64 = 1e-11;

/// Finds an equilibrium near `guess`: coordinates with q̈(t, q, 0) = 0, for the driven inputs at
/// `t`. The equilibrium can be stable or unstable.
///
/// Each step of Newton's method solves K δ = M q̈ with the stiffness matrix K = −M ∂q̈/∂q of
/// [`linearize`](crate::analysis::linearize). The step is halved until the next step, computed with
/// the same K, is shorter; this test is independent of units (Deuflhard 2004, Newton Methods for
/// Nonlinear Problems, section 3.2). A step changes each coordinate q by at most 1 + |q|. If K is
/// singular, as for a cart without a preferred position, δ is the shortest solution, by singular
/// values.
///
/// ```
/// use pendulum_runtime::prelude::*;
/// use pendulum_runtime::analysis::equilibrium;
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     /// A bead on a hoop that turns about its vertical diameter.
///     pub struct Hoop { R: m, Ω: 1/s, g: m/s^2 = 9.81 }
///     coordinate θ: rad;
///     kinetic = R^2/2*(θ̇^2 + Ω^2*sin(θ)^2);
///     potential = -g*R*cos(θ);
/// }
/// # }
/// # use system::Hoop;
/// let q = equilibrium(&Hoop::new(0.5, 6.0), 0.0, [1.0])?;
/// // cos θ = g/(R Ω²).
/// assert!((q[0].cos() - 9.81 / 18.0).abs() < 1e-15);
/// # Ok::<(), pendulum_runtime::analysis::EquilibriumError<1>>(())
/// ```
///
/// The result fulfils constraints of positions as well. Limits are ignored.
///
/// With dry friction, equilibria form a set, in which frictions hold what other forces pull. The
/// result is the one in which they have nothing to hold. What slides while the coordinates are at
/// rest, as on a belt, has the force of sliding, without the parts that limits in contact have in it.
///
/// # Errors
/// Returns an error if a value is not finite, if an acceleration is independent of all coordinates,
/// or if the search stalls or is too slow. The error contains the guess, the point at which the
/// search ended, and the largest acceleration at this point.
pub fn equilibrium<D, const N: usize>(
    dynamics: &D,
    t: f64,
    guess: [f64; N],
) -> Result<[f64; N], EquilibriumError<N>>
where
    D: Dynamics<N, Scalar = f64>,
    D::System: Jacobians<N>,
{
    let accelerations = |q: &[f64; N]| {
        let (t, side, v) = (Time::new(t), Side::After, &[0.0; N]);
        let phase = Phase { dynamics, t, side, q, v };
        let mut a = dynamics.accelerations_at(t, side, q, v);
        if const { has_frictions::<D, N>() } {
            a = with_belts(&phase, &a);
        }
        resting(&phase, &a)
    };
    let inputs = dynamics.inputs(Time::new(t), Side::After, Purpose::Momenta);
    let misfits =
        |q: &[f64; N]| dynamics.system().misfits(At { t, q, v: &[0.0; N], inputs: &inputs })[0];
    let failure = |reason, q: [f64; N]| {
        let a = accelerations(&q);
        let size = |i: usize| if a[i].is_finite() { a[i].abs() } else { f64::INFINITY };
        let index = (0..N).fold(0, |most, i| if size(most) < size(i) { i } else { most });
        let names = <D::System as System<N>>::FACTS.coordinates;
        EquilibriumError {
            reason,
            t,
            guess,
            q,
            coordinate: Coordinate { index, name: names.get(index).copied().unwrap_or_default() },
            acceleration: a.get(index).copied().unwrap_or_default(),
        }
    };
    let finite = |values: &[f64; N]| values.iter().all(|value| value.is_finite());
    let mut q = guess;
    let mut a = accelerations(&q);
    if !(finite(&q) && finite(&a) && t.is_finite()) {
        return Err(failure(EquilibriumFailure::NotFinite, q));
    }
    for _ in 0..STEPS {
        let g = misfits(&q);
        if a == [0.0; N] && g == [0.0; N] {
            return Ok(q);
        }
        let Some(newton) = Newton::new(dynamics, t, &q) else {
            return Err(failure(EquilibriumFailure::NotFinite, q));
        };
        let (step, lost) = newton.step(&a, &g);
        let within = |bound: f64| (0..N).all(|i| step[i].abs() <= bound * (1.0 + q[i].abs()));
        if lost && within(1e-6) {
            return Err(failure(EquilibriumFailure::NoRestoringForce, q));
        }
        let trial = |share: f64| -> [f64; N] { core::array::from_fn(|i| q[i] + share * step[i]) };
        if within(8.0 * f64::EPSILON) {
            // The last step is taken if it does not increase the accelerations or the violations of
            // constraints.
            let end = trial(1.0);
            let sum = |a: [f64; N]| a.iter().map(|a| a.abs()).sum::<f64>();
            let better = sum(accelerations(&end)) <= sum(a) && sum(misfits(&end)) <= sum(g);
            return Ok(if better { end } else { q });
        }
        let longest = (0..N).fold(1.0, |share: f64, i| {
            let most = (1.0 + q[i].abs()) / step[i].abs();
            if most < share { most } else { share }
        });
        let mut share = longest;
        let taken = (0..HALVES).find_map(|_| {
            let (end, part) = (trial(share), share);
            share *= 0.5;
            let then = accelerations(&end);
            if !finite(&then) {
                return None;
            }
            let (next, _) = newton.step(&then, &misfits(&end));
            (next.norm() <= (1.0 - 0.5 * part) * step.norm()).then_some((end, then))
        });
        match taken {
            Some(taken) => (q, a) = taken,
            // The rounding error is larger than the step.
            None if !lost && within(1e-8) => return Ok(q),
            None if lost => return Err(failure(EquilibriumFailure::NoRestoringForce, q)),
            None => return Err(failure(EquilibriumFailure::Stalled, q)),
        }
    }
    Err(failure(EquilibriumFailure::Slow, q))
}

/// Returns accelerations with the rates of states in their places.
fn resting<D, const N: usize>(phase: &Phase<'_, D, N>, a: &[f64; N]) -> [f64; N]
where
    D: Dynamics<N, Scalar = f64>,
{
    let mut a = *a;
    if const { has_states::<D, N>() } {
        let [rates, _] = phase.with_rates(&a);
        let first = N - <D::System as System<N>>::FACTS.states;
        a[first..].copy_from_slice(&rates[first..]);
    }
    a
}

/// Returns accelerations with the forces of the dry frictions that slide although the coordinates
/// are at rest.
fn with_belts<D, const N: usize>(phase: &Phase<'_, D, N>, a: &[f64; N]) -> [f64; N]
where
    D: Dynamics<N, Scalar = f64>,
{
    let inputs = phase.inputs(Purpose::Accelerations);
    let [rates, _] = phase.dynamics.system().slips(phase.at(&inputs));
    let frictions = <D::System as System<N>>::FACTS.frictions;
    let vector = |k: usize| frictions.get(k).is_some_and(|own| own.components != 1);
    let grips = core::array::from_fn(|k| match rates[k] {
        0.0 => Grip::Sticks,
        rate => Grip::sliding(0.0 < rate || vector(k)),
    });
    phase.slide(&Contacts::NONE.with(grips), a)
}

/// The matrices of a step: M, and the singular value decomposition of K with the gradients of the
/// constraints below it.
struct Newton<const N: usize> {
    mass: DMatrix<f64>,
    /// The weight of the constraints relative to forces.
    weight: f64,
    u: DMatrix<f64>,
    values: DVector<f64>,
    v_t: DMatrix<f64>,
    /// The bound below which forces are rounding errors.
    floor: f64,
}

impl<const N: usize> Newton<N> {
    /// Computes the matrices; returns `None` if they are not finite.
    fn new<D>(dynamics: &D, t: f64, q: &[f64; N]) -> Option<Self>
    where
        D: Dynamics<N, Scalar = f64>,
        D::System: Jacobians<N>,
    {
        let small = without_frictions(dynamics, t, q, &[0.0; N]);
        let dense = |matrix: &nalgebra::SMatrix<f64, N, N>| {
            DMatrix::from_fn(N, N, |row, column| matrix[(row, column)])
        };
        let (mass, stiffness) = (dense(&small.mass), dense(&small.resting_stiffness()));
        if mass.iter().chain(stiffness.iter()).any(|entry| !entry.is_finite()) {
            return None;
        }
        let phase = Phase { dynamics, t: Time::new(t), side: Side::After, q, v: &[0.0; N] };
        let constrained = !<D::System as System<N>>::FACTS.constraints.is_empty();
        let gradients = dynamics.system().constraint_jacobian(phase.at(&phase.momentum_inputs()));
        // The weight gives constraints and forces the same magnitude.
        let weight = match (stiffness.amax(), gradients.amax()) {
            (stiffness, gradient) if 0.0 < stiffness && 0.0 < gradient => stiffness / gradient,
            _ => 1.0,
        };
        let rows = if constrained { 2 * N } else { N };
        let equations = DMatrix::from_fn(rows, N, |row, column| {
            if row < N { stiffness[(row, column)] } else { weight * gradients[(row - N, column)] }
        });
        let svd = equations.try_svd(true, true, f64::EPSILON, 300 * N)?;
        let size = q.iter().fold(1.0, |sum, q| sum + q.abs());
        let floor = 1e3 * f64::EPSILON * size * svd.singular_values.amax();
        Some(Self { mass, weight, u: svd.u?, values: svd.singular_values, v_t: svd.v_t?, floor })
    }

    /// Returns the shortest δ that minimizes |K δ − M q̈|, and `true` if a large part of M q̈
    /// remains, as in directions without restoring forces.
    fn step(&self, a: &[f64; N], misfits: &[f64; N]) -> (SVector<f64, N>, bool) {
        let force = &self.mass * DVector::from_column_slice(a);
        let rows = self.u.nrows();
        let force = DVector::from_fn(rows, |row, _| {
            if row < N { force[row] } else { -self.weight * misfits[row - N] }
        });
        let parts = self.u.tr_mul(&force);
        let rank = RANK * self.values.amax();
        let (mut kept, mut lost) = (DVector::zeros(N), 0.0f64);
        for i in 0..N {
            if rank < self.values[i] {
                kept[i] = parts[i] / self.values[i];
            } else {
                lost = lost.max(parts[i].abs());
            }
        }
        let step = self.v_t.tr_mul(&kept);
        (SVector::from_fn(|i, _| step[i]), (1e-3 * force.amax()).max(self.floor) < lost)
    }
}
