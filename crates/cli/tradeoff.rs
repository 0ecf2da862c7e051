//! `malus tradeoff`: measure error against time on the user's scene.

mod curve;
mod diagram;
mod reference;
mod report;
mod series;
mod setting;
mod trial;

use crate::args;
use crate::computing::threads;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::Directory;
use crate::progress::Reporter;
use crate::report::{print, warn};
use crate::run::{End, directory};
use anyhow::anyhow;
use malus_scene::Scene;
use series::{Budget, Series};
use std::time::Instant;

/// Seconds that the command may take where nothing is said.
const BUDGET_S: f64 = 300.0;

/// Shares of what is left of the budget: for finding out how fast each setting is, and for the reference.
const PILOT: f64 = 0.08;
const REFERENCE: f64 = 0.65;

/// Runs of every setting and number of samples that there is to be time for.
const RUNS: u32 = 5;

/// Runs after which more would tell nothing new.
const MOST_RUNS: u64 = 21;

/// Measures the scene, writes the table and the diagram, prints what is cheapest.
///
/// # Errors
/// Bad arguments, a bad scene, or a budget too small for anything to be measured.
pub fn tradeoff(command: &args::Tradeoff) -> Result<End, Failure> {
    let started = Instant::now();
    let most_threads = threads(command.threads.as_deref())?;
    let budget = Budget::new(started, seconds(command.budget.as_deref())?);
    let scene = Scene::load(&command.scene, &command.set)
        .map_err(|error| Failure::input(anyhow!(error.to_string())))?;
    if scene
        .sensors
        .iter()
        .all(|sensor| sensor.points.iter().all(|point| point.enclosed))
    {
        return Err(Failure::input(anyhow!(
            "{}: there is no free sensor point to measure errors at",
            command.scene.display()
        )));
    }
    let directory = Directory::prepare(&directory(command.output.as_deref(), &command.scene))
        .map_err(Failure::run)?;
    warn(&scene.warnings);
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let mut reporter = Reporter::new(command.quiet, Some(budget.seconds));
    let mut series = Series::new(&scene, most_threads, budget, &interrupt)?;
    let reference = measure(&mut series, &mut reporter);
    reporter.finish();
    let reference = reference?;
    let curves = series.curves(&reference);
    let told = curves.iter().any(|curve| curve.points().next().is_some());
    if !told && !interrupt.asked() {
        return Err(Failure::run(anyhow!(
            "no error is five times the reference's standard error of {}, so none can be told after {:.1} s: give more --budget",
            report::percent(reference.standard_error()),
            budget.elapsed()
        )));
    }
    let report = report::Report {
        file: &command.scene,
        scene: &scene,
        reference: &reference,
        curves: &curves,
        seconds: started.elapsed().as_secs_f64(),
    };
    write(command, &report, &directory).map_err(Failure::run)?;
    if !command.quiet {
        print(&report.text(directory.path())).map_err(Failure::run)?;
    }
    if interrupt.asked() {
        warn(&[format!(
            "interrupted: what is in {} is what was measured by then",
            directory.path().display()
        )]);
        return Ok(End::Interrupted);
    }
    Ok(End::Complete)
}

/// Writes both files.
fn write(
    command: &args::Tradeoff,
    report: &report::Report,
    directory: &Directory,
) -> anyhow::Result<()> {
    directory.write("tradeoff.csv", &report.csv()?)?;
    let drawn = (!command.no_pictures)
        .then(|| diagram::svg(report))
        .flatten();
    match drawn {
        Some(drawn) => directory.write("tradeoff.svg", drawn.as_bytes()),
        None => Ok(()),
    }
}

/// Finds out how fast everything is, makes the reference, and measures for as long as the budget allows.
fn measure(series: &mut Series, reporter: &mut Reporter) -> Result<reference::Reference, Failure> {
    let budget = series.budget;
    series.pass(None, PILOT * budget.left(), 1, reporter);
    let reference = series.reference(REFERENCE * budget.left(), reporter);
    let reference = reference.ok_or_else(|| {
        Failure::run(anyhow!(
            "no light reaches any sensor: there is nothing that an error is a share of"
        ))
    })?;
    let time = budget.left();
    for _ in 1..MOST_RUNS {
        if series.pass(Some(&reference), time, RUNS, reporter) == 0 {
            break;
        }
    }
    Ok(reference)
}

/// Seconds of the budget.
fn seconds(asked: Option<&str>) -> Result<f64, Failure> {
    let Some(text) = asked else {
        return Ok(BUDGET_S);
    };
    text.parse()
        .ok()
        .filter(|seconds: &f64| seconds.is_finite() && *seconds > 0.0)
        .ok_or_else(|| {
            Failure::input(anyhow!(
                "--budget {text}: must be a number of seconds above 0, found {text:?}"
            ))
        })
}
