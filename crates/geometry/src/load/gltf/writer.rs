//! Small glTF files for tests.

use crate::load::{LoadError, Model, Placement, load};
use serde_json::{Value, json};

pub(super) const U8: u32 = 5121;
pub(super) const U16: u32 = 5123;
pub(super) const U32: u32 = 5125;
pub(super) const F32: u32 = 5126;

/// A glTF file in the making: JSON to be edited freely, and the data of its only buffer.
pub(super) struct Writer {
    pub json: Value,
    pub data: Vec<u8>,
}

impl Writer {
    /// One node `Tri` with the mesh `TriMesh`: the triangle (0, 0, 0), (2, 0, 0), (0, 1, 0), area 1, facing +Z.
    pub fn triangle() -> Self {
        let mut file = Self {
            json: json!({
                "asset": {"version": "2.0"},
                "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0, "name": "Tri"}],
                "accessors": [],
                "bufferViews": [],
            }),
            data: Vec::new(),
        };
        let positions = file.positions(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let indices = file.indices(U16, &[0, 1, 2]);
        file.json["meshes"] = json!([{"name": "TriMesh", "primitives": [
            {"attributes": {"POSITION": positions}, "indices": indices}]}]);
        file
    }

    /// Adds a member to an array of the file's root and returns its index.
    pub fn push(&mut self, array: &str, value: Value) -> usize {
        if self.json[array].is_null() {
            self.json[array] = json!([]);
        }
        let array = self.json[array].as_array_mut().unwrap();
        array.push(value);
        array.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.data.len().next_multiple_of(4);
        self.data.resize(offset, 0);
        self.data.extend(bytes);
        let view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        self.push("bufferViews", view)
    }

    pub fn positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let view = self.view(&floats(positions));
        self.push("accessors", json!({"bufferView": view, "componentType": F32, "type": "VEC3", "count": positions.len()}))
    }

    pub fn indices(&mut self, component: u32, indices: &[u32]) -> usize {
        let view = self.view(&integers(component, indices));
        self.push("accessors", json!({"bufferView": view, "componentType": component, "type": "SCALAR", "count": indices.len()}))
    }

    /// The only primitive of the only mesh.
    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// The file as JSON with its data in base64.
    pub fn text(&self) -> String {
        let mut json = self.json.clone();
        let uri = format!(
            "data:application/octet-stream;base64,{}",
            base64(&self.data)
        );
        json["buffers"] = json!([{"byteLength": self.data.len(), "uri": uri}]);
        json.to_string()
    }

    /// The file as GLB.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.data.len()}]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut data = self.data.clone();
        data.resize(data.len().next_multiple_of(4), 0);
        let mut bytes = b"glTF".to_vec();
        let length = 12 + 8 + text.len() + 8 + data.len();
        for word in [2, length as u32, text.len() as u32] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(b"JSON");
        bytes.extend(text);
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(data);
        bytes
    }

    pub fn load(&self) -> Result<Model, LoadError> {
        self.load_placed(&Placement::default())
    }

    pub fn load_placed(&self, placement: &Placement) -> Result<Model, LoadError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trap.gltf");
        std::fs::write(&path, self.text()).unwrap();
        load(&path, placement)
    }

    /// The message of the error that loading ends in.
    pub fn error(&self) -> String {
        let message = self.load().unwrap_err().to_string();
        assert!(
            message.contains("trap.gltf"),
            "the file is not named: {message}"
        );
        assert!(
            message.lines().count() == 1 && message.len() < 400,
            "too long: {message}"
        );
        message
    }
}

pub(super) fn floats(values: &[[f32; 3]]) -> Vec<u8> {
    values
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect()
}

pub(super) fn integers(component: u32, values: &[u32]) -> Vec<u8> {
    let size = match component {
        U8 => 1,
        U16 => 2,
        _ => 4,
    };
    values
        .iter()
        .flat_map(|v| v.to_le_bytes()[..size].to_vec())
        .collect()
}

fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let word =
            chunk.iter().fold(0u32, |w, &b| w << 8 | u32::from(b)) << (8 * (3 - chunk.len()));
        for i in 0..4 {
            text.push(match i <= chunk.len() {
                true => char::from(ALPHABET[(word >> (18 - 6 * i) & 63) as usize]),
                false => '=',
            });
        }
    }
    text
}
