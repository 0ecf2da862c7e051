//! Lines of OBJ and MTL files.
//!
//! The crate tobj knows neither joined lines nor comments behind values, refuses what is not UTF-8, and tells
//! no line numbers; so both formats pass through here first.

use super::LoadError;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// The lines of a text file, joined where one ends in a backslash. The text is UTF-8 or, where a line is not
/// valid as that, Latin-1: neither format says which.
pub(super) struct Lines<'a> {
    file: &'a Path,
    reader: BufReader<File>,
    bytes: Vec<u8>,
    text: String,
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
            text: String::new(),
            read: 0,
        }
    }

    /// The next line that is neither empty nor a comment; none at the end.
    pub(super) fn line(&mut self) -> Result<Option<Line<'_>>, LoadError> {
        let mut number = self.read + 1;
        while self.fill()? {
            if !self.text.is_empty() && !self.text.starts_with('#') {
                let (keyword, rest) = self
                    .text
                    .split_once(|c: char| c.is_ascii_whitespace())
                    .unwrap_or((&self.text, ""));
                return Ok(Some(Line {
                    number,
                    keyword,
                    rest: rest.trim(),
                }));
            }
            number = self.read + 1;
        }
        Ok(None)
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
            any |= read > 0;
            self.read += u64::from(read > 0);
            while matches!(self.bytes.last(), Some(b'\n' | b'\r')) {
                self.bytes.pop();
            }
            match self.bytes.last_mut() {
                Some(last) if *last == b'\\' => *last = b' ',
                _ => break,
            }
        }
        let bytes = self.bytes.trim_ascii();
        self.text.clear();
        match std::str::from_utf8(bytes) {
            Ok(text) => self.text.push_str(text),
            Err(_) => self.text.extend(bytes.iter().map(|&b| char::from(b))),
        }
        Ok(any)
    }
}

/// The words of a line up to a comment.
pub(super) fn words(rest: &str) -> impl Iterator<Item = &str> {
    rest.split_ascii_whitespace()
        .take_while(|word| !word.starts_with('#'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(u64, String, String)> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.obj");
        std::fs::write(&path, bytes).unwrap();
        let mut lines = Lines::of(&path, File::open(&path).unwrap());
        let mut seen = Vec::new();
        while let Some(found) = lines.line().unwrap() {
            seen.push(line(found.number, found.keyword, found.rest));
        }
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
