//! Where in a scene file, or on the command line, something is written.

use std::fmt;
use std::sync::Arc;

/// Place of a key or a value; prints as `scenes/room.toml:12:9` or `--set material.plaster.a=2`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    File {
        file: Arc<str>,
        line: usize,
        column: usize,
    },
    Override(Arc<str>),
}

impl Place {
    /// Place of the byte at `offset` of a file's `text`; lines and columns count from 1, columns in characters.
    pub(crate) fn in_text(file: &Arc<str>, text: &str, offset: usize) -> Self {
        let mut end = offset.min(text.len());
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &text[..end];
        let start_of_line = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self::File {
            file: Arc::clone(file),
            line: before.matches('\n').count() + 1,
            column: before[start_of_line..].chars().count() + 1,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { file, line, column } => write!(f, "{file}:{line}:{column}"),
            Self::Override(text) => write!(f, "--set {text}"),
        }
    }
}

/// A value and the place it is written at.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Located<T> {
    pub(crate) value: T,
    pub(crate) at: Place,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let file: Arc<str> = "room.toml".into();
        let text = "a = 1\nφ = 2";
        let two = text.find('2').unwrap();
        assert_eq!(Place::in_text(&file, text, 0).to_string(), "room.toml:1:1");
        assert_eq!(
            Place::in_text(&file, text, two).to_string(),
            "room.toml:2:5"
        );
        assert_eq!(
            Place::in_text(&file, text, 999).to_string(),
            "room.toml:2:6"
        );
    }
}
