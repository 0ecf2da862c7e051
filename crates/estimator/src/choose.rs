//! Which estimator a scene is given, and what each cannot see.

use crate::bridge;
use crate::emitters::Emitters;
use crate::engine::Engine;
use crate::medium::Medium;
use crate::pass::{Modelled, is_mirrorlike};
use crate::receiver::Receiver;
use crate::techniques::Techniques;
use malus_geometry::Surfaces;
use malus_scene::{Estimator, Material, Scene, Settings};

/// A local estimate is not to be trusted where a surface in front of a sensor is nearer than this share of the mean
/// distance: its variance grows as the inverse square of the distance.
const TRUSTED: f64 = 0.02;

/// Those of walks from sensors that correct a guess, and why they are used.
pub(crate) const CORRECTING: (Techniques, &str) = (
    Techniques {
        mirrored: true,
        local: 0.0,
        bridged: 0.0,
        block: 0,
        gather: true,
        shared: true,
    },
    "an empty convex room without mirrors: a solution of its radiosity equation on tiles, and walks from the sensors that \
     correct it; nothing is lost",
);

/// The techniques of an estimator, and one sentence on why it is used.
pub(crate) fn techniques(
    asked: Estimator,
    surfaces: &Surfaces,
    receivers: &[Receiver],
) -> (Techniques, &'static str) {
    let joined = receivers.iter().any(Receiver::is_irradiance);
    let block = if joined { bridge::walks(surfaces) } else { 0 };
    match asked {
        Estimator::Local | Estimator::Direct => (Techniques::ALONE, "asked for"),
        Estimator::Gather => (
            Techniques {
                mirrored: false,
                local: 0.0,
                bridged: 0.0,
                block: 0,
                gather: true,
                shared: false,
            },
            "asked for",
        ),
        Estimator::Auto => (
            Techniques {
                mirrored: true,
                local: if joined { 1.0 } else { 0.0 },
                bridged: 0.0,
                block,
                gather: true,
                shared: joined,
            },
            "walks from both ends and images in flat mirrors, weighted against each other: nothing is lost",
        ),
    }
}

/// Nearest surface in front of a sensor as a share of the mean distance of what it sees.
fn clearance(surfaces: &Surfaces, receiver: &Receiver) -> f64 {
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

/// The paths that an estimator cannot see in a scene, one sentence each; none where it sees all light.
#[must_use]
pub fn unseen(scene: &Scene, settings: &Settings) -> Vec<String> {
    let emitters = Emitters::new(scene);
    let modelled = Modelled::alone(scene, settings.model);
    blind_spots(&modelled.medium(scene, &emitters), settings.estimator)
}

/// The paths that an estimator cannot see in this medium, one sentence each.
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
        Estimator::Gather if sources > 0.0 => vec![format!(
            "gather: light of point, spot and distant sources ({:.1} % of the flux) that a mirror-like reflection \
             (off {mirrors}) sends on to a sensor or to a diffuse surface is missing",
            100.0 * sources
        )],
        _ if sources > 0.0 && medium.mirrors.unseen() > 0.0 => vec![format!(
            "light of point, spot and distant sources ({:.1} % of the flux) is missing where it is mirrored by small or \
             curved surfaces on its way and again just before a sensor (off {mirrors})",
            100.0 * sources
        )],
        _ => Vec::new(),
    }
}
