//! The clock, the joints and the samples of a scene, and the inputs of systems on its joints.

use crate::sampling::carried::{Carrier, Place, Ride};
use crate::sampling::clock::Clock;
use crate::sampling::joint::{Drive, JointSlot, drives, erase};
use crate::sampling::live::{Course, Steer};
use crate::sampling::tracks::{Shared, Tracks};
use crate::system::{Layout, Layouts, ORDERS, SceneSystem};
use pendulum_core::motion::{Derivatives, Side, Still};
use pendulum_core::scalar::Float;
use pendulum_core::system::{Purpose, Samples};
use pendulum_core::time::Time;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The maximum number of numbers of the inputs of a pendulum that carries joints: eight attitudes
/// with their derivatives.
pub(crate) const MOST_NUMBERS: usize = 96;

/// The clock, the joints and the samples of a scene.
pub(crate) struct World<T> {
    pub(crate) clock: Clock,
    pub(crate) joints: Vec<JointSlot<T>>,
    /// For each joint, the number of joints that have had its index before.
    pub(crate) generations: Vec<u32>,
    /// For each joint, the group and the index of each pendulum that it drives, once for each
    /// input.
    pub(crate) carries: Vec<Vec<(u32, u32)>>,
    /// The indices of removed joints, to be used again.
    free: Vec<u32>,
    pub(crate) tracks: Vec<Tracks<T>>,
    /// The indices of the live joints.
    pub(crate) live: Vec<u32>,
    /// The pendulums that carry joints, in the order in which they are computed.
    pub(crate) carriers: BTreeMap<Place, Carrier<T>>,
    /// For each joint, the pendulum that carries it, if any.
    pub(crate) carried: Vec<Option<Place>>,
    /// The times at which the last two frames with ticks ended.
    frames: [f64; 2],
}

impl<T: Float> World<T> {
    pub(crate) const fn new(clock: Clock, joints: Vec<JointSlot<T>>) -> Self {
        Self {
            clock,
            joints,
            generations: Vec::new(),
            carries: Vec::new(),
            free: Vec::new(),
            tracks: Vec::new(),
            live: Vec::new(),
            carriers: BTreeMap::new(),
            carried: Vec::new(),
            frames: [0.0; 2],
        }
    }

    /// Returns the index of the tracks with these properties, and adds them if they are new.
    pub(crate) fn tracks_for(&mut self, shared: &Shared) -> usize {
        self.tracks.iter().position(|tracks| tracks.shared == *shared).unwrap_or_else(|| {
            self.tracks.push(Tracks::new(shared));
            self.tracks.len() - 1
        })
    }

    /// Samples the joints of a level in the next `ticks` ticks.
    pub(crate) fn sample(&mut self, level: u32, ticks: usize, fork: bool) {
        let Self { clock, joints, tracks, .. } = self;
        for tracks in tracks.iter_mut().filter(|tracks| tracks.shared.kind.level == level) {
            tracks.sample(clock, joints, ticks, fork);
        }
    }

    /// Returns the index that the next joint will have.
    pub(crate) fn next_joint(&self) -> u32 {
        self.free.last().copied().unwrap_or(self.joints.len() as u32)
    }

    /// Adds a joint, and returns its index and generation.
    pub(crate) fn add_joint(&mut self, slot: JointSlot<T>) -> (u32, u32) {
        if slot.drive.live().is_some() {
            let (index, live) = (self.next_joint(), &mut self.live);
            live.insert(live.partition_point(|&joint| joint < index), index);
        }
        let index = self.free.pop().unwrap_or_else(|| {
            self.joints.push(slot.clone());
            self.generations.push(0);
            self.carries.push(Vec::new());
            self.carried.push(None);
            self.joints.len() as u32 - 1
        });
        self.joints[index as usize] = slot;
        (index, self.generations[index as usize])
    }

    /// Removes a joint that carries nothing.
    pub(crate) fn remove_joint(&mut self, joint: u32) {
        let index = joint as usize;
        self.joints[index] = erase(Still::new([]), self.clock.rate());
        self.live.retain(|&live| live != joint);
        if let Some(place) = self.carried[index].take()
            && let Some(carrier) = self.carriers.get_mut(&place)
        {
            carrier.rides.retain(|ride| ride.joint != joint);
            if carrier.rides.is_empty() {
                self.carriers.remove(&place);
            }
        }
        for tracks in &mut self.tracks {
            tracks.remove(joint);
        }
        // An index without a further generation is not used again.
        self.generations[index] += 1;
        if self.generations[index] < u32::MAX {
            self.free.push(joint);
        }
    }

    /// Returns a live joint; `None` if the joint follows a motion.
    pub(crate) fn live_mut(&mut self, joint: u32) -> Option<&mut dyn Steer> {
        // Another reference exists only while the motion of a joint is replaced.
        Arc::get_mut(&mut self.joints[joint as usize].drive)?.live_mut()
    }

    /// Applies `change` to all live joints.
    pub(crate) fn each_live(&mut self, mut change: impl FnMut(u32, &mut dyn Steer)) {
        for index in 0..self.live.len() {
            let joint = self.live[index];
            if let Some(live) = self.live_mut(joint) {
                change(joint, live);
            }
        }
    }

    /// Begins a frame of `ticks` ticks for the live joints, and appends those that do not continue
    /// their motion to `others`, in ascending order.
    pub(crate) fn begin_frame(&mut self, ticks: u64, others: &mut Vec<(u32, Course)>) {
        let [before, begin] = self.frames;
        let ends = [before, begin, self.clock.asked(ticks)];
        self.frames = [begin, ends[2]];
        self.each_live(|joint, live| {
            let course = live.frame(ends);
            if course != Course::Continues {
                others.push((joint, course));
            }
        });
    }

    /// Returns all numbers on which the motions of live joints depend.
    pub(crate) fn save_live(&self) -> Vec<f64> {
        let mut numbers = self.frames.to_vec();
        for live in self.live.iter().filter_map(|&joint| self.joints[joint as usize].drive.live()) {
            live.save(&mut numbers);
        }
        numbers
    }

    /// Returns `true` if there are live joints.
    pub(crate) fn has_live(&self) -> bool {
        !self.live.is_empty()
    }

    /// Restores these numbers.
    pub(crate) fn restore_live(&mut self, numbers: &[f64]) {
        if let Some((&frames, mut rest)) = numbers.split_first_chunk() {
            self.frames = frames;
            self.each_live(|_, live| live.restore(&mut rest));
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

    /// Returns the level of a pendulum on some joints.
    pub(crate) fn level(&self, joints: &[u32]) -> u32 {
        let above = |&joint: &u32| self.carried[joint as usize].map_or(0, |(level, ..)| level + 1);
        joints.iter().map(above).max().unwrap_or(0)
    }

    /// Returns the highest level.
    pub(crate) fn top(&self) -> u32 {
        self.carriers.last_key_value().map_or(0, |((level, ..), _)| level + 1)
    }

    /// Moves a carried joint through a tick.
    pub(crate) fn move_carried(&mut self, ride: &Ride, tick: i64) -> Course {
        let ends = [tick, tick + 1].map(|tick| self.clock.time(tick));
        let drive = Arc::get_mut(&mut self.joints[ride.joint as usize].drive);
        let course = drive.and_then(|drive| drive.follow(ends, &ride.states));
        course.unwrap_or(Course::Continues)
    }

    /// Returns the positions, velocities and accelerations of some joints, joint by joint;
    /// derivatives that a motion does not have are zero.
    pub(crate) fn numbers<const M: usize>(&self, joints: &[u32], t: Time) -> [T; M] {
        let (mut numbers, mut begin) = ([T::from_f64(0.0); M], 0);
        for drive in self.drives(joints) {
            // What has all derivatives is asked once; a bone under limits asks in every tick.
            let has = drive.has();
            let orders = if has == Derivatives::ALL { &[Derivatives::ALL][..] } else { &ORDERS };
            for &order in orders {
                if has.contains(order) {
                    drive.sample(t, Side::After, order, &mut numbers[begin..]);
                }
                begin += drive.components() * order.count();
            }
        }
        numbers
    }

    /// Returns the inputs of a system on joints, with the derivatives that `purpose` needs and with
    /// control inputs of zero. If `at_rest` is `true`, velocities and accelerations are zero.
    pub(crate) fn inputs<S: SceneSystem<T, N>, const N: usize>(
        &self,
        joints: &[u32],
        t: Time,
        side: Side,
        purpose: Purpose,
        at_rest: bool,
    ) -> S::Inputs {
        let layout = Layout::new(S::FACTS.inputs, Layouts::<S, N>::COMPONENTS, purpose);
        let (mut few, mut more) = ([T::from_f64(0.0); MOST_NUMBERS], Vec::new());
        let record: &mut [T] = if layout.width <= MOST_NUMBERS {
            &mut few
        } else {
            more.resize(layout.width, T::from_f64(0.0));
            &mut more
        };
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
        Samples::from_numbers(&mut |input, derivative, component| {
            let place = layout.place(input, derivative, component);
            place.map_or(T::from_f64(0.0), |place| record[place])
        })
    }
}
