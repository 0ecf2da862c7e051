//! A mesh parted into flat patches: neighbouring triangles of one surface and one plane.

use crate::Surfaces;
use crate::weld::weld;

/// Cosine between the normals of a patch and of a triangle below which the triangle is no part of it: what is nearly
/// flat to within the tolerance may still be a needle that stands across.
const PARALLEL: f64 = 0.999;

/// Flat patches of a mesh, none of which have a triangle in common.
#[derive(Debug)]
pub struct Patches {
    /// Triangles of each, its largest first, one patch after the other.
    triangles: Vec<u32>,
    /// Where each begins in that list.
    starts: Vec<u32>,
    /// Area of each, in m².
    areas: Vec<f64>,
}

impl Patches {
    /// The patches of the triangles that are `wanted`; each grows from the largest triangle that is left.
    #[must_use]
    pub fn new(surfaces: &Surfaces, wanted: impl Fn(u32) -> bool) -> Self {
        let mut found = Self {
            triangles: Vec::new(),
            starts: Vec::new(),
            areas: Vec::new(),
        };
        let triangles: Vec<u32> = (0..surfaces.len() as u32).filter(|&t| wanted(t)).collect();
        if triangles.is_empty() {
            return found;
        }
        let neighbours = Neighbours::new(surfaces, &triangles);
        let area = |triangle: u32| surfaces.triangle(triangle).area();
        let mut free = vec![false; surfaces.len()];
        let mut seeds: Vec<(f64, u32)> = Vec::with_capacity(triangles.len());
        for &triangle in &triangles {
            free[triangle as usize] = true;
            seeds.push((area(triangle), triangle));
        }
        seeds.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        found.triangles.reserve_exact(triangles.len());
        for (_, seed) in seeds {
            if free[seed as usize] {
                let start = found.triangles.len();
                grow(surfaces, &neighbours, seed, &mut free, &mut found.triangles);
                let patch = found.triangles[start..].iter();
                found.starts.push(start as u32);
                found.areas.push(patch.map(|&t| area(t)).sum());
            }
        }
        found
    }

    /// The patches: area in m², and triangles, the largest first.
    pub fn iter(&self) -> impl Iterator<Item = (f64, &[u32])> {
        let ends = self.starts.iter().skip(1).copied();
        let ends = ends.chain([self.triangles.len() as u32]);
        let ranges = self.starts.iter().zip(ends);
        let lists = ranges.map(|(&start, end)| &self.triangles[start as usize..end as usize]);
        self.areas.iter().copied().zip(lists)
    }
}

/// Which triangles share an edge.
struct Neighbours {
    /// One vertex for all in its place.
    welded: Vec<u32>,
    /// Where the triangles about each vertex begin in their list, and the end of the list.
    starts: Vec<u32>,
    about: Vec<u32>,
}

impl Neighbours {
    fn new(surfaces: &Surfaces, triangles: &[u32]) -> Self {
        let mesh = surfaces.mesh();
        let corners = |&triangle: &u32| mesh.triangles[triangle as usize];
        let used: Vec<[u32; 3]> = triangles.iter().map(corners).collect();
        let welded = weld(mesh, &used, surfaces.tolerance());
        let mut starts = vec![0; welded.len() + 1];
        for &vertex in used.iter().flatten() {
            starts[welded[vertex as usize] as usize] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        // Filled from the back, so that each list ends where the next begins and rises.
        let mut about = vec![0; end as usize];
        for (corners, &triangle) in used.iter().zip(triangles).rev() {
            for &vertex in corners {
                let start = &mut starts[welded[vertex as usize] as usize];
                *start -= 1;
                about[*start as usize] = triangle;
            }
        }
        Self {
            welded,
            starts,
            about,
        }
    }

    fn corners(&self, surfaces: &Surfaces, triangle: u32) -> [u32; 3] {
        surfaces.mesh().triangles[triangle as usize].map(|v| self.welded[v as usize])
    }

    /// The triangles about a vertex, in order.
    fn about(&self, vertex: u32) -> &[u32] {
        let [start, end] = [vertex, vertex + 1].map(|v| self.starts[v as usize] as usize);
        &self.about[start..end]
    }

    fn at<'a>(&'a self, surfaces: &'a Surfaces, triangle: u32) -> impl Iterator<Item = u32> + 'a {
        let [a, b, c] = self.corners(surfaces, triangle);
        [(a, b), (b, c), (c, a)]
            .into_iter()
            .flat_map(move |(one, other)| {
                // About the hub of a fan lie all of its triangles.
                let ends = [(one, other), (other, one)];
                let [about, next] = ends.map(|(from, to)| (self.about(from), to));
                let (about, other) = if next.0.len() < about.0.len() {
                    next
                } else {
                    about
                };
                let about = about.iter().copied();
                about.filter(move |&t| self.corners(surfaces, t).contains(&other))
            })
    }
}

/// Adds to `patch` the free triangles about the `seed` that lie in its plane and are of its surface, itself first; they
/// are free no longer.
fn grow(
    surfaces: &Surfaces,
    neighbours: &Neighbours,
    seed: u32,
    free: &mut [bool],
    patch: &mut Vec<u32>,
) {
    let normal = surfaces.normal(seed);
    let height = surfaces.triangle(seed).vertices[0].dot(normal);
    let tolerance = surfaces.tolerance();
    let mut next = patch.len();
    patch.push(seed);
    free[seed as usize] = false;
    while let Some(&triangle) = patch.get(next) {
        next += 1;
        for other in neighbours.at(surfaces, triangle) {
            if free[other as usize]
                && surfaces.surface(other) == surfaces.surface(seed)
                && surfaces.normal(other).dot(normal).abs() > PARALLEL
                && surfaces
                    .triangle(other)
                    .vertices
                    .iter()
                    .all(|v| (v.dot(normal) - height).abs() <= tolerance)
            {
                free[other as usize] = false;
                patch.push(other);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesh, shape};
    use glam::DVec3;

    #[test]
    fn a_patch_is_of_one_surface_and_joined_across_seams() {
        let mut mesh = Mesh::default();
        for (left, surface) in [(0.0, 0), (1.0, 0), (2.0, 1), (4.0, 1)] {
            let corner = DVec3::X * left;
            let (positions, triangles) = shape::rectangle(corner, DVec3::X, DVec3::Y);
            mesh.append(&positions, &triangles, surface, surface);
        }
        let surfaces = Surfaces::new(mesh).unwrap();
        let all = Patches::new(&surfaces, |_| true);
        let found: Vec<(f64, usize)> = all.iter().map(|(area, it)| (area, it.len())).collect();
        assert_eq!(found, [(2.0, 4), (1.0, 2), (1.0, 2)]);
        let mut triangles: Vec<u32> = all.iter().flat_map(|(_, it)| it).copied().collect();
        triangles.sort_unstable();
        assert_eq!(triangles, [0, 1, 2, 3, 4, 5, 6, 7]);
        let some = Patches::new(&surfaces, |triangle| triangle > 3);
        assert_eq!(some.iter().count(), 2);
        assert_eq!(Patches::new(&surfaces, |_| false).iter().count(), 0);
    }
}
