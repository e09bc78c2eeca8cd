//! What bones need of Bevy's hierarchy: where their joints are.

use crate::bone::{SpringBone, SpringCenter, Teleported};
use crate::pendulums::{Frame, attitude, numbers, quaternion};
use bevy_ecs::change_detection::Ref;
use bevy_ecs::entity::Entity;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::query::With;
use bevy_ecs::system::{Query, SystemParam};
use bevy_math::{DQuat, DVec3, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_transform::helper::TransformHelper;
use pendulum_runtime::scene::{Scene, SceneError};

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

/// A frame of the scene that follows a place of Bevy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Led {
    pub(crate) joints: Frame,
    /// Where it was last told to be.
    pub(crate) at: (DVec3, DQuat),
    /// The turn of its last jump, if it was told to jump.
    pub(crate) jump: Option<DQuat>,
}

impl Led {
    pub(crate) fn new(scene: &mut Scene<f64>, at: (DVec3, DQuat)) -> Result<Self, SceneError> {
        let joints = scene.live_frame(at.0.to_array(), attitude(at.1))?;
        Ok(Self { joints, at, jump: None })
    }

    /// Tells the scene where the frame is at the end of the coming frame of Bevy. It jumps there if
    /// it is marked as teleported, and in a pause.
    pub(crate) fn lead(
        &mut self,
        scene: &mut Scene<f64>,
        to: (DVec3, DQuat),
        [paused, marked]: [bool; 2],
    ) -> Result<(), SceneError> {
        let before = core::mem::replace(&mut self.at, to);
        let ((place, turn), (position, rotation)) = (self.joints, to);
        self.jump = None;
        if !(marked || paused && before != to) {
            scene.move_to(place, position.to_array())?;
            return scene.move_to(turn, numbers(rotation));
        }
        let before = quaternion(scene.joint_pose(turn, 1.0));
        scene.teleport(place, position.to_array())?;
        scene.teleport(turn, numbers(rotation))?;
        self.jump = Some(rotation * before.inverse());
        Ok(())
    }

    pub(crate) fn remove(&self, scene: &mut Scene<f64>) -> Result<(), SceneError> {
        scene.remove_joint(self.joints.0)?;
        scene.remove_joint(self.joints.1)
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
    pub(crate) centers: Query<'w, 's, &'static SpringCenter>,
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

    /// Returns the entity in whose space the bone of an entity moves, if any.
    pub(crate) fn center(&self, entity: Entity) -> Option<Entity> {
        let nearest = self.upwards(entity).find_map(|above| self.centers.get(above).ok());
        nearest?.0.filter(|&center| self.stand(center).is_some())
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
