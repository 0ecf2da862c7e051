//! Sixteen rays from one point against boxes and triangles, in single precision.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane has the same number in several lists"
)]

use super::frame::Frame;
use super::lanes::Lanes;
use super::targets::PACKET;
use super::wide::{Leaf, Node, WIDTH};
use glam::DVec3;
use obvhs::ray::safe_inverse;

/// Numbers of sixteen rays.
type Sixteen = [f32; PACKET];

/// The rays from one point to the targets of a packet, in the tree's frame.
pub(super) struct Rays<L: Lanes<PACKET>> {
    origin: [f32; 3],
    direction: [L::Numbers; 3],
    inverse: [L::Numbers; 3],
    /// Distances to the targets, rounded up.
    reach: L::Numbers,
    /// Bounds of all these, by axis.
    bounds: [Bounds; 3],
    farthest: f32,
}

/// What bounds the directions of a packet along an axis, and with them where its rays can meet a box.
#[derive(Clone, Copy)]
struct Bounds {
    direction: [f32; 2],
    /// By what the distances to a box's two sides are multiplied: the greater bounds the nearest crossing from below.
    near: [f32; 2],
    /// Which side bounds the farthest crossing from above, multiplied by what; infinite where rays of both senses are
    /// in the packet.
    far: (bool, f32, f32),
}

impl Bounds {
    #[inline(always)]
    fn new<L: Lanes<PACKET>>(lanes: L, direction: L::Numbers) -> Self {
        let (least, most) = (lanes.least(direction), lanes.most(direction));
        // The inverse falls with the direction on either side of zero.
        let forward = if most >= 0.0 {
            safe_inverse(most)
        } else {
            f32::MAX
        };
        let backward = if least < 0.0 {
            safe_inverse(least)
        } else {
            f32::MIN
        };
        let far = if least >= 0.0 {
            (true, safe_inverse(least), f32::NEG_INFINITY)
        } else if most < 0.0 {
            (false, safe_inverse(most), f32::NEG_INFINITY)
        } else {
            (false, 0.0, f32::INFINITY)
        };
        Self {
            direction: [least, most],
            near: [forward, backward],
            far,
        }
    }
}

impl<L: Lanes<PACKET>> Rays<L> {
    /// Rays of the given directions and, in m, lengths.
    #[inline(always)]
    pub fn new(
        lanes: L,
        frame: &Frame,
        from: DVec3,
        directions: &[Sixteen; 3],
        lengths: &[f64; PACKET],
    ) -> Self {
        let mut inverse = [[0.0; PACKET]; 3];
        let mut reach = [0.0; PACKET];
        for axis in 0..3 {
            for lane in 0..PACKET {
                inverse[axis][lane] = safe_inverse(directions[axis][lane]);
            }
        }
        for lane in 0..PACKET {
            // More than what it is rounded by.
            reach[lane] = (lengths[lane] * frame.scale * (1.0 + 1e-6)) as f32;
        }
        let direction = lanes.load3(directions);
        let reach = lanes.load(&reach);
        Self {
            origin: frame.point(from).as_vec3().to_array(),
            direction,
            inverse: lanes.load3(&inverse),
            reach,
            bounds: [
                Bounds::new(lanes, direction[0]),
                Bounds::new(lanes, direction[1]),
                Bounds::new(lanes, direction[2]),
            ],
            farthest: lanes.most(reach),
        }
    }
}

/// Where the children of a node lie from the origin of a packet, and which of them some ray may meet.
pub(super) struct Slabs {
    sides: [[[f32; WIDTH]; 2]; 3],
    pub any: u32,
}

impl Slabs {
    #[inline(always)]
    pub fn new<E: Lanes<WIDTH>, L: Lanes<PACKET>>(lanes: E, rays: &Rays<L>, node: &Node) -> Self {
        let mut near = lanes.splat(0.0);
        let mut far = lanes.splat(rays.farthest);
        let mut sides = [[[0.0; WIDTH]; 2]; 3];
        for axis in 0..3 {
            let origin = lanes.splat(rays.origin[axis]);
            let least = lanes.sub(lanes.load(&node.sides[axis][0]), origin);
            let most = lanes.sub(lanes.load(&node.sides[axis][1]), origin);
            sides[axis] = [lanes.store(least), lanes.store(most)];
            let bounds = &rays.bounds[axis];
            near = lanes.max(near, lanes.mul(least, lanes.splat(bounds.near[0])));
            near = lanes.max(near, lanes.mul(most, lanes.splat(bounds.near[1])));
            let (upper, factor, floor) = bounds.far;
            let side = if upper { most } else { least };
            let end = lanes.mul(side, lanes.splat(factor));
            far = lanes.min(far, lanes.max(end, lanes.splat(floor)));
        }
        Self {
            sides,
            any: lanes.at_most(near, far),
        }
    }

    /// Which rays meet the box of a child, one bit each.
    #[inline(always)]
    pub fn met<L: Lanes<PACKET>>(&self, lanes: L, rays: &Rays<L>, child: usize) -> u32 {
        let mut near = lanes.splat(0.0);
        let mut far = rays.reach;
        for axis in 0..3 {
            let [least, most] = &self.sides[axis];
            let least = lanes.mul(lanes.splat(least[child]), rays.inverse[axis]);
            let most = lanes.mul(lanes.splat(most[child]), rays.inverse[axis]);
            near = lanes.max(near, lanes.min(least, most));
            far = lanes.min(far, lanes.max(least, most));
        }
        lanes.at_most(near, far)
    }
}

/// The edges of a leaf's triangles as the origin of a packet sees them, and which of the triangles some ray may cross.
pub(super) struct Crossings {
    /// From the origin to an edge's start, times the edge: a ray passes the edge on the side of the sign of its product
    /// with this.
    edges: [[[f32; WIDTH]; 3]; 3],
    /// By how much such a product may be wrong.
    blur: [f32; WIDTH],
    pub any: u32,
}

impl Crossings {
    /// With ε₀ = 2⁻²⁴, the scene's radius r and a triangle's longest edge l, such a product with a ray that crosses the
    /// triangle is wrong by 7 ε₀ r l from the rounding of its vertices and of the origin, by 4 ε₀ r l from the ray's
    /// direction and by 38 ε₀ r l from its own, and the thickness of triangles shifts it by l slacks. The
    /// longest edge is at most √3 times its longest component.
    #[inline(always)]
    pub fn new<E: Lanes<WIDTH>, L: Lanes<PACKET>>(
        lanes: E,
        frame: &Frame,
        rays: &Rays<L>,
        leaf: &Leaf,
    ) -> Self {
        let origin = lanes.splat3(rays.origin);
        let [p, q, r] = &leaf.vertices;
        let p = lanes.load_less([&p[0], &p[1], &p[2]], origin);
        let q = lanes.load_less([&q[0], &q[1], &q[2]], origin);
        let r = lanes.load_less([&r[0], &r[1], &r[2]], origin);
        let sides = [lanes.sub3(q, p), lanes.sub3(r, q), lanes.sub3(p, r)];
        let mut size = lanes.splat(0.0);
        for side in sides {
            for component in side {
                size = lanes.max(lanes.abs(component), size);
            }
        }
        let blur = lanes.mul(size, lanes.splat(frame.margin));
        let products = [
            lanes.cross(p, sides[0]),
            lanes.cross(q, sides[1]),
            lanes.cross(r, sides[2]),
        ];
        let mut edges = [[[0.0; WIDTH]; 3]; 3];
        let mut least = [lanes.splat(0.0); 3];
        let mut most = least;
        for edge in 0..3 {
            for axis in 0..3 {
                let product = products[edge][axis];
                edges[edge][axis] = lanes.store(product);
                let [low, high] = rays.bounds[axis].direction;
                let low = lanes.mul(product, lanes.splat(low));
                let high = lanes.mul(product, lanes.splat(high));
                least[edge] = lanes.add(least[edge], lanes.min(low, high));
                most[edge] = lanes.add(most[edge], lanes.max(low, high));
            }
        }
        // Not beyond one edge with all rays while before another with all.
        let any = lanes.at_most(lanes.negative(blur), lanes.min3(most))
            | lanes.at_most(lanes.max3(least), blur);
        Self {
            edges,
            blur: lanes.store(blur),
            any,
        }
    }

    /// Which rays may cross a triangle, one bit each, and whose lines surely do.
    ///
    /// Those that pass all edges on one side by more than the blur cross it by 30 ε₀ r inside its edges at least: double
    /// precision sees them do so too.
    #[inline(always)]
    pub fn crossed<L: Lanes<PACKET>>(
        &self,
        lanes: L,
        rays: &Rays<L>,
        triangle: usize,
    ) -> (u32, u32) {
        let blur = lanes.splat(self.blur[triangle]);
        let beneath = lanes.negative(blur);
        let passed = [
            self.dot(lanes, rays, &self.edges[0], triangle),
            self.dot(lanes, rays, &self.edges[1], triangle),
            self.dot(lanes, rays, &self.edges[2], triangle),
        ];
        let (least, most) = (lanes.min3(passed), lanes.max3(passed));
        let may = lanes.at_most(beneath, least) | lanes.at_most(most, blur);
        if may == 0 {
            return (0, 0);
        }
        let inside = lanes.at_most(blur, least) | lanes.at_most(most, beneath);
        (may, inside)
    }

    /// Products of the rays with a vector of a triangle.
    #[inline(always)]
    fn dot<L: Lanes<PACKET>>(
        &self,
        lanes: L,
        rays: &Rays<L>,
        vectors: &[[f32; WIDTH]; 3],
        triangle: usize,
    ) -> L::Numbers {
        let x = lanes.mul(lanes.splat(vectors[0][triangle]), rays.direction[0]);
        let y = lanes.mul(lanes.splat(vectors[1][triangle]), rays.direction[1]);
        let z = lanes.mul(lanes.splat(vectors[2][triangle]), rays.direction[2]);
        lanes.add(lanes.add(x, y), z)
    }
}
