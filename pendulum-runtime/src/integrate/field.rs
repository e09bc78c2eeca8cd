//! The accelerations as the methods see them: counted, or watched for numbers that are not finite.

use crate::error::{Coordinate, Quantity};
use crate::motion::Side;
use crate::real::Float;
use crate::system::{Dynamics, Facts, Purpose, Samples, System, scalar_time};
use crate::time::Time;

/// q̈ as a function of time and state: what a method integrates.
pub trait Accelerations<T, const N: usize> {
    /// The accelerations at `t`, seen from `side`.
    fn at(&mut self, t: Time, side: Side, q: &[T; N], v: &[T; N]) -> [T; N];
}

/// The accelerations of some dynamics, with the number of evaluations.
#[derive(Debug)]
pub struct Counted<'a, D> {
    pub(crate) dynamics: &'a D,
    pub(crate) evaluations: u64,
}

impl<'a, D> Counted<'a, D> {
    /// None evaluated yet.
    pub fn new(dynamics: &'a D) -> Self {
        Self { dynamics, evaluations: 0 }
    }
}

impl<const N: usize, D: Dynamics<N>> Accelerations<D::Scalar, N> for Counted<'_, D> {
    #[inline]
    fn at(&mut self, t: Time, side: Side, q: &[D::Scalar; N], v: &[D::Scalar; N]) -> [D::Scalar; N] {
        self.evaluations += 1;
        self.dynamics.accelerations_at(t, side, q, v)
    }
}

/// The accelerations of some dynamics and the first number in them, or on the way to them, that is not finite.
///
/// A failed step is taken once more through this to find out where it failed, so that successful ones need not look.
#[derive(Debug)]
pub(crate) struct Watched<'a, D> {
    pub(crate) dynamics: &'a D,
    pub(crate) first: Option<(Time, Quantity)>,
}

impl<const N: usize, D: Dynamics<N, Scalar: Float>> Accelerations<D::Scalar, N> for Watched<'_, D> {
    fn at(&mut self, t: Time, side: Side, q: &[D::Scalar; N], v: &[D::Scalar; N]) -> [D::Scalar; N] {
        let facts = &<D::System as System<N>>::FACTS;
        let inputs = self.dynamics.inputs(t, side, Purpose::Accelerations);
        let a = self.dynamics.system().accelerations(scalar_time(t), q, v, &inputs);
        if self.first.is_none() {
            self.first = first_in_state(facts, q, v)
                .or_else(|| first_in_inputs(facts, &inputs))
                .or_else(|| first_in(&a).map(|index| Quantity::Acceleration(coordinate(facts, index))))
                .map(|what| (t, what));
        }
        a
    }
}

/// The coordinate with this index.
pub(crate) fn coordinate(facts: &Facts, index: usize) -> Coordinate {
    Coordinate { index, name: facts.coordinates.get(index).copied().unwrap_or("") }
}

/// The first component of the state that is not finite.
pub(crate) fn first_in_state<T: Float, const N: usize>(facts: &Facts, q: &[T; N], v: &[T; N]) -> Option<Quantity> {
    let position = first_in(q).map(|index| Quantity::Position(coordinate(facts, index)));
    position.or_else(|| first_in(v).map(|index| Quantity::Velocity(coordinate(facts, index))))
}

/// The first component of a driven input that is not finite.
pub(crate) fn first_in_inputs(facts: &Facts, inputs: &impl Samples) -> Option<Quantity> {
    let (input, derivative, component) = inputs.first_not_finite()?;
    let name = facts.inputs.get(input).map_or("", |input| input.name);
    Some(Quantity::Input { name, component, derivative })
}

fn first_in<T: Float, const N: usize>(values: &[T; N]) -> Option<usize> {
    values.iter().position(|value| !value.is_finite())
}
