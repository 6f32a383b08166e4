//! Writes .glb files.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// A glTF file in the making: its JSON, and the bytes of its buffer.
pub(crate) struct Glb {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

impl Glb {
    /// An empty scene.
    pub(crate) fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [] }],
            "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [],
            "extensionsUsed": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// Appends to a list at the top of the file and returns the index.
    pub(crate) fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json.get(list).is_none() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    /// Adds a node at the top of the scene.
    pub(crate) fn node(&mut self, value: Value) -> usize {
        let index = self.push("nodes", value);
        self.json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(index));
        index
    }

    /// Adds bytes to the buffer and returns the index of their view.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    /// Adds an accessor of floats.
    pub(crate) fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let mut accessor =
            json!({ "bufferView": view, "componentType": 5126, "count": values.len(), "type": kind });
        // The format asks for the bounds of positions.
        let bound = |f: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N).map(|axis| values.iter().map(|value| value[axis]).reduce(f).unwrap_or(0.0)).collect()
        };
        (accessor["min"], accessor["max"]) = (json!(bound(f32::min)), json!(bound(f32::max)));
        self.push("accessors", accessor)
    }

    /// Adds an accessor of indices with 16 bits.
    pub(crate) fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let accessor =
            json!({ "bufferView": view, "componentType": 5123, "count": values.len(), "type": "SCALAR" });
        self.push("accessors", accessor)
    }

    /// Adds a mesh of one square in the plane z = 0 from −1 to 1, which faces +z, with normals and texture coordinates.
    pub(crate) fn square(&mut self, name: &str, material: Option<usize>) -> usize {
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
        let positions = self.floats(&corners);
        let normals = self.floats(&[[0.0f32, 0.0, 1.0]; 4]);
        let uvs = self.floats(&[[0.0f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
        let indices = self.indices(&[0, 1, 2, 0, 2, 3]);
        let attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
        let mut primitive = json!({ "attributes": attributes, "indices": indices });
        if let Some(material) = material {
            primitive["material"] = json!(material);
        }
        self.push("meshes", json!({ "name": name, "primitives": [primitive] }))
    }

    /// The bytes of the file.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        // Empty lists are not valid.
        let lists = json.as_object_mut().expect("an object");
        lists.retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        glb(json.to_string().as_bytes(), &self.bytes)
    }

    /// Writes the file into a folder.
    pub(crate) fn write(&self, folder: &Path) -> PathBuf {
        let path = folder.join("room.glb");
        std::fs::write(&path, self.to_bytes()).expect("it can be written");
        path
    }
}

/// A file with these two chunks.
fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json, b' '), padded(binary, 0));
    let mut file = b"glTF".to_vec();
    let number = |file: &mut Vec<u8>, value: usize| file.extend((value as u32).to_le_bytes());
    number(&mut file, 2);
    number(&mut file, 12 + 8 + json.len() + 8 + binary.len());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        number(&mut file, chunk.len());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}
