//! Damping and stops of single pendulums and of blocks of lanes.

#![allow(clippy::inline_always)]

use crate::lanes::block::lane_of;
use crate::system::{Wide, octet};
use pendulum_core::scalar::{Float, Octet, Real};

/// The damping and the stops of a pendulum, or of a block of pendulums, which act in addition to
/// its equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits<T, const N: usize> {
    /// The damping γ in 1/s.
    pub(crate) damping: T,
    pub(crate) low: [T; N],
    pub(crate) high: [T; N],
    /// The fraction of the velocity after an impact on a hard stop.
    pub(crate) restitution: T,
    /// The acceleration per unit of distance beyond a soft stop, in 1/s²; zero for hard stops.
    pub(crate) stiffness: T,
    /// 1 for hard stops, 0 for soft stops.
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

impl<T: Float, const N: usize> Limits<Wide<T>, N> {
    /// Returns the limits of a lane.
    pub(crate) fn lane(&self, lane: usize) -> Limits<T, N> {
        Limits {
            damping: self.damping.0[lane],
            low: lane_of(&self.low, lane),
            high: lane_of(&self.high, lane),
            restitution: self.restitution.0[lane],
            stiffness: self.stiffness.0[lane],
            hard: self.hard.0[lane],
        }
    }

    /// Sets the limits of a lane.
    pub(crate) fn set_lane(&mut self, lane: usize, own: &Limits<T, N>) {
        for i in 0..N {
            (self.low[i].0[lane], self.high[i].0[lane]) = (own.low[i], own.high[i]);
        }
        self.damping.0[lane] = own.damping;
        self.restitution.0[lane] = own.restitution;
        self.stiffness.0[lane] = own.stiffness;
        self.hard.0[lane] = own.hard;
    }
}

/// The limits of lanes, with values derived from them.
#[derive(Clone, Debug)]
pub(crate) struct LaneLimits<L, const N: usize> {
    pub(crate) own: Limits<L, N>,
    /// The factor e^(−γh/2) for the step h of the bucket.
    pub(crate) factor: L,
    /// The square of the largest turn in a step: infinite in lanes with damping or stops.
    pub(crate) most_turn: L,
    /// `true` if a lane has stops.
    pub(crate) stops: bool,
}

impl<T: Float, const N: usize> LaneLimits<Wide<T>, N> {
    /// Returns the limits of eight lanes.
    pub(crate) fn octet(&self, part: usize) -> LaneLimits<Octet<T>, N> {
        let Limits { damping, low, high, restitution, stiffness, hard } = &self.own;
        let [low, high] = [low, high].map(|all| core::array::from_fn(|i| octet(&all[i], part)));
        let [damping, restitution, stiffness, hard, factor, most_turn] =
            [damping, restitution, stiffness, hard, &self.factor, &self.most_turn]
                .map(|all| octet(all, part));
        let own = Limits { damping, low, high, restitution, stiffness, hard };
        LaneLimits { own, factor, most_turn, stops: self.stops }
    }
}

impl<L: Real, const N: usize> LaneLimits<L, N> {
    /// Adds the accelerations of soft stops.
    #[inline(always)]
    pub(super) fn push(&self, q: &[L; N], a: &mut [L; N]) {
        for i in 0..if self.stops { N } else { 0 } {
            let (above, below) = (q[i] - self.own.high[i], q[i] - self.own.low[i]);
            let below = (-below).where_positive(below, L::from_f64(0.0));
            a[i] -= self.own.stiffness * above.where_positive(above, below);
        }
    }
}

/// Returns e^(−γh/2).
pub(crate) fn half_decay<T: Real>(damping: T, h: f64) -> T {
    (damping * T::from_f64(-0.5 * h)).exp()
}
