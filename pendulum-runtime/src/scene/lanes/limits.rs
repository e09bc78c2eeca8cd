//! Damping and stops of single pendulums and of blocks of lanes.

use crate::scalar::{Float, Lane, Real};
use crate::scene::system::Wide;

/// The damping and the stops of a pendulum, which act in addition to its equations.
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

    /// Returns `true` if the stops are walls.
    pub(crate) fn is_hard(&self) -> bool {
        self.hard != T::from_f64(0.0)
    }

    /// Returns the nearest coordinates within the limits.
    pub(crate) fn inside(&self, q: &[T; N]) -> [T; N] {
        core::array::from_fn(|i| Real::min(Real::max(q[i], self.low[i]), self.high[i]))
    }

    /// Returns the accelerations of soft stops: −k times the distance beyond the limits.
    pub(crate) fn push(&self, q: &[T; N]) -> [T; N] {
        let inside = self.inside(q);
        core::array::from_fn(|i| self.stiffness * (inside[i] - q[i]))
    }

    /// Clamps a state to hard limits: coordinates beyond a limit are set to the limit, and their
    /// outward velocities to zero.
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

/// The damping and the stops of a block of pendulums, which act in addition to their equations.
#[derive(Clone, Debug)]
pub(crate) struct LaneLimits<T, const N: usize> {
    /// The damping γ in 1/s.
    pub(crate) damping: Wide<T>,
    /// The factor e^(−γh/2) for the step h of the bucket.
    pub(crate) factor: Wide<T>,
    /// `true` if a lane has stops.
    pub(crate) stops: bool,
    pub(crate) low: [Wide<T>; N],
    pub(crate) high: [Wide<T>; N],
    /// The fraction of the velocity after an impact on a hard stop.
    pub(crate) restitution: Wide<T>,
    /// The acceleration per unit of distance beyond a soft stop, in 1/s²; zero for hard stops.
    pub(crate) stiffness: Wide<T>,
    /// 1 for hard stops, 0 for soft stops.
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

/// Returns e^(−γh/2).
pub(crate) fn half_decay<T: Real>(damping: T, h: f64) -> T {
    (damping * T::from_f64(-0.5 * h)).exp()
}
