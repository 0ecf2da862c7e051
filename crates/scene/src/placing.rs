//! Sensors of the scene file and of mesh files, found and put in order.

use crate::Sensor;
use crate::assembly::ObjectIndex;
use crate::camera::Camera;
use crate::error::Error;
use crate::import::{Import, Role};
use crate::material::library::is_glob;
use crate::nearest::hint;
use crate::place::Located;
use crate::sensor::described::Described;
use crate::sensor::marker::sensor;
use crate::sensor::name::{folded, usable};
use globset::Glob;
use malus_geometry::load::Object;
use std::collections::BTreeSet;

/// The objects that each sensor of the scene file lies on.
pub(crate) struct Measured(Vec<Vec<ObjectIndex>>);

impl Measured {
    /// All of them.
    pub(crate) fn objects(&self) -> BTreeSet<ObjectIndex> {
        self.0.iter().flatten().copied().collect()
    }
}

/// Finds the objects that the scene file's sensors lie on.
pub(crate) fn measured(sensors: &[Described], imports: &[Import]) -> Result<Measured, Error> {
    let mut found = Vec::with_capacity(sensors.len());
    let mut errors = Vec::new();
    for sensor in sensors {
        match sensor.objects().map(|pattern| objects(pattern, imports)) {
            None => found.push(Vec::new()),
            Some(Ok(objects)) => found.push(objects),
            Some(Err(error)) => errors.push(error),
        }
    }
    Error::all(errors).map(|()| Measured(found))
}

/// Mesh objects of a name, or else those that a glob matches.
fn objects(pattern: &Located<String>, imports: &[Import]) -> Result<Vec<ObjectIndex>, Error> {
    let meshes = || {
        imports.iter().enumerate().flat_map(|(file, import)| {
            let objects = import.model.objects.iter().enumerate();
            objects
                .filter(|(index, object)| {
                    !object.parts.is_empty() && import.role(*index) != Role::Ignored
                })
                .map(move |(index, object)| (object.name.as_str(), (file, index)))
        })
    };
    let named = |matches: &dyn Fn(&str) -> bool| -> Vec<ObjectIndex> {
        let hits = meshes().filter(|(name, _)| matches(name));
        hits.map(|(_, at)| at).collect()
    };
    let mut hits = named(&|name| name == pattern.value);
    if hits.is_empty() && is_glob(&pattern.value) {
        let glob = Glob::new(&pattern.value).map_err(|error| Error::BadValue {
            at: pattern.at.to_string(),
            key: "[[sensor]] mesh".into(),
            found: format!("{:?}", pattern.value),
            allowed: format!("a name or a glob ({})", error.kind()),
            hint: String::new(),
        })?;
        let matcher = glob.compile_matcher();
        hits = named(&|name| matcher.is_match(name));
    }
    if hits.is_empty() {
        return Err(Error::NoMatch {
            at: pattern.at.to_string(),
            what: "mesh object".into(),
            name: pattern.value.clone(),
            hint: hint(&pattern.value, meshes().map(|(name, _)| name)),
        });
    }
    Ok(hits)
}

/// All sensors: those of the scene file, then the marked objects of mesh files that none of those lies on; `cameras`
/// have names of their own beside them.
pub(crate) fn place(
    described: Vec<Described>,
    cameras: &[Located<Camera>],
    imports: &[Import],
    measured: &Measured,
    warnings: &mut Vec<String>,
) -> Result<Vec<Sensor>, Error> {
    check_names(&described, cameras, imports, measured)?;
    let mut sensors = Vec::new();
    let mut errors = Vec::new();
    for (described, objects) in described.into_iter().zip(&measured.0) {
        for &(file, index) in objects {
            let import = &imports[file];
            if import.role(index) == Role::Geometry {
                warnings.push(format!(
                    "{} is no geometry, because sensor {:?} lies on it",
                    import.label(&import.model.objects[index]),
                    described.name.value
                ));
            }
        }
        let objects: Vec<&Object> = objects
            .iter()
            .map(|&(file, index)| &imports[file].model.objects[index])
            .collect();
        match described.placed(&objects, warnings) {
            Ok(sensor) => sensors.push(sensor),
            Err(error) => errors.push(error),
        }
    }
    let names = sensors.iter().map(|sensor| folded(&sensor.name));
    let cameras = cameras.iter().map(|camera| folded(&camera.value.name));
    let mut taken: BTreeSet<String> = names.chain(cameras).collect();
    for (file, index) in marked(imports, &measured.objects()) {
        let (import, object) = (&imports[file], &imports[file].model.objects[index]);
        let Role::Sensor(marker) = import.role(index) else {
            continue;
        };
        let name = usable(&object.name, &taken);
        taken.insert(folded(&name));
        match sensor(name, object, &import.objects[index], marker) {
            Ok(sensor) => sensors.push(sensor),
            Err(reason) => errors.push(Error::Marker {
                holder: import.label(object),
                reason,
            }),
        }
    }
    Error::all(errors).map(|()| sensors)
}

/// Marked objects of mesh files that no sensor of the scene file lies on.
fn marked(imports: &[Import], measured: &BTreeSet<ObjectIndex>) -> Vec<ObjectIndex> {
    let mut marked = Vec::new();
    for (file, import) in imports.iter().enumerate() {
        for index in 0..import.model.objects.len() {
            let sensor = matches!(import.role(index), Role::Sensor(_));
            if sensor && !measured.contains(&(file, index)) {
                marked.push((file, index));
            }
        }
    }
    marked
}

/// Names of sensors and cameras must differ even where upper and lower case are one, since they name files.
fn check_names(
    described: &[Described],
    cameras: &[Located<Camera>],
    imports: &[Import],
    measured: &Measured,
) -> Result<(), Error> {
    let marked: BTreeSet<String> = marked(imports, &measured.objects())
        .into_iter()
        .map(|(file, index)| folded(&imports[file].model.objects[index].name))
        .collect();
    let mut taken = BTreeSet::new();
    let mut errors = Vec::new();
    let sensors = described.iter().map(|sensor| {
        let Located { value, at } = &sensor.name;
        ("sensor", value.as_str(), at)
    });
    let cameras = cameras
        .iter()
        .map(|camera| ("camera", camera.value.name.as_str(), &camera.at));
    for (what, value, at) in sensors.chain(cameras) {
        let reason = if !taken.insert(folded(value)) {
            format!(
                "the {what} name {value:?} is used twice (upper and lower case count as one, sensors and cameras too); names must differ"
            )
        } else if marked.contains(&folded(value)) {
            let instead = match what {
                "sensor" => format!(", or mesh = {value:?} to take its place"),
                _ => String::new(),
            };
            format!(
                "the {what} name {value:?} is that of an object in a mesh file, which is a sensor already; give another name{instead}"
            )
        } else {
            continue;
        };
        errors.push(Error::Conflict {
            at: at.to_string(),
            reason,
        });
    }
    Error::all(errors)
}
