//! Motions from glTF 2.0 files and back into them: the animations of their nodes.
//!
//! ```no_run
//! use pendulum_runtime::motion::Projected;
//! use pendulum_runtime::import::gltf::Gltf;
//!
//! let file = Gltf::open("fox.glb")?;
//! let (walk, tail) = (file.animation("Walk")?, file.node("b_Tail03_014")?);
//! // The tip of the tail, seen from the side, in metres: this fox is drawn in centimetres.
//! let tip = Projected::new(file.motion(walk, tail)?.looped()?, [[0.0, 0.0, 0.01], [0.0, 0.01, 0.0]]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Gltf::motion`] is the position of a node, [`Gltf::orientation`] its orientation, for systems
//! with a `driven` rotation. [`Gltf::springs`] are the spring bones of an avatar.
//!
//! [`Gltf::bake`] writes a file with one more animation, in which nodes follow any motions, such as
//! that of a run:
//!
//! ```
//! use pendulum_runtime::import::gltf::Gltf;
//! use pendulum_runtime::motion::{Attitudes, Derivatives, Motion, Sample, Side};
//! use pendulum_runtime::prelude::*;
//! use pendulum_runtime::time::Time;
//!
//! lagrangian! {
//!     /// An ear that springs back and hangs down.
//!     pub struct Ear { l: m, f: 1/s, g: m/s^2 = 9.81 }
//!     coordinate q: rad;
//!     kinetic = l^2*q̇^2/2;
//!     potential = (2*pi*f*l*q)^2/2 - g*l*cos(q);
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let json = br#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
//!     "nodes":[{"name":"head","children":[1]},{"name":"ear","translation":[0,0.1,0]}]}"#;
//! let rabbit = Gltf::read(json)?;
//! let run = solve(&Ear::new(0.1, 1.5), (0.0, 2.0), [0.8], [0.0]).every(1.0 / 60.0).run()?;
//! let turned = |q: &[f64; 1]| Attitude::from_axis_angle([0.0, 0.0, 1.0], q[0]);
//! let keys: Vec<Attitude> = run.q.iter().map(turned).collect();
//! let mut bake = rabbit.bake("shake", 2.0);
//! bake.orientation(rabbit.node("ear")?, Attitudes::spline(&run.t, &keys)?).bounds(0.01, 0.001);
//! let shaken = Gltf::read(&bake.write()?)?;
//! // It is read as any other, and may drive a system.
//! let ear = shaken.orientation(shaken.animation("shake")?, shaken.node("ear")?)?;
//! let at: Sample<f64, 4> = ear.sample(Time::new(1.0), Side::After, Derivatives::POSITION);
//! let angle = 2.0 * at.position[3].atan2(at.position[0]);
//! assert!((angle - run.q[60][0]).abs() < 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! Supported are channels of translations, rotations and scales, with steps, linear interpolation
//! (rotations along the shorter great circle) or cubics with tangents, in `.glb` files and in
//! `.gltf` files with buffers inside or beside the file. Weights of morph targets move no nodes and
//! are ignored, as are channels without a node, which belong to extensions, except those of
//! `KHR_animation_pointer` that move a node. Nothing but nodes, animations and the numbers that
//! they use is looked at, and a mistake in one of them is an error only of the motions that need
//! it. Compressed animations (`EXT_meshopt_compression`) are not supported. Khronos Group, "glTF
//! 2.0 Specification", sections 3.5, 3.6, 3.11 and appendix C.

mod accessor;
mod bake;
mod buffer;
mod channel;
mod chunks;
mod error;
mod jet;
mod json;
mod node;
mod orientation;
mod output;
mod spring;
#[cfg(test)]
mod tests;
mod track;

pub use bake::Bake;
pub use error::GltfError;
pub use node::NodeMotion;
pub use spring::{SpringBone, SpringCollider, SpringShape, Springs};

use crate::contents;
use accessor::Source;
use buffer::Buffer;
use channel::{duration, track, turn};
use json::{floats, index, list, member, number, text};
use node::{Chain, Local, Parts};
use pendulum_core::attitude::Attitude;
use pendulum_core::scalar::Real;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use track::{Track, Turn, dot};

/// The advice for a file that contradicts itself.
const MEND: &str = "mend the file or export it again";

/// A glTF file: a hierarchy of nodes and the animations that move them.
#[derive(Debug)]
pub struct Gltf {
    root: Value,
    buffers: Vec<Buffer>,
    parents: Vec<Option<usize>>,
    /// `true` for a `.glb` file.
    binary: bool,
}

/// An animation, or none, in which all nodes rest.
#[derive(Debug)]
struct Played<'a> {
    place: String,
    animation: &'a Value,
    /// The channels by the nodes that they move, with the properties that they move.
    channels: BTreeMap<usize, Vec<(usize, &'a str)>>,
    /// The samplers that they use.
    samplers: BTreeSet<usize>,
}

/// The animation in which all nodes rest.
static NONE: Value = Value::Null;

/// The greatest number of names in an error.
const LISTED: usize = 12;

/// Returns the number of a name.
fn called<'a>(
    place: &str,
    name: &str,
    names: impl Iterator<Item = &'a str> + Clone,
) -> Result<usize, GltfError> {
    if let Some(number) = names.clone().position(|own| own == name) {
        return Ok(number);
    }
    let known: Vec<String> =
        names.filter(|own| !own.is_empty()).map(|own| format!("`{own}`")).collect();
    let listed = known[..known.len().min(LISTED)].join(", ");
    let what = match known.len() {
        0 => format!("none is called `{name}`, and none has a name"),
        count if LISTED < count => {
            format!("none is called `{name}`; there are {listed} and {} more", count - LISTED)
        }
        _ => format!("none is called `{name}`; there are {listed}"),
    };
    Err(GltfError::new(place, what, "give one of these names, or a number"))
}

impl Gltf {
    /// Reads a `.gltf` or `.glb` file and the buffers beside it.
    ///
    /// # Errors
    /// If the file cannot be read, is cut off or contradicts itself.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, GltfError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes = contents(path, u64::MAX).map_err(|error| {
            GltfError::new(&*name, error.to_string(), "give the path of a glTF file")
        })?;
        Self::parse(&bytes, Some(path.parent().unwrap_or(Path::new(""))))
            .map_err(|error| error.within(&name))
    }

    /// Reads the bytes of a file that refers to no other files.
    ///
    /// # Errors
    /// The errors of [`open`](Self::open), and if a buffer is in another file.
    pub fn read(bytes: &[u8]) -> Result<Self, GltfError> {
        Self::parse(bytes, None)
    }

    fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<Self, GltfError> {
        let fail = |place: &str, what: String| {
            GltfError::new(place, what, "give a file in the format glTF 2.0")
        };
        let (text, blob) = chunks::split(bytes)?;
        let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        if text.trim_ascii().is_empty() {
            return Err(fail("text", "it is empty".into()));
        }
        let root: Value =
            serde_json::from_slice(text).map_err(|error| fail("text", error.to_string()))?;
        let version = match member(&root["asset"], "version") {
            Some(Value::String(version)) => version.clone(),
            Some(version) => version.to_string(),
            None => return Err(fail("asset.version", "it is missing".into())),
        };
        if version.split('.').next() != Some("2") {
            return Err(fail("asset.version", format!("version `{version}`")));
        }
        for key in ["nodes", "animations", "accessors", "bufferViews", "buffers"] {
            if member(&root, key).is_some_and(|list| !list.is_array()) {
                return Err(GltfError::new(key, "it is no list", MEND));
            }
        }
        let buffers = buffer::buffers(&root, blob, folder)?;
        let parents = parents(list(&root, "nodes"))?;
        Ok(Self { root, buffers, parents, binary: bytes.starts_with(b"glTF") })
    }

    /// Returns the names of all nodes by number; empty for nodes without a name.
    pub fn nodes(&self) -> impl Iterator<Item = &str> + Clone {
        list(&self.root, "nodes").iter().map(|node| text(node, "name").unwrap_or(""))
    }

    /// Returns the names of all animations by number; empty for animations without a name.
    pub fn animations(&self) -> impl Iterator<Item = &str> + Clone {
        list(&self.root, "animations").iter().map(|played| text(played, "name").unwrap_or(""))
    }

    /// Returns the number of the first node of this name.
    ///
    /// # Errors
    /// If there is no node of this name; the error lists the existing names.
    pub fn node(&self, name: &str) -> Result<usize, GltfError> {
        called("nodes", name, self.nodes())
    }

    /// Returns the number of the first animation of this name.
    ///
    /// # Errors
    /// If there is no animation of this name; the error lists the existing names.
    pub fn animation(&self, name: &str) -> Result<usize, GltfError> {
        called("animations", name, self.animations())
    }

    /// Returns the position of a node in the world during an animation.
    ///
    /// # Errors
    /// If the animation or the node does not exist, or if a channel contradicts itself.
    pub fn motion(&self, animation: usize, node: usize) -> Result<NodeMotion, GltfError> {
        let (chain, duration) = self.chain(Some(animation), node)?;
        Ok(NodeMotion::new(Chain::Places(chain), duration))
    }

    /// Returns the orientation of a node in the world during an animation, as the unit quaternion
    /// w, x, y, z of its axes.
    ///
    /// It is the product of the rotations of the node and its parents: scales do not turn, even if
    /// they are not uniform and the axes of the node are then not at right angles. If an odd number
    /// of scales is negative, the axes are left-handed, and the orientation has the opposite of
    /// their x.
    ///
    /// # Errors
    /// Also if the scale of the node or of a parent changes its sign, or if the matrix of one of
    /// them has shear.
    pub fn orientation(&self, animation: usize, node: usize) -> Result<NodeMotion<4>, GltfError> {
        let (turns, duration) = self.turns(Some(animation), node)?;
        Ok(NodeMotion::new(Chain::Turns(turns), duration))
    }

    /// Returns the position of a node and its orientation after a first turn by `turn`, during an
    /// animation or at rest, for what hangs on the node, such as a [`SpringBone`].
    ///
    /// # Errors
    /// As for [`motion`](Self::motion) and [`orientation`](Self::orientation).
    pub fn frame(
        &self,
        animation: Option<usize>,
        node: usize,
        turn: Attitude,
    ) -> Result<(NodeMotion, NodeMotion<4>), GltfError> {
        let (chain, duration) = self.chain(animation, node)?;
        let (mut turns, _) = self.turns(animation, node)?;
        let [w, x, y, z] = turn.to_quaternion();
        turns.insert(0, Turn::Still([x, y, z, w]));
        let place = NodeMotion::new(Chain::Places(chain), duration);
        Ok((place, NodeMotion::new(Chain::Turns(turns), duration)))
    }

    /// Begins an animation of this name, to be added to the file. It lasts from 0 to `seconds`, the
    /// times of the motions that its nodes follow.
    pub fn bake(&self, name: &str, seconds: f64) -> Bake<'_> {
        Bake::new(self, name, seconds)
    }

    /// Returns the rotations of a node and its parents during an animation, and the duration.
    fn turns(&self, animation: Option<usize>, node: usize) -> Result<(Vec<Turn>, f64), GltfError> {
        let (chain, duration) = self.chain(animation, node)?;
        let (turns, _) = orientation::turns(chain).map_err(|(link, what)| {
            let node = (0..link).fold(node, |node, _| self.parents[node].unwrap_or(node));
            let name = self.nodes().nth(node).unwrap_or("");
            GltfError::new(format!("nodes[{node}] `{name}`"), what, "ask for its parent")
        })?;
        Ok((turns, duration))
    }

    /// Returns a node and its parents outwards during an animation, and the duration.
    fn chain(&self, animation: Option<usize>, node: usize) -> Result<(Vec<Local>, f64), GltfError> {
        let played = self.played(animation)?;
        if self.parents.len() <= node {
            return Err(missing(format!("nodes[{node}]")));
        }
        let source = Source::new(&self.root, &self.buffers);
        let mut chain = Vec::new();
        let mut next = Some(node);
        while let Some(link) = next {
            let local = self.local(&source, &played, link);
            chain.push(local.map_err(|error| error.within(&played.place))?);
            next = self.parents[link];
        }
        let duration = duration(&source, list(played.animation, "samplers"), &played.samplers);
        Ok((chain, duration.map_err(|error| error.within(&played.place))?))
    }

    /// Finds the nodes that an animation moves; without one, all rest.
    fn played(&self, animation: Option<usize>) -> Result<Played<'_>, GltfError> {
        let Some(animation) = animation else {
            return Ok(Played {
                place: "at rest".into(),
                animation: &NONE,
                channels: BTreeMap::new(),
                samplers: BTreeSet::new(),
            });
        };
        let place = format!("animations[{animation}]");
        let animation = list(&self.root, "animations").get(animation);
        let animation = animation.ok_or_else(|| missing(place.clone()))?;
        for key in ["channels", "samplers"] {
            if !animation[key].is_array() {
                return Err(GltfError::new(place, format!("it has no list of `{key}`"), MEND));
            }
        }
        let mut channels: BTreeMap<usize, Vec<(usize, &str)>> = BTreeMap::new();
        let mut samplers = BTreeSet::new();
        for (number, channel) in list(animation, "channels").iter().enumerate() {
            let fail = |what| GltfError::new(format!("{place}: channels[{number}]"), what, MEND);
            let Some((node, path)) = target(channel).map_err(fail)? else { continue };
            if self.parents.len() <= node {
                return Err(fail(format!("its target nodes[{node}] does not exist")));
            }
            samplers.insert(index(channel, "sampler").map_err(fail)?);
            channels.entry(node).or_default().push((number, path));
        }
        Ok(Played { place, animation, channels, samplers })
    }

    /// Returns the position of a node relative to its parent during an animation.
    fn local(
        &self,
        source: &Source<'_>,
        played: &Played<'_>,
        index: usize,
    ) -> Result<Local, GltfError> {
        let animation = played.animation;
        let node = &self.root["nodes"][index];
        let fail = |what: &str| GltfError::new(format!("nodes[{index}]"), what, MEND);
        let rest: Option<[f64; 4]> = floats(node, "rotation").map_err(|what| fail(&what))?;
        let rest = rest.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let mut rotation =
            Turn::Still(unit(rest).ok_or_else(|| fail("its rotation is no unit quaternion"))?);
        let still = |key: &str, default: [f64; 3]| {
            let value = floats(node, key).map_err(|what| fail(&what))?.unwrap_or(default);
            if value.iter().any(|value| !value.is_finite()) {
                return Err(fail("a number that is infinite or none"));
            }
            Ok(Track::Still(value))
        };
        let mut translation = still("translation", [0.0; 3])?;
        let mut scale = still("scale", [1.0; 3])?;
        let mut moved: BTreeMap<&str, usize> = BTreeMap::new();
        for &(number, path) in played.channels.get(&index).map_or(&[][..], Vec::as_slice) {
            let channel = &animation["channels"][number];
            let place = format!("channels[{number}]");
            let within = |error: GltfError| error.within(&place);
            match path {
                "translation" => translation = track(source, animation, channel).map_err(within)?,
                "rotation" => rotation = turn(source, animation, channel).map_err(within)?,
                "scale" => scale = track(source, animation, channel).map_err(within)?,
                "weights" => continue,
                _ => return Err(GltfError::new(place, "an unknown target path", MEND)),
            }
            if let Some(other) = moved.insert(path, number) {
                let what = format!("channels[{other}] moves the {path} of nodes[{index}] too");
                return Err(GltfError::new(place, what, MEND));
            }
        }
        match floats::<16>(node, "matrix").map_err(|what| fail(&what))? {
            Some(_) if !moved.is_empty() => {
                Err(fail("it is animated, but stands on its parent by a matrix"))
            }
            Some(matrix) => {
                let rows = [0, 1, 2].map(|row| [0, 1, 2, 3].map(|column| matrix[4 * column + row]));
                let last = [3, 7, 11, 15].map(|at| matrix[at]);
                if rows.iter().flatten().any(|value| !value.is_finite())
                    || last != [0.0, 0.0, 0.0, 1.0]
                {
                    return Err(fail("its matrix is no affine map"));
                }
                Ok(Local::Matrix(rows))
            }
            None => Ok(Local::Parts(Box::new(Parts { translation, rotation, scale }))),
        }
    }
}

/// Returns the node that a channel moves, and its property. There is none if the channel belongs to
/// an extension and is to be ignored; `KHR_animation_pointer` may move nodes, too.
fn target(channel: &Value) -> Result<Option<(usize, &str)>, String> {
    let target = &channel["target"];
    if !target.is_object() {
        return Err("its `target` is missing".into());
    }
    if member(target, "node").is_some() {
        return Ok(Some((index(target, "node")?, text(target, "path").unwrap_or(""))));
    }
    let pointer = text(&target["extensions"]["KHR_animation_pointer"], "pointer");
    let moved = pointer.and_then(|pointer| pointer.strip_prefix("/nodes/")?.split_once('/'));
    let moved = moved.filter(|(_, path)| ["translation", "rotation", "scale"].contains(path));
    let node = |node: &str| node.parse().map_err(|_| format!("`{node}` is no number of a node"));
    moved.map(|(number, path)| Ok((node(number)?, path))).transpose()
}

/// The error of a number of nothing.
fn missing(place: String) -> GltfError {
    GltfError::new(place, "does not exist", "ask for the number of a name")
}

/// Returns the parent of each node from the lists of children.
fn parents(nodes: &[Value]) -> Result<Vec<Option<usize>>, GltfError> {
    let count = nodes.len();
    let mut parents: Vec<Option<usize>> = vec![None; count];
    for (index, node) in nodes.iter().enumerate() {
        let fail = |what: String| GltfError::new(format!("nodes[{index}].children"), what, MEND);
        if member(node, "children").is_some_and(|children| !children.is_array()) {
            return Err(fail("it is no list".into()));
        }
        for child in list(node, "children") {
            let child = number(child).and_then(|child| usize::try_from(child).ok());
            let child = child.ok_or_else(|| fail("one of them is no number of a node".into()))?;
            let parent = parents
                .get_mut(child)
                .ok_or_else(|| fail(format!("nodes[{child}] does not exist")))?;
            if let Some(other) = parent.replace(index) {
                return Err(fail(format!("nodes[{child}] is a child of nodes[{other}] too")));
            }
        }
    }
    // A node that reaches no root is its own ancestor. Nodes that reach a root are marked.
    let mut grounded = vec![false; count];
    for start in 0..count {
        let mut path = vec![start];
        while let Some(parent) = parents[path[path.len() - 1]].filter(|&parent| !grounded[parent]) {
            if count <= path.len() {
                return Err(GltfError::new(
                    format!("nodes[{start}]"),
                    "it is a parent of itself",
                    MEND,
                ));
            }
            path.push(parent);
        }
        for node in path {
            grounded[node] = true;
        }
    }
    Ok(parents)
}

/// Normalizes a quaternion; `None` if it is too short or too long, or NaN.
fn unit(quaternion: [f64; 4]) -> Option<[f64; 4]> {
    let length = Real::sqrt(dot(&quaternion, &quaternion));
    (1e-3 < length && length < 1e3).then(|| quaternion.map(|part| part / length))
}
