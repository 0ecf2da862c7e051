//! The largest flat patches of a mesh, as polygons in their planes.

use crate::Surfaces;
use crate::patches::Patches;
use crate::shape::across;
use glam::{DVec2, DVec3};

/// Corners of the longest hull that is kept; a rounder one is replaced by its rectangle.
const CORNERS: usize = 8;

/// Edges of a polygon along which a rectangle about it is tried: of a disc every one is as good.
const SIDES: usize = 16;

/// A flat patch of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Unit normal of its plane, that of its largest triangle.
    pub normal: DVec3,
    /// Distance of the plane from the origin along the normal, in m.
    pub height: f64,
    /// Corners of a convex polygon in the plane that holds the patch, in order, in m.
    pub hull: Vec<DVec3>,
    /// Area of the triangles of the patch, in m².
    pub area: f64,
    /// Its largest triangle.
    pub triangle: u32,
    /// Centre of the hull and square of the distance of its farthest corner, in m and m².
    centre: (DVec3, f64),
    /// Normals in the plane, inwards across each edge of the hull, and the edges' heights along them.
    edges: Vec<(DVec3, f64)>,
}

/// The largest flat patches among some of the triangles of a mesh.
#[derive(Debug, Clone, Default)]
pub struct Facets {
    list: Vec<Facet>,
    /// One more than the patch that each triangle belongs to, 0 for none; empty where there is no patch.
    of: Vec<u16>,
}

impl Facet {
    /// A ball about the hull: its centre and the square of its radius, in m and m².
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        self.centre
    }

    /// Height of a point over the plane, in m.
    #[must_use]
    #[inline]
    pub fn above(&self, point: DVec3) -> f64 {
        point.dot(self.normal) - self.height
    }

    /// The point mirrored in the plane.
    #[must_use]
    #[inline]
    pub fn image(&self, point: DVec3) -> DVec3 {
        point - self.normal * (2.0 * self.above(point))
    }

    /// The direction mirrored in the plane.
    #[must_use]
    #[inline]
    pub fn mirrored(&self, direction: DVec3) -> DVec3 {
        direction - self.normal * (2.0 * direction.dot(self.normal))
    }

    /// The share of the way along `span` from `origin` at which the plane is crossed, where that lies in the hull.
    #[must_use]
    #[inline]
    pub fn crossing(&self, origin: DVec3, span: DVec3) -> Option<f64> {
        let (depth, along) = (self.height - origin.dot(self.normal), span.dot(self.normal));
        // Most facets lie behind.
        if depth * along <= 0.0 {
            return None;
        }
        let share = depth / along;
        if !share.is_finite() {
            return None;
        }
        let point = origin + span * share;
        let (centre, reach) = self.centre;
        if point.distance_squared(centre) > reach {
            return None;
        }
        let inside = |&(inward, height): &(DVec3, f64)| point.dot(inward) >= height;
        self.edges.iter().all(inside).then_some(share)
    }
}

impl Facets {
    /// The `most` largest of the patches whose surface is `wanted`, none smaller than `least` (in m²).
    #[must_use]
    pub fn new(
        surfaces: &Surfaces,
        patches: &Patches,
        wanted: impl Fn(u32) -> bool,
        least: f64,
        most: usize,
    ) -> Self {
        let mut chosen: Vec<(f64, &[u32])> = patches
            .iter()
            .filter(|&(area, patch)| area >= least && wanted(surfaces.surface(patch[0])))
            .collect();
        if chosen.is_empty() {
            return Self::default();
        }
        chosen.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1[0].cmp(&b.1[0])));
        chosen.truncate(most.min(usize::from(u16::MAX) - 1));
        let mut of = vec![0; surfaces.len()];
        // The last patch that has used each vertex.
        let mut used = vec![0; surfaces.mesh().positions.len()];
        let mut list = Vec::with_capacity(chosen.len());
        for (number, (area, patch)) in (1..).zip(chosen) {
            for &triangle in patch {
                of[triangle as usize] = number;
            }
            let normal = surfaces.normal(patch[0]);
            let corners = patch
                .iter()
                .flat_map(|&triangle| surfaces.mesh().triangles[triangle as usize]);
            let mut first_use =
                |vertex: &u32| std::mem::replace(&mut used[*vertex as usize], number) != number;
            let origin = surfaces.triangle(patch[0]).vertices[0];
            let corners = corners
                .filter(|vertex| first_use(vertex))
                .map(|vertex| surfaces.mesh().positions[vertex as usize]);
            let hull = hull(corners, origin, normal);
            list.push(Facet {
                normal,
                height: origin.dot(normal),
                centre: ball(&hull),
                edges: edges(&hull, normal),
                hull,
                area,
                triangle: patch[0],
            });
        }
        Self { list, of }
    }

    /// The patches, the largest first.
    #[must_use]
    pub fn list(&self) -> &[Facet] {
        &self.list
    }

    /// The patch that a triangle belongs to.
    #[must_use]
    #[inline]
    pub fn of(&self, triangle: u32) -> Option<u32> {
        let number = *self.of.get(triangle as usize)?;
        u32::from(number).checked_sub(1)
    }
}

/// A convex polygon in the plane across `normal` through `origin` that holds the points, anticlockwise about the normal.
fn hull(points: impl Iterator<Item = DVec3>, origin: DVec3, normal: DVec3) -> Vec<DVec3> {
    let (mut corners, lifted) = flat_hull(points, origin, normal);
    if corners.len() > CORNERS {
        corners = rectangle(&corners).to_vec();
    }
    corners.into_iter().map(lifted).collect()
}

/// The convex hull of points in the plane across `normal` through `origin`, anticlockwise, and what lifts it back there.
fn flat_hull(
    points: impl Iterator<Item = DVec3>,
    origin: DVec3,
    normal: DVec3,
) -> (Vec<DVec2>, impl Fn(DVec2) -> DVec3) {
    let (x, y) = across(normal);
    let flat = points.map(|v| DVec2::new((v - origin).dot(x), (v - origin).dot(y)));
    let corners = convex(outermost(flat.collect()));
    (corners, move |p| origin + x * p.x + y * p.y)
}

/// The smallest rectangle that holds points (some at least) of one plane, anticlockwise about its normal.
pub(crate) fn rectangle_about(points: &[DVec3], normal: DVec3) -> [DVec3; 4] {
    let (corners, lifted) = flat_hull(points.iter().copied(), points[0], normal);
    rectangle(&corners).map(lifted)
}

/// A ball about a polygon: its centre and the square of its radius.
fn ball(hull: &[DVec3]) -> (DVec3, f64) {
    let centre = hull.iter().sum::<DVec3>() / hull.len() as f64;
    let squares = hull.iter().map(|corner| corner.distance_squared(centre));
    // A little larger, so that rounding leaves no corner outside.
    (centre, squares.fold(0.0, f64::max) * (1.0 + 1e-9))
}

/// Inward normals of the edges of a polygon that runs anticlockwise about `normal`, with the edges' heights along them.
fn edges(hull: &[DVec3], normal: DVec3) -> Vec<(DVec3, f64)> {
    let next = hull.iter().cycle().skip(1);
    let edge = |(&from, &to): (&DVec3, &DVec3)| {
        let inward = normal.cross(to - from).normalize();
        (inward, from.dot(inward))
    };
    hull.iter().zip(next).map(edge).collect()
}

/// Without the points that lie surely inside the others' convex hull: within the polygon of those that lie farthest
/// in eight directions (Akl and Toussaint 1978).
fn outermost(mut points: Vec<DVec2>) -> Vec<DVec2> {
    const ROUND: [DVec2; 8] = [
        DVec2::new(1.0, 0.0),
        DVec2::new(1.0, 1.0),
        DVec2::new(0.0, 1.0),
        DVec2::new(-1.0, 1.0),
        DVec2::new(-1.0, 0.0),
        DVec2::new(-1.0, -1.0),
        DVec2::new(0.0, -1.0),
        DVec2::new(1.0, -1.0),
    ];
    let mut farthest = [points[0]; 8];
    for point in &points {
        for (far, way) in farthest.iter_mut().zip(ROUND) {
            if point.dot(way) > far.dot(way) {
                *far = *point;
            }
        }
    }
    let next = farthest.iter().cycle().skip(1);
    let sides: Vec<(DVec2, DVec2)> = farthest
        .iter()
        .zip(next)
        .filter(|(from, to)| from != to)
        .map(|(from, to)| (*from, to - from))
        .collect();
    let inside = |point: &DVec2| {
        sides
            .iter()
            .all(|(from, side)| side.perp_dot(point - from) > 0.0)
    };
    points.retain(|point| sides.is_empty() || !inside(point));
    points
}

/// The convex hull of points, anticlockwise (Andrew's monotone chain).
fn convex(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., before, last] = chain[..] {
                if (last - before).perp_dot(point - last) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}

/// The smallest rectangle about a convex polygon that has a side along one of its longest edges.
fn rectangle(corners: &[DVec2]) -> [DVec2; 4] {
    let next = corners.iter().cycle().skip(1);
    let mut edges: Vec<DVec2> = corners.iter().zip(next).map(|(a, &b)| b - a).collect();
    edges.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    edges.truncate(SIDES);
    let about = |edge: DVec2| {
        let along = edge.normalize();
        let extent = |axis: DVec2| {
            let heights = corners.iter().map(|p| p.dot(axis));
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| {
                (low.min(h), high.max(h))
            })
        };
        (along, extent(along), extent(along.perp()))
    };
    let area = |&(_, x, y): &(DVec2, (f64, f64), (f64, f64))| (x.1 - x.0) * (y.1 - y.0);
    let best = edges
        .into_iter()
        .map(about)
        .min_by(|a, b| area(a).total_cmp(&area(b)));
    let (along, (left, right), (bottom, top)) = best.unwrap_or_default();
    [(left, bottom), (right, bottom), (right, top), (left, top)]
        .map(|(x, y)| along * x + along.perp() * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesh, shape};

    fn surfaces(parts: &[(Vec<DVec3>, Vec<[u32; 3]>)]) -> Surfaces {
        let mut mesh = Mesh::default();
        for (object, (positions, triangles)) in (0..).zip(parts) {
            mesh.append(positions, triangles, 0, object);
        }
        Surfaces::new(mesh).unwrap()
    }

    #[test]
    fn a_box_has_six_patches_of_two_triangles() {
        let room = surfaces(&[shape::cuboid(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0), true)]);
        let facets = Facets::new(&room, room.patches(), |_| true, 0.0, 64);
        let areas: Vec<f64> = facets.list().iter().map(|f| f.area).collect();
        assert_eq!(areas, [6.0, 6.0, 3.0, 3.0, 2.0, 2.0]);
        for facet in facets.list() {
            assert_eq!(facet.hull.len(), 4);
            assert_eq!(
                facets
                    .of(facet.triangle)
                    .map(|f| &facets.list()[f as usize]),
                Some(facet)
            );
        }
        assert!((0..12).all(|t| facets.of(t).is_some()));
    }

    #[test]
    fn patches_stay_small_in_number_and_large_in_size() {
        let room = surfaces(&[shape::cuboid(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0), true)]);
        assert_eq!(
            Facets::new(&room, room.patches(), |_| true, 2.5, 64)
                .list()
                .len(),
            4
        );
        let two = Facets::new(&room, room.patches(), |_| true, 0.0, 2);
        assert_eq!(two.list().len(), 2);
        assert_eq!((0..12).filter(|&t| two.of(t).is_some()).count(), 4);
        let none = Facets::new(&room, room.patches(), |_| false, 0.0, 64);
        assert!(none.list().is_empty() && none.of(3).is_none());
    }

    #[test]
    fn a_round_patch_lies_in_the_square_about_it() {
        let disc = surfaces(&[shape::disc(DVec3::Z, DVec3::Z, 1.0, 128)]);
        let facets = Facets::new(&disc, disc.patches(), |_| true, 0.0, 64);
        let [facet] = facets.list() else {
            panic!("one patch");
        };
        assert_eq!(facet.hull.len(), 4);
        let hit = facet.crossing(DVec3::new(0.9, 0.0, 3.0), DVec3::NEG_Z * 4.0);
        assert!(hit.is_some_and(|share| (share - 0.5).abs() < 1e-12));
        assert_eq!(facet.crossing(DVec3::new(0.9, 0.0, 3.0), DVec3::Z), None);
        assert_eq!(
            facet.crossing(DVec3::new(1.7, 0.0, 3.0), DVec3::NEG_Z),
            None
        );
        let image = facet.image(DVec3::new(0.1, 0.2, 3.0));
        assert!(image.distance(DVec3::new(0.1, 0.2, -1.0)) < 1e-12);
    }
}
