//! Ways out of the geometry.

use crate::{Camera, Material, Sensor};
use glam::DVec3;
use malus_geometry::Surfaces;
use std::f64::consts::TAU;

/// The most points looked out from, evenly picked.
const POINTS: usize = 256;

/// Directions from each, a power of two so that shares are exact.
const DIRECTIONS: u32 = 64;

/// The most panes that a look goes through.
const PANES: usize = 64;

/// Where a look begins, with the axis of the hemisphere it covers.
type Outlook = (DVec3, DVec3);

/// Share of directions from the free sensor points, or from the cameras where there are none, each over its hemisphere,
/// that leave the geometry, straight through panes too: 64 a point, from at most 256 points evenly picked.
pub(crate) fn escaping(
    surfaces: &Surfaces,
    materials: &[Material],
    sensors: &[Sensor],
    cameras: &[Camera],
) -> f64 {
    share(surfaces, materials, &outlooks(sensors, cameras))
}

/// Whether any light is found to leave the geometry: from sensors, from cameras, or from either side of a pane.
pub(crate) fn any(
    surfaces: &Surfaces,
    materials: &[Material],
    sensors: &[Sensor],
    cameras: &[Camera],
) -> bool {
    let found = |outlooks: &[Outlook]| share(surfaces, materials, outlooks) > 0.0;
    found(&outlooks(sensors, cameras)) || found(&panes(surfaces, materials))
}

fn outlooks(sensors: &[Sensor], cameras: &[Camera]) -> Vec<Outlook> {
    if sensors.is_empty() {
        let look = |camera: &Camera| (camera.position, camera.forward);
        return cameras.iter().map(look).collect();
    }
    let points = sensors.iter().flat_map(|sensor| &sensor.points);
    let free = points.filter(|point| !point.enclosed);
    free.map(|point| (point.position, point.normal)).collect()
}

/// Both sides of every triangle of a pane.
fn panes(surfaces: &Surfaces, materials: &[Material]) -> Vec<Outlook> {
    let numbers = (0_u32..).zip(&surfaces.mesh().surfaces);
    let clear = numbers.filter(|(_, surface)| materials[**surface as usize].optics.is_pane());
    clear
        .flat_map(|(triangle, _)| {
            let centre = surfaces.triangle(triangle).centroid();
            let normal = surfaces.normal(triangle);
            [(centre, normal), (centre, -normal)]
        })
        .collect()
}

/// Share of directions over the hemispheres that leave the geometry.
///
/// The directions are a spiral of equal steps in height over the upper hemisphere, turned by the golden ratio.
fn share(surfaces: &Surfaces, materials: &[Material], outlooks: &[Outlook]) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let step = outlooks.len().div_ceil(POINTS).max(1);
    let (mut escaped, mut all) = (0_u32, 0_u32);
    for &(position, normal) in outlooks.iter().step_by(step) {
        let from = position + surfaces.offset() * normal;
        let (x, y) = normal.any_orthonormal_pair();
        for index in 0..DIRECTIONS {
            let height = (f64::from(index) + 0.5) / f64::from(DIRECTIONS);
            let (sin, cos) = libm::sincos(TAU * GOLDEN * f64::from(index));
            let reach = (1.0 - height * height).sqrt();
            let direction = reach * (cos * x + sin * y) + height * normal;
            escaped += u32::from(leaves(surfaces, materials, from, direction));
            all += 1;
        }
    }
    if all == 0 {
        0.0
    } else {
        f64::from(escaped) / f64::from(all)
    }
}

/// Whether a look from a point meets nothing but panes.
fn leaves(surfaces: &Surfaces, materials: &[Material], mut from: DVec3, direction: DVec3) -> bool {
    for _ in 0..PANES {
        let Some(hit) = surfaces.nearest(from, direction) else {
            return true;
        };
        let surface = surfaces.surface(hit.triangle);
        if !materials[surface as usize].optics.is_pane() {
            return false;
        }
        from += (hit.distance + surfaces.offset()) * direction;
    }
    false
}
