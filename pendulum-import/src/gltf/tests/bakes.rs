//! Tests of animations that are added to files. What they do is evaluated with matrices from the
//! bytes, independently of the reader.

use super::dancer;
use super::writer::{Writer, base64};
use crate::gltf::{Bake, Gltf};
use base64::prelude::{BASE64_STANDARD, Engine};
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{
    Attitudes, Curve, Derivatives, Function, Motion, Sample, Side, Sinusoid, Still, Turning,
};
use pendulum_core::nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;
use serde_json::Value;

/// The parts of a file.
struct Parts {
    json: Value,
    buffers: Vec<Vec<u8>>,
}

impl Parts {
    fn of(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (json, chunk) = if bytes.starts_with(b"glTF") {
            assert_eq!((word(8), word(12) % 4), (bytes.len(), 0));
            let end = 20 + word(12);
            (&bytes[20..end], bytes.get(end + 8..).map(<[u8]>::to_vec))
        } else {
            (bytes, None)
        };
        let json: Value = serde_json::from_slice(json).unwrap();
        let inside = |buffer: &Value| match buffer["uri"].as_str() {
            Some(uri) => BASE64_STANDARD.decode(uri.split_once(',').unwrap().1).unwrap(),
            None => chunk.clone().unwrap(),
        };
        let buffers = json["buffers"].as_array().unwrap().iter().map(inside).collect();
        Self { json, buffers }
    }

    /// The numbers of a packed accessor.
    fn floats(&self, accessor: &Value) -> Vec<f64> {
        let number = |part: &Value, key: &str| part[key].as_u64().unwrap_or(0) as usize;
        let accessor = &self.json["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.json["bufferViews"][number(accessor, "bufferView")];
        let start = number(view, "byteOffset") + number(accessor, "byteOffset");
        let width = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        let bytes =
            &self.buffers[number(view, "buffer")][start..][..4 * width * number(accessor, "count")];
        bytes
            .chunks(4)
            .map(|part| f64::from(f32::from_le_bytes(part.try_into().unwrap())))
            .collect()
    }

    /// The last animation.
    fn animation(&self) -> &Value {
        self.json["animations"].as_array().unwrap().last().unwrap()
    }

    /// The keys of a channel of the last animation.
    fn keys(&self, node: usize, path: &str) -> Option<(Vec<f64>, Vec<f64>, bool)> {
        let played = self.animation();
        let channel = played["channels"].as_array().unwrap().iter().find(|channel| {
            channel["target"]["node"] == node && channel["target"]["path"] == path
        })?;
        let sampler = &played["samplers"][channel["sampler"].as_u64().unwrap() as usize];
        let values = self.floats(&sampler["output"]);
        Some((self.floats(&sampler["input"]), values, sampler["interpolation"] == "STEP"))
    }

    /// A translation, rotation or scale at a time of the last animation.
    fn part<const D: usize>(&self, node: usize, path: &str, rest: [f64; D], t: f64) -> [f64; D] {
        let array = |values: &[f64]| -> [f64; D] { values.try_into().unwrap() };
        let Some((times, values, steps)) = self.keys(node, path) else {
            let given = self.json["nodes"][node][path].as_array();
            let given =
                given.map(|parts| parts.iter().map(|part| part.as_f64().unwrap()).collect());
            return given.map_or(rest, |parts: Vec<f64>| array(&parts));
        };
        let next = times.partition_point(|&key| key <= t);
        let key = |key: usize| array(&values[D * key..][..D]);
        if next == 0 || next == times.len() || steps {
            return key(next.saturating_sub(1));
        }
        let (from, to) = (key(next - 1), key(next));
        let share = (t - times[next - 1]) / (times[next] - times[next - 1]);
        if D == 3 {
            return core::array::from_fn(|d| from[d] + share * (to[d] - from[d]));
        }
        let [from, to] = [from, to].map(|key| {
            UnitQuaternion::from_quaternion(Quaternion::new(key[3], key[0], key[1], key[2]))
        });
        let at = from.slerp(&to, share).coords;
        core::array::from_fn(|d| at[d])
    }

    fn local(&self, node: usize, t: f64) -> Matrix4<f64> {
        if let Some(matrix) = self.json["nodes"][node]["matrix"].as_array() {
            return Matrix4::from_iterator(matrix.iter().map(|part| part.as_f64().unwrap()));
        }
        let at = self.part(node, "translation", [0.0; 3], t);
        let [x, y, z, w] = self.part(node, "rotation", [0.0, 0.0, 0.0, 1.0], t);
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let scale = self.part(node, "scale", [1.0; 3], t);
        Matrix4::new_translation(&Vector3::from(at))
            * turn.to_homogeneous()
            * Matrix4::new_nonuniform_scaling(&Vector3::from(scale))
    }

    fn world(&self, node: usize, t: f64) -> Matrix4<f64> {
        let nodes = self.json["nodes"].as_array().unwrap();
        let parent = nodes.iter().position(|parent| {
            parent["children"].as_array().is_some_and(|all| all.contains(&node.into()))
        });
        match parent {
            Some(parent) => self.world(parent, t) * self.local(node, t),
            None => self.local(node, t),
        }
    }
}

fn sampled<const D: usize>(motion: &impl Motion<f64, D>, t: f64) -> [f64; D] {
    let side = if t < 1.0 { Side::After } else { Side::Before };
    let sample: Sample<f64, D> = motion.sample(Time::new(t), side, Derivatives::POSITION);
    sample.position
}

/// Checks that a node turns as a motion does over one second, at a thousand times: by products of
/// matrices, whose columns of length one are its axes, and as it is read.
#[track_caller]
fn turns(bytes: &[u8], node: usize, motion: &impl Motion<f64, 4>, bound: f64) {
    let parts = Parts::of(bytes);
    let read = Gltf::read(bytes).unwrap();
    let read = read.orientation(read.animations().count() - 1, node).unwrap();
    for k in 0..=1000 {
        let t = f64::from(k) / 1000.0;
        let exact = Attitude::from_quaternion(sampled(motion, t));
        let mut axes = parts.world(node, t).fixed_view::<3, 3>(0, 0).into_owned();
        if axes.determinant() < 0.0 {
            axes.column_mut(0).neg_mut();
        }
        for mut axis in axes.column_iter_mut() {
            axis.normalize_mut();
        }
        // An axis at a right angle to that of the turn moves by the chord of its angle.
        axes -= exact.to_matrix();
        let apart = axes.column_iter().map(|axis| axis.norm()).fold(0.0, f64::max);
        assert!(apart <= bound, "{apart} at {t}");
        let found = Attitude::from_quaternion(sampled(&read, t));
        let (_, angle) = (found.inverse() * exact).to_axis_angle();
        assert!(angle <= bound, "{angle} at {t}");
    }
}

/// Checks that a node moves as a motion does over one second.
#[track_caller]
fn moves(bytes: &[u8], node: usize, motion: &impl Motion<f64, 3>, bound: f64) {
    let parts = Parts::of(bytes);
    let read = Gltf::read(bytes).unwrap();
    let read = read.motion(read.animations().count() - 1, node).unwrap();
    for k in 0..=1000 {
        let t = f64::from(k) / 1000.0;
        let exact = Vector3::from(sampled(motion, t));
        let matrix = parts.world(node, t).fixed_view::<3, 1>(0, 3) - exact;
        let found = Vector3::from(sampled(&read, t)) - exact;
        assert!(matrix.norm() <= bound && found.norm() <= bound, "{matrix} {found} at {t}");
    }
}

/// To and fro about an axis, by up to 0.9 rad.
fn swing(rate: f64) -> Turning<Sinusoid<1>> {
    let start = Attitude::from_euler("zxz", [0.3, 1.0, 2.0]).unwrap();
    Turning::new([1.0, -2.0, 2.0], Sinusoid::new([0.9], rate, [0.4])).starting_at(start)
}

fn path() -> Curve<3> {
    let values = [[0.0, 1.0, 0.0], [0.5, 1.2, -0.3], [0.2, 0.8, 0.4], [0.0, 1.0, 0.0]];
    Curve::spline(&[0.0, 0.3, 0.7, 1.0], &values).unwrap()
}

const BOUND: f64 = 1e-3;

/// Two turns as far apart as players have to take them, twice as long as they should be.
const TURNS: [f32; 8] = [0.96, 1.2, 0.0, 1.28, 0.0, -1.2, 1.6, 0.0];

/// A file whose first node turns and moves.
fn rooted() -> Writer {
    let mut file = Writer::default();
    file.channel(0, "rotation", "LINEAR", &[0.0, 0.4], &TURNS);
    file.channel(0, "translation", "LINEAR", &[0.1, 0.9], &[0.0, 1.0, 0.0, 3.0, 1.0, -2.0]);
    file
}

/// Writes a file with baked nodes.
fn baked<'a>(file: &'a Gltf, add: impl FnOnce(&mut Bake<'a>)) -> Vec<u8> {
    let mut bake = file.bake("sway", 1.0);
    bake.under(0).bounds(BOUND, BOUND);
    add(&mut bake);
    bake.write().unwrap()
}

/// Bakes orientation and position of the last of these nodes and checks both.
#[track_caller]
fn check(nodes: &str, node: usize) {
    for bytes in [rooted().binary(nodes), rooted().text(nodes)] {
        let file = Gltf::read(&bytes).unwrap();
        let written = baked(&file, |bake| {
            bake.orientation(node, swing(9.0)).position(node, path());
        });
        assert_eq!(written.starts_with(b"glTF"), bytes.starts_with(b"glTF"));
        turns(&written, node, &swing(9.0), BOUND);
        moves(&written, node, &path(), BOUND);
        // Alone, the orientation leaves the node where it stands on its parent.
        let written = baked(&file, |bake| {
            bake.orientation(node, swing(9.0));
        });
        turns(&written, node, &swing(9.0), BOUND);
        assert_eq!(Parts::of(&written).keys(node, "translation").is_none(), node != 0);
    }
}

#[test]
fn a_root_that_moves_carries_what_is_baked() {
    check(r#"{"name":"hip","children":[1]},{"name":"tail","translation":[0,0.5,0]}"#, 1);
    check(r#"{"name":"hip","children":[1]},{"name":"tail"}"#, 0);
}

#[test]
fn a_rig_in_centimetres_is_baked() {
    let nodes = r#"{"children":[1],"scale":[0.01,0.01,0.01]},
        {"translation":[0,50,0],"children":[2],"scale":[2,2,2]},
        {"translation":[0,20,0],"scale":[3,1,0.5]}"#;
    check(nodes, 2);
}

#[test]
fn mirrored_rigs_are_baked() {
    for signs in [[-1, 1, 1], [1, -1, 1], [-1, -1, 1], [-1, -1, -1], [1, 1, -1]] {
        let nodes = format!(
            r#"{{"children":[1]}},{{"scale":{signs:?},"rotation":[0,0.6,0,0.8],"children":[2]}},
            {{"translation":[0,20,0],"scale":[1,-2,1]}}"#
        );
        check(&nodes, 2);
    }
}

#[test]
fn nodes_on_matrices_and_nodes_with_one_are_baked() {
    let nodes = r#"{"children":[1]},{"matrix":[0,2,0,0, -2,0,0,0, 0,0,2,0, 1,2,3,1],"children":[2]},
        {"matrix":[0,0,-3,0, 0,1,0,0, 0.5,0,0,0, 0,1,0,1],"children":[3]},{"translation":[1,0,0]}"#;
    check(nodes, 2);
    check(&nodes.replace("0.5,0,0,0", "-0.5,0,0,0"), 2);
}

#[test]
fn rotations_of_any_length_are_baked() {
    let nodes = r#"{"rotation":[0,3,0,4],"children":[1]},{"rotation":[0,0.06,0,-0.08],"children":[2]},
        {"rotation":[1,2,3,4]}"#;
    check(nodes, 2);
}

/// Skins, meshes, unknown members and extensions stay as they are.
#[test]
fn skins_and_what_is_not_known_survive() {
    let nodes = r#"{"name":"hip","children":[1,2]},{"name":"left","extras":[1,{"a":null}]},
        {"translation":[1,0,0],"extensions":{"VRMC_x":{"deep":[0.1,1e-3,12345678901234567890]}}}"#;
    let more = r#"{"extensionsUsed":["VRMC_x"],"scene":0,"scenes":[{"nodes":[0]}],"skins":[{"joints":[0,1]},
        {"joints":[0,2],"name":"cloak"}],"extras":7,"cameras":null,"asset""#;
    let text = String::from_utf8(rooted().text(nodes)).unwrap().replacen(r#"{"asset""#, more, 1);
    let file = Gltf::read(text.as_bytes()).unwrap();
    let written = baked(&file, |bake| {
        let cloth = bake.orientation(1, swing(5.0)).add("cloth", Some(2));
        let moth = bake.position(cloth, path()).add("moth", None);
        bake.orientation(moth, swing(3.0)).position(moth, path());
    });
    turns(&written, 1, &swing(5.0), BOUND);
    moves(&written, 3, &path(), BOUND);
    turns(&written, 4, &swing(3.0), BOUND);
    let (before, mut after): (Value, _) =
        (serde_json::from_str(&text).unwrap(), Parts::of(&written).json);
    assert_eq!(
        (&after["scenes"][0]["nodes"], &after["nodes"][2]["children"]),
        (&[0, 4].into(), &[3].into())
    );
    // Nodes that are added begin where they rest.
    assert_eq!(after["nodes"][4]["translation"], serde_json::json!([0.0, 1.0, 0.0]));
    assert_eq!(
        after["nodes"][3].as_object().unwrap().keys().collect::<Vec<_>>(),
        ["name", "translation"]
    );
    // Nothing else is changed: without what was added, the file is the same.
    after["scenes"][0]["nodes"] = [0].into();
    after["nodes"][2].as_object_mut().unwrap().remove("children");
    for (key, old) in before.as_object().unwrap() {
        if let (Some(old), Some(new)) = (old.as_array(), after[key].as_array_mut()) {
            new.truncate(old.len());
        }
    }
    assert_eq!(before, after);
}

#[test]
fn files_without_animations_or_buffers_are_baked() {
    let json = r#"{"asset":{"version":"2.0"},"nodes":[{"children":[1]},{}],"animations":null}"#;
    let length = |bytes: usize| u32::try_from(bytes).unwrap().to_le_bytes();
    let padded = format!("{json}{}", " ".repeat(json.len().next_multiple_of(4) - json.len()));
    let binary = [
        &b"glTF"[..],
        &length(2),
        &length(20 + padded.len()),
        &length(padded.len()),
        b"JSON",
        padded.as_bytes(),
    ];
    for bytes in [json.as_bytes(), &binary.concat()] {
        let file = Gltf::read(bytes).unwrap();
        let written = file.bake("first", 1.0).orientation(1, swing(9.0)).write().unwrap();
        turns(&written, 1, &swing(9.0), 1e-3);
        let again = Gltf::read(&written).unwrap();
        assert_eq!(again.animations().collect::<Vec<_>>(), ["first"]);
        let twice = again.bake("second", 1.0).orientation(0, swing(2.0)).write().unwrap();
        turns(&twice, 0, &swing(2.0), 1e-3);
        let read = Gltf::read(&twice).unwrap();
        let first = |file: &Gltf| file.orientation(0, 1).unwrap();
        assert_eq!(first(&read), first(&again));
    }
}

#[test]
fn buffers_beside_the_file_stay_there() {
    let folder = std::env::temp_dir().join(format!("pendulum-bake-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (file, nodes) = dancer();
    std::fs::write(folder.join("steps.bin"), &file.bytes).unwrap();
    std::fs::write(folder.join("dance.gltf"), file.json(nodes, r#","uri":"steps.bin""#)).unwrap();
    let dance = Gltf::open(folder.join("dance.gltf")).unwrap();
    let mut bake = dance.bake("sway", 1.0);
    let written = bake.under(0).orientation(1, swing(9.0)).write().unwrap();
    std::fs::write(folder.join("swayed.gltf"), written).unwrap();
    let swayed = Gltf::open(folder.join("swayed.gltf")).unwrap();
    assert_eq!(swayed.motion(0, 3).unwrap(), dance.motion(0, 3).unwrap());
    // The other nodes move as in the dance.
    assert_eq!(swayed.motion(1, 0).unwrap(), dance.motion(0, 0).unwrap());
    let found = swayed.orientation(1, 1).unwrap();
    for k in 0..=100 {
        let t = f64::from(k) / 100.0;
        let [found, exact] = [sampled(&found, t), sampled(&swing(9.0), t)];
        let (_, angle) = (Attitude::from_quaternion(found).inverse()
            * Attitude::from_quaternion(exact))
        .to_axis_angle();
        assert!(angle <= 1e-3, "{angle}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Bones of length zero, each twice as fast as the one before.
#[test]
fn errors_do_not_add_up_along_a_chain() {
    let nodes: Vec<String> = (1..6).map(|child| format!(r#"{{"children":[{child}]}}"#)).collect();
    let file = Gltf::read(&rooted().binary(&format!("{},{{}}", nodes.join(",")))).unwrap();
    let rate = |node: usize| 1.5 * f64::from(1 << node);
    let written = baked(&file, |bake| {
        // In any order.
        for node in [3, 1, 5, 4, 2] {
            bake.orientation(node, swing(rate(node)));
        }
    });
    for node in 1..6 {
        turns(&written, node, &swing(rate(node)), BOUND);
    }
}

#[test]
fn jumps_of_parents_and_of_motions_are_baked() {
    let mut file = Writer::default();
    file.channel(0, "rotation", "STEP", &[0.0, 0.25, 0.5], &[&TURNS[..], &TURNS[..4]].concat());
    file.channel(0, "scale", "STEP", &[0.0, 0.75], &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    let file = Gltf::read(&file.binary(r#"{"children":[1]},{}"#)).unwrap();
    let jumps: Vec<[f64; 3]> = (0..4).map(|key| [f64::from(key % 2), 1.0, 0.0]).collect();
    let hops = Curve::steps(&[0.0, 0.125, 0.625, 0.875], &jumps).unwrap();
    let written = baked(&file, |bake| {
        bake.orientation(1, swing(9.0)).position(1, hops.clone());
    });
    turns(&written, 1, &swing(9.0), BOUND);
    moves(&written, 1, &hops, BOUND);
    // Two keys for each jump of the position, its parent's scale included.
    let (times, ..) = Parts::of(&written).keys(1, "translation").unwrap();
    assert!(times.len() <= 16, "{times:?}");
}

#[test]
fn keys_are_the_motion_in_single_precision() {
    let file = Gltf::read(&rooted().binary("{}")).unwrap();
    let angle = Sinusoid::new([0.9], 7.0, [0.4]);
    let written = baked(&file, |bake| {
        bake.orientation(0, Turning::new([0.0, 0.0, 1.0], angle)).position(0, path());
    });
    let parts = Parts::of(&written);
    let (times, values, _) = parts.keys(0, "rotation").unwrap();
    for (&t, key) in times.iter().zip(values.chunks(4)) {
        let (sin, cos) = Real::sin_cos(0.5 * sampled(&angle, t)[0]);
        assert_eq!(key, [0.0, 0.0, f64::from(sin as f32), f64::from(cos as f32)]);
    }
    let (times, values, _) = parts.keys(0, "translation").unwrap();
    for (&t, key) in times.iter().zip(values.chunks(3)) {
        assert_eq!(key, sampled(&path(), t).map(|part| f64::from(part as f32)));
    }
    let accessors = parts.json["accessors"].as_array().unwrap();
    let input = accessors.iter().rfind(|accessor| accessor["type"] == "SCALAR").unwrap();
    assert_eq!((&input["min"], &input["max"]), (&[0.0].into(), &[1.0].into()));
}

#[test]
fn keys_are_few() {
    let file = Gltf::read(&rooted().binary("{}")).unwrap();
    let count = |motion: &dyn Fn(f64) -> [f64; 4], bound: f64| {
        let mut bake = file.bake("sway", 1.0);
        bake.bounds(bound, 1.0).orientation(0, Function::new(motion));
        Parts::of(&bake.write().unwrap()).keys(0, "rotation").unwrap().0.len()
    };
    let about = |angle: f64| Attitude::from_axis_angle([0.6, 0.0, 0.8], angle).to_quaternion();
    assert_eq!(count(&|_| about(1.0), 1e-6), 2);
    assert_eq!(count(&|t| about(2.5 * t), 1e-6), 2);
    // Two and a half turns, of which an arc has less than a half.
    assert_eq!(count(&|t| about(5.0 * core::f64::consts::PI * t), 1e-6), 7);
    // A parabola is ¼ a h² /2 off its chords of length h: 16 of them for a bound of 1/1024.
    let keys = count(&|t| about(t * t), 1.0 / 1024.0);
    assert!((17..=18).contains(&keys), "{keys}");
}

#[test]
fn keys_of_a_scene_are_baked_as_they_are() {
    let times: Vec<f64> = (0..=60).map(|frame| f64::from(frame) / 60.0).collect();
    let attitudes: Vec<Attitude> =
        times.iter().map(|&t| Attitude::from_quaternion(sampled(&swing(9.0), t))).collect();
    let run = Attitudes::slerp(&times, &attitudes).unwrap();
    let file = Gltf::read(&rooted().binary(r#"{"children":[1]},{}"#)).unwrap();
    turns(
        &baked(&file, |bake| {
            bake.orientation(1, run.clone());
        }),
        1,
        &run,
        BOUND,
    );
}

#[test]
fn what_cannot_be_baked_is_refused_by_name() {
    let nodes = r#"{"name":"hip","children":[1]},{"name":"tail","scale":[0,1,1],"children":[2]},{"name":"tip",
        "matrix":[1,0,0,0, 0.25,2,0,0, 0,0,1,0, 0,0.5,0,1]}"#;
    let file = Gltf::read(&rooted().binary(nodes)).unwrap();
    let refused = |add: &dyn Fn(&mut Bake<'_>), expected: &str| {
        let mut bake = file.bake("sway", 1.0);
        add(&mut bake);
        let message = bake.write().unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message}");
    };
    let nan = Function::new(|t: f64| [if t < 0.5 { 1.0 } else { f64::NAN }, 0.0, 0.0, 0.0]);
    let turn = Still::new([1.0, 0.0, 0.0, 0.0]);
    refused(&|_| {}, "bake: no node follows a motion; ");
    refused(
        &|bake| {
            bake.orientation(9, turn);
        },
        "nodes[9]: does not exist",
    );
    refused(
        &|bake| {
            bake.under(4);
        },
        "animations[4]: does not exist; ",
    );
    refused(
        &|bake| {
            bake.add("moth", Some(3));
        },
        "nodes[3] `moth`: its parent nodes[3] does not exist before it; add the parent first",
    );
    refused(
        &|bake| {
            bake.orientation(2, turn).bounds(1.0, 1.0);
        },
        "nodes[2] `tip`: its matrix has shear; ",
    );
    refused(
        &|bake| {
            bake.position(2, Still::new([0.0; 3]));
        },
        "nodes[2] `tip`: its matrix has shear; ",
    );
    refused(
        &|bake| {
            let child = bake.add("child", Some(1));
            bake.position(child, Still::new([0.0; 3]));
        },
        "nodes[3] `child`: position: a parent has the scale zero at 0 s; ",
    );
    refused(
        &|bake| {
            bake.orientation(0, nan.clone());
        },
        "nodes[0] `hip`: motion: the motion gives no finite numbers at 0.5 s; ",
    );
    refused(
        &|bake| {
            bake.orientation(0, swing(9.0)).bounds(1e-9, 1.0);
        },
        "nodes[0] `hip`: bounds: single precision holds no orientations within 0.000000001 rad; ",
    );
    refused(
        &|bake| {
            bake.position(0, Still::new([1e6 / 3.0; 3])).bounds(1.0, 1e-9);
        },
        "nodes[0] `hip`: bounds: single precision holds no",
    );
    for bounds in [[0.0, 1.0], [1.0, f64::NAN], [f64::INFINITY, 1.0]] {
        refused(
            &|bake| {
                bake.bounds(bounds[0], bounds[1]);
            },
            "bake: the bounds [",
        );
    }
    for seconds in [0.0, -1.0, f64::NAN, 1e9] {
        let message = file.bake("sway", seconds).orientation(0, turn).write().unwrap_err();
        assert!(message.to_string().starts_with("bake: "), "{message}");
    }
}

/// A scene with a broken list, and a parent that is no node.
#[test]
fn what_contradicts_itself_is_refused() {
    let file = |nodes: &str, more: &str| {
        let data = base64(&[0; 4]);
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{nodes}],"buffers":[{{"byteLength":4,"uri":"data:;base64,{data}"}}]{more}}}"#
        );
        Gltf::read(json.as_bytes()).unwrap()
    };
    let add = |file: &Gltf, parent: Option<usize>| {
        let mut bake = file.bake("sway", 1.0);
        let node = bake.add("new", parent);
        bake.orientation(node, swing(1.0)).write().map_err(|error| error.to_string())
    };
    for (nodes, more, parent, expected) in [
        ("7", "", Some(0), "nodes[0]: it has no list of `children`; "),
        ("null", "", Some(0), "nodes[0]: it has no list of `children`; "),
        ("", r#","scenes":[7]"#, None, "scenes[0]: it has no list of `nodes`; "),
        ("", r#","scene":1,"scenes":[{},{"nodes":{}}]"#, None, "scenes[1]: it has no list of `no"),
    ] {
        let message = add(&file(nodes, more), parent).unwrap_err();
        assert!(message.starts_with(expected), "{message}");
    }
    for more in ["", r#","scene":5,"scenes":[{}]"#, r#","scenes":7"#, r#","scenes":[{}]"#] {
        turns(&add(&file("", more), None).unwrap(), 0, &swing(1.0), 1e-3);
    }
}
