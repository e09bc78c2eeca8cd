//! Tests of numbers in files: packed, sparse, and in files beside the file.

use super::writer::base64;
use super::{at, close, dancer};
use crate::gltf::Gltf;
use pendulum_core::motion::Side;

/// Normalized short integers with gaps between them, and a sparse accessor without a bufferView.
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
