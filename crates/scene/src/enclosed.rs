//! Sensor points inside closed solids, where no light comes.

use crate::{Material, Sensor, Source, SourceKind};
use glam::DVec3;
use malus_geometry::Surfaces;
use malus_geometry::solid::Solids;

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
    let emitters = emitters(surfaces, materials, sources);
    for solid in &Solids::of(surfaces.mesh()) {
        let (least, most) = solid.bounds();
        let within = |point: DVec3| point.cmpge(least).all() && point.cmple(most).all();
        let mut points: Vec<_> = sensors
            .iter_mut()
            .flat_map(|sensor| &mut sensor.points)
            .collect();
        let count = points.len();
        points.retain(|point| within(point.position));
        // Whether an emitter is inside is asked first: a room of a million triangles is then asked once, not for each
        // point.
        if points.is_empty() || emitters.iter().any(|&point| solid.contains(point)) {
            continue;
        }
        points.retain(|point| solid.contains(point.position + offset * point.normal));
        if points.len() < count {
            points.iter_mut().for_each(|point| point.enclosed = true);
        }
    }
}

/// A point of each emitter: point sources, and emitting triangles a little to the front.
fn emitters(surfaces: &Surfaces, materials: &[Material], sources: &[Source]) -> Vec<DVec3> {
    let points = sources.iter().filter_map(|source| match source.kind {
        SourceKind::Point { position, .. } => Some(position),
        SourceKind::Distant { .. } => None,
    });
    let mesh = surfaces.mesh();
    let emits = |triangle: &usize| {
        materials[mesh.surfaces[*triangle] as usize]
            .emission
            .is_some()
    };
    let fronts = (0..mesh.len()).filter(emits).map(|triangle| {
        let triangle = mesh.triangle(triangle);
        triangle.centroid() + surfaces.offset() * triangle.normal()
    });
    points.chain(fronts).collect()
}
