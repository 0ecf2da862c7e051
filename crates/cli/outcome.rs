//! What one variant of a study gave, as much of it as comparing it with others takes.

use crate::digest::Digest;
use malus_estimator::{Estimate, Group, Replicates};
use serde::{Deserialize, Serialize};

/// One variant.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its number, or `base`.
    pub name: String,
    /// The value of each key of the study, as text; `None` where nothing tells.
    pub values: Vec<Option<String>>,
}

impl Outcome {
    /// The value of a key, or else what the base has; empty where nothing tells.
    pub fn value<'a>(&'a self, key: usize, base: &'a Self) -> &'a str {
        let value = |outcome: &'a Self| outcome.values[key].as_deref();
        value(self).or(value(base)).unwrap_or_default()
    }
}

/// What one sensor group measured, in the unit of its readings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Mean of S0.
    pub mean: f64,
    /// Its standard error.
    pub mean_standard_error: f64,
    /// Least S0.
    pub min: f64,
    /// Uniformity min/mean.
    pub u0: f64,
    /// Mean degree of linear polarisation.
    pub dolp_mean: f64,
    /// Whether it is more than one free point: one is as even as can be.
    several: bool,
    replicates: Replicates,
}

/// A quantity by which variants are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Mean of S0.
    Mean,
    /// Uniformity min/mean.
    Uniformity,
    /// Mean of S0 less that of the scalar model.
    Polarisation,
}

/// What each sensor group measured; `None` where all its points are inside a solid.
pub type Groups = Vec<Option<Measured>>;

/// What sensor groups measured.
pub fn measured(groups: &[Group]) -> Groups {
    groups.iter().map(Measured::of).collect()
}

impl Measured {
    /// The figures of a group.
    pub fn of(group: &Group) -> Option<Self> {
        let digest = Digest::of(group);
        let several = digest.count > digest.enclosed + 1;
        let free = digest.free?;
        Some(Self {
            several,
            mean: free.mean,
            mean_standard_error: free.mean_standard_error,
            min: free.min,
            u0: free.u0,
            dolp_mean: free.dolp_mean,
            replicates: group.replicates.clone(),
        })
    }

    /// A quantity in every replica; `None` where it was not computed. What is not linear in the readings is expanded
    /// about the whole run's.
    pub fn replicas(&self, quantity: Quantity) -> Option<Vec<f64>> {
        let Replicates { mean, min, scalar } = &self.replicates;
        match quantity {
            Quantity::Mean => Some(mean.clone()),
            Quantity::Uniformity if self.several && self.mean > 0.0 => {
                let expanded =
                    |(min, mean): (&f64, &f64)| self.u0 + (min - self.u0 * mean) / self.mean;
                Some(min.iter().zip(mean).map(expanded).collect())
            }
            Quantity::Uniformity => None,
            Quantity::Polarisation => (!scalar.is_empty()).then(|| {
                mean.iter()
                    .zip(scalar)
                    .map(|(mean, scalar)| mean - scalar)
                    .collect()
            }),
        }
    }

    /// A quantity less the same of another run with the same random numbers, with the paired standard error.
    pub fn less(&self, other: &Self, quantity: Quantity) -> Option<Estimate> {
        let (own, other) = (self.replicas(quantity)?, other.replicas(quantity)?);
        let differences: Vec<f64> = own.iter().zip(&other).map(|(a, b)| a - b).collect();
        Some(Estimate::of(&differences))
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// What a group of two points gives whose mean and least are these in each replica.
    pub fn measured(mean: &[f64], min: &[f64]) -> Measured {
        let [of_mean, of_min] = [mean, min].map(Estimate::of);
        Measured {
            mean: of_mean.mean,
            mean_standard_error: of_mean.standard_error,
            min: of_min.mean,
            u0: of_min.mean / of_mean.mean,
            dolp_mean: 0.0,
            several: true,
            replicates: Replicates {
                mean: mean.to_vec(),
                min: min.to_vec(),
                scalar: Vec::new(),
            },
        }
    }

    #[test]
    fn what_two_runs_share_cancels_in_their_difference() {
        let one = measured(&[10.0, 12.0, 11.0], &[5.0, 6.0, 5.5]);
        let other = measured(&[9.0, 11.0, 10.0], &[5.0, 6.0, 5.5]);
        let difference = one.less(&other, Quantity::Mean).expect("computed");
        assert_eq!((difference.mean, difference.standard_error), (1.0, 0.0));
        assert!(one.less(&other, Quantity::Polarisation).is_none());
    }

    #[test]
    fn a_uniformity_that_every_replica_has_is_free_of_error() {
        let one = measured(&[10.0, 12.0, 11.0], &[5.0, 6.0, 5.5]);
        let uniformity = Estimate::of(&one.replicas(Quantity::Uniformity).expect("computed"));
        assert!((uniformity.mean - 0.5).abs() < 1e-15 && uniformity.standard_error < 1e-15);
        let other = measured(&[10.0, 12.0, 11.0], &[5.0, 5.0, 5.0]);
        let uniformity = Estimate::of(&other.replicas(Quantity::Uniformity).expect("computed"));
        // u0 = 5/11 and its slope against the mean −5/121, of errors 1/√3.
        assert!((uniformity.mean - 5.0 / 11.0).abs() < 1e-15);
        assert!((uniformity.standard_error - 5.0 / 121.0 / 3f64.sqrt()).abs() < 1e-15);
    }
}
