//! What varies by itself: a key with its values, or rows of values for several keys.

use super::{Study, Varied};
use crate::document::{Entry, Node, Value};
use crate::error::Error;
use crate::overrides::Key;
use crate::reader::Field;
use std::ops::Range;

/// Values that keys take together, row by row.
#[derive(Debug)]
pub(super) struct Axis {
    /// Indices of the study's keys.
    keys: Range<usize>,
    /// One value a key; `None` leaves the base's.
    rows: Vec<Vec<Option<Node>>>,
}

impl Axis {
    pub(super) fn new(keys: Range<usize>, rows: Vec<Vec<Option<Node>>>) -> Self {
        Self { keys, rows }
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// The keys of one row, by index, with their values.
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = (usize, &Option<Node>)> {
        self.keys.clone().zip(&self.rows[row])
    }
}

/// Reads `[grid]`: every key with the list of its values.
pub(super) fn grid(field: Field, study: &mut Study) -> Result<(), Error> {
    let mut table = field.table()?;
    let at = table.at().to_string();
    let leaves = leaves(table.rest(), |value| !matches!(value, Value::Table(_)))?;
    if leaves.is_empty() {
        return Err(Error::Conflict {
            at,
            reason: "[grid] holds no key: give each key the list of its values, \"material.Floor.a\" = [0, 0.2]"
                .into(),
        });
    }
    for (varied, node) in leaves {
        let field = Field::new(format!("[grid] {}", varied.key), node.clone());
        let Value::List(values) = node.value else {
            return Err(field.refused("the list of its values", String::new()));
        };
        if values.is_empty() {
            return Err(field.refused("a list of one value or more", String::new()));
        }
        study.add(
            vec![varied],
            values.into_iter().map(|value| vec![Some(value)]).collect(),
        )?;
    }
    Ok(())
}

/// The keys of a table down to those values that are `whole`: a dotted key may stand in quotes or be written as tables.
pub(super) fn leaves(
    entries: Vec<Entry>,
    whole: impl Fn(&Value) -> bool,
) -> Result<Vec<(Varied, Node)>, Error> {
    let mut found = Vec::new();
    for Entry { key, at, node } in entries {
        let key = Key::parse(&key, &at)?;
        descend(Varied { key, at }, node, &whole, &mut found);
    }
    Ok(found)
}

fn descend(
    varied: Varied,
    node: Node,
    whole: &dyn Fn(&Value) -> bool,
    found: &mut Vec<(Varied, Node)>,
) {
    match node.value {
        Value::Table(entries) if !whole(&Value::Table(entries.clone())) => {
            for Entry { key, at, node } in entries {
                let key = varied.key.below(&key);
                descend(Varied { key, at }, node, whole, found);
            }
        }
        value => found.push((varied, Node { at: node.at, value })),
    }
}
