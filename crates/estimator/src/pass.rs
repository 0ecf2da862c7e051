//! Which models one run computes, and which walks serve which of them.

use crate::cover::Cover;
use crate::emitters::Emitters;
use crate::glints::Glints;
use crate::medium::Medium;
use crate::mirrors::Mirrors;
use crate::spread::Spread;
use crate::techniques::Techniques;
use crate::variation::{Variation, covers};
use malus_optics::Representation;
use malus_scene::{Material, Model, Scene, Settings};
use std::ops::AddAssign;

/// Which of a sensor's sums holds what. The main model's Stokes components come first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Channels {
    /// Components of the main model.
    pub components: usize,
    /// S0 of the scalar model, where asked for; 0 where the main model's S0 is it.
    pub scalar: Option<usize>,
    /// S0 of the diffuse model, likewise.
    pub diffuse: Option<usize>,
    /// The scalar model evaluated along the main model's walks.
    pub along: Option<usize>,
    /// A model that needs walks of its own.
    pub apart: Option<usize>,
    /// First of the two parts of S0 that walks from sensors found in mirrors and met by chance.
    pub found: usize,
    /// Sums a sensor, for each of the two kinds of walk.
    pub count: usize,
}

impl Channels {
    /// Layout for a run with so many components, of a scene with or without mirrors.
    #[must_use]
    pub(crate) fn new(mirrors: bool, settings: &Settings, representation: Representation) -> Self {
        let components = match settings.model {
            Model::Polarised => representation.components(),
            Model::Scalar | Model::Diffuse => 1,
        };
        let mut channels = Self {
            components,
            found: components,
            count: components + 2,
            ..Self::of_intensity()
        };
        if settings.compare_scalar {
            channels.scalar = Some(match settings.model {
                Model::Polarised if components > 1 => channels.open(false),
                Model::Diffuse if mirrors => channels.open(true),
                _ => 0,
            });
        }
        if settings.compare_diffuse {
            channels.diffuse = Some(match settings.model {
                Model::Polarised | Model::Scalar if mirrors => channels.open(true),
                _ => 0,
            });
        }
        channels
    }

    /// The sums of S0 alone.
    pub(crate) fn of_intensity() -> Self {
        Self {
            components: 1,
            scalar: None,
            diffuse: None,
            along: None,
            apart: None,
            found: 1,
            count: 3,
        }
    }

    fn open(&mut self, apart: bool) -> usize {
        let channel = self.count;
        self.count += 1;
        if apart {
            self.apart = Some(channel);
        } else {
            self.along = Some(channel);
        }
        channel
    }
}

/// True if some part of the reflection is mirror-like.
#[must_use]
pub(crate) fn is_mirrorlike(material: &Material) -> bool {
    material.optics.representation() > Representation::Intensity
}

/// True if anything reflects like a mirror.
#[must_use]
pub(crate) fn has_mirrors(materials: &[Material]) -> bool {
    materials.iter().any(is_mirrorlike)
}

/// The materials of a model: without their mirror-like part for the diffuse one.
#[must_use]
pub(crate) fn materials_of(model: Model, materials: &[Material]) -> Vec<Material> {
    let mut materials = materials.to_vec();
    if model == Model::Diffuse {
        for material in &mut materials {
            material.optics = material.optics.without_fresnel();
        }
    }
    materials
}

/// The kinds of walk that a run takes.
#[derive(Clone, Copy)]
pub(crate) struct Passes<'a> {
    /// Walks for the main model.
    pub main: Medium<'a>,
    /// Walks for the model that needs its own, by the same random numbers.
    pub apart: Option<Medium<'a>>,
    /// How they find light.
    pub techniques: Techniques,
}

/// What one model has of scenes that the same walks serve.
pub(crate) struct Modelled {
    /// Materials by which walks are taken.
    materials: Vec<Material>,
    covers: Vec<Cover>,
    variations: Vec<Variation>,
    spread: Spread,
    mirrors: Mirrors,
    glints: Glints,
}

impl Modelled {
    /// The scenes as a model has them; emitters are chosen as `covering` has them.
    pub(crate) fn new(scenes: &[&Scene], covering: &Scene, model: Model) -> Self {
        let covers = covers(scenes, model);
        let variation = |scene: &&Scene| Variation::new(scene, covering, model);
        let variations: Vec<Variation> = scenes.iter().map(variation).collect();
        let mirrors = Mirrors::new(&covering.surfaces, &covers, &covering.sources);
        Self {
            glints: Glints::new(&covering.surfaces, &covers, &mirrors),
            mirrors,
            materials: materials_of(model, &covering.materials),
            spread: Spread::new(&variations),
            variations,
            covers,
        }
    }

    /// One scene as a model has it.
    pub(crate) fn alone(scene: &Scene, model: Model) -> Self {
        Self::new(&[scene], scene, model)
    }

    /// What walks through it move through.
    pub(crate) fn medium<'a>(&'a self, scene: &'a Scene, emitters: &'a Emitters<'a>) -> Medium<'a> {
        Medium {
            surfaces: &scene.surfaces,
            materials: &self.materials,
            covers: &self.covers,
            variations: &self.variations,
            spread: &self.spread,
            emitters,
            mirrors: &self.mirrors,
            glints: &self.glints,
            panes: self.materials.iter().any(|m| m.optics.is_pane()),
            radiosity: None,
        }
    }
}

impl<'a> Passes<'a> {
    /// What the walks of each kind move through.
    pub(crate) fn media(&self) -> impl Iterator<Item = &Medium<'a>> {
        std::iter::once(&self.main).chain(&self.apart)
    }
}

/// What walks have cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Effort {
    /// Rays asked of the geometry, those of joins left out.
    pub rays: u64,
    /// Vertices joined to sensors.
    pub joins: u64,
    /// Vertices of walks from emitters that walks from sensors were joined to.
    pub bridges: u64,
    /// Walks cut off at their greatest length.
    pub truncated: u64,
}

impl AddAssign for Effort {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.joins += other.joins;
        self.bridges += other.bridges;
        self.truncated += other.truncated;
    }
}
