//! Where a run stands, on stderr: a bar on a terminal, plain lines elsewhere.

use crate::number::{duration, significant};
use crate::stop::{Forecast, share_done};
use indicatif::{ProgressBar, ProgressStyle};
use malus_estimator::Progress;
use std::io::IsTerminal;
use std::time::Duration;

/// Seconds between two plain lines.
const PLAIN_LINES_S: f64 = 5.0;

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Reports where a run stands.
pub struct Reporter {
    form: Form,
    forecast: Forecast,
    /// Time limit in seconds, where given.
    limit: Option<f64>,
}

enum Form {
    Silent,
    Lines { last: f64 },
    Bar(ProgressBar),
}

impl Reporter {
    /// A reporter that fits what stderr is; silent if `quiet`.
    pub fn new(quiet: bool, limit: Option<f64>) -> Self {
        let form = if quiet {
            Form::Silent
        } else if std::io::stderr().is_terminal() {
            Form::Bar(bar())
        } else {
            Form::Lines { last: 0.0 }
        };
        Self {
            form,
            forecast: Forecast::default(),
            limit,
        }
    }

    /// Shows which share of a picture is done after `elapsed` seconds.
    pub fn show_share(&mut self, name: &str, share: f64, elapsed: f64) {
        self.tell(share, elapsed, || format!("{name}: {:.0} %", 100.0 * share));
    }

    /// Shows what is going on within a job that takes `limit` seconds in all, after `elapsed` of them; the time first, as a
    /// narrow terminal cuts off the end.
    pub fn show_stage(&mut self, stage: &str, elapsed: f64) {
        let left = self.limit.map_or(0.0, |limit| (limit - elapsed).max(0.0));
        self.tell(share_done(elapsed, Some(left)), elapsed, || {
            format!("at most {} left, {stage}", duration(left))
        });
    }

    /// Shows where the run stands after `elapsed` seconds.
    pub fn show(&mut self, progress: &Progress, elapsed: f64) {
        let left = self.forecast.seconds_left(progress, elapsed, self.limit);
        let share = share_done(elapsed, left);
        self.tell(share, elapsed, || state(progress, left));
    }

    /// Moves the bar to a share of the job, or prints a line where it is time for one.
    fn tell(&mut self, share: f64, elapsed: f64, message: impl FnOnce() -> String) {
        match &mut self.form {
            Form::Silent => {}
            Form::Bar(bar) => {
                bar.set_position((share * STEPS as f64) as u64);
                bar.set_message(message());
            }
            Form::Lines { last } => {
                if elapsed >= *last + PLAIN_LINES_S {
                    *last = elapsed;
                    eprintln!("{} so far: {}", duration(elapsed), message());
                }
            }
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Form::Bar(bar) = &self.form {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(STEPS);
    if let Ok(style) =
        ProgressStyle::with_template("{elapsed:>4} [{bar:20}] {percent:>3} %  {wide_msg}")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    // The clock goes on while a long step is computed.
    bar.enable_steady_tick(Duration::from_millis(250));
    bar
}

/// Where the run stands, in words; the most wanted first, as a narrow terminal cuts off the rest.
///
/// The error is the largest relative standard error.
fn state(progress: &Progress, left: Option<f64>) -> String {
    let percent = |share: f64| format!("{} %", significant(100.0 * share, 2));
    let mut parts = Vec::new();
    if let Some(error) = progress.relative_error {
        let goal = progress
            .relative_error_goal
            .map_or(String::new(), |goal| format!(" (goal {})", percent(goal)));
        parts.push(format!("error {}{goal}", percent(error)));
    }
    if let Some(left) = left {
        parts.push(format!("about {} left", duration(left)));
    }
    parts.push(match progress.samples_limit {
        Some(limit) => format!("{} of {limit} samples", progress.samples),
        None => format!("{} samples", progress.samples),
    });
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_state_tells_error_goal_samples_and_time() {
        let progress = Progress {
            samples: 65536,
            next_checkpoint: 131_072,
            samples_limit: None,
            checkpoint: true,
            relative_error: Some(0.018),
            relative_error_goal: Some(0.01),
        };
        assert_eq!(
            state(&progress, Some(11.2)),
            "error 1.8 % (goal 1.0 %), about 12 s left, 65536 samples"
        );
    }

    #[test]
    fn what_is_not_known_is_not_told() {
        let progress = Progress {
            samples: 64,
            next_checkpoint: 128,
            samples_limit: Some(1024),
            checkpoint: false,
            relative_error: None,
            relative_error_goal: None,
        };
        assert_eq!(state(&progress, None), "64 of 1024 samples");
    }
}
