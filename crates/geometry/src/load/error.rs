//! Why a geometry file cannot be imported.

use std::io;
use std::path::{Path, PathBuf};

/// Why a geometry file cannot be imported: the file, the place in it, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file is of a format that is not read.
    #[error(
        "{}: only .gltf, .glb and .obj files are read, not {found}; in Blender: File > Export > glTF 2.0 with \
         Include > Custom Properties and Punctual Lights, and Data > Mesh > Apply Modifiers",
        file.display()
    )]
    Format {
        /// The file asked for.
        file: PathBuf,
        /// Its extension.
        found: String,
    },
    /// The file itself cannot be read.
    #[error("{}: cannot be read: {reason}", file.display())]
    Unreadable {
        /// The file asked for.
        file: PathBuf,
        /// What the operating system says.
        reason: io::Error,
    },
    /// A file that this one refers to cannot be read: a `.bin` of a `.gltf`, a `.mtl` of an `.obj`.
    #[error("{}: {place} refers to {}, which cannot be read: {reason}; {remedy}", file.display(), needed.display())]
    Companion {
        /// The file that refers to the other.
        file: PathBuf,
        /// Where in it.
        place: String,
        /// The file referred to.
        needed: PathBuf,
        /// What the operating system says.
        reason: io::Error,
        /// What to do.
        remedy: &'static str,
    },
    /// A glTF extension without which the file cannot be understood is not supported.
    #[error("{}: needs the glTF extension {extension}, which is not read: {remedy}", file.display())]
    Extension {
        /// The file.
        file: PathBuf,
        /// The extension's name.
        extension: String,
        /// The export option to change.
        remedy: &'static str,
    },
    /// Something in the file is not as its format has it.
    #[error("{}: {place}: {found}; {allowed}", file.display())]
    Invalid {
        /// The file.
        file: PathBuf,
        /// Line, JSON path or object.
        place: String,
        /// What is there.
        found: String,
        /// What may be there.
        allowed: String,
    },
    /// A stretch of data reaches beyond its container.
    #[error("{}: {place}: needs {needed} bytes, but there are {available}", file.display())]
    Range {
        /// The file.
        file: PathBuf,
        /// JSON path.
        place: String,
        /// Bytes needed.
        needed: u128,
        /// Bytes there.
        available: u128,
    },
    /// A vertex index without a vertex.
    #[error("{}: {place}: index {index}, but there are {count} vertices", file.display())]
    Index {
        /// The file.
        file: PathBuf,
        /// Line or mesh.
        place: String,
        /// The index as written in the file.
        index: i64,
        /// How many vertices there are at that place.
        count: usize,
    },
    /// A coordinate that is infinite or no number.
    #[error(
        "{}: {place}: vertex {vertex} is ({}, {}, {}); coordinates must be finite",
        file.display(), found[0], found[1], found[2]
    )]
    NotFinite {
        /// The file.
        file: PathBuf,
        /// The mesh or object, and the line where there are lines.
        place: String,
        /// Number of the vertex as the format counts: from 0 in glTF, from 1 in OBJ.
        vertex: usize,
        /// Its coordinates.
        found: [f64; 3],
    },
}

impl LoadError {
    pub(super) fn invalid(
        file: &Path,
        place: impl Into<String>,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        Self::Invalid {
            file: file.to_owned(),
            place: place.into(),
            found: found.into(),
            allowed: allowed.into(),
        }
    }

    pub(super) fn unreadable(file: &Path, reason: io::Error) -> Self {
        Self::Unreadable {
            file: file.to_owned(),
            reason,
        }
    }
}
