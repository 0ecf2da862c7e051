//! What can be said of a tree without tracing a ray.

use super::layout::{Boxes, depth};
use super::wide::{LEAF, WIDTH, Wide};
use super::{Layout, Preset, Tree};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;

/// What a tree of boxes is like.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TreeFacts {
    /// How it is laid out.
    pub layout: Layout,
    /// With how much care it was built.
    pub preset: Preset,
    /// Vector unit that walks it.
    pub unit: &'static str,
    /// Number of nodes with children.
    pub nodes: usize,
    /// Number of levels of nodes.
    pub depth: usize,
    /// Memory for boxes, triangles and their vertices, in bytes.
    pub bytes: usize,
    /// Nodes opened and triangles tried by a line through the box around everything, on average over all lines and if
    /// it is never stopped: by the surface-area heuristic, both counted alike.
    pub sah_cost: f64,
}

/// Nodes, levels, and cost before division by the whole's area.
#[derive(Default)]
struct Count {
    nodes: usize,
    depth: usize,
    cost: f64,
    whole: f64,
}

impl Tree {
    /// What it is like.
    #[must_use]
    pub fn facts(&self) -> TreeFacts {
        let (unit, own, count) = match &self.boxes {
            Boxes::Wide(wide, unit) => (unit.name(), wide.bytes(), Count::of_wide(wide)),
            Boxes::Bvh2(tree) => ("SSE2", size_of_val(&*tree.nodes), Count::of_bvh2(tree)),
            Boxes::Cwbvh(tree) => ("SSE2", size_of_val(&*tree.nodes), Count::of_cwbvh(tree)),
            Boxes::List(count) => (
                "none",
                0,
                Count {
                    cost: *count as f64,
                    whole: 1.0,
                    ..Count::default()
                },
            ),
        };
        TreeFacts {
            layout: self.layout,
            preset: self.preset,
            unit,
            nodes: count.nodes,
            depth: count.depth,
            bytes: own + size_of_val(&*self.triangles) + size_of_val(&*self.corners),
            sah_cost: if count.whole > 0.0 {
                count.cost / count.whole
            } else {
                0.0
            },
        }
    }
}

impl Count {
    fn of_bvh2(tree: &Bvh2) -> Self {
        let mut count = Self {
            depth: depth(tree),
            whole: tree.nodes.first().map_or(0.0, |root| area(root.aabb())),
            ..Self::default()
        };
        for node in &tree.nodes {
            count.nodes += usize::from(!node.is_leaf());
            count.cost += area(node.aabb()) * f64::from(node.prim_count.max(1));
        }
        count
    }

    fn of_wide(wide: &Wide) -> Self {
        let mut count = Self {
            nodes: wide.nodes.len(),
            depth: wide.levels,
            ..Self::default()
        };
        for (index, node) in wide.nodes.iter().enumerate() {
            let mut whole = Aabb::INVALID;
            for lane in 0..WIDTH {
                let Some(aabb) = node.child_box(lane) else {
                    continue;
                };
                whole = whole.union(&aabb);
                let child = node.children[lane];
                count.cost += area(&aabb)
                    * match child & LEAF {
                        0 => 1.0,
                        _ => f64::from(wide.leaves[(child & !LEAF) as usize].count),
                    };
            }
            if index == 0 {
                count.whole = area(&whole);
                count.cost += count.whole;
            }
        }
        count
    }

    fn of_cwbvh(tree: &CwBvh) -> Self {
        let mut count = Self::default();
        let mut open = vec![(0, 1)];
        while let Some((index, level)) = open.pop() {
            let Some(node) = tree.nodes.get(index) else {
                continue;
            };
            count.nodes += 1;
            count.depth = count.depth.max(level);
            let mut whole = Aabb::INVALID;
            for child in (0..WIDTH).filter(|&child| !node.is_child_empty(child)) {
                let aabb = node.child_aabb(child);
                whole = whole.union(&aabb);
                if node.is_leaf(child) {
                    count.cost += area(&aabb) * f64::from(node.child_primitives(child).1);
                } else {
                    open.push((node.child_node_index(child) as usize, level + 1));
                }
            }
            count.cost += area(&whole);
            if index == 0 {
                count.whole = area(&whole);
            }
        }
        count
    }
}

/// Half the surface of a box.
fn area(aabb: &Aabb) -> f64 {
    f64::from(aabb.half_area())
}
