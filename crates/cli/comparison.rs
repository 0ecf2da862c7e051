//! Which variants differ, and in which order they stand: paired differences, corrected for their number.

use malus_estimator::{Estimate, half_width, two_sided};
use rayon::prelude::*;

/// Chance that any of a family of comparisons finds a difference where there is none.
pub const LEVEL: f64 = 0.05;

/// Pairs that are corrected by Holm's procedure; more of them by Bonferroni's, which keeps nothing in memory.
const MOST_PAIRS: usize = 2_000_000;

/// Replicas that are summed side by side.
const LANES: usize = 8;

/// One difference among several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The difference, with its paired standard error.
    pub estimate: Estimate,
    /// Ends of its interval: all intervals of the family hold their differences with a confidence of 95 % (Bonferroni).
    pub interval: [f64; 2],
    /// Probability with which chance alone makes one this large.
    pub p: f64,
    /// The same, corrected for the number of differences (Holm 1979).
    pub p_corrected: f64,
}

impl Difference {
    /// Whether the two differ.
    pub fn is_one(&self) -> bool {
        self.p_corrected < LEVEL
    }
}

/// A family of differences, each with `dof` degrees of freedom of its error.
pub fn differences(estimates: &[Estimate], dof: u32) -> Vec<Difference> {
    let p: Vec<f64> = estimates.iter().map(|it| probability(it, dof)).collect();
    let corrected = corrected(&p);
    let reach = half_width(1.0 - LEVEL / estimates.len().max(1) as f64, dof);
    let difference = |((estimate, p), p_corrected): ((&Estimate, &f64), f64)| Difference {
        estimate: *estimate,
        interval: [-reach, reach].map(|reach| estimate.mean + reach * estimate.standard_error),
        p: *p,
        p_corrected,
    };
    estimates
        .iter()
        .zip(&p)
        .zip(corrected)
        .map(difference)
        .collect()
}

/// Probability with which chance alone makes a difference as large.
fn probability(estimate: &Estimate, dof: u32) -> f64 {
    if estimate.mean == 0.0 {
        return 1.0;
    }
    two_sided(estimate.mean / estimate.standard_error, dof)
}

/// Holm's correction: the smallest of m probabilities times m, the next times m − 1 and so on, none below one before it.
fn corrected(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut corrected = vec![0.0; p.len()];
    let mut least: f64 = 0.0;
    for (place, &index) in order.iter().enumerate() {
        least = least.max(((p.len() - place) as f64 * p[index]).min(1.0));
        corrected[index] = least;
    }
    corrected
}

/// A place in an order, with those that it may as well have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rank {
    /// Which of the values.
    pub index: usize,
    /// First and last place that cannot be told from this one, counted from 1: with a confidence of 95 % for all
    /// values together, so many are greater and so many less.
    pub places: [usize; 2],
}

/// The order of several values, the greatest first; `values` holds each in every replica.
pub fn ranking(values: &[&[f64]], dof: u32) -> Vec<Rank> {
    let sorted = Sorted::new(values);
    let count = values.len();
    let number = count * count.saturating_sub(1) / 2;
    let told_apart = if number <= MOST_PAIRS {
        sorted.by_holm(dof)
    } else {
        sorted.by_bonferroni(half_width(1.0 - LEVEL / number as f64, dof))
    };
    let rank = |(index, apart): (usize, Apart)| Rank {
        index,
        places: [1 + apart.greater, count - apart.less],
    };
    sorted.order.into_iter().zip(told_apart).map(rank).collect()
}

/// How many values are surely greater and surely less than one.
#[derive(Clone, Copy, Default)]
struct Apart {
    greater: usize,
    less: usize,
}

/// Values from the greatest to the least.
struct Sorted {
    /// Which value stands in each place.
    order: Vec<usize>,
    estimates: Vec<Estimate>,
    /// What each is in every replica less its mean, in groups that a vector unit takes together; zeros fill the last.
    deviations: Vec<[f64; LANES]>,
    replicas: usize,
}

impl Sorted {
    fn new(values: &[&[f64]]) -> Self {
        let mut estimated: Vec<(usize, Estimate)> = values
            .iter()
            .map(|it| Estimate::of(it))
            .enumerate()
            .collect();
        estimated.sort_by(|(_, a), (_, b)| b.mean.total_cmp(&a.mean));
        let mut deviations = Vec::new();
        for (index, estimate) in &estimated {
            for values in values[*index].chunks(LANES) {
                let mut group = [0.0; LANES];
                for (deviation, value) in group.iter_mut().zip(values) {
                    *deviation = value - estimate.mean;
                }
                deviations.push(group);
            }
        }
        let (order, estimates) = estimated.into_iter().unzip();
        Self {
            order,
            estimates,
            deviations,
            replicas: values.first().map_or(0, |it| it.len()),
        }
    }

    /// The difference of the values in two places, with its paired error.
    fn difference(&self, a: usize, b: usize) -> Estimate {
        let groups = self.replicas.div_ceil(LANES);
        let of = |place: usize| &self.deviations[place * groups..][..groups];
        let mut squares = [0.0; LANES];
        for (a, b) in of(a).iter().zip(of(b)) {
            for (square, (a, b)) in squares.iter_mut().zip(a.iter().zip(b)) {
                *square += (a - b) * (a - b);
            }
        }
        let count = self.replicas as f64;
        let variance = squares.iter().sum::<f64>() / (count * (count - 1.0)).max(1.0);
        Estimate {
            mean: self.estimates[a].mean - self.estimates[b].mean,
            standard_error: variance.sqrt(),
        }
    }

    /// What Holm's procedure tells apart.
    fn by_holm(&self, dof: u32) -> Vec<Apart> {
        let count = self.order.len();
        let pairs = || (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
        let p: Vec<f64> = pairs()
            .map(|(a, b)| probability(&self.difference(a, b), dof))
            .collect();
        let mut found = vec![Apart::default(); count];
        for ((a, b), p) in pairs().zip(corrected(&p)) {
            if p < LEVEL {
                found[a].less += 1;
                found[b].greater += 1;
            }
        }
        found
    }

    /// What differs by more than `reach` standard errors.
    fn by_bonferroni(&self, reach: f64) -> Vec<Apart> {
        let count = self.order.len();
        let errors = self.estimates.iter().map(|it| it.standard_error);
        let largest = errors.fold(0.0, f64::max);
        let row = |a: usize| {
            let one = self.estimates[a];
            // No error of a difference is larger than the sum of both, so what is far enough below is surely less.
            let far = reach * (one.standard_error + largest);
            let near = &self.estimates[a + 1..];
            let end = a + 1 + near.partition_point(|it| one.mean - it.mean <= far);
            let apart = |&b: &usize| {
                let difference = self.difference(a, b);
                difference.mean > reach * difference.standard_error
            };
            ((a + 1..end).filter(apart).collect::<Vec<_>>(), end)
        };
        let rows: Vec<(Vec<usize>, usize)> = (0..count).into_par_iter().map(row).collect();
        let mut found = vec![Apart::default(); count];
        for (a, (near, end)) in rows.into_iter().enumerate() {
            found[a].less = near.len() + count - end;
            near.into_iter()
                .chain(end..count)
                .for_each(|b| found[b].greater += 1);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corrected_probabilities_are_those_of_the_procedure() {
        // 0.01 · 4, 0.02 · 3, then 0.03 · 2 = 0.06 and 0.04 · 1, raised to 0.06.
        let corrected = corrected(&[0.04, 0.01, 0.03, 0.02]);
        for (got, expected) in corrected.iter().zip([0.06, 0.04, 0.06, 0.06]) {
            assert!((got - expected).abs() < 1e-15, "{corrected:?}");
        }
    }

    #[test]
    fn a_difference_of_nothing_is_none_and_one_without_error_is_one() {
        let estimate = |mean, standard_error| Estimate {
            mean,
            standard_error,
        };
        let told = differences(
            &[estimate(0.0, 0.0), estimate(1e-9, 0.0), estimate(1.0, 0.5)],
            63,
        );
        let differ: Vec<bool> = told.iter().map(Difference::is_one).collect();
        // t = 2 has p = 0.0498, which two comparisons do not bear.
        assert_eq!(differ, [false, true, false]);
        assert!(told[2].p < LEVEL && told[2].interval[0] < 0.0);
    }

    #[test]
    fn what_cannot_be_told_apart_shares_its_places() {
        let one = [3.0, 3.1, 2.9, 3.0, 3.05, 2.95];
        let like = [3.1, 2.9, 3.0, 3.05, 2.95, 3.01];
        let less = one.map(|value| value - 1.0);
        let ranks = ranking(&[&less, &one, &like], 5);
        let places: Vec<_> = ranks.iter().map(|rank| (rank.index, rank.places)).collect();
        assert_eq!(places, [(2, [1, 2]), (1, [1, 2]), (0, [3, 3])]);
    }

    #[test]
    fn what_lies_far_apart_is_told_apart_unasked() {
        // Means a step apart, with errors that grow, in common to all but for a part of each.
        let common = |replica: usize| ((replica * 37) % 64) as f64 - 31.5;
        let own = |index: usize, replica: usize| ((replica * (2 * index + 1)) % 64) as f64 - 31.5;
        let values: Vec<Vec<f64>> = (0..200)
            .map(|index| {
                let value = |replica| {
                    let size = 1.0 + 0.1 * index as f64;
                    2.0 * index as f64 + 0.3 * size * (common(replica) + 0.1 * own(index, replica))
                };
                (0..64).map(value).collect()
            })
            .collect();
        let slices: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
        let sorted = Sorted::new(&slices);
        let reach = 4.0;
        let mut less = 0;
        for (a, found) in sorted.by_bonferroni(reach).iter().enumerate() {
            let apart = |b: &usize| {
                let (one, other) = (&values[sorted.order[a]], &values[sorted.order[*b]]);
                let differences: Vec<f64> = one.iter().zip(other).map(|(a, b)| a - b).collect();
                let estimate = Estimate::of(&differences);
                estimate.mean.abs() > reach * estimate.standard_error
            };
            assert_eq!(found.greater, (0..a).filter(apart).count(), "place {a}");
            assert_eq!(found.less, (a + 1..200).filter(apart).count(), "place {a}");
            less += found.less;
        }
        assert!((1_000..19_900).contains(&less), "{less}");
    }
}
