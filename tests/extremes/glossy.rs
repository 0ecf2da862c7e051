//! Refractive indices, extinctions and fractions at the ends of what is allowed.

use super::{assert_physical, cube, sensors, unit_room};
use crate::experiment::{assert_estimate, measured, s0};

const POINTS: [[f64; 3]; 2] = [[0.3, 0.4, 0.0], [0.001, 0.001, 0.0]];

fn room(material: &str, run: &str) -> Vec<malus_estimator::Reading> {
    measured(&unit_room(material, 1.0, 0.0, &POINTS, run))
}

#[test]
fn every_index_gives_finite_physical_light() {
    for n in [
        "1e-12",
        "0.5",
        "0.999999999999",
        "1",
        "1.000000000001",
        "1000",
        "inf",
    ] {
        for k in ["0", "1000"] {
            for a in ["0", "0.5", "1"] {
                let material = format!("rho = 0.5\na = {a}\nn = {n}\nk = {k}");
                for reading in room(&material, "samples = 64\ncompare = ['scalar', 'diffuse']") {
                    assert_physical(&material, &reading);
                }
            }
        }
    }
}

/// No polarised state of a lamp, mirrored by anything, is more than fully polarised.
#[test]
fn polarised_lamps_stay_physical_in_every_mirror() {
    for (n, k) in [
        ("1e-12", "0"),
        ("0.5", "0"),
        ("1.000000000001", "0"),
        ("1000", "0"),
        ("1", "1000"),
    ] {
        let toml = unit_room(
            &format!("rho = 0.5\na = 0.5\nn = {n}\nk = {k}"),
            1.0,
            0.0,
            &POINTS,
            "samples = 1024\nrepresentation = 'full'",
        )
        .replace(
            "exitance = 1",
            "exitance = 1\nemission_stokes = [1, 0.6, 0, 0.8]",
        );
        for reading in measured(&toml) {
            assert_physical(&format!("n = {n}, k = {k}"), &reading);
        }
    }
}

/// What an index of 1 does not reflect is lost: Lambert's reflectance is ρ(1 − a).
#[test]
fn an_index_of_one_leaves_the_diffuse_part() {
    for n in ["1", "1.000000000001", "0.999999999999"] {
        for a in [0.5, 1.0] {
            let glossy = room(&format!("rho = 0.5\na = {a}\nn = {n}"), "samples = 16384");
            let plain = room(
                &format!("rho = {}", 0.5 * (1.0 - a)),
                "samples = 16384\nseed = 2",
            );
            for (one, other) in glossy.iter().zip(&plain) {
                let ((value, error), (exact, uncertainty)) = (s0(one), s0(other));
                let what = format!("n = {n}, a = {a}");
                assert_estimate(&what, (value, error.hypot(uncertainty)), exact, 3e-3);
                // Polarised light is as little as the reflectance, which is of the square of n − 1; grazing light alone
                // is reflected.
                assert!(one.dolp < 1e-9, "{what}: {}", one.dolp);
            }
        }
    }
}

/// An index of 1000 at normal incidence: R = (999/1001)², and a sensor below a lamp over a mirror faces its image.
#[test]
fn a_high_index_mirrors_by_fresnels_law() {
    let toml = |n: &str, a: f64| {
        format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [-5, -5, 0]
            u = [10, 0, 0]
            v = [0, 10, 0]
            material = 'mirror'
            [material.mirror]
            rho = 0
            a = {a}
            n = {n}
            [[source]]
            kind = 'point'
            position = [0, 0, 1]
            intensity = 9
            {}
            [run]
            samples = 64",
            sensors(&[[0.0, 0.0, 2.0]], [0.0, 0.0, -1.0])
        )
    };
    // The image is 3 m away and sends 9·R/9, beside the source itself at 1 m, which sends 9.
    for (n, a, reflectance) in [
        ("inf", 1.0, 1.0),
        ("1000", 1.0, (999.0f64 / 1001.0).powi(2)),
        ("1e-12", 1.0, ((1.0 - 1e-12) / (1.0 + 1e-12f64)).powi(2)),
        ("1000", 0.25, 0.25 * (999.0f64 / 1001.0).powi(2)),
        ("1", 1.0, 0.0),
    ] {
        let reading = measured(&toml(n, a))[0];
        let mirrored = reading.stokes[0] - 9.0;
        assert!(
            (mirrored - reflectance).abs() < 4.5 * reading.standard_error[0] + 1e-6,
            "n = {n}, a = {a}: {mirrored} ± {}, exactly {reflectance}",
            reading.standard_error[0]
        );
        assert_physical(n, &reading);
    }
}

/// A furnace of ideal mirrors and black emitters in one, a of each: E = M/(1 − a − (1 − a)ρ) with a diffuse emission of
/// (1 − a) and ρ: the mirrors change nothing.
#[test]
fn ideal_mirrors_in_a_furnace_change_nothing() {
    for a in [0.1, 0.5, 0.9] {
        let toml = format!(
            "{}
            [material.wall]
            rho = 0.5
            a = {a}
            n = inf
            exitance = {}
            {}
            [run]
            samples = 1024",
            cube("wall", [0.0; 3], [1.0; 3]),
            0.5 * (1.0 - a),
            sensors(&[[0.5, 0.5, 0.5], [0.001, 0.3, 0.0]], [0.0, 0.0, 1.0])
        );
        for reading in measured(&toml) {
            assert_estimate(&format!("a = {a}"), s0(&reading), 1.0, 0.05);
        }
    }
}
