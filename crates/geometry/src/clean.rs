//! Leaving out what cannot be hit: triangles without area, and all but the last of exact duplicates.

use crate::{Error, Mesh};
use glam::DVec3;
use std::collections::BTreeMap;

/// What was left out of an object before anything is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Cleaned {
    /// Index of the object.
    pub object: u32,
    /// Triangles without area (no higher than the tolerance of a crossing).
    pub degenerate: usize,
    /// Triangles of which an exact duplicate follows: the same three positions in any order.
    pub duplicates: usize,
}

/// Which triangles of a mesh to leave out.
pub(crate) struct Waste {
    /// Degenerate triangles, ascending.
    pub degenerate: Vec<u32>,
    /// Duplicates, ascending, each with the triangle that stays in its place.
    pub duplicates: Vec<(u32, u32)>,
}

/// A sphere around all vertices in use: centre of their box and greatest distance from it, in m.
pub(crate) fn bounding_sphere(mesh: &Mesh) -> (DVec3, f64) {
    let used = || {
        mesh.triangles
            .iter()
            .flatten()
            .map(|&vertex| mesh.positions[vertex as usize])
    };
    let least = used().fold(DVec3::INFINITY, DVec3::min);
    let most = used().fold(DVec3::NEG_INFINITY, DVec3::max);
    if !least.is_finite() {
        return (DVec3::ZERO, 0.0);
    }
    let centre = 0.5 * (least + most);
    let radius = used().fold(0.0, |radius: f64, position| {
        radius.max((position - centre).length_squared())
    });
    (centre, radius.sqrt())
}

/// Distance within which a line that passes an edge still hits it, in m: 2⁻⁴² of the scene.
pub(crate) fn slack(centre: DVec3, radius: f64) -> f64 {
    (centre.length() + radius) / (1_u64 << 42) as f64
}

/// Refuses a mesh that nothing can be computed from.
pub(crate) fn check(mesh: &Mesh) -> Result<(), Error> {
    let count = mesh.len();
    if mesh.surfaces.len() != count || mesh.objects.len() != count {
        return Err(Error::Uneven {
            triangles: count,
            surfaces: mesh.surfaces.len(),
            objects: mesh.objects.len(),
        });
    }
    let allowed = i32::MAX as usize;
    if count > allowed {
        return Err(Error::TooMany {
            triangles: count,
            allowed,
        });
    }
    for (triangle, (vertices, &object)) in (0..).zip(mesh.triangles.iter().zip(&mesh.objects)) {
        for &vertex in vertices {
            let Some(&position) = mesh.positions.get(vertex as usize) else {
                return Err(Error::NoSuchVertex {
                    object,
                    triangle,
                    vertex,
                    count: mesh.positions.len(),
                });
            };
            // Squares and products of coordinates must stay finite too; NaN fails the comparison.
            if !(position.abs().max_element() < 1e30 && position.is_finite()) {
                return Err(Error::NotFinite {
                    object,
                    vertex,
                    position,
                });
            }
        }
    }
    Ok(())
}

/// Finds triangles lower than `slack` over their longest edge, and all but the last of equal ones.
pub(crate) fn waste(mesh: &Mesh, slack: f64) -> Waste {
    let mut degenerate = Vec::new();
    let mut keyed = Vec::with_capacity(mesh.len());
    for (index, _) in (0_u32..).zip(&mesh.triangles) {
        let triangle = mesh.triangle(index as usize);
        if triangle.area_vector().length() <= slack * triangle.longest_edge() {
            degenerate.push(index);
        } else {
            keyed.push((hash(&key(mesh, index)), index));
        }
    }
    keyed.sort_unstable();
    let mut duplicates = Vec::new();
    for run in keyed.chunk_by_mut(|left, right| left.0 == right.0) {
        if run.len() > 1 {
            run.sort_by_cached_key(|&(_, index)| (key(mesh, index), index));
            for same in run.chunk_by(|left, right| key(mesh, left.1) == key(mesh, right.1)) {
                let (&(_, kept), dropped) = same.split_last().expect("a chunk is never empty");
                duplicates.extend(dropped.iter().map(|&(_, index)| (index, kept)));
            }
        }
    }
    duplicates.sort_unstable();
    Waste {
        degenerate,
        duplicates,
    }
}

impl Waste {
    /// All triangles to leave out.
    pub fn indices(&self) -> impl Iterator<Item = u32> {
        let duplicates = self.duplicates.iter().map(|&(dropped, _)| dropped);
        self.degenerate.iter().copied().chain(duplicates)
    }

    /// How much of it each object has.
    pub fn counted(&self, mesh: &Mesh) -> Vec<Cleaned> {
        let mut counts: BTreeMap<u32, [usize; 2]> = BTreeMap::new();
        let object = |triangle: u32| mesh.objects[triangle as usize];
        for &index in &self.degenerate {
            counts.entry(object(index)).or_default()[0] += 1;
        }
        for &(index, _) in &self.duplicates {
            counts.entry(object(index)).or_default()[1] += 1;
        }
        let row = |(object, [degenerate, duplicates]): (u32, [usize; 2])| Cleaned {
            object,
            degenerate,
            duplicates,
        };
        counts.into_iter().map(row).collect()
    }

    /// Takes it out of a mesh, whose other triangles keep their order and whose vertices all stay.
    pub fn remove_from(&self, mesh: &mut Mesh) {
        if self.indices().next().is_none() {
            return;
        }
        let mut keep = vec![true; mesh.len()];
        for index in self.indices() {
            keep[index as usize] = false;
        }
        retain(&mut mesh.triangles, &keep);
        retain(&mut mesh.surfaces, &keep);
        retain(&mut mesh.objects, &keep);
    }
}

fn retain<T>(list: &mut Vec<T>, keep: &[bool]) {
    let mut kept = keep.iter();
    list.retain(|_| kept.next().copied().unwrap_or(true));
}

/// A triangle's positions in an order that does not depend on the order of its vertices, as bits.
fn key(mesh: &Mesh, index: u32) -> [[u64; 3]; 3] {
    let mut key = mesh.triangle(index as usize).vertices.map(|position| {
        // Zero has two signs and one place.
        (position + DVec3::ZERO).to_array().map(f64::to_bits)
    });
    key.sort_unstable();
    key
}

/// FNV-1a over 64-bit words with a final mix: spreads keys, nothing more.
fn hash(key: &[[u64; 3]; 3]) -> u64 {
    let mixed = key
        .iter()
        .flatten()
        .fold(0xcbf2_9ce4_8422_2325_u64, |state, &word| {
            let state = (state ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            state ^ (state >> 32)
        });
    mixed ^ (mixed >> 29)
}
