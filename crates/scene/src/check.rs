//! What was understood of a scene, for `malus check`.

use crate::assembly::areas;
use crate::need::word;
use crate::{Layout, Material, Scene, Sensor, Source, SourceKind, Unit};
use glam::DVec3;
use malus_geometry::Surfaces;
use serde::Serialize;
use std::f64::consts::TAU;

/// What was understood of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Name of the scene.
    pub name: String,
    /// Unit of flux.
    pub unit: Unit,
    /// Number of triangles in use.
    pub triangles: usize,
    /// Area of all of them, in m².
    pub area_m2: f64,
    /// Box around all surfaces, in m; none without geometry.
    pub bounds_m: Option<[[f64; 3]; 2]>,
    /// Every material in use.
    pub materials: Vec<MaterialReport>,
    /// Every emitter.
    pub emitters: Vec<EmitterReport>,
    /// Every sensor.
    pub sensors: Vec<SensorReport>,
    /// Representation to run with, as in scene files.
    pub representation: &'static str,
    /// Why.
    pub representation_reason: String,
    /// Share of directions from the free sensor points, each over its hemisphere, that leave the geometry.
    pub escaping: f64,
    /// Surfaces that lie in one another, each pair with its area.
    pub coincidences: Vec<String>,
    /// Defects and warnings, one sentence each.
    pub warnings: Vec<String>,
}

/// A material in use.
#[derive(Clone, Debug, Serialize)]
pub struct MaterialReport {
    /// Its name.
    pub name: String,
    /// The object it is for, where that matters.
    pub object: Option<String>,
    /// Number of its triangles.
    pub triangles: usize,
    /// Their area in m², hidden parts included.
    pub area_m2: f64,
    /// The part of it that nothing hides, in m².
    pub exposed_m2: f64,
    /// Its values.
    pub values: Vec<ValueReport>,
}

/// A value with its origin.
#[derive(Clone, Debug, Serialize)]
pub struct ValueReport {
    /// Key in scene files.
    pub key: &'static str,
    /// The value.
    pub value: String,
    /// Where it comes from.
    pub origin: String,
}

/// An emitter.
#[derive(Clone, Debug, Serialize)]
pub struct EmitterReport {
    /// Name of the material or source.
    pub name: String,
    /// `surface`, `point`, `spot` or `distant`.
    pub kind: &'static str,
    /// Flux in the scene's unit; none for a distant source.
    pub flux: Option<f64>,
    /// Surfaces: exitance M in unit/m². Points: greatest intensity in unit/sr. Distant sources: irradiance in unit/m².
    pub strength: f64,
    /// State of the emitted light, S0 = 1.
    pub state: [f64; 4],
}

/// A sensor.
#[derive(Clone, Debug, Serialize)]
pub struct SensorReport {
    /// Its name.
    pub name: String,
    /// `grid`, `line` or `points`.
    pub layout: &'static str,
    /// Number of its points.
    pub count: usize,
    /// Number of those that are enclosed.
    pub enclosed: usize,
    /// Box around its points, in m.
    pub bounds_m: [[f64; 3]; 2],
}

impl Report {
    /// What was understood of `scene`.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let materials = materials(scene);
        let needed = scene.need.representation;
        let chosen = scene.representation();
        let reason = &scene.need.reason;
        Self {
            name: scene.name.clone(),
            unit: scene.unit,
            triangles: scene.surfaces.len(),
            area_m2: areas(&scene.surfaces, materials.len()).iter().sum(),
            bounds_m: bounds(&scene.surfaces).map(|(min, max)| [min.into(), max.into()]),
            emitters: emitters(scene, &materials),
            materials,
            sensors: scene.sensors.iter().map(SensorReport::of).collect(),
            representation: word(chosen),
            representation_reason: if scene.settings.representation.is_some() {
                let needed = word(needed);
                format!("asked for; the scene needs {needed:?}, because {reason}")
            } else {
                reason.clone()
            },
            escaping: escaping(&scene.surfaces, &scene.sensors),
            coincidences: scene.coincidences.clone(),
            warnings: scene.warnings.clone(),
        }
    }
}

fn materials(scene: &Scene) -> Vec<MaterialReport> {
    let mut reports: Vec<MaterialReport> = scene.materials.iter().map(MaterialReport::of).collect();
    for (triangle, &surface) in (0..).zip(&scene.surfaces.mesh().surfaces) {
        let report = &mut reports[surface as usize];
        report.triangles += 1;
        report.area_m2 += scene.surfaces.triangle(triangle).area();
        report.exposed_m2 += scene.surfaces.exposed_area(triangle);
    }
    reports
}

fn emitters(scene: &Scene, materials: &[MaterialReport]) -> Vec<EmitterReport> {
    let surfaces = scene.materials.iter().zip(materials);
    let surfaces = surfaces.filter_map(|(material, report)| {
        let emission = material.emission.as_ref()?;
        Some(EmitterReport {
            name: material.name.clone(),
            kind: "surface",
            flux: Some(emission.exitance * report.exposed_m2),
            strength: emission.exitance,
            state: emission.state,
        })
    });
    let sources = scene.sources.iter().map(EmitterReport::of);
    surfaces.chain(sources).collect()
}

impl MaterialReport {
    fn of(material: &Material) -> Self {
        let values = material.values.iter().map(|value| ValueReport {
            key: value.key,
            value: value.value.clone(),
            origin: value.origin.to_string(),
        });
        Self {
            name: material.name.clone(),
            object: material.object.clone(),
            triangles: 0,
            area_m2: 0.0,
            exposed_m2: 0.0,
            values: values.collect(),
        }
    }
}

impl EmitterReport {
    fn of(source: &Source) -> Self {
        use crate::Distribution::Spot;
        let (kind, strength) = match &source.kind {
            SourceKind::Point {
                intensity,
                distribution,
                ..
            } => match distribution {
                Spot { .. } => ("spot", *intensity),
                _ => ("point", *intensity),
            },
            SourceKind::Distant { irradiance, .. } => ("distant", *irradiance),
        };
        Self {
            name: source.name.clone(),
            kind,
            flux: source.flux(),
            strength,
            state: source.state,
        }
    }
}

impl SensorReport {
    fn of(sensor: &Sensor) -> Self {
        let positions = || sensor.points.iter().map(|point| point.position);
        let (min, max) = span(positions());
        Self {
            name: sensor.name.clone(),
            layout: match sensor.layout {
                Layout::Grid { .. } => "grid",
                Layout::Line => "line",
                Layout::Points => "points",
            },
            count: sensor.points.len(),
            enclosed: sensor.points.iter().filter(|point| point.enclosed).count(),
            bounds_m: [min.into(), max.into()],
        }
    }
}

/// Box around all surfaces in use, in m; none without geometry.
pub(crate) fn bounds(surfaces: &Surfaces) -> Option<(DVec3, DVec3)> {
    let mesh = surfaces.mesh();
    let corners = mesh.triangles.iter().flatten();
    (!mesh.is_empty()).then(|| span(corners.map(|corner| mesh.positions[*corner as usize])))
}

fn span(positions: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    positions.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(min, max), position| (min.min(position), max.max(position)),
    )
}

/// Share of directions from the free points that leave the geometry: 64 a point, from at most 256 points evenly picked.
///
/// The directions are a spiral of equal steps in height over the upper hemisphere, turned by the golden ratio.
pub(crate) fn escaping(surfaces: &Surfaces, sensors: &[Sensor]) -> f64 {
    const POINTS: usize = 256;
    const DIRECTIONS: u32 = 64;
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let free = sensors.iter().flat_map(|sensor| &sensor.points);
    let free: Vec<_> = free.filter(|point| !point.enclosed).collect();
    let step = free.len().div_ceil(POINTS).max(1);
    let (mut escaped, mut all) = (0_u32, 0_u32);
    for point in free.iter().step_by(step) {
        let from = point.position + surfaces.offset() * point.normal;
        let (x, y) = point.normal.any_orthonormal_pair();
        for index in 0..DIRECTIONS {
            let height = (f64::from(index) + 0.5) / f64::from(DIRECTIONS);
            let (sin, cos) = libm::sincos(TAU * GOLDEN * f64::from(index));
            let reach = (1.0 - height * height).sqrt();
            let direction = reach * (cos * x + sin * y) + height * point.normal;
            escaped += u32::from(surfaces.escapes(from, direction));
            all += 1;
        }
    }
    if all == 0 {
        0.0
    } else {
        f64::from(escaped) / f64::from(all)
    }
}

#[cfg(test)]
mod tests;
