//! Choosing from a list in proportion to what each entry has.

use std::ops::Range;

/// What the first entries of a list have together.
#[derive(Debug)]
pub(crate) struct Cumulated {
    /// Of the first i + 1.
    until: Vec<f64>,
    /// The first entry that reaches each of as many equal steps as there are entries: where to look for one.
    guide: Vec<u32>,
}

impl Cumulated {
    /// Of entries that have so much each, ≥ 0.
    pub(crate) fn new(entries: impl Iterator<Item = f64>) -> Self {
        let until: Vec<f64> = entries
            .scan(0.0, |sum, own| {
                *sum += own;
                Some(*sum)
            })
            .collect();
        let count = until.len();
        let step = until.last().map_or(0.0, |total| total / count as f64);
        let first = |index: usize| until.partition_point(|&u| u <= step * index as f64);
        Self {
            guide: (0..=count).map(|index| first(index) as u32).collect(),
            until,
        }
    }

    /// How many entries there are.
    pub(crate) fn len(&self) -> usize {
        self.until.len()
    }

    /// What the first `count` have.
    pub(crate) fn total(&self, count: usize) -> f64 {
        count.checked_sub(1).map_or(0.0, |last| self.until[last])
    }

    /// The one of the first `count` entries, one at least, that a uniform number chooses, and where within that entry it lies:
    /// again a uniform number, so that numbers next to each other choose places next to each other.
    pub(crate) fn choose(&self, count: usize, u: f64) -> (usize, f64) {
        let all = self.len();
        let target = u * self.total(count);
        let step = (target / self.total(all) * all as f64) as usize;
        let [start, end] = [step, step + 1].map(|step| self.guide[step.min(all)] as usize);
        let mut entry = self.search(start..end, target);
        // Rounding may have told the step beside.
        if self.total(entry) > target || self.until.get(entry).is_some_and(|&u| u <= target) {
            entry = self.search(0..all, target);
        }
        let entry = entry.min(count - 1);
        let below = self.total(entry);
        let within = (target - below) / (self.until[entry] - below);
        (entry, within.clamp(0.0, 1.0 - f64::EPSILON))
    }

    /// The first entry of a range to reach more.
    fn search(&self, range: Range<usize>, target: f64) -> usize {
        let start = range.start;
        start + self.until[range].partition_point(|&u| u <= target)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_chosen_as_if_all_were_asked() {
        // Steps that hold none, one and many of them, and entries without anything.
        let given = [
            0.0, 1e-9, 3.0, 0.0, 1e-3, 1e-3, 1e-3, 500.0, 1e-12, 2.0, 0.0,
        ];
        let cumulated = Cumulated::new(given.into_iter());
        for count in 2..=given.len() {
            let total: f64 = given[..count].iter().sum();
            for draw in 0..10_000 {
                let u = f64::from(draw) / 1e4;
                let (entry, within) = cumulated.choose(count, u);
                assert!(entry < count && given[entry] > 0.0);
                let below: f64 = given[..entry].iter().sum();
                assert!((below + within * given[entry] - u * total).abs() < 1e-12 * total);
            }
        }
    }
}
