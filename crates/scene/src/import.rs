//! A mesh file with its custom properties and fields given a meaning.

use crate::appearance::{Appearance, luminance};
use crate::error::Error;
use crate::file::MeshFile;
use crate::polarisation::UNPOLARISED;
use crate::properties::{Custom, Holder, Marker};
use crate::sensor::marker::marked;
use crate::source::{Distribution, Source, SourceKind};
use malus_geometry::load::{Lamp, LampKind, Look, Model, Object, load};

/// A mesh file, loaded.
pub(crate) struct Import {
    /// The file as the scene file writes it.
    pub(crate) file: String,
    pub(crate) model: Model,
    /// Custom properties of each object of the model.
    pub(crate) objects: Vec<Custom>,
    /// Custom properties of each material.
    pub(crate) materials: Vec<Custom>,
    /// What the fields of each material give.
    pub(crate) appearances: Vec<Appearance>,
    /// Its lamps as sources.
    pub(crate) lamps: Vec<Source>,
}

/// What an object is to the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Geometry,
    Sensor(Marker),
    /// Left out by `malus_ignore`.
    Ignored,
    /// An Empty that marks nothing.
    Nothing,
}

impl Import {
    /// Loads a mesh file and reads every custom property in it.
    pub(crate) fn load(mesh: &MeshFile) -> Result<Self, Error> {
        let model = load(&mesh.path, &mesh.placement).map_err(|error| Error::Mesh {
            at: mesh.file.at.to_string(),
            reason: Box::new(error),
        })?;
        let mut import = Self::of(mesh.file.value.clone(), model)?;
        let faceless = |object: &Object| object.parts.iter().all(|part| part.triangles.is_empty());
        let means_nothing = |(index, object): (usize, &Object)| {
            matches!(import.role(index), Role::Nothing | Role::Geometry) && faceless(object)
        };
        if import.lamps.is_empty() && import.model.objects.iter().enumerate().all(means_nothing) {
            return Err(Error::EmptyMesh {
                at: mesh.file.at.to_string(),
                file: mesh.path.display().to_string(),
            });
        }
        if !mesh.lights {
            import.lamps.clear();
        }
        Ok(import)
    }

    /// Gives a meaning to a `model` that comes from `file`.
    pub(crate) fn of(file: String, model: Model) -> Result<Self, Error> {
        let mut errors = Vec::new();
        let mut read = |holder, what: &str, name: &str, properties| {
            let label = format!("{what} {name:?} ({file})");
            Custom::read(holder, &label, properties).unwrap_or_else(|error| {
                errors.push(error);
                Custom::default()
            })
        };
        let objects = model.objects.iter();
        let objects = objects
            .map(|object| read(Holder::Object, "object", &object.name, &object.properties))
            .collect();
        let materials = model.materials.iter();
        let materials = materials
            .map(|it| read(Holder::Material, "material", &it.name, &it.properties))
            .collect();
        let lamps: Vec<(&Lamp, Custom)> = model
            .lamps
            .iter()
            .map(|lamp| {
                (
                    lamp,
                    read(Holder::Lamp, "lamp", &lamp.name, &lamp.properties),
                )
            })
            .filter(|(_, custom)| !custom.ignore)
            .collect();
        let mut sources = Vec::with_capacity(lamps.len());
        for (lamp, custom) in lamps {
            match source(lamp, &custom, &file) {
                Ok(source) => sources.push(source),
                Err(error) => errors.push(error),
            }
        }
        Error::all(errors)?;
        Ok(Self {
            appearances: model.materials.iter().map(Appearance::of).collect(),
            file,
            objects,
            materials,
            lamps: sources,
            model,
        })
    }

    /// What object `index` is to the scene.
    pub(crate) fn role(&self, index: usize) -> Role {
        let (object, custom) = (&self.model.objects[index], &self.objects[index]);
        if custom.ignore {
            return Role::Ignored;
        }
        match marked(object, custom) {
            Some(marker) => Role::Sensor(marker),
            None if object.parts.is_empty() => Role::Nothing,
            None => Role::Geometry,
        }
    }

    /// Forgets the faces of those objects that are geometry and `done` with: a large mesh would stand in memory twice.
    pub(crate) fn let_go(&mut self, done: impl Fn(usize) -> bool) {
        for index in 0..self.model.objects.len() {
            if self.role(index) == Role::Geometry && done(index) {
                for part in &mut self.model.objects[index].parts {
                    part.positions = Vec::new();
                    part.triangles = Vec::new();
                    part.faces = Vec::new();
                }
            }
        }
    }

    /// Name of an object for messages.
    pub(crate) fn label(&self, object: &Object) -> String {
        format!("object {:?} ({})", object.name, self.file)
    }

    /// Whether this is a glTF with nothing in it that an exporter leaves out unless told to write it.
    fn is_bare_gltf(&self) -> bool {
        let model = &self.model;
        let is_gltf = |look: &Look| matches!(look, Look::Gltf { .. });
        model.lamps.is_empty()
            && model
                .materials
                .iter()
                .any(|material| is_gltf(&material.look))
            && model
                .materials
                .iter()
                .all(|material| material.properties.is_empty())
            && model
                .objects
                .iter()
                .all(|object| object.properties.is_empty())
    }

    /// What the loader left aside, and custom properties that have no effect.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let notes = self.model.notes.iter();
        let mut warnings: Vec<String> =
            notes.map(|note| format!("{}: {note}", self.file)).collect();
        if self.is_bare_gltf() {
            warnings.push(format!(
                "{}: no custom property and no light is in it; where it comes from Blender and should have them, export it with Include > Custom Properties and Punctual Lights ticked, and with Mesh > Apply Modifiers, without which arrays, mirrors and bevels are missing too",
                self.file
            ));
        }
        for (index, (object, custom)) in self.model.objects.iter().zip(&self.objects).enumerate() {
            if custom.is_material() && self.role(index) == Role::Nothing {
                warnings.push(format!(
                    "{} has no faces: its custom properties have no effect; set them on the objects below it",
                    self.label(object)
                ));
            }
        }
        warnings
    }
}

/// A lamp of KHR_lights_punctual as a source: its intensity times its colour's luminance.
///
/// A spot falls off by a smoothstep in the cosine between the file's two angles.
fn source(lamp: &Lamp, custom: &Custom, file: &str) -> Result<Source, Error> {
    let faulty = |key: &str, found: String, allowed: &str| Error::BadMaterial {
        holder: format!("lamp {:?} ({file})", lamp.name),
        key: key.into(),
        found,
        allowed: allowed.into(),
        origin: "KHR_lights_punctual".into(),
    };
    let intensity = lamp.intensity * luminance(lamp.color);
    if !(intensity.is_finite() && intensity >= 0.0) {
        let found = format!("{} × colour {:?}", lamp.intensity, lamp.color);
        return Err(faulty("intensity", found, "a number ≥ 0"));
    }
    let (position, direction) = (lamp.position, lamp.direction);
    let kind = match lamp.kind {
        LampKind::Point => SourceKind::Point {
            position,
            intensity,
            distribution: Distribution::Isotropic,
        },
        LampKind::Spot {
            inner_rad,
            outer_rad,
        } => {
            if !(inner_rad >= 0.0
                && outer_rad > 0.0
                && outer_rad <= std::f64::consts::FRAC_PI_2 + 1e-6)
            {
                let found = format!("{inner_rad} and {outer_rad} radians");
                return Err(faulty("cone", found, "between 0 and a right angle"));
            }
            let cos_outer = libm::cos(outer_rad);
            SourceKind::Point {
                position,
                intensity,
                distribution: Distribution::Spot {
                    direction,
                    cos_inner: libm::cos(inner_rad).max(cos_outer),
                    cos_outer,
                },
            }
        }
        LampKind::Distant => SourceKind::Distant {
            direction,
            irradiance: intensity,
        },
    };
    Ok(Source {
        name: lamp.name.clone(),
        kind,
        state: custom.state.unwrap_or(UNPOLARISED),
        axis: lamp.x_axis,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DVec3};
    use serde_json::json;

    fn lamp(kind: LampKind, properties: serde_json::Value) -> Lamp {
        Lamp {
            name: "Spot".into(),
            properties: serde_json::from_value(properties).unwrap(),
            kind,
            position: DVec3::Z,
            direction: DVec3::NEG_Z,
            x_axis: DVec3::Y,
            intensity: 100.0,
            color: [1.0, 0.5, 0.0],
        }
    }

    fn import(lamps: Vec<Lamp>, objects: Vec<Object>) -> Result<Import, String> {
        let model = Model {
            lamps,
            objects,
            ..Model::default()
        };
        Import::of("room.glb".into(), model).map_err(|error| error.to_string())
    }

    fn empty(name: &str, properties: serde_json::Value) -> Object {
        Object {
            name: name.into(),
            properties: serde_json::from_value(properties).unwrap(),
            parts: Vec::new(),
            frame: DAffine3::IDENTITY,
        }
    }

    #[test]
    fn a_lamp_shines_with_the_luminance_of_its_colour() {
        let source = &import(vec![lamp(LampKind::Point, json!({}))], vec![])
            .unwrap()
            .lamps[0];
        let SourceKind::Point { intensity, .. } = source.kind else {
            panic!("a point")
        };
        assert!((intensity - 100.0 * (0.2126 + 0.5 * 0.7152)).abs() < 1e-12);
    }

    #[test]
    fn a_spot_keeps_its_angles_its_state_and_its_axis() {
        let kind = LampKind::Spot {
            inner_rad: 0.349,
            outer_rad: 0.436,
        };
        let properties = json!({"malus_polarisation": [1.0, 0.3, 0.0, 0.0]});
        let import = import(vec![lamp(kind, properties)], vec![]).unwrap();
        let source = &import.lamps[0];
        assert_eq!(
            (source.state, source.axis),
            ([1.0, 0.3, 0.0, 0.0], DVec3::Y)
        );
        let SourceKind::Point {
            distribution:
                Distribution::Spot {
                    cos_inner,
                    cos_outer,
                    ..
                },
            ..
        } = source.kind
        else {
            panic!("a spot")
        };
        assert!((cos_inner - libm::cos(0.349)).abs() < 1e-15);
        assert!((cos_outer - libm::cos(0.436)).abs() < 1e-15);
    }

    #[test]
    fn an_ignored_lamp_is_left_out_and_a_bad_one_is_an_error() {
        let ignored = lamp(LampKind::Distant, json!({"malus_ignore": true}));
        assert!(import(vec![ignored], vec![]).unwrap().lamps.is_empty());
        let mut dark = lamp(LampKind::Distant, json!({}));
        dark.intensity = -1.0;
        let error = import(vec![dark], vec![]).err().unwrap();
        assert!(
            error.contains("lamp \"Spot\" (room.glb)") && error.contains("≥ 0"),
            "{error}"
        );
    }

    #[test]
    fn every_bad_property_of_a_file_is_told_at_once() {
        let objects = vec![
            empty("A", json!({"malus_roh": 1})),
            empty("B", json!({"malus_a": 2})),
        ];
        let error = import(vec![], objects).err().unwrap();
        assert_eq!(error.lines().count(), 2, "{error}");
        assert!(error.contains("object \"B\" (room.glb)"), "{error}");
    }

    #[test]
    fn roles_follow_the_properties() {
        let objects = vec![
            empty("SENSOR_a", json!({})),
            empty("SENSOR_b", json!({"malus_ignore": 1})),
            empty("Parent", json!({"malus_rho": 0.5})),
        ];
        let import = import(vec![], objects).unwrap();
        let roles: Vec<Role> = (0..3).map(|index| import.role(index)).collect();
        let expected = [Role::Sensor(Marker::Grid), Role::Ignored, Role::Nothing];
        assert_eq!(roles, expected);
        assert!(import.warnings()[0].contains("object \"Parent\""));
    }
}
