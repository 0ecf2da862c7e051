//! Values from the command line or a study, put into the scene file before it is read.

use crate::document::{Entry, Node, Value};
use crate::error::Error;
use crate::nearest::hint;
use crate::place::Place;
use std::fmt;

/// One value in place of the scene file's: `--set material.plaster.a=0.3`.
///
/// A segment of the key that holds a dot stands in quotes: `material."Wall.001".rho`.
/// An entry of a list is addressed by its index or, where it has one, its name: `shape.0.radius`,
/// `sensor.desk.frame`, `mesh.0.file`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Dotted path of the key.
    pub key: String,
    /// The value as TOML; a bare word that is none counts as a string.
    pub value: String,
}

impl Override {
    /// Puts the value into the document, over the one that is there.
    pub(crate) fn apply(&self, document: &mut Node) -> Result<(), Error> {
        let at = Place::Override(format!("{}={}", self.key, self.value).into());
        let key = Key::parse(&self.key, &at)?;
        let value = Node::value(&self.value, &at)?;
        key.put(value, &at, document)
    }
}

/// A dotted key of the scene file, as its segments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Key(Vec<String>);

impl Key {
    /// Reads a dotted key that stands at `at`.
    pub(crate) fn parse(text: &str, at: &Place) -> Result<Self, Error> {
        segments(text).map(Self).ok_or_else(|| Error::Override {
            at: at.to_string(),
            reason: format!("{text:?} is no dotted key"),
            hint: String::new(),
        })
    }

    /// The key with one more segment, taken as it is.
    pub(crate) fn below(&self, segment: &str) -> Self {
        let mut segments = self.0.clone();
        segments.push(segment.to_owned());
        Self(segments)
    }

    /// The segments.
    pub(crate) fn segments(&self) -> Vec<&str> {
        self.0.iter().map(String::as_str).collect()
    }

    /// Puts a value into the document, over the one that is there; `at` is where the key stands.
    pub(crate) fn put(&self, value: Node, at: &Place, document: &mut Node) -> Result<(), Error> {
        let mut node = document;
        for (depth, segment) in self.0.iter().enumerate() {
            let so_far = self.0[..depth].join(".");
            node = step(node, segment, at).map_err(|(reason, hint)| Error::Override {
                at: at.to_string(),
                reason: format!("{so_far:?} {reason}"),
                hint,
            })?;
        }
        *node = value;
        Ok(())
    }

    /// The value in the document, where there is one.
    pub(crate) fn find<'a>(&self, document: &'a Node) -> Option<&'a Node> {
        self.0
            .iter()
            .try_fold(document, |node, segment| match &node.value {
                Value::Table(entries) => {
                    let entry = entries.iter().find(|entry| entry.key == *segment)?;
                    Some(&entry.node)
                }
                Value::List(items) => {
                    let named = items
                        .iter()
                        .find(|item| name(item).as_deref() == Some(segment.as_str()));
                    named.or_else(|| items.get(segment.parse::<usize>().ok()?))
                }
                _ => None,
            })
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (depth, segment) in self.0.iter().enumerate() {
            let dot = if depth > 0 { "." } else { "" };
            match segment.contains('.') {
                true => write!(f, "{dot}\"{segment}\"")?,
                false => write!(f, "{dot}{segment}")?,
            }
        }
        Ok(())
    }
}

/// Parts of a dotted key, quotes taken off; `None` if it has an empty part or an open quote.
fn segments(key: &str) -> Option<Vec<String>> {
    let mut segments = vec![String::new()];
    let mut quote = None;
    let mut quoted = false;
    for c in key.trim().chars() {
        match (quote, c) {
            (Some(open), _) if c == open => quote = None,
            (None, '"' | '\'') => {
                quote = Some(c);
                quoted = true;
            }
            (None, '.') => {
                if segments.last().is_none_or(String::is_empty) && !quoted {
                    return None;
                }
                segments.push(String::new());
                quoted = false;
            }
            _ => segments.last_mut()?.push(c),
        }
    }
    let complete = quote.is_none() && (quoted || !segments.last()?.is_empty());
    complete.then_some(segments)
}

/// The node below `node` that `segment` names; a table gets the key if it lacks it.
fn step<'a>(
    node: &'a mut Node,
    segment: &str,
    at: &Place,
) -> Result<&'a mut Node, (String, String)> {
    let nothing = || String::new();
    match &mut node.value {
        Value::Table(entries) => {
            let index = entries
                .iter()
                .position(|entry| entry.key == segment)
                .unwrap_or_else(|| {
                    entries.push(Entry {
                        key: segment.to_owned(),
                        at: at.clone(),
                        node: Node {
                            at: at.clone(),
                            value: Value::Table(Vec::new()),
                        },
                    });
                    entries.len() - 1
                });
            Ok(&mut entries[index].node)
        }
        Value::List(items) => {
            let names: Vec<String> = items.iter().filter_map(name).collect();
            let named = items
                .iter()
                .position(|item| name(item).as_deref() == Some(segment));
            let index = match (named, segment.parse::<usize>()) {
                (Some(index), _) => index,
                (None, Ok(index)) if index < items.len() => index,
                (None, Ok(index)) => {
                    let reason = format!("has {} entries, counted from 0: no {index}", items.len());
                    return Err((reason, nothing()));
                }
                (None, Err(_)) => {
                    let reason = format!("has no entry called {segment:?}");
                    return Err((reason, hint(segment, names.iter().map(String::as_str))));
                }
            };
            Ok(&mut items[index])
        }
        other => {
            let reason = format!("is {}, with no key {segment:?} in it", other.described());
            Err((reason, nothing()))
        }
    }
}

/// The `name` of an entry of a list of tables.
fn name(item: &Node) -> Option<String> {
    let Value::Table(entries) = &item.value else {
        return None;
    };
    let entry = entries.iter().find(|entry| entry.key == "name")?;
    match &entry.node.value {
        Value::Text(text) => Some(text.clone()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: &str = "[material.\"Wall.001\"]\nrho = 0.5\n[[shape]]\nkind = \"box\"\n\
        [[sensor]]\nname = \"desk\"\npoints = [[0, 0, 1]]\n";

    fn apply(key: &str, value: &str) -> Result<Node, String> {
        let mut document = Node::document(&"room.toml".into(), ROOM).unwrap();
        let entry = Override {
            key: key.into(),
            value: value.into(),
        };
        entry
            .apply(&mut document)
            .map_err(|error| error.to_string())?;
        Ok(document)
    }

    fn found(document: &Node, path: &[&str]) -> String {
        let mut node = document.clone();
        for segment in path {
            let at = Place::Override("test".into());
            node = step(&mut node, segment, &at).unwrap().clone();
        }
        node.value.described()
    }

    #[test]
    fn a_quoted_segment_may_hold_a_dot() {
        let document = apply("material.\"Wall.001\".rho", "0.25").unwrap();
        assert_eq!(found(&document, &["material", "Wall.001", "rho"]), "0.25");
    }

    #[test]
    fn a_key_is_written_as_it_is_read_and_finds_its_value() {
        let document = apply("sensor.desk.frame", "fixed").unwrap();
        let at = Place::Override("test".into());
        for (text, expected) in [
            ("material.\"Wall.001\".rho", Some("0.5")),
            ("sensor.desk.frame", Some("the string \"fixed\"")),
            ("sensor.0.points.0.2", Some("1")),
            ("shape.1.kind", None),
            ("material.Wall.rho", None),
        ] {
            let key = Key::parse(text, &at).unwrap();
            assert_eq!(key.to_string(), text);
            let found = key.find(&document).map(|node| node.value.described());
            assert_eq!(found.as_deref(), expected);
        }
    }

    #[test]
    fn lists_are_addressed_by_index_or_name() {
        let document = apply("sensor.desk.frame", "fixed").unwrap();
        let expected = "the string \"fixed\"";
        assert_eq!(found(&document, &["sensor", "0", "frame"]), expected);
        let document = apply("sensor.0.points.0.2", "0.75").unwrap();
        assert_eq!(
            found(&document, &["sensor", "desk", "points", "0", "2"]),
            "0.75"
        );
    }

    #[test]
    fn an_absent_table_is_made() {
        let document = apply("run.samples", "64").unwrap();
        assert_eq!(found(&document, &["run", "samples"]), "64");
    }

    #[test]
    fn an_unknown_name_in_a_list_tells_the_nearest() {
        let error = apply("sensor.dsek.frame", "fixed").unwrap_err();
        assert!(
            error.starts_with("--set sensor.dsek.frame=fixed: "),
            "{error}"
        );
        assert!(error.contains("\"desk\""), "{error}");
    }

    #[test]
    fn an_index_beyond_the_list_tells_its_length() {
        let error = apply("shape.7.kind", "disc").unwrap_err();
        assert!(
            error.contains("has 1 entries") && error.contains("no 7"),
            "{error}"
        );
    }

    #[test]
    fn a_number_has_no_keys() {
        let error = apply("material.\"Wall.001\".rho.x", "1").unwrap_err();
        assert!(error.contains("is 0.5, with no key \"x\""), "{error}");
    }

    #[test]
    fn a_key_without_parts_is_refused() {
        for key in ["", "material..rho", "a.", "material.\"Wall"] {
            assert!(
                apply(key, "1").unwrap_err().contains("no dotted key"),
                "{key}"
            );
        }
    }
}
