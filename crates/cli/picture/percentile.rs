//! Percentiles of many numbers in little memory.

/// How many numbers there are of each size, in 256 bins from each power of two to the next.
#[derive(Clone, Debug)]
pub struct Percentiles {
    bins: Vec<u64>,
    count: u64,
}

/// Low bits of an f32 that a bin leaves out: 8 of the 23 bits of the fraction remain.
const LEFT_OUT: u32 = 15;

impl Percentiles {
    /// Of no numbers.
    pub fn new() -> Self {
        Self {
            bins: vec![0; 1 << (31 - LEFT_OUT)],
            count: 0,
        }
    }

    /// Counts a number; those that are not above 0 and finite take no part.
    pub fn add(&mut self, value: f32) {
        if value > 0.0 && value.is_finite() {
            // Positive floats are in the order of their bits.
            self.bins[(value.to_bits() >> LEFT_OUT) as usize] += 1;
            self.count += 1;
        }
    }

    /// The number that `share` (0 … 1) of all are not above, to 0.4 % below; `None` of no numbers.
    pub fn at(&self, share: f64) -> Option<f32> {
        let rank = ((share * self.count as f64).ceil() as u64).max(1);
        let mut below = 0;
        let bin = self.bins.iter().position(|bin| {
            below += bin;
            below >= rank
        })?;
        Some(f32::from_bits((bin as u32) << LEFT_OUT))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_those_of_the_sorted_numbers_within_a_bin() {
        let mut percentiles = Percentiles::new();
        for value in 1..=1000_u16 {
            percentiles.add(f32::from(value));
        }
        for share in [0.01, 0.5, 0.95, 1.0] {
            let found = f64::from(percentiles.at(share).expect("numbers"));
            assert!(
                (0.996..=1.0).contains(&(found / (1000.0 * share))),
                "{found}"
            );
        }
        assert_eq!(percentiles.at(0.0), Some(1.0));
    }

    #[test]
    fn darkness_and_what_is_no_number_take_no_part() {
        let mut percentiles = Percentiles::new();
        for value in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            percentiles.add(value);
        }
        assert_eq!(percentiles.at(0.5), None);
        percentiles.add(f32::MAX);
        percentiles.add(f32::MIN_POSITIVE / 2.0);
        assert!(percentiles.at(1.0) > Some(3.38e38));
    }
}
