//! A furnished office against an independent program.

use crate::experiment::{readings, repository};
use malus_estimator::{Answer, run};
use malus_scene::{Estimator, Scene};

/// Total illuminance and its relative standard error at each point, in the order of the sensors.
fn reference() -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(repository("tests/data/office_ref.txt")).unwrap();
    text.lines()
        .map(|line| {
            let columns: Vec<f64> = line
                .split_whitespace()
                .map(|word| word.parse().unwrap())
                .collect();
            (columns[5], columns[6])
        })
        .collect()
}

#[test]
fn free_sensors_agree_and_those_inside_furniture_are_marked() {
    let scene = Scene::load(&repository("tests/data/reference_office.toml"), &[]).unwrap();
    let mut settings = scene.settings.clone();
    settings.estimator = Estimator::Gather;
    settings.relative_error = None;
    settings.samples = Some(16_384);
    let results = run(&scene, &settings, &mut |_| Answer::Continue);
    let readings = readings(&results);
    assert_eq!(readings.len(), 273);
    let mut enclosed = 0;
    for (point, (reading, (exact, share))) in readings.iter().zip(reference()).enumerate() {
        if reading.enclosed {
            enclosed += 1;
            continue;
        }
        let error = reading.standard_error[0];
        let z = (reading.stokes[0] - exact) / error.hypot(share * exact);
        assert!(
            z.abs() < 4.5,
            "point {point}: {} against {exact}: z = {z:.2}",
            reading.stokes[0]
        );
        assert!(error < 0.01 * exact, "point {point}: {error} of {exact}");
    }
    assert_eq!(enclosed, 9);
}
