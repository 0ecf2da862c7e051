//! One point against many: rays that share their origin go through the tree together.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane has the same number in several lists"
)]

use super::frame::Frame;
use super::lanes::{Lanes, Work};
use super::rays::{Crossings, Rays, Slabs};
use super::targets::{PACKET, Packet, Question};
use super::wide::{LEAF, OPEN, Wide};
use crate::crossing::Beside;
use glam::DVec3;

/// Numbers of the targets of a packet, by axis.
pub(super) type Sixteen3 = [[f64; PACKET]; 3];

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

/// Which targets see a point within the scene's bounding sphere, each in front of the other.
pub(super) struct Sight<'a, S, P, B> {
    pub wide: &'a Wide,
    pub frame: &'a Frame,
    pub question: &'a Question<'a>,
    /// One entry a target.
    pub seen: &'a mut [bool],
    /// Whether a place is seen that single precision cannot tell from the point, or that lies outside the sphere.
    pub single: S,
    /// What is known of the point and the triangle at a place among the leaves.
    pub beside: P,
    /// Whether such a triangle lies between the point and another; told where it surely does if it exists there.
    pub between: B,
}

impl<S, P, B> Work for Sight<'_, S, P, B>
where
    S: FnMut(DVec3) -> bool,
    P: Fn(usize) -> Beside,
    B: FnMut(DVec3, usize, bool) -> bool,
{
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

impl<S, P, B> Sight<'_, S, P, B>
where
    S: FnMut(DVec3) -> bool,
    P: Fn(usize) -> Beside,
    B: FnMut(DVec3, usize, bool) -> bool,
{
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
                    if may == 0 {
                        continue;
                    }
                    let place = leaf.first as usize + triangle;
                    let beside = (self.beside)(place);
                    while may != 0 {
                        let lane = may.trailing_zeros() as usize & 15;
                        may &= may - 1;
                        let surely = surely >> lane & 1 == 1;
                        let to = packet.place(lane);
                        // Mostly the surface that the point lies on, from which single precision cannot tell it.
                        if beside.keeps_off(to) {
                            continue;
                        }
                        if (self.between)(to, place, surely) {
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
