//! Changes of motions and parameters.

use crate::motion::{Orders, Side};
use crate::real::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::group::joints::{check_motion, inputs_at};
use crate::scene::group::members::Group;
use crate::scene::lanes::system::Hung;
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::Place;
use crate::system::{Purpose, scalar_time};
use crate::time::Time;

/// What becomes of the swing when a joint is given another motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carry {
    /// Coordinates and velocities stay: a teleport that nobody feels.
    Swing,
    /// The momenta stay: a jump in the velocity of the joint is a blow.
    Momentum,
    /// The pendulums hang at rest.
    Rest,
}

impl<S: Hung<T, N>, T: Lane + Float, const N: usize> Group<S, T, N> {
    /// Lets all pendulums hang at rest.
    pub(super) fn reset(&mut self, clock: &Clock, places: &[Place<T>]) -> Result<(), SceneError> {
        (0..self.table.len() as u32).try_for_each(|id| self.rest(clock, places, id))
    }

    /// Whether a motion has what those on a joint need.
    pub(super) fn accepts_motion(&self, joint: u32, has: Orders) -> Result<(), SceneError> {
        for bucket in &self.buckets {
            for track in 0..bucket.tracks.count() as u32 {
                for (input, &other) in bucket.tracks.joints(track).iter().enumerate() {
                    if other == joint {
                        check_motion(&S::FACTS, input, has)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// A joint has another motion than `before`.
    pub(super) fn moved(
        &mut self,
        clock: &Clock,
        before: &[Place<T>],
        places: &[Place<T>],
        joint: u32,
        carry: Carry,
    ) -> Result<(), SceneError> {
        let time = Time::new(clock.time(clock.tick()));
        for id in 0..self.table.len() as u32 {
            if !self.joints(id).contains(&joint) {
                continue;
            }
            let mut loose = self.read(id);
            if carry == Carry::Momentum {
                let inputs = |places, side| {
                    inputs_at::<S, T, N>(places, &loose.joints, time, side, Purpose::Momenta, false)
                };
                let (old, new) = (inputs(before, Side::Before), inputs(places, Side::After));
                let (system, t) = (self.system_of(&loose.parameters), scalar_time(time));
                let [q, _, v, ..] = loose.state;
                if old != new {
                    let after = system.velocities(t, &q, &system.momenta(t, &q, &v, &old), &new);
                    // One whose equations have no solution keeps its velocity, and fails in the
                    // next tick, which says why.
                    if after.iter().all(|v| v.is_finite()) {
                        (loose.state[2], loose.state[3]) = (after, [T::from_f64(0.0); N]);
                    }
                }
            }
            self.rewrite(clock, places, &loose);
            if carry == Carry::Rest {
                self.rest(clock, places, id)?;
            }
            self.rouse(id);
            self.unmake_bed(id);
        }
        Ok(())
    }

    /// Sets a parameter of all, if they have it.
    pub(super) fn set_parameter(
        &mut self,
        clock: &Clock,
        places: &[Place<T>],
        name: &str,
        value: T,
    ) -> Option<usize> {
        let index = S::FACTS.parameters.iter().position(|parameter| *parameter == name)?;
        for id in 0..self.table.len() as u32 {
            let mut loose = self.read(id);
            loose.parameters[index] = value;
            self.rewrite(clock, places, &loose);
            self.rouse(id);
        }
        self.beds.clear();
        Some(self.table.len())
    }
}
