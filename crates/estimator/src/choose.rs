//! Which estimator a scene is given, and what each cannot see.

use crate::engine::Engine;
use crate::pass::is_mirrorlike;
use crate::receiver::Receiver;
use crate::statistics::REPLICAS;
use crate::trace::Medium;
use malus_scene::{Estimator, Material};

/// Walks a replica of a pilot run.
const PILOT: u64 = 8;

/// Sensors, evenly spaced over all, that a pilot looks at.
const PILOT_SENSORS: usize = 32;

/// A local estimate is trusted where no surface in front of a sensor is nearer than this share of the mean distance:
/// its variance grows as the inverse square of the distance, faster than a short pilot can tell.
const CLEARANCE: f64 = 0.2;

/// Nearer than this, in the same measure, errors are not only large but wrong.
const TRUSTED: f64 = 0.02;

/// An estimator with the reason for it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chosen {
    /// Local, gather or direct.
    pub estimator: Estimator,
    /// One sentence.
    pub reason: String,
}

impl Chosen {
    fn gather(reason: impl Into<String>) -> Self {
        Self {
            estimator: Estimator::Gather,
            reason: reason.into(),
        }
    }
}

/// The estimator asked for, or for `auto` the one that misses least, and among equals the one that is cheaper.
pub(crate) fn choose<const N: usize>(engine: &Engine<N>, asked: Estimator) -> Chosen {
    match asked {
        Estimator::Local | Estimator::Gather | Estimator::Direct => Chosen {
            estimator: asked,
            reason: "asked for".into(),
        },
        Estimator::Auto => automatic(engine),
    }
}

fn automatic<const N: usize>(engine: &Engine<N>) -> Chosen {
    let surfaces = engine.passes.main.surfaces;
    let media = engine.passes.media();
    let mirrors: Vec<&str> = media
        .flat_map(|medium| mirrorlike_names(medium.materials))
        .collect();
    if !mirrors.is_empty() {
        return Chosen::gather(format!(
            "local estimates cannot see light whose last reflection is mirror-like ({})",
            mirrors.join(", ")
        ));
    }
    let pilots: Vec<Receiver> = {
        let free: Vec<Receiver> = engine
            .receivers
            .iter()
            .copied()
            .filter(|r| !r.enclosed)
            .collect();
        let stride = free.len().div_ceil(PILOT_SENSORS).max(1);
        free.into_iter().step_by(stride).collect()
    };
    let clearance = pilots
        .iter()
        .map(|receiver| clearance(surfaces, receiver))
        .fold(f64::INFINITY, f64::min);
    if clearance < CLEARANCE {
        return Chosen::gather(format!(
            "a sensor stands so near a surface ({:.2} of its mean view) that local estimates would be erratic",
            clearance
        ));
    }
    let pilot = Engine::<N> {
        receivers: &pilots,
        ..*engine
    };
    // Cost of a sample in rays times the largest relative variance of a sample: proportional to time for a given error.
    let shares = engine.receivers.len() as f64 / pilots.len().max(1) as f64;
    let cost = |estimator| {
        let mut tally = pilot.tally();
        let effort = pilot.advance(estimator, &mut tally, PILOT);
        let variance = (0..pilots.len())
            .map(|sensor| {
                let index = sensor * pilot.channels.count;
                let estimate = tally.estimate(|means| means.at(index));
                let relative = estimate.standard_error / estimate.mean;
                relative * relative
            })
            .filter(|variance| variance.is_finite())
            .fold(0.0, f64::max);
        variance * effort.rays as f64 * shares
    };
    let (local, gather) = (cost(Estimator::Local), cost(Estimator::Gather));
    let walks = PILOT * u64::from(REPLICAS);
    let cheaper = |one: f64, other: f64, name: &str| {
        format!(
            "nothing mirror-like, and a pilot of {walks} walks found it {:.1} times cheaper than {name}",
            other / one
        )
    };
    // An estimator whose pilot saw nothing vary has proved nothing.
    if local <= 0.0 || gather <= 0.0 {
        Chosen::gather(format!(
            "nothing mirror-like, and a pilot of {walks} walks saw no light to compare the estimators by"
        ))
    } else if local < gather {
        Chosen {
            estimator: Estimator::Local,
            reason: cheaper(local, gather, "gather"),
        }
    } else {
        Chosen::gather(cheaper(gather, local, "local"))
    }
}

/// Nearest surface in front of a sensor as a share of the mean distance of what it sees.
fn clearance(surfaces: &malus_geometry::Surfaces, receiver: &Receiver) -> f64 {
    const SIDE: i32 = 8;
    let mut nearest = f64::INFINITY;
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..SIDE * SIDE {
        let at = |k: i32| (f64::from(k) + 0.5) / f64::from(SIDE);
        let direction =
            crate::direction::in_cone(receiver.normal, 0.0, [at(i / SIDE), at(i % SIDE)]);
        if let Some(hit) = surfaces.nearest(receiver.origin, direction) {
            nearest = nearest.min(hit.distance);
            sum += hit.distance;
            count += 1.0;
        }
    }
    if count > 0.0 {
        nearest * count / sum
    } else {
        f64::INFINITY
    }
}

/// Names of the materials that reflect like a mirror.
pub(crate) fn mirrorlike_names(materials: &[Material]) -> Vec<&str> {
    let mut names: Vec<&str> = materials
        .iter()
        .filter(|m| is_mirrorlike(m))
        .map(|m| m.name.as_str())
        .collect();
    names.dedup();
    names
}

/// Says if a local estimate was asked for where its variance, and so its error bar, cannot be trusted.
pub(crate) fn erratic<const N: usize>(engine: &Engine<N>, estimator: Estimator) -> Option<String> {
    if estimator != Estimator::Local {
        return None;
    }
    let surfaces = engine.passes.main.surfaces;
    let free = || engine.receivers.iter().filter(|r| !r.enclosed);
    let near = free()
        .filter(|receiver| clearance(surfaces, receiver) < TRUSTED)
        .count();
    (near > 0).then(|| {
        format!(
            "local: {near} of {} sensor points stand so near a surface that values and errors there cannot be trusted: \
             the variance of a local estimate grows without bound towards a surface; gather has no such limit",
            free().count()
        )
    })
}

/// The paths that an estimator cannot see in this scene, one sentence each.
pub(crate) fn blind_spots(medium: &Medium, estimator: Estimator) -> Vec<String> {
    let mirrors = mirrorlike_names(medium.materials);
    if mirrors.is_empty() {
        return Vec::new();
    }
    let mirrors = mirrors.join(", ");
    let sources = medium.emitters.source_share();
    match estimator {
        Estimator::Local => vec![format!(
            "local: light whose last reflection before the sensor is mirror-like is missing (off {mirrors})"
        )],
        // What is counted is counted by whatever way it came.
        Estimator::Direct => Vec::new(),
        _ if sources > 0.0 => vec![format!(
            "gather: light of point, spot and distant sources ({:.1} % of the flux) that a mirror-like reflection \
             (off {mirrors}) sends on to a sensor or to a diffuse surface is missing",
            100.0 * sources
        )],
        _ => Vec::new(),
    }
}
