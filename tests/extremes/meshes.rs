//! Meshes as nobody would draw them: in a furnace E = M/(1 − ρ), and no ray leaves.

use super::{cube, sensors};
use crate::experiment::{assert_estimate, evaluate, measured, readings, s0, scene, scene_beside};
use glam::DVec3;
use malus_scene::Scene;

/// A wall as quads, each from one corner to the opposite one in the coordinates of the wall, 0 … 1.
type Quads = Vec<[[f64; 2]; 2]>;

/// Columns of different widths, cut into rows at different heights: every vertex inside is a T-junction.
fn irregular() -> Quads {
    let columns = [0.0, 0.07, 0.31, 1.0 / 3.0, 0.5, 0.83, 1.0];
    let mut quads = Vec::new();
    for (index, pair) in columns.windows(2).enumerate() {
        let rows = index + 2;
        let at = |row: usize| {
            let share = row as f64 / rows as f64;
            share * share
        };
        for row in 0..rows {
            quads.push([[pair[0], at(row)], [pair[1], at(row + 1)]]);
        }
    }
    quads
}

/// Strips of 10⁻⁹ of their length, across one another's ends.
fn slivers() -> Quads {
    vec![
        [[0.0, 0.0], [1.0, 1e-9]],
        [[0.0, 1e-9], [0.4, 1.0]],
        [[0.4, 1e-9], [0.4 + 1e-9, 1.0]],
        [[0.4 + 1e-9, 1e-9], [1.0, 0.7]],
        [[0.4 + 1e-9, 0.7], [1.0, 0.7 + 1e-9]],
        [[0.4 + 1e-9, 0.7 + 1e-9], [1.0, 1.0]],
    ]
}

/// The floor twice over in the same triangles, and once more in others.
fn doubled() -> Quads {
    let whole = [[0.0, 0.0], [1.0, 1.0]];
    let halves = [[[0.0, 0.0], [0.3, 1.0]], [[0.3, 0.0], [1.0, 1.0]]];
    vec![whole, whole, halves[0], halves[1]]
}

/// The unit cube with its inside in sight, each of its faces made of these quads; a model in the format OBJ.
fn model(quads: &Quads) -> String {
    // Origin, u and v of each face, u × v inwards.
    let faces = [
        ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
        ([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ];
    let mut text = String::from("o room\nusemtl wall\n");
    let mut corners = String::new();
    let mut count = 0;
    for (origin, u, v) in faces.map(|(o, u, v)| (DVec3::from(o), DVec3::from(u), DVec3::from(v))) {
        for [[a, b], [c, d]] in quads {
            for (s, t) in [(a, b), (c, b), (c, d), (a, d)] {
                let at = origin + u * *s + v * *t;
                text += &format!("v {:?} {:?} {:?}\n", at.x, at.y, at.z);
            }
            corners += &format!("f {} {} {}\n", count + 1, count + 2, count + 3);
            corners += &format!("f {} {} {}\n", count + 1, count + 3, count + 4);
            count += 4;
        }
    }
    text + &corners
}

fn room(quads: &Quads, points: &[[f64; 3]], normal: [f64; 3], samples: u64) -> Scene {
    let toml = format!(
        "[[mesh]]
        file = 'room.obj'
        up = 'z'
        [material.wall]
        rho = 0.5
        exitance = 1
        {}
        [run]
        samples = {samples}",
        sensors(points, normal)
    );
    scene_beside(&[("room.obj", &model(quads))], &toml)
}

/// On a T-junction, on an edge, on a sliver, and inside.
const POINTS: [[f64; 3]; 5] = [
    [1.0 / 3.0, 0.25, 0.0],
    [0.31, 0.6, 0.0],
    [0.4, 0.7, 0.0],
    [0.4, 0.7, 0.5],
    [0.2, 5e-10, 0.0],
];

#[test]
fn furnaces_of_odd_meshes_are_even() {
    let kinds = [
        ("irregular", irregular()),
        ("slivers", slivers()),
        ("doubled", doubled()),
    ];
    for (name, quads) in kinds {
        let scene = room(&quads, &POINTS, [0.0, 0.0, 1.0], 16384);
        for reading in readings(&evaluate(&scene)) {
            assert_estimate(name, s0(&reading), 2.0, 0.02);
        }
    }
}

/// Sine of the angle to a face below which a ray is not asked to meet it, here that of 10⁻⁹ rad.
const GRAZING: f64 = 1e-9;

/// Rays through vertices, along edges and between: from inside, and from points right above an edge, looking along it.
#[test]
fn no_ray_leaves_a_closed_room_by_a_vertex_or_along_an_edge() {
    for (name, quads) in [
        ("irregular", irregular()),
        ("slivers", slivers()),
        ("doubled", doubled()),
    ] {
        let scene = room(&quads, &POINTS, [0.0, 0.0, 1.0], 64);
        let surfaces = &scene.surfaces;
        let origins = [
            DVec3::new(0.5, 0.5, 0.5),
            DVec3::new(0.31, 0.6, 0.2),
            DVec3::new(1.0 / 3.0, 0.25, surfaces.offset()),
            DVec3::new(0.4, 0.7, surfaces.offset()),
        ];
        for triangle in 0..surfaces.len() as u32 {
            let [a, b, c] = surfaces.triangle(triangle).vertices;
            for origin in origins {
                for target in [a, b, c, 0.5 * (a + b), 0.3 * b + 0.7 * c, (a + b + c) / 3.0] {
                    let ray = target - origin;
                    // Within the plane of a face a ray along it is neither inside nor out.
                    let sine = ray.normalize_or_zero().dot(surfaces.normal(triangle)).abs();
                    if sine < GRAZING {
                        continue;
                    }
                    let what = format!("{name}: from {origin} to {target}");
                    assert!(!surfaces.escapes(origin, ray.normalize()), "{what}");
                }
                for edge in [b - a, c - b, a - c] {
                    let along = edge.normalize();
                    // Where the edge runs on through a wall behind the origin is inside as well.
                    assert!(
                        !surfaces.escapes(origin, along),
                        "{name}: {origin} along {along}"
                    );
                    assert!(
                        !surfaces.escapes(origin, -along),
                        "{name}: {origin} along {along}"
                    );
                }
            }
        }
    }
}

/// Two rooms with walls of no thickness this far apart: one a furnace, one dark.
fn neighbours(gap: f64, dark_first: bool) -> String {
    let bright = cube("bright", [0.0, 0.0, 0.5 + 0.5 * gap], [1.0, 1.0, 1.0]);
    let dark = cube("dark", [0.0, 0.0, 0.0], [1.0, 1.0, 0.5 - 0.5 * gap]);
    let both = if dark_first {
        dark + &bright
    } else {
        bright + &dark
    };
    format!(
        "{both}
        [material.bright]
        rho = 0.5
        exitance = 1
        [material.dark]
        rho = 0.5
        {}{}
        [run]
        samples = 16384",
        sensors(
            &[[0.3, 0.6, 0.7], [0.3, 0.6, 0.5 + 0.5 * gap]],
            [0.0, 0.0, 1.0]
        ),
        sensors(
            &[[0.3, 0.6, 0.2], [0.3, 0.6, 0.5 - 0.5 * gap]],
            [0.0, 0.0, -1.0]
        )
        .replace("'points'", "'dark'"),
    )
}

#[test]
fn walls_that_nearly_touch_keep_light_on_its_side() {
    for dark_first in [false, true] {
        // Nearer than single precision tells, one of the two surfaces stands for both.
        let readings = measured(&neighbours(1e-5, dark_first));
        for reading in &readings[..2] {
            assert_estimate("bright", s0(reading), 2.0, 0.02);
        }
        for reading in &readings[2..] {
            assert!(reading.stokes[0].abs() == 0.0, "{reading:?}");
        }
    }
}

/// At 10⁻⁶ m in a room of 1 m the surfaces count as one: it is said so, and light stays on its side all the same.
#[test]
fn walls_that_touch_by_single_precision_are_named_and_dark_rooms_stay_dark() {
    for dark_first in [false, true] {
        let scene = scene(&neighbours(1e-6, dark_first));
        assert_eq!(scene.coincidences.len(), 1, "{:?}", scene.coincidences);
        let readings = readings(&evaluate(&scene));
        assert!(readings[2].stokes[0].abs() == 0.0, "{readings:?}");
        assert!(
            readings
                .iter()
                .all(|r| r.stokes[0] <= 2.0 + 4.5 * r.standard_error[0])
        );
    }
}
