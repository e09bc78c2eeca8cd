//! The stages of explicit Runge–Kutta–Nyström methods for q̈ = a(t, q).

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::interpolant::hermite;
use crate::integrate::method::Weights;
use crate::integrate::schemes::runge_kutta::{Row, weighted};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::Dynamics;

/// The accelerations at the `S` stages of a step.
#[derive(Clone, Copy, Debug)]
pub struct Kicks<T, const N: usize, const S: usize> {
    /// The accelerations.
    pub a: [[T; N]; S],
}

// A row is a constant. After inlining, its indices and weights are constants too.
#[allow(clippy::inline_always)]
impl<T: Float, const N: usize, const S: usize> Kicks<T, N, S> {
    /// Returns accelerations that are all zero.
    pub(crate) fn zero() -> Self {
        Self { a: [[T::from_f64(0.0); N]; S] }
    }

    /// Computes the first stage, which is the start of a step.
    #[inline]
    pub(crate) fn first<const W: bool>(
        &mut self,
        field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
        from: &mut Endpoint<T, N>,
    ) {
        self.a[0] = from.start_acceleration(field);
    }

    /// Computes stage `index` at `start + c h`, with the coordinates q + c h q̇ + h² Σ weight ·
    /// acceleration.
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
        let (drift, kick) = (T::from_f64(c) * h, h * h);
        let sum = self.weighted(row);
        let q = core::array::from_fn(|i| (from.q.high[i] + drift * from.v.high[i]) + kick * sum[i]);
        let (t, side) = interval.at(c);
        // The accelerations of velocity-free systems do not depend on the velocities.
        self.a[index] = field.at(t, side, &q, &from.v.high);
    }

    /// Returns Σ weight · acceleration.
    #[inline(always)]
    pub(crate) fn weighted<const K: usize>(&self, row: Row<K>) -> [T; N] {
        weighted(&self.a, row)
    }

    /// Returns the end of the step, from the weights of the coordinates and of the velocities.
    #[inline(always)]
    pub(crate) fn end<const K: usize, const L: usize>(
        &self,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
        q: Row<K>,
        v: Row<L>,
    ) -> Endpoint<T, N> {
        let h = interval.length::<T>();
        let sum = self.weighted(q);
        let mut to = Endpoint { t: interval.end, a: None, ..*from };
        for i in 0..N {
            // The drift is by far the largest part, so that its product has both words.
            to.q.add_product(i, h, from.v.high[i], h * (from.v.low[i] + h * sum[i]));
        }
        to.v.add(h, &self.weighted(v));
        to
    }

    /// Returns the root mean square of the error, from the differences of the weights of both
    /// orders.
    #[inline(always)]
    pub(crate) fn error<const K: usize, const L: usize>(
        &self,
        h: f64,
        weights: &Weights<N>,
        q: Row<K>,
        v: Row<L>,
    ) -> f64 {
        let q = self.weighted(q).map(|difference| T::from_f64(h) * difference);
        h * (weights.square_sum(&q, &self.weighted(v)) / (2 * N) as f64).sqrt()
    }

    /// Returns the motion within the step, with the accelerations `a1` at the end. Beyond the
    /// quintic, the coordinates have the terms h² Σ weight · acceleration from the sixth term on,
    /// and the velocities have the terms h Σ weight · acceleration from the fourth on.
    #[inline(always)]
    pub(crate) fn dense<const K: usize, const Q: usize, const V: usize>(
        &self,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
        to: &Endpoint<T, N>,
        a1: &[T; N],
        q: [Row<K>; Q],
        v: [Row<K>; V],
    ) -> Interpolant<T, N> {
        let h = interval.length::<T>();
        let mut interpolant = hermite::quintic(interval, from, to, &self.a[0], a1);
        for (term, row) in q.into_iter().enumerate() {
            interpolant.q[5 + term] = self.weighted(row).map(|sum| h * h * sum);
        }
        for (term, row) in v.into_iter().enumerate() {
            interpolant.v[3 + term] = self.weighted(row).map(|sum| h * sum);
        }
        interpolant.terms = 5 + Q;
        interpolant
    }
}
