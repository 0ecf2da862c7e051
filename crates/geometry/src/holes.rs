//! Closed chains of edges at which only one triangle ends.

use crate::Mesh;
use crate::edges::{self, Use};
use glam::DVec3;
use std::collections::BTreeMap;

/// A rim: a chain of edges of one triangle each, where the scene is open.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Hole {
    /// Objects whose edges make up the rim, ascending.
    pub objects: Vec<u32>,
    /// Number of edges.
    pub edges: usize,
    /// Length of the rim in m.
    pub length: f64,
    /// Area in m² of the hole, or of the sheet that the rim surrounds: that of the surface of least twist, exact where
    /// the rim is plane.
    pub area: f64,
    /// Unit normal that a face closing the hole would have, wound as its neighbours are; 0 where there is no area.
    pub normal: DVec3,
    /// Lower corner of the rim's box, in m.
    pub min: DVec3,
    /// Upper corner of the rim's box, in m.
    pub max: DVec3,
}

/// Chains the edges of one triangle in the whole scene, the largest hole first.
pub(crate) fn of(mesh: &Mesh, uses: &[Use]) -> Vec<Hole> {
    let open: Vec<Use> = edges::by_edge(uses)
        .filter(|edge| edge.len() == 1)
        .map(|edge| edge[0])
        .collect();
    let mut at: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (index, edge) in open.iter().enumerate() {
        for end in edge.ends {
            at.entry(end).or_default().push(index);
        }
    }
    let mut taken = vec![false; open.len()];
    let mut holes = Vec::new();
    for start in 0..open.len() {
        if taken[start] {
            continue;
        }
        let mut chain = Chain::new(&open[start]);
        taken[start] = true;
        loop {
            // Where several rims meet, one object's rim goes on along that object.
            let last = chain.edges[chain.edges.len() - 1];
            let object = mesh.objects[last.triangle as usize];
            let end = chain.corners[chain.corners.len() - 1];
            let next = at[&end]
                .iter()
                .copied()
                .filter(|&index| !taken[index])
                .min_by_key(|&index| {
                    (mesh.objects[open[index].triangle as usize] != object, index)
                });
            let Some(next) = next else {
                break;
            };
            taken[next] = true;
            chain.push(open[next]);
            // A rim closes as soon as it comes back to any of its corners.
            if let Some(part) = chain.closed() {
                holes.push(part.hole(mesh));
                if chain.edges.is_empty() {
                    break;
                }
            }
        }
        if !chain.edges.is_empty() {
            holes.push(chain.hole(mesh));
        }
    }
    holes.sort_by(|one, other| {
        (other.area.total_cmp(&one.area)).then(other.length.total_cmp(&one.length))
    });
    holes
}

/// Edges in a row, with one corner more than there are edges.
struct Chain {
    edges: Vec<Use>,
    corners: Vec<u32>,
}

impl Chain {
    /// Starts along the edge as the triangle's neighbour would run, against its own winding.
    fn new(edge: &Use) -> Self {
        let [low, high] = edge.ends;
        Self {
            edges: vec![*edge],
            corners: if edge.forward {
                vec![high, low]
            } else {
                vec![low, high]
            },
        }
    }

    fn push(&mut self, edge: Use) {
        let end = self.corners[self.corners.len() - 1];
        self.corners.push(if edge.ends[0] == end {
            edge.ends[1]
        } else {
            edge.ends[0]
        });
        self.edges.push(edge);
    }

    /// Takes off the end of the chain if it has come back to a corner passed before.
    fn closed(&mut self) -> Option<Self> {
        let (end, before) = self.corners.split_last()?;
        let back = before.iter().rposition(|corner| corner == end)?;
        let part = Self {
            edges: self.edges.split_off(back),
            corners: self.corners[back..].to_vec(),
        };
        self.corners.truncate(back + 1);
        Some(part)
    }

    fn hole(&self, mesh: &Mesh) -> Hole {
        let corners: Vec<DVec3> = self
            .corners
            .iter()
            .map(|&corner| mesh.positions[corner as usize])
            .collect();
        let from = corners[0];
        let vector = corners
            .windows(2)
            .map(|pair| 0.5 * (pair[0] - from).cross(pair[1] - from))
            .sum::<DVec3>();
        let mut objects: Vec<u32> = self
            .edges
            .iter()
            .map(|edge| mesh.objects[edge.triangle as usize])
            .collect();
        objects.sort_unstable();
        objects.dedup();
        Hole {
            objects,
            edges: self.edges.len(),
            length: corners
                .windows(2)
                .map(|pair| pair[0].distance(pair[1]))
                .sum(),
            area: vector.length(),
            normal: vector.normalize_or_zero(),
            min: corners.iter().copied().fold(DVec3::INFINITY, DVec3::min),
            max: corners
                .iter()
                .copied()
                .fold(DVec3::NEG_INFINITY, DVec3::max),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Mesh, defects, shape};
    use glam::DVec3;

    /// A room of single sheets, its west wall (x = 0) left out, its floor one rectangle against four of a wall.
    fn room_without_west() -> Mesh {
        let mut mesh = Mesh::default();
        let mut add = |origin: [f64; 3], u: DVec3, v: DVec3, object| {
            let (positions, triangles) = shape::rectangle(origin.into(), u, v);
            mesh.append(&positions, &triangles, 0, object);
        };
        let (x, y, z) = (DVec3::X * 6.0, DVec3::Y * 4.0, DVec3::Z * 2.8);
        add([0.0; 3], x, y, 0);
        add([0.0, 0.0, 2.8], y, x, 1);
        for column in 0..4 {
            add([1.5 * f64::from(column), 0.0, 0.0], z, x / 4.0, 2);
        }
        add([0.0, 4.0, 0.0], x, z, 3);
        add([6.0, 0.0, 0.0], z, y, 4);
        mesh
    }

    #[test]
    fn a_missing_wall_is_one_hole_of_its_size() {
        let report = defects::of(&room_without_west());
        assert_eq!(report.holes.len(), 1);
        let hole = &report.holes[0];
        assert!((hole.area - 11.2).abs() < 1e-12);
        assert!((hole.length - 13.6).abs() < 1e-12);
        assert!(hole.normal.distance(DVec3::X) < 1e-12);
        assert_eq!(
            (hole.min, hole.max),
            (DVec3::ZERO, DVec3::new(0.0, 4.0, 2.8))
        );
        assert_eq!(hole.objects, [0, 1, 2, 3]);
        assert!(report.turned.is_empty());
    }

    #[test]
    fn sheets_that_touch_at_a_corner_have_a_rim_each() {
        let mut mesh = Mesh::default();
        for (object, origin) in [(0, 0.0), (1, 1.0)] {
            let (positions, triangles) =
                shape::rectangle(DVec3::new(origin, origin, 0.0), DVec3::X, DVec3::Y);
            mesh.append(&positions, &triangles, 0, object);
        }
        let holes = defects::of(&mesh).holes;
        assert_eq!(holes.len(), 2);
        assert!(holes.iter().all(|hole| (hole.area - 1.0).abs() < 1e-15));
    }
}
