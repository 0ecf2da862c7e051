//! Sensors where surfaces meet. In a furnace E = M/(1 − ρ) at every point, whichever way it faces.

use super::{cube, sensors, sheet};
use crate::experiment::{assert_estimate, measured, s0};

fn furnace(points: &[[f64; 3]], normal: [f64; 3], extra: &str, run: &str) -> String {
    format!(
        "{}{extra}
        [material.wall]
        rho = 0.5
        exitance = 1
        {}
        [run]
        samples = 8192
        {run}",
        cube("wall", [0.0; 3], [1.0; 3]),
        sensors(points, normal)
    )
}

/// Corners, edges, diagonals of the triangulation, faces.
const ON: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [1.0, 0.25, 1.0],
    [0.0, 1.0, 0.75],
    [0.5, 0.5, 0.0],
    [0.25, 0.25, 1.0],
    [0.3, 0.7, 0.0],
    [1.0, 0.5, 0.5],
];

#[test]
fn sensors_on_corners_edges_and_faces_are_inside_the_furnace() {
    for point in ON {
        // Towards the middle of the room, and along each face that the point lies on.
        let inward = point.map(|x| 0.5 - x);
        for normal in [
            inward,
            [inward[0], 0.0, 0.0],
            [0.0, inward[1], 0.0],
            [0.0, 0.0, inward[2]],
        ] {
            if normal.iter().all(|x| x.abs() == 0.0) {
                continue;
            }
            for estimator in ["auto", "gather"] {
                let run = format!("estimator = '{estimator}'");
                let what = format!("{estimator} at {point:?} facing {normal:?}");
                for reading in measured(&furnace(&[point], normal, "", &run)) {
                    assert_estimate(&what, s0(&reading), 2.0, 0.03);
                }
            }
        }
    }
}

/// 1e-12 m is less than the distance by which rays leave surfaces, 1e-9 m more.
#[test]
fn sensors_next_to_nothing_from_a_surface_are_on_the_side_that_they_face() {
    for gap in [1e-12, 1e-9] {
        for (z, up) in [
            (gap, 1.0),
            (-gap, 1.0),
            (1.0 - gap, -1.0),
            (1.0 + gap, -1.0),
        ] {
            let points = [[0.3, 0.6, z], [0.5, 0.5, z], [1e-12, 1e-12, z]];
            for reading in measured(&furnace(&points, [0.0, 0.0, up], "", "")) {
                let what = format!("{gap} at z = {z}");
                assert_estimate(&what, s0(&reading), 2.0, 0.02);
            }
        }
    }
}

/// Across the plane of a lamp's edge the sensor sees half of the hemisphere's symmetry: at the corner of a square lamp a
/// quarter of what four lamps about it would give.
#[test]
fn a_sensor_below_the_corner_of_a_lamp_has_a_quarter_of_four() {
    let lamps = |corners: &[[f64; 2]]| {
        let sheets: String = corners
            .iter()
            .map(|&[x, y]| sheet("lamp", [x, y, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]))
            .collect();
        let toml = format!(
            "{sheets}
            [material.lamp]
            rho = 0
            exitance = 1
            {}
            [run]
            samples = 65536",
            sensors(&[[0.0, 0.0, 0.0]], [0.0, 0.0, 1.0])
        );
        s0(&measured(&toml)[0])
    };
    // E/M of a unit square seen from 1 m below its corner, parallel: (1/2π)·2·(1/√2)·atan(1/√2).
    let root = 2f64.sqrt();
    let exact = (1.0 / root) * (1.0 / root).atan() / std::f64::consts::PI;
    assert_estimate("one", lamps(&[[0.0, 0.0]]), exact, 3e-3);
    let four = [[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [-1.0, -1.0]];
    assert_estimate("four", lamps(&four), 4.0 * exact, 3e-3);
}
