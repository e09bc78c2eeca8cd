//! Sleep: pendulums that hardly move, on joints that rest, are not computed until their joints
//! move.

use crate::group::criterion::{AtRest, SleepCriterion, barrier};
use crate::group::frequency;
use crate::group::members::{Group, SceneStatus};
use crate::sampling::world::World;
use crate::system::{Layouts, SceneSystem, W};
use core::cmp::Reverse;
use pendulum_core::scalar::{Float, Real};

/// The number of ticks from one check of the sleep criteria to the next.
pub(crate) const LOOK: i64 = 16;

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Group<S, T, N> {
    /// Wakes the pendulums whose joints are about to move, and puts others to sleep with this
    /// tolerance. Returns the next tick at which a pendulum wakes, or `i64::MAX` if there is none.
    pub(super) fn sleep(&mut self, world: &mut World<T>, tolerance: Option<f64>) -> i64 {
        let tick = world.clock.tick();
        while let Some(&Reverse((when, id))) = self.alarms.peek()
            && when <= tick
        {
            self.alarms.pop();
            // All other alarms belong to pendulums that have been woken already.
            if self.status[id as usize] == SceneStatus::Asleep(when) {
                self.wake(world, id);
            }
        }
        if let Some(tolerance) = tolerance
            && tick.rem_euclid(LOOK) == 0
        {
            self.fall_asleep(world, tolerance);
        }
        self.alarms.peek().map_or(i64::MAX, |Reverse((tick, _))| *tick)
    }

    /// Puts all pendulums to sleep that fulfil their sleep criterion.
    fn fall_asleep(&mut self, world: &mut World<T>, tolerance: f64) {
        // A constraint on velocities leaves the state of rest open.
        if S::FACTS.explicit_time || const { Layouts::<S, N>::ROLLS } {
            return;
        }
        let (tick, now) = (world.clock.tick(), world.now());
        self.criteria.resize(self.table.len(), None);
        let mut sleepers: Vec<(u32, i64)> = Vec::new();
        for index in 0..self.buckets.len() {
            let bucket = &self.buckets[index];
            // The last tick that begins while the joints of a track still rest, for each track.
            let tracks = &world.tracks[bucket.tracks];
            let until: Vec<i64> = (0..tracks.count() as u32)
                .map(|track| {
                    if !tracks.is_awake(track as usize) {
                        return tick;
                    }
                    let rests = world.drives(tracks.joints(track));
                    let until =
                        rests.map(|drive| drive.rest_until(now)).fold(f64::INFINITY, f64::min);
                    world.clock.last_before(until)
                })
                .collect();
            for slot in 0..self.buckets[index].awake {
                let bucket = &self.buckets[index];
                let (block, lane) = (&bucket.blocks[slot / W], slot % W);
                let (id, wake) = (bucket.id(slot), until[block.track[lane] as usize]);
                if wake < tick + LOOK {
                    continue;
                }
                let (q, v) = block.state(lane);
                if const { Layouts::<S, N>::LIMITED }
                    && self.rests_in_contact(world, (index, slot), tolerance)
                {
                    sleepers.push((id, wake));
                    continue;
                }
                if !S::FACTS.frictions.is_empty() {
                    // Friction holds a pendulum far from its state of rest without it.
                    continue;
                }
                let known = self.criteria[id as usize]
                    .filter(|criterion| criterion.until == wake && criterion.lasts(&q, &v));
                let criterion = known.unwrap_or_else(|| self.criterion(world, id, tolerance, wake));
                self.criteria[id as usize] = Some(criterion);
                let slow = T::from_f64(0.0) < criterion.energy
                    && (0..N).all(|i| Real::abs(v[i]) <= criterion.speed[i]);
                if slow
                    && criterion.distance(&q) <= criterion.near
                    && self.is_calm(world, id, &q, &v, &criterion)
                {
                    sleepers.push((id, wake));
                }
            }
        }
        for &(id, wake) in &sleepers {
            let mut detached = self.read(id);
            let zero = [T::from_f64(0.0); N];
            let q = detached.state[0];
            detached.state = [q, detached.state[1], zero, zero, q, zero];
            self.write(world, &detached);
            self.status[id as usize] = SceneStatus::Asleep(wake);
            self.set_awake(world, id, false);
            self.alarms.extend(alarm(id, self.status[id as usize]));
        }
        // Removes obsolete alarms of pendulums that have been woken.
        if 2 * self.table.len() < self.alarms.len() {
            self.reset_alarms();
        }
    }

    /// Sets the alarms of all sleeping pendulums.
    pub(crate) fn reset_alarms(&mut self) {
        self.alarms =
            (0..).zip(&self.status).filter_map(|(id, status)| alarm(id, *status)).collect();
    }

    /// Discards the sleep criterion of a pendulum.
    pub(crate) fn forget_criterion(&mut self, id: u32) {
        if let Some(criterion) = self.criteria.get_mut(id as usize) {
            *criterion = None;
        }
    }

    /// Returns `true` if a pendulum touches a limit or sticks and hardly moves: by a millionth of
    /// the tolerance in a tick, at both ends of the last one. Its state of rest without the limit
    /// is elsewhere. A motion to and fro along the limit is as slow at its ends only if its width
    /// is below the tolerance.
    ///
    /// The next tick tells whether an input or a parameter that has just been set moves it.
    fn rests_in_contact(
        &self,
        world: &World<T>,
        (bucket, slot): (usize, usize),
        tolerance: f64,
    ) -> bool {
        let bucket = &self.buckets[bucket];
        let (_, [q, _, v, _, q_before, v_before]) = bucket.numbers(slot);
        let least = T::from_f64(1e-6 * tolerance);
        let slow = |v: T| Real::abs(v * T::from_f64(world.clock.step())) <= least;
        bucket.standing(slot).holds()
            && (0..N)
                .all(|i| slow(v[i]) && slow(v_before[i]) && Real::abs(q[i] - q_before[i]) <= least)
            && {
                let detached = self.read(bucket.id(slot));
                let (tick, substeps) = (world.clock.tick(), bucket.kind.grid.substeps);
                self.hung(world, &detached).stays(tick, substeps, least)
            }
    }

    /// Returns `true` if the energy is small enough to sleep.
    fn is_calm(
        &self,
        world: &World<T>,
        id: u32,
        q: &[T; N],
        v: &[T; N],
        criterion: &SleepCriterion<T, N>,
    ) -> bool {
        let detached = self.read(id);
        let hung = self.hung(world, &detached);
        let rest = AtRest::new(&hung);
        let by = core::array::from_fn(|i| q[i] - criterion.rest[i]);
        rest.kinetic(q, v) + rest.lifted(&criterion.rest, &by) <= criterion.energy
    }

    /// Computes the sleep criterion of a pendulum.
    fn criterion(
        &self,
        world: &World<T>,
        id: u32,
        tolerance: f64,
        until: i64,
    ) -> SleepCriterion<T, N> {
        let (detached, near) = (self.read(id), T::from_f64(4.0 * tolerance));
        let hung = self.hung(world, &detached);
        let still = AtRest::new(&hung);
        let [q, ..] = detached.state;
        // The criterion of a pendulum that must not sleep is computed again when the pendulum is
        // slow.
        let [_, omega] = frequency::fastest(&hung.system, still.t, &q, &still.forces);
        let never = SleepCriterion {
            until,
            rest: q,
            energy: T::from_f64(-1.0),
            speed: [T::from_f64(omega * tolerance); N],
            near,
            reach: near,
        };
        let Ok(rest) = hung.rest(world.now()) else { return never };
        let lifted = |by: &[f64; N]| still.lifted(&rest, &by.map(T::from_f64)).to_f64();
        let energy = if const { Layouts::<S, N>::HELD } {
            // Springs of a much greater stiffness stand for the constraints.
            let along = |by: &[f64; N]| {
                let [along, away] = still.split(&rest, &by.map(T::from_f64));
                let away = away.iter().map(|part| part.to_f64() * part.to_f64()).sum::<f64>();
                (still.lifted(&rest, &along).to_f64(), away)
            };
            let single = |i: usize| core::array::from_fn(|j| if i == j { tolerance } else { 0.0 });
            let largest = (0..N).map(|i| along(&single(i)).0.abs()).fold(0.0, f64::max);
            let stiffness = 1e4 * largest / (tolerance * tolerance);
            barrier(tolerance, |by| {
                let (lifted, away) = along(by);
                lifted + stiffness * away
            })
        } else {
            barrier(tolerance, lifted)
        };
        let Some(energy) = energy else { return never };
        let energy = T::from_f64(energy);
        // T = pᵀM⁻¹p/2 bounds q̇ᵢ by √(2T (M⁻¹)ᵢᵢ). The bound is a tenth larger, because M is not
        // constant.
        let speed = core::array::from_fn(|i| {
            (T::from_f64(2.42) * energy * still.mobility(&rest, i)).sqrt()
        });
        let criterion = SleepCriterion { until, rest, energy, speed, near, reach: near };
        // A tenth more, so that a growing swing does not exceed `reach` in every period.
        SleepCriterion {
            reach: Real::max(near, T::from_f64(1.1) * criterion.distance(&q)),
            ..criterion
        }
    }
}

/// Returns the alarm of a pendulum that sleeps for a limited time.
fn alarm(id: u32, status: SceneStatus) -> Option<Reverse<(i64, u32)>> {
    match status {
        SceneStatus::Asleep(tick) if tick != i64::MAX => Some(Reverse((tick, id))),
        _ => None,
    }
}
