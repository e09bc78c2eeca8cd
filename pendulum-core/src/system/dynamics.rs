//! Systems with motions for their driven inputs.

use crate::error::Error;
use crate::motion::input::Purpose;
use crate::motion::{Motions, Side, sufficient};
use crate::scalar::Real;
use crate::system::at::At;
use crate::system::equations::System;
use crate::system::inputs::NoInputs;
use crate::time::Time;

/// The greatest total number of components of the inputs of a system.
pub const MOST_CONTROLS: usize = 24;

/// A system with a motion for each of its driven inputs, as required by integrators.
///
/// Every system without driven inputs implements this trait. For a system with driven inputs, the
/// method `driven_by` returns a [`Driven`], which implements it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be integrated",
    label = "no system whose inputs have motions and controllers",
    note = "integrators take systems that `lagrangian!` has made; driven inputs get their motions by `.driven_by(…)`, then control inputs their controller by `.controlled_by(…)` or `.sampled(…)`"
)]
pub trait Dynamics<const N: usize> {
    /// The system.
    type System: System<N, Scalar = Self::Scalar>;
    /// The scalar of the system.
    type Scalar: Real;

    /// Returns the system.
    fn system(&self) -> &Self::System;

    /// `true` if control inputs depend on the state, so that [`inputs`](Self::inputs) leaves them
    /// out.
    const FEEDBACK: bool = false;

    /// `true` if a stateful controller is sampled during the integration. The integration cannot be
    /// resumed from its numbers without the controller.
    const SAMPLED: bool = false;

    /// Returns the samples of all inputs at `t`, with the derivatives that `purpose` needs. At a
    /// kink the samples are the limits from `side`. Control inputs that depend on the state are
    /// left out.
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> <Self::System as System<N>>::Inputs;

    /// Returns the first time after `t` at which a derivative of an input jumps.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// Returns the last time before `t` at which a derivative of a driven input jumps: −∞ if there
    /// is none, `None` if it is unknown. If it is unknown, integrations cannot go backwards in
    /// time.
    fn kink_before(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Returns the longest step from `t` that the motions allow, as
    /// [`Motion::longest_step`](crate::motion::Motion::longest_step). `unknown` replaces the bound
    /// of motions that return `None`, and of dynamics with inputs that do not override this method.
    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let _ = (t, widths);
        if <Self::System as System<N>>::FACTS.inputs.is_empty() { f64::INFINITY } else { unknown }
    }

    /// Writes the values of control inputs that depend on the state to `inputs`.
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

    /// Returns the samples of all inputs at `t` in the state `q`, `v`, with the derivatives that
    /// `purpose` needs. At a kink the samples are the limits from `side`.
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

    /// Returns the values of the control inputs from the controller, component by component.
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

    /// Begins an integration at `t` and resets sampled controllers. Returns a number that
    /// identifies the integration in calls of [`sample`](Self::sample).
    fn begin(&self, t: f64) -> u64 {
        let _ = t;
        0
    }

    /// Returns the number of the integration whose samples a sampled controller has: 0 before the
    /// first integration and for all other dynamics.
    fn recorded(&self) -> u64 {
        0
    }

    /// Samples a sampled controller if a sample is due at `t`, the start of a step. Returns `true`
    /// if it has been sampled.
    ///
    /// # Errors
    /// If a value is not finite, or if the controller belongs to another integration by now.
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

    /// Computes the accelerations at `t`, or at a kink their limit from `side`.
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

    /// Computes the accelerations at `t`, or at a kink their limit from `side`, with the values
    /// `prepared` from the parameters.
    ///
    /// All methods call this function. Override it to add forces to those of the system.
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
        let at = At { t: scalar_time(t), q, v, inputs: &inputs };
        self.system().accelerations_prepared(prepared, at)
    }

    /// Computes the Jacobi integral at `t`.
    fn energy_at(&self, t: f64, q: &[Self::Scalar; N], v: &[Self::Scalar; N]) -> Self::Scalar {
        let t = Time::new(t);
        let inputs = self.inputs_with(t, Side::After, Purpose::Energy, q, v);
        self.system().energy(At { t: scalar_time(t), q, v, inputs: &inputs })
    }

    /// Computes dE/dt at `t`.
    ///
    /// Excludes limits in contact; [`Solution::power`](crate::integrate::Solution::power) includes
    /// them.
    fn power_at(&self, t: f64, q: &[Self::Scalar; N], v: &[Self::Scalar; N]) -> Self::Scalar {
        let t = Time::new(t);
        let inputs = self.inputs_with(t, Side::After, Purpose::Power, q, v);
        self.system().power(At { t: scalar_time(t), q, v, inputs: &inputs })
    }

    /// Computes the multipliers λ of M q̈ = f + Cᵀλ at `t`, in the order of `FACTS.constraints`;
    /// the remaining entries are zero.
    ///
    /// [`Constraint::reaction_unit`](crate::system::Constraint) is the unit of each multiplier.
    ///
    /// Excludes limits in contact; [`Solution::reactions`](crate::integrate::Solution::reactions)
    /// includes them.
    fn reactions_at(
        &self,
        t: f64,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let t = Time::new(t);
        let inputs = self.inputs_with(t, Side::After, Purpose::Accelerations, q, v);
        self.system().reactions(At { t: scalar_time(t), q, v, inputs: &inputs })
    }

    /// Computes the velocities on the far side of a kink at `t` from the velocities `v` on the side
    /// `from`: the momenta are equal on both sides.
    ///
    /// Returns `v` unchanged if the inputs on which the momenta depend do not jump.
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
        let p = self.system().momenta(At { t: scalar_time(t), q, v, inputs: &near });
        self.system().velocities(scalar_time(t), q, &p, &far)
    }
}

/// Returns `true` if the system of the dynamics `D` has constraints with multipliers.
#[inline]
pub(crate) const fn is_constrained<D: Dynamics<N>, const N: usize>() -> bool {
    0 < <D::System as System<N>>::FACTS.held_constraints()
}

/// Converts `t` to the scalar of a system, including its low word.
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

/// A system with motions for its driven inputs.
#[derive(Clone, Debug)]
pub struct Driven<S, M> {
    /// The system.
    pub system: S,
    /// A tuple of motions in the order of declaration.
    pub motions: M,
}

impl<S, M> Driven<S, M> {
    /// Combines a system with `motions`, a tuple with one motion for each driven input. Does not
    /// compile if a motion lacks a derivative that the equations or the outputs need.
    pub fn new<const N: usize>(system: S, motions: M) -> Self
    where
        S: System<N>,
        M: Motions<S::Inputs>,
    {
        const {
            assert!(
                sufficient(M::HAS, S::FACTS.inputs),
                "a motion that `driven_by` was given lacks a derivative that the equations of motion or the outputs need; a `Function` gets them by `.velocity(…)` and `.acceleration(…)`"
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

    // Inlining removes the derivatives that a constant `purpose` does not need.
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
