//! `variants.csv`: one row a variant, written as it is finished; and the same as Parquet.

use super::columnar::Columnar;
use super::results::Wanted;
use crate::number::exact;
use crate::outcome::{Groups, Outcome, Quantity};
use crate::output::unwritten;
use anyhow::{Context, Result};
use malus_scene::{Base, Scene, Study};
use std::fs::File;
use std::path::PathBuf;

/// Name of the file.
const NAME: &str = "variants.csv";

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

/// One row.
#[derive(Clone, Debug)]
pub struct Row {
    /// The variant's name.
    pub name: String,
    /// The value of each key of the study.
    pub values: Vec<Option<String>>,
    /// The columns of every sensor group.
    pub numbers: Vec<Option<f64>>,
    /// Whether it is as it should be.
    pub status: &'static str,
}

/// The file, open, and the same as Parquet where it is wanted.
pub struct Variants {
    file: csv::Writer<File>,
    path: PathBuf,
    columnar: Option<Columnar>,
}

impl Variants {
    /// A file with its header in the directory.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn create(wanted: &Wanted, study: &Study, base: &Base) -> Result<Self> {
        let numbers: Vec<String> = numbers(&base.scene).collect();
        let columnar = wanted
            .parquet
            .then(|| Columnar::create(wanted.directory, study, base, &numbers));
        let mut variants = Self {
            file: csv::Writer::from_writer(wanted.directory.growing(NAME)?),
            path: wanted.directory.path().join(NAME),
            columnar: columnar.transpose()?,
        };
        let columns = std::iter::once("variant".to_owned())
            .chain(study.keys())
            .chain(numbers)
            .chain(["status".to_owned()]);
        variants.write(columns.collect())?;
        Ok(variants)
    }

    /// The row of a variant, with its differences to the base.
    ///
    /// # Errors
    /// A result that is no finite number.
    pub fn row(outcome: &Outcome, groups: &Groups, base: &Groups) -> Result<Row> {
        let mut numbers = Vec::new();
        for (group, base) in groups.iter().zip(base) {
            let Some(group) = group else {
                numbers.extend([None; GROUP.len()]);
                continue;
            };
            let difference = base
                .as_ref()
                .and_then(|base| group.less(base, Quantity::Mean));
            numbers.extend([
                Some(group.mean),
                Some(group.mean_standard_error),
                Some(group.min),
                Some(group.u0),
                Some(group.dolp_mean),
                difference.map(|it| it.mean),
                difference.map(|it| it.standard_error),
            ]);
        }
        for number in numbers.iter().flatten() {
            exact(*number)?;
        }
        Ok(Row {
            name: outcome.name.clone(),
            values: outcome.values.clone(),
            numbers,
            status: "ok",
        })
    }

    /// The row of a variant that failed.
    pub fn failed_row(name: &str, values: &[Option<String>], groups: usize) -> Row {
        Row {
            name: name.to_owned(),
            values: values.to_vec(),
            numbers: vec![None; groups * GROUP.len()],
            status: "failed",
        }
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, row: &Row) -> Result<()> {
        let values = row.values.iter();
        let values = values.map(|value| Ok(value.clone().unwrap_or_default()));
        let numbers = row.numbers.iter();
        let numbers = numbers.map(|number| number.map_or(Ok(String::new()), exact));
        let name = std::iter::once(Ok(row.name.clone()));
        let fields = name.chain(values).chain(numbers);
        let fields = fields.chain([Ok(row.status.to_owned())]);
        self.write(fields.collect::<Result<_>>()?)?;
        match &mut self.columnar {
            Some(columnar) => columnar.add(row),
            None => Ok(()),
        }
    }

    /// Ends the files.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn finish(self) -> Result<()> {
        match self.columnar {
            Some(columnar) => columnar.finish(),
            None => Ok(()),
        }
    }

    fn write(&mut self, row: Vec<String>) -> Result<()> {
        self.file
            .write_record(row)
            .and_then(|()| Ok(self.file.flush()?))
            .with_context(|| unwritten(&self.path))
    }
}

/// Names of the columns that hold numbers of sensor groups.
fn numbers(scene: &Scene) -> impl Iterator<Item = String> {
    scene.sensors.iter().flat_map(|sensor| {
        let name = &sensor.name;
        GROUP.iter().map(move |column| format!("{name}_{column}"))
    })
}
