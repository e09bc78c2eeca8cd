//! Snapshots: the state of a scene as plain numbers.

use crate::error::{SceneError, SceneFault};
use crate::group::members::SceneStatus;
use crate::group::saved::GroupState;
use crate::scene::Scene;
use pendulum_core::scalar::{Float, Real};

/// A snapshot of a scene: the time, the states, contacts, parameters, control inputs, damping,
/// stops and statuses of all pendulums, and the last positions of live joints.
///
/// A snapshot does not contain motions, the lists of joints and pendulums, or the colliders, bounds
/// and winds of bones. It can be restored to its scene, or to a scene that was built in the same
/// way. Serialized snapshots contain the statuses of failed pendulums but not the faults:
/// [`Scene::faults`] is empty after a deserialized snapshot is restored. With `serde_json`, numbers
/// keep their bits if the feature `float_roundtrip` of `serde_json` is enabled.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Snapshot<T> {
    /// The tick, the tick at which the sum of frame times began, and this sum in two words.
    clock: (i64, i64, [f64; 2]),
    groups: Vec<GroupState<T>>,
    /// The times of the last frames, and the last positions of live joints.
    #[cfg_attr(feature = "serde", serde(default))]
    live: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(skip))]
    faults: Vec<SceneFault>,
}

/// The largest tick whose number is exact as `f64`.
const MOST_TICKS: u64 = 1 << 53;

impl<T> Snapshot<T> {
    pub(crate) fn groups(&self) -> &[GroupState<T>] {
        &self.groups
    }
}

impl<T: Float> Scene<T> {
    /// Returns a snapshot of the scene.
    pub fn snapshot(&self) -> Snapshot<T> {
        let groups = self.groups.iter().map(|(_, group)| group.save()).collect();
        Snapshot {
            clock: self.world.clock.state(),
            groups,
            live: self.world.save_live(),
            faults: self.faults.clone(),
        }
    }

    /// Restores the scene to the state of a snapshot. The motion continues with the same bits as
    /// after the snapshot was taken, also on live joints that are told the same positions again. If
    /// a joint is somewhere else by now, [`teleport`](Self::teleport) moves it there.
    ///
    /// # Errors
    /// Returns an error if the snapshot belongs to another scene or is damaged.
    pub fn restore(&mut self, snapshot: &Snapshot<T>) -> Result<(), SceneError> {
        if snapshot.groups.len() != self.groups.len() {
            return Err(SceneError::Snapshot("the numbers of types differ"));
        }
        for ((_, group), state) in self.groups.iter().zip(&snapshot.groups) {
            group.accepts(state)?;
        }
        let (tick, origin, asked) = snapshot.clock;
        if MOST_TICKS < tick.unsigned_abs().max(origin.unsigned_abs())
            || asked.iter().any(|asked| !asked.is_finite())
        {
            return Err(SceneError::Snapshot("it holds a time that is out of range"));
        }
        // Snapshots that are older than live joints lack the times of frames.
        let older = snapshot.live.is_empty() && !self.world.has_live();
        if !older && snapshot.live.len() != self.world.save_live().len() {
            return Err(SceneError::Snapshot("the numbers of live joints differ"));
        }
        if snapshot.live.iter().any(|number| !number.is_finite()) {
            return Err(SceneError::Snapshot("it holds a position that is not finite"));
        }
        self.world.clock.restore(snapshot.clock);
        self.world.restore_live(&snapshot.live);
        for ((_, group), state) in self.groups.iter_mut().zip(&snapshot.groups) {
            group.restore(&mut self.world, state);
        }
        self.carry_all(false);
        self.faults.clone_from(&snapshot.faults);
        Ok(())
    }

    /// Returns a checksum of the tick and of all states, parameters and limits. Scenes with the
    /// same values at the same tick, to the last bit, have equal checksums, regardless of their
    /// frames.
    pub fn checksum(&self) -> u64 {
        self.snapshot().checksum()
    }
}

impl<T: Real + Float> Snapshot<T> {
    /// Returns a checksum of the tick and of all states, parameters and limits. Snapshots with the
    /// same values to the last bit have equal checksums. The fraction of a tick requested by frames
    /// does not count.
    pub fn checksum(&self) -> u64 {
        let mut hash = Hash::new();
        hash.add(self.clock.0 as u64);
        for group in &self.groups {
            hash.add(group.pendulums.len() as u64);
            for &(scheme, substeps, status) in &group.pendulums {
                let (status, tick) = match status {
                    SceneStatus::Awake => (0, 0),
                    SceneStatus::Asleep(tick) => (1, tick),
                    SceneStatus::Hidden(tick) => (2, tick),
                    SceneStatus::Failed => (3, 0),
                };
                hash.add(scheme as u64 | u64::from(substeps) << 8 | status << 40);
                hash.add(tick as u64);
            }
            for number in &group.numbers {
                hash.add(number.to_f64().to_bits());
            }
        }
        hash.value()
    }
}

/// The hash FNV-1a of Fowler, Noll and Vo over words of 64 bits, with a final mixing of the bits.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf29ce484222325)
    }

    fn add(&mut self, word: u64) {
        // Without the shifted word and the rotation, high bits would not influence low bits.
        self.0 = (self.0 ^ word ^ (word >> 32)).wrapping_mul(0x100000001b3).rotate_left(23);
    }

    fn value(&self) -> u64 {
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58476d1ce4e5b9);
        mixed ^ (mixed >> 31)
    }
}
