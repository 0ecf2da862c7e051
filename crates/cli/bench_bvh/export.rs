//! Geometry and rays as bare arrays, for other programs to trace.

use super::rays::{Directed, Rays};
use crate::output::Directory;
use glam::DVec3;
use malus_geometry::Surfaces;

/// Writes `vertices.f64` (x y z), `triangles.u32` (three vertices each), `primary.f64` and `cosine.f64` (origin and
/// direction), `pairs.f64` and `sensors.f64` (two ends): little-endian, in rows.
pub fn export(surfaces: &Surfaces, rays: &Rays, directory: &Directory) -> anyhow::Result<()> {
    let mesh = surfaces.mesh();
    let triangles = mesh.triangles.as_flattened().iter();
    let triangles: Vec<u8> = triangles.flat_map(|vertex| vertex.to_le_bytes()).collect();
    directory.write("triangles.u32", &triangles)?;
    directory.write("vertices.f64", &bytes(mesh.positions.iter().copied()))?;
    let both = |rays: &[Directed]| bytes(rays.iter().flat_map(|&(from, along)| [from, along]));
    directory.write("primary.f64", &both(&rays.primary))?;
    directory.write("cosine.f64", &both(&rays.cosine))?;
    let ends = |pairs: &[[DVec3; 2]]| bytes(pairs.as_flattened().iter().copied());
    directory.write("pairs.f64", &ends(&rays.pairs))?;
    directory.write("sensors.f64", &ends(&rays.asked()))
}

fn bytes(vectors: impl Iterator<Item = DVec3>) -> Vec<u8> {
    vectors
        .flat_map(|vector| vector.to_array())
        .flat_map(f64::to_le_bytes)
        .collect()
}
