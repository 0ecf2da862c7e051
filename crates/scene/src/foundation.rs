//! What scenes share whose geometry is one: it is loaded and its trees are built once.

use crate::assembly::Assembly;
use crate::enclosed::Darkness;
use crate::error::Error;
use crate::file::SceneFile;
use crate::import::Import;
use crate::need::Need;
use crate::scene::{lit, sources, without_loss};
use crate::{Camera, Material, Scene, Source, flush, panes};
use std::path::Path;
use std::sync::Arc;

/// Values of a material that leave the geometry, and what belongs to which surface, as they are.
const OF_SURFACES: [&str; 8] = ["rho", "a", "n", "k", "tau", "kind", "exitance", "two_sided"];

/// What a loaded scene was made of.
pub(crate) struct Foundation {
    /// The mesh files, without the points of what is geometry.
    pub(crate) imports: Vec<Import>,
    /// What belongs to which surface.
    pub(crate) assembly: Assembly,
}

/// Whether a scene in which only this key is another has the same geometry, sensors and surfaces.
pub(crate) fn keeps_geometry(key: &[&str]) -> bool {
    match key {
        ["material", _, value] => OF_SURFACES.contains(value),
        ["source", ..] | ["run", ..] => true,
        _ => false,
    }
}

/// Whether light takes the same ways in a scene in which only this key is another, but for how strong it is.
pub(crate) fn keeps_ways(key: &[&str]) -> bool {
    let moved = matches!(
        key,
        [
            "source",
            _,
            "position" | "direction" | "distribution" | "cone_deg" | "blend"
        ]
    );
    keeps_geometry(key) && !moved
}

impl Foundation {
    /// The scene of a file that differs from that of `base` only by keys that keep the geometry.
    ///
    /// # Errors
    /// As loading it from the start.
    pub(crate) fn scene(&self, base: &Scene, file: SceneFile, path: &Path) -> Result<Scene, Error> {
        let Self { imports, assembly } = self;
        let surfaces = &base.surfaces;
        let names = assembly.material_names(imports);
        let meshes = !imports.is_empty();
        file.library.check_used(&names, meshes, &mut Vec::new())?;
        let (materials, _) = assembly.materials(imports, &file.library, surfaces)?;
        panes::check(surfaces, &materials, &assembly.objects, &file.library)?;
        let mut sources = sources(file.sources, imports);
        lit(path, surfaces, &materials, &sources)?;
        flush::clear(&mut sources, surfaces, &base.sensors, &base.cameras);
        let mut sensors = base.sensors.clone();
        if !same_places(base, &materials, &sources) {
            for point in sensors.iter_mut().flat_map(|sensor| &mut sensor.points) {
                point.enclosed = false;
            }
            Darkness::of(surfaces, &materials, &sources).mark(&mut sensors);
        }
        let cameras: Vec<Camera> = base.cameras.clone();
        without_loss(path, surfaces, &materials, &sensors, &cameras)?;
        Ok(Scene {
            name: file.name,
            unit: file.unit,
            surfaces: Arc::clone(surfaces),
            need: Need::of(file.settings.model, &materials, &sources),
            materials,
            sources,
            sensors,
            cameras,
            settings: file.settings,
            objects: base.objects.clone(),
            coincidences: Vec::new(),
            warnings: Vec::new(),
        })
    }
}

/// Whether light is emitted where it is in the base: then what lies in the dark does so still.
fn same_places(base: &Scene, materials: &[Material], sources: &[Source]) -> bool {
    let emits = |materials: &[Material]| -> Vec<bool> {
        materials
            .iter()
            .map(|material| material.emission.is_some())
            .collect()
    };
    emits(&base.materials) == emits(materials) && base.sources == sources
}
