//! Studies: every variant says what a run of it alone would say, and differences are far better known than either side.

use crate::cli::{Folder, ROOM, stderr};
use std::collections::BTreeMap;
use std::process::Output;

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
    // The scene does not say n.
    assert_eq!(
        (
            &*rows["base"]["material.plaster.a"],
            &*rows["base"]["material.plaster.n"]
        ),
        ("0.3", "")
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
    let wrong = "study.toml:3:31: [material.plaster] a must be a number from 0 to 1, found 1.5";
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
