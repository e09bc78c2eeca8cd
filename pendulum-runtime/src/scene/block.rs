//! A block of lanes: pendulums of one type that are computed together.

use super::hung::{Hung, W, Wide};
use crate::integrate::step::compensated::Compensated;
use crate::real::{Float, Lane, Real};
use crate::system::System;

/// [`W`] pendulums of one type.
pub(super) struct Block<S: Hung<T, N>, T: Lane + Float, const N: usize> {
    pub(super) prepared: <S::Lanes as System<N>>::Prepared,
    pub(super) q: Compensated<Wide<T>, N>,
    pub(super) v: Compensated<Wide<T>, N>,
    /// The state one tick before.
    pub(super) before: [[Wide<T>; N]; 2],
    /// By lane, the track that it follows.
    pub(super) track: [u32; W],
    /// The lanes whose state has ceased to be finite, by bit, and the ticks since the beginning of
    /// the batch when it did.
    pub(super) failed: u64,
    pub(super) failed_at: [u8; W],
    /// Damping and stops, if any lane has them.
    pub(super) extras: Option<Box<Extras<T, N>>>,
}

/// What most steps do not read of [`W`] pendulums: between the states it would only use up the
/// caches.
pub(super) struct Rare<S: Hung<T, N>, T: Lane + Float, const N: usize> {
    pub(super) system: S::Lanes,
    /// By lane, its number in the group.
    pub(super) id: [u32; W],
    /// Whether parameters have changed, so that `system` and what it has prepared must be made
    /// anew.
    pub(super) stale: bool,
}

/// What acts on pendulums beside their equations.
#[derive(Clone, Debug)]
pub(super) struct Extras<T, const N: usize> {
    /// γ in 1/s.
    pub(super) damping: Wide<T>,
    /// e^(−γh/2) for the whole step of the bucket.
    pub(super) factor: Wide<T>,
    /// Some lane has stops.
    pub(super) stops: bool,
    pub(super) low: [Wide<T>; N],
    pub(super) high: [Wide<T>; N],
    /// What is left of the velocity after a hard stop.
    pub(super) restitution: Wide<T>,
    /// The acceleration in 1/s² per unit beyond a soft stop; zero for hard ones.
    pub(super) stiffness: Wide<T>,
    /// One where the stop is hard, zero where it is soft.
    pub(super) hard: Wide<T>,
}

impl<T: Lane + Float, const N: usize> Extras<T, N> {
    pub(super) fn none() -> Self {
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
pub(super) fn half_decay<T: Real>(damping: T, h: f64) -> T {
    (damping * T::from_f64(-0.5 * h)).exp()
}

impl<S: Hung<T, N>, T: Lane + Float, const N: usize> Block<S, T, N> {
    /// A block of pendulums like `prototype`, at rest at zero.
    pub(super) fn new(prototype: &S) -> (Self, Rare<S, T, N>) {
        let system = prototype.widen(Wide::splat);
        let zero = [Wide::from_f64(0.0); N];
        let block = Self {
            prepared: system.prepare(),
            q: Compensated::new(zero),
            v: Compensated::new(zero),
            before: [zero; 2],
            track: [0; W],
            failed: 0,
            failed_at: [0; W],
            extras: None,
        };
        (block, Rare { system, id: [0; W], stale: false })
    }

    /// The state of a lane: coordinates and velocities.
    pub(super) fn state(&self, lane: usize) -> ([T; N], [T; N]) {
        (self.q.high.map(|q| q.0[lane]), self.v.high.map(|v| v.0[lane]))
    }
}
