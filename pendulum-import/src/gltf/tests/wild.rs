//! Tests of what real files have: members that other readers trip over, and parts that are broken
//! but not needed.

use super::writer::{Writer, base64};
use super::{at, close, dancer};
use crate::gltf::{Gltf, GltfError, NodeMotion};
use pendulum_core::motion::Side;

/// Reads the motion of the last node of the dancer.
fn danced(text: &[u8]) -> Result<NodeMotion, GltfError> {
    let read = Gltf::read(text)?;
    read.motion(read.animation("dance")?, 3)
}

/// Returns a .glb file of these chunks.
fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let length = |bytes: usize| u32::try_from(bytes).unwrap().to_le_bytes();
    let chunks: Vec<u8> = chunks
        .iter()
        .flat_map(|(kind, bytes)| [&length(bytes.len()), &kind[..], bytes].concat())
        .collect();
    [&b"glTF"[..], &2u32.to_le_bytes(), &length(12 + chunks.len()), &chunks].concat()
}

/// Each change leaves the motion as it is.
#[test]
fn what_moves_nothing_does_not_matter() {
    let (file, nodes) = dancer();
    let text = String::from_utf8(file.text(nodes)).unwrap();
    let plain = danced(text.as_bytes()).unwrap();
    let root = r#""nodes":["#;
    let channel = r#""channels":["#;
    let changes = [
        // Channels of extensions.
        (channel, r#""channels":[{"sampler":0,"target":{"path":"pointer"}},"#),
        (
            channel,
            r#""channels":[{"sampler":1,"target":{"path":"pointer","extensions":
            {"KHR_animation_pointer":{"pointer":"/nodes/3/weights/0"}}}},"#,
        ),
        (channel, r#""channels":[{"sampler":77,"target":{"node":null,"path":"pointer"}},"#),
        // Extras of any type, anywhere.
        (root, r#""extras":"text","nodes":["#),
        (root, r#""extras":[1,{"a":null}],"nodes":["#),
        (r#""version":"2.0""#, r#""version":"2.0","extras":7"#),
        (r#"{"name":"hips""#, r#"{"extras":false,"name":"hips""#),
        (r#"{"sampler":2"#, r#"{"extras":null,"sampler":2"#),
        (r#"{"input":4"#, r#"{"extras":[],"input":4"#),
        (r#"{"bufferView":0"#, r#"{"extras":-1.5,"bufferView":0"#),
        (r#"{"buffer":0"#, r#"{"extras":"","buffer":0"#),
        (r#""name":"dance""#, r#""extras":"dance","name":"dance""#),
        // Parts that are broken or unknown, and lists without elements.
        (root, r#""scene":0,"scenes":[{}],"nodes":["#),
        (root, r#""scene":9,"scenes":[],"meshes":[],"skins":[],"nodes":["#),
        (root, r#""scenes":[{"name":null,"nodes":null}],"nodes":["#),
        (root, r#""cameras":[{"type":"fisheye"}],"materials":{"a":1},"nodes":["#),
        (root, r#""meshes":[{"primitives":[{"attributes":{"POSITION":-5},"mode":99}]}],"nodes":["#),
        (root, r#""skins":[{}],"textures":[null],"images":[{"uri":5}],"samplers":null,"nodes":["#),
        (root, r#""extensionsRequired":["KHR_draco_mesh_compression","X_y"],"nodes":["#),
        (root, r#""extensions":{"KHR_lights_punctual":7},"extensionsUsed":null,"nodes":["#),
        (r#"{"name":"hips""#, r#"{"mesh":null,"skin":-1,"camera":"x","weights":{},"name":"hips""#),
        (r#"{"bufferView":0"#, r#"{"min":null,"max":["x"],"name":5,"sparse":null,"bufferView":0"#),
        (r#"{"buffer":0"#, r#"{"target":1,"byteStride":null,"buffer":0"#),
        // An animation is not disturbed by the next.
        (r#""animations":["#, r#""animations":[{"name":7},"#),
        // Schemes in capitals, and lines of base64.
        ("data:application/octet-stream;base64,", r"DATA:;Base64,\n "),
        // Whole numbers.
        (r#""sampler":2"#, r#""sampler":2.0"#),
        (r#""node":3"#, r#""node":3.0"#),
        (r#""componentType":5126"#, r#""componentType":5126.0"#),
        (r#""bufferView":0"#, r#""bufferView":0e0"#),
        (r#""children":[3]"#, r#""children":[3.0]"#),
        (r#""count":3,"type":"SCALAR""#, r#""count":3.0,"type":"SCALAR""#),
        (r#""version":"2.0""#, r#""version":2.0"#),
        (r#""version":"2.0""#, r#""version":"2""#),
    ];
    for (from, to) in changes {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        assert_eq!(danced(changed.as_bytes()), Ok(plain.clone()), "{to}");
    }
}

#[test]
fn pointers_move_nodes_as_channels_do() {
    let (file, nodes) = dancer();
    let text = String::from_utf8(file.text(nodes)).unwrap();
    let plain = danced(text.as_bytes());
    for (node, path) in [(0, "translation"), (0, "rotation"), (1, "scale"), (1, "rotation")] {
        let pointed = |pointer: &str| {
            let target = format!(r#"{{"node":{node},"path":"{path}"}}"#);
            let pointer = format!(
                r#"{{"path":"pointer","extensions":{{"KHR_animation_pointer":{{"pointer":"/nodes/{pointer}"}}}}}}"#
            );
            assert!(text.contains(&target));
            danced(text.replacen(&target, &pointer, 1).as_bytes())
        };
        assert_eq!(pointed(&format!("{node}/{path}")), plain);
        for (wrong, what) in [("9", "nodes[9] does not exist"), ("x", "`x` is no number of a node")]
        {
            let error = pointed(&format!("{wrong}/{path}")).unwrap_err().to_string();
            assert!(
                error.starts_with("animations[0]: channels[") && error.contains(what),
                "{error}"
            );
        }
    }
}

#[test]
fn texts_begin_and_end_as_editors_leave_them() {
    let (file, nodes) = dancer();
    let (text, json) = (file.text(nodes), file.json(nodes, "").into_bytes());
    let plain = danced(&text).unwrap();
    let mark = b"\xef\xbb\xbf";
    let bin = &file.bytes[..];
    for bytes in [
        [&mark[..], &text].concat(),
        [&mark[..], b"\r\n\t ", &text, b"\n\n"].concat(),
        glb(&[(b"JSON", &[mark, &json[..]].concat()), (b"BIN\0", bin)]),
        glb(&[(b"JSON", &[&json[..], b"\0\0\0"].concat()), (b"BIN\0", bin)]),
        glb(&[(b"JSON", &json), (b"LIVE", b"what"), (b"BIN\0", bin), (b"MORE", b"")]),
        // Neither the odd bytes nor the longer chunk matter.
        [&glb(&[(b"JSON", &json), (b"BIN\0", &[bin, &[0; 3]].concat())])[..], b"odd"].concat(),
    ] {
        assert_eq!(danced(&bytes), Ok(plain.clone()));
    }
    let message = |bytes: &[u8]| Gltf::read(bytes).unwrap_err().to_string();
    for empty in [&b""[..], mark, b" \n", &glb(&[(b"JSON", b"  ")])] {
        assert!(message(empty).starts_with("text: it is empty; "), "{}", message(empty));
    }
    assert!(message(&glb(&[(b"BIN\0", bin)])).contains("the first chunk is no JSON"));
    assert!(message(&glb(&[])).contains("there is no JSON chunk"));
    let cut = glb(&[(b"JSON", &json), (b"BIN\0", bin)]);
    let mut longer = cut.clone();
    longer[12 + 8 + json.len() + 2] ^= 0x80;
    assert!(message(&longer).starts_with("chunks: a chunk of "), "{}", message(&longer));
    for (text, what) in [
        (r#"{"nodes":[]}"#, "asset.version: it is missing"),
        ("[]", "asset.version: it is missing"),
        (r#"{"asset":{"version":"1.1"},"nodes":{"a":{}}}"#, "asset.version: version `1.1`"),
        (r#"{"asset":{"version":"2.0"},"nodes":{"a":{}}}"#, "nodes: it is no list"),
        (r#"{"asset":{"version":"2.0"},"nodes":[{"children":3}]}"#, "nodes[0].children: it is no"),
    ] {
        assert!(message(text.as_bytes()).starts_with(what), "{}", message(text.as_bytes()));
    }
}

/// Each file has two animations, of which the first is broken in another way.
#[test]
fn a_broken_animation_does_not_lose_the_others() {
    let (file, nodes) = dancer();
    let text = String::from_utf8(file.text(nodes)).unwrap();
    let plain = danced(text.as_bytes()).unwrap();
    let moved = |sampler: &str| {
        format!(
            r#"{{"samplers":[{sampler}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}]}}"#
        )
    };
    for (broken, what) in [
        ("null".into(), "it has no list of `channels`"),
        ("{}".into(), "it has no list of `channels`"),
        (r#"{"channels":[]}"#.into(), "it has no list of `samplers`"),
        (moved("{}"), "channels[0]: samplers[0]: its `input` is missing"),
        (moved("null"), "channels[0]: samplers[0]: its `input` is missing"),
        (moved(""), "channels[0]: samplers[0]: does not exist"),
        (moved(r#"{"input":0}"#), "channels[0]: samplers[0]: its `output` is missing"),
        (moved(r#"{"input":-1,"output":1}"#), "samplers[0]: its `input` is no whole number"),
        (moved(r#"{"input":0,"output":1,"interpolation":5}"#), "an unknown interpolation"),
        (moved(r#"{"input":99,"output":1}"#), "samplers[0].input: accessors[99]: does not exist"),
        (moved("{}").replace(r#""node":0"#, r#""node":"a""#), "its `node` is no whole number"),
        (moved("{}").replace(r#""sampler":0,"#, ""), "channels[0]: its `sampler` is missing"),
    ] {
        let both = text.replacen(r#""animations":["#, &format!(r#""animations":[{broken},"#), 1);
        assert_eq!(danced(both.as_bytes()), Ok(plain.clone()), "{broken}");
        let message = Gltf::read(both.as_bytes()).unwrap().motion(0, 0).unwrap_err().to_string();
        assert!(message.starts_with("animations[0]: ") && message.contains(what), "{message}");
    }
}

#[test]
fn one_key_is_a_still_motion() {
    let parts = [("LINEAR", 0..1), ("STEP", 0..1), ("CUBICSPLINE", 0..3)];
    for (interpolation, keys) in parts {
        let mut file = Writer::default();
        let [place, turn]: [Vec<f32>; 2] =
            [[1.0, 2.0, 3.0].repeat(keys.len()), [0.0, 0.0, 1.0, 0.0].repeat(keys.len())];
        file.channel(0, "translation", interpolation, &[0.5], &place);
        file.channel(0, "rotation", interpolation, &[0.5], &turn);
        let nodes = r#"{"children":[1]},{"translation":[1,0,0]}"#;
        let motion = Gltf::read(&file.text(nodes)).unwrap().motion(0, 1).unwrap();
        for t in [0.0, 0.5, 9.0] {
            let sample = at(&motion, t, Side::After);
            close(sample.position, [0.0, 2.0, 3.0], 1e-15);
            assert_eq!(sample.velocity, [0.0; 3]);
        }
    }
}

/// The keys of a channel without a node do not count, nor those of a sampler that no channel uses.
#[test]
fn an_animation_lasts_as_long_as_its_nodes_move() {
    let mut file = Writer::default();
    file.channel(0, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    file.channel(1, "translation", "LINEAR", &[0.0, 3.0], &[0.0; 6]);
    let text = String::from_utf8(file.text("{},{}")).unwrap();
    let duration =
        |text: &str| Gltf::read(text.as_bytes()).unwrap().motion(0, 0).unwrap().duration();
    assert_eq!(duration(&text), 3.0);
    assert_eq!(duration(&text.replacen(r#""node":1,"#, "", 1)), 1.0);
}

/// As `gltfpack -c` writes it: a second buffer stands for the decompressed bytes of meshes and has
/// no bytes of its own.
#[test]
fn compressed_meshes_do_not_matter_and_compressed_animations_are_refused() {
    let mut file = Writer::default();
    file.channel(0, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 2.0, 4.0, 8.0]);
    for extension in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let packed = |text: Vec<u8>| {
            let fallback = format!(
                r#","buffers":[{{"byteLength":4096,"extensions":{{"{extension}":{{"fallback":true}}}}}},"#
            );
            let view = format!(
                r#""bufferViews":[{{"buffer":0,"byteLength":4096,"byteStride":12,
                "extensions":{{"{extension}":{{"buffer":1,"byteLength":9,"byteStride":12,"count":9,"mode":"ATTRIBUTES"}}}}}},"#
            );
            let text = String::from_utf8(text).unwrap();
            // The fallback comes first here, so that the numbers of all others grow by one.
            text.replacen(r#","buffers":["#, &fallback, 1)
                .replace(r#"{"buffer":0,"byteOffset""#, r#"{"buffer":1,"byteOffset""#)
                .replacen(r#""bufferViews":["#, &view, 1)
                .replace(r#""bufferView":1"#, r#""bufferView":2"#)
                .replace(r#""bufferView":0"#, r#""bufferView":1"#)
        };
        let text = packed(file.text("{}"));
        let motion = Gltf::read(text.as_bytes()).unwrap().motion(0, 0).unwrap();
        assert_eq!(at(&motion, 0.5, Side::After).position, [1.0, 2.0, 4.0]);
        let needed = text.replace(r#""bufferView":2"#, r#""bufferView":0"#);
        let message = Gltf::read(needed.as_bytes()).unwrap().motion(0, 0).unwrap_err().to_string();
        assert!(
            message
                .contains("samplers[0].output: buffers[0]: its bytes are only there in compress"),
            "{message}"
        );
        // In a .glb file the first buffer is the chunk and the fallback the second.
        let json = file.json("{}", "").replacen(
            r#"}],"bufferViews""#,
            &format!(
                r#"}},{{"byteLength":4096,"extensions":{{"{extension}":{{"fallback":true}}}}}}],"bufferViews""#
            ),
            1,
        );
        let bytes = glb(&[(b"JSON", json.as_bytes()), (b"BIN\0", &file.bytes)]);
        let motion = Gltf::read(&bytes).unwrap().motion(0, 0).unwrap();
        assert_eq!(at(&motion, 0.5, Side::After).position, [1.0, 2.0, 4.0]);
    }
}

/// A buffer that cannot be read is an error of the motions that need it, and of the whole file if
/// there is no other.
#[test]
fn a_missing_buffer_does_not_lose_the_others() {
    let mut file = Writer::default();
    file.channel(0, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 2.0, 4.0, 8.0]);
    for other in [
        r#"{"byteLength":4,"uri":"https://example.org/meshes.bin"}"#,
        r#"{"byteLength":4,"uri":"data:text/plain,abcd"}"#,
        r#"{"byteLength":4}"#,
        r#"{"uri":"data:;base64,AAAA"}"#,
        "null",
    ] {
        let uri = format!(r#","uri":"data:;base64,{}"}},{other}"#, base64(&file.bytes));
        let text = file.json("{}", &uri).replacen(&format!("{other}}}]"), &format!("{other}]"), 1);
        let motion = Gltf::read(text.as_bytes()).unwrap().motion(0, 0).unwrap();
        assert_eq!(at(&motion, 0.5, Side::After).position, [1.0, 2.0, 4.0]);
        let needed = text.replacen(r#"{"buffer":0"#, r#"{"buffer":1"#, 1);
        let message = Gltf::read(needed.as_bytes()).unwrap().motion(0, 0).unwrap_err().to_string();
        assert!(message.contains("samplers[0].input: buffers[1]: "), "{message}");
        let alone = format!(r#"{{"asset":{{"version":"2.0"}},"buffers":[{other}]}}"#);
        let message = Gltf::read(alone.as_bytes()).unwrap_err().to_string();
        assert!(message.starts_with("buffers[0]: "), "{message}");
    }
}

#[test]
#[cfg(unix)]
fn buffers_without_an_end_are_no_files() {
    let (file, nodes) = dancer();
    let folder = std::env::temp_dir().join(format!("pendulum-pipes-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("folder")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.join("zero")).unwrap();
    let pipe = folder.join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let path = folder.join("dance.gltf");
    for name in ["folder", "zero", "pipe"] {
        std::fs::write(&path, file.json(nodes, &format!(r#","uri":"{name}""#))).unwrap();
        let message = Gltf::open(&path).unwrap_err().to_string();
        assert!(message.contains(&format!("`{name}`: it is no regular file")), "{message}");
        let message = Gltf::open(folder.join(name)).unwrap_err().to_string();
        assert!(message.contains("it is no regular file"), "{message}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
