//! Exact answers of whole rooms.

use crate::Row;
use malus_estimator::{Answer, Reading, run};
use malus_scene::Scene;
use std::f64::consts::PI;

/// Readings of a scene of this repository with some of its keys set.
pub fn readings(file: &str, changes: &[(&str, &str)]) -> Vec<Reading> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let overrides: Vec<malus_scene::Override> = changes
        .iter()
        .map(|(key, value)| malus_scene::Override {
            key: (*key).into(),
            value: (*value).into(),
        })
        .collect();
    let scene = Scene::load(&path, &overrides).unwrap();
    let results = run(&scene, &scene.settings, &mut |_| Answer::Continue);
    results
        .groups
        .into_iter()
        .flat_map(|group| group.readings)
        .collect()
}

pub fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    diffuse(&mut rows);
    mirrored(&mut rows);
    rows
}

fn diffuse(rows: &mut Vec<Row>) {
    let exact = [3.09795e-3, 3.37907e-3, 3.60136e-3, 3.74677e-3, 3.79783e-3];
    for (estimator, samples) in [("local", "4194304"), ("gather", "1048576")] {
        let changes = [
            ("material.plaster.a", "0"),
            ("run.estimator", estimator),
            ("run.samples", samples),
            ("run.compare", "[]"),
        ];
        for (i, (reading, expected)) in readings("scenes/unit-room.toml", &changes)
            .iter()
            .zip(exact)
            .enumerate()
        {
            rows.push(Row {
                what: format!("paper's room, a = 0, x = 0.{}, by {estimator}", i + 1),
                source: "radiosity, converged",
                expected,
                got: reading.stokes[0],
                error: reading.standard_error[0].hypot(4e-5 * expected),
                test: "unit_room",
            });
        }
    }
}

fn mirrored(rows: &mut Vec<Row>) {
    // Two lines of the floor; of each the first points, as many as there are rows.
    let lines = [
        (
            "{ from = [0.25, 0.25, 0], to = [0.75, 0.25, 0], count = 3 }",
            &MIRRORED[..2],
        ),
        (
            "{ from = [0.5, 0.5, 0], to = [0.75, 0.5, 0], count = 2 }",
            &MIRRORED[2..],
        ),
    ];
    let digits = 0.5e-6 / 3f64.sqrt();
    for (line, table) in lines {
        let changes = [
            ("material.plaster.a", "1"),
            ("sensor.floor.line", line),
            ("run.samples", "16777216"),
            ("run.compare", "['scalar']"),
        ];
        for (reading, row) in readings("scenes/unit-room.toml", &changes)
            .iter()
            .zip(table)
        {
            mirrored_point(rows, reading, row, digits);
        }
    }
}

/// Point, scalar Fresnel, Stokes, relative difference at a = 1 and unit luminance, by images alone.
const MIRRORED: [(&str, f64, f64, f64); 3] = [
    ("(0.25, 0.25)", 0.006_728, 0.006_715, -1.966e-3),
    ("(0.50, 0.25)", 0.007_421, 0.007_411, -1.376e-3),
    ("(0.50, 0.50)", 0.008_250, 0.008_242, -9.71e-4),
];

fn mirrored_point(
    rows: &mut Vec<Row>,
    reading: &Reading,
    row: &(&str, f64, f64, f64),
    digits: f64,
) {
    let (point, scalar, stokes, difference) = *row;
    let paired = reading.scalar.unwrap();
    let mut push = |what: &str, expected, got, error| {
        rows.push(Row {
            what: format!("paper's room, a = 1, {point}, {what}"),
            source: "images",
            expected,
            got,
            error,
            test: "unit_room",
        });
    };
    push(
        "scalar",
        scalar,
        PI * paired.value,
        (PI * paired.standard_error).hypot(digits),
    );
    push(
        "Stokes",
        stokes,
        PI * reading.stokes[0],
        (PI * reading.standard_error[0]).hypot(digits),
    );
    let relative = paired.difference_standard_error / paired.value;
    push(
        "relative difference",
        difference,
        paired.difference / paired.value,
        relative.hypot(5e-7),
    );
}
