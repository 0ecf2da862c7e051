//! `variants.csv`: one row a variant, written as it is finished.

use crate::number::exact;
use crate::outcome::{Outcome, Quantity};
use crate::output::Directory;
use anyhow::{Context, Result};
use malus_scene::{Scene, Study};
use std::fs::File;

/// Columns of one sensor group, each after the group's name.
const GROUP: [&str; 7] = [
    "mean",
    "se_mean",
    "min",
    "u0",
    "dolp_mean",
    "dmean",
    "se_dmean",
];

/// The file, open.
pub struct Variants(csv::Writer<File>);

impl Variants {
    /// A file with its header in the directory.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn create(directory: &Directory, study: &Study, scene: &Scene) -> Result<Self> {
        let mut variants = Self(csv::Writer::from_writer(directory.growing("variants.csv")?));
        let groups = scene.sensors.iter().flat_map(|sensor| {
            let name = &sensor.name;
            GROUP.iter().map(move |column| format!("{name}_{column}"))
        });
        let keys = study.keys().into_iter();
        let columns = std::iter::once("variant".to_owned())
            .chain(keys)
            .chain(groups);
        variants.write(columns.chain(["status".to_owned()]).collect())?;
        Ok(variants)
    }

    /// Adds a variant, with its differences to the base.
    ///
    /// # Errors
    /// A result that is no finite number, or the file cannot be written.
    pub fn add(&mut self, outcome: &Outcome) -> Result<()> {
        let mut row = head(&outcome.name, &outcome.values);
        for (group, base) in outcome.groups.iter().zip(outcome.base.iter()) {
            let Some(group) = group else {
                row.extend(GROUP.map(|_| String::new()));
                continue;
            };
            let difference = base
                .as_ref()
                .and_then(|base| group.less(base, Quantity::Mean));
            let numbers = [
                Some(group.mean),
                Some(group.mean_standard_error),
                Some(group.min),
                Some(group.u0),
                Some(group.dolp_mean),
                difference.map(|it| it.mean),
                difference.map(|it| it.standard_error),
            ];
            for number in numbers {
                row.push(number.map_or(Ok(String::new()), exact)?);
            }
        }
        row.push("ok".to_owned());
        self.write(row)
    }

    /// Adds a variant that failed.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add_failed(
        &mut self,
        name: &str,
        values: &[Option<String>],
        groups: usize,
    ) -> Result<()> {
        let mut row = head(name, values);
        row.extend(std::iter::repeat_n(String::new(), groups * GROUP.len()));
        row.push("failed".to_owned());
        self.write(row)
    }

    fn write(&mut self, row: Vec<String>) -> Result<()> {
        self.0
            .write_record(row)
            .and_then(|()| Ok(self.0.flush()?))
            .context("variants.csv: cannot be written")
    }
}

fn head(name: &str, values: &[Option<String>]) -> Vec<String> {
    let values = values.iter().map(|value| value.clone().unwrap_or_default());
    std::iter::once(name.to_owned()).chain(values).collect()
}
