#![doc = include_str!("../README.md")]

mod around;
mod bone;
mod pendulums;
mod rig;
#[cfg(feature = "vrm")]
mod vrm;

pub use around::{SpringCollider, SpringColliders, Wind};
pub use bone::{Spring, SpringBone, SpringCenter, Teleported};
pub use pendulums::Pendulums;
#[cfg(feature = "vrm")]
pub use vrm::VrmSprings;

use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::change_detection::ResMut;
use bevy_ecs::schedule::{IntoScheduleConfigs, SystemSet};
use bevy_transform::TransformSystems;
use pendulum_runtime::scene::{Scene, SceneError};

/// The systems of this crate, in [`PostUpdate`] before [`TransformSystems::Propagate`]. What moves
/// the parents of bones in `PostUpdate`, such as Bevy's animations, belongs before this set:
/// `configure_sets(PostUpdate, PendulumSystems.after(AnimationSystems))`.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq, SystemSet)]
pub struct PendulumSystems;

/// Moves all entities with a [`SpringBone`]. It needs Bevy's `TimePlugin` and `TransformPlugin`,
/// which are among `DefaultPlugins`.
///
/// The scene takes the delta of `Time<Virtual>` in each frame and divides it into its own ticks, so
/// that pausing and slow motion act on bones, too. This is the only clock: nothing of this crate
/// runs in `FixedUpdate`, whose steps would be divided a second time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendulumPlugin {
    rate: f64,
}

impl PendulumPlugin {
    /// Creates a plugin whose scene has `rate` ticks per second of virtual time.
    ///
    /// # Errors
    /// Returns an error if the rate is not between 0.001 and a million.
    pub fn new(rate: f64) -> Result<Self, SceneError> {
        Scene::<f64>::new(rate).map(|_| Self { rate })
    }
}

impl Default for PendulumPlugin {
    /// 240 ticks per second: frames at 24, 30, 40, 48, 60, 80, 120 and 240 per second take whole
    /// numbers of ticks.
    fn default() -> Self {
        Self { rate: 240.0 }
    }
}

impl Plugin for PendulumPlugin {
    fn build(&self, app: &mut App) {
        // The rate has been checked when the plugin was created.
        if let Ok(scene) = Scene::new(self.rate) {
            app.insert_resource(Pendulums::new(scene));
        }
        app.register_type::<SpringBone>().register_type::<Teleported>();
        app.register_type::<SpringCollider>().register_type::<SpringColliders>();
        app.register_type::<Wind>().register_type::<SpringCenter>();
        let sweep = |mut pendulums: ResMut<Pendulums>, rig: rig::Rig| pendulums.sweep(&rig);
        let systems = (sweep, pendulums::release, pendulums::advance, pendulums::pose).chain();
        #[cfg(feature = "vrm")]
        let systems = (vrm::hang, systems).chain();
        let systems = systems.in_set(PendulumSystems).before(TransformSystems::Propagate);
        app.add_systems(PostUpdate, systems);
    }
}
