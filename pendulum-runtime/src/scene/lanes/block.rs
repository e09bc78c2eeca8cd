//! A block of lanes: pendulums of one type that are computed together.

use crate::integrate::sum::Sum;
use crate::real::{Float, Lane, Real};
use crate::scene::lanes::system::{Hung, W, Wide};
use crate::system::System;

/// [`W`] pendulums of one type.
pub(crate) struct Block<S: Hung<T, N>, T: Lane + Float, const N: usize> {
    pub(crate) prepared: <S::Lanes as System<N>>::Prepared,
    pub(crate) q: Sum<Wide<T>, N>,
    pub(crate) v: Sum<Wide<T>, N>,
    /// The state one tick before.
    pub(crate) before: [[Wide<T>; N]; 2],
    /// By lane, the track that it follows.
    pub(crate) track: [u32; W],
    /// The lanes whose state has ceased to be finite, by bit, and the ticks since the beginning of
    /// the batch when it did.
    pub(crate) failed: u64,
    pub(crate) failed_at: [u8; W],
    /// Damping and stops, if any lane has them.
    pub(crate) extras: Option<Box<Extras<T, N>>>,
}

/// What most steps do not read of [`W`] pendulums: between the states it would only use up the
/// caches.
pub(crate) struct Rare<S: Hung<T, N>, T: Lane + Float, const N: usize> {
    pub(crate) system: S::Lanes,
    /// By lane, its number in the group.
    pub(crate) id: [u32; W],
    /// Whether parameters have changed, so that `system` and what it has prepared must be made
    /// anew.
    pub(crate) stale: bool,
}

/// What acts on pendulums beside their equations.
#[derive(Clone, Debug)]
pub(crate) struct Extras<T, const N: usize> {
    /// γ in 1/s.
    pub(crate) damping: Wide<T>,
    /// e^(−γh/2) for the whole step of the bucket.
    pub(crate) factor: Wide<T>,
    /// Some lane has stops.
    pub(crate) stops: bool,
    pub(crate) low: [Wide<T>; N],
    pub(crate) high: [Wide<T>; N],
    /// What is left of the velocity after a hard stop.
    pub(crate) restitution: Wide<T>,
    /// The acceleration in 1/s² per unit beyond a soft stop; zero for hard ones.
    pub(crate) stiffness: Wide<T>,
    /// One where the stop is hard, zero where it is soft.
    pub(crate) hard: Wide<T>,
}

impl<T: Lane + Float, const N: usize> Extras<T, N> {
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

impl<S: Hung<T, N>, T: Lane + Float, const N: usize> Block<S, T, N> {
    /// A block of pendulums like `prototype`, at rest at zero.
    pub(crate) fn new(prototype: &S) -> (Self, Rare<S, T, N>) {
        let system = prototype.widen(Wide::splat);
        let zero = [Wide::from_f64(0.0); N];
        let block = Self {
            prepared: system.prepare(),
            q: Sum::new(zero),
            v: Sum::new(zero),
            before: [zero; 2],
            track: [0; W],
            failed: 0,
            failed_at: [0; W],
            extras: None,
        };
        (block, Rare { system, id: [0; W], stale: false })
    }

    /// The state of a lane: coordinates and velocities.
    pub(crate) fn state(&self, lane: usize) -> ([T; N], [T; N]) {
        (self.q.high.map(|q| q.0[lane]), self.v.high.map(|v| v.0[lane]))
    }
}
