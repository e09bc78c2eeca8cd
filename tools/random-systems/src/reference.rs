//! The equations of motion computed from the source: Euler–Lagrange with infinitesimals, direction
//! by direction.

use super::evaluate::{Constants, Leaves, indexed, scalar};
use super::nilpotent::Nilpotent;
use super::tree::System;
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
    /// Returns the variables without infinitesimals.
    pub fn leaves(&self, accelerations: &[T]) -> Leaves<T> {
        let constant = |&value: &T| Nilpotent::constant(value, 0);
        let all = |values: &[T]| values.iter().map(constant).collect::<Vec<_>>();
        let input = |orders: &[T; 4]| orders.each_ref().map(constant);
        Leaves {
            time: constant(&self.t),
            q: all(&self.q),
            v: all(&self.v),
            a: all(accelerations),
            inputs: self
                .inputs
                .iter()
                .map(|components| components.iter().map(input).collect())
                .collect(),
        }
    }

    /// Converts the state to another scalar.
    pub fn map<U>(&self, map: impl Fn(T) -> U + Copy) -> State<U> {
        use super::evaluate::Points;
        let all = |values: &[T]| values.iter().map(|&value| map(value)).collect::<Vec<_>>();
        let points = |points: &Points<T>| {
            Points(points.0.iter().map(|&(w, p)| (map(w), p.map(map))).collect())
        };
        State {
            constants: Constants {
                parameters: all(&self.constants.parameters),
                bodies: self
                    .constants
                    .bodies
                    .iter()
                    .map(|body| body.as_ref().map(points))
                    .collect(),
            },
            t: map(self.t),
            q: all(&self.q),
            v: all(&self.v),
            inputs: self
                .inputs
                .iter()
                .map(|input| input.iter().map(|orders| orders.map(map)).collect())
                .collect(),
        }
    }
}

/// Returns Σ kinetic − Σ potential.
pub fn lagrangian<T: Float>(
    system: &System,
    constants: &Constants<T>,
    leaves: &Leaves<T>,
) -> Nilpotent<T> {
    let mut total = Nilpotent::constant(T::from_f64(0.0), leaves.infinitesimals());
    for expr in &system.kinetic {
        total = total.add(&scalar(system, constants, leaves, expr));
    }
    for expr in &system.potential {
        total = total.sub(&scalar(system, constants, leaves, expr));
    }
    total
}

fn dissipation<T: Float>(
    system: &System,
    constants: &Constants<T>,
    leaves: &Leaves<T>,
) -> Nilpotent<T> {
    let mut total = Nilpotent::constant(T::from_f64(0.0), leaves.infinitesimals());
    for expr in &system.dissipation {
        total = total.add(&scalar(system, constants, leaves, expr));
    }
    total
}

/// Adds a new infinitesimal to one velocity.
fn pushed<T: Float>(leaves: &Leaves<T>, coordinate: usize) -> Leaves<T> {
    let mut wide = leaves.widened();
    let half = wide.v[coordinate].0.len() / 2;
    wide.v[coordinate].0[half] = T::from_f64(1.0);
    wide
}

/// Adds a new infinitesimal to one coordinate.
fn shifted<T: Float>(leaves: &Leaves<T>, coordinate: usize) -> Leaves<T> {
    let mut wide = leaves.widened();
    let half = wide.q[coordinate].0.len() / 2;
    wide.q[coordinate].0[half] = T::from_f64(1.0);
    wide
}

/// Computes all values at a state.
pub fn reference<T: Float>(system: &System, state: &State<T>) -> Reference<T> {
    let count = system.count();
    let zero = T::from_f64(0.0);
    let constants = &state.constants;
    let still = state.leaves(&vec![zero; count]);
    let later = still.later();
    let mut reference = Reference {
        lagrangian: lagrangian(system, constants, &still).0[0],
        kinetic: zero,
        potential: zero,
        momenta: Vec::new(),
        masses: vec![vec![zero; count]; count],
        slopes: Vec::new(),
        drifts: Vec::new(),
        externals: Vec::new(),
        explicit: zero,
    };
    for expr in &system.kinetic {
        reference.kinetic += scalar(system, constants, &still, expr).0[0];
    }
    for expr in &system.potential {
        reference.potential += scalar(system, constants, &still, expr).0[0];
    }
    for i in 0..count {
        // L(q + ε₁q̇, q̇ + ε₂eᵢ, t + ε₁): the coefficient of ε₂ is pᵢ, that of ε₁ε₂ its rate.
        let value = lagrangian(system, constants, &pushed(&later, i));
        reference.momenta.push(value.0[2]);
        reference.drifts.push(value.0[3]);
        reference.slopes.push(lagrangian(system, constants, &shifted(&still, i)).0[1]);
        for j in 0..=i {
            let entry = lagrangian(system, constants, &pushed(&pushed(&still, i), j)).0[3];
            reference.masses[i][j] = entry;
            reference.masses[j][i] = entry;
        }
        let friction = dissipation(system, constants, &pushed(&still, i)).0[1];
        reference.externals.push(-friction);
    }
    // L(q, q̇, t + ε), where driven inputs advance and coordinates do not.
    let frozen = Leaves { q: still.widened().q, v: still.widened().v, ..later };
    reference.explicit = lagrangian(system, constants, &frozen).0[1];
    for force in &system.forces {
        let first = system.first_coordinate(force.coordinate);
        let members = match (system.coordinates[force.coordinate].length, force.member) {
            (Some(length), None) => 0..length,
            (_, member) => member.unwrap_or(0)..member.unwrap_or(0) + 1,
        };
        for k in members {
            reference.externals[first + k] +=
                indexed(system, constants, &still, &force.expr, Some(k)).0[0];
        }
    }
    reference
}
