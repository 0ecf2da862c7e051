//! The whole scene as triangles.

use crate::Triangle;
use glam::DVec3;

/// The triangles of a scene in file order, each with the surface it has and the object it belongs to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, in m.
    pub positions: Vec<DVec3>,
    /// Three indices into `positions` a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// One surface (material) index a triangle.
    pub surfaces: Vec<u32>,
    /// One object index a triangle.
    pub objects: Vec<u32>,
}

impl Mesh {
    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there is no triangle at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Triangle `index`, which must be less than [`len`](Self::len).
    #[must_use]
    pub fn triangle(&self, index: usize) -> Triangle {
        let vertices = self.triangles[index].map(|vertex| self.positions[vertex as usize]);
        Triangle { vertices }
    }

    /// Adds triangles that index into their own `positions`, all of one surface and one object.
    ///
    /// A mesh can number 2³² vertices; indices beyond that are kept out of range, for
    /// [`Surfaces::new`](crate::Surfaces::new) to refuse.
    pub fn append(
        &mut self,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        surface: u32,
        object: u32,
    ) {
        let first = u32::try_from(self.positions.len()).unwrap_or(u32::MAX);
        self.positions.extend_from_slice(positions);
        self.triangles.extend(
            triangles
                .iter()
                .map(|triangle| triangle.map(|vertex| vertex.saturating_add(first))),
        );
        self.surfaces.resize(self.triangles.len(), surface);
        self.objects.resize(self.triangles.len(), object);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn appended_triangles_keep_their_own_vertices() {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let lifted = positions.map(|position| position + DVec3::Z);
        let mut mesh = Mesh::default();
        mesh.append(&positions, &[[0, 1, 2]], 4, 0);
        mesh.append(&lifted, &[[2, 1, 0]], 7, 1);
        assert_eq!(mesh.triangle(0).vertices, positions);
        assert_eq!(mesh.triangle(1).vertices, [lifted[2], lifted[1], lifted[0]]);
        assert_eq!((mesh.surfaces, mesh.objects), (vec![4, 7], vec![0, 1]));
    }
}
