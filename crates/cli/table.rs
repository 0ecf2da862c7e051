//! Columns that line up.

/// Which edge a column lines up at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// Words.
    Left,
    /// Numbers.
    Right,
}

/// A column of words.
pub fn left(title: &str) -> (String, Edge) {
    (title.to_owned(), Edge::Left)
}

/// A column of numbers.
pub fn right(title: &str) -> (String, Edge) {
    (title.to_owned(), Edge::Right)
}

/// A table of text.
#[derive(Debug)]
pub struct Table {
    columns: Vec<(String, Edge)>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with the given columns and no rows.
    pub fn new(columns: impl IntoIterator<Item = (String, Edge)>) -> Self {
        Self {
            columns: columns.into_iter().collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row; cells that it lacks are empty.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let mut cells: Vec<String> = cells.into_iter().take(self.columns.len()).collect();
        cells.resize(self.columns.len(), String::new());
        self.rows.push(cells);
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table as lines, each after `indent`.
    pub fn text(&self, indent: &str) -> String {
        let head: Vec<String> = self
            .columns
            .iter()
            .map(|(title, _)| title.clone())
            .collect();
        let lines = || std::iter::once(&head).chain(&self.rows);
        let widths: Vec<usize> = (0..head.len())
            .map(|column| lines().map(|row| width(&row[column])).max().unwrap_or(0))
            .collect();
        let mut text = String::new();
        for row in lines() {
            let mut line = indent.to_owned();
            for ((cell, &(_, edge)), &full) in row.iter().zip(&self.columns).zip(&widths) {
                let padding = " ".repeat(full - width(cell));
                match edge {
                    Edge::Left => line += &format!("{cell}{padding}  "),
                    Edge::Right => line += &format!("{padding}{cell}  "),
                }
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }
}

/// Characters of a text; those that a terminal draws two wide do not occur in numbers.
fn width(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_line_up_left_and_numbers_right() {
        let mut table = Table::new([
            ("sensor".to_owned(), Edge::Left),
            ("mean ± se".to_owned(), Edge::Right),
            ("note".to_owned(), Edge::Left),
        ]);
        table.row(["a".into(), "1.0 ± 0.1".into(), "x".into()]);
        table.row(["longer name".into(), "12.0 ± 0.1".into()]);
        assert_eq!(
            table.text("  "),
            "  sensor        mean ± se  note\n  a             1.0 ± 0.1  x\n  longer name  12.0 ± 0.1\n"
        );
    }
}
