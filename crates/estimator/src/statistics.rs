//! Sums of replicas, and the means and standard errors read off them.
//!
//! A run is split into a fixed number of replicas with random numbers of their own. The spread between
//! their means is the only source of standard errors, so an error stays honest for whatever correlates
//! the walks inside a replica or the quantities that one walk feeds.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// Number of replicas of a run. The relative error of a standard error is 1/√(2·31) = 13 %.
///
/// The points of one replica are spread evenly, those of different ones are not: with fewer replicas the same walks err
/// less, and their error is known less well.
pub const REPLICAS: u32 = 32;

/// The sums of one replica.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Replica {
    /// Which replica.
    pub id: u32,
    /// Walks summed so far (at each sensor, for an estimator that starts at sensors).
    pub points: u64,
    /// One sum a channel a sensor: `sums[sensor · channels + channel]`.
    pub sums: Vec<f64>,
    /// Walks that ended at the bound on their length.
    pub truncated: u64,
}

impl Replica {
    fn new(id: u32, length: usize) -> Self {
        Self {
            id,
            points: 0,
            sums: vec![0.0; length],
            truncated: 0,
        }
    }
}

/// Why two tallies cannot be joined.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum MergeError {
    /// The same replica stands on both sides.
    #[error("replica {id} is present twice")]
    Doubled {
        /// The replica.
        id: u32,
    },
    /// The two sides measure different numbers of quantities.
    #[error("replica {id} holds {found} sums, the others {expected}")]
    Shape {
        /// The replica.
        id: u32,
        /// Sums that it holds.
        found: usize,
        /// Sums that the others hold.
        expected: usize,
    },
}

/// A set of replicas of one run. Joining two tallies is a union: no floating-point addition, so no order matters.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    replicas: BTreeMap<u32, Replica>,
}

/// A mean over replicas with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Standard error of the mean, from the spread between replicas.
    pub standard_error: f64,
}

impl Tally {
    /// Empty replicas with the given ids, each with `length` sums.
    #[must_use]
    pub fn new(ids: impl IntoIterator<Item = u32>, length: usize) -> Self {
        Self {
            replicas: ids
                .into_iter()
                .map(|id| (id, Replica::new(id, length)))
                .collect(),
        }
    }

    /// Union with the replicas of `other`.
    ///
    /// # Errors
    /// If a replica stands on both sides, or if the sides hold different numbers of sums.
    pub fn merge(mut self, other: Self) -> Result<Self, MergeError> {
        let expected = self.replicas.values().next().map(|r| r.sums.len());
        for (id, replica) in other.replicas {
            let found = replica.sums.len();
            if let Some(expected) = expected.filter(|&e| e != found) {
                return Err(MergeError::Shape {
                    id,
                    found,
                    expected,
                });
            }
            if self.replicas.insert(id, replica).is_some() {
                return Err(MergeError::Doubled { id });
            }
        }
        Ok(self)
    }

    /// The replicas in ascending order of their ids.
    pub fn replicas(&self) -> impl Iterator<Item = &Replica> {
        self.replicas.values()
    }

    /// The replicas in ascending order of their ids, to be added to.
    pub fn replicas_mut(&mut self) -> impl Iterator<Item = &mut Replica> {
        self.replicas.values_mut()
    }

    /// Walks that the first replica has summed; all others have as many unless they were joined from different parts.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.replicas
            .values()
            .next()
            .map_or(0, |first| first.points)
    }

    /// Gives `length` sums to each replica that has none yet.
    ///
    /// # Errors
    /// If a replica has another number of them.
    pub fn fit(&mut self, length: usize) -> Result<(), MergeError> {
        for replica in self.replicas.values_mut() {
            if replica.sums.is_empty() && replica.points == 0 {
                replica.sums = vec![0.0; length];
            } else if replica.sums.len() != length {
                return Err(MergeError::Shape {
                    id: replica.id,
                    found: replica.sums.len(),
                    expected: length,
                });
            }
        }
        Ok(())
    }

    /// A function of a replica's means in every replica, in ascending order of their ids.
    pub fn values(&self, value: impl Fn(&Means) -> f64) -> Vec<f64> {
        self.replicas
            .values()
            .map(|replica| value(&Means(replica)))
            .collect()
    }

    /// Estimate of any function of a replica's means that is linear in them; `value` is given the means.
    ///
    /// The standard error is that of [`Estimate::of`].
    pub fn estimate(&self, value: impl Fn(&Means) -> f64) -> Estimate {
        Estimate::of(&self.values(value))
    }
}

impl Estimate {
    /// The mean of what independent replicas gave, with the standard error √(Σ (vᵣ − v̄)² / (R (R − 1))), 0 for fewer than
    /// two replicas.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let standard_error = if values.len() < 2 {
            0.0
        } else {
            (squares / (count * (count - 1.0))).sqrt()
        };
        Self {
            mean,
            standard_error,
        }
    }
}

/// The means of one replica, as [`Tally::estimate`] hands them out.
#[derive(Debug)]
pub struct Means<'a>(&'a Replica);

impl Means<'_> {
    /// Mean of the sum at `index` over all walks.
    #[must_use]
    pub fn at(&self, index: usize) -> f64 {
        self.over(index, self.points())
    }

    /// Mean of the sum at `index` over so many walks.
    #[must_use]
    pub fn over(&self, index: usize, walks: u64) -> f64 {
        self.0.sums[index] / walks as f64
    }

    /// Walks summed.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.0.points
    }
}

/// Degree of linear polarisation √(s1² + s2²)/s0, 0 where s0 is 0, with the standard error of its linear expansion.
///
/// `fluctuation` estimates c0·s0 + c1·s1 + c2·s2 for the coefficients it is given.
/// Where s1 = s2 = 0 the expansion has no slope; the error is then √(se1² + se2²)/s0.
pub(crate) fn degree_of_linear_polarisation(
    stokes: [f64; 4],
    fluctuation: impl Fn([f64; 3]) -> Estimate,
) -> Estimate {
    let [s0, s1, s2, _] = stokes;
    let linear = (s1 * s1 + s2 * s2).sqrt();
    if s0 <= 0.0 {
        return Estimate {
            mean: 0.0,
            standard_error: 0.0,
        };
    }
    let degree = linear / s0;
    let standard_error = if linear > 0.0 {
        fluctuation([-degree / s0, s1 / (linear * s0), s2 / (linear * s0)]).standard_error
    } else {
        let se1 = fluctuation([0.0, 1.0 / s0, 0.0]).standard_error;
        let se2 = fluctuation([0.0, 0.0, 1.0 / s0]).standard_error;
        (se1 * se1 + se2 * se2).sqrt()
    };
    Estimate {
        mean: degree,
        standard_error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally(values: &[(u32, f64)]) -> Tally {
        let mut tally = Tally::new(values.iter().map(|v| v.0), 1);
        for (replica, (_, value)) in tally.replicas_mut().zip(values) {
            replica.points = 2;
            replica.sums[0] = 2.0 * value;
        }
        tally
    }

    #[test]
    fn error_is_the_spread_of_replica_means() {
        // Mean 2.5; squares 2.25 + 0.25 + 0.25 + 2.25 = 5; √(5/(4·3)).
        let estimate =
            tally(&[(0, 1.0), (1, 2.0), (2, 3.0), (3, 4.0)]).estimate(|means| means.at(0));
        assert!((estimate.mean - 2.5).abs() < 1e-15);
        assert!((estimate.standard_error - (5.0f64 / 12.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn joining_in_any_order_gives_the_same_tally() {
        let (a, b) = (tally(&[(0, 0.1), (5, 0.3)]), tally(&[(2, 0.2)]));
        assert_eq!(a.clone().merge(b.clone()), b.merge(a));
    }

    #[test]
    fn a_doubled_replica_is_refused_by_its_number() {
        let twice = tally(&[(3, 1.0)]).merge(tally(&[(3, 1.0)]));
        assert_eq!(twice, Err(MergeError::Doubled { id: 3 }));
    }

    #[test]
    fn replicas_of_another_shape_are_refused() {
        let other = Tally::new([9], 2);
        assert_eq!(
            tally(&[(3, 1.0)]).merge(other),
            Err(MergeError::Shape {
                id: 9,
                found: 2,
                expected: 1
            })
        );
    }

    #[test]
    fn degree_of_polarisation_of_nothing_is_zero() {
        let none = degree_of_linear_polarisation([0.0; 4], |_| unreachable!("no slope at zero"));
        assert!(none.mean == 0.0 && none.standard_error == 0.0);
    }
}
