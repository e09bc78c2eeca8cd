//! Switches at which accelerations jump, along dense output.
//!
//! Where the argument of `sign`, or of `min` in a potential, changes its sign, the accelerations may
//! jump, and so do the derivatives of the motion by whatever moves the time of the change (Aizerman
//! and Gantmacher 1958). Where the accelerations only have a kink, as with `max` in a force, the
//! derivatives are continuous.

use crate::integrate::interpolant::dense::DenseStep;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::arguments::Arguments;
use crate::integrate::step::passing::Passing;
use crate::scalar::Float;
use crate::system::{Dynamics, System};

/// A step that is as short as this fraction of the steps before it passes one place only.
const STRAIGHT: f64 = 1e-6;

/// The switches along a motion.
pub(super) struct Switches<T> {
    arguments: Arguments<T>,
    /// The last value of each switch that was not zero.
    last: Vec<T>,
}

impl<T: Float> Switches<T> {
    pub(super) fn new<D: Dynamics<N, Scalar = T>, const N: usize>() -> Self {
        let last = vec![T::from_f64(0.0); <D::System as System<N>>::FACTS.switches.len()];
        Self { arguments: Arguments::new::<D, N>(), last }
    }

    /// Returns the jump of the accelerations within the next step, if any.
    ///
    /// # Errors
    /// Returns the index of the switch of a second jump in a step that does not end at the first.
    pub(super) fn jump<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        step: &DenseStep<'_, T, N>,
    ) -> Result<Option<Passing<T, N>>, usize> {
        let zero = T::from_f64(0.0);
        let (h, side) = (step.interval.h.abs(), step.interval.side());
        let usual = self.arguments.usual(h);
        let motion = |theta: f64| {
            let (q, v) = step.at(T::from_f64(theta));
            Endpoint::new(step.interval.at(theta).0, q, v)
        };
        let mut first = None;
        for index in 0..self.last.len() {
            let after = self.arguments.value(dynamics, index, &motion(1.0), side.opposite());
            if after == zero {
                continue;
            }
            let differs = |value: T| value != zero && (value < zero) != (after < zero);
            let before = core::mem::replace(&mut self.last[index], after);
            let start = self.arguments.value(dynamics, index, &motion(0.0), side);
            // At a kink of the inputs, the switch jumps between two steps, and no column moves that
            // time. A step may also begin at its zero.
            if !differs(start) && (start != zero || !differs(before)) {
                continue;
            }
            let passing = self.arguments.passing(dynamics, index, motion, side);
            if passing.jump == [zero; N] {
                continue;
            }
            if first.is_none() {
                first = Some(passing);
            } else if STRAIGHT * usual < h {
                return Err(index);
            }
        }
        Ok(first)
    }
}
