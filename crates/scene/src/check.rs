//! What was understood of a scene, for `malus check`.

use crate::assembly::areas;
use crate::leaks;
use crate::need::word;
use crate::{
    Camera, Layout, Material, Quantity, Scene, Sensor, SensorPoint, Source, SourceKind, Unit,
};
use glam::DVec3;
use malus_geometry::Surfaces;
use serde::Serialize;

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
    /// Every camera.
    pub cameras: Vec<CameraReport>,
    /// Representation to run with, as in scene files.
    pub representation: &'static str,
    /// Why.
    pub representation_reason: String,
    /// Share of directions from the free sensor points, or from the cameras where there are none, each over its
    /// hemisphere, that leave the geometry, straight through panes too.
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
    /// `irradiance` or `radiance`.
    pub quantity: &'static str,
    /// Unit vector of the direction that a radiance sensor looks in, where it is one for all its points.
    pub direction: Option<[f64; 3]>,
    /// `grid`, `line` or `points`.
    pub layout: &'static str,
    /// Number of its points.
    pub count: usize,
    /// Number of those that are enclosed.
    pub enclosed: usize,
    /// Box around its points, in m.
    pub bounds_m: [[f64; 3]; 2],
}

/// A camera.
#[derive(Clone, Debug, Serialize)]
pub struct CameraReport {
    /// Its name.
    pub name: String,
    /// Where it stands, in m.
    pub position_m: [f64; 3],
    /// Where it looks, a unit vector.
    pub forward: [f64; 3],
    /// Upwards in the picture, a unit vector.
    pub up: [f64; 3],
    /// Angle across the picture's width in degrees.
    pub fov_deg: f64,
    /// Picture elements across.
    pub width: u32,
    /// Picture elements from top to bottom.
    pub height: u32,
    /// Walks a picture element.
    pub samples: u64,
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
            cameras: scene.cameras.iter().map(CameraReport::of).collect(),
            representation: word(chosen),
            representation_reason: if scene.settings.representation.is_some() {
                let needed = word(needed);
                format!("asked for; the scene needs {needed:?}, because {reason}")
            } else {
                reason.clone()
            },
            escaping: leaks::escaping(
                &scene.surfaces,
                &scene.materials,
                &scene.sensors,
                &scene.cameras,
            ),
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
            quantity: match sensor.quantity {
                Quantity::Irradiance => "irradiance",
                Quantity::Radiance => "radiance",
            },
            direction: looked_in(sensor).map(Into::into),
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

impl CameraReport {
    fn of(camera: &Camera) -> Self {
        Self {
            name: camera.name.clone(),
            position_m: camera.position.into(),
            forward: camera.forward.into(),
            up: camera.up.into(),
            fov_deg: camera.fov_deg,
            width: camera.width,
            height: camera.height,
            samples: camera.samples,
        }
    }
}

/// The one direction that all points of a radiance sensor look in.
fn looked_in(sensor: &Sensor) -> Option<DVec3> {
    let first = sensor.points.first()?.normal;
    let same = |point: &SensorPoint| point.normal == first;
    (sensor.quantity == Quantity::Radiance && sensor.points.iter().all(same)).then_some(first)
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

#[cfg(test)]
mod tests;
