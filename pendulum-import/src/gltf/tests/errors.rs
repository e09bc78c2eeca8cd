//! Tests of errors: damaged files, invalid keys, wrong sizes and wrong bytes.

use super::writer::Writer;
use super::{at, dancer};
use crate::gltf::Gltf;
use crate::random::Random;
use pendulum_core::motion::{Derivatives, Motion, Sample, Side, Still};
use pendulum_core::time::Time;
use std::fmt::Write;

#[test]
fn errors_say_what_and_where() {
    let (file, nodes) = dancer();
    let message = |bytes: &[u8]| match Gltf::read(bytes) {
        Err(error) => error.to_string(),
        Ok(read) => (0..4)
            .find_map(|node| read.motion(0, node).err())
            .map_or_else(|| "fine".into(), |error| error.to_string()),
    };
    let binary = file.binary(nodes);
    assert_eq!(message(&binary), "fine");
    let cut = message(&binary[..binary.len() - 10]);
    assert!(cut.starts_with("header: the header does not fit the"), "{cut}");
    let text = String::from_utf8(file.text(nodes)).unwrap();
    let changes = [
        ("", "}", "text: trailing characters at line"),
        (r#""version":"2.0""#, r#""version":"1.0""#, "asset.version: version `1.0`"),
        (
            r#""path":"scale""#,
            r#""path":"colour""#,
            "animations[0]: channels[2]: an unknown target path",
        ),
        (
            r#""sampler":2"#,
            r#""sampler":9"#,
            "animations[0]: channels[2]: samplers[9]: does not exist",
        ),
        (
            r#""input":4"#,
            r#""input":99"#,
            "animations[0]: samplers[2].input: accessors[99]: does not exist",
        ),
        (r#""input":4"#, r#""input":5"#, "accessors[5]: elements of 3 numbers where 1 are needed"),
        (r#""count":9"#, r#""count":8"#, "samplers[0]: 3 times but 8 values; 3 a time are needed"),
        (
            r#""count":3,"type":"SCALAR""#,
            r#""count":4,"type":"SCALAR""#,
            "go beyond the 12 bytes of bufferViews[0]",
        ),
        (
            r#""byteOffset":12,"byteLength""#,
            r#""byteOffset":99999,"byteLength""#,
            "bufferViews[1] goes beyond the",
        ),
        (
            r#""interpolation":"STEP""#,
            r#""interpolation":"JUMP""#,
            "samplers[4]: an unknown interpolation",
        ),
        (r#""children":[3]"#, r#""children":[0]"#, "nodes[0]: it is a parent of itself"),
        (r#""children":[3]"#, r#""children":[7]"#, "nodes[2].children: nodes[7] does not exist"),
        (r#""children":[3]"#, r#""children":[1]"#, "nodes[1] is a child of nodes[0] too"),
        ("[0,0,0,1]", "[0,0,0,0]", "nodes[3]: its rotation is no unit quaternion"),
        ("[0.1,1,0]", "[1e39,1,0]", "nodes[1]: a number that is infinite or none"),
        ("0,0.5,0,1]", "0,0.5,0,2]", "nodes[2]: its matrix is no affine map"),
        (
            r#""node":3"#,
            r#""node":4"#,
            "animations[0]: channels[4]: its target nodes[4] does not exist; mend the file or export it again",
        ),
        (
            r#""node":3"#,
            r#""node":2"#,
            "nodes[2]: it is animated, but stands on its parent by a matrix",
        ),
        (
            r#""node":1,"path":"rotation""#,
            r#""node":0,"path":"rotation""#,
            "animations[0]: channels[3]: channels[1] moves the rotation of nodes[0] too",
        ),
        (r#""target":{"node":3"#, r#""goal":{"node":3"#, "channels[4]: its `target` is missing"),
        (
            "data:application/octet-stream;base64,",
            "data:application/octet-stream,",
            "buffers[0]: a data URI that is not base64",
        ),
        (
            "data:application/octet-stream;base64,",
            "dance.bin?",
            "buffers[0]: its bytes are in the file `dance.bin?",
        ),
    ];
    for (from, to, expected) in changes {
        let changed =
            if from.is_empty() { format!("{text}{to}") } else { text.replacen(from, to, 1) };
        assert_ne!(changed, text, "{from}");
        let message = message(changed.as_bytes());
        assert!(message.contains(expected), "`{message}` does not contain `{expected}`");
    }
    let read = Gltf::read(&binary).unwrap();
    assert_eq!(
        read.motion(0, 4).unwrap_err().to_string(),
        "nodes[4]: does not exist; ask for the number of a name"
    );
    assert_eq!(
        read.motion(1, 0).unwrap_err().to_string(),
        "animations[1]: does not exist; ask for the number of a name"
    );
}

/// Times that do not increase, invalid numbers, and quaternions that vanish between keys.
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
    assert!(empty.contains("the number of keys is 0"), "{empty}");
    let none = message("translation", "STEP", &[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0]);
    assert!(none.contains("key 1 is infinite or no number"), "{none}");
    let mut through = [0.0; 24];
    (through[7], through[19]) = (1.0, -1.0);
    let vanishes = message("rotation", "CUBICSPLINE", &[0.0, 1.0], &through);
    assert!(
        vanishes.contains("output: the quaternion vanishes between key 0 and key 1"),
        "{vanishes}"
    );
    let zero = message("rotation", "STEP", &[0.0], &[0.0; 4]);
    assert!(zero.contains("output: key 0 is no unit quaternion"), "{zero}");
}

/// Counts beyond the existing bytes, and few bytes used by many nodes, are rejected before memory
/// is allocated.
#[test]
fn what_lies_about_its_size_is_refused() {
    let sparse = r#""sparse":{"count":0,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}"#;
    for count in [65_537, 4_294_967_296, u64::MAX] {
        for (extra, expected) in
            [(r#""bufferView":0"#, "go beyond the"), (sparse, "elements without a bufferView")]
        {
            let accessor = |kind: &str| {
                format!(r#"{{{extra},"componentType":5126,"count":{count},"type":"{kind}"}}"#)
            };
            let json = format!(
                r#"{{"asset":{{"version":"2.0"}},"nodes":[{{}}],"buffers":[{{"byteLength":6,"uri":"data:;base64,AAAAAAAA"}}],
                "bufferViews":[{{"buffer":0,"byteLength":6}}],"accessors":[{},{}],"animations":[{{"samplers":[{{"input":0,"output":1}}],
                "channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}]}}]}}"#,
                accessor("SCALAR"),
                accessor("VEC3")
            );
            let message =
                Gltf::read(json.as_bytes()).unwrap().motion(0, 0).unwrap_err().to_string();
            assert!(
                message.contains("samplers[0].input: accessors[0]: ") && message.contains(expected),
                "{message}"
            );
        }
    }
    // A thousand nodes, each a child of the one before, all with the same fifty thousand keys.
    let mut file = Writer::default();
    let times: Vec<f32> = (0..50_000u16).map(f32::from).collect();
    file.channel(0, "translation", "LINEAR", &times, &vec![0.5; 150_000]);
    for node in 1..1000 {
        write!(
            file.channels,
            r#",{{"sampler":0,"target":{{"node":{node},"path":"translation"}}}}"#
        )
        .unwrap();
    }
    let nodes: Vec<String> =
        (1..1000).map(|child| format!(r#"{{"children":[{child}]}}"#)).collect();
    let read = Gltf::read(&file.binary(&format!("{},{{}}", nodes.join(",")))).unwrap();
    let message = read.motion(0, 999).unwrap_err().to_string();
    assert!(message.contains("more than 16777216 keys in one motion"), "{message}");
    assert_eq!(at(&read.motion(0, 9).unwrap(), 7.0, Side::After).position, [5.0; 3]);
}

/// Ten thousand files with wrong bytes, and all shortened files, result in errors or finite
/// numbers, never in a panic.
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
        if taken % 8 == 0 {
            let mut bake = read.bake("still", 0.002);
            let child = bake.under(0).add("child", Some(3));
            let written = bake.orientation(3, Still::new([0.6, 0.0, 0.8, 0.0]));
            let written = written.position(child, Still::new([1.0; 3])).write();
            assert!(written.map_or(true, |bytes| Gltf::read(&bytes).is_ok()));
        }
        for node in 0..read.nodes().count() {
            for animation in 0..read.animations().count() {
                if let Ok(turns) = read.orientation(animation, node) {
                    let sample: Sample<f64, 4> =
                        turns.sample(Time::new(0.7), Side::Before, Derivatives::POSITION);
                    assert!(sample.position.iter().all(|value| !value.is_nan()), "{sample:?}");
                }
                let Ok(motion) = read.motion(animation, node) else { continue };
                for t in [0.0, 0.7, 1.5, 3.0] {
                    let sample = at(&motion, t, Side::Before);
                    assert!(sample.position.iter().all(|value| !value.is_nan()), "{sample:?}");
                }
                if let Ok(looped) = motion.looped() {
                    let _ =
                        (at(&looped, 5.3, Side::After), Motion::<f64, 3>::next_kink(&looped, 5.3));
                }
            }
        }
    };
    for original in [file.binary(nodes), file.text(nodes)] {
        for _ in 0..5000 {
            let mut bytes = original.clone();
            for _ in 0..=random.bits() % 3 {
                let place = random.bits() as usize % bytes.len();
                // Digits are usually replaced by digits.
                let digit = bytes[place].is_ascii_digit() && !random.bits().is_multiple_of(8);
                bytes[place] =
                    if digit { b'0' + (random.bits() % 10) as u8 } else { random.bits() as u8 };
            }
            probe(&bytes);
        }
        for length in 0..original.len() {
            probe(&original[..length]);
        }
    }
    assert!(1000 < refused && 1000 < taken, "{refused} {taken}");
}

#[test]
fn names_that_there_are_are_listed() {
    let (file, nodes) = dancer();
    let read = Gltf::read(&file.binary(nodes)).unwrap();
    let names: Vec<&str> = read.nodes().filter(|name| !name.is_empty()).collect();
    let message = read.node("nobody").unwrap_err().to_string();
    assert!(message.starts_with("nodes: none is called `nobody`"), "{message}");
    for name in &names {
        assert!(message.contains(&format!("`{name}`")), "{message}");
        assert!(read.node(name).is_ok());
    }
    assert!(read.animation("nothing").unwrap_err().to_string().contains("animations: none"));
}
