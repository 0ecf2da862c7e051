//! When a run is looked at: fixed beforehand, so that luck does not choose it.

/// When a run is judged, by walks a replica.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Checkpoints {
    first: u64,
}

impl Checkpoints {
    /// Walks a replica of which the spread tells the error well enough to go on because of it.
    const TELLING: u64 = 16;

    /// Walks a replica of which the spread tells the error at all.
    const FEWEST: u64 = 1;

    /// By how much less the error has to be expected than it may be, so that hardly a run goes on.
    const MARGIN: f64 = 2.5;

    /// With few walks luck makes an error look small or large together with the mean: a run that stopped because of it would
    /// be biased. So what the pilot has found decides how early a run is judged for the first time, and few walks are enough
    /// where it makes little doubt that they are.
    pub(crate) fn new(goal: Option<f64>, expected_error: impl Fn(u64) -> f64) -> Self {
        let mut first = Self::FEWEST;
        while first < Self::TELLING
            && goal.is_none_or(|goal| Self::MARGIN * expected_error(first) > goal)
        {
            first += 1 << first.ilog2().saturating_sub(1);
        }
        Self { first }
    }

    /// The first checkpoint after `taken` walks a replica: of the first of all, one to the octave, and two as soon as they
    /// tell enough. At every look luck may stop a run too early, so there are few.
    pub(crate) fn after(self, taken: u64) -> u64 {
        let mut next = self.first;
        while next <= taken {
            next = if next < Self::TELLING {
                2 * next
            } else {
                let spacing = 1 << (next.ilog2() - 1);
                (next / spacing + 1) * spacing
            };
        }
        next
    }

    /// Whether one is reached after so many.
    pub(crate) fn holds(self, taken: u64) -> bool {
        self.after(taken - 1) == taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checkpoints_stand_two_to_the_octave_and_one_before_where_little_is_asked() {
        let first = |goal, expected: f64, count: usize| -> Vec<u64> {
            let checkpoints = Checkpoints::new(goal, |walks| expected / (walks as f64).sqrt());
            let mut taken = 0;
            let mut next = || {
                // However long the steps are.
                let next = checkpoints.after(taken);
                for step in taken + 1..next {
                    assert!(!checkpoints.holds(step) && checkpoints.after(step) == next);
                }
                assert!(checkpoints.holds(next));
                taken = next;
                taken
            };
            (0..count).map(|_| next()).collect()
        };
        let all = [16, 24, 32, 48, 64, 96, 128, 192, 256, 384];
        assert_eq!(first(None, 1.0, 10), all);
        assert_eq!(first(Some(0.3), 1.0, 10), all);
        // Where less is expected to do, a run is judged earlier, too.
        assert_eq!(first(Some(2.5), 2.0, 3), [4, 8, 16]);
        assert_eq!(first(Some(2.49), 2.0, 3), [6, 12, 24]);
        assert_eq!(first(Some(3.6), 2.0, 3), [2, 4, 8]);
        assert_eq!(first(Some(5.0), 2.0, 3), [1, 2, 4]);
    }
}
