//! Polygons cut into triangles.

use earcut::Earcut;
use glam::DVec3;

/// Cuts polygons into triangles by clipping ears, reusing its memory.
pub(super) struct Clipper {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    indices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

/// The triangles of one polygon.
pub(super) struct Clipped<'a> {
    /// Indices of corners, each triangle wound as the polygon.
    pub triangles: &'a [[u32; 3]],
    /// Whether they cover the polygon exactly; false for one that crosses itself or has no area.
    pub simple: bool,
}

impl Clipper {
    pub(super) fn new() -> Self {
        Self {
            earcut: Earcut::new(),
            flat: Vec::new(),
            indices: Vec::new(),
            triangles: Vec::new(),
        }
    }

    /// The triangles of the closed polygon through three or more `corners`, convex or not.
    ///
    /// Every corner is kept, also one on a straight edge: a neighbour may have a vertex there, and the mesh
    /// stays closed. So n corners make n − 2 triangles. A polygon that is not plane is cut as it looks along
    /// its mean normal; one that crosses itself, as a fan.
    pub(super) fn clip(&mut self, corners: &[DVec3]) -> Clipped<'_> {
        self.triangles.clear();
        let simple = match corners {
            [_, _, _] => {
                self.triangles.push([0, 1, 2]);
                true
            }
            &[a, b, c, d] => self.halve([a, b, c, d]),
            _ => self.clip_ears(corners),
        };
        Clipped {
            triangles: &self.triangles,
            simple,
        }
    }

    /// Cuts a quadrilateral along the diagonal that leaves both halves facing its mean normal, the better one
    /// where both do. This is right for any skew quadrilateral, which a projection may fold.
    fn halve(&mut self, corners: [DVec3; 4]) -> bool {
        let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
        let facing = |half: [u32; 3]| {
            let [a, b, c] = half.map(|i| corners[i as usize]);
            (b - a).cross(c - a).dot(normal)
        };
        let worse = |halves: [[u32; 3]; 2]| facing(halves[0]).min(facing(halves[1]));
        let (first, second) = ([[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]]);
        let better = if worse(second) > worse(first) {
            second
        } else {
            first
        };
        self.triangles.extend(better);
        worse(better) > 0.0
    }

    fn clip_ears(&mut self, corners: &[DVec3]) -> bool {
        self.project(corners);
        let area = signed_area(&self.flat);
        self.earcut
            .earcut_slice(&self.flat, &[0u32; 0], &mut self.indices);
        self.triangles
            .extend(self.indices.as_chunks::<3>().0.iter().copied());
        let covered: f64 = self.triangles.iter().map(|&t| self.triangle_area(t)).sum();
        let simple = area != 0.0 && (covered.abs() - area.abs()).abs() <= 1e-9 * area.abs();
        if !simple {
            let count = corners.len() as u32;
            self.triangles.clear();
            self.triangles.extend((2..count).map(|i| [0, i - 1, i]));
            return false;
        }
        if covered * area < 0.0 {
            for triangle in &mut self.triangles {
                triangle.swap(1, 2);
            }
        }
        if self.triangles.len() + 2 < corners.len() {
            self.restore_straight_corners();
        }
        true
    }

    /// Drops the coordinate in which the polygon is thinnest; exact, so what is straight stays straight.
    fn project(&mut self, corners: &[DVec3]) {
        let mut normal = DVec3::ZERO;
        for pair in corners.windows(2) {
            normal += (pair[0] - corners[0]).cross(pair[1] - corners[0]);
        }
        let size = normal.abs();
        let (u, v) = if size.z >= size.x && size.z >= size.y {
            (0, 1)
        } else if size.y >= size.x {
            (2, 0)
        } else {
            (1, 2)
        };
        self.flat.clear();
        self.flat.extend(corners.iter().map(|c| [c[u], c[v]]));
    }

    fn triangle_area(&self, triangle: [u32; 3]) -> f64 {
        signed_area(&triangle.map(|i| self.flat[i as usize]))
    }

    /// Puts back the corners that the clipping dropped because they lie on a straight edge: the edge that
    /// skips them belongs to one triangle, which is split.
    fn restore_straight_corners(&mut self) {
        let count = self.flat.len();
        let mut used = vec![false; count];
        for &corner in self.triangles.iter().flatten() {
            used[corner as usize] = true;
        }
        let Some(first) = used.iter().position(|&u| u) else {
            return;
        };
        let mut start = first;
        for step in first + 1..=first + count {
            let corner = step % count;
            if !used[corner] {
                continue;
            }
            let skipped: Vec<usize> = (start + 1..step).map(|i| i % count).collect();
            self.split(start % count, &skipped, corner);
            start = step;
        }
    }

    fn split(&mut self, from: usize, skipped: &[usize], to: usize) {
        let edge = [from as u32, to as u32];
        let along = |i: usize| {
            let ([x, y], [x0, y0], [x1, y1]) = (self.flat[i], self.flat[from], self.flat[to]);
            (x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)
        };
        // A corner out of order belongs to a spike of no area, not to the edge.
        let in_order = skipped
            .iter()
            .chain([&to])
            .is_sorted_by(|&&a, &&b| along(a) < along(b));
        if skipped.is_empty() || !in_order || along(skipped[0]) <= 0.0 {
            return;
        }
        let found = self.triangles.iter().enumerate().find_map(|(i, t)| {
            (0..3)
                .find(|&k| [t[k], t[(k + 1) % 3]] == edge)
                .map(|k| (i, t[(k + 2) % 3]))
        });
        if let Some((i, apex)) = found {
            self.triangles.swap_remove(i);
            let mut before = edge[0];
            for &corner in skipped.iter().chain([&to]) {
                self.triangles.push([before, corner as u32, apex]);
                before = corner as u32;
            }
        }
    }
}

/// Area of a closed polygon in the plane, positive when anticlockwise.
fn signed_area(corners: &[[f64; 2]]) -> f64 {
    let origin = corners[0];
    let twice: f64 = corners
        .windows(2)
        .map(|p| {
            (p[0][0] - origin[0]) * (p[1][1] - origin[1])
                - (p[1][0] - origin[0]) * (p[0][1] - origin[1])
        })
        .sum();
    0.5 * twice
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Sum of areas and of directed areas of the triangles of a polygon.
    fn cut(corners: &[DVec3]) -> (Vec<[u32; 3]>, f64, DVec3, bool) {
        let mut clipper = Clipper::new();
        let clipped = clipper.clip(corners);
        let directed = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| corners[i as usize]);
            0.5 * (b - a).cross(c - a)
        };
        let area = clipped.triangles.iter().map(|t| directed(t).length()).sum();
        let vector = clipped.triangles.iter().map(directed).sum();
        (clipped.triangles.to_vec(), area, vector, clipped.simple)
    }

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect()
    }

    /// Edges that belong to one triangle only, as the polygon's boundary must.
    fn boundary(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let mut edges = BTreeMap::new();
        for t in triangles {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                *edges.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
            }
        }
        edges
            .into_iter()
            .filter(|e| e.1 == 1)
            .map(|e| e.0)
            .collect()
    }

    const L: [[f64; 2]; 6] = [
        [0.0, 0.0],
        [8.0, 0.0],
        [8.0, 3.0],
        [4.0, 3.0],
        [4.0, 9.0],
        [0.0, 9.0],
    ];

    #[test]
    fn a_concave_polygon_keeps_its_area_where_a_fan_would_not() {
        let corners = flat(&L);
        let (triangles, area, vector, simple) = cut(&corners);
        assert_eq!(triangles.len(), 4);
        assert!(simple && (area - 48.0).abs() < 1e-12, "{area}");
        assert!((vector - 48.0 * DVec3::Z).length() < 1e-12);
        let fan: f64 = (1..5)
            .map(|i| {
                0.5 * (corners[i] - corners[5])
                    .cross(corners[(i + 5) % 6] - corners[5])
                    .length()
            })
            .sum();
        assert!(fan > 48.0, "this polygon would not show a fan: {fan}");
    }

    #[test]
    fn the_winding_and_the_area_survive_in_every_plane_and_from_every_corner() {
        for start in 0..6 {
            for axes in [
                [DVec3::X, DVec3::Y],
                [DVec3::Y, DVec3::Z],
                [DVec3::Z, DVec3::X],
                [DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.0, 0.6, 0.8)],
            ] {
                for reverse in [false, true] {
                    let mut corners: Vec<_> = (0..6)
                        .map(|i| L[(i + start) % 6])
                        .map(|p| 100.0 + p[0] * axes[0] + p[1] * axes[1])
                        .collect();
                    let mut expected = 48.0 * axes[0].cross(axes[1]);
                    if reverse {
                        corners.reverse();
                        expected = -expected;
                    }
                    let (_, area, vector, simple) = cut(&corners);
                    assert!(simple);
                    assert!((area - expected.length()).abs() < 1e-9);
                    assert!(
                        (vector - expected).length() < 1e-9,
                        "{vector} for {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn corners_on_straight_edges_are_kept_so_that_a_neighbour_still_fits() {
        // A unit square, each edge cut into n.
        for n in 1..6 {
            let mut points = Vec::new();
            let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            for side in 0..4 {
                let (a, b) = (square[side], square[(side + 1) % 4]);
                for i in 0..n {
                    let t = f64::from(i) / f64::from(n);
                    points.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
                }
            }
            for start in 0..points.len() {
                points.rotate_left(start);
                let (triangles, area, ..) = cut(&flat(&points));
                assert_eq!(triangles.len(), points.len() - 2);
                assert!((area - 1.0).abs() < 1e-12);
                assert_eq!(boundary(&triangles).len(), points.len());
            }
        }
    }

    #[test]
    fn a_concave_quadrilateral_is_cut_along_the_diagonal_inside_it() {
        let arrow = [[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]];
        for start in 0..4 {
            let mut points = arrow;
            points.rotate_left(start);
            let (triangles, area, vector, simple) = cut(&flat(&points));
            assert_eq!(triangles.len(), 2);
            assert!(simple && (area - 0.5).abs() < 1e-15, "{area} from {start}");
            assert!((vector - 0.5 * DVec3::Z).length() < 1e-15);
        }
    }

    #[test]
    fn a_skew_quadrilateral_is_two_triangles_on_its_four_edges() {
        // A cell of a terrain over the unit square. The steep ones fold when seen along an axis.
        for (heights, step) in (0..625).flat_map(|h| [(h, 0.25), (h, 1.5)]) {
            let height = |place| f64::from(heights / place % 5) * step;
            let corners = [
                DVec3::new(0.0, 0.0, height(1)),
                DVec3::new(1.0, 0.0, height(5)),
                DVec3::new(1.0, 1.0, height(25)),
                DVec3::new(0.0, 1.0, height(125)),
            ];
            let (triangles, _, vector, simple) = cut(&corners);
            assert_eq!((triangles.len(), boundary(&triangles).len()), (2, 4));
            // The directed area over the ground is that of the cell whatever the diagonal.
            assert!((vector.z - 1.0).abs() < 1e-12);
            assert!(simple || step > 1.0, "{corners:?}");
        }
    }

    #[test]
    fn a_polygon_that_crosses_itself_or_has_no_area_is_told() {
        assert!(!cut(&flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 1.0]])).3);
        assert!(!cut(&flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]])).3);
        assert!(!cut(&[DVec3::ONE; 4]).3);
        assert!(!cut(&[DVec3::ONE; 5]).3);
        // A pentagram: its triangles still join its five edges.
        let star = [0, 2, 4, 1, 3].map(|i| f64::from(i) * 0.4 * std::f64::consts::PI);
        let (triangles, .., simple) = cut(&star.map(|a| DVec3::new(a.cos(), a.sin(), 0.0)));
        assert_eq!((triangles.len(), simple), (3, false));
        assert!(
            !cut(&[
                DVec3::splat(1e300),
                DVec3::X * 1e300,
                DVec3::Y * -1e300,
                DVec3::Z
            ])
            .3
        );
    }

    #[test]
    fn a_spike_of_no_area_adds_none() {
        let (_, area, _, simple) = cut(&flat(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [3.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
        ]));
        assert!(simple && (area - 1.0).abs() < 1e-12, "{area}");
    }
}
