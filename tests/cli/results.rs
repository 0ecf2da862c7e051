//! What a run leaves behind: tables, plans, summary, in the form that scripts hold on to.

mod plans;

use super::{Folder, ROOM, malus, room_with, stderr, word};
use crate::experiment::{evaluate, repository};
use malus_estimator::Reading;
use malus_scene::Scene;
use std::path::{Path, PathBuf};

const SENSORS: &str = "sensor,index,x_m,y_m,z_m,nx,ny,nz,s0,s1,s2,s3,se0,se1,se2,se3,dolp,se_dolp,s0_scalar,se_s0_scalar,ds0,se_ds0,s0_diffuse,dd0,se_dd0,status";

const GRIDS: &str = "sensor,count,enclosed,mean,se_mean,min,max,u0,dolp_mean";

/// A glossy room with a solid block in it, a grid of which one point lies within that block, and a row; all compared.
const FURNISHED: &str = r#"[scene]
name = "A < B & \"C\""
[[shape]]
kind = "box"
min = [0, 0, 0]
max = [4, 3, 2.5]
inward = true
material = "plaster"
[[shape]]
kind = "box"
min = [1, 1, 0.25]
max = [2, 2, 1]
material = "plaster"
[[source]]
kind = "point"
position = [2.5, 1.5, 2]
intensity = 10
[material.plaster]
rho = 0.5
a = 0.4
[[sensor]]
name = "Desk & shelf"
grid = { origin = [0, 0, 0.75], u = [4, 0, 0], v = [0, 3, 0], counts = [4, 3] }
normal = [0, 0, 1]
[[sensor]]
name = "row"
line = { from = [0.5, 0.5, 1.5], to = [3.5, 0.5, 1.5], count = 3 }
normal = [0.6, 0, 0.8]
[run]
compare = ["scalar", "diffuse"]
samples = 256
"#;

fn furnished(words: &[&str]) -> Folder {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    folder.run("out", words);
    folder
}

/// Fields of the rows below the header.
fn rows(table: &str) -> Vec<Vec<String>> {
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let rows = reader
        .records()
        .map(|row| row.unwrap().iter().map(str::to_owned).collect());
    rows.collect()
}

fn scenes() -> Vec<PathBuf> {
    let toml = |folder: &PathBuf| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        entries.collect()
    };
    let mut files = toml(&repository("scenes"));
    let folders: Vec<PathBuf> = files.iter().filter(|path| path.is_dir()).cloned().collect();
    files.extend(folders.iter().flat_map(toml));
    files.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "toml")
    });
    files.sort();
    files
}

/// Whether a file is a study of a scene.
fn is_study(path: &Path) -> bool {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().any(|line| line.starts_with("scene = "))
}

#[test]
fn every_study_of_the_project_runs() {
    let studies: Vec<PathBuf> = scenes().into_iter().filter(|it| is_study(it)).collect();
    assert!(!studies.is_empty());
    for study in studies {
        let folder = tempfile::tempdir().unwrap();
        let words = [
            "sweep",
            word(&study),
            "-o",
            word(folder.path()),
            "--samples",
            "64",
            "--quiet",
        ];
        let output = malus(&words).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(folder.path().join("variants.csv").is_file());
    }
}

#[test]
fn every_scene_of_the_project_passes_check_and_runs() {
    let scenes = scenes();
    assert!(!scenes.is_empty());
    for scene in scenes.into_iter().filter(|it| !is_study(it)) {
        let output = malus(&["check", word(&scene)]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let folder = tempfile::tempdir().unwrap();
        let words = [
            "run",
            word(&scene),
            "-o",
            word(folder.path()),
            "--samples",
            "64",
            "--no-pictures",
        ];
        let output = malus(&words).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let table = std::fs::read_to_string(folder.path().join("sensors.csv")).unwrap();
        assert!(
            rows(&table)
                .iter()
                .any(|row| row[25] == "ok" && row[8].parse::<f64>().unwrap() > 0.0),
            "{scene:?}"
        );
    }
}

#[test]
fn numbers_read_back_to_the_bits_that_were_computed() {
    let folder = furnished(&[]);
    let table = folder.text("out/sensors.csv");
    assert_eq!(table.lines().next(), Some(SENSORS));
    let scene = Scene::load(&folder.path("room.toml"), &[]).unwrap();
    let results = evaluate(&scene);
    let mut rows = rows(&table).into_iter();
    for (sensor, group) in scene.sensors.iter().zip(&results.groups) {
        for (index, (point, reading)) in sensor.points.iter().zip(&group.readings).enumerate() {
            let row = rows.next().unwrap();
            assert_eq!((&row[0], &row[1]), (&sensor.name, &index.to_string()));
            let expected = [point.position.to_array(), point.normal.to_array()].concat();
            assert_bits(&row[2..8], &expected);
            if reading.enclosed {
                assert!(row[8..25].iter().all(String::is_empty), "{row:?}");
                assert_eq!(row[25], "enclosed");
            } else {
                assert_bits(&row[8..25], &values(reading));
                assert_eq!(row[25], "ok");
            }
        }
    }
    assert_eq!(rows.next(), None);
}

/// The columns from `s0` to `se_dd0`.
fn values(reading: &Reading) -> Vec<f64> {
    let (scalar, diffuse) = (reading.scalar.unwrap(), reading.diffuse.unwrap());
    let mut values = [reading.stokes, reading.standard_error].concat();
    values.extend([reading.dolp, reading.dolp_standard_error]);
    values.extend([
        scalar.value,
        scalar.standard_error,
        scalar.difference,
        scalar.difference_standard_error,
    ]);
    values.extend([
        diffuse.value,
        diffuse.difference,
        diffuse.difference_standard_error,
    ]);
    values
}

#[track_caller]
fn assert_bits(fields: &[String], values: &[f64]) {
    let bits = |values: &[f64]| {
        values
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    let read: Vec<f64> = fields.iter().map(|field| field.parse().unwrap()).collect();
    assert_eq!(bits(&read), bits(values), "{fields:?} for {values:?}");
}

#[test]
fn what_was_not_asked_for_is_an_empty_field() {
    let folder = furnished(&["--set", "run.compare=[]"]);
    for row in rows(&folder.text("out/sensors.csv")) {
        assert!(row[18..25].iter().all(String::is_empty), "{row:?}");
        assert_eq!(row[8].is_empty(), row[25] == "enclosed", "{row:?}");
    }
    let folder = furnished(&["--model", "scalar"]);
    for row in rows(&folder.text("out/sensors.csv"))
        .iter()
        .filter(|row| row[25] == "ok")
    {
        // The scalar model is the main one here: the same number, and a difference of nothing.
        assert_eq!([&row[8], &row[12]], [&row[18], &row[19]], "{row:?}");
        assert_eq!([&row[20], &row[21]], ["0", "0"], "{row:?}");
        assert_eq!(
            [&row[9], &row[10], &row[11], &row[13]],
            ["0", "0", "0", "0"],
            "{row:?}"
        );
    }
}

#[test]
fn a_point_within_a_solid_is_marked_and_takes_no_part_in_the_means() {
    let folder = furnished(&[]);
    let all = rows(&folder.text("out/sensors.csv"));
    let enclosed: Vec<&str> = all
        .iter()
        .filter(|row| row[25] == "enclosed")
        .map(|row| row[1].as_str())
        .collect();
    // Cell centres of the grid: the point at x = y = 1.5 is number 5, and the block reaches from 1 to 2.
    assert_eq!(enclosed, ["5"]);

    let table = folder.text("out/grids.csv");
    assert_eq!(table.lines().next(), Some(GRIDS));
    let grids = rows(&table);
    assert_eq!(grids.len(), 2);
    for (grid, [count, enclosed]) in grids.iter().zip([["12", "1"], ["3", "0"]]) {
        let free = all
            .iter()
            .filter(|row| row[0] == grid[0] && row[25] == "ok");
        let s0: Vec<f64> = free.map(|row| row[8].parse().unwrap()).collect();
        let mean = s0.iter().sum::<f64>() / s0.len() as f64;
        let (min, max) = (
            s0.iter().copied().fold(f64::MAX, f64::min),
            s0.iter().copied().fold(0.0, f64::max),
        );
        assert_eq!([&grid[1], &grid[2]], [count, enclosed]);
        for (field, expected) in [(3, mean), (5, min), (6, max), (7, min / mean)] {
            let found: f64 = grid[field].parse().unwrap();
            assert!(
                (found / expected - 1.0).abs() < 1e-14,
                "{field}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn the_summary_has_all_that_scripts_look_for() {
    let folder = furnished(&["--seed", "7", "--threads", "1"]);
    let summary = folder.json("out/summary.json");
    for (key, expected) in [
        ("scene", "A < B & \"C\"".into()),
        ("unit", "lm".into()),
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("seed", 7.into()),
        ("model", "polarised".into()),
        ("representation", "linear".into()),
        ("samples", 256.into()),
        ("threads", 1.into()),
        ("triangles", 24.into()),
        ("complete", true.into()),
    ] {
        let expected: serde_json::Value = expected;
        assert_eq!(summary[key], expected, "{key}");
    }
    assert!(
        ["local", "gather", "auto"]
            .iter()
            .any(|name| summary["estimator"] == *name),
        "{summary}"
    );
    assert!(summary["dof"].as_u64().unwrap() >= 31, "{summary}");
    assert!(summary["seconds"].as_f64().unwrap() > 0.0);
    let error = summary["relative_error_max"].as_f64().unwrap();
    assert!(error > 0.0 && error < 1.0, "{error}");
    let warnings = summary["warnings"].as_array().unwrap();
    assert!(
        warnings.iter().all(serde_json::Value::is_string),
        "{warnings:?}"
    );
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    for threads in ["1", "2", "3"] {
        folder.run(threads, &["--threads", threads]);
    }
    for file in ["sensors.csv", "grids.csv"] {
        let [one, two, three] =
            ["1", "2", "3"].map(|threads| folder.text(&format!("{threads}/{file}")));
        assert!(one == two && two == three, "{file}");
    }
}

#[test]
fn another_seed_gives_other_numbers_and_the_same_seed_the_same() {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    for (name, seed) in [("a", "1"), ("b", "2"), ("c", "2")] {
        folder.run(name, &["--seed", seed]);
    }
    assert_ne!(folder.text("a/sensors.csv"), folder.text("b/sensors.csv"));
    assert_eq!(folder.text("b/sensors.csv"), folder.text("c/sensors.csv"));
}

#[test]
fn a_set_value_takes_the_place_of_the_files() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    folder.run("grey", &[]);
    folder.run("black", &["--set", "material.plaster.rho=0"]);
    let s0 = |name: &str| -> f64 {
        rows(&folder.text(&format!("{name}/sensors.csv")))[0][8]
            .parse()
            .unwrap()
    };
    // Straight from the lamp, 1.25 m above: I/d².
    assert!(
        (s0("black") / (10.0 / 1.25_f64.powi(2)) - 1.0).abs() < 1e-12,
        "{}",
        s0("black")
    );
    assert!(s0("grey") > 1.1 * s0("black"));
    let scene = Folder::new(room_with("rho = 0.5", "rho = 0").as_bytes(), &[]);
    scene.run("out", &[]);
    assert_eq!(
        scene.text("out/sensors.csv"),
        folder.text("black/sensors.csv")
    );
}

#[test]
fn a_picture_that_cannot_be_written_costs_no_reading() {
    let scene = format!(
        "[[camera]]
        name = 'view'
        position = [1, 1, 1.5]
        look_at = [3, 2, 0.5]
        width = 8
        height = 6
        samples = 1
        {FURNISHED}"
    );
    let folder = Folder::new(scene.as_bytes(), &[("out/", b""), ("out/view.tiff/", b"")]);
    let output = folder.malus(&["run", "room.toml", "-o", "out"]);
    assert_eq!(output.status.code(), Some(1));
    let told = stderr(&output);
    assert!(told.contains("view.tiff: cannot be written"), "{told}");
    assert_eq!(rows(&folder.text("out/sensors.csv")).len(), 15);
    assert_eq!(folder.json("out/summary.json")["complete"], false);
}
