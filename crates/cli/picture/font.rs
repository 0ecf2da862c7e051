//! Letters for legends, drawn for this program: five pixels wide, seven above the line and two below.

/// Width of a letter.
pub const WIDTH: usize = 5;

/// Height of a digit above the line.
pub const DIGIT: usize = 7;

/// From one letter to the next.
pub const ADVANCE: usize = 6;

/// The letters by rows from the top; rows left out are empty.
const LETTERS: [(char, &str); 41] = [
    ('0', ".###. #...# #..## #.#.# ##..# #...# .###."),
    ('1', "..#.. .##.. ..#.. ..#.. ..#.. ..#.. .###."),
    ('2', ".###. #...# ....# ...#. ..#.. .#... #####"),
    ('3', ".###. #...# ....# ..##. ....# #...# .###."),
    ('4', "...#. ..##. .#.#. #..#. ##### ...#. ...#."),
    ('5', "##### #.... ####. ....# ....# #...# .###."),
    ('6', "..##. .#... #.... ####. #...# #...# .###."),
    ('7', "##### ....# ...#. ..#.. ..#.. ..#.. ..#.."),
    ('8', ".###. #...# #...# .###. #...# #...# .###."),
    ('9', ".###. #...# #...# .#### ....# ...#. .##.."),
    ('.', "..... ..... ..... ..... ..... .##.. .##.."),
    (',', "..... ..... ..... ..... ..... .##.. ..#.. .#..."),
    ('-', "..... ..... ..... .###."),
    ('%', "##..# ##..# ...#. ..#.. .#... #..## #..##"),
    ('°', ".##.. #..#. #..#. .##.."),
    ('a', "..... ..... .###. ....# .#### #...# .####"),
    ('b', "#.... #.... #.##. ##..# #...# #...# ####."),
    ('c', "..... ..... .###. #...# #.... #...# .###."),
    ('d', "....# ....# .##.# #..## #...# #...# .####"),
    ('e', "..... ..... .###. #...# ##### #.... .###."),
    ('f', "..##. .#..# .#... ###.. .#... .#... .#..."),
    ('g', "..... ..... .#### #...# #...# #...# .#### ....# .###."),
    ('h', "#.... #.... #.##. ##..# #...# #...# #...#"),
    ('i', "..#.. ..... .##.. ..#.. ..#.. ..#.. .###."),
    ('j', "...#. ..... ..##. ...#. ...#. ...#. ...#. #..#. .##.."),
    ('k', "#.... #.... #..#. #.#.. ##... #.#.. #..#."),
    ('l', ".##.. ..#.. ..#.. ..#.. ..#.. ..#.. .###."),
    ('m', "..... ..... ##.#. #.#.# #.#.# #.#.# #.#.#"),
    ('n', "..... ..... #.##. ##..# #...# #...# #...#"),
    ('o', "..... ..... .###. #...# #...# #...# .###."),
    ('p', "..... ..... ####. #...# #...# #...# ####. #.... #...."),
    ('q', "..... ..... .#### #...# #...# #...# .#### ....# ....#"),
    ('r', "..... ..... #.##. ##..# #.... #.... #...."),
    ('s', "..... ..... .#### #.... .###. ....# ####."),
    ('t', ".#... .#... ###.. .#... .#... .#..# ..##."),
    ('u', "..... ..... #...# #...# #...# #..## .##.#"),
    ('v', "..... ..... #...# #...# #...# .#.#. ..#.."),
    ('w', "..... ..... #...# #.#.# #.#.# #.#.# .#.#."),
    ('x', "..... ..... #...# .#.#. ..#.. .#.#. #...#"),
    ('y', "..... ..... #...# #...# #...# #..## .##.# ....# .###."),
    ('z', "..... ..... ##### ...#. ..#.. .#... #####"),
];

/// A box, for a letter that is not there.
const MISSING: &str = "##### #...# #...# #...# #...# #...# #####";

/// Pixels (column, row) of a letter, from its top left.
pub fn pixels(letter: char) -> impl Iterator<Item = (usize, usize)> {
    let found = LETTERS.iter().find(|(name, _)| *name == letter);
    let rows = match found {
        Some((_, rows)) => rows,
        None if letter == ' ' => "",
        None => MISSING,
    };
    rows.split(' ').enumerate().flat_map(|(row, marks)| {
        let inked = marks.bytes().enumerate().filter(|(_, mark)| *mark == b'#');
        inked.map(move |(column, _)| (column, row))
    })
}

/// Width of a text, without the space after its last letter.
pub fn width(text: &str) -> usize {
    (text.chars().count() * ADVANCE).saturating_sub(ADVANCE - WIDTH)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a letter, with what hangs below the line.
    const HEIGHT: usize = 9;

    #[test]
    fn every_letter_fits_its_box_and_looks_like_no_other() {
        for (index, (letter, rows)) in LETTERS.iter().enumerate() {
            assert!(rows.split(' ').count() <= HEIGHT, "{letter}");
            assert!(rows.split(' ').all(|row| row.len() == WIDTH), "{letter}");
            assert!(pixels(*letter).count() > 2, "{letter}");
            let same = |other: &&(char, &str)| other.1 == *rows;
            assert_eq!(LETTERS.iter().filter(same).count(), 1, "{letter}");
            assert_eq!(
                LETTERS.iter().position(|(name, _)| name == letter),
                Some(index)
            );
        }
    }

    #[test]
    fn a_space_is_empty_and_an_unknown_letter_a_box() {
        assert_eq!(pixels(' ').count(), 0);
        assert_eq!(pixels('Ω').count(), 20);
        assert_eq!((width(""), width("1"), width("100")), (0, 5, 17));
    }
}
