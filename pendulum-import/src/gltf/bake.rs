//! Animations that are added to a file: few keys of nodes that follow given motions.

use super::accessor::Source;
use super::error::GltfError;
use super::jet::Jet;
use super::node::{Chain, Local, Parts, Pose};
use super::orientation;
use super::output::{Keys, Output};
use super::track::{Arcs, Track, Turn, dot};
use super::{Gltf, MEND, Played, missing, unit};
use core::fmt;
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Curve, Derivatives, Motion, Side};
use pendulum_core::nalgebra::{Matrix3, Vector3};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;
use std::collections::BTreeMap;

/// The samples in a second.
const RATE: f64 = 1000.0;

/// The longest animation in seconds: a million samples of each node.
const LONGEST: f64 = 1000.0;

/// The greatest number of kinks of a motion, of which each is two further samples.
const KINKS: usize = 1 << 20;

/// The share of the bounds that keys use. The rest is for times between the samples and for times
/// of samples in single precision.
const SHARE: f64 = 0.99;

/// The least cosine of the angle between the quaternions of two keys, except for jumps. At a right
/// angle, which is half a turn, rounding errors decide which way is the shorter.
const LEAST: f64 = 0.25;

/// An animation to be added to a file, in which nodes follow motions in the world: [`Gltf::bake`].
///
/// The keys are local to the parents of the nodes, which may move in another animation or be baked
/// themselves. Between the keys, rotations are arcs and positions lines (`LINEAR`). The motions are
/// sampled a thousand times a second and at their kinks; each key is as far from the one before as
/// the bounds allow, measured in the world with the written parents, so that errors do not add up
/// along a chain. A jump takes one step of single precision.
pub struct Bake<'a> {
    file: &'a Gltf,
    name: String,
    seconds: f64,
    under: Option<usize>,
    bounds: [f64; 2],
    /// Names and parents of the nodes that the file does not have.
    added: Vec<(String, Option<usize>)>,
    turns: BTreeMap<usize, Path<'a, 4>>,
    places: BTreeMap<usize, Path<'a, 3>>,
}

/// A motion of any type: its first kinks, and its position.
type Path<'a, const D: usize> = (Vec<f64>, Box<dyn Fn(Time, Side) -> [f64; D] + 'a>);

/// Returns a motion with its kinks between 0 and `end`, at most [`KINKS`] of them.
fn path<'a, const D: usize>(motion: impl Motion<f64, D> + 'a, end: f64) -> Path<'a, D> {
    let next = |t: &f64| motion.next_kink(*t).filter(|kink| t < kink && *kink < end);
    let kinks = core::iter::successors(next(&0.0), next).take(KINKS).collect();
    (kinks, Box::new(move |t, side| motion.sample(t, side, Derivatives::POSITION).position))
}

impl fmt::Debug for Bake<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Bake").field("name", &self.name).finish_non_exhaustive()
    }
}

impl<'a> Bake<'a> {
    pub(super) fn new(file: &'a Gltf, name: &str, seconds: f64) -> Self {
        Self {
            file,
            name: name.to_owned(),
            seconds,
            under: None,
            bounds: [1e-3; 2],
            added: Vec::new(),
            turns: BTreeMap::new(),
            places: BTreeMap::new(),
        }
    }

    /// Moves all other nodes as in this animation, whose channels the new one shares.
    pub fn under(&mut self, animation: usize) -> &mut Self {
        self.under = Some(animation);
        self
    }

    /// Sets the greatest errors of an orientation, in radians, and of a position, in the file's
    /// unit of length; by default, both are 0.001.
    pub fn bounds(&mut self, turn: f64, distance: f64) -> &mut Self {
        self.bounds = [turn, distance];
        self
    }

    /// Adds a node to the file and returns its number. A node without a parent belongs to the scene
    /// that the file shows.
    pub fn add(&mut self, name: &str, parent: Option<usize>) -> usize {
        self.added.push((name.to_owned(), parent));
        self.file.parents.len() + self.added.len() - 1
    }

    /// Sets the orientation of a node in the world, as [`Gltf::orientation`] returns it. The
    /// quaternions need not be of unit length.
    pub fn orientation(&mut self, node: usize, motion: impl Motion<f64, 4> + 'a) -> &mut Self {
        self.turns.insert(node, path(motion, self.seconds));
        self
    }

    /// Sets the position of a node in the world. Without it, the node keeps its place on its
    /// parent.
    pub fn position(&mut self, node: usize, motion: impl Motion<f64, 3> + 'a) -> &mut Self {
        self.places.insert(node, path(motion, self.seconds));
        self
    }

    /// Returns the bytes of the file with the animation: a `.glb` file if it was read from one,
    /// else a `.gltf` file with the keys inside. The JSON keeps all its members; only a matrix of a
    /// node that follows a motion becomes its translation, rotation and scale.
    ///
    /// # Errors
    /// If a node, a parent or the animation of the others does not exist, or has an error; if the
    /// time is not from a millisecond to a thousand seconds, a bound is not positive, no node
    /// follows a motion, or a motion gives no number; if an orientation is as in the errors of
    /// [`Gltf::orientation`], or a position stands on a parent of scale zero; and if single
    /// precision does not suffice for the bounds.
    pub fn write(&self) -> Result<Vec<u8>, GltfError> {
        let fail = |what: String, advice| GltfError::new("bake", what, advice);
        if !(1.0 / RATE..=LONGEST).contains(&self.seconds) {
            let what = format!("{} s of motion", self.seconds);
            return Err(fail(what, "give a time from 0.001 s to 1000 s"));
        }
        if self.bounds.iter().any(|&bound| !(0.0 < bound && bound < f64::INFINITY)) {
            let what = format!("the bounds {:?}", self.bounds);
            return Err(fail(what, "give positive numbers, as 0.001"));
        }
        let mut rig = Rig::new(self)?;
        let mut nodes: Vec<usize> = self.turns.keys().chain(self.places.keys()).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        if nodes.is_empty() {
            return Err(fail("no node follows a motion".into(), "give an orientation of a node"));
        }
        let mut output = Output::new(&self.file.root, rig.played.animation);
        for (name, parent) in &self.added {
            output.add(name, *parent)?;
        }
        for &node in &nodes {
            if let Some(pose) = rig.load(node)? {
                output.unpack(node, pose);
            }
        }
        let times = self.times(&rig)?;
        // Parents first: their keys carry those of their children.
        nodes.sort_by_key(|&node| rig.line(node).count());
        for node in nodes {
            let place = rig.place(node);
            let within = |error: GltfError| error.within(&place);
            if let Some((_, motion)) = self.turns.get(&node) {
                let keys = rig.turn(node, motion, &times, self.bounds[0]).map_err(within)?;
                output.channel(node, "rotation", &keys);
            }
            if let Some((_, motion)) = self.places.get(&node) {
                let keys = rig.travel(node, motion, &times, self.bounds[1]).map_err(within)?;
                output.channel(node, "translation", &keys);
            }
        }
        output.finish(self.file, &self.name)
    }

    /// Returns the times of the samples, which are numbers of single precision: at each kink, the
    /// first such number that is not before it and the one before that.
    fn times(&self, rig: &Rig<'_>) -> Result<Vec<f64>, GltfError> {
        let end = self.seconds as f32;
        let count = (self.seconds * RATE).ceil() as usize;
        let mut times: Vec<f32> = (0..count).map(|k| (k as f64 / RATE) as f32).collect();
        times.push(end);
        let mut kink = |kink: f64| {
            let near = kink as f32;
            let at = if f64::from(near) < kink { near.next_up() } else { near };
            times.extend([at.next_down(), at]);
        };
        rig.locals.values().flat_map(Local::kinks).for_each(&mut kink);
        let turns = self.turns.values().map(|(kinks, _)| kinks);
        for kinks in turns.chain(self.places.values().map(|(kinks, _)| kinks)) {
            if kinks.len() == KINKS {
                let what = format!("a motion with more than {KINKS} kinks");
                return Err(GltfError::new("bake", what, "bake a shorter part of it"));
            }
            kinks.iter().copied().for_each(&mut kink);
        }
        times.retain(|time| (0.0..=end).contains(time));
        times.sort_by(f32::total_cmp);
        times.dedup();
        Ok(times.into_iter().map(f64::from).collect())
    }
}

/// The nodes of a file and those that are added, each relative to its parent.
struct Rig<'a> {
    bake: &'a Bake<'a>,
    source: Source<'a>,
    played: Played<'a>,
    parents: Vec<Option<usize>>,
    /// The nodes that follow motions and their parents; with keys as soon as these are found.
    locals: BTreeMap<usize, Local>,
}

impl<'a> Rig<'a> {
    fn new(bake: &'a Bake<'a>) -> Result<Self, GltfError> {
        let file = bake.file;
        let mut parents = file.parents.clone();
        for (name, parent) in &bake.added {
            if let Some(absent) = parent.filter(|&parent| parents.len() <= parent) {
                let place = format!("nodes[{}] `{name}`", parents.len());
                let what = format!("its parent nodes[{absent}] does not exist before it");
                return Err(GltfError::new(place, what, "add the parent first"));
            }
            parents.push(*parent);
        }
        let played = file.played(bake.under)?;
        let source = Source::new(&file.root, &file.buffers);
        Ok(Self { bake, source, played, parents, locals: BTreeMap::new() })
    }

    /// Returns the place of a node for errors.
    fn place(&self, node: usize) -> String {
        let added = node.checked_sub(self.bake.file.parents.len());
        let added = added.and_then(|added| self.bake.added.get(added)).map(|(name, _)| &**name);
        let name = added.or_else(|| self.bake.file.nodes().nth(node)).unwrap_or("");
        format!("nodes[{node}] `{name}`")
    }

    /// Returns a node and its parents outwards.
    fn line(&self, node: usize) -> impl Iterator<Item = usize> {
        core::iter::successors(Some(node), |&node| self.parents[node])
    }

    /// Returns the positions of a node and its parents outwards.
    fn chain(&self, node: usize) -> Vec<Local> {
        self.line(node).filter_map(|link| self.locals.get(&link).cloned()).collect()
    }

    /// Reads a node that follows a motion, and its parents. Returns the parts of its matrix if it
    /// has one.
    fn load(&mut self, node: usize) -> Result<Option<Pose>, GltfError> {
        if self.parents.len() <= node {
            return Err(missing(format!("nodes[{node}]")));
        }
        let line: Vec<usize> = self.line(node).collect();
        for link in line {
            if self.locals.contains_key(&link) {
                continue;
            }
            let local = if link < self.bake.file.parents.len() {
                let local = self.bake.file.local(&self.source, &self.played, link);
                local.map_err(|error| error.within(&self.played.place))?
            } else {
                Local::still(([0.0; 3], [0.0, 0.0, 0.0, 1.0], [1.0; 3]))
            };
            self.locals.insert(link, local);
        }
        let Some(Local::Matrix(rows)) = self.locals.get(&node) else { return Ok(None) };
        let (at, turn, scale) = orientation::parts(rows)
            .map_err(|what| GltfError::new(self.place(node), what, MEND))?;
        // As they will be read.
        let [at, scale] = [at, scale].map(|parts| parts.map(|part| f64::from(part as f32)));
        let pose = (at, unit(turn.map(|part| f64::from(part as f32))).unwrap_or(turn), scale);
        self.locals.insert(node, Local::still(pose));
        Ok(Some(pose))
    }

    /// Returns the parts of a node that follows a motion.
    fn parts(&mut self, node: usize) -> Option<&mut Parts> {
        match self.locals.get_mut(&node) {
            Some(Local::Parts(parts)) => Some(parts),
            _ => None,
        }
    }

    /// Finds keys of the rotation with which a node follows a motion.
    fn turn(
        &mut self,
        node: usize,
        motion: impl Fn(Time, Side) -> [f64; 4],
        times: &[f64],
        bound: f64,
    ) -> Result<Keys<4>, GltfError> {
        let (turns, own) = orientation::turns(self.chain(node)).map_err(|(link, what)| {
            let link = self.line(node).nth(link).unwrap_or(node);
            GltfError::new(self.place(link), what, "give the orientation of its parent")
        })?;
        let [inner, outer] =
            [&turns[..own], &turns[own + 1..]].map(|turns| Chain::Turns(turns.to_vec()));
        let turned = |chain: &Chain, t: Time, side: Side| {
            Attitude::from_quaternion(chain.at::<1>(t, side).map(|jet| jet.0[0])).inverse()
        };
        let mut exact: Vec<[f64; 4]> = Vec::with_capacity(times.len());
        for (t, side) in samples(times) {
            let world = Attitude::from_quaternion(motion(t, side));
            let local = turned(&outer, t, side) * world * turned(&inner, t, side);
            let [w, x, y, z] = finite(local.to_quaternion(), t)?;
            let key = [x, y, z, w];
            let opposite = exact.last().is_some_and(|last| dot(last, &key) < 0.0);
            exact.push(if opposite { key.map(|part| -part) } else { key });
        }
        let held: Vec<[f32; 4]> = exact.iter().map(|key| key.map(|part| part as f32)).collect();
        // As they will be read.
        let read = held.iter().map(|key| unit(key.map(f64::from)).unwrap_or([f64::NAN; 4]));
        let read: Vec<[f64; 4]> = read.collect();
        // The angle between quaternions is half of that between rotations.
        let chord = 2.0 * Real::sin(0.25 * Real::min(SHARE * bound, core::f64::consts::PI));
        let fits = |from: usize, to: usize| {
            let arc = Arcs::new(&[times[from], times[to]], &[read[from], read[to]]);
            let arc = Turn::Arcs(arc);
            let short = from + 1 == to || LEAST < dot(&read[from], &read[to]).abs();
            short
                && (from..=to).all(|k| {
                    let at = arc.at::<1>(Time::new(times[k]), Side::After).map(|jet| jet.0[0]);
                    let sign = if dot(&at, &exact[k]) < 0.0 { -1.0 } else { 1.0 };
                    let apart: [f64; 4] = core::array::from_fn(|d| at[d] - sign * exact[k][d]);
                    dot(&apart, &apart) <= chord * chord
                })
        };
        let keys = thinned(times.len(), fits)
            .ok_or_else(|| too_fine(&format!("no orientations within {bound} rad")))?;
        let pick = |values: &[[f64; 4]]| keys.iter().map(|&key| values[key]).collect::<Vec<_>>();
        let at: Vec<f64> = keys.iter().map(|&key| times[key]).collect();
        let rotation = Turn::Arcs(Arcs::new(&at, &pick(&read)));
        if let Some(parts) = self.parts(node) {
            parts.rotation = rotation;
        }
        Ok(keys.iter().map(|&key| (times[key] as f32, held[key])).collect())
    }

    /// Finds keys of the translation with which a node follows a motion.
    fn travel(
        &mut self,
        node: usize,
        motion: impl Fn(Time, Side) -> [f64; 3],
        times: &[f64],
        bound: f64,
    ) -> Result<Keys<3>, GltfError> {
        let chain = self.chain(node);
        let (mut exact, mut frames) = (Vec::new(), Vec::new());
        for (t, side) in samples(times) {
            let world = Vector3::from(finite(motion(t, side), t)?);
            let placed = |point: [f64; 3]| {
                let point = point.map(Jet::<1>::constant);
                let world = chain[1..].iter().fold(point, |point, on| on.place(&point, t, side));
                Vector3::from(world.map(|jet| jet.0[0]))
            };
            let origin = placed([0.0; 3]);
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let frame = Matrix3::from_columns(&axes.map(|axis| placed(axis) - origin));
            let back = frame.try_inverse().ok_or_else(|| {
                let what = format!("a parent has the scale zero at {} s", t.to_f64());
                GltfError::new("position", what, "give the orientation only")
            })?;
            exact.push(back * (world - origin));
            frames.push(frame);
        }
        let held: Vec<[f32; 3]> =
            exact.iter().map(|key| [key.x, key.y, key.z].map(|part| part as f32)).collect();
        let line = |keys: &[usize]| {
            let at: Vec<f64> = keys.iter().map(|&key| times[key]).collect();
            let values: Vec<[f64; 3]> = keys.iter().map(|&key| held[key].map(f64::from)).collect();
            Curve::linear(&at, &values).map(Track::Keyed)
        };
        let fits = |from: usize, to: usize| {
            let line = line(&[from, to]);
            line.is_ok_and(|line| {
                (from..=to).all(|k| {
                    let at = line.at::<1>(Time::new(times[k]), Side::After).map(|jet| jet.0[0]);
                    let apart = frames[k] * (Vector3::from(at) - exact[k]);
                    apart.norm_squared() <= (SHARE * bound) * (SHARE * bound)
                })
            })
        };
        let too_fine = || too_fine(&format!("no positions within {bound}"));
        let keys = thinned(times.len(), fits).ok_or_else(too_fine)?;
        let translation = line(&keys).map_err(|_| too_fine())?;
        if let Some(parts) = self.parts(node) {
            parts.translation = translation;
        }
        Ok(keys.iter().map(|&key| (times[key] as f32, held[key])).collect())
    }
}

/// Returns the times of samples, each with the side from which it is taken: the last is the end.
fn samples(times: &[f64]) -> impl Iterator<Item = (Time, Side)> {
    let last = times.len().saturating_sub(1);
    let side = move |k| if k == last { Side::Before } else { Side::After };
    times.iter().enumerate().map(move |(k, &t)| (Time::new(t), side(k)))
}

/// Refuses values that are no numbers.
fn finite<const D: usize>(value: [f64; D], t: Time) -> Result<[f64; D], GltfError> {
    if value.iter().all(|part| part.is_finite()) {
        return Ok(value);
    }
    let what = format!("the motion gives no finite numbers at {} s", t.to_f64());
    Err(GltfError::new("motion", what, "mend the motion, or bake a shorter part of it"))
}

fn too_fine(what: &str) -> GltfError {
    GltfError::new("bounds", format!("single precision holds {what}"), "give a larger bound")
}

/// Selects keys from `count` samples by a greedy search: each key is as far from the one before as
/// `fits` allows. `None` if two samples in a row do not fit.
fn thinned(count: usize, fits: impl Fn(usize, usize) -> bool) -> Option<Vec<usize>> {
    let last = count - 1;
    let mut keys = vec![0];
    let mut from = 0;
    while from < last {
        if !fits(from, from + 1) {
            return None;
        }
        // Doubling followed by bisection needs a logarithmic number of trials.
        let (mut good, mut stride) = (from + 1, 2);
        while from + stride <= last && fits(from, from + stride) {
            good = from + stride;
            stride *= 2;
        }
        let mut bad = (from + stride).min(last + 1);
        while good + 1 < bad {
            let middle = good.midpoint(bad);
            if fits(from, middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        keys.push(good);
        from = good;
    }
    Some(keys)
}
