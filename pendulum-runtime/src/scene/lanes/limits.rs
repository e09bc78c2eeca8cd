//! Damping and stops, of one pendulum and of a block of lanes.

use crate::scalar::{Float, Lane, Real};
use crate::scene::lanes::system::Wide;

/// Damping and stops of one pendulum, which act beside its equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits<T, const N: usize> {
    pub(crate) damping: T,
    pub(crate) low: [T; N],
    pub(crate) high: [T; N],
    pub(crate) restitution: T,
    pub(crate) stiffness: T,
    pub(crate) hard: T,
}

impl<T: Real, const N: usize> Limits<T, N> {
    pub(crate) fn none() -> Self {
        let number = T::from_f64;
        Self {
            damping: number(0.0),
            low: [number(f64::NEG_INFINITY); N],
            high: [number(f64::INFINITY); N],
            restitution: number(0.0),
            stiffness: number(0.0),
            hard: number(1.0),
        }
    }

    /// Returns true if the limits are walls.
    pub(crate) fn is_hard(&self) -> bool {
        self.hard != T::from_f64(0.0)
    }

    /// The nearest coordinates within the limits.
    pub(crate) fn inside(&self, q: &[T; N]) -> [T; N] {
        core::array::from_fn(|i| Real::min(Real::max(q[i], self.low[i]), self.high[i]))
    }

    /// The accelerations of soft stops, −k times what lies beyond the limits.
    pub(crate) fn push(&self, q: &[T; N]) -> [T; N] {
        let inside = self.inside(q);
        core::array::from_fn(|i| self.stiffness * (inside[i] - q[i]))
    }

    /// Holds a state within hard limits: what lies beyond them lies at them, and goes no further
    /// out.
    pub(crate) fn hold(&self, q: &mut [T; N], v: &mut [T; N]) {
        if !self.is_hard() {
            return;
        }
        let (inside, zero) = (self.inside(q), T::from_f64(0.0));
        for i in 0..N {
            if inside[i] != q[i] {
                v[i] = if inside[i] == self.low[i] {
                    Real::max(v[i], zero)
                } else {
                    Real::min(v[i], zero)
                };
                q[i] = inside[i];
            }
        }
    }
}

/// Damping and stops of a block of pendulums, which act beside their equations.
#[derive(Clone, Debug)]
pub(crate) struct LaneLimits<T, const N: usize> {
    /// γ in 1/s.
    pub(crate) damping: Wide<T>,
    /// e^(−γh/2) for the whole step of the bucket.
    pub(crate) factor: Wide<T>,
    /// Some lane has stops.
    pub(crate) stops: bool,
    pub(crate) low: [Wide<T>; N],
    pub(crate) high: [Wide<T>; N],
    /// The part of the velocity that a hard stop leaves.
    pub(crate) restitution: Wide<T>,
    /// The acceleration in 1/s² per unit beyond a soft stop; zero for hard ones.
    pub(crate) stiffness: Wide<T>,
    /// One where the stop is hard, zero where it is soft.
    pub(crate) hard: Wide<T>,
}

impl<T: Lane + Float, const N: usize> LaneLimits<T, N> {
    pub(crate) fn none() -> Self {
        let lanes = |value| Wide::from_f64(value);
        Self {
            damping: lanes(0.0),
            factor: lanes(1.0),
            stops: false,
            low: [lanes(f64::NEG_INFINITY); N],
            high: [lanes(f64::INFINITY); N],
            restitution: lanes(0.0),
            stiffness: lanes(0.0),
            hard: lanes(1.0),
        }
    }
}

/// e^(−γh/2).
pub(crate) fn half_decay<T: Real>(damping: T, h: f64) -> T {
    (damping * T::from_f64(-0.5 * h)).exp()
}
