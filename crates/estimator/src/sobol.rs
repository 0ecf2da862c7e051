//! Owen-scrambled Sobol' points (Burley 2020), four dimensions at a time.
//!
//! They are those of [`sobol_burley::sample_4d`]. That shuffles the index of a point anew for every four dimensions, and adds
//! direction numbers bit by bit; here a point is shuffled once, and four bits are looked up at a time.

use sobol_burley::parts::{
    Int4, hash, hash_int4, owen_scramble_int4_rev, owen_scramble_rev, sobol_int4_rev,
};
use std::sync::LazyLock;

/// Length of a sequence, as a power of two.
pub(crate) const LENGTH: u32 = 16;

/// Sets of four dimensions.
const SETS: u32 = 48;

/// Bits of an index that are looked up at once.
const BITS: u32 = 4;

/// Sums of direction numbers, by the bits of an index that ask for them.
type Sums = [[u32; 4]; 1 << BITS];

/// Those of each set of dimensions, by place of the bits in the index, from the highest on.
static SUMS: LazyLock<Vec<[Sums; (LENGTH / BITS) as usize]>> =
    LazyLock::new(|| (0..SETS).map(sums).collect());

fn sums(set: u32) -> [Sums; (LENGTH / BITS) as usize] {
    std::array::from_fn(|place| {
        let shift = u32::BITS - BITS * (place as u32 + 1);
        std::array::from_fn(|bits| sobol_int4_rev((bits as u32) << shift, set).into())
    })
}

/// A point of a sequence.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    /// Its index, shuffled, the lowest bit first.
    shuffled: u32,
    /// What the sequence is scrambled by.
    seed: u32,
}

impl Point {
    /// The point of that index, below 2¹⁶, of the sequence that is scrambled by `seed`.
    #[must_use]
    pub(crate) fn new(index: u32, seed: u32) -> Self {
        Self {
            shuffled: owen_scramble_rev(index.reverse_bits(), hash(seed ^ 0x79c6_8e4a)),
            seed,
        }
    }

    /// Four coordinates in [0, 1), multiples of 2⁻²³: those of a set of dimensions below [`SETS`].
    #[must_use]
    #[inline]
    pub(crate) fn four(self, set: u32) -> [f32; 4] {
        let mut point = Int4::from([0; 4]);
        for (place, sums) in SUMS[set as usize].iter().enumerate() {
            let bits = self.shuffled >> (u32::BITS - BITS * (place as u32 + 1));
            point ^= sums[bits as usize & ((1 << BITS) - 1)].into();
        }
        let scramble = self.seed.wrapping_mul(0x9c8f_2d3b) ^ set;
        let lanes = [0x912f_69ba, 0x174f_18ab, 0x691e_72ca, 0xb40c_c1b8];
        let scramble = hash_int4(lanes.map(|lane| lane ^ scramble).into());
        let point = owen_scramble_int4_rev(point, scramble);
        point.reverse_bits().to_f32_norm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_those_of_the_crate() {
        for seed in [0, 1, 0x1234_5678, u32::MAX] {
            for index in (0..1 << LENGTH).step_by(37) {
                let point = Point::new(index, seed);
                for set in 0..SETS {
                    let expected = sobol_burley::sample_4d(index, set, seed);
                    assert_eq!(
                        point.four(set).map(f32::to_bits),
                        expected.map(f32::to_bits),
                        "{index}, {set}, {seed}"
                    );
                }
            }
        }
    }
}
