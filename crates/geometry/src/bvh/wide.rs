//! A tree of boxes with eight children a node, and triangles in single precision eight to a leaf.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane has the same number in several lists"
)]

use super::frame::Frame;
use super::lanes::Lanes;
use super::layout::{ENOUGH, Visit};
use crate::Mesh;
use crate::crossing::Line;
use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;

/// Children of a node, and triangles of a leaf.
pub(super) const WIDTH: usize = 8;

/// Set in the name of a child that is a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// Entries of a walk's list of open children that lie on the machine's stack.
pub(super) const OPEN: usize = 96;

/// The boxes of up to eight children, by axis and side; those missing are never hit.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Node {
    pub sides: [[[f32; WIDTH]; 2]; 3],
    pub children: [u32; WIDTH],
}

/// Up to eight triangles, by vertex and axis; those missing are no numbers and never hit.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Leaf {
    pub vertices: [[[f32; WIDTH]; 3]; 3],
    /// Place of the first among all triangles in the order of the leaves.
    pub first: u32,
    pub count: u32,
}

/// The tree. Triangles of a leaf that the boxes let through are culled once more by their edges; both only cull.
#[derive(Debug, Default)]
pub(super) struct Wide {
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
    pub levels: usize,
}

impl Wide {
    /// Opens the largest box of each node of a binary tree until it has eight.
    pub fn new(binary: &Bvh2, mesh: &Mesh, frame: &Frame) -> Self {
        let mut wide = Self::default();
        if binary.nodes.is_empty() {
            return wide;
        }
        wide.nodes.push(Node::EMPTY);
        let mut open = vec![(0, vec![0], 1)];
        while let Some((index, mut children, level)) = open.pop() {
            wide.levels = wide.levels.max(level);
            let area = |&child: &usize| binary.nodes[child].aabb().half_area();
            while children.len() < WIDTH {
                let largest = (0..children.len())
                    .filter(|&place| !binary.nodes[children[place]].is_leaf())
                    .max_by(|&a, &b| area(&children[a]).total_cmp(&area(&children[b])));
                let Some(place) = largest else {
                    break;
                };
                let first = binary.nodes[children[place]].first_index as usize;
                children[place] = first;
                children.push(first + 1);
            }
            // A packet opens the last first: the largest is the likeliest to stop its rays.
            children.sort_by(|a, b| area(a).total_cmp(&area(b)));
            for (lane, child) in children.into_iter().enumerate() {
                let node = &binary.nodes[child];
                wide.nodes[index].set_box(lane, node.aabb());
                let first = node.first_index as usize;
                wide.nodes[index].children[lane] = if node.is_leaf() {
                    let range = first..first + node.prim_count as usize;
                    let triangles = &binary.primitive_indices[range];
                    wide.leaves
                        .push(Leaf::new(node.first_index, triangles, mesh, frame));
                    LEAF | number(wide.leaves.len() - 1)
                } else {
                    wide.nodes.push(Node::EMPTY);
                    open.push((wide.nodes.len() - 1, vec![first, first + 1], level + 1));
                    number(wide.nodes.len() - 1)
                };
            }
        }
        wide
    }

    /// Memory that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.leaves)
    }

    /// How many children a walk may have open.
    pub fn open_entries(levels: usize) -> usize {
        (WIDTH - 1) * levels + 1
    }

    /// Tries the triangles that a ray may cross, roughly from the nearest on.
    #[inline(always)]
    pub fn walk<L: Lanes<WIDTH>>(
        &self,
        lanes: L,
        frame: &Frame,
        line: &Line,
        reach: f32,
        search: &mut impl Visit,
    ) {
        let entries = Self::open_entries(self.levels);
        if entries <= OPEN {
            self.walk_with(lanes, frame, line, reach, &mut [0; OPEN], search);
        } else {
            self.walk_with(lanes, frame, line, reach, &mut vec![0; entries], search);
        }
    }

    #[inline(always)]
    fn walk_with<L: Lanes<WIDTH>>(
        &self,
        lanes: L,
        frame: &Frame,
        line: &Line,
        mut reach: f32,
        open: &mut [u64],
        search: &mut impl Visit,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let ray = frame.ray(line);
        let origin = lanes.splat3(ray.origin.to_array());
        let inverse = lanes.splat3(ray.inv_direction.to_array());
        let backward = ray.inv_direction.to_array().map(|i| usize::from(i < 0.0));
        let sheared = Sheared::new(lanes, frame, line, ray.origin.to_array());
        let mut count = 0;
        let mut child = 0;
        loop {
            if child & LEAF != 0 {
                let leaf = &self.leaves[(child & !LEAF) as usize];
                let mut crossed = sheared.crossed(lanes, leaf, reach);
                while crossed.may != 0 {
                    let lane = crossed.may.trailing_zeros() as usize & 7;
                    crossed.may &= crossed.may - 1;
                    if crossed.least[lane] > reach {
                        continue;
                    }
                    let surely = crossed.surely >> lane & 1 == 1;
                    reach = search.visit(leaf.first as usize + lane, reach, surely);
                    if reach <= ENOUGH {
                        return;
                    }
                }
            } else {
                let node = &self.nodes[child as usize];
                let mut near = lanes.splat(0.0);
                let mut far = lanes.splat(reach);
                for axis in 0..3 {
                    let sides = &node.sides[axis];
                    let first = lanes.load(&sides[backward[axis]]);
                    let last = lanes.load(&sides[1 - backward[axis]]);
                    let first = lanes.mul(lanes.sub(first, origin[axis]), inverse[axis]);
                    let last = lanes.mul(lanes.sub(last, origin[axis]), inverse[axis]);
                    near = lanes.max(first, near);
                    far = lanes.min(last, far);
                }
                let mut bits = lanes.at_most(near, far);
                let near = lanes.store(near);
                let first = count;
                while bits != 0 {
                    let lane = bits.trailing_zeros() as usize & 7;
                    bits &= bits - 1;
                    let entry =
                        u64::from(near[lane].to_bits()) << 32 | u64::from(node.children[lane]);
                    // The nearest last, to be taken first.
                    let mut place = count;
                    while place > first && open[place - 1] < entry {
                        open[place] = open[place - 1];
                        place -= 1;
                    }
                    open[place] = entry;
                    count += 1;
                }
            }
            loop {
                if count == 0 {
                    return;
                }
                count -= 1;
                let entry = open[count];
                if f32::from_bits((entry >> 32) as u32) <= reach {
                    child = entry as u32;
                    break;
                }
            }
        }
    }

    /// Visits the place of every triangle in a leaf whose box meets another box, in the frame's units.
    pub fn near(&self, around: &Aabb, mut visit: impl FnMut(usize)) {
        let meets = |bounds: &Aabb| {
            bounds.min.cmple(around.max).all() && bounds.max.cmpge(around.min).all()
        };
        self.all(meets, |place| {
            visit(place);
            true
        });
    }

    /// Whether every place `passes` of a triangle in leaves whose boxes, in the frame's units, `enters` lets in.
    pub fn all(
        &self,
        enters: impl Fn(&Aabb) -> bool,
        mut passes: impl FnMut(usize) -> bool,
    ) -> bool {
        let mut open = Vec::new();
        if !self.nodes.is_empty() {
            open.push(0);
        }
        while let Some(child) = open.pop() {
            if child & LEAF != 0 {
                let leaf = &self.leaves[(child & !LEAF) as usize];
                if !(leaf.first..leaf.first + leaf.count).all(|place| passes(place as usize)) {
                    return false;
                }
                continue;
            }
            let node = &self.nodes[child as usize];
            for lane in 0..WIDTH {
                if node.child_box(lane).is_some_and(|bounds| enters(&bounds)) {
                    open.push(node.children[lane]);
                }
            }
        }
        true
    }
}

/// A node or leaf by its number: there are fewer than triangles, whose numbers are of 31 bits.
#[allow(clippy::cast_possible_truncation)]
fn number(index: usize) -> u32 {
    index as u32
}

impl Node {
    const EMPTY: Self = Self {
        sides: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3],
        children: [0; WIDTH],
    };

    /// The box of a child, if there is one.
    pub fn child_box(&self, lane: usize) -> Option<Aabb> {
        let side =
            |side: usize| Vec3A::from_array([0, 1, 2].map(|axis| self.sides[axis][side][lane]));
        (side(0).x <= side(1).x).then(|| Aabb::new(side(0), side(1)))
    }

    fn set_box(&mut self, lane: usize, aabb: &Aabb) {
        for axis in 0..3 {
            self.sides[axis][0][lane] = aabb.min[axis];
            self.sides[axis][1][lane] = aabb.max[axis];
        }
    }
}

impl Leaf {
    fn new(first: u32, triangles: &[u32], mesh: &Mesh, frame: &Frame) -> Self {
        let mut leaf = Self {
            vertices: [[[f32::NAN; WIDTH]; 3]; 3],
            first,
            count: number(triangles.len()),
        };
        for (lane, &triangle) in triangles.iter().enumerate() {
            let vertices = mesh.triangle(triangle as usize).vertices;
            for (vertex, place) in vertices.into_iter().enumerate() {
                let place: DVec3 = frame.point(place);
                for axis in 0..3 {
                    leaf.vertices[vertex][axis][lane] = place[axis] as f32;
                }
            }
        }
        leaf
    }
}

/// A ray seen along itself in single precision: the axis that it follows most is kept, the others are sheared.
struct Sheared<L: Lanes<WIDTH>> {
    axes: [usize; 3],
    origin: [L::Numbers; 3],
    shear: [L::Numbers; 2],
    /// Distance along the ray for a step of one along the axis kept.
    stretch: L::Numbers,
    /// By how much a coordinate may be wrong.
    least: L::Numbers,
    /// By how much an edge function may be wrong, for coordinates of size 1.
    blur: L::Numbers,
    /// By how much a distance along the ray may be wrong.
    margin: L::Numbers,
}

/// What single precision says of a ray and the triangles of a leaf.
struct Crossed {
    /// One bit a triangle: zero where the ray surely misses it.
    may: u32,
    /// One bit a triangle: one where the ray surely crosses it within its reach.
    surely: u32,
    /// Distance at which it may be crossed at least.
    least: [f32; WIDTH],
}

impl<L: Lanes<WIDTH>> Sheared<L> {
    /// With ε₀ = 2⁻²⁴ and the scene's radius r, a coordinate across the ray is wrong by 17 ε₀ r: 4 of each of the two
    /// differences to the origin, the rest from the shear. An edge function of coordinates up to m is wrong by four times
    /// that and 16 ε₀ r from its own rounding, times m; the thickness of triangles shifts it by 6 slacks. A distance is
    /// wrong by 20 ε₀ r.
    #[inline(always)]
    fn new(lanes: L, frame: &Frame, line: &Line, origin: [f32; 3]) -> Self {
        let size = line.direction.abs();
        let along = if size.x > size.y && size.x > size.z {
            0
        } else if size.y > size.z {
            1
        } else {
            2
        };
        let axes = [(along + 1) % 3, (along + 2) % 3, along];
        let stretch = 1.0 / line.direction[along];
        let shear = axes.map(|axis| (line.direction[axis] * stretch) as f32);
        let ulp = frame.ulp();
        Self {
            axes,
            origin: lanes.splat3(axes.map(|axis| origin[axis])),
            shear: [lanes.splat(shear[0]), lanes.splat(shear[1])],
            stretch: lanes.splat(stretch as f32),
            least: lanes.splat((17.0 * ulp) as f32),
            blur: lanes.splat((96.0 * ulp + 8.0 * frame.slack) as f32),
            margin: lanes.splat(frame.margin),
        }
    }

    /// A ray that passes all edges on one side by more than the blur crosses the triangle: double precision sees it do so
    /// too. It then finds a distance between those of the vertices, also where the triangle is seen edge-on, unless it
    /// is narrower than the slack over its length; hence the length in the bound.
    #[inline(always)]
    fn crossed(&self, lanes: L, leaf: &Leaf, reach: f32) -> Crossed {
        let p = self.seen(lanes, &leaf.vertices[0]);
        let q = self.seen(lanes, &leaf.vertices[1]);
        let r = self.seen(lanes, &leaf.vertices[2]);
        let edges = [
            lanes.minor([p[0], p[1]], [q[0], q[1]]),
            lanes.minor([q[0], q[1]], [r[0], r[1]]),
            lanes.minor([r[0], r[1]], [p[0], p[1]]),
        ];
        let size = lanes.max3([
            lanes.max(lanes.abs(p[0]), lanes.abs(p[1])),
            lanes.max(lanes.abs(q[0]), lanes.abs(q[1])),
            lanes.max(lanes.abs(r[0]), lanes.abs(r[1])),
        ]);
        let size = lanes.add(size, self.least);
        let blur = lanes.mul(self.blur, size);
        let (least, most) = (lanes.min3(edges), lanes.max3(edges));
        // On one side of all edges, or nearly.
        let may = lanes.at_most(lanes.negative(blur), least) | lanes.at_most(most, blur);
        if may == 0 {
            return Crossed {
                may,
                surely: 0,
                least: [0.0; WIDTH],
            };
        }
        let along = [
            lanes.mul(p[2], self.stretch),
            lanes.mul(q[2], self.stretch),
            lanes.mul(r[2], self.stretch),
        ];
        let (near, far) = (lanes.min3(along), lanes.max3(along));
        let sharp = lanes.mul(self.blur, lanes.add(size, lanes.sub(far, near)));
        let inside = lanes.at_most(sharp, least) | lanes.at_most(most, lanes.negative(sharp));
        let end = lanes.sub(lanes.splat(reach), self.margin);
        let within = lanes.at_most(self.margin, near) & lanes.at_most(far, end);
        Crossed {
            // What lies behind the origin altogether is not met.
            may: may & lanes.at_most(lanes.negative(self.margin), far),
            surely: inside & within,
            least: lanes.store(lanes.sub(near, self.margin)),
        }
    }

    /// Coordinates of a vertex: two across the ray, and the one along the axis kept.
    #[inline(always)]
    fn seen(&self, lanes: L, vertex: &[[f32; WIDTH]; 3]) -> [L::Numbers; 3] {
        let [x, y, z] = self.axes;
        let [x, y, z] = lanes.load_less([&vertex[x], &vertex[y], &vertex[z]], self.origin);
        [
            lanes.sub(x, lanes.mul(self.shear[0], z)),
            lanes.sub(y, lanes.mul(self.shear[1], z)),
            z,
        ]
    }
}
