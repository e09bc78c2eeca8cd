//! Places that change without being felt.

use super::*;
use bevy_pendulum::Teleported;
use bevy_time::{Time, Virtual};

/// An app with a swinging chain of two bones, far above which an entity can be moved.
struct Stage {
    app: App,
    hero: Entity,
    bones: [Entity; 2],
}

impl Stage {
    fn new() -> Self {
        let mut app = app();
        let hero = joint(&mut app, Transform::IDENTITY);
        let head = spawn(&mut app, hero, Transform::from_xyz(0.0, 1.7, 0.0));
        let ear = spawn(&mut app, head, SpringBone::swinging(Vec3::X * 0.2, 1.5, 0.1));
        let tip =
            (SpringBone::swinging(Vec3::X * 0.1, 3.0, 0.1), Transform::from_xyz(0.2, 0.0, 0.0));
        let tip = spawn(&mut app, ear, tip);
        frame(&mut app, 0);
        for bone in [ear, tip] {
            app.world_mut().get_mut::<SpringBone>(bone).unwrap().spring = heavy(Vec3::Y).spring;
        }
        run(&mut app, 60, SECOND / 5);
        Self { app, hero, bones: [ear, tip] }
    }

    /// Moves the hero by a hundred metres and turns it about the direction of gravity.
    fn jump(&mut self) {
        let place = Transform::from_xyz(100.0, 0.0, -3.0).with_rotation(Quat::from_rotation_y(2.5));
        self.app.world_mut().entity_mut(self.hero).insert(place);
    }

    fn poses(&self) -> [Quat; 2] {
        self.bones.map(|bone| rotation(&self.app, bone))
    }

    /// Returns how far the swing of the next half second is from that of a hero that stays.
    fn felt(mut self) -> f32 {
        let mut other = Self::new();
        let mut most = 0.0f32;
        for _ in 0..30 {
            frame(&mut self.app, SECOND / 60);
            frame(&mut other.app, SECOND / 60);
            for (one, other) in self.poses().into_iter().zip(other.poses()) {
                most = most.max(apart(one, other));
            }
        }
        most
    }
}

#[test]
fn a_teleport_is_not_felt() {
    let mut stage = Stage::new();
    stage.jump();
    stage.app.world_mut().entity_mut(stage.hero).insert(Teleported);
    let felt = stage.felt();
    assert!(felt < 1e-5, "{felt}");
}

#[test]
fn without_the_mark_a_jump_is_felt() {
    let mut stage = Stage::new();
    stage.jump();
    assert!(0.1 < stage.felt());
}

#[test]
fn the_mark_is_gone_after_the_frame() {
    let mut stage = Stage::new();
    stage.app.world_mut().entity_mut(stage.hero).insert(Teleported);
    frame(&mut stage.app, SECOND / 60);
    assert!(stage.app.world().get::<Teleported>(stage.hero).is_none());
    // Also where nothing hangs.
    let lonely = stage.app.world_mut().spawn(Teleported).id();
    frame(&mut stage.app, SECOND / 60);
    assert!(stage.app.world().get::<Teleported>(lonely).is_none());
}

#[test]
fn what_moves_in_a_pause_takes_its_bones_along() {
    let mut stage = Stage::new();
    stage.app.world_mut().resource_mut::<Time<Virtual>>().pause();
    frame(&mut stage.app, SECOND / 60);
    let before = stage.poses();
    stage.jump();
    frame(&mut stage.app, SECOND / 60);
    // The picture is one tick further, the time by which it is late otherwise.
    for (one, other) in stage.poses().into_iter().zip(before) {
        assert!(apart(one, other) < 0.02, "{}", apart(one, other));
    }
    stage.app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    let felt = stage.felt();
    assert!(felt < 1e-5, "{felt}");
}
