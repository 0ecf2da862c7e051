//! Reads one table key by key; what nobody asked for is an error that names the nearest known key.

use crate::allowed::Allowed;
use crate::document::{Entry, Node, Value};
use crate::error::Error;
use crate::nearest::{alike, hint};
use crate::place::{Located, Place};
use glam::DVec3;

/// Name of the table that is the whole file.
pub(crate) const WHOLE: &str = "the scene file";

/// Name of the table that is the whole of a study file.
pub(crate) const STUDY: &str = "the study";

/// A table that is being read.
pub(crate) struct Reader {
    name: String,
    at: Place,
    entries: Vec<Entry>,
    asked: Vec<&'static str>,
}

/// A value that is being read, with the key it stands under.
pub(crate) struct Field {
    key: String,
    node: Node,
}

impl Reader {
    /// Begins to read `node`, a table called `name` in messages.
    pub(crate) fn new(name: String, node: Node) -> Result<Self, Error> {
        let Node { at, value } = node;
        match value {
            Value::Table(entries) => Ok(Self {
                name,
                at,
                entries,
                asked: Vec::new(),
            }),
            other => Err(bad(&at, &name, &other, "a table")),
        }
    }

    /// Place of the table.
    pub(crate) fn at(&self) -> &Place {
        &self.at
    }

    /// Takes the value of `key` out of the table, if it is there.
    pub(crate) fn take(&mut self, key: &'static str) -> Option<Field> {
        self.asked.push(key);
        let index = self.entries.iter().position(|entry| entry.key == key)?;
        Some(Field {
            key: self.path_of(key),
            node: self.entries.remove(index).node,
        })
    }

    /// A key with its table, as messages name it: `[run] samples`, `shape.0 min`, of a whole file the key alone.
    fn path_of(&self, key: &str) -> String {
        if [WHOLE, STUDY].contains(&self.name.as_str()) {
            format!("[{key}]")
        } else {
            format!("{} {key}", self.name)
        }
    }

    /// Takes the value of `key`, which has to be there and to be as `expected`.
    pub(crate) fn require(&mut self, key: &'static str, expected: &str) -> Result<Field, Error> {
        if let Some(field) = self.take(key) {
            return Ok(field);
        }
        // A key that is left over and looks like this one is more likely misspelt than the other missing.
        let misspelt = self.entries.iter().find(|entry| alike(&entry.key, key));
        Err(match misspelt {
            Some(entry) => Error::UnknownKey {
                at: entry.at.to_string(),
                table: self.name.clone(),
                key: entry.key.clone(),
                hint: hint(&entry.key, [key]),
            },
            None => Error::MissingKey {
                at: self.at.to_string(),
                table: self.name.clone(),
                key: key.to_owned(),
                expected: expected.to_owned(),
            },
        })
    }

    /// Takes a number, or `default`.
    pub(crate) fn number_or(
        &mut self,
        key: &'static str,
        allowed: Allowed,
        default: f64,
    ) -> Result<f64, Error> {
        self.take(key)
            .map_or(Ok(default), |field| field.number(allowed))
    }

    /// Takes a flag, or `default`.
    pub(crate) fn flag_or(&mut self, key: &'static str, default: bool) -> Result<bool, Error> {
        self.take(key).map_or(Ok(default), Field::flag)
    }

    /// Takes every entry that is left: a table whose keys are the user's own names.
    pub(crate) fn rest(&mut self) -> Vec<Entry> {
        std::mem::take(&mut self.entries)
    }

    /// Ends the reading: whatever nobody asked for is an error.
    pub(crate) fn finish(self) -> Result<(), Error> {
        let unknown = |entry: &Entry| Error::UnknownKey {
            at: entry.at.to_string(),
            table: self.name.clone(),
            key: entry.key.clone(),
            hint: hint(&entry.key, self.asked.iter().copied()),
        };
        Error::all(self.entries.iter().map(unknown).collect())
    }
}

impl Field {
    /// A value under a key that is the user's own name.
    pub(crate) fn new(key: String, node: Node) -> Self {
        Self { key, node }
    }

    /// Place of the value.
    pub(crate) fn at(&self) -> &Place {
        &self.node.at
    }

    /// The value as a table.
    pub(crate) fn table(self) -> Result<Reader, Error> {
        Reader::new(self.key, self.node)
    }

    /// The value as a list of anything.
    pub(crate) fn list(self) -> Result<Vec<Self>, Error> {
        let Self { key, node } = self;
        match node.value {
            Value::List(items) => Ok(items
                .into_iter()
                .enumerate()
                .map(|(index, node)| Self {
                    key: format!("{key}[{index}]"),
                    node,
                })
                .collect()),
            other => Err(bad(&node.at, &key, &other, "a list")),
        }
    }

    /// The value as the tables `[[kind]]`.
    pub(crate) fn tables(self, kind: &str) -> Result<Vec<Self>, Error> {
        let Self { node, .. } = self;
        let written = format!("[[{kind}]]");
        match node.value {
            Value::List(items) => Ok(items
                .into_iter()
                .map(|node| Self::new(written.clone(), node))
                .collect()),
            other => {
                let allowed = format!("a list of tables, each headed {written}");
                Err(bad(&node.at, kind, &other, &allowed))
            }
        }
    }

    /// The value as text.
    pub(crate) fn text(self) -> Result<Located<String>, Error> {
        match self.node.value {
            Value::Text(value) => Ok(Located {
                value,
                at: self.node.at,
            }),
            other => Err(bad(&self.node.at, &self.key, &other, "a string")),
        }
    }

    /// The value as `true` or `false`.
    pub(crate) fn flag(self) -> Result<bool, Error> {
        match self.node.value {
            Value::Flag(flag) => Ok(flag),
            ref other => Err(bad(&self.node.at, &self.key, other, "true or false")),
        }
    }

    /// The value as a number in a range.
    pub(crate) fn number(&self, allowed: Allowed) -> Result<f64, Error> {
        let number = match self.node.value {
            // Beyond 2⁵³ the nearest number that a computer has is meant.
            Value::Integer(integer) => integer as f64,
            Value::Number(number) => number,
            _ => f64::NAN,
        };
        if allowed.admits(number) {
            Ok(number)
        } else {
            Err(bad(
                &self.node.at,
                &self.key,
                &self.node.value,
                allowed.words(),
            ))
        }
    }

    /// The value as a whole number from `least` to `most`; `1e6` is one.
    pub(crate) fn whole(&self, least: u64, most: u64) -> Result<u64, Error> {
        let whole = match self.node.value {
            Value::Integer(integer) => u64::try_from(integer).ok(),
            Value::Number(number)
                if (0.0..9.0e15).contains(&number) && number.fract().abs() < f64::MIN_POSITIVE =>
            {
                Some(number as u64)
            }
            _ => None,
        };
        whole
            .filter(|whole| (least..=most).contains(whole))
            .ok_or_else(|| {
                let allowed = if most == u64::MAX {
                    format!("a whole number ≥ {least}")
                } else {
                    format!("a whole number from {least} to {most}")
                };
                bad(&self.node.at, &self.key, &self.node.value, &allowed)
            })
    }

    /// The value as a list of N numbers.
    pub(crate) fn numbers<const N: usize>(&self) -> Result<[f64; N], Error> {
        let wrong = || {
            let allowed = format!("a list of {N} numbers");
            bad(&self.node.at, &self.key, &self.node.value, &allowed)
        };
        let Value::List(items) = &self.node.value else {
            return Err(wrong());
        };
        if items.len() != N {
            return Err(wrong());
        }
        let mut numbers = [0.0; N];
        for (index, (number, node)) in numbers.iter_mut().zip(items).enumerate() {
            let item = Self::new(format!("{}[{index}]", self.key), node.clone());
            *number = item.number(Allowed::Finite)?;
        }
        Ok(numbers)
    }

    /// The value as a point or vector.
    pub(crate) fn vector(&self) -> Result<DVec3, Error> {
        Ok(DVec3::from_array(self.numbers()?))
    }

    /// The value as a vector of length 1; the one given may have any length but 0.
    pub(crate) fn direction(&self) -> Result<DVec3, Error> {
        let vector = self.vector()?;
        unit(vector).ok_or_else(|| {
            let mut error = bad(
                &self.node.at,
                &self.key,
                &self.node.value,
                "a direction, not zero",
            );
            if let Error::BadValue { found, .. } = &mut error {
                *found = format!("[{}, {}, {}]", vector.x, vector.y, vector.z);
            }
            error
        })
    }

    /// The value as one of a few words.
    pub(crate) fn choice<T: Clone>(&self, choices: &[(&'static str, T)]) -> Result<T, Error> {
        let words = || choices.iter().map(|(word, _)| *word);
        let allowed = || {
            let quoted: Vec<String> = words().map(|word| format!("{word:?}")).collect();
            quoted.join(" or ")
        };
        let Value::Text(text) = &self.node.value else {
            return Err(bad(&self.node.at, &self.key, &self.node.value, &allowed()));
        };
        let chosen = choices.iter().find(|(word, _)| word == text);
        chosen
            .map(|(_, choice)| choice.clone())
            .ok_or_else(|| self.refused(&allowed(), hint(text, words())))
    }

    /// The error that this value is not as it has to be.
    pub(crate) fn refused(&self, allowed: &str, hint: String) -> Error {
        Error::BadValue {
            at: self.node.at.to_string(),
            key: self.key.clone(),
            found: self.node.value.described(),
            allowed: allowed.to_owned(),
            hint,
        }
    }
}

/// `vector` at length 1; `None` if it has no direction. Scaled first, so that no square under- or overflows.
pub(crate) fn unit(vector: DVec3) -> Option<DVec3> {
    let largest = vector.abs().max_element();
    if !largest.is_finite() || largest <= 0.0 {
        return None;
    }
    let scaled = vector / largest;
    Some(scaled / scaled.length())
}

fn bad(at: &Place, key: &str, found: &Value, allowed: &str) -> Error {
    Error::BadValue {
        at: at.to_string(),
        key: key.to_owned(),
        found: found.described(),
        allowed: allowed.to_owned(),
        hint: String::new(),
    }
}

#[cfg(test)]
mod tests;
