//! A state of dynamics at a time.

use super::InputsOf;
use crate::motion::Side;
use crate::scalar::Real;
use crate::system::{At, Dynamics, Purpose, System, scalar_time};
use crate::time::Time;

/// A state of the dynamics `D` at a time.
pub(crate) struct Phase<'a, D: Dynamics<N>, const N: usize> {
    pub(crate) dynamics: &'a D,
    pub(crate) t: Time,
    /// The side whose values count at a kink.
    pub(crate) side: Side,
    pub(crate) q: &'a [D::Scalar; N],
    pub(crate) v: &'a [D::Scalar; N],
}

impl<D: Dynamics<N, Scalar: Real>, const N: usize> Phase<'_, D, N> {
    /// Returns the state as the system takes it, with samples of the inputs.
    pub(crate) fn at<'b>(
        &'b self,
        inputs: &'b InputsOf<D, N>,
    ) -> At<'b, D::Scalar, InputsOf<D, N>, N> {
        At { t: scalar_time(self.t), q: self.q, v: self.v, inputs }
    }

    /// Returns the velocities with the rates of the states in their places, and the accelerations
    /// with the derivatives of these rates.
    pub(crate) fn with_rates(&self, accelerations: &[D::Scalar; N]) -> [[D::Scalar; N]; 2] {
        let inputs = self.inputs(Purpose::Accelerations);
        self.dynamics.system().state_rates(self.at(&inputs), accelerations)
    }

    /// Returns the samples of the inputs that the momentum form needs, without control inputs that
    /// depend on the state.
    pub(crate) fn momentum_inputs(&self) -> InputsOf<D, N> {
        self.dynamics.inputs(self.t, self.side, Purpose::Momenta)
    }

    /// Returns the samples of all inputs, with the derivatives that `purpose` needs.
    pub(crate) fn inputs(&self, purpose: Purpose) -> InputsOf<D, N> {
        self.dynamics.inputs_with(self.t, self.side, purpose, self.q, self.v)
    }
}

/// Returns `true` if the system of the dynamics `D` has states, whose rates are given.
///
/// Does not compile if the rate of a state contains a control input that follows a law in
/// continuous time: the derivative of the rate, with which states are integrated, is not known.
#[inline]
pub(crate) const fn has_states<D: Dynamics<N>, const N: usize>() -> bool {
    let facts = &<D::System as System<N>>::FACTS;
    assert!(
        !(D::FEEDBACK && facts.controlled_rates),
        "the rate of a `state` contains a control input whose law has no derivative: write the law into the rate, or use `sampled`"
    );
    0 < facts.states
}
