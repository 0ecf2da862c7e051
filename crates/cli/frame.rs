//! Where a map lies on paper: its shape and its axes.

use crate::number::triple;
use crate::svg::{Anchor, SMALL, line, path_data, text};
use crate::tick::Ticks;
use std::fmt::Write;

/// Space in pixels left of a map for its axis.
pub const LEFT: f64 = 62.0;
/// Space above it for the titles.
pub const ABOVE: f64 = 46.0;
/// Space below it for its axis.
const BELOW: f64 = 44.0;
/// Space between a map and its colour bar.
const GAP: f64 = 18.0;
/// Width of the colour bar.
pub const BAR: f64 = 16.0;
/// Space for the numbers of the colour bar.
const NUMBERS: f64 = 84.0;
/// Least height of the colour bar.
pub const BAR_HEIGHT: f64 = 110.0;
/// Least width of a panel, so that its title fits.
const LEAST_WIDTH: f64 = 300.0;

/// Largest size of a map where two stand side by side.
const BESIDE: [f64; 2] = [420.0, 520.0];
/// Largest size of a map where one stands above the other.
const ABOVE_EACH_OTHER: [f64; 2] = [760.0, 420.0];
/// From this ratio of width to height they stand above each other.
const WIDE: f64 = 1.6;

/// The parallelogram of a grid on paper: u to the right, v upwards.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Lengths of the sides in metres.
    pub sides: [f64; 2],
    /// Cosine and sine of the angle between them.
    pub angle: [f64; 2],
    /// Pixels a metre.
    pub scale: f64,
    /// Names of the two axes.
    pub names: [String; 2],
}

impl Frame {
    /// The frame of a grid with sides `u` and `v` in metres; `None` where it has no area.
    pub fn new(u: [f64; 3], v: [f64; 3]) -> Option<Self> {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let sides = [dot(u, u).sqrt(), dot(v, v).sqrt()];
        let cos = dot(u, v) / (sides[0] * sides[1]);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let mut frame = Self {
            sides,
            angle: [cos, sin],
            scale: 1.0,
            names: [
                format!("u in m, towards {}", direction(u, sides[0])),
                format!("v in m, towards {}", direction(v, sides[1])),
            ],
        };
        let room = if frame.is_wide() {
            ABOVE_EACH_OTHER
        } else {
            BESIDE
        };
        let [width, height] = frame.size();
        frame.scale = (room[0] / width).min(room[1] / height);
        (frame.scale.is_finite() && height > 0.0).then_some(frame)
    }

    /// Whether two maps stand better above each other than side by side.
    pub fn is_wide(&self) -> bool {
        let [width, height] = self.size();
        width > WIDE * height
    }

    /// Width and height on paper, in pixels.
    pub fn size(&self) -> [f64; 2] {
        let [cos, sin] = self.angle;
        let [u, v] = self.sides;
        [(u + v * cos.abs()) * self.scale, v * sin * self.scale]
    }

    /// Width and height of a panel, in pixels.
    pub fn panel(&self) -> [f64; 2] {
        let height = self.size()[1];
        [
            (self.bar() + BAR + NUMBERS).max(LEAST_WIDTH),
            ABOVE + height.max(BAR_HEIGHT) + BELOW,
        ]
    }

    /// Distance of the colour bar from the panel's left edge, in pixels.
    pub fn bar(&self) -> f64 {
        LEFT + self.size()[0] + GAP
    }

    /// The place on paper of a point at such shares of the two sides, from the panel's upper left corner.
    pub fn place(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.angle;
        let [u, v] = [a * self.sides[0], b * self.sides[1]];
        let lean = (-cos).max(0.0) * self.sides[1];
        [
            LEFT + (u + v * cos + lean) * self.scale,
            ABOVE + (self.sides[1] - v) * sin * self.scale,
        ]
    }

    /// Outline, ticks and names of the axes.
    pub fn axes(&self) -> String {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|at| self.place(at));
        let mut lines = format!("<path d=\"{}Z\"/>\n", path_data(&corners));
        let mut texts = String::new();
        for side in [0, 1] {
            let pixels = self.sides[side] * self.scale;
            let spacing = [46.0, 24.0][side];
            let most = ((pixels / spacing) as usize).clamp(1, 6);
            let ticks = Ticks::within(0.0, self.sides[side], most, 0.0);
            for tick in ticks.into_iter().flat_map(Ticks::iter) {
                let mut share = [0.0; 2];
                share[side] = tick.value / self.sides[side];
                let [x, y] = self.place(share);
                if side == 0 {
                    lines += &line([x, y], [x, y + 5.0]);
                    texts += &text([x, y + 17.0], SMALL, Anchor::Middle, &tick.text);
                } else {
                    lines += &line([x, y], [x - 5.0, y]);
                    texts += &text([x - 8.0, y + 4.0], SMALL, Anchor::End, &tick.text);
                }
            }
        }
        let [[x0, y0], [x1, _], _, [_, y3]] = corners;
        texts += &text(
            [0.5 * (x0 + x1), y0 + 35.0],
            SMALL,
            Anchor::Middle,
            &self.names[0],
        );
        let [x, y] = [14.0, 0.5 * (y0 + y3)];
        let name = text([0.0, 0.0], SMALL, Anchor::Middle, &self.names[1]);
        let _ = writeln!(
            texts,
            "<g transform=\"translate({x:.1} {y:.1}) rotate(-90)\">{name}</g>"
        );
        format!("<g fill=\"none\" stroke=\"#333\">\n{lines}</g>\n{texts}")
    }
}

/// A direction in words: `+x`, or its components.
fn direction(vector: [f64; 3], length: f64) -> String {
    let unit = vector.map(|component| component / length);
    for (component, axis) in unit.into_iter().zip(['x', 'y', 'z']) {
        if component.abs() > 1.0 - 1e-9 {
            return format!("{}{axis}", if component > 0.0 { '+' } else { '−' });
        }
    }
    triple(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_named_after_axes_where_they_can_be() {
        assert_eq!(direction([2.0, 0.0, 0.0], 2.0), "+x");
        assert_eq!(direction([0.0, -3.0, 0.0], 3.0), "−y");
        assert_eq!(direction([0.6, 0.8, 0.0], 1.0), "(0.6, 0.8, 0)");
    }

    #[test]
    fn maps_keep_their_true_shape() {
        let frame = Frame::new([6.0, 0.0, 0.0], [0.0, 5.0, 0.0]).expect("an area");
        let [width, height] = frame.size();
        assert!((width / height - 1.2).abs() < 1e-12);
        assert!(!frame.is_wide());
        assert!(Frame::new([12.0, 0.0, 0.0], [0.0, 1.0, 0.0]).is_some_and(|frame| frame.is_wide()));
    }

    #[test]
    fn a_grid_without_area_has_no_frame() {
        assert!(Frame::new([1.0, 0.0, 0.0], [2.0, 0.0, 0.0]).is_none());
        assert!(Frame::new([0.0; 3], [0.0, 1.0, 0.0]).is_none());
    }

    #[test]
    fn a_leaning_grid_begins_at_its_lower_left_corner() {
        let frame = Frame::new([1.0, 0.0, 0.0], [-0.6, 0.8, 0.0]).expect("an area");
        let [width, height] = frame.size();
        assert!((width / height - 2.0).abs() < 1e-12);
        let [x, _] = frame.place([0.0, 1.0]);
        assert!((x - LEFT).abs() < 1e-9);
    }
}
