//! Where a line meets a triangle, in double precision, without cracks.

use crate::Triangle;
use crate::shape::across;
use glam::DVec3;

/// Cosine² below which a crossing is grazing and its distance is held within the triangle's own.
const GRAZING: f64 = 1.0 / 65536.0;

/// A line to be crossed with triangles, and how near a miss still counts as a hit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Two unit vectors that make up a right-handed frame with the direction.
    across: [DVec3; 2],
    /// Every triangle is thicker by this all round, in m.
    slack: f64,
    /// Upper bound of slack · edge over all edges of the scene, in m².
    reach: f64,
}

/// Where a vertex is seen from the line: two coordinates across it and one along it, in m.
type Seen = [f64; 3];

impl Line {
    /// A line through a scene whose edges are no longer than `longest` (in m).
    pub fn new(origin: DVec3, direction: DVec3, slack: f64, longest: f64) -> Self {
        let (x, y) = across(direction);
        Self {
            origin,
            direction,
            across: [x, y],
            slack,
            reach: slack * longest,
        }
    }

    /// Distance along the line to where it crosses the triangle, in m and of either sign; `None` where it misses.
    ///
    /// With the vertices' coordinates across the line, the side on which it passes an edge from p to q is the sign of
    /// pₓ q_y − p_y qₓ. A vertex has the same coordinates in every triangle, and without fused multiply-add the
    /// difference is bitwise antisymmetric, so triangles that share an edge agree on its side (after Woop, Benthin
    /// and Wald 2013, *Watertight Ray/Triangle Intersection*).
    ///
    /// Where edges meet without sharing their ends (one long edge against several short ones), rounding opens
    /// cracks of some 2⁻⁵² of the scene: a line that passes the triangle within `slack` of an edge counts as
    /// crossing it where it comes nearest to that edge.
    #[inline(always)]
    pub fn crossing(&self, triangle: &[DVec3; 3]) -> Option<f64> {
        let (p, q, r) = (
            triangle[0] - self.origin,
            triangle[1] - self.origin,
            triangle[2] - self.origin,
        );
        // Most triangles lie well to one side.
        let x = self.across[0];
        let (px, qx, rx) = (p.dot(x), q.dot(x), r.dot(x));
        if on_one_side([px, qx, rx], self.slack) {
            return None;
        }
        let y = self.across[1];
        let (py, qy, ry) = (p.dot(y), q.dot(y), r.dot(y));
        if on_one_side([py, qy, ry], self.slack) {
            return None;
        }
        let u = px * qy - py * qx;
        let v = qx * ry - qy * rx;
        let w = rx * py - ry * px;
        // Beyond an edge on one side and beyond another on the other: not even near the triangle.
        if ((u < -self.reach) | (v < -self.reach) | (w < -self.reach))
            & ((u > self.reach) | (v > self.reach) | (w > self.reach))
        {
            return None;
        }
        let z = self.direction;
        let (pz, qz, rz) = (p.dot(z), q.dot(z), r.dot(z));
        let seen = [[px, py, pz], [qx, qy, qz], [rx, ry, rz]];
        if ((u < 0.0) | (v < 0.0) | (w < 0.0)) & ((u > 0.0) | (v > 0.0) | (w > 0.0)) {
            return self.past_edges(seen);
        }
        let triangle = Triangle {
            vertices: *triangle,
        };
        let normal = triangle.area_vector();
        let along = normal.dot(self.direction);
        let distance = normal.dot(p) / along;
        if along * along > GRAZING * normal.length_squared() {
            Some(distance)
        } else if along.abs() > 4.0 * self.slack * triangle.longest_edge() {
            Some(distance.clamp(pz.min(qz).min(rz), pz.max(qz).max(rz)))
        } else {
            // Seen as narrow as the slack: the signs are noise, and only nearness counts.
            self.past_edges(seen)
        }
    }

    /// The least distance at which the line passes within the slack of an edge; positive ones come first.
    #[cold]
    #[inline(never)]
    fn past_edges(&self, [p, q, r]: [Seen; 3]) -> Option<f64> {
        let mut first: Option<f64> = None;
        for (from, to) in [(p, q), (q, r), (r, p)] {
            let edge = [0, 1, 2].map(|axis| to[axis] - from[axis]);
            let length = edge[0] * edge[0] + edge[1] * edge[1];
            let place = if length > 0.0 {
                (-(from[0] * edge[0] + from[1] * edge[1]) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let [x, y, distance] = [0, 1, 2].map(|axis| from[axis] + place * edge[axis]);
            if x * x + y * y <= self.slack * self.slack
                && first.is_none_or(|least| (distance <= 0.0, distance) < (least <= 0.0, least))
            {
                first = Some(distance);
            }
        }
        first
    }
}

/// Height over its longest edge, in terms of that, below which a triangle's plane may miss its vertices by a slack.
const NEEDLE: f64 = 1e-5;

/// A point beside a triangle: whether a segment from there stays on its side of the triangle's plane, or leaves it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beside {
    /// Of the length of twice the area.
    normal: DVec3,
    corner: DVec3,
    /// Heights over the plane, times that length: of the point, and beyond which no slack reaches.
    height: f64,
    margin: f64,
}

impl Beside {
    #[inline(always)]
    pub fn new(point: DVec3, triangle: &[DVec3; 3], slack: f64) -> Self {
        let vertices = *triangle;
        let triangle = Triangle { vertices };
        let normal = triangle.area_vector();
        let (length, longest) = (normal.length(), triangle.longest_edge());
        Self {
            normal,
            corner: vertices[0],
            height: normal.dot(point - vertices[0]),
            // The plane of a needle is known too badly to tell anything.
            margin: if length > NEEDLE * longest * longest {
                2.0 * slack * length
            } else {
                f64::INFINITY
            },
        }
    }

    /// Of points given by axis, one bit each: those between which and the point [`Line::crossing`] finds nothing, as both
    /// stand off the plane on one side; and those between which and the point all lies that it finds, as they stand off on
    /// different sides.
    ///
    /// From either end it is farther along the line than a slack over the cosine, the scene over 2⁴² times that; its
    /// distance is wrong by less than the scene over 2⁴⁸ times the cosine.
    #[allow(
        clippy::needless_range_loop,
        reason = "a point has the same number in several lists"
    )]
    #[inline(always)]
    pub fn sides<const N: usize>(&self, to: &[[f64; N]; 3]) -> (u32, u32) {
        let (mut above, mut below) = (0, 0);
        for point in 0..N {
            let height = self.normal.x * (to[0][point] - self.corner.x)
                + self.normal.y * (to[1][point] - self.corner.y)
                + self.normal.z * (to[2][point] - self.corner.z);
            above |= u32::from(height > self.margin) << point;
            below |= u32::from(height < -self.margin) << point;
        }
        if self.height > self.margin {
            (above, below)
        } else if self.height < -self.margin {
            (below, above)
        } else {
            (0, 0)
        }
    }
}

/// Whether all three lie beyond `slack` on the same side of zero.
#[inline]
fn on_one_side([a, b, c]: [f64; 3], slack: f64) -> bool {
    ((a > slack) & (b > slack) & (c > slack)) | ((a < -slack) & (b < -slack) & (c < -slack))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Uniform;
    use proptest::prelude::*;

    const TRIANGLE: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    fn line(origin: DVec3, towards: DVec3) -> Line {
        let direction = (towards - origin).normalize();
        Line::new(origin, direction, 1e-12, 10.0)
    }

    #[test]
    fn a_line_is_crossed_ahead_and_behind() {
        let place = DVec3::new(0.25, 0.5, 0.0);
        for origin in [DVec3::new(0.1, 0.2, 3.0), DVec3::new(0.4, -2.0, -3.0)] {
            let line = line(origin, place);
            let distance = origin.distance(place);
            assert!((line.crossing(&TRIANGLE).unwrap() - distance).abs() < 1e-14);
            let away = Line::new(origin, -line.direction, 1e-12, 10.0);
            assert!((away.crossing(&TRIANGLE).unwrap() + distance).abs() < 1e-14);
        }
    }

    #[test]
    fn a_triangle_is_thicker_by_the_slack_and_no_more() {
        for (beside, met) in [(0.9e-12, true), (1.1e-12, false)] {
            for at in [
                DVec3::new(0.5, -beside, 0.0),
                DVec3::new(1.0 + beside, 0.0, 0.0),
            ] {
                let line = line(at + DVec3::Z, at);
                assert_eq!(line.crossing(&TRIANGLE).is_some(), met, "{at}");
            }
        }
    }

    #[test]
    fn a_line_in_the_plane_meets_the_first_edge_on_its_way_or_none() {
        let through = line(DVec3::new(-1.0, 0.25, 0.0), DVec3::new(2.0, 0.25, 0.0));
        assert!((through.crossing(&TRIANGLE).unwrap() - 1.0).abs() < 1e-12);
        let beside = line(DVec3::new(-1.0, 1.5, 0.0), DVec3::new(2.0, 1.5, 0.0));
        assert_eq!(beside.crossing(&TRIANGLE), None);
        let oblique = line(DVec3::new(0.3, -0.7, 0.0), DVec3::new(0.2, 3.0, 0.0));
        assert!(oblique.crossing(&TRIANGLE).is_some());
    }

    proptest! {
        #[test]
        fn what_stays_beside_a_triangle_does_not_cross_it_and_what_leaves_does_so_between(seed: u64) {
            let mut uniform = Uniform(seed);
            const SLACK: f64 = 1e-9;
            let triangle = [(); 3].map(|()| uniform.point());
            let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalize();
            // Points that hardly leave the plane, on either side of it.
            let mut near = || {
                let place = uniform.point();
                let height = 10f64.powf(-10.0 + 3.0 * uniform.next()) * (uniform.next() - 0.5).signum();
                place + (height - (place - triangle[0]).dot(normal)) * normal
            };
            let (from, to) = (near(), near());
            let line = Line::new(from, (to - from).normalize(), SLACK, 10.0);
            let distance = line.crossing(&triangle);
            let crossed = distance.is_some_and(|it| it > 0.0 && it < from.distance(to));
            let heights = [from, to].map(|it| (it - triangle[0]).dot(normal));
            let (off, parted) = Beside::new(from, &triangle, SLACK).sides(&to.to_array().map(|it| [it]));
            prop_assert!(parted == 0 || distance.is_none() || crossed);
            if off == 1 {
                prop_assert!(!crossed && heights[0] * heights[1] > 0.0);
            } else {
                prop_assert!(heights[0] * heights[1] < 0.0 || heights[0].abs().min(heights[1].abs()) < 2.1 * SLACK);
            }
        }

        #[test]
        fn one_of_two_triangles_is_met_at_their_common_edge_even_without_slack(seed: u64) {
            let mut uniform = Uniform(seed);
            let [a, b, c, d] = [(); 4].map(|()| uniform.point());
            let from = 3.0 * uniform.direction();
            let towards = a + uniform.next() * (b - a);
            let line = Line::new(from, (towards - from).normalize(), 0.0, 10.0);
            // One triangle on either side of the edge as it is seen.
            let side = (b - a).cross(from - a);
            prop_assume!(side.dot(c - a) * side.dot(d - a) < -1e-6);
            let met = [[a, b, c], [b, a, d]].map(|triangle| line.crossing(&triangle));
            prop_assert!(met[0].is_some() || met[1].is_some());
        }
    }
}
