//! Linear models from control inputs to outputs.

use crate::analysis::reduction::{Reduction, has_linear_states};
use crate::integrate::field::phase::Phase;
use crate::motion::Side;
use crate::scalar::Dual;
use crate::system::{At, Dynamics, Jacobians, MOST_CONTROLS, Output, Purpose, Samples, System};
use crate::time::Time;
use nalgebra::DMatrix;

/// A linear model of small changes x = (δq, δq̇) of a state, u of the control inputs and y of the
/// outputs: ẋ = A x + B u, y = C x + D u.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StateSpace {
    /// The indices of the coordinates whose changes δq are in x. Without constraints these are all
    /// coordinates.
    pub coordinates: Vec<usize>,
    /// The indices of the velocities whose changes δq̇ follow in x. With constraints of velocities
    /// and with states there are fewer velocities than coordinates.
    pub velocities: Vec<usize>,
    /// The matrix A, 2n × 2n for n coordinates without constraints and states.
    pub a: DMatrix<f64>,
    /// The matrix B, with a column for each component of the control inputs in the order of
    /// declaration.
    pub b: DMatrix<f64>,
    /// The matrix C, with a row for each scalar of the outputs in the order of declaration.
    pub c: DMatrix<f64>,
    /// The matrix D.
    pub d: DMatrix<f64>,
}

/// Computes the linear model about the state `q`, `v` at time `t`, with exact derivatives.
///
/// The values of the control inputs are those of the controller of `dynamics` at this state. The
/// model does not include the law of the controller: it is the model of the open loop. The values
/// of a [sampled](crate::system::Sampled) controller are those of its last run at `t`, or NaN
/// before a run. Driven inputs are constant.
///
/// The model describes small changes relative to the motion through the state. For a goal at rest,
/// the controller should return the forces that hold the goal: `controlled_by(|_, _, _| u0)`.
///
/// With constraints, x contains independent coordinates and velocities. The others follow from C δq
/// = 0 for constraints of positions, and from C δq̇ + ∂(C q̇ + b)/∂q δq = 0 for all constraints.
/// The state may move, and must fulfil the constraints. If the constraints depend on each other,
/// the entries are not finite. A system with dry friction has no linear model at rest, and does not
/// compile.
///
/// Source: K. J. Åström and R. M. Murray (2008), Feedback Systems, eq. 5.33.
pub fn state_space<D, const N: usize>(
    dynamics: &D,
    t: f64,
    q: &[f64; N],
    v: &[f64; N],
) -> StateSpace
where
    D: Dynamics<N, Scalar = f64, System: Jacobians<N>>,
{
    const {
        assert!(
            <D::System as System<N>>::FACTS.frictions.is_empty(),
            "the force of a dry friction has no derivative at rest: leave the frictions out of the block of the linear model, and hold by a `constraint` what sticks"
        );
    }
    let phase = &Phase { dynamics, t: Time::new(t), side: Side::After, q, v };
    let system = dynamics.system();
    let facts = &<D::System as System<N>>::FACTS;
    let controls: usize = facts.inputs[facts.driven()..].iter().map(|own| own.components).sum();
    let reduction = Reduction::new(phase);
    let mut model = StateSpace {
        coordinates: reduction.coordinates.clone(),
        velocities: reduction.velocities.clone(),
        a: DMatrix::zeros(2 * N, 2 * N),
        b: DMatrix::zeros(2 * N, controls),
        c: DMatrix::zeros(facts.outputs.iter().map(Output::count).sum(), 2 * N),
        d: DMatrix::zeros(facts.outputs.iter().map(Output::count).sum(), controls),
    };
    let inputs = phase.inputs(Purpose::Accelerations);
    let at = phase.at(&inputs);
    let (by_q, by_v) = (system.position_jacobian(at), system.velocity_jacobian(at));
    let mut by_u = [[0.0; N]; MOST_CONTROLS];
    system.control_jacobian(at, &mut by_u);
    for i in 0..N {
        model.a[(i, N + i)] = 1.0;
        for j in 0..N {
            (model.a[(N + i, j)], model.a[(N + i, N + j)]) = (by_q[(i, j)], by_v[(i, j)]);
        }
        for k in 0..controls {
            model.b[(N + i, k)] = by_u[k][i];
        }
    }
    outputs(phase, &mut model);
    if facts.held_constraints() == 0 && !const { has_linear_states::<D, N>() } {
        return model;
    }
    model.a = reduction.rows(&(&model.a * &reduction.all));
    model.b = reduction.rows(&model.b);
    model.c *= &reduction.all;
    model
}

/// Computes C and D, and the rows of B of the states, one column per evaluation over dual numbers.
fn outputs<D, const N: usize>(phase: &Phase<'_, D, N>, model: &mut StateSpace)
where
    D: Dynamics<N, Scalar = f64, System: Jacobians<N>>,
{
    type Number = Dual<f64>;
    let facts = &<D::System as System<N>>::FACTS;
    let system = phase.dynamics.system().over(Number::constant);
    let inputs = phase.inputs(Purpose::Outputs);
    let At { t, q, v, .. } = phase.at(&inputs);
    let lifted: <<D::System as Jacobians<N>>::Over<Number> as System<N>>::Inputs =
        inputs.map(Number::constant);
    let values = phase.dynamics.controls(phase.t, q, v);
    let (t, controls) = (Number::constant(t), model.d.ncols());
    for column in 0..2 * N + controls {
        let (mut q, mut v) = (q.map(Number::constant), v.map(Number::constant));
        let (mut inputs, mut u) = (lifted, values.map(Number::constant));
        let own = if column < N {
            &mut q[column]
        } else if column < 2 * N {
            &mut v[column - N]
        } else {
            &mut u[column - 2 * N]
        };
        own.derivative = 1.0;
        if 2 * N <= column {
            inputs.set_controls(facts.driven(), &u[..controls]);
        }
        if 2 * N <= column && const { has_linear_states::<D, N>() } {
            let [rates, _] = system.state_rates(At { t, q: &q, v: &v, inputs: &inputs }, &v);
            for state in N - facts.states..N {
                model.b[(state, column - 2 * N)] = rates[state].derivative;
            }
        }
        let mut row = 0;
        for (index, output) in facts.outputs.iter().enumerate() {
            let mut scalars = vec![Number::constant(0.0); output.count()];
            system.output(index, At { t, q: &q, v: &v, inputs: &inputs }, &mut scalars);
            for scalar in scalars {
                if column < 2 * N {
                    model.c[(row, column)] = scalar.derivative;
                } else {
                    model.d[(row, column - 2 * N)] = scalar.derivative;
                }
                row += 1;
            }
        }
    }
}
