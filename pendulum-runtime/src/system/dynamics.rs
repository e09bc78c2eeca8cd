//! Systems together with the motions that drive them.

use crate::error::Error;
use crate::motion::input::Purpose;
use crate::motion::{Motions, Side, sufficient};
use crate::scalar::Real;
use crate::system::equations::System;
use crate::system::inputs::NoInputs;
use crate::time::Time;

/// The greatest number of components that the inputs of a system have together.
pub const MOST_CONTROLS: usize = 24;

/// A system with a motion for each of its driven inputs: what an integrator takes.
///
/// Every system without driven inputs is one; a driven one becomes one by its method `driven_by`,
/// which gives a [`Driven`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be integrated",
    label = "no system whose driven inputs have motions",
    note = "integrators take systems that `lagrangian!` has made; driven inputs get their motions by `.driven_by(…)`"
)]
pub trait Dynamics<const N: usize> {
    /// The system.
    type System: System<N, Scalar = Self::Scalar>;
    /// Its scalar.
    type Scalar: Real;

    /// The system.
    fn system(&self) -> &Self::System;

    /// Control inputs follow the state: [`inputs`](Self::inputs) alone does not give them.
    const FEEDBACK: bool = false;

    /// A controller with a state of its own is asked now and then: an integration cannot be taken
    /// up again from its numbers alone.
    const SAMPLED: bool = false;

    /// The samples of all inputs at `t`, seen from `side`, with the derivatives that `purpose`
    /// needs; control inputs that follow the state are left out.
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> <Self::System as System<N>>::Inputs;

    /// The first time after `t` at which a derivative of a driven input jumps.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// The last such time before `t`; −∞ if there is none, and `None` if that is not known:
    /// integrations do not go back in time then.
    fn kink_before(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// The longest step from `t` over the motions, as
    /// [`Motion::longest_step`](crate::motion::Motion::longest_step); `unknown` stands for the
    /// answer of those that do not know, and of dynamics with inputs that do not say it.
    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let _ = (t, widths);
        if <Self::System as System<N>>::FACTS.inputs.is_empty() { f64::INFINITY } else { unknown }
    }

    /// Puts the values of control inputs that follow the state into `inputs`.
    #[inline]
    fn control(
        &self,
        t: Time,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &mut <Self::System as System<N>>::Inputs,
    ) {
        let _ = (t, q, v, inputs);
    }

    /// The samples of all inputs at `t`, seen from `side`, in the state `q`, `v`, with the
    /// derivatives that `purpose` needs.
    #[inline]
    fn inputs_with(
        &self,
        t: Time,
        side: Side,
        purpose: Purpose,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> <Self::System as System<N>>::Inputs {
        let mut inputs = self.inputs(t, side, purpose);
        if Self::FEEDBACK {
            self.control(t, q, v, &mut inputs);
        }
        inputs
    }

    /// The values that a controller gives the control inputs, component by component.
    #[inline]
    fn controls(
        &self,
        t: Time,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; MOST_CONTROLS] {
        let _ = (t, q, v);
        [Self::Scalar::from_f64(0.0); MOST_CONTROLS]
    }

    /// Begins an integration at `t`: controllers that are sampled start anew. Returns a number by
    /// which the integration is known to [`sample`](Self::sample).
    fn begin(&self, t: f64) -> u64 {
        let _ = t;
        0
    }

    /// The number of the integration whose samples a sampled controller has; 0 before the first
    /// one and for all other dynamics.
    fn recorded(&self) -> u64 {
        0
    }

    /// Asks a sampled controller for its values if they are due at the start of a step; returns
    /// true if they have changed.
    ///
    /// # Errors
    /// A value that is not finite, a controller that serves another integration by now.
    fn sample(
        &self,
        run: u64,
        t: Time,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> Result<bool, Error> {
        let _ = (run, t, q, v);
        Ok(false)
    }

    /// The accelerations at `t`, seen from `side`.
    #[inline]
    fn accelerations_at(
        &self,
        t: Time,
        side: Side,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        self.accelerations_with(&self.system().prepare(), t, side, q, v)
    }

    /// The accelerations at `t`, seen from `side`, with what the parameters alone decide computed
    /// before: what all methods call, and the place for forces beside those of the system.
    #[inline]
    fn accelerations_with(
        &self,
        prepared: &<Self::System as System<N>>::Prepared,
        t: Time,
        side: Side,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let inputs = self.inputs_with(t, side, Purpose::Accelerations, q, v);
        self.system().accelerations_prepared(prepared, scalar_time(t), q, v, &inputs)
    }

    /// The Jacobi integral at `t`.
    fn energy_at(&self, t: f64, q: &[Self::Scalar; N], v: &[Self::Scalar; N]) -> Self::Scalar {
        let t = Time::new(t);
        let inputs = self.inputs_with(t, Side::After, Purpose::Energy, q, v);
        self.system().energy(scalar_time(t), q, v, &inputs)
    }

    /// dE/dt at `t`.
    ///
    /// Limits in contact have no part in it; [`Solution::power`](crate::integrate::Solution::power)
    /// knows them.
    fn power_at(&self, t: f64, q: &[Self::Scalar; N], v: &[Self::Scalar; N]) -> Self::Scalar {
        let t = Time::new(t);
        let inputs = self.inputs_with(t, Side::After, Purpose::Power, q, v);
        self.system().power(scalar_time(t), q, v, &inputs)
    }

    /// The multipliers λ of M q̈ = f + Cᵀλ at `t`, in the order of `FACTS.constraints`; the rest is
    /// zero.
    ///
    /// Each has the unit that [`Constraint::reaction_unit`](crate::system::Constraint) names.
    ///
    /// Limits in contact have no part in them;
    /// [`Solution::reactions`](crate::integrate::Solution::reactions) knows them.
    fn reactions_at(
        &self,
        t: f64,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let t = Time::new(t);
        let inputs = self.inputs_with(t, Side::After, Purpose::Accelerations, q, v);
        self.system().reactions(scalar_time(t), q, v, &inputs)
    }

    /// The velocities beyond a kink at `t` from those on the side `from`: the momenta are the same
    /// on both sides.
    ///
    /// Where nothing that the momenta contain jumps, they are the same numbers.
    fn across_kink(
        &self,
        t: Time,
        from: Side,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let near = self.inputs(t, from, Purpose::Momenta);
        let far = self.inputs(t, from.opposite(), Purpose::Momenta);
        if near == far {
            return *v;
        }
        let p = self.system().momenta(scalar_time(t), q, v, &near);
        self.system().velocities(scalar_time(t), q, &p, &far)
    }
}

/// Returns true if the system of the dynamics `D` has constraints that its equations hold.
#[inline]
pub(crate) const fn is_constrained<D: Dynamics<N>, const N: usize>() -> bool {
    0 < <D::System as System<N>>::FACTS.held_constraints()
}

/// `t` in the scalar of a system, with both of its words.
#[inline]
pub fn scalar_time<T: Real>(t: Time) -> T {
    T::from_f64(t.to_f64()) + T::from_f64(t.low())
}

impl<const N: usize, S: System<N, Inputs: NoInputs<S>>> Dynamics<N> for S {
    type System = S;
    type Scalar = S::Scalar;

    fn system(&self) -> &S {
        self
    }

    #[inline]
    fn inputs(&self, _: Time, _: Side, _: Purpose) -> S::Inputs {
        NoInputs::none()
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn kink_before(&self, _: f64) -> Option<f64> {
        Some(f64::NEG_INFINITY)
    }
}

/// A system and the motions of its driven inputs.
#[derive(Clone, Debug)]
pub struct Driven<S, M> {
    /// The system.
    pub system: S,
    /// A tuple of motions in the order of declaration.
    pub motions: M,
}

impl<S, M> Driven<S, M> {
    /// Binds `motions`, a tuple with one motion for each driven input; does not compile if one of
    /// them lacks a derivative that the equations need.
    pub fn new<const N: usize>(system: S, motions: M) -> Self
    where
        S: System<N>,
        M: Motions<S::Inputs>,
    {
        const {
            assert!(
                sufficient(M::HAS, S::FACTS.inputs),
                "a motion that `driven_by` was given lacks a derivative that the equations of motion need; a `Function` gets them by `.velocity(…)` and `.acceleration(…)`"
            );
        };
        Self { system, motions }
    }
}

impl<const N: usize, S: System<N>, M: Motions<S::Inputs>> Dynamics<N> for Driven<S, M> {
    type System = S;
    type Scalar = S::Scalar;

    fn system(&self) -> &S {
        &self.system
    }

    // The derivatives that nobody needs are left out where the purpose is known.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> S::Inputs {
        self.motions.sample(t, side, S::FACTS.inputs, purpose)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.motions.next_kink(t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        self.motions.kink_before(t)
    }

    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        self.motions.longest_step(t, widths, unknown)
    }
}
