//! Repeated runs of one setting with one number of samples, and what they say of its error.

use crate::tradeoff::reference::{Reference, free};
use malus_estimator::Results;

/// From so many runs on, what they have in common can be told from chance.
const ENOUGH: usize = 5;

/// Ratio of the squares of a mean deviation and of its standard error beyond which it is no chance: 3.5², as the
/// deviations of all sensors may be one, and the error is of a few runs.
const NO_CHANCE: f64 = 12.0;

/// Runs by one setting with one number of samples, by different seeds.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Samples of each.
    pub samples: u64,
    seconds: Vec<f64>,
    /// S0 of the first run at each free point; the others as deviations from it, so that no digits are lost.
    first: Vec<f64>,
    deviations: Vec<f64>,
    squares: Vec<f64>,
    /// Sums of the standard errors that the runs state.
    stated: Vec<f64>,
}

/// What the runs of a trial say together. Errors are relative: shares of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Samples of each run.
    pub samples: u64,
    /// Number of runs.
    pub runs: usize,
    /// Median time of a run.
    pub seconds: f64,
    /// Root mean square over runs and points of the deviation from the reference.
    pub rms_error: f64,
    /// The greatest root mean square over runs at any one point.
    pub max_error: f64,
    /// Mean over runs and points of the standard error that the runs state.
    pub se_mean: f64,
    /// The part of `rms_error` that all runs have in common and more samples will not take away, where there is one.
    pub bias: Option<f64>,
}

impl Trial {
    /// No runs yet.
    pub fn new(samples: u64) -> Self {
        Self {
            samples,
            seconds: Vec::new(),
            first: Vec::new(),
            deviations: Vec::new(),
            squares: Vec::new(),
            stated: Vec::new(),
        }
    }

    /// Adds a run that took so many seconds.
    pub fn add(&mut self, results: &Results, seconds: f64) {
        let readings = free(results);
        if self.seconds.is_empty() {
            self.first = readings.iter().map(|it| it.stokes[0]).collect();
            self.deviations = vec![0.0; readings.len()];
            self.squares = vec![0.0; readings.len()];
            self.stated = vec![0.0; readings.len()];
        }
        self.seconds.push(seconds);
        for (index, reading) in readings.iter().enumerate() {
            let deviation = reading.stokes[0] - self.first[index];
            self.deviations[index] += deviation;
            self.squares[index] += deviation * deviation;
            self.stated[index] += reading.standard_error[0];
        }
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.seconds.len()
    }

    /// Median time of a run, 0 where there is none.
    pub fn median_seconds(&self) -> f64 {
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => 0.0,
            count if count % 2 == 1 => sorted[count / 2],
            count => 0.5 * (sorted[count / 2 - 1] + sorted[count / 2]),
        }
    }

    /// Mean standard error that the runs state, as a share of the reference.
    pub fn stated(&self, reference: &Reference) -> f64 {
        let sum: f64 = self
            .stated
            .iter()
            .zip(&reference.scales)
            .map(|(stated, scale)| stated / scale)
            .sum();
        sum / (self.runs() * self.stated.len()) as f64
    }

    /// What the runs say together; `None` where there is none.
    pub fn outcome(&self, reference: &Reference) -> Option<Outcome> {
        let runs = self.runs();
        if runs == 0 {
            return None;
        }
        let count = runs as f64;
        let points = self.first.len() as f64;
        let (mut squares, mut greatest) = (0.0, 0.0_f64);
        let (mut common, mut chance) = (0.0, 0.0);
        for index in 0..self.first.len() {
            let scale = reference.scales[index] * reference.scales[index];
            let mean = self.deviations[index] / count;
            let bias = self.first[index] + mean - reference.values[index];
            let spread = (self.squares[index] - count * mean * mean).max(0.0);
            let square = (bias * bias + spread / count) / scale;
            squares += square;
            greatest = greatest.max(square);
            common += bias * bias / scale;
            chance += spread / (count * (count - 1.0).max(1.0)) / scale
                + reference.errors[index] * reference.errors[index];
        }
        let told = runs >= ENOUGH && common > NO_CHANCE * chance && common - chance > 0.5 * squares;
        Some(Outcome {
            samples: self.samples,
            runs,
            seconds: self.median_seconds(),
            rms_error: (squares / points).sqrt(),
            max_error: greatest.sqrt(),
            se_mean: self.stated(reference),
            bias: told.then(|| ((common - chance) / points).sqrt()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tradeoff::reference::tests::reference;

    /// A trial at two points with the given values of S0 and a stated error of a hundredth of them.
    fn trial(runs: &[[f64; 2]]) -> Trial {
        let mut trial = Trial::new(64);
        for (index, run) in runs.iter().enumerate() {
            if index == 0 {
                trial.first = run.to_vec();
                (trial.deviations, trial.squares) = (vec![0.0; 2], vec![0.0; 2]);
                trial.stated = vec![0.0; 2];
            }
            trial.seconds.push(index as f64);
            for (point, value) in run.iter().enumerate() {
                let deviation = value - trial.first[point];
                trial.deviations[point] += deviation;
                trial.squares[point] += deviation * deviation;
                trial.stated[point] += 0.01 * value;
            }
        }
        trial
    }

    #[test]
    fn errors_are_root_mean_squares_against_the_reference() {
        let runs = [[1.1, 2.0], [0.9, 2.4], [1.0, 2.0]];
        let outcome = trial(&runs).outcome(&reference(&[1.0, 2.0], 0.0)).unwrap();
        // Relative deviations: ±0.1 and 0 at one point, 0.2 and twice 0 at the other.
        assert!((outcome.rms_error - (0.06_f64 / 6.0).sqrt()).abs() < 1e-12);
        assert!((outcome.max_error - (0.04_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((outcome.se_mean - 0.01 * (3.0 + 3.2) / 6.0).abs() < 1e-12);
        assert!((outcome.seconds - 1.0).abs() < 1e-15);
        assert_eq!(outcome.bias, None);
    }

    #[test]
    fn what_all_runs_have_in_common_is_bias_and_what_they_have_not_is_chance() {
        let scattered = [0.97, 1.02, 1.01, 0.98, 1.03, 0.99].map(|s0| [s0, 2.0 * s0]);
        let reference = reference(&[1.0, 2.0], 1e-4);
        assert_eq!(trial(&scattered).outcome(&reference).unwrap().bias, None);
        let low = scattered.map(|run| run.map(|s0| 0.9 * s0));
        let bias = trial(&low).outcome(&reference).unwrap().bias.unwrap();
        assert!((bias - 0.1).abs() < 0.002, "{bias}");
    }

    #[test]
    fn a_trial_without_runs_says_nothing() {
        assert_eq!(Trial::new(64).outcome(&reference(&[1.0], 0.0)), None);
    }
}
