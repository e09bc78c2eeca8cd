//! Bones that do not feel what their centers do.

use super::*;
use bevy_pendulum::{SpringCenter, Teleported};
use bevy_time::{Time, Virtual};

/// A hero with two bones in a chain and what is the center of the first one and, by it, of both.
struct Stage {
    app: App,
    hero: Entity,
    bones: [Entity; 2],
}

impl Stage {
    fn new(center: impl FnOnce(Entity) -> Option<Entity>) -> Self {
        let mut app = app();
        let hero = joint(&mut app, Transform::IDENTITY);
        app.world_mut().entity_mut(hero).insert(SpringCenter(center(hero)));
        let head = spawn(&mut app, hero, Transform::from_xyz(0.0, 1.7, 0.3));
        let ear = spawn(&mut app, head, heavy(0.2 * Vec3::X));
        let tip = (heavy(0.1 * Vec3::X), Transform::from_xyz(0.2, 0.0, 0.0));
        let tip = spawn(&mut app, ear, tip);
        frame(&mut app, 0);
        Self { app, hero, bones: [ear, tip] }
    }

    fn poses(&self) -> [Quat; 2] {
        self.bones.map(|bone| rotation(&self.app, bone))
    }

    /// Returns how far the bones swing in a second in which the hero walks and turns.
    fn swing(&mut self, speed: f32, turn: f32) -> f32 {
        let (before, mut most) = (self.poses(), 0.0f32);
        for k in 0..60u8 {
            // From rest to rest.
            let done = 0.5 - 0.5 * (std::f32::consts::PI * f32::from(k + 1) / 60.0).cos();
            let place = Transform::from_translation(speed * done * Vec3::Z);
            let place = place.with_rotation(Quat::from_rotation_y(turn * done));
            self.app.world_mut().entity_mut(self.hero).insert(place);
            frame(&mut self.app, SECOND / 60);
            for (one, other) in self.poses().into_iter().zip(before) {
                most = most.max(apart(one, other));
            }
        }
        most
    }

    fn felt(&mut self) -> f32 {
        self.swing(2.0, 0.0)
    }
}

#[test]
fn bones_with_a_center_do_not_feel_its_walk() {
    let walk = |center: fn(Entity) -> Option<Entity>, turn| Stage::new(center).swing(2.0, turn);
    let (straight, curved) = (walk(Some, 0.0), walk(Some, 2.0));
    assert!(straight < 1e-5 && curved < 0.01, "{straight} {curved}");
    assert!(0.1 < walk(|_| None, 0.0));
}

#[test]
fn the_nearest_center_counts_and_may_change() {
    let mut stage = Stage::new(Some);
    assert!(stage.bones.iter().all(|&bone| pendulums(&stage.app).centered_bone(bone).is_some()));
    assert!(stage.bones.iter().all(|&bone| pendulums(&stage.app).bone(bone).is_none()));
    // None of its own for the lower bone, then for both.
    let [ear, tip] = stage.bones;
    stage.app.world_mut().entity_mut(tip).insert(SpringCenter(None));
    frame(&mut stage.app, SECOND / 60);
    let centered = |app: &App| [ear, tip].map(|bone| pendulums(app).centered_bone(bone).is_some());
    assert_eq!((centered(&stage.app), count(&stage.app)), ([true, false], 2));
    stage.app.world_mut().entity_mut(ear).insert(SpringCenter(None));
    frame(&mut stage.app, SECOND / 60);
    assert_eq!((centered(&stage.app), count(&stage.app)), ([false; 2], 2));
    assert!(0.1 < stage.felt());
    for bone in [ear, tip] {
        stage.app.world_mut().entity_mut(bone).remove::<SpringCenter>();
    }
    run(&mut stage.app, 60, 8 * SECOND);
    assert!(stage.felt() < 1e-4);
    stage.app.world_mut().entity_mut(stage.hero).remove::<SpringCenter>();
    frame(&mut stage.app, SECOND / 60);
    assert_eq!(centered(&stage.app), [false; 2]);
}

#[test]
fn a_center_that_is_gone_is_none() {
    let mut app = app();
    let center = joint(&mut app, Transform::IDENTITY);
    let parent = joint(&mut app, Transform::IDENTITY);
    let bone = spawn(&mut app, parent, (heavy(0.2 * Vec3::X), SpringCenter(Some(center))));
    frame(&mut app, SECOND / 60);
    assert!(pendulums(&app).centered_bone(bone).is_some());
    app.world_mut().despawn(center);
    frame(&mut app, SECOND / 60);
    assert!(pendulums(&app).bone(bone).is_some());
    app.world_mut().despawn(bone);
    frame(&mut app, SECOND / 60);
    assert_eq!(count(&app), 0);
}

#[test]
fn teleports_of_a_hero_and_its_center_are_not_felt() {
    for paused in [false, true] {
        let [mut one, mut other] = [0, 1].map(|_| {
            let mut stage = Stage::new(Some);
            stage.app.world_mut().get_mut::<SpringBone>(stage.bones[0]).unwrap().tip *= 1.5;
            run(&mut stage.app, 60, SECOND / 5);
            stage
        });
        let place = Transform::from_xyz(100.0, 0.0, -3.0).with_rotation(Quat::from_rotation_y(2.5));
        one.app.world_mut().entity_mut(one.hero).insert(place);
        if paused {
            one.app.world_mut().resource_mut::<Time<Virtual>>().pause();
            frame(&mut one.app, SECOND / 60);
            one.app.world_mut().resource_mut::<Time<Virtual>>().unpause();
        } else {
            one.app.world_mut().entity_mut(one.hero).insert(Teleported);
        }
        for _ in 0..30 {
            frame(&mut one.app, SECOND / 60);
            frame(&mut other.app, SECOND / 60);
            for (one, other) in one.poses().into_iter().zip(other.poses()) {
                assert!(apart(one, other) < 1e-5, "{}", apart(one, other));
            }
        }
    }
}

#[test]
fn a_center_that_jumps_alone_turns_no_bone() {
    let mut app = app();
    let center = joint(&mut app, Transform::IDENTITY);
    let parent = joint(&mut app, Transform::IDENTITY);
    let bone = spawn(&mut app, parent, (heavy(0.2 * Vec3::X), SpringCenter(Some(center))));
    run(&mut app, 60, SECOND / 5);
    let before = direction(&app, bone);
    let place = Transform::from_xyz(3.0, 1.0, 0.0).with_rotation(Quat::from_rotation_z(2.0));
    app.world_mut().entity_mut(center).insert((place, Teleported));
    run(&mut app, 60, SECOND / 5);
    assert!(direction(&app, bone).distance(before) < 1e-4, "{}", direction(&app, bone));
}
