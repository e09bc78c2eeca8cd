//! The clock, the joints and the samples of a scene, and the inputs of systems on its joints.

use crate::sampling::clock::Clock;
use crate::sampling::joint::{Drive, JointSlot, drives};
use crate::sampling::tracks::{Shared, Tracks};
use crate::system::{By, FromNumbers, Layout, SceneSystem};
use pendulum_core::motion::{Derivatives, Side};
use pendulum_core::scalar::{Float, Lane};
use pendulum_core::system::Purpose;
use pendulum_core::time::Time;

/// The clock, the joints and the samples of a scene.
pub(crate) struct World<T> {
    pub(crate) clock: Clock,
    pub(crate) joints: Vec<JointSlot<T>>,
    pub(crate) tracks: Vec<Tracks<T>>,
}

impl<T: Lane + Float> World<T> {
    pub(crate) const fn new(clock: Clock, joints: Vec<JointSlot<T>>) -> Self {
        Self { clock, joints, tracks: Vec::new() }
    }

    /// Returns the index of the tracks with these properties, and adds them if they are new.
    pub(crate) fn tracks_for(&mut self, shared: &Shared) -> usize {
        self.tracks.iter().position(|tracks| tracks.shared == *shared).unwrap_or_else(|| {
            self.tracks.push(Tracks::new(shared));
            self.tracks.len() - 1
        })
    }

    /// Samples the next `ticks` ticks.
    pub(crate) fn sample(&mut self, ticks: usize, fork: bool) {
        let Self { clock, joints, tracks } = self;
        for tracks in tracks {
            tracks.sample(clock, joints, ticks, fork);
        }
    }

    /// Returns the time of the last tick.
    pub(crate) fn now(&self) -> f64 {
        self.clock.time(self.clock.tick())
    }

    /// Returns the motions of some joints.
    pub(crate) fn drives<'a>(
        &'a self,
        joints: &'a [u32],
    ) -> impl Iterator<Item = &'a dyn Drive<T>> {
        drives(&self.joints, joints)
    }

    /// Returns `true` if some joints rest for ever.
    pub(crate) fn still(&self, joints: &[u32]) -> bool {
        joints.iter().all(|&joint| self.joints[joint as usize].still)
    }

    /// Returns the inputs of a system on joints, with the derivatives that `purpose` needs. If
    /// `at_rest` is `true`, velocities and accelerations are zero.
    pub(crate) fn inputs<S: SceneSystem<T, N>, const N: usize>(
        &self,
        joints: &[u32],
        t: Time,
        side: Side,
        purpose: Purpose,
        at_rest: bool,
    ) -> S::Inputs {
        let components = <S::Inputs as FromNumbers<T>>::COMPONENTS;
        let layout = Layout::new(S::FACTS.inputs, components, purpose);
        let mut record = vec![T::from_f64(0.0); layout.width];
        let mut begin = 0;
        for (drive, &wanted) in self.drives(joints).zip(&layout.wanted) {
            let position = wanted.contains(Derivatives::POSITION);
            let sampled = match (at_rest, position) {
                (false, _) => wanted,
                (true, true) => Derivatives::POSITION,
                (true, false) => Derivatives::NONE,
            };
            drive.sample(t, side, sampled, &mut record[begin..]);
            begin += drive.components() * wanted.count();
        }
        FromNumbers::from_numbers(&mut By(|input, derivative, component| {
            let place = layout.place(input, derivative, component);
            place.map_or(T::from_f64(0.0), |place| record[place])
        }))
    }
}
