//! Uniform numbers, each a pure function of (seed, replica, stream, walk, depth, purpose).
//!
//! Nothing here has a state that a walk could leave behind, so walks that part company meet again at
//! the next vertex, and no number depends on the thread that asked for it.
//!
//! The first vertices of the walks of one replica are spread evenly: Owen-scrambled Sobol' points (Burley 2020) of all these
//! dimensions together, scrambled anew for each replica, so that the spread between replicas is an honest error.
//! Each point by itself is uniform, so any number of them is without bias. What comes later is independent.

use crate::sobol::{LENGTH, Point};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What a block of four uniforms is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// The direction in which a walk leaves an emitter, and the point where.
    Launch = 0,
    /// Lobe and direction in which a walk from an emitter goes on.
    Scatter = 1,
    /// The same for a walk from a sensor, its first direction included.
    Search = 2,
    /// The point of an emitter that a vertex looks at.
    Connect = 3,
    /// The chain of mirrors in which a vertex looks for an emitter.
    Reflect = 4,
    /// The small mirror that the companion of a walk from a sensor is aimed at.
    Glint = 5,
    /// Whether a vertex of a long walk takes part in bridges.
    Bridge = 6,
}

impl Purpose {
    /// Which four dimensions of the Sobol' points serve it at a vertex whose numbers are spread evenly: the lowest, which are
    /// spread best, decide where walks go.
    fn dimensions(self, depth: u32) -> u32 {
        match self {
            Self::Launch => 0,
            Self::Scatter | Self::Search => depth,
            // What a sensor itself looks at comes after that of the vertices, which most of the light comes by.
            Self::Reflect if depth == 0 => 2 * SPREAD,
            Self::Connect if depth == 0 => 2 * SPREAD + 1,
            Self::Connect => SPREAD - 1 + depth,
            Self::Reflect => 2 * SPREAD + 1 + depth,
            Self::Glint => 3 * SPREAD + 1 + depth,
            // Walks so long are beyond all that is spread evenly.
            Self::Bridge => 4 * SPREAD + 1 + depth,
        }
    }
}

const PURPOSES: u64 = 8;
const BLOCK: u64 = 4;

/// Vertices of a walk, its start included, whose numbers are spread evenly.
const SPREAD: u32 = 8;

/// Weyl increment of SplitMix64 (Steele, Lea & Flood 2014): the odd number nearest 2⁶⁴/φ.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// The finaliser of SplitMix64, variant 13 of Stafford's mixers.
fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The numbers of one replica.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stream {
    key: u64,
}

impl Stream {
    /// Stream of a replica. Its key comes from ChaCha8, so that neighbouring seeds and replicas share nothing.
    #[must_use]
    pub(crate) fn new(seed: u64, replica: u32) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(u64::from(replica));
        Self {
            key: generator.next_u64(),
        }
    }

    /// A stream of its own inside this one, for one sensor say.
    #[must_use]
    pub(crate) fn branch(self, index: u64) -> Self {
        Self {
            key: mixed(self.key ^ mixed(index.wrapping_add(1).wrapping_mul(GOLDEN))),
        }
    }

    /// The `index`-th walk of this stream.
    #[must_use]
    pub(crate) fn walk(self, index: u64) -> Uniforms {
        // A sequence that has come to its end is scrambled anew.
        let sequence = index >> LENGTH;
        let seed = mixed(self.key ^ mixed(sequence.wrapping_mul(GOLDEN) ^ GOLDEN)) as u32;
        Uniforms {
            point: Point::new((index & ((1 << LENGTH) - 1)) as u32, seed),
            key: mixed(
                self.key
                    .wrapping_add(mixed(index.wrapping_mul(GOLDEN) ^ GOLDEN)),
            ),
        }
    }
}

/// Uniform numbers one after the other, for what needs an unknown number of them.
#[derive(Debug, Clone)]
pub(crate) struct Fresh {
    key: u64,
    taken: u64,
}

impl Fresh {
    /// The next four numbers in [0, 1).
    pub(crate) fn next(&mut self) -> [f64; 4] {
        std::array::from_fn(|_| {
            self.taken += 1;
            let bits = mixed(self.key.wrapping_add(self.taken.wrapping_mul(GOLDEN)));
            (bits >> 11) as f64 * (0.5 / (1u64 << 52) as f64)
        })
    }
}

/// All uniform numbers of one walk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Uniforms {
    /// Those that are spread evenly.
    point: Point,
    key: u64,
}

impl Uniforms {
    /// Four numbers for the mirror of that `order` in the chain by which the vertex at `depth` looks for an emitter.
    #[must_use]
    pub(crate) fn in_chain(self, depth: u32, order: u32) -> [f64; 4] {
        if order == 0 {
            return self.at(depth, Purpose::Reflect);
        }
        let chain = u64::from(depth) << 32 | u64::from(order);
        let key = mixed(self.key ^ mixed(chain.wrapping_mul(GOLDEN)));
        Self { key, ..self }.at(SPREAD, Purpose::Reflect)
    }

    /// Numbers without end, for the image of that `order` by which the vertex at `depth` looks for an emitter.
    #[must_use]
    pub(crate) fn fresh(self, depth: u32, order: u32) -> Fresh {
        let chain = u64::from(depth) << 32 | u64::from(order);
        Fresh {
            key: mixed(self.key ^ mixed(!chain.wrapping_mul(GOLDEN))),
            taken: 0,
        }
    }

    /// Four numbers in [0, 1), multiples of 2⁻⁵³, for the vertex at `depth`.
    #[must_use]
    #[inline]
    pub(crate) fn at(self, depth: u32, purpose: Purpose) -> [f64; 4] {
        let block = u64::from(depth) * PURPOSES + purpose as u64;
        let bits = |i: usize| {
            let counter = block * BLOCK + i as u64 + 1;
            mixed(self.key.wrapping_add(counter.wrapping_mul(GOLDEN)))
        };
        if depth >= SPREAD {
            return std::array::from_fn(|i| (bits(i) >> 11) as f64 * (0.5 / (1u64 << 52) as f64));
        }
        let point = self.point.four(purpose.dimensions(depth));
        // Single precision gives 23 bits; independent ones fill the other 30, two numbers' worth from each hash.
        let (low, high) = (bits(0), bits(1));
        let rest = [low >> 34, low & 0x3FFF_FFFF, high >> 34, high & 0x3FFF_FFFF];
        std::array::from_fn(|i| f64::from(point[i]) + rest[i] as f64 * (0.5 / (1u64 << 52) as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_lie_in_the_half_open_unit_interval_and_fill_it_evenly() {
        // χ² over 64 cells for each of the four coordinates, 65,536 draws: mean 63, σ = √126.
        let stream = Stream::new(1, 0);
        let mut counts = [[0u32; 64]; 4];
        for index in 0..65_536 {
            for (u, cells) in stream
                .walk(index)
                .at(SPREAD, Purpose::Scatter)
                .into_iter()
                .zip(&mut counts)
            {
                assert!((0.0..1.0).contains(&u));
                cells[(u * 64.0) as usize] += 1;
            }
        }
        for cells in counts {
            let chi2: f64 = cells
                .iter()
                .map(|&c| (f64::from(c) - 1024.0).powi(2) / 1024.0)
                .sum();
            assert!((chi2 - 63.0).abs() < 4.5 * 126f64.sqrt(), "χ² = {chi2}");
        }
    }

    #[test]
    fn neighbours_in_every_argument_are_uncorrelated() {
        let n = 20_000u64;
        let reference = |i: u64| {
            Stream::new(7, 3)
                .branch(5)
                .walk(i)
                .at(SPREAD, Purpose::Scatter)[0]
        };
        type Draw = fn(u64) -> f64;
        let neighbours: [(&str, Draw); 6] = [
            ("seed", |i| {
                Stream::new(8, 3)
                    .branch(5)
                    .walk(i)
                    .at(SPREAD, Purpose::Scatter)[0]
            }),
            ("replica", |i| {
                Stream::new(7, 4)
                    .branch(5)
                    .walk(i)
                    .at(SPREAD, Purpose::Scatter)[0]
            }),
            ("branch", |i| {
                Stream::new(7, 3)
                    .branch(6)
                    .walk(i)
                    .at(SPREAD, Purpose::Scatter)[0]
            }),
            ("walk", |i| {
                Stream::new(7, 3)
                    .branch(5)
                    .walk(i + 1)
                    .at(SPREAD, Purpose::Scatter)[0]
            }),
            ("depth", |i| {
                Stream::new(7, 3).branch(5).walk(i).at(3, Purpose::Scatter)[0]
            }),
            ("purpose", |i| {
                Stream::new(7, 3)
                    .branch(5)
                    .walk(i)
                    .at(SPREAD, Purpose::Connect)[0]
            }),
        ];
        for (argument, neighbour) in neighbours {
            let covariance: f64 = (0..n)
                .map(|i| (reference(i) - 0.5) * (neighbour(i) - 0.5))
                .sum::<f64>()
                / n as f64;
            // The product of two independent uniforms less ½ has the standard deviation 1/12.
            let z = covariance * 12.0 * (n as f64).sqrt();
            assert!(z.abs() < 4.5, "{argument}: z = {z}");
        }
    }

    #[test]
    fn first_vertices_are_spread_evenly_and_others_are_not() {
        let stream = Stream::new(3, 1).branch(2);
        let filled = |depth: u32, purpose: Purpose, cell: &dyn Fn([f64; 4]) -> f64| {
            let numbers = (0..256).map(|index| stream.walk(index).at(depth, purpose));
            let mut cells: Vec<u32> = numbers.map(|n| cell(n) as u32).collect();
            cells.sort_unstable();
            cells.dedup();
            cells.len()
        };
        // 2⁸ points of a (0, 8, 2)-net in base 2: each of 16 × 16 cells holds one.
        let square = |[_, u, v, _]: [f64; 4]| (u * 16.0).floor() * 16.0 + (v * 16.0).floor();
        assert_eq!(filled(0, Purpose::Launch, &square), 256);
        // In every single dimension each of 256 columns does.
        for dimension in 0..4 {
            let column = |numbers: [f64; 4]| numbers[dimension] * 256.0;
            for depth in 0..SPREAD {
                assert_eq!(filled(depth, Purpose::Connect, &column), 256);
            }
            // Of 256 independent points 256 (1 − 1/e) = 162 columns are hit, ± 8.
            assert!(filled(SPREAD, Purpose::Connect, &column) < 200);
        }
    }

    #[test]
    fn spread_numbers_are_uniform_one_by_one() {
        // Means of u and u² over 20,000 replicas of one and the same walk.
        let (mut first, mut second) = (0.0, 0.0);
        let count = 20_000;
        for replica in 0..count {
            let u = Stream::new(1, replica).walk(5).at(1, Purpose::Scatter)[2];
            assert!((0.0..1.0).contains(&u));
            first += u / f64::from(count);
            second += u * u / f64::from(count);
        }
        // Standard deviations of a uniform number and its square: √(1/12), √(4/45).
        assert!((first - 0.5).abs() < 4.5 * (1.0 / 12.0 / f64::from(count)).sqrt());
        assert!((second - 1.0 / 3.0).abs() < 4.5 * (4.0 / 45.0 / f64::from(count)).sqrt());
    }

    #[test]
    fn the_same_arguments_give_the_same_number() {
        let bits = || {
            let uniforms = Stream::new(1, 2).branch(3).walk(4);
            uniforms.at(5, Purpose::Connect).map(f64::to_bits)
        };
        assert_eq!(bits(), bits());
    }
}
