//! Tiny files, written here; what a node does in them is known in closed form or from matrices.

use super::{Gltf, NodeMotion};
use crate::body::random::Random;
use crate::motion::{Linear, Motion, Orders, Projected, Sample, Side};
use crate::real::Real;
use crate::time::Time;
use nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3};
use std::fmt::Write;

/// A file while it is written.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    views: String,
    accessors: String,
    samplers: String,
    channels: String,
    count: [usize; 2],
}

impl Writer {
    fn accessor(&mut self, numbers: &[f32], kind: &str, width: usize) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        let index = self.count[0];
        let comma = if index == 0 { "" } else { "," };
        write!(self.views, r#"{comma}{{"buffer":0,"byteOffset":{start},"byteLength":{}}}"#, 4 * numbers.len()).unwrap();
        let count = numbers.len() / width;
        let accessor = format!(r#"{{"bufferView":{index},"componentType":5126,"count":{count},"type":"{kind}"}}"#);
        write!(self.accessors, "{comma}{accessor}").unwrap();
        self.count[0] += 1;
        index
    }

    fn channel(&mut self, node: usize, path: &str, interpolation: &str, times: &[f32], values: &[f32]) {
        let width = if path == "rotation" { 4 } else { 3 };
        let input = self.accessor(times, "SCALAR", 1);
        let output = self.accessor(values, &format!("VEC{width}"), width);
        let sampler = self.count[1];
        let comma = if sampler == 0 { "" } else { "," };
        write!(self.samplers, r#"{comma}{{"input":{input},"output":{output},"interpolation":"{interpolation}"}}"#).unwrap();
        write!(self.channels, r#"{comma}{{"sampler":{sampler},"target":{{"node":{node},"path":"{path}"}}}}"#).unwrap();
        self.count[1] += 1;
    }

    fn json(&self, nodes: &str, uri: &str) -> String {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{nodes}],"buffers":[{{"byteLength":{}{uri}}}],"bufferViews":[{}],"accessors":[{}],
"animations":[{{"name":"dance","samplers":[{}],"channels":[{}]}}]}}"#,
            self.bytes.len(),
            self.views,
            self.accessors,
            self.samplers,
            self.channels
        )
    }

    /// The bytes of a .gltf file with its buffer inside.
    fn text(&self, nodes: &str) -> Vec<u8> {
        let uri = format!(r#","uri":"data:application/octet-stream;base64,{}""#, base64(&self.bytes));
        self.json(nodes, &uri).into_bytes()
    }

    /// The bytes of a .glb file.
    fn binary(&self, nodes: &str) -> Vec<u8> {
        let mut json = self.json(nodes, "").into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = |bytes: usize| u32::try_from(bytes).unwrap().to_le_bytes();
        let chunk = |kind: &[u8; 4], bytes: &[u8]| [&length(bytes.len()), &kind[..], bytes].concat();
        let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &self.bytes)].concat();
        [&b"glTF"[..], &2u32.to_le_bytes(), &length(12 + chunks.len()), &chunks].concat()
    }
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let word = group.iter().enumerate().fold(0u32, |word, (at, &byte)| word | u32::from(byte) << (16 - 8 * at));
        for digit in 0..4 {
            let value = word >> (18 - 6 * digit) & 63;
            text.push(if digit <= group.len() { char::from(DIGITS[value as usize]) } else { '=' });
        }
    }
    text
}

fn at(motion: &impl Motion<f64, 3>, t: f64, side: Side) -> Sample<f64, 3> {
    motion.sample(Time::new(t), side, Orders::ALL)
}

fn close(a: [f64; 3], b: [f64; 3], slack: f64) {
    assert!((0..3).all(|axis| (a[axis] - b[axis]).abs() <= slack), "{a:?} is not {b:?}");
}

fn kinks(motion: &NodeMotion, until: f64) -> Vec<f64> {
    let mut kinks = Vec::new();
    let mut t = -1.0;
    while let Some(kink) = Motion::<f64, 3>::next_kink(motion, t).filter(|&kink| kink <= until) {
        kinks.push(kink);
        t = kink;
    }
    kinks
}

#[test]
fn a_node_on_lines_moves_as_lines_do() {
    let mut file = Writer::default();
    file.channel(0, "translation", "LINEAR", &[0.5, 1.0, 2.0], &[0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, -4.0]);
    for bytes in [file.text(r#"{"name":"foot"}"#), file.binary(r#"{"name":"foot"}"#)] {
        let read = Gltf::read(&bytes).unwrap();
        assert_eq!((read.node("foot"), read.animation("dance"), read.node("hand")), (Some(0), Some(0), None));
        let motion = read.motion(0, 0).unwrap();
        let lines = Linear::new(&[0.5, 1.0, 2.0], &[[0.0; 3], [1.0, 2.0, 0.0], [1.0, 2.0, -4.0]]).unwrap();
        for k in 0..50 {
            let t = 0.05 * f64::from(k);
            for side in [Side::Before, Side::After] {
                assert_eq!(at(&motion, t, side), at(&lines, t, side));
            }
        }
        assert_eq!(kinks(&motion, 9.0), [0.5, 1.0, 2.0]);
        assert_eq!(motion.duration(), 2.0);
        let rest = |t| Motion::<f64, 3>::rest_until(&motion, t);
        assert_eq!([0.0, 0.5, 1.9, 2.0].map(rest), [0.5, 0.5, 1.9, f64::INFINITY]);
    }
}

#[test]
fn nodes_rest_where_no_channel_moves_them() {
    let mut file = Writer::default();
    // Stays, moves and stays; jumps at 3 s only; turns from 4 s to 5 s.
    let stays = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    file.channel(0, "translation", "LINEAR", &[0.0, 1.0, 2.0, 6.0], &stays);
    file.channel(0, "scale", "STEP", &[0.0, 2.5, 3.0, 6.0], &[1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 1.0, 1.0]);
    file.channel(1, "rotation", "LINEAR", &[4.0, 5.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let nodes = r#"{"children":[1]},{"translation":[1,0,0],"children":[2]},{"translation":[0,1,0]},{"translation":[0,9,0]}"#;
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    let rest = |motion: &NodeMotion, t| Motion::<f64, 3>::rest_until(motion, t);
    let (parent, child) = (read.motion(0, 0).unwrap(), read.motion(0, 2).unwrap());
    let times = [-1.0, 0.5, 1.0, 1.5, 2.0, 2.7, 3.0, 4.5, 5.0, 6.0];
    assert_eq!(
        times.map(|t| rest(&parent, t)),
        [1.0, 1.0, 1.0, 1.5, 3.0, 3.0, f64::INFINITY, f64::INFINITY, f64::INFINITY, f64::INFINITY]
    );
    assert_eq!(times.map(|t| rest(&child, t)), [1.0, 1.0, 1.0, 1.5, 3.0, 3.0, 4.0, 4.5, f64::INFINITY, f64::INFINITY]);
    // Whatever is said to rest has one position, both sides of every key included.
    let looped = child.clone().looped().unwrap();
    for motion in [parent, child, looped.clone()] {
        for k in -50..200 {
            let t = 0.1 * f64::from(k) + 0.01;
            let until = Real::min(rest(&motion, t), t + 20.0);
            for share in [0.0, 0.3, 0.99, 1.0 - 1e-14] {
                assert_eq!(
                    at(&motion, t + share * (until - t), Side::After).position,
                    at(&motion, t, Side::After).position,
                    "{t}"
                );
            }
        }
    }
    assert!((rest(&looped, 8.2) - 9.0).abs() < 1e-12 && (rest(&looped, 11.5) - 12.0).abs() < 1e-12);
    assert_eq!(rest(&read.motion(0, 3).unwrap().looped().unwrap(), 1.0), f64::INFINITY);
}

/// A rod of two metres turned about z by a quarter turn in a second, the shorter way round although the signs differ.
#[test]
fn a_turning_parent_carries_its_child_on_a_circle() {
    let half = 0.5f32.sqrt();
    let mut file = Writer::default();
    file.channel(0, "rotation", "LINEAR", &[0.0, 1.0, 2.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -half, -half, 0.0, 0.0, 1.0, 0.0]);
    let bytes = file.binary(r#"{"children":[1]},{"translation":[2,0,0]}"#);
    let motion = Gltf::read(&bytes).unwrap().motion(0, 1).unwrap();
    let speed = core::f64::consts::FRAC_PI_2;
    for k in 1..20 {
        let t = 0.1 * f64::from(k);
        let (sin, cos) = Real::sin_cos(speed * t);
        let sample = at(&motion, t, Side::After);
        // The key of single precision turns by π/2 within 10⁻⁷.
        close(sample.position, [2.0 * cos, 2.0 * sin, 0.0], 3e-7);
        close(sample.velocity, [-2.0 * speed * sin, 2.0 * speed * cos, 0.0], 1e-6);
        close(sample.acceleration, [-2.0 * speed * speed * cos, -2.0 * speed * speed * sin, 0.0], 1e-6);
    }
    // No jump at the key in the middle, where the speed stays the same.
    assert_eq!(kinks(&motion, 9.0), [0.0, 2.0]);
}

/// Three nodes, all channels and interpolations and a matrix.
fn dancer() -> (Writer, &'static str) {
    let mut file = Writer::default();
    let quaternion = |axis: [f32; 3], angle: f32| {
        let (sin, cos) = Real::sin_cos(f64::from(angle) / 2.0);
        [axis[0] * sin as f32, axis[1] * sin as f32, axis[2] * sin as f32, cos as f32]
    };
    let turns = [quaternion([0.6, 0.0, 0.8], 0.3), quaternion([0.0, 1.0, 0.0], 1.4), quaternion([0.0, 0.6, -0.8], 2.0)];
    let mut curved = Vec::new();
    for (key, turn) in turns.iter().enumerate() {
        let tangent = [0.3 - key as f32, 0.2, 0.5 * key as f32, -0.4];
        curved.extend(tangent.iter().chain(turn).chain(&tangent));
    }
    let curve: Vec<f32> = (0..27).map(|k| ((7 * k) % 11) as f32 * 0.2 - 1.0).collect();
    let grow = [1.0, 1.0, 1.0, 2.0, 1.5, 0.5, 1.0, 0.5, 1.25];
    file.channel(0, "translation", "CUBICSPLINE", &[0.0, 0.5, 2.0], &curve);
    file.channel(0, "rotation", "LINEAR", &[0.25, 1.0, 1.75], &turns.concat());
    file.channel(1, "scale", "LINEAR", &[0.0, 1.0, 2.0], &grow);
    file.channel(1, "rotation", "CUBICSPLINE", &[0.0, 0.75, 2.0], &curved);
    file.channel(3, "translation", "STEP", &[0.0, 1.25, 1.5], &[1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let nodes = r#"{"name":"hips","children":[1]},
        {"name":"spine","translation":[0.1,1,0],"children":[2]},
        {"name":"neck","matrix":[1,0,0,0, 0.25,2,0,0, 0,0,1,0, 0,0.5,0,1],"children":[3]},
        {"name":"head","rotation":[0,0,0,1]}"#;
    (file, nodes)
}

#[test]
fn derivatives_are_those_of_the_position() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    for node in 0..4 {
        let motion = read.motion(0, node).unwrap();
        for k in 0..200 {
            let t = 0.0053 + 0.01 * f64::from(k);
            let h = 1e-3;
            if kinks(&motion, 9.0).iter().any(|kink| (kink - t).abs() < 2.5 * h) {
                continue;
            }
            let x = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(&motion, t + k * h, Side::After).position);
            let sample = at(&motion, t, Side::After);
            // Central differences of fourth order.
            let first = |d: usize| (x[0][d] - 8.0 * x[1][d] + 8.0 * x[3][d] - x[4][d]) / (12.0 * h);
            let second = |d: usize| (-x[0][d] + 16.0 * x[1][d] - 30.0 * x[2][d] + 16.0 * x[3][d] - x[4][d]) / (12.0 * h * h);
            close(sample.velocity, [0, 1, 2].map(first), 1e-8);
            close(sample.acceleration, [0, 1, 2].map(second), 1e-6);
            for orders in [Orders::NONE, Orders::POSITION, Orders::VELOCITY, Orders::POSITION.and(Orders::ACCELERATION)] {
                let some: Sample<f64, 3> = motion.sample(Time::new(t), Side::After, orders);
                let kept = |wanted: Orders, value: [f64; 3]| if orders.contains(wanted) { value } else { [0.0; 3] };
                assert_eq!(some.position, kept(Orders::POSITION, sample.position));
                assert_eq!(some.velocity, kept(Orders::VELOCITY, sample.velocity));
                assert_eq!(some.acceleration, kept(Orders::ACCELERATION, sample.acceleration));
            }
        }
    }
}

/// The same hierarchy as products of matrices.
#[test]
fn positions_are_those_of_matrices() {
    let mut file = Writer::default();
    let turns = [[0.0f32, 0.0, 0.0, 1.0], [0.48, 0.6, 0.0, 0.64]];
    file.channel(0, "rotation", "LINEAR", &[0.0, 1.0], &turns.concat());
    file.channel(1, "rotation", "LINEAR", &[0.0, 1.0], &[turns[1], turns[0]].concat());
    file.channel(1, "scale", "LINEAR", &[0.0, 1.0], &[1.0, 1.0, 1.0, 3.0, 0.5, 2.0]);
    let nodes = r#"{"children":[1],"translation":[1,2,3]},{"children":[2],"translation":[0,1,0]},{"translation":[0.5,0,-1]}"#;
    let motion = Gltf::read(&file.text(nodes)).unwrap().motion(0, 2).unwrap();
    let wide = turns.map(|[x, y, z, w]| {
        UnitQuaternion::from_quaternion(Quaternion::new(f64::from(w), f64::from(x), f64::from(y), f64::from(z)))
    });
    for k in 0..=10 {
        let t = f64::from(k) / 10.0;
        let place = |x: [f64; 3]| Matrix4::new_translation(&Vector3::from(x));
        let scale = Matrix4::new_nonuniform_scaling(&Vector3::new(1.0 + 2.0 * t, 1.0 - 0.5 * t, 1.0 + t));
        let outer = place([1.0, 2.0, 3.0]) * wide[0].slerp(&wide[1], t).to_homogeneous();
        let inner = place([0.0, 1.0, 0.0]) * wide[1].slerp(&wide[0], t).to_homogeneous() * scale;
        let expected = outer * inner * nalgebra::Vector4::new(0.5, 0.0, -1.0, 1.0);
        close(at(&motion, t, Side::Before).position, [expected[0], expected[1], expected[2]], 1e-12);
    }
}

#[test]
fn kinks_stand_where_something_jumps() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    let motion = read.motion(0, 3).unwrap();
    // The step at 1.25 s leaves the value as it is; the scale's middle key bends.
    assert_eq!(kinks(&motion, 9.0), [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 1.75, 2.0]);
    let [before, after] = [Side::Before, Side::After].map(|side| at(&motion, 1.5, side).position);
    assert!(0.5 < (0..3).map(|d| (before[d] - after[d]).abs()).sum::<f64>());
    // Between kinks neither side differs.
    assert_eq!(at(&motion, 1.3, Side::Before), at(&motion, 1.3, Side::After));
}

#[test]
fn a_loop_repeats_and_its_seam_is_a_kink_unless_smooth() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    let (once, looped) = (read.motion(0, 3).unwrap(), read.motion(0, 3).unwrap().looped().unwrap());
    for k in 0..40 {
        let t = 0.05 * f64::from(k) + 0.01;
        for turn in [-3.0, 0.0, 1.0, 1000.0] {
            let (a, b) = (at(&once, t, Side::After), at(&looped, t + 2.0 * turn, Side::After));
            close(a.position, b.position, 1e-10);
            close(a.acceleration, b.acceleration, 1e-8);
        }
    }
    assert_eq!(kinks(&looped, 2.5), [-0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 1.75, 2.0, 2.25, 2.5]);
    for (kink, period) in [(0.75, 0.0), (0.75, 2.0 * 777.0), (1.5, 2.0 * 333.0), (0.0, 20.0)] {
        let [a, b] = [Side::Before, Side::After].map(|side| at(&looped, kink + period, side));
        let before = if kink == 0.0 { 2.0 } else { kink };
        assert_eq!((a, b), (at(&once, before, Side::Before), at(&once, kink, Side::After)));
    }
    // A full turn in four quarters has no seam.
    let half = 0.5f32.sqrt();
    let mut wheel = Writer::default();
    let keys =
        [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, half, -half], [0.0, 0.0, 0.0, -1.0]];
    wheel.channel(0, "rotation", "LINEAR", &[0.0, 1.0, 2.0, 3.0, 4.0], &keys.concat());
    let rim = Gltf::read(&wheel.text(r#"{"children":[1]},{"translation":[1,0,0]}"#)).unwrap().motion(0, 1).unwrap();
    assert_eq!(kinks(&rim.looped().unwrap(), 30.0), [0.0f64; 0]);
}

#[test]
fn a_plane_sees_two_directions() {
    let (file, nodes) = dancer();
    let motion = Gltf::read(&file.binary(nodes)).unwrap().motion(0, 2).unwrap();
    let space = at(&motion, 0.6, Side::After);
    let seen = Projected::new(motion, [[0.0, 0.0, -0.01], [0.0, 0.01, 0.0]]);
    let plane: Sample<f64, 2> = seen.sample(Time::new(0.6), Side::After, Orders::ALL);
    assert_eq!(plane.position, [-0.01 * space.position[2], 0.01 * space.position[1]]);
    assert_eq!(plane.acceleration, [-0.01 * space.acceleration[2], 0.01 * space.acceleration[1]]);
    assert_eq!(Motion::<f64, 2>::next_kink(&seen, 0.3), Some(0.5));
}

/// Shorts that stand for fractions, with gaps between them; and a sparse accessor over nothing.
#[test]
fn packed_and_sparse_numbers_are_read() {
    let mut bytes: Vec<u8> = [0.0f32, 1.0].iter().flat_map(|time| time.to_le_bytes()).collect();
    for [x, y, z, w] in [[0i16, 0, 0, 32767], [0, 0, 32767, 0]] {
        bytes.extend([x, y, z, w, 77, 77].iter().flat_map(|part| part.to_le_bytes()));
    }
    bytes.extend([1u8, 0, 0, 0]);
    bytes.extend([5.0f32, 6.0, 7.0].iter().flat_map(|part| part.to_le_bytes()));
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"children":[1]}},{{"translation":[1,0,0]}}],
        "buffers":[{{"byteLength":{},"uri":"data:;base64,{}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":8}},{{"buffer":0,"byteOffset":8,"byteLength":24,"byteStride":12}},
            {{"buffer":0,"byteOffset":32,"byteLength":1}},{{"buffer":0,"byteOffset":36,"byteLength":12}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR"}},
            {{"bufferView":1,"componentType":5122,"normalized":true,"count":2,"type":"VEC4"}},
            {{"componentType":5126,"count":2,"type":"VEC3","sparse":{{"count":1,
                "indices":{{"bufferView":2,"componentType":5121}},"values":{{"bufferView":3}}}}}}],
        "animations":[{{"samplers":[{{"input":0,"output":1}},{{"input":0,"output":2}}],
            "channels":[{{"sampler":0,"target":{{"node":0,"path":"rotation"}}}},
                {{"sampler":1,"target":{{"node":0,"path":"translation"}}}}]}}]}}"#,
        bytes.len(),
        base64(&bytes)
    );
    let motion = Gltf::read(json.as_bytes()).unwrap().motion(0, 1).unwrap();
    close(at(&motion, 0.0, Side::After).position, [1.0, 0.0, 0.0], 1e-15);
    close(at(&motion, 1.0, Side::Before).position, [4.0, 6.0, 7.0], 1e-15);
    close(at(&motion, 0.5, Side::Before).position, [2.5, 4.0, 3.5], 1e-15);
}

#[test]
fn errors_say_what_and_where() {
    let (file, nodes) = dancer();
    let message = |bytes: &[u8]| match Gltf::read(bytes) {
        Err(error) => error.to_string(),
        Ok(read) => (0..4).find_map(|node| read.motion(0, node).err()).map_or_else(|| "fine".into(), |error| error.to_string()),
    };
    let binary = file.binary(nodes);
    assert_eq!(message(&binary), "fine");
    let cut = message(&binary[..binary.len() - 10]);
    assert!(cut.starts_with("header: the header does not fit the"), "{cut}");
    let text = String::from_utf8(file.text(nodes)).unwrap();
    let changes = [
        ("", "}", "text: trailing characters at line"),
        (r#""version":"2.0""#, r#""version":"1.0""#, "asset.version: version `1.0`"),
        (r#""path":"scale""#, r#""path":"colour""#, "animations[0]: channels[2]: an unknown target path"),
        (r#""sampler":2"#, r#""sampler":9"#, "animations[0]: channels[2]: samplers[9]: does not exist"),
        (r#""input":4"#, r#""input":99"#, "animations[0]: samplers[2].input: accessors[99]: does not exist"),
        (r#""input":4"#, r#""input":5"#, "accessors[5]: elements of 3 numbers where 1 are needed"),
        (r#""count":9"#, r#""count":8"#, "samplers[0]: 3 times but 8 values; 3 a time are needed"),
        (r#""count":3,"type":"SCALAR""#, r#""count":4,"type":"SCALAR""#, "go beyond the 12 bytes of bufferViews[0]"),
        (r#""byteOffset":12,"byteLength""#, r#""byteOffset":99999,"byteLength""#, "bufferViews[1] goes beyond the"),
        (r#""interpolation":"STEP""#, r#""interpolation":"JUMP""#, "samplers[4]: an unknown interpolation"),
        (r#""children":[3]"#, r#""children":[0]"#, "nodes[0]: it is a parent of itself"),
        (r#""children":[3]"#, r#""children":[7]"#, "nodes[2].children: nodes[7] does not exist"),
        (r#""children":[3]"#, r#""children":[1]"#, "nodes[1] is a child of nodes[0] too"),
        ("[0,0,0,1]", "[0,0,0,0]", "nodes[3]: its rotation is no unit quaternion"),
        ("[0.1,1,0]", "[1e39,1,0]", "nodes[1]: a number that is infinite or none"),
        ("0,0.5,0,1]", "0,0.5,0,2]", "nodes[2]: its matrix is no affine map"),
        (r#""node":3"#, r#""node":2"#, "nodes[2]: it is animated, but stands on its parent by a matrix"),
        ("data:application/octet-stream;base64,", "data:application/octet-stream,", "buffers[0]: a data URI that is not base64"),
        ("data:application/octet-stream;base64,", "dance.bin?", "buffers[0]: its bytes are in the file `dance.bin?"),
    ];
    for (from, to, expected) in changes {
        let changed = if from.is_empty() { format!("{text}{to}") } else { text.replacen(from, to, 1) };
        assert_ne!(changed, text, "{from}");
        let message = message(changed.as_bytes());
        assert!(message.contains(expected), "`{message}` does not contain `{expected}`");
    }
    let read = Gltf::read(&binary).unwrap();
    assert_eq!(read.motion(0, 4).unwrap_err().to_string(), "nodes[4]: does not exist; ask for the number of a name");
    assert_eq!(read.motion(1, 0).unwrap_err().to_string(), "animations[1]: does not exist; ask for the number of a name");
}

/// Times that stand still, numbers that are none, quaternions that vanish on their way.
#[test]
fn impossible_keys_are_refused() {
    let message = |path: &str, interpolation: &str, times: &[f32], values: &[f32]| {
        let mut file = Writer::default();
        file.channel(0, path, interpolation, times, values);
        Gltf::read(&file.binary("{}")).unwrap().motion(0, 0).unwrap_err().to_string()
    };
    let still = message("translation", "LINEAR", &[1.0, 1.0], &[0.0; 6]);
    assert!(still.contains("channels[0]: samplers[0]: key 1 at 1 s is not later"), "{still}");
    let early = message("translation", "LINEAR", &[-1.0, 1.0], &[0.0; 6]);
    assert!(early.contains("key 0 at -1 s lies before the beginning"), "{early}");
    let empty = message("translation", "LINEAR", &[], &[]);
    assert!(empty.contains("at least one key"), "{empty}");
    let none = message("translation", "STEP", &[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0]);
    assert!(none.contains("key 1 is infinite or no number"), "{none}");
    let mut through = [0.0; 24];
    (through[7], through[19]) = (1.0, -1.0);
    let vanishes = message("rotation", "CUBICSPLINE", &[0.0, 1.0], &through);
    assert!(vanishes.contains("output: the quaternion vanishes between key 0 and key 1"), "{vanishes}");
    let zero = message("rotation", "STEP", &[0.0], &[0.0; 4]);
    assert!(zero.contains("output: key 0 is no unit quaternion"), "{zero}");
}

/// Counts that the bytes do not bear out, and few bytes that many nodes name: refused before anything is made room for.
#[test]
fn what_lies_about_its_size_is_refused() {
    let sparse = r#""sparse":{"count":0,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}"#;
    for count in [65_537, 4_294_967_296, u64::MAX] {
        for (extra, expected) in [(r#""bufferView":0"#, "go beyond the"), (sparse, "elements without a bufferView")] {
            let accessor = |kind: &str| format!(r#"{{{extra},"componentType":5126,"count":{count},"type":"{kind}"}}"#);
            let json = format!(
                r#"{{"asset":{{"version":"2.0"}},"nodes":[{{}}],"buffers":[{{"byteLength":6,"uri":"data:;base64,AAAAAAAA"}}],
                "bufferViews":[{{"buffer":0,"byteLength":6}}],"accessors":[{},{}],"animations":[{{"samplers":[{{"input":0,"output":1}}],
                "channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}]}}]}}"#,
                accessor("SCALAR"),
                accessor("VEC3")
            );
            let message = Gltf::read(json.as_bytes()).unwrap().motion(0, 0).unwrap_err().to_string();
            assert!(message.contains("samplers[0].input: accessors[0]: ") && message.contains(expected), "{message}");
        }
    }
    // A thousand nodes, each on the one before, all moved by the same fifty thousand keys.
    let mut file = Writer::default();
    let times: Vec<f32> = (0..50_000u16).map(f32::from).collect();
    file.channel(0, "translation", "LINEAR", &times, &vec![0.5; 150_000]);
    for node in 1..1000 {
        write!(file.channels, r#",{{"sampler":0,"target":{{"node":{node},"path":"translation"}}}}"#).unwrap();
    }
    let nodes: Vec<String> = (1..1000).map(|child| format!(r#"{{"children":[{child}]}}"#)).collect();
    let read = Gltf::read(&file.binary(&format!("{},{{}}", nodes.join(",")))).unwrap();
    let message = read.motion(0, 999).unwrap_err().to_string();
    assert!(message.contains("more than 16777216 keys in one motion"), "{message}");
    assert_eq!(at(&read.motion(0, 9).unwrap(), 7.0, Side::After).position, [5.0; 3]);
}

#[test]
fn files_beside_the_file_are_found() {
    let (file, nodes) = dancer();
    let folder = std::env::temp_dir().join(format!("pendulum-gltf-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("dance.gltf");
    std::fs::write(&path, file.json(nodes, r#","uri":"the%20steps.bin""#)).unwrap();
    let missing = Gltf::open(&path).unwrap_err().to_string();
    assert!(missing.contains("dance.gltf: buffers[0]: `the%20steps.bin`: "), "{missing}");
    std::fs::write(folder.join("the steps.bin"), &file.bytes).unwrap();
    let inside = Gltf::read(&file.binary(nodes)).unwrap().motion(0, 3).unwrap();
    assert_eq!(Gltf::open(&path).unwrap().motion(0, 3).unwrap(), inside);
    std::fs::write(folder.join("the steps.bin"), &file.bytes[..9]).unwrap();
    let cut = Gltf::open(&path).unwrap_err().to_string();
    assert!(cut.contains("buffers[0]: 9 bytes of"), "{cut}");
    std::fs::write(&path, file.json(nodes, r#","uri":"/dev/zero""#)).unwrap();
    assert!(Gltf::open(&path).unwrap_err().to_string().contains("`/dev/zero` is no relative path"));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Ten thousand files with wrong bytes, and every shorter one: an error or finite numbers, never a panic.
#[test]
fn wrong_bytes_never_panic() {
    let (file, nodes) = dancer();
    let mut random = Random::new(11);
    let [mut refused, mut taken] = [0, 0];
    let mut probe = |bytes: &[u8]| {
        let Ok(read) = Gltf::read(bytes) else {
            refused += 1;
            return;
        };
        taken += 1;
        for node in 0..read.nodes().count() {
            for animation in 0..read.animations().count() {
                let Ok(motion) = read.motion(animation, node) else { continue };
                for t in [0.0, 0.7, 1.5, 3.0] {
                    let sample = at(&motion, t, Side::Before);
                    assert!(sample.position.iter().all(|value| !value.is_nan()), "{sample:?}");
                }
                if let Ok(looped) = motion.looped() {
                    let _ = (at(&looped, 5.3, Side::After), Motion::<f64, 3>::next_kink(&looped, 5.3));
                }
            }
        }
    };
    for original in [file.binary(nodes), file.text(nodes)] {
        for _ in 0..5000 {
            let mut bytes = original.clone();
            for _ in 0..=random.bits() % 3 {
                let place = (random.unit() * bytes.len() as f64) as usize;
                // A number becomes another more often than nonsense.
                let digit = bytes[place].is_ascii_digit() && !random.bits().is_multiple_of(8);
                bytes[place] = if digit { b'0' + (random.bits() % 10) as u8 } else { random.bits() as u8 };
            }
            probe(&bytes);
        }
        for length in 0..original.len() {
            probe(&original[..length]);
        }
    }
    assert!(1000 < refused && 1000 < taken, "{refused} {taken}");
}
