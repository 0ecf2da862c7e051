//! The shards of one run, as they lie in directories.

use crate::part::{Head, Part};
use anyhow::{Context, Result, anyhow, bail, ensure};
use malus_estimator::{Film, State};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files of shards, each with what it holds, by the number of the shard.
#[derive(Debug)]
pub struct Shards(BTreeMap<u32, (PathBuf, Part)>);

impl Shards {
    /// Reads all shards that lie in some directories.
    ///
    /// # Errors
    /// A directory holds none, or a shard is damaged, there twice, or of another run than the others. All that is wrong is
    /// told at once, each by the name of its file.
    pub fn read(directories: &[PathBuf]) -> Result<Self> {
        let mut shards = BTreeMap::new();
        let mut wrong = Vec::new();
        for directory in directories {
            for path in files(directory)? {
                match Part::read(&path).and_then(|part| admit(&mut shards, path, part)) {
                    Ok(()) => {}
                    Err(error) => wrong.push(format!("{error:#}")),
                }
            }
        }
        ensure!(wrong.is_empty(), wrong.join("\n"));
        Ok(Self(shards))
    }

    /// Any of them: what it says of the run, all of them say.
    pub fn any(&self) -> &Part {
        let first = self.0.values().next();
        &first.expect("directories without shards are refused").1
    }

    /// All of them, each with its file.
    pub fn all(&self) -> impl Iterator<Item = &(PathBuf, Part)> {
        self.0.values()
    }

    /// Makes sure that all shards are there and finished.
    ///
    /// # Errors
    /// Some are not; the error tells which, and how to compute them.
    pub fn check(&self) -> Result<()> {
        let count = self.any().head.shard.count();
        let missing: Vec<String> = (1..=count)
            .filter(|index| !self.0.contains_key(index))
            .map(|index| index.to_string())
            .collect();
        let mut wrong: Vec<String> = self.0.values().filter_map(unfinished).collect();
        if !missing.is_empty() {
            wrong.push(format!(
                "of {count} shards these are missing: {}; compute each with malus {} … --shard I/{count}",
                missing.join(", "),
                match self.any().head.study {
                    Some(_) => "sweep",
                    None => "run",
                }
            ));
        }
        ensure!(wrong.is_empty(), wrong.join("\n"));
        Ok(())
    }

    /// Time that all of them took together, in seconds.
    pub fn seconds(&self) -> f64 {
        self.0.values().map(|(_, part)| part.head.seconds).sum()
    }

    /// The most threads that one of them ran on.
    pub fn threads(&self) -> usize {
        let threads = self.0.values().map(|(_, part)| part.head.threads);
        threads.max().unwrap_or(1)
    }

    /// The sums and films of all of them, as of a run in one piece.
    ///
    /// # Errors
    /// Two of them hold the same replica.
    pub fn joined(self) -> Result<(State, Vec<Film>)> {
        let mut joined: Option<State> = None;
        let mut films: Vec<Film> = Vec::new();
        for (path, part) in self.0.into_values() {
            joined = Some(match joined {
                None => part.state,
                Some(state) => state
                    .merge(part.state)
                    .with_context(|| format!("{}", path.display()))?,
            });
            if films.len() < part.films.len() {
                films.resize(part.films.len(), Film::default());
            }
            for (film, other) in films.iter_mut().zip(part.films) {
                film.merge(other);
            }
        }
        Ok((joined.context("there is no shard")?, films))
    }
}

/// Makes sure that the shards that lie in a directory, if any, are of the run that `run` tells of and of so many.
///
/// # Errors
/// One is not; the error names its file.
pub fn belong(directory: &Path, run: &Head, count: u32) -> Result<()> {
    for path in entries(directory)? {
        let found = Part::peek(&path)
            .context("is no state of a run")
            .and_then(|found| {
                run.check_run(&found)?;
                let of = found.shard.count();
                ensure!(of == count, "is one of {of} shards, not of {count}");
                Ok(())
            });
        found.map_err(|error| {
            anyhow!(
                "{}: {error}; remove it, or choose another directory with -o",
                path.display()
            )
        })?;
    }
    Ok(())
}

/// Files in a directory that are called as shards, in the order of their names.
fn entries(directory: &Path) -> Result<Vec<PathBuf>> {
    let told = || format!("{}: cannot be read as a directory", directory.display());
    let mut files = Vec::new();
    for entry in std::fs::read_dir(directory).with_context(told)? {
        let path = entry.with_context(told)?.path();
        if Part::is_shard(&path) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// The same, where there have to be some.
fn files(directory: &Path) -> Result<Vec<PathBuf>> {
    let files = entries(directory)?;
    if files.is_empty() {
        bail!(
            "{}: holds no shards, files shard-I-of-N.malus as malus run --shard I/N and malus sweep --shard I/N write them",
            directory.display()
        );
    }
    Ok(files)
}

/// Takes a shard in beside the others.
fn admit(shards: &mut BTreeMap<u32, (PathBuf, Part)>, path: PathBuf, part: Part) -> Result<()> {
    let own = env!("CARGO_PKG_VERSION");
    let head = &part.head;
    ensure!(
        head.version == own,
        "{}: was written by malus {}, this is {own}",
        path.display(),
        head.version
    );
    if let Some((other, first)) = shards.values().next() {
        let told = |what: String| {
            anyhow!(
                "{}: is of another run than {}: {what}",
                path.display(),
                other.display()
            )
        };
        let differences = head.fingerprint.differences(&first.head.fingerprint);
        if !differences.is_empty() {
            return Err(told(format!("they differ in {}", differences.join(", "))));
        }
        if let Err(error) = first.head.check_run(head) {
            return Err(told(format!("it {error}")));
        }
        let samples = |goal: Option<u64>| goal.map_or("any number".to_owned(), |n| n.to_string());
        if head.goal != first.head.goal {
            let [found, expected] = [head.goal, first.head.goal].map(samples);
            return Err(told(format!("{found} samples, not {expected}")));
        }
        let [found, expected] = [head.shard, first.head.shard].map(|shard| shard.count());
        if found != expected {
            return Err(told(format!("one of {found} shards, not of {expected}")));
        }
        if head.pictures != first.head.pictures {
            return Err(told(
                "one was given --no-pictures and the other was not".to_owned(),
            ));
        }
    }
    let index = head.shard.index();
    if let Some((other, _)) = shards.get(&index) {
        bail!(
            "{}: shard {} is there twice, the other is {}",
            path.display(),
            head.shard,
            other.display()
        );
    }
    shards.insert(index, (path, part));
    Ok(())
}

/// What is said of a shard that is not finished.
fn unfinished((path, part): &(PathBuf, Part)) -> Option<String> {
    let head = &part.head;
    let goal = head.goal.unwrap_or(head.samples);
    (!head.complete).then(|| match &head.study {
        Some(study) => format!(
            "{}: is not finished ({:.0} % of the variants); compute shard {} again with --resume",
            path.display(),
            100.0 * study.share,
            head.shard
        ),
        None => format!(
            "{}: is not finished ({} of {goal} samples); compute shard {} again with --resume",
            path.display(),
            head.samples,
            head.shard
        ),
    })
}
