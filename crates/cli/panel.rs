//! One map of a plan: colours, contour lines, axes and legend.

use crate::colour::{hexadecimal, viridis};
use crate::field::Field;
use crate::frame::{ABOVE, BAR, BAR_HEIGHT, Frame, LEFT};
use crate::scale::Scale;
use crate::svg::{Anchor, SMALL, line, path_data, text, text_width};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Steps of colour.
const SHADES: f64 = 127.0;
/// Side of the smallest patch of colour, in pixels.
const PATCH: f64 = 6.0;

/// What one map shows.
#[derive(Debug)]
pub struct Map {
    /// Title above the map.
    pub title: String,
    /// Unit above the legend.
    pub unit: String,
    /// The values.
    pub field: Field,
    /// Their colours.
    pub scale: Scale,
    /// Typical standard error of a value: contour lines closer than twice this would draw noise.
    pub noise: f64,
}

/// A map or, in its place, a sentence.
#[derive(Debug)]
pub enum Panel {
    /// A map.
    Map(Map),
    /// A title, and why there is no map.
    Nothing(String, String),
}

impl Panel {
    /// The panel as SVG, its upper left corner at the origin.
    pub fn svg(&self, frame: &Frame) -> String {
        match self {
            Self::Map(map) => map.svg(frame),
            Self::Nothing(title, sentence) => {
                let [x, y] = frame.place([0.5, 0.5]);
                title_text(title)
                    + &frame.axes()
                    + &text([x, y + 4.0], 12.0, Anchor::Middle, sentence)
            }
        }
    }
}

impl Map {
    fn svg(&self, frame: &Frame) -> String {
        title_text(&self.title)
            + &self.colours(frame)
            + &frame.axes()
            + &self.contours(frame)
            + &self.legend(frame)
    }

    /// Parts that each cell is cut into along each side.
    fn fineness(&self, frame: &Frame) -> usize {
        let counts = self.field.counts();
        let cell = [0, 1].map(|side| frame.sides[side] * frame.scale / counts[side] as f64);
        let wanted = (cell[0].max(cell[1]) / PATCH).ceil() as usize;
        let affordable = (20_000.0 / (counts[0] * counts[1]) as f64).sqrt() as usize;
        wanted.min(affordable).clamp(1, 24)
    }

    /// Patches of colour, gathered by colour; cells without a value are hatched.
    fn colours(&self, frame: &Frame) -> String {
        let fineness = self.fineness(frame);
        let fine = fineness as f64;
        let parts = self.field.counts().map(|count| count * fineness);
        let shade = |column: usize, row: usize| {
            let middle = [column, row].map(|index| (index as f64 + 0.5) / fine);
            let value = self.field.at(middle)?;
            Some((self.scale.share(value) * SHADES).round() as u32)
        };
        let mut paths: BTreeMap<Option<u32>, String> = BTreeMap::new();
        for row in 0..parts[1] {
            let mut column = 0;
            while column < parts[0] {
                let colour = shade(column, row);
                let run = (column..parts[0])
                    .take_while(|&c| shade(c, row) == colour)
                    .count();
                let _ = write!(
                    paths.entry(colour).or_default(),
                    "M{column} {row}h{run}v1h-{run}z"
                );
                column += run;
            }
        }
        let [origin, right, up] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|at| frame.place(at));
        let [a, b, c, d] = [
            (right[0] - origin[0]) / parts[0] as f64,
            (right[1] - origin[1]) / parts[0] as f64,
            (up[0] - origin[0]) / parts[1] as f64,
            (up[1] - origin[1]) / parts[1] as f64,
        ];
        let mut drawing = format!(
            "<g transform=\"matrix({a:.5} {b:.5} {c:.5} {d:.5} {:.2} {:.2})\" shape-rendering=\"crispEdges\">\n",
            origin[0], origin[1]
        );
        let mut hatched = String::new();
        for (colour, data) in paths {
            let fill = match colour {
                Some(shade) => hexadecimal(viridis(f64::from(shade) / SHADES)),
                None => {
                    hatched = self.hatched(frame);
                    "#dddddd".to_owned()
                }
            };
            let _ = writeln!(drawing, "<path fill=\"{fill}\" d=\"{data}\"/>");
        }
        drawing + "</g>\n" + &hatched
    }

    /// Hatching over the cells without a value.
    fn hatched(&self, frame: &Frame) -> String {
        let [columns, rows] = self.field.counts();
        let mut data = String::new();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)))
        {
            let corner = |right: usize, up: usize| {
                frame.place([
                    (column + right) as f64 / columns as f64,
                    (row + up) as f64 / rows as f64,
                ])
            };
            if self
                .field
                .at([column as f64 + 0.5, row as f64 + 0.5])
                .is_none()
            {
                data += &path_data(&[corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
                data.push('Z');
            }
        }
        format!("<path fill=\"url(#hatching)\" d=\"{data}\"/>\n")
    }

    /// Contour lines with their values.
    fn contours(&self, frame: &Frame) -> String {
        let fineness = self.fineness(frame);
        let lattice = self.field.lattice(fineness);
        let parts = self.field.counts().map(|count| (count * fineness) as f64);
        let (mut data, mut labels) = (String::new(), String::new());
        let mut taken: Vec<[f64; 4]> = Vec::new();
        for level in self.scale.levels(self.noise) {
            for contour in lattice.contours(level.value) {
                let points: Vec<[f64; 2]> = contour
                    .iter()
                    .map(|[a, b]| frame.place([a / parts[0], b / parts[1]]))
                    .collect();
                data += &path_data(&points);
                if let Some(at) = label_place(&points, &level.text, frame, &mut taken) {
                    labels += &text([at[0], at[1] + 4.0], SMALL, Anchor::Middle, &level.text);
                }
            }
        }
        format!(
            "<g fill=\"none\" stroke-linejoin=\"round\">\n\
             <path stroke=\"#fff\" stroke-opacity=\"0.6\" stroke-width=\"2.4\" d=\"{data}\"/>\n\
             <path stroke=\"#111\" stroke-width=\"0.9\" d=\"{data}\"/>\n</g>\n\
             <g fill=\"#111\" stroke=\"#fff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\">\n\
             {labels}</g>\n"
        )
    }

    /// The colour bar with its numbers; lines across it where the map has contour lines.
    fn legend(&self, frame: &Frame) -> String {
        /// Patches of the bar.
        const PATCHES: usize = 64;
        let [x, top] = [frame.bar(), ABOVE];
        let height = frame.size()[1].max(BAR_HEIGHT);
        let place = |share: f64| top + (1.0 - share) * height;
        let mut bar = String::new();
        for patch in 0..PATCHES {
            let share = (patch as f64 + 0.5) / PATCHES as f64;
            let y = place((patch + 1) as f64 / PATCHES as f64);
            let fill = hexadecimal(viridis(share));
            let _ = writeln!(
                bar,
                "<rect x=\"{x:.1}\" y=\"{y:.2}\" width=\"{BAR}\" height=\"{:.2}\" fill=\"{fill}\"/>",
                height / PATCHES as f64
            );
        }
        let mut lines = String::new();
        let levels = self.scale.levels(self.noise);
        for level in &levels {
            let y = place(self.scale.share(level.value));
            lines += &line([x, y], [x + BAR, y]);
        }
        let marks = if levels.len() < 2 {
            self.scale.ticks()
        } else {
            levels
        };
        let mut numbers = String::new();
        for tick in marks {
            let y = place(self.scale.share(tick.value));
            lines += &line([x + BAR, y], [x + BAR + 4.0, y]);
            numbers += &text([x + BAR + 7.0, y + 4.0], SMALL, Anchor::Start, &tick.text);
        }
        let heading = self.scale.heading(&self.unit);
        let unit = text([x, top - 12.0], SMALL, Anchor::Start, &heading);
        format!(
            "<g shape-rendering=\"crispEdges\">\n{bar}</g>\n<g fill=\"none\" stroke=\"#333\">\n\
             <rect x=\"{x:.1}\" y=\"{top:.1}\" width=\"{BAR}\" height=\"{height:.1}\"/>\n{lines}</g>\n{numbers}{unit}"
        )
    }
}

fn title_text(title: &str) -> String {
    text([LEFT, 14.0], 14.0, Anchor::Start, title)
}

/// A place for a label on a line where it lies inside the frame and on no other label; it is then taken.
fn label_place(
    points: &[[f64; 2]],
    label: &str,
    frame: &Frame,
    taken: &mut Vec<[f64; 4]>,
) -> Option<[f64; 2]> {
    /// Parts of the line at which a label may sit, the best first.
    const TRIES: [f64; 9] = [0.5, 0.35, 0.65, 0.2, 0.8, 0.42, 0.58, 0.1, 0.9];
    let [half_width, half_height] = [0.5 * text_width(SMALL, label) + 2.0, 0.5 * SMALL + 2.0];
    let steps: Vec<f64> = points
        .windows(2)
        .map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]))
        .collect();
    let length: f64 = steps.iter().sum();
    if length < 3.0 * half_width {
        return None;
    }
    let corners = [[0.0, 0.0], [1.0, 1.0]].map(|at| frame.place(at));
    let found = TRIES.iter().find_map(|part| {
        let mut rest = part * length;
        let (step, pair) = steps.iter().zip(points.windows(2)).find(|(step, _)| {
            rest -= **step;
            rest <= 0.0
        })?;
        let part = if *step > 0.0 { 1.0 + rest / step } else { 0.0 };
        let [x, y] = [0, 1].map(|side| pair[0][side] + part * (pair[1][side] - pair[0][side]));
        let label = [
            x - half_width,
            y - half_height,
            x + half_width,
            y + half_height,
        ];
        let inside = label[0] > corners[0][0].min(corners[1][0])
            && label[2] < corners[0][0].max(corners[1][0])
            && label[1] > corners[1][1]
            && label[3] < corners[0][1];
        let free = taken.iter().all(|other| {
            label[2] < other[0] || other[2] < label[0] || label[3] < other[1] || other[3] < label[1]
        });
        (inside && free).then_some(([x, y], label))
    });
    let (at, label) = found?;
    taken.push(label);
    Some(at)
}
