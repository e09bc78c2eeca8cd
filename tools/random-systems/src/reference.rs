//! The equations of motion computed from the source: Euler–Lagrange with infinitesimals, direction
//! by direction.

use super::evaluate::{Constants, Evaluator, Leaves, Points};
use super::nilpotent::Nilpotent;
use super::tree::{Expr, System};
use pendulum_runtime::scalar::Float;

/// A state with the driven inputs and constants.
#[derive(Clone, Debug)]
pub struct State<T> {
    pub constants: Constants<T>,
    pub t: T,
    pub q: Vec<T>,
    pub v: Vec<T>,
    /// For each driven input and component, the value and its derivatives up to the third.
    pub inputs: Vec<Vec<[T; 4]>>,
}

/// The values of the source at a state: M q̈ = f and further functions.
#[derive(Clone, Debug)]
pub struct Reference<T> {
    pub lagrangian: T,
    /// Σ `kinetic`; `potential` is Σ `potential`.
    pub kinetic: T,
    pub potential: T,
    pub momenta: Vec<T>,
    pub masses: Vec<Vec<T>>,
    /// ∂L/∂q.
    pub slopes: Vec<T>,
    /// dp/dt at q̈ = 0.
    pub drifts: Vec<T>,
    /// Q − ∂R/∂q̇.
    pub externals: Vec<T>,
    /// ∂L/∂t at constant coordinates and velocities.
    pub explicit: T,
}

impl<T: Float> State<T> {
    /// Returns the variables without infinitesimals, with accelerations of zero.
    fn leaves(&self) -> Leaves<T> {
        let constant = |&value: &T| Nilpotent::constant(value, 0);
        let all = |values: &[T]| values.iter().map(constant).collect::<Vec<_>>();
        let input = |orders: &[T; 4]| orders.each_ref().map(constant);
        Leaves {
            time: constant(&self.t),
            q: all(&self.q),
            v: all(&self.v),
            a: vec![constant(&T::from_f64(0.0)); self.q.len()],
            inputs: self.inputs.iter().map(|parts| parts.iter().map(input).collect()).collect(),
        }
    }

    /// Converts the state to another scalar.
    pub fn map<U>(&self, map: impl Fn(T) -> U + Copy) -> State<U> {
        let all = |values: &[T]| values.iter().map(|&value| map(value)).collect::<Vec<_>>();
        let points = |points: &Points<T>| {
            Points(points.0.iter().map(|&(w, p)| (map(w), p.map(map))).collect())
        };
        let input = |parts: &Vec<[T; 4]>| parts.iter().map(|orders| orders.map(map)).collect();
        let Constants { parameters, bodies } = &self.constants;
        let bodies = bodies.iter().map(|body| body.as_ref().map(points)).collect();
        State {
            constants: Constants { parameters: all(parameters), bodies },
            t: map(self.t),
            q: all(&self.q),
            v: all(&self.v),
            inputs: self.inputs.iter().map(input).collect(),
        }
    }
}

/// Adds a new infinitesimal to one variable.
fn nudged<T: Float>(
    leaves: &Leaves<T>,
    variable: impl Fn(&mut Leaves<T>) -> &mut Nilpotent<T>,
) -> Leaves<T> {
    let mut wide = leaves.widened();
    let Nilpotent(coefficients) = variable(&mut wide);
    let half = coefficients.len() / 2;
    coefficients[half] = T::from_f64(1.0);
    wide
}

/// Computes all values at a state.
pub fn reference<T: Float>(system: &System, state: &State<T>) -> Reference<T> {
    let count = system.count();
    let evaluator = Evaluator { system, constants: &state.constants };
    let total = |terms: &[Expr], leaves: &Leaves<T>| {
        let zero = Nilpotent::constant(T::from_f64(0.0), leaves.time.infinitesimals());
        terms.iter().fold(zero, |sum, term| sum.add(&evaluator.indexed(term, leaves, None)))
    };
    let lagrangian = |leaves: &Leaves<T>| {
        total(&system.kinetic, leaves).sub(&total(&system.potential, leaves)).0
    };
    let still = state.leaves();
    let later = still.later();
    let pushed = |leaves: &Leaves<T>, i: usize| nudged(leaves, |leaves| &mut leaves.v[i]);
    // L(q, q̇, t + ε), where driven inputs advance and coordinates do not.
    let frozen = Leaves { q: still.widened().q, v: still.widened().v, ..later.clone() };
    let mut reference = Reference {
        lagrangian: lagrangian(&still)[0],
        kinetic: total(&system.kinetic, &still).0[0],
        potential: total(&system.potential, &still).0[0],
        momenta: Vec::new(),
        masses: vec![vec![T::from_f64(0.0); count]; count],
        slopes: Vec::new(),
        drifts: Vec::new(),
        externals: Vec::new(),
        explicit: lagrangian(&frozen)[1],
    };
    for i in 0..count {
        // L(q + ε₁q̇, q̇ + ε₂eᵢ, t + ε₁): the coefficient of ε₂ is pᵢ, that of ε₁ε₂ its rate.
        let value = lagrangian(&pushed(&later, i));
        reference.momenta.push(value[2]);
        reference.drifts.push(value[3]);
        reference.slopes.push(lagrangian(&nudged(&still, |leaves| &mut leaves.q[i]))[1]);
        for j in 0..=i {
            let entry = lagrangian(&pushed(&pushed(&still, i), j))[3];
            reference.masses[i][j] = entry;
            reference.masses[j][i] = entry;
        }
        reference.externals.push(-total(&system.dissipation, &pushed(&still, i)).0[1]);
    }
    for force in &system.forces {
        let first = system.first_coordinate(force.coordinate);
        let members = match (system.coordinates[force.coordinate].length, force.member) {
            (Some(length), None) => 0..length,
            (_, member) => member.unwrap_or(0)..member.unwrap_or(0) + 1,
        };
        for k in members {
            reference.externals[first + k] += evaluator.indexed(&force.expr, &still, Some(k)).0[0];
        }
    }
    reference
}
