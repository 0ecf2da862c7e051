//! `variants.parquet`: the rows of `variants.csv` as typed columns, written group by group.

use super::variants::Row;
use crate::output::{Directory, Growing, unwritten};
use anyhow::{Context, Result};
use malus_scene::{Base, Study};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;
use std::io::BufWriter;
use std::path::PathBuf;
use std::sync::Arc;

/// Fields of one row group, at most: they wait in memory until they are written.
const FIELDS: usize = 1 << 20;

/// Name of the file.
const NAME: &str = "variants.parquet";

/// The file under way.
pub struct Columnar {
    writer: SerializedFileWriter<BufWriter<Growing>>,
    path: PathBuf,
    /// Whether the values of a key are numbers.
    numeric: Vec<bool>,
    /// Rows that wait.
    rows: Vec<Row>,
    /// How many rows make a group.
    most: usize,
}

/// Makes sure that the program can write such files.
///
/// # Errors
/// None: it can.
pub fn check() -> Result<()> {
    Ok(())
}

impl Columnar {
    /// A file without rows; `numbers` are the columns after those of the keys.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn create(
        directory: &Directory,
        study: &Study,
        base: &Base,
        numbers: &[String],
    ) -> Result<Self> {
        let is_number = |value: &Option<String>| {
            let value = value.as_ref();
            value.is_none_or(|value| value.parse::<f64>().is_ok())
        };
        let of_base = base.values(study);
        let numeric = study.numeric().into_iter().zip(&of_base);
        let numeric: Vec<bool> = numeric.map(|(all, base)| all && is_number(base)).collect();
        let mut fields = vec![field("variant", Repetition::REQUIRED, false)?];
        for (key, numeric) in study.keys().iter().zip(&numeric) {
            fields.push(field(key, Repetition::OPTIONAL, *numeric)?);
        }
        for name in numbers {
            fields.push(field(name, Repetition::OPTIONAL, true)?);
        }
        fields.push(field("status", Repetition::REQUIRED, false)?);
        let most = (FIELDS / fields.len()).max(1);
        let schema = Type::group_type_builder("variants").with_fields(fields);
        let path = directory.path().join(NAME);
        let file = directory.begin(NAME).with_context(|| unwritten(&path))?;
        let properties = Arc::new(WriterProperties::builder().build());
        let writer =
            SerializedFileWriter::new(BufWriter::new(file), Arc::new(schema.build()?), properties);
        Ok(Self {
            writer: writer.with_context(|| unwritten(&path))?,
            path,
            numeric,
            rows: Vec::new(),
            most,
        })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, row: &Row) -> Result<()> {
        self.rows.push(row.clone());
        if self.rows.len() == self.most {
            self.flush().with_context(|| unwritten(&self.path))?;
        }
        Ok(())
    }

    /// Writes what is left, and puts the file in its place.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self) -> Result<()> {
        let flushed = self.flush();
        let told = || unwritten(&self.path);
        flushed.with_context(told)?;
        // This writes what a reader begins with.
        let file = self.writer.into_inner().with_context(told)?;
        let file = file.into_inner().map_err(|error| error.into_error());
        file.with_context(told)?.finish().with_context(told)
    }

    /// Writes the rows that wait as a group.
    fn flush(&mut self) -> Result<()> {
        let rows = std::mem::take(&mut self.rows);
        if rows.is_empty() {
            return Ok(());
        }
        let mut group = self.writer.next_row_group()?;
        let keys = self.numeric.len();
        let numbers = rows[0].numbers.len();
        for column in 0..1 + keys + numbers + 1 {
            let mut writer = group.next_column()?.context("there are more columns")?;
            match column.checked_sub(1) {
                None => required(&mut writer, rows.iter().map(|row| &*row.name))?,
                Some(key) if key < keys => {
                    let values = rows.iter().map(|row| row.values[key].as_deref());
                    if self.numeric[key] {
                        // A key is numeric where all its values are.
                        let parsed = values.map(|value| value.and_then(|it| it.parse().ok()));
                        doubles(&mut writer, parsed)?;
                    } else {
                        texts(&mut writer, values)?;
                    }
                }
                Some(number) if number < keys + numbers => {
                    let values = rows.iter().map(|row| row.numbers[number - keys]);
                    doubles(&mut writer, values)?;
                }
                Some(_) => required(&mut writer, rows.iter().map(|row| row.status))?,
            }
            writer.close()?;
        }
        group.close()?;
        Ok(())
    }
}

/// A column: numbers, or text.
fn field(name: &str, repetition: Repetition, number: bool) -> Result<Arc<Type>> {
    let (physical, logical) = match number {
        true => (Physical::DOUBLE, None),
        false => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(name, physical)
        .with_repetition(repetition)
        .with_logical_type(logical);
    Ok(Arc::new(field.build()?))
}

/// Writes a column in which every row has a text.
fn required<'r>(
    writer: &mut SerializedColumnWriter,
    values: impl Iterator<Item = &'r str>,
) -> Result<()> {
    let values: Vec<ByteArray> = values.map(ByteArray::from).collect();
    let writer = writer.typed::<ByteArrayType>();
    writer.write_batch(&values, None, None)?;
    Ok(())
}

/// Writes a column of texts, some of which are missing.
fn texts<'r>(
    writer: &mut SerializedColumnWriter,
    values: impl Iterator<Item = Option<&'r str>> + Clone,
) -> Result<()> {
    let levels: Vec<i16> = values.clone().map(level).collect();
    let values: Vec<ByteArray> = values.flatten().map(ByteArray::from).collect();
    let writer = writer.typed::<ByteArrayType>();
    writer.write_batch(&values, Some(&levels), None)?;
    Ok(())
}

/// Writes a column of numbers, some of which are missing.
fn doubles(
    writer: &mut SerializedColumnWriter,
    values: impl Iterator<Item = Option<f64>> + Clone,
) -> Result<()> {
    let levels: Vec<i16> = values.clone().map(level).collect();
    let values: Vec<f64> = values.flatten().collect();
    let writer = writer.typed::<DoubleType>();
    writer.write_batch(&values, Some(&levels), None)?;
    Ok(())
}

/// Parquet's definition level: whether there is a value.
fn level<T>(value: Option<T>) -> i16 {
    i16::from(value.is_some())
}
