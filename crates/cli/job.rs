//! The computing itself: the clock, the user and the checkpoints beside the estimator.

use crate::interrupt::Interrupt;
use crate::keeper::Keeper;
use crate::output::Directory;
use crate::part::{self, Part};
use crate::progress::Reporter;
use crate::stop;
use anyhow::{Context, Result};
use malus_estimator::{Answer, Film, Progress, Results, State};
use malus_scene::{Scene, Settings};
use std::time::Instant;

/// What is computed, and what goes on beside it.
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// How it is computed.
    pub settings: &'a Settings,
    /// Whether the user asks for an end.
    pub interrupt: &'a Interrupt,
    /// Where the run is set aside.
    pub directory: &'a Directory,
    /// In which file.
    pub name: &'a str,
    /// Whether no progress is shown.
    pub quiet: bool,
}

impl Job<'_> {
    /// Takes the sums of a part to their end, or as far as the user lets it.
    ///
    /// # Errors
    /// The part does not fit the scene, or a checkpoint cannot be written.
    pub fn compute(&self, part: &mut Part, keeper: &mut Keeper) -> Result<Results> {
        let Part {
            head, state, films, ..
        } = part;
        let (started, before) = (Instant::now(), head.seconds);
        let mut reporter = Reporter::new(self.quiet, self.settings.seconds);
        let mut watch = |progress: &Progress, state: &State| {
            head.samples = progress.samples;
            head.seconds = before + started.elapsed().as_secs_f64();
            reporter.show(progress, head.seconds);
            let kept = keeper
                .keep(|| part::write(self.directory, self.name, head, state, films.iter(), None));
            if !kept || self.interrupt.asked() {
                Answer::Interrupt
            } else {
                stop::answer(progress, head.seconds, self.settings.seconds)
            }
        };
        let results = malus_estimator::resume(self.scene, self.settings, state, &mut watch);
        head.seconds = before + started.elapsed().as_secs_f64();
        reporter.finish();
        keeper.check()?;
        results.with_context(|| format!("{}", self.directory.path().join(self.name).display()))
    }

    /// Takes what is missing of the picture of a camera, by its index, unless the user asks for an end.
    ///
    /// # Errors
    /// A checkpoint cannot be written.
    pub fn shoot(&self, part: &mut Part, keeper: &mut Keeper, index: usize) -> Result<()> {
        let camera = &self.scene.cameras[index];
        let Part {
            head, state, films, ..
        } = part;
        films.resize(self.scene.cameras.len(), Film::default());
        let mut film = std::mem::take(&mut films[index]);
        let started = Instant::now();
        let mut reporter = Reporter::new(self.quiet, None);
        malus_estimator::expose(
            self.scene,
            camera,
            self.settings,
            head.shard,
            &mut film,
            &mut |share, film| {
                reporter.show_share(&camera.name, share, started.elapsed().as_secs_f64());
                head.shot = index as f64 + share;
                let kept = keeper.keep(|| {
                    let others = films.iter().enumerate();
                    let films =
                        others.map(|(other, kept)| if other == index { film } else { kept });
                    part::write(self.directory, self.name, head, state, films, None)
                });
                if !kept || self.interrupt.asked() {
                    Answer::Interrupt
                } else {
                    Answer::Continue
                }
            },
        );
        films[index] = film;
        reporter.finish();
        keeper.check()
    }

    /// Sets a part aside, whatever the time.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn set_aside(&self, part: &Part) -> Result<()> {
        let Part {
            head, state, films, ..
        } = part;
        part::write(self.directory, self.name, head, state, films.iter(), None)
            .context("what was computed last is lost")
    }
}
