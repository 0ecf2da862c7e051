//! Panes and coats in scenes: where they can be, what they need, whether light is lost.

use super::*;
use malus_optics::Material::{Coated, Pane};

const ROOM: &str = "[[shape]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [4, 3, 2.5]\ninward = true\nmaterial = \"plaster\"\n\
    [material.plaster]\nrho = 0.5\n[material.glass]\nkind = \"pane\"\n";

/// A sheet across the room at x = 2.
const SHEET: &str = "[[shape]]\nkind = \"rectangle\"\norigin = [2, 0, 0]\nu = [0, 3, 0]\nv = [0, 0, 2]\nmaterial = \"glass\"\n";

/// A slab in the room.
const SLAB: &str =
    "[[shape]]\nkind = \"box\"\nmin = [2, 1, 1]\nmax = [2.01, 2, 2]\nmaterial = \"glass\"\n";

/// The room without its wall at x = 0.
fn open_room(wall: &str) -> String {
    let side = |origin: &str, u: &str, v: &str, material: &str| {
        format!(
            "[[shape]]\nkind = \"rectangle\"\norigin = {origin}\nu = {u}\nv = {v}\nmaterial = \"{material}\"\n"
        )
    };
    let mut text = "[material.plaster]\nrho = 1\n[material.glass]\nkind = \"pane\"\n".to_owned();
    text += &side("[0, 0, 0]", "[4, 0, 0]", "[0, 3, 0]", "plaster");
    text += &side("[0, 0, 2.5]", "[0, 3, 0]", "[4, 0, 0]", "plaster");
    text += &side("[0, 0, 0]", "[0, 0, 2.5]", "[4, 0, 0]", "plaster");
    text += &side("[0, 3, 0]", "[4, 0, 0]", "[0, 0, 2.5]", "plaster");
    text += &side("[4, 0, 0]", "[0, 0, 2.5]", "[0, 3, 0]", "plaster");
    text += &side("[0, 0, 0]", "[0, 3, 0]", "[0, 0, 2.5]", wall);
    format!("{text}{LAMP}{FLOOR}")
}

#[test]
fn a_sheet_may_be_a_pane_and_polarises() {
    let scene = Room::new(&format!("{ROOM}{SHEET}{LAMP}{FLOOR}")).load();
    let glass = Pane { n: 1.5, tau: 1.0 };
    assert_eq!(scene.materials[1].optics, glass);
    assert_eq!(scene.need.representation, Representation::Linear);
    assert!(
        scene.need.reason.contains("\"glass\" is a pane"),
        "{}",
        scene.need.reason
    );
}

#[test]
fn a_coat_polarises() {
    let room = Room::new(&format!("{CUBE}{LAMP}{FLOOR}"));
    let scene = room.with(&[("material.plaster.kind", "coated")]).unwrap();
    let coated = malus_optics::Coated::new(0.5, 1.5);
    assert_eq!(scene.materials[0].optics, Coated(coated));
    assert_eq!(scene.need.representation, Representation::Linear);
    assert!(
        scene.need.reason.contains("by its coat"),
        "{}",
        scene.need.reason
    );
}

#[test]
fn a_closed_solid_is_no_pane() {
    let room = Room::new(&format!("{ROOM}{SLAB}{LAMP}{FLOOR}"));
    let error = room.error();
    assert!(
        error.contains("room.toml:10:8: material \"glass\" is a pane"),
        "{error}"
    );
    assert!(
        error.contains("closed solids: \"shape.1\"; a pane is a whole sheet"),
        "{error}"
    );
    let mixture = [
        ("material.glass.kind", "mixture"),
        ("material.glass.rho", "0"),
    ];
    assert!(room.with(&mixture).is_ok());
    // A room of panes: each of its walls is a sheet.
    let inward = room.with(&[("shape.1.inward", "true")]).unwrap();
    assert!(inward.materials[1].optics.is_pane());
}

#[test]
fn a_slab_with_edges_of_another_material_is_no_pane_and_a_room_with_a_window_is_none() {
    let obj = |height: &str| {
        let quad = |name: &str, corners: &str| format!("usemtl {name}\nf {corners}\n");
        let mut text = "mtllib room.mtl\no Box\n".to_owned();
        for z in ["0", height] {
            text += &format!("v 0 0 {z}\nv 1 0 {z}\nv 1 1 {z}\nv 0 1 {z}\n");
        }
        text += &quad("Clear", "4 3 2 1");
        text += &quad("Clear", "5 6 7 8");
        for corners in ["1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"] {
            text += &quad("Frame", corners);
        }
        text
    };
    let text = "[[mesh]]\nfile = \"room.obj\"\nup = \"z\"\n[material.Clear]\nkind = \"pane\"\n\
         [[source]]\nkind = \"point\"\nposition = [0.5, 0.5, 4]\nintensity = 1\n\
         [[sensor]]\nname = \"a\"\npoints = [[0.5, 0.5, 3]]\n";
    let room = Room::new(text);
    room.write(
        "room.mtl",
        "newmtl Frame\nKd 0.5 0.5 0.5\nnewmtl Clear\nKd 1 1 1\n",
    );
    room.write("room.obj", &obj("1"));
    // Two of six equal faces.
    assert!(room.with(&[]).is_ok());
    room.write("room.obj", &obj("0.01"));
    let error = room.error();
    assert!(error.contains("closed solids: \"Box\""), "{error}");
}

#[test]
fn a_room_that_loses_nothing_may_lose_light_through_a_pane() {
    let closed = Room::new(&open_room("plaster")).error();
    assert!(closed.contains("nothing absorbs light"), "{closed}");
    let scene = Room::new(&open_room("glass")).load();
    // From the floor, 1.25 m² of window in each direction: some looks go out through it.
    let escaping = crate::Report::of(&scene).escaping;
    assert!(escaping > 0.05 && escaping < 0.5, "{escaping}");
}

#[test]
fn a_pane_within_a_white_room_loses_nothing() {
    let room = Room::new(&format!("{ROOM}{SHEET}{LAMP}{FLOOR}"));
    let white = ("material.plaster.rho", "1");
    let error = room.with(&[white]).err().unwrap();
    assert!(
        error.contains("nothing absorbs light") && error.contains("plaster, glass"),
        "{error}"
    );
    assert!(room.with(&[white, ("material.glass.tau", "0.99")]).is_ok());
    let coated = ("material.plaster.kind", "coated");
    assert!(room.with(&[white, coated]).is_err());
}

#[test]
fn light_enters_a_solid_through_a_pane() {
    // A cabinet with a glass lid, joined to one object by its file.
    let text = format!(
        "[[mesh]]\nfile = \"room.obj\"\nup = \"z\"\n[material.Clear]\nkind = \"pane\"\n{LAMP}\
         [[sensor]]\nname = \"in\"\npoints = [[0.5, 0.5, 0.5], [3, 3, 3]]\n"
    );
    let room = Room::new(&text);
    room.write(
        "room.mtl",
        "newmtl Frame\nKd 0.5 0.5 0.5\nnewmtl Clear\nKd 1 1 1\n",
    );
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    let obj = |lid: &str| {
        format!(
            "mtllib room.mtl\no Box\n{corners}usemtl Frame\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nusemtl {lid}\nf 5 6 7 8\n"
        )
    };
    room.write("room.obj", &obj("Clear"));
    assert!(!room.load().sensors[0].points[0].enclosed);
    room.write(
        "room.obj",
        &format!(
            "{}o Other\nv 9 9 9\nv 8 9 9\nv 8 8 9\nusemtl Clear\nf 9 10 11\n",
            obj("Frame")
        ),
    );
    assert!(room.load().sensors[0].points[0].enclosed);
}

/// A triangle in the plane z = 1, of glass by its file's own fields; `extras` are those of its material.
fn glass_sheet(extras: &str) -> Room {
    let room = Room::new(&format!(
        "[[mesh]]\nfile = \"sheet.gltf\"\n{CUBE}{LAMP}{FLOOR}"
    ));
    let bytes: Vec<u8> = [0.0_f32, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, -1.0]
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    std::fs::write(room.folder.path().join("sheet.bin"), bytes).unwrap();
    let text = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "Window"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "extensionsUsed": ["KHR_materials_transmission", "KHR_materials_ior"],
        "materials": [{"name": "Glass", "extras": EXTRAS,
            "pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0.5, 1], "metallicFactor": 0, "roughnessFactor": 0},
            "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.517}}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 1, -1], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "sheet.bin"}]}"#;
    room.write("sheet.gltf", &text.replace("EXTRAS", extras));
    room
}

#[test]
fn a_sheet_that_transmits_by_its_file_is_a_pane() {
    let scene = glass_sheet("{}").load();
    let glass = &scene.materials[0];
    let Pane { n, tau } = glass.optics else {
        panic!("a pane, not {:?}", glass.optics)
    };
    // The base colour's luminance, by Rec. 709.
    let luminance = 0.5 * (0.2126 + 0.0722) + 0.7152;
    assert!((n - 1.517).abs() < 1e-15 && (tau - luminance).abs() < 1e-15);
    let origins: Vec<String> = glass.values[..3]
        .iter()
        .map(|it| it.origin.to_string())
        .collect();
    assert_eq!(
        origins,
        [
            "KHR_materials_transmission ≥ 0.5",
            "KHR_materials_ior",
            "base colour"
        ]
    );
    assert!(!has(&scene.warnings, "Glass"), "{:?}", scene.warnings);
}

#[test]
fn custom_properties_go_before_the_file_s_own_glass() {
    let glass = |extras: &str| glass_sheet(extras).with(&[]);
    let optics = |extras: &str| glass(extras).unwrap().materials[0].optics;
    let Pane { tau, .. } = optics(r#"{"malus_tau": 0.25}"#) else {
        panic!("a pane")
    };
    assert!((tau - 0.25).abs() < 1e-15);
    assert!(!optics(r#"{"malus_kind": "mixture"}"#).is_pane());
    assert!(!optics(r#"{"malus_a": 0.5}"#).is_pane());
    let error = glass(r#"{"malus_kind": "pane", "malus_rho": 0.5}"#)
        .err()
        .unwrap();
    assert!(
        error.contains(
            "object \"Window\" (sheet.gltf), material \"Glass\": malus_rho of the material is given"
        ),
        "{error}"
    );
}
