//! One point against many: rays that share their origin go through the tree together.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane has the same number in several lists"
)]

use super::frame::Frame;
use super::lanes::{Lanes, Work};
use super::rays::{Crossings, Rays, Slabs};
use super::targets::{PACKET, Packet, Question};
use super::wide::{LEAF, OPEN, WIDTH, Wide};
use crate::crossing::Beside;
use glam::DVec3;

/// One bit for each ray of a packet.
const EACH: u32 = (1 << PACKET) - 1;

/// Coordinates of the targets of a packet, by axis.
type Places = [[f64; PACKET]; 3];

#[inline(always)]
fn less(places: &Places, from: DVec3) -> Places {
    let mut segment = [[0.0; PACKET]; 3];
    for axis in 0..3 {
        for lane in 0..PACKET {
            segment[axis][lane] = places[axis][lane] - from[axis];
        }
    }
    segment
}

#[inline(always)]
fn dot(a: &Places, b: &Places) -> [f64; PACKET] {
    let mut sums = [0.0; PACKET];
    for lane in 0..PACKET {
        sums[lane] = a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane];
    }
    sums
}

/// One bit a lane.
#[inline(always)]
fn bits(whether: impl Fn(usize) -> bool) -> u32 {
    let mut bits = 0;
    for lane in 0..PACKET {
        bits |= u32::from(whether(lane)) << lane;
    }
    bits
}

/// Which targets see a point within the scene's bounding sphere, each in front of the other.
pub(super) struct Sight<'a, S, P, Q, W, B> {
    pub wide: &'a Wide,
    pub frame: &'a Frame,
    pub question: &'a Question<'a>,
    /// One entry a target.
    pub seen: &'a mut [bool],
    /// The leaf that last stopped a ray; it is likely to stop the next packet's.
    pub last: Option<u32>,
    /// Whether a place is seen that single precision cannot tell from the point, or that lies outside the sphere.
    pub single: S,
    /// What is known of the point and the triangle at a place among the leaves.
    pub beside: P,
    /// The same of the triangle with all that may cover it.
    pub beyond: Q,
    /// Whether such a triangle exists wherever it is crossed.
    pub whole: W,
    /// Whether it lies between the point and another.
    pub between: B,
}

impl<S, P, Q, W, B> Work for Sight<'_, S, P, Q, W, B>
where
    S: FnMut(DVec3) -> bool,
    P: Fn(usize) -> Beside,
    Q: Fn(usize) -> Beside,
    W: Fn(usize) -> bool,
    B: Fn(DVec3, usize) -> bool,
{
    type Output = ();

    #[inline(always)]
    fn with<E: Lanes<WIDTH>, L: Lanes<PACKET>>(mut self, eight: E, lanes: L) {
        // Beside the open children, the leaf tried first, and a child that no ray meets.
        let entries = Wide::open_entries(self.wide.levels) + 2;
        if entries <= OPEN {
            self.look(eight, lanes, &mut [(0, 0); OPEN]);
        } else {
            self.look(eight, lanes, &mut vec![(0, 0); entries]);
        }
    }
}

impl<S, P, Q, W, B> Sight<'_, S, P, Q, W, B>
where
    S: FnMut(DVec3) -> bool,
    P: Fn(usize) -> Beside,
    Q: Fn(usize) -> Beside,
    W: Fn(usize) -> bool,
    B: Fn(DVec3, usize) -> bool,
{
    #[inline(always)]
    fn look<E: Lanes<WIDTH>, L: Lanes<PACKET>>(
        &mut self,
        eight: E,
        lanes: L,
        open: &mut [(u32, u32)],
    ) {
        let &Question {
            from,
            normal,
            sides,
            targets,
        } = self.question;
        let sphere = self.frame.sphere;
        let normals = [normal.x, normal.y, normal.z].map(|part| [part; PACKET]);
        for packet in &targets.packets {
            let mut segment = less(&packet.places, from);
            let leaving = dot(&segment, &normals);
            let arriving = dot(&segment, &packet.normals);
            let mut alive = bits(|lane| (leaving[lane] > 0.0) & (arriving[lane] < 0.0));
            // Targets missing have no normal.
            if alive == 0 {
                continue;
            }
            if sides.is_some() {
                for lane in 0..PACKET {
                    if alive >> lane & 1 == 1 && sides == packet.sides[lane] {
                        alive &= !(1 << lane);
                        self.seen[packet.indices[lane] as usize] = true;
                    }
                }
            }
            let off = less(&packet.places, self.frame.centre);
            let (mut square, aside) = (dot(&segment, &segment), dot(&off, &off));
            let good = bits(|lane| (square[lane] > 0.0) & (aside[lane] <= sphere * sphere));
            let mut single = alive & !good;
            alive &= good;
            while single != 0 {
                let lane = single.trailing_zeros() as usize & 15;
                single &= single - 1;
                let seen = (self.single)(packet.place(lane));
                self.seen[packet.indices[lane] as usize] = seen;
            }
            if alive == 0 {
                continue;
            }
            let first = alive.trailing_zeros() as usize & 15;
            // Rays that take no part must not widen the packet.
            let mut others = !alive & EACH;
            while others != 0 {
                let lane = others.trailing_zeros() as usize & 15;
                others &= others - 1;
                square[lane] = square[first];
                for axis in 0..3 {
                    segment[axis][lane] = segment[axis][first];
                }
            }
            let mut length = [0.0; PACKET];
            for lane in 0..PACKET {
                length[lane] = square[lane].sqrt();
            }
            let mut direction = [[0.0; PACKET]; 3];
            for axis in 0..3 {
                for lane in 0..PACKET {
                    // A negative zero would turn its inverse to the wrong side of a box.
                    direction[axis][lane] = (segment[axis][lane] / length[lane]) as f32 + 0.0;
                }
            }
            let rays = Rays::new(lanes, self.frame, from, &direction, &length);
            alive = self.walk(eight, lanes, &rays, packet, alive, open);
            while alive != 0 {
                let lane = alive.trailing_zeros() as usize & 15;
                alive &= alive - 1;
                self.seen[packet.indices[lane] as usize] = true;
            }
        }
    }

    /// Those of the rays, one bit each, that nothing stops.
    #[inline(always)]
    fn walk<E: Lanes<WIDTH>, L: Lanes<PACKET>>(
        &mut self,
        eight: E,
        lanes: L,
        rays: &Rays<L>,
        packet: &Packet,
        mut alive: u32,
        open: &mut [(u32, u32)],
    ) -> u32 {
        if self.wide.nodes.is_empty() {
            return alive;
        }
        open[0] = (0, alive);
        let mut count = 1;
        let mut tried = None;
        if let Some(leaf) = self.last {
            open[1] = (leaf, alive);
            count = 2;
        }
        while count > 0 && alive != 0 {
            count -= 1;
            let (child, mask) = open[count];
            let mask = mask & alive;
            if mask == 0 || tried == Some(child) {
                continue;
            }
            if child & LEAF != 0 {
                tried = tried.or(Some(child));
                let leaf = &self.wide.leaves[(child & !LEAF) as usize];
                let crossings = Crossings::new(eight, self.frame, rays, leaf);
                let mut triangles = crossings.any;
                while triangles != 0 {
                    let triangle = triangles.trailing_zeros() as usize & 7;
                    triangles &= triangles - 1;
                    let (may, inside) = crossings.crossed(lanes, rays, triangle);
                    let mut may = may & mask & alive;
                    if may == 0 {
                        continue;
                    }
                    let place = leaf.first as usize + triangle;
                    let (off, parted) = (self.beside)(place).sides(&packet.places);
                    // Mostly the surface that the point lies on, from which single precision cannot tell it.
                    may &= !off;
                    let mut stopped = may & inside & parted;
                    if stopped != 0 && !(self.whole)(place) {
                        stopped &= (self.beyond)(place).sides(&packet.places).1;
                    }
                    may &= !stopped;
                    while may != 0 {
                        let lane = may.trailing_zeros() as usize & 15;
                        may &= may - 1;
                        stopped |= u32::from((self.between)(packet.place(lane), place)) << lane;
                    }
                    if stopped != 0 {
                        alive &= !stopped;
                        self.last = Some(child);
                    }
                }
            } else {
                let node = &self.wide.nodes[child as usize];
                let slabs = Slabs::new(eight, rays, node);
                let mut children = slabs.any;
                while children != 0 {
                    let lane = children.trailing_zeros() as usize & 7;
                    children &= children - 1;
                    let met = slabs.met(lanes, rays, lane) & mask;
                    // Without a branch, which would be hard to foresee.
                    open[count] = (node.children[lane], met);
                    count += usize::from(met != 0);
                }
            }
        }
        alive
    }
}
