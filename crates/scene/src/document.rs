//! A TOML document as a tree in which every key and value knows its place.

use crate::error::Error;
use crate::place::Place;
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use toml::de::{DeTable, DeValue};

/// A value as written.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) at: Place,
    pub(crate) value: Value,
}

/// What a value is.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(i128),
    Number(f64),
    Flag(bool),
    Date(String),
    List(Vec<Node>),
    /// In the order of writing.
    Table(Vec<Entry>),
}

/// A key with its value.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) at: Place,
    pub(crate) node: Node,
}

impl Node {
    /// Reads a whole document.
    pub(crate) fn read(path: &Path) -> Result<Self, Error> {
        let unreadable = |reason: String| Error::Unreadable {
            path: path.display().to_string(),
            reason,
        };
        if path.is_dir() {
            return Err(unreadable("is a directory, not a file (.toml)".into()));
        }
        let bytes = std::fs::read(path).map_err(|error| {
            unreadable(match error.kind() {
                std::io::ErrorKind::NotFound => "there is no such file".into(),
                _ => format!("cannot be read: {error}"),
            })
        })?;
        let file: Arc<str> = path.display().to_string().into();
        match std::str::from_utf8(&bytes) {
            Ok(text) => Self::document(&file, text),
            Err(error) => {
                let valid = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
                Err(Error::Syntax {
                    at: Place::in_text(&file, &valid, valid.len()).to_string(),
                    message: "a TOML file is UTF-8 text, this byte is not".into(),
                })
            }
        }
    }

    /// Parses the `text` of a whole document that is called `file` in messages.
    pub(crate) fn document(file: &Arc<str>, text: &str) -> Result<Self, Error> {
        // A byte order mark is no part of the text; toml skips it and so must the counting of columns.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let place = |offset| Place::in_text(file, text, offset);
        let table = DeTable::parse(text).map_err(|error| Error::Syntax {
            at: place(error.span().map_or(0, |span| span.start)).to_string(),
            message: error.message().to_owned(),
        })?;
        Ok(Self {
            at: place(0),
            value: entries(table.into_inner(), &place)?,
        })
    }

    /// Parses one value given on the command line; a bare word that is no TOML value is taken as a string.
    pub(crate) fn value(text: &str, at: &Place) -> Result<Self, Error> {
        let text = text.trim();
        let place = |_: usize| at.clone();
        match DeValue::parse(text) {
            Ok(value) => node(value.into_inner(), at.clone(), &place),
            Err(_) if is_word(text) => Ok(Self {
                at: at.clone(),
                value: Value::Text(text.to_owned()),
            }),
            Err(error) => Err(Error::Syntax {
                at: at.to_string(),
                message: error.message().to_owned(),
            }),
        }
    }
}

/// Whether a text that is no TOML value can only be meant as a string.
fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || "./_".contains(c))
        && !text.contains(['"', '\'', '[', ']', '{', '}', '=', '#', '\n', ','])
}

fn entries(table: DeTable<'_>, place: &dyn Fn(usize) -> Place) -> Result<Value, Error> {
    let mut written: Vec<_> = table.into_iter().collect();
    written.sort_by_key(|(key, _)| key.span().start);
    let mut entries = Vec::with_capacity(written.len());
    for (key, value) in written {
        let at = place(value.span().start);
        entries.push(Entry {
            at: place(key.span().start),
            key: key.into_inner().into_owned(),
            node: node(value.into_inner(), at, place)?,
        });
    }
    Ok(Value::Table(entries))
}

fn node(value: DeValue<'_>, at: Place, place: &dyn Fn(usize) -> Place) -> Result<Node, Error> {
    let too_large = |found: &str| Error::BadValue {
        at: at.to_string(),
        key: "a number".into(),
        found: found.to_owned(),
        allowed: "small enough for a computer to hold".into(),
        hint: String::new(),
    };
    let value = match value {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Boolean(flag) => Value::Flag(flag),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Integer(integer) => Value::Integer(
            i128::from_str_radix(integer.as_str(), integer.radix())
                .map_err(|_| too_large(integer.as_str()))?,
        ),
        DeValue::Float(float) => match float.as_str().parse::<f64>() {
            Ok(number) if !number.is_infinite() || float.as_str().contains("inf") => {
                Value::Number(number)
            }
            _ => return Err(too_large(float.as_str())),
        },
        DeValue::Array(items) => Value::List(
            items
                .into_iter()
                .map(|item| {
                    let at = place(item.span().start);
                    node(item.into_inner(), at, place)
                })
                .collect::<Result<_, _>>()?,
        ),
        DeValue::Table(table) => entries(table, place)?,
    };
    Ok(Node { at, value })
}

impl Value {
    /// The value in words, for messages.
    pub(crate) fn described(&self) -> String {
        match self {
            Self::Text(text) => format!("the string {text:?}"),
            Self::Integer(integer) => integer.to_string(),
            Self::Number(number) => number.to_string(),
            Self::Flag(flag) => flag.to_string(),
            Self::Date(date) => format!("the date {date}"),
            Self::List(items) => format!("a list of {}", items.len()),
            Self::Table(_) => "a table".into(),
        }
    }
}

impl fmt::Display for Value {
    /// The value as it may be written, text without its quotes.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let quoted = |node: &Node| match &node.value {
            Self::Text(text) => format!("{text:?}"),
            other => other.to_string(),
        };
        match self {
            Self::Text(text) | Self::Date(text) => f.write_str(text),
            Self::Integer(integer) => write!(f, "{integer}"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Flag(flag) => write!(f, "{flag}"),
            Self::List(items) => {
                let items: Vec<String> = items.iter().map(quoted).collect();
                write!(f, "[{}]", items.join(", "))
            }
            Self::Table(entries) => {
                let entry = |entry: &Entry| format!("{} = {}", entry.key, quoted(&entry.node));
                let entries: Vec<String> = entries.iter().map(entry).collect();
                write!(f, "{{ {} }}", entries.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Node, Error> {
        Node::document(&"room.toml".into(), text)
    }

    #[test]
    fn entries_keep_the_order_of_writing() {
        let document = parse("z = 1\na = 2\n[m.z]\nq = 1\n[m.b]\n").unwrap();
        let Value::Table(entries) = &document.value else {
            panic!("a document is a table")
        };
        let keys: Vec<&str> = entries.iter().map(|entry| entry.key.as_str()).collect();
        assert_eq!(keys, ["z", "a", "m"]);
        let Value::Table(inner) = &entries[2].node.value else {
            panic!("m is a table")
        };
        assert_eq!(inner[0].key, "z");
        assert_eq!(inner[1].at.to_string(), "room.toml:5:4");
    }

    #[test]
    fn a_syntax_error_has_a_place() {
        let error = parse("[scene]\nname = \n").unwrap_err().to_string();
        assert!(error.starts_with("room.toml:2:"), "{error}");
        assert!(error.contains("not valid TOML"), "{error}");
    }

    #[test]
    fn infinity_is_a_number_and_an_overflow_is_an_error() {
        let at = Place::Override("x".into());
        assert!(
            matches!(Node::value("inf", &at).unwrap().value, Value::Number(n) if n.is_infinite())
        );
        let error = Node::value("1e999", &at).unwrap_err().to_string();
        assert!(error.contains("1e999"), "{error}");
    }

    #[test]
    fn a_bare_word_on_the_command_line_is_a_string() {
        let at = Place::Override("run.model=scalar".into());
        assert!(
            matches!(Node::value("scalar", &at).unwrap().value, Value::Text(t) if t == "scalar")
        );
        assert!(matches!(
            Node::value("desk.pts", &at).unwrap().value,
            Value::Text(_)
        ));
        assert!(Node::value("[1, 2", &at).is_err());
        assert!(Node::value("", &at).is_err());
    }

    #[test]
    fn a_file_that_is_no_scene_file_is_refused_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let message = |path: &Path| Node::read(path).unwrap_err().to_string();
        assert!(message(folder.path()).contains("is a directory"));
        assert!(message(&folder.path().join("none.toml")).contains("no such file"));
        let latin = folder.path().join("latin.toml");
        std::fs::write(&latin, b"[scene]\nname = \"B\xfcro\"\n").unwrap();
        let message = message(&latin);
        assert!(
            message.contains("latin.toml:2:10") && message.contains("UTF-8"),
            "{message}"
        );
    }
}
