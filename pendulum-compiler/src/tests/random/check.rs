//! Comparison of all derived quantities of a system with the reference.

use super::interpret::Values;
use crate::algebra::expr::{Graph, Id};
use crate::mechanics::motion::Motion;
use crate::model::Model;
use pendulum_runtime::scalar::{DoubleDouble, Dual, Float};
use random_systems::reference::{Reference, State, reference};
use random_systems::state::{precise, state};
use random_systems::tree::System;

/// The results for a system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Findings {
    /// The largest error of each kind relative to its terms, in `f64` and in double-double.
    pub(crate) worst: Vec<(&'static str, f64, f64)>,
    /// The smallest pivot of the mass matrix relative to its largest entry.
    pub(crate) pivot: f64,
    /// The error of the reference itself in `f64`; NaN if the source has no value.
    pub(crate) own: f64,
}

impl Findings {
    fn note(&mut self, what: &'static str, plain: f64, precise: f64) {
        match self.worst.iter_mut().find(|row| row.0 == what) {
            Some(row) => (row.1, row.2) = (worse(row.1, plain), worse(row.2, precise)),
            None => self.worst.push((what, plain, precise)),
        }
    }

    /// Returns `true` if the source has a value at the state that `f64` can compute.
    pub(crate) fn sound(&self) -> bool {
        self.own < 1e-13
    }

    /// Returns the errors above the tolerance.
    pub(crate) fn wrong(&self) -> Vec<(&'static str, f64, f64)> {
        let right = |row: &&(&str, f64, f64)| !(row.1 < PLAIN && row.2 < PRECISE);
        self.worst.iter().filter(right).copied().collect()
    }
}

/// The tolerances for relative residuals in `f64` and in double-double.
pub(crate) const PLAIN: f64 = 1e-12;
pub(crate) const PRECISE: f64 = 1e-25;

/// Returns the larger number, or NaN.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b < a { a } else { b }
}

/// The model, the graph and the motion of a derived block.
pub(crate) struct Derived<'d, 'm> {
    pub(crate) model: &'d Model<'m>,
    pub(crate) graph: &'d Graph,
    pub(crate) motion: &'d Motion,
}

impl Derived<'_, '_> {
    fn values<T: Float>(&self, values: &Values<T>, roots: &[Id]) -> Vec<DoubleDouble> {
        values.of(self.model, self.graph, roots).into_iter().map(double).collect()
    }
}

/// Converts a value to double-double.
fn double<T: Float>(value: T) -> DoubleDouble {
    let high = value.to_f64();
    let low = (value - T::from_f64(high)).to_f64();
    DoubleDouble::sum(high, low)
}

/// Compares a system with the reference at one state.
pub(crate) fn compare(system: &System, derived: &Derived<'_, '_>, seed: u64) -> Findings {
    let plain = state(system, seed);
    let precise: State<DoubleDouble> = precise(system, &plain);
    let truth = reference(system, &precise);
    let mut findings = Findings { pivot: pivot(&truth.masses), ..Findings::default() };
    let own = reference(system, &plain);
    findings.own = own_error(&own, &truth);
    let pairs = [
        errors(derived, &Values::new(&plain), &truth),
        errors(derived, &Values::new(&precise), &truth),
    ];
    for (&(what, a), &(_, b)) in pairs[0].iter().zip(&pairs[1]) {
        findings.note(what, a, b);
    }
    findings
}

type Errors = Vec<(&'static str, f64)>;

fn errors<T: Float>(
    derived: &Derived<'_, '_>,
    values: &Values<T>,
    truth: &Reference<DoubleDouble>,
) -> Errors {
    let motion = derived.motion;
    let mut errors = Errors::new();
    let count = truth.momenta.len();
    let v: Vec<DoubleDouble> = values.v.iter().map(|&v| double(v)).collect();
    let accelerations = derived.values(values, &motion.accelerations);
    for i in 0..count {
        // Euler–Lagrange: M q̈ + drift = ∂L/∂q + Q.
        let mut terms: Vec<DoubleDouble> =
            (0..count).map(|j| truth.masses[i][j] * accelerations[j]).collect();
        terms.extend([truth.drifts[i], -truth.slopes[i], -truth.externals[i]]);
        errors.push(("Euler–Lagrange", residual(&terms)));
    }
    let same =
        |what: &'static str, roots: &[Id], expected: &[DoubleDouble], errors: &mut Errors| {
            let scale = expected.iter().fold(1.0, |scale: f64, x| scale.max(x.to_f64().abs()));
            for (found, expected) in derived.values(values, roots).into_iter().zip(expected) {
                errors.push((what, ((found - *expected).to_f64() / scale).abs()));
            }
        };
    for (row, expected) in motion.mass_matrix.iter().zip(&truth.masses) {
        same("mass matrix", row, expected, &mut errors);
    }
    same("momenta", &motion.momenta, &truth.momenta, &mut errors);
    let rates: Vec<DoubleDouble> =
        truth.slopes.iter().zip(&truth.externals).map(|(&a, &b)| a + b).collect();
    same("momentum rates", &motion.momentum_rates, &rates, &mut errors);
    let forces: Vec<DoubleDouble> = rates.iter().zip(&truth.drifts).map(|(&a, &b)| a - b).collect();
    same("forces", &motion.forces, &forces, &mut errors);
    let mut terms: Vec<DoubleDouble> = v.iter().zip(&truth.momenta).map(|(&v, &p)| v * p).collect();
    terms.extend([-truth.lagrangian, -derived.values(values, &[motion.energy])[0]]);
    errors.push(("energy", residual(&terms)));
    let mut terms: Vec<DoubleDouble> =
        v.iter().zip(&truth.externals).map(|(&v, &f)| v * f).collect();
    terms.extend([-truth.explicit, -derived.values(values, &[motion.power])[0]]);
    errors.push(("power", residual(&terms)));
    for (root, expected) in [(motion.kinetic, truth.kinetic), (motion.potential, truth.potential)] {
        if let Some(root) = root {
            same("split energy", &[root], &[expected], &mut errors);
        }
    }
    if let Some(velocities) = &motion.velocities {
        let mut values = values.clone();
        values.p =
            truth.momenta.iter().map(|&p| T::from_f64(p.high()) + T::from_f64(p.low())).collect();
        let found = derived.values(&values, velocities);
        for i in 0..count {
            // M q̇ is the momentum minus its value at q̇ = 0.
            let terms = (0..count).map(|j| truth.masses[i][j] * (found[j] - v[j]));
            let scale = (0..count).fold(truth.momenta[i].to_f64().abs().max(1.0), |scale, j| {
                scale.max((truth.masses[i][j] * v[j]).to_f64().abs())
            });
            let sum = terms.reduce(|a, b| a + b).map_or(0.0, Float::to_f64);
            errors.push(("velocities", (sum / scale).abs()));
        }
    }
    for &i in &motion.cyclic {
        errors.push((
            "cyclic",
            truth.slopes[i].to_f64().abs() / truth.drifts[i].to_f64().abs().max(1.0),
        ));
    }
    along(derived, values, &mut errors);
    jacobians(derived, values, &mut errors);
    errors
}

/// Checks rates along the motion by dual numbers: the power for the energy, the momentum rates for
/// the momenta, and zero for conserved quantities.
fn along<T: Float>(derived: &Derived<'_, '_>, values: &Values<T>, errors: &mut Errors) {
    let (motion, count) = (derived.motion, values.q.len());
    let accelerations = values.of(derived.model, derived.graph, &motion.accelerations);
    let dual = |value: T, derivative: T| Dual { value, derivative };
    let pairs = |a: &[T], b: &[T]| a.iter().zip(b).map(|(&a, &b)| dual(a, b)).collect::<Vec<_>>();
    let zero = T::from_f64(0.0);
    let input = |&[x, v, a, j]: &[T; 4]| [dual(x, v), dual(v, a), dual(a, j), dual(j, zero)];
    let moving = Values {
        parameters: values.parameters.iter().map(|&value| Dual::constant(value)).collect(),
        time: Dual::variable(values.time),
        q: pairs(&values.q, &values.v),
        v: pairs(&values.v, &accelerations),
        p: Vec::new(),
        inputs: values
            .inputs
            .iter()
            .map(|components| components.iter().map(input).collect())
            .collect(),
    };
    let conserved = motion.conserved.iter().map(|conserved| conserved.value);
    let quantities: Vec<Id> = [motion.energy]
        .into_iter()
        .chain(motion.momenta.iter().copied())
        .chain(conserved)
        .collect();
    let rates: Vec<Id> =
        [motion.power].into_iter().chain(motion.momentum_rates.iter().copied()).collect();
    let found = moving.of(derived.model, derived.graph, &quantities);
    let mut expected = values.of(derived.model, derived.graph, &rates);
    expected.resize(found.len(), zero);
    for (index, (found, expected)) in found.into_iter().zip(expected).enumerate() {
        let what = match index {
            0 => "dE/dt",
            _ if index <= count => "dp/dt",
            _ => "conserved",
        };
        // The largest terms of a rate are products of forces and velocities.
        let mut scale = found.value.to_f64().abs().max(1.0);
        for (a, v) in accelerations.iter().zip(&values.v) {
            scale = scale.max(a.to_f64().abs()).max((*a * *v).to_f64().abs());
        }
        errors.push((what, ((found.derivative - expected).to_f64() / scale).abs()));
    }
}

/// Checks the Jacobians by dual numbers.
fn jacobians<T: Float>(derived: &Derived<'_, '_>, values: &Values<T>, errors: &mut Errors) {
    let motion = derived.motion;
    let Some(jacobians) = &motion.jacobians else { return };
    let constants =
        |values: &[T]| values.iter().map(|&value| Dual::constant(value)).collect::<Vec<_>>();
    let input = |orders: &[T; 4]| orders.map(Dual::constant);
    let resting = Values {
        parameters: constants(&values.parameters),
        time: Dual::constant(values.time),
        q: constants(&values.q),
        v: constants(&values.v),
        p: Vec::new(),
        inputs: values
            .inputs
            .iter()
            .map(|components| components.iter().map(input).collect())
            .collect(),
    };
    for (kind, columns) in jacobians.iter().enumerate() {
        for (index, column) in columns.iter().enumerate() {
            let mut pushed = resting.clone();
            let slots = [&mut pushed.q, &mut pushed.v, &mut pushed.parameters];
            let [q, v, parameters] = slots;
            [q, v, parameters][kind][index].derivative = T::from_f64(1.0);
            let expected = pushed.of(derived.model, derived.graph, &motion.accelerations);
            let found = values.of(derived.model, derived.graph, column);
            let size = |scale: f64, x: &Dual<T>| {
                scale.max(x.value.to_f64().abs()).max(x.derivative.to_f64().abs())
            };
            let scale = expected.iter().fold(1.0, size);
            for (found, expected) in found.into_iter().zip(expected) {
                errors.push(("Jacobians", ((found - expected.derivative).to_f64() / scale).abs()));
            }
        }
    }
}

/// Returns the sum of terms that should cancel, relative to the largest of them or to one.
fn residual(terms: &[DoubleDouble]) -> f64 {
    let sum = terms.iter().copied().reduce(|a, b| a + b).map_or(0.0, Float::to_f64);
    let scale = terms.iter().fold(1.0, |scale: f64, term| scale.max(term.to_f64().abs()));
    (sum / scale).abs()
}

/// Returns the error of the forces and masses of the reference in `f64`.
fn own_error(own: &Reference<f64>, truth: &Reference<DoubleDouble>) -> f64 {
    let pairs = |own: &[f64], truth: &[DoubleDouble]| {
        let scale = truth.iter().fold(1.0, |scale: f64, x| scale.max(x.to_f64().abs()));
        own.iter()
            .zip(truth)
            .fold(0.0, |worst, (a, b)| worse(worst, (a - b.to_f64()).abs() / scale))
    };
    let mut worst = pairs(&own.drifts, &truth.drifts);
    worst = worse(worst, pairs(&[own.kinetic, own.potential], &[truth.kinetic, truth.potential]));
    worst = worse(worst, pairs(&own.slopes, &truth.slopes));
    worst = worse(worst, pairs(&own.externals, &truth.externals));
    worst = worse(worst, pairs(&own.momenta, &truth.momenta));
    own.masses
        .iter()
        .zip(&truth.masses)
        .fold(worst, |worst, (own, truth)| worse(worst, pairs(own, truth)))
}

/// Returns the smallest pivot of a symmetric matrix relative to its largest entry. It is negative
/// if the matrix is not positive definite.
fn pivot(matrix: &[Vec<DoubleDouble>]) -> f64 {
    let mut rows: Vec<Vec<f64>> =
        matrix.iter().map(|row| row.iter().map(|entry| entry.to_f64()).collect()).collect();
    let scale = rows.iter().flatten().fold(0.0f64, |scale, entry| scale.max(entry.abs()));
    let mut least = f64::INFINITY;
    for pivot in 0..rows.len() {
        let own = rows[pivot][pivot];
        least = if own.is_nan() { own } else { least.min(own / scale) };
        for row in pivot + 1..rows.len() {
            let factor = rows[row][pivot] / own;
            for column in 0..rows.len() {
                rows[row][column] -= factor * rows[pivot][column];
            }
        }
    }
    least
}
