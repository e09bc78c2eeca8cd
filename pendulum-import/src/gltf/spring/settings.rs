//! The settings of spring bones: their names, defaults and bounds.

use super::super::error::GltfError;
use super::super::json::{floats, index, list, member, number, text};
use super::super::{Gltf, MEND};
use super::SpringBone;
use super::colliders::{Part, collider, sphere_of_0};
use pendulum_core::attitude::Attitude;
use serde_json::Value;
use std::collections::BTreeSet;

/// A bone whose length and direction are those between two nodes.
pub(super) struct Joint {
    /// The path of its settings.
    pub(super) place: String,
    pub(super) bone: SpringBone,
    /// The node at the tip; `None` for a bone of VRM 0.x without a child.
    pub(super) tail: Option<usize>,
}

/// The greatest number of nodes between two joints of a chain.
const SKIPPED: usize = 1 << 10;

/// Returns the elements of a list with their paths; none if it is absent.
pub(super) fn entries<'a>(
    object: &'a Value,
    place: &str,
    key: &str,
) -> Result<Vec<(String, &'a Value)>, GltfError> {
    let place = format!("{place}.{key}");
    if member(object, key).is_some_and(|list| !list.is_array()) {
        return Err(GltfError::new(place, "it is no list", MEND));
    }
    let named = |(at, entry)| (format!("{place}[{at}]"), entry);
    Ok(list(object, key).iter().enumerate().map(named).collect())
}

/// Returns a finite number, or its default.
pub(super) fn real(object: &Value, key: &str, default: f64) -> Result<f64, String> {
    let Some(value) = member(object, key) else { return Ok(default) };
    let value = value.as_f64().filter(|value| value.is_finite());
    value.ok_or_else(|| format!("its `{key}` is no number"))
}

/// Returns a number that is not negative, or its default.
pub(super) fn size(object: &Value, key: &str, default: f64) -> Result<f64, String> {
    let value = real(object, key, default)?;
    if value < 0.0 { Err(format!("its `{key}` is negative")) } else { Ok(value) }
}

/// Returns a vector of finite numbers, or its default.
pub(super) fn vector(object: &Value, key: &str, default: [f64; 3]) -> Result<[f64; 3], String> {
    let value = floats(object, key)?.unwrap_or(default);
    let finite = value.iter().all(|part| part.is_finite());
    finite.then_some(value).ok_or_else(|| format!("its `{key}` is infinite"))
}

/// Returns a vector of VRM 0.x, or its default. It is an object, and its axes are left-handed, those
/// of Unity: z points backwards.
///
/// UniVRM, `MigrateVector3`, which turns the model by half a turn about y, too.
pub(super) fn object(object: &Value, key: &str, default: [f64; 3]) -> Result<[f64; 3], String> {
    let Some(value) = member(object, key) else { return Ok(default) };
    if !value.is_object() {
        return Err(format!("its `{key}` is no object with x, y and z"));
    }
    let part = |axis| real(value, axis, 0.0).map_err(|what| format!("`{key}`: {what}"));
    Ok([part("x")?, part("y")?, -part("z")?])
}

/// Reads the settings of a joint, which VRM 0.x has in each group.
fn setting(setting: &Value, stiffness: &str, gravity_dir: [f64; 3]) -> Result<SpringBone, String> {
    Ok(SpringBone {
        node: 0,
        axis: Attitude::identity(),
        carrier: None,
        place: [0.0; 3],
        rest: Attitude::identity(),
        length: 0.0,
        stiffness: size(setting, stiffness, 1.0)?,
        gravity_power: real(setting, "gravityPower", 0.0)?,
        gravity_dir,
        drag_force: size(setting, "dragForce", 0.5)?,
        hit_radius: size(setting, "hitRadius", 0.0)?,
        center: None,
        colliders: Vec::new(),
    })
}

impl Gltf {
    /// Returns the number of a node that exists.
    pub(super) fn node_of(&self, object: &Value, key: &str) -> Result<usize, String> {
        let node = index(object, key)?;
        let exists = node < self.parents.len();
        exists.then_some(node).ok_or_else(|| format!("its `{key}`, nodes[{node}], does not exist"))
    }

    /// Returns the node `center`, which Unity writes as −1 if there is none, and the colliders of a
    /// spring.
    fn of_spring(
        &self,
        spring: &Value,
        place: &str,
        groups: &[Vec<usize>],
    ) -> Result<(Option<usize>, Vec<usize>), GltfError> {
        let center = match spring["center"].as_f64() {
            Some(none) if none < 0.0 => None,
            _ if member(spring, "center").is_none() => None,
            _ => {
                let center = self.node_of(spring, "center");
                Some(center.map_err(|what| GltfError::new(place, what, MEND))?)
            }
        };
        let mut colliders = BTreeSet::new();
        for (place, group) in entries(spring, place, "colliderGroups")? {
            let own = number(group).and_then(|group| groups.get(usize::try_from(group).ok()?));
            let own =
                own.ok_or_else(|| GltfError::new(place, "this group does not exist", MEND))?;
            colliders.extend(own);
        }
        Ok((center, colliders.into_iter().collect()))
    }

    /// Reads `VRMC_springBone`.
    pub(super) fn joints(&self, springs: &Value) -> Result<(Vec<Joint>, Vec<Part>), GltfError> {
        let root = "extensions.VRMC_springBone";
        let version = text(springs, "specVersion").unwrap_or("");
        if version.split(['.', '-']).next() != Some("1") {
            let place = format!("{root}.specVersion");
            return Err(GltfError::new(place, format!("version `{version}`"), MEND));
        }
        let mut parts = Vec::new();
        for (place, entry) in entries(springs, root, "colliders")? {
            parts.push(collider(self, entry).map_err(|what| GltfError::new(place, what, MEND))?);
        }
        let mut groups = Vec::new();
        for (place, group) in entries(springs, root, "colliderGroups")? {
            let mut own = Vec::new();
            for (place, entry) in entries(group, &place, "colliders")? {
                let entry = number(entry).and_then(|entry| usize::try_from(entry).ok());
                let entry = entry.filter(|&entry| entry < parts.len());
                let missing = || GltfError::new(place, "this collider does not exist", MEND);
                own.push(entry.ok_or_else(missing)?);
            }
            groups.push(own);
        }
        let (mut joints, mut heads) = (Vec::new(), BTreeSet::new());
        for (place, spring) in entries(springs, root, "springs")? {
            let (center, colliders) = self.of_spring(spring, &place, &groups)?;
            let chain = entries(spring, &place, "joints")?;
            for pair in chain.windows(2) {
                let [(place, head), (behind, tail)] = pair else { continue };
                let fail = |what: String| GltfError::new(place, what, MEND);
                let node = self.node_of(head, "node").map_err(fail)?;
                let tail = self
                    .node_of(tail, "node")
                    .map_err(|what| fail(format!("the next one: {what}")))?;
                let mut above =
                    core::iter::successors(self.parents[tail], |&link| self.parents[link]);
                if !above.by_ref().take(SKIPPED).any(|link| link == node) {
                    let what = format!(
                        "nodes[{tail}] does not stand on nodes[{node}], the joint before it"
                    );
                    return Err(GltfError::new(behind, what, MEND));
                }
                if !heads.insert(node) {
                    return Err(fail(format!("nodes[{node}] is turned by another joint too")));
                }
                let dir = vector(head, "gravityDir", [0.0, -1.0, 0.0]).map_err(fail)?;
                let bone = setting(head, "stiffness", dir).map_err(fail)?;
                let bone = SpringBone { node, center, colliders: colliders.clone(), ..bone };
                joints.push(Joint { place: place.clone(), bone, tail: Some(tail) });
            }
        }
        Ok((joints, parts))
    }

    /// Reads `secondaryAnimation`: each bone of a group, and all nodes on it, is a joint.
    pub(super) fn joints_of_0(
        &self,
        springs: &Value,
    ) -> Result<(Vec<Joint>, Vec<Part>), GltfError> {
        let root = "extensions.VRM.secondaryAnimation";
        let (mut parts, mut groups) = (Vec::new(), Vec::new());
        for (place, group) in entries(springs, root, "colliderGroups")? {
            let node = self.node_of(group, "node");
            let node = node.map_err(|what| GltfError::new(&*place, what, MEND))?;
            let mut own = Vec::new();
            for (place, entry) in entries(group, &place, "colliders")? {
                own.push(parts.len());
                let shape = sphere_of_0(entry).map_err(|what| GltfError::new(place, what, MEND))?;
                parts.push(Part { node, shape });
            }
            groups.push(own);
        }
        let (mut joints, mut heads) = (Vec::new(), BTreeSet::new());
        for (place, group) in entries(springs, root, "boneGroups")? {
            let (center, colliders) = self.of_spring(group, &place, &groups)?;
            let fail = |what: String| GltfError::new(&*place, what, MEND);
            let dir = object(group, "gravityDir", [0.0, -1.0, 0.0]).map_err(fail)?;
            // The name is misspelt in the specification.
            let setting = setting(group, "stiffiness", dir).map_err(fail)?;
            for (place, root) in entries(group, &place, "bones")? {
                let root = number(root).and_then(|root| usize::try_from(root).ok());
                let root = root.filter(|&root| root < self.parents.len());
                let missing = || GltfError::new(&*place, "this node does not exist", MEND);
                let mut next = vec![root.ok_or_else(missing)?];
                while let Some(node) = next.pop() {
                    if !heads.insert(node) {
                        continue;
                    }
                    // The lists of children were checked when the file was read.
                    let children = list(&self.root["nodes"][node], "children").iter();
                    let children: Vec<usize> =
                        children.filter_map(number).map(|child| child as usize).collect();
                    let colliders = colliders.clone();
                    let bone = SpringBone { node, center, colliders, ..setting.clone() };
                    let (place, tail) = (place.clone(), children.first().copied());
                    joints.push(Joint { place, bone, tail });
                    next.extend(children.iter().rev());
                }
            }
        }
        Ok((joints, parts))
    }
}
