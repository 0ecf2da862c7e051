//! Legends: what colours of a picture stand for.

use super::canvas::{Canvas, INK};
use super::cycle;
use super::font::{DIGIT, width};
use crate::colour::viridis;
use crate::tick::Ticks;

/// Rows of a picture to a pixel of a letter.
const ROWS_TO_A_PIXEL: usize = 320;

/// Side of a letter's pixel, at least: smaller ones are not read.
const SMALLEST: usize = 2;

/// Lengths in pixels of a letter.
const MARGIN: usize = 5;
const LINE: usize = 11;
const STROKE: usize = 13;
/// Least length of a bar.
const BAR: usize = 60;
/// Width of a bar of one dimension, and of two.
const NARROW: usize = 10;
const WIDE: usize = 22;

/// The legend of the degree of linear polarisation, for a picture of `rows` rows; its scale ends at the share `end`.
pub fn degree(rows: usize, end: f64) -> Canvas {
    let title = ["degree of", "linear", "polarisation", "%"];
    let mut legend = Legend::new(rows, &title, NARROW, 0);
    legend.bar(|_, up| viridis(up));
    let ticks = Ticks::within(0.0, 100.0 * end, 5, 0.0);
    for tick in ticks.into_iter().flat_map(Ticks::iter) {
        legend.mark(tick.value / (100.0 * end), &tick.text);
    }
    legend.canvas
}

/// The legend of the angle of linear polarisation; the colours are full from the degree `end` on.
pub fn angle(rows: usize, end: f64) -> Canvas {
    let title = ["angle of", "linear", "polarisation"];
    let mut legend = Legend::new(rows, &title, WIDE, 2);
    legend.bar(|across, up| {
        let twice = (360.0 * up).to_radians();
        cycle::colour(libm::cos(twice), libm::sin(twice), across)
    });
    for angle in [0, 45, 90, 135, 180] {
        let up = f64::from(angle) / 180.0;
        let text = format!("{angle}°");
        legend.mark(up, &text);
        legend.direction(up, f64::from(angle));
    }
    legend.below(&format!("{} %", (100.0 * end).round()));
    legend.canvas
}

/// A legend that is being drawn: title, bar with marks, and lines below.
struct Legend {
    canvas: Canvas,
    /// Side of a letter's pixel.
    scale: usize,
    /// The bar's top left.
    corner: [usize; 2],
    /// The bar's width and height.
    sides: [usize; 2],
}

impl Legend {
    /// The title and room for the rest; as high as the picture, or higher where that is too low.
    fn new(rows: usize, title: &[&str], bar_width: usize, lines_below: usize) -> Self {
        let scale = (rows / ROWS_TO_A_PIXEL).max(SMALLEST);
        let above = MARGIN + title.len() * LINE + LINE / 2;
        let below = MARGIN + lines_below * LINE + DIGIT / 2;
        let height = rows.max(scale * (above + BAR + below));
        let widest = title.iter().map(|line| width(line)).max().unwrap_or(0);
        let mut canvas = Canvas::new(scale * (widest + 2 * MARGIN), height);
        for (index, line) in title.iter().enumerate() {
            let y = scale * (MARGIN + index * LINE);
            canvas.text([scale * MARGIN, y], scale, line);
        }
        Self {
            canvas,
            scale,
            corner: [scale * MARGIN, scale * above],
            sides: [scale * bar_width, height - scale * (above + below)],
        }
    }

    /// Draws the bar by the colours at shares (across, up) of it, in a frame.
    fn bar(&mut self, colour: impl Fn(f64, f64) -> [u8; 3]) {
        let ([x, y], [width, height]) = (self.corner, self.sides);
        self.canvas
            .fill([x - 1, y - 1], [width + 2, height + 2], INK);
        for row in 0..height {
            let up = 1.0 - (row as f64 + 0.5) / height as f64;
            for column in 0..width {
                let across = (column as f64 + 0.5) / width as f64;
                self.canvas.set(x + column, y + row, colour(across, up));
            }
        }
    }

    /// The row at a share of the bar from below.
    fn place(&self, up: f64) -> usize {
        self.corner[1] + ((1.0 - up) * self.sides[1] as f64).round() as usize
    }

    /// A tick with a text beside the bar.
    fn mark(&mut self, up: f64, text: &str) {
        let (edge, row, scale) = (self.corner[0] + self.sides[0], self.place(up), self.scale);
        self.canvas
            .fill([edge, row - scale / 2], [3 * scale, scale], INK);
        let top = row.saturating_sub(DIGIT * scale / 2);
        self.canvas.text([edge + 5 * scale, top], scale, text);
    }

    /// A stroke in the direction that a mark stands for.
    fn direction(&mut self, up: f64, angle_deg: f64) {
        let x = self.corner[0] + self.sides[0] + (7 + 4 * 6 + STROKE / 2) * self.scale;
        let centre = [x, self.place(up)];
        let length = STROKE * self.scale;
        self.canvas.stroke(centre, length, self.scale, angle_deg);
    }

    /// What the bar's width stands for: from 0 to `end`.
    fn below(&mut self, end: &str) {
        let ([x, y], [bar, height], scale) = (self.corner, self.sides, self.scale);
        let top = y + height + (DIGIT / 2 + LINE / 2) * scale;
        self.canvas.text([x, top], scale, "0");
        self.canvas.text([x + bar - 5 * scale, top], scale, end);
        self.canvas.text([x, top + LINE * scale], scale, "degree");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(legend: &Canvas) -> (usize, usize) {
        let rows = (0..legend.height()).filter_map(|row| legend.row(row));
        let pixels: Vec<[u8; 3]> = rows.flatten().copied().collect();
        let ink = pixels.iter().filter(|pixel| **pixel == INK).count();
        let coloured = pixels.iter().filter(|[r, g, b]| r != g || g != b).count();
        (ink, coloured)
    }

    #[test]
    fn legends_have_letters_and_colours_and_are_at_least_as_high_as_the_picture() {
        for rows in [1, 64, 480, 1080] {
            for legend in [degree(rows, 0.2), angle(rows, 0.2)] {
                assert!(legend.height() >= rows);
                let (ink, coloured) = shares(&legend);
                assert!(ink > 1000 && coloured > 1000, "{rows}: {ink} {coloured}");
            }
        }
    }

    #[test]
    fn the_bar_of_angles_begins_and_ends_alike_and_fades_to_the_left() {
        let mut legend = Legend::new(480, &["angle"], WIDE, 2);
        legend.bar(|across, up| [(200.0 * across) as u8, (200.0 * up) as u8, 7]);
        let [x, y] = legend.corner;
        let row = |y| legend.canvas.row(y).expect("a row");
        assert!(row(y)[x][1] > 195 && row(y + legend.sides[1] - 1)[x][1] < 5);
        assert!(row(y)[x][0] < 10 && row(y)[x + legend.sides[0] - 1][0] > 190);
        assert_eq!(legend.place(0.0), y + legend.sides[1]);
        assert_eq!(legend.place(1.0), y);
    }
}
