//! The files of results, and what is printed of them.

use crate::digest::Digest;
use crate::output::Directory;
use crate::summary::Circumstances;
use crate::{overview, plan, rows, summary};
use anyhow::{Context, Result};
use malus_estimator::Results;
use malus_scene::{Scene, Settings};
use std::io::Write;

/// What is reported, and how much of it.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// Where the files go.
    pub directory: &'a Directory,
    /// Whether plans are drawn.
    pub pictures: bool,
    /// Whether nothing is printed.
    pub quiet: bool,
}

impl Report<'_> {
    /// Writes all files, the summary last, so that where it is, everything is; then prints the overview.
    ///
    /// # Errors
    /// A file cannot be written, or a result is no number.
    pub fn write(
        &self,
        scene: &Scene,
        settings: &Settings,
        results: &Results,
        circumstances: &Circumstances,
    ) -> Result<()> {
        let directory = self.directory;
        let digests: Vec<Digest> = results.groups.iter().map(Digest::of).collect();
        let sensors = rows::sensors(scene, &results.groups)?;
        let grids = rows::grids(scene, &digests)?;
        let summary = summary::json(scene, settings, results, circumstances)?;
        directory.write("sensors.csv", &sensors)?;
        directory.write("grids.csv", &grids)?;
        let pictured = if self.pictures { &digests[..] } else { &[] };
        for (index, (sensor, digest)) in scene.sensors.iter().zip(pictured).enumerate() {
            if let Some(drawn) = plan::svg(scene, results, index, digest) {
                directory.write(&format!("{}.svg", sensor.name), drawn.as_bytes())?;
            }
        }
        directory.write("summary.json", &summary)?;
        if !self.quiet {
            let path = directory.path();
            print(&overview::text(
                scene,
                results,
                &digests,
                circumstances,
                path,
            ))?;
        }
        Ok(())
    }
}

/// Warnings, on stderr even where the run is quiet.
pub fn warn(warnings: &[String]) {
    for warning in warnings {
        eprintln!("warning: {warning}");
    }
}

/// Text on stdout; a reader that has gone away is no failure.
pub fn print(text: &str) -> Result<()> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(error).context("cannot write to stdout")
        }
        _ => Ok(()),
    }
}
