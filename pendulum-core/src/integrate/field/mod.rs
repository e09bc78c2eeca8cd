//! The dynamics as evaluated by methods: with a count of evaluations, and watched after a failed
//! step.

mod complementarity;
pub(crate) mod cone;
pub(crate) mod contacts;
pub(crate) mod diagnose;
pub(crate) mod grasp;
pub(crate) mod inertia;
pub(crate) mod load;
mod modes;
pub(crate) mod phase;
pub(crate) mod response;
mod strike;

use self::contacts::{Contacts, has_contacts};
use self::phase::Phase;
use crate::error::{Coordinate, Quantity};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{
    At, Dynamics, Facts, Jacobians, Purpose, Samples, System, feedback_jacobians, scalar_time,
};
use crate::time::Time;
use nalgebra::SMatrix;

/// The driven inputs of the dynamics `D`.
pub(crate) type InputsOf<D, const N: usize> = <<D as Dynamics<N>>::System as System<N>>::Inputs;

/// The values that depend only on the parameters of the dynamics `D`.
pub(crate) type PreparedOf<D, const N: usize> = <<D as Dynamics<N>>::System as System<N>>::Prepared;

/// The functions of the dynamics `D` that a method can evaluate: accelerations, and the momentum
/// form.
///
/// A field that is `WATCHED` looks for the first number that is not finite. A failed step is
/// repeated with a watched field, so that successful steps need no such check. It is a constant
/// because a flag, tested in each evaluation, makes steps of small systems slower by up to a third.
#[derive(Debug)]
pub struct Field<'a, D: Dynamics<N>, const N: usize, const WATCHED: bool = false> {
    pub(crate) dynamics: &'a D,
    pub(crate) prepared: &'a PreparedOf<D, N>,
    /// The number of evaluations.
    pub(crate) evaluations: u64,
    /// `true` if the steps go back in time.
    pub(crate) backwards: bool,
    /// The limits in contact, whose forces act.
    pub(crate) contacts: Contacts,
    /// The first number that is not finite, if any.
    pub(crate) findings: Findings,
}

/// The first number that is not finite in the evaluations of a step or in their arguments.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Findings {
    pub(crate) first: Option<(Time, Quantity)>,
    /// `true` if this number is a velocity that belongs to a finite momentum: the mass matrix has
    /// no inverse there, or no velocity gives that momentum.
    pub(crate) singular: bool,
    /// The time and the coordinate if that velocity was not found: it is NaN and not infinite.
    pub(crate) lost: Option<(Time, Coordinate)>,
}

impl<'a, D: Dynamics<N>, const N: usize> Field<'a, D, N> {
    /// Creates a field without evaluations.
    #[inline]
    pub(crate) fn new(dynamics: &'a D, prepared: &'a PreparedOf<D, N>) -> Self {
        Self {
            dynamics,
            prepared,
            evaluations: 0,
            backwards: false,
            contacts: Contacts::NONE,
            findings: Findings::default(),
        }
    }

    /// Returns a watched field of the same dynamics.
    pub(crate) fn watched(&self) -> Field<'a, D, N, true> {
        let Self { dynamics, prepared, backwards, contacts, .. } = *self;
        let findings = Findings::default();
        Field { dynamics, prepared, evaluations: 0, backwards, contacts, findings }
    }
}

impl<'a, D: Dynamics<N, Scalar: Float>, const N: usize, const WATCHED: bool>
    Field<'a, D, N, WATCHED>
{
    /// Returns the side of a kink on which a step lies that starts there; a step that ends there
    /// lies on the opposite side.
    #[inline]
    pub fn side(&self) -> Side {
        if self.backwards { Side::Before } else { Side::After }
    }

    /// Returns the dynamics.
    pub fn dynamics(&self) -> &'a D {
        self.dynamics
    }

    /// Returns the accelerations at `t`; counts as an evaluation. At a kink, `side` selects the
    /// values.
    #[inline]
    pub fn at(
        &mut self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [D::Scalar; N] {
        self.evaluations += 1;
        let mut a = self.dynamics.accelerations_with(self.prepared, t, side, q, v);
        if const { has_contacts::<D, N>() } && self.contacts.any() {
            let phase = Phase { dynamics: self.dynamics, t, side, q, v };
            a = phase.pushed(&a, &self.contacts);
        }
        if WATCHED {
            self.check_accelerations(t, side, q, v, &a);
        }
        a
    }

    /// Returns the samples of the inputs that the momentum form needs at `t`. At a kink, `side`
    /// selects the values. [`momentum_rates`](Self::momentum_rates) adds control inputs that depend
    /// on the state.
    #[inline]
    pub fn inputs(&mut self, t: Time, side: Side) -> InputsOf<D, N> {
        let inputs = self.dynamics.inputs(t, side, Purpose::Momenta);
        self.check(t, || first_in_inputs(Self::facts(), &inputs));
        inputs
    }

    /// Returns the momenta p = ∂L/∂q̇.
    #[inline]
    pub fn momenta(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &InputsOf<D, N>,
    ) -> [D::Scalar; N] {
        self.check(t, || first_in_state(Self::facts(), q, v));
        self.dynamics.system().momenta(At { t: scalar_time(t), q, v, inputs })
    }

    /// Returns the velocities that give the momenta `p`.
    #[inline]
    pub fn velocities(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        p: &[D::Scalar; N],
        inputs: &InputsOf<D, N>,
    ) -> [D::Scalar; N] {
        let v = self.dynamics.system().velocities(scalar_time(t), q, p, inputs);
        if WATCHED {
            self.check_velocities(t, q, p, &v);
        }
        v
    }

    /// Returns dp/dt; counts as one evaluation together with the velocities.
    #[inline]
    pub fn momentum_rates(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &InputsOf<D, N>,
    ) -> [D::Scalar; N] {
        self.evaluations += 1;
        let mut inputs = *inputs;
        if D::FEEDBACK {
            self.dynamics.control(t, q, v, &mut inputs);
            self.check(t, || first_in_inputs(Self::facts(), &inputs));
        }
        let at = At { t: scalar_time(t), q, v, inputs: &inputs };
        let rates = self.dynamics.system().momentum_rates(at);
        self.check(t, || {
            let index = first_in(&rates)?;
            Some(Quantity::Acceleration(Self::facts().coordinate(index)))
        });
        rates
    }

    /// Returns the mass matrix M = ∂²L/∂q̇².
    pub fn mass_matrix(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        inputs: &InputsOf<D, N>,
    ) -> SMatrix<D::Scalar, N, N> {
        self.dynamics.system().mass_matrix(At { t: scalar_time(t), q, v, inputs })
    }

    /// Returns ∂q̈/∂q and ∂q̈/∂q̇ at `t`. At a kink, `side` selects the values.
    pub fn jacobians(
        &mut self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [SMatrix<D::Scalar, N, N>; 2]
    where
        D::System: Jacobians<N>,
    {
        let system = self.dynamics.system();
        let inputs = self.dynamics.inputs_with(t, side, Purpose::Accelerations, q, v);
        let at = At { t: scalar_time(t), q, v, inputs: &inputs };
        let mut jacobians = [system.position_jacobian(at), system.velocity_jacobian(at)];
        if D::FEEDBACK {
            let [by_q, by_v] = feedback_jacobians(self.dynamics, t, at);
            jacobians[0] += by_q;
            jacobians[1] += by_v;
        }
        self.check(t, || {
            let entries = |matrix: &SMatrix<D::Scalar, N, N>| {
                (0..N).find(|&i| matrix.row(i).iter().any(|x| !x.is_finite()))
            };
            let index = jacobians.iter().find_map(entries)?;
            Some(Quantity::Acceleration(Self::facts().coordinate(index)))
        });
        jacobians
    }

    fn facts() -> &'static Facts {
        &<D::System as System<N>>::FACTS
    }

    #[inline]
    fn check(&mut self, t: Time, what: impl FnOnce() -> Option<Quantity>) {
        if WATCHED && self.findings.first.is_none() {
            self.findings.first = what().map(|what| (t, what));
        }
    }

    #[cold]
    #[inline(never)]
    fn check_accelerations(
        &mut self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        a: &[D::Scalar; N],
    ) {
        let inputs = self.dynamics.inputs_with(t, side, Purpose::Accelerations, q, v);
        self.check(t, || {
            let facts = Self::facts();
            let state = first_in_state(facts, q, v).or_else(|| first_in_inputs(facts, &inputs));
            state.or_else(|| Some(Quantity::Acceleration(facts.coordinate(first_in(a)?))))
        });
    }

    #[cold]
    #[inline(never)]
    fn check_velocities(
        &mut self,
        t: Time,
        q: &[D::Scalar; N],
        p: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) {
        let facts = Self::facts();
        let findings = &mut self.findings;
        if findings.first.is_none() {
            findings.singular |=
                first_in(p).is_none() && first_in(q).is_none() && first_in(v).is_some();
            if findings.singular && findings.lost.is_none() {
                // NaN is the only value without an order.
                let lost = v.iter().position(|v| v.partial_cmp(v).is_none());
                findings.lost = lost.map(|index| (t, facts.coordinate(index)));
            }
        }
        self.check(t, || first_in_state(facts, q, v));
    }
}

/// Returns the first component of the state that is not finite.
pub(crate) fn first_in_state<T: Float, const N: usize>(
    facts: &Facts,
    q: &[T; N],
    v: &[T; N],
) -> Option<Quantity> {
    let position = first_in(q).map(|index| Quantity::Position(facts.coordinate(index)));
    position.or_else(|| first_in(v).map(|index| Quantity::Velocity(facts.coordinate(index))))
}

/// Returns the first component of a driven input that is not finite.
pub(crate) fn first_in_inputs<T: Real>(
    facts: &Facts,
    inputs: &impl Samples<T>,
) -> Option<Quantity> {
    let (input, derivative, component) = inputs.first_not_finite()?;
    let (name, control) =
        facts.inputs.get(input).map_or(("", false), |input| (input.name, input.control));
    Some(if control {
        Quantity::Control { name, component }
    } else {
        Quantity::Input { name, component, derivative }
    })
}

fn first_in<T: Float, const N: usize>(values: &[T; N]) -> Option<usize> {
    values.iter().position(|value| !value.is_finite())
}
