//! Closed solids, and which points lie inside them.

use crate::edges::{self, Pieces};
use crate::surfaces::tolerance;
use crate::weld::weld;
use crate::{Mesh, clean};
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// All closed solids of a mesh.
#[derive(Debug, Clone, Default)]
pub struct Solids<'a>(Vec<Solid<'a>>);

/// A part of an object without gaps: every edge joins an even number of triangles.
///
/// A room seen from inside is one too, if it is a single object.
#[derive(Debug, Clone)]
pub struct Solid<'a> {
    mesh: &'a Mesh,
    object: u32,
    indices: Vec<u32>,
    /// Which triangles are wound against the greater part of the area.
    turned: Vec<bool>,
    min: DVec3,
    max: DVec3,
}

impl<'a> Solids<'a> {
    /// Finds the solids of a mesh: within each object the parts that hang together by edges, vertices within the
    /// [tolerance](crate::Surfaces::tolerance) taken as one. A mesh that [`Surfaces::new`](crate::Surfaces::new)
    /// refuses has none.
    #[must_use]
    pub fn of(mesh: &'a Mesh) -> Self {
        if clean::check(mesh).is_err() {
            return Self::default();
        }
        let (centre, radius) = clean::bounding_sphere(mesh);
        let mut dropped = vec![false; mesh.len()];
        for index in clean::waste(mesh, clean::slack(centre, radius)).indices() {
            dropped[index as usize] = true;
        }
        let tolerance = tolerance(centre, radius);
        Self::among(
            mesh,
            &weld(mesh, &mesh.triangles, tolerance),
            tolerance,
            |triangle| !dropped[triangle as usize],
        )
    }

    /// The same among some of the triangles, with vertices welded already.
    pub(crate) fn among(
        mesh: &'a Mesh,
        welded: &[u32],
        tolerance: f64,
        wanted: impl Fn(u32) -> bool,
    ) -> Self {
        let uses = edges::uses(mesh, welded, wanted, |triangle| {
            mesh.objects[triangle as usize]
        });
        let uses = edges::split_at_junctions(mesh, uses, tolerance);
        let mut pieces = Pieces::new(mesh.len());
        for edge in edges::by_edge(&uses) {
            for pair in edge.windows(2) {
                // Two faces of a solid run along their edge in opposite senses.
                pieces.join(
                    pair[0].triangle,
                    pair[1].triangle,
                    edge.len() == 2 && pair[0].forward == pair[1].forward,
                );
            }
        }
        let mut parts: BTreeMap<u32, Option<Vec<(u32, bool)>>> = BTreeMap::new();
        for edge in edges::by_edge(&uses) {
            if edge.len() % 2 == 1 {
                parts.insert(pieces.find(edge[0].triangle).0, None);
            }
        }
        let mut members: Vec<u32> = uses.iter().map(|entry| entry.triangle).collect();
        members.sort_unstable();
        members.dedup();
        for triangle in members {
            let (root, turned) = pieces.find(triangle);
            if let Some(part) = parts.entry(root).or_insert_with(|| Some(Vec::new())) {
                part.push((triangle, turned));
            }
        }
        let closed = parts.into_values().flatten();
        Self(closed.map(|part| Solid::new(mesh, &part)).collect())
    }

    /// The solids in the order of their first triangles.
    pub fn iter(&self) -> std::slice::Iter<'_, Solid<'a>> {
        self.0.iter()
    }

    /// Number of solids.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a point (in m) lies inside any of them.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.0.iter().any(|solid| solid.contains(point))
    }
}

impl<'s, 'a> IntoIterator for &'s Solids<'a> {
    type Item = &'s Solid<'a>;
    type IntoIter = std::slice::Iter<'s, Solid<'a>>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a> Solid<'a> {
    fn new(mesh: &'a Mesh, part: &[(u32, bool)]) -> Self {
        let area_of = |sense: bool| -> f64 {
            part.iter()
                .filter(|&&(_, turned)| turned == sense)
                .map(|&(triangle, _)| mesh.triangle(triangle as usize).area())
                .sum()
        };
        let sense = area_of(true) > area_of(false);
        let corners = || {
            part.iter()
                .flat_map(|&(triangle, _)| mesh.triangle(triangle as usize).vertices)
        };
        Self {
            mesh,
            object: mesh.objects[part[0].0 as usize],
            indices: part.iter().map(|&(triangle, _)| triangle).collect(),
            turned: part.iter().map(|&(_, turned)| turned != sense).collect(),
            min: corners().fold(DVec3::INFINITY, DVec3::min),
            max: corners().fold(DVec3::NEG_INFINITY, DVec3::max),
        }
    }

    /// Corners of its triangles, all wound alike.
    fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.indices
            .iter()
            .zip(&self.turned)
            .map(|(&index, &turned)| {
                let [a, b, c] = self.mesh.triangle(index as usize).vertices;
                if turned { [a, c, b] } else { [a, b, c] }
            })
    }

    /// Index of the object it belongs to.
    #[must_use]
    pub fn object(&self) -> u32 {
        self.object
    }

    /// Its triangles by their indices in the mesh, ascending.
    #[must_use]
    pub fn triangles(&self) -> &[u32] {
        &self.indices
    }

    /// Lower and upper corner of its box, in m.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        (self.min, self.max)
    }

    /// Signed volume in m³: negative where the normals point inward, as in a room.
    ///
    /// V = Σ a · (b × c) / 6 over the triangles, taken from the box's centre.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let centre = 0.5 * (self.min + self.max);
        let cones = self.corners().map(|corners| {
            let [a, b, c] = corners.map(|vertex| vertex - centre);
            a.dot(b.cross(c)) / 6.0
        });
        cones.sum()
    }

    /// Whether a point (in m) lies inside: generalised winding number w = Σ Ω / 4π, |w| ≥ ½, Ω being the signed solid
    /// angle of each triangle (Van Oosterom and Strackee 1983).
    ///
    /// Exact but for points within rounding of the surface.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        if point.cmplt(self.min).any() || point.cmpgt(self.max).any() {
            return false;
        }
        let half_angles: f64 = self
            .corners()
            .map(|corners| {
                let [a, b, c] = corners.map(|vertex| vertex - point);
                let [la, lb, lc] = [a.length(), b.length(), c.length()];
                let above = a.dot(b.cross(c));
                let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
                libm::atan2(above, below)
            })
            .sum();
        half_angles.abs() >= 0.5 * TAU
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape;

    fn mesh(parts: &[shape::Faces]) -> Mesh {
        let mut mesh = Mesh::default();
        for (object, (positions, triangles)) in (0..).zip(parts) {
            mesh.append(positions, triangles, 0, object);
        }
        mesh
    }

    #[test]
    fn a_box_contains_its_inside_and_a_rectangle_contains_nothing() {
        let mesh = mesh(&[
            shape::rectangle(DVec3::ZERO, DVec3::X * 9.0, DVec3::Y * 9.0),
            shape::cuboid(DVec3::ONE, DVec3::splat(3.0), false),
            shape::cuboid(DVec3::ZERO, DVec3::splat(9.0), true),
        ]);
        let solids = Solids::of(&mesh);
        assert_eq!(solids.len(), 2);
        let [body, room] = [&solids.0[0], &solids.0[1]];
        assert_eq!((body.object(), room.object()), (1, 2));
        assert!((body.volume() - 8.0).abs() < 1e-12);
        assert!((room.volume() + 729.0).abs() < 1e-9);
        assert_eq!(body.triangles(), (2..14).collect::<Vec<_>>());
        for (point, in_body, in_room) in [
            (DVec3::splat(2.0), true, true),
            (DVec3::new(1.5, 2.0, 2.999), true, true),
            (DVec3::new(1.5, 2.0, 3.001), false, true),
            (DVec3::splat(5.0), false, true),
            (DVec3::new(5.0, 5.0, 9.001), false, false),
        ] {
            assert_eq!(body.contains(point), in_body, "{point}");
            assert_eq!(room.contains(point), in_room, "{point}");
        }
    }

    #[test]
    fn a_sphere_contains_what_is_nearer_than_its_facets() {
        let centre = DVec3::new(10.0, -4.0, 0.5);
        let mesh = mesh(&[shape::sphere(centre, 2.0, false, 3)]);
        let solids = Solids::of(&mesh);
        let (directions, _) = shape::sphere(DVec3::ZERO, 1.0, false, 2);
        for direction in directions {
            assert!(solids.contains(centre + 1.97 * direction));
            assert!(!solids.contains(centre + 2.001 * direction));
        }
    }

    #[test]
    fn a_box_with_a_face_missing_is_no_solid() {
        let (positions, mut triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, false);
        triangles.pop();
        let mesh = mesh(&[(positions, triangles)]);
        assert!(Solids::of(&mesh).is_empty());
    }

    #[test]
    fn a_face_wound_the_wrong_way_does_not_open_a_solid() {
        let (positions, mut triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, false);
        triangles[5].swap(0, 1);
        let mesh = mesh(&[(positions, triangles)]);
        let solids = Solids::of(&mesh);
        assert!(solids.contains(DVec3::splat(0.5)));
        assert!((solids.0[0].volume() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_solid_may_have_separate_vertices_for_each_face_and_long_edges_along_short_ones() {
        // Five sides of a box, and a lid in two strips across its long edges.
        let side = |origin: [f64; 3], u: DVec3, v: DVec3| shape::rectangle(origin.into(), u, v);
        let sides = [
            side([0.0, 0.0, 0.0], DVec3::Y, DVec3::X),
            side([0.0, 0.0, 0.0], DVec3::X, DVec3::Z),
            side([0.0, 1.0, 0.0], DVec3::Z, DVec3::X),
            side([0.0, 0.0, 0.0], DVec3::Z, DVec3::Y),
            side([1.0, 0.0, 0.0], DVec3::Y, DVec3::Z),
            side([0.0, 0.0, 1.0], DVec3::X * 0.3, DVec3::Y),
            side([0.3, 0.0, 1.0], DVec3::X * 0.7, DVec3::Y),
        ];
        let mut mesh = Mesh::default();
        for (positions, triangles) in sides {
            mesh.append(&positions, &triangles, 0, 0);
        }
        let solids = Solids::of(&mesh);
        assert_eq!(solids.len(), 1);
        assert!((solids.0[0].volume() - 1.0).abs() < 1e-14);
        assert!(solids.contains(DVec3::new(0.3, 0.5, 0.999)));
    }
}
