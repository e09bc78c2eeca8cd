//! Ticks: joints are sampled, then all blocks go through a batch.

use super::Scene;
use super::bucket::Failed;
use super::clock::Clock;
use super::error::SceneError;
use super::joint::Place;
use super::timetable::Timetable;
use super::tracks::{BATCH, Sampled};
use crate::real::{Float, Lane};

/// What [`Scene::advance`] has done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advanced {
    /// The ticks done.
    pub ticks: u64,
    /// The seconds that were more than the longest frame, and are lost.
    pub dropped: f64,
    /// The pendulums that have failed.
    pub failed: usize,
}

impl<T: Lane + Float> Scene<T> {
    /// Takes a frame of `dt` seconds: does all ticks that are due and keeps the rest for the next frame.
    ///
    /// States at common times have the same bits however time is cut into frames. A frame of zero does nothing; one longer than
    /// the [longest frame](Self::set_longest_frame) is cut.
    ///
    /// # Errors
    /// A time that is negative or no number.
    pub fn advance(&mut self, dt: f64) -> Result<Advanced, SceneError> {
        if self.paused && (0.0..f64::INFINITY).contains(&dt) {
            return Ok(Advanced::default());
        }
        let (ticks, dropped) = self.clock.ask(dt, self.longest_frame)?;
        let failed = self.failures.len();
        self.ticks(ticks);
        Ok(Advanced { ticks, dropped, failed: self.failures.len() - failed })
    }

    /// Does so many ticks, which no frame needs to ask for.
    pub fn advance_ticks(&mut self, ticks: u32) -> Advanced {
        self.whole_ticks(u64::from(ticks))
    }

    pub(super) fn whole_ticks(&mut self, ticks: u64) -> Advanced {
        let failed = self.failures.len();
        self.clock.shift(ticks as i64);
        self.ticks(ticks);
        Advanced { ticks, dropped: 0.0, failed: self.failures.len() - failed }
    }

    pub(super) fn ticks(&mut self, mut ticks: u64) {
        while 0 < ticks {
            let batch = ticks.min(self.watch()).min(BATCH as u64);
            self.batch(batch as usize);
            self.clock.passed(batch);
            ticks -= batch;
        }
    }

    /// Goes through `ticks` ticks, at most [`BATCH`].
    fn batch(&mut self, ticks: usize) {
        if self.dirty {
            self.assign();
        }
        let tick = self.clock.tick();
        self.sample(tick, ticks);
        let Self { clock, places, numbers, timetable, groups, failures, parallel, .. } = self;
        let mut failed: Vec<Failed> = Vec::new();
        for (_, group) in groups.iter_mut() {
            group.settle(clock);
            let sampled = Sampled { clock, tick, ticks, places, numbers, timetable };
            group.run(&sampled, *parallel, &mut failed);
            if !failed.is_empty() {
                failed.sort_by_key(|&(id, at)| (at, id));
                for (id, at) in failed.drain(..) {
                    failures.push(group.fail(clock, places, id, tick + i64::from(at)));
                }
                self.dirty = true;
            }
        }
    }

    /// Tells every joint who needs it, and when.
    fn assign(&mut self) {
        self.dirty = false;
        let Self { places, groups, timetable, .. } = self;
        for place in places.iter_mut() {
            (place.orders, place.grids) = (crate::motion::Orders::NONE, 0);
        }
        for (_, group) in groups.iter() {
            // The bit of the grid is looked up once a bucket, not once a joint.
            let mut known = None;
            group.needs(&mut |joint, orders, grid| {
                let bit = match known {
                    Some((last, bit)) if last == grid => bit,
                    _ => timetable.bit(grid),
                };
                known = Some((grid, bit));
                let place = &mut places[joint as usize];
                place.orders = place.orders.and(orders);
                place.grids |= bit;
            });
        }
        let mut last = None;
        for place in places.iter_mut().filter(|place| place.grids != 0) {
            place.class = match last {
                Some((grids, class)) if grids == place.grids => class,
                _ => timetable.class(place.grids),
            };
            last = Some((place.grids, place.class));
        }
    }

    /// Samples all joints that somebody needs.
    fn sample(&mut self, tick: i64, ticks: usize) {
        let Self { clock, places, numbers, timetable, .. } = self;
        timetable.begin(clock, tick, ticks);
        let mut length = 0;
        let shared = Times { clock, timetable, tick, ticks };
        for place in places.iter_mut().filter(|place| is_sampled(place)) {
            place.offset = length;
            length += shared.length(place);
        }
        numbers.resize(length, T::from_f64(0.0));
        shared.sample_all(places, numbers, self.parallel);
    }
}

/// The joints that are sampled.
fn is_sampled<T>(place: &Place<T>) -> bool {
    place.grids != 0 && !place.still
}

/// What all samplers share.
#[derive(Clone, Copy)]
struct Times<'a> {
    clock: &'a Clock,
    timetable: &'a Timetable,
    tick: i64,
    ticks: usize,
}

impl Times<'_> {
    /// The numbers of a joint in a batch.
    fn length<T: Lane + Float>(&self, place: &Place<T>) -> usize {
        self.timetable.times(place.class).len() * place.width()
    }

    /// Samples joints into `numbers`, which begin at the offset `base`.
    fn sample<T: Lane + Float>(&self, places: &mut [Place<T>], numbers: &mut [T], base: usize) {
        for place in places.iter_mut().filter(|place| is_sampled(place)) {
            let (begin, length) = (place.offset - base, self.length(place));
            place.sample(
                self.clock,
                self.tick,
                self.ticks,
                self.timetable.times(place.class),
                &mut numbers[begin..begin + length],
            );
        }
    }

    /// Samples joints, on all threads if there are many.
    #[cfg(feature = "rayon")]
    fn sample_all<T: Lane + Float>(&self, places: &mut [Place<T>], numbers: &mut [T], parallel: bool) {
        const CHUNK: usize = 256;
        if !parallel || places.len() < 2 * CHUNK {
            return self.sample(places, numbers, 0);
        }
        rayon::scope(|scope| {
            let (mut rest, mut base) = (numbers, 0);
            for chunk in places.chunks_mut(CHUNK) {
                let size = chunk.iter().filter(|place| is_sampled(place)).map(|place| self.length(place)).sum();
                let (mine, after) = rest.split_at_mut(size);
                rest = after;
                let begin = base;
                base += size;
                if 0 < size {
                    scope.spawn(move |_| self.sample(chunk, mine, begin));
                }
            }
        });
    }

    /// Samples joints.
    #[cfg(not(feature = "rayon"))]
    fn sample_all<T: Lane + Float>(&self, places: &mut [Place<T>], numbers: &mut [T], _: bool) {
        self.sample(places, numbers, 0);
    }
}
