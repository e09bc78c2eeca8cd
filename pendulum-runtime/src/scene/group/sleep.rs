//! Sleep: pendulums that hardly move, on joints that rest, are not computed until their joints
//! move.

use crate::real::{Float, Lane, Real};
use crate::scene::group::criterion::{AtRest, Bed, barrier};
use crate::scene::group::frequency;
use crate::scene::group::members::Group;
use crate::scene::group::status::Status;
use crate::scene::lanes::system::{Hung, W};
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::Place;
use core::cmp::Reverse;

/// The ticks from one look for sleepers to the next.
pub(crate) const LOOK: i64 = 16;

impl<S: Hung<T, N>, T: Lane + Float, const N: usize> Group<S, T, N> {
    /// Wakes those whose time has come; all at the end of time.
    pub(crate) fn wake_up_to(&mut self, tick: i64) -> bool {
        let mut woken = false;
        if tick == i64::MAX {
            self.alarms.clear();
            for id in 0..self.table.len() as u32 {
                woken |= matches!(self.status[id as usize], Status::Asleep(_));
                self.rouse(id);
            }
        }
        while let Some(&Reverse((when, id))) = self.alarms.peek()
            && when <= tick
        {
            self.alarms.pop();
            // Others have been woken before.
            if self.status[id as usize] == Status::Asleep(when) {
                self.rouse(id);
                woken = true;
            }
        }
        woken
    }

    /// Lets those fall asleep that may.
    pub(crate) fn fall_asleep(
        &mut self,
        clock: &Clock,
        places: &[Place<T>],
        tolerance: f64,
    ) -> bool {
        if S::FACTS.explicit_time {
            return false;
        }
        let (tick, now) = (clock.tick(), clock.time(clock.tick()));
        self.beds.resize(self.table.len(), None);
        let mut sleepers: Vec<(u32, i64)> = Vec::new();
        for index in 0..self.buckets.len() {
            let bucket = &self.buckets[index];
            // The last tick that begins while the joints of a track still rest.
            let until: Vec<i64> = (0..bucket.tracks.count() as u32)
                .map(|track| {
                    if !bucket.tracks.is_awake(track as usize) {
                        return tick;
                    }
                    let rest = |&joint: &u32| places[joint as usize].drive.rest_until(now);
                    clock.last_before(
                        bucket.tracks.joints(track).iter().map(rest).fold(f64::INFINITY, f64::min),
                    )
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
                let known =
                    self.beds[id as usize].filter(|bed| bed.until == wake && bed.lasts(&q, &v));
                let bed = known.unwrap_or_else(|| self.bed(clock, places, id, tolerance, wake));
                self.beds[id as usize] = Some(bed);
                let slow = T::from_f64(0.0) < bed.energy
                    && (0..N).all(|i| Real::abs(v[i]) <= bed.speed[i]);
                if slow
                    && bed.distance(&q) <= bed.near
                    && self.calm(clock, places, id, &q, &v, &bed)
                {
                    sleepers.push((id, wake));
                }
            }
        }
        for &(id, wake) in &sleepers {
            let mut loose = self.read(id);
            let zero = [T::from_f64(0.0); N];
            let q = loose.state[0];
            loose.state = [q, loose.state[1], zero, zero, q, zero];
            self.write(&loose);
            self.status[id as usize] = Status::Asleep(wake);
            self.set_awake(id, false);
            self.alarms.extend(alarm(id, self.status[id as usize]));
        }
        // Those of sleepers that were woken stay behind.
        if 2 * self.table.len() < self.alarms.len() {
            self.reset_alarms();
        }
        !sleepers.is_empty()
    }

    /// Sets the alarms of all that sleep.
    pub(crate) fn reset_alarms(&mut self) {
        self.alarms =
            (0..).zip(&self.status).filter_map(|(id, status)| alarm(id, *status)).collect();
    }

    /// Forgets whether a pendulum may sleep.
    pub(crate) fn unmake_bed(&mut self, id: u32) {
        if let Some(bed) = self.beds.get_mut(id as usize) {
            *bed = None;
        }
    }

    /// Whether the energy is small enough.
    fn calm(
        &self,
        clock: &Clock,
        places: &[Place<T>],
        id: u32,
        q: &[T; N],
        v: &[T; N],
        bed: &Bed<T, N>,
    ) -> bool {
        let loose = self.read(id);
        let system = self.system_of(&loose.parameters);
        let rest = AtRest::new(&system, clock, places, &loose);
        let by = core::array::from_fn(|i| q[i] - bed.rest[i]);
        rest.kinetic(q, v) + rest.lifted(&bed.rest, &by) <= bed.energy
    }

    /// What decides whether a pendulum may sleep.
    fn bed(
        &self,
        clock: &Clock,
        places: &[Place<T>],
        id: u32,
        tolerance: f64,
        until: i64,
    ) -> Bed<T, N> {
        let (loose, near) = (self.read(id), T::from_f64(4.0 * tolerance));
        let system = self.system_of(&loose.parameters);
        let still = AtRest::new(&system, clock, places, &loose);
        let [q, ..] = loose.state;
        // Where it may not sleep it is looked at again when it is slow.
        let omega = frequency::fastest(&system, still.t, &q, &still.forces);
        let never = Bed {
            until,
            rest: q,
            energy: T::from_f64(-1.0),
            speed: [T::from_f64(omega * tolerance); N],
            near,
            reach: near,
        };
        let Some(rest) = self.rest_of(places, &loose, clock.time(clock.tick())) else {
            return never;
        };
        let lifted = |by: &[f64; N]| still.lifted(&rest, &by.map(T::from_f64)).to_f64();
        let Some(energy) = barrier(tolerance, lifted) else { return never };
        let energy = T::from_f64(energy);
        // T = pᵀM⁻¹p/2 bounds q̇ᵢ by √(2T (M⁻¹)ᵢᵢ), with a tenth more because M is not the same
        // everywhere.
        let speed = core::array::from_fn(|i| {
            (T::from_f64(2.42) * energy * still.mobility(&rest, i)).sqrt()
        });
        let bed = Bed { until, rest, energy, speed, near, reach: near };
        // A tenth more, so that a swing that grows is not looked at in every turn.
        Bed { reach: Real::max(near, T::from_f64(1.1) * bed.distance(&q)), ..bed }
    }
}

/// When a pendulum is to wake, if it ever is.
fn alarm(id: u32, status: Status) -> Option<Reverse<(i64, u32)>> {
    match status {
        Status::Asleep(tick) if tick != i64::MAX => Some(Reverse((tick, id))),
        _ => None,
    }
}
