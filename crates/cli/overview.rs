//! What `run` prints: a short table of the results and how they came about.

use crate::digest::{Difference, Digest};
use crate::label;
use crate::number::{measured, metres, significant, with_error};
use crate::summary::Circumstances;
use crate::table::{Table, left, right};
use malus_estimator::{Group, Reading, Results, Stop, half_width_95};
use malus_optics::Representation;
use malus_scene::{Scene, Sensor};
use std::path::Path;

/// Sensors with at most so many points are also printed point by point.
const FEW: usize = 12;

/// The overview of a run whose results are in `directory`.
pub fn text(
    scene: &Scene,
    results: &Results,
    digests: &[Digest],
    circumstances: &Circumstances,
    directory: &Path,
) -> String {
    let mut text = groups(scene, results, digests).text("");
    for (sensor, group) in scene.sensors.iter().zip(&results.groups) {
        if group.readings.len() <= FEW {
            text.push('\n');
            text += &points(scene, sensor, group, results);
        }
    }
    text.push('\n');
    text += &provenance(results, circumstances, directory);
    text
}

/// One row a sensor.
fn groups(scene: &Scene, results: &Results, digests: &[Digest]) -> Table {
    let polarised = results.representation > Representation::Intensity;
    let readings = || results.groups.iter().flat_map(|group| &group.readings);
    let scalar = readings().any(|reading| reading.scalar.is_some());
    let diffuse = readings().any(|reading| reading.diffuse.is_some());
    let quantity = scene
        .sensors
        .first()
        .map_or(malus_scene::Quantity::Irradiance, |sensor| sensor.quantity);
    let mean = format!("mean ± se, {}", label::unit(quantity, scene.unit));
    let mut columns = vec![left("sensor")];
    columns.extend([right("points"), right(&mean), right("min"), right("max")]);
    columns.extend([right("u0"), right("max se, %")]);
    columns.extend(polarised.then(|| right("DoLP, %")));
    columns.extend(scalar.then(|| right("less scalar, %")));
    columns.extend(diffuse.then(|| right("less diffuse, %")));
    let mut table = Table::new(columns);
    for (sensor, digest) in scene.sensors.iter().zip(digests) {
        let points = match digest.enclosed {
            0 => digest.count.to_string(),
            enclosed => format!("{} ({enclosed} enclosed)", digest.count),
        };
        let mut row = vec![sensor.name.clone(), points];
        if let Some(free) = &digest.free {
            row.push(measured(free.mean, free.mean_standard_error));
            row.extend([free.min, free.max].map(|value| significant(value, 4)));
            row.push(significant(free.u0, 3));
            row.push(significant(100.0 * free.relative_error_max, 2));
            row.extend(polarised.then(|| significant(100.0 * free.dolp_mean, 3)));
            row.extend(scalar.then(|| difference(free.scalar)));
            row.extend(diffuse.then(|| difference(free.diffuse)));
        }
        table.row(row);
    }
    table
}

/// One row a point of one sensor.
fn points(scene: &Scene, sensor: &Sensor, group: &Group, results: &Results) -> String {
    let components = results.representation.components();
    let reach = half_width_95(results.dof);
    let scalar = group
        .readings
        .iter()
        .any(|reading| reading.scalar.is_some());
    let mut columns = vec![right("point"), right("x"), right("y"), right("z")];
    columns.extend([right("s0 ± se"), right("95 % interval")]);
    let others = ["s1 ± se", "s2 ± se", "s3 ± se"];
    columns.extend(others.iter().take(components - 1).map(|title| right(title)));
    columns.extend((components > 1).then(|| right("DoLP, %")));
    columns.extend(scalar.then(|| right("less scalar ± se")));
    let mut table = Table::new(columns);
    for (index, (point, reading)) in sensor.points.iter().zip(&group.readings).enumerate() {
        let mut row = vec![index.to_string()];
        row.extend(point.position.to_array().map(metres));
        row.extend(readings(reading, components, reach, scalar));
        table.row(row);
    }
    format!(
        "{}, {}, positions in m\n{}",
        sensor.name,
        label::unit(sensor.quantity, scene.unit),
        table.text("")
    )
}

/// Cells of one reading.
fn readings(reading: &Reading, components: usize, reach: f64, scalar: bool) -> Vec<String> {
    if reading.enclosed {
        return vec!["enclosed".to_owned()];
    }
    let [value, error] = [reading.stokes[0], reading.standard_error[0]];
    let mut row = vec![measured(value, error), interval(value, error, reach)];
    for component in 1..components {
        row.push(measured(
            reading.stokes[component],
            reading.standard_error[component],
        ));
    }
    if components > 1 {
        row.push(measured(
            100.0 * reading.dolp,
            100.0 * reading.dolp_standard_error,
        ));
    }
    if scalar {
        row.push(reading.scalar.map_or(String::new(), |pair| {
            measured(pair.difference, pair.difference_standard_error)
        }));
    }
    row
}

/// The interval of `reach` standard errors, to the digits of the error.
fn interval(value: f64, error: f64, reach: f64) -> String {
    let [low, high] = [value - reach * error, value + reach * error];
    format!(
        "{} … {}",
        with_error(low, error).0,
        with_error(high, error).0
    )
}

/// A mean difference in per cent.
fn difference(difference: Option<Difference>) -> String {
    difference.map_or(String::new(), |difference| {
        let (share, error) =
            with_error(100.0 * difference.share, 100.0 * difference.standard_error);
        let sign = if difference.share > 0.0 { "+" } else { "" };
        format!("{sign}{share} ± {error}")
    })
}

/// How the results came about.
fn provenance(results: &Results, circumstances: &Circumstances, directory: &Path) -> String {
    let reason = |text: &str| match text {
        "" => String::new(),
        text => format!(" ({text})"),
    };
    let end = match results.stop {
        Stop::RelativeError => "the relative error asked for is reached",
        Stop::Samples => "the samples asked for are taken",
        Stop::Time => "the time asked for is used up",
        Stop::Interrupted => "INTERRUPTED: incomplete",
    };
    format!(
        "{} samples in {:.1} s on {} threads; {end}\n\
         representation {}{}; estimator {}{}\n\
         repeat with {}\n\
         results in {}\n",
        results.samples,
        circumstances.seconds,
        circumstances.threads,
        label::representation(results.representation),
        reason(&results.representation_reason),
        label::estimator(results.estimator),
        reason(&results.estimator_reason),
        circumstances.repeat,
        directory.display(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::digest::tests::{enclosed, reading};

    #[test]
    fn a_point_shows_the_components_that_were_computed() {
        let cells = readings(&reading(2.0), 3, 2.0, false);
        let expected = [
            "2.000 ± 0.020",
            "1.960 … 2.040",
            "0.2000 ± 0.0010",
            "0.0000 ± 0.0020",
            "10.00 ± 0.30",
        ];
        assert_eq!(cells, expected);
        assert_eq!(readings(&reading(2.0), 1, 2.0, false).len(), 2);
        assert_eq!(readings(&enclosed(), 4, 2.0, true), ["enclosed"]);
    }

    #[test]
    fn differences_carry_their_sign() {
        let of = |share| {
            difference(Some(Difference {
                share,
                standard_error: 0.002,
            }))
        };
        assert_eq!(of(0.0117), "+1.17 ± 0.20");
        assert_eq!(of(-0.233), "-23.30 ± 0.20");
        assert_eq!(difference(None), "");
    }
}
