//! Sources that lie flush in a surface, as a spot does in a ceiling.

use crate::{Distribution, Source, SourceKind};
use glam::DVec3;
use malus_geometry::Surfaces;

/// Planes at which a source is put on the one side or the other; it lies in more only where many meet in a point.
const MOST_PLANES: usize = 3;

/// How far from a plane a source is put that lies in it, as a share of the distance within which things lie in one place:
/// farther than images of it are moved aside to be looked for.
const CLEARANCE: f64 = 0.02;

/// Moves point sources off the surfaces that they lie in: to the side on which most of the observers, points in m, see them,
/// of equals to that where their light goes, or else to that of the surface's normal.
///
/// In the plane itself rounding would decide whether light comes past the surface.
pub(crate) fn clear(sources: &mut [Source], surfaces: &Surfaces, observers: &[DVec3]) {
    for source in sources {
        if let SourceKind::Point {
            position,
            distribution,
            ..
        } = &mut source.kind
        {
            let toward = match *distribution {
                Distribution::Isotropic => None,
                Distribution::Cosine { direction } | Distribution::Spot { direction, .. } => {
                    Some(direction)
                }
            };
            *position = free(surfaces, *position, toward, observers);
        }
    }
}

fn free(surfaces: &Surfaces, position: DVec3, toward: Option<DVec3>, observers: &[DVec3]) -> DVec3 {
    let touched = surfaces.touching(position);
    if touched.is_empty() {
        return position;
    }
    // A normal of each plane, and the triangles in it.
    let mut planes: Vec<(DVec3, Vec<u32>)> = Vec::new();
    for triangle in touched {
        let normal = surfaces.normal(triangle);
        let same = |plane: &&mut (DVec3, Vec<u32>)| plane.0.cross(normal).length_squared() < 1e-12;
        match planes.iter_mut().find(same) {
            Some((_, triangles)) => triangles.push(triangle),
            None => planes.push((normal, vec![triangle])),
        }
    }
    let sides = 0..1u32 << planes.len().min(MOST_PLANES);
    let distance = CLEARANCE * surfaces.tolerance();
    let on = |sides: u32| {
        let mut place = position;
        for (index, (normal, triangles)) in planes.iter().enumerate() {
            let side = match sides >> index & 1 {
                0 => *normal,
                _ => -*normal,
            };
            for &triangle in triangles {
                let height = (place - surfaces.triangle(triangle).vertices[0]).dot(side);
                place += side * (distance - height).max(0.0);
            }
        }
        place
    };
    let seen = |&place: &DVec3| {
        // Observers may lie in surfaces, too.
        let sees = |observer: &&DVec3| surfaces.visible(place, observer.lerp(place, 1e-4));
        observers.iter().filter(sees).count()
    };
    let lit = |&place: &DVec3| toward.is_some_and(|t| (place - position).dot(t) > 0.0);
    // Of equals the first: that of the normals.
    let mut best: Option<(usize, bool, DVec3)> = None;
    for place in sides.map(on) {
        let (count, lit) = (seen(&place), lit(&place));
        if best.is_none_or(|(most, lights, _)| (count, lit) > (most, lights)) {
            best = Some((count, lit, place));
        }
    }
    best.map_or(position, |(_, _, place)| place)
}
