//! `malus sweep`: evaluate the variants of a study and say how they differ.

use crate::args;
use crate::batch::{Batch, Batches, Loaded};
use crate::conclusion::{self, Circumstances, Computed};
use crate::failure::Failure;
use crate::findings::Finding;
use crate::interrupt::Interrupt;
use crate::outcome::{Measured, Outcome};
use crate::output::Directory;
use crate::progress::Reporter;
use crate::report::{print, warn};
use crate::run::{End, directory, pool};
use crate::student::half_width_95;
use crate::variants::Variants;
use crate::{rows, stop, trade};
use anyhow::{Result, anyhow, ensure};
use malus_estimator::{Allocation, Answer, Group, REPLICAS, Results, Together, run_together};
use malus_scene::{Base, Scene, Settings, Study};
use std::sync::Arc;
use std::time::Instant;

/// Name of the scene as it stands among its variants.
const BASE: &str = "base";

/// Evaluates the variants of a study.
///
/// # Errors
/// Bad arguments, a bad scene or study, or variants that failed.
pub fn sweep(command: &args::Sweep) -> Result<End, Failure> {
    let threads = command.computing.threads()?;
    let study = Study::load(&command.study).map_err(|error| command.computing.refused(&error))?;
    let overrides = command.computing.overrides();
    let base = study.base(&overrides);
    let base = base.map_err(|error| command.computing.refused(&error))?;
    let mut settings = base.scene.settings.clone();
    stop::narrow(&mut settings, &overrides);
    let directory = Directory::prepare(&directory(command.output.as_deref(), &command.study))
        .map_err(Failure::run)?;
    warn(&base.scene.warnings);
    warn(&base.doubts);
    let pool = pool(threads)?;
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let mut sweep = Sweep {
        command,
        study: &study,
        base: &base,
        variants: Variants::create(&directory, &study, &base.scene).map_err(Failure::run)?,
        directory,
        interrupt,
        started: Instant::now(),
        reporter: Reporter::new(command.quiet, settings.seconds),
        allocation: None,
        of_base: Arc::default(),
        outcomes: Vec::new(),
        failed: Vec::new(),
        batches: 0,
        apart: Vec::new(),
    };
    let computed = pool.install(|| sweep.all(settings)).map_err(Failure::run)?;
    sweep.reporter.finish();
    let end = sweep.conclude(&computed, threads).map_err(Failure::run)?;
    if !sweep.failed.is_empty() {
        return Err(Failure::run(anyhow!(
            "{} of {} variants failed: {}; the others are in {}",
            sweep.failed.len(),
            study.count(),
            sweep.failed.join(", "),
            sweep.directory.path().display()
        )));
    }
    Ok(end)
}

/// A study under way.
struct Sweep<'a> {
    command: &'a args::Sweep,
    study: &'a Study,
    base: &'a Base,
    directory: Directory,
    variants: Variants,
    interrupt: Interrupt,
    started: Instant,
    reporter: Reporter,
    /// How the base's walks are shared out between the sensors.
    allocation: Option<Allocation>,
    /// What the base gave along the last walks that served it.
    of_base: Arc<Vec<Option<Measured>>>,
    /// The base, then what variants gave.
    outcomes: Vec<Outcome>,
    /// Names of variants that failed.
    failed: Vec<String>,
    /// Sets of walks that were taken.
    batches: usize,
    /// Names of variants of the base's geometry that walks for the base would serve badly.
    apart: Vec<String>,
}

impl Sweep<'_> {
    /// Computes the base by its own stopping rule, and every variant along the same walks or with as many samples.
    fn all(&mut self, mut settings: Settings) -> Result<Computed> {
        let mut batches = Batches::default();
        for variant in self.study.variants() {
            let (name, values) = (variant.name(), variant.values());
            let scene = self
                .base
                .variant(&variant)
                .map_err(|error| anyhow!("{error}"));
            let scene = scene.and_then(|scene| {
                let alike = names(&scene).eq(names(&self.base.scene));
                ensure!(alike, "its sensors are not those of the base");
                Ok(scene)
            });
            let loaded = match scene {
                Ok(scene) => Loaded {
                    name,
                    values,
                    scene,
                },
                Err(error) => {
                    self.fail(name, &values, &error)?;
                    continue;
                }
            };
            if let Some(batch) = batches.add(&self.base.scene, loaded)
                && !self.evaluate(batch, &mut settings)?
            {
                return Ok(self.computed(&settings, false));
            }
        }
        for batch in batches.rest() {
            if !self.evaluate(batch, &mut settings)? {
                return Ok(self.computed(&settings, false));
            }
        }
        Ok(self.computed(&settings, true))
    }

    /// Evaluates the variants of a batch; false where the user has ended it.
    fn evaluate(&mut self, batch: Batch, settings: &mut Settings) -> Result<bool> {
        let base = self.base;
        if self.outcomes.is_empty() && !batch.with_base {
            // Differences to the base need it first.
            let alone = self.compute(&[&base.scene], settings, 0)?;
            if !self.keep_base(&alone.first, settings)? {
                return Ok(false);
            }
        }
        let own = batch.variants.iter().map(|it| &it.scene);
        let scenes: Vec<&Scene> = batch
            .with_base
            .then_some(&base.scene)
            .into_iter()
            .chain(own)
            .collect();
        let settings_of_batch = match batch.with_base {
            true => settings.clone(),
            false => Settings {
                samples: settings.samples,
                relative_error: settings.relative_error,
                seconds: settings.seconds,
                ..scenes[0].settings.clone()
            },
        };
        let together = self.compute(&scenes, &settings_of_batch, batch.variants.len())?;
        if batch.with_base && self.outcomes.is_empty() {
            self.keep_base(&together.first, settings)?;
        }
        if !together.first.complete {
            return Ok(false);
        }
        if batch.with_base {
            self.of_base = Arc::new(measured(&together.first.groups));
        } else {
            self.of_base = Arc::clone(&self.outcomes[0].base);
            let apart = batch
                .variants
                .iter()
                .filter(|it| Arc::ptr_eq(&it.scene.surfaces, &base.scene.surfaces));
            self.apart.extend(apart.map(|it| it.name.clone()));
        }
        self.batches += 1;
        let first = (!batch.with_base).then_some(&together.first.groups);
        let groups = first.into_iter().chain(&together.others);
        for (variant, groups) in batch.variants.iter().zip(groups) {
            let kept = self.keep(&variant.name, &variant.values, &variant.scene, groups);
            if let Err(error) = kept {
                self.fail(variant.name.clone(), &variant.values, &error)?;
            }
        }
        Ok(true)
    }

    /// What scenes give that the same walks serve; `count` of them are variants.
    fn compute(
        &mut self,
        scenes: &[&Scene],
        settings: &Settings,
        count: usize,
    ) -> Result<Together> {
        let total = self.study.count() as f64;
        let done = (self.outcomes.len().saturating_sub(1) + self.failed.len()) as f64;
        let started = Instant::now();
        Ok(run_together(
            scenes,
            settings,
            self.allocation.as_ref(),
            &mut |progress| {
                let within = progress
                    .samples_limit
                    .map_or(0.0, |limit| progress.samples as f64 / limit as f64);
                let share = (done + within * count as f64) / total;
                self.reporter
                    .show_share("variants", share, self.started.elapsed().as_secs_f64());
                if self.interrupt.asked() {
                    Answer::Interrupt
                } else {
                    stop::answer(progress, started.elapsed().as_secs_f64(), settings.seconds)
                }
            },
        ))
    }

    /// Keeps the base, whose samples all variants take; false where the user has ended it.
    fn keep_base(&mut self, base: &Results, settings: &mut Settings) -> Result<bool> {
        warn(&base.warnings);
        settings.samples = Some(base.samples);
        settings.relative_error = None;
        settings.seconds = None;
        self.allocation = Some(base.allocation.clone());
        self.of_base = Arc::new(measured(&base.groups));
        let values = self.base.values(self.study);
        self.keep(BASE, &values, &self.base.scene, &base.groups)?;
        Ok(base.complete)
    }

    /// Writes what a variant gave, and keeps what comparing it takes.
    fn keep(
        &mut self,
        name: &str,
        values: &[Option<String>],
        scene: &Scene,
        groups: &[Group],
    ) -> Result<()> {
        let outcome = Outcome {
            name: name.to_owned(),
            values: values.to_vec(),
            groups: measured(groups),
            base: Arc::clone(&self.of_base),
        };
        if self.command.sensors {
            let folder = self.directory.path().join("variants").join(name);
            let folder = Directory::prepare(&folder)?;
            folder.write("sensors.csv", &rows::sensors(scene, groups)?)?;
        }
        self.variants.add(&outcome)?;
        self.outcomes.push(outcome);
        Ok(())
    }

    /// Names a variant that failed.
    fn fail(
        &mut self,
        name: String,
        values: &[Option<String>],
        error: &anyhow::Error,
    ) -> Result<()> {
        eprintln!("error: variant {name}: {error:#}");
        let groups = self.base.scene.sensors.len();
        self.variants.add_failed(&name, values, groups)?;
        self.failed.push(name);
        Ok(())
    }

    fn computed(&self, settings: &Settings, complete: bool) -> Computed {
        Computed {
            seed: settings.seed,
            samples: settings.samples.unwrap_or_default(),
            dof: REPLICAS - 1,
            complete,
        }
    }

    /// Says what the variants show, in files and on stdout.
    fn conclude(&self, computed: &Computed, threads: usize) -> Result<End> {
        let scene = &self.base.scene;
        let findings = Finding::all(self.study, scene, &self.outcomes, computed.dof);
        let title = self.title();
        let circumstances = Circumstances {
            study: &title,
            computed,
            variants: self.study.count(),
            failed: &self.failed,
            batches: self.batches,
            apart: &self.apart,
            seconds: self.started.elapsed().as_secs_f64(),
            threads,
        };
        self.directory.write(
            "study.json",
            &conclusion::json(scene, &circumstances, &findings)?,
        )?;
        let pictured = if self.command.no_pictures {
            &[]
        } else {
            &findings[..]
        };
        for finding in pictured {
            if let Some(drawn) = trade::svg(finding, &title, half_width_95(computed.dof)) {
                let name = format!("{}-trade.svg", finding.sensor);
                self.directory.write(&name, drawn.as_bytes())?;
            }
        }
        if !self.command.quiet {
            print(&conclusion::text(
                &circumstances,
                &findings,
                self.directory.path(),
            ))?;
        }
        if computed.complete {
            return Ok(End::Complete);
        }
        warn(&[format!(
            "interrupted: the results in {} are incomplete",
            self.directory.path().display()
        )]);
        Ok(End::Interrupted)
    }

    /// Name of the study for titles.
    fn title(&self) -> String {
        let stem = self.command.study.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }
}

/// What each sensor group measured.
fn measured(groups: &[Group]) -> Vec<Option<Measured>> {
    groups.iter().map(Measured::of).collect()
}

fn names(scene: &Scene) -> impl Iterator<Item = &str> {
    scene.sensors.iter().map(|sensor| sensor.name.as_str())
}
