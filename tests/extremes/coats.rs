//! Coats and panes at the ends of their ranges.

use super::{assert_physical, cube, sensors, sheet, unit_room};
use crate::experiment::{assert_estimate, measured, s0};
use malus_estimator::Reading;

const POINTS: [[f64; 3]; 2] = [[0.3, 0.4, 0.0], [0.02, 0.5, 0.0]];

fn room(material: &str, run: &str) -> Vec<Reading> {
    measured(&unit_room(material, 1.0, 0.0, &POINTS, run))
}

#[track_caller]
fn assert_same(what: &str, one: &[Reading], other: &[Reading], ceiling: f64) {
    for (one, other) in one.iter().zip(other) {
        let ((value, error), (exact, uncertainty)) = (s0(one), s0(other));
        assert_estimate(what, (value, error.hypot(uncertainty)), exact, ceiling);
    }
}

#[test]
fn a_coat_of_index_one_is_no_coat() {
    for rho in [0.0, 0.5, 0.9] {
        let coated = room(
            &format!("kind = 'coated'\nrho = {rho}\nn = 1"),
            "samples = 8192",
        );
        let plain = room(&format!("rho = {rho}"), "samples = 8192\nseed = 2");
        assert_same(&format!("rho = {rho}"), &coated, &plain, 1e-2);
    }
}

/// Over a black base a coat is Fresnel's mirror.
#[test]
fn a_coat_over_black_is_a_mirror() {
    for n in ["1.5", "100"] {
        let coated = room(
            &format!("kind = 'coated'\nrho = 0\nn = {n}"),
            "samples = 8192",
        );
        let mirror = room(
            &format!("rho = 0.7\na = 1\nn = {n}"),
            "samples = 8192\nseed = 2",
        );
        assert_same(n, &coated, &mirror, 0.05);
        for reading in coated {
            assert_physical(n, &reading);
        }
    }
}

/// A coat over a base that loses nothing loses nothing: between such walls a black emitter fills the view (Kirchhoff).
#[test]
fn a_coat_over_white_loses_nothing() {
    for (n, ceiling) in [("1", 0.02), ("1.5", 0.03), ("100", 0.06)] {
        let toml = format!(
            "{}{}
            [material.wall]
            kind = 'coated'
            rho = 1
            n = {n}
            [material.patch]
            rho = 0
            exitance = 1
            {}
            [run]
            samples = 2048",
            cube("wall", [0.0; 3], [1.0; 3]),
            sheet("patch", [0.1, 0.1, 0.0], [0.8, 0.0, 0.0], [0.0, 0.8, 0.0]),
            sensors(&[[0.5, 0.5, 0.5], [0.9, 0.2, 0.3]], [0.6, 0.0, 0.8])
        );
        for reading in measured(&toml) {
            assert_estimate(&format!("n = {n}"), s0(&reading), 1.0, ceiling);
        }
    }
}

/// The paper's room with a sheet across it at half its height.
fn divided(sheet_material: &str, run: &str) -> Vec<Reading> {
    let divided = if sheet_material.is_empty() {
        String::new()
    } else {
        let across = sheet("sheet", [0.0, 0.0, 0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        format!("{across}\n[material.sheet]\n{sheet_material}\n")
    };
    measured(&(divided + &unit_room("rho = 0.5\na = 0.2\nn = 1.5", 1.0, 0.0, &POINTS, run)))
}

#[test]
fn a_pane_of_index_one_is_not_there() {
    let run = "samples = 4096";
    let open = divided("", run);
    let pane = divided("kind = 'pane'\nn = 1\ntau = 1", run);
    assert_same("pane", &pane, &open, 1e-2);
}

#[test]
fn a_pane_that_passes_nothing_is_a_wall() {
    for n in ["1", "1.5"] {
        for reading in divided(
            &format!("kind = 'pane'\nn = {n}\ntau = 0"),
            "samples = 1024",
        ) {
            assert!(reading.stokes[0].abs() == 0.0, "{reading:?}");
        }
    }
}

#[test]
fn panes_of_any_index_are_physical() {
    for n in ["1.000000000001", "100"] {
        for tau in ["0.000000000001", "1"] {
            let pane = format!("kind = 'pane'\nn = {n}\ntau = {tau}");
            for reading in divided(&pane, "samples = 512") {
                assert_physical(&pane, &reading);
            }
        }
    }
}
