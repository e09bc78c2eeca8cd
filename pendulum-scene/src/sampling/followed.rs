//! The inputs of lanes, read from the tracks that these follow.

#![allow(clippy::inline_always)]

use crate::sampling::tracks::Tracks;
use crate::system::{Layout, OctetOf, SceneSystem, W, Wide, WideOf};
use pendulum_core::scalar::{Float, Octet, Real};
use pendulum_core::system::{Numbers, Samples, System};

/// The driven inputs of all lanes at one time.
pub(crate) type Inputs<S, const N: usize> = <WideOf<S, N> as System<N>>::Inputs;

/// Returns inputs that are zero.
#[inline(always)]
pub(crate) fn nothing<S: SceneSystem<T, N>, T: Float, const N: usize>() -> Inputs<S, N> {
    Samples::from_numbers(&mut |_, _, _| Wide::from_f64(0.0))
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

impl<'a, T: Float> Followed<'a, T> {
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
            Samples::from_numbers(&mut Spread { records: &records[..*count], begin, layout })
        } else {
            let records = track.map(|track| tracks.record(track, evaluation, layout.width));
            Samples::from_numbers(&mut Gathered { records: &records, layout })
        }
    }
}

impl<T: Float> Followed<'_, T> {
    /// Returns the inputs of eight lanes at an evaluation of the batch.
    #[inline(always)]
    pub(crate) fn octet<S: SceneSystem<T, N>, const N: usize>(
        &self,
        evaluation: usize,
        part: usize,
    ) -> <OctetOf<S, N> as System<N>>::Inputs {
        let Self { tracks, layout, track, .. } = self;
        let track: &[u32; 8] = &track.as_chunks().0[part];
        let records = track.map(|track| tracks.record(track, evaluation, layout.width));
        Samples::from_numbers(&mut Gathered { records: &records, layout })
    }
}

/// A source of numbers that are equal in all lanes of a run.
struct Spread<'a, T> {
    records: &'a [&'a [T]],
    begin: &'a [T; MOST_RUNS],
    layout: &'a Layout,
}

impl<T: Float> Numbers<Wide<T>> for Spread<'_, T> {
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
struct Gathered<'a, T, const M: usize> {
    records: &'a [&'a [T]; M],
    layout: &'a Layout,
}

impl<T: Float> Numbers<Octet<T>> for Gathered<'_, T, 8> {
    #[inline(always)]
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> Octet<T> {
        let mut lanes = Octet::from_f64(0.0);
        if let Some(place) = self.layout.place(input, derivative, component) {
            for lane in 0..8 {
                lanes.0[lane] = self.records[lane][place];
            }
        }
        lanes
    }
}

impl<T: Float> Numbers<Wide<T>> for Gathered<'_, T, W> {
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
