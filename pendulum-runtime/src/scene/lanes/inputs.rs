//! The inputs of the lanes of a block, read from the samples of their joints.

#![allow(clippy::inline_always)]

use crate::scalar::{Float, Lane, Real};
use crate::scene::sampling::tracks::Tracks;
use crate::scene::system::Layout;
use crate::scene::system::{FromNumbers, Numbers};
use crate::scene::system::{SceneSystem, W, Wide};
use crate::sealed::Sealed;
use crate::system::{InLanes, LaneSystem, System};

/// The driven inputs of all lanes at one time.
pub(crate) type Inputs<S, const N: usize> =
    <<S as LaneSystem<InLanes<W>, N>>::Wide as System<N>>::Inputs;

/// Returns inputs that are zero.
#[inline(always)]
pub(crate) fn nothing<S: SceneSystem<T, N>, T: Lane + Float, const N: usize>() -> Inputs<S, N> {
    FromNumbers::from_numbers(&mut Nothing)
}

struct Nothing;

impl Sealed for Nothing {}

impl<T: Lane> Numbers<Wide<T>> for Nothing {
    #[inline(always)]
    fn number(&mut self, _: usize, _: usize, _: usize) -> Wide<T> {
        Wide::from_f64(0.0)
    }
}

/// The tracks of the lanes of a block during a batch.
pub(crate) struct Followed<'a, T> {
    tracks: &'a Tracks<T>,
    layout: &'a Layout,
    track: &'a [u32; W],
    /// The runs of adjacent lanes with equal tracks; `None` if there are more than [`MOST_RUNS`].
    runs: Option<Runs<T>>,
}

/// The maximum number of runs. In blocks with more runs, each lane is read separately.
const MOST_RUNS: usize = 8;

struct Runs<T> {
    count: usize,
    track: [u32; MOST_RUNS],
    /// The first lane of each run except the first, as a number that can be compared in all lanes.
    begin: [T; MOST_RUNS],
}

impl<'a, T: Lane + Float> Followed<'a, T> {
    #[inline(always)]
    pub(crate) fn new(tracks: &'a Tracks<T>, layout: &'a Layout, track: &'a [u32; W]) -> Self {
        let zero = T::from_f64(0.0);
        let mut runs = Runs { count: 1, track: [track[0]; MOST_RUNS], begin: [zero; MOST_RUNS] };
        let mut others = 0u32;
        if 0 < layout.width {
            for lane in 1..W {
                others |= u32::from(track[lane] != track[lane - 1]) << lane;
            }
        }
        let few = (others.count_ones() as usize) < MOST_RUNS;
        while few && others != 0 {
            let lane = others.trailing_zeros() as usize % W;
            others &= others - 1;
            let run = runs.count % MOST_RUNS;
            (runs.track[run], runs.begin[run]) = (track[lane], T::from_f64(lane as f64));
            runs.count += 1;
        }
        Self { tracks, layout, track, runs: few.then_some(runs) }
    }

    /// Returns the inputs at an evaluation of the batch.
    #[inline(always)]
    pub(crate) fn inputs<S: SceneSystem<T, N>, const N: usize>(
        &self,
        evaluation: usize,
    ) -> Inputs<S, N> {
        let Self { tracks, layout, track, runs } = self;
        if let Some(Runs { count, track, begin }) = runs {
            let mut records: [&[T]; MOST_RUNS] = [&[]; MOST_RUNS];
            for run in 0..MOST_RUNS {
                if run < *count {
                    records[run] = tracks.record(track[run], evaluation, layout.width);
                }
            }
            FromNumbers::from_numbers(&mut Spread { records: &records[..*count], begin, layout })
        } else {
            let records = track.map(|track| tracks.record(track, evaluation, layout.width));
            FromNumbers::from_numbers(&mut Gathered { records: &records, layout })
        }
    }
}

/// A source of numbers that are equal in all lanes of a run.
struct Spread<'a, T> {
    records: &'a [&'a [T]],
    begin: &'a [T; MOST_RUNS],
    layout: &'a Layout,
}

impl<T> Sealed for Spread<'_, T> {}

impl<T: Lane> Numbers<Wide<T>> for Spread<'_, T> {
    #[inline(always)]
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> Wide<T> {
        let Some(place) = self.layout.place(input, derivative, component) else {
            return Wide::from_f64(0.0);
        };
        let mut lanes = Wide::splat(self.records[0][place]);
        for (record, &begin) in self.records.iter().zip(self.begin).skip(1) {
            let number = record[place];
            for lane in 0..W {
                lanes.0[lane] =
                    if begin <= T::from_f64(lane as f64) { number } else { lanes.0[lane] };
            }
        }
        lanes
    }
}

/// A source of numbers that differ in each lane.
struct Gathered<'a, T> {
    records: &'a [&'a [T]; W],
    layout: &'a Layout,
}

impl<T> Sealed for Gathered<'_, T> {}

impl<T: Lane> Numbers<Wide<T>> for Gathered<'_, T> {
    #[inline(always)]
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> Wide<T> {
        let mut lanes = Wide::from_f64(0.0);
        if let Some(place) = self.layout.place(input, derivative, component) {
            for lane in 0..W {
                lanes.0[lane] = self.records[lane][place];
            }
        }
        lanes
    }
}
