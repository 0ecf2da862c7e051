//! A shard of a study: the sums of its replicas for every variant, batch after batch, to be merged.

use super::batch::Batch;
use super::course::{Course, Step};
use super::job::Job;
use super::outcomes::CHANGED;
use crate::journal::{Journal, Records};
use crate::report::{print, warn};
use crate::run::End;
use anyhow::{Context, Result, ensure};
use malus_estimator::State;
use malus_scene::{Base, Fingerprint, Study};

/// The record of a batch in a shard: which batch, and the sums.
///
/// # Errors
/// It cannot be written as bytes.
pub fn record(digest: u128, state: &State) -> Result<Vec<u8>> {
    Ok(postcard::to_stdvec(&(digest, state))?)
}

/// The sums that a record holds.
///
/// # Errors
/// They are of another batch.
pub fn read(record: &[u8], digest: u128) -> Result<State> {
    let (found, state): (u128, &[u8]) = postcard::take_from_bytes(record)?;
    ensure!(found == digest, CHANGED);
    Ok(postcard::from_bytes(state)?)
}

/// Computes what is left of a shard; `journal` holds what is finished.
///
/// # Errors
/// The shard is damaged or of another study, or cannot be written.
pub fn compute(
    job: &mut Job,
    mut journal: Journal,
    study: &Study,
    base: &Base,
    quiet: bool,
) -> Result<End> {
    let path = job.directory.path().join(job.name);
    let shard = job.part.head.shard;
    let tell = |what: &str| {
        let text = format!("shard {shard} {what}: {}\n", path.display());
        if quiet { Ok(()) } else { print(&text) }
    };
    let name = Journal::name_of(job.name);
    let finished = job.part.head.finished();
    if job.part.head.complete {
        tell("is there already")?;
        return Ok(End::Complete);
    }
    let mut records = Records::open(&job.directory.path().join(&name), finished)?;
    let fingerprint = job.part.head.fingerprint;
    for step in Course::new(study, base) {
        match step {
            Step::Failed(failed) => {
                eprintln!("error: variant {}: {:#}", failed.name, failed.error);
                job.pass(1);
            }
            Step::Batch(batch) => {
                if let Some((_, record)) = records.next()? {
                    let told = || format!("{}", job.directory.path().join(&name).display());
                    read(&record, batch.digest(&base.scene, &fingerprint)?).with_context(told)?;
                    job.pass(batch.variants.len());
                } else if !advance(job, &batch, &mut journal, &fingerprint)? {
                    job.set_aside(&mut journal)?;
                    warn(&[format!(
                        "interrupted: {} is not finished; --resume goes on with it",
                        path.display()
                    )]);
                    return Ok(End::Interrupted);
                }
            }
        }
    }
    job.part.head.complete = true;
    job.set_aside(&mut journal)?;
    tell("is finished")?;
    Ok(End::Complete)
}

/// Computes a batch; false where the user has ended it.
fn advance(
    job: &mut Job,
    batch: &Batch,
    journal: &mut Journal,
    fingerprint: &Fingerprint,
) -> Result<bool> {
    let together = job.compute(batch, journal)?;
    if !together.first.complete {
        return Ok(false);
    }
    let digest = batch.digest(job.base, fingerprint)?;
    let record = record(digest, &job.part.state)?;
    job.finish(batch, &together, &record, journal)?;
    Ok(true)
}
