//! `malus sweep`: evaluate the variants of a study and say how they differ.

use crate::args;
use crate::conclusion::{self, Circumstances, Computed};
use crate::failure::Failure;
use crate::findings::Finding;
use crate::interrupt::Interrupt;
use crate::outcome::{Measured, Outcome};
use crate::output::Directory;
use crate::progress::Reporter;
use crate::run::{End, pool, print, warn};
use crate::student::half_width_95;
use crate::variants::Variants;
use crate::{rows, stop, trade};
use anyhow::{Context, Result, anyhow, ensure};
use malus_estimator::{Answer, Results};
use malus_scene::{Base, Scene, Settings, Study};
use std::path::{Path, PathBuf};
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
    let directory = Directory::prepare(&directory(command)).map_err(Failure::run)?;
    warn(&base.scene.warnings);
    warn(&base.doubts);
    let pool = pool(threads).map_err(Failure::run)?;
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
        outcomes: Vec::new(),
        failed: Vec::new(),
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
    /// The base, then what variants gave.
    outcomes: Vec<Outcome>,
    /// Names of variants that failed.
    failed: Vec<String>,
}

impl Sweep<'_> {
    /// Computes the base by its own stopping rule, then every variant with as many samples.
    fn all(&mut self, settings: Settings) -> Result<Computed> {
        let seed = settings.seed;
        let base = self.compute(&self.base.scene, &settings, 0);
        warn(&base.warnings);
        let values = self.base.values(self.study);
        self.keep(BASE.to_owned(), values, &self.base.scene, &base)?;
        let mut computed = Computed {
            seed,
            samples: base.samples,
            dof: base.dof,
            complete: base.complete,
        };
        if !base.complete {
            return Ok(computed);
        }
        let settings = Settings {
            samples: Some(base.samples),
            relative_error: None,
            seconds: None,
            ..settings
        };
        for (index, variant) in self.study.variants().enumerate() {
            let (name, values) = (variant.name(), variant.values());
            let scene = self
                .base
                .variant(&variant)
                .map_err(|error| anyhow!("{error}"));
            let done = scene.and_then(|scene| {
                ensure!(
                    names(&scene).eq(names(&self.base.scene)),
                    "its sensors are not those of the base"
                );
                let settings = Settings {
                    samples: settings.samples,
                    relative_error: None,
                    seconds: None,
                    ..scene.settings.clone()
                };
                let results = self.compute(&scene, &settings, index + 1);
                if results.complete {
                    self.keep(name.clone(), values.clone(), &scene, &results)?;
                }
                Ok(results.complete)
            });
            match done {
                Ok(true) => {}
                Ok(false) => {
                    computed.complete = false;
                    return Ok(computed);
                }
                Err(error) => {
                    eprintln!("error: variant {name}: {error:#}");
                    let groups = self.base.scene.sensors.len();
                    self.variants.add_failed(&name, &values, groups)?;
                    self.failed.push(name);
                }
            }
        }
        Ok(computed)
    }

    /// The results of one scene, the `index`-th of the study.
    fn compute(&mut self, scene: &Scene, settings: &Settings, index: usize) -> Results {
        let count = self.study.count() + 1;
        let started = Instant::now();
        malus_estimator::run(scene, settings, &mut |progress| {
            let within = progress
                .samples_limit
                .map_or(0.0, |limit| progress.samples as f64 / limit as f64);
            let share = (index as f64 + within) / count as f64;
            let elapsed = self.started.elapsed().as_secs_f64();
            self.reporter.show_share("variants", share, elapsed);
            if self.interrupt.asked() {
                Answer::Interrupt
            } else {
                stop::answer(progress, started.elapsed().as_secs_f64(), settings.seconds)
            }
        })
    }

    /// Writes what a variant gave, and keeps what comparing it takes.
    fn keep(
        &mut self,
        name: String,
        values: Vec<Option<String>>,
        scene: &Scene,
        results: &Results,
    ) -> Result<()> {
        let outcome = Outcome {
            name,
            values,
            groups: results.groups.iter().map(Measured::of).collect(),
        };
        if self.command.sensors {
            let folder = self.directory.path().join("variants").join(&outcome.name);
            let folder = Directory::prepare(&folder)?;
            folder.write("sensors.csv", &rows::sensors(scene, results)?)?;
        }
        self.variants
            .add(&outcome, self.outcomes.first().unwrap_or(&outcome))?;
        self.outcomes.push(outcome);
        Ok(())
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

fn names(scene: &Scene) -> impl Iterator<Item = &str> {
    scene.sensors.iter().map(|sensor| sensor.name.as_str())
}

/// Where the results go.
fn directory(command: &args::Sweep) -> PathBuf {
    command.output.clone().unwrap_or_else(|| {
        let stem = command.study.file_stem().unwrap_or("study".as_ref());
        Path::new("results").join(stem)
    })
}
