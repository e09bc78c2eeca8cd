//! Truncated Taylor series in time, for velocities and accelerations in a hierarchy.

use core::ops::{Add, Mul, Sub};
use pendulum_core::scalar::Real;

/// The first `N` Taylor coefficients of a function of time: the value, the first derivative, and
/// half of the second derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Jet<const N: usize>(pub(super) [f64; N]);

impl<const N: usize> Jet<N> {
    /// Creates a constant.
    pub(super) fn constant(value: f64) -> Self {
        let mut jet = [0.0; N];
        jet[0] = value;
        Self(jet)
    }

    /// Computes the power a of a positive series: k s₀ r_k = Σ_{j=1}^k (a j − (k − j)) s_j r_{k−j}
    /// (Knuth, TAOCP 2, section 4.7).
    fn power(self, first: f64, exponent: f64) -> Self {
        let mut jet = Self::constant(first);
        for k in 1..N {
            let mut sum = 0.0;
            for j in 1..=k {
                sum += (exponent * j as f64 - (k - j) as f64) * self.0[j] * jet.0[k - j];
            }
            jet.0[k] = sum / (k as f64 * self.0[0]);
        }
        jet
    }

    /// Computes 1/√s of a positive series.
    pub(super) fn reciprocal_root(self) -> Self {
        self.power(1.0 / Real::sqrt(self.0[0]), -0.5)
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a += b;
        }
        self
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;

    fn sub(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a -= b;
        }
        self
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;

    /// Computes the Cauchy product.
    fn mul(self, other: Self) -> Self {
        let mut product = [0.0; N];
        for k in 0..N {
            for j in 0..=k {
                product[k] += self.0[j] * other.0[k - j];
            }
        }
        Self(product)
    }
}

/// Computes the cross product a × b.
pub(super) fn cross<const N: usize>(a: &[Jet<N>; 3], b: &[Jet<N>; 3]) -> [Jet<N>; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Computes the product a∘b of quaternions (x, y, z, w).
pub(super) fn product<const N: usize>(a: &[Jet<N>; 4], b: &[Jet<N>; 4]) -> [Jet<N>; 4] {
    let ([ax, ay, az, aw], [bx, by, bz, bw]) = (*a, *b);
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// Rotates p by the unit quaternion q = (v, w): p + 2 w v × p + 2 v × (v × p).
pub(super) fn turned<const N: usize>(q: &[Jet<N>; 4], p: &[Jet<N>; 3]) -> [Jet<N>; 3] {
    let [x, y, z, w] = *q;
    let once = cross(&[x, y, z], p);
    let twice = cross(&[x, y, z], &once);
    let part = |axis: usize| w * once[axis] + twice[axis];
    [0, 1, 2].map(|axis| p[axis] + part(axis) + part(axis))
}
