//! What was measured, as scripts and as people read it.

use crate::label;
use crate::number::{exact, significant};
use crate::table::{Edge, Table};
use crate::tradeoff::curve::{Curve, Reach};
use crate::tradeoff::reference::Reference;
use anyhow::Result;
use malus_scene::{Estimator, Scene};
use std::path::Path;

/// Columns of `tradeoff.csv`.
const HEADER: &str = "estimator,representation,threads,samples,seconds,rms_error,max_error,se_mean";

/// The errors whose price is told.
const TARGETS: [f64; 4] = [0.03, 0.01, 0.003, 0.001];

/// The one that is also told as a command.
const EXAMPLE: f64 = 0.01;

/// Everything that was measured.
pub struct Report<'a> {
    /// The scene's file.
    pub file: &'a Path,
    /// The scene.
    pub scene: &'a Scene,
    /// What errors are against.
    pub reference: &'a Reference,
    /// Error against time, a curve a setting.
    pub curves: &'a [Curve],
    /// Time that all took.
    pub seconds: f64,
}

impl Report<'_> {
    /// `tradeoff.csv`: one row a setting and number of samples.
    ///
    /// # Errors
    /// A result that is no finite number.
    pub fn csv(&self) -> Result<Vec<u8>> {
        let mut table = csv::Writer::from_writer(Vec::new());
        table.write_record(HEADER.split(','))?;
        for curve in self.curves {
            let setting = curve.setting;
            for point in curve.points() {
                let mut row = vec![
                    label::estimator(setting.estimator).to_owned(),
                    label::representation(setting.representation).to_owned(),
                    setting.threads.to_string(),
                    point.samples.to_string(),
                ];
                for number in [
                    point.seconds,
                    point.rms_error,
                    point.max_error,
                    point.se_mean,
                ] {
                    row.push(exact(number)?);
                }
                table.write_record(row)?;
            }
        }
        Ok(table.into_inner()?)
    }

    /// The reference in one sentence.
    pub fn reference(&self) -> String {
        let reference = self.reference;
        let points = reference.values.len();
        let how = match reference.estimator {
            Estimator::Gather => "gather alone",
            // Where gather does not see all light.
            other => label::estimator(other),
        };
        format!(
            "reference by {how}, {} samples in {:.1} s, standard error {} (root mean square over {points} sensor point{})",
            reference.samples,
            reference.seconds,
            percent(reference.standard_error()),
            if points == 1 { "" } else { "s" }
        )
    }

    /// The smallest error of any curve.
    fn smallest(&self) -> Option<f64> {
        let points = self.curves.iter().flat_map(Curve::points);
        points.map(|point| point.rms_error).reduce(f64::min)
    }

    /// What `tradeoff` prints, with results in `directory`.
    pub fn text(&self, directory: &Path) -> String {
        let smallest = self
            .smallest()
            .map_or("nothing to show yet".into(), |error| {
                format!("smallest error shown {}", percent(error))
            });
        let mut text = format!("{}; {smallest}\n\n", self.reference());
        text += &self.settings().text("");
        text += "\nCheapest setting to a relative error (root mean square over sensor points and runs)\n";
        text += &self.cheapest().text("");
        let foretold = |target: &f64| {
            self.best(*target)
                .is_some_and(|(_, reach)| reach.is_foretold)
        };
        if TARGETS.iter().any(foretold) {
            text += "≈ beyond what was measured: foretold by the square root of the samples\n";
        }
        if let Some((curve, reach)) = self.best(EXAMPLE) {
            text += &format!(
                "{} % by malus run {} --samples {} {}\n",
                100.0 * EXAMPLE,
                self.file.display(),
                reach.samples,
                curve.setting.options()
            );
        }
        let notes = self.notes();
        if !notes.is_empty() {
            text += &format!("\n{}\n", notes.join("\n"));
        }
        text += &format!(
            "\nmeasured in {:.1} s; results in {}\n",
            self.seconds,
            directory.display()
        );
        text
    }

    /// One row a setting.
    fn settings(&self) -> Table {
        let mut columns = setting_columns();
        columns.extend(["runs", "smallest error", "stated", "s", "slope"].map(right));
        columns.push(("".to_owned(), Edge::Left));
        let mut table = Table::new(columns);
        for curve in self.curves {
            // What cannot be told is at least known to be small.
            let (last, about) = match (curve.points().next_back(), curve.outcomes.first()) {
                (Some(last), _) => (last, percent(last.rms_error)),
                (None, Some(first)) => (first, format!("< {}", percent(curve.limit))),
                (None, None) => continue,
            };
            let mut row = setting_cells(curve);
            row.extend([
                last.runs.to_string(),
                about,
                percent(last.se_mean),
                significant(last.seconds, 2),
                curve
                    .slope()
                    .map_or(String::new(), |slope| format!("{slope:+.2}")),
                curve.floor().map_or(String::new(), |floor| {
                    format!("floor at {}", percent(floor))
                }),
            ]);
            table.row(row);
        }
        table
    }

    /// One row an error.
    fn cheapest(&self) -> Table {
        let mut columns = vec![right("error"), right("s")];
        columns.extend(setting_columns());
        columns.push(right("samples"));
        let mut table = Table::new(columns);
        for target in TARGETS {
            let mut row = vec![format!("{} %", 100.0 * target)];
            match self.best(target) {
                Some((curve, reach)) => {
                    let about = if reach.is_foretold { "≈ " } else { "" };
                    row.push(format!("{about}{}", significant(reach.seconds, 2)));
                    row.extend(setting_cells(curve));
                    row.push(reach.samples.to_string());
                }
                None => row.push("not known".to_owned()),
            }
            table.row(row);
        }
        table
    }

    /// The setting that comes to an error first.
    fn best(&self, target: f64) -> Option<(&Curve, Reach)> {
        self.curves
            .iter()
            .filter_map(|curve| Some((curve, curve.reach(target)?)))
            .min_by(|(_, a), (_, b)| a.seconds.total_cmp(&b.seconds))
    }

    /// What keeps settings from the right answer, each sentence once.
    fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = Vec::new();
        for sentence in self
            .curves
            .iter()
            .flat_map(|curve| curve.setting.shortcomings(self.scene))
        {
            if !notes.contains(&sentence) {
                notes.push(sentence);
            }
        }
        notes
    }
}

fn setting_columns() -> Vec<(String, Edge)> {
    let left = |title: &str| (title.to_owned(), Edge::Left);
    vec![left("estimator"), left("representation"), right("threads")]
}

fn setting_cells(curve: &Curve) -> Vec<String> {
    vec![
        label::estimator(curve.setting.estimator).to_owned(),
        label::representation(curve.setting.representation).to_owned(),
        curve.setting.threads.to_string(),
    ]
}

fn right(title: &str) -> (String, Edge) {
    (title.to_owned(), Edge::Right)
}

/// A share in per cent, to two digits.
pub fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
}
