//! Lines of OBJ and MTL files.
//!
//! The crate tobj, which reads both formats, joins no lines, takes no comments behind numbers, refuses what is not
//! UTF-8, and says no line in its errors. So it is given what has passed here.

use super::LoadError;
use std::borrow::Cow;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// The lines of a text file, joined where one ends in a backslash. The text is UTF-8 or, where a line is not
/// valid as that, Latin-1: neither format says which.
pub(super) struct Lines<'a> {
    file: &'a Path,
    reader: BufReader<File>,
    bytes: Vec<u8>,
    read: u64,
}

/// One line.
pub(super) struct Line<'a> {
    /// Number of the line in the file, from 1; of the first one where several are joined.
    pub number: u64,
    /// Its first word.
    pub keyword: &'a str,
    /// What follows the first word.
    pub rest: &'a str,
}

impl<'a> Lines<'a> {
    pub(super) fn of(file: &'a Path, opened: File) -> Self {
        Self {
            file,
            reader: BufReader::new(opened),
            bytes: Vec::new(),
            read: 0,
        }
    }

    /// Calls `visit` with every line that is neither empty nor a comment.
    pub(super) fn visit(
        mut self,
        mut visit: impl FnMut(Line) -> Result<(), LoadError>,
    ) -> Result<(), LoadError> {
        loop {
            let number = self.read + 1;
            if !self.fill()? {
                return Ok(());
            }
            let text = decoded(self.bytes.trim_ascii());
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            let (keyword, rest) = text
                .split_once(|c: char| c.is_ascii_whitespace())
                .unwrap_or((&text, ""));
            visit(Line {
                number,
                keyword,
                rest: rest.trim(),
            })?;
        }
    }

    /// Reads one line and those joined to it; false at the end of the file.
    fn fill(&mut self) -> Result<bool, LoadError> {
        self.bytes.clear();
        let mut any = false;
        loop {
            let read = self
                .reader
                .read_until(b'\n', &mut self.bytes)
                .map_err(|reason| LoadError::unreadable(self.file, reason))?;
            if read == 0 {
                return Ok(any);
            }
            any = true;
            self.read += 1;
            while matches!(self.bytes.last(), Some(b'\n' | b'\r')) {
                self.bytes.pop();
            }
            match self.bytes.last_mut() {
                Some(last) if *last == b'\\' => *last = b' ',
                _ => return Ok(true),
            }
        }
    }
}

/// The words of a line up to a comment.
pub(super) fn words(rest: &str) -> impl Iterator<Item = &str> {
    rest.split_ascii_whitespace()
        .take_while(|word| !word.starts_with('#'))
}

/// UTF-8, or Latin-1 where it is not valid UTF-8.
fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(u64, String, String)> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.obj");
        std::fs::write(&path, bytes).unwrap();
        let mut seen = Vec::new();
        Lines::of(&path, File::open(&path).unwrap())
            .visit(|line| {
                seen.push((line.number, line.keyword.to_owned(), line.rest.to_owned()));
                Ok(())
            })
            .unwrap();
        seen
    }

    fn line(number: u64, keyword: &str, rest: &str) -> (u64, String, String) {
        (number, keyword.to_owned(), rest.to_owned())
    }

    #[test]
    fn a_backslash_joins_lines_and_the_numbers_stay_those_of_the_file() {
        assert_eq!(
            lines(b"# c\n\nf 1 2 \\\r\n 3\r\n\tv 1\t2 3 \nend"),
            [
                line(3, "f", "1 2   3"),
                line(5, "v", "1\t2 3"),
                line(6, "end", "")
            ]
        );
    }

    #[test]
    fn names_may_be_utf8_or_latin1_and_hold_spaces() {
        assert_eq!(lines("o Büro 2\n".as_bytes()), lines(b"o B\xfcro 2\n"),);
        assert_eq!(lines(b"o B\xfcro 2\n"), [line(1, "o", "Büro 2")]);
    }

    #[test]
    fn a_file_that_ends_in_a_backslash_or_holds_nothing_has_an_end() {
        assert_eq!(lines(b"f 1 \\"), [line(1, "f", "1")]);
        assert_eq!(lines(b""), []);
        assert_eq!(lines(b"\\\n\\\n"), []);
    }

    #[test]
    fn numbers_end_where_a_comment_begins() {
        assert_eq!(words(" 1  2 #3 4").collect::<Vec<_>>(), ["1", "2"]);
    }
}
