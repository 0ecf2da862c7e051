//! `malus sweep`: evaluate the variants of a study, or a shard of it, and say how they differ.

mod batch;
#[cfg_attr(not(feature = "parquet"), path = "sweep/without_parquet.rs")]
mod columnar;
mod course;
mod job;
pub mod merge;
mod outcomes;
mod results;
mod shard;
mod variants;
mod whole;

use crate::args;
use crate::failure::Failure;
use crate::handing::Handing;
use crate::interrupt::Interrupt;
use crate::journal::Journal;
use crate::keeper::Keeper;
use crate::output::Directory;
use crate::part::{CHECKPOINT, Head, Part, Studied};
use crate::progress::Reporter;
use crate::report::warn;
use crate::run::{End, directory, pool};
use crate::stop;
use job::Job;
use malus_estimator::{Shard, Sharing};
use malus_scene::{Base, Settings, Study};
use results::Wanted;
use std::path::PathBuf;
use std::time::Instant;

/// Evaluates the variants of a study, or computes a shard of it.
///
/// # Errors
/// Bad arguments, a bad scene or study, a state that it cannot go on from, or variants that failed.
pub fn sweep(command: &args::Sweep) -> Result<End, Failure> {
    let threads = command.computing.threads()?;
    let interval = command.portion.interval().map_err(Failure::input)?;
    if command.parquet {
        columnar::check().map_err(Failure::input)?;
    }
    let asked = Asked::load(command)?;
    let head = asked.head(command);
    if command.cluster.submit.is_some() {
        return hand_in(command, &asked, &head);
    }
    let shard = command
        .portion
        .shard(&asked.settings)
        .map_err(Failure::input)?;
    let directory = Directory::prepare(&directory(command.output.as_deref(), &command.study))
        .map_err(Failure::run)?;
    let name = shard.map_or(CHECKPOINT.to_owned(), Part::name_of);
    let head = Head {
        threads,
        shard: shard.unwrap_or(Shard::WHOLE),
        ..head
    };
    let part = command.portion.begin(head, &name, &directory);
    let part = part.map_err(Failure::input)?;
    if !command.portion.resume {
        // Its journal is begun anew, and what is there tells of the old one.
        directory.remove(&name).map_err(Failure::run)?;
    }
    let journal = Journal::name_of(&name);
    let journal = Journal::resume_or_create(&directory, &journal, part.head.finished());
    let journal = journal.map_err(Failure::input)?;
    warn(&asked.base.scene.warnings);
    warn(&asked.base.doubts);
    let pool = pool(threads)?;
    let mut job = Job {
        base: &asked.base.scene,
        settings: &asked.settings,
        variants: asked.study.count(),
        sharing: match asked.study.moves() {
            true => Sharing::Differences,
            false => Sharing::Points,
        },
        done: 0,
        directory: &directory,
        name: &name,
        before: part.head.seconds,
        part,
        keeper: Keeper::new(interval),
        interrupt: Interrupt::listen().map_err(Failure::run)?,
        reporter: Reporter::new(command.quiet, asked.settings.seconds),
        started: Instant::now(),
    };
    let wanted = Wanted {
        directory: &directory,
        title: asked.title(),
        sensors: command.sensors,
        parquet: command.parquet,
        pictures: !command.no_pictures,
        quiet: command.quiet,
    };
    let (study, base) = (&asked.study, &asked.base);
    let end = pool.install(|| match shard {
        Some(_) => shard::compute(&mut job, journal, study, base, command.quiet),
        None => whole::compute(&mut job, journal, study, base, &wanted),
    });
    end.map_err(Failure::run)
}

/// Hands a study to a cluster, as shards.
fn hand_in(command: &args::Sweep, asked: &Asked, head: &Head) -> Result<End, Failure> {
    let mut flags = Vec::new();
    flags.extend(command.sensors.then_some("--sensors"));
    flags.extend(command.parquet.then_some("--parquet"));
    flags.extend(command.no_pictures.then_some("--no-pictures"));
    let handing = Handing {
        cluster: &command.cluster,
        command: "sweep",
        input: &command.study,
        title: &asked.title(),
        head,
        settings: &asked.settings,
        cameras: 0,
        checkpoint: command.portion.checkpoint.as_deref(),
        flags: &flags,
        output: directory(command.output.as_deref(), &command.study),
        quiet: command.quiet,
    };
    warn(&asked.base.scene.warnings);
    warn(&asked.base.doubts);
    handing.hand_in()
}

/// A study that is asked for, as it is understood.
struct Asked {
    path: PathBuf,
    study: Study,
    base: Base,
    /// How the base is computed.
    settings: Settings,
}

impl Asked {
    /// Reads the study and the scene that it starts from.
    ///
    /// # Errors
    /// A bad study or a bad scene.
    fn load(command: &args::Sweep) -> Result<Self, Failure> {
        let refused = |error| command.computing.refused(&error);
        let study = Study::load(&command.study).map_err(refused)?;
        let overrides = command.computing.overrides();
        let base = study.base(&overrides).map_err(refused)?;
        let mut settings = base.scene.settings.clone();
        stop::narrow(&mut settings, &overrides);
        Ok(Self {
            path: command.study.clone(),
            study,
            base,
            settings,
        })
    }

    /// Name of the study for titles.
    fn title(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }

    /// What a file of this study says of itself at its beginning.
    fn head(&self, command: &args::Sweep) -> Head {
        Head {
            study: Some(Studied {
                digest: self.study.digest(),
                rule: stop::words(&self.settings),
                sensors: command.sensors,
                parquet: command.parquet,
                samples: None,
                finished: Default::default(),
                share: 0.0,
            }),
            ..Head::new(
                &self.path,
                &self.base.scene,
                &self.settings,
                &command.computing,
                command.no_pictures,
            )
        }
    }
}
