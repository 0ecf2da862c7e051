//! Surfaces that lie in one another: the later one exists, the earlier one is hidden there.

use crate::bvh::Tree;
use crate::polygon::{Plane, Polygon};
use crate::{Mesh, Triangle};
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;

/// Cosine² of the angle beyond which planes are not parallel, however small the triangles.
const PARALLEL: f64 = 0.98;

/// An area over which one surface hides another that lies in the same place.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Coincidence {
    /// Object of the earlier triangles, which do not exist there.
    pub hidden_object: u32,
    /// Surface of the earlier triangles.
    pub hidden_surface: u32,
    /// Object of the later triangles, which exist there.
    pub covering_object: u32,
    /// Surface of the later triangles.
    pub covering_surface: u32,
    /// Hidden area in m².
    pub area: f64,
}

/// Object and surface of a hidden triangle and of the one that covers it.
pub(crate) type Kind = [u32; 4];

/// Which triangles are covered, and by which later ones.
#[derive(Debug, Default)]
pub(crate) struct Coverings {
    /// Covered triangles, ascending.
    hidden: Vec<Hidden>,
    /// Covering triangles, those of each hidden one together and ascending.
    covering: Vec<u32>,
    /// One bit a triangle: whether it is covered at all. Empty where nothing is.
    covered: Vec<u64>,
    /// Covered triangles before each word of these bits.
    before: Vec<u32>,
}

/// A triangle that others cover in part.
#[derive(Debug)]
struct Hidden {
    triangle: u32,
    /// Its covering triangles, in the list of all.
    covering: Range<usize>,
    /// Corners of a box around them: most lines that cross a large triangle pass far from a small cover.
    least: DVec3,
    most: DVec3,
}

impl Coverings {
    /// Pairs of parallel triangles whose overlap lies within `tolerance` (in m) of both planes and is wider than it.
    pub fn of(mesh: &Mesh, tree: &Tree, tolerance: f64) -> Self {
        let mut pairs = Vec::new();
        let mut candidates = Vec::new();
        for (index, _) in (0_u32..).zip(&mesh.triangles) {
            let hidden = mesh.triangle(index as usize);
            let vector = hidden.area_vector();
            candidates.clear();
            tree.near(&hidden.vertices, tolerance, |other| {
                if other > index {
                    candidates.push(other);
                }
            });
            candidates.retain(|&other| {
                let other = mesh.triangle(other as usize).area_vector();
                let dot = vector.dot(other);
                dot * dot >= PARALLEL * vector.length_squared() * other.length_squared()
            });
            if candidates.is_empty() {
                continue;
            }
            let plane = Plane::of(&hidden);
            let polygon = plane.polygon(&hidden);
            for &other in &candidates {
                if coincide(&plane, &polygon, &mesh.triangle(other as usize), tolerance) {
                    pairs.push((index, other));
                }
            }
        }
        pairs.sort_unstable();
        let mut coverings = Self::default();
        if !pairs.is_empty() {
            coverings.covered.resize(mesh.len().div_ceil(64), 0);
        }
        for same in pairs.chunk_by(|one, next| one.0 == next.0) {
            let triangle = same[0].0;
            coverings.covered[triangle as usize / 64] |= 1 << (triangle % 64);
            let first = coverings.covering.len();
            coverings.covering.extend(same.iter().map(|pair| pair.1));
            let corners = || {
                same.iter()
                    .flat_map(|pair| mesh.triangle(pair.1 as usize).vertices)
            };
            coverings.hidden.push(Hidden {
                triangle,
                covering: first..coverings.covering.len(),
                least: corners().fold(DVec3::INFINITY, DVec3::min) - tolerance,
                most: corners().fold(DVec3::NEG_INFINITY, DVec3::max) + tolerance,
            });
        }
        coverings.before = coverings
            .covered
            .iter()
            .scan(0, |sum, bits| {
                let before = *sum;
                *sum += bits.count_ones();
                Some(before)
            })
            .collect();
        coverings
    }

    /// Whether some later triangle covers part of this one.
    #[inline]
    pub fn any(&self, triangle: u32) -> bool {
        self.covered
            .get(triangle as usize / 64)
            .is_some_and(|bits| bits >> (triangle % 64) & 1 == 1)
    }

    fn hidden(&self, triangle: u32) -> Option<&Hidden> {
        if !self.any(triangle) {
            return None;
        }
        let (word, bit) = (triangle as usize / 64, triangle % 64);
        let below = self.covered[word] & !(u64::MAX << bit);
        self.hidden
            .get((self.before[word] + below.count_ones()) as usize)
    }

    /// The later triangles that cover part of this one, the latest first.
    pub fn over(&self, triangle: u32) -> impl Iterator<Item = u32> {
        let range = self
            .hidden(triangle)
            .map_or(0..0, |hidden| hidden.covering.clone());
        self.covering[range].iter().rev().copied()
    }

    /// The later triangles that may cover this point of a triangle, the latest first.
    #[inline]
    pub fn over_point(&self, triangle: u32, point: DVec3) -> impl Iterator<Item = u32> {
        let hidden = self
            .hidden(triangle)
            .filter(|hidden| point.cmpge(hidden.least).all() && point.cmple(hidden.most).all());
        let range = hidden.map_or(0..0, |hidden| hidden.covering.clone());
        self.covering[range].iter().rev().copied()
    }

    /// Area in m² that each covering triangle hides, the latest first, and what is left of the hidden one.
    fn shares(&self, mesh: &Mesh, hidden: u32) -> (Vec<(u32, f64)>, f64) {
        let triangle = mesh.triangle(hidden as usize);
        let plane = Plane::of(&triangle);
        let mut left = vec![plane.polygon(&triangle)];
        let mut before: f64 = triangle.area();
        let mut shares = Vec::new();
        for covering in self.over(hidden) {
            let cover = plane.polygon(&mesh.triangle(covering as usize));
            left = left
                .into_iter()
                .flat_map(|piece| piece.minus(&cover))
                .collect();
            let after = left.iter().map(Polygon::area).sum();
            shares.push((covering, before - after));
            before = after;
        }
        (shares, before)
    }

    /// Area of a triangle that no later one covers, in m².
    pub fn exposed_area(&self, mesh: &Mesh, triangle: u32) -> f64 {
        if self.any(triangle) {
            self.shares(mesh, triangle).1
        } else {
            mesh.triangle(triangle as usize).area()
        }
    }

    /// Adds up who hides how much of whom; each place counts once, for the latest surface there.
    pub fn add_to(&self, mesh: &Mesh, areas: &mut BTreeMap<Kind, f64>) {
        for &Hidden {
            triangle: hidden, ..
        } in &self.hidden
        {
            let whole = mesh.triangle(hidden as usize).area();
            for (covering, area) in self.shares(mesh, hidden).0 {
                if area > 1e-12 * whole {
                    *areas.entry(kind(mesh, hidden, covering)).or_default() += area;
                }
            }
        }
    }
}

/// What a pair of triangles is booked under.
pub(crate) fn kind(mesh: &Mesh, hidden: u32, covering: u32) -> Kind {
    let (hidden, covering) = (hidden as usize, covering as usize);
    [
        mesh.objects[hidden],
        mesh.surfaces[hidden],
        mesh.objects[covering],
        mesh.surfaces[covering],
    ]
}

/// The sums of [`Coverings::add_to`] as a list.
pub(crate) fn list(areas: BTreeMap<Kind, f64>) -> Vec<Coincidence> {
    let row = |(kind, area): (Kind, f64)| Coincidence {
        hidden_object: kind[0],
        hidden_surface: kind[1],
        covering_object: kind[2],
        covering_surface: kind[3],
        area,
    };
    areas.into_iter().map(row).collect()
}

/// Whether another triangle lies in a plane over an area that is wider than the tolerance in every direction, so that
/// triangles that share or touch an edge do not count.
fn coincide(plane: &Plane, polygon: &Polygon, other: &Triangle, tolerance: f64) -> bool {
    let other = plane.polygon(other);
    if other.0.iter().all(|corner| corner.z > tolerance)
        || other.0.iter().all(|corner| corner.z < -tolerance)
        || polygon.separates(&other, tolerance)
        || other.separates(polygon, tolerance)
    {
        return false;
    }
    let common = other.intersection(polygon);
    common.area() > tolerance * common.width()
        && common.0.iter().all(|corner| corner.z.abs() <= tolerance)
}

#[cfg(test)]
mod tests;
