//! Tracks: the samples of joints that pendulums use during a batch of ticks.
//!
//! Pendulums of several types share tracks if they take the same steps and need the same
//! derivatives: each joint is sampled once for all of them, straight into the records that their
//! lanes read. Samples at times that different steps have in common are not shared: that needs a
//! table of the times of all steps and a copy of every sample, and leapfrog has no such times.

#![allow(clippy::inline_always)]

use crate::sampling::clock::Clock;
use crate::sampling::joint::{Drive, JointSlot, drives};
use crate::sampling::scheme::{Kind, MOST_STAGES};
use crate::system::Layout;
use crate::threads::{part, share};
use pendulum_core::integrate::method::StepInterval;
use pendulum_core::motion::{Derivatives, Side};
use pendulum_core::scalar::{Float, Real};
use pendulum_core::time::Time;
use std::collections::BTreeMap;

/// The maximum number of ticks in a batch.
pub(crate) const BATCH: usize = 8;

/// The properties of pendulums that share tracks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shared {
    pub(crate) kind: Kind,
    /// The number of joints of a track.
    pub(crate) inputs: usize,
    /// The layouts of the records for accelerations and for momenta.
    pub(crate) forces: Layout,
    pub(crate) momenta: Layout,
}

/// The distinct tuples of joints of some pendulums, and their samples.
#[derive(Debug)]
pub(crate) struct Tracks<T> {
    pub(crate) shared: Shared,
    /// The times of all evaluations of the batch, tick by tick.
    pub(crate) times: Vec<Time>,
    /// The joints of all tracks, one track after the other.
    joints: Vec<u32>,
    /// The next kinks of these joints.
    kinks: Vec<NextKink>,
    by_joints: BTreeMap<Vec<u32>, u32>,
    /// The tracks of joints that have been removed, to be used again.
    free: Vec<u32>,
    /// The number of awake pendulums on each track.
    awake: Vec<u32>,
    /// `true` if joints that rest for ever have been sampled.
    sampled: bool,
    /// The ticks of the batch with a kink in them or at their ends, by track and bit.
    kinked: Vec<u32>,
    /// The records, by track, tick and evaluation.
    records: Vec<T>,
    /// The number of records of a track.
    stride: usize,
    /// By tick and track: the index of the first piece and the number of pieces, which is 0 for
    /// ticks without a kink. The vector is empty in batches without kinks.
    cuts: Vec<(u32, u32)>,
    pieces: Vec<Piece>,
    /// The records of the pieces.
    piece_records: Vec<T>,
}

/// A step in a tick that is cut at kinks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) h: f64,
    /// The times of the evaluations.
    pub(crate) times: [Time; MOST_STAGES],
    /// The index at which the records of the evaluations begin.
    pub(crate) begin: usize,
    /// The time of the kink at the end of the piece, and the index at which the records for the
    /// momenta before and after the kink begin; `None` without such a kink.
    pub(crate) jump: Option<(f64, usize)>,
}

/// The next kink of a joint, as found by the last search.
#[derive(Clone, Copy, Debug)]
struct NextKink {
    /// The time of the search: until the kink, later batches need no search.
    searched: f64,
    kink: f64,
    /// `true` if a kink shortly after the search counted as at its time.
    late: bool,
}

impl NextKink {
    /// No search has been made.
    const UNKNOWN: Self = Self { searched: f64::INFINITY, kink: f64::NEG_INFINITY, late: false };

    /// Returns `true` if there is a kink in (`start`, `end`], or shortly after `start` one that
    /// counts as at `start`.
    fn within<T>(&mut self, drive: &dyn Drive<T>, start: f64, end: f64) -> bool {
        if !(self.searched <= start && start < self.kink) {
            self.searched = start;
            self.kink = match drive.next_kink(start) {
                // If the next kink is not after `start`, there are no further kinks.
                Some(kink) if start < kink => kink,
                _ => f64::INFINITY,
            };
            self.late = start < drive.felt(Time::new(start)).to_f64();
        }
        self.kink <= end || self.late && self.searched == start
    }
}

/// The next ticks of a scene with its joints, and the times of samples.
struct Ticks<'a, T> {
    clock: &'a Clock,
    joints: &'a [JointSlot<T>],
    count: usize,
    times: &'a [Time],
}

impl<T: Float> Tracks<T> {
    pub(crate) const fn new(shared: &Shared) -> Self {
        Self {
            shared: *shared,
            times: Vec::new(),
            joints: Vec::new(),
            kinks: Vec::new(),
            by_joints: BTreeMap::new(),
            free: Vec::new(),
            awake: Vec::new(),
            sampled: false,
            kinked: Vec::new(),
            records: Vec::new(),
            stride: 0,
            cuts: Vec::new(),
            pieces: Vec::new(),
            piece_records: Vec::new(),
        }
    }

    /// Returns the track of `joints`, and adds it if it is new.
    pub(crate) fn find(&mut self, joints: &[u32]) -> u32 {
        if let Some(&track) = self.by_joints.get(joints) {
            return track;
        }
        let track = self.free.pop().unwrap_or_else(|| {
            self.joints.extend_from_slice(joints);
            self.kinks.resize(self.joints.len(), NextKink::UNKNOWN);
            self.awake.push(0);
            self.kinked.push(0);
            self.awake.len() as u32 - 1
        });
        let begin = track as usize * self.shared.inputs;
        self.joints[begin..][..joints.len()].copy_from_slice(joints);
        self.kinks[begin..][..joints.len()].fill(NextKink::UNKNOWN);
        self.by_joints.insert(joints.to_vec(), track);
        self.sampled = false;
        track
    }

    /// Removes the tracks with a joint that carries nothing.
    pub(crate) fn remove(&mut self, joint: u32) {
        if self.shared.inputs == 1 {
            self.free.extend(self.by_joints.remove(&[joint][..]));
            return;
        }
        let free = &mut self.free;
        self.by_joints.retain(|joints, track| {
            let stays = !joints.contains(&joint);
            if !stays {
                free.push(*track);
            }
            stays
        });
    }

    pub(crate) fn joints(&self, track: u32) -> &[u32] {
        &self.joints[track as usize * self.shared.inputs..][..self.shared.inputs]
    }

    pub(crate) fn count(&self) -> usize {
        self.awake.len()
    }

    /// Increments or decrements the number of awake pendulums on a track.
    pub(crate) fn count_awake(&mut self, track: u32, up: bool) {
        let awake = &mut self.awake[track as usize];
        // A track is not sampled while nobody is awake.
        self.sampled &= *awake != 0;
        *awake = if up { *awake + 1 } else { *awake - 1 };
    }

    /// Forgets the samples and the next kinks of a joint, before it gets another motion.
    pub(crate) fn forget(&mut self, joint: u32) {
        self.sampled = false;
        if self.shared.inputs == 1 {
            if let Some(&track) = self.by_joints.get(&[joint][..]) {
                self.kinks[track as usize] = NextKink::UNKNOWN;
            }
            return;
        }
        for (own, kink) in self.joints.iter().zip(&mut self.kinks) {
            if *own == joint {
                *kink = NextKink::UNKNOWN;
            }
        }
    }

    /// Returns `true` if a pendulum on the track is awake.
    pub(crate) fn is_awake(&self, track: usize) -> bool {
        self.awake[track] != 0
    }

    /// Calls `visit` for every joint of awake pendulums, with the derivatives that accelerations
    /// need.
    pub(crate) fn needs(&self, mut visit: impl FnMut(u32, Derivatives)) {
        for track in (0..self.count()).filter(|&track| self.is_awake(track)) {
            for (&joint, &wanted) in
                self.joints(track as u32).iter().zip(&self.shared.forces.wanted)
            {
                visit(joint, wanted);
            }
        }
    }

    /// Samples the joints of all tracks with awake pendulums in the next `count` ticks, and cuts
    /// ticks at kinks.
    pub(crate) fn sample(
        &mut self,
        clock: &Clock,
        joints: &[JointSlot<T>],
        count: usize,
        fork: bool,
    ) {
        if self.awake.iter().all(|&awake| awake == 0) {
            return;
        }
        let Shared { kind: Kind { grid, still, .. }, inputs, forces, .. } = self.shared;
        let tick = clock.tick();
        self.times.clear();
        for tick in tick..tick + count as i64 {
            self.times.extend(grid.fractions().map(|fraction| clock.within(tick, fraction)));
        }
        // Joints that rest for ever have one record, which does not change.
        let now = [Time::new(clock.time(tick))];
        if inputs == 0 || still && self.sampled {
            return;
        }
        let times = core::mem::take(&mut self.times);
        let ticks = Ticks { clock, joints, count, times: if still { &now } else { &times } };
        self.sample_at(&ticks, forces, fork);
        (self.times, self.sampled) = (times, true);
    }

    /// Samples the joints of all tracks with awake pendulums, and cuts ticks at kinks.
    fn sample_at(&mut self, ticks: &Ticks<'_, T>, layout: Layout, fork: bool) {
        let (tracks, inputs) = (self.count(), self.shared.inputs);
        self.cuts.clear();
        self.pieces.clear();
        self.piece_records.clear();
        self.stride = ticks.times.len();
        let length = self.stride * layout.width;
        self.records.resize(length * tracks, T::from_f64(0.0));
        let (part, mut rest) = (part(tracks, 256, fork), &mut self.records[..]);
        let (awake, joints) = (self.awake.chunks(part), self.joints.chunks(part * inputs));
        let (kinks, kinked) = (self.kinks.chunks_mut(part * inputs), self.kinked.chunks_mut(part));
        let parts = awake.zip(joints).zip(kinks.zip(kinked)).map(|(own, kinks)| {
            (own, kinks, rest.split_off_mut(..length * own.0.len()).unwrap_or_default())
        });
        share(parts, |((awake, joints), (kinks, kinked), records)| {
            let joints = joints.chunks(inputs).zip(kinks.chunks_mut(inputs));
            for (track, (joints, kinks)) in joints.enumerate() {
                kinked[track] = 0;
                if awake[track] != 0 {
                    let records = &mut records[track * length..][..length];
                    kinked[track] = sample_track(joints, kinks, records, &layout, ticks);
                }
            }
        });
        for track in 0..tracks {
            let kinked = self.kinked[track];
            if kinked != 0 {
                self.cuts.resize(ticks.count * tracks, (0, 0));
                for tick in (0..ticks.count).filter(|tick| kinked & (1 << tick) != 0) {
                    let begin = self.pieces.len();
                    self.cut(track, tick, ticks);
                    self.cuts[tick * tracks + track] =
                        (begin as u32, (self.pieces.len() - begin) as u32);
                }
            }
        }
    }

    /// Cuts a tick at the kinks of the joints of a track.
    fn cut(&mut self, track: usize, tick: usize, ticks: &Ticks<'_, T>) {
        let Shared { kind: Kind { grid, .. }, inputs, forces, momenta } = self.shared;
        let mut joints = [0; 8];
        let joints = &mut joints[..inputs];
        joints.copy_from_slice(self.joints(track as u32));
        let (slots, clock) = (ticks.joints, ticks.clock);
        let now = clock.tick() + tick as i64;
        let (mut start, end) = (clock.time(now), clock.time(now + 1));
        let step = clock.step();
        while start < end {
            let kink = drives(slots, joints).filter_map(|drive| drive.next_kink(start));
            let kink =
                kink.filter(|&kink| start < kink && kink <= end).fold(f64::INFINITY, f64::min);
            let stop = if kink < end { kink } else { end };
            let length = stop - start;
            let steps = (length / step * f64::from(grid.substeps) - 1e-9).ceil().max(1.0);
            for index in 0..steps as u32 {
                let from = if index == 0 {
                    Time::new(start)
                } else {
                    Time::new(start) + f64::from(index) / steps * length
                };
                let last = f64::from(index) + 1.0 == steps;
                let span = if last {
                    StepInterval::to(from, stop)
                } else {
                    StepInterval::by(from, length / steps)
                };
                let begin = self.piece_records.len();
                let mut times = [from; MOST_STAGES];
                for (stage, &fraction) in grid.scheme.stages().iter().enumerate() {
                    let (t, side) = span.at(fraction);
                    times[stage] = t;
                    self.append(joints, t, side, &forces, slots);
                }
                let mut jump = None;
                if last && kink == stop && 0 < momenta.width {
                    jump = Some((kink, self.piece_records.len()));
                    for side in [Side::Before, Side::After] {
                        self.append(joints, Time::new(kink), side, &momenta, slots);
                    }
                }
                self.pieces.push(Piece { h: span.h, times, begin, jump });
            }
            start = stop;
        }
    }

    /// Appends a record of `joints` at `t`.
    fn append(
        &mut self,
        joints: &[u32],
        t: Time,
        side: Side,
        layout: &Layout,
        slots: &[JointSlot<T>],
    ) {
        for (drive, &wanted) in drives(slots, joints).zip(&layout.wanted) {
            let begin = self.piece_records.len();
            self.piece_records
                .resize(begin + drive.components() * wanted.count(), T::from_f64(0.0));
            drive.sample(t, side, wanted, &mut self.piece_records[begin..]);
        }
    }

    /// Returns the record of a track at an evaluation of the batch. A track at rest has one record,
    /// and `evaluation` must be 0.
    #[inline(always)]
    pub(crate) fn record(&self, track: u32, evaluation: usize, width: usize) -> &[T] {
        &self.records[(track as usize * self.stride + evaluation) * width..][..width]
    }

    /// Returns `true` if a tick of the batch is cut for a track.
    #[inline]
    pub(crate) fn any_cut(&self) -> bool {
        !self.cuts.is_empty()
    }

    /// Returns the pieces of a tick on a track; the slice is empty if the tick is not cut.
    #[inline(always)]
    pub(crate) fn pieces(&self, tick: usize, track: u32) -> &[Piece] {
        let track = track as usize;
        if self.cuts.is_empty() || !self.is_awake(track) {
            return &[];
        }
        let (begin, count) = self.cuts[tick * self.count() + track];
        &self.pieces[begin as usize..][..count as usize]
    }

    pub(crate) fn piece_records(&self) -> &[T] {
        &self.piece_records
    }
}

/// Samples the joints of a track. Ticks with a kink in them or at their ends are omitted; returns
/// these ticks by bit.
fn sample_track<T: Real>(
    joints: &[u32],
    kinks: &mut [NextKink],
    records: &mut [T],
    layout: &Layout,
    &Ticks { clock, joints: slots, count, times }: &Ticks<'_, T>,
) -> u32 {
    let tick = clock.tick();
    let (mut begin, mut kinked) = (0, 0);
    for ((&joint, next), &wanted) in joints.iter().zip(kinks).zip(&layout.wanted) {
        let JointSlot { drive, still } = &slots[joint as usize];
        let mut sample = |times: &[Time], first: usize| {
            if wanted != Derivatives::NONE {
                let numbers = &mut records[first * layout.width + begin..];
                drive.sample_all(times, wanted, numbers, layout.width);
            }
        };
        if *still {
            // A joint at rest has equal values in all records.
            let now = Time::new(clock.time(tick));
            for record in records.chunks_exact_mut(layout.width.max(1)) {
                drive.sample(now, Side::After, wanted, &mut record[begin..]);
            }
        } else if next.within(&**drive, clock.time(tick), clock.time(tick + count as i64)) {
            let per_tick = times.len() / count;
            for index in 0..count {
                let now = tick + index as i64;
                if next.within(&**drive, clock.time(now), clock.time(now + 1)) {
                    kinked |= 1 << index;
                } else {
                    sample(&times[index * per_tick..][..per_tick], index * per_tick);
                }
            }
        } else {
            sample(times, 0);
        }
        begin += drive.components() * wanted.count();
    }
    kinked
}

#[cfg(test)]
mod tests {
    use super::{Shared, Tracks};
    use crate::sampling::scheme::{Grid, Kind, Scheme};
    use crate::system::Layout;
    use pendulum_core::system::Purpose;

    #[test]
    fn tracks_of_removed_joints_are_used_again() {
        for inputs in [1, 2] {
            let layout = Layout::new(&[], &[1, 1][..inputs], Purpose::Accelerations);
            let grid = Grid { scheme: Scheme::Rk4, substeps: 1, watched: false };
            let kind = Kind { grid, still: false, level: 0 };
            let mut tracks =
                Tracks::<f64>::new(&Shared { kind, inputs, forces: layout, momenta: layout });
            let joints = |first: u32| -> Vec<u32> { (first..).take(inputs).collect() };
            for round in 3..100 {
                for first in [1, round] {
                    let track = tracks.find(&joints(first));
                    assert_eq!(tracks.joints(track), joints(first));
                }
                tracks.remove(1);
                tracks.remove(round);
            }
            assert_eq!(tracks.count(), 2);
        }
    }
}
