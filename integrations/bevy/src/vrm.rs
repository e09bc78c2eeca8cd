//! Bones of VRM files on the entities that Bevy makes of their nodes.

use crate::around::{SpringCollider, SpringColliders};
use crate::bone::{Spring, SpringBone, SpringCenter};
use crate::rig::{Place, Rig};
use bevy_ecs::component::Component;
use bevy_ecs::entity::Entity;
use bevy_ecs::hierarchy::{ChildOf, Children};
use bevy_ecs::name::Name;
use bevy_ecs::system::{Commands, Query};
use bevy_math::DVec3;
use log::warn;
use pendulum_runtime::attitude::Attitude;
use pendulum_runtime::import::gltf::{Gltf, GltfError, SpringShape, Springs};
use std::collections::HashMap;

/// The spring bones of a VRM file, which hang themselves on the entities of its nodes.
///
/// Added to the entity below which Bevy spawns the file, it waits for the entities of the nodes,
/// adds [`SpringBone`], [`SpringCenter`], [`SpringColliders`] and [`SpringCollider`] to them in their
/// attitudes at rest, and is removed. Nodes are found by their names, for those without one by
/// `GltfNode` and the number, as Bevy's loader calls them; a node whose name another one has gets
/// no bone, and a warning says so.
///
/// ```no_run
/// # fn spawn(mut commands: bevy_ecs::system::Commands) -> Result<(), Box<dyn std::error::Error>> {
/// let springs = bevy_pendulum::VrmSprings::read(&std::fs::read("assets/avatar.vrm")?)?;
/// commands.spawn(springs); // … with the scene of "avatar.vrm"
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Component, Debug)]
pub struct VrmSprings {
    springs: Springs,
    /// The names of all nodes.
    names: Vec<String>,
}

impl VrmSprings {
    /// Reads the spring bones of a file, of VRM 1.0 or 0.x.
    ///
    /// # Errors
    /// Returns an error if the file or a setting is malformed, as [`Gltf::springs`] does.
    pub fn read(bytes: &[u8]) -> Result<Self, GltfError> {
        let file = Gltf::read(bytes)?;
        let name = |(number, name): (usize, &str)| match name {
            "" => format!("GltfNode{number}"),
            name => name.to_owned(),
        };
        Ok(Self { springs: file.springs()?, names: file.nodes().enumerate().map(name).collect() })
    }

    /// Adds the components to the entities of the nodes.
    fn hang(
        &self,
        entity_of: impl Fn(usize) -> Option<Entity>,
        axes_of: impl Fn(Entity) -> Option<Place>,
        commands: &mut Commands,
    ) {
        let Springs { bones, colliders } = &self.springs;
        let bodies: Vec<_> = colliders
            .iter()
            .map(|body| {
                // A body that a bone carries is given from the tip of the bone, in its axes.
                let bone = body.carrier.map(|carrier| &bones[carrier]);
                let node = bone.map_or(body.node, |bone| bone.node);
                let turn = bone.map_or(Attitude::identity(), |bone| bone.axis);
                let length = bone.map_or(0.0, |bone| bone.length);
                let entity = entity_of(node)?;
                let axes = axes_of(entity)?;
                let local = |u: [f64; 3]| axes.vector(DVec3::from(turn * u).as_vec3()).as_vec3();
                let point = |[x, y, z]: [f64; 3]| local([x, y + length, z]);
                let shape = match body.shape {
                    SpringShape::Plane { point: at, normal } => {
                        SpringCollider::Half { point: point(at), normal: local(normal) }
                    }
                    SpringShape::Capsule { ends, radius, inside } => {
                        let (ends, radius) = (ends.map(point), narrow(radius * axes.scale));
                        if inside {
                            SpringCollider::Inside { ends, radius }
                        } else {
                            SpringCollider::Capsule { ends, radius }
                        }
                    }
                };
                Some(commands.spawn((shape, ChildOf(entity))).id())
            })
            .collect();
        for bone in bones {
            let Some(entity) = entity_of(bone.node) else { continue };
            let Some(axes) = axes_of(entity) else { continue };
            let tip = DVec3::from(bone.axis * [0.0, bone.length, 0.0]);
            let tip = axes.vector(tip.as_vec3()).as_vec3();
            let spring = Spring::Vrm {
                stiffness: narrow(bone.stiffness),
                gravity_power: narrow(bone.gravity_power),
                gravity_dir: DVec3::from(bone.gravity_dir).as_vec3(),
                drag_force: narrow(bone.drag_force),
            };
            let bodies = bone.colliders.iter().filter_map(|&body| bodies[body]).collect();
            let list = SpringColliders { radius: narrow(bone.hit_radius), bodies, friction: 0.0 };
            let center = SpringCenter(bone.center.and_then(&entity_of));
            commands.entity(entity).insert((SpringBone { tip, spring }, list, center));
        }
    }
}

/// Adds the bones of files whose entities have been spawned.
pub(crate) fn hang(
    files: Query<(Entity, &VrmSprings)>,
    children: Query<&Children>,
    names: Query<&Name>,
    rig: Rig,
    mut commands: Commands,
) {
    for (root, file) in &files {
        let mut found = HashMap::new();
        for entity in children.iter_descendants(root) {
            if let Ok(name) = names.get(entity) {
                found.entry(name.as_str()).or_insert_with(Vec::new).push(entity);
            }
        }
        if file.names.iter().all(|name| !found.contains_key(name.as_str())) {
            continue;
        }
        let own = |node: usize| {
            let name = file.names[node].as_str();
            if let Some(&[entity]) = found.get(name).map(Vec::as_slice) {
                return Some(entity);
            }
            warn!("no bone on the node {node}, {name:?}: no or several entities have its name");
            None
        };
        // Vectors of the file, in metres, become those of the node.
        let axes = |entity| {
            let (own, top) = (rig.stand(entity)?, rig.stand(root)?);
            let mirrored = own.mirrored != top.mirrored;
            Some(Place { scale: top.scale / own.scale, mirrored, ..own })
        };
        file.hang(own, axes, &mut commands);
        commands.entity(root).remove::<VrmSprings>();
    }
}

/// Returns the nearest number of the type that Bevy has.
#[allow(clippy::cast_possible_truncation)]
fn narrow(x: f64) -> f32 {
    x as f32
}
