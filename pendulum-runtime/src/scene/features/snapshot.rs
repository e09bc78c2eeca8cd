//! Everything that changes while a scene runs, as plain numbers.

use crate::scalar::{Float, Lane, Real};
use crate::scene::error::{SceneError, SceneFault};
use crate::scene::features::hash;
use crate::scene::group::saved::GroupState;
use crate::scene::group::status::SceneStatus;
use crate::scene::scene::Scene;

/// The state of a scene: time, states, parameters, damping, stops, who sleeps and who has failed.
///
/// Motions and the list of joints and pendulums are not in it: it is restored to the scene that it
/// was taken of, or to one that was built in the same way. Written to a file, it keeps who has
/// failed and not why: [`Scene::faults`] is empty after it was read. With `serde_json` the bits
/// stay what they are if its feature `float_roundtrip` is on.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Snapshot<T> {
    /// Tick, tick at which the sum of frame times began, that sum in two words.
    clock: (i64, i64, [f64; 2]),
    groups: Vec<GroupState<T>>,
    #[cfg_attr(feature = "serde", serde(skip))]
    faults: Vec<SceneFault>,
}

/// The time of a tick beyond these is no longer exact.
const MOST_TICKS: u64 = 1 << 53;

impl<T> Snapshot<T> {
    pub(crate) fn groups(&self) -> &[GroupState<T>] {
        &self.groups
    }
}

impl<T: Lane + Float> Scene<T> {
    /// Everything that changes while the scene runs.
    pub fn snapshot(&self) -> Snapshot<T> {
        let groups = self.groups.iter().map(|(_, group)| group.save()).collect();
        Snapshot { clock: self.clock.state(), groups, faults: self.faults.clone() }
    }

    /// Puts the scene back to where a snapshot was taken; what follows has the same bits as it had
    /// then.
    ///
    /// # Errors
    /// A snapshot of another scene, or one that was damaged.
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
        self.clock.restore(snapshot.clock);
        for ((_, group), state) in self.groups.iter_mut().zip(&snapshot.groups) {
            group.restore(&self.joint_slots, state);
        }
        self.faults.clone_from(&snapshot.faults);
        self.dirty = true;
        Ok(())
    }

    /// A number that two scenes share that are in the same state at the same tick, to the last bit,
    /// whatever the frames were.
    pub fn checksum(&self) -> u64 {
        self.snapshot().checksum()
    }
}

impl<T: Real + Float> Snapshot<T> {
    /// A number that two snapshots share whose tick and states are the same to the last bit; the
    /// part of a tick that frames have asked for beyond does not count.
    pub fn checksum(&self) -> u64 {
        let mut hash = hash::Hash::new();
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
