//! Real rooms: the Blender office, third-party rooms where they are at hand, and closed rooms that no ray may leave.

mod leaks;

use crate::cli::{Folder, assert_told, refusal, stderr, stdout, word};
use crate::experiment::{repository, third_party};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// A scene with one mesh file in it, and further text after it.
pub fn with_mesh(file: &Path, more: &str) -> String {
    format!("[[mesh]]\nfile = {:?}\n{more}", word(file))
}

/// A scene of a file of the office, whose glass is that of closed boxes too and so no pane.
pub fn office(file: &str) -> String {
    let mesh = repository("scenes/meshes/blender_office").join(file);
    with_mesh(&mesh, "[material.Glass]\nkind = \"mixture\"\n")
}

/// What `malus check --json` understands of a scene.
#[track_caller]
fn report(scene: &str) -> Value {
    let folder = Folder::new(scene.as_bytes(), &[]);
    let output = folder.malus(&["check", "room.toml", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// Triangles and area in m² of every material.
fn materials(report: &Value) -> BTreeMap<&str, (u64, f64)> {
    let mut materials = BTreeMap::new();
    for material in report["materials"].as_array().unwrap() {
        let entry = materials
            .entry(material["name"].as_str().unwrap())
            .or_insert((0, 0.0));
        entry.0 += material["triangles"].as_u64().unwrap();
        entry.1 += material["area_m2"].as_f64().unwrap();
    }
    materials
}

fn names<'a>(report: &'a Value, what: &str) -> Vec<&'a str> {
    report[what]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it["name"].as_str().unwrap())
        .collect()
}

fn warnings(report: &Value) -> Vec<&str> {
    report["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it.as_str().unwrap())
        .collect()
}

/// Triangles of the sensor board, which is no geometry.
const BOARD: u64 = 24;

#[test]
fn the_office_has_blenders_own_triangles_and_areas() {
    let text =
        std::fs::read_to_string(repository("scenes/meshes/blender_office/expected.json")).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    let areas = expected["area_m2"].as_object().unwrap();
    for file in ["office.glb", "office.gltf", "office.obj"] {
        let report = report(&office(file));
        assert_eq!(
            report["triangles"],
            expected["triangles"].as_u64().unwrap() - BOARD,
            "{file}"
        );
        let materials = materials(&report);
        let triangles: u64 = materials.values().map(|(triangles, _)| triangles).sum();
        assert_eq!(report["triangles"], triangles, "{file}");
        // Only the board has no material of its own.
        let known: Vec<&str> = areas
            .keys()
            .map(String::as_str)
            .filter(|name| *name != "(none)")
            .collect();
        assert_eq!(
            materials.keys().copied().collect::<Vec<_>>(),
            known,
            "{file}"
        );
        for (name, (_, area)) in materials {
            // Blender's areas are rounded at 1e-5 m², the file's coordinates at single precision.
            let off = (area - areas[name].as_f64().unwrap()).abs();
            assert!(off < 2e-5, "{file}, {name}: {area} m², off by {off}");
        }
    }
}

#[test]
fn the_offices_lamps_and_sensors_are_those_of_blender() {
    for file in ["office.glb", "office.gltf"] {
        let report = report(&office(file));
        assert_eq!(
            names(&report, "emitters"),
            ["Lamp_Panel", "Lamp_Dim", "Point_Bulb", "Spot_Accent", "Sun"],
            "{file}"
        );
        // malus_emit_lm = 3600 over 1.08 m², to the single precision of the areas.
        let panel = &report["emitters"][0];
        assert!(
            (panel["flux"].as_f64().unwrap() / 3600.0 - 1.0).abs() < 1e-6,
            "{panel}"
        );
        assert!(
            (panel["strength"].as_f64().unwrap() * 1.08 / 3600.0 - 1.0).abs() < 1e-6,
            "{panel}"
        );
        // The spot's malus_polarisation.
        assert_eq!(
            report["emitters"][3]["state"],
            serde_json::json!([1.0, 0.3, 0.0, 0.0])
        );
        let mut sensors = names(&report, "sensors");
        sensors.sort_unstable();
        assert_eq!(
            sensors,
            ["SENSOR_Board", "SENSOR_Eye", "SENSOR_Workplane"],
            "{file}"
        );
        let count = |name: &str| {
            let mut all = report["sensors"].as_array().unwrap().iter();
            all.find(|sensor| sensor["name"] == name).unwrap()["count"]
                .as_u64()
                .unwrap()
        };
        // malus_nx × malus_ny of the plane.
        assert_eq!(
            [count("SENSOR_Eye"), count("SENSOR_Workplane")],
            [1, 77],
            "{file}"
        );
    }
    // OBJ has no lamps and no Empties; the board is a sensor by its name, not the emitter whose material it inherits.
    let obj = report(&office("office.obj"));
    assert_eq!(names(&obj, "emitters"), ["Lamp_Panel", "Lamp_Dim"]);
    assert_eq!(names(&obj, "sensors"), ["SENSOR_Board"]);
    assert_told(
        &warnings(&obj).join("\n"),
        &["without a usemtl", "SENSOR_Board (Lamp_Dim)"],
    );
}

/// What is wrong with `office_defects.glb`, one sentence each, by its essential parts.
const DEFECTS: [[&str; 3]; 4] = [
    ["\"Cabinet\"", "inside out", "0.5400 m³"],
    ["\"Window_Reveal\"", "turned over", "all its faces"],
    ["\"Floor\"", "2 doubled triangles", "left out"],
    // The west wall: 4.0 × 2.8 m at x = 0.
    [
        "open along a rim of 13.600 m",
        "11.2000 m²",
        "near (0, 2, 1.4)",
    ],
];

#[test]
fn every_defect_of_the_spoiled_office_is_named() {
    let report = report(&office("office_defects.glb"));
    let told = warnings(&report);
    for parts in DEFECTS {
        let count = told
            .iter()
            .filter(|line| parts.iter().all(|part| line.contains(part)))
            .count();
        assert_eq!(count, 1, "{parts:?} in:\n{}", told.join("\n"));
    }
    let coincidences = report["coincidences"].as_array().unwrap();
    assert!(coincidences.iter().any(|pair| {
        let pair = pair.as_str().unwrap();
        pair.contains("Floor_copy") && pair.contains("24.000000 m²")
    }));
    // With a wall missing, light leaves.
    assert!(
        report["escaping"].as_f64().unwrap() > 0.02,
        "{}",
        report["escaping"]
    );
}

#[test]
fn the_sound_office_has_none_of_these_defects() {
    for file in [
        "office.glb",
        "office.gltf",
        "office.obj",
        "office_defaults.glb",
    ] {
        let report = report(&office(file));
        let told = warnings(&report).join("\n");
        for part in [
            "inside out",
            "turned over",
            "doubled",
            "mixed winding",
            "without area",
            "non-manifold",
        ] {
            assert!(!told.contains(part), "{file}: {part:?} in:\n{told}");
        }
        // The one sheet in mid-air, a banner of 0.8 m², is an open rim rightly; the shell is not.
        for line in told.lines().filter(|line| line.contains("open along")) {
            assert!(
                line.contains("Banner") && line.contains("0.8000 m²"),
                "{file}: {line}"
            );
        }
        assert_eq!(report["escaping"], 0.0, "{file}");
    }
}

/// What users send first: modifiers not applied, no lamps, no custom properties.
#[test]
fn the_export_by_default_shows_what_is_not_in_it() {
    let report = report(&office("office_defaults.glb"));
    // 466 triangles without the modifiers, those of the board among them.
    assert_eq!(report["triangles"], 466 - BOARD);
    assert_eq!(names(&report, "emitters"), ["Lamp_Panel", "Lamp_Dim"]);
    let origins = report["materials"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|it| it["values"].as_array().unwrap());
    for value in origins {
        assert!(
            !value["origin"].as_str().unwrap().contains("malus_"),
            "{value}"
        );
    }
}

#[test]
fn the_export_by_default_tells_which_boxes_to_tick() {
    let report = report(&office("office_defaults.glb"));
    let told = warnings(&report).join("\n");
    assert_told(
        &told,
        &[
            "office_defaults.glb",
            "Custom Properties",
            "Punctual Lights",
            "Apply Modifiers",
        ],
    );
}

/// Runs a scene of a third-party room and asserts that light arrives at every free point.
#[track_caller]
fn assert_lit(scene: &str) {
    let folder = Folder::new(scene.as_bytes(), &[]);
    let output = folder.run("out", &["--samples", "1024", "--no-pictures"]);
    let table = folder.text("out/sensors.csv");
    let mut lit = 0;
    for row in csv::Reader::from_reader(table.as_bytes()).records() {
        let row = row.unwrap();
        assert_eq!(&row[25], "ok", "{}", stderr(&output));
        assert!(row[8].parse::<f64>().unwrap() > 0.0, "{row:?}");
        lit += 1;
    }
    assert!(lit > 0);
}

#[test]
fn an_obj_room_without_a_lamp_says_so_and_runs_with_one() {
    let Some(folder) = third_party("cornell_embree") else {
        return;
    };
    let file = folder.join("cornell_box.obj");
    let sensor = "scale = 0.001\n[[sensor]]\nname = 'floor'\nline = { from = [0.1, -0.1, 0], to = [0.5, -0.1, 0], count = 3 }\nnormal = [0, 0, 1]\n";
    let dark = Folder::new(with_mesh(&file, sensor).as_bytes(), &[]);
    for command in ["check", "run"] {
        let output = dark.malus(&[command, "room.toml"]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert_told(
            &stderr(&output),
            &[
                "nothing emits light",
                "glTF drops Blender's area lights",
                "[[source]]",
            ],
        );
    }
    let lamp = "[[source]]\nkind = 'point'\nposition = [0.278, -0.28, 0.5]\nintensity = 1\n[material.red]\nrho = 0.3\n";
    let scene = with_mesh(&file, &format!("{sensor}{lamp}"));
    let report = report(&scene);
    assert_eq!(report["triangles"], 34);
    assert_bounds(&report, [0.556, 0.5592, 0.5488]);
    let red = report["materials"]
        .as_array()
        .unwrap()
        .iter()
        .find(|it| it["name"] == "red")
        .unwrap();
    let rho = red["values"]
        .as_array()
        .unwrap()
        .iter()
        .find(|it| it["key"] == "rho")
        .unwrap();
    assert_eq!(
        rho["value"], "0.3",
        "the scene file has the last word: {rho}"
    );
    assert_lit(&scene);
}

#[test]
fn a_gltf_room_in_millimetres_runs_with_its_own_lamp() {
    let Some(folder) = third_party("cornell_bevy") else {
        return;
    };
    let sensor = "scale = 0.001\n[[sensor]]\nname = 'floor'\nline = { from = [-0.5, 0.1, 0], to = [-0.1, 0.1, 0], count = 3 }\nnormal = [0, 0, 1]\n";
    let scene = with_mesh(&folder.join("CornellBox.glb"), sensor);
    let report = report(&scene);
    assert_eq!(report["triangles"], 36);
    assert_bounds(&report, [0.556, 0.5592, 0.5488]);
    // emissiveStrength 100 of white: π × 100.
    assert_eq!(names(&report, "emitters").len(), 1);
    let strength = report["emitters"][0]["strength"].as_f64().unwrap();
    assert!(
        (strength / (100.0 * std::f64::consts::PI) - 1.0).abs() < 1e-12,
        "{strength}"
    );
    // The box is open at the front.
    assert!(
        warnings(&report)
            .iter()
            .any(|line| line.contains("open along a rim of 2.2")),
        "{report}"
    );
    assert_lit(&scene);
    // In millimetres taken for metres it is told that this is no room.
    let told = report_of_unscaled(&folder.join("CornellBox.glb"));
    assert_told(&told, &["556", "no room", "scale"]);
}

fn report_of_unscaled(file: &Path) -> String {
    let sensor = "[[sensor]]\nname = 'floor'\npoints = [[-100, 100, 0]]\nnormal = [0, 0, 1]\n";
    warnings(&report(&with_mesh(file, sensor))).join("\n")
}

#[test]
fn a_real_export_with_every_kind_of_defect_is_checked_and_run() {
    let Some(folder) = third_party("godot_living_room") else {
        return;
    };
    let more = "[[source]]\nkind = 'point'\nposition = [0, 0, 1.8]\nintensity = 100\n\
        [[sensor]]\nname = 'room'\nline = { from = [-1, 0, 1.2], to = [1, 0, 1.2], count = 3 }\nnormal = [0, 0, 1]\n";
    let scene = with_mesh(&folder.join("living_room.glb"), more);
    let report = report(&scene);
    assert_bounds(&report, [10.0, 14.5, 5.5]);
    let told = warnings(&report).join("\n");
    for part in [
        "without area",
        "doubled triangles",
        "non-manifold edges",
        "mixed winding",
        "boundary edges",
    ] {
        assert!(told.contains(part), "no {part:?} in:\n{told}");
    }
    assert_lit(&scene);
    let dark = Folder::new(
        with_mesh(&folder.join("living_room.glb"), "").as_bytes(),
        &[],
    );
    let output = dark.malus(&["check", "room.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert_told(&stderr(&output), &["nothing emits light"]);
}

/// Asserts the room's size in m, to the digits that its files give.
#[track_caller]
fn assert_bounds(report: &Value, size: [f64; 3]) {
    let bounds = |end: usize, axis: usize| report["bounds_m"][end][axis].as_f64().unwrap();
    for (axis, expected) in size.into_iter().enumerate() {
        let found = bounds(1, axis) - bounds(0, axis);
        assert!(
            (found - expected).abs() < 2e-4 * expected,
            "axis {axis}: {found} m, not {expected}"
        );
    }
}

/// The office as it is, with all its defects of export, gives numbers at every sensor of its own.
#[test]
fn the_office_runs_as_exported() {
    for file in [
        "office.glb",
        "office.obj",
        "office_defaults.glb",
        "office_defects.glb",
    ] {
        let folder = Folder::new(office(file).as_bytes(), &[]);
        let output = folder.run("out", &["--samples", "64", "--no-pictures"]);
        assert!(stdout(&output).contains("SENSOR_Board"), "{file}");
    }
}

/// Glass boxes count twice as panes: an export that has them says so before anything is computed.
#[test]
fn the_glass_boxes_of_the_office_are_refused_as_panes() {
    for file in ["office.glb", "office_defaults.glb"] {
        let mesh = repository("scenes/meshes/blender_office").join(file);
        let told = refusal(with_mesh(&mesh, "").as_bytes(), &[], &[]);
        assert_told(
            &told,
            &[
                "material \"Glass\" is a pane (KHR_materials_transmission",
                "\"Partition\", \"Table_Glass\"; ",
                "a single sheet",
                "kind = \"mixture\"",
            ],
        );
        assert!(!told.contains("Window_Pane"), "{told}");
    }
}
