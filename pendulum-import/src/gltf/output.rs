//! A file with one more animation: its JSON, its keys and its container.

use super::error::GltfError;
use super::json::{count, index, list, member, text};
use super::node::Pose;
use super::{Gltf, MEND, target};
use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::{Value, json};

/// Times and values of a channel.
pub(super) type Keys<const D: usize> = Vec<(f32, [f32; D])>;

/// A file to be written.
pub(super) struct Output {
    root: Value,
    /// The numbers of all keys, in one view.
    bytes: Vec<u8>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
    /// The number of nodes that the file had.
    nodes: usize,
}

impl Output {
    /// Begins with the JSON of a file and with the channels of one of its animations.
    pub(super) fn new(root: &Value, animation: &Value) -> Self {
        Self {
            root: root.clone(),
            bytes: Vec::new(),
            samplers: list(animation, "samplers").to_vec(),
            channels: list(animation, "channels").to_vec(),
            nodes: list(root, "nodes").len(),
        }
    }

    /// Adds a node.
    pub(super) fn add(&mut self, name: &str, parent: Option<usize>) -> Result<(), GltfError> {
        let node = list(&self.root, "nodes").len();
        append(&mut self.root, "nodes", json!({ "name": name }), "nodes")?;
        if let Some(parent) = parent {
            let place = format!("nodes[{parent}]");
            return append(&mut self.root["nodes"][parent], "children", node.into(), &place);
        }
        let shown = index(&self.root, "scene").unwrap_or(0);
        match self.root.get_mut("scenes").and_then(|scenes| scenes.get_mut(shown)) {
            Some(scene) => append(scene, "nodes", node.into(), &format!("scenes[{shown}]")),
            // A file without scenes is a library, whose nodes belong to none.
            None => Ok(()),
        }
    }

    /// Replaces the matrix of a node by its parts: animated nodes may not have a matrix.
    pub(super) fn unpack(&mut self, node: usize, (at, turn, scale): Pose) {
        if let Some(Value::Object(members)) = self.root["nodes"].get_mut(node) {
            members.remove("matrix");
            members.insert("translation".into(), single(at));
            members.insert("rotation".into(), single(turn));
            members.insert("scale".into(), single(scale));
        }
    }

    /// Adds a channel, in place of that of the same node and path.
    pub(super) fn channel<const D: usize>(&mut self, node: usize, path: &str, keys: &Keys<D>) {
        self.channels.retain(|channel| target(channel) != Ok(Some((node, path))));
        if self.nodes <= node
            && let Some(&(_, first)) = keys.first()
        {
            self.root["nodes"][node][path] = single(first.map(f64::from));
        }
        let input = self.accessor("SCALAR", keys.iter().map(|&(time, _)| [time]));
        let ends = [keys.first(), keys.last()].map(|key| key.map_or(0.0, |&(time, _)| time));
        self.root["accessors"][input]["min"] = json!([ends[0]]);
        self.root["accessors"][input]["max"] = json!([ends[1]]);
        let output = self.accessor(&format!("VEC{D}"), keys.iter().map(|&(_, value)| value));
        let sampler = self.samplers.len();
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
        let channel = json!({ "sampler": sampler, "target": { "node": node, "path": path } });
        self.channels.push(channel);
    }

    /// Adds numbers and returns the number of their accessor.
    fn accessor<const D: usize>(
        &mut self,
        kind: &str,
        values: impl ExactSizeIterator<Item = [f32; D]>,
    ) -> usize {
        let accessor = json!({
            "bufferView": list(&self.root, "bufferViews").len(),
            "byteOffset": self.bytes.len(),
            "componentType": 5126,
            "count": values.len(),
            "type": kind,
        });
        self.bytes.extend(values.flatten().flat_map(f32::to_le_bytes));
        push(&mut self.root["accessors"], accessor)
    }

    /// Returns the bytes of the file.
    pub(super) fn finish(mut self, file: &Gltf, name: &str) -> Result<Vec<u8>, GltfError> {
        let animation = json!({
            "name": name,
            "samplers": self.samplers,
            "channels": self.channels,
        });
        push(&mut self.root["animations"], animation);
        let length = self.bytes.len();
        let first = list(&self.root, "buffers").first();
        let mut chunk = match (file.binary, first, file.buffers.first()) {
            (false, ..) => None,
            (true, None, _) => {
                push(&mut self.root["buffers"], json!({}));
                Some(Vec::new())
            }
            (true, Some(first), _) if text(first, "uri").is_some() => None,
            (true, Some(first), Some(Ok(bytes))) => {
                let length = count(first, "byteLength").ok().flatten().unwrap_or(0);
                Some(bytes[..bytes.len().min(length as usize)].to_vec())
            }
            (true, Some(_), Some(Err(error))) => return Err(error.clone()),
            (true, Some(_), None) => None,
        };
        let (buffer, start) = if let Some(chunk) = &mut chunk {
            chunk.resize(chunk.len().next_multiple_of(4), 0);
            let start = chunk.len();
            chunk.append(&mut self.bytes);
            self.root["buffers"][0]["byteLength"] = chunk.len().into();
            (0, start)
        } else {
            let data = BASE64_STANDARD.encode(&self.bytes);
            let uri = format!("data:application/octet-stream;base64,{data}");
            let buffer = json!({ "byteLength": length, "uri": uri });
            (push(&mut self.root["buffers"], buffer), 0)
        };
        let view = json!({ "buffer": buffer, "byteOffset": start, "byteLength": length });
        push(&mut self.root["bufferViews"], view);
        let text = serde_json::to_vec(&self.root);
        let text = text.map_err(|error| GltfError::new("text", error.to_string(), MEND))?;
        if file.binary { packed(text, chunk) } else { Ok(text) }
    }
}

/// Returns numbers as a list, rounded to single precision.
fn single<const D: usize>(values: [f64; D]) -> Value {
    values.map(|value| value as f32).to_vec().into()
}

/// Appends to a list, which may be absent, and returns the place of the item.
fn push(items: &mut Value, item: Value) -> usize {
    if let Value::Array(items) = items {
        items.push(item);
        return items.len() - 1;
    }
    *items = Value::Array(vec![item]);
    0
}

/// Appends to a list of an object.
fn append(object: &mut Value, key: &str, item: Value, place: &str) -> Result<(), GltfError> {
    if !object.is_object() || member(object, key).is_some_and(|items| !items.is_array()) {
        return Err(GltfError::new(place, format!("it has no list of `{key}`"), MEND));
    }
    push(&mut object[key], item);
    Ok(())
}

/// Returns the bytes of a .glb file. Khronos Group, "glTF 2.0 Specification", section 4.4.
fn packed(mut text: Vec<u8>, chunk: Option<Vec<u8>>) -> Result<Vec<u8>, GltfError> {
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut chunks = vec![(b"JSON", text)];
    if let Some(mut bytes) = chunk {
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        chunks.push((b"BIN\0", bytes));
    }
    let length = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
    // No part is longer than the whole.
    let word = |length: usize| {
        u32::try_from(length).map(u32::to_le_bytes).map_err(|_| {
            GltfError::new("header", format!("{length} bytes in one file"), "bake fewer nodes")
        })
    };
    let mut file = [&b"glTF"[..], &2_u32.to_le_bytes(), &word(length)?].concat();
    for (kind, bytes) in chunks {
        file.extend(word(bytes.len())?);
        file.extend(kind);
        file.extend(bytes);
    }
    Ok(file)
}
