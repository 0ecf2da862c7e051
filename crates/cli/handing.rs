//! A run or a study on its way to a cluster: as shards, which are merged when all are finished.

use crate::args;
use crate::computing::quoted;
use crate::failure::Failure;
use crate::output::Directory;
use crate::part::{Head, Part};
use crate::portion::{rounded_up, samples_alone};
use crate::run::End;
use crate::slurm::Array;
use crate::submit::{Cluster, Reach};
use crate::{merge, shards, submit};
use anyhow::{Context, Error};
use malus_estimator::Shard;
use malus_scene::Settings;
use std::path::{Path, PathBuf};

/// What is handed in.
pub struct Handing<'a> {
    /// To where, and in how many shards.
    pub cluster: &'a Cluster,
    /// The command that computes a shard.
    pub command: &'static str,
    /// The file that it reads.
    pub input: &'a Path,
    /// What it is called.
    pub title: &'a str,
    /// What its files say of themselves.
    pub head: &'a Head,
    /// How it is computed.
    pub settings: &'a Settings,
    /// Number of cameras.
    pub cameras: usize,
    /// How often shards are set aside, as typed.
    pub checkpoint: Option<&'a str>,
    /// Further options of the command.
    pub flags: &'a [&'static str],
    /// Directory of the results.
    pub output: PathBuf,
    /// Whether nothing is printed.
    pub quiet: bool,
}

impl Handing<'_> {
    /// Submits what is left to do and, if asked to, waits for it and merges it.
    ///
    /// # Errors
    /// There are shards of something else in the directory, the cluster does not take them, or they cannot be merged.
    pub fn hand_in(&self) -> Result<End, Failure> {
        let goal = samples_alone(self.settings, "--submit").map_err(Failure::input)?;
        let goal = rounded_up(goal);
        let count = self.cluster.count().map_err(Failure::input)?;
        let output =
            std::path::absolute(&self.output).map_err(|error| Failure::run(error.into()))?;
        let directory = Directory::prepare(&output).map_err(Failure::run)?;
        shards::belong(&output, self.head, count).map_err(Failure::input)?;
        let reach = |index| {
            let shard = Shard::new(index, count).expect("the number of shards is checked");
            let found = Part::peek(&output.join(Part::name_of(shard)));
            found.map_or(Reach::default(), |found| Reach {
                share: found.share(self.cameras),
                finished: found.finishes(self.head),
            })
        };
        let title = format!("malus {}", self.title);
        let array = Array {
            directory: &directory,
            title: &title,
            words: &self.words(goal, &output).map_err(Failure::run)?,
            count,
            options: self.cluster.sbatch.as_deref().unwrap_or_default(),
        };
        let merge = format!("malus merge {}", quoted(&output.to_string_lossy()));
        let end = submit::submit(self.cluster, &array, &reach, &merge, self.quiet)?;
        if end == End::Complete && self.cluster.wait {
            merge::merge(&args::Merge {
                shards: vec![output],
                output: None,
                scene: Some(self.input.to_owned()),
                no_pictures: !self.head.pictures,
                quiet: self.quiet,
            })?;
        }
        Ok(end)
    }

    /// The program and its arguments that compute a shard, but for which.
    fn words(&self, goal: u64, output: &Path) -> Result<Vec<String>, Error> {
        let program = std::env::current_exe().context("cannot tell where this program is")?;
        let text = |path: &Path| path.to_string_lossy().into_owned();
        let mut words = vec![
            text(&program),
            self.command.to_owned(),
            self.head.scene.clone(),
        ];
        words.extend(self.head.words.iter().cloned());
        words.extend(["--samples".to_owned(), goal.to_string()]);
        if let Some(seconds) = self.checkpoint {
            words.extend(["--checkpoint".to_owned(), seconds.to_owned()]);
        }
        words.extend(self.flags.iter().map(|flag| (*flag).to_owned()));
        words.extend(["--quiet".to_owned(), "-o".to_owned(), text(output)]);
        Ok(words)
    }
}
