//! Surfaces in one place: the later one exists.

use crate::testing::{Uniform, grid, surfaces};
use crate::{Surfaces, shape};
use glam::{DQuat, DVec3};

/// A ceiling at z = 2.8 facing down, 6 m × 4 m, and lamps in it given by corner, width and depth.
fn ceiling() -> shape::Faces {
    grid(DVec3::Z * 2.8, DVec3::Y * 4.0, DVec3::X * 6.0, [2, 3])
}

fn lamp(x: f64, y: f64, width: f64, depth: f64) -> shape::Faces {
    shape::rectangle(DVec3::new(x, y, 2.8), DVec3::Y * depth, DVec3::X * width)
}

fn object_over(surfaces: &Surfaces, x: f64, y: f64) -> Option<u32> {
    let above = surfaces.nearest(DVec3::new(x, y, 0.0), DVec3::Z);
    let below = surfaces.nearest(DVec3::new(x, y, 5.0), DVec3::NEG_Z);
    let object = |hit: crate::Hit| surfaces.object(hit.triangle);
    assert_eq!(above.map(object), below.map(object), "from either side");
    above.map(object)
}

#[test]
fn a_lamp_flush_in_a_ceiling_exists_and_the_ceiling_there_does_not() {
    let scene = surfaces(&[ceiling(), lamp(2.5, 1.5, 0.6, 0.6)]);
    assert_eq!(object_over(&scene, 2.8, 1.7), Some(1));
    assert_eq!(object_over(&scene, 2.4, 1.7), Some(0));
    let found = scene.coincidences();
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].hidden_object, found[0].covering_object), (0, 1));
    assert!((found[0].area - 0.36).abs() < 1e-12);
    let exposed = |object| -> f64 {
        (0..scene.len() as u32)
            .filter(|&triangle| scene.object(triangle) == object)
            .map(|triangle| scene.exposed_area(triangle))
            .sum()
    };
    assert!((exposed(0) - 23.64).abs() < 1e-12);
    assert!((exposed(1) - 0.36).abs() < 1e-12);
}

#[test]
fn a_ceiling_after_the_lamp_hides_all_of_it() {
    let scene = surfaces(&[lamp(2.5, 1.5, 0.6, 0.6), ceiling()]);
    assert_eq!(object_over(&scene, 2.8, 1.7), Some(1));
    assert!((0..2).all(|triangle| scene.exposed_area(triangle) < 1e-15));
    assert_eq!(scene.coincidences()[0].hidden_object, 0);
}

#[test]
fn the_hidden_part_is_the_one_not_exposed() {
    let scene = surfaces(&[ceiling(), lamp(2.5, 1.5, 0.6, 0.6)]);
    let mut uniform = Uniform(1);
    for _ in 0..20_000 {
        let triangle = uniform.index(scene.len()) as u32;
        let point = scene
            .triangle(triangle)
            .point_at([uniform.next(), uniform.next()]);
        let met = scene.nearest(point - DVec3::Z, DVec3::Z).unwrap();
        let same = scene.object(met.triangle) == scene.object(triangle);
        assert_eq!(scene.exposed(triangle, point), same);
        assert!(!scene.visible(point - DVec3::Z, point + DVec3::Z));
    }
}

#[test]
fn coverers_that_overlap_count_once() {
    // Two lamps of 1 m² with half of each in common, in a ceiling: 1.5 m² hidden, and half of the earlier lamp.
    let scene = surfaces(&[
        ceiling(),
        lamp(2.0, 1.0, 1.0, 1.0),
        lamp(2.5, 1.0, 1.0, 1.0),
    ]);
    let rows: Vec<_> = scene
        .coincidences()
        .iter()
        .map(|row| {
            (
                row.hidden_object,
                row.covering_object,
                (row.area * 1e9).round() / 1e9,
            )
        })
        .collect();
    assert_eq!(rows, [(0, 1, 0.5), (0, 2, 1.0), (1, 2, 0.5)]);
    assert_eq!(object_over(&scene, 2.7, 1.5), Some(2));
    assert_eq!(object_over(&scene, 2.2, 1.5), Some(1));
}

#[test]
fn a_lamp_facing_away_hides_as_well() {
    let (positions, mut triangles) = lamp(2.5, 1.5, 0.6, 0.6);
    for triangle in &mut triangles {
        triangle.swap(0, 1);
    }
    let scene = surfaces(&[ceiling(), (positions, triangles)]);
    assert_eq!(object_over(&scene, 2.8, 1.7), Some(1));
}

#[test]
fn surfaces_that_touch_or_cross_or_lie_apart_hide_nothing() {
    let tilted = DQuat::from_rotation_x(1e-3);
    let (positions, triangles) = lamp(2.5, 1.5, 0.6, 0.6);
    let crossing = positions
        .iter()
        .map(|&corner| tilted * (corner - positions[0]) + positions[0])
        .collect();
    let apart = positions
        .iter()
        .map(|&corner| corner - DVec3::Z * 1e-3)
        .collect();
    for other in [
        (crossing, triangles.clone()),
        (apart, triangles),
        lamp(6.0, 0.0, 1.0, 4.0),
        shape::cuboid(DVec3::ZERO, DVec3::new(6.0, 4.0, 2.0), true),
        shape::rectangle(DVec3::Z * 2.8, DVec3::X, DVec3::NEG_Z),
    ] {
        let scene = surfaces(&[ceiling(), other]);
        assert_eq!(scene.coincidences(), []);
        assert!((0..scene.len() as u32).all(|triangle| {
            (scene.exposed_area(triangle) - scene.triangle(triangle).area()).abs() < 1e-15
        }));
    }
}

#[test]
fn single_precision_leaves_surfaces_coincident_and_their_rim_tight() {
    // Corners rounded as mesh files hold them, in a plane out of the axes: planes differ by rounding, up to a micron.
    let turn = DQuat::from_xyzw(0.1, 0.5, -0.3, 0.7).normalize();
    let rounded = |(positions, triangles): shape::Faces| {
        let round = |&corner: &DVec3| (turn * corner).as_vec3().as_dvec3();
        (positions.iter().map(round).collect(), triangles)
    };
    let mut scene = Vec::from([rounded(ceiling())]);
    scene.push(rounded(lamp(2.5, 1.5, 0.6, 0.6)));
    let scene = surfaces(&scene);
    let area: f64 = scene.coincidences().iter().map(|row| row.area).sum();
    assert!((area - 0.36).abs() < 1e-5);
    let mut uniform = Uniform(2);
    for index in 0..100_000 {
        // At the lamp, at every other try at its rim, from both sides and at any angle.
        let mut place = [2.5 + 0.6 * uniform.next(), 1.5 + 0.6 * uniform.next()];
        if index % 2 == 0 {
            place[0] = 2.5;
        }
        let to = turn * DVec3::new(place[0], place[1], 2.8);
        let side = if index % 4 < 2 { 1.0 } else { -1.0 };
        let normal = turn * DVec3::Z * side;
        let from = to + 0.3 * uniform.cosine(normal);
        let direction = (to - from).normalize();
        let hit = scene.nearest(from, direction).expect("a lamp in a ceiling");
        assert!(hit.position.distance(to) < 1e-2);
        if index % 2 == 1 && (place[0] - 2.8).abs() < 0.29 && (place[1] - 1.8).abs() < 0.29 {
            let steep = direction.dot(normal).abs() > 0.01;
            assert!(!steep || scene.object(hit.triangle) == 1);
        }
    }
}

#[test]
fn an_exact_duplicate_of_another_object_is_reported_with_its_area() {
    let one = lamp(0.0, 0.0, 2.0, 1.0);
    let scene = surfaces(&[one.clone(), one]);
    assert_eq!(scene.len(), 2);
    let row = scene.coincidences()[0];
    assert_eq!((row.hidden_object, row.covering_object), (0, 1));
    assert!((row.area - 2.0).abs() < 1e-15);
}

#[test]
fn a_disc_covers_its_own_area_however_finely_it_is_cut() {
    for segments in [33, 64, 256] {
        for shift in [0.0, 0.25] {
            let sheet =
                shape::rectangle(DVec3::new(-2.0, -2.0, 1.0), DVec3::X * 4.0, DVec3::Y * 4.0);
            let centre = DVec3::new(shift, shift, 1.0);
            let surfaces = surfaces(&[sheet, shape::disc(centre, DVec3::Z, 1.0, segments)]);
            let area: f64 = surfaces.coincidences().iter().map(|pair| pair.area).sum();
            // Slivers at the rim narrower than the tolerance are not told apart from touching edges.
            assert!(
                (area / std::f64::consts::PI - 1.0).abs() < 1e-6,
                "{segments}: {area}"
            );
        }
    }
}
