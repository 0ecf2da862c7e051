//! A closed room where each surface emits what it absorbs of E₀, M = (1 − ρ)E₀, holds E = E₀ at every point, however
//! rarely a walk ends (Kirchhoff's law; ideal mirrors neither absorb nor emit).

use super::{cube, sensors, sheet};
use crate::experiment::{assert_estimate, measured, s0};
use malus_scene::Scene;

const POINTS: [[f64; 3]; 3] = [[0.5, 0.5, 0.5], [0.001, 0.001, 0.001], [0.42, 0.42, 0.0]];
const NORMAL: [f64; 3] = [0.6, 0.0, 0.8];

/// A cube with a black patch of a side in its floor that emits 1.
fn patched(wall: &str, side: f64, points: &[[f64; 3]], run: &str) -> String {
    format!(
        "{}{}
        [material.wall]
        {wall}
        [material.patch]
        rho = 0
        exitance = 1
        {}
        [run]
        {run}",
        cube("wall", [0.0; 3], [1.0; 3]),
        sheet("patch", [0.4, 0.4, 0.0], [side, 0.0, 0.0], [0.0, side, 0.0]),
        sensors(points, NORMAL)
    )
}

/// A walk is scattered 6/0.1² = 600 times before the patch ends it.
#[test]
fn a_furnace_that_loses_next_to_nothing_is_even() {
    for wall in ["rho = 0.999999999\nexitance = 1e-9", "rho = 1"] {
        for reading in measured(&patched(wall, 0.1, &POINTS, "samples = 1024")) {
            assert_estimate(wall, s0(&reading), 1.0, 0.05);
        }
    }
}

/// Half of the events are mirror-like: thousands of them, each of probability ½, in one walk.
#[test]
fn weights_stay_finite_over_thousands_of_events() {
    let wall = "rho = 1\na = 0.5\nn = inf";
    for reading in measured(&patched(wall, 0.05, &POINTS[..1], "samples = 256")) {
        assert_estimate("half mirrors", s0(&reading), 1.0, 0.15);
    }
}

/// The lamp is seen in images behind hundreds of ideal mirrors.
#[test]
fn a_lamp_among_ideal_mirrors_fills_the_view() {
    let toml = patched(
        "rho = 0\na = 1\nn = inf",
        0.6,
        &POINTS[..1],
        "samples = 1024",
    );
    for reading in measured(&toml) {
        assert_estimate("mirrors", s0(&reading), 1.0, 0.03);
    }
}

/// E = M/(1 − ρ): a thousand events a walk.
#[test]
fn a_furnace_of_reflectance_0_999_is_a_thousand_times_as_bright() {
    let toml = format!(
        "{}
        [material.wall]
        rho = 0.999
        exitance = 1
        {}
        [run]
        samples = 2048",
        cube("wall", [0.0; 3], [1.0; 3]),
        sensors(&POINTS[..2], NORMAL)
    );
    for reading in measured(&toml) {
        assert_estimate("furnace", s0(&reading), 1e3, 0.04);
    }
}

/// A scene that is to be refused, with the message.
fn refused(toml: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, toml).unwrap();
    match Scene::load(&path, &[]) {
        Ok(_) => panic!("not refused: {toml}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_room_that_absorbs_nothing_is_refused() {
    for wall in [
        "rho = 1",
        "rho = 0.3\na = 1\nn = inf",
        "rho = 1\na = 0.5\nn = inf",
    ] {
        let toml = format!(
            "{}
            [material.wall]
            {wall}
            exitance = 1
            {}",
            cube("wall", [0.0; 3], [1.0; 3]),
            sensors(&POINTS, NORMAL)
        );
        let message = refused(&toml);
        assert!(message.contains("grows without bound"), "{wall}: {message}");
    }
}
