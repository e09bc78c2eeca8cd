//! Drifts and kicks: the steps of splitting methods for q̈ = a(t, q).
//!
//! A drift moves the coordinates with fixed velocities and advances the time, a kick changes the
//! velocities with fixed coordinates.

use crate::integrate::field::Field;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::Dynamics;

/// A palindromic splitting with `S` evaluations a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Splitting<const OUTER: usize, const S: usize> {
    /// The weights of what comes first and last.
    pub(crate) outer: [f64; OUTER],
    /// The weights of what stands between.
    pub(crate) inner: [f64; S],
    /// The times of the evaluations, in steps.
    pub(crate) times: [f64; S],
}

/// Kicks outside, drifts inside, an evaluation after each drift; the last one serves the next step.
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

/// Drifts outside, kicks inside, an evaluation for each kick; none at the ends of the step.
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

/// The same with both words of every product and of the velocities that drift: what remains is the
/// rounding of the accelerations.
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
    /// The kick-drift-kick splitting with the first half of the kicks and of the drifts.
    pub(crate) const fn kicks_outside(kicks: &[f64], drifts: &[f64]) -> Self {
        let (outer, inner) = (palindrome::<OUTER>(kicks), palindrome::<S>(drifts));
        Self { outer, inner, times: times::<S>(&inner) }
    }

    /// The drift-kick-drift splitting with the first half of the drifts and of the kicks.
    pub(crate) const fn drifts_outside(drifts: &[f64], kicks: &[f64]) -> Self {
        let outer = palindrome::<OUTER>(drifts);
        Self { outer, inner: palindrome::<S>(kicks), times: times::<S>(&outer) }
    }
}

/// The weights whose first half, with the middle one if there is one, is `half`.
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

/// The time after each drift; the whole step after the last one.
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
