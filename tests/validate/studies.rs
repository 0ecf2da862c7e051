//! Whether a variant that shares its walks with others says what a run of it alone says.

use malus_estimator::{Answer, Sharing, run, run_together};
use malus_scene::{Override, Scene, Settings};
use std::path::Path;

/// Runs of either kind.
const SEEDS: u64 = 400;

/// Floors of the office: polish, reflectance, refractive index. The last one is held against runs of its own.
const FLOORS: [[f64; 3]; 4] = [
    [0.6, 0.15, 1.52],
    [0.0, 0.4, 1.52],
    [0.9, 0.1, 1.9],
    [0.3, 0.25, 1.4],
];

fn floor([a, rho, n]: [f64; 3]) -> Scene {
    let values = [("a", a), ("rho", rho), ("n", n)];
    let overrides = values.map(|(key, value)| Override {
        key: format!("material.Floor_Gloss.{key}"),
        value: value.to_string(),
    });
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/office.toml");
    Scene::load(&path, &overrides).unwrap()
}

/// Deviation of S0 at the board's first point between a variant among others and the same alone, in standard errors.
fn deviation(floors: &[Scene], seed: u64) -> f64 {
    let settings = |seed| Settings {
        seed,
        samples: Some(256),
        relative_error: None,
        ..floors[0].settings.clone()
    };
    let scenes: Vec<&Scene> = floors.iter().collect();
    let last = scenes[scenes.len() - 1];
    let board = last
        .sensors
        .iter()
        .position(|it| it.name == "SENSOR_Board")
        .unwrap();
    let together = run_together(&scenes, &settings(seed), Sharing::Points, &mut |_| {
        Answer::Continue
    });
    let alone = run(last, &settings(1_000_000 + seed), &mut |_| Answer::Continue);
    let [one, other] = [&together.others[scenes.len() - 2], &alone.groups].map(|groups| {
        let reading = &groups[board].readings[0];
        (reading.stokes[0], reading.standard_error[0])
    });
    (one.0 - other.0) / one.1.hypot(other.1)
}

pub fn print() {
    println!("\n## Studies\n");
    println!(
        "A variant of the Blender office evaluated along the walks of four, against runs of it alone: z of S0 at one point over {SEEDS} seeds of 256 samples, held against N(0, 1) by the test of Kolmogorov and Smirnov.\n"
    );
    let floors = FLOORS.map(floor);
    let mut deviations: Vec<f64> = (1..=SEEDS).map(|seed| deviation(&floors, seed)).collect();
    deviations.sort_by(f64::total_cmp);
    let count = deviations.len() as f64;
    let mean = deviations.iter().sum::<f64>() / count;
    let square = deviations.iter().map(|z| z * z).sum::<f64>() / count;
    let distance = deviations.iter().enumerate().map(|(index, z)| {
        let expected = normal(*z);
        let (below, above) = (index as f64 / count, (index as f64 + 1.0) / count);
        (expected - below).abs().max((above - expected).abs())
    });
    let distance = distance.fold(0.0, f64::max);
    println!("| mean of z | mean of z² | greatest distance | p |");
    println!("|---|---|---|---|");
    println!(
        "| {mean:+.3} | {square:.3} | {distance:.4} | {:.3} |",
        p_value(distance, count)
    );
}

/// Distribution function of the normal distribution.
fn normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z / std::f64::consts::SQRT_2)
}

/// Probability of such a distance or more (Stephens 1970).
fn p_value(distance: f64, count: f64) -> f64 {
    let root = count.sqrt();
    let scaled = (root + 0.12 + 0.11 / root) * distance;
    let term = |k: i32| {
        let k = f64::from(k);
        let sign = if k as i32 % 2 == 1 { 1.0 } else { -1.0 };
        2.0 * sign * (-2.0 * k * k * scaled * scaled).exp()
    };
    (1..=100).map(term).sum::<f64>().clamp(0.0, 1.0)
}
