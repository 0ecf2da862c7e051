//! One triangle: area, normal, points on it.

use glam::DVec3;

/// A triangle in space, vertices in metres; its normal follows their order by the right-hand rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// The three corners, in m.
    pub vertices: [DVec3; 3],
}

impl Triangle {
    /// Cross product of two edges: along the normal, twice the area long, in m².
    ///
    /// Taken from the two shorter edges, so that a needle's normal is as accurate as its coordinates allow.
    #[must_use]
    pub fn area_vector(&self) -> DVec3 {
        let [a, b, c] = self.vertices;
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let (l_ab, l_bc, l_ca) = (
            ab.length_squared(),
            bc.length_squared(),
            ca.length_squared(),
        );
        if l_ab >= l_bc && l_ab >= l_ca {
            bc.cross(ca)
        } else if l_bc >= l_ca {
            ca.cross(ab)
        } else {
            ab.cross(bc)
        }
    }

    /// Area in m².
    #[must_use]
    pub fn area(&self) -> f64 {
        0.5 * self.area_vector().length()
    }

    /// Unit normal by the order of the vertices; zero where the triangle has no area.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        let vector = self.area_vector();
        // Scaled first: squares of a very small or very large triangle's components leave the range of f64.
        let largest = vector.abs().max_element();
        if largest > 0.0 {
            let scaled = vector / largest;
            scaled / scaled.length()
        } else {
            DVec3::ZERO
        }
    }

    /// Centre of gravity, in m.
    #[must_use]
    pub fn centroid(&self) -> DVec3 {
        let [a, b, c] = self.vertices;
        (a + b + c) / 3.0
    }

    /// Length of the longest edge, in m.
    #[must_use]
    pub fn longest_edge(&self) -> f64 {
        let [a, b, c] = self.vertices;
        (b - a)
            .length_squared()
            .max((c - b).length_squared())
            .max((a - c).length_squared())
            .sqrt()
    }

    /// The point that two uniform numbers in [0, 1) pick, uniform in area.
    ///
    /// Barycentric weights (1 − √u₀, √u₀ (1 − u₁), √u₀ u₁): Turk, *Graphics Gems* (1990), p. 24.
    #[must_use]
    pub fn point_at(&self, uniform: [f64; 2]) -> DVec3 {
        let [a, b, c] = self.vertices;
        let root = uniform[0].sqrt();
        let of_c = root * uniform[1];
        let of_b = root - of_c;
        a * (1.0 - root) + b * of_b + c * of_c
    }

    /// Whether a point, moved along the normal onto the triangle's plane, lies within it, its edges included.
    #[must_use]
    pub fn covers(&self, point: DVec3) -> bool {
        let [a, b, c] = self.vertices;
        let normal = self.area_vector();
        let side = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal);
        side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: Triangle = Triangle {
        vertices: [
            DVec3::ZERO,
            DVec3::new(3.0, 0.0, 0.0),
            DVec3::new(0.0, 4.0, 0.0),
        ],
    };

    #[test]
    fn a_right_triangle_has_half_the_product_of_its_legs() {
        assert!((RIGHT.area() - 6.0).abs() < 1e-14);
        assert!((RIGHT.normal() - DVec3::Z).length() < 1e-15);
        assert!((RIGHT.longest_edge() - 5.0).abs() < 1e-15);
    }

    #[test]
    fn turning_the_vertices_round_turns_the_normal() {
        let [a, b, c] = RIGHT.vertices;
        for vertices in [[a, c, b], [c, b, a], [b, a, c]] {
            assert!((Triangle { vertices }.normal() + DVec3::Z).length() < 1e-15);
        }
    }

    #[test]
    fn normals_survive_any_size() {
        for scale in [1e-120, 1e-20, 1.0, 1e20, 1e120] {
            let vertices = RIGHT.vertices.map(|vertex| vertex * scale);
            assert!((Triangle { vertices }.normal() - DVec3::Z).length() < 1e-15);
        }
    }

    #[test]
    fn uniform_points_have_the_moments_of_the_triangle() {
        // Mean at the centroid (1, 4/3); mean of x² over a right triangle of leg l is l²/6.
        let steps = 400;
        let (mut mean, mut square) = (DVec3::ZERO, 0.0);
        for i in 0..steps {
            for j in 0..steps {
                let at = |k: i32| (f64::from(k) + 0.5) / f64::from(steps);
                let point = RIGHT.point_at([at(i), at(j)]);
                assert!(RIGHT.covers(point));
                mean += point;
                square += point.x * point.x;
            }
        }
        let count = f64::from(steps * steps);
        assert!((mean / count - RIGHT.centroid()).length() < 1e-4);
        assert!((square / count - 1.5).abs() < 1e-4);
    }

    #[test]
    fn points_above_count_as_within_and_points_beside_do_not() {
        assert!(RIGHT.covers(DVec3::new(0.5, 0.5, 7.0)));
        assert!(RIGHT.covers(DVec3::new(1.5, 0.0, 0.0)));
        assert!(!RIGHT.covers(DVec3::new(-1e-12, 0.5, 0.0)));
        assert!(!RIGHT.covers(DVec3::new(2.0, 2.0, 0.0)));
    }
}
