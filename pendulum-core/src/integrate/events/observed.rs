//! The interface of integrations for event detectors and recorders.

use crate::error::Error;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::system::Facts;
use crate::time::Time;

/// An integration after a step, either single or in a lane of a batch.
///
/// Detectors and recorders use it as a trait object, so that they are compiled once for all
/// methods.
pub(crate) trait Observed<T, const N: usize> {
    /// Returns the facts about the system.
    fn facts(&self) -> &'static Facts;

    /// Returns the state reached; at a kink, the state beyond the kink.
    fn end(&self) -> &Endpoint<T, N>;

    /// Returns the state before the kink, if the last step has ended on one.
    fn before_kink(&self) -> Option<&Endpoint<T, N>>;

    /// Computes the motion within the last step, if any.
    fn interpolate(&mut self);

    /// Returns the motion within the last step, if it has been computed.
    fn interpolated(&self) -> Option<&Interpolant<T, N>>;

    /// Returns the accelerations at the state reached.
    fn accelerations(&mut self) -> [T; N];

    /// Returns `true` if the last step went back in time.
    fn goes_back(&self) -> bool;

    /// Returns the length of the last step, before a cut; 0 without a step.
    fn last_length(&self) -> f64;

    /// Ends the last step at a state within the step.
    fn cut(&mut self, t: Time, state: &State<T, N>);

    /// Sets another state at the same time.
    fn jump(&mut self, state: &State<T, N>) -> Result<(), Error>;

    /// Moves a state within the last step, at `t`, onto the constraints.
    fn deliver(&self, t: Time, state: &mut State<T, N>) {
        let _ = (t, state);
    }

    /// Returns the limits in contact during the last step, and at its end, with one bit per limit,
    /// and the modes of the frictions.
    fn contacts(&self) -> [u64; 2] {
        [0; 2]
    }

    /// Takes the last step back.
    fn retreat(&mut self);
}
