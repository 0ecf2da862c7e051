//! `malus merge`: join the shards of a run or of a study.

use crate::args;
use crate::failure::Failure;
use crate::output::Directory;
use crate::part::Head;
use crate::report::{Report, warn};
use crate::shards::Shards;
use crate::summary::Circumstances;
use crate::{picture, run, sweep};
use anyhow::{Context, Result, anyhow, ensure};
use malus_estimator::Answer;
use malus_scene::{Fingerprint, Scene, Settings};
use std::path::{Path, PathBuf};

/// Joins shards and writes the results of the whole run.
///
/// # Errors
/// The shards are not those of one run, one is missing, the scene is another by now, or nothing can be written.
pub fn merge(command: &args::Merge) -> Result<(), Failure> {
    let shards = Shards::read(&command.shards).map_err(Failure::input)?;
    shards.check().map_err(Failure::input)?;
    let head = shards.any().head.clone();
    if head.study.is_some() {
        return sweep::merge::merge(command, &shards);
    }
    let asked = asked(command, &head).map_err(Failure::input)?;
    let scene = run::load(&asked)?;
    let settings = run::settings(&asked, &scene);
    let found = scene.fingerprint(&settings);
    same(&head.fingerprint, &found, &asked.scene).map_err(Failure::input)?;
    let output = command.output.as_ref().unwrap_or(&command.shards[0]);
    let directory = Directory::prepare(output).map_err(Failure::run)?;
    warn(&scene.warnings);
    join(command, shards, &asked, &scene, &settings, &directory).map_err(Failure::run)
}

/// Writes what the shards say together.
fn join(
    command: &args::Merge,
    shards: Shards,
    asked: &args::Run,
    scene: &Scene,
    settings: &Settings,
    directory: &Directory,
) -> Result<()> {
    let head = shards.any().head.clone();
    let (seconds, threads) = (shards.seconds(), shards.threads());
    let (mut state, films) = shards.joined()?;
    // All samples are taken, so nothing is left to compute but what they say.
    let results =
        malus_estimator::resume(scene, settings, &mut state, &mut |_, _| Answer::Continue)?;
    warn(&results.warnings);
    let pictures = head.pictures && !command.no_pictures;
    if pictures {
        for (camera, film) in scene.cameras.iter().zip(&films) {
            picture::write(&film.developed(camera), scene, directory, &camera.name)?;
        }
    }
    let circumstances = Circumstances {
        seconds,
        threads,
        complete: results.complete,
        repeat: asked.computing.repeating(results.samples),
        warnings: [scene.warnings.as_slice(), &results.warnings].concat(),
    };
    let report = Report {
        directory,
        pictures,
        quiet: command.quiet,
    };
    report.write(scene, settings, &results, &circumstances)
}

/// The run whose shards these are.
fn asked(command: &args::Merge, head: &Head) -> Result<args::Run> {
    let goal = head.goal.context("the shards tell no number of samples")?;
    let scene = asked_scene(command, head)?;
    Ok(args::Run::told(&scene, &head.words, goal)?)
}

/// The file of the scene or study whose shards these are.
///
/// # Errors
/// It is not where it was, and nothing tells where it is.
pub fn asked_scene(command: &args::Merge, head: &Head) -> Result<PathBuf> {
    if let Some(path) = &command.scene {
        return Ok(path.clone());
    }
    let path = PathBuf::from(&head.scene);
    let what = match head.study {
        Some(_) => "study",
        None => "scene",
    };
    ensure!(
        path.exists(),
        "{}: the {what} of these shards is no longer there; give it with --scene",
        path.display()
    );
    Ok(path)
}

/// Makes sure that the scene is what it was; `path` is what was read.
///
/// # Errors
/// It is another; the error tells what differs.
pub fn same(shards: &Fingerprint, scene: &Fingerprint, path: &Path) -> Result<()> {
    let differences = shards.differences(scene);
    if differences.is_empty() {
        return Ok(());
    }
    Err(anyhow!(
        "{}: is not the scene that the shards were computed of: they differ in {}; give that scene with --scene, or compute \
         the shards again",
        path.display(),
        differences.join(", ")
    ))
}
