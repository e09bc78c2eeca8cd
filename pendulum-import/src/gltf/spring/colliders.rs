//! The bodies that spring bones do not enter, in the axes of their nodes.

use super::super::Gltf;
use super::super::json::member;
use super::settings::{object, size, vector};
use super::{Rest, SpringShape, length, minus};
use pendulum_core::attitude::Attitude;
use serde_json::Value;

/// A body as it stands in the file.
pub(super) struct Part {
    pub(super) node: usize,
    pub(super) shape: SpringShape,
}

/// Reads a collider of `VRMC_springBone`; `VRMC_springBone_extended_collider` replaces its shape.
pub(super) fn collider(file: &Gltf, entry: &Value) -> Result<Part, String> {
    let node = file.node_of(entry, "node")?;
    let extended = member(&entry["extensions"], "VRMC_springBone_extended_collider");
    let shape = match extended.and_then(|extended| member(extended, "shape")) {
        Some(shape) => self::shape(shape, true),
        None => self::shape(&entry["shape"], false),
    };
    Ok(Part { node, shape: shape.map_err(|what| format!("its shape: {what}"))? })
}

fn shape(shape: &Value, extended: bool) -> Result<SpringShape, String> {
    if let Some(plane) = member(shape, "plane").filter(|_| extended) {
        let normal = vector(plane, "normal", [0.0, 0.0, 1.0])?;
        if length(normal) <= 1e-6 {
            return Err("its `normal` has no direction".into());
        }
        return Ok(SpringShape::Plane { point: vector(plane, "offset", [0.0; 3])?, normal });
    }
    let (round, tail) = match (member(shape, "sphere"), member(shape, "capsule")) {
        (Some(sphere), _) => (sphere, "offset"),
        (None, Some(capsule)) => (capsule, "tail"),
        (None, None) => return Err("it is neither a sphere nor a capsule".into()),
    };
    let inside = match member(round, "inside").filter(|_| extended).map(Value::as_bool) {
        None => false,
        Some(Some(inside)) => inside,
        Some(None) => return Err("its `inside` is neither true nor false".into()),
    };
    let radius = size(round, "radius", 0.0)?;
    if inside && radius == 0.0 {
        return Err("its `radius` is zero, and nothing has room inside".into());
    }
    let ends = [vector(round, "offset", [0.0; 3])?, vector(round, tail, [0.0; 3])?];
    Ok(SpringShape::Capsule { ends, radius, inside })
}

/// Reads a sphere of VRM 0.x.
pub(super) fn sphere_of_0(entry: &Value) -> Result<SpringShape, String> {
    let ends = [object(entry, "offset", [0.0; 3])?; 2];
    let radius = size(entry, "radius", 0.0)?;
    Ok(SpringShape::Capsule { ends, radius, inside: false })
}

impl SpringShape {
    /// Returns the shape on a node at rest as a frame sees it; `None` if a number of it is infinite
    /// or none, as on a node whose scale is zero or huge.
    pub(super) fn seen(self, node: &Rest, (origin, turn): ([f64; 3], Attitude)) -> Option<Self> {
        let place = |p: [f64; 3]| turn.inverse() * minus(node.point(p), origin);
        let (seen, numbers) = match self {
            Self::Capsule { ends, radius, inside } => {
                let ends = ends.map(place);
                (Self::Capsule { ends, radius, inside }, ends)
            }
            Self::Plane { point, normal } => {
                let (point, normal) = (place(point), turn.inverse() * node.normal(normal));
                let size = length(normal);
                let normal = normal.map(|part| part / size);
                (Self::Plane { point, normal }, [point, normal])
            }
        };
        numbers.iter().flatten().all(|part| part.is_finite()).then_some(seen)
    }
}
