//! Vertices in one place as one vertex.

use crate::Mesh;
use std::collections::HashMap;

/// For each position of a mesh the first one within `tolerance` (in m) of it that these triangles use; what they do not
/// use stands for itself.
pub(crate) fn weld(mesh: &Mesh, triangles: &[[u32; 3]], tolerance: f64) -> Vec<u32> {
    let size = (4.0 * tolerance).max(f64::MIN_POSITIVE);
    let mut used = vec![false; mesh.positions.len()];
    for &vertex in triangles.iter().flatten() {
        used[vertex as usize] = true;
    }
    let mut welded: Vec<u32> = (0..).take(mesh.positions.len()).collect();
    // The first vertex of each cell of a grid, and after each vertex the next in its cell.
    let mut first: HashMap<[i64; 3], u32> = HashMap::new();
    let mut next: Vec<Option<u32>> = vec![None; mesh.positions.len()];
    for (vertex, &position) in (0_u32..).zip(&mesh.positions) {
        if !used[vertex as usize] {
            continue;
        }
        let cells = position
            .to_array()
            .map(|coordinate| cells(coordinate / size));
        let mut twin: Option<u32> = None;
        for x in cells[0].clone() {
            for y in cells[1].clone() {
                for z in cells[2].clone() {
                    let mut other = first.get(&[x, y, z]).copied();
                    while let Some(candidate) = other {
                        let there = mesh.positions[candidate as usize];
                        if there.distance_squared(position) <= tolerance * tolerance
                            && twin.is_none_or(|twin| candidate < twin)
                        {
                            twin = Some(candidate);
                        }
                        other = next[candidate as usize];
                    }
                }
            }
        }
        if let Some(twin) = twin {
            welded[vertex as usize] = twin;
        } else {
            let cell = position
                .to_array()
                .map(|coordinate| cell(coordinate / size));
            next[vertex as usize] = first.insert(cell, vertex);
        }
    }
    welded
}

/// The cells within a quarter of a cell of a coordinate that is given in cells.
fn cells(coordinate: f64) -> std::ops::RangeInclusive<i64> {
    cell(coordinate - 0.25)..=cell(coordinate + 0.25)
}

#[allow(clippy::cast_possible_truncation)]
fn cell(coordinate: f64) -> i64 {
    coordinate.floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn vertices_within_the_tolerance_are_one_whatever_cell_they_lie_in() {
        let mut mesh = Mesh::default();
        let places: Vec<DVec3> = (0..300)
            .map(|index| DVec3::new(f64::from(index) * 0.01, 0.7, -3.0))
            .collect();
        let moved: Vec<DVec3> = places
            .iter()
            .map(|place| *place + DVec3::new(6e-5, -6e-5, 3e-5))
            .collect();
        let triangles: Vec<[u32; 3]> = (0..100).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        mesh.append(&places, &triangles, 0, 0);
        mesh.append(&moved, &triangles, 0, 1);
        let welded = weld(&mesh, &mesh.triangles, 1e-4);
        for index in 0..300 {
            assert_eq!(welded[index as usize], index);
            assert_eq!(welded[300 + index as usize], index);
        }
        assert_eq!(weld(&mesh, &mesh.triangles, 1e-5)[300], 300);
    }
}
