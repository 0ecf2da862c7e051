//! Convex polygons in a plane: clipping and subtraction, for surfaces that lie in one another.

use crate::Triangle;
use glam::{DVec2, DVec3};

/// The plane of a triangle as a frame: x and y in it, z (the height) along its normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    origin: DVec3,
    axes: [DVec3; 3],
}

impl Plane {
    /// The plane of a triangle that has an area.
    pub fn of(triangle: &Triangle) -> Self {
        let [a, b, c] = triangle.vertices;
        let normal = triangle.normal();
        // The longer of two edges: the other may be as short as the triangle is thin.
        let edge = if (b - a).length_squared() >= (c - a).length_squared() {
            b - a
        } else {
            c - a
        };
        let x = (edge - edge.dot(normal) * normal).normalize_or_zero();
        Self {
            origin: a,
            axes: [x, normal.cross(x), normal],
        }
    }

    /// A point's coordinates in the plane's frame, in m.
    pub fn local(&self, point: DVec3) -> DVec3 {
        let seen = point - self.origin;
        DVec3::from_array(self.axes.map(|axis| axis.dot(seen)))
    }

    /// A triangle in the plane's frame, seen anticlockwise from above whichever way it faces.
    pub fn polygon(&self, triangle: &Triangle) -> Polygon {
        let [a, b, c] = triangle.vertices.map(|vertex| self.local(vertex));
        let turn = (b - a).truncate().perp_dot((c - a).truncate());
        Polygon(if turn >= 0.0 {
            vec![a, b, c]
        } else {
            vec![a, c, b]
        })
    }
}

/// A convex polygon, anticlockwise in x and y; z is carried along.
#[derive(Debug, Clone)]
pub(crate) struct Polygon(pub Vec<DVec3>);

impl Polygon {
    /// Its sides, each from one corner to the next.
    fn sides(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        let next = self.0.iter().cycle().skip(1);
        self.0
            .iter()
            .zip(next)
            .map(|(from, to)| (from.truncate(), to.truncate()))
    }

    /// Area of the projection on x and y, in m².
    pub fn area(&self) -> f64 {
        let Some(&first) = self.0.first() else {
            return 0.0;
        };
        let fan = self.0.windows(2).map(|pair| {
            let [from, to] = [pair[0] - first, pair[1] - first];
            from.truncate().perp_dot(to.truncate())
        });
        0.5 * fan.sum::<f64>()
    }

    /// Longest distance between two corners in x and y, in m.
    pub fn width(&self) -> f64 {
        let pairs = self
            .0
            .iter()
            .flat_map(|one| self.0.iter().map(|other| (*one - *other).truncate()));
        pairs.map(DVec2::length_squared).fold(0.0, f64::max).sqrt()
    }

    /// Whether some side of this polygon has all of the other beyond it, or no further inside than `margin` (in m).
    pub fn separates(&self, other: &Self, margin: f64) -> bool {
        // The direction of a side that is next to nothing is noise, and such a side would separate everything.
        let longest = self
            .sides()
            .map(|(from, to)| from.distance(to))
            .fold(0.0, f64::max);
        let long = move |side: &(DVec2, DVec2)| side.0.distance(side.1) > 1e-6 * longest;
        self.sides().filter(long).any(|(from, to)| {
            let along = to - from;
            let limit = margin * along.length();
            other
                .0
                .iter()
                .all(|corner| along.perp_dot(corner.truncate() - from) <= limit)
        })
    }

    /// The parts on the left (inside) and the right of a line (Sutherland and Hodgman 1974, once for each side).
    pub fn split(&self, from: DVec2, to: DVec2) -> (Self, Self) {
        let along = to - from;
        let side = |corner: DVec3| along.perp_dot(corner.truncate() - from);
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for (index, &corner) in self.0.iter().enumerate() {
            let next = self.0[(index + 1) % self.0.len()];
            let (here, there) = (side(corner), side(next));
            if here >= 0.0 {
                left.push(corner);
            }
            if here <= 0.0 {
                right.push(corner);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let crossing = corner + (next - corner) * (here / (here - there));
                left.push(crossing);
                right.push(crossing);
            }
        }
        (Self(left), Self(right))
    }

    /// What this polygon and another have in common; heights are this one's.
    pub fn intersection(&self, other: &Self) -> Self {
        other
            .sides()
            .fold(self.clone(), |rest, (from, to)| rest.split(from, to).0)
    }

    /// Cuts another polygon out of this one: the pieces left, all convex.
    pub fn minus(self, other: &Self) -> Vec<Self> {
        // Cutting along the sides of one that lies elsewhere would only multiply pieces.
        if self.separates(other, 0.0) || other.separates(&self, 0.0) {
            return vec![self];
        }
        let whole = self.area();
        let mut pieces = Vec::new();
        let mut rest = self;
        for (from, to) in other.sides() {
            let (inside, outside) = rest.split(from, to);
            // Splinters of rounding would only multiply.
            if outside.area() > 1e-14 * whole {
                pieces.push(outside);
            }
            rest = inside;
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(least: f64, most: f64) -> Polygon {
        Polygon(vec![
            DVec3::new(least, least, 0.0),
            DVec3::new(most, least, 0.0),
            DVec3::new(most, most, 0.0),
            DVec3::new(least, most, 0.0),
        ])
    }

    #[test]
    fn a_part_and_its_rest_make_up_the_whole() {
        let whole = square(0.0, 4.0);
        for (least, most, common) in [(1.0, 2.0, 1.0), (3.0, 9.0, 1.0), (-1.0, 5.0, 16.0)] {
            let other = square(least, most);
            let rest = whole.clone().minus(&other);
            let left: f64 = rest.iter().map(Polygon::area).sum();
            assert!((whole.intersection(&other).area() - common).abs() < 1e-14);
            assert!((left - (16.0 - common)).abs() < 1e-14);
        }
    }

    #[test]
    fn polygons_that_touch_are_separate() {
        assert!(square(0.0, 1.0).separates(&square(1.0, 2.0), 1e-9));
        assert!(!square(0.0, 1.0).separates(&square(0.9, 2.0), 1e-9));
    }

    #[test]
    fn clipping_keeps_heights_on_the_slope() {
        let slope = Polygon(
            square(0.0, 4.0)
                .0
                .iter()
                .map(|corner| corner.with_z(0.5 * corner.x))
                .collect(),
        );
        let common = slope.intersection(&square(1.0, 2.0));
        assert_eq!(common.0.len(), 4);
        assert!(
            common
                .0
                .iter()
                .all(|corner| (corner.z - 0.5 * corner.x).abs() < 1e-15)
        );
    }
}
