//! Drifts and kicks: the steps of splitting methods for q̈ = a(t, q).
//!
//! A drift moves the coordinates with fixed velocities and advances the time. A kick changes the
//! velocities with fixed coordinates.

use crate::integrate::field::Field;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::Dynamics;

/// The coefficients of a palindromic splitting with `S` evaluations per step: drifts q ← q + c h q̇
/// and kicks q̇ ← q̇ + c h a(t, q) in turn.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Splitting<const OUTER: usize, const S: usize> {
    /// The coefficients of the outer operations, which come first and last.
    pub outer: [f64; OUTER],
    /// The coefficients of the inner operations.
    pub inner: [f64; S],
    /// The times of the evaluations, in steps.
    pub times: [f64; S],
}

/// Takes a step with kicks outside, drifts inside and an evaluation after each drift. The next step
/// reuses the last evaluation.
#[inline]
pub(crate) fn kick_drift_kick<
    T: Float,
    const N: usize,
    const OUTER: usize,
    const S: usize,
    const W: bool,
>(
    splitting: &Splitting<OUTER, S>,
    field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    interval: &StepInterval,
    from: &mut Endpoint<T, N>,
) -> Endpoint<T, N> {
    let h = interval.length::<T>();
    let mut a = from.start_acceleration(field);
    let mut to = Endpoint { t: interval.end, ..*from };
    for i in 0..S {
        to.v.add(T::from_f64(splitting.outer[i]) * h, &a);
        to.q.add(T::from_f64(splitting.inner[i]) * h, &to.v.high);
        let (t, side) = interval.at(splitting.times[i]);
        a = field.at(t, side, &to.q.high, &to.v.high);
    }
    to.v.add(T::from_f64(splitting.outer[S]) * h, &a);
    to.a = Some(a);
    to
}

/// Takes a step with drifts outside, kicks inside and an evaluation for each kick, but none at the
/// ends of the step.
#[inline]
pub(crate) fn drift_kick_drift<
    T: Float,
    const N: usize,
    const OUTER: usize,
    const S: usize,
    const W: bool,
>(
    splitting: &Splitting<OUTER, S>,
    field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    interval: &StepInterval,
    from: &Endpoint<T, N>,
) -> Endpoint<T, N> {
    let h = interval.length::<T>();
    let mut to = Endpoint { t: interval.end, a: None, ..*from };
    for i in 0..S {
        to.q.add(T::from_f64(splitting.outer[i]) * h, &to.v.high);
        let (t, side) = interval.at(splitting.times[i]);
        let a = field.at(t, side, &to.q.high, &to.v.high);
        to.v.add(T::from_f64(splitting.inner[i]) * h, &a);
    }
    to.q.add(T::from_f64(splitting.outer[S]) * h, &to.v.high);
    to
}

/// Takes the step of [`drift_kick_drift`] with both words of every product and of the velocities in
/// drifts, so that only the rounding errors of the accelerations remain.
#[inline]
pub(crate) fn drift_kick_drift_in_two_words<
    T: Float,
    const N: usize,
    const OUTER: usize,
    const S: usize,
    const W: bool,
>(
    splitting: &Splitting<OUTER, S>,
    field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    interval: &StepInterval,
    from: &Endpoint<T, N>,
) -> Endpoint<T, N> {
    let (h, zero) = (interval.length::<T>(), [T::from_f64(0.0); N]);
    let mut to = Endpoint { t: interval.end, a: None, ..*from };
    for i in 0..S {
        to.q.add_both(T::from_f64(splitting.outer[i]) * h, &to.v.high, &to.v.low);
        let (t, side) = interval.at(splitting.times[i]);
        let a = field.at(t, side, &to.q.high, &to.v.high);
        to.v.add_both(T::from_f64(splitting.inner[i]) * h, &a, &zero);
    }
    to.q.add_both(T::from_f64(splitting.outer[S]) * h, &to.v.high, &to.v.low);
    to
}

impl<const OUTER: usize, const S: usize> Splitting<OUTER, S> {
    /// Creates a kick-drift-kick splitting from the first half of the kicks and of the drifts.
    pub(crate) const fn kicks_outside(kicks: &[f64], drifts: &[f64]) -> Self {
        let (outer, inner) = (palindrome::<OUTER>(kicks), palindrome::<S>(drifts));
        Self { outer, inner, times: times::<S>(&inner) }
    }

    /// Creates a drift-kick-drift splitting from the first half of the drifts and of the kicks.
    pub(crate) const fn drifts_outside(drifts: &[f64], kicks: &[f64]) -> Self {
        let outer = palindrome::<OUTER>(drifts);
        Self { outer, inner: palindrome::<S>(kicks), times: times::<S>(&outer) }
    }
}

/// Returns the palindrome with the first half `half`, which includes the middle weight if there is
/// one.
const fn palindrome<const K: usize>(half: &[f64]) -> [f64; K] {
    assert!(half.len() == K.div_ceil(2));
    let mut weights = [0.0; K];
    let mut i = 0;
    while i < half.len() {
        weights[i] = half[i];
        weights[K - 1 - i] = half[i];
        i += 1;
    }
    weights
}

/// Returns the time after each drift, in steps; exactly 1 after the last drift.
const fn times<const S: usize>(drifts: &[f64]) -> [f64; S] {
    let mut times = [0.0; S];
    let (mut i, mut sum) = (0, 0.0);
    while i < S {
        sum += drifts[i];
        times[i] = if i + 1 == drifts.len() { 1.0 } else { sum };
        i += 1;
    }
    times
}

#[cfg(test)]
mod tests {
    use super::Splitting;

    #[test]
    fn halves_are_mirrored() {
        let splitting = Splitting::<3, 2>::kicks_outside(&[0.25, 0.5], &[0.5]);
        assert_eq!(
            (splitting.outer, splitting.inner, splitting.times),
            ([0.25, 0.5, 0.25], [0.5, 0.5], [0.5, 1.0])
        );
        let splitting = Splitting::<3, 2>::drifts_outside(&[0.25, 0.5], &[0.5]);
        assert_eq!(
            (splitting.outer, splitting.inner, splitting.times),
            ([0.25, 0.5, 0.25], [0.5, 0.5], [0.25, 0.75])
        );
    }
}
