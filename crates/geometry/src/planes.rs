//! The planes that all surfaces lie in, where they are few: points on one side of each see each other.

use crate::{Mesh, Triangle};
use glam::DVec3;

/// Most planes that are kept: beyond, asking for all of them costs as much as a ray.
const MOST: usize = 16;

/// Planes that all triangles of a scene lie in; none where they are too many.
#[derive(Debug, Default)]
pub(crate) struct Planes {
    /// Unit normal and height of each, in m.
    planes: Vec<(DVec3, f64)>,
    /// Within this distance of a plane a point is on neither side, in m.
    margin: f64,
}

impl Planes {
    /// The planes of a mesh whose triangles are thicker by `slack` for rays.
    ///
    /// A triangle belongs to a plane if it is nowhere further from it than a quarter of the slack. With the slack itself
    /// and the rounding of a crossing it blocks nothing that stays two slacks off the plane.
    pub fn of(mesh: &Mesh, slack: f64) -> Self {
        let mut planes: Vec<(DVec3, f64)> = Vec::new();
        for index in 0..mesh.len() {
            let triangle = mesh.triangle(index);
            let within = |plane: &(DVec3, f64)| holds(plane, &triangle, slack);
            // Neighbours in the file mostly lie in the plane found last.
            if planes.iter().rev().any(within) {
                continue;
            }
            let normal = triangle.normal();
            let own = (normal, normal.dot(triangle.vertices[0]));
            if planes.len() == MOST || !within(&own) {
                return Self::default();
            }
            planes.push(own);
        }
        Self {
            planes,
            margin: 2.0 * slack,
        }
    }

    /// Whether there are few enough of them.
    pub fn are_known(&self) -> bool {
        !self.planes.is_empty()
    }

    /// On which side of each plane a point (in m) lies, one bit a plane; `None` where it is too near to one, or where the
    /// planes are not known.
    #[inline]
    pub fn sides(&self, point: DVec3) -> Option<u32> {
        if self.planes.is_empty() {
            return None;
        }
        let mut sides = 0;
        for &(normal, height) in &self.planes {
            let off = normal.dot(point) - height;
            // Not a number where the point is none.
            if off.is_nan() || off.abs() < self.margin {
                return None;
            }
            sides = sides << 1 | u32::from(off > 0.0);
        }
        Some(sides)
    }

    /// Unit normals of all planes on the side of a point (in m) that no part of the mesh lies behind; `None` where there is
    /// no such point.
    pub fn walls(&self, mesh: &Mesh, point: DVec3) -> Option<Vec<DVec3>> {
        self.sides(point)?;
        let toward = |&(normal, height): &(DVec3, f64)| {
            let side = (normal.dot(point) - height).signum();
            let behind = |index| {
                let vertices = mesh.triangle(index).vertices;
                let off = |vertex: DVec3| side * (normal.dot(vertex) - height);
                vertices.iter().any(|&vertex| off(vertex) < -self.margin)
            };
            (!(0..mesh.len()).any(behind)).then_some(normal * side)
        };
        self.planes.iter().map(toward).collect()
    }

    /// The plane that a triangle of the mesh lies in.
    pub fn of_triangle(&self, triangle: &Triangle) -> Option<usize> {
        let slack = 0.5 * self.margin;
        let within = |plane: &(DVec3, f64)| holds(plane, triangle, slack);
        // As they were found, the last first.
        self.planes.iter().rposition(within)
    }
}

/// Whether a triangle lies in a plane where triangles are thicker by `slack` for rays.
fn holds(&(normal, height): &(DVec3, f64), triangle: &Triangle, slack: f64) -> bool {
    let off = |vertex: DVec3| (normal.dot(vertex) - height).abs();
    triangle
        .vertices
        .iter()
        .all(|&vertex| off(vertex) <= 0.25 * slack)
}

#[cfg(test)]
mod tests {
    use crate::testing::{Uniform, cube, surfaces};
    use crate::{Layout, Preset, shape};
    use glam::DVec3;

    #[test]
    fn points_of_an_empty_convex_room_lie_on_one_side_of_everything() {
        let mut room = cube(DVec3::ZERO, 1.0, 40);
        room.exchange(room.tree(Layout::List, Preset::Medium));
        let mut uniform = Uniform(1);
        for _ in 0..1000 {
            let mut inside = || (1.0 - 1e-9) * uniform.point();
            let (from, to) = (inside(), inside());
            assert_eq!(room.planes_sides(from), room.planes_sides(to));
            assert!(room.planes_sides(from).is_some());
            assert!(room.visible(from, to));
        }
        let on_wall = DVec3::new(0.5, 0.1, 0.2);
        assert_eq!(room.planes_sides(on_wall), None);
        assert_ne!(
            room.planes_sides(DVec3::splat(0.25)),
            room.planes_sides(DVec3::splat(0.75))
        );
    }

    #[test]
    fn planes_are_known_of_few_and_of_those_of_everything() {
        let side = |parts: &[shape::Faces]| surfaces(parts).planes_sides(DVec3::splat(0.3));
        let room = shape::cuboid(DVec3::ZERO, DVec3::ONE, true);
        let block = shape::cuboid(DVec3::splat(0.5), DVec3::splat(0.6), false);
        let ball = shape::sphere(DVec3::splat(0.5), 0.1, false, 1);
        assert!(side(&[room.clone(), block]).is_some());
        assert_eq!(side(&[room, ball]), None);
        assert_eq!(side(&[]), None);
    }
}
