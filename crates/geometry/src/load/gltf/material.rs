//! Materials and custom properties of a glTF file.

use super::super::image::Mean;
use super::super::{FileMaterial, LoadError, Look, Properties};
use super::buffer::Buffers;
use super::uri::{self, Failure};
use ::gltf::json::Extras;
use ::gltf::material::AlphaMode;
use ::gltf::texture::Info;
use ::gltf::{Document, Material};
use serde_json::Value;
use std::collections::BTreeMap;

/// Custom properties; none where `extras` is no JSON object.
pub(super) fn properties(extras: &Extras) -> Properties {
    let parsed = extras
        .as_ref()
        .and_then(|raw| serde_json::from_str(raw.get()).ok());
    match parsed {
        Some(Value::Object(members)) => members.into_iter().collect(),
        _ => Properties::new(),
    }
}

/// All materials of the file, in its order.
pub(super) fn all(
    document: &Document,
    buffers: &Buffers,
    notes: &mut Vec<String>,
) -> Vec<FileMaterial> {
    let mut textures = Textures {
        document,
        buffers,
        means: BTreeMap::new(),
        notes,
    };
    document
        .materials()
        .enumerate()
        .map(|(index, material)| {
            let name = match material.name() {
                Some(name) => name.to_owned(),
                None => format!("material {index}"),
            };
            FileMaterial {
                properties: properties(material.extras()),
                look: look(&material, &name, &mut textures),
                name,
            }
        })
        .collect()
}

fn look(material: &Material, name: &str, textures: &mut Textures) -> Look {
    let core = material.pbr_metallic_roughness();
    let texture = core.base_color_texture();
    let textured = texture.is_some();
    let base = textures.mean(texture, name, "base colour");
    let surface = textures.mean(core.metallic_roughness_texture(), name, "roughness");
    let glow = textures.mean(material.emissive_texture(), name, "emission");
    let [r, g, b, alpha] = core.base_color_factor().map(decimal);
    let specular = material.specular();
    let transmission = material.transmission();
    let ignored = [
        (
            "transmission",
            transmission
                .as_ref()
                .map(|t| t.transmission_texture().is_some()),
        ),
        (
            "specular",
            specular.as_ref().map(|s| s.specular_texture().is_some()),
        ),
        (
            "specular colour",
            specular
                .as_ref()
                .map(|s| s.specular_color_texture().is_some()),
        ),
    ];
    for (quantity, _) in ignored.iter().filter(|i| i.1 == Some(true)) {
        textures.notes.push(format!(
            "material {name}: its texture of the {quantity} is ignored, the factor stands"
        ));
    }
    let strength = material.emissive_strength().map_or(1.0, decimal);
    let emissive = material.emissive_factor().map(decimal);
    Look::Gltf {
        base_color: product([r, g, b], base.color),
        textured,
        metallic: decimal(core.metallic_factor()) * surface.stored[2],
        roughness: decimal(core.roughness_factor()) * surface.stored[1],
        specular: specular
            .as_ref()
            .map_or(1.0, |s| decimal(s.specular_factor())),
        specular_color: specular.map_or([1.0; 3], |s| s.specular_color_factor().map(decimal)),
        ior: material.ior().map(decimal),
        transmission: transmission.map_or(0.0, |t| decimal(t.transmission_factor())),
        emissive: product(emissive.map(|e| e * strength), glow.color),
        alpha: alpha * base.stored[3],
        opaque: material.alpha_mode() == AlphaMode::Opaque,
        double_sided: material.double_sided(),
        thickness: material
            .volume()
            .map_or(0.0, |v| decimal(v.thickness_factor())),
    }
}

/// The number a user typed: the shortest decimal that an f32 stands for. Blender writes a colour of 0.78 as
/// 0.7799999713897705, and 0.78 to an OBJ file; both mean the same.
fn decimal(value: f32) -> f64 {
    format!("{value}").parse().unwrap_or(value.into())
}

fn product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// The means of the file's images, each decoded once.
struct Textures<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    means: BTreeMap<usize, Mean>,
    notes: &'a mut Vec<String>,
}

/// What a factor is multiplied by without a texture.
const PLAIN: Mean = Mean {
    color: [1.0; 3],
    stored: [1.0; 4],
};

impl Textures<'_> {
    /// The mean of a texture; 1, with a note, where it cannot be read.
    fn mean(&mut self, texture: Option<Info>, material: &str, quantity: &str) -> Mean {
        let Some(texture) = texture else {
            return PLAIN;
        };
        self.notes.push(format!(
            "material {material}: the texture of its {quantity} is taken at its mean"
        ));
        let index = texture.texture().source().index();
        if let Some(&mean) = self.means.get(&index) {
            return mean;
        }
        let mean = self.decoded(index).unwrap_or_else(|reason| {
            let name = self.document.as_json().images[index].name.as_deref();
            self.notes.push(format!(
                "images[{index}] {:?} cannot be read and counts as white: {reason}",
                name.unwrap_or_default()
            ));
            PLAIN
        });
        self.means.insert(index, mean);
        mean
    }

    fn decoded(&self, index: usize) -> Result<Mean, String> {
        let image = &self.document.as_json().images[index];
        if let Some(uri) = &image.uri {
            return match uri::bytes(self.buffers.file, uri) {
                Ok(bytes) => Mean::of(&bytes),
                Err(Failure::File(path, reason)) => Err(format!("{}: {reason}", path.display())),
                Err(Failure::Uri(found)) => Err(format!("{found} is not read")),
            };
        }
        let view = image
            .buffer_view
            .and_then(|view| self.document.views().nth(view.value()))
            .ok_or("it has neither uri nor bufferView")?;
        let bytes = self
            .buffers
            .view(&view)
            .map_err(|e: LoadError| e.to_string())?;
        Mean::of(bytes)
    }
}
