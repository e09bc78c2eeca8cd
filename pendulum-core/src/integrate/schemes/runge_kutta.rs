//! The stages of explicit Runge–Kutta methods for (q, q̇)′ = (q̇, a(t, q, q̇)).

use crate::integrate::field::Field;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::Dynamics;

/// A row of a tableau without its zeros: the indices of earlier stages, from 0, and their weights.
pub(crate) type Row<const K: usize> = [(usize, f64); K];

/// The slopes at the `S` stages of a step: velocities and accelerations.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<T, const N: usize, const S: usize> {
    /// The slopes of the coordinates.
    pub v: [[T; N]; S],
    /// The slopes of the velocities.
    pub a: [[T; N]; S],
}

impl<T: Float, const N: usize, const S: usize> Slopes<T, N, S> {
    /// Returns slopes that are all zero.
    pub(crate) fn zero() -> Self {
        let zero = [[T::from_f64(0.0); N]; S];
        Self { v: zero, a: zero }
    }

    /// Computes the first stage, which is the start of a step.
    #[inline]
    pub(crate) fn first<const W: bool>(
        &mut self,
        field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
        from: &mut Endpoint<T, N>,
    ) {
        self.v[0] = from.v.high;
        self.a[0] = from.start_acceleration(field);
    }

    /// Computes stage `index` at `start + c h`.
    // A row is a constant. After inlining, its indices and weights are constants too.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    pub(crate) fn stage<const K: usize, const W: bool>(
        &mut self,
        field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
        index: usize,
        c: f64,
        row: Row<K>,
    ) {
        let h = interval.length::<T>();
        let (dq, dv) = self.weighted(row);
        let q = core::array::from_fn(|i| from.q.high[i] + h * dq[i]);
        let v = core::array::from_fn(|i| from.v.high[i] + h * dv[i]);
        let (t, side) = interval.at(c);
        self.v[index] = v;
        self.a[index] = field.at(t, side, &q, &v);
    }

    /// Returns Σ weight · slope, for coordinates and velocities.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    pub(crate) fn weighted<const K: usize>(&self, row: Row<K>) -> ([T; N], [T; N]) {
        (weighted(&self.v, row), weighted(&self.a, row))
    }
}

#[allow(clippy::inline_always)]
#[inline(always)]
pub(crate) fn weighted<T: Float, const N: usize, const S: usize, const K: usize>(
    slopes: &[[T; N]; S],
    row: Row<K>,
) -> [T; N] {
    let mut sum = [T::from_f64(0.0); N];
    for (k, (stage, weight)) in row.into_iter().enumerate() {
        for i in 0..N {
            let term = T::from_f64(weight) * slopes[stage][i];
            sum[i] = if k == 0 { term } else { sum[i] + term };
        }
    }
    sum
}

/// Sums for the order conditions that the tests check.
#[cfg(test)]
pub(crate) mod conditions {
    use super::Row;

    /// Returns Σ weight.
    pub(crate) fn sum<const K: usize>(row: Row<K>) -> f64 {
        row.iter().map(|(_, weight)| weight).sum()
    }

    /// Returns Σ weight · nodeᵖ.
    pub(crate) fn moment<const K: usize>(nodes: &[f64], row: Row<K>, power: i32) -> f64 {
        row.iter()
            .map(|&(stage, weight)| weight * (0..power).map(|_| nodes[stage]).product::<f64>())
            .sum()
    }
}
