//! What bones need of Bevy's hierarchy: where their joints are.

use crate::bone::{SpringBone, Teleported};
use bevy_ecs::change_detection::Ref;
use bevy_ecs::entity::Entity;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::query::With;
use bevy_ecs::system::{Query, SystemParam};
use bevy_math::{DQuat, DVec3, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;

/// Axes of an entity from a point: for a bone, those of its parent from its joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) position: DVec3,
    pub(crate) rotation: DQuat,
    pub(crate) scale: f64,
    /// The axes are those of `rotation` with the first one reversed.
    pub(crate) mirrored: bool,
}

impl Place {
    /// Returns `None` if the numbers are infinite or the scale is zero.
    fn new(above: &GlobalTransform, position: Vec3, scale: f64) -> Option<Self> {
        let (scales, rotation, _) = above.to_scale_rotation_translation();
        let place = Self {
            position: position.as_dvec3(),
            rotation: rotation.as_dquat().normalize(),
            scale: scale * mean(scales),
            mirrored: scales.x < 0.0,
        };
        let finite = place.position.is_finite() && place.rotation.is_finite();
        (finite && 0.0 < place.scale && place.scale < f64::INFINITY).then_some(place)
    }

    /// Returns a vector of the entity, in metres and in the axes of `rotation`.
    pub(crate) fn vector(&self, u: Vec3) -> DVec3 {
        self.scale * reversed(u.as_dvec3(), self.mirrored)
    }
}

/// The bones, and all transforms above them.
#[derive(SystemParam)]
pub(crate) struct Rig<'w, 's> {
    pub(crate) bones: Query<
        'w,
        's,
        (Entity, Ref<'static, SpringBone>, &'static Transform, Option<&'static ChildOf>),
    >,
    pub(crate) teleported: Query<'w, 's, Entity, With<Teleported>>,
    parents: Query<'w, 's, &'static ChildOf>,
    transforms: TransformHelper<'w, 's>,
}

impl Rig<'_, '_> {
    /// Returns the parent of an entity.
    pub(crate) fn parent(&self, entity: Entity) -> Option<Entity> {
        self.parents.get(entity).ok().map(ChildOf::parent)
    }

    /// Returns an entity and those above it.
    pub(crate) fn upwards(&self, entity: Entity) -> impl Iterator<Item = Entity> {
        core::iter::once(entity).chain(self.parents.iter_ancestors(entity))
    }

    /// Returns where the joint of a bone with this transform and parent is in this frame, or `None`
    /// if the transforms above it are incomplete, infinite or of scale zero.
    pub(crate) fn place(&self, transform: &Transform, parent: Option<Entity>) -> Option<Place> {
        let above = parent.map_or(Some(GlobalTransform::IDENTITY), |parent| self.global(parent))?;
        let joint = above.transform_point(transform.translation);
        Place::new(&above, joint, mean(transform.scale))
    }

    /// Returns where an entity is in this frame, or `None` as [`place`](Self::place) does.
    pub(crate) fn stand(&self, entity: Entity) -> Option<Place> {
        let own = self.global(entity)?;
        Place::new(&own, own.translation(), 1.0)
    }

    fn global(&self, entity: Entity) -> Option<GlobalTransform> {
        // Bevy's own global transforms are those of the last frame until it propagates.
        self.transforms.compute_global_transform(entity).ok()
    }

    /// Returns `true` if an entity or one above it is marked as teleported.
    pub(crate) fn is_teleported(&self, entity: Entity) -> bool {
        let marked = |entity| self.teleported.contains(entity);
        !self.teleported.is_empty() && self.upwards(entity).any(marked)
    }
}

/// Returns the mean size of the components of a scale.
pub(crate) fn mean(scale: Vec3) -> f64 {
    scale.as_dvec3().abs().element_sum() / 3.0
}

/// Returns a vector in mirrored axes, the first of which is reversed.
pub(crate) fn reversed(u: DVec3, mirrored: bool) -> DVec3 {
    if mirrored { DVec3::new(-u.x, u.y, u.z) } else { u }
}

/// Returns `true` if a scale is another one. Rounding errors of rotations change it by less.
pub(crate) fn other(before: f64, scale: f64) -> bool {
    1e-4 * before < (scale - before).abs()
}
