//! Evaluation of the derived equations at a state, by the program that would be emitted.

use crate::algebra::expr::{Graph, Id, Moment, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use crate::model::{Model, Quantity};
use crate::schedule::{self, Op};
use pendulum_runtime::scalar::Real;
use random_systems::reference::State;

/// The values of all symbols of a block.
#[derive(Clone, Debug)]
pub(crate) struct Values<T> {
    pub(crate) parameters: Vec<T>,
    pub(crate) time: T,
    pub(crate) q: Vec<T>,
    pub(crate) v: Vec<T>,
    pub(crate) p: Vec<T>,
    /// All orders, by input and component.
    pub(crate) inputs: Vec<Vec<[T; 4]>>,
}

impl<T: Real> Values<T> {
    pub(crate) fn new(state: &State<T>) -> Self {
        Self {
            parameters: state.constants.parameters.clone(),
            time: state.t,
            q: state.q.clone(),
            v: state.v.clone(),
            p: Vec::new(),
            inputs: state.inputs.clone(),
        }
    }

    fn symbol(&self, symbol: Symbol, model: &Model) -> T {
        match symbol {
            Symbol::Parameter(index) => self.parameters[index],
            Symbol::Time => self.time,
            Symbol::Coordinate(index) => self.q[index],
            Symbol::Velocity(index) => self.v[index],
            Symbol::Momentum(index) => self.p[index],
            Symbol::Input { input, component, order } => {
                self.inputs[input][component][usize::from(order)]
            }
            Symbol::Moment(first, moment) => {
                debug_assert!(
                    model
                        .parameters
                        .iter()
                        .any(|quantity: &Quantity| quantity.is_body() && quantity.first == first)
                );
                let [m, x, y, xx, xy, yy] =
                    [0, 1, 2, 3, 4, 5].map(|offset| self.parameters[first + offset]);
                let (xx, xy, yy) = (xx + m * x * x, xy + m * x * y, yy + m * y * y);
                match moment {
                    Moment::Inertia => xx + yy,
                    Moment::Difference => xx - yy,
                    Moment::Product => xy,
                    Moment::About(_) | Moment::Mixed(_) => panic!("random systems have no solids"),
                }
            }
            Symbol::Control { input, component } => self.inputs[input][component][0],
            Symbol::Target(index) => self.p[index],
            Symbol::Auxiliary(_)
            | Symbol::Position(_)
            | Symbol::Entry(..)
            | Symbol::Point(..)
            | Symbol::Acceleration(_)
            | Symbol::Multiplier(_)
            | Symbol::Contact(_)
            | Symbol::Friction(_) => {
                panic!("{symbol:?} is left over")
            }
        }
    }

    /// Returns the values of some outputs.
    pub(crate) fn of(&self, model: &Model, graph: &Graph, roots: &[Id]) -> Vec<T> {
        let program = schedule::of_derivatives(graph, roots);
        let mut known: Vec<(T, T)> = Vec::with_capacity(program.ops.len());
        let zero = T::from_f64(0.0);
        for op in &program.ops {
            let at = |place: schedule::Place| known[place.0].0;
            let value = match *op {
                Op::Number(value) | Op::Literal(Literal::Exact(value)) => ratio(value),
                Op::Literal(Literal::Decimal(ref digits)) => {
                    T::from_f64(digits.parse().expect("a number"))
                }
                Op::Pi => T::pi(),
                Op::Load(symbol) => self.symbol(symbol, model),
                Op::Negative(a) => -at(a),
                Op::Add(a, b) => at(a) + at(b),
                Op::Sub(a, b) => at(a) - at(b),
                Op::Mul(a, b) => at(a) * at(b),
                Op::Div(a, b) => at(a) / at(b),
                Op::Sqrt(a) => at(a).sqrt(),
                Op::Powf(a, b) => at(a).powf(at(b)),
                Op::Atan2(y, x) => at(y).atan2(at(x)),
                Op::Max(a, b) => at(a).max(at(b)),
                Op::Call(function, a) => function.of(at(a)),
                Op::SinCos(a) => {
                    known.push(at(a).sin_cos());
                    continue;
                }
                Op::Part(Function::Sin, pair) => known[pair.0].0,
                Op::Part(_, pair) => known[pair.0].1,
            };
            known.push((value, zero));
        }
        program.results.iter().map(|result| known[result.0].0).collect()
    }
}

/// Converts an exact number to the scalar, split into parts that are exact in `f64`.
fn ratio<T: Real>(value: Rational) -> T {
    whole::<T>(value.numerator()) / whole(value.denominator())
}

fn whole<T: Real>(value: i128) -> T {
    let (magnitude, mask) = (value.unsigned_abs(), (1u128 << 43) - 1);
    let parts = [magnitude >> 86, (magnitude >> 43) & mask, magnitude & mask];
    let scale = T::from_f64((1u64 << 43) as f64);
    let sum = parts
        .into_iter()
        .fold(T::from_f64(0.0), |sum, part| sum * scale + T::from_f64(part as f64));
    if value < 0 { -sum } else { sum }
}
