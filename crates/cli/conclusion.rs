//! `study.json`, and what `sweep` prints at its end.

use crate::findings::Finding;
use crate::number::duration;
use anyhow::Result;
use malus_scene::{Scene, Unit};
use serde::ser::{Error, SerializeSeq};
use serde::{Serialize, Serializer};
use std::cell::RefCell;
use std::io::Write;
use std::path::Path;

/// What the variants have in common.
#[derive(Clone, Copy, Debug)]
pub struct Computed {
    /// Seed of the random numbers.
    pub seed: u64,
    /// Samples of each variant.
    pub samples: u64,
    /// Degrees of freedom of all standard errors.
    pub dof: u32,
    /// False where the user has ended it.
    pub complete: bool,
}

/// How a study came about.
pub struct Circumstances<'a> {
    /// Its name.
    pub study: &'a str,
    /// What the variants have in common.
    pub computed: &'a Computed,
    /// Number of variants.
    pub variants: usize,
    /// Names of those that failed.
    pub failed: &'a [String],
    /// Sets of walks that were taken for them.
    pub batches: usize,
    /// Names of variants that walks for the base would have served badly.
    pub apart: &'a [String],
    /// Time it took, in seconds.
    pub seconds: f64,
    /// Threads it ran on.
    pub threads: usize,
}

#[derive(Serialize)]
struct Json<'a, L> {
    study: &'a str,
    scene: &'a str,
    unit: Unit,
    version: &'a str,
    seed: u64,
    samples: u64,
    dof: u32,
    seconds: f64,
    threads: usize,
    complete: bool,
    variants: usize,
    failed: &'a [String],
    walks: Walks<'a>,
    sensors: L,
}

/// A list whose items come about as they are written.
struct OneByOne<G>(RefCell<G>);

impl<'f, G: Iterator<Item = Result<Finding<'f>>>> Serialize for OneByOne<G> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        for finding in self.0.borrow_mut().by_ref() {
            let finding = finding.map_err(|error| S::Error::custom(format!("{error:#}")))?;
            list.serialize_element(&finding.json())?;
        }
        list.end()
    }
}

/// How variants share walks.
#[derive(Serialize)]
struct Walks<'a> {
    /// Sets of walks.
    sets: usize,
    /// Variants too far from the base to share its walks.
    apart: &'a [String],
}

/// Writes the study as JSON.
///
/// # Errors
/// A finding cannot be had, or the file cannot be written.
pub fn write<'f>(
    mut file: impl Write,
    scene: &Scene,
    circumstances: &Circumstances,
    findings: impl Iterator<Item = Result<Finding<'f>>>,
) -> Result<()> {
    let Computed {
        seed,
        samples,
        dof,
        complete,
    } = *circumstances.computed;
    let json = Json {
        study: circumstances.study,
        scene: &scene.name,
        unit: scene.unit,
        version: env!("CARGO_PKG_VERSION"),
        seed,
        samples,
        dof,
        seconds: circumstances.seconds,
        threads: circumstances.threads,
        complete,
        variants: circumstances.variants,
        failed: circumstances.failed,
        walks: Walks {
            sets: circumstances.batches,
            apart: circumstances.apart,
        },
        sensors: OneByOne(RefCell::new(findings)),
    };
    serde_json::to_writer_pretty(&mut file, &json)?;
    Ok(file.write_all(b"\n")?)
}

/// How the study came about, in words.
pub fn text(circumstances: &Circumstances, directory: &Path) -> String {
    let mut text = format!(
        "{} variants of {} samples each, along {} of walks, seed {}; {} on {} threads\n",
        circumstances.variants,
        circumstances.computed.samples,
        match circumstances.batches {
            1 => "one set".to_owned(),
            sets => format!("{sets} sets"),
        },
        circumstances.computed.seed,
        duration(circumstances.seconds),
        circumstances.threads,
    );
    if !circumstances.apart.is_empty() {
        text += &format!(
            "too far from the base to share its walks: {}\n",
            circumstances.apart.join(", ")
        );
    }
    text + &format!("results in {}\n", directory.display())
}
