//! Whether a run that stops by its error is as good as one of a fixed length: no bias, and intervals that hold.

use crate::coverage::{room, t};
use malus_estimator::{Answer, run};
use malus_scene::{Estimator, Scene};
use rayon::prelude::*;

/// Runs a case.
const SEEDS: u64 = 4000;

/// What is aimed at, in errors of a run of `SHORT` samples: with much less and with much more luck decides when a run
/// stops, and how early it is judged at all.
const SHARES: [f64; 2] = [0.7, 2.0];

/// Samples of a run that ends at the first checkpoint at which any run is judged.
const SHORT: u64 = 1024;

/// Samples of the run that is taken for the truth where none is known.
const LONG: u64 = 1 << 20;

/// A scene that is run until its error is small enough.
struct Case {
    name: &'static str,
    scene: Scene,
    estimator: Estimator,
    /// S0, where it is known.
    exact: Option<f64>,
}

/// One run.
struct Outcome {
    /// S0 at each point, with its standard error.
    readings: Vec<(f64, f64)>,
    samples: u64,
    relative_error: f64,
}

impl Case {
    fn run(&self, seed: u64, samples: Option<u64>, relative_error: Option<f64>) -> Outcome {
        let mut settings = self.scene.settings.clone();
        settings.estimator = self.estimator;
        settings.compare_scalar = false;
        settings.seed = seed;
        settings.samples = samples;
        settings.relative_error = relative_error;
        let results = run(&self.scene, &settings, &mut |_| Answer::Continue);
        Outcome {
            readings: results.groups[0]
                .readings
                .iter()
                .map(|reading| (reading.stokes[0], reading.standard_error[0]))
                .collect(),
            samples: results.samples,
            relative_error: results.relative_error_max,
        }
    }
}

pub fn print() {
    println!("\n## Stopping by error\n");
    println!(
        "{SEEDS} runs of each case by different seeds, each stopped at the first checkpoint at which the standard error is at most the share aimed at, at every point: {} or {} times that of a run of {SHORT} samples, so that some runs stop at once and some later.",
        SHARES[0], SHARES[1]
    );
    println!(
        "*Bias* is the mean deviation of the stopped runs from the exact answer, or from a run of {LONG} samples, in standard deviations of one stopped run; of several points the worst is told. Chance in the stopped runs and in the long one scatters it by the number behind ±."
    );
    println!(
        "*Covered* is how often the 95 % interval (Student's t) of a stopped run holds that value, and beside it how often that of a run does which was given the median number of samples instead; of several points the mean.\n"
    );
    println!(
        "| scene | estimator | aimed at, % | samples, 5 % … 95 % | bias, stopped | covered, %: stopped | of fixed length |"
    );
    println!("|---|---|---|---|---|---|---|");
    for case in cases() {
        for share in SHARES {
            report(&case, share);
        }
    }
}

fn cases() -> Vec<Case> {
    let open = "[0.3, 0.4, 0]";
    let glossy = "rho = 0.5\na = 0.6";
    let case = |name, material: &str, points: &str| Case {
        name,
        scene: room(material, points),
        estimator: Estimator::Auto,
        exact: None,
    };
    vec![
        Case {
            // The lamp too: every surface emits and reflects alike. Walks that correct a guess leave nothing to chance there.
            scene: furnace(),
            estimator: Estimator::Gather,
            exact: Some(5.0),
            ..case("furnace, ρ = 0.8", "rho = 0", open)
        },
        case("a = 0.6", glossy, open),
        case(
            "a = 0.6, three points",
            glossy,
            "[0.1, 0.5, 0], [0.3, 0.5, 0], [0.5, 0.5, 0]",
        ),
        case("a = 0.9, n = 3", "rho = 0.5\na = 0.9\nn = 3", open),
        case(
            "gold, a = 0.5, a millimetre from a wall",
            "rho = 0.5\na = 0.5\nn = 0.183\nk = 3.43",
            "[0.001, 0.4, 0]",
        ),
        Case {
            estimator: Estimator::Gather,
            ..case("a = 0", "rho = 0.5", open)
        },
    ]
}

/// A closed room that emits from all its walls: S0 is M/(1 − ρ) everywhere.
fn furnace() -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let toml = "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [material.wall]
        rho = 0.8
        exitance = 1
        [[sensor]]
        name = 'point'
        points = [[0.3, 0.4, 0]]
        normal = [0, 0, 1]";
    std::fs::write(&path, toml).unwrap();
    Scene::load(&path, &[]).unwrap()
}

fn report(case: &Case, share: f64) {
    let first = case.run(0, Some(SHORT), None);
    let goal = share * first.relative_error;
    let over_seeds = |run: &(dyn Fn(u64) -> Outcome + Sync)| -> Vec<Outcome> {
        (1..=SEEDS).into_par_iter().map(run).collect()
    };
    let stopped = over_seeds(&|seed| case.run(seed, None, Some(goal)));
    let mut samples: Vec<u64> = stopped.iter().map(|run| run.samples).collect();
    samples.sort_unstable();
    let quantile = |share: f64| samples[(share * (samples.len() - 1) as f64) as usize];
    let fixed = over_seeds(&|seed| case.run(seed, Some(quantile(0.5)), None));
    let truth = match case.exact {
        Some(exact) => vec![(exact, 0.0); first.readings.len()],
        None => case.run(0, Some(LONG), None).readings,
    };
    let (bias, scatter) = bias(&stopped, &truth);
    println!(
        "| {} | {} | {:.2} | {} … {} | {bias:+.3} ± {scatter:.3} | {:.2} | {:.2} |",
        case.name,
        match case.estimator {
            Estimator::Gather => "gather",
            _ => "auto",
        },
        100.0 * goal,
        quantile(0.05),
        quantile(0.95),
        100.0 * covered(&stopped, &truth),
        100.0 * covered(&fixed, &truth)
    );
}

/// The greatest mean deviation at any point in standard deviations of one run, and by how much chance scatters it.
fn bias(runs: &[Outcome], truth: &[(f64, f64)]) -> (f64, f64) {
    let count = runs.len() as f64;
    let at_point = |(index, &(value, error)): (usize, &(f64, f64))| {
        let deviations: Vec<f64> = runs
            .iter()
            .map(|run| run.readings[index].0 - value)
            .collect();
        let mean = deviations.iter().sum::<f64>() / count;
        let squares: f64 = deviations.iter().map(|d| (d - mean) * (d - mean)).sum();
        let one = (squares / (count - 1.0)).sqrt();
        (mean / one, (1.0 / count.sqrt()).hypot(error / one))
    };
    let points = truth.iter().enumerate().map(at_point);
    let greater = |a: &(f64, f64), b: &(f64, f64)| a.0.abs().total_cmp(&b.0.abs());
    points.max_by(greater).unwrap()
}

/// Share of the runs whose interval holds the truth, as a mean over the points.
fn covered(runs: &[Outcome], truth: &[(f64, f64)]) -> f64 {
    let holds = |run: &Outcome| {
        let readings = run.readings.iter().zip(truth);
        readings
            .filter(|((value, error), (exact, _))| (value - exact).abs() <= t() * error)
            .count()
    };
    runs.iter().map(holds).sum::<usize>() as f64 / (runs.len() * truth.len()) as f64
}
