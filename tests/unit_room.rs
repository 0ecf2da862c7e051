//! The paper's room: a unit cube, ρ = 0.5, n = 1.5, lit by a disc of radius 0.05 and M = 1 in its ceiling.

use crate::experiment::{assert_estimate, measured, s0};
use std::f64::consts::PI;

fn room(a: f64, sensors: &str, run: &str) -> String {
    format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'plaster'
        [[shape]]
        kind = 'disc'
        centre = [0.5, 0.5, 1]
        normal = [0, 0, -1]
        radius = 0.05
        material = 'lamp'
        [material.plaster]
        rho = 0.5
        a = {a}
        n = 1.5
        [material.lamp]
        rho = 0
        exitance = 1
        [[sensor]]
        name = 'floor'
        {sensors}
        normal = [0, 0, 1]
        [run]
        {run}"
    )
}

const NINE: &str = "line = { from = [0.1, 0.5, 0], to = [0.9, 0.5, 0], count = 9 }";

/// Illuminance at x = 0.1 … 0.9, y = 0.5 on the floor for a = 0, known to 4e-5 from a converged radiosity solution.
const DIFFUSE: [f64; 9] = [
    3.09795e-3, 3.37907e-3, 3.60136e-3, 3.74677e-3, 3.79783e-3, 3.74677e-3, 3.60136e-3, 3.37907e-3,
    3.09795e-3,
];

/// The reference's own uncertainty, as a share.
const DIFFUSE_UNCERTAINTY: f64 = 4e-5;

fn diffuse_room_agrees(estimator: &str, samples: u64) {
    let run = format!("estimator = '{estimator}'\nsamples = {samples}");
    for (reading, exact) in measured(&room(0.0, NINE, &run)).iter().zip(DIFFUSE) {
        let (value, error) = s0(reading);
        let combined = error.hypot(DIFFUSE_UNCERTAINTY * exact);
        assert_estimate(estimator, (value, combined), exact, 1e-3);
    }
}

#[test]
fn diffuse_room_agrees_by_local() {
    diffuse_room_agrees("local", 2_097_152);
}

#[test]
fn diffuse_room_agrees_by_gather() {
    diffuse_room_agrees("gather", 262_144);
}

/// The direct part at the same points.
#[test]
fn black_room_has_the_direct_light_of_a_disc() {
    let direct = [1.85556e-3, 2.10057e-3, 2.30648e-3, 2.44487e-3, 2.49377e-3];
    let toml =
        room(0.0, NINE, "samples = 131072\nestimator = 'gather'").replace("rho = 0.5", "rho = 0");
    for (reading, exact) in measured(&toml).iter().zip(direct) {
        // The table is rounded at the sixth digit, the disc is a polygon of 128 sides and of the disc's area.
        let (value, error) = s0(reading);
        assert_estimate("direct", (value, error.hypot(3e-6 * exact)), exact, 1e-4);
    }
}

/// a = 1, unit luminance, by images alone: point, scalar Fresnel, Stokes, relative difference.
const MIRRORED: [(&str, f64, f64, f64); 3] = [
    (
        "points = [[0.25, 0.25, 0]]",
        0.006_728,
        0.006_715,
        -1.966e-3,
    ),
    ("points = [[0.5, 0.25, 0]]", 0.007_421, 0.007_411, -1.376e-3),
    ("points = [[0.5, 0.5, 0]]", 0.008_250, 0.008_242, -9.71e-4),
];

#[test]
fn mirrored_room_agrees_with_its_images() {
    for (point, scalar, stokes, difference) in MIRRORED {
        let reading = measured(&room(1.0, point, "estimator = 'gather'\nsamples = 8388608"))[0];
        let paired = reading.scalar.unwrap();
        // Four digits are given: half of the last is the table's own uncertainty.
        let table = 0.5e-6 / 3f64.sqrt();
        let (value, error) = s0(&reading);
        assert_estimate(
            "Stokes",
            (value * PI, (error * PI).hypot(table)),
            stokes,
            2e-3,
        );
        let error = (paired.standard_error * PI).hypot(table);
        assert_estimate("scalar", (paired.value * PI, error), scalar, 2e-3);
        let relative = (
            paired.difference / paired.value,
            paired.difference_standard_error / paired.value,
        );
        assert_estimate("difference", relative, difference, 0.1);
    }
}

/// The lamp's images in the glossy walls are met by one walk in thousands. A run that stops by its error must not stop
/// before it has met them: in ten seeds its values agree with a long run of another seed.
#[test]
fn a_run_that_stops_by_its_error_has_not_overlooked_the_lamp_in_the_mirrors() {
    let points = "points = [[0.4, 0.5, 0], [0.6, 0.5, 0]]";
    let long = "estimator = 'gather'\nsamples = 4194304\nseed = 100";
    // The two points mirror each other.
    let reference: Vec<(f64, f64)> = measured(&room(0.6, points, long)).iter().map(s0).collect();
    let exact = (reference[0].0 + reference[1].0) / 2.0;
    let uncertainty = reference[0].1.hypot(reference[1].1) / 2.0;
    for seed in 1..=10 {
        let run = format!("estimator = 'gather'\nrelative_error = 0.01\nseed = {seed}");
        for reading in measured(&room(0.6, points, &run)) {
            let (value, error) = s0(&reading);
            assert_estimate("stopped", (value, error.hypot(uncertainty)), exact, 0.0105);
        }
    }
}
