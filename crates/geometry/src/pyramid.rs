//! What stands between a point and a polygon.

use crate::Surfaces;
use glam::DVec3;

/// The pyramid over a convex polygon.
struct Pyramid<'a> {
    apex: DVec3,
    corners: &'a [DVec3],
    /// Inward unit normals of its sides and its base, with their heights in m.
    planes: Vec<(DVec3, f64)>,
}

impl<'a> Pyramid<'a> {
    /// `None` where the apex lies in the plane of the polygon.
    fn new(apex: DVec3, corners: &'a [DVec3]) -> Option<Self> {
        let next = || corners.iter().cycle().skip(1);
        let area: DVec3 = corners
            .iter()
            .zip(next())
            .map(|(&a, &b)| (a - corners[0]).cross(b - corners[0]))
            .sum();
        let base = area.try_normalize()?;
        let height = corners[0].dot(base);
        let above = apex.dot(base) - height;
        if above.abs() <= 0.0 {
            return None;
        }
        // The base faces the apex from here on.
        let side = above.signum();
        let mut planes = vec![(base * side, height * side)];
        for (&a, &b) in corners.iter().zip(next()) {
            // Anticlockwise about the base as the apex sees it, so to the left of every edge is inside.
            let inward = ((b - apex).cross(a - apex) * side).try_normalize()?;
            planes.push((inward, apex.dot(inward)));
        }
        Some(Self {
            apex,
            corners,
            planes,
        })
    }

    /// Whether one of its planes has a box, given by two corners, wholly outside.
    fn misses_box(&self, least: DVec3, most: DVec3) -> bool {
        self.planes.iter().any(|&(inward, height)| {
            let farthest = DVec3::select(inward.cmpge(DVec3::ZERO), most, least);
            farthest.dot(inward) < height
        })
    }

    /// Whether a plane keeps a triangle apart from it: its base to within `tolerance`, or to within `slack` (both in m)
    /// one of its sides or the triangle's own.
    fn misses(&self, triangle: &[DVec3; 3], slack: f64, tolerance: f64) -> bool {
        let outside = |&(inward, height): &(DVec3, f64), thickness| {
            triangle.iter().all(|v| v.dot(inward) <= height + thickness)
        };
        let [base, sides @ ..] = self.planes.as_slice() else {
            return false;
        };
        if outside(base, tolerance) || sides.iter().any(|side| outside(side, slack)) {
            return true;
        }
        let [a, b, c] = *triangle;
        let Some(normal) = (b - a).cross(c - a).try_normalize() else {
            return false;
        };
        let heights = || {
            let points = self.corners.iter().chain([&self.apex]);
            points.map(|&p| (p - a).dot(normal))
        };
        heights().all(|h| h >= -slack) || heights().all(|h| h <= slack)
    }
}

impl Surfaces {
    /// The triangles that may hide something of a flat convex polygon from `apex` (in m), whichever side of it that lies
    /// on; `None` where there are more than `most` of them, or the apex lies in the polygon's plane.
    ///
    /// What lies within [`tolerance`](Self::tolerance) of the polygon's plane or touches the pyramid from outside does not
    /// count. Where there is none, every point of the polygon is seen; where there are some, all may be seen nevertheless:
    /// triangles are told apart from the pyramid by the planes of either.
    #[must_use]
    pub fn before(&self, apex: DVec3, corners: &[DVec3], most: usize) -> Option<Vec<u32>> {
        let pyramid = Pyramid::new(apex, corners)?;
        if self.share_a_cell(apex, &pyramid) {
            return Some(Vec::new());
        }
        let (slack, tolerance) = (self.slack(), self.tolerance());
        let mut found = Vec::new();
        let complete = self.boxes().all(
            |least, most| !pyramid.misses_box(least, most),
            |triangle| {
                if !pyramid.misses(&self.triangle(triangle).vertices, slack, tolerance) {
                    found.push(triangle);
                }
                found.len() <= most
            },
        );
        // The same in every tree.
        found.sort_unstable();
        complete.then_some(found)
    }

    /// Whether the apex and the polygon, but for where it touches a surface, lie in one cell, in which all see each other.
    fn share_a_cell(&self, apex: DVec3, pyramid: &Pyramid) -> bool {
        let Some(cell) = self.cell(apex) else {
            return false;
        };
        let (base, _) = pyramid.planes[0];
        let off = |&corner: &DVec3| corner + base * self.offset();
        let corners = pyramid.corners.iter();
        corners
            .map(off)
            .all(|corner| self.cell(corner) == Some(cell))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Uniform;
    use crate::{Mesh, shape};

    const SQUARE: [DVec3; 4] = [
        DVec3::new(0.4, 0.4, 1.0),
        DVec3::new(0.6, 0.4, 1.0),
        DVec3::new(0.6, 0.6, 1.0),
        DVec3::new(0.4, 0.6, 1.0),
    ];

    fn sees_whole(room: &Surfaces, apex: DVec3, corners: &[DVec3]) -> bool {
        room.before(apex, corners, 0).is_some()
    }

    /// The unit cube seen from inside, with a small box in it.
    fn room(least: DVec3, most: DVec3) -> Surfaces {
        let mut mesh = Mesh::default();
        for (object, (least, most, inward)) in
            (0..).zip([(DVec3::ZERO, DVec3::ONE, true), (least, most, false)])
        {
            let (positions, triangles) = shape::cuboid(least, most, inward);
            mesh.append(&positions, &triangles, object, object);
        }
        Surfaces::new(mesh).unwrap()
    }

    #[test]
    fn a_lamp_in_the_ceiling_is_seen_past_a_box_beside_the_way_and_not_behind_one_in_it() {
        let floor = DVec3::new(0.5, 0.5, 1e-9);
        let beside = room(DVec3::new(0.61, 0.2, 0.0), DVec3::new(0.9, 0.8, 1.0));
        assert!(sees_whole(&beside, floor, &SQUARE));
        let within = room(DVec3::new(0.52, 0.2, 0.4), DVec3::new(0.9, 0.8, 0.6));
        assert!(!sees_whole(&within, floor, &SQUARE));
        // A thread across the pyramid, no corner of it inside.
        let thread = room(DVec3::new(0.1, 0.5, 0.5), DVec3::new(0.9, 0.500_1, 0.500_1));
        assert!(!sees_whole(&thread, floor, &SQUARE));
        let reversed: Vec<DVec3> = SQUARE.into_iter().rev().collect();
        assert!(sees_whole(&beside, floor, &reversed) && !sees_whole(&within, floor, &reversed));
    }

    #[test]
    fn in_an_empty_room_all_is_seen_whole_but_what_lies_outside() {
        let mut mesh = Mesh::default();
        let (positions, triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, true);
        mesh.append(&positions, &triangles, 0, 0);
        let empty = Surfaces::new(mesh).unwrap();
        let floor = DVec3::new(0.5, 0.5, 1e-9);
        assert!(empty.cell(floor).is_some());
        assert!(sees_whole(&empty, floor, &SQUARE));
        // From above the ceiling, and half of it behind a wall.
        assert!(sees_whole(&empty, DVec3::new(0.5, 0.5, 2.0), &SQUARE));
        let beyond = SQUARE.map(|corner| corner + 0.5 * DVec3::X);
        assert!(!sees_whole(&empty, floor, &beyond));
        // The floor from above the ceiling.
        let below = SQUARE.map(|corner| corner - DVec3::Z);
        assert!(!sees_whole(&empty, DVec3::new(0.5, 0.5, 2.0), &below));
    }

    #[test]
    fn what_is_seen_whole_is_seen_in_every_point() {
        let mut uniform = Uniform(7);
        let (mut whole, mut part) = (0, 0);
        for _ in 0..300 {
            let corner = DVec3::splat(0.1) + 0.8 * uniform.point().abs();
            let room = room(corner, corner + 0.05 + 0.2 * uniform.point().abs());
            let apex = DVec3::new(uniform.next(), uniform.next(), 0.01 * uniform.next());
            let seen = |_: i32| {
                let [u, v] = [uniform.next(), uniform.next()].map(|x| 0.4 + 0.2 * x);
                room.visible(apex, DVec3::new(u, v, 1.0 - 1e-9))
            };
            let all = (0..200).map(seen).filter(|&s| s).count() == 200;
            if sees_whole(&room, apex, &SQUARE) {
                whole += 1;
                assert!(all, "{apex} sees no whole square past {corner}");
            } else if !all {
                part += 1;
            }
        }
        assert!(
            whole > 100 && part > 20,
            "{whole} seen whole, {part} in part"
        );
    }

    #[test]
    fn a_point_in_the_plane_of_a_polygon_sees_nothing_of_it() {
        let room = room(DVec3::splat(0.1), DVec3::splat(0.2));
        assert!(!sees_whole(&room, DVec3::new(0.2, 0.5, 1.0), &SQUARE));
    }
}
