//! The parts of an object, from what tobj makes of it.

use super::super::Part;
use super::super::polygon::Clipper;
use super::scan::Tally;
use glam::{DAffine3, DVec3};

/// A part in the making: the faces of one object and one material.
pub(super) struct Growing {
    pub material: Option<usize>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The face of each triangle.
    faces: Vec<u32>,
    count: u32,
}

impl Growing {
    pub(super) fn new(material: Option<usize>) -> Self {
        Self {
            material,
            positions: Vec::new(),
            triangles: Vec::new(),
            faces: Vec::new(),
            count: 0,
        }
    }

    /// Adds the faces of a mesh, cut into triangles. `lines` has the lines of all polygons to come; those that
    /// are not simple are counted as `ragged`.
    pub(super) fn add(
        &mut self,
        mesh: &tobj::Mesh,
        placement: DAffine3,
        clipper: &mut Clipper,
        lines: &mut impl Iterator<Item = u64>,
        ragged: &mut Tally,
    ) {
        let base = self.positions.len() as u32;
        let points = mesh.positions.as_chunks::<3>().0.iter();
        self.positions
            .extend(points.map(|&p| placement.transform_point3(DVec3::from_array(p))));
        // tobj gives no numbers of corners where all faces are triangles.
        let mut arities = mesh.face_arities.iter();
        let mut indices = &mesh.indices[..];
        let mut corners = Vec::new();
        while !indices.is_empty() {
            let (face, rest) = indices.split_at(arities.next().map_or(3, |&arity| arity as usize));
            indices = rest;
            corners.clear();
            corners.extend(face.iter().map(|i| self.positions[(base + i) as usize]));
            let clipped = clipper.clip(&corners);
            let cut = clipped.triangles.iter();
            self.triangles
                .extend(cut.map(|t| t.map(|corner| base + face[corner as usize])));
            self.faces.resize(self.triangles.len(), self.count);
            self.count += 1;
            // Triangles are simple.
            if let Some(line) = (face.len() > 3).then(|| lines.next()).flatten()
                && !clipped.simple
            {
                ragged.add(line);
            }
        }
    }

    /// The part, with each position once: tobj begins a mesh with vertices of its own at every `usemtl`, `g`
    /// and `o`.
    pub(super) fn finish(mut self) -> Part {
        let bits = |i: u32| self.positions[i as usize].to_array().map(f64::to_bits);
        let mut order: Vec<u32> = (0..).take(self.positions.len()).collect();
        order.sort_unstable_by_key(|&i| (bits(i), i));
        let mut first = vec![u32::MAX; order.len()];
        for same in order.chunk_by(|&a, &b| bits(a) == bits(b)) {
            for &i in same {
                first[i as usize] = same[0];
            }
        }
        drop(order);
        for corner in self.triangles.iter_mut().flatten() {
            *corner = first[*corner as usize];
        }
        first.fill(u32::MAX);
        Part::gathered(
            self.material,
            self.triangles,
            self.faces,
            &self.positions,
            &mut first,
        )
    }
}
