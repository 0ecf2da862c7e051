//! Rays in closed rooms: nothing leaks, nothing hits itself, distances are right.

use crate::testing::{self, Uniform, cube, grid, room, surfaces};
use crate::{Error, Mesh, Surfaces, shape};
use glam::{DQuat, DVec3};
use proptest::prelude::*;

const SIDES: [f64; 6] = [1e-4, 1e-3, 0.1, 1.0, 100.0, 1e4];

#[test]
fn a_negative_zero_in_the_direction_hits_what_a_zero_hits() {
    let room = cube(DVec3::ZERO, 2.0, 3);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for sign in [1.0, -1.0] {
            let zeros = sign * axis + DVec3::ZERO;
            let negative = DVec3::from_array(
                zeros
                    .to_array()
                    .map(|component| if component == 0.0 { -0.0 } else { component }),
            );
            let from = DVec3::new(0.11, -0.23, 0.37);
            assert_eq!(room.nearest(from, zeros), room.nearest(from, negative));
            assert!(!room.escapes(from, negative));
        }
    }
}

#[test]
fn rays_along_the_axes_at_grid_lines_do_not_leak() {
    for side in SIDES {
        let room = cube(DVec3::ZERO, side, 8);
        let mut uniform = Uniform(1);
        for index in 0..20_000 {
            let mut half_grid = || (uniform.index(15) as f64 - 7.0) / 16.0 * side;
            let from = DVec3::new(half_grid(), half_grid(), half_grid());
            let mut direction = DVec3::ZERO;
            direction[index % 3] = if index % 2 == 0 { 1.0 } else { -1.0 };
            let hit = room.nearest(from, direction).unwrap();
            let expected = 0.5 * side - (from * direction).element_sum();
            assert!((hit.distance - expected).abs() < 1e-14 * side);
            assert!(!room.escapes(from, direction));
            assert!(!room.visible(from, from + 2.0 * side * direction));
        }
    }
}

#[test]
fn rays_at_vertices_and_edges_do_not_leak() {
    for side in SIDES {
        for at in [0.0, 1e4] {
            let centre = DVec3::new(at, 0.3 * at, -0.7 * at);
            let room = cube(centre, side, 7);
            let mut uniform = Uniform(2);
            for index in 0..10_000 {
                let triangle = room.triangle(u32::try_from(uniform.index(room.len())).unwrap());
                let [a, b, _] = triangle.vertices;
                let place = if index % 2 == 0 { 0.0 } else { uniform.next() };
                let from = centre + 0.6 * side * uniform.point();
                let direction = (a + place * (b - a) - from).normalize();
                assert!(
                    room.nearest(from, direction).is_some(),
                    "side {side} at {at}"
                );
                assert!(!room.escapes(from, direction), "side {side} at {at}");
            }
        }
    }
}

/// A room turned out of the axes whose floor and ceiling have long edges against the walls' many short ones.
fn room_with_junctions(edges: [DVec3; 3], min: DVec3) -> Surfaces {
    let counts = [[1, 1], [1, 1], [17, 3], [1, 23], [5, 29], [97, 1]];
    surfaces(&room(min, edges, counts))
}

#[test]
fn long_edges_against_short_ones_do_not_leak() {
    let turn = DQuat::from_xyzw(0.1, 0.5, -0.3, 0.7).normalize();
    for (turn, at) in [(DQuat::IDENTITY, 0.0), (turn, 0.0), (turn, 300.0)] {
        let edges = [DVec3::X * 6.1, DVec3::Y * 4.3, DVec3::Z * 2.7].map(|edge| turn * edge);
        let min = DVec3::new(at, -at, 0.1);
        let room = room_with_junctions(edges, min);
        let mut uniform = Uniform(3);
        for _ in 0..100_000 {
            // A point on one of the twelve edges of the room.
            let mut place = [0.0, 1.0, 0.0].map(|_: f64| f64::from(uniform.next() < 0.5));
            place[uniform.index(3)] = uniform.next();
            let at = |place: [f64; 3]| {
                min + place[0] * edges[0] + place[1] * edges[1] + place[2] * edges[2]
            };
            let from = at([0; 3].map(|_| 0.05 + 0.9 * uniform.next()));
            let direction = (at(place) - from).normalize();
            assert!(room.nearest(from, direction).is_some());
            assert!(!room.escapes(from, direction));
        }
    }
}

#[test]
fn the_offset_leaves_no_surface_hitting_itself_and_loses_no_walk() {
    for side in [1e-3, 1.0, 1e4] {
        for at in [0.0, 1e4] {
            let centre = DVec3::new(at, 0.3 * at, -0.7 * at);
            let ball = surfaces(&[shape::sphere(centre, 0.5 * side, true, 3)]);
            let mut uniform = Uniform(4);
            let (mut origin, mut direction, mut last) = (centre, DVec3::X, None);
            for _ in 0..20_000 {
                let hit = ball.nearest(origin, direction).expect("a closed sphere");
                let normal = ball.normal(hit.triangle);
                assert!(normal.dot(direction) < 0.0, "met from behind");
                assert_ne!(
                    Some(hit.triangle),
                    last,
                    "a flat triangle does not see itself"
                );
                let depth = normal.dot(hit.position - ball.triangle(hit.triangle).vertices[0]);
                // Past an edge a hit may lie off the plane by the thickness of surfaces, a quarter of the offset.
                assert!(depth.abs() < 0.26 * ball.offset());
                last = Some(hit.triangle);
                origin = hit.position + ball.offset() * normal;
                direction = uniform.cosine(normal);
            }
        }
    }
}

#[test]
fn points_on_one_wall_see_each_other_once_moved_off_it() {
    for side in [1e-3, 1.0, 1e4] {
        let room = cube(DVec3::splat(0.3), side, 5);
        let mut uniform = Uniform(5);
        for _ in 0..2_000 {
            let mut on_floor = || {
                let place = uniform.point() * 0.99 * side;
                DVec3::splat(0.3) + place.with_z(-0.5 * side + room.offset())
            };
            assert!(room.visible(on_floor(), on_floor()));
        }
    }
}

#[test]
fn a_source_far_away_meets_the_scene_as_exactly_as_one_nearby() {
    let room = cube(DVec3::ZERO, 1.0, 6);
    let mut uniform = Uniform(6);
    for distance in [1e2, 1e4, 1e6, 1e8] {
        for _ in 0..2_000 {
            let target = 0.9 * uniform.point();
            let from = target + distance * uniform.direction();
            let direction = (target - from).normalize();
            let hit = room.nearest(from, direction).expect("the target is inside");
            let depth = hit.position.abs().max_element();
            assert!((depth - 0.5).abs() < 1e-14);
            assert!((hit.distance - hit.position.distance(from)).abs() < 1e-15 * distance);
            assert!(!room.visible(from, target));
            assert!(!room.escapes(from, direction));
            assert!(room.escapes(from, -direction));
        }
    }
}

#[test]
fn of_surfaces_at_one_distance_the_later_is_met() {
    let left = shape::rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    let right = shape::rectangle(DVec3::X, DVec3::X, DVec3::Y);
    for parts in [[left.clone(), right.clone()], [right, left]] {
        let both = surfaces(&parts);
        let hit = both
            .nearest(DVec3::new(1.0, 0.4, 1.0), DVec3::NEG_Z)
            .unwrap();
        assert_eq!(both.object(hit.triangle), 1);
    }
}

#[test]
fn visibility_leaves_out_its_ends() {
    let sheet = surfaces(&[shape::rectangle(DVec3::ZERO, DVec3::X, DVec3::Y)]);
    let on = DVec3::new(0.5, 0.25, 0.0);
    assert!(sheet.visible(on, on + DVec3::Z));
    assert!(sheet.visible(on - DVec3::Z, on));
    assert!(!sheet.visible(on - DVec3::Z, on + DVec3::Z));
    assert!(sheet.visible(on, on));
}

#[test]
fn an_empty_scene_hides_nothing() {
    let empty = Surfaces::new(Mesh::default()).unwrap();
    assert!(empty.is_empty());
    assert_eq!(empty.nearest(DVec3::ZERO, DVec3::X), None);
    assert!(empty.visible(DVec3::ZERO, DVec3::X));
    assert!(empty.escapes(DVec3::ZERO, DVec3::X));
}

#[test]
fn vertices_that_are_not_finite_are_refused_by_object() {
    for wrong in [f64::NAN, f64::INFINITY, -1e300] {
        let mut mesh = Mesh::default();
        let (positions, triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, false);
        mesh.append(&positions, &triangles, 0, 0);
        mesh.append(&positions, &triangles, 0, 1);
        mesh.positions[11].y = wrong;
        let error = Surfaces::new(mesh).err().unwrap();
        assert!(
            matches!(
                error,
                Error::NotFinite {
                    object: 1,
                    vertex: 11,
                    ..
                }
            ),
            "{error}"
        );
    }
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let mut mesh = Mesh::default();
    let (positions, triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, false);
    mesh.append(&positions, &triangles, 0, 3);
    let mut uneven = mesh.clone();
    uneven.objects.pop();
    let error = Surfaces::new(uneven).err().unwrap();
    assert!(
        matches!(error, Error::Uneven { objects: 11, .. }),
        "{error}"
    );
    mesh.triangles[4][1] = 8;
    let error = Surfaces::new(mesh).err().unwrap();
    let expected = Error::NoSuchVertex {
        object: 3,
        triangle: 4,
        vertex: 8,
        count: 8,
    };
    assert_eq!(error, expected);
}

#[test]
fn thousands_of_equal_triangles_are_one() {
    let (positions, triangles) = shape::rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    let mut mesh = Mesh::default();
    for copy in 0..20_000_u32 {
        let [a, b, c] = triangles[0];
        let turned = [[a, b, c], [c, a, b], [b, a, c]][copy as usize % 3];
        mesh.append(&positions, &[turned, [0, 1, 1]], copy, copy / 10_000);
    }
    let one = Surfaces::new(mesh).unwrap();
    assert_eq!((one.len(), one.surface(0), one.object(0)), (1, 19_999, 1));
    let counts: Vec<_> = one
        .cleaned()
        .iter()
        .map(|row| (row.object, row.degenerate, row.duplicates))
        .collect();
    assert_eq!(counts, [(0, 10_000, 10_000), (1, 10_000, 9_999)]);
}

/// Möller and Trumbore's test (1997), with how far inside its edges the hit is.
fn crossed(vertices: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let [a, b, c] = vertices;
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    let u = (origin - a).dot(p) / determinant;
    let q = (origin - a).cross(ab);
    let v = direction.dot(q) / determinant;
    let distance = ac.dot(q) / determinant;
    (distance > 0.0).then_some((distance, u.min(v).min(1.0 - u - v)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_tree_finds_what_trying_every_triangle_finds(seed: u64, count in 1_u32..300, size in 0.01..1.0) {
        let soup = Surfaces::new(testing::soup(seed, count, size)).unwrap();
        let mut uniform = Uniform(!seed);
        for _ in 0..50 {
            let (from, direction) = (2.0 * uniform.point(), uniform.direction());
            let all: Vec<_> = (0..count)
                .filter_map(|index| {
                    let vertices = soup.triangle(index).vertices;
                    crossed(vertices, from, direction).map(|(distance, inside)| (distance, inside, index))
                })
                .collect();
            // Hits that rounding may take either way prove nothing.
            if all.iter().any(|entry| entry.1.abs() < 1e-6) {
                continue;
            }
            let first = all
                .iter()
                .filter(|entry| entry.1 > 0.0)
                .min_by(|one, other| one.0.total_cmp(&other.0));
            let hit = soup.nearest(from, direction);
            prop_assert_eq!(hit.map(|hit| hit.triangle), first.map(|entry| entry.2));
            prop_assert_eq!(soup.escapes(from, direction), first.is_none());
            if let (Some(hit), Some(first)) = (hit, first) {
                prop_assert!((hit.distance - first.0).abs() < 1e-9);
                let (before, after) = (hit.distance - 1e-6, hit.distance + 1e-6);
                prop_assert!(soup.visible(from, from + before * direction));
                prop_assert!(!soup.visible(from, from + after * direction));
            }
        }
    }

    #[test]
    fn visibility_is_symmetric(seed: u64, size in 0.05..1.0) {
        let soup = Surfaces::new(testing::soup(seed, 40, size)).unwrap();
        let mut uniform = Uniform(!seed);
        for index in 0..200 {
            // Every other end lies on an edge, where rounding decides.
            let on_edge = soup.triangle(uniform.index(40) as u32).vertices[0];
            let (from, to) = (uniform.point(), if index % 2 == 0 { on_edge } else { uniform.point() });
            prop_assert_eq!(soup.visible(from, to), soup.visible(to, from));
        }
    }
}

#[test]
fn the_search_for_an_obstacle_stops_at_the_first() {
    // Sheets one behind the other; asking one is enough.
    let sheets: Vec<_> = (0..100)
        .map(|index| grid(DVec3::Z * f64::from(index), DVec3::X, DVec3::Y, [1, 1]))
        .collect();
    let stack = surfaces(&sheets);
    let asked = std::cell::Cell::new(0);
    let from = DVec3::new(0.3, 0.6, -1.0);
    let blocked = stack.tree.ahead(
        from,
        DVec3::Z,
        |_| false,
        |_, _, _| {
            asked.set(asked.get() + 1);
            true
        },
    );
    assert!(blocked);
    assert_eq!(asked.get(), 1);
}
