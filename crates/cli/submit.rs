//! Handing a run to a cluster: an array of shards is submitted, watched and merged.

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::progress::Reporter;
use crate::report::{print, warn};
use crate::run::End;
use crate::slurm::Array;
use anyhow::{Result, anyhow, ensure};
use clap::{Args, ValueEnum};
use malus_estimator::{REPLICAS, Shard};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Time between the first two looks at the queue, and the longest; each is longer than the one before by half.
const POLL: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(10)];

/// Time within which the user's wish to end is heeded.
const NAP: Duration = Duration::from_millis(200);

/// How often a shard is handed in that comes no further.
const TRIES: u32 = 3;

/// Looks at the queue that may fail one after the other.
const SILENT: u32 = 60;

/// Options of handing a run to a cluster.
#[derive(Args, Clone, Debug, Default)]
pub struct Cluster {
    /// Hand the run to a cluster: its shards are submitted as a job array. Shards that are finished in DIR, or in the queue,
    /// are not submitted again
    #[arg(long, value_name = "SCHEDULER", requires = "shards", conflicts_with_all = ["shard", "resume", "threads"])]
    pub submit: Option<Scheduler>,

    /// Number of shards of --submit, 1 to 32
    #[arg(
        long,
        value_name = "N",
        requires = "submit",
        allow_hyphen_values = true
    )]
    pub shards: Option<String>,

    /// The site's own options of sbatch for --submit, in one word: "--partition=long --cpus-per-task=8 --time=2:00:00"
    #[arg(
        long,
        value_name = "OPTIONS",
        requires = "submit",
        allow_hyphen_values = true
    )]
    pub sbatch: Option<String>,

    /// Wait for the shards of --submit, submit again what failed, and merge them
    #[arg(long, requires = "submit")]
    pub wait: bool,
}

/// What takes jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Scheduler {
    /// Slurm, by its sbatch and squeue
    Slurm,
}

/// How far a shard has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Share of its walks that is taken, 0 … 1.
    pub share: f64,
    /// Whether nothing is left to do.
    pub finished: bool,
}

impl Cluster {
    /// Number of shards.
    ///
    /// # Errors
    /// It is none from 1 to 32.
    pub fn count(&self) -> Result<u32> {
        let text = self.shards.as_deref().unwrap_or_default();
        let shard = text.parse().ok().and_then(|n| Shard::new(1, n).ok());
        let shard = shard.ok_or_else(|| {
            anyhow!("--shards {text}: must be a whole number from 1 to {REPLICAS}, found {text:?}")
        })?;
        Ok(shard.count())
    }
}

/// Submits what is left to do of an array and, if asked to, waits until all is finished.
///
/// `reach` tells how far a shard has come, from its file. `merge` is what the user types to join the shards.
///
/// # Errors
/// The cluster does not take the jobs, or a shard comes no further.
pub fn submit(
    cluster: &Cluster,
    array: &Array,
    reach: &dyn Fn(u32) -> Reach,
    merge: &str,
    quiet: bool,
) -> Result<End, Failure> {
    let mut watch = Watch {
        array,
        reach,
        tried: BTreeMap::new(),
    };
    let submitted = watch.advance().map_err(Failure::run)?;
    if !quiet {
        print(&told(array, &submitted, cluster.wait, merge)).map_err(Failure::run)?;
    }
    if !cluster.wait {
        return Ok(End::Complete);
    }
    watch.wait(merge, quiet).map_err(Failure::run)
}

/// What is printed of a submission.
fn told(array: &Array, submitted: &[u32], waits: bool, merge: &str) -> String {
    let what = if submitted.is_empty() {
        "nothing is left to submit: every shard is finished or in the queue".to_owned()
    } else {
        let jobs = array.job_words();
        let [count, all] = [submitted.len() as u32, array.count];
        format!("{count} of {all} shards submitted; jobs so far: {jobs}")
    };
    let next = if waits {
        String::new()
    } else {
        format!("; when they are finished: {merge}")
    };
    format!("{what}{next}\n")
}

/// Shards on their way.
struct Watch<'a> {
    array: &'a Array<'a>,
    reach: &'a dyn Fn(u32) -> Reach,
    /// For each shard handed in: its share at that time, and how often it was handed in since it came further.
    tried: BTreeMap<u32, (f64, u32)>,
}

impl Watch<'_> {
    /// Submits all shards that are neither finished nor in the queue, and gives their numbers.
    ///
    /// # Errors
    /// The cluster does not answer or does not take them, or a shard has failed too often.
    fn advance(&mut self) -> Result<Vec<u32>> {
        // The queue first: what has left it since is finished in its file.
        let active = self.array.active()?;
        let left: Vec<(u32, Reach)> = (1..=self.array.count)
            .filter(|shard| !active.contains(shard))
            .map(|shard| (shard, (self.reach)(shard)))
            .filter(|(_, reach)| !reach.finished)
            .collect();
        for &(shard, reach) in &left {
            let (share, times) = self.tried.entry(shard).or_insert((reach.share, 0));
            if reach.share > *share {
                (*share, *times) = (reach.share, 0);
            }
            *times += 1;
            ensure!(
                *times <= TRIES,
                "shard {shard} was submitted {TRIES} times and came no further; {}",
                last_words(self.array, shard)
            );
        }
        let shards: Vec<u32> = left.iter().map(|(shard, _)| *shard).collect();
        if !shards.is_empty() {
            self.array.submit(&shards)?;
        }
        Ok(shards)
    }

    /// Waits until all shards are finished.
    ///
    /// # Errors
    /// The cluster does not answer, or a shard has failed too often.
    fn wait(&mut self, merge: &str, quiet: bool) -> Result<End> {
        let interrupt = Interrupt::listen()?;
        let started = Instant::now();
        let mut reporter = Reporter::new(quiet, None);
        let mut silent = 0;
        let [mut pause, longest] = POLL;
        loop {
            let reaches: Vec<Reach> = (1..=self.array.count).map(self.reach).collect();
            let finished = reaches.iter().filter(|reach| reach.finished).count();
            if finished == reaches.len() {
                reporter.finish();
                return Ok(End::Complete);
            }
            let share = reaches.iter().map(|reach| reach.share).sum::<f64>() / reaches.len() as f64;
            let name = format!("{finished} of {} shards finished", reaches.len());
            reporter.show_share(&name, share, started.elapsed().as_secs_f64());
            let looked = Instant::now();
            while looked.elapsed() < pause {
                if interrupt.asked() {
                    reporter.finish();
                    warn(&[format!(
                        "interrupted: the shards go on (jobs {}); when they are finished: {merge}",
                        self.array.job_words()
                    )]);
                    return Ok(End::Interrupted);
                }
                std::thread::sleep(NAP);
            }
            pause = (pause * 3 / 2).min(longest);
            match self.advance() {
                Ok(shards) => {
                    silent = 0;
                    if !shards.is_empty() {
                        let shards: Vec<String> = shards.iter().map(u32::to_string).collect();
                        warn(&[format!("submitted again: shards {}", shards.join(", "))]);
                    }
                }
                // A controller that starts anew does not answer for a while.
                Err(_) if silent < SILENT && self.array.active().is_err() => silent += 1,
                Err(error) => return Err(error),
            }
        }
    }
}

/// Where to look for what went wrong with a shard.
fn last_words(array: &Array, shard: u32) -> String {
    let log = array.log(shard);
    let text = std::fs::read_to_string(&log).unwrap_or_default();
    match text.lines().last() {
        Some(line) => format!("{} ends with: {line}", log.display()),
        None => format!("{} tells nothing", log.display()),
    }
}
