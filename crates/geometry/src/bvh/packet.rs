//! One point against many: rays that share their origin go through the tree together.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane has the same number in several lists"
)]

use super::frame::Frame;
use super::lanes::{Lanes, Work};
use super::wide::{LEAF, Leaf, Node, OPEN, WIDTH, Wide};
use glam::DVec3;
use obvhs::ray::safe_inverse;

/// Rays that go together.
const PACKET: usize = 16;

/// Points with normals that one point after another is to see, kept in packets of neighbours.
#[derive(Debug, Clone, Default)]
pub struct Targets {
    packets: Vec<Packet>,
    len: usize,
}

/// Up to sixteen targets; those missing are copies of the first without a normal, which nothing sees.
#[derive(Debug, Clone)]
struct Packet {
    places: [[f64; PACKET]; 3],
    normals: [[f64; PACKET]; 3],
    indices: [u32; PACKET],
    /// On which sides of all planes of the scene, where these are known.
    sides: [Option<u32>; PACKET],
    count: usize,
}

impl Targets {
    /// Targets by place (in m) and normal, with the sides of planes that a place lies on.
    pub(crate) fn new(targets: &[(DVec3, DVec3)], sides: impl Fn(DVec3) -> Option<u32>) -> Self {
        let places = || targets.iter().map(|target| target.0);
        let least = places().fold(DVec3::INFINITY, DVec3::min);
        let most = places().fold(DVec3::NEG_INFINITY, DVec3::max);
        let size = (most - least).max_element();
        let mut order: Vec<(u64, u32)> = (0..)
            .zip(places())
            .map(|(index, place)| (morton((place - least) / size), index))
            .collect();
        order.sort_unstable();
        let packets = order
            .chunks(PACKET)
            .map(|chunk| {
                let mut packet = Packet {
                    places: [[0.0; PACKET]; 3],
                    normals: [[0.0; PACKET]; 3],
                    indices: [0; PACKET],
                    sides: [None; PACKET],
                    count: chunk.len(),
                };
                for lane in 0..PACKET {
                    let index = chunk.get(lane).unwrap_or(&chunk[0]).1;
                    let (place, normal) = targets[index as usize];
                    packet.indices[lane] = index;
                    packet.sides[lane] = sides(place);
                    for axis in 0..3 {
                        packet.places[axis][lane] = place[axis];
                        if lane < chunk.len() {
                            packet.normals[axis][lane] = normal[axis];
                        }
                    }
                }
                packet
            })
            .collect();
        Self {
            packets,
            len: targets.len(),
        }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

/// A point that looks at targets.
pub(crate) struct Question<'a> {
    pub from: DVec3,
    pub normal: DVec3,
    /// On which sides of all planes of the scene, where these are known.
    pub sides: Option<u32>,
    pub targets: &'a Targets,
}

impl Question<'_> {
    /// Calls `ask` for each target in front of the point that has the point in front of it.
    pub(super) fn each_before(&self, mut ask: impl FnMut(usize, DVec3)) {
        for packet in &self.targets.packets {
            for lane in 0..packet.count {
                let place = packet.place(lane);
                let [x, y, z] = packet.normals.map(|normal| normal[lane]);
                let segment = place - self.from;
                if segment.dot(self.normal) > 0.0 && segment.dot(DVec3::new(x, y, z)) < 0.0 {
                    ask(packet.indices[lane] as usize, place);
                }
            }
        }
    }
}

/// Numbers of the targets of a packet, by axis.
type Sixteen3 = [[f64; PACKET]; 3];

#[inline(always)]
fn less(places: &Sixteen3, from: DVec3) -> Sixteen3 {
    let mut segment = [[0.0; PACKET]; 3];
    for axis in 0..3 {
        for lane in 0..PACKET {
            segment[axis][lane] = places[axis][lane] - from[axis];
        }
    }
    segment
}

#[inline(always)]
fn dot(a: &Sixteen3, b: &Sixteen3) -> [f64; PACKET] {
    let mut sums = [0.0; PACKET];
    for lane in 0..PACKET {
        sums[lane] = a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane];
    }
    sums
}

/// Place of a point of the unit cube along a curve through it whose stretches are compact (Morton 1966).
fn morton(place: DVec3) -> u64 {
    let spread = |coordinate: f64| {
        let bits = (coordinate * 2_097_151.0) as u64;
        (0..21).fold(0, |spread, bit| spread | (bits >> bit & 1) << (3 * bit))
    };
    spread(place.x) | spread(place.y) << 1 | spread(place.z) << 2
}

/// Numbers of sixteen rays.
type Sixteen = [[f32; WIDTH]; 2];

/// The rays from one point to the targets of a packet, in the tree's frame.
struct Rays {
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
    fn new(frame: &Frame, from: DVec3, directions: &Sixteen3, lengths: &[f64; PACKET]) -> Self {
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

/// Which targets see a point within the scene's bounding sphere, each in front of the other.
pub(super) struct Sight<'a, S, B> {
    pub wide: &'a Wide,
    pub frame: &'a Frame,
    pub question: &'a Question<'a>,
    /// One entry a target.
    pub seen: &'a mut [bool],
    /// Whether a place is seen that single precision cannot tell from the point, or that lies outside the sphere.
    pub single: S,
    /// Whether the triangle at a place among the leaves lies between the point and another; told where it surely does if
    /// it exists there.
    pub between: B,
}

impl<S: FnMut(DVec3) -> bool, B: FnMut(DVec3, usize, bool) -> bool> Work for Sight<'_, S, B> {
    type Output = ();

    #[inline(always)]
    fn with<L: Lanes>(mut self, lanes: L) {
        let entries = Wide::open_entries(self.wide.levels);
        if entries <= OPEN {
            self.look(lanes, &mut [(0, 0); OPEN]);
        } else {
            self.look(lanes, &mut vec![(0, 0); entries]);
        }
    }
}

impl<S: FnMut(DVec3) -> bool, B: FnMut(DVec3, usize, bool) -> bool> Sight<'_, S, B> {
    #[inline(always)]
    fn look<L: Lanes>(&mut self, lanes: L, open: &mut [(u32, u32)]) {
        let &Question {
            from,
            normal,
            sides,
            targets,
        } = self.question;
        let sphere = self.frame.sphere;
        for packet in &targets.packets {
            let segment = less(&packet.places, from);
            let leaving = dot(
                &segment,
                &[[normal.x; PACKET], [normal.y; PACKET], [normal.z; PACKET]],
            );
            let arriving = dot(&segment, &packet.normals);
            let mut length = dot(&segment, &segment);
            for length in &mut length {
                *length = length.sqrt();
            }
            let mut alive = 0;
            for lane in 0..packet.count {
                alive |= u32::from(leaving[lane] > 0.0 && arriving[lane] < 0.0) << lane;
            }
            let mut left = alive;
            while left != 0 {
                let lane = left.trailing_zeros() as usize & 15;
                left &= left - 1;
                let place = packet.place(lane);
                if sides.is_some() && sides == packet.sides[lane] {
                    alive &= !(1 << lane);
                    self.seen[packet.indices[lane] as usize] = true;
                    continue;
                }
                let within = (place - self.frame.centre).length_squared() <= sphere * sphere;
                if !(length[lane] > 0.0 && within) {
                    alive &= !(1 << lane);
                    self.seen[packet.indices[lane] as usize] = (self.single)(place);
                }
            }
            if alive == 0 {
                continue;
            }
            // Rays that take no part must not widen the packet.
            let first = alive.trailing_zeros() as usize & 15;
            let mut direction = [[0.0; PACKET]; 3];
            for lane in 0..PACKET {
                let part = if alive >> lane & 1 == 1 { lane } else { first };
                for axis in 0..3 {
                    direction[axis][lane] = segment[axis][part] / length[part];
                }
            }
            for lane in 0..PACKET {
                if alive >> lane & 1 == 0 {
                    length[lane] = length[first];
                }
            }
            let rays = Rays::new(self.frame, from, &direction, &length);
            alive = self.walk(lanes, &rays, packet, alive, open);
            while alive != 0 {
                let lane = alive.trailing_zeros() as usize & 15;
                alive &= alive - 1;
                self.seen[packet.indices[lane] as usize] = true;
            }
        }
    }

    /// Those of the rays, one bit each, that nothing stops.
    #[inline(always)]
    fn walk<L: Lanes>(
        &mut self,
        lanes: L,
        rays: &Rays,
        packet: &Packet,
        mut alive: u32,
        open: &mut [(u32, u32)],
    ) -> u32 {
        if self.wide.nodes.is_empty() {
            return alive;
        }
        let mut count = 1;
        open[0] = (0, alive);
        while count > 0 && alive != 0 {
            count -= 1;
            let (child, mask) = open[count];
            let mask = mask & alive;
            if mask == 0 {
                continue;
            }
            if child & LEAF != 0 {
                let leaf = &self.wide.leaves[(child & !LEAF) as usize];
                let crossings = Crossings::new(lanes, self.frame, rays, leaf);
                let mut triangles = crossings.any;
                while triangles != 0 {
                    let triangle = triangles.trailing_zeros() as usize & 7;
                    triangles &= triangles - 1;
                    let (may, surely) = crossings.crossed(lanes, rays, triangle);
                    let mut may = may & mask & alive;
                    while may != 0 {
                        let lane = may.trailing_zeros() as usize & 15;
                        may &= may - 1;
                        let place = leaf.first as usize + triangle;
                        let surely = surely >> lane & 1 == 1;
                        if (self.between)(packet.place(lane), place, surely) {
                            alive &= !(1 << lane);
                        }
                    }
                }
            } else {
                let node = &self.wide.nodes[child as usize];
                let slabs = Slabs::new(lanes, rays, node);
                let mut children = slabs.any;
                while children != 0 {
                    let lane = children.trailing_zeros() as usize & 7;
                    children &= children - 1;
                    let met = slabs.met(lanes, rays, lane) & mask;
                    if met != 0 {
                        open[count] = (node.children[lane], met);
                        count += 1;
                    }
                }
            }
        }
        alive
    }
}

impl Packet {
    #[inline(always)]
    fn place(&self, lane: usize) -> DVec3 {
        let [x, y, z] = &self.places;
        DVec3::new(x[lane & 15], y[lane & 15], z[lane & 15])
    }
}

/// Where the children of a node lie from the origin of a packet, and which of them some ray may meet.
struct Slabs {
    sides: [[[f32; WIDTH]; 2]; 3],
    any: u32,
}

impl Slabs {
    #[inline(always)]
    fn new<L: Lanes>(lanes: L, rays: &Rays, node: &Node) -> Self {
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
    fn met<L: Lanes>(&self, lanes: L, rays: &Rays, child: usize) -> u32 {
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
struct Crossings {
    /// From the origin to an edge's start, times the edge: a ray passes the edge on the side of the sign of its product
    /// with this.
    edges: [[[f32; WIDTH]; 3]; 3],
    /// By how much such a product may be wrong.
    blur: [f32; WIDTH],
    /// The vertices as the origin sees them.
    vertices: [[[f32; WIDTH]; 3]; 3],
    /// By how much a distance along a ray may be wrong, and more.
    margin: f32,
    any: u32,
}

impl Crossings {
    /// With ε₀ = 2⁻²⁴, the scene's radius r and a triangle's longest edge l, such a product with a ray that crosses the
    /// triangle is wrong by 7 ε₀ r l from the rounding of its vertices and of the origin, by 4 ε₀ r l from the ray's
    /// direction and by 38 ε₀ r l from its own, and the thickness of triangles shifts it by l slacks. The
    /// longest edge is at most √3 times its longest component.
    #[inline(always)]
    fn new<L: Lanes>(lanes: L, frame: &Frame, rays: &Rays, leaf: &Leaf) -> Self {
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
    fn crossed<L: Lanes>(&self, lanes: L, rays: &Rays, triangle: usize) -> (u32, u32) {
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
