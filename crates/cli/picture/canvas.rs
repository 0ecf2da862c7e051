//! A small picture to draw on.

use super::font;

/// Black, for letters and lines.
pub const INK: [u8; 3] = [30, 30, 30];

/// White, for what is left empty.
pub const PAPER: [u8; 3] = [255, 255, 255];

/// A picture of 8-bit sRGB pixels, by rows from the top left; what is drawn beyond its edges is left out.
#[derive(Clone, Debug)]
pub struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    /// An empty one.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![PAPER; width * height],
        }
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// A row of pixels; `None` below the last.
    pub fn row(&self, row: usize) -> Option<&[[u8; 3]]> {
        self.pixels.chunks_exact(self.width.max(1)).nth(row)
    }

    /// Colours one pixel.
    pub fn set(&mut self, x: usize, y: usize, colour: [u8; 3]) {
        if x < self.width && y < self.height {
            self.pixels[y * self.width + x] = colour;
        }
    }

    /// Fills the rectangle with its top left at (x, y).
    pub fn fill(&mut self, [x, y]: [usize; 2], [width, height]: [usize; 2], colour: [u8; 3]) {
        for row in y..y + height {
            for column in x..x + width {
                self.set(column, row, colour);
            }
        }
    }

    /// Writes a text with the top of its digits at (x, y), each pixel of a letter `scale` wide.
    pub fn text(&mut self, [x, y]: [usize; 2], scale: usize, text: &str) {
        for (index, letter) in text.chars().enumerate() {
            let left = x + index * font::ADVANCE * scale;
            for (column, row) in font::pixels(letter) {
                self.fill([left + column * scale, y + row * scale], [scale; 2], INK);
            }
        }
    }

    /// Draws a straight stroke of `length` through the centre (x, y), at `angle_deg` counter-clockwise from the right.
    pub fn stroke(&mut self, [x, y]: [usize; 2], length: usize, thickness: usize, angle_deg: f64) {
        let (sin, cos) = (
            libm::sin(angle_deg.to_radians()),
            libm::cos(angle_deg.to_radians()),
        );
        let steps = 2 * length.max(1);
        for step in 0..=steps {
            let along = length as f64 * (step as f64 / steps as f64 - 0.5);
            // Rows count downwards.
            let at = |centre: usize, offset: f64| {
                let corner = centre as f64 + offset - 0.5 * thickness as f64;
                corner.round().max(0.0) as usize
            };
            self.fill(
                [at(x, along * cos), at(y, -along * sin)],
                [thickness; 2],
                INK,
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inked(canvas: &Canvas) -> Vec<(usize, usize)> {
        let places = (0..canvas.height()).flat_map(|y| (0..canvas.width()).map(move |x| (x, y)));
        let ink = |&(x, y): &(usize, usize)| canvas.row(y).expect("a row")[x] == INK;
        places.filter(ink).collect()
    }

    #[test]
    fn a_text_stands_where_it_is_put_and_may_run_over_the_edge() {
        let mut canvas = Canvas::new(12, 20);
        canvas.text([2, 3], 2, "-1");
        let marks = inked(&canvas);
        // The dash is the fourth row of its letter, from its second column on; of the 1, nothing is left.
        assert_eq!((marks.len(), marks[0], marks[11]), (12, (4, 9), (9, 10)));
        assert_eq!(canvas.row(20), None);
    }

    #[test]
    fn strokes_turn_counter_clockwise() {
        let mut canvas = Canvas::new(21, 21);
        canvas.stroke([10, 10], 12, 1, 45.0);
        let marks = inked(&canvas);
        assert!(marks.len() > 8);
        assert!(
            marks.iter().all(|(x, y)| (x + y).abs_diff(20) <= 1),
            "{marks:?}"
        );
        assert!(marks.iter().any(|(x, y)| *x > 12 && *y < 8), "{marks:?}");
    }
}
