//! Switches at which accelerations jump, along dense output.
//!
//! Where the argument of `sign`, or of `min` in a potential, changes its sign, the accelerations may
//! jump, and so do the derivatives of the motion by whatever moves the time of the change (Aizerman
//! and Gantmacher 1958). Where the accelerations only have a kink, as with `max` in a force, the
//! derivatives are continuous.

use crate::integrate::interpolant::dense::DenseStep;
use crate::scalar::Float;
use crate::system::{At, Dynamics, Purpose, System, scalar_time};

/// A change of an acceleration counts as a jump above this fraction of it, and above a smaller one
/// of the largest acceleration, whose rounding errors the others may have.
const FRACTIONS: [f64; 2] = [1e-7, 1e-12];

/// The switches along a motion: the last value of each that was not zero.
pub(super) struct Switches<T> {
    last: Vec<T>,
}

impl<T: Float> Switches<T> {
    pub(super) fn new<D: Dynamics<N, Scalar = T>, const N: usize>() -> Self {
        Self { last: vec![T::from_f64(0.0); <D::System as System<N>>::FACTS.switches.len()] }
    }

    /// Returns the first switch that changes its sign within the next step while the accelerations
    /// jump, if `moves` returns `true` for it and the fraction of the step: if what is varied moves
    /// the time of the change.
    pub(super) fn jump<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        step: &DenseStep<'_, T, N>,
        moves: impl Fn(usize, T) -> bool,
    ) -> Option<usize> {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let mut first: Option<(T, usize)> = None;
        for index in 0..self.last.len() {
            let value = |theta: T| {
                let mut values = vec![zero; index + 1];
                self::at(dynamics, step, theta, |system, at| system.arguments(at, &mut values));
                values[index]
            };
            let after = value(one);
            if after == zero {
                continue;
            }
            let last = core::mem::replace(&mut self.last[index], after);
            let before = if last == zero { value(zero) } else { last };
            if before == zero || (before < zero) == (after < zero) {
                continue;
            }
            let (mut low, mut high) = (zero, one);
            loop {
                let middle = (low + high) * T::from_f64(0.5);
                if middle <= low || high <= middle {
                    break;
                }
                let own = value(middle);
                let beyond = own != zero && (own < zero) == (after < zero);
                (low, high) = if beyond { (low, middle) } else { (middle, high) };
            }
            let [near, far] =
                [low, high].map(|theta| at(dynamics, step, theta, System::accelerations));
            let size = |a: T, b: T| f64::max(a.abs().to_f64(), b.abs().to_f64());
            let most = near.iter().zip(&far).map(|(a, b)| size(*a, *b)).fold(0.0, f64::max);
            let [own, all] = FRACTIONS;
            let apart =
                |(a, b): (&T, &T)| own * size(*a, *b) + all * most < (*a - *b).abs().to_f64();
            let earlier = first.is_none_or(|(theta, _)| low < theta);
            if earlier && near.iter().zip(&far).any(apart) && moves(index, low) {
                first = Some((low, index));
            }
        }
        first.map(|(_, index)| index)
    }
}

/// Returns `of` the system at a place of a step.
fn at<D: Dynamics<N>, R, const N: usize>(
    dynamics: &D,
    step: &DenseStep<'_, D::Scalar, N>,
    theta: D::Scalar,
    of: impl FnOnce(&D::System, At<'_, D::Scalar, <D::System as System<N>>::Inputs, N>) -> R,
) -> R
where
    D::Scalar: Float,
{
    let ((q, v), (t, side)) = (step.at(theta), step.interval.at(theta.to_f64()));
    let inputs = dynamics.inputs_with(t, side, Purpose::Accelerations, &q, &v);
    of(dynamics.system(), At { t: scalar_time(t), q: &q, v: &v, inputs: &inputs })
}
