//! Import of geometry files: glTF 2.0 (`.gltf`, `.glb`) and Wavefront OBJ (`.obj` with its `.mtl`).
//!
//! A file becomes a [`Model`]: triangles in world metres with Z up, and beside them everything the file
//! says of its materials, lamps and objects, *uninterpreted*. What a base colour, a custom property or an
//! Empty means is not decided here.
//!
//! Nothing is keyed by a name of the file, since names repeat in ordinary exports. Whatever was left
//! aside (lines, cameras, morph targets, an unreadable texture) is said in [`Model::notes`]. No content of a
//! file makes an import panic: it ends in a [`LoadError`] that names the place.

// Tests compare floats where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod error;
mod gltf;
mod image;
mod model;
mod mtl;
mod obj;
mod placement;
mod polygon;
mod text;

#[cfg(test)]
mod robustness;
#[cfg(test)]
mod rooms;

use std::io;
use std::path::Path;

pub use error::LoadError;
pub use model::{FileMaterial, Lamp, LampKind, Look, Model, Object, Part, Properties};
pub use placement::{Placement, Up};

/// What is in a geometry file, placed in the world.
///
/// The format is told from the file's extension, in any case.
///
/// # Errors
/// [`LoadError`] if the placement is no similarity, the file or one it refers to cannot be read, the format
/// or a required extension is not supported, or the content contradicts itself.
pub fn load(path: &Path, placement: &Placement) -> Result<Model, LoadError> {
    placement.check(path)?;
    if path.is_dir() {
        return Err(LoadError::Unreadable {
            file: path.to_owned(),
            reason: io::ErrorKind::IsADirectory.into(),
        });
    }
    let extension = path
        .extension()
        .map(|e| e.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    match extension.as_str() {
        "gltf" | "glb" => gltf::read(path, placement),
        "obj" => obj::read(path, placement),
        _ => Err(LoadError::Format {
            file: path.to_owned(),
            found: if extension.is_empty() {
                "a name without an extension".to_owned()
            } else {
                format!(".{extension}")
            },
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_of_another_program_says_what_is_read_and_how_to_export() {
        for name in ["room.fbx", "room.BLEND", "room"] {
            let message = load(Path::new(name), &Placement::default())
                .unwrap_err()
                .to_string();
            assert!(message.contains(".gltf, .glb and .obj"), "{message}");
            assert!(message.contains("Export"), "{message}");
        }
    }

    #[test]
    fn a_directory_given_as_a_file_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.glb");
        fs::create_dir(&path).unwrap();
        let message = load(&path, &Placement::default()).unwrap_err().to_string();
        assert!(message.contains("room.glb"), "{message}");
        assert!(message.contains("directory"), "{message}");
    }

    #[test]
    fn a_file_that_is_not_there_is_an_error_that_names_it() {
        for name in ["absent.glb", "absent.gltf", "absent.obj"] {
            let error = load(Path::new(name), &Placement::default()).unwrap_err();
            assert!(matches!(error, LoadError::Unreadable { .. }), "{error}");
            assert!(error.to_string().contains(name), "{error}");
        }
    }
}
