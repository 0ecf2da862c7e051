//! Variants of a scene that the same walks serve: they differ in what surfaces do to light and how much of it is emitted.

use crate::cover::Cover;
use crate::medium::Step;
use crate::pass::materials_of;
use malus_scene::{Material, Model, Scene, Source, SourceKind};
use std::sync::Arc;

/// Who emits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Origin {
    /// The surface of that index.
    Surface(u32),
    /// The source without geometry of that number.
    Source(usize),
}

/// One variant, as light meets it along walks that are taken for several.
#[derive(Debug)]
pub(crate) struct Variation {
    /// What surfaces do to light, by surface index.
    pub materials: Vec<Material>,
    /// Whether a surface has another reflector than the one whose matrices the walks hold.
    other: Vec<bool>,
    /// Emitted light as a share of that by which emitters are chosen, by surface index.
    of_surfaces: Vec<f64>,
    /// The same of sources without geometry.
    of_sources: Vec<f64>,
}

impl Variation {
    /// A variant as a model has it, among those that `covering` covers.
    pub(crate) fn new(scene: &Scene, covering: &Scene, model: Model) -> Self {
        let materials = materials_of(model, &scene.materials);
        let recorded = materials_of(model, &covering.materials);
        let share = |own: f64, all: f64| if all > 0.0 { own / all } else { 0.0 };
        Self {
            other: materials
                .iter()
                .zip(&recorded)
                .map(|(own, all)| own.optics != all.optics)
                .collect(),
            of_surfaces: materials
                .iter()
                .zip(&recorded)
                .map(|(own, all)| share(exitance(own), exitance(all)))
                .collect(),
            of_sources: scene
                .sources
                .iter()
                .zip(&covering.sources)
                .map(|(own, all)| share(strength(own), strength(all)))
                .collect(),
            materials,
        }
    }

    /// Light that an emitter sends, as a share of that by which it is chosen.
    #[inline]
    pub(crate) fn emitted(&self, origin: Origin) -> f64 {
        match origin {
            Origin::Surface(surface) => self.of_surfaces[surface as usize],
            Origin::Source(source) => self.of_sources[source],
        }
    }

    /// Number of sources without geometry.
    pub(crate) fn sources(&self) -> usize {
        self.of_sources.len()
    }

    /// A mirror or a pane as this variant has it.
    #[inline]
    pub(crate) fn step(&self, step: &Step) -> Step {
        if !self.other[step.surface as usize] {
            return *step;
        }
        let optics = &self.materials[step.surface as usize].optics;
        step.met(step.arriving, optics)
    }
}

/// The reflectors that each surface has in any of the scenes, as a model has them.
pub(crate) fn covers(scenes: &[&Scene], model: Model) -> Vec<Cover> {
    let variants: Vec<Vec<Material>> = scenes
        .iter()
        .map(|it| materials_of(model, &it.materials))
        .collect();
    let surfaces = 0..variants.first().map_or(0, Vec::len);
    let cover = |surface: usize| Cover::new(variants.iter().map(|it| it[surface].optics));
    surfaces.map(cover).collect()
}

/// The scene by which emitters are chosen: the first one, with each emitter as strong as in any.
pub(crate) fn covering(scenes: &[&Scene]) -> Scene {
    let mut covering = scenes[0].clone();
    for scene in &scenes[1..] {
        for (all, own) in covering.materials.iter_mut().zip(&scene.materials) {
            if exitance(own) > exitance(all) {
                all.emission.clone_from(&own.emission);
            }
        }
        for (all, own) in covering.sources.iter_mut().zip(&scene.sources) {
            if strength(own) > strength(all) {
                all.clone_from(own);
            }
        }
        if scene.need.representation > covering.need.representation {
            covering.need = scene.need.clone();
        }
    }
    covering
}

/// Scenes that the same walks serve: they have one geometry, the same sensors, emitters and sheets of glass in the same
/// places, and reflectors for which walks that suit them all are not much worse than the walks of each alone.
pub struct Cohort {
    /// The first scene, with an emission wherever any of them has one.
    first: Scene,
    covers: Vec<Cover>,
}

impl Cohort {
    /// A scene with none beside it.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self {
            first: scene.clone(),
            covers: covers(&[scene], scene.settings.model),
        }
    }

    /// Takes another scene in, if the same walks serve it too.
    pub fn admit(&mut self, other: &Scene) -> bool {
        let first = &self.first;
        let alike = Arc::ptr_eq(&first.surfaces, &other.surfaces)
            && first.sensors == other.sensors
            && first.settings == other.settings
            && first.materials.len() == other.materials.len()
            && first.sources.len() == other.sources.len();
        let mut materials = first.materials.iter().zip(&other.materials);
        let mut sources = first.sources.iter().zip(&other.sources);
        if !alike
            || !materials.all(|(a, b)| of_one_kind(a, b))
            || !sources.all(|(a, b)| even(a) == even(b))
        {
            return false;
        }
        let reflectors = materials_of(other.settings.model, &other.materials);
        let mut wider = Vec::new();
        for (index, (cover, material)) in self.covers.iter().zip(&reflectors).enumerate() {
            if !cover.holds(&material.optics) {
                let cover = cover.with(material.optics);
                if !cover.serves_all() {
                    return false;
                }
                wider.push((index, cover));
            }
        }
        for (index, cover) in wider {
            self.covers[index] = cover;
        }
        for (all, own) in self.first.materials.iter_mut().zip(&other.materials) {
            if all.emission.is_none() {
                all.emission.clone_from(&own.emission);
            }
        }
        true
    }
}

/// Whether two materials differ in numbers alone.
fn of_one_kind(one: &Material, other: &Material) -> bool {
    let states = match (&one.emission, &other.emission) {
        (Some(one), Some(other)) => {
            one.state.map(f64::to_bits) == other.state.map(f64::to_bits) && one.axis == other.axis
        }
        _ => true,
    };
    states
        && one.two_sided == other.two_sided
        && std::mem::discriminant(&one.optics) == std::mem::discriminant(&other.optics)
}

/// A source with a strength of 1.
fn even(source: &Source) -> Source {
    let mut even = source.clone();
    match &mut even.kind {
        SourceKind::Point { intensity, .. } => *intensity = 1.0,
        SourceKind::Distant { irradiance, .. } => *irradiance = 1.0,
    }
    even
}

fn exitance(material: &Material) -> f64 {
    material.emission.as_ref().map_or(0.0, |it| it.exitance)
}

fn strength(source: &Source) -> f64 {
    match source.kind {
        SourceKind::Point { intensity, .. } => intensity,
        SourceKind::Distant { irradiance, .. } => irradiance,
    }
}
