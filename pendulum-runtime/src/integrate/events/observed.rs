//! Integrations as event detectors and recorders see them.

use crate::error::Error;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::system::Facts;
use crate::time::Time;

/// An integration after a step, alone or in a lane of a batch.
///
/// Detectors and recorders take it as a trait object: they are compiled once for all methods.
pub(crate) trait Observed<T, const N: usize> {
    /// The facts about its system.
    fn facts(&self) -> &'static Facts;

    /// The state reached; at a kink the one beyond it.
    fn end(&self) -> &Endpoint<T, N>;

    /// The state on this side of a kink, if the last step has ended on one.
    fn before_kink(&self) -> Option<&Endpoint<T, N>>;

    /// Computes the motion within the last step, if there was one.
    fn interpolate(&mut self);

    /// The motion within the last step, once it is computed.
    fn interpolated(&self) -> Option<&Interpolant<T, N>>;

    /// The accelerations at the state reached.
    fn accelerations(&mut self) -> [T; N];

    /// Returns true if the last step went back in time.
    fn goes_back(&self) -> bool;

    /// The length of the last step, before it was cut; 0 without one.
    fn last_length(&self) -> f64;

    /// Ends the last step at a state within.
    fn cut(&mut self, t: Time, state: &State<T, N>);

    /// Puts the state elsewhere at the same time.
    fn jump(&mut self, state: &State<T, N>) -> Result<(), Error>;

    /// Brings a state within the last step, at `t`, onto the constraints.
    fn deliver(&self, t: Time, state: &mut State<T, N>) {
        let _ = (t, state);
    }

    /// The limits in contact during the last step, and at its end; a bit for each.
    fn contacts(&self) -> [u16; 2] {
        [0; 2]
    }

    /// Takes the last step back.
    fn retreat(&mut self);
}
