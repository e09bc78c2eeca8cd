//! A block of lanes: pendulums of one type that are computed together.

use crate::integrate::state::compensated::Compensated;
use crate::scalar::{Float, Lane, Real};
use crate::scene::lanes::limits::LaneLimits;
use crate::scene::lanes::system::{SceneSystem, W, Wide};
use crate::system::{InLanes, LaneSystem, System};

/// [`W`] pendulums of one type.
pub(crate) struct Block<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> {
    pub(crate) prepared: <S::Wide as System<N>>::Prepared,
    pub(crate) q: Compensated<Wide<T>, N>,
    pub(crate) v: Compensated<Wide<T>, N>,
    /// The state one tick before.
    pub(crate) before: [[Wide<T>; N]; 2],
    /// By lane, the track that it follows.
    pub(crate) track: [u32; W],
    /// The lanes whose state has ceased to be finite, by bit, and the ticks since the beginning of
    /// the batch when it did.
    pub(crate) failed: u64,
    pub(crate) failed_at: [u8; W],
    /// Damping and stops, if any lane has them.
    pub(crate) limits: Option<Box<LaneLimits<T, N>>>,
}

/// Data of [`W`] pendulums that most steps do not read: between the states they would only use up
/// the caches.
pub(crate) struct ColdData<S: LaneSystem<InLanes<W>, N>, const N: usize> {
    pub(crate) system: S::Wide,
    /// By lane, its number in the group.
    pub(crate) id: [u32; W],
    /// Parameters have changed, so that `system` and its prepared values must be made anew.
    pub(crate) stale: bool,
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> Block<S, T, N> {
    /// A block of pendulums like `prototype`, at rest at zero.
    pub(crate) fn new(prototype: &S) -> (Self, ColdData<S, N>) {
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
            limits: None,
        };
        (block, ColdData { system, id: [0; W], stale: false })
    }

    /// The state of a lane: coordinates and velocities.
    pub(crate) fn state(&self, lane: usize) -> ([T; N], [T; N]) {
        (self.q.high.map(|q| q.0[lane]), self.v.high.map(|v| v.0[lane]))
    }
}
