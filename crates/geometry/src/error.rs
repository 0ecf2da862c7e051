//! What can be wrong with a mesh so that nothing can be computed from it.

use glam::DVec3;

/// A mesh that cannot be used. Objects and vertices are named by their indices in the [`Mesh`](crate::Mesh).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN, infinite or beyond 10³⁰ m.
    #[error(
        "object {object}: vertex {vertex} is at ({}, {}, {}); every coordinate must be a finite number of metres below 1e30 in size",
        .position.x, .position.y, .position.z
    )]
    NotFinite {
        /// Index of the object.
        object: u32,
        /// Index of the vertex in `positions`.
        vertex: u32,
        /// The position found.
        position: DVec3,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "object {object}: triangle {triangle} uses vertex {vertex}; the mesh has {count} vertices, numbered from 0"
    )]
    NoSuchVertex {
        /// Index of the object.
        object: u32,
        /// Index of the triangle.
        triangle: u32,
        /// Index of the vertex asked for.
        vertex: u32,
        /// Number of vertices in the mesh.
        count: usize,
    },
    /// The lists of a mesh do not belong together.
    #[error(
        "the mesh has {triangles} triangles but {surfaces} surface and {objects} object indices; there must be one of each a triangle"
    )]
    Uneven {
        /// Number of triangles.
        triangles: usize,
        /// Number of surface indices.
        surfaces: usize,
        /// Number of object indices.
        objects: usize,
    },
    /// More triangles than can be numbered.
    #[error("the mesh has {triangles} triangles; at most {allowed} are possible")]
    TooMany {
        /// Number of triangles.
        triangles: usize,
        /// The largest number allowed.
        allowed: usize,
    },
}
