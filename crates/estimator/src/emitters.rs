//! Where light comes from: one table of everything that emits, sampled by flux.

use crate::direction::{cosine_weighted, in_cone, on_disc};
use crate::random::{Purpose, Uniforms};
use crate::reading::Unmet;
use glam::DVec3;
use malus_geometry::Surfaces;
use malus_scene::{Distribution, Material, Scene, Source, SourceKind};
use std::f64::consts::PI;

/// All emitters of a scene: emitting triangles first, then sources without geometry, by cumulated flux.
pub(crate) struct Emitters<'a> {
    surfaces: &'a Surfaces,
    materials: &'a [Material],
    sources: &'a [Source],
    triangles: Vec<u32>,
    /// Flux of the first i + 1 entries, triangles and then sources.
    cumulated: Vec<f64>,
}

/// Which part of the table a vertex looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Choice {
    /// Emitting triangles alone; the sources are then summed one by one.
    Areas,
    /// Everything.
    All,
}

/// State of emitted light: (1, q, u, v) about an axis; `None` where unpolarised.
pub(crate) type State<'a> = Option<(&'a [f64; 4], DVec3)>;

/// What an emitter sends to one point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Incoming<'a> {
    /// Where the light comes from; `None` from infinity.
    pub from: Option<DVec3>,
    /// Unit vector from the point towards the emitter.
    pub toward: DVec3,
    /// Irradiance on a surface across the beam, divided by the probability of this choice, in unit/m².
    pub irradiance: f64,
    /// Density of this choice per solid angle at the point; `None` where no direction sampled at random could meet it.
    pub density: Option<f64>,
    /// State of the light.
    pub state: State<'a>,
}

/// Where a walk from an emitter starts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start<'a> {
    /// On or at the emitter, moved off its surface.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Flux that the walk carries, in unit; the mean over walks is the flux of the scene.
    pub flux: f64,
    /// Normal of the emitting surface; `None` for a source without geometry.
    pub normal: Option<DVec3>,
    /// State of the light.
    pub state: State<'a>,
}

fn state_of<'a>(state: &'a [f64; 4], axis: DVec3) -> State<'a> {
    let polarised = state[1..].iter().any(|&component| component.abs() > 0.0);
    polarised.then_some((state, axis))
}

/// State of the light that a surface emits.
pub(crate) fn emitted_state(material: &Material) -> State<'_> {
    let emission = material.emission.as_ref()?;
    state_of(&emission.state, emission.axis)
}

impl<'a> Emitters<'a> {
    /// The table of a scene. A triangle that later surfaces hide whole is left out.
    #[must_use]
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let surfaces = &scene.surfaces;
        let mut triangles = Vec::new();
        let mut cumulated = Vec::new();
        let mut total = 0.0;
        for triangle in 0..surfaces.len() as u32 {
            let emission = &scene.materials[surfaces.surface(triangle) as usize].emission;
            if let Some(emission) = emission
                && surfaces.exposed_area(triangle) > 0.0
            {
                total += emission.exitance * surfaces.triangle(triangle).area();
                triangles.push(triangle);
                cumulated.push(total);
            }
        }
        for source in &scene.sources {
            total += source_flux(source, surfaces);
            cumulated.push(total);
        }
        Self {
            surfaces,
            materials: &scene.materials,
            sources: &scene.sources,
            triangles,
            cumulated,
        }
    }

    /// Flux of the part of the table, in unit, hidden parts of emitting triangles included.
    pub(crate) fn flux(&self, choice: Choice) -> f64 {
        let entries = match choice {
            Choice::Areas => self.triangles.len(),
            Choice::All => self.cumulated.len(),
        };
        entries.checked_sub(1).map_or(0.0, |i| self.cumulated[i])
    }

    /// Flux that leaves the emitters, in unit: of what nothing hides; of parallel light, what passes through the great
    /// circle of the scene.
    #[must_use]
    pub(crate) fn exposed_flux(&self) -> f64 {
        let exposed =
            |&triangle: &u32| self.emission(triangle).0 * self.surfaces.exposed_area(triangle);
        let sources = self
            .sources
            .iter()
            .map(|source| source_flux(source, self.surfaces));
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

    fn entry(&self, choice: Choice, u: f64) -> usize {
        let count = match choice {
            Choice::Areas => self.triangles.len(),
            Choice::All => self.cumulated.len(),
        };
        let target = u * self.flux(choice);
        self.cumulated[..count]
            .partition_point(|&c| c <= target)
            .min(count - 1)
    }

    fn emission(&self, triangle: u32) -> (f64, &'a Material) {
        let material = &self.materials[self.surfaces.surface(triangle) as usize];
        let exitance = material.emission.as_ref().map_or(0.0, |e| e.exitance);
        (exitance, material)
    }

    /// Density per solid angle with which [`Emitters::look`] finds the point of a surface met at `distance` and
    /// under `cos_emission`, for a surface of the given exitance.
    ///
    /// A triangle is chosen by its flux and a point of it evenly, so the density per area is exitance/flux
    /// whichever triangle it is.
    pub(crate) fn density(
        &self,
        choice: Choice,
        exitance: f64,
        distance: f64,
        cos_emission: f64,
    ) -> f64 {
        exitance / self.flux(choice) * distance * distance / cos_emission
    }

    /// Light that one emitter, chosen by flux, would send to `point` were nothing between them.
    ///
    /// `None` where the point lies behind it, outside its cone, or looks at a hidden part.
    pub(crate) fn look(
        &self,
        choice: Choice,
        point: DVec3,
        [which, u, v, _]: [f64; 4],
    ) -> Option<Incoming<'a>> {
        let total = self.flux(choice);
        if total <= 0.0 {
            return None;
        }
        let entry = self.entry(choice, which);
        let Some(&triangle) = self.triangles.get(entry) else {
            let index = entry - self.triangles.len();
            let mut incoming = self.light_of_source(index, point)?;
            incoming.irradiance *= total / source_flux(&self.sources[index], self.surfaces);
            return Some(incoming);
        };
        let position = self.surfaces.triangle(triangle).point_at([u, v]);
        let normal = self.surfaces.normal(triangle);
        let from = position + normal * self.surfaces.offset();
        let to_light = from - point;
        let square = to_light.length_squared();
        let toward = to_light / square.sqrt();
        let cos_emission = -toward.dot(normal);
        if cos_emission <= 0.0 || !self.surfaces.exposed(triangle, position) {
            return None;
        }
        let (exitance, material) = self.emission(triangle);
        Some(Incoming {
            from: Some(from),
            toward,
            // Radiance M/π over a density per area of M/flux.
            irradiance: total * cos_emission / (PI * square),
            density: Some(exitance / total * square / cos_emission),
            state: emitted_state(material),
        })
    }

    /// Light that the source without geometry of that number sends to `point` were nothing between them.
    pub(crate) fn light_of_source(&self, index: usize, point: DVec3) -> Option<Incoming<'a>> {
        let source = &self.sources[index];
        let (from, toward, irradiance) = match &source.kind {
            SourceKind::Point {
                position,
                intensity,
                distribution,
            } => {
                let to_light = *position - point;
                let square = to_light.length_squared();
                let toward = to_light / square.sqrt();
                let share = distribution.share(-toward);
                (Some(*position), toward, intensity * share / square)
            }
            SourceKind::Distant {
                direction,
                irradiance,
            } => (None, -*direction, *irradiance),
        };
        // A point at the source itself has no direction to it.
        (irradiance > 0.0 && irradiance.is_finite()).then_some(Incoming {
            from,
            toward,
            irradiance,
            density: None,
            state: state_of(&source.state, source.axis),
        })
    }

    /// Number of sources without geometry.
    pub(crate) fn source_count(&self) -> usize {
        self.sources.len()
    }

    /// Where the sources without geometry stand, those at infinity left out.
    pub(crate) fn source_positions(&self) -> impl Iterator<Item = DVec3> {
        self.sources.iter().filter_map(|source| match source.kind {
            SourceKind::Point { position, .. } => Some(position),
            SourceKind::Distant { .. } => None,
        })
    }

    /// Start of a walk that carries the flux of the scene divided by its own probability.
    ///
    /// `None` where it would start on a hidden part of a surface.
    pub(crate) fn start(&self, uniforms: Uniforms) -> Option<Start<'a>> {
        let [which, u, v, _] = uniforms.at(0, Purpose::Emit);
        let [s, t, ..] = uniforms.at(0, Purpose::Launch);
        let flux = self.flux(Choice::All);
        let entry = self.entry(Choice::All, which);
        let Some(&triangle) = self.triangles.get(entry) else {
            let source = &self.sources[entry - self.triangles.len()];
            let (origin, direction, share) = self.launch(&source.kind, [u, v], [s, t]);
            return Some(Start {
                origin,
                direction,
                flux: flux * share,
                normal: None,
                state: state_of(&source.state, source.axis),
            });
        };
        let position = self.surfaces.triangle(triangle).point_at([u, v]);
        let normal = self.surfaces.normal(triangle);
        self.surfaces.exposed(triangle, position).then(|| Start {
            origin: position + normal * self.surfaces.offset(),
            direction: cosine_weighted(normal, [s, t]),
            flux,
            normal: Some(normal),
            state: emitted_state(self.emission(triangle).1),
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
