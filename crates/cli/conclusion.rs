//! `study.json`, and what `sweep` prints at its end.

use crate::findings::Finding;
use crate::number::duration;
use anyhow::Result;
use malus_scene::{Scene, Unit};
use serde::Serialize;
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
struct Json<'a, G> {
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
    sensors: Vec<G>,
}

/// How variants share walks.
#[derive(Serialize)]
struct Walks<'a> {
    /// Sets of walks.
    sets: usize,
    /// Variants too far from the base to share its walks.
    apart: &'a [String],
}

/// The study as JSON.
///
/// # Errors
/// It cannot be written as JSON.
pub fn json(scene: &Scene, circumstances: &Circumstances, findings: &[Finding]) -> Result<Vec<u8>> {
    let Computed {
        seed,
        samples,
        dof,
        complete,
    } = *circumstances.computed;
    let mut text = serde_json::to_vec_pretty(&Json {
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
        sensors: findings.iter().map(Finding::json).collect(),
    })?;
    text.push(b'\n');
    Ok(text)
}

/// The study in tables.
pub fn text(circumstances: &Circumstances, findings: &[Finding], directory: &Path) -> String {
    let mut text = String::new();
    for finding in findings {
        text += &finding.text();
        text.push('\n');
    }
    text += &format!(
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
