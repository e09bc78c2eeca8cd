//! Spring bones of avatars: `VRMC_springBone` of VRM 1.0 and `secondaryAnimation` of VRM 0.x.
//!
//! VRM Consortium, "VRMC_springBone 1.0", "VRMC_springBone_extended_collider 1.0" and the schema of
//! "VRM 0.0".

mod colliders;
mod settings;

use super::accessor::Source;
use super::error::GltfError;
use super::jet::Jet;
use super::json::member;
use super::node::Local;
use super::orientation::turns;
use super::{Gltf, MEND, Played};
use colliders::Part;
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::Side;
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;
use settings::Joint;
use std::collections::BTreeMap;

/// The spring bones of a file, and the bodies that they do not enter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Springs {
    /// The bones; each stands behind the one that carries it.
    pub bones: Vec<SpringBone>,
    /// The bodies.
    pub colliders: Vec<SpringCollider>,
}

/// A bone that springs back: it turns its node, and all that stands on the node.
///
/// It points along the axis y of its attitude, which at rest is that of the node after a first turn
/// by [`axis`](Self::axis). Lengths are those of the file at rest, with the scales of all parents,
/// which have to be the same along all axes; `hit_radius` is not scaled. Settings are in the units
/// of the file, for its formula.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringBone {
    /// The node.
    pub node: usize,
    /// The attitude of the bone relative to its node. If the bone has the attitude A, the
    /// orientation of the node is A times the inverse of it.
    pub axis: Attitude,
    /// The bone that carries this one, by its number in the list: that of the nearest parent with
    /// one. Without one, the parent of the node carries it.
    pub carrier: Option<usize>,
    /// The place of the bone on what carries it: from the tip of the bone that does, in its axes,
    /// or from the parent, in the axes of its orientation.
    pub place: [f64; 3],
    /// The attitude at rest relative to that of the bone that carries this one, or to the
    /// orientation of the parent.
    pub rest: Attitude,
    /// The distance from the node to the tip, which is positive.
    pub length: f64,
    /// `stiffness`: the force towards the direction of rest.
    pub stiffness: f64,
    /// `gravityPower`: the magnitude of gravity.
    pub gravity_power: f64,
    /// `gravityDir`: the direction of gravity.
    pub gravity_dir: [f64; 3],
    /// `dragForce`: the deceleration, usually from 0 to 1.
    pub drag_force: f64,
    /// `hitRadius`: the radius of the ball around the tip that enters no body.
    pub hit_radius: f64,
    /// `center`: the node in whose space the inertia of the bone counts, as that of a
    /// `CenteredBone` does.
    pub center: Option<usize>,
    /// The bodies that the bone does not enter, by their numbers in the list.
    pub colliders: Vec<usize>,
}

/// A body that bones do not enter or leave.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringCollider {
    /// The node on which the body stands.
    pub node: usize,
    /// The bone that carries the node, if any, by its number in the list.
    pub carrier: Option<usize>,
    /// The shape in the axes of the orientation of the node, from the node; if a bone carries it,
    /// in the axes of the bone, from its tip.
    pub shape: SpringShape,
}

/// The shape of a [`SpringCollider`], in metres. Radii are not scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpringShape {
    /// All points within a distance of a line between two points.
    Capsule {
        /// The points; a sphere has two equal ones.
        ends: [[f64; 3]; 2],
        /// The distance, which may be zero outside of the capsule.
        radius: f64,
        /// `true` for what bones do not leave.
        inside: bool,
    },
    /// The half of space on the other side of a plane than its normal.
    Plane {
        /// A point of the plane.
        point: [f64; 3],
        /// The direction out of the half, of length 1.
        normal: [f64; 3],
    },
}

/// The length of a bone of VRM 0.x without a child, by its specification.
const LEAF: f64 = 0.07;

/// The length in metres below which a bone has no direction, but rounding errors.
const SHORTEST: f64 = 1e-6;

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn length(a: [f64; 3]) -> f64 {
    Real::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
}

/// A node at rest in the world.
#[derive(Clone, Copy, Debug)]
struct Rest {
    /// The affine map of its points, by rows.
    rows: [[f64; 4]; 3],
    /// Its orientation, and whether its axes are mirrored.
    turn: Attitude,
    mirrored: bool,
    /// The number of its parents.
    depth: usize,
}

impl Rest {
    fn world() -> Self {
        let rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        Self { rows, turn: Attitude::identity(), mirrored: false, depth: 0 }
    }

    fn point(&self, p: [f64; 3]) -> [f64; 3] {
        self.rows.map(|[x, y, z, w]| x * p[0] + y * p[1] + z * p[2] + w)
    }

    fn origin(&self) -> [f64; 3] {
        self.rows.map(|row| row[3])
    }

    fn column(&self, at: usize) -> [f64; 3] {
        self.rows.map(|row| row[at])
    }

    /// Returns the normal of a plane of the node, of any length: that of the images of two vectors
    /// in it, on the side of the image of the normal.
    fn normal(&self, normal: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = [0, 1, 2].map(|at| self.column(at));
        let across = [cross(b, c), cross(c, a), cross(a, b)];
        let sign = if self.mirrored { -1.0 } else { 1.0 };
        [0, 1, 2].map(|k| sign * (0..3).map(|at| normal[at] * across[at][k]).sum::<f64>())
    }

    /// Returns the node `link` at rest on this one.
    fn carry(&self, link: usize, local: Local) -> Result<Self, GltfError> {
        let image = |p: [f64; 3]| {
            let p = p.map(Jet::<1>::constant);
            self.point(local.place(&p, Time::new(0.0), Side::After).map(|part| part.0[0]))
        };
        let origin = image([0.0; 3]);
        let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let [x, y, z] = units.map(|unit| minus(image(unit), origin));
        let rows = [0, 1, 2].map(|row| [x[row], y[row], z[row], origin[row]]);
        let volume: f64 = cross(x, y).iter().zip(z).map(|(a, b)| a * b).sum();
        let (turns, _) = turns(vec![local]).map_err(|(_, what)| {
            GltfError::new(format!("nodes[{link}]"), what, "let no spring bone stand on it")
        })?;
        // A mirror commutes with everything but stands behind the half turn about x, see `turns`.
        let mirrored = volume < 0.0;
        let half = |mirrored: bool| {
            Attitude::from_quaternion(if mirrored {
                [0.0, 1.0, 0.0, 0.0]
            } else {
                [1.0, 0.0, 0.0, 0.0]
            })
        };
        let own = turns.iter().fold(Attitude::identity(), |inner, turn| {
            let [x, y, z, w] = turn.at::<1>(Time::new(0.0), Side::After).map(|part| part.0[0]);
            Attitude::from_quaternion([w, x, y, z]) * inner
        });
        let turn = self.turn * half(self.mirrored) * own * half(mirrored != self.mirrored);
        Ok(Self { rows, turn: turn * half(mirrored), mirrored, depth: self.depth + 1 })
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The nodes of a file at rest, each computed once from its parent: a file may be one long chain.
struct Nodes<'a> {
    file: &'a Gltf,
    source: Source<'a>,
    played: Played<'a>,
    known: Vec<Option<Rest>>,
}

impl<'a> Nodes<'a> {
    fn new(file: &'a Gltf) -> Result<Self, GltfError> {
        let source = Source::new(&file.root, &file.buffers);
        Ok(Self { file, source, played: file.played(None)?, known: vec![None; file.parents.len()] })
    }

    fn at(&mut self, node: usize) -> Result<Rest, GltfError> {
        let above = |link: &usize| self.file.parents[*link];
        let line = core::iter::successors(Some(node), above);
        let path: Vec<usize> = line.take_while(|&link| self.known[link].is_none()).collect();
        for link in path.into_iter().rev() {
            let outer = self.file.parents[link].and_then(|parent| self.known[parent]);
            let local = self.file.local(&self.source, &self.played, link)?;
            self.known[link] = Some(outer.unwrap_or_else(Rest::world).carry(link, local)?);
        }
        Ok(self.known[node].unwrap_or_else(Rest::world))
    }
}

impl Gltf {
    /// Returns the spring bones of `VRMC_springBone`, with the shapes of
    /// `VRMC_springBone_extended_collider`, or of `secondaryAnimation` of VRM 0.x. There are none
    /// in a file with neither.
    ///
    /// A joint at the place of the next one has no direction and makes no bone; those below it are
    /// carried by the bone above. In VRM 0.x a node that several groups name belongs to the first,
    /// a bone without a child is 7 cm long, and a bone with several children ends at the first one.
    ///
    /// This hangs all bones of a file into a scene, on the nodes of an animation. A program that
    /// moves nodes itself gives live frames in place of [`frame`](Self::frame). A bone without
    /// `center` has one that rests.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::import::gltf::{Gltf, SpringShape};
    /// use pendulum_runtime::motion::Still;
    /// use pendulum_runtime::scene::{Collider, Scene, Shape, VrmSpring};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let json = br#"{"asset":{"version":"2.0"},"nodes":[{"name":"head","children":[1]},
    /// #     {"name":"ear","translation":[0,0.1,0],"children":[2]},{"translation":[0,0.2,0]}],
    /// #     "extensions":{"VRMC_springBone":{"specVersion":"1.0",
    /// #     "colliders":[{"node":0,"shape":{"sphere":{"radius":0.05}}}],
    /// #     "colliderGroups":[{"colliders":[0]}],
    /// #     "springs":[{"joints":[{"node":1,"gravityPower":0.1},{"node":2}],
    /// #     "colliderGroups":[0]}]}}}"#;
    /// let file = Gltf::read(json)?;
    /// let springs = file.springs()?;
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let still = scene.joint(Still::new([1.0, 0.0, 0.0, 0.0]));
    /// let space = (scene.joint(Still::new([0.0; 3])), still);
    /// let mut hung = Vec::new();
    /// for bone in &springs.bones {
    ///     let frame = match bone.carrier {
    ///         Some(below) => scene.frame_on(hung[below], ["tip", "turn"], bone.place, bone.rest)?,
    ///         None => {
    ///             let (place, turn) = file.frame(None, bone.node, bone.axis)?;
    ///             (scene.joint(place), scene.joint(turn))
    ///         }
    ///     };
    ///     let spring = VrmSpring {
    ///         stiffness: bone.stiffness,
    ///         gravity_power: bone.gravity_power,
    ///         gravity_dir: bone.gravity_dir,
    ///         drag_force: bone.drag_force,
    ///         ..VrmSpring::default()
    ///     };
    ///     let center = match bone.center {
    ///         Some(node) => {
    ///             let (place, turn) = file.frame(None, node, Attitude::identity())?;
    ///             (scene.joint(place), scene.joint(turn))
    ///         }
    ///         None => space,
    ///     };
    ///     let anchor = (frame.0, frame.1, center.0, center.1);
    ///     hung.extend(scene.hang_chain(anchor, [spring.bone(bone.length)?.centered()])?);
    /// }
    /// let mut bodies = Vec::new();
    /// for body in &springs.colliders {
    ///     let frame = match body.carrier {
    ///         Some(bone) => {
    ///             let turn = Attitude::identity();
    ///             scene.frame_on(hung[bone], ["tip", "turn"], [0.0; 3], turn)?
    ///         }
    ///         None => {
    ///             let (place, turn) = file.frame(None, body.node, Attitude::identity())?;
    ///             (scene.joint(place), scene.joint(turn))
    ///         }
    ///     };
    ///     let shape = match body.shape {
    ///         SpringShape::Plane { point, normal } => Shape::Half { point, normal },
    ///         SpringShape::Capsule { ends, radius, inside } if inside => {
    ///             Shape::Inside { ends, radius }
    ///         }
    ///         SpringShape::Capsule { ends, radius, .. } => Shape::Capsule { ends, radius },
    ///     };
    ///     bodies.push(Collider { frame, shape });
    /// }
    /// for (bone, &handle) in springs.bones.iter().zip(&hung) {
    ///     let own: Vec<_> = bone.colliders.iter().map(|&body| bodies[body]).collect();
    ///     scene.set_colliders(handle, bone.hit_radius, &own)?;
    /// }
    /// scene.advance(1.0)?;
    /// // The orientation of each node in the world.
    /// let seen = scene.observe(hung[0], scene.alpha());
    /// let ear = seen.system.turn(seen.t, &seen.q, &seen.v, &seen.inputs);
    /// let ear = ear * springs.bones[0].axis.inverse();
    /// # assert!((ear * [0.0, 1.0, 0.0])[1] > 0.99);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Returns an error if a setting is malformed, which it names by its path, if a node does not
    /// exist or is turned by two springs, if a spring bone carries a center, or if the matrix of a
    /// node has shear.
    pub fn springs(&self) -> Result<Springs, GltfError> {
        let extensions = &self.root["extensions"];
        let (joints, parts) = if let Some(springs) = member(extensions, "VRMC_springBone") {
            self.joints(springs)?
        } else if let Some(springs) = member(&extensions["VRM"], "secondaryAnimation") {
            self.joints_of_0(springs)?
        } else {
            return Ok(Springs::default());
        };
        let mut nodes = Nodes::new(self)?;
        let mut bones = self.bones(&mut nodes, joints)?;
        let carriers = self.carriers(&bones);
        let mut tips = Vec::with_capacity(bones.len());
        for bone in &bones {
            // The center of a bone may be the node of the first one of a chain.
            let above = |center: usize| self.parents[center].and_then(|parent| carriers[parent]);
            if let Some((center, carrier)) =
                bone.center.and_then(|center| Some(center).zip(above(center)))
            {
                let what = format!(
                    "it is the center of a spring, and the spring bone nodes[{}] carries it",
                    bones[carrier].node
                );
                let advice = "give a node that no spring bone carries, or none";
                return Err(GltfError::new(format!("nodes[{center}]"), what, advice));
            }
            let rest = nodes.at(bone.node)?;
            let turn = rest.turn * bone.axis;
            let [x, y, z] = turn * [0.0, bone.length, 0.0];
            tips.push((minus(rest.origin(), [-x, -y, -z]), turn));
        }
        for number in 0..bones.len() {
            let (node, (_, turn)) = (bones[number].node, tips[number]);
            let below = self.parents[node];
            let carrier = below.and_then(|below| carriers[below]);
            let (origin, base) = match (carrier, below) {
                (Some(bone), _) => tips[bone],
                (None, Some(parent)) => {
                    let parent = nodes.at(parent)?;
                    (parent.origin(), parent.turn)
                }
                (None, None) => ([0.0; 3], Attitude::identity()),
            };
            let place = base.inverse() * minus(nodes.at(node)?.origin(), origin);
            let rest = base.inverse() * turn;
            bones[number] = SpringBone { carrier, place, rest, ..bones[number].clone() };
        }
        let mut colliders = Vec::with_capacity(parts.len());
        for Part { node, shape } in parts {
            let (rest, carrier) = (nodes.at(node)?, carriers[node]);
            let frame = carrier.map_or_else(|| (rest.origin(), rest.turn), |bone| tips[bone]);
            let shape = shape.seen(&rest, frame).ok_or_else(|| {
                let what = "a collider on it has no finite shape";
                GltfError::new(format!("nodes[{node}]"), what, "mend the scales of its parents")
            })?;
            colliders.push(SpringCollider { node, carrier, shape });
        }
        Ok(Springs { bones, colliders })
    }

    /// Returns the bones of joints, parents first, without what carries them.
    fn bones(
        &self,
        nodes: &mut Nodes<'_>,
        joints: Vec<Joint>,
    ) -> Result<Vec<SpringBone>, GltfError> {
        let mut bones: Vec<(usize, SpringBone)> = Vec::new();
        for Joint { place, mut bone, tail } in joints {
            let rest = nodes.at(bone.node).map_err(|error| error.within(&place))?;
            let along = match (tail, self.parents[bone.node]) {
                (Some(tail), _) => {
                    let tail = nodes.at(tail).map_err(|error| error.within(&place))?;
                    minus(tail.origin(), rest.origin())
                }
                (None, Some(parent)) => {
                    let along = minus(rest.origin(), nodes.at(parent)?.origin());
                    let size = length(along);
                    along.map(|part| if 0.0 < size { LEAF * part / size } else { 0.0 })
                }
                (None, None) => [0.0; 3],
            };
            bone.length = length(along);
            if !bone.length.is_finite() {
                return Err(GltfError::new(place, "its node is infinitely far away", MEND));
            }
            if bone.length < SHORTEST {
                continue;
            }
            bone.axis = Attitude::from_directions([0.0, 1.0, 0.0], rest.turn.inverse() * along);
            bones.push((rest.depth, bone));
        }
        bones.sort_by_key(|(depth, _)| *depth);
        Ok(bones.into_iter().map(|(_, bone)| bone).collect())
    }

    /// Returns the bone that carries each node, that of the node itself or of the nearest parent
    /// with one, in one pass over all nodes.
    fn carriers(&self, bones: &[SpringBone]) -> Vec<Option<usize>> {
        let numbers = bones.iter().enumerate().map(|(number, bone)| (bone.node, Some(number)));
        let mut known: BTreeMap<usize, Option<usize>> = numbers.collect();
        let mut path = Vec::new();
        for node in 0..self.parents.len() {
            let mut next = Some(node);
            let found = loop {
                let Some(link) = next else { break None };
                if let Some(found) = known.get(&link) {
                    break *found;
                }
                path.push(link);
                next = self.parents[link];
            };
            known.extend(path.drain(..).map(|link| (link, found)));
        }
        known.into_values().collect()
    }
}
