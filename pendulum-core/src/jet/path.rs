//! The series of a motion and of the values that its equations compute.

use crate::jet::order::Order;
use crate::jet::sum::Pairs;
use crate::motion::series::{LENGTH, Series, zero};
use crate::scalar::Real;

/// The series of a motion.
#[derive(Clone, Debug)]
pub struct Path<T, const N: usize> {
    /// The time at the start.
    pub t: T,
    /// The coordinates.
    pub q: [Series<T>; N],
    /// The velocities.
    pub v: [Series<T>; N],
    /// The accelerations.
    pub a: [Series<T>; N],
    /// The reciprocals of the numbers 1, 2, ….
    pub reciprocals: Reciprocals<T>,
}

/// The reciprocals of the numbers 1, 2, ….
#[derive(Clone, Debug)]
pub struct Reciprocals<T>(Series<T>);

impl<T: Real> Reciprocals<T> {
    /// Computes the reciprocals, correctly rounded.
    pub fn new() -> Self {
        Self(core::array::from_fn(|k| T::ratio(1.0, if k == 0 { 1.0 } else { k as f64 })))
    }

    /// Returns 1/k for 0 < k < [`LENGTH`].
    #[inline(always)]
    pub fn of(&self, k: usize) -> T {
        self.0[k]
    }

    /// Computes x/k for 0 < k < [`LENGTH`]. Small k are divided by, because the rounding error of ⅓
    /// would be the same in every step and accumulate.
    #[inline(always)]
    pub fn over(&self, x: T, k: usize) -> T {
        if matches!(k, 3 | 5 | 6) { x / T::from_f64(k as f64) } else { x * self.0[k] }
    }
}

impl<T: Real> Default for Reciprocals<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize> Path<T, N> {
    /// Creates series that are zero.
    pub fn new() -> Self {
        let zero = [zero(); N];
        Self { t: T::from_f64(0.0), q: zero, v: zero, a: zero, reciprocals: Reciprocals::new() }
    }

    /// Computes the coefficients k + 1 of q and q̇ from the accelerations of order k: ẋ = y is
    /// (k+1) x\[k+1\] = y\[k\].
    #[inline(always)]
    pub fn integrate<O: Order>(&mut self, order: O) {
        let k = order.index();
        for i in 0..N {
            self.q[i][k + 1] = self.reciprocals.over(self.v[i][k], k + 1);
            self.v[i][k + 1] = self.reciprocals.over(self.a[i][k], k + 1);
        }
    }
}

impl<T: Real, const N: usize> Default for Path<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

/// The workspace of generated code: `W` series, `Q` pairs of series, `P` values that depend only on
/// parameters, `L` values that are computed once per step, and the factors of the blocks of the
/// mass matrix.
#[derive(Clone, Debug)]
pub struct Work<T, F, const W: usize, const Q: usize, const P: usize, const L: usize> {
    /// The series of operands of products and functions.
    pub series: [Series<T>; W],
    /// Sines and cosines.
    pub pairs: [Pairs<T>; Q],
    /// Values that depend only on parameters.
    pub parameter_only: [T; P],
    /// Values that depend only on leading coefficients: reciprocals and signs.
    pub leading: [T; L],
    /// The factors of the mass matrix at the start of the step.
    pub factors: F,
}

impl<T: Real, F, const W: usize, const Q: usize, const P: usize, const L: usize>
    Work<T, F, W, Q, P, L>
{
    /// Creates a workspace with the values `parameter_only`, and zero series.
    pub fn new(parameter_only: [T; P], factors: F) -> Self {
        let zero_number = T::from_f64(0.0);
        Self {
            series: [zero(); W],
            pairs: [[[zero_number; 2]; LENGTH]; Q],
            parameter_only,
            leading: [zero_number; L],
            factors,
        }
    }
}
