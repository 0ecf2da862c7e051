//! Every tree, on every vector unit, alone or in packets, gives the same answers to the last bit.

use super::Unit;
use crate::planes::Planes;
use crate::testing::{self, Uniform, cube, grid, room, surfaces};
use crate::{Hit, Layout, Mesh, Preset, Surfaces, Targets, shape};
use glam::DVec3;
use proptest::prelude::*;

/// The trees of `obvhs`.
const OTHERS: [Layout; 2] = [Layout::Bvh2, Layout::Cwbvh];

/// Ends of a question, each with a normal.
type Ends = Vec<(DVec3, DVec3)>;

/// Rays as likely as not to pass exactly through an edge or a vertex.
fn rays(surfaces: &Surfaces, uniform: &mut Uniform, count: usize) -> Ends {
    let (centre, radius) = (surfaces.centre(), surfaces.radius());
    (0..count)
        .map(|index| {
            let from = centre + 1.2 * radius * uniform.point();
            let direction = match index % 3 {
                0 => uniform.direction(),
                1 => (corner(surfaces, uniform) - from).normalize(),
                _ => [DVec3::X, DVec3::NEG_Y, DVec3::Z][uniform.index(3)],
            };
            (from, direction)
        })
        .collect()
}

/// A vertex or a point of an edge.
fn corner(surfaces: &Surfaces, uniform: &mut Uniform) -> DVec3 {
    let triangle = u32::try_from(uniform.index(surfaces.len())).unwrap();
    let [a, b, _] = surfaces.triangle(triangle).vertices;
    a + [0.0, 0.5, uniform.next()][uniform.index(3)] * (b - a)
}

/// Points in a scene, on its surfaces, on their edges, far outside, and some twice.
fn ends(surfaces: &Surfaces, uniform: &mut Uniform, count: usize) -> Ends {
    let (centre, radius) = (surfaces.centre(), surfaces.radius());
    let mut ends: Ends = Vec::new();
    for index in 0..count {
        let place = match index % 8 {
            0 => corner(surfaces, uniform),
            1 => corner(surfaces, uniform) + surfaces.offset() * uniform.direction(),
            2 => centre + 1e3 * radius * uniform.point(),
            3 if index > 8 => ends[uniform.index(index)].0,
            _ => centre + 1.1 * radius * uniform.point(),
        };
        let normal = if index % 31 == 0 {
            DVec3::ZERO
        } else {
            uniform.direction()
        };
        ends.push((place, normal));
    }
    ends
}

/// What single rays say of all targets.
fn one_by_one(surfaces: &Surfaces, (from, normal): (DVec3, DVec3), targets: &Ends) -> Vec<bool> {
    targets
        .iter()
        .map(|&(to, facing)| {
            let segment = to - from;
            segment.dot(normal) > 0.0 && segment.dot(facing) < 0.0 && surfaces.visible(from, to)
        })
        .collect()
}

/// Asserts that a scene gives the same answers in every way of asking; trees of `layouts` beside the usual one.
fn assert_one_answer(mut surfaces: Surfaces, layouts: &[Layout], seed: u64, count: usize) {
    let mut uniform = Uniform(seed);
    let rays = rays(&surfaces, &mut uniform, 8 * count);
    let targets = ends(&surfaces, &mut uniform, 10 * count + 3);
    let points = ends(&surfaces, &mut uniform, count);
    let hits = |surfaces: &Surfaces| -> Vec<Option<Hit>> {
        rays.iter()
            .map(|&(from, direction)| surfaces.nearest(from, direction))
            .collect()
    };
    surfaces.exchange(surfaces.tree(Layout::List, Preset::Medium));
    let planes = surfaces.exchange_planes(Planes::default());
    let expected = hits(&surfaces);
    let seen: Vec<_> = points
        .iter()
        .map(|&point| one_by_one(&surfaces, point, &targets))
        .collect();
    surfaces.exchange_planes(planes);
    let packets = surfaces.targets(&targets);
    assert!(expected.iter().any(Option::is_some));
    let all = seen.iter().flatten();
    let some = all.filter(|&&seen| seen).count();
    assert!(some > 0, "nothing is seen: nothing is tested");
    let mut found = Vec::new();
    let mut check = |surfaces: &Surfaces, layout| {
        assert_eq!(hits(surfaces), expected, "{layout:?}");
        for (&point, seen) in points.iter().zip(&seen) {
            assert_eq!(&one_by_one(surfaces, point, &targets), seen, "{layout:?}");
            surfaces.visible_from(point.0, point.1, &packets, &mut found);
            assert_eq!(&found, seen, "{layout:?}");
        }
    };
    for &layout in [Layout::Wide, Layout::List].iter().chain(layouts) {
        surfaces.exchange(surfaces.tree(layout, Preset::Medium));
        check(&surfaces, layout);
    }
    surfaces.exchange(surfaces.tree(Layout::Wide, Preset::Fastest));
    for unit in Unit::all() {
        surfaces.exchange_unit(unit);
        check(&surfaces, Layout::Wide);
    }
}

#[test]
fn all_trees_answer_alike_at_every_scale() {
    for side in [1e-4, 1.0, 1e4] {
        for at in [0.0, 1e4] {
            let centre = DVec3::new(at, 0.3 * at, -0.7 * at);
            assert_one_answer(cube(centre, side, 5), &OTHERS, 7, 24);
        }
    }
}

#[test]
fn all_trees_answer_alike_where_surfaces_coincide() {
    let edges = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| 3.0 * axis);
    let mut parts = room(DVec3::ZERO, edges, [[3, 2]; 6]);
    parts.push(grid(DVec3::new(0.5, 0.75, 3.0), DVec3::Y, DVec3::X, [4, 3]));
    parts.push(shape::cuboid(
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(2.0, 2.0, 1.0),
        false,
    ));
    parts.push(shape::sphere(DVec3::splat(2.0), 0.5, false, 2));
    let scene = surfaces(&parts);
    assert!(!scene.coincidences().is_empty());
    assert_one_answer(scene, &OTHERS, 8, 64);
}

#[test]
fn a_surface_hidden_by_a_later_one_behind_it_stands_before_nothing_of_that() {
    // A lamp after the ceiling that it lies in, and behind that by less than what counts as one place.
    let wide = [4.0 * DVec3::X, 4.0 * DVec3::Y];
    let ceiling = grid(DVec3::new(-2.0, -2.0, 1.0), wide[0], wide[1], [1, 1]);
    let at = |behind: f64| DVec3::new(-0.25, -0.25, 1.0 + behind);
    let depth = 0.5 * surfaces(std::slice::from_ref(&ceiling)).tolerance();
    let lamp = grid(at(depth), 0.5 * DVec3::X, 0.5 * DVec3::Y, [2, 2]);
    let scene = surfaces(&[ceiling, lamp]);
    assert!(!scene.coincidences().is_empty());
    let lit = DVec3::new(0.3, 0.2, 0.0);
    let place = |x: f64, height: f64| (DVec3::new(x, 0.1, height), DVec3::NEG_Z);
    let on_lamp = 1.0 + depth - scene.offset();
    // On the lamp, between the two; above it; above the ceiling beside it, by as little and by more.
    let targets = [
        place(0.1, on_lamp),
        place(0.1, 1.5),
        place(0.7, on_lamp),
        place(0.7, 1.5),
    ];
    let seen = [true, false, false, false];
    assert_eq!(targets.map(|(at, _)| scene.visible(lit, at)), seen);
    assert_eq!(targets.map(|(at, _)| scene.visible(at, lit)), seen);
    let mut found = Vec::new();
    scene.visible_from(lit, DVec3::Z, &scene.targets(&targets), &mut found);
    assert_eq!(found, seen);
}

#[test]
fn a_tree_too_deep_for_the_usual_stack_answers_alike() {
    // Ever smaller triangles towards a point: each step of the way there divides the rest.
    let mut mesh = Mesh::default();
    for step in 0..900 {
        let size = 0.97_f64.powi(step);
        let corners = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| size * axis);
        mesh.append(&corners, &[[0, 1, 2]], 0, 0);
    }
    let scene = Surfaces::new(mesh).unwrap();
    let depth = scene.tree(Layout::Wide, Preset::Medium).facts().depth;
    assert!(depth >= 14, "{depth} levels do not fill the usual stack");
    assert_one_answer(scene, &OTHERS, 9, 16);
}

#[test]
fn from_an_empty_scene_all_is_seen_that_lies_in_front() {
    let empty = Surfaces::new(Mesh::default()).unwrap();
    let targets = [(DVec3::X, DVec3::NEG_X), (DVec3::NEG_X, DVec3::X)];
    let mut seen = vec![true; 7];
    let both = empty.targets(&targets);
    empty.visible_from(DVec3::ZERO, DVec3::X, &both, &mut seen);
    assert_eq!(seen, [true, false]);
    empty.visible_from(DVec3::ZERO, DVec3::X, &Targets::default(), &mut seen);
    assert!(seen.is_empty());
}

/// Triangles anywhere in a closed room.
fn soup(seed: u64, count: u32, size: f64) -> Surfaces {
    let mut mesh = testing::soup(seed, count, size);
    // So that something is hit and something seen.
    let (positions, triangles) = shape::cuboid(DVec3::splat(-1.0), DVec3::splat(1.0), true);
    mesh.append(&positions, &triangles, count, 1);
    Surfaces::new(mesh).unwrap()
}

#[test]
fn all_trees_answer_alike_where_the_way_is_short() {
    // A target lies beside the edge of a triangle, nearer than what obvhs's eight-wide tree takes for a distance.
    for seed in [6_294_458_513_746_412_739, 18_279_747_352_678_812_461] {
        assert_one_answer(soup(seed, 1, 0.01), &OTHERS, !seed, 16);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn all_trees_answer_alike_in_a_soup(seed: u64, count in 1_u32..200, size in 0.01..1.0) {
        assert_one_answer(soup(seed, count, size), &OTHERS, !seed, 16);
    }
}
