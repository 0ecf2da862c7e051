//! A square lattice of sensor points on a flat object, along its longest edge.

use super::{Layout, SensorPoint};
use crate::reader::unit;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// How far vertices may lie off the plane of an object that counts as flat, as a share of its size.
const FLATNESS: f64 = 1e-4;

/// The largest number of points in a lattice.
const MOST_POINTS: f64 = 1e7;

/// A lattice over flat `triangles`, `spacing` metres apart, centred on them, its rows along the longest outer edge.
///
/// Where every point of the rectangle around the triangles lies on one of them the layout is a grid.
/// The error is what the triangles lack.
pub(super) fn lattice(
    triangles: &[[DVec3; 3]],
    spacing: f64,
) -> Result<(Vec<SensorPoint>, Layout), String> {
    let plane = Plane::of(triangles)?;
    let flat: Vec<[DVec2; 3]> = triangles
        .iter()
        .map(|corners| corners.map(|corner| plane.flat(corner)))
        .collect();
    let corners = || flat.iter().flatten();
    let least = corners().fold(DVec2::INFINITY, |least, corner| least.min(*corner));
    let most = corners().fold(DVec2::NEG_INFINITY, |most, corner| most.max(*corner));
    let counts = ((most - least) / spacing + 1e-9).floor().max(DVec2::ONE);
    if counts.x * counts.y > MOST_POINTS {
        return Err(format!(
            "would have {} × {} points at this spacing; at most {MOST_POINTS} are possible",
            counts.x, counts.y
        ));
    }
    let first = 0.5 * (least + most) - 0.5 * spacing * (counts - DVec2::ONE);
    let mut points = Vec::new();
    let (columns, rows) = (counts.x as usize, counts.y as usize);
    for row in 0..rows {
        for column in 0..columns {
            let place = first + spacing * DVec2::new(column as f64, row as f64);
            if flat.iter().any(|triangle| covers(triangle, place)) {
                points.push(SensorPoint::new(plane.point(place), plane.normal));
            }
        }
    }
    if points.is_empty() {
        return Err("holds no point of the lattice; make the spacing smaller".into());
    }
    let layout = if points.len() == columns * rows {
        Layout::Grid {
            origin: plane.point(first - DVec2::splat(0.5 * spacing)),
            u: plane.u * spacing * counts.x,
            v: plane.v * spacing * counts.y,
            counts: [columns, rows],
        }
    } else {
        Layout::Points
    };
    Ok((points, layout))
}

/// A plane with axes u, v and normal u × v.
struct Plane {
    origin: DVec3,
    u: DVec3,
    v: DVec3,
    normal: DVec3,
}

impl Plane {
    fn of(triangles: &[[DVec3; 3]]) -> Result<Self, String> {
        let flat = || {
            "is not flat: a lattice needs a flat object; leave spacing out for the faces' centres"
                .to_owned()
        };
        let areas = || triangles.iter().map(|[a, b, c]| (b - a).cross(c - a));
        let normal = unit(areas().sum()).ok_or_else(flat)?;
        let edge = longest_outer_edge(triangles).ok_or_else(flat)?;
        let origin = triangles[0][0];
        let corners = || triangles.iter().flatten();
        let size = corners().fold(0.0, |size: f64, corner| {
            size.max((corner - origin).length())
        });
        let even = corners().all(|corner| (corner - origin).dot(normal).abs() <= FLATNESS * size);
        let one_side = areas().all(|area| area.dot(normal) >= 0.0);
        if !even || !one_side {
            return Err(flat());
        }
        let u = unit(edge - edge.dot(normal) * normal).ok_or_else(flat)?;
        Ok(Self {
            origin,
            u,
            v: normal.cross(u),
            normal,
        })
    }

    fn flat(&self, point: DVec3) -> DVec2 {
        let offset = point - self.origin;
        DVec2::new(offset.dot(self.u), offset.dot(self.v))
    }

    fn point(&self, flat: DVec2) -> DVec3 {
        self.origin + flat.x * self.u + flat.y * self.v
    }
}

/// The longest edge that belongs to one triangle only, so that no diagonal of a face counts; the first of equals.
///
/// Vertices are told apart by their positions, because glTF repeats them.
fn longest_outer_edge(triangles: &[[DVec3; 3]]) -> Option<DVec3> {
    // Adding zero gives −0.0 the bits of 0.0.
    let bits = |point: DVec3| (point + DVec3::ZERO).to_array().map(f64::to_bits);
    let edges = || {
        let of_triangle = |&[a, b, c]: &[DVec3; 3]| [[a, b], [b, c], [c, a]];
        triangles.iter().flat_map(of_triangle)
    };
    let key = |[from, to]: [DVec3; 2]| {
        let (from, to) = (bits(from), bits(to));
        (from.min(to), from.max(to))
    };
    let mut uses = BTreeMap::new();
    for edge in edges() {
        *uses.entry(key(edge)).or_insert(0) += 1;
    }
    let mut longest: Option<DVec3> = None;
    for edge in edges().filter(|edge| uses.get(&key(*edge)) == Some(&1)) {
        let vector = edge[1] - edge[0];
        // A rounding in the file must not choose between equals.
        if longest.is_none_or(|longest| vector.length() > longest.length() * (1.0 + 1e-6)) {
            longest = Some(vector);
        }
    }
    longest
}

/// Whether an anticlockwise triangle covers a place, its rim included.
fn covers(triangle: &[DVec2; 3], place: DVec2) -> bool {
    let [a, b, c] = *triangle;
    let reach = (b - a).perp_dot(c - a).abs() * 1e-9;
    let left = |from: DVec2, to: DVec2| (to - from).perp_dot(place - from) >= -reach;
    left(a, b) && left(b, c) && left(c, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of 4 m × 2 m in the plane y = 3, its normal −Y.
    fn board() -> Vec<[DVec3; 3]> {
        let corner = |x: f64, z: f64| DVec3::new(x, 3.0, z);
        let [a, b, c, d] = [
            corner(0., 0.),
            corner(4., 0.),
            corner(4., 2.),
            corner(0., 2.),
        ];
        vec![[a, b, c], [a, c, d]]
    }

    #[test]
    fn a_rectangle_gets_a_grid_along_its_longest_edge() {
        let (points, layout) = lattice(&board(), 0.5).unwrap();
        assert_eq!(points.len(), 8 * 4);
        assert!((points[0].position - DVec3::new(0.25, 3.0, 0.25)).length() < 1e-12);
        assert!((points[1].position - DVec3::new(0.75, 3.0, 0.25)).length() < 1e-12);
        assert!((points[0].normal - DVec3::NEG_Y).length() < 1e-12);
        let Layout::Grid {
            origin,
            u,
            v,
            counts,
        } = layout
        else {
            panic!("a full rectangle is a grid")
        };
        assert!(origin.distance(DVec3::new(0.0, 3.0, 0.0)) < 1e-12);
        assert!(u.distance(DVec3::X * 4.0) < 1e-12 && v.distance(DVec3::Z * 2.0) < 1e-12);
        assert_eq!(counts, [8, 4]);
    }

    #[test]
    fn what_is_left_over_is_shared_by_both_ends() {
        let (points, _) = lattice(&board(), 1.5).unwrap();
        assert_eq!(points.len(), 2);
        assert!((points[0].position - DVec3::new(1.25, 3.0, 1.0)).length() < 1e-12);
    }

    #[test]
    fn a_triangle_gets_the_points_that_lie_on_it() {
        let (points, layout) = lattice(&board()[..1], 0.5).unwrap();
        assert!(points.len() < 32 && points.len() >= 12);
        assert_eq!(layout, Layout::Points);
    }

    #[test]
    fn what_is_not_flat_is_refused() {
        let mut bent = board();
        bent[1][2].y = 2.0;
        assert!(lattice(&bent, 0.5).unwrap_err().contains("not flat"));
        let mut folded = board();
        folded[1].swap(0, 1);
        assert!(lattice(&folded, 0.5).unwrap_err().contains("not flat"));
    }

    #[test]
    fn too_fine_a_lattice_is_refused_before_it_fills_the_memory() {
        assert!(lattice(&board(), 1e-5).unwrap_err().contains("at most"));
    }
}
