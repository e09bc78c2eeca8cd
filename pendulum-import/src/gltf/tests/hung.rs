//! Springs of files as bones in scenes: at rest, on colliders, with a center, and baked again.

use super::springs::{EAR, close, file, one, orientation, stand, zero};
use super::writer::Writer;
use crate::gltf::{Gltf, SpringCollider, SpringShape, Springs};
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Attitudes, Derivatives, Motion, Sample, Side};
use pendulum_core::time::Time;
use pendulum_runtime::motion::Still;
use pendulum_runtime::scene::{CenteredBone, Collider, Handle, Scene, Shape, VrmSpring};

type Hung = (Scene<f64>, Vec<Handle<CenteredBone, 4>>);

/// Hangs the bones of a file into a scene, at rest or on the nodes of an animation.
fn hang(file: &Gltf, springs: &Springs, animation: Option<usize>) -> Hung {
    let mut scene = Scene::new(120.0).unwrap();
    let mut hung: Vec<Handle<CenteredBone, 4>> = Vec::new();
    let ends = ["tip", "turn"];
    let identity = Attitude::identity();
    let space =
        (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(identity.to_quaternion())));
    for bone in &springs.bones {
        let frame = if let Some(below) = bone.carrier {
            scene.frame_on(hung[below], ends, bone.place, bone.rest).unwrap()
        } else {
            let (place, turn) = file.frame(animation, bone.node, bone.axis).unwrap();
            (scene.joint(place), scene.joint(turn))
        };
        let center = bone.center.map_or(space, |node| {
            let (place, turn) = file.frame(animation, node, identity).unwrap();
            (scene.joint(place), scene.joint(turn))
        });
        let spring = VrmSpring {
            stiffness: bone.stiffness,
            gravity_power: bone.gravity_power,
            gravity_dir: bone.gravity_dir,
            drag_force: bone.drag_force,
            ..VrmSpring::default()
        };
        let anchor = (frame.0, frame.1, center.0, center.1);
        let bone = spring.bone(bone.length).unwrap().centered();
        hung.extend(scene.hang_chain(anchor, [bone]).unwrap());
    }
    let mut bodies = Vec::new();
    for SpringCollider { node, carrier, shape } in springs.colliders.clone() {
        let frame = if let Some(bone) = carrier {
            scene.frame_on(hung[bone], ends, [0.0; 3], identity).unwrap()
        } else {
            let (place, turn) = file.frame(animation, node, identity).unwrap();
            (scene.joint(place), scene.joint(turn))
        };
        let shape = match shape {
            SpringShape::Plane { point, normal } => Shape::Half { point, normal },
            SpringShape::Capsule { ends, radius, inside: true } => Shape::Inside { ends, radius },
            SpringShape::Capsule { ends, radius, .. } => Shape::Capsule { ends, radius },
        };
        bodies.push(Collider { frame, shape });
    }
    for (bone, &handle) in springs.bones.iter().zip(&hung) {
        let own: Vec<_> = bone.colliders.iter().map(|&body| bodies[body]).collect();
        scene.set_colliders(handle, bone.hit_radius, &own).unwrap();
    }
    (scene, hung)
}

#[test]
fn what_hangs_as_in_the_file_stays_at_rest() {
    let nodes = r#"{"translation":[0,1,0],"rotation":[0,0.6,0,0.8],"scale":[0.5,0.5,0.5],
        "children":[1]},{"translation":[0,0.1,0],"children":[2,3]},{"translation":[0,0.2,0.1]},
        {"translation":[0.3,0,0.4],"rotation":[0.6,0,0,0.8],"children":[4]},
        {"translation":[0,0.3,0]}"#;
    let file = file(nodes, &zero(r#""boneGroups":[{"bones":[1]}]"#));
    let springs = file.springs().unwrap();
    let (mut scene, hung) = hang(&file, &springs, None);
    scene.advance(0.5).unwrap();
    for ((bone, &handle), ends) in springs.bones.iter().zip(&hung).zip(stand(&file, &springs)) {
        let turn = Attitude::from_quaternion(scene.state(handle).0) * bone.axis.inverse();
        let exact = orientation(&file, bone.node, Attitude::identity());
        close(turn * [1.0, 0.0, 0.0], exact * [1.0, 0.0, 0.0]);
        close(turn * [0.0, 1.0, 0.0], exact * [0.0, 1.0, 0.0]);
        let seen = scene.observe(handle, 1.0);
        close(seen.inputs.0.position, ends[0]);
        close(seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs), ends[1]);
    }
}

#[test]
fn an_ear_of_a_file_falls_onto_its_collider() {
    let nodes = r#"{"translation":[0,1,0],"children":[1]},
        {"translation":[0,0.3,0],"children":[2]},{"translation":[0.2,0.05,0],"children":[3]},
        {"translation":[0.2,0.05,0]}"#;
    let springs = r#""colliders":[{"node":0,"shape":{"sphere":{"radius":0.25}}}],
        "colliderGroups":[{"colliders":[0]}],"springs":[{"colliderGroups":[0],"joints":
        [{"node":1,"gravityPower":1,"stiffness":0.05,"hitRadius":0.02},
        {"node":2,"gravityPower":1,"stiffness":0.05,"hitRadius":0.02},{"node":3}]}]"#;
    let file = file(nodes, &one(springs));
    let (mut scene, hung) = hang(&file, &file.springs().unwrap(), None);
    let mut least = f64::INFINITY;
    for _ in 0..120 {
        scene.advance_ticks(1);
        for &bone in &hung {
            let seen = scene.observe(bone, 1.0);
            let tip = seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs);
            let joint = seen.inputs.0.position;
            for s in 0..=1000 {
                let part = f64::from(s) / 1000.0;
                let [x, y, z] = [0, 1, 2].map(|i| joint[i] + part * (tip[i] - joint[i]));
                least = least.min((x * x + (y - 1.0) * (y - 1.0) + z * z).sqrt() - 0.27);
            }
        }
    }
    assert!((-1e-6..1e-5).contains(&least), "{least:e}");
}

/// A file whose nodes walk two metres and turn around in two seconds, with an ear.
fn walking(center: &str) -> Gltf {
    let mut writer = Writer::default();
    let places = [0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 2.0, 0.0, 0.0]
        .chunks(3)
        .zip([0.5f32, 2.0, -1.0])
        .flat_map(|(place, speed)| {
            let tangent = [speed, 0.0, 0.3 * speed];
            [tangent, [place[0], place[1], place[2]], tangent].concat()
        })
        .collect::<Vec<_>>();
    writer.channel(0, "translation", "CUBICSPLINE", &[0.0, 0.8, 2.0], &places);
    let turns = [0.0, 0.0, 0.0, 1.0, 0.0, 0.6, 0.0, 0.8, 0.0, 1.0, 0.0, 0.0];
    writer.channel(0, "rotation", "LINEAR", &[0.0, 1.0, 2.0], &turns);
    let springs =
        format!(r#""springs":[{{{center}"joints":[{{"node":1}},{{"node":2}},{{"node":3}}]}}]"#);
    let text = String::from_utf8(writer.text(EAR)).unwrap();
    let extensions = format!(r#"{{"extensions":{{{}}},"#, one(&springs));
    Gltf::read(text.replacen('{', &extensions, 1).as_bytes()).unwrap()
}

/// The attitude of a bone in space.
fn in_space(scene: &Scene<f64>, bone: Handle<CenteredBone, 4>) -> Attitude {
    let seen = scene.observe(bone, 1.0);
    seen.system.turn(seen.t, &seen.q, &seen.v, &seen.inputs)
}

#[test]
fn a_file_with_a_center_walks_without_swinging() {
    let swing = |center: &str| {
        let file = walking(center);
        let springs = file.springs().unwrap();
        let (mut scene, hung) = hang(&file, &springs, Some(0));
        let root = file.orientation(0, 0).unwrap();
        // The attitude of a bone relative to that of the root.
        let relative = |scene: &Scene<f64>, bone| {
            let t = Time::new(scene.time());
            let turn: Sample<f64, 4> = root.sample(t, Side::After, Derivatives::POSITION);
            Attitude::from_quaternion(turn.position).inverse() * in_space(scene, bone)
        };
        let rest: Vec<_> = hung.iter().map(|&bone| relative(&scene, bone)).collect();
        assert_eq!(rest.len(), 2);
        let mut most = 0.0f64;
        for _ in 0..110 {
            scene.advance_ticks(1);
            for (&bone, rest) in hung.iter().zip(&rest) {
                let (_, angle) = (relative(&scene, bone) * rest.inverse()).to_axis_angle();
                assert!(angle.is_finite());
                most = most.max(angle);
            }
        }
        most
    };
    let (centered, felt) = (swing(r#""center":0,"#), swing(""));
    assert!(centered < 1e-4 && 0.1 < felt, "{centered:e} {felt}");
}

/// glTFast #473.
#[test]
fn bones_that_are_baked_into_their_file_turn_its_nodes_as_they_did() {
    let file = walking("");
    let springs = file.springs().unwrap();
    let (mut scene, hung) = hang(&file, &springs, Some(0));
    let (mut times, mut turns) = (Vec::new(), vec![Vec::new(); hung.len()]);
    for _ in 0..=120 {
        times.push(scene.time());
        for ((turns, &handle), bone) in turns.iter_mut().zip(&hung).zip(&springs.bones) {
            turns.push(in_space(&scene, handle) * bone.axis.inverse());
        }
        scene.advance_ticks(1);
    }
    let mut bake = file.bake("sway", 1.0);
    bake.under(0).bounds(1e-3, 1e-3);
    for (turns, bone) in turns.iter().zip(&springs.bones) {
        bake.orientation(bone.node, Attitudes::spline(&times, turns).unwrap());
    }
    let written = Gltf::read(&bake.write().unwrap()).unwrap();
    let sway = written.animation("sway").unwrap();
    for (turns, bone) in turns.iter().zip(&springs.bones) {
        let played = written.orientation(sway, bone.node).unwrap();
        for (&t, &turn) in times.iter().zip(turns) {
            let sample: Sample<f64, 4> =
                played.sample(Time::new(t), Side::After, Derivatives::POSITION);
            let played = Attitude::from_quaternion(sample.position);
            let (_, off) = (played * turn.inverse()).to_axis_angle();
            assert!(off < 1.1e-3, "{t}: {off:e}");
        }
    }
}
