//! What errors are measured against.

use malus_estimator::{Reading, Results};
use malus_scene::Estimator;

/// Share of the smallest error shown that the reference's own standard error may be.
pub const SHARE: f64 = 0.2;

/// The best values that are known at the free sensor points.
#[derive(Debug)]
pub struct Reference {
    /// S0 at each free point.
    pub values: Vec<f64>,
    /// What an error is a share of there: max(S0, 10⁻³ · mean S0).
    pub scales: Vec<f64>,
    /// Standard error at each, as such a share.
    pub errors: Vec<f64>,
    /// How it was made.
    pub estimator: Estimator,
    /// Walks at each sensor.
    pub samples: u64,
    /// Time it took.
    pub seconds: f64,
}

impl Reference {
    /// A run as a reference; `None` where every sensor is dark, so that no error is a share of anything.
    pub fn of(results: &Results, seconds: f64) -> Option<Self> {
        let free = free(results);
        let values: Vec<f64> = free.iter().map(|reading| reading.stokes[0]).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let scales: Vec<f64> = values.iter().map(|s0| s0.max(1e-3 * mean)).collect();
        let errors = free
            .iter()
            .zip(&scales)
            .map(|(reading, scale)| reading.standard_error[0] / scale)
            .collect();
        (mean > 0.0).then_some(Self {
            values,
            scales,
            errors,
            estimator: results.estimator,
            samples: results.samples,
            seconds,
        })
    }

    /// Its standard error: root of the mean square over the points.
    pub fn standard_error(&self) -> f64 {
        let squares: f64 = self.errors.iter().map(|error| error * error).sum();
        (squares / self.errors.len() as f64).sqrt()
    }

    /// The smallest error that it can tell.
    pub fn limit(&self) -> f64 {
        self.standard_error() / SHARE
    }
}

/// The readings of a run's free points.
pub fn free(results: &Results) -> Vec<&Reading> {
    results
        .groups
        .iter()
        .flat_map(|group| &group.readings)
        .filter(|reading| !reading.enclosed)
        .collect()
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A reference with such values, all of the same relative standard error.
    pub fn reference(values: &[f64], error: f64) -> Reference {
        Reference {
            values: values.to_vec(),
            scales: values.to_vec(),
            errors: vec![error; values.len()],
            estimator: Estimator::Gather,
            samples: 64,
            seconds: 1.0,
        }
    }

    #[test]
    fn errors_down_to_five_of_its_own_can_be_told() {
        let reference = reference(&[2.0, 4.0], 1e-3);
        assert!((reference.standard_error() - 1e-3).abs() < 1e-18);
        assert!((reference.limit() - 5e-3).abs() < 1e-17);
    }
}
