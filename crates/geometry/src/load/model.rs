//! What a geometry file holds, placed in the world and not yet interpreted.

use glam::{DAffine3, DVec3};
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};

/// Custom properties of an object, a material or a lamp (glTF `extras`).
pub type Properties = BTreeMap<String, Value>;

/// What a geometry file holds: world metres, Z up, uninterpreted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Objects in file order. glTF: each node after its parent, children in their order.
    pub objects: Vec<Object>,
    /// Materials in file order, unused ones included.
    pub materials: Vec<FileMaterial>,
    /// Lamps without geometry, in the order of their nodes.
    pub lamps: Vec<Lamp>,
    /// What was left aside or assumed, one sentence each.
    pub notes: Vec<String>,
}

/// One object: a node of glTF that is neither camera nor lamp only, an `o` or `g` of OBJ.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its name, made unique within the file where it repeats (`Desk_Leg`, `Desk_Leg (2)`).
    pub name: String,
    /// Its own custom properties over those of its mesh.
    pub properties: Properties,
    /// Its triangles, one part a material. An Empty has none.
    pub parts: Vec<Part>,
    /// From the object's local axes, as Blender shows them, to the world.
    ///
    /// Blender's local Z is a glTF file's local +Y, its scale (sx, sy, sz) the file's [sx, sz, sy]; so this is
    /// the file's own map with the turn of [`super::Up`] undone on the local side. Not orthonormal where
    /// the object is scaled.
    pub frame: DAffine3,
}

/// Triangles of one object and one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Index into [`Model::materials`]; none where the file assigns none.
    pub material: Option<usize>,
    /// Vertices in the world, in metres, each used by a triangle.
    pub positions: Vec<DVec3>,
    /// Indices into `positions`, anticlockwise seen from the front; mirrored objects are already flipped.
    pub triangles: Vec<[u32; 3]>,
    /// The face of the file that each triangle is cut from, counted from 0 within the part: polygons in OBJ,
    /// the triangles themselves in glTF.
    pub faces: Vec<u32>,
}

/// A material as the file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct FileMaterial {
    /// Its name as in the file; names may repeat.
    pub name: String,
    /// Its custom properties.
    pub properties: Properties,
    /// The file's own fields.
    pub look: Look,
}

/// The optical fields of a file's material. Colours are linear; ranges are not checked.
#[derive(Clone, Debug, PartialEq)]
pub enum Look {
    /// glTF's metallic-roughness model and the extensions that Blender writes.
    Gltf {
        /// Base colour: factor × mean of the texture.
        base_color: [f64; 3],
        /// Whether a base-colour texture is involved.
        textured: bool,
        /// Metallic factor × mean of its texture.
        metallic: f64,
        /// Roughness factor × mean of its texture.
        roughness: f64,
        /// `specularFactor` of KHR_materials_specular, 1 without it.
        specular: f64,
        /// `specularColorFactor` of KHR_materials_specular, 1 without it; may exceed 1.
        specular_color: [f64; 3],
        /// KHR_materials_ior, where written.
        ior: Option<f64>,
        /// `transmissionFactor` of KHR_materials_transmission, 0 without it.
        transmission: f64,
        /// Emitted luminance in cd/m² by the standard: factor × strength × mean of the texture.
        emissive: [f64; 3],
        /// Alpha: factor × mean of the texture. Without meaning where `opaque`.
        alpha: f64,
        /// Whether the alpha mode is OPAQUE.
        opaque: bool,
        /// `doubleSided`.
        double_sided: bool,
        /// `thicknessFactor` of KHR_materials_volume in the mesh's units, 0 without it.
        thickness: f64,
    },
    /// Wavefront MTL. A field that the file does not give is none.
    Mtl {
        /// Diffuse colour.
        kd: Option<[f64; 3]>,
        /// Specular colour.
        ks: Option<[f64; 3]>,
        /// Emission.
        ke: Option<[f64; 3]>,
        /// Refractive index.
        ni: Option<f64>,
        /// Opacity (`d`, or 1 − `Tr`).
        d: Option<f64>,
        /// Transmission colour.
        tf: Option<[f64; 3]>,
        /// Illumination model, 0 to 10.
        illum: Option<u8>,
        /// Whether there is a `map_Kd`; it is not read.
        textured: bool,
        /// Roughness (`Pr`).
        pr: Option<f64>,
        /// Metallic (`Pm`).
        pm: Option<f64>,
    },
}

/// A source without geometry (KHR_lights_punctual).
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// Its node's name, made unique among the lamps.
    pub name: String,
    /// Custom properties: the object's over the light's.
    pub properties: Properties,
    /// Its kind.
    pub kind: LampKind,
    /// Where it is, in metres.
    pub position: DVec3,
    /// Unit vector along which its light propagates.
    pub direction: DVec3,
    /// Unit vector along the object's local X.
    pub x_axis: DVec3,
    /// Luminous intensity in cd, or illuminance in lx for [`LampKind::Distant`]; before `color`.
    pub intensity: f64,
    /// Linear colour that multiplies `intensity`.
    pub color: [f64; 3],
}

/// The kinds of lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LampKind {
    /// The same intensity in all directions.
    Point,
    /// A cone about the direction.
    Spot {
        /// Angle from the axis where the falloff begins, in radians.
        inner_rad: f64,
        /// Angle from the axis where the falloff ends, in radians.
        outer_rad: f64,
    },
    /// Parallel light.
    Distant,
}

impl Part {
    /// A part with those of `all` that its triangles use, in the order of first use.
    ///
    /// `places` is working memory: at least as long as `all`, `u32::MAX` throughout before and after. All
    /// indices must be valid.
    pub(super) fn gathered(
        material: Option<usize>,
        mut triangles: Vec<[u32; 3]>,
        faces: Vec<u32>,
        all: &[DVec3],
        places: &mut [u32],
    ) -> Self {
        let mut origins = Vec::new();
        for corner in triangles.iter_mut().flatten() {
            let place = &mut places[*corner as usize];
            if *place == u32::MAX {
                // Fewer than u32::MAX, because every entry is another valid u32 index.
                *place = origins.len() as u32;
                origins.push(*corner);
            }
            *corner = *place;
        }
        for &origin in &origins {
            places[origin as usize] = u32::MAX;
        }
        Self {
            material,
            positions: origins.iter().map(|&o| all[o as usize]).collect(),
            triangles,
            faces,
        }
    }
}

/// Names already given, each with the last number set behind it, to tell objects of one name apart.
#[derive(Default)]
pub(super) struct Names(HashMap<String, usize>);

impl Names {
    /// `name`, with a number behind it where it has been given before.
    pub(super) fn unique(&mut self, name: &str) -> String {
        let mut number = self.0.get(name).copied().unwrap_or(0);
        loop {
            number += 1;
            let unique = match number {
                1 => name.to_owned(),
                _ => format!("{name} ({number})"),
            };
            if number == 1 || !self.0.contains_key(&unique) {
                self.0.insert(name.to_owned(), number);
                self.0.entry(unique.clone()).or_insert(1);
                return unique;
            }
        }
    }
}

/// At most five names and the number of the others.
pub(super) fn listed(names: &[String]) -> String {
    let shown = names.len().min(5);
    let mut list = names[..shown].join(", ");
    if names.len() > shown {
        list += &format!(" and {} more", names.len() - shown);
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_changed_only_where_it_repeats() {
        let mut names = Names::default();
        let given = ["Leg", "Leg (2)", "Leg", "Top", "Leg"].map(|n| names.unique(n));
        assert_eq!(given, ["Leg", "Leg (2)", "Leg (3)", "Top", "Leg (4)"]);
    }

    #[test]
    fn a_part_keeps_only_the_vertices_it_uses_and_its_triangles_stay_where_they_are() {
        let all = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| DVec3::new(x, x * x, 0.0));
        let mut places = vec![u32::MAX; 5];
        let part = Part::gathered(
            None,
            vec![[4, 1, 3], [3, 1, 4]],
            vec![0, 1],
            &all,
            &mut places,
        );
        assert_eq!(part.positions, [all[4], all[1], all[3]]);
        assert_eq!(part.triangles, [[0, 1, 2], [2, 1, 0]]);
        assert_eq!(places, [u32::MAX; 5]);
    }
}
