//! Whether intervals hold what they promise: short runs of one scene by many seeds.

use malus_estimator::{Answer, REPLICAS, Reading, half_width_95, run};
use malus_scene::Scene;

/// Runs a scene.
const SEEDS: u64 = 4000;

/// Student's t of a run at 97.5 %.
pub fn t() -> f64 {
    half_width_95(REPLICAS - 1)
}

/// Value and standard error of something that is read.
type Quantity = fn(&Reading) -> (f64, f64);

/// The paper's room with another material or other sensor points.
pub fn room(material: &str, points: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let toml = format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [[shape]]
        kind = 'disc'
        centre = [0.5, 0.5, 1]
        normal = [0, 0, -1]
        radius = 0.05
        material = 'lamp'
        [material.wall]
        {material}
        [material.lamp]
        rho = 0
        exitance = 1
        [[sensor]]
        name = 'point'
        points = [{points}]
        normal = [0, 0, 1]
        [run]
        samples = 1024"
    );
    std::fs::write(&path, toml).unwrap();
    Scene::load(&path, &[]).unwrap()
}

pub fn print() {
    println!("\n## Intervals\n");
    println!(
        "How often the 95 % interval (Student's t) of a run of 1,024 samples holds the mean of {SEEDS} such runs. That mean has an error of its own, 1/63 of one run's. Chance alone scatters a share of 95 % by ± 0.34 % (one standard deviation)."
    );
    println!(
        "*Bias* is the mean of all runs' deviations from a run of 4,194,304 samples, in standard errors of that difference.\n"
    );
    println!("| scene | quantity | covered, % | bias, z |");
    println!("|---|---|---|---|");
    let scenes = [
        (
            "a = 0.6, n = 1.5, (0.3, 0.4, 0)",
            room("rho = 0.5\na = 0.6", "[0.3, 0.4, 0]"),
        ),
        (
            "a = 0.9, n = 3, (0.3, 0.4, 0)",
            room("rho = 0.5\na = 0.9\nn = 3", "[0.3, 0.4, 0]"),
        ),
        (
            "gold, a = 0.5, a millimetre from a wall",
            room("rho = 0.5\na = 0.5\nn = 0.183\nk = 3.43", "[0.001, 0.4, 0]"),
        ),
    ];
    for (name, scene) in &scenes {
        report(name, scene);
    }
}

fn report(name: &str, scene: &Scene) {
    let read = |samples: u64, seed: u64| {
        let mut settings = scene.settings.clone();
        settings.seed = seed;
        settings.samples = Some(samples);
        run(scene, &settings, &mut |_| Answer::Continue).groups[0].readings[0]
    };
    let runs: Vec<Reading> = (1..=SEEDS).map(|seed| read(1024, seed)).collect();
    let long = read(1 << 22, 0);
    let quantities: [(&str, Quantity); 3] = [
        ("S0", |r| (r.stokes[0], r.standard_error[0])),
        ("S1", |r| (r.stokes[1], r.standard_error[1])),
        ("S0 − scalar S0", |r| {
            let scalar = r.scalar.unwrap();
            (scalar.difference, scalar.difference_standard_error)
        }),
    ];
    for (quantity, of) in quantities {
        let values: Vec<(f64, f64)> = runs.iter().map(of).collect();
        let count = values.len() as f64;
        let mean = values.iter().map(|v| v.0).sum::<f64>() / count;
        let squares: f64 = values.iter().map(|v| (v.0 - mean) * (v.0 - mean)).sum();
        let error = (squares / (count * (count - 1.0))).sqrt();
        let held = values
            .iter()
            .filter(|v| (v.0 - mean).abs() <= t() * v.1)
            .count();
        let (truth, its_error) = of(&long);
        println!(
            "| {name} | {quantity} | {:.2} | {:+.2} |",
            100.0 * held as f64 / count,
            (mean - truth) / error.hypot(its_error)
        );
    }
}
