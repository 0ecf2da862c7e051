//! What of a run is computed, and where it begins: anew, or where it was set aside.

use crate::keeper::{self, Interval};
use crate::output::Directory;
use crate::part::{CHECKPOINT, Head, Part, Studied};
use crate::report::warn;
use anyhow::{Context, Error, Result, anyhow};
use clap::Args;
use malus_estimator::{REPLICAS, Shard, State};
use malus_scene::Settings;

/// Options of what is computed of a run, and of how it survives what ends the program.
#[derive(Args, Clone, Debug, Default)]
pub struct Portion {
    /// Compute part I of N, 1 ≤ I ≤ N ≤ 32, and write it to DIR for `malus merge`. The run has to be stopped by its number of
    /// samples
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    pub shard: Option<String>,

    /// Set the run aside every so many seconds, so that --resume can go on with it; 0: never [default: 60]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub checkpoint: Option<String>,

    /// Go on where the same run into the same directory was set aside, if it was: the results have the same bytes
    #[arg(long)]
    pub resume: bool,
}

impl Portion {
    /// The shard asked for, if any.
    ///
    /// # Errors
    /// There is no such shard, or the run has another stopping rule than a number of samples.
    pub fn shard(&self, settings: &Settings) -> Result<Option<Shard>> {
        let Some(text) = &self.shard else {
            return Ok(None);
        };
        let option = format!("--shard {text}");
        let shard = text.parse().map_err(|error| anyhow!("{option}: {error}"))?;
        samples_alone(settings, &option)?;
        Ok(Some(shard))
    }

    /// How often the run is set aside.
    ///
    /// # Errors
    /// What was asked for is no number of seconds.
    pub fn interval(&self) -> Result<Interval> {
        keeper::interval(self.checkpoint.as_deref())
    }

    /// Where the run begins that `head` tells of: at the file of that name if it is to be resumed and there is one.
    ///
    /// # Errors
    /// The file is damaged, or of another run.
    pub fn begin(&self, head: Head, name: &str, directory: &Directory) -> Result<Part> {
        let path = directory.path().join(name);
        let whole = name == CHECKPOINT;
        // Results may have been written when a run was ended; shards of others may be written now.
        directory.tidy(if self.resume && whole { "" } else { name });
        if !(self.resume && path.exists()) {
            if whole && path.exists() {
                let instead = match head.study {
                    // Its journal grows in the place of the old one.
                    Some(_) => "in its place; --resume would have gone on with it",
                    None => "--resume would go on with it",
                };
                warn(&[format!(
                    "{}: an earlier run was set aside there; this one begins anew, {instead}",
                    path.display()
                )]);
            }
            return Ok(Part {
                state: State::new(head.shard),
                films: Vec::new(),
                allocation: None,
                head,
            });
        }
        let mut part = Part::read(&path)?;
        let told = |error: Error| {
            anyhow!(
                "{}: {error}; --resume goes on with the same run only: leave it out to begin anew, or choose another -o",
                path.display()
            )
        };
        head.check(&part.head).map_err(told)?;
        if let Some(goal) = head.goal.filter(|&goal| goal < part.head.samples) {
            let taken = part.head.samples;
            return Err(told(anyhow!(
                "holds {taken} samples already, and {goal} are asked for"
            )));
        }
        let study = head.study.as_ref().zip(part.head.study.take());
        let study = study.map(|(asked, found)| Studied {
            parquet: asked.parquet,
            ..found
        });
        // The same sums may be taken further, or have pictures added.
        let done = part.head.complete
            && part.head.goal == head.goal
            && part.head.pictures == head.pictures;
        part.head = Head {
            complete: done,
            samples: part.head.samples,
            shot: part.head.shot,
            seconds: part.head.seconds,
            study,
            ..head
        };
        Ok(part)
    }
}

/// Makes sure that a run which is computed in parts is stopped by its number of samples alone: any other rule depends on
/// all parts together.
///
/// # Errors
/// It has no number of samples, or another rule beside it.
pub fn samples_alone(settings: &Settings, option: &str) -> Result<u64> {
    let others = [
        ("relative_error", settings.relative_error),
        ("seconds", settings.seconds),
    ];
    let given = others
        .iter()
        .find_map(|(key, value)| Some((key, (*value)?)));
    if let Some((key, value)) = given {
        return Err(anyhow!(
            "{option}: parts of a run are stopped by their number of samples, as any other rule depends on all parts \
             together; found {key} = {value}; give --samples N, which takes its place"
        ));
    }
    let samples = settings.samples;
    samples.with_context(|| format!("{option}: a part of a run needs --samples N"))
}

/// The number of samples that a run takes which is asked for `samples`: whole rounds.
pub fn rounded_up(samples: u64) -> u64 {
    let replicas = u64::from(REPLICAS);
    samples.div_ceil(replicas).max(1).saturating_mul(replicas)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stop::tests::settings;

    #[test]
    fn a_part_of_a_run_needs_samples_and_nothing_else() {
        let portion = |text: &str| Portion {
            shard: Some(text.to_owned()),
            ..Portion::default()
        };
        let stops = |samples, relative_error, seconds| Settings {
            samples,
            relative_error,
            seconds,
            ..settings()
        };
        let good = portion("3/8").shard(&stops(Some(64), None, None));
        assert_eq!(good.expect("a shard").map(Shard::index), Some(3));
        let none = Portion::default().shard(&stops(None, Some(0.1), None));
        assert!(none.expect("no shard").is_none());
        for (text, settings, told) in [
            (
                "9/8",
                stops(Some(64), None, None),
                "1 ≤ I ≤ N ≤ 32, found \"9/8\"",
            ),
            (
                "3/8",
                stops(None, Some(0.01), None),
                "found relative_error = 0.01",
            ),
            ("3/8", stops(Some(64), None, Some(5.0)), "found seconds = 5"),
        ] {
            let error = portion(text).shard(&settings).expect_err("no shard");
            let error = error.to_string();
            assert!(
                error.starts_with(&format!("--shard {text}: ")) && error.contains(told),
                "{error}"
            );
        }
    }

    #[test]
    fn samples_are_rounded_up_to_whole_rounds() {
        assert_eq!([1, 32, 33].map(rounded_up), [32, 32, 64]);
    }
}
