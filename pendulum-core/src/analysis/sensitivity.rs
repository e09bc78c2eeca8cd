//! Sensitivities of a motion that has been integrated.
//!
//! The derivative of a motion by a parameter or by its initial state obeys a linear equation, δq̈ =
//! A δq + B δq̇ + c, whose coefficients are known once the motion is known. It is solved after the
//! run, along its dense output, by collocation at Radau's nodes: A, B and c are evaluated once at all
//! nodes of a step, side by side, and every further column costs a solution of the same linear
//! equations. The alternative, [`Variational`](super::Variational), evaluates them in every stage of
//! the run, and the number of its columns is part of the type.

// Compiled for several instruction sets, as is what they call.
#![allow(clippy::inline_always)]

use super::collocation::Equations;
use super::jump::Switches;
use super::radau::{Column, NODES, Nodes, Part, Rule};
use crate::integrate::ColumnError;
use crate::integrate::Solution;
use crate::integrate::State;
use crate::integrate::field::InputsOf;
use crate::integrate::interpolant::KNOWN;
use crate::integrate::interpolant::dense::DenseStep;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::passing::Passing;
use crate::motion::Side;
use crate::scalar::{Dual, Float, Octet, Real};
use crate::simd;
use crate::system::label::{Labels, Source};
use crate::system::{
    At, Dynamics, Jacobians, Purpose, Samples, Staged, System, feedback_jacobians, name,
    scalar_time,
};
use crate::time::Time;
use nalgebra::SMatrix;

/// The number of parts into which steps with more terms than are [`KNOWN`] are divided. They are
/// Taylor polynomials, whose steps may be twice as long as those of eight nodes.
const PARTS: usize = 3;

/// The quantity by which a column is the derivative.
#[derive(Clone, Copy, PartialEq)]
enum By {
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
}

impl<T: Float, const N: usize> Solution<T, N> {
    /// Returns the derivatives of the motion by initial values or parameters, named as in the
    /// block: `"θ"` is the initial coordinate, `"θ̇"` or `"theta_dot"` the initial velocity, `"b"` or
    /// `"c.x"` a parameter. For each name there is a state at each output time, whose `q` and `v`
    /// are the derivatives of the coordinates and of the velocities.
    ///
    /// The run needs [`dense`](crate::integrate::Solve::dense). The derivatives are as accurate as
    /// the run, and do not change its steps. Motions of driven inputs are not varied. The derivatives
    /// of a feedback law, which has to be smooth, are differences, good to ten digits; a sampled
    /// controller does not compile. Neither do limits and dry frictions. Where a `sign`, or a `min`
    /// in a potential, makes the accelerations jump, the derivatives jump with them, to ten digits
    /// (Aizerman and Gantmacher 1958).
    ///
    /// If a constraint of positions or velocities does not hold for a varied start, as that of a
    /// rod whose length is the parameter, the start moves to fulfil it, by the shortest way in the
    /// metric of the mass matrix.
    ///
    /// ```
    /// use pendulum_runtime::prelude::*;
    ///
    /// # mod system {
    /// pendulum_runtime::lagrangian! {
    ///     pub struct Spring { k, m }
    ///     coordinate x;
    ///     kinetic = m*ẋ^2/2;
    ///     potential = k*x^2/2;
    /// }
    /// # }
    /// # use system::Spring;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let spring = Spring::new(4.0, 1.0);
    /// let run = solve(&spring, (0.0, 1.0), [1.0], [0.0]).rtol(1e-12).dense().run()?;
    /// let [by_k, by_start] = run.sensitivities(&spring, ["k", "x"])?;
    /// // x = cos ωt with ω² = k/m.
    /// assert!((by_k[0].q[0] + 2.0_f64.sin() / 4.0).abs() < 1e-10);
    /// assert!((by_start[0].q[0] - 2.0_f64.cos()).abs() < 1e-10);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Returns an error for a name that the system has not, for a run without dense output, if the
    /// action of an event has changed the state, if a step of fixed length passes two changes of
    /// sign, and if a derivative is not finite.
    pub fn sensitivities<D, const K: usize>(
        &self,
        dynamics: &D,
        names: [&str; K],
    ) -> Result<[Vec<State<T, N>>; K], ColumnError>
    where
        D: Dynamics<N, Scalar = T, System: Jacobians<N>>,
    {
        const {
            assert!(
                !D::SAMPLED,
                "the derivatives of a sampled controller are not known: take differences of two runs"
            );
            let facts = &<D::System as System<N>>::FACTS;
            assert!(
                facts.limits.is_empty(),
                "sensitivities jump where a limit strikes, which is not written yet: leave the limits out, or take differences of two runs"
            );
            assert!(
                facts.frictions.is_empty(),
                "sensitivities jump where a dry friction begins to stick, which is not written yet: leave the frictions out, or write `dissipation` or a force with `tanh(rate/eps)`"
            );
            assert!(
                facts.states == 0,
                "the sensitivities of a `state` follow its rate, which is not written yet: give it by a coordinate with an inertia"
            );
        };
        let labels = Source::Facts(const { &<D::System as System<N>>::FACTS }).labels(N);
        let mut by = [By::Coordinate(0); K];
        for (by, wanted) in by.iter_mut().zip(names) {
            *by = find::<D, N>(&labels, wanted)?;
        }
        let first = names.first().copied().unwrap_or_default();
        let dense = self.dense.as_ref().ok_or_else(|| ColumnError::not_dense(first))?;
        if self.events.iter().any(|event| {
            (event.state.q, event.state.v) != (event.after.q, event.after.v)
                && event.time.to_f64() != self.end.t
        }) {
            return Err(ColumnError::action(first));
        }
        let varied = Varied::new(dynamics, by);
        let rule = Rule::new();
        let mut columns = varied.start(dense.start());
        let mut all: [Vec<State<T, N>>; K] =
            core::array::from_fn(|_| Vec::with_capacity(self.t.len()));
        let mut put = |t: f64, columns: &[Column<T, N>; K]| {
            for (states, [q, v]) in all.iter_mut().zip(columns) {
                states.push(State { t, q: *q, v: *v });
            }
        };
        let mut times = self.t.iter().copied().peekable();
        while let Some(t) = times.next_if_eq(&dense.start().t) {
            put(t, &columns);
        }
        let mut switches = Switches::new::<D, N>();
        for step in dense.steps() {
            let jump = switches.jump(dynamics, &step).map_err(|index| {
                ColumnError::jumps(first, <D::System as System<N>>::FACTS.switches[index])
            })?;
            if let Some(passing) = jump {
                varied.jump(&passing, step.interval.side(), &mut columns);
            }
            let (end, h) = (step.interval.end.to_f64(), step.interval.h);
            let parts = if step.terms() <= KNOWN { 1 } else { PARTS };
            for index in 0..parts {
                let part = Part { step: &step, index, parts };
                let solved = varied.solve(&rule, &part, &columns);
                while let Some(t) = times
                    .next_if(|t| (end - t) * h > 0.0 && (index + 1 == parts || part.contains(*t)))
                {
                    put(t, &rule.at(part.fraction(t), &part, &columns, &solved));
                }
                columns = rule.at(T::from_f64(1.0), &part, &columns, &solved);
            }
            // Of two output times at a kink, the first is before the kink.
            let first = times.next_if_eq(&end);
            if let (Some(t), Some(_)) = (first, times.peek().filter(|next| **next == end)) {
                put(t, &columns);
            }
            let single = first.filter(|_| times.peek() != Some(&end));
            columns = varied.across_kink(&step, columns);
            if let Some(t) = single {
                put(t, &columns);
            }
            while let Some(t) = times.next_if_eq(&end) {
                put(t, &columns);
            }
        }
        let finite = |states: &Vec<State<T, N>>| {
            states.iter().all(|state| state.q.iter().chain(&state.v).all(|x| x.is_finite()))
        };
        match names.iter().zip(&all).find(|(_, states)| !finite(states)) {
            Some((name, _)) => Err(ColumnError::not_finite(name)),
            None => Ok(all),
        }
    }
}

/// Returns the initial value or the parameter with this name.
fn find<D: Dynamics<N>, const N: usize>(labels: &Labels, wanted: &str) -> Result<By, ColumnError> {
    let parameters = <D::System as System<N>>::FACTS.parameters;
    let read = name::read(wanted);
    let place = |names: &mut dyn Iterator<Item = &str>| {
        names.enumerate().find(|(_, name)| name::read(name) == read).map(|(index, _)| index)
    };
    let of = |labels: &[crate::system::label::Label]| {
        place(&mut labels.iter().map(|label| label.name.as_str()))
    };
    if let Some(index) = place(&mut parameters.iter().copied()) {
        return Ok(By::Parameter(index));
    }
    if let Some(index) = of(&labels.coordinates) {
        return Ok(By::Coordinate(index));
    }
    if let Some(index) = of(&labels.velocities) {
        return Ok(By::Velocity(index));
    }
    let names = parameters.iter().copied().chain(labels.names().skip(1));
    Err(ColumnError::new(wanted, names, ""))
}

/// Dynamics with the quantities by which they are varied.
struct Varied<'d, D, const N: usize, const K: usize>
where
    D: Dynamics<N, Scalar: Float, System: Jacobians<N>>,
{
    dynamics: &'d D,
    by: [By; K],
    /// For each column the system over dual numbers, in which its parameter varies.
    systems: [Lifted<D, N>; K],
    /// The system over the nodes, and for each column that over dual numbers.
    wide: Wide<D, N>,
    wide_systems: [WideLifted<D, N>; K],
    prepared: [<WideLifted<D, N> as System<N>>::Prepared; K],
}

type ScalarOf<D, const N: usize> = <D as Dynamics<N>>::Scalar;
type Lifted<D, const N: usize> =
    <<D as Dynamics<N>>::System as Jacobians<N>>::Over<Dual<ScalarOf<D, N>>>;
type LiftedInputs<D, const N: usize> = <Lifted<D, N> as System<N>>::Inputs;
type Wide<D, const N: usize> =
    <<D as Dynamics<N>>::System as Jacobians<N>>::Over<Octet<ScalarOf<D, N>>>;
type WideInputs<D, const N: usize> = <Wide<D, N> as System<N>>::Inputs;
type WideLifted<D, const N: usize> =
    <Wide<D, N> as Jacobians<N>>::Over<Dual<Octet<ScalarOf<D, N>>>>;

impl<'d, D, T, const N: usize, const K: usize> Varied<'d, D, N, K>
where
    T: Float,
    D: Dynamics<N, Scalar = T, System: Jacobians<N>>,
{
    fn new(dynamics: &'d D, by: [By; K]) -> Self {
        let wide = dynamics.system().over(Octet::splat);
        let systems = by.map(|by| dynamics.system().over(varied(by)));
        let wide_systems = by.map(|by| wide.over(varied(by)));
        let prepared = core::array::from_fn(|k| wide_systems[k].prepare());
        Self { dynamics, by, systems, wide, wide_systems, prepared }
    }

    /// Returns the columns at the start.
    fn start(&self, start: &State<T, N>) -> [Column<T, N>; K] {
        let unit = |on: Option<usize>| {
            core::array::from_fn(|i| T::from_f64(if on == Some(i) { 1.0 } else { 0.0 }))
        };
        core::array::from_fn(|k| {
            let column = match self.by[k] {
                By::Coordinate(index) => [unit(Some(index)), unit(None)],
                By::Velocity(index) => [unit(None), unit(Some(index))],
                By::Parameter(_) => [unit(None), unit(None)],
            };
            let t = Time::new(start.t);
            self.onto_constraints(t, Side::After, start, k, column)
        })
    }

    /// Returns `of` the system over dual numbers, at a state that is varied along a column.
    fn along<R>(
        &self,
        k: usize,
        (t, q, v): (Time, &[T; N], &[T; N]),
        column: &Column<T, N>,
        inputs: &InputsOf<D, N>,
        of: impl FnOnce(&Lifted<D, N>, At<'_, Dual<T>, LiftedInputs<D, N>, N>) -> R,
    ) -> R {
        let inputs = inputs.map(Dual::constant);
        let lift = |values: &[T; N], derivatives: &[T; N]| {
            core::array::from_fn(|i| Dual { value: values[i], derivative: derivatives[i] })
        };
        let [by_q, by_v] = column;
        let t = Dual::constant(scalar_time(t));
        of(&self.systems[k], At { t, q: &lift(q, by_q), v: &lift(v, by_v), inputs: &inputs })
    }

    /// Changes the columns where the accelerations jump: a varied motion passes the zero of the
    /// switch s earlier by δs/ṡ.
    fn jump(&self, passing: &Passing<T, N>, side: Side, columns: &mut [Column<T, N>; K]) {
        let Passing { index, near: Endpoint { t, q, v, .. }, rate, jump } = passing;
        let (q, v) = (&q.high, &v.high);
        let inputs = self.dynamics.inputs_with(*t, side, Purpose::Accelerations, q, v);
        let mut values = vec![Dual::constant(T::from_f64(0.0)); index + 1];
        for (k, column) in columns.iter_mut().enumerate() {
            self.along(k, (*t, q, v), column, &inputs, |system, at| {
                system.arguments(at, &mut values);
            });
            let earlier = values[*index].derivative / *rate;
            for i in 0..N {
                column[1][i] += jump[i] * earlier;
            }
        }
    }

    /// Changes a column such that the varied state fulfils the constraints.
    fn onto_constraints(
        &self,
        t: Time,
        side: Side,
        State { q, v, .. }: &State<T, N>,
        k: usize,
        mut column: Column<T, N>,
    ) -> Column<T, N> {
        if <D::System as System<N>>::FACTS.held_constraints() == 0 {
            return column;
        }
        let inputs = self.dynamics.inputs(t, side, Purpose::Momenta);
        let at = At { t: scalar_time(t), q, v, inputs: &inputs };
        // The rates depend on the coordinates, which are corrected first.
        for part in 0..2 {
            let misfits = self.along(k, (t, q, v), &column, &inputs, System::misfits);
            let misfit = misfits[part].map(|misfit| misfit.derivative);
            let change = self.dynamics.system().correction(at, &misfit);
            for i in 0..N {
                column[part][i] -= change[i];
            }
        }
        column
    }

    /// Returns the columns on the far side of the end of a step. The derivatives of the momenta are
    /// the same on both sides, as are the momenta.
    fn across_kink(
        &self,
        step: &DenseStep<'_, T, N>,
        mut columns: [Column<T, N>; K],
    ) -> [Column<T, N>; K] {
        if <D::System as System<N>>::FACTS.inputs.is_empty() {
            return columns;
        }
        let (t, far) = (step.interval.end, step.interval.side());
        let [near, beyond] =
            [far.opposite(), far].map(|side| self.dynamics.inputs(t, side, Purpose::Momenta));
        if near == beyond {
            return columns;
        }
        let (q, v) = step.at(T::from_f64(1.0));
        for (k, column) in columns.iter_mut().enumerate() {
            let v_beyond = self.along(k, (t, &q, &v), column, &near, |system, at| {
                let inputs = beyond.map(Dual::constant);
                system.velocities(at.t, at.q, &system.momenta(at), &inputs)
            });
            column[1] = v_beyond.map(|v| v.derivative);
            let state = State { t: t.to_f64(), q, v: v_beyond.map(|v| v.value) };
            *column = self.onto_constraints(t, far, &state, k, *column);
        }
        columns
    }

    /// Returns the accelerations of the columns at the nodes of a part of a step.
    fn solve(
        &self,
        rule: &Rule<T>,
        part: &Part<'_, T, N>,
        columns: &[Column<T, N>; K],
    ) -> [Nodes<T, N>; K] {
        let mut accelerations = [[Octet::splat(T::from_f64(0.0)); N]; K];
        simd::wide(Collocation { varied: self, rule, part, columns, a: &mut accelerations });
        accelerations
    }

    /// Returns the coefficients of the equations at the nodes of a part of a step.
    #[inline(always)]
    fn equations(&self, rule: &Rule<T>, part: &Part<'_, T, N>) -> Equations<T, N, K> {
        let zero = Octet::splat(T::from_f64(0.0));
        let [q, v] = part.at_nodes(rule);
        let mut t = rule.nodes;
        let mut samples: [InputsOf<D, N>; NODES] = [Samples::zero(); NODES];
        // Other dynamics do not use the times.
        if D::FEEDBACK || !<D::System as System<N>>::FACTS.autonomous {
            for node in 0..NODES {
                let theta = part.of_step(rule.nodes.0[node]).to_f64();
                let (time, side) = part.step.interval.at(theta);
                t.0[node] = scalar_time(time);
                let (q, v) = (q.map(|q| q.0[node]), v.map(|v| v.0[node]));
                samples[node] =
                    self.dynamics.inputs_with(time, side, Purpose::Accelerations, &q, &v);
            }
        }
        let inputs = side_by_side::<D, N>(&samples);
        let at = At { t, q: &q, v: &v, inputs: &inputs };
        let matrix = |all: SMatrix<Octet<T>, N, N>| {
            core::array::from_fn(|i| core::array::from_fn(|j| all[(i, j)]))
        };
        let by_q = matrix(self.wide.position_jacobian(at));
        let by_v = if <D::System as System<N>>::FACTS.velocity_free {
            [[zero; N]; N]
        } else {
            matrix(self.wide.velocity_jacobian(at))
        };
        let mut equations = Equations { h: part.length(), by_q, by_v, constant: [[zero; N]; K] };
        if D::FEEDBACK {
            for node in 0..NODES {
                let (time, _) = part.step.interval.at(part.of_step(rule.nodes.0[node]).to_f64());
                let (q, v) = (q.map(|q| q.0[node]), v.map(|v| v.0[node]));
                let at = At { t: t.0[node], q: &q, v: &v, inputs: &samples[node] };
                let [by_q, by_v] = feedback_jacobians(self.dynamics, time, at);
                for i in 0..N {
                    for j in 0..N {
                        equations.by_q[i][j].0[node] += by_q[(i, j)];
                        equations.by_v[i][j].0[node] += by_v[(i, j)];
                    }
                }
            }
        }
        let lifted = inputs.map(Dual::constant);
        let (q, v) = (q.map(Dual::constant), v.map(Dual::constant));
        let at = At { t: Dual::constant(t), q: &q, v: &v, inputs: &lifted };
        for k in 0..K {
            if let By::Parameter(_) = self.by[k] {
                let (system, prepared) = (&self.wide_systems[k], &self.prepared[k]);
                let At { t, q, v, inputs } = at;
                let times = WideLifted::<D, N>::at_time(t, inputs);
                let positions = system.at_position(prepared, &times, t, q, inputs);
                let a = system.accelerations_staged(prepared, &times, &positions, t, q, v, inputs);
                equations.constant[k] = a.map(|a| a.derivative);
            }
        }
        equations
    }
}

/// Returns the map that makes the parameter by which a column is the derivative a variable.
fn varied<T: Real>(by: By) -> impl FnMut(T) -> Dual<T> {
    let mut index = 0;
    move |value| {
        index += 1;
        if by == By::Parameter(index - 1) { Dual::variable(value) } else { Dual::constant(value) }
    }
}

/// Returns the samples of the inputs at all nodes in lanes.
#[inline(always)]
fn side_by_side<D, const N: usize>(samples: &[InputsOf<D, N>; NODES]) -> WideInputs<D, N>
where
    D: Dynamics<N, Scalar: Float, System: Jacobians<N>>,
{
    let number = |node: usize, input, derivative, component| {
        let number = samples[node].number(input, derivative, component);
        number.copied().unwrap_or(D::Scalar::from_f64(0.0))
    };
    Samples::from_numbers(&mut |input, derivative, component| {
        Octet(core::array::from_fn(|node| number(node, input, derivative, component)))
    })
}

/// The collocation of all columns in a part of a step.
struct Collocation<'a, 'd, D, const N: usize, const K: usize>
where
    D: Dynamics<N, Scalar: Float, System: Jacobians<N>>,
{
    varied: &'a Varied<'d, D, N, K>,
    rule: &'a Rule<D::Scalar>,
    part: &'a Part<'a, D::Scalar, N>,
    columns: &'a [Column<D::Scalar, N>; K],
    /// The accelerations of the columns at the nodes.
    a: &'a mut [Nodes<D::Scalar, N>; K],
}

impl<D, T, const N: usize, const K: usize> simd::Work for Collocation<'_, '_, D, N, K>
where
    T: Float,
    D: Dynamics<N, Scalar = T, System: Jacobians<N>>,
{
    #[inline(always)]
    fn run(self) {
        let Self { varied, rule, part, columns, a } = self;
        varied.equations(rule, part).solve(rule, columns, a);
    }
}
