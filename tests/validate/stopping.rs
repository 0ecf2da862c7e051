//! Whether a run that stops by its error is as good as one of a fixed length: no bias, and intervals that hold.

use crate::coverage::{T, room};
use malus_estimator::{Answer, Reading, run};
use malus_scene::{Estimator, Scene};
use rayon::prelude::*;

/// Runs a case.
const SEEDS: u64 = 4000;

/// Samples of the run that is taken for the truth.
const LONG: u64 = 1 << 21;

/// A scene that is run until its error is small enough.
struct Case {
    name: &'static str,
    scene: Scene,
    estimator: Estimator,
    goal: f64,
}

/// One stopped run.
struct Stopped {
    readings: Vec<Reading>,
    samples: u64,
}

pub fn print() {
    println!("\n## Stopping by error\n");
    println!(
        "{SEEDS} runs of each case by different seeds, each stopped at the first checkpoint at which every sensor point's standard error is at most the share aimed at."
    );
    println!(
        "*Bias* is the mean deviation of the stopped runs from a run of {LONG} samples, in standard errors of one stopped run; of several points the worst is told. Chance alone, in the stopped runs and in the long one, scatters it by the number behind ±."
    );
    println!(
        "*Covered* is how often the 95 % interval (Student's t) of a stopped run holds the long run's value; of several points the mean.\n"
    );
    println!("| scene | estimator | error aimed at, % | samples, median | bias | covered, % |");
    println!("|---|---|---|---|---|---|");
    for case in cases() {
        report(&case);
    }
}

fn cases() -> Vec<Case> {
    let open = "[0.3, 0.4, 0]";
    let nine = "[0.1, 0.5, 0], [0.2, 0.5, 0], [0.3, 0.5, 0], [0.4, 0.5, 0], [0.5, 0.5, 0], [0.6, 0.5, 0], \
                [0.7, 0.5, 0], [0.8, 0.5, 0], [0.9, 0.5, 0]";
    let glossy = "rho = 0.5\na = 0.6";
    let case = |name, material: &str, points: &str, estimator, goal| Case {
        name,
        scene: room(material, points),
        estimator,
        goal,
    };
    vec![
        case("a = 0, one point", "rho = 0.5", open, Estimator::Auto, 0.02),
        case(
            "a = 0, one point",
            "rho = 0.5",
            open,
            Estimator::Auto,
            0.005,
        ),
        case(
            "a = 0, one point",
            "rho = 0.5",
            open,
            Estimator::Gather,
            0.05,
        ),
        case(
            "a = 0, nine points",
            "rho = 0.5",
            nine,
            Estimator::Auto,
            0.01,
        ),
        case("a = 0.6, one point", glossy, open, Estimator::Auto, 0.05),
        case("a = 0.6, one point", glossy, open, Estimator::Auto, 0.01),
        case("a = 0.6, nine points", glossy, nine, Estimator::Auto, 0.02),
        case(
            "a = 0.9, n = 3, one point",
            "rho = 0.5\na = 0.9\nn = 3",
            open,
            Estimator::Auto,
            0.02,
        ),
        case(
            "gold, a = 0.5, a millimetre from a wall",
            "rho = 0.5\na = 0.5\nn = 0.183\nk = 3.43",
            "[0.001, 0.4, 0]",
            Estimator::Auto,
            0.02,
        ),
    ]
}

fn report(case: &Case) {
    let stopped = |seed: u64, samples: Option<u64>| {
        let mut settings = case.scene.settings.clone();
        settings.estimator = case.estimator;
        settings.compare_scalar = false;
        settings.seed = seed;
        settings.samples = samples;
        settings.relative_error = Some(case.goal).filter(|_| samples.is_none());
        let results = run(&case.scene, &settings, &mut |_| Answer::Continue);
        Stopped {
            readings: results.groups[0].readings.clone(),
            samples: results.samples,
        }
    };
    let runs: Vec<Stopped> = (1..=SEEDS)
        .into_par_iter()
        .map(|seed| stopped(seed, None))
        .collect();
    let long = stopped(0, Some(LONG)).readings;
    let count = SEEDS as f64;
    let (mut bias, mut scatter, mut held) = (0.0_f64, 0.0, 0.0);
    for (index, truth) in long.iter().enumerate() {
        let deviations: Vec<f64> = runs
            .iter()
            .map(|run| run.readings[index].stokes[0] - truth.stokes[0])
            .collect();
        let mean = deviations.iter().sum::<f64>() / count;
        let spread = deviations
            .iter()
            .map(|d| (d - mean) * (d - mean))
            .sum::<f64>()
            / (count - 1.0);
        let one = spread.sqrt();
        if (mean / one).abs() >= bias.abs() {
            bias = mean / one;
            scatter = (1.0 / count.sqrt()).hypot(truth.standard_error[0] / one);
        }
        held += deviations
            .iter()
            .zip(&runs)
            .filter(|(d, run)| d.abs() <= T * run.readings[index].standard_error[0])
            .count() as f64
            / (count * long.len() as f64);
    }
    let mut samples: Vec<u64> = runs.iter().map(|run| run.samples).collect();
    samples.sort_unstable();
    println!(
        "| {} | {} | {} | {} | {bias:+.3} ± {scatter:.3} | {:.2} |",
        case.name,
        match case.estimator {
            Estimator::Gather => "gather",
            _ => "auto",
        },
        100.0 * case.goal,
        samples[samples.len() / 2],
        100.0 * held
    );
}
