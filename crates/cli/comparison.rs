//! Which variants differ, and in which order they stand: paired differences, corrected for their number.

use crate::student::{half_width, two_sided};
use malus_estimator::Estimate;

/// Chance that any of a family of comparisons finds a difference where there is none.
pub const LEVEL: f64 = 0.05;

/// Pairs that are corrected by Holm's procedure; more of them by Bonferroni's, which keeps nothing in memory.
const MOST_PAIRS: usize = 2_000_000;

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
    let count = values.len();
    let means: Vec<f64> = values.iter().map(|it| Estimate::of(it).mean).collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| means[b].total_cmp(&means[a]));
    let pairs = || (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    let difference = |(a, b): (usize, usize)| {
        let of_replicas = values[order[a]].iter().zip(values[order[b]]);
        Estimate::of(&of_replicas.map(|(a, b)| a - b).collect::<Vec<_>>())
    };
    let number = count * count.saturating_sub(1) / 2;
    let mut places: Vec<[usize; 2]> = vec![[1, count]; count];
    let mut told_apart = |(a, b): (usize, usize)| {
        places[a][1] -= 1;
        places[b][0] += 1;
    };
    if number <= MOST_PAIRS {
        let p: Vec<f64> = pairs()
            .map(|pair| probability(&difference(pair), dof))
            .collect();
        let corrected = corrected(&p);
        pairs()
            .zip(corrected)
            .filter(|(_, p)| *p < LEVEL)
            .for_each(|(pair, _)| told_apart(pair));
    } else {
        let reach = half_width(1.0 - LEVEL / number as f64, dof);
        let apart = |pair: &(usize, usize)| {
            let estimate = difference(*pair);
            estimate.mean.abs() > reach * estimate.standard_error
        };
        pairs().filter(apart).for_each(told_apart);
    }
    let rank = |(index, places)| Rank { index, places };
    order.into_iter().zip(places).map(rank).collect()
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
}
