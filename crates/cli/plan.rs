//! `<sensor>.svg`: a false-colour plan of a grid and, beside it, the degree of polarisation.

use crate::digest::Digest;
use crate::field::Field;
use crate::frame::Frame;
use crate::label;
use crate::number::{measured, significant, triple};
use crate::panel::{Map, Panel};
use crate::scale::Scale;
use crate::svg::{Anchor, SMALL, text, text_width};
use malus_estimator::{Group, Reading, Results};
use malus_optics::Representation;
use malus_scene::{Layout, Scene, Sensor};
use std::fmt::Write;

/// Space around everything, and for the title.
const MARGIN: f64 = 16.0;
const HEADER: f64 = 66.0;
/// Height of a line of the notes below.
const NOTE: f64 = 16.0;

/// The plan of the sensor at `index`; `None` where it is no grid of at least 2 × 2 points.
pub fn svg(scene: &Scene, results: &Results, index: usize, digest: &Digest) -> Option<String> {
    let (sensor, group) = (scene.sensors.get(index)?, results.groups.get(index)?);
    let Layout::Grid {
        origin,
        u,
        v,
        counts,
    } = &sensor.layout
    else {
        return None;
    };
    if counts.iter().any(|&count| count < 2) {
        return None;
    }
    let frame = Frame::new(u.to_array(), v.to_array())?;
    let panels = [
        strength(scene, sensor, group, *counts)?,
        polarisation(results, group, *counts)?,
    ];
    let title = format!("{} · {}", sensor.name, scene.name);
    let normal = sensor.points.first().map(|point| point.normal.to_array());
    let mut notes = vec![format!(
        "u = v = 0 at {} m{}",
        triple(origin.to_array()),
        normal.map_or(String::new(), |normal| format!(
            "; normal {}",
            triple(normal)
        ))
    )];
    if digest.enclosed > 0 {
        notes.push(format!(
            "hatched: {} points inside a solid",
            digest.enclosed
        ));
    }
    if !results.complete {
        notes.push("interrupted run: incomplete".to_owned());
    }
    let subtitle = subtitle(scene, sensor, digest);
    Some(page(&frame, &panels, &title, &subtitle, &notes))
}

/// The map of S0.
fn strength(scene: &Scene, sensor: &Sensor, group: &Group, counts: [usize; 2]) -> Option<Panel> {
    let name = capitalised(label::quantity(sensor.quantity, scene.unit));
    let field = field(group, counts, |reading| reading.stokes[0])?;
    let Some(scale) = Scale::over(&field) else {
        return Some(Panel::Nothing(
            name,
            "all points are inside a solid".to_owned(),
        ));
    };
    let by_logarithm = if scale.is_logarithmic() {
        ", logarithmic colours"
    } else {
        ""
    };
    Some(Panel::Map(Map {
        title: format!("{name} S0{by_logarithm}"),
        unit: label::unit(sensor.quantity, scene.unit).to_owned(),
        field,
        scale,
        noise: typical(group, |reading| reading.standard_error[0]),
    }))
}

/// The map of the degree of linear polarisation, or why there is none.
fn polarisation(results: &Results, group: &Group, counts: [usize; 2]) -> Option<Panel> {
    let title = "Degree of linear polarisation".to_owned();
    if results.representation == Representation::Intensity {
        return Some(Panel::Nothing(
            title,
            "unpolarised: not computed".to_owned(),
        ));
    }
    let field = field(group, counts, |reading| 100.0 * reading.dolp)?;
    let scale = Scale::from_zero(&field);
    let Some(scale) = scale.filter(|_| field.range().is_some_and(|[_, high]| high > 0.0)) else {
        return Some(Panel::Nothing(
            title,
            "unpolarised: zero everywhere".to_owned(),
        ));
    };
    Some(Panel::Map(Map {
        title,
        unit: "%".to_owned(),
        field,
        scale,
        noise: typical(group, |reading| 100.0 * reading.dolp_standard_error),
    }))
}

fn field(group: &Group, counts: [usize; 2], value: impl Fn(&Reading) -> f64) -> Option<Field> {
    let values = group
        .readings
        .iter()
        .map(|reading| (!reading.enclosed).then(|| value(reading)))
        .collect();
    Field::new(counts, values)
}

/// Root mean square of an error over the free points.
fn typical(group: &Group, error: impl Fn(&Reading) -> f64) -> f64 {
    let free = || group.readings.iter().filter(|reading| !reading.enclosed);
    let squares: f64 = free().map(|reading| error(reading) * error(reading)).sum();
    (squares / free().count().max(1) as f64).sqrt()
}

/// The line of figures under the title.
fn subtitle(scene: &Scene, sensor: &Sensor, digest: &Digest) -> String {
    let quantity = label::quantity(sensor.quantity, scene.unit);
    let unit = label::unit(sensor.quantity, scene.unit);
    match &digest.free {
        Some(free) => format!(
            "{quantity} in {unit}: mean {} (standard error), min {}, max {}, u0 {}; standard error at a point ≤ {} %",
            measured(free.mean, free.mean_standard_error),
            significant(free.min, 4),
            significant(free.max, 4),
            significant(free.u0, 3),
            significant(100.0 * free.relative_error_max, 2),
        ),
        None => "all points are inside a solid".to_owned(),
    }
}

/// Puts everything on one page.
fn page(
    frame: &Frame,
    panels: &[Panel; 2],
    title: &str,
    subtitle: &str,
    notes: &[String],
) -> String {
    let [panel_width, panel_height] = frame.panel();
    let wide = frame.is_wide();
    let (across, down) = if wide { (1.0, 2.0) } else { (2.0, 1.0) };
    let widest = notes
        .iter()
        .map(|note| text_width(12.0, note))
        .chain([text_width(18.0, title), text_width(12.0, subtitle)])
        .fold(across * panel_width, f64::max);
    let width = (widest + 2.0 * MARGIN).ceil();
    let height = (HEADER + down * panel_height + NOTE * notes.len() as f64 + MARGIN).ceil();
    let mut drawing = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" \
         fill=\"#111\">\n\
         <defs><pattern id=\"hatching\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">\
         <path d=\"M-1 1L1 -1M0 6L6 0M5 7L7 5\" stroke=\"#777\" fill=\"none\"/></pattern></defs>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    drawing += &text([MARGIN, 30.0], 18.0, Anchor::Start, title);
    drawing += &text([MARGIN, 50.0], 12.0, Anchor::Start, subtitle);
    for (panel, place) in panels.iter().zip([0.0, 1.0]) {
        let [x, y] = if wide {
            [MARGIN, HEADER + place * panel_height]
        } else {
            [MARGIN + place * panel_width, HEADER]
        };
        let _ = writeln!(
            drawing,
            "<g transform=\"translate({x:.1} {y:.1})\">\n{}</g>",
            panel.svg(frame)
        );
    }
    for (index, note) in notes.iter().enumerate() {
        let y = HEADER + down * panel_height + NOTE * (index as f64 + 0.75);
        drawing += &text([MARGIN, y], SMALL, Anchor::Start, note);
    }
    drawing + "</svg>\n"
}

fn capitalised(word: &str) -> String {
    let mut chars = word.chars();
    chars
        .next()
        .map(|first| first.to_uppercase().chain(chars).collect())
        .unwrap_or_default()
}
