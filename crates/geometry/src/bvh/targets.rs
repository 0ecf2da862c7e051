//! Points that others are to see, in packets of neighbours.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane has the same number in several lists"
)]

use glam::DVec3;

/// Rays that go together.
pub(super) const PACKET: usize = 16;

/// Points with normals that one point after another is to see, kept in packets of neighbours.
#[derive(Debug, Clone, Default)]
pub struct Targets {
    pub(super) packets: Vec<Packet>,
    len: usize,
}

/// Up to sixteen targets; those missing are copies of the first without a normal, which nothing sees.
#[derive(Debug, Clone)]
pub(super) struct Packet {
    pub places: [[f64; PACKET]; 3],
    pub normals: [[f64; PACKET]; 3],
    pub indices: [u32; PACKET],
    /// On which sides of all planes of the scene, where these are known.
    pub sides: [Option<u32>; PACKET],
    pub count: usize,
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

    /// Which of them lie near one another, up to sixteen at a time.
    pub fn clusters(&self) -> impl Iterator<Item = &[u32]> {
        let packets = self.packets.iter();
        packets.map(|packet| &packet.indices[..packet.count])
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

impl Packet {
    #[inline(always)]
    pub fn place(&self, lane: usize) -> DVec3 {
        let [x, y, z] = &self.places;
        DVec3::new(x[lane & 15], y[lane & 15], z[lane & 15])
    }
}

/// Place of a point of the unit cube along a curve through it whose stretches are compact (Morton 1966).
fn morton(place: DVec3) -> u64 {
    let spread = |coordinate: f64| {
        let bits = (coordinate * 2_097_151.0) as u64;
        (0..21).fold(0, |spread, bit| spread | (bits >> bit & 1) << (3 * bit))
    };
    spread(place.x) | spread(place.y) << 1 | spread(place.z) << 2
}
