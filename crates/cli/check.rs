//! `malus check`: what was understood of a scene, and what is wrong with it.

use crate::args;
use crate::failure::Failure;
use crate::number::{significant, triple};
use crate::report::print;
use crate::table::{Edge, Table};
use anyhow::Context;
use malus_scene::{CameraReport, EmitterReport, MaterialReport, Report, Scene, SensorReport};

/// Loads the scene and prints what was understood of it.
///
/// # Errors
/// A bad scene; stdout that cannot be written to.
pub fn check(command: &args::Check) -> Result<(), Failure> {
    let scene =
        Scene::load(&command.scene, &command.set).map_err(|error| Failure::input(error.into()))?;
    let report = Report::of(&scene);
    let text = if command.json {
        serde_json::to_string_pretty(&report)
            .context("the report cannot be written as JSON")
            .map_err(Failure::run)?
            + "\n"
    } else {
        text(&report)
    };
    print(&text).map_err(Failure::run)
}

/// The report as people read it; what calls for action stands last.
fn text(report: &Report) -> String {
    let unit = report.unit.symbol();
    let mut text = format!(
        "{}: {} triangles, {} m²",
        report.name,
        report.triangles,
        significant(report.area_m2, 5)
    );
    if let Some([low, high]) = report.bounds_m {
        text += &format!(", from {} to {} m", triple(low), triple(high));
    }
    text += "\n\nMaterials\n";
    for material in &report.materials {
        text += &described(material);
    }
    text += "\nEmitters\n";
    text += &emitters(&report.emitters, unit).text("  ");
    if !report.sensors.is_empty() {
        text += "\nSensors\n";
        text += &sensors(&report.sensors).text("  ");
    }
    if !report.cameras.is_empty() {
        text += "\nCameras\n";
        text += &cameras(&report.cameras).text("  ");
    }
    let outlook = match report.sensors.is_empty() {
        true => "cameras",
        false => "sensors",
    };
    text += &format!(
        "\nRepresentation {}: {}\n{} % of the directions from the {outlook} leave the geometry\n",
        report.representation,
        report.representation_reason,
        significant(100.0 * report.escaping, 2)
    );
    if !report.coincidences.is_empty() {
        text += "\nSurfaces in the same place\n";
    }
    for pair in &report.coincidences {
        text += &format!("  {pair}\n");
    }
    text += &match report.warnings.len() {
        0 => "\nNo defects, no warnings\n".to_owned(),
        count => format!("\nDefects and warnings: {count}\n"),
    };
    for warning in &report.warnings {
        text += &format!("  warning: {warning}\n");
    }
    text
}

/// A material: what was given, value by value with its origin, and what is left at its default in one line.
fn described(material: &MaterialReport) -> String {
    let object = match &material.object {
        Some(object) => format!(" of {object}"),
        None => String::new(),
    };
    let [area, exposed] = [material.area_m2, material.exposed_m2].map(|area| significant(area, 5));
    let hidden = if area == exposed {
        String::new()
    } else {
        format!(", of which {exposed} m² are not covered by another surface")
    };
    let mut text = format!(
        "  {}{object}: {} triangles, {area} m²{hidden}\n",
        material.name, material.triangles
    );
    let columns = ["value", "", "from"].map(|title| (title.to_owned(), Edge::Left));
    let mut given = Table::new(columns);
    let mut defaults = Vec::new();
    for value in &material.values {
        if value.origin == "default" {
            defaults.push(format!("{} {}", value.key, value.value));
        } else {
            given.row([
                value.key.to_owned(),
                value.value.clone(),
                value.origin.clone(),
            ]);
        }
    }
    if !given.is_empty() {
        text += &given.text("    ");
    }
    if !defaults.is_empty() {
        text += &format!("    default: {}\n", defaults.join(", "));
    }
    text
}

fn emitters(emitters: &[EmitterReport], unit: &str) -> Table {
    let flux = format!("flux, {unit}");
    let columns = [
        ("name", Edge::Left),
        ("kind", Edge::Left),
        (flux.as_str(), Edge::Right),
        ("strength", Edge::Right),
        ("Stokes vector", Edge::Left),
    ];
    let mut table = Table::new(columns.map(|(title, edge)| (title.to_owned(), edge)));
    for emitter in emitters {
        let per = match emitter.kind {
            "point" | "spot" => "sr",
            _ => "m²",
        };
        let [_, polarised @ ..] = emitter.state;
        let state = if polarised.iter().all(|component| component.abs() <= 0.0) {
            "unpolarised".to_owned()
        } else {
            format!("{:?}", emitter.state)
        };
        table.row([
            emitter.name.clone(),
            emitter.kind.to_owned(),
            emitter
                .flux
                .map_or("(infinite beam)".to_owned(), |flux| significant(flux, 5)),
            format!("{} {unit}/{per}", significant(emitter.strength, 5)),
            state,
        ]);
    }
    table
}

fn sensors(sensors: &[SensorReport]) -> Table {
    let columns = [
        ("name", Edge::Left),
        ("quantity", Edge::Left),
        ("layout", Edge::Left),
        ("points", Edge::Right),
        ("enclosed", Edge::Right),
        ("from, m", Edge::Left),
        ("to, m", Edge::Left),
    ];
    let mut table = Table::new(columns.map(|(title, edge)| (title.to_owned(), edge)));
    for sensor in sensors {
        let [low, high] = sensor.bounds_m.map(triple);
        let quantity = match sensor.direction {
            Some(direction) => format!("{} along {}", sensor.quantity, triple(direction)),
            None => sensor.quantity.to_owned(),
        };
        table.row([
            sensor.name.clone(),
            quantity,
            sensor.layout.to_owned(),
            sensor.count.to_string(),
            sensor.enclosed.to_string(),
            low,
            high,
        ]);
    }
    table
}

fn cameras(cameras: &[CameraReport]) -> Table {
    let columns = [
        ("name", Edge::Left),
        ("at, m", Edge::Left),
        ("looks along", Edge::Left),
        ("up", Edge::Left),
        ("across", Edge::Right),
        ("picture", Edge::Right),
        ("walks a pixel", Edge::Right),
    ];
    let mut table = Table::new(columns.map(|(title, edge)| (title.to_owned(), edge)));
    for camera in cameras {
        table.row([
            camera.name.clone(),
            triple(camera.position_m),
            triple(camera.forward),
            triple(camera.up),
            format!("{}°", significant(camera.fov_deg, 4)),
            format!("{} × {}", camera.width, camera.height),
            camera.samples.to_string(),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use malus_scene::ValueReport;

    #[test]
    fn a_material_shows_where_its_values_come_from() {
        let value = |key, value: &str, origin: &str| ValueReport {
            key,
            value: value.to_owned(),
            origin: origin.to_owned(),
        };
        let material = MaterialReport {
            name: "plaster".into(),
            object: None,
            triangles: 12,
            area_m2: 6.0,
            exposed_m2: 5.5,
            values: vec![
                value("rho", "0.5", "room.toml:9:7"),
                value("a", "0", "default"),
                value("n", "1.5", "default"),
            ],
        };
        assert_eq!(
            described(&material),
            "  plaster: 12 triangles, 6.0000 m², of which 5.5000 m² are not covered by another surface\n    \
             value       from\n    \
             rho    0.5  room.toml:9:7\n    \
             default: a 0, n 1.5\n"
        );
    }

    #[test]
    fn a_radiance_shows_where_its_sensor_looks() {
        let sensor = |quantity, direction| SensorReport {
            name: "screen".into(),
            quantity,
            direction,
            layout: "points",
            count: 1,
            enclosed: 0,
            bounds_m: [[1.0, 2.0, 0.5]; 2],
        };
        let text = |quantity, direction| sensors(&[sensor(quantity, direction)]).text("");
        assert!(text("radiance", Some([0.0, 0.0, -1.0])).contains("radiance along (0, 0, -1)"));
        assert!(text("radiance", None).contains("  radiance  points"));
        assert!(text("irradiance", None).contains("  irradiance  points"));
    }

    #[test]
    fn a_camera_shows_its_view_and_its_picture() {
        let camera = CameraReport {
            name: "door".into(),
            position_m: [0.5, 0.25, 1.6],
            forward: [0.0, 1.0, 0.0],
            up: [0.0, 0.0, 1.0],
            fov_deg: 70.0,
            width: 640,
            height: 480,
            samples: 64,
        };
        let text = cameras(&[camera]).text("");
        for part in [
            "door",
            "(0.5, 0.25, 1.6)",
            "(0, 1, 0)",
            "70.00°",
            "640 × 480",
            "64",
        ] {
            assert!(text.contains(part), "no {part:?} in:\n{text}");
        }
    }

    #[test]
    fn an_emitter_has_the_unit_of_its_kind() {
        let emitter = EmitterReport {
            name: "lamp".into(),
            kind: "point",
            flux: Some(125.663_706),
            strength: 10.0,
            state: [1.0, 0.0, 0.0, 0.0],
        };
        assert_eq!(
            emitters(&[emitter], "lm").text(""),
            "name  kind   flux, lm      strength  Stokes vector\n\
             lamp  point    125.66  10.000 lm/sr  unpolarised\n"
        );
    }
}
