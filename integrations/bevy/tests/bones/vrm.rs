//! Spring bones of VRM files.

use super::*;
use bevy_ecs::name::Name;
use bevy_pendulum::{SpringCenter, SpringCollider, SpringColliders, VrmSprings};

const FILE: &[u8] = br#"{"asset":{"version":"2.0"},"nodes":[
{"name":"model","scale":[-2,2,2],"children":[1]},
{"name":"head","translation":[0,1.5,0],"children":[2]},
{"name":"ear","translation":[0.1,0.1,0],"rotation":[0,0,0.6,0.8],"scale":[0.5,0.5,0.5],"children":[3]},
{"translation":[0.03,0.2,0.01],"children":[4]},
{"name":"end","translation":[0.05,0.1,0]},
{"name":"twin","children":[6]},{"name":"twin","translation":[0,1,0]}],
"extensions":{"VRMC_springBone":{"specVersion":"1.0","colliders":[
{"node":1,"shape":{"sphere":{"offset":[0.2,0.1,0],"radius":0.25}}},
{"node":3,"shape":{"capsule":{"offset":[0.1,0,0],"radius":0.125,"tail":[0,0.1,0]}}}],
"colliderGroups":[{"colliders":[0,1]}],
"springs":[{"joints":[{"node":2,"stiffness":0.5,"gravityPower":0.25,"hitRadius":0.0625},
{"node":3,"dragForce":0.75,"gravityDir":[0,0,1]},{"node":4}],"colliderGroups":[0],"center":1},
{"joints":[{"node":5},{"node":6}]}]}}}"#;

/// Spawns the nodes of the file as a loader does, below a root.
fn spawn_file(app: &mut App, root: Entity) -> [Entity; 4] {
    let mut node = |name: &str, transform: Transform, parent: Entity| {
        app.world_mut().spawn((Name::new(name.to_owned()), transform, ChildOf(parent))).id()
    };
    let model = node("model", Transform::from_scale(Vec3::new(-2.0, 2.0, 2.0)), root);
    let head = node("head", Transform::from_xyz(0.0, 1.5, 0.0), model);
    let turn = Transform::from_rotation(Quat::from_xyzw(0.0, 0.0, 0.6, 0.8));
    let ear = turn.with_translation(Vec3::new(0.1, 0.1, 0.0)).with_scale(Vec3::splat(0.5));
    let ear = node("ear", ear, head);
    let tip = node("GltfNode3", Transform::from_xyz(0.03, 0.2, 0.01), ear);
    let end = node("end", Transform::from_xyz(0.05, 0.1, 0.0), tip);
    for _ in 0..2 {
        node("twin", Transform::default(), root);
    }
    [head, ear, tip, end]
}

#[test]
fn a_file_hangs_itself_when_its_entities_come() {
    let mut app = app();
    let springs = VrmSprings::read(FILE).unwrap();
    // A scene of the size 3 beside the origin.
    let place = Transform::from_xyz(5.0, 0.0, 0.0).with_scale(Vec3::splat(3.0));
    let root = app.world_mut().spawn((springs, place)).id();
    frame(&mut app, SECOND / 60);
    assert!(app.world().get::<VrmSprings>(root).is_some());
    let [head, ear, tip, end] = spawn_file(&mut app, root);
    let ends = [tip, end].map(|entity| get::<Transform>(&app, entity).translation);
    frame(&mut app, SECOND / 60);
    assert!(app.world().get::<VrmSprings>(root).is_none());
    assert_eq!(count(&app), 2);

    for (bone, goal) in [ear, tip].into_iter().zip(ends) {
        let tip = get::<SpringBone>(&app, bone).tip;
        assert!(tip.distance(goal) < 1e-6, "{tip} {goal}");
    }
    let vrm = |entity| match get::<SpringBone>(&app, entity).spring {
        Spring::Vrm { stiffness, gravity_power, gravity_dir, drag_force } => {
            (stiffness, gravity_power, gravity_dir, drag_force)
        }
        other @ Spring::Swing { .. } => panic!("{other:?}"),
    };
    assert_eq!(vrm(ear), (0.5, 0.25, Vec3::NEG_Y, 0.5));
    assert_eq!(vrm(tip), (1.0, 0.0, Vec3::Z, 0.75));
    let list = get::<SpringColliders>(&app, ear);
    assert_eq!((list.radius, list.friction, list.bodies.len()), (0.0625, 0.0, 2));
    for bone in [ear, tip] {
        assert_eq!(get::<SpringCenter>(&app, bone), SpringCenter(Some(head)));
        assert!(pendulums(&app).centered_bone(bone).is_some());
    }

    // Where the bodies are in the world, from the numbers of the file.
    let [ball, capsule] = [0, 1].map(|k| {
        let body = list.bodies[k];
        let place = get::<GlobalTransform>(&app, body);
        let scale = place.to_scale_rotation_translation().0.y;
        match get::<SpringCollider>(&app, body) {
            SpringCollider::Capsule { ends, radius } => {
                (ends.map(|end| place.transform_point(end)), scale * radius)
            }
            other => panic!("{other:?}"),
        }
    });
    let point = |entity: Entity, p: [f32; 3]| {
        get::<GlobalTransform>(&app, entity).transform_point(Vec3::from(p))
    };
    // Radii of a file are metres, whatever its nodes; the scene around them scales them.
    assert!((ball.1 - 3.0 * 0.25).abs() < 1e-6 && (capsule.1 - 3.0 * 0.125).abs() < 1e-6);
    assert!(ball.0[0].distance(point(head, [0.2, 0.1, 0.0])) < 1e-5);
    assert!(capsule.0[0].distance(point(tip, [0.1, 0.0, 0.0])) < 1e-5);
    assert!(capsule.0[1].distance(point(tip, [0.0, 0.1, 0.0])) < 1e-5);
}

#[test]
fn a_file_without_bones_or_with_a_wrong_setting_is_told() {
    let none = VrmSprings::read(br#"{"asset":{"version":"2.0"},"nodes":[{}]}"#).unwrap();
    let mut app = app();
    let root = app.world_mut().spawn((none, Transform::default())).id();
    let child = (Name::new("GltfNode0"), Transform::default(), ChildOf(root));
    app.world_mut().spawn(child);
    frame(&mut app, SECOND / 60);
    assert!(app.world().get::<VrmSprings>(root).is_none());
    let wrong = FILE.to_vec();
    let text = String::from_utf8(wrong).unwrap().replace("\"stiffness\":0.5", "\"stiffness\":[]");
    assert!(VrmSprings::read(text.as_bytes()).unwrap_err().to_string().contains("stiffness"));
}
