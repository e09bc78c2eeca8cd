//! Bones of entities in apps whose time the tests set.

mod around;
mod centers;
mod changes;
mod motion;
mod teleports;
#[cfg(feature = "vrm")]
mod vrm;

use bevy_app::{App, TaskPoolPlugin};
use bevy_ecs::bundle::Bundle;
use bevy_ecs::entity::Entity;
use bevy_ecs::hierarchy::ChildOf;
use bevy_math::{Quat, Vec3};
use bevy_pendulum::{PendulumPlugin, Pendulums, Spring, SpringBone};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::{GlobalTransform, Transform};
use std::time::Duration;

const SECOND: u64 = 1_000_000_000;

fn app() -> App {
    let mut app = App::new();
    let bevy = (TaskPoolPlugin::default(), TimePlugin, TransformPlugin);
    app.add_plugins((bevy, PendulumPlugin::default()));
    // The first update of an app takes no time.
    app.update();
    app
}

/// Runs a frame of so many nanoseconds.
fn frame(app: &mut App, nanoseconds: u64) {
    let time = Duration::from_nanos(nanoseconds);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(time));
    app.update();
}

/// Runs frames at `rate` for so many nanoseconds, after which times are equal at all rates.
fn run(app: &mut App, rate: u64, nanoseconds: u64) {
    let frames = rate * nanoseconds / SECOND;
    let end = |k| k * nanoseconds / frames;
    (0..frames).for_each(|k| frame(app, end(k + 1) - end(k)));
}

/// Spawns an entity with a bone below a parent.
fn spawn(app: &mut App, parent: Entity, bone: impl Bundle) -> Entity {
    app.world_mut().spawn((bone, ChildOf(parent))).id()
}

/// Spawns an entity without a bone.
fn joint(app: &mut App, transform: Transform) -> Entity {
    app.world_mut().spawn(transform).id()
}

fn get<C: bevy_ecs::component::Component + Clone>(app: &App, entity: Entity) -> C {
    app.world().get::<C>(entity).unwrap().clone()
}

fn rotation(app: &App, entity: Entity) -> Quat {
    get::<Transform>(app, entity).rotation
}

/// Returns the direction from an entity to the tip of its bone in space.
fn direction(app: &App, entity: Entity) -> Vec3 {
    let tip = get::<SpringBone>(app, entity).tip;
    get::<GlobalTransform>(app, entity).affine().transform_vector3(tip).normalize()
}

fn pendulums(app: &App) -> &Pendulums {
    app.world().resource()
}

/// Returns the number of bones in the scene.
fn count(app: &App) -> usize {
    pendulums(app).scene().awake().1
}

fn heavy(tip: Vec3) -> SpringBone {
    let gravity = Vec3::new(0.0, -9.81, 0.0);
    SpringBone { tip, spring: Spring::Swing { frequency: 1.5, ratio: 0.3, gravity } }
}

/// Returns the direction of rest of [`heavy`], whose frame has the direction `frame`: that of the
/// sum of the spring and gravity.
fn rest_of(frame: Vec3, length: f32) -> Vec3 {
    let omega = std::f32::consts::TAU * 1.5;
    (omega * omega * frame + Vec3::new(0.0, -9.81 / length, 0.0)).normalize()
}

fn apart(one: Quat, other: Quat) -> f32 {
    (one - other).length().min((one + other).length())
}
