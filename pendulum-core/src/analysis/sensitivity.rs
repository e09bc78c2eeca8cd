//! Sensitivities of a motion that has been integrated.
//!
//! The derivative of a motion by a parameter or by its initial state obeys a linear equation, δq̈ =
//! A δq + B δq̇ + c, whose coefficients are known once the motion is known. It is solved after the
//! run, along its dense output, by collocation at Radau's nodes: A, B and c are evaluated once at each
//! node, and every further column costs a solution of the same linear equations. The alternative,
//! [`Variational`](super::Variational), evaluates them in every stage of the run, and the number of
//! its columns is part of the type.

use super::jump::Switches;
use super::radau::{NODES, Rule, advanced};
use crate::integrate::ColumnError;
use crate::integrate::Solution;
use crate::integrate::State;
use crate::integrate::interpolant::dense::DenseStep;
use crate::integrate::linear::Factors;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::passing::Passing;
use crate::motion::Side;
use crate::scalar::{Dual, Float};
use crate::system::label::{Labels, Source};
use crate::system::{
    At, Dynamics, Jacobians, Purpose, System, feedback_jacobians, name, scalar_time,
};
use crate::time::Time;

/// The largest number of terms for which few nodes suffice.
const FEW: usize = 8;

/// The largest number of terms of a step that is not divided. Only Taylor polynomials have more, and
/// their steps may be twice as long as those of eight nodes.
const MANY: usize = 18;

/// The number of parts into which longer steps are divided.
const PARTS: usize = 3;

/// The most coordinates for which the equations of the nodes are solved by elimination at once. It
/// serves all columns; for two coordinates it takes as long as the sweeps of two of them.
const ELIMINATED: usize = 2;

/// The most sweeps of the iteration before the equations are solved by elimination. Where a step
/// of the motion converges within seven sweeps, the columns converge to rounding within twice as
/// many.
const SWEEPS: usize = 24;

/// The quantity by which a column is the derivative.
#[derive(Clone, Copy, PartialEq)]
enum By {
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
}

/// The derivatives of the coordinates and of the velocities.
pub(super) type Column<T, const N: usize> = [[T; N]; 2];

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
                "the derivatives of a sampled controller are not known: use a law in continuous time"
            );
            let facts = &<D::System as System<N>>::FACTS;
            assert!(
                facts.limits.is_empty(),
                "sensitivities jump where a limit strikes, which is not written yet: leave the limits out"
            );
            assert!(
                facts.frictions.is_empty(),
                "sensitivities jump where a dry friction begins to stick, which is not written yet: leave the frictions out"
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
        let (few, many) = (Rule::<T, { NODES[0] }>::new(), Rule::<T, { NODES[1] }>::new());
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
            let parts = if step.terms() <= MANY { 1 } else { PARTS };
            for index in 0..parts {
                let part = Part { step: &step, index, parts };
                let mut within = |at: &dyn Fn(T) -> [Column<T, N>; K]| {
                    while let Some(t) = times.next_if(|t| {
                        (end - t) * h > 0.0 && (index + 1 == parts || part.contains(*t))
                    }) {
                        put(t, &at(part.fraction(t)));
                    }
                    at(T::from_f64(1.0))
                };
                columns = if step.terms() <= FEW {
                    let solved = varied.solve(&few, &part, &columns);
                    within(&|theta| few.at(theta, &part, &columns, &solved))
                } else {
                    let solved = varied.solve(&many, &part, &columns);
                    within(&|theta| many.at(theta, &part, &columns, &solved))
                };
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

/// One of several parts of equal length of a step.
pub(super) struct Part<'a, T, const N: usize> {
    step: &'a DenseStep<'a, T, N>,
    index: usize,
    parts: usize,
}

impl<T: Float, const N: usize> Part<'_, T, N> {
    /// Returns the length in seconds.
    pub(super) fn length(&self) -> T {
        self.step.interval.length::<T>() / T::from_f64(self.parts as f64)
    }

    /// Returns the fraction of the step that has passed when θ of the part has.
    fn of_step(&self, theta: T) -> T {
        (T::from_f64(self.index as f64) + theta) / T::from_f64(self.parts as f64)
    }

    /// Returns the fraction of the part that has passed at `t`.
    fn fraction(&self, t: f64) -> T {
        let passed = self.step.interval.fraction::<T>(t);
        passed * T::from_f64(self.parts as f64) - T::from_f64(self.index as f64)
    }

    /// Returns `true` if the part does not end before `t`.
    fn contains(&self, t: f64) -> bool {
        self.fraction(t) <= T::from_f64(1.0)
    }

    /// Returns the coordinates and the velocities at a node.
    fn at<const S: usize>(&self, rule: &Rule<T, S>, node: usize) -> ([T; N], [T; N]) {
        if self.parts == 1 {
            return self.step.where_known(&rule.functions[node]);
        }
        self.step.at(self.of_step(rule.nodes[node]))
    }
}

/// Dynamics with the quantities by which they are varied.
struct Varied<'d, D, const N: usize, const K: usize>
where
    D: Dynamics<N, System: Jacobians<N>>,
{
    dynamics: &'d D,
    by: [By; K],
    /// For each column the system over dual numbers, in which its parameter varies.
    systems: [Lifted<D, N>; K],
    prepared: [<Lifted<D, N> as System<N>>::Prepared; K],
}

type Lifted<D, const N: usize> = <<D as Dynamics<N>>::System as Jacobians<N>>::Over<
    Dual<<<D as Dynamics<N>>::System as System<N>>::Scalar>,
>;
type InputsOf<D, const N: usize> = <<D as Dynamics<N>>::System as System<N>>::Inputs;
type LiftedInputs<D, const N: usize> = <Lifted<D, N> as System<N>>::Inputs;

impl<'d, D, T, const N: usize, const K: usize> Varied<'d, D, N, K>
where
    T: Float,
    D: Dynamics<N, Scalar = T, System: Jacobians<N>>,
{
    fn new(dynamics: &'d D, by: [By; K]) -> Self {
        let systems = by.map(|by| {
            let mut index = 0;
            dynamics.system().over(|value| {
                index += 1;
                if by == By::Parameter(index - 1) {
                    Dual::variable(value)
                } else {
                    Dual::constant(value)
                }
            })
        });
        let prepared = core::array::from_fn(|k| systems[k].prepare());
        Self { dynamics, by, systems, prepared }
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
        let inputs = <D::System as Jacobians<N>>::inputs_over(inputs, Dual::constant);
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
                let inputs = <D::System as Jacobians<N>>::inputs_over(&beyond, Dual::constant);
                system.velocities(at.t, at.q, &system.momenta(at), &inputs)
            });
            column[1] = v_beyond.map(|v| v.derivative);
            let state = State { t: t.to_f64(), q, v: v_beyond.map(|v| v.value) };
            *column = self.onto_constraints(t, far, &state, k, *column);
        }
        columns
    }

    /// Returns the accelerations of the columns at the nodes of a step.
    fn solve<const S: usize>(
        &self,
        rule: &Rule<T, S>,
        part: &Part<'_, T, N>,
        columns: &[Column<T, N>; K],
    ) -> [[[T; N]; S]; K] {
        let zero = T::from_f64(0.0);
        let mut equations =
            Equations { h: part.length(), by_q: [[[zero; N]; N]; S], by_v: [[[zero; N]; N]; S] };
        let mut constant = [[[zero; N]; S]; K];
        for node in 0..S {
            let (q, v) = part.at(rule, node);
            let (t, side) = part.step.interval.at(part.of_step(rule.nodes[node]).to_f64());
            let inputs = self.dynamics.inputs_with(t, side, Purpose::Accelerations, &q, &v);
            let at = At { t: scalar_time(t), q: &q, v: &v, inputs: &inputs };
            let system = self.dynamics.system();
            let mut by_q = system.position_jacobian(at);
            let mut by_v = (!<D::System as System<N>>::FACTS.velocity_free)
                .then(|| system.velocity_jacobian(at));
            if D::FEEDBACK {
                let [more_by_q, more_by_v] = feedback_jacobians(self.dynamics, t, at);
                by_q += more_by_q;
                by_v = Some(by_v.map_or(more_by_v, |by_v| by_v + more_by_v));
            }
            for i in 0..N {
                for j in 0..N {
                    equations.by_q[node][i][j] = by_q[(i, j)];
                    equations.by_v[node][i][j] = by_v.as_ref().map_or(zero, |by_v| by_v[(i, j)]);
                }
            }
            for k in 0..K {
                if let By::Parameter(_) = self.by[k] {
                    let still = [[zero; N]; 2];
                    let found = self.along(k, (t, &q, &v), &still, &inputs, |system, at| {
                        system.accelerations_prepared(&self.prepared[k], at)
                    });
                    constant[k][node] = found.map(|a| a.derivative);
                }
            }
        }
        let mut factors = None;
        core::array::from_fn(|k| {
            let next = |a: &[[T; N]; S]| equations.swept(rule, &columns[k], a, &constant[k]);
            if ELIMINATED < N
                && factors.is_none()
                && let Some(found) = iterated(next, constant[k])
            {
                return found;
            }
            let factors = factors.get_or_insert_with(|| equations.factors(rule));
            let mut a = next(&[[zero; N]; S]);
            factors.solve(&mut a);
            a
        })
    }
}

/// Returns the fixed point of `next`; `None` if the iteration does not converge fast.
fn iterated<T: Float, const N: usize, const S: usize>(
    next: impl Fn(&[[T; N]; S]) -> [[T; N]; S],
    mut a: [[T; N]; S],
) -> Option<[[T; N]; S]> {
    let mut last = f64::INFINITY;
    for _ in 0..SWEEPS {
        let new = next(&a);
        let (mut change, mut size) = (0.0f64, 0.0f64);
        for (new, old) in new.as_flattened().iter().zip(a.as_flattened()) {
            change = change.max((*new - *old).abs().to_f64());
            size = size.max(new.abs().to_f64());
        }
        a = new;
        if change <= 4.0 * T::EPSILON.to_f64() * size {
            return Some(a);
        }
        // NaN fails the comparison.
        if !(change < 0.5 * last || last == f64::INFINITY) {
            return None;
        }
        last = change;
    }
    None
}

/// The coefficients of the linear equations at the nodes of a step of length `h`.
struct Equations<T, const N: usize, const S: usize> {
    h: T,
    /// ∂q̈/∂q at each node.
    by_q: [[[T; N]; N]; S],
    /// ∂q̈/∂q̇ at each node.
    by_v: [[[T; N]; N]; S],
}

impl<T: Float, const N: usize, const S: usize> Equations<T, N, S> {
    /// Returns A δq + B δq̇ + c at the nodes, for a column with the accelerations `a`.
    fn swept(
        &self,
        rule: &Rule<T, S>,
        column: &Column<T, N>,
        a: &[[T; N]; S],
        constant: &[[T; N]; S],
    ) -> [[T; N]; S] {
        core::array::from_fn(|node| {
            let weights = (&rule.once[node], &rule.twice[node]);
            let [q, v] = advanced(rule.nodes[node] * self.h, self.h, column, a, weights);
            core::array::from_fn(|i| {
                (0..N).fold(constant[node][i], |sum, j| {
                    sum + self.by_q[node][i][j] * q[j] + self.by_v[node][i][j] * v[j]
                })
            })
        })
    }

    /// Returns the factors of the equations of the accelerations at all nodes.
    fn factors(&self, rule: &Rule<T, S>) -> Factors<T, N, S> {
        Factors::new(|node, of| {
            let square = self.h * self.h * rule.twice[node][of];
            let once = self.h * rule.once[node][of];
            core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let own = T::from_f64(if (node, i) == (of, j) { 1.0 } else { 0.0 });
                    own - square * self.by_q[node][i][j] - once * self.by_v[node][i][j]
                })
            })
        })
    }
}
