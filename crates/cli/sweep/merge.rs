//! Joining the shards of a study: its batches one by one, each from the sums that all shards hold of it.

use super::batch::Batch;
use super::course::{Course, Step};
use super::outcomes::Outcomes;
use super::results::{Made, Results, Wanted};
use super::{Asked, columnar, shard};
use crate::args;
use crate::conclusion::Computed;
use crate::failure::Failure;
use crate::journal::{self, Extent, Journal, Records};
use crate::merge::{asked_scene, same};
use crate::output::Directory;
use crate::part::Studied;
use crate::progress::Reporter;
use crate::report::warn;
use crate::shards::Shards;
use anyhow::{Context, Result, anyhow, ensure};
use malus_estimator::{Allocation, Answer, REPLICAS, Sharing, State, Together, resume_together};
use malus_scene::{Scene, Settings};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Joins the shards of a study and writes the results of the whole.
///
/// # Errors
/// A journal is damaged, what the study names is another by now, nothing can be written, or variants failed.
pub fn merge(command: &args::Merge, shards: &Shards) -> Result<(), Failure> {
    let journals = journals(shards).map_err(Failure::input)?;
    let head = shards.any().head.clone();
    let (studied, allocation) = head
        .study
        .as_ref()
        .zip(shards.any().allocation.as_ref())
        .context("the shards say nothing of a study")
        .map_err(Failure::input)?;
    if studied.parquet {
        columnar::check().map_err(Failure::input)?;
    }
    let path = asked_scene(command, &head).map_err(Failure::input)?;
    let told = args::Sweep::told(&path, &head.words);
    let asked = Asked::load(&told.map_err(|error| Failure::input(error.into()))?)?;
    let found = asked.base.scene.fingerprint(&asked.settings);
    same(&head.fingerprint, &found, &path).map_err(Failure::input)?;
    if asked.study.digest() != studied.digest {
        return Err(Failure::input(anyhow!(
            "{}: is not the study that the shards were computed of: other keys vary, or they have other values; give that \
             study with --scene, or compute the shards again",
            path.display()
        )));
    }
    let output = command.output.as_ref().unwrap_or(&command.shards[0]);
    let directory = Directory::prepare(output).map_err(Failure::run)?;
    directory.tidy("outcomes");
    warn(&asked.base.scene.warnings);
    warn(&asked.base.doubts);
    let wanted = Wanted {
        directory: &directory,
        title: asked.title(),
        sensors: studied.sensors,
        parquet: studied.parquet,
        pictures: head.pictures && !command.no_pictures,
        quiet: command.quiet,
    };
    let mut joint = Joint {
        asked: &asked,
        studied,
        allocation,
        records: journals,
    };
    let made = Made {
        computed: Computed {
            seed: asked.settings.seed,
            samples: studied.samples.or(head.goal).unwrap_or_default(),
            dof: REPLICAS - 1,
            complete: true,
        },
        seconds: shards.seconds(),
        threads: shards.threads(),
    };
    joint.write(&wanted, &made).map_err(Failure::run)
}

/// The journals of all shards, none of them damaged.
fn journals(shards: &Shards) -> Result<Vec<(PathBuf, Records)>> {
    let mut wrong = Vec::new();
    let mut journals = Vec::new();
    for (path, part) in shards.all() {
        match open(path, part.head.finished()) {
            Ok(opened) => journals.push(opened),
            Err(error) => wrong.push(format!("{error:#}")),
        }
    }
    ensure!(wrong.is_empty(), wrong.join("\n"));
    Ok(journals)
}

fn open(part: &Path, extent: Extent) -> Result<(PathBuf, Records)> {
    let path = Journal::beside(part);
    journal::check(&path, extent)?;
    let records = Records::open(&path, extent)?;
    Ok((path, records))
}

/// Shards under way to their results.
struct Joint<'a> {
    asked: &'a Asked,
    studied: &'a Studied,
    allocation: &'a Allocation,
    /// The journal of each shard.
    records: Vec<(PathBuf, Records)>,
}

impl Joint<'_> {
    fn write(&mut self, wanted: &Wanted, made: &Made) -> Result<()> {
        let Asked { study, base, .. } = self.asked;
        let name = format!(".outcomes.{}.part", std::process::id());
        let journal = Journal::create(wanted.directory, &name)?;
        let mut results = Results::begin(study, base, wanted, Outcomes::new(journal))?;
        let written = self.batches(wanted, &mut results);
        let written = written.and_then(|()| results.conclude(made));
        // The first error is the one to report.
        match written {
            Ok(()) => results.end(),
            Err(error) => {
                let _ = results.end();
                Err(error)
            }
        }
    }

    /// Writes what all batches gave.
    fn batches(&mut self, wanted: &Wanted, results: &mut Results) -> Result<()> {
        let Asked { study, base, .. } = self.asked;
        let fingerprint = base.scene.fingerprint(&self.asked.settings);
        let (started, mut reporter) = (Instant::now(), Reporter::new(wanted.quiet, None));
        let mut done = 0;
        for step in Course::new(study, base) {
            match step {
                Step::Failed(failed) => {
                    results.fail(failed)?;
                    done += 1;
                }
                Step::Batch(batch) => {
                    let digest = batch.digest(&base.scene, &fingerprint)?;
                    let together = self.together(&batch, digest)?;
                    if batch.with_base && results.outcomes().count() == 0 {
                        warn(&together.first.warnings);
                    }
                    let record = results.gave(&batch, &together)?.record(digest)?;
                    let place = results.outcomes().journal().append(&record)?;
                    results.keep(&batch, (place, &record), digest)?;
                    done += batch.variants.len();
                }
            }
            let share = done as f64 / study.count() as f64;
            reporter.show_share("variants", share, started.elapsed().as_secs_f64());
        }
        reporter.finish();
        Ok(())
    }

    /// What the scenes of a batch gave along the walks of all shards.
    fn together(&mut self, batch: &Batch, digest: u128) -> Result<Together> {
        let base: &Scene = &self.asked.base.scene;
        let mut joined: Option<State> = None;
        for (path, records) in &mut self.records {
            let read = records.next().and_then(|record| {
                let (_, record) = record.context("ends before the study does")?;
                let state = shard::read(&record, digest)?;
                Ok(match joined.take() {
                    None => state,
                    Some(joined) => joined.merge(state)?,
                })
            });
            joined = Some(read.with_context(|| format!("{}", path.display()))?);
        }
        let mut state = joined.context("there is no shard")?;
        let stops = Settings {
            samples: self.studied.samples,
            relative_error: None,
            seconds: None,
            ..self.asked.settings.clone()
        };
        let settings = batch.settings(base, &stops);
        // All samples are taken, so nothing is left to compute but what they say.
        let scenes = batch.scenes(base);
        Ok(resume_together(
            &scenes,
            &settings,
            Sharing::Like(self.allocation),
            &mut state,
            &mut |_, _| Answer::Continue,
        )?)
    }
}
