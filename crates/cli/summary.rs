//! `summary.json`: how the results came about.

use crate::label;
use anyhow::Result;
use malus_estimator::{Results, Stop};
use malus_scene::{Scene, Settings, Unit};
use serde::Serialize;

/// What only the program knows of a run.
#[derive(Clone, Debug)]
pub struct Circumstances {
    /// Time the run took, in seconds.
    pub seconds: f64,
    /// Threads it ran on.
    pub threads: usize,
    /// False where the user ended the run, or a picture, before it was done.
    pub complete: bool,
    /// Options of `malus run` that repeat it to the byte.
    pub repeat: String,
    /// Warnings of the scene and of the run.
    pub warnings: Vec<String>,
}

#[derive(Serialize)]
struct Summary<'a> {
    scene: &'a str,
    unit: Unit,
    version: &'a str,
    seed: u64,
    model: &'a str,
    representation: &'a str,
    representation_reason: &'a str,
    estimator: &'a str,
    estimator_reason: &'a str,
    samples: u64,
    dof: u32,
    seconds: f64,
    threads: usize,
    triangles: usize,
    complete: bool,
    stop: &'a str,
    repeat: &'a str,
    relative_error_max: f64,
    techniques: Techniques,
    energy: Energy<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unseen: Option<Unseen>,
    warnings: &'a [String],
}

/// Where the emitted flux goes, in the scene's unit.
#[derive(Serialize)]
struct Energy<'a> {
    emitted: f64,
    absorbed: f64,
    escaped: f64,
    truncated: f64,
    /// Standard error of emitted − absorbed − escaped − truncated.
    se: f64,
    materials: Vec<Absorbed<'a>>,
}

/// What one material absorbs.
#[derive(Serialize)]
struct Absorbed<'a> {
    name: &'a str,
    absorbed: f64,
    se: f64,
}

impl<'a> Energy<'a> {
    fn of(energy: &'a malus_estimator::Energy) -> Self {
        let materials = energy.by_material.iter().map(|it| Absorbed {
            name: &it.material,
            absorbed: it.flux,
            se: it.standard_error,
        });
        Self {
            emitted: energy.emitted,
            absorbed: energy.absorbed,
            escaped: energy.escaped,
            truncated: energy.truncated,
            se: energy.standard_error,
            materials: materials.collect(),
        }
    }
}

/// Light that no technique of the estimator can find, as a share of all light that meets surfaces.
#[derive(Serialize)]
struct Unseen {
    share: f64,
    se: f64,
    at_most: f64,
}

/// What each way of finding light has brought, as shares of S0 summed over the free sensor points.
#[derive(Serialize)]
struct Techniques {
    /// Summed exactly: sources without geometry, straight and by their images in few flat mirrors, emitters seen whole, and where
    /// walks correct a guess of what surfaces scatter, that guess.
    exact: f64,
    /// Walks from the sensors that looked at emitters, or what they corrected, which may be negative.
    looked: f64,
    /// The same in mirrors.
    mirrored: f64,
    /// Walks from the sensors that met emitters by chance.
    met: f64,
    /// Walks from the emitters, joined to the sensors.
    local: f64,
}

/// The summary as JSON.
///
/// # Errors
/// It cannot be written as JSON.
pub fn json(
    scene: &Scene,
    settings: &Settings,
    results: &Results,
    circumstances: &Circumstances,
) -> Result<Vec<u8>> {
    let summary = Summary {
        scene: &scene.name,
        unit: scene.unit,
        version: env!("CARGO_PKG_VERSION"),
        seed: settings.seed,
        model: label::model(settings.model),
        representation: label::representation(results.representation),
        representation_reason: &results.representation_reason,
        estimator: label::estimator(results.estimator),
        estimator_reason: &results.estimator_reason,
        samples: results.samples,
        dof: results.dof,
        seconds: circumstances.seconds,
        threads: circumstances.threads,
        triangles: scene.surfaces.len(),
        complete: circumstances.complete,
        stop: stop(results.stop),
        repeat: &circumstances.repeat,
        relative_error_max: results.relative_error_max,
        techniques: Techniques {
            exact: results.shares.exact,
            looked: results.shares.looked,
            mirrored: results.shares.mirrored,
            met: results.shares.met,
            local: results.shares.local,
        },
        energy: Energy::of(&results.energy),
        unseen: results.unseen.map(|it| Unseen {
            share: it.share,
            se: it.standard_error,
            at_most: it.at_most,
        }),
        warnings: &circumstances.warnings,
    };
    let mut text = serde_json::to_vec_pretty(&summary)?;
    text.push(b'\n');
    Ok(text)
}

/// What ended the run, as a key.
fn stop(stop: Stop) -> &'static str {
    match stop {
        Stop::RelativeError => "relative_error",
        Stop::Samples => "samples",
        Stop::Time => "seconds",
        Stop::Interrupted => "interrupted",
    }
}
