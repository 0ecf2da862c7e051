//! A study in one piece: what is finished is kept, and what is left is computed.

use super::batch::Batch;
use super::course::{Course, Step};
use super::job::Job;
use super::outcomes::{Gave, Outcomes};
use super::results::{Made, Results, Wanted};
use crate::conclusion::Computed;
use crate::journal::{Journal, Records};
use crate::outcome::measured;
use crate::report::warn;
use crate::run::End;
use anyhow::{Context, Result};
use malus_estimator::REPLICAS;
use malus_scene::{Base, Study};

/// Computes what is left of a study, and writes its results; `journal` holds what is finished.
///
/// # Errors
/// What was set aside is damaged, nothing can be written, or variants failed.
pub fn compute(
    job: &mut Job,
    journal: Journal,
    study: &Study,
    base: &Base,
    wanted: &Wanted,
) -> Result<End> {
    let name = Journal::name_of(job.name);
    let path = job.directory.path().join(&name);
    let finished = job.part.head.finished();
    let mut records = Records::open(&path, finished)?;
    let mut results = Results::begin(study, base, wanted, Outcomes::new(journal))?;
    let fingerprint = job.part.head.fingerprint;
    let mut complete = true;
    for step in Course::new(study, base) {
        let batch = match step {
            Step::Failed(failed) => {
                results.fail(failed)?;
                job.pass(1);
                continue;
            }
            Step::Batch(batch) => batch,
        };
        let digest = batch.digest(&base.scene, &fingerprint)?;
        if let Some((place, record)) = records.next()? {
            let kept = results.keep(&batch, (place, &record), digest);
            kept.with_context(|| format!("{}", path.display()))?;
            job.pass(batch.variants.len());
        } else if !advance(job, &batch, digest, &mut results)? {
            complete = false;
            break;
        }
    }
    job.reporter.finish();
    let head = &job.part.head;
    let taken = Some(head.samples).filter(|&samples| samples > 0);
    let samples = head.study.as_ref().and_then(|study| study.samples);
    let samples = samples.or(taken).or(head.goal);
    results.conclude(&Made {
        computed: Computed {
            seed: job.settings.seed,
            samples: samples.unwrap_or_default(),
            dof: REPLICAS - 1,
            complete,
        },
        seconds: job.before + job.started.elapsed().as_secs_f64(),
        threads: head.threads,
    })?;
    if complete {
        job.directory.remove(job.name)?;
        results.end()?;
        return Ok(End::Complete);
    }
    let mut told = format!(
        "interrupted: the results in {} are incomplete",
        job.directory.path().display()
    );
    if job.keeper.keeps() {
        told += "; --resume goes on with them";
        warn(&[told]);
    } else {
        warn(&[told]);
        results.end()?;
    }
    Ok(End::Interrupted)
}

/// Computes a batch and keeps what it gave; false where the user has ended it.
fn advance(job: &mut Job, batch: &Batch, digest: u128, results: &mut Results) -> Result<bool> {
    let first = results.outcomes().count() == 0;
    let together = job.compute(batch, results.outcomes().journal())?;
    if !together.first.complete {
        if job.keeper.keeps() {
            job.set_aside(results.outcomes().journal())?;
        }
        if first {
            // What there is of the base is shown; it does not count in what is set aside.
            let gave = Gave {
                base: Some(measured(&together.first.groups)),
                variants: Vec::new(),
            };
            let record = gave.record(digest)?;
            let place = results.outcomes().journal().append(&record)?;
            results.keep(&Batch::base(job.base), (place, &record), digest)?;
        }
        return Ok(false);
    }
    let record = results.gave(batch, &together)?.record(digest)?;
    let place = job.finish(batch, &together, &record, results.outcomes().journal())?;
    results.keep(batch, (place, &record), digest)?;
    Ok(true)
}
