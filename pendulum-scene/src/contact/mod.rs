//! Colliders and bounds: bones that are moved out of them at the end of each tick.

mod body;
mod bound;
mod friction;
mod gap;
mod sweep;

pub use bound::Bound;

use crate::bone::{AnyBone, Bone, CenteredBone};
use crate::error::SceneError;
use crate::group::any::AnyGroup;
use crate::group::members::{Group, Location, SceneStatus};
use crate::handle::SceneId;
use crate::lanes::block::lane_of;
use crate::sampling::carried::Place;
use crate::sampling::joint::{Joint, Living};
use crate::sampling::world::World;
use crate::system::W;
use body::{Body, Frames};
use core::any::{Any, TypeId};
use gap::{Nearest, gap_of, room};
use pendulum_core::attitude::{Attitude, Rates};
use pendulum_core::scalar::{Float, Real};
use pendulum_core::time::Time;
use std::collections::BTreeMap;
use sweep::{Look, may_cross, may_pass, thin};

type Vector = [f64; 3];

/// The shape of a [`Collider`], in the axes of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A ball, which bones do not enter.
    Ball {
        /// The centre.
        center: [f64; 3],
        /// The radius in metres.
        radius: f64,
    },
    /// A capsule, the points within a distance of a line between two points, which bones do not
    /// enter.
    Capsule {
        /// The points.
        ends: [[f64; 3]; 2],
        /// The distance in metres.
        radius: f64,
    },
    /// The half of space on the other side of a plane than its normal, which tips do not enter.
    Half {
        /// A point of the plane.
        point: [f64; 3],
        /// The direction out of the half, of any length.
        normal: [f64; 3],
    },
    /// A capsule that tips do not leave; a ball if both ends are equal.
    Inside {
        /// The points.
        ends: [[f64; 3]; 2],
        /// The distance in metres.
        radius: f64,
    },
}

/// A body that bones do not enter, on a frame that moves.
///
/// It is gone when a joint of its frame is removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collider {
    /// The joints of the position and of the attitude.
    pub frame: (Joint<3>, Joint<4>),
    /// The shape in the axes of the frame.
    pub shape: Shape,
}

/// What limits a bone, and what blows on it.
#[derive(Clone, Debug)]
pub(crate) struct Limit {
    /// The radius of the bone, a capsule from its joint to its tip.
    pub(crate) radius: f64,
    pub(crate) bounds: Vec<Bound>,
    /// The speed in m/s at which the bone leaves a body that contains it.
    pub(crate) push_out: f64,
    /// The coefficient of friction on colliders.
    pub(crate) friction: f64,
    /// The joint whose position is the acceleration by the wind.
    pub(crate) wind: Option<Joint<3>>,
    pub(crate) colliders: Vec<Collider>,
}

impl Shape {
    /// Returns an error if a number of the shape is no number, or a radius or a normal is none.
    pub(crate) fn check(&self) -> Result<(), SceneError> {
        let (points, size, name) = match self {
            Self::Ball { center, radius } => ([*center; 2], *radius, "radius"),
            Self::Capsule { ends, radius } | Self::Inside { ends, radius } => {
                (*ends, *radius, "radius")
            }
            Self::Half { point, normal } => ([*point; 2], length(*normal), "normal"),
        };
        // A point or a line keeps off a bone with a radius.
        let thin = thin(self).is_some();
        if !(0.0 < size && size < f64::INFINITY || thin && size == 0.0) {
            let required = if thin { "zero or positive" } else { "positive and finite" };
            return Err(SceneError::Setting { name, value: size, required });
        }
        match points.into_iter().flatten().find(|part| !part.is_finite()) {
            Some(value) => Err(SceneError::Setting { name: "point", value, required: "finite" }),
            None => Ok(()),
        }
    }
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn plus(a: Vector, by: f64, b: Vector) -> Vector {
    core::array::from_fn(|i| a[i] + by * b[i])
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The largest turn of a correction in radians, and the number of corrections of all limits.
const MOST: f64 = 0.5;
const ROUNDS: usize = 64;

/// The distance in metres, or the angle in radians, within which a bone touches a border.
const TOUCH: f64 = 1e-7;

/// The forces on a bone per moment of inertia, as in its equations.
struct Forces {
    /// The attitude of the frame.
    frame: Attitude,
    stiffness: f64,
    /// The acceleration of gravity in the frame, over the length of the bone.
    fall: Vector,
    /// The angular velocity of the center, relative to which the inertia of the bone counts.
    drift: Vector,
    /// The duration of a tick.
    tick: f64,
}

impl Forces {
    /// Returns the kinetic energy of a bone, and its energy in the forces.
    fn energies(&self, pose: &Pose) -> [f64; 2] {
        let [p, q] = [self.frame, pose.turn].map(Attitude::to_quaternion);
        let cosine: f64 = (0..4).map(|i| p[i] * q[i]).sum();
        let height = dot(self.fall, pose.turn * [0.0, 1.0, 0.0]);
        let spin = plus(pose.spin, -1.0, self.drift);
        [0.5 * dot(spin, spin), -2.0 * self.stiffness * cosine * cosine - height]
    }

    /// Returns a bound of the work of a border that moves with this angular velocity in a tick.
    fn work(&self, rate: f64) -> f64 {
        (self.stiffness + length(self.fall)) * rate.abs() * self.tick
    }
}

/// A bone at the end of a tick.
struct Pose {
    turn: Attitude,
    spin: Vector,
    /// The distance from the joint to the tip.
    length: f64,
}

impl Pose {
    fn bone(&self) -> Vector {
        self.turn * [0.0, self.length, 0.0]
    }

    fn turn_by(&mut self, by: Vector) {
        self.turn = Attitude::from_rotation_vector(by) * self.turn;
    }

    /// Turns the bone about an axis by a share of the first angle at which `gap` is between zero and
    /// the distance of a touch; `guess` is the angle at which a straight border would be left. If
    /// the gap stays negative, the guess takes its place.
    fn turn_to(&mut self, axis: Vector, guess: f64, share: f64, gap: impl Fn(Vector) -> f64) {
        let turned = |angle: f64| Attitude::from_rotation_vector(axis.map(|part| angle * part));
        let at = |angle: f64| gap(turned(angle) * self.bone());
        // The angle may be too large, because borders and levers are curved.
        let (mut inside, mut outside) = (0.0, if guess < MOST { guess } else { MOST });
        if at(outside) < 0.0 {
            inside = outside;
        }
        for _ in 0..60 {
            let left = at(outside);
            if inside == outside || left <= TOUCH {
                break;
            }
            let middle = 0.5 * (inside + outside);
            if at(middle) < 0.0 { inside = middle } else { outside = middle }
        }
        self.turn = turned(share * outside) * self.turn;
    }

    /// Turns the bone out of what it has entered. Returns the number of rounds, none if it has
    /// entered nothing and all if there is no room for it, and `true` if it now touches nothing.
    fn leave(&mut self, limit: &Limit, parent: &Body, bodies: &[Option<Body>]) -> (usize, bool) {
        for round in 0..ROUNDS {
            let (left, free) = self.correct(limit, parent, bodies, 1.0);
            if !left {
                return (round, free);
            }
        }
        // Smaller and smaller shares of the corrections lead to where they cancel, from which the
        // bone may slip out to a side.
        for round in 1..=ROUNDS {
            self.correct(limit, parent, bodies, 1.0 / (1 + round) as f64);
        }
        if self.slip(limit, parent, bodies) { (ROUNDS - 1, false) } else { (ROUNDS, false) }
    }

    /// Turns a bone between bodies along the surface of the deepest one, to the side where the way
    /// out of all is the shortest, and returns `true` if there is one.
    fn slip(&mut self, limit: &Limit, parent: &Body, bodies: &[Option<Body>]) -> bool {
        let deepest = |bone: Vector| {
            let all = limit.colliders.iter().zip(bodies).filter_map(|(collider, body)| {
                let body = body.as_ref()?;
                Some(gap_of(&collider.shape, body, parent.place, bone, limit.radius))
            });
            all.min_by(|a, b| a.gap.total_cmp(&b.gap))
        };
        let Some(Nearest { normal, .. }) = deepest(self.bone()) else { return false };
        let (gap, start) = (|bone| deepest(bone).map_or(0.0, |near| near.gap), self.turn);
        // From a thousandth of a radian on.
        for guess in (0..10).map(|k| MOST / f64::from(1 << (9 - k))) {
            for axis in [normal, normal.map(|part| -part)] {
                self.turn = start;
                self.turn_to(axis, guess, 1.0, gap);
                if 0.0 <= gap(self.bone()) && !self.correct(limit, parent, bodies, 0.0).0 {
                    return true;
                }
            }
        }
        self.turn = start;
        false
    }

    /// Turns the bone by a share of what takes it out of each body and bound. Returns `true` if it
    /// was in one, and `true` if it touched nothing.
    fn correct(
        &mut self,
        limit: &Limit,
        parent: &Body,
        bodies: &[Option<Body>],
        share: f64,
    ) -> (bool, bool) {
        let (mut left, mut free) = (false, limit.bounds.is_empty());
        for (collider, body) in limit.colliders.iter().zip(bodies) {
            let Some(body) = body else { continue };
            let Nearest { gap, normal, arm, lever, square } =
                gap_of(&collider.shape, body, parent.place, self.bone(), limit.radius);
            let along = dot(arm, normal);
            free &= TOUCH < gap;
            // A border at the joint is the concern of what moves the joint.
            if gap < 0.0 && 1e-6 * self.length < length(arm) {
                if square <= 1e-12 * self.length * self.length {
                    // Pushed along itself, the bone gives way to a side; if it points straight
                    // out, there is no room for it.
                    if along < 0.0 {
                        left = true;
                        self.turn_by((self.turn * [1.0, 0.0, 0.0]).map(|part| 0.1 * share * part));
                    }
                    continue;
                }
                left = true;
                // Beyond the normal, the bone would turn in again.
                let most = Real::atan2(square.sqrt(), along);
                self.turn_to(
                    lever.map(|part| part / square.sqrt()),
                    Real::min((0.5 * TOUCH - gap) / square.sqrt(), most),
                    share,
                    |bone| gap_of(&collider.shape, body, parent.place, bone, limit.radius).gap,
                );
            }
        }
        for &bound in &limit.bounds {
            left |= self.bind(parent, bound, share);
        }
        (left, free)
    }

    /// Takes away the velocities with which the bone would enter what it touches: an impact without
    /// restitution. The inertia is the same about all axes, so the impulse at the point of contact
    /// turns the bone about its lever. Friction by `coefficient` follows each impulse. Returns a
    /// bound of the work of the borders in the tick.
    fn stop(
        &mut self,
        limit: &Limit,
        parent: &Body,
        bodies: &[Option<Body>],
        forces: &Forces,
        coefficient: f64,
    ) -> f64 {
        let (mut work, mut touched) = (0.0, !limit.bounds.is_empty());
        for round in 0..4 {
            for (collider, body) in limit.colliders.iter().zip(bodies) {
                let Some(body) = body else { continue };
                let near = gap_of(&collider.shape, body, parent.place, self.bone(), limit.radius);
                let Nearest { gap, normal, arm, lever, square } = near;
                if TOUCH < gap || square <= 1e-12 * self.length * self.length {
                    continue;
                }
                touched = true;
                let ours = plus(parent.velocity, 1.0, cross(self.spin, arm));
                let at = plus(plus(parent.place, 1.0, arm), -1.0, body.place);
                let theirs = plus(body.velocity, 1.0, cross(body.spin, at));
                let rate = dot(normal, plus(ours, -1.0, theirs));
                if round == 0 {
                    let border = dot(normal, plus(theirs, -1.0, parent.velocity));
                    work += forces.work(border / square.sqrt());
                }
                if rate < 0.0 {
                    self.spin = plus(self.spin, -rate / square, lever);
                }
                if rate < 0.0 && 0.0 < coefficient {
                    let ours = plus(parent.velocity, 1.0, cross(self.spin, arm));
                    let before = forces.energies(self)[0];
                    let grip = near.grip(plus(ours, -1.0, theirs), coefficient, -rate);
                    self.spin = plus(self.spin, 1.0, grip);
                    work += forces.energies(self)[0] - before;
                }
            }
            for &bound in &limit.bounds {
                if self.stay(parent, bound) && round == 0 {
                    work += forces.work(length(parent.spin));
                }
            }
            // The bone does not turn here, so what it does not touch now, it does not touch later.
            if !touched {
                break;
            }
        }
        work
    }
}

/// The limits of the bones of a scene.
#[derive(Debug, Default)]
pub(crate) struct Limits {
    pub(crate) bones: BTreeMap<Place, Limit>,
    /// The colliders of a bone at the beginning and at the end of a tick, and within it; used again
    /// by each bone.
    looks: [Look; 3],
    frames: Frames,
}

impl Limits {
    /// Moves the bones of a level out of what limits them, at the end of the current tick. A bone
    /// that sleeps wakes if something enters it.
    pub(crate) fn keep<T: Float>(
        &mut self,
        world: &mut World<T>,
        groups: &mut [(TypeId, Box<dyn AnyGroup<T>>)],
        scene: SceneId,
        level: u32,
    ) {
        if level == 0 {
            self.frames.round += 1;
        }
        for (&(_, place, id), limit) in self.bones.range((level, 0, 0)..(level + 1, 0, 0)) {
            let group: &mut dyn Any = &mut *groups[place as usize].1;
            let tools = (&mut self.looks, &mut self.frames);
            if group.is::<Group<Bone<T>, T, 4>>() {
                if let Some(group) = group.downcast_mut::<Group<Bone<T>, T, 4>>() {
                    keep(group, world, scene, id, limit, tools);
                }
            } else if let Some(group) = group.downcast_mut::<Group<CenteredBone<T>, T, 4>>() {
                keep(group, world, scene, id, limit, tools);
            }
        }
    }
}

fn keep<B: AnyBone<T>, T: Float>(
    group: &mut Group<B, T, 4>,
    world: &mut World<T>,
    scene: SceneId,
    id: u32,
    limit: &Limit,
    ([begin, end, within], frames): (&mut [Look; 3], &mut Frames),
) {
    let status = group.status[id as usize];
    if !matches!(status, SceneStatus::Awake | SceneStatus::Asleep(_)) {
        return;
    }
    let awake = group.is_awake(id);
    let Location { bucket, slot } = group.table[id as usize];
    let (bucket, slot) = (&mut group.buckets[bucket as usize], slot as usize);
    let living = Living { scene, generations: &world.generations };
    let [from, to] = [0, 1].map(|tick| world.clock.time(world.clock.tick() + tick));
    let (joints, center) = bucket.joints(slot).split_at(2);
    let frame_of = |collider: &Collider| {
        let (place, turn) = collider.frame;
        Some([place.of(living).ok()?, turn.of(living).ok()?])
    };
    for look in [&mut *begin, &mut *end] {
        look.bodies.clear();
    }
    for collider in &limit.colliders {
        let ends = frame_of(collider).map(|joints| frames.ends(world, joints, [from, to]));
        begin.bodies.push(ends.map(|[begin, _]| *begin));
        end.bodies.push(ends.map(|[_, end]| *end));
    }
    let tick = world.clock.step();
    let mut parameters = [0.0; 6];
    for (own, parameter) in parameters.iter_mut().zip(bucket.parameters_of(slot)) {
        *own = parameter.to_f64();
    }
    let [length, stiffness, _, gravity @ ..] = parameters;
    let plain = limit.bounds.is_empty() && limit.wind.is_none() && center.is_empty();
    if plain && limit.push_out == f64::INFINITY {
        // Most bones are far from everything, whatever their attitudes.
        for (look, t) in [(&mut *begin, from), (&mut *end, to)] {
            let numbers: [T; 9] = world.numbers(&joints[..1], Time::new(t));
            look.parent = Body::moving(&numbers.map(T::to_f64));
        }
        let block = &bucket.blocks[slot / W];
        let [now, before] = [&block.q.high, &block.before[0]].map(|q| lane_of(q, slot % W));
        let by: [f64; 4] = core::array::from_fn(|i| (now[i] - before[i]).to_f64());
        let by = if awake { by.iter().map(|part| part * part).sum::<f64>().sqrt() } else { 0.0 };
        let reach = length + limit.radius + 2.0 * TOUCH;
        let places = [begin.parent.place, end.parent.place];
        let left =
            |shape: &Shape, body: &Body, look: usize| room(shape, body, places[look]) - reach;
        let far = limit.colliders.iter().zip(&end.bodies).all(|(collider, body)| {
            body.as_ref().is_none_or(|body| 0.0 < left(&collider.shape, body, 1))
        });
        // The chord of a turn is at most twice the distance of the quaternions.
        let turned = 2.0 * length * by + TOUCH;
        if far && !may_pass(limit, [begin, end], turned, tick, left) {
            return;
        }
    }
    end.parent = world.body(joints, to);
    let (_, [q, _, v, _, before, _]) = bucket.numbers(slot);
    let [was, own] = [before, q].map(|q| Attitude::from_quaternion(q.map(Float::to_f64)));
    let was = if awake { was } else { own };
    let rates = Rates::from_derivative(own, v.map(Float::to_f64)).in_space(own);
    let (mut started, mut turn, mut spin, mut drift) = (was, own, rates, [0.0; 3]);
    let mut felt = end.parent.acceleration;
    let ends = (!center.is_empty()).then(|| [from, to].map(|t| world.body(center, t)));
    if let Some([before, now]) = &ends {
        (started, turn, drift) = (before.turn * was, now.turn * own, now.spin);
        spin = plus(drift, 1.0, now.turn * rates);
        felt = world.felt(center, to, &end.parent);
    }
    let fall = plus(gravity, -1.0, felt).map(|part| part / length);
    let forces = Forces { frame: end.parent.turn, stiffness, fall, drift, tick };
    let direction = turn * [0.0, 1.0, 0.0];
    let blown = plus(spin, forces.tick / length, cross(direction, world.gust(living, limit, to)));
    let mut pose = Pose { turn, spin: blown, length };
    let bones = [started * [0.0, length, 0.0], pose.bone()];
    let mut met = false;
    let slow = limit.push_out < f64::INFINITY;
    let sweeps = limit.colliders.iter().any(|collider| thin(&collider.shape).is_some());
    if slow || sweeps {
        begin.parent = world.body(joints, from);
    }
    if slow {
        // What contains the bone may still contain it at the end, but not as deep.
        let bodies = begin.bodies.iter_mut().zip(&mut end.bodies);
        for (collider, bodies) in limit.colliders.iter().zip(bodies) {
            let (Some(from), Some(to)) = bodies else { continue };
            let shape = &collider.shape;
            let inside = -gap_of(shape, from, begin.parent.place, bones[0], limit.radius).gap;
            to.depth = Real::max(inside - limit.push_out * forces.tick, 0.0);
            from.depth = to.depth;
        }
    }
    if sweeps {
        let look = |part: f64, look: &mut Look| {
            // Exact at the end.
            let t = if part < 1.0 { from + part * (to - from) } else { to };
            look.parent = world.body(joints, t);
            look.bodies.clear();
            look.bodies.extend(limit.colliders.iter().zip(&end.bodies).map(|(collider, end)| {
                Some(Body { depth: end.as_ref()?.depth, ..world.body(&frame_of(collider)?, t) })
            }));
        };
        met = may_cross(limit, [begin, end], bones, forces.tick)
            && pose.sweep(limit, started, forces.tick, [begin, within], look);
    }
    let (rounds, free) = pose.leave(limit, &end.parent, &end.bodies);
    let (moved, pressed) = (0 < rounds || met, rounds == ROUNDS);
    if pressed {
        // What holds the bone on all sides gives it no velocity.
        pose.spin = drift;
    }
    if free && !moved && blown == spin {
        return;
    }
    // A body that would have passed turns the bone, and does no further work.
    let friction = if met { 0.0 } else { limit.friction };
    let parent = &end.parent;
    let idle = free || pressed;
    let work = if idle { 0.0 } else { pose.stop(limit, parent, &end.bodies, &forces, friction) };
    let work = if met { 0.0 } else { work };
    if moved {
        // On its way out, the bone climbs against the forces; what it gains is taken from its
        // velocity.
        let before: f64 = forces.energies(&Pose { turn, spin: blown, length }).iter().sum();
        let [kinetic, height] = forces.energies(&pose);
        let left = before + work - height;
        if left < kinetic && 0.0 < kinetic {
            let by = (left.max(0.0) / kinetic).sqrt();
            pose.spin = plus(drift, by, plus(pose.spin, -1.0, drift));
        }
    }
    if moved && !pressed && 0.0 < friction {
        let start =
            |collider: &Collider| Some(frames.ends(world, frame_of(collider)?, [from, to])[0]);
        let parents = [&world.body(joints, from), parent];
        pose.rub(limit, [started, turn], parents, &end.bodies, start);
        pose.leave(limit, parent, &end.bodies);
    }
    // What is hit by a fast body would turn many times in a tick, which no step can follow.
    let (rate, most) = (self::length(pose.spin), Real::max(self::length(blown), 1.0 / forces.tick));
    if most < rate {
        pose.spin = pose.spin.map(|part| part * (most / rate));
    }
    if moved || pose.spin != spin {
        if let Some([_, now]) = &ends {
            let back = now.turn.inverse();
            pose.spin = back * plus(pose.spin, -1.0, drift);
            pose.turn = back * pose.turn;
        }
        let rates = Rates::space(pose.spin).derivative(pose.turn);
        let [q, v] = [pose.turn.to_quaternion(), rates].map(|part| part.map(T::from_f64));
        bucket.set_state(slot, &q, &v);
        group.wake(world, id);
    }
}
