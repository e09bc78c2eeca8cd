//! Motions from glTF 2.0 files: the animations of their nodes.
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
//! Supported are channels of translations, rotations and scales, with steps, linear interpolation
//! (rotations along the shorter great circle) or cubics with tangents, in `.glb` files and in
//! `.gltf` files with buffers inside or beside the file. Weights of morph targets move no nodes and
//! are ignored. Khronos Group, "glTF 2.0 Specification", sections 3.5, 3.6, 3.11 and appendix C.

mod accessor;
mod buffer;
mod error;
mod jet;
mod node;
#[cfg(test)]
mod tests;
mod track;

pub use error::GltfError;
pub use node::NodeMotion;

use crate::motion::piecewise::{Piecewise, checked};
use crate::scalar::Real;
use accessor::Source;
use gltf::json::animation::{Channel, Interpolation, Property};
use gltf::json::validation::Checked;
use gltf::json::{Animation, Root};
use node::{Local, Parts};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use track::{Arcs, Track, Turn, dot, vanishing};

/// Times, values and their interpolation.
type Keys<const D: usize> = (Vec<f64>, Vec<[f64; D]>, Interpolation);

/// The advice for a file that contradicts itself.
const MEND: &str = "mend the file or export it again";

/// A glTF file: a hierarchy of nodes and the animations that move them.
#[derive(Debug)]
pub struct Gltf {
    root: Root,
    buffers: Vec<Vec<u8>>,
    parents: Vec<Option<usize>>,
}

/// The greatest number of names in an error.
const LISTED: usize = 12;

/// Returns the number of a name.
fn number<'a>(
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
        let bytes = std::fs::read(path).map_err(|error| {
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
        if bytes.starts_with(b"glTF") {
            let header =
                bytes.get(8..12).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
            match header {
                Some(length) if 12 <= length && length as usize <= bytes.len() => {}
                _ => {
                    let what =
                        format!("the header does not fit the {} bytes of the file", bytes.len());
                    return Err(GltfError::new(
                        "header",
                        what,
                        "the file is cut off; fetch it again",
                    ));
                }
            }
        }
        let file = ::gltf::Gltf::from_slice_without_validation(bytes).map_err(|error| {
            let place = if bytes.starts_with(b"glTF") { "chunks" } else { "text" };
            GltfError::new(place, error.to_string(), "give a file in the format glTF 2.0")
        })?;
        let root = file.document.into_json();
        if !root.asset.version.starts_with("2.") {
            let what = format!("version `{}`", root.asset.version);
            return Err(GltfError::new(
                "asset.version",
                what,
                "give a file in the format glTF 2.0",
            ));
        }
        let buffers = buffer::buffers(&root, file.blob, folder)?;
        let parents = parents(&root)?;
        Ok(Self { root, buffers, parents })
    }

    /// Returns the names of all nodes by number; empty for nodes without a name.
    pub fn nodes(&self) -> impl Iterator<Item = &str> + Clone {
        self.root.nodes.iter().map(|node| node.name.as_deref().unwrap_or(""))
    }

    /// Returns the names of all animations by number; empty for animations without a name.
    pub fn animations(&self) -> impl Iterator<Item = &str> + Clone {
        self.root.animations.iter().map(|animation| animation.name.as_deref().unwrap_or(""))
    }

    /// Returns the number of the first node of this name.
    ///
    /// # Errors
    /// If there is no node of this name; the error lists the existing names.
    pub fn node(&self, name: &str) -> Result<usize, GltfError> {
        number("nodes", name, self.nodes())
    }

    /// Returns the number of the first animation of this name.
    ///
    /// # Errors
    /// If there is no animation of this name; the error lists the existing names.
    pub fn animation(&self, name: &str) -> Result<usize, GltfError> {
        number("animations", name, self.animations())
    }

    /// Returns the motion of a node in world coordinates during an animation.
    ///
    /// # Errors
    /// If the animation or the node does not exist, or if a channel contradicts itself.
    pub fn motion(&self, animation: usize, node: usize) -> Result<NodeMotion, GltfError> {
        let outer = format!("animations[{animation}]");
        let missing =
            |place: String| GltfError::new(place, "does not exist", "ask for the number of a name");
        let played = self.root.animations.get(animation).ok_or_else(|| missing(outer.clone()))?;
        if self.root.nodes.len() <= node {
            return Err(missing(format!("nodes[{node}]")));
        }
        let source = Source::new(&self.root, &self.buffers);
        // The channels by the nodes that they move.
        let mut channels: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (number, channel) in played.channels.iter().enumerate() {
            let target = channel.target.node.value();
            if self.root.nodes.len() <= target {
                let what = format!("its target nodes[{target}] does not exist");
                return Err(GltfError::new(format!("{outer}: channels[{number}]"), what, MEND));
            }
            channels.entry(target).or_default().push(number);
        }
        let mut chain = Vec::new();
        let mut next = Some(node);
        while let Some(link) = next {
            let own = channels.get(&link).map_or(&[][..], Vec::as_slice);
            chain.push(
                self.local(&source, played, own, link).map_err(|error| error.within(&outer))?,
            );
            next = self.parents[link];
        }
        Ok(NodeMotion::new(chain, duration(&source, played).map_err(|error| error.within(&outer))?))
    }

    /// Returns the position of a node relative to its parent during an animation with these
    /// channels.
    fn local(
        &self,
        source: &Source<'_>,
        animation: &Animation,
        channels: &[usize],
        index: usize,
    ) -> Result<Local, GltfError> {
        let node = &self.root.nodes[index];
        let fail = |what: &str| GltfError::new(format!("nodes[{index}]"), what, MEND);
        let wide = |values: [f32; 3]| values.map(f64::from);
        let rest = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0.map(f64::from));
        let mut translation = Track::Still(wide(node.translation.unwrap_or([0.0; 3])));
        let mut rotation =
            Turn::Still(unit(rest).ok_or_else(|| fail("its rotation is no unit quaternion"))?);
        let mut scale = Track::Still(wide(node.scale.unwrap_or([1.0; 3])));
        let numbers = [node.translation, node.scale];
        if numbers.iter().flatten().flatten().any(|value| !value.is_finite()) {
            return Err(fail("a number that is infinite or none"));
        }
        let mut animated = false;
        for &number in channels {
            let channel = &animation.channels[number];
            let place = format!("channels[{number}]");
            let Checked::Valid(path) = channel.target.path else {
                return Err(GltfError::new(place, "an unknown target path", MEND));
            };
            match path {
                Property::Translation => {
                    translation =
                        track(source, animation, channel).map_err(|error| error.within(&place))?;
                }
                Property::Rotation => {
                    rotation =
                        turn(source, animation, channel).map_err(|error| error.within(&place))?;
                }
                Property::Scale => {
                    scale =
                        track(source, animation, channel).map_err(|error| error.within(&place))?;
                }
                Property::MorphTargetWeights => continue,
            }
            animated = true;
        }
        match node.matrix {
            Some(_) if animated => {
                Err(fail("it is animated, but stands on its parent by a matrix"))
            }
            Some(matrix) => {
                let rows = [0, 1, 2]
                    .map(|row| [0, 1, 2, 3].map(|column| f64::from(matrix[4 * column + row])));
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

/// Returns the time of the last key of all channels.
fn duration(source: &Source<'_>, animation: &Animation) -> Result<f64, GltfError> {
    let mut last = 0.0;
    let mut inputs = BTreeSet::new();
    for (index, sampler) in animation.samplers.iter().enumerate() {
        // Channels usually have the same times.
        if !inputs.insert(sampler.input.value()) {
            continue;
        }
        let times = source.read::<1>(sampler.input.value());
        let times = times.map_err(|error| error.within(&format!("samplers[{index}].input")))?;
        last = times.iter().fold(last, |last, &[time]| if last < time { time } else { last });
    }
    if last.is_finite() {
        Ok(last)
    } else {
        Err(GltfError::new("samplers", "a key at an infinite time", MEND))
    }
}

fn track(
    source: &Source<'_>,
    animation: &Animation,
    channel: &Channel,
) -> Result<Track, GltfError> {
    let (times, values, interpolation) = keys::<3>(source, animation, channel)?;
    Ok(Track::Keyed(match interpolation {
        Interpolation::Step => Piecewise::steps(&times, &values),
        Interpolation::Linear => Piecewise::lines(&times, &values),
        Interpolation::CubicSpline => cubic(&times, &values),
    }))
}

fn turn(source: &Source<'_>, animation: &Animation, channel: &Channel) -> Result<Turn, GltfError> {
    let (times, mut values, interpolation) = keys::<4>(source, animation, channel)?;
    let tangents = interpolation == Interpolation::CubicSpline;
    let [first, each] = if tangents { [1, 3] } else { [0, 1] };
    let keys = values.iter_mut().skip(first).step_by(each);
    for (key, value) in keys.enumerate() {
        let what = || GltfError::new("output", format!("key {key} is no unit quaternion"), MEND);
        let length = unit(*value).ok_or_else(what)?;
        if !tangents {
            *value = length;
        }
    }
    Ok(match interpolation {
        Interpolation::Step => Turn::Steps(Piecewise::steps(&times, &values)),
        Interpolation::Linear => Turn::Arcs(Arcs::new(&times, &values)),
        Interpolation::CubicSpline => {
            let curve = cubic(&times, &values);
            if let Some(key) = vanishing(&curve) {
                let what = format!("the quaternion vanishes between key {key} and key {}", key + 1);
                return Err(GltfError::new(
                    "output",
                    what,
                    "turn by less than half a turn from key to key",
                ));
            }
            Turn::Cubic(curve)
        }
    })
}

/// Returns the times and values of a channel, with three values per key if there are tangents.
fn keys<const D: usize>(
    source: &Source<'_>,
    animation: &Animation,
    channel: &Channel,
) -> Result<Keys<D>, GltfError> {
    let number = channel.sampler.value();
    let place = format!("samplers[{number}]");
    let fail = |what: String| GltfError::new(&*place, what, MEND);
    let sampler = animation.samplers.get(number).ok_or_else(|| fail("does not exist".into()))?;
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return Err(fail("an unknown interpolation".into()));
    };
    let within = |part: &str, error: GltfError| error.within(&format!("{place}.{part}"));
    let times = source.read::<1>(sampler.input.value()).map_err(|error| within("input", error))?;
    let values =
        source.read::<D>(sampler.output.value()).map_err(|error| within("output", error))?;
    let times: Vec<f64> = times.into_iter().map(|[time]| time).collect();
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if values.len() != each * times.len() {
        return Err(fail(format!(
            "{} times but {} values; {each} a time are needed",
            times.len(),
            values.len()
        )));
    }
    checked(&times, &values[..times.len()]).map_err(|error| fail(error.to_string()))?;
    if times[0] < 0.0 {
        return Err(fail(format!("key 0 at {} s lies before the beginning", times[0])));
    }
    if let Some(key) = values.iter().position(|value| value.iter().any(|part| !part.is_finite())) {
        return Err(fail(format!("value {key} is infinite or no number")));
    }
    Ok((times, values, interpolation))
}

/// Returns the parent of each node from the lists of children.
fn parents(root: &Root) -> Result<Vec<Option<usize>>, GltfError> {
    let count = root.nodes.len();
    let mut parents: Vec<Option<usize>> = vec![None; count];
    for (index, node) in root.nodes.iter().enumerate() {
        let fail = |what: String| GltfError::new(format!("nodes[{index}].children"), what, MEND);
        for child in node.children.iter().flatten().map(gltf::json::Index::value) {
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

/// Creates cubics from three values per key: an arriving tangent, the value and a leaving tangent.
/// Tangents are velocities.
fn cubic<const D: usize>(times: &[f64], values: &[[f64; D]]) -> Piecewise<D> {
    let points: Vec<[f64; D]> = values.iter().skip(1).step_by(3).copied().collect();
    let slopes: Vec<_> =
        (0..times.len() - 1).map(|key| [values[3 * key + 2], values[3 * key + 3]]).collect();
    Piecewise::hermite(times, &points, &slopes).with_kinks(true)
}

/// Normalizes a quaternion; `None` if it is too short or too long, or NaN.
fn unit(quaternion: [f64; 4]) -> Option<[f64; 4]> {
    let length = Real::sqrt(dot(&quaternion, &quaternion));
    (1e-3 < length && length < 1e3).then(|| quaternion.map(|part| part / length))
}
