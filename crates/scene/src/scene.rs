//! The checked model of a scene: everything an estimator has to know.

use crate::appearance::NO_MIRROR;
use crate::assembly::{Assembly, areas};
use crate::error::Error;
use crate::file::SceneFile;
use crate::foundation::Foundation;
use crate::import::Import;
use crate::need::{Need, word};
use crate::overrides::Override;
use crate::placing::{measured, place};
use crate::{
    Camera, Material, Origin, Sensor, Settings, Source, Unit, defects, enclosed, flush, leaks,
    panes,
};
use glam::DVec3;
use malus_geometry::Surfaces;
use malus_optics::Representation;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// A scene, checked: nothing later needs to look at a file again.
#[derive(Clone)]
pub struct Scene {
    /// Name for titles and results.
    pub name: String,
    /// Unit of flux.
    pub unit: Unit,
    /// Where surfaces are; `surfaces.surface(triangle)` is an index of `materials`.
    pub surfaces: Arc<Surfaces>,
    /// Materials by surface index.
    pub materials: Vec<Material>,
    /// Sources without geometry: those of the scene file, then lamps of mesh files.
    pub sources: Vec<Source>,
    /// Sensors, in the order of the scene file, then those found in mesh files; none only where there are cameras.
    pub sensors: Vec<Sensor>,
    /// Cameras, in the order of the scene file.
    pub cameras: Vec<Camera>,
    /// How the scene is to be computed.
    pub settings: Settings,
    /// Number of Stokes components that the scene needs, and what forces it.
    pub need: Need,
    /// Names of objects, by the index that `surfaces.object(triangle)` gives.
    pub objects: Vec<String>,
    /// Surfaces that lie in one another, each pair with its area: ordinary where a thing stands on another.
    pub coincidences: Vec<String>,
    /// What a careful user would want to know, one sentence each.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Loads the scene file at `path`, with every file it names; `overrides` replace its own values, the later ones last.
    ///
    /// # Errors
    /// The first things found wrong, each with its place, what was found and what is allowed.
    pub fn load(path: &Path, overrides: &[Override]) -> Result<Self, Error> {
        let (scene, _) = Self::founded(SceneFile::read(path, overrides)?, path)?;
        Ok(scene)
    }

    /// Loads every file that the scene file names, which stands at `path`; gives the foundation too.
    pub(crate) fn founded(file: SceneFile, path: &Path) -> Result<(Self, Foundation), Error> {
        let mut warnings = Vec::new();
        let mut imports = each(&file.meshes, Import::load)?;
        for import in &imports {
            warnings.extend(import.warnings());
        }

        let measured = measured(&file.sensors, &imports)?;
        let sensed = measured.objects();
        let mut assembly = Assembly::new(&imports, &file, &sensed)?;
        for (index, import) in imports.iter_mut().enumerate() {
            import.let_go(|object| !sensed.contains(&(index, object)));
        }
        let names = assembly.material_names(&imports);
        let meshes = !imports.is_empty();
        file.library.check_used(&names, meshes, &mut warnings)?;

        let mesh = std::mem::take(&mut assembly.mesh);
        // Of the mesh as given: what Surfaces leaves out is a defect too.
        let flaws = malus_geometry::defects::of(&mesh);
        let surfaces = Surfaces::new(mesh).map_err(|error| Error::Geometry {
            path: path.display().to_string(),
            reason: Box::new(error),
        })?;
        let surfaces = Arc::new(surfaces);
        let (materials, doubts) = assembly.materials(&imports, &file.library, &surfaces)?;
        warnings.extend(doubts);
        panes::check(&surfaces, &materials, &assembly.objects, &file.library)?;
        warnings.extend(no_mirrors(&materials));
        warnings.extend(white(&materials));

        let mut sources = sources(file.sources, &imports);
        lit(path, &surfaces, &materials, &sources)?;
        warnings.extend(mixed_units(&imports, &materials));

        let (sensors, cameras) = (file.sensors, file.cameras);
        let mut sensors = place(sensors, &cameras, &imports, &measured, &mut warnings)?;
        let cameras: Vec<Camera> = cameras.into_iter().map(|camera| camera.value).collect();
        if sensors.is_empty() && cameras.is_empty() {
            let path = path.display().to_string();
            return Err(Error::NoSensor { path });
        }
        flush::clear(&mut sources, &surfaces, &sensors, &cameras);
        let darkness = enclosed::Darkness::of(&surfaces, &materials, &sources);
        darkness.mark(&mut sensors);
        warnings.extend(darkness.warnings(&cameras, &sensors, &assembly.objects));

        resolved(path, &surfaces)?;
        without_loss(path, &surfaces, &materials, &sensors, &cameras)?;
        warnings.extend(defects::warnings(
            &flaws,
            &surfaces,
            &assembly.objects,
            &observers(&sensors, &cameras),
            &panes::sheets(&surfaces, &materials),
        ));
        let labels: Vec<String> = materials.iter().map(|it| it.name.clone()).collect();
        let coincidences = defects::coincidences(&surfaces, &assembly.objects, &labels);
        warnings.extend(odd_extent(&surfaces));
        if materials
            .iter()
            .any(|it| it.optics.representation() > Representation::Intensity)
        {
            // Mirrors are chosen among these; like the tree, they serve every run over the scene.
            surfaces.patches();
        }
        let need = Need::of(file.settings.model, &materials, &sources);
        warnings.extend(too_little(&file.settings, &need));
        let scene = Self {
            name: file.name,
            unit: file.unit,
            surfaces,
            materials,
            sources,
            sensors,
            cameras,
            settings: file.settings,
            need,
            objects: assembly.objects.clone(),
            coincidences,
            warnings,
        };
        Ok((scene, Foundation { imports, assembly }))
    }

    /// Whether the surfaces close the scene, as far as can be seen from its free sensor points.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        !crate::leaks::any(
            &self.surfaces,
            &self.materials,
            &self.sensors,
            &self.cameras,
        )
    }

    /// Representation to run with: the one asked for, else the one needed.
    #[must_use]
    pub fn representation(&self) -> Representation {
        let asked = self.settings.representation;
        asked.unwrap_or(self.need.representation)
    }
}

/// Sources of the scene file, then lamps of mesh files, those left out that emit nothing.
pub(crate) fn sources(of_file: Vec<Source>, imports: &[Import]) -> Vec<Source> {
    let lamps = imports.iter().flat_map(|import| import.lamps.clone());
    of_file
        .into_iter()
        .chain(lamps)
        .filter(Source::emits)
        .collect()
}

/// Refuses a scene in which nothing emits light.
pub(crate) fn lit(
    path: &Path,
    surfaces: &Surfaces,
    materials: &[Material],
    sources: &[Source],
) -> Result<(), Error> {
    let exposed = areas(surfaces, materials.len());
    let shines = |(material, area): (&Material, &f64)| material.emission.is_some() && *area > 0.0;
    if sources.is_empty() && !materials.iter().zip(&exposed).any(shines) {
        let path = path.display().to_string();
        return Err(Error::NoEmitter { path });
    }
    Ok(())
}

/// Applies `read` to every item; all errors are told at once.
fn each<I, T>(items: &[I], read: impl Fn(&I) -> Result<T, Error>) -> Result<Vec<T>, Error> {
    let mut good = Vec::with_capacity(items.len());
    let mut errors = Vec::new();
    for item in items {
        match read(item) {
            Ok(value) => good.push(value),
            Err(error) => errors.push(error),
        }
    }
    Error::all(errors).map(|()| good)
}

/// Where light is measured or seen, in m.
fn observers(sensors: &[Sensor], cameras: &[Camera]) -> Vec<DVec3> {
    let points = sensors.iter().flat_map(|sensor| &sensor.points);
    let eyes = cameras.iter().map(|camera| camera.position);
    points.map(|point| point.position).chain(eyes).collect()
}

/// Surfaces nearer than their tolerance lie in one place: a scene this many times as large or less has no shape left.
const RESOLVED: f64 = 10.0;

/// Refuses a scene so far from the origin that its surfaces cannot be told apart.
fn resolved(path: &Path, surfaces: &Surfaces) -> Result<(), Error> {
    let Some(extent) = extent(surfaces) else {
        return Ok(());
    };
    let (size, tolerance) = (extent.max_element(), surfaces.tolerance());
    if size > RESOLVED * tolerance {
        return Ok(());
    }
    Err(Error::Conflict {
        at: path.display().to_string(),
        reason: format!(
            "the geometry is {size:.3e} m large and lies {:.3e} m from the origin, where surfaces nearer than {tolerance:.1e} m cannot be told apart; move it to the origin",
            surfaces.centre().length()
        ),
    })
}

/// Refuses a closed scene in which light is never lost: there is no steady state to compute.
///
/// A pane that absorbs nothing loses light only where what it lets through leaves.
pub(crate) fn without_loss(
    path: &Path,
    surfaces: &Surfaces,
    materials: &[Material],
    sensors: &[Sensor],
    cameras: &[Camera],
) -> Result<(), Error> {
    let lossless = |material: &Material| match material.optics {
        malus_optics::Material::Pane { tau, .. } => tau >= 1.0,
        optics => material.two_sided && optics.is_lossless(),
    };
    if surfaces.is_empty()
        || !materials.iter().all(lossless)
        || leaks::any(surfaces, materials, sensors, cameras)
    {
        return Ok(());
    }
    let names: Vec<String> = materials
        .iter()
        .map(|material| material.name.clone())
        .collect();
    Err(Error::NoLoss {
        path: path.display().to_string(),
        materials: defects::listed(&names),
    })
}

/// One sentence for all materials of OBJ files whose fields say nothing of mirror-like reflection.
fn no_mirrors(materials: &[Material]) -> Option<String> {
    let unsaid = Origin::Field(NO_MIRROR.to_owned());
    let has = |material: &&Material| {
        let mut values = material.values.iter();
        values.any(|value| value.key == "a" && value.origin == unsaid)
    };
    let names = names_of(materials.iter().filter(has));
    (!names.is_empty()).then(|| {
        format!(
            "{} materials have a = 0, because their MTL fields say nothing of mirror-like reflection (illum < 3): {}; give a in the scene file",
            names.len(),
            defects::listed(&names)
        )
    })
}

/// Says which materials scatter without any loss.
fn white(materials: &[Material]) -> Option<String> {
    let scatters = |it: &&Material| it.optics.scattering() > 0.0 && it.optics.is_lossless();
    let names = names_of(materials.iter().filter(scatters));
    (!names.is_empty()).then(|| {
        format!(
            "{} materials keep no light (rho = 1): {}; real ones keep some, and what is caught between such surfaces is followed for a million reflections, which takes long",
            names.len(),
            defects::listed(&names)
        )
    })
}

/// Each name once, in the order of the alphabet.
fn names_of<'a>(materials: impl Iterator<Item = &'a Material>) -> Vec<String> {
    let names: BTreeSet<&str> = materials.map(|it| it.name.as_str()).collect();
    names.into_iter().map(str::to_owned).collect()
}

/// Blender writes lamps as W × 683/4π cd and emission strengths as they stand: within one file they do not agree.
fn mixed_units(imports: &[Import], materials: &[Material]) -> Option<String> {
    let from_fields = |material: &&Material| {
        let mut values = material.values.iter();
        let exitance = values.find(|value| value.key == "exitance");
        material.emission.is_some()
            && exitance.is_some_and(|value| matches!(value.origin, Origin::Field(_)))
    };
    let glowing = materials.iter().find(from_fields)?;
    let import = imports.iter().find(|import| {
        let mut names = import.model.materials.iter();
        !import.lamps.is_empty() && names.any(|material| material.name == glowing.name)
    })?;
    Some(format!(
        "{}: material {:?} emits by its file's strength, and there are lamps ({}) beside it; Blender writes lamps times 683 and strengths as they stand, so one of the two is wrong by 683: give malus_emit_lm or malus_exitance",
        import.file,
        glowing.name,
        defects::listed(
            &import
                .lamps
                .iter()
                .map(|lamp| lamp.name.clone())
                .collect::<Vec<_>>()
        )
    ))
}

/// A room that is measured in millimetres or feet.
fn odd_extent(surfaces: &Surfaces) -> Option<String> {
    let extent = extent(surfaces)?;
    let largest = extent.max_element();
    (!(1.0..=100.0).contains(&largest)).then(|| {
        let [x, y, z] = extent.to_array();
        format!(
            "the geometry measures {x:.4} × {y:.4} × {z:.4} m, which is no room; a mesh in other units needs scale = (its unit in metres)"
        )
    })
}

/// Size of the box around all surfaces, in m.
fn extent(surfaces: &Surfaces) -> Option<DVec3> {
    let bounds = crate::check::bounds(surfaces)?;
    Some(bounds.1 - bounds.0)
}

/// A representation asked for that leaves out what the scene has.
fn too_little(settings: &Settings, need: &Need) -> Option<String> {
    let asked = settings.representation?;
    (asked < need.representation).then(|| {
        format!(
            "representation {:?} leaves something out: the scene needs {:?}, because {}",
            word(asked),
            word(need.representation),
            need.reason
        )
    })
}

#[cfg(test)]
mod tests;
