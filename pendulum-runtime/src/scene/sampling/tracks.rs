//! Tracks: the samples of joints that the pendulums of a bucket use during a batch of ticks.

use crate::integrate::state::interval::StepInterval;
use crate::motion::{Derivatives, Side};
use crate::scalar::{Float, Real};
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::{Active, JointSlot};
use crate::scene::sampling::scheme::{Grid, MOST_STAGES};
use crate::scene::sampling::timetable::Timetable;
use crate::scene::system::Layout;
use crate::scene::threads::{part, share};
use crate::system::{Input, Purpose};
use crate::time::Time;
use std::collections::BTreeMap;

/// The maximum number of ticks in a batch.
pub(crate) const BATCH: usize = 8;

/// The distinct tuples of joints of the pendulums in a bucket, and their samples.
#[derive(Clone, Debug)]
pub(crate) struct Tracks<T> {
    /// The number of joints of a track.
    inputs: usize,
    /// The joints of all tracks, one track after the other.
    joints: Vec<u32>,
    by_joints: BTreeMap<Vec<u32>, u32>,
    /// The number of awake pendulums on each track.
    awake: Vec<u32>,
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

/// The samples of all joints in a batch, and the data needed to read them.
pub(crate) struct Sampled<'a, T> {
    pub(crate) clock: &'a Clock,
    pub(crate) tick: i64,
    pub(crate) ticks: usize,
    pub(crate) joint_slots: &'a [JointSlot<T>],
    pub(crate) actives: &'a [Active],
    pub(crate) numbers: &'a [T],
    pub(crate) timetable: &'a Timetable,
    /// `true` if a joint has a kink.
    pub(crate) kinks: bool,
}

impl<T: Real + Float> Tracks<T> {
    pub(crate) fn new(inputs: usize) -> Self {
        Self {
            inputs,
            joints: Vec::new(),
            by_joints: BTreeMap::new(),
            awake: Vec::new(),
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
        let track = self.awake.len() as u32;
        self.joints.extend_from_slice(joints);
        self.by_joints.insert(joints.to_vec(), track);
        self.awake.push(0);
        track
    }

    pub(crate) fn joints(&self, track: u32) -> &[u32] {
        &self.joints[track as usize * self.inputs..][..self.inputs]
    }

    pub(crate) fn count(&self) -> usize {
        self.awake.len()
    }

    /// Increments or decrements the number of awake pendulums on a track.
    pub(crate) fn count_awake(&mut self, track: u32, up: bool) {
        let awake = &mut self.awake[track as usize];
        *awake = if up { *awake + 1 } else { *awake - 1 };
    }

    /// Calls `visit` for every joint of awake pendulums, with the derivatives that the equations
    /// need.
    pub(crate) fn needs(&self, inputs: &[Input], mut visit: impl FnMut(u32, Derivatives)) {
        for (track, &awake) in self.awake.iter().enumerate() {
            if awake != 0 {
                for (input, &joint) in self.joints(track as u32).iter().enumerate() {
                    visit(
                        joint,
                        crate::motion::derivatives_of(inputs, input, Purpose::Accelerations),
                    );
                }
            }
        }
    }

    /// Returns `true` if a pendulum on the track is awake.
    pub(crate) fn is_awake(&self, track: usize) -> bool {
        self.awake[track] != 0
    }

    /// Copies the samples of a batch into the records of all tracks, and cuts ticks at kinks.
    pub(crate) fn load(
        &mut self,
        grid: Grid,
        layout: &Layout,
        momenta: &Layout,
        inputs: &[Input],
        sampled: &Sampled<'_, T>,
        fork: bool,
    ) {
        let tracks = self.count();
        self.cuts.clear();
        self.pieces.clear();
        self.piece_records.clear();
        self.stride = sampled.ticks * grid.count();
        let mut records = core::mem::take(&mut self.records);
        records.resize(self.stride * tracks * layout.width, T::from_f64(0.0));
        self.read_all(grid, layout, inputs, sampled, &mut records, fork);
        self.records = records;
        if !sampled.kinks {
            return;
        }
        for track in 0..tracks {
            let kinked = if self.is_awake(track) { self.kinked(track, sampled) } else { 0 };
            if kinked != 0 {
                self.cuts.resize(sampled.ticks * tracks, (0, 0));
                for tick in (0..sampled.ticks).filter(|tick| kinked & (1 << tick) != 0) {
                    let begin = self.pieces.len();
                    self.cut(track, tick, grid, momenta, inputs, sampled);
                    self.cuts[tick * tracks + track] =
                        (begin as u32, (self.pieces.len() - begin) as u32);
                }
            }
        }
    }

    /// Returns the ticks of the batch in which a track has a kink, by bit.
    fn kinked(&self, track: usize, sampled: &Sampled<'_, T>) -> u32 {
        let moving =
            self.joints(track as u32).iter().map(|&joint| &sampled.joint_slots[joint as usize]);
        let moving = moving.filter(|joint_slot| !joint_slot.still && joint_slot.grids != 0);
        moving.fold(0, |kinked, joint_slot| {
            kinked | sampled.actives[joint_slot.active as usize].kinked
        })
    }

    /// Reads the records of all tracks, on all threads if there are many tracks.
    fn read_all(
        &self,
        grid: Grid,
        layout: &Layout,
        inputs: &[Input],
        sampled: &Sampled<'_, T>,
        records: &mut [T],
        fork: bool,
    ) {
        let (part, length) = (part(self.count(), 512, fork), self.stride * layout.width);
        if length != 0 {
            share(records.chunks_mut(part * length).enumerate(), |(index, records)| {
                self.read(index * part, grid, layout, inputs, sampled, records);
            });
        }
    }

    /// Reads the records of the tracks from `first` on.
    fn read(
        &self,
        first: usize,
        grid: Grid,
        layout: &Layout,
        inputs: &[Input],
        sampled: &Sampled<'_, T>,
        records: &mut [T],
    ) {
        let (evaluations, width) = (grid.count(), layout.width);
        if width == 0 {
            return;
        }
        for (track, records) in (first..).zip(records.chunks_exact_mut(self.stride * width)) {
            if !self.is_awake(track) {
                continue;
            }
            let mut at = 0;
            for (input, &joint) in self.joints(track as u32).iter().enumerate() {
                let joint_slot = &sampled.joint_slots[joint as usize];
                let wanted = crate::motion::derivatives_of(inputs, input, Purpose::Accelerations);
                if wanted == Derivatives::NONE {
                    continue;
                }
                if joint_slot.still {
                    // A resting joint beside moving joints has equal values in all records.
                    let own = joint_slot.drive.components() * wanted.count();
                    let now = Time::new(sampled.clock.time(sampled.tick));
                    for record in records.chunks_exact_mut(width) {
                        joint_slot.drive.sample(
                            now,
                            Side::After,
                            wanted,
                            &mut record[at..at + own],
                        );
                    }
                    at += own;
                    continue;
                }
                let active = &sampled.actives[joint_slot.active as usize];
                let own = active.components * wanted.count();
                let (nodes, mine) = sampled.timetable.nodes(active.class, grid);
                let alike = nodes == evaluations
                    && mine.iter().enumerate().all(|(index, &node)| index == usize::from(node));
                if own == width && wanted == active.wanted && alike {
                    // The samples of the joint and the records of the track have the same layout.
                    let length = records.len();
                    records.copy_from_slice(&sampled.numbers[active.offset..][..length]);
                } else {
                    let mut records = records.chunks_exact_mut(width);
                    for tick in 0..sampled.ticks {
                        for (record, &node) in (&mut records).take(evaluations).zip(mine) {
                            let from =
                                active.offset + (tick * nodes + usize::from(node)) * active.width();
                            let numbers = &sampled.numbers[from..];
                            narrow(
                                active.components,
                                active.wanted,
                                numbers,
                                wanted,
                                &mut record[at..at + own],
                            );
                        }
                    }
                }
                at += own;
            }
        }
    }

    /// Cuts a tick at the kinks of the joints of a track.
    fn cut(
        &mut self,
        track: usize,
        tick: usize,
        grid: Grid,
        momenta: &Layout,
        inputs: &[Input],
        sampled: &Sampled<'_, T>,
    ) {
        let mut joints = [0; 8];
        let joints = &mut joints[..self.inputs];
        joints.copy_from_slice(self.joints(track as u32));
        let now = sampled.tick + tick as i64;
        let (mut start, end) = (sampled.clock.time(now), sampled.clock.time(now + 1));
        let step = sampled.clock.step();
        while start < end {
            let kink = joints
                .iter()
                .filter_map(|&joint| sampled.joint_slots[joint as usize].drive.next_kink(start));
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
                    self.append(joints, t, side, inputs, Purpose::Accelerations, sampled);
                }
                let mut jump = None;
                if last && kink == stop && 0 < momenta.width {
                    jump = Some((kink, self.piece_records.len()));
                    for side in [Side::Before, Side::After] {
                        self.append(
                            joints,
                            Time::new(kink),
                            side,
                            inputs,
                            Purpose::Momenta,
                            sampled,
                        );
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
        inputs: &[Input],
        purpose: Purpose,
        sampled: &Sampled<'_, T>,
    ) {
        for (input, &joint) in joints.iter().enumerate() {
            let drive = &sampled.joint_slots[joint as usize].drive;
            let wanted = crate::motion::derivatives_of(inputs, input, purpose);
            let begin = self.piece_records.len();
            self.piece_records
                .resize(begin + drive.components() * wanted.count(), T::from_f64(0.0));
            drive.sample(t, side, wanted, &mut self.piece_records[begin..]);
        }
    }

    /// Reads the constant records of joints that rest for ever.
    pub(crate) fn load_still(
        &mut self,
        layout: &Layout,
        inputs: &[Input],
        now: f64,
        joint_slots: &[JointSlot<T>],
    ) {
        self.records.resize(self.count() * layout.width, T::from_f64(0.0));
        self.stride = 1;
        let mut to = 0;
        for track in 0..self.count() {
            for (input, &joint) in
                self.joints[track * self.inputs..][..self.inputs].iter().enumerate()
            {
                let drive = &joint_slots[joint as usize].drive;
                let wanted = crate::motion::derivatives_of(inputs, input, Purpose::Accelerations);
                let own = drive.components() * wanted.count();
                drive.sample(Time::new(now), Side::After, wanted, &mut self.records[to..to + own]);
                to += own;
            }
        }
    }

    /// Returns the record of a track at an evaluation of the batch. A track at rest has one record,
    /// and `evaluation` must be 0.
    #[inline(always)]
    #[allow(clippy::inline_always)]
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
    #[allow(clippy::inline_always)]
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

/// Copies the derivatives in `wanted` from `numbers`, which contain the derivatives in `has`.
#[inline]
fn narrow<T: Copy>(
    components: usize,
    has: Derivatives,
    numbers: &[T],
    wanted: Derivatives,
    to: &mut [T],
) {
    if has == wanted {
        to.copy_from_slice(&numbers[..to.len()]);
        return;
    }
    let (mut from, mut filled) = (0, 0);
    for derivative in 0..3 {
        let order = Derivatives::of(derivative);
        if wanted.contains(order) {
            to[filled..filled + components].copy_from_slice(&numbers[from..from + components]);
            filled += components;
        }
        if has.contains(order) {
            from += components;
        }
    }
}
