//! The directions in which a point sees a chain of flat mirrors.

use glam::DVec3;
use malus_geometry::Facet;
use smallvec::SmallVec;
use std::f64::consts::TAU;

/// Corners of a polygon as directions, on the stack where there are few.
type Edges = SmallVec<[DVec3; 8]>;

/// A cone of directions from a receiving point, or from its image behind mirrors.
///
/// Mirrors are unfolded: behind each one the apex moves to its image, and so does everything that belongs to it.
#[derive(Debug, Clone)]
pub(crate) struct Beam {
    /// The point or its image, in m.
    pub apex: DVec3,
    /// Normal of the receiving surface, mirrored likewise.
    pub normal: DVec3,
    /// Edges of the cone, as directions of any length; none: the whole hemisphere about the normal.
    edges: Edges,
    /// +1 where the edges run anticlockwise as seen against the beam, −1 otherwise.
    turn: f64,
}

impl Beam {
    /// All that a surface with this unit normal sees from a point.
    pub(crate) fn hemisphere(apex: DVec3, normal: DVec3) -> Self {
        Self {
            apex,
            normal,
            edges: Edges::new(),
            turn: 1.0,
        }
    }

    /// The part of the beam that goes through the hull of a facet, past the mirror `window` that it comes from; `None`
    /// where nothing is left.
    pub(crate) fn through(&self, facet: &Facet, window: Option<&Facet>) -> Option<Self> {
        // The hull runs anticlockwise about the facet's normal, so as seen from the side of the normal.
        let above = self.apex.dot(facet.normal) > facet.height;
        let turn = if above { 1.0 } else { -1.0 };
        let mut edges: Edges = facet.hull.iter().map(|&c| c - self.apex).collect();
        if let Some(window) = window {
            // What lies past the window lies across its plane from the apex.
            let depth = self.apex.dot(window.normal) - window.height;
            clip(&mut edges, window.normal * -depth.signum(), depth.abs());
        }
        clip(&mut edges, self.normal, 0.0);
        let mut last = self.edges.last().copied();
        for &edge in &self.edges {
            if let Some(last) = last.replace(edge) {
                // Unit length keeps products of distant hulls within range.
                clip(&mut edges, (last.cross(edge) * -self.turn).normalize(), 0.0);
            }
        }
        drop_doubles(&mut edges);
        (edges.len() > 2).then_some(Self {
            edges,
            turn,
            ..*self
        })
    }

    /// The beam behind a mirror.
    pub(crate) fn mirrored(mut self, facet: &Facet) -> Self {
        self.apex = facet.image(self.apex);
        self.normal = facet.mirrored(self.normal);
        for edge in &mut self.edges {
            *edge = facet.mirrored(*edge);
        }
        self.turn = -self.turn;
        self
    }

    /// Whether a direction, of any length, lies in the beam.
    pub(crate) fn contains(&self, direction: DVec3) -> bool {
        if direction.dot(self.normal) <= 0.0 {
            return false;
        }
        let Some(&(mut last)) = self.edges.last() else {
            return true;
        };
        for &edge in &self.edges {
            if last.cross(edge).dot(direction) * self.turn > 0.0 {
                return false;
            }
            last = edge;
        }
        true
    }

    /// Probability that a direction with density cos θ/π about the normal lies in the beam.
    pub(crate) fn share(&self) -> f64 {
        if self.edges.is_empty() {
            return 1.0;
        }
        share(&self.edges, self.normal)
    }
}

/// Form factor from a point with this unit normal to a flat convex polygon: the share of density cos θ/π that goes there,
/// what lies below the horizon left out.
pub(crate) fn form_factor(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let mut edges: Edges = corners.iter().map(|&c| c - point).collect();
    clip(&mut edges, normal, 0.0);
    drop_doubles(&mut edges);
    share(&edges, normal)
}

/// The same for all that lies within an outline of edges that run one way around, in any order: all of it above the horizon.
pub(crate) fn form_factor_within(point: DVec3, normal: DVec3, outline: &[[DVec3; 2]]) -> f64 {
    let edges = outline.iter().map(|edge| edge.map(|end| end - point));
    shared(edges, normal)
}

/// Parts of a polygon that may be left of it before it is given up.
const MOST: usize = 64;

/// The same of what opaque triangles leave of the polygon; `None` where that falls into too many parts.
pub(crate) fn form_factor_behind(
    point: DVec3,
    normal: DVec3,
    corners: &[DVec3],
    triangles: impl Iterator<Item = [DVec3; 3]>,
) -> Option<f64> {
    let mut edges: Edges = corners.iter().map(|&c| c - point).collect();
    let [a, b, c, ..] = edges[..] else {
        return Some(0.0);
    };
    // Along this normal the polygon lies deep below the point.
    let down = (b - a).cross(c - a).normalize();
    let down = down * a.dot(down).signum();
    let depth = a.dot(down);
    clip(&mut edges, normal, 0.0);
    let mut parts = vec![edges];
    for triangle in triangles {
        let mut shade: Edges = triangle.iter().map(|&corner| corner - point).collect();
        clip(&mut shade, down, NEAREST * depth);
        // Corners in the polygon's plane are not to be cut off by their rounding.
        clip(&mut shade, -down, -depth * (1.0 + NEAREST));
        // Between corners that stand together there is no plane.
        drop_doubles(&mut shade);
        if shade.len() > 2 {
            parts = parts
                .into_iter()
                .flat_map(|part| beside(part, &shade))
                .collect();
        }
        if parts.len() > MOST {
            return None;
        }
    }
    for part in &mut parts {
        drop_doubles(part);
    }
    Some(parts.iter().map(|part| share(part, normal)).sum())
}

/// What is nearer to a point than this share of a polygon's distance stands beside the polygon, as far as directions tell, and
/// what is as near to its plane stands in it.
const NEAREST: f64 = 1e-9;

/// Sine of the angle below which a corner lies in a plane through the point.
const FLAT: f64 = 1e-13;

/// The convex parts of a convex polygon that are seen beside a convex shade.
fn beside(part: Edges, shade: &[DVec3]) -> Vec<Edges> {
    let next = || shade.iter().cycle().skip(1);
    let turn: f64 = {
        let middle: DVec3 = shade.iter().sum();
        let across = shade.iter().zip(next()).map(|(a, &b)| a.cross(b));
        across.sum::<DVec3>().dot(middle).signum()
    };
    let planes: Vec<DVec3> = shade
        .iter()
        .zip(next())
        .map(|(a, &b)| a.cross(b).normalize_or_zero() * turn)
        .collect();
    let reaches = |part: &[DVec3], plane: DVec3| {
        part.iter()
            .any(|edge| edge.dot(plane) > FLAT * edge.length())
    };
    if planes.iter().any(|&plane| !reaches(&part, plane)) {
        return vec![part];
    }
    let mut left = Vec::new();
    let mut rest = part;
    for plane in planes {
        if reaches(&rest, -plane) {
            let mut outside = rest.clone();
            clip(&mut outside, -plane, 0.0);
            left.push(outside);
            clip(&mut rest, plane, 0.0);
        }
    }
    left
}

/// The share of density cos θ/π that goes through a polygon whose corners lie in these directions.
fn share(edges: &[DVec3], normal: DVec3) -> f64 {
    let Some(&last) = edges.last() else {
        return 0.0;
    };
    let before = [last].into_iter().chain(edges.iter().copied());
    shared(before.zip(edges).map(|(from, &to)| [from, to]), normal)
}

/// Lambert's sum over the edges of a polygon, (1/2π) Σ γ **N**·(**e** × **e**′)/|**e** × **e**′| with γ the angle between
/// their ends.
fn shared(edges: impl Iterator<Item = [DVec3; 2]>, normal: DVec3) -> f64 {
    let mut sum = 0.0;
    for [from, to] in edges {
        let across = from.cross(to);
        let sine = across.length();
        if sine > 0.0 {
            let angle = libm::atan2(sine, from.dot(to));
            sum += angle * across.dot(normal) / sine;
        }
    }
    (sum.abs() / TAU).min(1.0)
}

/// Sine² of the angle below which two edges are one: the plane between them would be noise.
const DOUBLE: f64 = 1e-22;

/// Leaves one of neighbouring edges in one direction.
fn drop_doubles(edges: &mut Edges) {
    let Some(&(mut last)) = edges.last() else {
        return;
    };
    edges.retain(|&mut edge| {
        let across = last.cross(edge).length_squared();
        // From next to an edge its ends are seen in opposite directions, which no plane tells apart either.
        let apart =
            across > DOUBLE * last.length_squared() * edge.length_squared() || last.dot(edge) < 0.0;
        if apart {
            last = edge;
        }
        apart
    });
}

/// Leaves of a polygon, given from the apex, what lies at least at that height along a normal.
fn clip(edges: &mut Edges, normal: DVec3, height: f64) {
    if edges.iter().all(|edge| edge.dot(normal) >= height) {
        return;
    }
    let Some(&(mut last)) = edges.last() else {
        return;
    };
    let mut kept = Edges::new();
    for &edge in edges.iter() {
        let (before, after) = (last.dot(normal) - height, edge.dot(normal) - height);
        if (before < 0.0) != (after < 0.0) {
            kept.push((last * after - edge * before) / (after - before));
        }
        if after >= 0.0 {
            kept.push(edge);
        }
        last = edge;
    }
    *edges = kept;
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, EulerRot};
    use malus_geometry::{Facets, Mesh, Surfaces, shape};
    use std::f64::consts::PI;

    /// The facets of the unit cube seen from inside: their normals, found by area and then by index.
    fn walls() -> Vec<Facet> {
        let mut mesh = Mesh::default();
        let (positions, triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, true);
        mesh.append(&positions, &triangles, 0, 0);
        let surfaces = Surfaces::new(mesh).unwrap();
        Facets::new(&surfaces, surfaces.patches(), |_| true, 0.0, 64)
            .list()
            .to_vec()
    }

    fn wall(normal: DVec3) -> Facet {
        let mut walls = walls().into_iter();
        walls.find(|f| f.normal.distance(normal) < 1e-12).unwrap()
    }

    #[test]
    fn the_walls_of_a_room_fill_the_view() {
        let beam = Beam::hemisphere(DVec3::new(0.2, 0.3, 0.1), DVec3::new(0.6, 0.0, 0.8));
        let shares = walls().into_iter().filter_map(|f| beam.through(&f, None));
        let sum: f64 = shares.map(|b| b.share()).sum();
        assert!((sum - 1.0).abs() < 1e-14, "{sum}");
    }

    #[test]
    fn the_ceiling_has_its_form_factor() {
        // A unit square seen from below its centre at distance 1, parallel: four times the corner formula
        // (1/2π)[X/√(1+X²) atan(Y/√(1+X²)) + …] with X = Y = ½.
        let x: f64 = 0.5;
        let root = (1.0 + x * x).sqrt();
        let exact = 4.0 / (2.0 * PI) * 2.0 * (x / root) * (x / root).atan();
        let beam = Beam::hemisphere(DVec3::new(0.5, 0.5, 0.0), DVec3::Z);
        let share = beam.through(&wall(DVec3::NEG_Z), None).unwrap().share();
        assert!((share - exact).abs() < 1e-14, "{share} {exact}");
    }

    #[test]
    fn chains_of_two_mirrors_fill_what_one_sees() {
        // Whatever leaves through a wall is mirrored there and meets one of the five others next.
        let beam = Beam::hemisphere(DVec3::new(0.7, 0.4, 0.2), DVec3::Z);
        let first = wall(DVec3::NEG_X);
        let seen = beam.through(&first, None).unwrap();
        let behind = seen.clone().mirrored(&first);
        let others = walls().into_iter().filter(|f| f.normal != first.normal);
        let sum: f64 = others
            .filter_map(|f| behind.through(&f, Some(&first)))
            .map(|b| b.share())
            .sum();
        assert!((sum - seen.share()).abs() < 1e-14);
        // And a direction lies in just one of them.
        let mut inside = 0;
        for facet in walls().into_iter().filter(|f| f.normal != first.normal) {
            let direction = DVec3::new(-0.9, 0.21, 0.37);
            inside += i32::from(
                behind
                    .through(&facet, Some(&first))
                    .is_some_and(|b| b.contains(direction)),
            );
        }
        assert_eq!(inside, 1);
    }

    #[test]
    fn what_opaque_triangles_leave_of_a_polygon_has_the_form_factor_of_its_parts() {
        let square = |least: f64, most: f64, z: f64| {
            [(least, least), (most, least), (most, most), (least, most)]
                .map(|(x, y)| DVec3::new(x, y, z))
        };
        let halves = |[a, b, c, d]: [DVec3; 4]| [[a, b, c], [a, c, d]];
        let eye = DVec3::new(0.5, 0.5, 0.0);
        let lamp = square(0.0, 1.0, 1.0);
        let factor = |triangles: &[[DVec3; 3]]| {
            form_factor_behind(eye, DVec3::Z, &lamp, triangles.iter().copied()).unwrap()
        };
        let whole = form_factor(eye, DVec3::Z, &lamp);
        assert!((factor(&[]) - whole).abs() < 1e-15);
        // Half as high, the middle square of a ninth hides what one twice as wide would in the plane of the lamp.
        let sheet = halves(square(0.4, 0.6, 0.5));
        let hidden = form_factor(eye, DVec3::Z, &square(0.3, 0.7, 1.0));
        assert!((factor(&sheet) - (whole - hidden)).abs() < 1e-14);
        // What is hidden twice, from either side, is hidden once.
        let [[a, b, c], other] = sheet;
        let twice = [[c, b, a], other, [a, b, c], other];
        assert!((factor(&twice) - (whole - hidden)).abs() < 1e-14);
        // A wall through the plane of the lamp, seen edge-on, hides nothing; behind the lamp nothing does.
        let wall = [
            DVec3::new(0.5, 0.0, 0.0),
            DVec3::new(0.5, 1.0, 0.0),
            DVec3::new(0.5, 0.5, 2.0),
        ];
        let behind = halves(square(-1.0, 2.0, 1.5));
        assert!((factor(&[wall]) - whole).abs() < 1e-14);
        assert!((factor(&behind) - whole).abs() < 1e-14);
        // A sheet over all of it leaves nothing, and one that reaches below the eye half of it.
        assert!(factor(&halves(square(0.0, 1.0, 0.5))) < 1e-15);
        let steep = [
            [(0.5, -9.0, 0.5), (0.5, 9.0, 0.5), (9.0, 9.0, -3.0)],
            [(0.5, -9.0, 0.5), (9.0, 9.0, -3.0), (9.0, -9.0, -3.0)],
        ];
        let steep = steep.map(|it| it.map(|(x, y, z)| DVec3::new(x, y, z)));
        assert!((factor(&steep) - 0.5 * whole).abs() < 1e-14);
        // Too many parts are left to chance.
        let comb = (0..200).map(|tooth| {
            let x = f64::from(tooth) / 200.0;
            [(x, -1.0), (x + 0.002, -1.0), (x + 0.001, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.9))
        });
        assert_eq!(form_factor_behind(eye, DVec3::Z, &lamp, comb), None);
    }

    #[test]
    fn blockers_with_corners_in_the_plane_of_a_polygon_hide_what_they_hide_beside_it() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(0x5851_F42D_4C95_7F2D)
                .wrapping_add(0x1405_7B7E_F767_814F);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..4000 {
            let turned = DQuat::from_euler(EulerRot::XYZ, uniform(), uniform(), uniform());
            let mut at = |z: f64| turned * DVec3::new(uniform(), uniform(), z);
            let lamp = [at(0.7), at(0.7), at(0.7)];
            let eye = at(0.0);
            let heights = [0.2, 0.7, 0.9];
            let blocker = |first: usize| {
                // Never wholly in the plane, where it hides nothing.
                [0, 1, 2].map(|corner| heights[(first >> (2 * corner) & 3).min(2)])
            };
            let heights = blocker((uniform() * 64.0) as usize);
            if heights
                .iter()
                .all(|height: &f64| height.total_cmp(&0.7).is_eq())
            {
                continue;
            }
            let mut at = |z: f64| turned * DVec3::new(uniform(), uniform(), z);
            let corners = heights.map(&mut at);
            let moved = corners.map(|corner| corner + 1e-8 * (at(0.0) - corner));
            let up = turned * DVec3::Z;
            let factor =
                |blocker| form_factor_behind(eye, up, &lamp, [blocker].into_iter()).unwrap();
            let (exact, near) = (factor(corners), factor(moved));
            assert!(
                (exact - near).abs() < 1e-6,
                "{exact} {near}: {corners:?} before {lamp:?} from {eye}"
            );
        }
    }
}
