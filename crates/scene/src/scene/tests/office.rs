//! An office as Blender exports it; `expected.json` and `make_office.py` beside the model say what is in it.

use super::*;
use crate::{Layout, SourceKind};

/// The glass of its table and its partition, which are closed boxes and so no panes.
const GLASS: &str = "[material.Glass]\nkind = \"mixture\"\n";

fn office(file: &str, text: &str) -> Result<Scene, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/meshes/blender_office");
    let mesh = folder.join(file).canonicalize().unwrap();
    let room = Room::new(&format!("[[mesh]]\nfile = {mesh:?}\n{text}"));
    room.with(&[])
}

fn material<'a>(scene: &'a Scene, name: &str) -> &'a Material {
    scene
        .materials
        .iter()
        .find(|material| material.name == name)
        .unwrap()
}

fn sensor<'a>(scene: &'a Scene, name: &str) -> &'a Sensor {
    scene
        .sensors
        .iter()
        .find(|sensor| sensor.name == name)
        .unwrap()
}

#[test]
fn the_blender_office_is_understood() {
    let scene = office("office.glb", GLASS).unwrap();
    // expected.json beside the file, as Blender itself counts; the sensor's 24 triangles are no geometry.
    assert_eq!(scene.surfaces.len(), 1786 - 24);
    let panel = material(&scene, "Lamp_Panel").emission.as_ref().unwrap();
    assert!(
        (panel.exitance - 10_000.0 / 3.0).abs() < 1e-3,
        "{}",
        panel.exitance
    );
    let steel = malus_optics::Material::Mixture {
        rho: 0.0,
        fraction: 1.0,
        index: malus_optics::Index::new(2.76, 3.79),
    };
    assert_eq!(material(&scene, "Steel_Brushed").optics, steel);
    assert_eq!(scene.need.representation, Representation::Full);
    assert!(
        !has(&scene.warnings, "\"Steel_Brushed\""),
        "{:?}",
        scene.warnings
    );
    assert!(!has(&scene.warnings, "\"Glass\""));
    assert!(has(
        &scene.warnings,
        "\"Lamp_Dim\" emits by its file's strength"
    ));
}

#[test]
fn the_sensors_of_the_blender_office_lie_where_blender_has_them() {
    let scene = office("office.glb", GLASS).unwrap();
    let plane = sensor(&scene, "SENSOR_Workplane");
    assert_eq!(plane.points.len(), 77);
    let Layout::Grid {
        origin,
        u,
        v,
        counts,
    } = &plane.layout
    else {
        panic!("an Empty is a grid")
    };
    assert!(origin.distance(DVec3::new(0.5, 0.5, 0.8)) < 1e-6);
    assert!(u.distance(DVec3::X * 5.0) < 1e-6 && v.distance(DVec3::Y * 3.0) < 1e-6);
    assert_eq!(counts, &[11, 7]);
    assert!(
        plane
            .points
            .iter()
            .all(|point| point.normal.distance(DVec3::Z) < 1e-6)
    );
    let eye = sensor(&scene, "SENSOR_Eye");
    assert_eq!(eye.points.len(), 1);
    assert!(eye.points[0].position.distance(DVec3::new(1.5, 2.0, 1.2)) < 1e-6);
    let board = sensor(&scene, "SENSOR_Board");
    assert_eq!(board.points.len(), 24);
    assert!(
        board
            .points
            .iter()
            .all(|point| (point.position.y - 3.9).abs() < 1e-6)
    );
    assert!(
        board
            .points
            .iter()
            .all(|point| point.normal.distance(DVec3::NEG_Y) < 1e-6)
    );
    assert_eq!(scene.sensors.len(), 3);
}

#[test]
fn the_lamps_of_the_blender_office_shine_as_blender_wrote_them() {
    let scene = office("office.glb", GLASS).unwrap();
    let source = |name: &str| {
        scene
            .sources
            .iter()
            .find(|source| source.name == name)
            .unwrap()
    };
    let SourceKind::Point {
        intensity,
        position,
        ..
    } = source("Point_Bulb").kind
    else {
        panic!("a point")
    };
    // 60 W; Blender writes W × 683/4π cd.
    let expected = 60.0 * 683.0 / (4.0 * std::f64::consts::PI);
    assert!((intensity / expected - 1.0).abs() < 1e-6);
    assert!(position.distance(DVec3::new(0.4, 3.6, 1.8)) < 1e-6);
    assert_eq!(
        format!("{:?}", source("Spot_Accent").state),
        "[1.0, 0.3, 0.0, 0.0]"
    );
    assert!(source("Spot_Accent").axis.distance(DVec3::X) < 1e-6);
    let SourceKind::Distant {
        direction,
        irradiance,
    } = source("Sun").kind
    else {
        panic!("distant")
    };
    // Turned by 50° about X: light that went straight down now goes towards +Y.
    let (sin, cos) = libm::sincos(50f64.to_radians());
    assert!(
        direction.distance(DVec3::new(0.0, sin, -cos)) < 1e-6,
        "{direction}"
    );
    assert!((irradiance - 3.0 * 683.0).abs() < 1e-3);
}

#[test]
fn the_scene_file_goes_before_the_office_s_own_properties() {
    let text = "[material.\"Lamp_*\"]\nexitance = 0\n[material.Steel_Brushed]\nn = 1.5\nk = 0\n";
    let scene = office("office.glb", &format!("{GLASS}{text}")).unwrap();
    assert!(
        scene
            .materials
            .iter()
            .all(|material| material.emission.is_none())
    );
    assert_eq!(scene.need.representation, Representation::Linear);
    assert!(!has(&scene.warnings, "by 683"));
}

#[test]
fn the_office_as_obj_keeps_its_sensor_out_of_the_lamps() {
    let scene = office("office.obj", "").unwrap();
    assert_eq!(sensor(&scene, "SENSOR_Board").points.len(), 12);
    let dim = scene
        .materials
        .iter()
        .position(|material| material.name == "Lamp_Dim")
        .unwrap();
    let area = areas(&scene.surfaces, scene.materials.len())[dim];
    // expected.json: 0.037 m², where the sensor would add 2 m².
    assert!((area - 0.037).abs() < 1e-6, "{area}");
}

#[test]
fn the_glass_boxes_of_the_office_are_no_panes_and_are_named() {
    let error = office("office.glb", "").err().unwrap();
    for part in [
        "material \"Glass\" is a pane (KHR_materials_transmission ≥ 0.5)",
        "closed solids: \"Partition\", \"Table_Glass\"; ",
        "replace it by a single sheet",
        "[material.\"Glass\"]\n    kind = \"mixture\"",
    ] {
        assert!(error.contains(part), "no {part:?} in {error}");
    }
    // A gloss given for it says that no pane is meant.
    let scene = office("office.glb", "[material.Glass]\na = 1\n").unwrap();
    assert!(has(&scene.warnings, "\"Glass\" transmits light"));
}

#[test]
fn the_glass_of_the_office_as_obj_is_opaque_unless_it_is_called_a_pane() {
    let scene = office("office.obj", "").unwrap();
    assert!(has(&scene.warnings, "\"Glass\" transmits light"));
    let error = office("office.obj", "[material.Glass]\nkind = \"pane\"\n")
        .err()
        .unwrap();
    assert!(
        error.contains("room.toml:4:8: material \"Glass\" is a pane")
            && error.contains("\"Partition\""),
        "{error}"
    );
}
