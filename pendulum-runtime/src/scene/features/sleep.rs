//! Sleep: pendulums that hardly move, on joints that rest, are not computed until their joints
//! move.

use crate::motion::Side;
use crate::real::{Float, Lane, Real};
use crate::scene::error::SceneError;
use crate::scene::group::frequency;
use crate::scene::group::members::{Group, Status, inputs_at};
use crate::scene::lanes::bucket::{Extra, Loose};
use crate::scene::lanes::system::{Hung, W};
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::joint::Place;
use crate::scene::scene::Scene;
use crate::system::Purpose;
use crate::time::Time;
use core::cmp::Reverse;
use nalgebra::DMatrix;
use std::collections::BinaryHeap;

/// The ticks from one look for sleepers to the next.
pub(crate) const LOOK: i64 = 16;

/// When sleepers are to wake: ticks and pendulums.
pub(crate) type Alarms = BinaryHeap<Reverse<(i64, u32)>>;

/// What decides whether a pendulum may sleep while its joints rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bed<T, const N: usize> {
    /// The tick in which the joints move again: another rest needs another bed.
    until: i64,
    /// Where it would come to rest.
    rest: [T; N],
    /// The energy above that at rest below which it sleeps; negative if it may not.
    energy: T,
    /// No velocity is larger with so little energy.
    speed: [T; N],
    /// No coordinate is farther from rest with so little energy.
    near: T,
    /// So far from rest it is known to come back to it.
    reach: T,
}

impl<T: Lane + Float, const N: usize> Bed<T, N> {
    /// Whether another look would find no more: what moves fast does not fall asleep, and what is
    /// not too far from its rest has no other.
    fn lasts(&self, q: &[T; N], v: &[T; N]) -> bool {
        let fast = (0..N).any(|i| T::from_f64(4.0) * self.speed[i] < Real::abs(v[i]));
        fast || T::from_f64(0.0) < self.energy && self.distance(q) <= self.reach
    }

    /// How far the coordinates are from rest.
    fn distance(&self, q: &[T; N]) -> T {
        (0..N).fold(T::from_f64(0.0), |distance, i| {
            Real::max(distance, Real::abs(q[i] - self.rest[i]))
        })
    }
}

impl<T: Lane + Float> Scene<T> {
    /// Lets pendulums sleep that hardly move: those whose energy would not lift any coordinate by
    /// more than `tolerance` from where they come to rest, while their joints rest too. Choose what
    /// moves the tip by half a pixel. `None`, as at first: nobody sleeps.
    ///
    /// A sleeper keeps its coordinates and costs nothing. It wakes with the tick in which its joint
    /// moves again, which the motion says [beforehand](crate::motion::Motion::rest_until), when
    /// something about it is changed, and when it is told to. A pendulum that comes to rest
    /// nowhere, or not at a minimum of its energy, or in whose equations the time itself stands,
    /// never sleeps.
    ///
    /// # Errors
    /// A tolerance that is not positive.
    pub fn set_sleep(&mut self, tolerance: Option<f64>) -> Result<(), SceneError> {
        if let Some(value) = tolerance
            && !(0.0 < value && value < f64::INFINITY)
        {
            return Err(SceneError::Setting { name: "sleep", value, required: "positive" });
        }
        self.sleep = tolerance;
        for (_, group) in &mut self.groups {
            group.unmake_beds();
        }
        if tolerance.is_none() {
            self.wake_all();
        }
        Ok(())
    }

    /// The pendulums that are computed, and all.
    pub fn awake(&self) -> (usize, usize) {
        self.groups.iter().fold((0, 0), |(awake, all), (_, group)| {
            let (more, others) = group.awake();
            (awake + more, all + others)
        })
    }

    /// Wakes all that sleep.
    pub(crate) fn wake_all(&mut self) {
        for (_, group) in &mut self.groups {
            self.dirty |= group.ring(i64::MAX);
        }
    }

    /// Wakes those whose joints are about to move, and lets others fall asleep; gives the ticks
    /// until that is to be done again.
    pub(crate) fn watch(&mut self) -> u64 {
        let tick = self.clock.tick();
        let Self { clock, places, groups, sleep, dirty, .. } = self;
        let mut next = i64::MAX;
        for (_, group) in groups.iter_mut() {
            *dirty |= group.ring(tick);
            if let Some(tolerance) = *sleep {
                if tick.rem_euclid(LOOK) == 0 {
                    *dirty |= group.lull(clock, places, tolerance);
                }
                next = next.min(LOOK - tick.rem_euclid(LOOK));
            }
            next = next.min(group.next_alarm().saturating_sub(tick));
        }
        next.max(1) as u64
    }
}

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

/// A system on joints that rest where they are.
struct AtRest<'a, S: Hung<T, N>, T: Lane + Float, const N: usize> {
    system: &'a S,
    t: T,
    forces: S::Inputs,
    momenta: S::Inputs,
    extra: &'a Extra<T, N>,
}

impl<'a, S: Hung<T, N>, T: Lane + Float, const N: usize> AtRest<'a, S, T, N> {
    fn new(system: &'a S, clock: &Clock, places: &[Place<T>], loose: &'a Loose<T, N>) -> Self {
        let t = clock.time(clock.tick());
        let inputs = |purpose| {
            inputs_at::<S, T, N>(places, &loose.joints, Time::new(t), Side::After, purpose, true)
        };
        let (forces, momenta) = (inputs(Purpose::Accelerations), inputs(Purpose::Momenta));
        Self { system, t: T::from_f64(t), forces, momenta, extra: &loose.extra }
    }

    /// q̇ᵀMq̇/2.
    fn kinetic(&self, q: &[T; N], v: &[T; N]) -> T {
        T::from_f64(0.5) * self.product(q, v, v)
    }

    /// aᵀMb.
    fn product(&self, q: &[T; N], a: &[T; N], b: &[T; N]) -> T {
        let p = |v: &[T; N]| self.system.momenta(self.t, q, v, &self.momenta);
        let (moving, still) = (p(b), p(&[T::from_f64(0.0); N]));
        (0..N).fold(T::from_f64(0.0), |sum, i| sum + a[i] * (moving[i] - still[i]))
    }

    /// The work that it takes to move from `rest` by `by`, by Simpson's rule over the forces:
    /// energies would have lost all their digits in single precision. Nothing gets through a wall.
    fn lifted(&self, rest: &[T; N], by: &[T; N]) -> T {
        let zero = [T::from_f64(0.0); N];
        if self.extra.is_hard()
            && (0..N).any(|i| {
                rest[i] + by[i] < self.extra.low[i] || self.extra.high[i] < rest[i] + by[i]
            })
        {
            return T::from_f64(f64::INFINITY);
        }
        let work = |part: f64| {
            let q = core::array::from_fn(|i| rest[i] + T::from_f64(part) * by[i]);
            let forces = self.system.forces(self.t, &q, &zero, &self.forces);
            let work = (0..N).fold(T::from_f64(0.0), |sum, i| sum - by[i] * forces[i]);
            if self.extra.stiffness == zero[0] {
                work
            } else {
                work - self.product(&q, by, &self.extra.push(&q))
            }
        };
        (work(0.0) + T::from_f64(4.0) * work(0.5) + work(1.0)) / T::from_f64(6.0)
    }

    /// (M⁻¹)ᵢᵢ.
    fn mobility(&self, q: &[T; N], i: usize) -> T {
        let mut p = self.system.momenta(self.t, q, &[T::from_f64(0.0); N], &self.momenta);
        p[i] += T::from_f64(1.0);
        self.system.velocities(self.t, q, &p, &self.momenta)[i]
    }
}

/// The energy without which no coordinate gets farther than `tolerance` from a minimum; `None` if
/// it is no minimum.
///
/// With the energy qᵀHq/2 that is tolerance²/(2 (H⁻¹)ᵢᵢ), the least over all i: the others go where
/// that costs least.
fn barrier<const N: usize>(tolerance: f64, above: impl Fn(&[f64; N]) -> f64) -> Option<f64> {
    let at = |moves: &[(usize, f64)]| {
        let mut by = [0.0; N];
        for &(i, sign) in moves {
            by[i] += sign * tolerance;
        }
        above(&by)
    };
    // Alone, a coordinate takes the easier side.
    let sides = |i: usize| [at(&[(i, 1.0)]), at(&[(i, -1.0)])];
    let energy = if N == 1 {
        let [ahead, behind] = sides(0);
        ahead.min(behind)
    } else {
        let hessian = DMatrix::from_fn(N, N, |i, j| {
            if i == j {
                let [ahead, behind] = sides(i);
                ahead + behind
            } else {
                let corner = |a, b| at(&[(i, a), (j, b)]);
                (corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0))
                    / 4.0
            }
        });
        let inverse = hessian.cholesky()?.inverse();
        (0..N).map(|i| 0.5 / inverse[(i, i)]).fold(f64::INFINITY, f64::min)
    };
    (0.0 < energy && energy < f64::INFINITY).then_some(energy)
}

#[cfg(test)]
mod tests {
    use super::barrier;

    #[test]
    fn coupled_coordinates_help_each_other_over_the_barrier() {
        // Two coordinates tied by a stiff spring: both go together.
        let tied = |by: &[f64; 2]| {
            0.5 * (by[0] * by[0] + by[1] * by[1]) + 50.0 * (by[0] - by[1]) * (by[0] - by[1])
        };
        let energy = barrier(0.01, tied).unwrap();
        let exact = 0.5e-4 / (101.0 / (101.0 * 101.0 - 1e4));
        assert!((energy / exact - 1.0).abs() < 1e-9, "{energy} for {exact}");
        assert_eq!(barrier(0.01, |by: &[f64; 1]| -by[0] * by[0]), None);
        assert_eq!(barrier(0.01, |by: &[f64; 2]| by[0] * by[0] - by[1] * by[1]), None);
        assert_eq!(barrier(0.01, |by: &[f64; 1]| by[0] * by[0]), Some(0.01 * 0.01));
    }
}
