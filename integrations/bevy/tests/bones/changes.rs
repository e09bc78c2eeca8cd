//! What comes, goes and changes while the app runs.

use super::*;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent};
use bevy_pendulum::Teleported;
use pendulum_runtime::scene::Scene;
use std::any::TypeId;

/// Spawns a joint with a chain of two bones.
fn chain(app: &mut App) -> [Entity; 3] {
    let head = joint(app, Transform::IDENTITY);
    let ear = spawn(app, head, heavy(Vec3::X * 0.2));
    let tip = (heavy(Vec3::X * 0.2), Transform::from_xyz(0.2, 0.0, 0.0));
    let tip = spawn(app, ear, tip);
    frame(app, 0);
    [head, ear, tip]
}

#[test]
fn what_is_despawned_leaves_nothing() {
    let mut app = app();
    // The scene prints the number of its joints, also of those whose places are free.
    let mut scenes = Vec::new();
    for part in [0, 1, 0, 2, 0] {
        let chain = chain(&mut app);
        assert_eq!(count(&app), 2);
        scenes.push(format!("{:?}", pendulums(&app).scene()));
        // Children are despawned with their parents.
        app.world_mut().despawn(chain[part]);
        frame(&mut app, 0);
        assert_eq!(count(&app), part.saturating_sub(1));
        assert!(pendulums(&app).bone(chain[2]).is_none());
        if part != 0 {
            app.world_mut().despawn(chain[0]);
            frame(&mut app, 0);
        }
    }
    scenes.dedup();
    assert_eq!((count(&app), scenes.len()), (0, 1));
}

#[test]
fn without_its_component_an_entity_has_its_rotation_at_rest_again() {
    let mut app = app();
    let turn = Quat::from_rotation_y(0.3);
    let ear = app.world_mut().spawn((heavy(Vec3::X * 0.2), Transform::from_rotation(turn))).id();
    run(&mut app, 60, SECOND / 10);
    assert!(0.1 < apart(rotation(&app, ear), turn));
    app.world_mut().entity_mut(ear).remove::<SpringBone>();
    frame(&mut app, SECOND / 60);
    assert_eq!((rotation(&app, ear), count(&app)), (turn, 0));
}

#[test]
fn a_chain_without_its_first_bone_hangs_on_the_transform() {
    let mut app = app();
    let [_, ear, tip] = chain(&mut app);
    app.world_mut().entity_mut(ear).remove::<SpringBone>();
    frame(&mut app, SECOND / 60);
    assert_eq!(count(&app), 1);
    assert!(direction(&app, tip).distance(rest_of(Vec3::X, 0.2)) < 1e-5);
}

#[test]
fn a_bone_that_is_added_between_two_others_carries_the_second_one() {
    let mut app = app();
    let [_, ear, tip] = chain(&mut app);
    let rest = rotation(&app, tip);
    app.world_mut().entity_mut(ear).remove::<SpringBone>();
    frame(&mut app, 0);
    app.world_mut().entity_mut(ear).insert(heavy(Vec3::X * 0.2));
    frame(&mut app, 0);
    frame(&mut app, 0);
    assert_eq!(count(&app), 2);
    assert!(apart(rotation(&app, tip), rest) < 1e-6);
}

#[test]
fn a_bone_hangs_on_its_new_parent() {
    let mut app = app();
    let [_, ear, tip] = chain(&mut app);
    let other = joint(&mut app, Transform::from_rotation(Quat::from_rotation_y(1.0)));
    app.world_mut().entity_mut(ear).insert(ChildOf(other));
    frame(&mut app, 0);
    let turned = Quat::from_rotation_y(1.0) * Vec3::X;
    assert!(direction(&app, ear).distance(rest_of(turned, 0.2)) < 1e-5);
    // The second one becomes the first one.
    app.world_mut().entity_mut(tip).insert(ChildOf(other));
    app.world_mut().entity_mut(ear).insert(ChildOf(tip));
    frame(&mut app, 0);
    assert!(direction(&app, tip).distance(rest_of(turned, 0.2)) < 1e-5);
    assert_eq!(count(&app), 2);
}

#[test]
fn settings_change_without_a_restart() {
    let mut app = app();
    let ear = app.world_mut().spawn(SpringBone::swinging(Vec3::X * 0.2, 1.5, 0.3)).id();
    run(&mut app, 60, SECOND / 10);
    let handle = pendulums(&app).bone(ear);
    app.world_mut().get_mut::<SpringBone>(ear).unwrap().spring = heavy(Vec3::X).spring;
    let before = direction(&app, ear);
    frame(&mut app, SECOND / 60);
    assert!(direction(&app, ear).distance(before) < 0.02);
    run(&mut app, 60, 10 * SECOND);
    assert!(direction(&app, ear).distance(rest_of(Vec3::X, 0.2)) < 1e-4);
    // Its length, too, but another direction of the tip is another bone.
    app.world_mut().get_mut::<SpringBone>(ear).unwrap().tip = Vec3::X * 0.4;
    run(&mut app, 60, 10 * SECOND);
    assert!(direction(&app, ear).distance(rest_of(Vec3::X, 0.4)) < 1e-4);
    assert_eq!(pendulums(&app).bone(ear), handle);
    app.world_mut().get_mut::<SpringBone>(ear).unwrap().tip = Vec3::Z * 0.4;
    frame(&mut app, SECOND / 60);
    assert!(direction(&app, ear).distance(rest_of(Vec3::Z, 0.4)) < 1e-5);
}

#[test]
fn bones_grow_with_their_parents() {
    let mut app = app();
    let [head, ear, tip] = chain(&mut app);
    app.world_mut().get_mut::<Transform>(head).unwrap().scale = Vec3::splat(3.0);
    frame(&mut app, SECOND / 60);
    for bone in [ear, tip] {
        let ours = pendulums(&app);
        let length = ours.scene().observe(ours.bone(bone).unwrap(), 1.0).system.length;
        assert!((length - 0.6).abs() < 1e-6);
    }
    // Parents without a size do not count until they have one.
    app.world_mut().get_mut::<Transform>(head).unwrap().scale = Vec3::ZERO;
    run(&mut app, 60, SECOND / 10);
    assert_eq!(count(&app), 2);
    let hidden = spawn(&mut app, head, heavy(Vec3::X * 0.2));
    frame(&mut app, SECOND / 60);
    assert!(pendulums(&app).bone(hidden).is_none());
    app.world_mut().get_mut::<Transform>(head).unwrap().scale = Vec3::ONE;
    frame(&mut app, SECOND / 60);
    assert!(pendulums(&app).bone(hidden).is_some());
}

#[test]
fn refused_settings_make_no_bone_until_they_change() {
    let mut app = app();
    let good = heavy(Vec3::X * 0.2);
    let bad = [
        SpringBone { tip: Vec3::ZERO, ..good },
        SpringBone { tip: Vec3::X * f32::NAN, ..good },
        SpringBone { tip: Vec3::X * f32::INFINITY, ..good },
        SpringBone::swinging(Vec3::X, -1.0, 0.3),
        SpringBone::swinging(Vec3::X, f32::NAN, 0.3),
        SpringBone::swinging(Vec3::X, 1.0, f32::NEG_INFINITY),
        // Too fast for the ticks.
        SpringBone::swinging(Vec3::X, 1e9, 0.3),
    ];
    for bad in bad {
        let new = app.world_mut().spawn(bad).id();
        let old = app.world_mut().spawn(good).id();
        frame(&mut app, SECOND / 60);
        assert!(pendulums(&app).bone(new).is_none(), "{bad:?}");
        // A bone that hangs already keeps its settings.
        *app.world_mut().get_mut(old).unwrap() = bad;
        run(&mut app, 60, SECOND / 10);
        let up = get::<GlobalTransform>(&app, old).affine().transform_vector3(Vec3::X);
        assert!(up.distance(rest_of(Vec3::X, 0.2)) < 1e-3, "{bad:?}");
        *app.world_mut().get_mut(new).unwrap() = good;
        frame(&mut app, SECOND / 60);
        assert!(pendulums(&app).bone(new).is_some(), "{bad:?}");
    }
}

#[test]
fn transforms_that_are_not_finite_move_nothing() {
    let mut app = app();
    let [head, ear, _] = chain(&mut app);
    let before = rotation(&app, ear);
    for lost in [Vec3::NAN, Vec3::INFINITY] {
        app.world_mut().get_mut::<Transform>(head).unwrap().translation = lost;
        run(&mut app, 60, SECOND / 10);
        assert!(apart(rotation(&app, ear), before) < 1e-3);
    }
    *app.world_mut().get_mut::<Transform>(head).unwrap() = Transform::IDENTITY;
    run(&mut app, 60, SECOND / 10);
    assert!(apart(rotation(&app, ear), before) < 1e-3);
}

#[test]
fn components_can_be_read_and_set_by_reflection() {
    let mut app = app();
    let ear = app.world_mut().spawn(heavy(Vec3::X * 0.2)).id();
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    let component = |id| registry.get_type_data::<ReflectComponent>(id).cloned();
    let bone = component(TypeId::of::<SpringBone>()).unwrap();
    bone.apply(app.world_mut().entity_mut(ear), &heavy(Vec3::X * 0.3));
    assert_eq!(get::<SpringBone>(&app, ear).tip, Vec3::X * 0.3);
    assert!(component(TypeId::of::<Teleported>()).is_some());
}

#[test]
fn impossible_rates_are_refused() {
    for rate in [0.0, -60.0, f64::NAN, f64::INFINITY] {
        let refused = PendulumPlugin::new(rate).unwrap_err().to_string();
        assert_eq!(refused, Scene::<f64>::new(rate).unwrap_err().to_string());
    }
    let mut app = App::new();
    app.add_plugins(PendulumPlugin::new(60.0).unwrap());
    assert_eq!(pendulums(&app).scene().step(), 1.0 / 60.0);
}
