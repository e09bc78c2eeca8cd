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

/// The space in which a bone has its joint: the position of the joint, and the rotation, the scale
/// and the handedness of the parent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) position: DVec3,
    pub(crate) rotation: DQuat,
    pub(crate) scale: f64,
    /// The axes are those of `rotation` with the first one reversed.
    pub(crate) mirrored: bool,
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

    /// Returns where the joint of a bone with this transform and parent is in this frame, or `None`
    /// if the transforms above it are incomplete, infinite or of scale zero.
    pub(crate) fn place(&self, transform: &Transform, parent: Option<Entity>) -> Option<Place> {
        let above = parent.map_or(Ok(GlobalTransform::IDENTITY), |parent| {
            // Bevy's own global transforms are those of the last frame until it propagates.
            self.transforms.compute_global_transform(parent)
        });
        let above = above.ok()?;
        let (scale, rotation, _) = above.to_scale_rotation_translation();
        let place = Place {
            position: above.transform_point(transform.translation).as_dvec3(),
            rotation: rotation.as_dquat().normalize(),
            scale: mean(scale) * mean(transform.scale),
            mirrored: scale.x < 0.0,
        };
        let finite = place.position.is_finite() && place.rotation.is_finite();
        (finite && 0.0 < place.scale && place.scale < f64::INFINITY).then_some(place)
    }

    /// Returns `true` if an entity or one above it is marked as teleported.
    pub(crate) fn is_teleported(&self, entity: Entity) -> bool {
        let marked = |entity| self.teleported.contains(entity);
        !self.teleported.is_empty()
            && (marked(entity) || self.parents.iter_ancestors(entity).any(marked))
    }
}

/// Returns the mean size of the components of a scale.
pub(crate) fn mean(scale: Vec3) -> f64 {
    scale.as_dvec3().abs().element_sum() / 3.0
}
