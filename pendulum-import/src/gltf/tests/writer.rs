//! A writer of files for tests.

use base64::prelude::{BASE64_STANDARD, Engine};
use std::fmt::Write;

/// A file under construction.
#[derive(Default)]
pub(super) struct Writer {
    pub(super) bytes: Vec<u8>,
    views: String,
    accessors: String,
    samplers: String,
    pub(super) channels: String,
    count: [usize; 2],
}

impl Writer {
    fn accessor(&mut self, numbers: &[f32], kind: &str, width: usize) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        let index = self.count[0];
        let comma = if index == 0 { "" } else { "," };
        write!(
            self.views,
            r#"{comma}{{"buffer":0,"byteOffset":{start},"byteLength":{}}}"#,
            4 * numbers.len()
        )
        .unwrap();
        let count = numbers.len() / width;
        let accessor = format!(
            r#"{{"bufferView":{index},"componentType":5126,"count":{count},"type":"{kind}"}}"#
        );
        write!(self.accessors, "{comma}{accessor}").unwrap();
        self.count[0] += 1;
        index
    }

    pub(super) fn channel(
        &mut self,
        node: usize,
        path: &str,
        interpolation: &str,
        times: &[f32],
        values: &[f32],
    ) {
        let width = if path == "rotation" { 4 } else { 3 };
        let input = self.accessor(times, "SCALAR", 1);
        let output = self.accessor(values, &format!("VEC{width}"), width);
        let sampler = self.count[1];
        let comma = if sampler == 0 { "" } else { "," };
        write!(
            self.samplers,
            r#"{comma}{{"input":{input},"output":{output},"interpolation":"{interpolation}"}}"#
        )
        .unwrap();
        write!(
            self.channels,
            r#"{comma}{{"sampler":{sampler},"target":{{"node":{node},"path":"{path}"}}}}"#
        )
        .unwrap();
        self.count[1] += 1;
    }

    pub(super) fn json(&self, nodes: &str, uri: &str) -> String {
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

    /// Returns the bytes of a .gltf file with its buffer inside.
    pub(super) fn text(&self, nodes: &str) -> Vec<u8> {
        let uri =
            format!(r#","uri":"data:application/octet-stream;base64,{}""#, base64(&self.bytes));
        self.json(nodes, &uri).into_bytes()
    }

    /// Returns the bytes of a .glb file.
    pub(super) fn binary(&self, nodes: &str) -> Vec<u8> {
        let mut json = self.json(nodes, "").into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = |bytes: usize| u32::try_from(bytes).unwrap().to_le_bytes();
        let chunk =
            |kind: &[u8; 4], bytes: &[u8]| [&length(bytes.len()), &kind[..], bytes].concat();
        let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &self.bytes)].concat();
        [&b"glTF"[..], &2u32.to_le_bytes(), &length(12 + chunks.len()), &chunks].concat()
    }
}

pub(super) fn base64(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}
