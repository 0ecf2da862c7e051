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

/// Two infinite planes: a box whose side walls are ideal mirrors, with a point source in its middle.
pub fn planes() -> impl Iterator<Item = Row> {
    let side = |origin: &str, u: &str, v: &str, material: &str| {
        format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [{origin}]
            u = [{u}]
            v = [{v}]
            material = '{material}'
            "
        )
    };
    let shapes = [
        side("0, 0, 0", "1, 0, 0", "0, 1, 0", "plane"),
        side("0, 1, 1", "1, 0, 0", "0, -1, 0", "plane"),
        side("0, 0, 0", "0, 1, 0", "0, 0, 1", "side"),
        side("1, 0, 0", "0, 0, 1", "0, 1, 0", "side"),
        side("0, 0, 0", "0, 0, 1", "1, 0, 0", "side"),
        side("0, 1, 0", "1, 0, 0", "0, 0, 1", "side"),
    ]
    .concat();
    // Three as tabulated elsewhere, which holds the formula; three more by it. Each with the samples that leave 0.03 %.
    let table = [
        (0.5, 1.5, 0.6, 8192, Some((1.497_205_45, 1.506_296_41))),
        (0.8, 2.0, 0.5, 24_576, None),
        (0.3, 4.0, 0.7, 8192, None),
        (0.9, 1.3, 0.3, 40_960, None),
        (0.5, 1.5, 0.9, 49_152, Some((1.516_864_96, 1.551_665_49))),
        (0.5, 3.0, 0.9, 32_768, Some((1.719_757_70, 2.002_682_83))),
    ];
    table.into_iter().flat_map(move |row| {
        let (rho, n, f, samples, tabulated) = row;
        let mut rows = Vec::new();
        let (without, with) = flux(rho, n, f);
        if let Some((other_without, other_with)) = tabulated {
            assert!((without - other_without).abs() < 1e-8 && (with - other_with).abs() < 1e-8);
        }
        let readings = crate::closed::measured(&format!(
            "{shapes}
            [material.plane]
            rho = {rho}
            a = {f}
            n = {n}
            [material.side]
            rho = 0
            a = 1
            n = inf
            [[source]]
            kind = 'point'
            position = [0.5, 0.5, 0.5]
            intensity = 1
            [[sensor]]
            name = 'floor'
            grid = {{ origin = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0], counts = [8, 8] }}
            normal = [0, 0, 1]
            [run]
            samples = {samples}"
        ));
        let count = readings.len() as f64;
        // Sensors share the walks from the emitter, which bring little here: their errors are taken as independent.
        let mean = |of: &dyn Fn(&Reading) -> (f64, f64)| {
            let values = readings.iter().map(of);
            let (sum, squares) = values.fold((0.0, 0.0), |(s, q), (value, error)| {
                (s + value, q + error * error)
            });
            (
                sum / count / (2.0 * PI),
                squares.sqrt() / count / (2.0 * PI),
            )
        };
        let mut push = |what: &str, expected, (got, error)| {
            rows.push(Row {
                what: format!("ρ = {rho}, n = {n}, f = {f}, {what}"),
                source: "parallel planes",
                expected,
                got,
                error,
                test: "direct, complete",
            });
        };
        push(
            "Stokes",
            with,
            mean(&|r| (r.stokes[0], r.standard_error[0])),
        );
        let scalar = |r: &Reading| r.scalar.unwrap();
        push(
            "scalar",
            without,
            mean(&|r| (scalar(r).value, scalar(r).standard_error)),
        );
        let difference = |r: &Reading| (scalar(r).difference, scalar(r).difference_standard_error);
        push("difference", with - without, mean(&difference));
        rows
    })
}

/// Flux on a plane over 2π I0 without and with polarisation: B/(1 − (1 − f) ρ A) with A = ∫ 2μ g dμ and B = ∫ g dμ, where
/// g = 1/(1 − f (Rs + Rp)/2) or ½ [1/(1 − f Rs) + 1/(1 − f Rp)]. A chain of mirrors keeps its angle and its plane.
fn flux(rho: f64, n: f64, f: f64) -> (f64, f64) {
    // The midpoint rule in μ = x², which flattens what is steep at grazing angles.
    let count = 100_000;
    let mut sums = [[0.0; 2]; 2];
    for i in 0..count {
        let x = (f64::from(i) + 0.5) / f64::from(count);
        let mu = x * x;
        let refracted = (n * n - 1.0 + mu * mu).sqrt();
        let s = ((mu - refracted) / (mu + refracted)).powi(2);
        let p = ((n * n * mu - refracted) / (n * n * mu + refracted)).powi(2);
        let gains = [
            1.0 / (1.0 - f * 0.5 * (s + p)),
            0.5 / (1.0 - f * s) + 0.5 / (1.0 - f * p),
        ];
        let width = 2.0 * x / f64::from(count);
        for (sums, gain) in sums.iter_mut().zip(gains) {
            sums[0] += 2.0 * mu * gain * width;
            sums[1] += gain * width;
        }
    }
    let [without, with] = sums.map(|[a, b]| b / (1.0 - (1.0 - f) * rho * a));
    (without, with)
}

fn diffuse(rows: &mut Vec<Row>) {
    let exact = [3.09795e-3, 3.37907e-3, 3.60136e-3, 3.74677e-3, 3.79783e-3];
    for (estimator, samples) in [
        ("local", "4194304"),
        ("gather", "1048576"),
        ("auto", "262144"),
    ] {
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
            ("run.samples", "262144"),
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
