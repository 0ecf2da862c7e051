//! Exitance in, illuminance out: neither knows the size of the room, nor where it stands.

use super::{cube, sensors, unit_room};
use crate::experiment::{assert_estimate, measured, s0};

/// Side of the room and the coordinates of its corner, in m.
const PLACES: [(f64, f64); 3] = [(1e-3, 0.0), (1e4, 0.0), (1.0, 1e4)];

/// Illuminance at x = 0.1 and 0.5, y = 0.5 for a = 0, converged to 4e-5 (radiosity).
const DIFFUSE: [f64; 2] = [3.09795e-3, 3.79783e-3];
const DIFFUSE_UNCERTAINTY: f64 = 4e-5;

const POINTS: [[f64; 3]; 3] = [[0.1, 0.5, 0.0], [0.5, 0.5, 0.0], [0.01, 0.02, 0.0]];

#[test]
fn a_diffuse_room_of_any_size_has_the_exact_illuminance() {
    for (scale, origin) in PLACES {
        let toml = unit_room("rho = 0.5", scale, origin, &POINTS[..2], "samples = 131072");
        for (reading, exact) in measured(&toml).iter().zip(DIFFUSE) {
            let (value, error) = s0(reading);
            let combined = error.hypot(DIFFUSE_UNCERTAINTY * exact);
            let what = format!("scale {scale}, origin {origin}");
            assert_estimate(&what, (value, combined), exact, 1e-3);
        }
    }
}

#[test]
fn a_glossy_room_of_any_size_is_the_room_of_one_metre() {
    for a in [0.6, 1.0] {
        let room = |scale: f64, origin: f64, seed: u32| {
            let material = format!("rho = 0.5\na = {a}\nn = 1.5");
            let run = format!("samples = 32768\nseed = {seed}");
            measured(&unit_room(&material, scale, origin, &POINTS, &run))
        };
        let metre = room(1.0, 0.0, 100);
        for (seed, (scale, origin)) in (1..).zip(PLACES) {
            for (reading, one) in room(scale, origin, seed).iter().zip(&metre) {
                let what = format!("a = {a}, scale {scale}, origin {origin}");
                let ((value, error), (exact, uncertainty)) = (s0(reading), s0(one));
                assert_estimate(&what, (value, error.hypot(uncertainty)), exact, 1e-3);
                for i in 1..3 {
                    let error = reading.standard_error[i].hypot(one.standard_error[i]);
                    let difference = (reading.stokes[i] - one.stokes[i]).abs();
                    assert!(difference < 4.5 * error, "{what}, S{i}");
                }
            }
        }
    }
}

/// Ten million times its size away from the origin nothing is left of a room in single precision: its faces all lie
/// within `Surfaces::tolerance` of each other and would hide one another.
#[test]
fn a_room_lost_in_the_distance_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let toml = unit_room("rho = 0.5", 1e-3, 1e4, &POINTS[1..2], "samples = 16384");
    std::fs::write(&path, toml).unwrap();
    let error = malus_scene::Scene::load(&path, &[]).err();
    let error = error.map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("cannot be told apart"), "{error}");
}

/// Intensity by the square of the side: E is that of one metre.
#[test]
fn a_mirrored_box_with_a_point_source_of_any_size_is_that_of_one_metre() {
    let room = |scale: f64, origin: f64, seed: u32| {
        let at = |point: [f64; 3]| point.map(|x| origin + scale * x);
        measured(&format!(
            "{}
            [material.mirror]
            rho = 0.5
            a = 1
            n = 3
            [[source]]
            kind = 'point'
            position = {:?}
            intensity = {:?}
            {}
            [run]
            samples = 32768
            seed = {seed}",
            cube("mirror", at([0.0; 3]), at([1.0; 3])),
            at([0.3, 0.4, 0.7]),
            scale * scale,
            sensors(
                &[at([0.6, 0.55, 0.0]), at([0.01, 0.2, 0.0])],
                [0.0, 0.0, 1.0]
            )
        ))
    };
    let metre = room(1.0, 0.0, 100);
    for (seed, (scale, origin)) in (1..).zip(PLACES) {
        for (reading, one) in room(scale, origin, seed).iter().zip(&metre) {
            let ((value, error), (exact, uncertainty)) = (s0(reading), s0(one));
            let what = format!("scale {scale}, origin {origin}");
            assert_estimate(&what, (value, error.hypot(uncertainty)), exact, 2e-2);
        }
    }
}
