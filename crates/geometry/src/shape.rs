//! Geometry without a file: rectangles, boxes, discs, spheres.
//!
//! Each function gives positions in m and triangles that index into them, for [`Mesh::append`](crate::Mesh::append).

use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Positions in m, and three indices into them a triangle.
pub type Faces = (Vec<DVec3>, Vec<[u32; 3]>);

/// A parallelogram with corners `origin`, `origin + u`, `origin + u + v`, `origin + v` (in m) and its normal along u × v.
#[must_use]
pub fn rectangle(origin: DVec3, u: DVec3, v: DVec3) -> Faces {
    let positions = vec![origin, origin + u, origin + u + v, origin + v];
    (positions, vec![[0, 1, 2], [0, 2, 3]])
}

/// A box along the axes between two corners (in m, in any order), normals outward, or inward for a room.
#[must_use]
pub fn cuboid(min: DVec3, max: DVec3, inward: bool) -> Faces {
    let (min, max) = (min.min(max), min.max(max));
    // Corner number: bit 0 for x, bit 1 for y, bit 2 for z.
    let corner = |bits: u32| {
        let pick = |bit: u32, low: f64, high: f64| if bits >> bit & 1 == 1 { high } else { low };
        DVec3::new(
            pick(0, min.x, max.x),
            pick(1, min.y, max.y),
            pick(2, min.z, max.z),
        )
    };
    let sides = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    ((0..8).map(corner).collect(), turned(triangles, inward))
}

/// A disc as a regular polygon of the disc's exact area, its normal along `normal` (of any length but 0).
///
/// The corners lie at r √(2π / (n sin(2π/n))) from the centre, n being `segments` (3 at least), r the radius in m.
#[must_use]
pub fn disc(centre: DVec3, normal: DVec3, radius: f64, segments: u32) -> Faces {
    let segments = segments.max(3);
    let step = TAU / f64::from(segments);
    let reach = radius * (step / libm::sin(step)).sqrt();
    let (x, y) = across(normal.normalize_or_zero());
    let rim = (0..segments).map(|index| {
        let (sin, cos) = libm::sincos(step * f64::from(index));
        centre + reach * (cos * x + sin * y)
    });
    // Every second corner is cut off, again and again. A fan from the centre would put all boxes of its triangles over
    // one another, and every ray towards a lamp would have to test a dozen of them.
    let mut corners: Vec<u32> = (0..segments).collect();
    let mut triangles = Vec::new();
    while corners.len() > 2 {
        let ears = (1..corners.len()).step_by(2);
        triangles
            .extend(ears.map(|i| [corners[i - 1], corners[i], corners[(i + 1) % corners.len()]]));
        corners = corners.into_iter().step_by(2).collect();
    }
    (rim.collect(), triangles)
}

/// A sphere as an icosahedron whose faces are cut in four `subdivisions` times; all vertices lie on the sphere.
///
/// It has 20 · 4ˢ triangles; s is held to 10 at most. `centre` and `radius` in m; normals outward, or inward for a room.
#[must_use]
pub fn sphere(centre: DVec3, radius: f64, inward: bool, subdivisions: u32) -> Faces {
    let (mut points, mut triangles) = icosahedron();
    for _ in 0..subdivisions.min(10) {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to): (u32, u32)| {
                *middles
                    .entry((from.min(to), from.max(to)))
                    .or_insert_with(|| {
                        points.push((points[from as usize] + points[to as usize]).normalize());
                        u32::try_from(points.len() - 1).unwrap_or(u32::MAX)
                    })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let positions = points
        .iter()
        .map(|point| centre + radius * *point)
        .collect();
    (positions, turned(triangles, inward))
}

/// The regular icosahedron on the unit sphere, normals outward, two vertices on the Z axis.
fn icosahedron() -> Faces {
    // The rings lie at z = ±1/√5, their radius is 2/√5.
    let height = 0.2_f64.sqrt();
    let mut points = vec![DVec3::Z];
    for ring in 0..10_u32 {
        let (sin, cos) = libm::sincos(PI / 5.0 * f64::from(ring));
        let z = if ring % 2 == 0 { height } else { -height };
        points.push(DVec3::new(2.0 * height * cos, 2.0 * height * sin, z));
    }
    points.push(DVec3::NEG_Z);
    let at = |ring: u32| 1 + ring % 10;
    let triangles = (0..10)
        .step_by(2)
        .flat_map(|ring| {
            [
                [0, at(ring), at(ring + 2)],
                [at(ring), at(ring + 1), at(ring + 2)],
                [at(ring + 1), at(ring + 3), at(ring + 2)],
                [at(ring + 1), 11, at(ring + 3)],
            ]
        })
        .collect();
    (points, triangles)
}

fn turned(mut triangles: Vec<[u32; 3]>, turn: bool) -> Vec<[u32; 3]> {
    if turn {
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
    }
    triangles
}

/// Two unit vectors x, y with x × y along a unit vector: Duff et al., *Building an Orthonormal Basis, Revisited* (2017).
pub(crate) fn across(normal: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0_f64.copysign(normal.z);
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    (
        DVec3::new(
            1.0 + sign * normal.x * normal.x * a,
            sign * b,
            -sign * normal.x,
        ),
        DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use proptest::prelude::*;

    fn mesh((positions, triangles): Faces) -> Mesh {
        let mut mesh = Mesh::default();
        mesh.append(&positions, &triangles, 0, 0);
        mesh
    }

    fn area(mesh: &Mesh) -> f64 {
        (0..mesh.len())
            .map(|index| mesh.triangle(index).area())
            .sum()
    }

    /// Volume enclosed by outward normals (divergence theorem).
    fn volume(mesh: &Mesh) -> f64 {
        let cones = (0..mesh.len()).map(|index| {
            let [a, b, c] = mesh.triangle(index).vertices;
            a.dot(b.cross(c)) / 6.0
        });
        cones.sum()
    }

    #[test]
    fn a_rectangle_faces_along_u_cross_v() {
        let mesh = mesh(rectangle(DVec3::ONE, DVec3::X * 2.0, DVec3::Y * 3.0));
        assert!((area(&mesh) - 6.0).abs() < 1e-14);
        for index in 0..2 {
            assert!((mesh.triangle(index).normal() - DVec3::Z).length() < 1e-15);
        }
    }

    #[test]
    fn a_box_encloses_its_volume_and_a_room_the_opposite() {
        let (min, max) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 4.0, 6.0));
        for (inward, sign) in [(false, 1.0), (true, -1.0)] {
            let mesh = mesh(cuboid(max, min, inward));
            assert_eq!(mesh.len(), 12);
            assert!((area(&mesh) - 22.0).abs() < 1e-13);
            assert!((volume(&mesh) - sign * 6.0).abs() < 1e-13);
        }
    }

    #[test]
    fn a_sphere_has_its_vertices_on_it_and_converges_to_its_volume() {
        let centre = DVec3::new(0.3, -0.7, 2.0);
        let mut last = f64::INFINITY;
        for subdivisions in 0..6 {
            let (positions, triangles) = sphere(centre, 2.0, false, subdivisions);
            assert_eq!(triangles.len(), 20 << (2 * subdivisions));
            assert_eq!(positions.len(), (10 << (2 * subdivisions)) + 2);
            assert!(
                positions
                    .iter()
                    .all(|position| (position.distance(centre) - 2.0).abs() < 1e-15 * 4.0)
            );
            let lack = 1.0 - volume(&mesh((positions, triangles))) / (32.0 * PI / 3.0);
            assert!(lack > 0.0 && lack < last / 3.0);
            last = lack;
        }
        assert!(last < 2e-3);
    }

    #[test]
    fn a_sphere_turned_inward_encloses_the_opposite_volume() {
        let of = |inward| volume(&mesh(sphere(DVec3::ZERO, 1.0, inward, 2)));
        assert!((of(true) + of(false)).abs() < 1e-14);
    }

    proptest! {
        #[test]
        fn a_disc_has_the_exact_area_and_normal(
            x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0, radius in 1e-3..1e3, segments in 3_u32..200,
        ) {
            let normal = DVec3::new(x, y, z);
            prop_assume!(normal.length() > 1e-3);
            let mesh = mesh(disc(DVec3::ONE, normal, radius, segments));
            prop_assert!((area(&mesh) / (PI * radius * radius) - 1.0).abs() < 1e-12);
            for index in 0..mesh.len() {
                prop_assert!(mesh.triangle(index).normal().distance(normal.normalize()) < 1e-9);
            }
        }
    }
}
