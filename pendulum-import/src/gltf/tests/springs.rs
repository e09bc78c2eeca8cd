//! Tests of spring bones: their settings, and their places against positions of nodes.

use super::dancer;
use crate::gltf::{Gltf, SpringCollider, SpringShape, Springs};
use crate::random::Random;
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Derivatives, Motion, Side};
use pendulum_core::time::Time;

/// A file with these nodes and extensions.
pub(super) fn file(nodes: &str, extensions: &str) -> Gltf {
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{nodes}],"extensions":{{{extensions}}}}}"#
    );
    Gltf::read(json.as_bytes()).unwrap()
}

pub(super) fn one(springs: &str) -> String {
    format!(r#""VRMC_springBone":{{"specVersion":"1.0",{springs}}}"#)
}

pub(super) fn zero(springs: &str) -> String {
    format!(r#""VRM":{{"secondaryAnimation":{{{springs}}}}}"#)
}

/// A head with an ear of three joints that is bent at its second one.
pub(super) const EAR: &str = r#"{"name":"head","translation":[0,1.5,0],"children":[1]},
    {"name":"ear","translation":[0.1,0.1,0],"rotation":[0,0,0.6,0.8],"children":[2]},
    {"translation":[0,0.2,0],"rotation":[0.6,0,0,0.8],"children":[3]},
    {"translation":[0.05,0.1,0]}"#;

#[track_caller]
pub(super) fn close(a: [f64; 3], b: [f64; 3]) {
    assert!((0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-7), "{a:?} is not {b:?}");
}

/// The position of a node at rest.
fn position(file: &Gltf, node: usize) -> [f64; 3] {
    let (place, _) = file.frame(None, node, Attitude::identity()).unwrap();
    place.sample(Time::new(0.0), Side::After, Derivatives::POSITION).position
}

pub(super) fn orientation(file: &Gltf, node: usize, turn: Attitude) -> Attitude {
    let (_, turn) = file.frame(None, node, turn).unwrap();
    let sample = turn.sample(Time::new(0.0), Side::After, Derivatives::POSITION);
    Attitude::from_quaternion(sample.position)
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|axis| a[axis] + b[axis])
}

/// Puts each bone on what carries it, and returns the joint and the tip.
pub(super) fn stand(file: &Gltf, springs: &Springs) -> Vec<[[f64; 3]; 2]> {
    let mut stood: Vec<([[f64; 3]; 2], Attitude)> = Vec::new();
    for bone in &springs.bones {
        let parent = (0..file.parents.len()).find(|&node| file.parents[bone.node] == Some(node));
        let (origin, turn) = match (bone.carrier, parent) {
            (Some(carrier), _) => (stood[carrier].0[1], stood[carrier].1),
            (None, Some(parent)) => {
                (position(file, parent), orientation(file, parent, Attitude::identity()))
            }
            (None, None) => ([0.0; 3], Attitude::identity()),
        };
        let (joint, turn) = (plus(origin, turn * bone.place), turn * bone.rest);
        stood.push(([joint, plus(joint, turn * [0.0, bone.length, 0.0])], turn));
        // The attitude relative to the carrier and that relative to the node are the same.
        let own = orientation(file, bone.node, bone.axis);
        close(own * [1.0, 0.0, 0.0], turn * [1.0, 0.0, 0.0]);
        close(own * [0.0, 1.0, 0.0], turn * [0.0, 1.0, 0.0]);
    }
    stood.into_iter().map(|(ends, _)| ends).collect()
}

#[test]
fn a_frame_is_the_motion_of_a_node_and_its_orientation_after_a_turn() {
    let (file, nodes) = dancer();
    let file = Gltf::read(&file.binary(nodes)).unwrap();
    let axis = Attitude::from_axis_angle([1.0, 2.0, 3.0], 0.7);
    for node in 0..2 {
        let (place, turn) = file.frame(Some(0), node, axis).unwrap();
        assert_eq!(place, file.motion(0, node).unwrap());
        let exact = file.orientation(0, node).unwrap();
        for k in 0..20 {
            let t = Time::new(0.1 * f64::from(k));
            let [turn, exact] =
                [&turn, &exact].map(|motion| motion.sample(t, Side::After, Derivatives::ALL));
            let turned = |q: [f64; 4]| Attitude::from_quaternion(q) * axis;
            let [a, b] = [Attitude::from_quaternion(turn.position), turned(exact.position)];
            close(a * [1.0, 0.0, 0.0], b * [1.0, 0.0, 0.0]);
            close(a * [0.0, 1.0, 0.0], b * [0.0, 1.0, 0.0]);
            let speed = |q: [f64; 4]| q.iter().map(|part| part * part).sum::<f64>();
            assert!((speed(turn.velocity) - speed(exact.velocity)).abs() < 1e-9);
        }
    }
}

#[test]
fn settings_have_their_names_and_defaults() {
    let springs = r#""colliders":[{"node":0,"shape":{"sphere":{"offset":[0,0.1,0],"radius":0.2}}},
            {"node":0,"shape":{"capsule":{"offset":[0,0,0.5],"radius":0.1,"tail":[0,0,1]}}}],
        "colliderGroups":[{"colliders":[1]},{"colliders":[0,1]}],
        "springs":[{"center":0,"colliderGroups":[1,0],"joints":[{"node":1,"stiffness":0.7,
            "gravityPower":0.2,"gravityDir":[1,0,0],"dragForce":0.4,"hitRadius":0.02},
            {"node":2},{"node":3}]}]"#;
    let springs = file(EAR, &one(springs)).springs().unwrap();
    let [first, second] = &springs.bones[..] else { panic!("{springs:?}") };
    assert_eq!((first.node, second.node), (1, 2));
    assert_eq!((first.carrier, second.carrier), (None, Some(0)));
    assert_eq!((first.stiffness, first.gravity_power, first.drag_force), (0.7, 0.2, 0.4));
    assert_eq!((first.gravity_dir, first.hit_radius), ([1.0, 0.0, 0.0], 0.02));
    assert_eq!((second.stiffness, second.gravity_power, second.drag_force), (1.0, 0.0, 0.5));
    assert_eq!((second.gravity_dir, second.hit_radius), ([0.0, -1.0, 0.0], 0.0));
    for bone in [first, second] {
        assert_eq!((bone.center, &bone.colliders[..]), (Some(0), &[0, 1][..]));
    }
    let shape = |ends, radius| SpringShape::Capsule { ends, radius, inside: false };
    let offset = [0.0, f64::from(0.1f32), 0.0];
    let expected = [shape([offset; 2], 0.2), shape([[0.0, 0.0, 0.5], [0.0, 0.0, 1.0]], 0.1)];
    let found: Vec<_> = springs.colliders.iter().map(|collider| collider.shape).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_file_without_springs_has_none() {
    assert_eq!(file(EAR, "").springs().unwrap(), Springs::default());
    assert_eq!(file(EAR, r#""VRM":{}"#).springs().unwrap(), Springs::default());
}

#[test]
fn bones_end_at_the_next_joint() {
    let springs = one(r#""springs":[{"joints":[{"node":1},{"node":2},{"node":3}]}]"#);
    let file = file(EAR, &springs);
    let springs = file.springs().unwrap();
    let ends = stand(&file, &springs);
    assert_eq!(ends.len(), 2);
    for (bone, nodes) in ends.iter().zip([[1, 2], [2, 3]]) {
        close(bone[0], position(&file, nodes[0]));
        close(bone[1], position(&file, nodes[1]));
    }
    assert!((springs.bones[0].length - 0.2).abs() < 1e-7);
    close(springs.bones[1].place, [0.0; 3]);
}

#[test]
fn joints_may_skip_nodes_and_chains_may_branch() {
    let nodes = r#"{"children":[1]},{"translation":[0,1,0],"children":[2,4]},
        {"translation":[0,1,0],"rotation":[0,0,0.6,0.8],"children":[3]},{"translation":[0,1,0]},
        {"translation":[1,0,0],"children":[5]},{"translation":[1,0,0]}"#;
    // The branch is named first, and stands behind the bone that carries it.
    let springs = r#""springs":[{"joints":[{"node":4},{"node":5}]},
        {"joints":[{"node":0},{"node":1},{"node":3}]}]"#;
    let file = file(nodes, &one(springs));
    let springs = file.springs().unwrap();
    let heads: Vec<usize> = springs.bones.iter().map(|bone| bone.node).collect();
    assert_eq!(heads, [0, 1, 4]);
    let carriers: Vec<_> = springs.bones.iter().map(|bone| bone.carrier).collect();
    assert_eq!(carriers, [None, Some(0), Some(1)]);
    for (bone, nodes) in stand(&file, &springs).iter().zip([[0, 1], [1, 3], [4, 5]]) {
        close(bone[0], position(&file, nodes[0]));
        close(bone[1], position(&file, nodes[1]));
    }
}

#[test]
fn bones_of_scaled_and_mirrored_models_end_at_the_next_joint() {
    let springs =
        one(r#""colliders":[{"node":2,"shape":{"sphere":{"offset":[0.3,0.2,0.1],"radius":1}}}],
        "springs":[{"joints":[{"node":1},{"node":2},{"node":3}]}]"#);
    for scale in [[2.0; 3], [-1.0, 1.0, 1.0], [-0.5; 3], [3.0, -3.0, 3.0], [-1.0, -1.0, 1.0]] {
        for scaled in 0..3 {
            let own = |node: usize| if node == scaled { scale } else { [1.0; 3] };
            let nodes = format!(
                r#"{{"scale":{:?},"rotation":[0.6,0,0,0.8],"children":[1]}},
                {{"scale":{:?},"translation":[0.1,0.1,0],"rotation":[0,0,0.6,0.8],"children":[2]}},
                {{"scale":{:?},"translation":[0,0.2,0],"rotation":[0.6,0,0,0.8],"children":[3,4]}},
                {{"translation":[0.05,0.1,0]}},{{"translation":[0.3,0.2,0.1]}}"#,
                own(0),
                own(1),
                own(2)
            );
            let file = file(&nodes, &springs);
            let springs = file.springs().unwrap();
            let ends = stand(&file, &springs);
            for (bone, nodes) in ends.iter().zip([[1, 2], [2, 3]]) {
                close(bone[0], position(&file, nodes[0]));
                close(bone[1], position(&file, nodes[1]));
            }
            // A bone carries the collider, which stands where a node with its offset stands.
            let SpringCollider { carrier: Some(1), shape, .. } = springs.colliders[0] else {
                panic!("{springs:?}")
            };
            let SpringShape::Capsule { ends: [center, _], .. } = shape else { panic!() };
            let turn = orientation(&file, 2, springs.bones[1].axis);
            close(plus(ends[1][1], turn * center), position(&file, 4));
        }
    }
}

#[test]
fn extended_shapes_replace_the_others() {
    let extended = |shape: &str| {
        let springs = format!(
            r#""colliders":[{{"node":0,"shape":{{"sphere":{{"radius":0,"offset":[0,-10000,0]}}}},
            "extensions":{{"VRMC_springBone_extended_collider":
            {{"specVersion":"1.0","shape":{shape}}}}}}}]"#
        );
        let nodes = r#"{"rotation":[0,0.6,0,0.8],"scale":[-2,2,2]}"#;
        file(nodes, &one(&springs)).springs().map(|springs| springs.colliders[0].shape)
    };
    let SpringShape::Plane { point, normal } =
        extended(r#"{"plane":{"offset":[1,2,3],"normal":[0.6,0.8,0]}}"#).unwrap()
    else {
        panic!()
    };
    // The orientation of a mirrored node has the opposite of its axis x.
    close(point, [-2.0, 4.0, 6.0]);
    close(normal, [-0.6, 0.8, 0.0]);
    let capsule = extended(r#"{"capsule":{"radius":0.5,"tail":[0,0,1],"inside":true}}"#).unwrap();
    let SpringShape::Capsule { ends, radius, inside } = capsule else { panic!() };
    assert_eq!((radius, inside), (0.5, true));
    close(ends[1], [0.0, 0.0, 2.0]);
    let sphere = extended(r#"{"sphere":{"radius":0.5,"inside":false}}"#).unwrap();
    assert_eq!(sphere, SpringShape::Capsule { ends: [[0.0; 3]; 2], radius: 0.5, inside: false });
    for (shape, what) in [
        (r#"{"plane":{"normal":[0,0,0]}}"#, "its `normal` has no direction"),
        (r#"{"sphere":{"inside":true}}"#, "its `radius` is zero"),
        (r#"{"sphere":{"radius":1,"inside":1}}"#, "neither true nor false"),
        (r#"{"cube":{}}"#, "neither a sphere nor a capsule"),
    ] {
        let error = extended(shape).unwrap_err();
        assert_eq!(error.place, "extensions.VRMC_springBone.colliders[0]");
        assert!(error.what.contains(what), "{error}");
    }
}

#[test]
fn a_plane_on_a_node_without_extent_is_refused() {
    let springs = r#""colliders":[{"node":0,"extensions":{"VRMC_springBone_extended_collider":
        {"specVersion":"1.0","shape":{"plane":{}}}}}]"#;
    let error = file(r#"{"scale":[0,0,0]}"#, &one(springs)).springs().unwrap_err().to_string();
    assert!(error.starts_with("nodes[0]: a collider on it has no finite shape"), "{error}");
}

#[test]
fn groups_of_vrm_0_name_all_nodes_below_and_leaves_are_7_cm_long() {
    let nodes = r#"{"translation":[0,1,0],"children":[1]},
        {"translation":[0,0.1,0],"children":[2,3]},{"translation":[0,0.2,0]},
        {"translation":[0.3,0,0.4]}"#;
    let springs = r#""boneGroups":[{"bones":[1],"stiffiness":0.9,"gravityPower":0.3,"center":-1,
            "gravityDir":{"x":0.5,"z":1},"dragForce":0.6,"hitRadius":0.03,"colliderGroups":[0]},
            {"bones":[2],"stiffiness":4}],
        "colliderGroups":[{"node":0,"colliders":[{"offset":{"x":1,"y":2,"z":3},"radius":0.1}]}]"#;
    let file = file(nodes, &zero(springs));
    let springs = file.springs().unwrap();
    let heads: Vec<_> = springs.bones.iter().map(|bone| (bone.node, bone.carrier)).collect();
    assert_eq!(heads, [(1, None), (2, Some(0)), (3, Some(0))]);
    for bone in &springs.bones {
        assert_eq!((bone.stiffness, bone.gravity_power, bone.drag_force), (0.9, 0.3, 0.6));
        assert_eq!((bone.gravity_dir, bone.hit_radius), ([0.5, 0.0, -1.0], 0.03));
        assert_eq!((bone.center, &bone.colliders[..]), (None, &[0][..]));
    }
    let ends = stand(&file, &springs);
    close(ends[0][1], position(&file, 2));
    close(ends[1][1], plus(position(&file, 2), [0.0, 0.07, 0.0]));
    // The second child stands beside the tip.
    close(ends[2][0], position(&file, 3));
    close(ends[2][1], plus(position(&file, 3), [0.6 * 0.07, 0.0, 0.8 * 0.07]));
    let sphere = [1.0, 2.0, -3.0];
    let shape = SpringShape::Capsule { ends: [sphere; 2], radius: 0.1, inside: false };
    assert_eq!(springs.colliders, [SpringCollider { node: 0, carrier: None, shape }]);
}

#[test]
fn joints_at_one_place_make_no_bone() {
    let nodes = r#"{"children":[1]},{"children":[2]},{"translation":[0,1,0],"children":[3]},
        {"translation":[0,1,0]}"#;
    let springs = r#""springs":[{"joints":[{"node":0},{"node":1},{"node":2},{"node":3}]}]"#;
    let springs = file(nodes, &one(springs)).springs().unwrap();
    let heads: Vec<_> = springs.bones.iter().map(|bone| (bone.node, bone.carrier)).collect();
    assert_eq!(heads, [(1, None), (2, Some(0))]);
    // A leaf without a parent has no direction.
    let lonely = file("{}", &zero(r#""boneGroups":[{"bones":[0]}]"#));
    assert_eq!(lonely.springs().unwrap(), Springs::default());
}

#[test]
fn errors_name_the_path() {
    let joints = |joints: &str| one(&format!(r#""springs":[{{"joints":[{joints}]}}]"#));
    let cases = [
        (
            joints(r#"{"node":9},{"node":2}"#),
            "VRMC_springBone.springs[0].joints[0]: its `node`, nodes[9]",
        ),
        (joints(r#"{"node":1},{}"#), "springs[0].joints[0]: the next one: its `node` is missing"),
        (joints(r#"{"node":2},{"node":1}"#), "joints[1]: nodes[1] does not stand on nodes[2]"),
        (
            joints(r#"{"node":1,"stiffness":-1},{"node":2}"#),
            "joints[0]: its `stiffness` is negative",
        ),
        (joints(r#"{"node":1,"dragForce":"a"},{"node":2}"#), "`dragForce` is no number"),
        (joints(r#"{"node":1,"gravityDir":[1,2]},{"node":2}"#), "`gravityDir` is no list of 3"),
        (joints(r#"{"node":1,"gravityDir":[1,2,1e39]},{"node":2}"#), "`gravityDir` is infinite"),
        (
            one(r#""springs":[{"joints":[{"node":1},{"node":2}]},
                    {"joints":[{"node":1},{"node":3}]}]"#),
            "springs[1].joints[0]: nodes[1] is turned by another joint too",
        ),
        (one(r#""springs":{}"#), "VRMC_springBone.springs: it is no list"),
        (one(r#""springs":[{"joints":[],"colliderGroups":[0]}]"#), "colliderGroups[0]: this group"),
        (one(r#""colliderGroups":[{"colliders":[0]}]"#), "colliders[0]: this collider"),
        (one(r#""springs":[{"center":7}]"#), "springs[0]: its `center`, nodes[7]"),
        (r#""VRMC_springBone":{"specVersion":"2.0"}"#.into(), "specVersion: version `2.0`"),
        (zero(r#""boneGroups":[{"bones":[4]}]"#), "boneGroups[0].bones[0]: this node"),
        (zero(r#""boneGroups":[{"gravityDir":{"x":"a"}}]"#), "`gravityDir`: its `x` is no number"),
        (
            zero(r#""boneGroups":[{"gravityDir":[0,-1,0]}]"#),
            "boneGroups[0]: its `gravityDir` is no object with x, y and z",
        ),
        (
            zero(r#""colliderGroups":[{"node":0,"colliders":[{"radius":-1}]}]"#),
            "secondaryAnimation.colliderGroups[0].colliders[0]: its `radius` is negative",
        ),
    ];
    for (extension, expected) in cases {
        let error = file(EAR, &extension).springs().unwrap_err().to_string();
        assert!(error.starts_with("extensions.") && error.contains(expected), "{error}");
    }
}

/// VRM 1.0: the center is the first joint of the chain, or stands below it.
#[test]
fn centers_that_a_spring_bone_carries_are_refused() {
    for (center, carrier) in [(0, None), (1, None), (2, Some(1)), (3, Some(2))] {
        let joints = format!(
            r#""springs":[{{"center":{center},"joints":[{{"node":1}},{{"node":2}},{{"node":3}}]}}]"#
        );
        let groups = format!(r#""boneGroups":[{{"center":{center},"bones":[1]}}]"#);
        for extension in [one(&joints), zero(&groups)] {
            let error = file(EAR, &extension).springs().map_err(|error| error.to_string()).err();
            let expected = carrier.map(|carrier| {
                format!(
                    "nodes[{center}]: it is the center of a spring, and the spring bone \
                     nodes[{carrier}] carries it; give a node that no spring bone carries, or none"
                )
            });
            assert_eq!(error, expected);
        }
    }
}

#[test]
fn damaged_settings_are_errors_or_springs() {
    let springs = [
        one(r#""colliders":[{"node":0,"shape":{"capsule":{"radius":1,"tail":[0,0,1]}}}],
            "colliderGroups":[{"colliders":[0]}],"springs":[{"center":0,"colliderGroups":[0],
            "joints":[{"node":1,"stiffness":0.5,"gravityDir":[0,-1,0]},{"node":2},{"node":3}]}]"#),
        zero(
            r#""boneGroups":[{"bones":[1,2],"stiffiness":0.9,"center":-1,"colliderGroups":[0],
            "gravityDir":{"x":0,"y":0,"z":1}}],
            "colliderGroups":[{"node":0,"colliders":[{"offset":{"x":1},"radius":0.1}]}]"#,
        ),
    ];
    let (mut random, mut read) = (Random::new(7), 0);
    let mut below = |most: usize| (random.bits() % most as u64) as usize;
    for case in 0..4000 {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{EAR}],"extensions":{{{}}}}}"#,
            springs[case % 2]
        );
        let mut bytes = json.into_bytes();
        for _ in 0..=below(3) {
            let at = 40 + below(bytes.len() - 40);
            bytes[at] = b"0123456789-.e,:[]{}\"x"[below(21)];
        }
        let file = Gltf::read(&bytes);
        read += usize::from(file.is_ok_and(|file| file.springs().is_ok()));
    }
    assert!((100..3900).contains(&read), "{read}");
}
