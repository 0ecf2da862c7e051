use super::*;
use crate::document::Node;
use glam::{DAffine3, DMat3};
use malus_geometry::load::{FileMaterial, Look, Model, Object, Part};
use serde_json::{Value, json};
use std::path::Path;

/// A grey dielectric that glows by its own field where `glow` is set.
fn material(name: &str, properties: Value, glow: f64) -> FileMaterial {
    FileMaterial {
        name: name.into(),
        properties: serde_json::from_value(properties).unwrap(),
        look: Look::Gltf {
            base_color: [0.5; 3],
            textured: false,
            metallic: 0.0,
            roughness: 1.0,
            specular: 1.0,
            specular_color: [1.0; 3],
            ior: None,
            transmission: 0.0,
            emissive: [glow; 3],
            alpha: 1.0,
            opaque: true,
            double_sided: false,
            thickness: 0.0,
        },
    }
}

/// A triangle of 0.5 m² for each material, one above the other; local X is the world's `x`.
fn object(name: &str, x: DVec3, properties: Value, materials: &[Option<usize>]) -> Object {
    let part = |(height, material): (usize, &Option<usize>)| Part {
        material: *material,
        positions: [DVec3::ZERO, DVec3::X, DVec3::Y]
            .map(|corner| corner + DVec3::Z * height as f64 + x * 10.0)
            .to_vec(),
        triangles: vec![[0, 1, 2]],
        faces: vec![0],
    };
    Object {
        name: name.into(),
        properties: serde_json::from_value(properties).unwrap(),
        parts: materials.iter().enumerate().map(part).collect(),
        frame: DAffine3 {
            matrix3: DMat3::from_cols(x, DVec3::Z.cross(x), DVec3::Z),
            translation: DVec3::ZERO,
        },
    }
}

struct Built {
    surfaces: Surfaces,
    materials: Vec<Material>,
}

impl Built {
    /// What object `number` emits by each of its triangles.
    fn exitances(&self, number: u32) -> Vec<f64> {
        let triangles = (0..self.surfaces.len() as u32)
            .filter(|triangle| self.surfaces.object(*triangle) == number);
        triangles
            .map(|triangle| {
                let material = &self.materials[self.surfaces.surface(triangle) as usize];
                material.emission.as_ref().map_or(0.0, |it| it.exitance)
            })
            .collect()
    }
}

fn build(materials: Vec<FileMaterial>, objects: Vec<Object>, toml: &str) -> Built {
    let model = Model {
        objects,
        materials,
        ..Model::default()
    };
    let imports = [Import::of("room.glb".into(), model).unwrap()];
    let document = Node::document(&"room.toml".into(), toml).unwrap();
    let file = SceneFile::typed(document, Path::new("room.toml")).unwrap();
    let assembly = Assembly::new(&imports, &file, &BTreeSet::new()).unwrap();
    let surfaces = Surfaces::new(assembly.mesh.clone()).unwrap();
    let (materials, _) = assembly
        .materials(&imports, &file.library, &surfaces)
        .unwrap();
    Built {
        surfaces,
        materials,
    }
}

fn near(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len()
        && found
            .iter()
            .zip(expected)
            .all(|(found, expected)| (found - expected).abs() < 1e-9)
}

#[test]
fn objects_share_a_surface_unless_their_own_properties_differ() {
    let plain = |name, x| object(name, x, json!({}), &[Some(0)]);
    let own = object("C", DVec3::NEG_X, json!({"malus_rho": 0.1}), &[Some(0)]);
    let built = build(
        vec![material("Wall", json!({}), 0.0)],
        vec![plain("A", DVec3::X), plain("B", DVec3::Y), own],
        "",
    );
    let surfaces: Vec<u32> = (0..3)
        .map(|triangle| built.surfaces.surface(triangle))
        .collect();
    assert_eq!(surfaces, [0, 0, 1]);
    assert_eq!(built.materials[0].object, None);
    assert_eq!(built.materials[1].object.as_deref(), Some("C"));
    assert_eq!(built.materials[1].values[1].value, "0.1");
}

#[test]
fn polarised_lamps_of_one_material_emit_along_their_own_axes() {
    let lamps = || {
        let lamp = |name, x| object(name, x, json!({}), &[Some(0)]);
        vec![lamp("A", DVec3::X), lamp("B", DVec3::Y)]
    };
    let polarised = json!({"malus_polarisation": [1, 0.5, 0, 0], "malus_exitance": 2});
    let axes = |built: &Built| -> Vec<DVec3> {
        let emissions = built.materials.iter().filter_map(|it| it.emission.as_ref());
        emissions.map(|emission| emission.axis).collect()
    };
    let own = build(vec![material("Lamp", polarised.clone(), 0.0)], lamps(), "");
    assert_eq!(axes(&own), [DVec3::X, DVec3::Y]);
    let given = "[material.Lamp]\nemission_axis = [0, 0, 1]";
    let given = build(vec![material("Lamp", polarised, 0.0)], lamps(), given);
    assert_eq!(axes(&given), [DVec3::Z]);
    let circular = json!({"malus_polarisation": "right-circular", "malus_exitance": 2});
    assert_eq!(
        build(vec![material("Lamp", circular, 0.0)], lamps(), "")
            .materials
            .len(),
        1
    );
}

#[test]
fn the_flux_of_a_material_is_shared_by_all_its_faces() {
    let lamp = |name, x| object(name, x, json!({}), &[Some(0), Some(0)]);
    let built = build(
        vec![material("Lamp", json!({"malus_emit_lm": 3600}), 5.0)],
        vec![lamp("A", DVec3::X), lamp("B", DVec3::Y)],
        "",
    );
    assert!(
        near(&built.exitances(0), &[1800.0; 2]),
        "{:?}",
        built.exitances(0)
    );
    assert!(near(&built.exitances(1), &[1800.0; 2]));
}

#[test]
fn the_flux_of_an_object_leaves_by_its_emitting_faces_or_else_by_all() {
    let lamp = |x| object("A", x, json!({"malus_emit_lm": 100}), &[Some(0), Some(1)]);
    let materials = |glow| {
        let rim = material("Rim", json!({}), 0.0);
        vec![rim, material("Panel", json!({}), glow)]
    };
    let flux = |glow, toml| build(materials(glow), vec![lamp(DVec3::X)], toml).exitances(0);
    assert!(near(&flux(1.0, ""), &[0.0, 200.0]));
    assert!(near(&flux(0.0, ""), &[100.0, 100.0]));
    assert!(near(
        &flux(1.0, "[material.Panel]\nexitance = 7"),
        &[200.0, 7.0]
    ));
}

#[test]
fn a_shape_may_have_a_material_of_a_mesh_file() {
    let toml = "[[shape]]\nkind = \"rectangle\"\norigin = [0, 0, 9]\nu = [1, 0, 0]\nv = [0, 1, 0]\nmaterial = \"Wall\"";
    let objects = vec![object("A", DVec3::X, json!({}), &[Some(0)])];
    let built = build(vec![material("Wall", json!({}), 0.0)], objects, toml);
    assert_eq!((built.surfaces.len(), built.materials.len()), (3, 1));
}

#[test]
fn faces_without_a_material_take_all_from_their_object() {
    let bare = object("A", DVec3::X, json!({"malus_rho": 0.3}), &[None]);
    let built = build(vec![], vec![bare], "");
    assert_eq!(
        (
            built.materials[0].name.as_str(),
            built.materials[0].values[1].value.as_str()
        ),
        (NAMELESS, "0.3")
    );
}

#[test]
fn an_object_may_be_of_another_kind_than_its_material() {
    let own = object("B", DVec3::Y, json!({"malus_kind": "coated"}), &[Some(0)]);
    let plain = object("A", DVec3::X, json!({}), &[Some(0)]);
    let built = build(vec![material("Wall", json!({}), 0.0)], vec![plain, own], "");
    let kinds: Vec<(&str, String)> = built
        .materials
        .iter()
        .map(|it| (it.values[0].value.as_str(), it.values[0].origin.to_string()))
        .collect();
    assert_eq!(kinds[0], ("mixture", "default".into()));
    assert_eq!(kinds[1], ("coated", "malus_kind of object \"B\"".into()));
}
