//! Sensors where surfaces meet. In a furnace E = M/(1 − ρ) at every point, whichever way it faces.

use super::{cube, sensors, sheet};
use crate::experiment::{assert_estimate, assert_exact, measured, s0};

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

/// In the corner of two mirrors a source and its three images stand in one direction up to signs: E = 4 I h/r³ of a point and
/// 4 E₀ h/r of parallel light, also where the source stands in the plane between the mirrors, so that neither is met first by
/// the geometry.
#[test]
fn a_sensor_in_the_corner_of_two_mirrors_sees_all_four_images() {
    let quarter = std::f64::consts::FRAC_PI_4;
    for turn in [0, 1, 2, 3, 5, 7]
        .map(|n| f64::from(n) * quarter)
        .into_iter()
        .chain([0.3])
    {
        let (sin, cos) = turn.sin_cos();
        let [u, v] = [[cos, sin, 0.0], [-sin, cos, 0.0]];
        for [x, y] in [[0.0, 0.0], [1.0, 1.0], [-0.7, 1.3]] {
            for (along, across) in [(0.5, 0.5), (0.3, 0.8)] {
                let up = [0.0, 0.0, 40.0];
                // With their normals towards the source: on that side of a wall along its normal a sensor lies.
                let walls = [
                    sheet("glass", [x, y, -20.0], up, u.map(|c| 20.0 * c)),
                    sheet("glass", [x, y, -20.0], v.map(|c| 20.0 * c), up),
                ];
                let toward = [0, 1].map(|axis| along * u[axis] + across * v[axis]);
                let readings = measured(&format!(
                    "{}{}
                    [material.glass]
                    rho = 0
                    a = 1
                    n = inf
                    [[source]]
                    kind = 'point'
                    position = [{}, {}, 0.6]
                    intensity = 2
                    [[source]]
                    kind = 'distant'
                    direction = [{}, {}, -0.5]
                    irradiance = 0.7
                    [run]
                    samples = 64",
                    walls.concat(),
                    sensors(&[[x, y, 0.1]], [0.0, 0.0, 1.0]),
                    x + toward[0],
                    y + toward[1],
                    -toward[0],
                    -toward[1],
                ));
                let square = along * along + across * across + 0.25;
                let exact = 4.0 * (2.0 * 0.5 / square + 0.7 * 0.5) / square.sqrt();
                let what = format!("turned by {turn}, ({x}, {y}), ({along}, {across})");
                assert_exact(&what, readings[0].stokes[0], exact, 1e-8);
            }
        }
    }
}

/// A source in the middle of a cube whose side walls are ideal mirrors, and sensors on its black floor, in corners, too: the
/// images are a square lattice, E = Σ I h/r³. What lies beyond the square |x|, |y| < n brings 4 √2 I h/n.
#[test]
fn sensors_in_the_corners_of_a_mirrored_box_see_a_whole_lattice() {
    let points = [[0.5, 0.5], [0.0, 0.5], [0.0, 0.0], [1.0, 1.0], [1.0, 0.0]];
    let readings = measured(&format!(
        "{}{}{}
        [material.glass]
        rho = 0
        a = 1
        n = inf
        [material.black]
        rho = 0
        [[source]]
        kind = 'point'
        position = [0.5, 0.5, 0.5]
        intensity = 1
        [run]
        samples = 8192",
        cube("glass", [0.0; 3], [1.0; 3]),
        [0.0, 1.0]
            .map(|z| sheet("black", [0.0, 0.0, z], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]))
            .concat(),
        sensors(&points.map(|[x, y]| [x, y, 0.0]), [0.0, 0.0, 1.0]),
    ));
    const SIDE: i32 = 300;
    for (reading, [x, y]) in readings.iter().zip(points) {
        let mut exact = 4.0 * 2f64.sqrt() * 0.5 / f64::from(SIDE);
        for i in -SIDE..SIDE {
            for j in -SIDE..SIDE {
                let (dx, dy) = (f64::from(i) + 0.5 - x, f64::from(j) + 0.5 - y);
                let square = dx * dx + dy * dy + 0.25;
                exact += 0.5 / (square * square.sqrt());
            }
        }
        assert_estimate(&format!("({x}, {y})"), s0(reading), exact, 0.01);
    }
}

/// Shares are told by where a walk has met a surface: moved off it, the point would be elsewhere as seen from next to it.
#[test]
fn sensors_in_one_corner_share_their_walks_rightly() {
    let block = "[[shape]]
        kind = 'box'
        min = [0.6, 0.6, 0.3]
        max = [0.7, 0.7, 0.5]
        material = 'wall'
        [[sensor]]
        name = 'tilted'
        points = [[0, 0, 0], [0.5, 0.5, 0]]
        normal = [0.5, 0.5, 0.5]";
    let points = [[1e-12; 3], [0.3, 0.6, 0.0], [0.2, 5e-10, 0.0]];
    let room = furnace(&points, [0.0, 0.0, 1.0], block, "");
    for reading in measured(&room) {
        assert_estimate("together", s0(&reading), 2.0, 0.02);
    }
}
