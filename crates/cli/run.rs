//! `malus run`: compute a scene and write what comes out.

use crate::args;
use crate::digest::Digest;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::Directory;
use crate::progress::Reporter;
use crate::summary::Circumstances;
use crate::{overview, picture, plan, rows, stop, summary};
use anyhow::{Context, anyhow};
use malus_estimator::{Answer, Picture, Results};
use malus_scene::{Camera, Scene, Settings};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// How a run ended without an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// By its stopping rule.
    Complete,
    /// By the user.
    Interrupted,
}

/// Computes the scene, writes the results, prints the overview.
///
/// # Errors
/// Bad arguments, a bad scene, or a run that failed.
pub fn run(command: &args::Run) -> Result<End, Failure> {
    let threads = threads(command.threads.as_deref())?;
    let scene = load(command)?;
    let mut settings = scene.settings.clone();
    stop::narrow(&mut settings, &command.overrides());
    let directory = Directory::prepare(&directory(command)).map_err(Failure::run)?;
    warn(&scene.warnings);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .with_context(|| format!("cannot start {threads} threads"))
        .map_err(Failure::run)?;
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let (results, seconds) = pool.install(|| compute(command, &scene, &settings, &interrupt));
    warn(&results.warnings);
    let pictured = if command.no_pictures {
        &[][..]
    } else {
        &scene.cameras
    };
    let mut complete = results.complete;
    for camera in pictured {
        if interrupt.asked() {
            break;
        }
        let taken = pool.install(|| shoot(command, &scene, &settings, camera, &interrupt));
        complete &= taken.complete;
        picture::write(&taken, &scene, &directory, &camera.name).map_err(Failure::run)?;
    }
    let circumstances = Circumstances {
        seconds,
        threads,
        repeat: command.repeating(results.samples),
        warnings: [scene.warnings.as_slice(), &results.warnings].concat(),
    };
    let digests: Vec<Digest> = results.groups.iter().map(Digest::of).collect();
    let summary = summary::json(&scene, &settings, &results, &circumstances);
    let summary = summary.map_err(Failure::run)?;
    write(command, &scene, &results, &digests, &summary, &directory).map_err(Failure::run)?;
    if !command.quiet {
        let text = overview::text(&scene, &results, &digests, &circumstances, directory.path());
        print(&text).map_err(Failure::run)?;
    }
    if complete {
        Ok(End::Complete)
    } else {
        warn(&[format!(
            "interrupted: the results in {} are incomplete",
            directory.path().display()
        )]);
        Ok(End::Interrupted)
    }
}

/// Loads the scene; errors name an option the way it was typed.
fn load(command: &args::Run) -> Result<Scene, Failure> {
    Scene::load(&command.scene, &command.overrides()).map_err(|error| {
        let mut text = error.to_string();
        for entry in command.keys() {
            let as_set = format!("--set {}={}", entry.key, entry.value);
            text = text.replace(&as_set, &format!("--{} {}", entry.option, entry.value));
        }
        Failure::input(anyhow!(text))
    })
}

/// More threads than any machine has cores: beyond, starting them is all that a run would do.
const MOST_THREADS: usize = 1024;

/// Number of threads asked for, or as many as there are cores.
pub fn threads(asked: Option<&str>) -> Result<usize, Failure> {
    let Some(text) = asked else {
        return Ok(std::thread::available_parallelism().map_or(1, usize::from));
    };
    text.parse()
        .ok()
        .filter(|count| (1..=MOST_THREADS).contains(count))
        .ok_or_else(|| {
            Failure::input(anyhow!(
                "--threads {text}: must be a whole number from 1 to {MOST_THREADS}, found {text:?}"
            ))
        })
}

/// Where the results go.
fn directory(command: &args::Run) -> PathBuf {
    command.output.clone().unwrap_or_else(|| {
        let stem = command.scene.file_stem().unwrap_or("scene".as_ref());
        Path::new("results").join(stem)
    })
}

/// The results, and the seconds they took.
fn compute(
    command: &args::Run,
    scene: &Scene,
    settings: &Settings,
    interrupt: &Interrupt,
) -> (Results, f64) {
    let started = Instant::now();
    let mut reporter = Reporter::new(command.quiet, settings.seconds);
    let results = malus_estimator::run(scene, settings, &mut |progress| {
        let elapsed = started.elapsed().as_secs_f64();
        reporter.show(progress, elapsed);
        if interrupt.asked() {
            Answer::Interrupt
        } else {
            stop::answer(progress, elapsed, settings.seconds)
        }
    });
    reporter.finish();
    (results, started.elapsed().as_secs_f64())
}

/// The picture that a camera takes.
fn shoot(
    command: &args::Run,
    scene: &Scene,
    settings: &Settings,
    camera: &Camera,
    interrupt: &Interrupt,
) -> Picture {
    let started = Instant::now();
    let mut reporter = Reporter::new(command.quiet, None);
    let picture = malus_estimator::picture(scene, camera, settings, &mut |share| {
        reporter.show_share(&camera.name, share, started.elapsed().as_secs_f64());
        if interrupt.asked() {
            Answer::Interrupt
        } else {
            Answer::Continue
        }
    });
    reporter.finish();
    picture
}

/// Writes all files; the summary last, so that where it is, everything is.
fn write(
    command: &args::Run,
    scene: &Scene,
    results: &Results,
    digests: &[Digest],
    summary: &[u8],
    directory: &Directory,
) -> anyhow::Result<()> {
    let sensors = rows::sensors(scene, results)?;
    let grids = rows::grids(scene, digests)?;
    directory.write("sensors.csv", &sensors)?;
    directory.write("grids.csv", &grids)?;
    let pictured = if command.no_pictures { &[] } else { digests };
    for (index, (sensor, digest)) in scene.sensors.iter().zip(pictured).enumerate() {
        if let Some(drawn) = plan::svg(scene, results, index, digest) {
            directory.write(&format!("{}.svg", sensor.name), drawn.as_bytes())?;
        }
    }
    directory.write("summary.json", summary)
}

/// Warnings, on stderr even where the run is quiet.
pub fn warn(warnings: &[String]) {
    for warning in warnings {
        eprintln!("warning: {warning}");
    }
}

/// Text on stdout; a reader that has gone away is no failure.
pub fn print(text: &str) -> anyhow::Result<()> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(error).context("cannot write to stdout")
        }
        _ => Ok(()),
    }
}
