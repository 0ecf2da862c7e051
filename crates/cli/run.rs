//! `malus run`: compute a scene, or a shard of it, and write what comes out.

use crate::args;
use crate::failure::Failure;
use crate::handing::Handing;
use crate::interrupt::Interrupt;
use crate::job::Job;
use crate::keeper::Keeper;
use crate::output::Directory;
use crate::part::{CHECKPOINT, Head, Part};
use crate::report::{Report, print, warn};
use crate::summary::Circumstances;
use crate::{picture, stop};
use anyhow::Context;
use malus_estimator::Shard;
use malus_scene::{Scene, Settings};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::{Path, PathBuf};

/// How a run ended without an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// By its stopping rule.
    Complete,
    /// By the user.
    Interrupted,
}

/// Computes the scene, writes the results, prints the overview; of a shard, writes what `malus merge` joins.
///
/// # Errors
/// Bad arguments, a bad scene, or a run that failed.
pub fn run(command: &args::Run) -> Result<End, Failure> {
    let threads = command.computing.threads()?;
    let interval = command.portion.interval().map_err(Failure::input)?;
    let scene = load(command)?;
    let settings = settings(command, &scene);
    if command.cluster.submit.is_some() {
        return hand_in(command, &scene, &settings);
    }
    let shard = command.portion.shard(&settings).map_err(Failure::input)?;
    let directory = Directory::prepare(&directory(command.output.as_deref(), &command.scene))
        .map_err(Failure::run)?;
    let name = shard.map_or(CHECKPOINT.to_owned(), Part::name_of);
    let head = Head {
        threads,
        ..head(command, &scene, &settings, shard)
    };
    let mut part = command
        .portion
        .begin(head, &name, &directory)
        .map_err(Failure::input)?;
    warn(&scene.warnings);
    let pool = pool(threads)?;
    let job = Job {
        scene: &scene,
        settings: &settings,
        interrupt: &Interrupt::listen().map_err(Failure::run)?,
        directory: &directory,
        name: &name,
        quiet: command.quiet,
    };
    let mut keeper = Keeper::new(interval);
    let end = pool.install(|| match shard {
        Some(shard) => compute_shard(&job, &mut part, &mut keeper, shard),
        None => compute_whole(command, &job, &mut part, &mut keeper),
    });
    end.map_err(Failure::run)
}

/// Computes a whole run and reports it.
fn compute_whole(
    command: &args::Run,
    job: &Job,
    part: &mut Part,
    keeper: &mut Keeper,
) -> anyhow::Result<End> {
    let results = job.compute(part, keeper)?;
    warn(&results.warnings);
    // A picture that fails costs no reading.
    let pictures = take_pictures(job, part, keeper);
    let complete = results.complete && matches!(pictures, Ok(true));
    let circumstances = Circumstances {
        seconds: part.head.seconds,
        threads: part.head.threads,
        complete,
        repeat: command.computing.repeating(results.samples),
        warnings: [job.scene.warnings.as_slice(), &results.warnings].concat(),
    };
    let report = Report {
        directory: job.directory,
        pictures: part.head.pictures,
        quiet: command.quiet,
    };
    report.write(job.scene, job.settings, &results, &circumstances)?;
    pictures?;
    if complete {
        job.directory.remove(job.name)?;
        return Ok(End::Complete);
    }
    let mut told = format!(
        "interrupted: the results in {} are incomplete",
        job.directory.path().display()
    );
    if keeper.keeps() {
        job.set_aside(part)?;
        told += "; --resume goes on with them";
    }
    warn(&[told]);
    Ok(End::Interrupted)
}

/// Takes and writes the pictures of all cameras; false where the user did not wait for them.
fn take_pictures(job: &Job, part: &mut Part, keeper: &mut Keeper) -> anyhow::Result<bool> {
    for index in pictured(part, job.scene) {
        if job.interrupt.asked() {
            return Ok(false);
        }
        job.shoot(part, keeper, index)?;
        let camera = &job.scene.cameras[index];
        let taken = part.films[index].developed(camera);
        picture::write(&taken, job.scene, job.directory, &camera.name)?;
        if !taken.complete {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Computes a shard and leaves it to be merged.
fn compute_shard(
    job: &Job,
    part: &mut Part,
    keeper: &mut Keeper,
    shard: Shard,
) -> anyhow::Result<End> {
    let path = job.directory.path().join(job.name);
    let tell = |what: &str| {
        let text = format!("shard {shard} {what}: {}\n", path.display());
        if job.quiet { Ok(()) } else { print(&text) }
    };
    if part.head.complete {
        tell("is there already")?;
        return Ok(End::Complete);
    }
    job.compute(part, keeper)?;
    for index in pictured(part, job.scene) {
        if !job.interrupt.asked() {
            job.shoot(part, keeper, index)?;
        }
    }
    part.head.complete = !job.interrupt.asked();
    job.set_aside(part)?;
    if part.head.complete {
        tell("is finished")?;
        return Ok(End::Complete);
    }
    warn(&[format!(
        "interrupted: {} is not finished; --resume goes on with it",
        path.display()
    )]);
    Ok(End::Interrupted)
}

/// Hands the scene to a cluster, as shards.
fn hand_in(command: &args::Run, scene: &Scene, settings: &Settings) -> Result<End, Failure> {
    let flags: &[&str] = match command.no_pictures {
        true => &["--no-pictures"],
        false => &[],
    };
    let handing = Handing {
        cluster: &command.cluster,
        command: "run",
        input: &command.scene,
        title: &scene.name,
        head: &head(command, scene, settings, None),
        settings,
        cameras: scene.cameras.len(),
        checkpoint: command.portion.checkpoint.as_deref(),
        flags,
        output: directory(command.output.as_deref(), &command.scene),
        quiet: command.quiet,
    };
    warn(&scene.warnings);
    handing.hand_in()
}

/// Indices of the cameras that take pictures.
fn pictured(part: &Part, scene: &Scene) -> std::ops::Range<usize> {
    0..if part.head.pictures {
        scene.cameras.len()
    } else {
        0
    }
}

/// What a file of this run says of itself at its beginning.
fn head(command: &args::Run, scene: &Scene, settings: &Settings, shard: Option<Shard>) -> Head {
    Head {
        shard: shard.unwrap_or(Shard::WHOLE),
        ..Head::new(
            &command.scene,
            scene,
            settings,
            &command.computing,
            command.no_pictures,
        )
    }
}

/// Loads the scene; errors name an option the way it was typed.
pub fn load(command: &args::Run) -> Result<Scene, Failure> {
    Scene::load(&command.scene, &command.computing.overrides())
        .map_err(|error| command.computing.refused(&error))
}

/// How the scene is to be computed: its own settings with the stopping rules of the command line.
pub fn settings(command: &args::Run, scene: &Scene) -> Settings {
    let mut settings = scene.settings.clone();
    stop::narrow(&mut settings, &command.computing.overrides());
    settings
}

/// So many threads, ready to compute.
///
/// # Errors
/// The system gives no threads.
pub fn pool(threads: usize) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .with_context(|| format!("cannot start {threads} threads"))
        .map_err(Failure::run)
}

/// Where the results go: what was asked for, or a directory of the scene file's name.
pub fn directory(asked: Option<&Path>, scene: &Path) -> PathBuf {
    match asked {
        Some(path) => path.to_owned(),
        None => Path::new("results").join(scene.file_stem().unwrap_or("scene".as_ref())),
    }
}
