//! Sets a run aside from time to time, so that what ends the program takes little with it.

use anyhow::{Error, Result};
use std::time::{Duration, Instant};

/// Seconds between two checkpoints where nothing else is asked for: shorter runs have none.
const EVERY_S: u64 = 60;

/// Longest time between two checkpoints that is told from never, in seconds.
const LONGEST_S: f64 = 1e9;

/// How often a run is set aside: `None` for never.
pub type Interval = Option<Duration>;

/// The interval that `--checkpoint` asks for.
///
/// # Errors
/// It is no number of seconds.
pub fn interval(text: Option<&str>) -> Result<Interval> {
    let Some(text) = text else {
        return Ok(Some(Duration::from_secs(EVERY_S)));
    };
    let seconds = text.parse::<f64>().ok();
    let seconds = seconds.filter(|seconds| (0.0..=LONGEST_S).contains(seconds));
    let seconds = seconds.ok_or_else(|| {
        anyhow::anyhow!(
            "--checkpoint {text}: must be a number of seconds from 0 (never) to {LONGEST_S:e}, found {text:?}"
        )
    })?;
    Ok((seconds > 0.0).then(|| Duration::from_secs_f64(seconds)))
}

/// Keeps time between checkpoints.
pub struct Keeper {
    interval: Interval,
    last: Instant,
    failure: Option<Error>,
}

impl Keeper {
    /// One that begins to count now.
    pub fn new(interval: Interval) -> Self {
        Self {
            interval,
            last: Instant::now(),
            failure: None,
        }
    }

    /// Lets `write` set the run aside if it is time; whether the run is to go on: not when that failed.
    pub fn keep(&mut self, write: impl FnOnce() -> Result<()>) -> bool {
        let due = self
            .interval
            .is_some_and(|interval| self.last.elapsed() >= interval);
        if due && self.failure.is_none() {
            self.failure = write().err();
            self.last = Instant::now();
        }
        self.failure.is_none()
    }

    /// Whether the run is ever set aside.
    pub fn keeps(&self) -> bool {
        self.interval.is_some()
    }

    /// Makes sure that the last checkpoint did not fail.
    ///
    /// # Errors
    /// It did.
    pub fn check(&mut self) -> Result<()> {
        match self.failure.take() {
            Some(failure) => Err(failure.context(
                "a checkpoint failed, so the run was ended; what was set aside before, if anything, is still there, and --resume goes on with it",
            )),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_lies_between_checkpoints_unless_asked_otherwise() {
        assert_eq!(interval(None).ok(), Some(Some(Duration::from_secs(60))));
        assert_eq!(
            interval(Some("0.25")).ok(),
            Some(Some(Duration::from_millis(250)))
        );
        assert_eq!(interval(Some("0")).ok(), Some(None));
        for text in ["", "-1", "nan", "inf", "1e30", "soon"] {
            let error = interval(Some(text)).expect_err("no interval").to_string();
            assert!(error.starts_with(&format!("--checkpoint {text}: must be")));
        }
    }

    #[test]
    fn a_run_is_set_aside_when_it_is_time_and_ends_when_that_fails() {
        let never = || -> Result<()> { unreachable!("not yet") };
        assert!(Keeper::new(None).keep(never));
        assert!(Keeper::new(Some(Duration::from_secs(3600))).keep(never));
        let mut keeper = Keeper::new(Some(Duration::ZERO));
        let mut written = 0;
        for _ in 0..3 {
            assert!(keeper.keep(|| {
                written += 1;
                Ok(())
            }));
        }
        assert_eq!(written, 3);
        assert!(keeper.check().is_ok());
        assert!(!keeper.keep(|| anyhow::bail!("no space")));
        assert!(!keeper.keep(never));
        let error = keeper.check().expect_err("no space");
        assert!(format!("{error:#}").ends_with("--resume goes on with it: no space"));
    }
}
