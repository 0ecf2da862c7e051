//! A chart: a box with an axis of numbers along its foot and one along its left side.

use crate::svg::{Anchor, SMALL, line, text};
use crate::tick::Ticks;

/// Room beside the box: left, above, right and below, in pixels.
const ROOM: [f64; 4] = [76.0, 34.0, 24.0, 52.0];

/// Numbers along an axis, at most.
const STEPS: usize = 6;

/// One axis.
#[derive(Clone, Debug)]
pub struct Scaled {
    /// What it shows.
    pub title: String,
    low: f64,
    high: f64,
}

impl Scaled {
    /// An axis that holds all values with a little room about them.
    pub fn over(title: String, values: impl Iterator<Item = f64> + Clone) -> Self {
        let low = values.clone().fold(f64::INFINITY, f64::min);
        let high = values.fold(f64::NEG_INFINITY, f64::max);
        let room = if high > low {
            0.06 * (high - low)
        } else {
            0.1 * high.abs().max(f64::MIN_POSITIVE)
        };
        Self {
            title,
            low: low - room,
            high: high + room,
        }
    }

    /// Its ends.
    pub fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}

/// A chart of a certain size.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Title above the box.
    pub title: String,
    /// Axis along the foot.
    pub x: Scaled,
    /// Axis along the left side.
    pub y: Scaled,
    /// Sides of the box, in pixels.
    pub sides: [f64; 2],
}

impl Chart {
    /// Width and height with everything about the box, in pixels.
    pub fn size(&self) -> [f64; 2] {
        let [left, above, right, below] = ROOM;
        let [width, height] = self.sides;
        [left + width + right, above + height + below]
    }

    /// Where a point lies, in pixels from the chart's upper left corner.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [width, height] = self.sides;
        let [left, above, ..] = ROOM;
        [
            left + width * self.x.share(x),
            above + height * (1.0 - self.y.share(y)),
        ]
    }

    /// The box with its axes and titles.
    pub fn axes(&self) -> String {
        let [left, above, ..] = ROOM;
        let [width, height] = self.sides;
        let foot = above + height;
        let mut drawing = text([left, above - 12.0], 14.0, Anchor::Start, &self.title);
        drawing += "<g stroke=\"#111\" fill=\"none\">\n";
        drawing += &format!(
            "<rect x=\"{left:.1}\" y=\"{above:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>\n"
        );
        let mut numbers = String::new();
        let ticks = |axis: &Scaled| Ticks::within(axis.low, axis.high, STEPS, 0.0);
        for tick in ticks(&self.x).into_iter().flat_map(Ticks::iter) {
            let [x, _] = self.place([tick.value, self.y.low]);
            drawing += &line([x, foot], [x, foot + 5.0]);
            numbers += &text([x, foot + 18.0], SMALL, Anchor::Middle, &tick.text);
        }
        for tick in ticks(&self.y).into_iter().flat_map(Ticks::iter) {
            let [_, y] = self.place([self.x.low, tick.value]);
            drawing += &line([left - 5.0, y], [left, y]);
            numbers += &text([left - 8.0, y + 4.0], SMALL, Anchor::End, &tick.text);
        }
        drawing += "</g>\n";
        drawing += &numbers;
        drawing += &text(
            [left + 0.5 * width, foot + 38.0],
            12.0,
            Anchor::Middle,
            &self.x.title,
        );
        let middle = [-(above + 0.5 * height), 16.0];
        drawing += &format!(
            "<g transform=\"rotate(-90)\">{}</g>\n",
            text(middle, 12.0, Anchor::Middle, &self.y.title).trim_end()
        );
        drawing
    }
}
