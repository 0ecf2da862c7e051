//! Edges of a mesh and the triangles that meet there.

use crate::Mesh;
use glam::DVec3;

/// One triangle at one of its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Use {
    /// What may be joined here: the object, or 0 for all.
    pub group: u32,
    /// The welded ends, the lower index first.
    pub ends: [u32; 2],
    pub triangle: u32,
    /// Whether the triangle's winding runs from the first end to the second.
    pub forward: bool,
}

/// All edges of the triangles wanted, sorted, so that the uses of one edge follow each other.
///
/// Triangles that welding leaves without area have no edges: their neighbours meet in their place.
pub(crate) fn uses(
    mesh: &Mesh,
    welded: &[u32],
    wanted: impl Fn(u32) -> bool,
    group: impl Fn(u32) -> u32,
) -> Vec<Use> {
    let mut uses = Vec::with_capacity(3 * mesh.len());
    for (triangle, vertices) in (0_u32..).zip(&mesh.triangles) {
        let [a, b, c] = vertices.map(|vertex| welded[vertex as usize]);
        if a == b || b == c || c == a || !wanted(triangle) {
            continue;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            uses.push(Use {
                group: group(triangle),
                ends: [from.min(to), from.max(to)],
                triangle,
                forward: from < to,
            });
        }
    }
    uses.sort_unstable();
    uses
}

/// Sorted uses, edge by edge.
pub(crate) fn by_edge(uses: &[Use]) -> impl Iterator<Item = &[Use]> {
    uses.chunk_by(|one, next| (one.group, one.ends) == (next.group, next.ends))
}

/// Splits edges of a single triangle where other such edges end on them, within `tolerance` (in m).
///
/// So one long edge along several short ones (a floor along a wall cut into columns) is not taken for a gap.
pub(crate) fn split_at_junctions(mesh: &Mesh, mut uses: Vec<Use>, tolerance: f64) -> Vec<Use> {
    let place = |vertex: u32| mesh.positions[vertex as usize];
    let single: Vec<Use> = by_edge(&uses)
        .filter(|edge| edge.len() == 1)
        .map(|edge| edge[0])
        .collect();
    let mut ends: Vec<u32> = single.iter().flat_map(|edge| edge.ends).collect();
    ends.sort_unstable();
    ends.dedup();
    let sorted = [0, 1, 2].map(|axis| {
        let mut sorted: Vec<(f64, u32)> = ends
            .iter()
            .map(|&vertex| (place(vertex)[axis], vertex))
            .collect();
        sorted.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        sorted
    });
    // Along the axis on which the fewest vertices lie beside the edge.
    let beside = |from: DVec3, to: DVec3| {
        let ranges = [0, 1, 2].map(|axis| {
            let (least, most) = (from[axis].min(to[axis]), from[axis].max(to[axis]));
            let start = sorted[axis].partition_point(|entry| entry.0 < least - tolerance);
            let end = sorted[axis].partition_point(|entry| entry.0 <= most + tolerance);
            &sorted[axis][start..end]
        });
        let [x, y, z] = ranges;
        let fewer = if x.len() <= y.len() { x } else { y };
        if fewer.len() <= z.len() { fewer } else { z }
    };
    // Few edges are split, so the list is changed in place: it is the largest thing in memory.
    let (mut split, mut pieces) = (Vec::new(), Vec::new());
    for whole in single {
        let [from, to] = whole.ends.map(place);
        let length = from.distance(to);
        let direction = (to - from) / length;
        let mut stops: Vec<(f64, u32)> = beside(from, to)
            .iter()
            .filter_map(|&(_, vertex)| {
                let seen = place(vertex) - from;
                let along = seen.dot(direction);
                let on = along > tolerance
                    && along < length - tolerance
                    && (seen - along * direction).length() <= tolerance;
                on.then_some((along, vertex))
            })
            .collect();
        if stops.is_empty() {
            continue;
        }
        stops.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        let inner = stops.iter().map(|stop| stop.1);
        let chain: Vec<u32> = std::iter::once(whole.ends[0])
            .chain(inner)
            .chain([whole.ends[1]])
            .collect();
        pieces.extend(chain.windows(2).map(|pair| Use {
            ends: [pair[0].min(pair[1]), pair[0].max(pair[1])],
            forward: (pair[0] < pair[1]) == whole.forward,
            ..whole
        }));
        split.push(whole);
    }
    if !split.is_empty() {
        // In the order of the list they come from, so they can be searched.
        uses.retain(|entry| split.binary_search(entry).is_err());
        uses.append(&mut pieces);
        uses.sort_unstable();
    }
    uses
}

/// Triangles joined across edges, each with whether it is wound like the first of its piece: a union-find with parity.
pub(crate) struct Pieces {
    parent: Vec<u32>,
    turned: Vec<bool>,
}

impl Pieces {
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..).take(count).collect(),
            turned: vec![false; count],
        }
    }

    /// The triangle that stands for the piece, and whether `triangle` is wound against it.
    pub fn find(&mut self, triangle: u32) -> (u32, bool) {
        let mut root = triangle;
        let mut turned = false;
        while self.parent[root as usize] != root {
            turned ^= self.turned[root as usize];
            root = self.parent[root as usize];
        }
        let (mut at, mut left) = (triangle, turned);
        while self.parent[at as usize] != root && at != root {
            let step = at as usize;
            let (up, own) = (self.parent[step], self.turned[step]);
            (self.parent[step], self.turned[step]) = (root, left);
            left ^= own;
            at = up;
        }
        (root, turned)
    }

    /// Joins two triangles; `against` where their windings disagree.
    pub fn join(&mut self, one: u32, other: u32, against: bool) {
        let ((root, turned), (joined, other_turned)) = (self.find(one), self.find(other));
        if root != joined {
            let (low, high) = (root.min(joined), root.max(joined));
            self.parent[high as usize] = low;
            self.turned[high as usize] = turned ^ other_turned ^ against;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_twice_is_no_turn() {
        let mut pieces = Pieces::new(6);
        pieces.join(0, 1, true);
        pieces.join(4, 3, false);
        pieces.join(1, 3, true);
        assert_eq!(pieces.find(1), (0, true));
        assert_eq!(pieces.find(3), (0, false));
        assert_eq!(pieces.find(4), (0, false));
        assert_eq!(pieces.find(5), (5, false));
    }
}
