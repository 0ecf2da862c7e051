//! The parts of an object, from what tobj makes of it.

use super::super::Part;
use super::super::polygon::Clipper;
use super::feed::Tally;
use glam::{DAffine3, DVec3};
use std::collections::HashMap;

/// A part in the making.
pub(super) struct Growing {
    pub part: Part,
    /// Where each position is in the part. tobj begins a mesh with vertices of its own at every `usemtl`; those
    /// of one object and one material are one again here.
    places: HashMap<[u64; 3], u32>,
    faces: u32,
}

impl Growing {
    pub(super) fn new(material: Option<usize>) -> Self {
        Self {
            part: Part {
                material,
                positions: Vec::new(),
                triangles: Vec::new(),
                faces: Vec::new(),
            },
            places: HashMap::new(),
            faces: 0,
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
        let Part {
            positions,
            triangles,
            faces,
            ..
        } = &mut self.part;
        let points = mesh.positions.as_chunks::<3>().0.iter();
        let places: Vec<u32> = points
            .map(|&point| {
                let position = placement.transform_point3(DVec3::from_array(point));
                let bits = position.to_array().map(f64::to_bits);
                *self.places.entry(bits).or_insert_with(|| {
                    positions.push(position);
                    positions.len() as u32 - 1
                })
            })
            .collect();
        // tobj gives no numbers of corners where all faces are triangles.
        let mut arities = mesh.face_arities.iter();
        let mut indices = &mesh.indices[..];
        let mut corners = Vec::new();
        while !indices.is_empty() {
            let (face, rest) = indices.split_at(arities.next().map_or(3, |&arity| arity as usize));
            indices = rest;
            let vertex = |index: u32| places[index as usize];
            corners.clear();
            corners.extend(face.iter().map(|&i| positions[vertex(i) as usize]));
            let clipped = clipper.clip(&corners);
            let cut = clipped.triangles.iter();
            triangles.extend(cut.map(|t| t.map(|corner| vertex(face[corner as usize]))));
            faces.resize(triangles.len(), self.faces);
            self.faces += 1;
            // Triangles are simple.
            if let Some(line) = (face.len() > 3).then(|| lines.next()).flatten()
                && !clipped.simple
            {
                ragged.add(line);
            }
        }
    }
}
