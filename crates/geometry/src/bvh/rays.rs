//! Sixteen rays from one point against boxes and triangles, in single precision.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane has the same number in several lists"
)]

use super::frame::Frame;
use super::lanes::Lanes;
use super::packet::Sixteen3;
use super::targets::PACKET;
use super::wide::{Leaf, Node, WIDTH};
use glam::DVec3;
use obvhs::ray::safe_inverse;

/// Numbers of sixteen rays.
type Sixteen = [[f32; WIDTH]; 2];

/// The rays from one point to the targets of a packet, in the tree's frame.
pub(super) struct Rays {
    origin: [f32; 3],
    direction: [Sixteen; 3],
    inverse: [Sixteen; 3],
    /// Distances to the targets, rounded up.
    reach: Sixteen,
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
    fn new(direction: &Sixteen, inverse: &Sixteen) -> Self {
        let mut forward = [[f32::MAX; WIDTH]; 2];
        let mut backward = [[f32::MIN; WIDTH]; 2];
        for half in 0..2 {
            for lane in 0..WIDTH {
                let inverse = inverse[half][lane];
                forward[half][lane] = if inverse > 0.0 { inverse } else { f32::MAX };
                backward[half][lane] = if inverse < 0.0 { inverse } else { f32::MIN };
            }
        }
        let (forward, backward) = (least(&forward), most(&backward));
        let far = match (forward < f32::MAX, backward > f32::MIN) {
            (true, false) => (true, most(inverse), f32::NEG_INFINITY),
            (false, true) => (false, least(inverse), f32::NEG_INFINITY),
            _ => (false, 0.0, f32::INFINITY),
        };
        Self {
            direction: [least(direction), most(direction)],
            near: [forward, backward],
            far,
        }
    }
}

#[inline(always)]
fn least([a, b]: &Sixteen) -> f32 {
    let mut eight = [0.0; WIDTH];
    for lane in 0..WIDTH {
        eight[lane] = if a[lane] < b[lane] { a[lane] } else { b[lane] };
    }
    for half in [4, 2, 1] {
        for lane in 0..half {
            if eight[lane + half] < eight[lane] {
                eight[lane] = eight[lane + half];
            }
        }
    }
    eight[0]
}

#[inline(always)]
fn most([a, b]: &Sixteen) -> f32 {
    let mut eight = [0.0; WIDTH];
    for lane in 0..WIDTH {
        eight[lane] = if a[lane] > b[lane] { a[lane] } else { b[lane] };
    }
    for half in [4, 2, 1] {
        for lane in 0..half {
            if eight[lane + half] > eight[lane] {
                eight[lane] = eight[lane + half];
            }
        }
    }
    eight[0]
}

impl Rays {
    #[inline(always)]
    pub fn new(frame: &Frame, from: DVec3, directions: &Sixteen3, lengths: &[f64; PACKET]) -> Self {
        let mut direction = [[[0.0; WIDTH]; 2]; 3];
        let mut inverse = direction;
        let mut reach = [[0.0; WIDTH]; 2];
        for half in 0..2 {
            for lane in 0..WIDTH {
                for axis in 0..3 {
                    // A negative zero would turn its inverse to the wrong side of a box.
                    let component = directions[axis][half * WIDTH + lane] as f32 + 0.0;
                    direction[axis][half][lane] = component;
                    inverse[axis][half][lane] = safe_inverse(component);
                }
                let length = lengths[half * WIDTH + lane];
                // More than what it is rounded by.
                reach[half][lane] = (length * frame.scale * (1.0 + 1e-6)) as f32;
            }
        }
        let bounds = [
            Bounds::new(&direction[0], &inverse[0]),
            Bounds::new(&direction[1], &inverse[1]),
            Bounds::new(&direction[2], &inverse[2]),
        ];
        Self {
            origin: frame.point(from).as_vec3().to_array(),
            direction,
            inverse,
            reach,
            bounds,
            farthest: most(&reach),
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
    pub fn new<L: Lanes>(lanes: L, rays: &Rays, node: &Node) -> Self {
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
    pub fn met<L: Lanes>(&self, lanes: L, rays: &Rays, child: usize) -> u32 {
        let mut met = 0;
        for half in 0..2 {
            let mut near = lanes.splat(0.0);
            let mut far = lanes.load(&rays.reach[half]);
            for axis in 0..3 {
                let inverse = lanes.load(&rays.inverse[axis][half]);
                let [least, most] = &self.sides[axis];
                let least = lanes.mul(lanes.splat(least[child]), inverse);
                let most = lanes.mul(lanes.splat(most[child]), inverse);
                near = lanes.max(near, lanes.min(least, most));
                far = lanes.min(far, lanes.max(least, most));
            }
            met |= lanes.at_most(near, far) << (half * WIDTH);
        }
        met
    }
}

/// The edges of a leaf's triangles as the origin of a packet sees them, and which of the triangles some ray may cross.
pub(super) struct Crossings {
    /// From the origin to an edge's start, times the edge: a ray passes the edge on the side of the sign of its product
    /// with this.
    edges: [[[f32; WIDTH]; 3]; 3],
    /// By how much such a product may be wrong.
    blur: [f32; WIDTH],
    /// The vertices as the origin sees them.
    vertices: [[[f32; WIDTH]; 3]; 3],
    /// By how much a distance along a ray may be wrong, and more.
    margin: f32,
    pub any: u32,
}

impl Crossings {
    /// With ε₀ = 2⁻²⁴, the scene's radius r and a triangle's longest edge l, such a product with a ray that crosses the
    /// triangle is wrong by 7 ε₀ r l from the rounding of its vertices and of the origin, by 4 ε₀ r l from the ray's
    /// direction and by 38 ε₀ r l from its own, and the thickness of triangles shifts it by l slacks. The
    /// longest edge is at most √3 times its longest component.
    #[inline(always)]
    pub fn new<L: Lanes>(lanes: L, frame: &Frame, rays: &Rays, leaf: &Leaf) -> Self {
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
        let mut vertices = [[[0.0; WIDTH]; 3]; 3];
        for axis in 0..3 {
            vertices[0][axis] = lanes.store(p[axis]);
            vertices[1][axis] = lanes.store(q[axis]);
            vertices[2][axis] = lanes.store(r[axis]);
        }
        Self {
            edges,
            blur: lanes.store(blur),
            vertices,
            margin: frame.margin,
            any,
        }
    }

    /// Which rays may cross a triangle, one bit each, and which surely cross it before their ends.
    ///
    /// Those that pass all edges on one side by more than the blur cross it by 30 ε₀ r inside its edges at least: double
    /// precision sees them do so too, and finds a distance between those of the vertices.
    #[inline(always)]
    pub fn crossed<L: Lanes>(&self, lanes: L, rays: &Rays, triangle: usize) -> (u32, u32) {
        let (mut may, mut surely) = (0, 0);
        let blur = lanes.splat(self.blur[triangle]);
        let beneath = lanes.negative(blur);
        for half in 0..2 {
            let direction = [
                lanes.load(&rays.direction[0][half]),
                lanes.load(&rays.direction[1][half]),
                lanes.load(&rays.direction[2][half]),
            ];
            let passed = [
                self.dot(lanes, direction, &self.edges[0], triangle),
                self.dot(lanes, direction, &self.edges[1], triangle),
                self.dot(lanes, direction, &self.edges[2], triangle),
            ];
            let (least, most) = (lanes.min3(passed), lanes.max3(passed));
            let some = lanes.at_most(beneath, least) | lanes.at_most(most, blur);
            if some == 0 {
                continue;
            }
            may |= some << (half * WIDTH);
            let along = [
                self.dot(lanes, direction, &self.vertices[0], triangle),
                self.dot(lanes, direction, &self.vertices[1], triangle),
                self.dot(lanes, direction, &self.vertices[2], triangle),
            ];
            let margin = lanes.splat(self.margin);
            let end = lanes.sub(lanes.load(&rays.reach[half]), margin);
            let within =
                lanes.at_most(margin, lanes.min3(along)) & lanes.at_most(lanes.max3(along), end);
            let inside = lanes.at_most(blur, least) | lanes.at_most(most, beneath);
            surely |= (within & inside) << (half * WIDTH);
        }
        (may, surely)
    }

    /// Products of eight rays with a vector of each triangle.
    #[inline(always)]
    fn dot<L: Lanes>(
        &self,
        lanes: L,
        direction: [L::Eight; 3],
        vectors: &[[f32; WIDTH]; 3],
        triangle: usize,
    ) -> L::Eight {
        let x = lanes.mul(lanes.splat(vectors[0][triangle]), direction[0]);
        let y = lanes.mul(lanes.splat(vectors[1][triangle]), direction[1]);
        let z = lanes.mul(lanes.splat(vectors[2][triangle]), direction[2]);
        lanes.add(lanes.add(x, y), z)
    }
}
