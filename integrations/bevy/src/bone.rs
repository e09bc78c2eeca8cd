//! The components: settings of bones, and the mark of a teleport.

use bevy_ecs::component::Component;
use bevy_ecs::entity::Entity;
use bevy_ecs::reflect::ReflectComponent;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use pendulum_runtime::scene::{Bone, SceneError, VrmSpring};

/// A bone that springs back: the rotation of its entity is written in each frame.
///
/// The bone begins at the origin of its entity and ends at `tip`. Its rotation at rest relative to
/// its parent is that of the [`Transform`] with which it was added; without the component, the
/// entity has this rotation again. A new bone begins at rest, also under gravity.
///
/// If the parent of the entity has a bone as well, both are a chain: the bone begins at its own
/// translation when it is added, usually the tip of its parent. The parent moves it and feels
/// nothing of it. Any other parent is followed where its [`GlobalTransform`] will be in this frame,
/// with the translation of the entity, which may change, too. Scales have to be the same along all
/// axes, except that parents without a bone may be mirrored; `tip` is scaled with them, gravity is
/// not.
///
/// Settings may change at any time, and the swing goes on; only another direction of the tip makes
/// a new bone. Settings that make no bone, such as a negative frequency, are reported as a warning
/// of the crate `log`, which Bevy's `LogPlugin` prints: a new bone then has no effect until its
/// settings change, and another one keeps its last ones.
///
/// [`GlobalTransform`]: bevy_transform::components::GlobalTransform
#[derive(Clone, Copy, Component, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[require(Transform)]
pub struct SpringBone {
    /// The end of the bone in the space of its entity; its distance is the length of the bone.
    pub tip: Vec3,
    /// How the bone springs back.
    pub spring: Spring,
}

/// How a bone springs back.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, PartialEq)]
pub enum Spring {
    /// Settings in an artist's words.
    Swing {
        /// The frequency of the swing without gravity, in Hz.
        frequency: f32,
        /// The damping ratio: 0 swings for ever, 1 returns without overshooting.
        ratio: f32,
        /// The acceleration of gravity in space, in m/s².
        gravity: Vec3,
    },
    /// Settings by the names of `VRMC_springBone`, as [`VrmSpring`] explains them, for its formula
    /// at 60 frames per second.
    Vrm {
        /// `stiffness`: the force towards the direction of rest.
        stiffness: f32,
        /// `gravityPower`: the magnitude of gravity.
        gravity_power: f32,
        /// `gravityDir`: the direction of gravity in space.
        gravity_dir: Vec3,
        /// `dragForce`: the deceleration, from 0 to 1.
        drag_force: f32,
    },
}

impl SpringBone {
    /// Creates a bone that ends at `tip`, swings with `frequency`, in Hz, and decays with the
    /// damping ratio `ratio`, without gravity.
    #[must_use]
    pub const fn swinging(tip: Vec3, frequency: f32, ratio: f32) -> Self {
        Self { tip, spring: Spring::Swing { frequency, ratio, gravity: Vec3::ZERO } }
    }

    /// Returns the bone of the scene for an entity with this scale.
    pub(crate) fn scaled(&self, scale: f64) -> Result<Bone<f64>, SceneError> {
        let length = scale * self.tip.as_dvec3().length();
        match self.spring {
            Spring::Swing { frequency, ratio, gravity } => {
                let bone = Bone::swinging(length, f64::from(frequency), f64::from(ratio))?;
                Ok(bone.under(gravity.as_dvec3().to_array()))
            }
            Spring::Vrm { stiffness, gravity_power, gravity_dir, drag_force } => VrmSpring {
                stiffness: f64::from(stiffness),
                gravity_power: f64::from(gravity_power),
                gravity_dir: gravity_dir.as_dvec3().to_array(),
                drag_force: f64::from(drag_force),
                ..VrmSpring::default()
            }
            .bone(length),
        }
    }
}

/// The entity in whose space the bones of an entity and below it move, up to the next center: they
/// do not feel what it does, only motion relative to it. This is the `center` of VRM; without an
/// entity, bones feel all motion.
///
/// A character whose bones have its root as their center walks and turns without swinging hair.
/// Another center makes a new bone. A center below a bone is one frame late.
#[derive(Clone, Copy, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct SpringCenter(#[entities] pub Option<Entity>);

/// Marks an entity that is moved in this frame without its bones feeling it: they turn with it and
/// keep their swing. Added together with the new [`Transform`] to an entity above the first bone of
/// a chain, however far, it is removed in the same frame.
///
/// While the virtual time rests, as in a pause, everything moves in this way.
#[derive(Clone, Copy, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct Teleported;
