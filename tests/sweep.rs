//! Studies: every variant says what a run of it alone would say, and differences are far better known than either side.

mod parquet;
mod parts;

use crate::cli::{Folder, ROOM, stderr};
use crate::experiment::{s0, scene};
use malus_estimator::{Answer, Cohort, Estimate, Sharing, run, run_together};
use malus_scene::{Scene, Settings};
use std::collections::BTreeMap;
use std::process::Output;
use std::sync::{Arc, LazyLock};

/// The room, glossy.
fn folder(study: &str, files: &[(&str, &[u8])]) -> Folder {
    let room = ROOM.replace("rho = 0.5", "rho = 0.5\na = 0.3");
    let folder = Folder::new(room.as_bytes(), files);
    let study = format!("scene = \"room.toml\"\n{study}");
    std::fs::write(folder.path("study.toml"), study).unwrap();
    folder
}

fn sweep(folder: &Folder, words: &[&str]) -> Output {
    folder.malus(&[&["sweep", "study.toml", "-o", "out"], words].concat())
}

/// Rows of `variants.csv` by their first field, each by its columns.
fn rows(folder: &Folder) -> BTreeMap<String, BTreeMap<String, String>> {
    let text = folder.text("out/variants.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let row = |record: csv::StringRecord| -> BTreeMap<String, String> {
        let fields = header.iter().zip(record.iter());
        fields
            .map(|(column, field)| (column.into(), field.into()))
            .collect()
    };
    let rows = reader.records().map(|record| record.unwrap());
    rows.map(|record| (record[0].to_owned(), row(record)))
        .collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

#[test]
fn every_variant_is_a_row_with_its_difference_to_the_base() {
    let study = "[grid]\n\"material.plaster.a\" = [0.1, 0.3]\n\"material.plaster.n\" = [1.5, 2]\n";
    let folder = folder(study, &[]);
    let output = sweep(&folder, &["--samples", "4096", "--quiet"]);
    assert_eq!(
        (output.status.code(), stderr(&output)),
        (Some(0), String::new())
    );
    let text = folder.text("out/variants.csv");
    assert_eq!(
        text.lines().next().unwrap(),
        "variant,material.plaster.a,material.plaster.n,desk_mean,desk_se_mean,desk_min,desk_u0,desk_dolp_mean,\
         desk_dmean,desk_se_dmean,status"
    );
    let rows = rows(&folder);
    let names: Vec<&str> = rows.keys().map(String::as_str).collect();
    assert_eq!(names, ["001", "002", "003", "004", "base"]);
    assert_eq!(rows["002"]["material.plaster.n"], "2");
    // The scene does not say n: it is the default.
    assert_eq!(
        (
            &*rows["base"]["material.plaster.a"],
            &*rows["base"]["material.plaster.n"]
        ),
        ("0.3", "1.5")
    );
    for name in ["base", "003"] {
        // The third variant is the base.
        assert_eq!(rows[name]["desk_dmean"], "0");
        assert_eq!(rows[name]["desk_se_dmean"], "0");
    }
    for name in ["001", "002", "004"] {
        let row = &rows[name];
        let difference = number(row, "desk_mean") - number(&rows["base"], "desk_mean");
        assert!((difference - number(row, "desk_dmean")).abs() < 1e-12);
        assert!(number(row, "desk_se_dmean") > 0.0);
    }
}

#[test]
fn a_variant_says_what_a_run_of_it_says() {
    let study =
        "[grid]\n\"material.plaster.a\" = [0, 0.5, 0.9]\n\"material.plaster.rho\" = [0.2, 0.7]\n";
    let folder = folder(study, &[]);
    let output = sweep(&folder, &["--samples", "16384", "--quiet", "--sensors"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for (name, row) in rows(&folder).iter().filter(|(name, _)| *name != "base") {
        let of = |key: &str| {
            format!(
                "material.plaster.{key}={}",
                row[&format!("material.plaster.{key}")]
            )
        };
        let (a, rho) = (of("a"), of("rho"));
        let options = [
            "--set",
            &a,
            "--set",
            &rho,
            "--samples",
            "16384",
            "--seed",
            "2",
            "--quiet",
        ];
        folder.run("alone", &options);
        let point = |path: &str| -> [f64; 2] {
            let text = folder.text(path);
            let fields: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
            [8, 12].map(|field| fields[field].parse().unwrap())
        };
        let [value, error] = point(&format!("out/variants/{name}/sensors.csv"));
        let [alone, error_alone] = point("alone/sensors.csv");
        let z = (value - alone) / error.hypot(error_alone);
        assert!(
            z.abs() < 4.5,
            "{name}: {value} ± {error}, alone {alone} ± {error_alone}: z = {z:.2}"
        );
        assert!(error <= 0.01 * value, "{name}: {value} ± {error}");
    }
}

#[test]
fn a_difference_of_geometry_is_better_known_than_the_errors_of_its_sides() {
    let study = "[grid]\n\"source.0.position\" = [[2, 1.5, 1.98], [2.05, 1.5, 2]]\n";
    let folder = folder(study, &[]);
    let output = sweep(&folder, &["--samples", "16384", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let rows = rows(&folder);
    for name in ["001", "002"] {
        let row = &rows[name];
        let independent = number(row, "desk_se_mean").hypot(number(&rows["base"], "desk_se_mean"));
        let paired = number(row, "desk_se_dmean");
        assert!(
            3.0 * paired < independent,
            "{name}: {paired}, independent {independent}"
        );
    }
}

#[test]
fn a_variant_that_fails_is_named_and_the_others_are_finished() {
    let study = "[grid]\n\"material.plaster.a\" = [0.1, 1.5, 0.2]\n";
    let folder = folder(study, &[]);
    let output = sweep(&folder, &[]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    let wrong = "study.toml:3:30: [material.plaster] a must be a number from 0 to 1, found 1.5";
    assert!(told.contains(&format!("warning: {wrong}")), "{told}");
    assert!(
        told.contains(&format!("error: variant 002: {wrong}")),
        "{told}"
    );
    assert!(told.contains("1 of 3 variants failed: 002"), "{told}");
    let rows = rows(&folder);
    let states: Vec<&str> = rows.values().map(|row| row["status"].as_str()).collect();
    assert_eq!(states, ["ok", "failed", "ok", "ok"]);
    assert_eq!(rows["002"]["desk_mean"], "");
    assert_eq!(folder.json("out/study.json")["failed"][0], "002");
}

#[test]
fn an_unknown_key_or_an_empty_grid_is_refused_before_anything_is_written() {
    for (study, wrong) in [
        (
            "[grid]\n\"material.plaster.rhoo\" = [0.1]",
            "error: study.toml:3:1: [material.plaster] has no key \"rhoo\"; the nearest is \"rho\"",
        ),
        (
            "[grid]\n\"material.plastr.rho\" = [0.1]",
            "error: study.toml:3:1: no material is called \"plastr\"; the nearest is \"plaster\"",
        ),
        (
            "[grid]\n\"material.plaster.rho\" = []",
            "error: study.toml:3:26: [grid] material.plaster.rho must be a list of one value or more, found a list of 0",
        ),
        (
            "[list]\nfile = \"v.csv\"",
            "error: v.csv:2:11: [material.plaster] has no key \"aa\"",
        ),
    ] {
        let folder = folder(
            study,
            &[(
                "v.csv",
                b"# no\nrun.model,material.plaster.aa\nscalar,0.1\n",
            )],
        );
        let output = sweep(&folder, &[]);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.starts_with(wrong), "{told}");
        assert!(
            !folder.path("out").exists(),
            "results of a study that is wrong"
        );
    }
}

#[test]
fn a_study_says_which_variants_differ_and_which_key_matters() {
    let study =
        "[grid]\n\"material.plaster.rho\" = [0.3, 0.5, 0.7]\n\"material.plaster.k\" = [0, 0.01]\n";
    let folder = folder(study, &[]);
    let output = sweep(&folder, &["--samples", "4096", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let study = folder.json("out/study.json");
    let desk = &study["sensors"][0];
    let differs: Vec<bool> = desk["variants"]
        .as_array()
        .unwrap()
        .iter()
        .map(|variant| variant["differs"].as_bool().unwrap())
        .collect();
    // The reflectance changes the illuminance, an extinction of 0.01 hardly does; the third variant is the base.
    assert_eq!(
        [differs[0], differs[1], differs[2], differs[4], differs[5]],
        [true, true, false, true, true]
    );
    let share = |key: usize| {
        desk["sensitivity"][key]["mean"]["share"]["value"]
            .as_f64()
            .unwrap()
    };
    assert!(
        share(0) > 0.95 && share(1) < 0.01,
        "{} {}",
        share(0),
        share(1)
    );
    let best = desk["ranking"][0]["variant"].as_str().unwrap();
    assert!(["005", "006"].contains(&best), "{best}");
    assert!(folder.text("out/desk-trade.svg").starts_with("<svg "));
}

/// A closed room of two materials and a small lamp, with the values that vary.
fn room(a: f64, rho: f64, n: f64, exitance: f64) -> Scene {
    scene(&format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [[shape]]
        kind = 'rectangle'
        origin = [0, 0, 0]
        u = [1, 0, 0]
        v = [0, 1, 0]
        material = 'floor'
        [[shape]]
        kind = 'sphere'
        centre = [0.4, 0.6, 0.7]
        radius = 0.1
        subdivisions = 2
        material = 'lamp'
        [material.wall]
        rho = 0.6
        a = 0.2
        [material.floor]
        rho = {rho}
        a = {a}
        n = {n}
        [material.lamp]
        rho = 0.1
        exitance = {exitance}
        [[source]]
        kind = 'point'
        position = [0.7, 0.3, 0.8]
        intensity = 0.05
        [[sensor]]
        name = 'board'
        points = [[0.5, 0.05, 0.4]]
        normal = [0, 1, 0]"
    ))
}

/// One scene of [`room`] together with others: they do not lie on one another's optics, but walks serve all.
fn varied() -> [Scene; 4] {
    [
        room(0.3, 0.5, 1.5, 3.0),
        room(0.0, 0.7, 1.5, 2.0),
        room(0.6, 0.2, 2.2, 4.0),
        room(0.1, 0.5, 1.3, 3.0),
    ]
}

/// The deviation of the last of the rooms, evaluated with the others, from itself alone by other numbers.
pub fn deviation(rooms: &[Scene], seed: u64, samples: u64) -> f64 {
    let settings = |seed| Settings {
        seed,
        samples: Some(samples),
        relative_error: None,
        ..rooms[0].settings.clone()
    };
    let scenes: Vec<&Scene> = rooms.iter().collect();
    let together = run_together(&scenes, &settings(seed), Sharing::Points, &mut |_| {
        Answer::Continue
    });
    let last = together.others.last().unwrap();
    let alone = run(
        scenes[scenes.len() - 1],
        &settings(seed + 1_000_000),
        &mut |_| Answer::Continue,
    );
    let [one, other] = [&last[0], &alone.groups[0]].map(|group| s0(&group.readings[0]));
    (one.0 - other.0) / one.1.hypot(other.1)
}

#[test]
fn walks_serve_scenes_that_differ_in_numbers_of_their_surfaces_alone() {
    let rooms = varied();
    let admits = |one: &Scene, other: &Scene| Cohort::of(one).admit(other);
    // Each has surfaces of its own here; a study shares them.
    assert!(!admits(&rooms[0], &rooms[1]));
    let shared = |mut it: Scene| {
        it.surfaces = Arc::clone(&SHARED.surfaces);
        it
    };
    let [first, others @ ..] = rooms.map(shared);
    let mut cohort = Cohort::of(&first);
    assert!(others.iter().all(|other| cohort.admit(other)));
    // An ideal mirror where another variant has a white wall would leave neither good walks.
    let mirror = shared(room(1.0, 0.0, f64::INFINITY, 3.0));
    let white = shared(room(0.0, 0.95, 1.5, 3.0));
    assert!(!admits(&mirror, &white) && admits(&first, &white));
}

static SHARED: LazyLock<Scene> = LazyLock::new(|| room(0.3, 0.5, 1.5, 3.0));

/// Σ z² over 48 seeds is χ² of 48 degrees of freedom; the mean of z has the standard deviation 1/√48. The test of the
/// whole distribution over 400 seeds is in `examples/validate`.
#[test]
fn deviations_from_single_runs_are_those_of_chance() {
    let rooms = varied();
    let deviations: Vec<f64> = (0..48)
        .map(|seed| deviation(&rooms, 1 + seed, 512))
        .collect();
    let count = deviations.len() as f64;
    let mean = deviations.iter().sum::<f64>() / count;
    let squares: f64 = deviations.iter().map(|z| z * z).sum();
    assert!(mean.abs() < 4.5 / count.sqrt(), "mean of z: {mean}");
    assert!(
        (squares - count).abs() < 4.5 * (2.0 * count).sqrt(),
        "Σ z² = {squares}"
    );
}

#[test]
fn a_difference_along_the_same_walks_is_ten_times_better_known_than_one_of_independent_runs() {
    // Neighbours on the grid of a study: a tenth of the polish.
    let rooms = [room(0.3, 0.5, 1.5, 3.0), room(0.4, 0.5, 1.5, 3.0)];
    let settings = Settings {
        samples: Some(8192),
        relative_error: None,
        ..rooms[0].settings.clone()
    };
    let scenes: Vec<&Scene> = rooms.iter().collect();
    let together = run_together(&scenes, &settings, Sharing::Points, &mut |_| {
        Answer::Continue
    });
    let [one, other] = [&together.first.groups[0], &together.others[0][0]];
    let pairs = one.replicates.mean.iter().zip(&other.replicates.mean);
    let differences: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
    let paired = Estimate::of(&differences).standard_error;
    let independent = one.mean_standard_error.hypot(other.mean_standard_error);
    assert!(
        paired > 0.0 && 10.0 * paired < independent,
        "{paired}, independent {independent}"
    );
}
