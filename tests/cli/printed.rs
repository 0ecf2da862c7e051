//! What the program prints, and where it says nothing.

use super::{Folder, ROOM, stderr, stdout};

#[test]
fn check_prints_every_value_with_its_origin_and_computes_nothing() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let output = folder.malus(&[
        "check",
        "room.toml",
        "--set",
        "material.plaster.a=0.25",
        "--json",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let values = report["materials"][0]["values"].as_array().unwrap();
    let origin = |key: &str| {
        let value = values.iter().find(|value| value["key"] == key).unwrap();
        (
            value["value"].as_str().unwrap(),
            value["origin"].as_str().unwrap(),
        )
    };
    assert_eq!(origin("rho"), ("0.5", "room.toml:14:7"));
    assert_eq!(origin("a"), ("0.25", "--set material.plaster.a=0.25"));
    assert_eq!(origin("n"), ("1.5", "default"));
    assert_eq!(
        (&report["triangles"], &report["representation"]),
        (&12.into(), &"linear".into())
    );
    // 4π sr of 10 lm/sr.
    let flux = report["emitters"][0]["flux"].as_f64().unwrap();
    assert!(
        (flux / (40.0 * std::f64::consts::PI) - 1.0).abs() < 1e-14,
        "{flux}"
    );
    assert!(!folder.path("results").exists());

    let text = stdout(&folder.malus(&["check", "room.toml"]));
    for part in [
        "plaster",
        "12 triangles",
        "room.toml:14:7",
        "125.66",
        "desk",
        "No defects, no warnings",
    ] {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}

#[test]
fn check_prints_kinds_radiances_and_cameras() {
    let more = "\n[[shape]]\nkind = \"rectangle\"\norigin = [2, 0, 0]\nu = [0, 3, 0]\nv = [0, 0, 2]\nmaterial = \"glass\"\n\
        [material.glass]\nkind = \"pane\"\ntau = 0.9\n\
        [[sensor]]\nname = \"screen\"\npoints = [[1, 1, 1]]\nquantity = \"radiance\"\ndirection = [0, 0, -2]\n\
        [[camera]]\nname = \"door\"\nposition = [0.5, 0.5, 1.6]\nlook_at = [0.5, 2, 1.6]\nfov_deg = 70\n";
    let folder = Folder::new(format!("{ROOM}{more}").as_bytes(), &[]);
    let text = stdout(&folder.malus(&["check", "room.toml"]));
    for part in [
        "kind   pane  room.toml:31:8",
        "tau    0.9   room.toml:32:7",
        "default: n 1.5, exitance 0, two_sided true",
        "radiance along (0, 0, -1)",
        "Cameras",
        "(0.5, 0.5, 1.6)",
        "70.00°",
        "640 × 480",
        "Representation linear: material \"glass\" is a pane",
        "No defects, no warnings",
    ] {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
    let set = [
        "--set",
        "camera.door.samples=9",
        "--set",
        "material.glass.tau=0.8",
    ];
    let words = [&["check", "room.toml", "--json"], &set[..]].concat();
    let report: serde_json::Value = serde_json::from_str(&stdout(&folder.malus(&words))).unwrap();
    let values = &report["materials"][1]["values"];
    assert_eq!(
        (&values[0]["key"], &values[0]["value"]),
        (&"kind".into(), &"pane".into())
    );
    assert_eq!(values[2]["origin"], "--set material.glass.tau=0.8");
    assert_eq!(report["sensors"][1]["quantity"], "radiance");
    assert_eq!(
        report["sensors"][1]["direction"],
        serde_json::json!([0.0, 0.0, -1.0])
    );
    let camera = &report["cameras"][0];
    assert_eq!(
        (&camera["name"], &camera["samples"]),
        (&"door".into(), &9.into())
    );
    assert_eq!(camera["forward"], serde_json::json!([0.0, 1.0, 0.0]));
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    for words in [["check", "room.toml"], ["run", "room.toml"]] {
        let mut child = folder
            .command(&words)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(
            (output.status.code(), stderr(&output)),
            (Some(0), String::new()),
            "{words:?}"
        );
    }
}

#[test]
fn a_quiet_run_prints_nothing() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let output = folder.run("out", &["--quiet"]);
    assert_eq!(
        (stdout(&output), stderr(&output)),
        (String::new(), String::new())
    );
    assert!(folder.path("out/summary.json").exists());
}

#[test]
fn results_go_to_a_folder_of_the_scenes_name_by_default() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let output = folder.malus(&["run", "room.toml"]);
    assert_eq!(output.status.code(), Some(0));
    let mut names: Vec<String> = std::fs::read_dir(folder.path("results/room"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["grids.csv", "sensors.csv", "summary.json"]);
    assert!(
        stdout(&output).contains("results/room"),
        "{}",
        stdout(&output)
    );
}

/// A lamp that lies flush in a ceiling is the documented way to place one: it opens no hole.
#[test]
fn a_lamp_flush_in_a_ceiling_is_no_defect() {
    let scene = crate::experiment::repository("scenes/unit-room.toml");
    let output = super::malus(&["check", super::word(&scene)])
        .output()
        .unwrap();
    let text = stdout(&output);
    assert!(
        !text.contains("boundary edges") && !text.contains("open along"),
        "{text}"
    );
}
