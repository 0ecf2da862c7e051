//! `<sensor>-trade.svg`: what one key gives up for another, and what the mean costs in uniformity.

use crate::chart::{Chart, Scaled};
use crate::colour::{hexadecimal, viridis};
use crate::findings::{Finding, Member};
use crate::number::significant;
use crate::sensitivity::Sensitivity;
use crate::svg::{Anchor, SMALL, line, path_data, text, text_width};
use crate::tick::Ticks;
use std::fmt::Write;

const MARGIN: f64 = 16.0;
const HEADER: f64 = 60.0;
/// Sides of each chart's box, in pixels.
const SIDES: [f64; 2] = [380.0, 320.0];
/// Lines of equal mean, at most.
const LINES: usize = 8;
/// Variants that are named on the chart, at most.
const NAMED: usize = 24;

/// The picture of one sensor group; `None` where no key is a number and the uniformity is not known.
pub fn svg(finding: &Finding, study: &str, reach: f64) -> Option<String> {
    let panels: Vec<(Chart, String)> = [keys(finding), uniformity(finding, reach)]
        .into_iter()
        .flatten()
        .collect();
    let height = panels
        .iter()
        .map(|(chart, _)| chart.size()[1])
        .fold(0.0, f64::max);
    let across: f64 = panels.iter().map(|(chart, _)| chart.size()[0]).sum();
    if panels.is_empty() {
        return None;
    }
    let title = format!("{} · {study}", finding.sensor);
    let notes = notes(finding);
    let widest = notes
        .iter()
        .map(|note| text_width(12.0, note))
        .fold(across, f64::max);
    let (width, height) = (
        widest + 2.0 * MARGIN,
        HEADER + height + 18.0 * notes.len() as f64 + MARGIN,
    );
    let mut drawing = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" \
         fill=\"#111\">\n<rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#fff\"/>\n"
    );
    drawing += &text([MARGIN, 30.0], 18.0, Anchor::Start, &title);
    let mut x = MARGIN;
    for (chart, marks) in &panels {
        let _ = write!(
            drawing,
            "<g transform=\"translate({x:.1} {HEADER:.1})\">\n{}{marks}</g>\n",
            chart.axes()
        );
        x += chart.size()[0];
    }
    let foot = height - MARGIN - 18.0 * notes.len() as f64;
    for (index, note) in notes.iter().enumerate() {
        drawing += &text(
            [MARGIN, foot + 18.0 * (index as f64 + 0.75)],
            12.0,
            Anchor::Start,
            note,
        );
    }
    Some(drawing + "</svg>\n")
}

/// The numeric keys by what share of the mean's variance each explains, the greatest first.
fn leading<'f>(finding: &'f Finding) -> Vec<(usize, &'f [f64], Sensitivity)> {
    let mut keys: Vec<_> = (0..finding.keys.len())
        .filter_map(|key| {
            let sensitivity = finding.to_mean[key].filter(|it| it.slope.is_some())?;
            Some((key, finding.columns[key].numbers()?, sensitivity))
        })
        .collect();
    keys.sort_by(|a, b| b.2.share.mean.total_cmp(&a.2.share.mean));
    keys
}

/// Two keys against each other, with lines along which the mean stays the same; the mean against one key where there is
/// but one.
fn keys(finding: &Finding) -> Option<(Chart, String)> {
    let leading = leading(finding);
    let variants = &finding.members[1..];
    let means: Vec<f64> = variants.iter().map(|it| it.measured.mean).collect();
    let title = |key: usize| finding.keys[key].clone();
    let (first, x, _) = *leading.first()?;
    let (y, title_y) = match leading.get(1) {
        Some(&(second, y, _)) => (y.to_vec(), title(second)),
        None => (means.clone(), format!("mean, {}", finding.unit)),
    };
    let chart = Chart {
        title: match leading.len() {
            1 => "Mean".to_owned(),
            _ => format!("Lines of equal mean, {}", finding.unit),
        },
        x: Scaled::over(title(first), x.iter().copied()),
        y: Scaled::over(title_y, y.iter().copied()),
        sides: SIDES,
    };
    let mut marks = String::new();
    if let [(_, x, to_x), (_, y, to_y), ..] = leading[..] {
        marks += &lines(&chart, [x, y], [to_x, to_y], &means);
    }
    for ((x, y), mean) in x.iter().zip(&y).zip(&means) {
        marks += &dot(chart.place([*x, *y]), shade(*mean, &means));
    }
    Some((chart, marks))
}

/// Lines of equal mean: of the plane through the variants that the slopes of both keys make.
fn lines(chart: &Chart, keys: [&[f64]; 2], slopes: [Sensitivity; 2], means: &[f64]) -> String {
    let average = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let middle = keys.map(average);
    let mean = average(means);
    let [sx, sy] = slopes.map(|it| it.slope.map_or(0.0, |slope| slope.mean));
    let (ends_x, ends_y) = (chart.x.ends(), chart.y.ends());
    let plane = |x: f64, y: f64| mean + sx * (x - middle[0]) + sy * (y - middle[1]);
    let corners = ends_x
        .iter()
        .flat_map(|x| ends_y.iter().map(|y| plane(*x, *y)));
    let low = corners.clone().fold(f64::INFINITY, f64::min);
    let high = corners.fold(f64::NEG_INFINITY, f64::max);
    let mut drawing = String::new();
    for tick in Ticks::within(low, high, LINES, 0.0)
        .into_iter()
        .flat_map(Ticks::iter)
    {
        let left = tick.value - mean;
        // Where the line meets the four sides of the box.
        let mut met: Vec<[f64; 2]> = Vec::new();
        for x in ends_x {
            met.push([x, middle[1] + (left - sx * (x - middle[0])) / sy]);
        }
        for y in ends_y {
            met.push([middle[0] + (left - sy * (y - middle[1])) / sx, y]);
        }
        let inside = |value: f64, [low, high]: [f64; 2]| {
            let slack = 1e-9 * (high - low);
            (low - slack..=high + slack).contains(&value)
        };
        met.retain(|[x, y]| inside(*x, ends_x) && inside(*y, ends_y));
        if let [from, .., to] = met[..] {
            let (from, to) = (chart.place(from), chart.place(to));
            let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]) - 3.0];
            let _ = writeln!(
                drawing,
                "<g stroke=\"#888\">{}</g>",
                line(from, to).trim_end()
            );
            drawing += &text(middle, SMALL, Anchor::Middle, &tick.text);
        }
    }
    drawing
}

/// The uniformity against the mean, with those variants joined that no other beats in both.
fn uniformity(finding: &Finding, reach: f64) -> Option<(Chart, String)> {
    let points: Vec<(&Member, [f64; 2], [f64; 2])> = finding
        .members
        .iter()
        .filter_map(|member| {
            let (u0, mean) = (member.u0?, &member.measured);
            let errors = [mean.mean_standard_error, u0.standard_error].map(|se| reach * se);
            Some((member, [mean.mean, u0.mean], errors))
        })
        .collect();
    if points.is_empty() {
        return None;
    }
    let ends = |axis: usize| {
        points
            .iter()
            .flat_map(move |(_, at, error)| [at[axis] - error[axis], at[axis] + error[axis]])
    };
    let chart = Chart {
        title: "Mean and uniformity, with 95 % intervals".to_owned(),
        x: Scaled::over(format!("mean, {}", finding.unit), ends(0)),
        y: Scaled::over("u0 = min/mean".to_owned(), ends(1)),
        sides: SIDES,
    };
    let beaten = |at: [f64; 2]| {
        points.iter().any(|(_, other, _)| {
            let (more, least) = (other[0] - at[0], other[1] - at[1]);
            more >= 0.0 && least >= 0.0 && more + least > 0.0
        })
    };
    let mut front: Vec<[f64; 2]> = points
        .iter()
        .map(|it| it.1)
        .filter(|at| !beaten(*at))
        .collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let front: Vec<[f64; 2]> = front.into_iter().map(|at| chart.place(at)).collect();
    let mut marks = format!(
        "<path fill=\"none\" stroke=\"#c33\" stroke-dasharray=\"5 3\" d=\"{}\"/>\n",
        path_data(&front)
    );
    let leading = leading(finding);
    let key = leading.first().map(|(_, numbers, _)| *numbers);
    for (index, (member, at, error)) in points.iter().enumerate() {
        let [x, y] = chart.place(*at);
        let [across, up] = [
            [
                chart.place([at[0] - error[0], at[1]]),
                chart.place([at[0] + error[0], at[1]]),
            ],
            [
                chart.place([at[0], at[1] - error[1]]),
                chart.place([at[0], at[1] + error[1]]),
            ],
        ];
        let bars = line(across[0], across[1]) + &line(up[0], up[1]);
        let _ = writeln!(marks, "<g stroke=\"#aaa\">{}</g>", bars.trim_end());
        let colour = match (index.checked_sub(1), key) {
            (Some(variant), Some(numbers)) if points.len() == numbers.len() + 1 => {
                shade(numbers[variant], numbers)
            }
            (None, _) => "#c33".to_owned(),
            _ => "#555".to_owned(),
        };
        marks += &dot([x, y], colour);
        if points.len() <= NAMED {
            marks += &text(
                [x + 6.0, y - 5.0],
                SMALL,
                Anchor::Start,
                &member.outcome.name,
            );
        }
    }
    Some((chart, marks))
}

/// What the picture shows, in words.
fn notes(finding: &Finding) -> Vec<String> {
    let leading = leading(finding);
    let mut notes = Vec::new();
    if let [(first, _, to_first), (second, _, to_second), ..] = leading[..] {
        let slope = |it: Sensitivity| it.slope.map_or(f64::NAN, |slope| slope.mean);
        let rate = -slope(to_first) / slope(to_second);
        if rate.is_finite() {
            notes.push(format!(
                "left: dots are variants, bright where the mean is great; the same mean is kept by {} of {} for 1 of {}",
                significant(rate, 3),
                finding.keys[second],
                finding.keys[first]
            ));
        }
    }
    let colours = leading.first().map_or(String::new(), |(key, ..)| {
        format!("; bright where {} is great", finding.keys[*key])
    });
    notes.push(format!(
        "mean and uniformity: red is the base; the dashed line joins what no other beats in both{colours}"
    ));
    notes
}

fn dot([x, y]: [f64; 2], colour: String) -> String {
    format!(
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\" stroke=\"#111\" stroke-width=\"0.5\"/>\n"
    )
}

/// The colour of a value among all.
fn shade(value: f64, all: &[f64]) -> String {
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let share = if high > low {
        (value - low) / (high - low)
    } else {
        0.5
    };
    hexadecimal(viridis(share))
}
