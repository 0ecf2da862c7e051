//! The computing of a study's batches: the clock, the user and the checkpoints beside the estimator.

use super::batch::Batch;
use crate::interrupt::Interrupt;
use crate::journal::Journal;
use crate::keeper::Keeper;
use crate::output::Directory;
use crate::part::{self, Part};
use crate::progress::Reporter;
use crate::report::warn;
use crate::stop::{self, Forecast};
use anyhow::{Context, Result};
use malus_estimator::{Answer, Progress, Sharing, State, Together, resume_together};
use malus_scene::{Scene, Settings};
use std::time::Instant;

/// A study, or a shard of one, that is computed.
pub struct Job<'a> {
    /// The base.
    pub base: &'a Scene,
    /// How it is computed.
    pub settings: &'a Settings,
    /// Number of variants.
    pub variants: usize,
    /// How the base's walks are shared out between emitters and sensors.
    pub sharing: Sharing<'static>,
    /// Those that are computed, or failed.
    pub done: usize,
    /// Where it is set aside.
    pub directory: &'a Directory,
    /// In which file.
    pub name: &'a str,
    /// As far as it has come.
    pub part: Part,
    /// When it is set aside.
    pub keeper: Keeper,
    /// Whether the user asks for an end.
    pub interrupt: Interrupt,
    /// Shows how far it is.
    pub reporter: Reporter,
    /// When this computing began.
    pub started: Instant,
    /// Seconds that it took before.
    pub before: f64,
}

impl Job<'_> {
    /// Takes the sums of a batch to their end, or as far as the user lets them; the base's by its own stopping rule, and
    /// all others to as many samples.
    ///
    /// # Errors
    /// The sums do not fit the batch, or a checkpoint cannot be written.
    pub fn compute(&mut self, batch: &Batch, journal: &mut Journal) -> Result<Together> {
        let Part {
            head,
            state,
            allocation,
            ..
        } = &mut self.part;
        let allocation = allocation.as_ref();
        let stops = match head.study.as_ref().and_then(|study| study.samples) {
            Some(samples) => &Settings {
                samples: Some(samples),
                relative_error: None,
                seconds: None,
                ..self.settings.clone()
            },
            None => self.settings,
        };
        let settings = batch.settings(self.base, stops);
        let (done, count) = (self.done as f64, batch.variants.len() as f64);
        let (begun, mut forecast) = (Instant::now(), Forecast::default());
        let mut watch = |progress: &Progress, state: &State| {
            let elapsed = begun.elapsed().as_secs_f64();
            let left = forecast.seconds_left(progress, elapsed, settings.seconds);
            let within = stop::share_done(elapsed, left);
            let share = (done + within * count) / self.variants as f64;
            head.samples = progress.samples;
            head.seconds = self.before + self.started.elapsed().as_secs_f64();
            self.reporter.show_share("variants", share, head.seconds);
            let kept = self.keeper.keep(|| {
                if let Some(study) = &mut head.study {
                    study.share = share;
                    study.finished = journal.sync()?;
                }
                let films = std::iter::empty();
                part::write(self.directory, self.name, head, state, films, allocation)
            });
            if !kept || self.interrupt.asked() {
                Answer::Interrupt
            } else {
                stop::answer(progress, head.seconds, settings.seconds)
            }
        };
        let scenes = batch.scenes(self.base);
        let sharing = allocation.map_or(self.sharing, Sharing::Like);
        let together = resume_together(&scenes, &settings, sharing, state, &mut watch);
        self.keeper.check()?;
        let told = || format!("{}", self.directory.path().join(self.name).display());
        let together = together.with_context(told)?;
        if batch.with_base && self.part.allocation.is_none() {
            warn(&together.first.warnings);
        }
        Ok(together)
    }

    /// Puts the record of a batch that is finished into the journal, and goes on to the next; gives its place.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(
        &mut self,
        batch: &Batch,
        together: &Together,
        record: &[u8],
        journal: &mut Journal,
    ) -> Result<u64> {
        let place = journal.append(record)?;
        self.pass(batch.variants.len());
        let Part {
            head,
            state,
            allocation,
            ..
        } = &mut self.part;
        *state = State::new(head.shard);
        head.samples = 0;
        head.seconds = self.before + self.started.elapsed().as_secs_f64();
        if let Some(study) = &mut head.study
            && study.samples.is_none()
        {
            study.samples = Some(together.first.samples);
            *allocation = Some(together.first.allocation.clone());
        }
        let Self {
            part,
            keeper,
            directory,
            name,
            ..
        } = self;
        keeper.keep(|| set_aside(part, directory, name, journal));
        self.keeper.check()?;
        Ok(place)
    }

    /// Counts variants that are done with.
    pub fn pass(&mut self, variants: usize) {
        self.done += variants;
        if let Some(study) = &mut self.part.head.study {
            study.share = self.done as f64 / self.variants as f64;
        }
    }

    /// Sets the study aside, whatever the time.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn set_aside(&mut self, journal: &mut Journal) -> Result<()> {
        set_aside(&mut self.part, self.directory, self.name, journal)
    }
}

/// Writes a part of a study, and makes sure that its journal is on the disk before.
fn set_aside(
    part: &mut Part,
    directory: &Directory,
    name: &str,
    journal: &mut Journal,
) -> Result<()> {
    if let Some(study) = &mut part.head.study {
        study.finished = journal.sync()?;
    }
    let (films, allocation) = (std::iter::empty(), part.allocation.as_ref());
    part::write(directory, name, &part.head, &part.state, films, allocation)
}
