//! Sources that lie flush in a surface, as a spot does in a ceiling.

use crate::{Camera, Distribution, Quantity, Sensor, Source, SourceKind};
use glam::DVec3;
use malus_geometry::Surfaces;

/// Planes at which a source is put on the one side or the other; it lies in more only where many meet in a point.
const MOST_PLANES: usize = 3;

/// How far from a plane a source is put that lies in it, as a share of the distance within which things lie in one place:
/// farther than images of it are moved aside to be looked for.
const CLEARANCE: f64 = 0.02;

/// Moves point sources off the surfaces that they lie in: to the side from which most sensor points and cameras are seen, of
/// equals to that where their light goes, then to that where the middle of those is, or else to that of the surface's normal.
///
/// In the plane itself rounding would decide whether light comes past the surface.
pub(crate) fn clear(
    sources: &mut [Source],
    surfaces: &Surfaces,
    sensors: &[Sensor],
    cameras: &[Camera],
) {
    let of_irradiance = |sensor: &Sensor| sensor.quantity == Quantity::Irradiance;
    let points = sensors.iter().flat_map(|sensor| {
        let normal = |normal| of_irradiance(sensor).then_some(normal);
        sensor
            .points
            .iter()
            .map(move |point| (point.position, normal(point.normal)))
    });
    let eyes = cameras.iter().map(|camera| (camera.position, None));
    let observers: Vec<Observer> = points.chain(eyes).collect();
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
            *position = free(surfaces, *position, toward, &observers);
        }
    }
}

/// A place from which light is measured, and if on one side only the normal there.
type Observer = (DVec3, Option<DVec3>);

fn free(
    surfaces: &Surfaces,
    position: DVec3,
    toward: Option<DVec3>,
    observers: &[Observer],
) -> DVec3 {
    let touched = surfaces.touching(position);
    let planes = surfaces.planes_of(&touched);
    let Some(&last) = planes.iter().max() else {
        return position;
    };
    let normals: Vec<DVec3> = (0..=last)
        .filter_map(|plane| planes.iter().position(|&p| p == plane))
        .map(|first| surfaces.normal(touched[first]))
        .collect();
    let distance = CLEARANCE * surfaces.tolerance();
    let on = |sides: u32| {
        let side = |(&triangle, &plane): (&u32, &usize)| {
            let turned = plane < MOST_PLANES && sides >> plane & 1 == 1;
            let sign = if turned { -1.0 } else { 1.0 };
            (triangle, normals[plane] * sign, distance)
        };
        let sides: Vec<_> = touched.iter().zip(&planes).map(side).collect();
        surfaces.moved_off(position, &sides)
    };
    let middle = observers.iter().map(|it| it.0).sum::<DVec3>() / observers.len().max(1) as f64;
    let rank = |place: DVec3| {
        let sees = |&&(observer, normal): &&Observer| {
            // Observers may lie in surfaces, too.
            normal.is_none_or(|normal| normal.dot(place - observer) > 0.0)
                && surfaces.visible(place, observer.lerp(place, 1e-4))
        };
        let along = |direction: DVec3| direction.dot(place - position) > 0.0;
        let lit = toward.is_some_and(along);
        (
            observers.iter().filter(sees).count(),
            lit,
            along(middle - position),
        )
    };
    // Of equals the first: that of the normals.
    let mut best = on(0);
    let mut highest = rank(best);
    for place in (1..1 << (last + 1).min(MOST_PLANES)).map(on) {
        let rank = rank(place);
        if rank > highest {
            (best, highest) = (place, rank);
        }
    }
    best
}
