//! `tradeoff.svg`: error against time, both logarithmic, a curve a setting.

use crate::colour::{hexadecimal, viridis};
use crate::scale::Scale;
use crate::svg::{Anchor, SMALL, line, path_data, text};
use crate::tradeoff::curve::{Curve, frontier};
use crate::tradeoff::report::{Report, percent};
use crate::tradeoff::trial::Outcome;
use std::fmt::Write;

/// The area of the curves: left, top, right, bottom, in pixels.
const AREA: [f64; 4] = [72.0, 72.0, 612.0, 492.0];
/// Size of the page.
const PAGE: [f64; 2] = [880.0, 560.0];
/// Left edge of the legend, and distance of its entries.
const LEGEND: f64 = 634.0;
const ENTRY: f64 = 36.0;
/// Errors above this are not worth a place.
const WORST: f64 = 1.0;
/// Lightest colour of a curve, as a share of the scale: beyond, it is lost on white.
const LIGHTEST: f64 = 0.82;

/// The axes: time to the right, error upwards.
struct Axes {
    time: Scale,
    error: Scale,
}

/// The diagram; `None` where there is no point to show.
pub fn svg(report: &Report) -> Option<String> {
    let curves = report.curves;
    let limit = report.reference.limit();
    let axes = Axes::around(curves, limit)?;
    let [width, height] = PAGE;
    let mut drawing = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"Helvetica, Arial, sans-serif\" fill=\"#111\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    drawing += &text(
        [16.0, 26.0],
        16.0,
        Anchor::Start,
        &format!("Error against time · {}", report.scene.name),
    );
    drawing += &text([16.0, 46.0], SMALL, Anchor::Start, &report.reference());
    drawing += &axes.untold(limit);
    drawing += &axes.grid();
    drawing += &axes.guides();
    drawing += &axes.frontier(curves);
    for (index, curve) in curves.iter().enumerate() {
        drawing += &axes.curve(curve, &Style::of(index, curves.len()));
    }
    drawing += &axes.frame();
    drawing += &legend(curves);
    Some(drawing + "</svg>\n")
}

/// The points of a curve that are worth a place, and have one on a logarithmic axis.
fn shown(curve: &Curve) -> impl Iterator<Item = &Outcome> {
    curve
        .points()
        .filter(|point| (f64::MIN_POSITIVE..=WORST).contains(&point.rms_error))
}

impl Axes {
    /// Axes that hold all points, with some room; time spans at least a decade.
    fn around(curves: &[Curve], limit: f64) -> Option<Self> {
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, 0.0], |[low, high], value| {
                [low.min(value), f64::max(high, value)]
            })
        };
        let points = || curves.iter().flat_map(shown);
        let bounds = curves.iter().filter_map(Curve::untold);
        let seconds = points().chain(bounds).map(|point| point.seconds);
        let [first, last] = ends(&mut { seconds });
        let [least, most] = ends(&mut points().map(|point| 100.0 * point.rms_error));
        if least > most {
            return None;
        }
        let first = first.max(1e-9);
        let low = if limit > 0.0 {
            least.min(100.0 * limit)
        } else {
            least
        };
        Some(Self {
            time: Scale::by_decades(first / 1.4, (last * 1.4).max(10.0 * first)),
            error: Scale::by_decades(low / 1.8, (most * 1.5).max(10.0 * low)),
        })
    }

    /// Place of a time in seconds and an error as a share.
    fn place(&self, [seconds, error]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = AREA;
        [
            left + self.time.share(seconds) * (right - left),
            bottom - self.error.share(100.0 * error) * (bottom - top),
        ]
    }

    /// The errors that the reference cannot tell.
    fn untold(&self, limit: f64) -> String {
        let [left, _, right, bottom] = AREA;
        if limit <= 0.0 {
            return String::new();
        }
        let [_, y] = self.place([1.0, limit]);
        format!(
            "<rect x=\"{left}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#f0f0f0\"/>\n<g fill=\"#666\">\n{}</g>\n",
            right - left,
            bottom - y,
            text(
                [left + 8.0, bottom - 8.0],
                SMALL,
                Anchor::Start,
                "finer than the reference can tell"
            )
        )
    }

    fn grid(&self) -> String {
        let [left, top, right, bottom] = AREA;
        let (mut lines, mut texts) = (String::new(), String::new());
        for tick in self.time.ticks() {
            let [x, _] = self.place([tick.value, 1.0]);
            lines += &line([x, top], [x, bottom]);
            texts += &text([x, bottom + 18.0], SMALL, Anchor::Middle, &tick.text);
        }
        for tick in self.error.ticks() {
            let [_, y] = self.place([1.0, 0.01 * tick.value]);
            lines += &line([left, y], [right, y]);
            texts += &text([left - 8.0, y + 4.0], SMALL, Anchor::End, &tick.text);
        }
        texts += &text(
            [0.5 * (left + right), bottom + 40.0],
            12.0,
            Anchor::Middle,
            &format!("time of a run in {}", self.time.heading("s")),
        );
        let name = text(
            [0.0, 0.0],
            12.0,
            Anchor::Middle,
            &format!("relative error in {}", self.error.heading("%")),
        );
        let _ = writeln!(
            texts,
            "<g transform=\"translate(22 {:.1}) rotate(-90)\">{name}</g>",
            0.5 * (top + bottom)
        );
        format!("<g fill=\"none\" stroke=\"#ddd\">\n{lines}</g>\n{texts}")
    }

    fn frame(&self) -> String {
        let [left, top, right, bottom] = AREA;
        format!(
            "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#333\"/>\n",
            right - left,
            bottom - top
        )
    }

    /// Lines of slope −½, a decade of error apart.
    fn guides(&self) -> String {
        let [left, top, right, bottom] = AREA;
        let across = (right - left) / self.time.decades();
        let down = (bottom - top) / self.error.decades();
        let slope = 0.5 * down / across;
        let mut lines = String::new();
        let mut start = top - ((right - left) * slope / down).ceil() * down;
        while start < bottom {
            let ends = [(left, start), (right, start + slope * (right - left))];
            lines += &line([ends[0].0, ends[0].1], [ends[1].0, ends[1].1]);
            start += down;
        }
        format!(
            "<clipPath id=\"area\"><rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\"/></clipPath>\n\
             <g clip-path=\"url(#area)\" fill=\"none\" stroke=\"#bbb\" stroke-dasharray=\"1 4\">\n{lines}</g>\n",
            right - left,
            bottom - top
        )
    }

    /// A band under what no setting beats.
    fn frontier(&self, curves: &[Curve]) -> String {
        let points: Vec<[f64; 2]> = frontier(curves)
            .into_iter()
            .filter(|[_, error]| *error <= WORST)
            .map(|at| self.place(at))
            .collect();
        band(&path_data(&points))
    }

    fn curve(&self, curve: &Curve, style: &Style) -> String {
        let places: Vec<[f64; 2]> = shown(curve)
            .map(|point| self.place([point.seconds, point.rms_error]))
            .collect();
        let mut drawing = style.stroke(&path_data(&places));
        for at in places {
            drawing += &style.mark(at);
        }
        if let Some(untold) = curve.untold() {
            // Known to be below, and no more: a mark under the limit that points down.
            let [x, y] = self.place([untold.seconds, curve.limit]);
            let arrow = [[x, y + 10.0], [x, y + 24.0], [x - 3.0, y + 19.0]];
            let barb = [[x, y + 24.0], [x + 3.0, y + 19.0]];
            drawing += &style.arrow(&(path_data(&arrow) + &path_data(&barb)));
            drawing += &style.mark([x, y + 10.0]);
        }
        drawing
    }
}

/// A broad light stroke.
fn band(data: &str) -> String {
    format!(
        "<path fill=\"none\" stroke=\"#ffd54a\" stroke-opacity=\"0.55\" stroke-width=\"11\" stroke-linecap=\"round\" \
         stroke-linejoin=\"round\" d=\"{data}\"/>\n"
    )
}

/// What tells a curve from the others, in colour and in grey.
struct Style {
    colour: String,
    shape: usize,
    is_first: bool,
}

impl Style {
    fn of(index: usize, count: usize) -> Self {
        let share = LIGHTEST * index as f64 / (count.max(2) - 1) as f64;
        Self {
            colour: hexadecimal(viridis(share)),
            shape: index,
            is_first: index == 0,
        }
    }

    fn stroke(&self, data: &str) -> String {
        /// Dashes, the same for every sixth curve.
        const DASHES: [&str; 6] = ["none", "7 3", "2 3", "10 3 2 3", "5 5", "12 4"];
        format!(
            "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\" d=\"{data}\"/>\n",
            self.colour,
            if self.is_first { 2.4 } else { 1.4 },
            DASHES[self.shape % DASHES.len()]
        )
    }

    fn arrow(&self, data: &str) -> String {
        format!(
            "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\" d=\"{data}\"/>\n",
            self.colour
        )
    }

    /// A mark of the curve's own shape about a place.
    fn mark(&self, [x, y]: [f64; 2]) -> String {
        /// Outlines about the origin, the same for every sixth curve.
        const SHAPES: [&str; 6] = [
            "M-4.2 0a4.2 4.2 0 1 0 8.4 0a4.2 4.2 0 1 0 -8.4 0Z",
            "M-3.6 -3.6H3.6V3.6H-3.6Z",
            "M0 -4.8L4.6 3.4H-4.6Z",
            "M0 -5L5 0L0 5L-5 0Z",
            "M0 4.8L4.6 -3.4H-4.6Z",
            "M-4.6 -1.5H-1.5V-4.6H1.5V-1.5H4.6V1.5H1.5V4.6H-1.5V1.5H-4.6Z",
        ];
        // Later rounds of the shapes are hollow.
        let hollow = self.shape >= SHAPES.len();
        format!(
            "<path transform=\"translate({x:.1} {y:.1})\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.2\" d=\"{}\"/>\n",
            if hollow { "#fff" } else { &self.colour },
            if hollow { &self.colour } else { "#fff" },
            SHAPES[self.shape % SHAPES.len()]
        )
    }
}

/// Name, slope and floor of every curve, and what the rest of the drawing means.
fn legend(curves: &[Curve]) -> String {
    let mut drawing = String::new();
    let mut y = AREA[1] + 10.0;
    for (index, curve) in curves.iter().enumerate() {
        let style = Style::of(index, curves.len());
        drawing += &style.stroke(&path_data(&[[LEGEND, y], [LEGEND + 34.0, y]]));
        drawing += &style.mark([LEGEND + 17.0, y]);
        drawing += &text(
            [LEGEND + 44.0, y + 1.0],
            12.0,
            Anchor::Start,
            &curve.setting.words(),
        );
        let note = format!(
            "<g fill=\"#555\">{}</g>\n",
            text(
                [LEGEND + 44.0, y + 15.0],
                SMALL,
                Anchor::Start,
                &ending(curve)
            )
        );
        drawing += &note;
        y += ENTRY;
    }
    drawing += &band(&path_data(&[[LEGEND + 5.0, y], [LEGEND + 29.0, y]]));
    drawing += &text(
        [LEGEND + 44.0, y + 4.0],
        12.0,
        Anchor::Start,
        "the least error for the time",
    );
    y += 24.0;
    drawing += &format!(
        "<g fill=\"none\" stroke=\"#999\" stroke-dasharray=\"1 4\">\n{}</g>\n",
        line([LEGEND, y - 6.0], [LEGEND + 34.0, y + 6.0])
    );
    drawing
        + &text(
            [LEGEND + 44.0, y + 4.0],
            12.0,
            Anchor::Start,
            "slope −½: error of pure chance",
        )
}

/// How a curve ends.
fn ending(curve: &Curve) -> String {
    let slope = curve.slope().map(|slope| {
        let sign = if slope < 0.0 { '−' } else { '+' };
        format!("slope {sign}{:.2}", slope.abs())
    });
    let floor = curve
        .floor()
        .map(|floor| format!("ends at {}", percent(floor)));
    if curve.points().next().is_none() {
        return "finer than the reference can tell".into();
    }
    let parts: Vec<String> = slope.into_iter().chain(floor).collect();
    parts.join(", ")
}
