//! When a run ends: which rules hold, and how long it will take.

use crate::portion::rounded_up;
use malus_estimator::{Answer, Progress};
use malus_scene::{Override, Settings};

/// Keeps only the stopping rules given on the command line, if any is: they replace those of the scene file.
pub fn narrow(settings: &mut Settings, given: &[Override]) {
    let is_given = |key: &str| given.iter().any(|entry| entry.key.trim() == key);
    let [samples, relative_error, seconds] =
        ["run.samples", "run.relative_error", "run.seconds"].map(is_given);
    if samples || relative_error || seconds {
        settings.samples = settings.samples.filter(|_| samples);
        settings.relative_error = settings.relative_error.filter(|_| relative_error);
        settings.seconds = settings.seconds.filter(|_| seconds);
    }
}

/// The rules in words; samples in whole rounds, as they are taken, so that numbers which ask for the same read the same.
pub fn words(settings: &Settings) -> String {
    let samples = settings.samples.map(rounded_up);
    let rules = [
        samples.map(|it| format!("samples = {it}")),
        settings
            .relative_error
            .map(|it| format!("relative_error = {it}")),
        settings.seconds.map(|it| format!("seconds = {it}")),
    ];
    let rules: Vec<String> = rules.into_iter().flatten().collect();
    rules.join(" and ")
}

/// Whether to go on after `elapsed` seconds: not past a checkpoint whose successor would come later than `limit`
/// seconds, at the pace so far.
pub fn answer(progress: &Progress, elapsed: f64, limit: Option<f64>) -> Answer {
    let Some(limit) = limit.filter(|_| progress.checkpoint) else {
        return Answer::Continue;
    };
    let pace = elapsed / progress.samples.max(1) as f64;
    if elapsed >= limit || pace * progress.next_checkpoint as f64 > limit {
        Answer::Enough
    } else {
        Answer::Continue
    }
}

/// Foretells the end of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Forecast {
    /// Samples and relative error at the last checkpoint.
    checkpoint: Option<(u64, f64)>,
}

impl Forecast {
    /// Seconds from now until the first of the stopping rules is met; `None` while nothing tells.
    ///
    /// The standard error falls as samples^−½, so the error aimed at takes samples · (error/goal)². Checkpoints are
    /// not counted in: the run may go on to the next one.
    pub fn seconds_left(
        &mut self,
        progress: &Progress,
        elapsed: f64,
        limit: Option<f64>,
    ) -> Option<f64> {
        if progress.checkpoint
            && let Some(error) = progress.relative_error
        {
            self.checkpoint = Some((progress.samples, error));
        }
        let by_error = self
            .checkpoint
            .zip(progress.relative_error_goal)
            .map(|((samples, error), goal)| samples as f64 * (error / goal) * (error / goal));
        let by_samples = progress.samples_limit.map(|samples| samples as f64);
        let pace = elapsed / progress.samples.max(1) as f64;
        let left = |samples: f64| (samples * pace - elapsed).max(0.0);
        [
            by_error.map(left),
            by_samples.map(left),
            limit.map(|limit| (limit - elapsed).max(0.0)),
        ]
        .into_iter()
        .flatten()
        .filter(|seconds| progress.samples > 0 && seconds.is_finite())
        .reduce(f64::min)
    }
}

/// Share of a job that is done after `elapsed` seconds, when so many are left; nothing while nobody knows.
pub fn share_done(elapsed: f64, left: Option<f64>) -> f64 {
    left.map_or(0.0, |left| elapsed / (elapsed + left).max(1e-9))
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use malus_scene::{Estimator, Model};

    fn progress(samples: u64, checkpoint: bool) -> Progress {
        Progress {
            samples,
            next_checkpoint: 2 * samples,
            samples_limit: None,
            checkpoint,
            relative_error: None,
            relative_error_goal: None,
        }
    }

    pub fn settings() -> Settings {
        Settings {
            model: Model::Polarised,
            compare_scalar: true,
            compare_diffuse: false,
            representation: None,
            estimator: Estimator::Auto,
            cell: None,
            samples: Some(1024),
            relative_error: Some(0.01),
            seconds: Some(60.0),
            seed: 1,
        }
    }

    fn given(key: &str) -> Vec<Override> {
        vec![Override {
            key: key.into(),
            value: "1".into(),
        }]
    }

    #[test]
    fn a_rule_of_the_command_line_replaces_those_of_the_file() {
        let mut kept = settings();
        narrow(&mut kept, &given("run.samples"));
        let stops = (kept.samples, kept.relative_error, kept.seconds);
        assert_eq!(stops, (Some(1024), None, None));
    }

    #[test]
    fn without_a_rule_on_the_command_line_those_of_the_file_hold() {
        let mut kept = settings();
        narrow(&mut kept, &given("run.seed"));
        assert_eq!(kept, settings());
    }

    #[test]
    fn time_ends_a_run_at_the_last_checkpoint_that_fits() {
        // 1000 samples took 4 s, so 2000 will take 8 s.
        assert_eq!(
            answer(&progress(1000, true), 4.0, Some(8.1)),
            Answer::Continue
        );
        assert_eq!(
            answer(&progress(1000, true), 4.0, Some(7.9)),
            Answer::Enough
        );
        assert_eq!(answer(&progress(1000, true), 4.0, None), Answer::Continue);
        assert_eq!(
            answer(&progress(1000, false), 9.0, Some(8.0)),
            Answer::Continue
        );
    }

    #[test]
    fn the_error_falls_with_the_square_root_of_the_samples() {
        let mut forecast = Forecast::default();
        let mut now = progress(1000, true);
        now.relative_error = Some(0.03);
        now.relative_error_goal = Some(0.01);
        // Nine times the samples are needed: 8 times the time is left.
        let left = forecast.seconds_left(&now, 2.0, None).expect("known");
        assert!((left - 16.0).abs() < 1e-9, "{left}");
        // Between checkpoints the last error counts, at the number of samples it was found at.
        let mut later = progress(2000, false);
        later.relative_error = Some(0.03);
        later.relative_error_goal = Some(0.01);
        let left = forecast.seconds_left(&later, 4.0, None).expect("known");
        assert!((left - 14.0).abs() < 1e-9, "{left}");
    }

    #[test]
    fn the_first_rule_to_be_met_counts() {
        let mut forecast = Forecast::default();
        let mut now = progress(1000, true);
        now.samples_limit = Some(5000);
        assert_eq!(forecast.seconds_left(&now, 2.0, None), Some(8.0));
        assert_eq!(forecast.seconds_left(&now, 2.0, Some(5.0)), Some(3.0));
        now.samples = 0;
        assert_eq!(forecast.seconds_left(&now, 2.0, Some(5.0)), None);
    }
}
