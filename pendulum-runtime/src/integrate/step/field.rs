//! The accelerations as the methods see them: counted, or watched for numbers that are not finite.

use crate::error::{Coordinate, Quantity};
use crate::motion::Side;
use crate::real::Float;
use crate::system::{Dynamics, Facts, Jacobians, Purpose, Samples, System, scalar_time};
use crate::time::Time;
use nalgebra::SMatrix;

/// q̈ as a function of time and state: what a method integrates.
pub trait Accelerations<T, const N: usize> {
    /// The accelerations at `t`, seen from `side`.
    fn at(&mut self, t: Time, side: Side, q: &[T; N], v: &[T; N]) -> [T; N];
}

/// All that a method can ask of the system `S` and the motions that drive it.
pub trait Field<S: System<N>, const N: usize>: Accelerations<S::Scalar, N> {
    /// The samples of the driven inputs that the momentum form needs at `t`, seen from `side`.
    fn inputs(&mut self, t: Time, side: Side) -> S::Inputs;

    /// The momenta p = ∂L/∂q̇.
    fn momenta(
        &mut self,
        t: Time,
        q: &[S::Scalar; N],
        v: &[S::Scalar; N],
        inputs: &S::Inputs,
    ) -> [S::Scalar; N];

    /// The velocities that give the momenta `p`.
    fn velocities(
        &mut self,
        t: Time,
        q: &[S::Scalar; N],
        p: &[S::Scalar; N],
        inputs: &S::Inputs,
    ) -> [S::Scalar; N];

    /// dp/dt; counts as an evaluation, together with the velocities.
    fn momentum_rates(
        &mut self,
        t: Time,
        q: &[S::Scalar; N],
        v: &[S::Scalar; N],
        inputs: &S::Inputs,
    ) -> [S::Scalar; N];

    /// The mass matrix M = ∂²L/∂q̇².
    fn mass_matrix(
        &mut self,
        t: Time,
        q: &[S::Scalar; N],
        v: &[S::Scalar; N],
        inputs: &S::Inputs,
    ) -> SMatrix<S::Scalar, N, N>;

    /// ∂q̈/∂q and ∂q̈/∂q̇ at `t`, seen from `side`.
    fn jacobians(
        &mut self,
        t: Time,
        side: Side,
        q: &[S::Scalar; N],
        v: &[S::Scalar; N],
    ) -> [SMatrix<S::Scalar, N, N>; 2]
    where
        S: Jacobians<N>;
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
    fn at(
        &mut self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [D::Scalar; N] {
        self.evaluations += 1;
        self.dynamics.accelerations_at(t, side, q, v)
    }
}

impl<const N: usize, D: Dynamics<N>> Field<D::System, N> for Counted<'_, D> {
    #[inline]
    fn inputs(&mut self, t: Time, side: Side) -> <D::System as System<N>>::Inputs {
        self.dynamics.inputs(t, side, Purpose::Momenta)
    }

    #[inline]
    fn momenta(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> [D::Scalar; N] {
        self.dynamics.system().momenta(scalar_time(t), q, v, inputs)
    }

    #[inline]
    fn velocities(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        p: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> [D::Scalar; N] {
        self.dynamics.system().velocities(scalar_time(t), q, p, inputs)
    }

    #[inline]
    fn momentum_rates(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> [D::Scalar; N] {
        self.evaluations += 1;
        self.dynamics.system().momentum_rates(scalar_time(t), q, v, inputs)
    }

    fn mass_matrix(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> SMatrix<D::Scalar, N, N> {
        self.dynamics.system().mass_matrix(scalar_time(t), q, v, inputs)
    }

    fn jacobians(
        &mut self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [SMatrix<D::Scalar, N, N>; 2]
    where
        D::System: Jacobians<N>,
    {
        jacobians(self.dynamics, t, side, q, v)
    }
}

fn jacobians<const N: usize, D: Dynamics<N, System: Jacobians<N>>>(
    dynamics: &D,
    t: Time,
    side: Side,
    q: &[D::Scalar; N],
    v: &[D::Scalar; N],
) -> [SMatrix<D::Scalar, N, N>; 2] {
    let (system, inputs, t) =
        (dynamics.system(), dynamics.inputs(t, side, Purpose::Accelerations), scalar_time(t));
    [system.position_jacobian(t, q, v, &inputs), system.velocity_jacobian(t, q, v, &inputs)]
}

/// The accelerations of some dynamics and the first number in them, or on the way to them, that is
/// not finite.
///
/// A failed step is taken once more through this to find out where it failed, so that successful
/// ones need not look.
#[derive(Debug)]
pub(crate) struct Watched<'a, D> {
    pub(crate) dynamics: &'a D,
    pub(crate) first: Option<(Time, Quantity)>,
    /// It is a velocity that belongs to a finite momentum: the mass matrix has no inverse there, or
    /// no velocity gives that momentum.
    pub(crate) singular: bool,
    /// The time and the coordinate if it is one that was not found, and not one beyond all numbers.
    pub(crate) lost: Option<(Time, Coordinate)>,
}

impl<const N: usize, D: Dynamics<N, Scalar: Float>> Accelerations<D::Scalar, N> for Watched<'_, D> {
    fn at(
        &mut self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [D::Scalar; N] {
        let facts = &<D::System as System<N>>::FACTS;
        let inputs = self.dynamics.inputs(t, side, Purpose::Accelerations);
        let a = self.dynamics.system().accelerations(scalar_time(t), q, v, &inputs);
        self.look(t, || {
            let state = first_in_state(facts, q, v).or_else(|| first_in_inputs(facts, &inputs));
            state.or_else(|| {
                first_in(&a).map(|index| Quantity::Acceleration(coordinate(facts, index)))
            })
        });
        a
    }
}

impl<'a, D> Watched<'a, D> {
    pub(crate) fn new(dynamics: &'a D) -> Self {
        Self { dynamics, first: None, singular: false, lost: None }
    }

    fn look(&mut self, t: Time, what: impl FnOnce() -> Option<Quantity>) {
        if self.first.is_none() {
            self.first = what().map(|what| (t, what));
        }
    }
}

impl<const N: usize, D: Dynamics<N, Scalar: Float>> Field<D::System, N> for Watched<'_, D> {
    fn inputs(&mut self, t: Time, side: Side) -> <D::System as System<N>>::Inputs {
        let inputs = self.dynamics.inputs(t, side, Purpose::Momenta);
        self.look(t, || first_in_inputs(&<D::System as System<N>>::FACTS, &inputs));
        inputs
    }

    fn momenta(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> [D::Scalar; N] {
        self.look(t, || first_in_state(&<D::System as System<N>>::FACTS, q, v));
        self.dynamics.system().momenta(scalar_time(t), q, v, inputs)
    }

    fn velocities(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        p: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> [D::Scalar; N] {
        let v = self.dynamics.system().velocities(scalar_time(t), q, p, inputs);
        self.singular |= self.first.is_none()
            && first_in(p).is_none()
            && first_in(q).is_none()
            && first_in(&v).is_some();
        if self.singular && self.lost.is_none() && self.first.is_none() {
            let facts = &<D::System as System<N>>::FACTS;
            // Only what is no number has no order.
            self.lost = v
                .iter()
                .position(|velocity| velocity.partial_cmp(velocity).is_none())
                .map(|index| (t, coordinate(facts, index)));
        }
        self.look(t, || first_in_state(&<D::System as System<N>>::FACTS, q, &v));
        v
    }

    fn momentum_rates(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> [D::Scalar; N] {
        let facts = &<D::System as System<N>>::FACTS;
        let rates = self.dynamics.system().momentum_rates(scalar_time(t), q, v, inputs);
        self.look(t, || {
            first_in(&rates).map(|index| Quantity::Acceleration(coordinate(facts, index)))
        });
        rates
    }

    fn mass_matrix(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &<D::System as System<N>>::Inputs,
    ) -> SMatrix<D::Scalar, N, N> {
        self.dynamics.system().mass_matrix(scalar_time(t), q, v, inputs)
    }

    fn jacobians(
        &mut self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [SMatrix<D::Scalar, N, N>; 2]
    where
        D::System: Jacobians<N>,
    {
        let jacobians = jacobians(self.dynamics, t, side, q, v);
        self.look(t, || {
            let entries = |matrix: &SMatrix<D::Scalar, N, N>| {
                (0..N).find(|&i| !matrix.row(i).iter().all(|x| x.is_finite()))
            };
            let row = jacobians.iter().find_map(entries);
            row.map(|index| {
                Quantity::Acceleration(coordinate(&<D::System as System<N>>::FACTS, index))
            })
        });
        jacobians
    }
}

/// The coordinate with this index.
pub(crate) fn coordinate(facts: &Facts, index: usize) -> Coordinate {
    Coordinate { index, name: facts.coordinates.get(index).copied().unwrap_or("") }
}

/// The first component of the state that is not finite.
pub(crate) fn first_in_state<T: Float, const N: usize>(
    facts: &Facts,
    q: &[T; N],
    v: &[T; N],
) -> Option<Quantity> {
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
