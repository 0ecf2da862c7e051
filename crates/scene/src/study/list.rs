//! Variants row by row, from a table that a spreadsheet writes.

use super::{Study, Varied};
use crate::document::Node;
use crate::error::Error;
use crate::overrides::Key;
use crate::place::Place;
use crate::reader::Field;
use std::path::Path;
use std::sync::Arc;

/// Reads `[list]`: the name of a CSV file whose header holds dotted keys. An empty field leaves the base's value.
pub(super) fn list(field: Field, folder: &Path, study: &mut Study) -> Result<(), Error> {
    let mut table = field.table()?;
    let file = table.require(
        "file",
        "the path of a .csv file with dotted keys in its header",
    )?;
    table.finish()?;
    let at = file.at().to_string();
    let path = folder.join(file.text()?.value);
    let shown: Arc<str> = path.display().to_string().into();
    let unreadable = |reason: String| Error::Unreadable {
        path: shown.to_string(),
        reason,
    };
    let bytes = std::fs::read(&path).map_err(|error| {
        unreadable(match error.kind() {
            std::io::ErrorKind::NotFound => format!("there is no such file (named at {at})"),
            _ => format!("cannot be read (named at {at}): {error}"),
        })
    })?;
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&bytes);
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text);
    let header = reader
        .headers()
        .map_err(|error| unreadable(error.to_string()))?
        .clone();
    let keys = header
        .iter()
        .zip(places(&shown, text, &header))
        .map(|(key, at)| Key::parse(key, &at).map(|key| Varied { key, at }))
        .collect::<Result<Vec<_>, _>>()?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| unreadable(error.to_string()))?;
        let places = places(&shown, text, &record);
        let values = record.iter().zip(places).map(|(text, at)| match text {
            "" => Ok(None),
            text => Node::value(text, &at).map(Some),
        });
        rows.push(values.collect::<Result<_, _>>()?);
    }
    if rows.is_empty() || keys.is_empty() {
        return Err(unreadable(
            "holds no variants: the first line is the header, each line after it a variant".into(),
        ));
    }
    study.add(keys, rows)
}

/// Place of each field of a line; exact where no field is in quotes.
fn places(file: &Arc<str>, text: &[u8], record: &csv::StringRecord) -> Vec<Place> {
    let line = record.position().map_or(1, |position| line(text, position));
    let mut column = 1;
    record
        .iter()
        .map(|field| {
            let place = Place::File {
                file: Arc::clone(file),
                line,
                column,
            };
            column += field.chars().count() + 1;
            place
        })
        .collect()
}

/// The line of a record that is said to begin at a position: comments and empty lines before it are passed over.
fn line(text: &[u8], position: &csv::Position) -> usize {
    let rest = &text[(position.byte() as usize).min(text.len())..];
    let passed_over = |row: &&[u8]| row.starts_with(b"#") || row.trim_ascii().is_empty();
    let before = rest.split(|byte| *byte == b'\n').take_while(passed_over);
    position.line() as usize + before.count()
}
