//! Sensor points inside closed solids, where no light comes.

use crate::{Material, Sensor, Source, SourceKind};
use glam::DVec3;
use malus_geometry::Surfaces;
use malus_geometry::solid::{Solid, Solids};

/// Marks the points strictly inside a closed solid that has no emitter inside and does not hold all points.
///
/// A point on a surface counts as lying on its normal's side of it.
pub(crate) fn mark(
    sensors: &mut [Sensor],
    surfaces: &Surfaces,
    materials: &[Material],
    sources: &[Source],
) {
    let offset = surfaces.offset();
    for solid in &Solids::of(surfaces.mesh()) {
        let mut points: Vec<_> = sensors
            .iter_mut()
            .flat_map(|sensor| &mut sensor.points)
            .collect();
        let count = points.len();
        points.retain(|point| solid.contains(point.position + offset * point.normal));
        let some = !points.is_empty() && points.len() < count;
        if some && !lit(solid, surfaces, materials, sources) {
            points.iter_mut().for_each(|point| point.enclosed = true);
        }
    }
}

/// Whether anything emits inside a solid: a point source in it, or a surface whose front lies in it.
fn lit(solid: &Solid, surfaces: &Surfaces, materials: &[Material], sources: &[Source]) -> bool {
    let points = sources.iter().filter_map(|source| match source.kind {
        SourceKind::Point { position, .. } => Some(position),
        SourceKind::Distant { .. } => None,
    });
    let mesh = surfaces.mesh();
    let emits = |surface: u32| materials[surface as usize].emission.is_some();
    let emitting = (0..mesh.len()).filter(|triangle| emits(mesh.surfaces[*triangle]));
    let fronts = emitting.map(|triangle| {
        let triangle = mesh.triangle(triangle);
        triangle.centroid() + surfaces.offset() * triangle.normal()
    });
    let inside = |point: DVec3| solid.contains(point);
    points.into_iter().any(inside) || fronts.into_iter().any(inside)
}
