//! Where light comes from: one table of everything that emits, sampled by flux.

use crate::cumulated::Cumulated;
use crate::direction::{cosine_weighted, in_cone, on_disc};
use crate::lamps::{Chosen, Lamps, Reach};
use crate::mirrors::Viewer;
use crate::random::{Purpose, Uniforms};
use crate::reading::Unmet;
use crate::site::{Shape, Site, Start, emitted_state, state_of};
use crate::variation::{Origin, Variation};
use glam::DVec3;
use malus_geometry::{Facet, Facets, Patches, Surfaces};
use malus_scene::{Distribution, Material, Scene, Source, SourceKind};
use std::f64::consts::PI;

/// All emitters of a scene: emitting triangles first, then sources without geometry, by cumulated flux.
pub(crate) struct Emitters<'a> {
    surfaces: &'a Surfaces,
    materials: &'a [Material],
    sources: &'a [Source],
    triangles: Vec<u32>,
    /// Flux of the entries, triangles and then sources.
    table: Cumulated,
    /// Flat patches of triangles that emit unpolarised light and are hidden nowhere.
    patches: Facets,
    /// What of all this lies together: the patches, as many sources as are left room for, and the rest.
    lamps: Lamps,
    /// Which of them each emitter belongs to.
    numbers: Numbers,
}

/// Patches that a sensor may see whole; the light of others is sampled.
const MOST_PATCHES: usize = 64;

/// Sources without geometry that are told from each other where a point of a walk looks for one.
const MOST_SOURCES: usize = 64;

/// Which part of the table a vertex looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Choice {
    /// Emitting triangles alone; the sources are then summed one by one.
    Areas,
    /// Everything.
    All,
}

impl<'a> Emitters<'a> {
    /// The table of a scene. A triangle that later surfaces hide whole is left out.
    #[must_use]
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let surfaces = &scene.surfaces;
        let mut triangles = Vec::new();
        let mut fluxes = Vec::new();
        // Those that a patch may be made of.
        let mut even = vec![false; surfaces.len()];
        for triangle in 0..surfaces.len() as u32 {
            let material = &scene.materials[surfaces.surface(triangle) as usize];
            let Some(emission) = &material.emission else {
                continue;
            };
            let exposed = surfaces.exposed_area(triangle);
            if exposed > 0.0 {
                let area = surfaces.triangle(triangle).area();
                triangles.push(triangle);
                fluxes.push(emission.exitance * area);
                even[triangle as usize] = exposed >= area && emitted_state(material).is_none();
            }
        }
        fluxes.extend(scene.sources.iter().map(|it| source_flux(it, surfaces)));
        let patches = Patches::new(surfaces, |t| even[t as usize]);
        let patches = Facets::new(surfaces, &patches, |_| true, 0.0, MOST_PATCHES);
        let numbers = Numbers::new(scene, &triangles, &patches);
        let of_triangles = triangles.iter().map(|&it| numbers.of_patch(patches.of(it)));
        let of_sources = (0..scene.sources.len()).map(|it| numbers.of_source(it));
        let of_entries = of_triangles.chain(of_sources);
        let lamps = Lamps::new(
            numbers.reaches(scene, &patches),
            fluxes.iter().copied().zip(of_entries),
        );
        Self {
            surfaces,
            materials: &scene.materials,
            sources: &scene.sources,
            triangles,
            table: Cumulated::new(fluxes.into_iter()),
            patches,
            lamps,
            numbers,
        }
    }

    /// Flat patches of triangles that emit unpolarised light and are hidden nowhere.
    pub(crate) fn patches(&self) -> &[Facet] {
        self.patches.list()
    }

    /// The patch that a triangle belongs to.
    #[inline]
    pub(crate) fn patch(&self, triangle: u32) -> Option<u32> {
        self.patches.of(triangle)
    }

    /// The emitting triangles, in the order of the table.
    pub(crate) fn triangles(&self) -> &[u32] {
        &self.triangles
    }

    /// How many entries the part of the table has.
    fn count(&self, choice: Choice) -> usize {
        match choice {
            Choice::Areas => self.triangles.len(),
            Choice::All => self.table.len(),
        }
    }

    /// Flux of the part of the table, in unit, hidden parts of emitting triangles included.
    pub(crate) fn flux(&self, choice: Choice) -> f64 {
        self.table.total(self.count(choice))
    }

    /// Flux that leaves the emitters in a variant, in unit: of what nothing hides; of parallel light, what passes through
    /// the great circle of the scene.
    #[must_use]
    pub(crate) fn exposed_flux(&self, variation: &Variation) -> f64 {
        let exposed = |&triangle: &u32| {
            let share = variation.emitted(Origin::Surface(self.surfaces.surface(triangle)));
            share * self.emission(triangle).0 * self.surfaces.exposed_area(triangle)
        };
        let sources = self.sources.iter().enumerate().map(|(index, source)| {
            variation.emitted(Origin::Source(index)) * source_flux(source, self.surfaces)
        });
        self.triangles.iter().map(exposed).chain(sources).sum()
    }

    /// What a walk may bring that meets emitting surfaces by chance.
    #[must_use]
    pub(crate) fn unmet(&self) -> Unmet {
        let exitances = self
            .triangles
            .iter()
            .map(|&triangle| self.emission(triangle).0);
        let radius = 0.5 * self.surfaces.radius();
        Unmet {
            one: exitances.fold(0.0, f64::max),
            most: self.flux(Choice::Areas) / (PI * radius * radius),
        }
    }

    /// Share of the flux that sources without geometry emit, 0 … 1.
    #[must_use]
    pub(crate) fn source_share(&self) -> f64 {
        1.0 - self.flux(Choice::Areas) / self.flux(Choice::All)
    }

    /// The entry of the table that a uniform number chooses by flux, and where within that entry it lies.
    fn entry(&self, choice: Choice, u: f64) -> (usize, f64) {
        self.table.choose(self.count(choice), u)
    }

    fn emission(&self, triangle: u32) -> (f64, &'a Material) {
        let material = &self.materials[self.surfaces.surface(triangle) as usize];
        let exitance = material.emission.as_ref().map_or(0.0, |e| e.exitance);
        (exitance, material)
    }

    /// Share of the table's flux that a surface of the given exitance emits per area, in 1/m².
    ///
    /// A triangle is chosen by its flux and a point of it evenly, so this is the density per area of the choice
    /// whichever triangle it is.
    pub(crate) fn density(&self, choice: Choice, exitance: f64) -> f64 {
        exitance / self.flux(choice)
    }

    /// One place of emission for a viewer, with the probability of choosing it relative to a choice by flux; `None` where that
    /// is a hidden part of a surface.
    pub(crate) fn look(
        &self,
        choice: Choice,
        viewer: &Viewer,
        [which, v, ..]: [f64; 4],
    ) -> Option<(Site<'a>, f64)> {
        let total = self.flux(choice);
        if total <= 0.0 {
            return None;
        }
        let Chosen {
            entry,
            within,
            preference,
        } = if self.lamps.guide(viewer) {
            self.lamps.choose(viewer, which)
        } else {
            let (entry, within) = self.entry(choice, which);
            Chosen {
                entry,
                within,
                preference: 1.0,
            }
        };
        let Some(&triangle) = self.triangles.get(entry) else {
            let index = entry - self.triangles.len();
            let flux = source_flux(&self.sources[index], self.surfaces);
            return Some((self.site_of_source(index, total / flux), preference));
        };
        let position = self.surfaces.triangle(triangle).point_at([within, v]);
        self.surfaces
            .exposed(triangle, position)
            .then(|| (self.site_on(triangle, position, total), preference))
    }

    /// Probability with which a viewer chooses a site, relative to a choice by flux.
    pub(crate) fn preference(&self, viewer: &Viewer, site: &Site) -> f64 {
        let lamp = match site.origin {
            Origin::Source(index) => self.numbers.of_source(index),
            Origin::Surface(_) => self.numbers.of_patch(site.patch),
        };
        self.lamps.preference(viewer, lamp)
    }

    /// A point of an emitting triangle as a site, out of a table of the flux `total`.
    pub(crate) fn site_on(&self, triangle: u32, position: DVec3, total: f64) -> Site<'a> {
        let normal = self.surfaces.normal(triangle);
        let (exitance, material) = self.emission(triangle);
        Site {
            origin: Origin::Surface(self.surfaces.surface(triangle)),
            from: Some(position + normal * self.surfaces.offset()),
            state: emitted_state(material),
            inverse: total,
            patch: self.patch(triangle),
            shape: Shape::Area {
                normal,
                density: exitance / total,
            },
        }
    }

    /// The source without geometry of that number, chosen with the probability 1/`inverse`.
    pub(crate) fn site_of_source(&self, index: usize, inverse: f64) -> Site<'a> {
        let source = &self.sources[index];
        let (from, shape) = match &source.kind {
            SourceKind::Point {
                position,
                intensity,
                distribution,
            } => (
                Some(*position),
                Shape::Point {
                    intensity: *intensity,
                    distribution,
                },
            ),
            SourceKind::Distant {
                direction,
                irradiance,
            } => {
                let radius = self.surfaces.radius();
                let shape = Shape::Distant {
                    direction: *direction,
                    irradiance: *irradiance,
                    area: PI * radius * radius,
                };
                (None, shape)
            }
        };
        Site {
            origin: Origin::Source(index),
            from,
            state: state_of(&source.state, source.axis),
            inverse,
            patch: None,
            shape,
        }
    }

    /// Number of sources without geometry.
    pub(crate) fn source_count(&self) -> usize {
        self.sources.len()
    }

    /// Start of a walk that carries the flux of the scene divided by its own probability.
    ///
    /// `None` where it would start on a hidden part of a surface.
    pub(crate) fn start(&self, uniforms: Uniforms) -> Option<Start<'a>> {
        let [s, t, which, v] = uniforms.at(0, Purpose::Launch);
        let flux = self.flux(Choice::All);
        let (entry, u) = self.entry(Choice::All, which);
        let Some(&triangle) = self.triangles.get(entry) else {
            let source = &self.sources[entry - self.triangles.len()];
            let (origin, direction, share) = self.launch(&source.kind, [u, v], [s, t]);
            let inverse = flux / source_flux(source, self.surfaces);
            return Some(Start {
                origin,
                direction,
                flux: flux * share,
                normal: None,
                site: self.site_of_source(entry - self.triangles.len(), inverse),
            });
        };
        let position = self.surfaces.triangle(triangle).point_at([u, v]);
        let normal = self.surfaces.normal(triangle);
        self.surfaces.exposed(triangle, position).then(|| Start {
            origin: position + normal * self.surfaces.offset(),
            direction: cosine_weighted(normal, [s, t]),
            flux,
            normal: Some(normal),
            site: self.site_on(triangle, position, flux),
        })
    }

    /// Origin and direction of light from a source, and the flux there relative to its mean over directions.
    fn launch(&self, kind: &SourceKind, across: [f64; 2], along: [f64; 2]) -> (DVec3, DVec3, f64) {
        match kind {
            SourceKind::Point {
                position,
                distribution,
                ..
            } => match *distribution {
                Distribution::Isotropic => (*position, in_cone(DVec3::Z, -1.0, along), 1.0),
                Distribution::Cosine { direction } => {
                    (*position, cosine_weighted(direction, along), 1.0)
                }
                Distribution::Spot {
                    direction,
                    cos_outer,
                    ..
                } => {
                    let launched = in_cone(direction, cos_outer, along);
                    let cone = 2.0 * PI * (1.0 - cos_outer);
                    let share = distribution.share(launched) * cone / distribution.solid_angle();
                    (*position, launched, share)
                }
            },
            SourceKind::Distant { direction, .. } => {
                let radius = self.surfaces.radius();
                let entry = self.surfaces.centre() - *direction * (2.0 * radius);
                (on_disc(entry, *direction, radius, across), *direction, 1.0)
            }
        }
    }
}

/// Flux of a source in unit; of parallel light, what passes through the great circle of the scene.
fn source_flux(source: &Source, surfaces: &Surfaces) -> f64 {
    match &source.kind {
        SourceKind::Point {
            intensity,
            distribution,
            ..
        } => intensity * distribution.solid_angle(),
        SourceKind::Distant { irradiance, .. } => {
            irradiance * PI * surfaces.radius() * surfaces.radius()
        }
    }
}

/// Which lamp is which: the patches come first, then the sources that are told from each other, and all others are the last.
#[derive(Debug)]
struct Numbers {
    /// The lamp of each patch.
    of_patch: Vec<usize>,
    /// How many sources are told from each other.
    sources: usize,
}

impl Numbers {
    fn new(scene: &Scene, triangles: &[u32], patches: &Facets) -> Self {
        let mut numbers = Self {
            of_patch: (0..patches.list().len()).collect(),
            sources: scene.sources.len().min(MOST_SOURCES),
        };
        let rest = numbers.rest();
        for &triangle in triangles {
            // A patch of which some triangles face the other way shines on both sides.
            if let Some(patch) = patches.of(triangle)
                && let facet = &patches.list()[patch as usize]
                && scene.surfaces.normal(triangle).dot(facet.normal) <= 0.0
            {
                numbers.of_patch[patch as usize] = rest;
            }
        }
        numbers
    }

    fn rest(&self) -> usize {
        self.of_patch.len() + self.sources
    }

    /// The lamp of an emitting surface, which may belong to a patch.
    fn of_patch(&self, patch: Option<u32>) -> usize {
        patch.map_or(self.rest(), |it| self.of_patch[it as usize])
    }

    /// The lamp of a source.
    fn of_source(&self, index: usize) -> usize {
        self.of_patch.len() + index.min(self.sources)
    }

    /// What tells how much each lamp sends.
    fn reaches(&self, scene: &Scene, patches: &Facets) -> Vec<Reach> {
        let told = scene.sources.iter().take(self.sources);
        let told = told.map(|it| Reach::Source(it.kind.clone()));
        let reaches = patches.list().iter().map(Reach::of).chain(told);
        reaches.chain([Reach::Unknown]).collect()
    }
}
