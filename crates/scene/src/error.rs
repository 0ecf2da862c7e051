//! What can be wrong with a scene.

use malus_geometry::Error as GeometryError;
use malus_geometry::load::LoadError;

/// Why a scene cannot be loaded: the place, what was found there and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file that cannot be read at all.
    #[error("{path}: {reason}")]
    Unreadable {
        /// The file.
        path: String,
        /// Why not.
        reason: String,
    },
    /// A scene file that is not TOML.
    #[error("{at}: not valid TOML: {message}")]
    Syntax {
        /// Place in the scene file.
        at: String,
        /// What the parser says.
        message: String,
    },
    /// A `--set` that fits nothing in the scene file.
    #[error("{at}: {reason}{hint}")]
    Override {
        /// The override as given.
        at: String,
        /// Why it does not fit.
        reason: String,
        /// The nearest spelling.
        hint: String,
    },
    /// A key that means nothing.
    #[error("{at}: {table} has no key {key:?}{hint}")]
    UnknownKey {
        /// Place of the key.
        at: String,
        /// Table it stands in.
        table: String,
        /// The key.
        key: String,
        /// The nearest spelling.
        hint: String,
    },
    /// A key that has to be there.
    #[error("{at}: {table} lacks the key {key:?}: {expected}")]
    MissingKey {
        /// Place of the table.
        at: String,
        /// The table.
        table: String,
        /// The key.
        key: String,
        /// What it should hold.
        expected: String,
    },
    /// A value of the wrong kind, length or range.
    #[error("{at}: {key} must be {allowed}, found {found}{hint}")]
    BadValue {
        /// Place of the value.
        at: String,
        /// The key, with its table.
        key: String,
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
        /// The nearest spelling, where the value is a word.
        hint: String,
    },
    /// Values that contradict each other.
    #[error("{at}: {reason}")]
    Conflict {
        /// Place of one of them.
        at: String,
        /// The contradiction.
        reason: String,
    },
    /// A mesh file that cannot be loaded.
    #[error("{at}: {reason}")]
    Mesh {
        /// Place of the `file` value.
        at: String,
        /// Why not, with the path looked at.
        reason: Box<LoadError>,
    },
    /// A mesh file with nothing in it.
    #[error(
        "{at}: {file} has no faces, no lights and no sensors in it: select the room and export again, or leave the file out"
    )]
    EmptyMesh {
        /// Place of the `file` value.
        at: String,
        /// The file as looked for.
        file: String,
    },
    /// A pane where only a single sheet can be one.
    #[error(
        "{at}material {material:?} is a pane ({origin}) and makes up closed solids: {objects}; a pane is a whole sheet with both its faces, so a closed solid of it counts every wall twice: replace it by a single sheet, or add to the scene file\n\n    [material.{material:?}]\n    kind = \"mixture\"\n\nwhich is opaque (for one object alone: its custom property malus_kind); normals that point inward mean a room, whose walls are single sheets"
    )]
    PaneSolid {
        /// Place of the kind in the scene file with a colon, empty where it comes from elsewhere.
        at: String,
        /// Names of the solids' objects.
        objects: String,
        /// The material.
        material: String,
        /// Where its kind comes from.
        origin: String,
    },
    /// A closed room without loss.
    #[error(
        "{path}: nothing absorbs light and none leaves: every surface reflects or lets through all of it ({materials}), so the illuminance grows without bound; give some material rho below 1"
    )]
    NoLoss {
        /// The scene file.
        path: String,
        /// Names of the materials.
        materials: String,
    },
    /// A name or glob in the scene file that nothing answers to.
    #[error("{at}: no {what} is called {name:?}{hint}")]
    NoMatch {
        /// Place of the name.
        at: String,
        /// What was looked for: a material, a mesh object.
        what: String,
        /// The name or glob.
        name: String,
        /// The nearest spelling.
        hint: String,
    },
    /// A custom property that means nothing or has a bad value.
    #[error("{holder}: custom property {key:?} {reason}{hint}")]
    Property {
        /// Object, material or lamp, with its file.
        holder: String,
        /// The property.
        key: String,
        /// What is wrong.
        reason: String,
        /// The nearest spelling.
        hint: String,
    },
    /// A material whose reflectance nothing gives.
    #[error(
        "{holder}: nothing gives its reflectance rho ({reason}); add to the scene file\n\n    [material.{name:?}]\n    rho = 0.5\n\nor the custom property malus_rho"
    )]
    NoReflectance {
        /// Object and material, with their file.
        holder: String,
        /// Name to write in the scene file.
        name: String,
        /// Why the file does not give it.
        reason: String,
    },
    /// A value of a mesh file that the model does not allow.
    #[error("{holder}: {key} must be {allowed}, found {found} (from {origin})")]
    BadMaterial {
        /// Object and material, with their file.
        holder: String,
        /// The value's key.
        key: String,
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
        /// Where it comes from.
        origin: String,
    },
    /// A sensor that cannot be made from an object of a mesh file.
    #[error("{holder}: {reason}")]
    Marker {
        /// The object, with its file.
        holder: String,
        /// What is wrong.
        reason: String,
    },
    /// A scene without light.
    #[error(
        "{path}: nothing emits light. glTF drops Blender's area lights: make them emitting surfaces (custom property malus_emit_lm, in lumens), export with lights switched on, or add to the scene file\n\n    [material.\"Lamp*\"]\n    exitance = 3000      # lm/m²\n\nor\n\n    [[source]]\n    kind = \"point\"\n    position = [2, 2, 2.5]\n    intensity = 100      # lm/sr"
    )]
    NoEmitter {
        /// The scene file.
        path: String,
    },
    /// A scene with neither sensors nor cameras.
    #[error(
        "{path}: there is no sensor and no camera; add to the scene file\n\n    [[sensor]]\n    name = \"desk\"\n    grid = {{ origin = [0, 0, 0.75], u = [4, 0, 0], v = [0, 3, 0], counts = [9, 9] }}\n    normal = [0, 0, 1]\n\nor name an Empty SENSOR_… in the mesh file"
    )]
    NoSensor {
        /// The scene file.
        path: String,
    },
    /// Geometry that cannot be used.
    #[error("{path}: {reason}")]
    Geometry {
        /// The scene file.
        path: String,
        /// Why not.
        reason: Box<GeometryError>,
    },
    /// Several errors, each on a line of its own.
    #[error("{}", several(.0))]
    Several(Vec<Error>),
}

impl Error {
    /// Nothing for no error, the error itself for one, else all of them.
    pub(crate) fn all(mut errors: Vec<Self>) -> Result<(), Self> {
        match errors.len() {
            0 => Ok(()),
            1 => Err(errors.remove(0)),
            _ => Err(Self::Several(errors)),
        }
    }

    /// The errors that this one is made of.
    pub(crate) fn parts(self) -> Vec<Self> {
        match self {
            Self::Several(errors) => errors.into_iter().flat_map(Self::parts).collect(),
            one => vec![one],
        }
    }
}

/// The first of several errors, and the number of the others.
fn several(errors: &[Error]) -> String {
    const SHOWN: usize = 20;
    let mut lines: Vec<String> = errors.iter().take(SHOWN).map(ToString::to_string).collect();
    if errors.len() > SHOWN {
        lines.push(format!("and {} more errors", errors.len() - SHOWN));
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(count: usize) -> Vec<Error> {
        let error = |line| Error::Conflict {
            at: format!("room.toml:{line}:1"),
            reason: "x".into(),
        };
        (0..count).map(error).collect()
    }

    #[test]
    fn several_errors_stand_on_lines_and_many_are_counted() {
        assert!(Error::all(errors(0)).is_ok());
        let message = |count| Error::all(errors(count)).unwrap_err().to_string();
        assert_eq!(message(1), "room.toml:0:1: x");
        assert_eq!(message(3).lines().count(), 3);
        assert!(message(50).ends_with("and 30 more errors"));
    }
}
