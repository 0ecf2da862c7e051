//! Light of sources without size in flat mirrors, held against all its images.

use crate::images::{Flat, Source, assert_images, eyes, mirror, parallel, point};
use glam::{DVec3, dvec3 as v};
use malus_optics::Material;

fn floor(material: Material) -> Flat {
    Flat {
        origin: v(-4.0, -4.0, 0.0),
        u: v(8.0, 0.0, 0.0),
        v: v(0.0, 8.0, 0.0),
        material,
    }
}

/// The reflectors that an image is drawn in.
fn reflectors() -> [(&'static str, Material); 4] {
    [
        ("ideal", mirror(1.0, f64::INFINITY, 0.0)),
        ("glass", mirror(1.0, 1.5, 0.0)),
        ("part gold", mirror(0.7, 0.183, 3.43)),
        ("from inside", mirror(1.0, 1.0 / 1.49661, 0.0)),
    ]
}

#[test]
fn one_mirror_makes_one_image() {
    let eyes = eyes(&[
        (v(1.2, 0.4, 0.7), v(0.3, 0.2, -1.0)),
        (v(-0.5, 0.9, 0.002), v(1.0, -0.3, 0.1)),
        (v(0.4, -1.3, 1.9), v(0.0, 0.5, -0.2)),
    ]);
    for (name, material) in reflectors() {
        let sources = [point(v(0.1, -0.2, 0.9)), parallel(v(0.3, -0.4, 0.8))];
        for source in sources {
            // One source and one mirror leave nothing to chance.
            assert_images(name, &[floor(material)], &[source], &eyes, 1, 4096, 1e-9);
        }
        assert_images(name, &[floor(material)], &sources, &eyes, 1, 4096, 1e-9);
    }
}

/// The corner of a room of three mirrors, seven images.
fn corner(material: Material) -> Vec<Flat> {
    let side = |u: DVec3, w: DVec3| Flat {
        origin: DVec3::ZERO,
        u: u * 5.0,
        v: w * 5.0,
        material,
    };
    vec![
        side(DVec3::X, DVec3::Y),
        side(DVec3::Y, DVec3::Z),
        side(DVec3::Z, DVec3::X),
    ]
}

#[test]
fn a_corner_of_two_and_of_three_mirrors_makes_three_and_seven_images() {
    let eyes = eyes(&[
        (v(1.2, 0.4, 0.7), v(-0.3, -0.2, -1.0)),
        (v(0.5, 0.9, 0.3), v(-1.0, -0.3, 0.2)),
    ]);
    for (name, material) in reflectors() {
        for source in [point(v(0.8, 1.1, 0.9)), parallel(v(0.3, 0.4, 0.8))] {
            let flats = corner(material);
            assert_images(name, &flats[..2], &[source], &eyes, 4, 16_384, 3e-2);
            assert_images(name, &flats, &[source], &eyes, 5, 16_384, 3e-2);
        }
    }
}

/// A thousand sources in one place have too many images for each to be looked at by every sensor.
#[test]
fn images_of_a_crowd_are_drawn() {
    let eyes = eyes(&[
        (v(1.2, 0.4, 0.7), v(-0.3, -0.2, -1.0)),
        (v(0.5, 0.9, 0.3), v(-1.0, -0.3, 0.2)),
    ]);
    let gold = corner(mirror(0.7, 0.183, 3.43));
    for one in [point(v(0.8, 1.1, 0.9)), parallel(v(0.3, 0.4, 0.8))] {
        let crowd = [Source {
            strength: 1e-3 * one.strength,
            ..one
        }; 1000];
        assert_images("crowd", &gold, &crowd, &eyes, 5, 16_384, 3e-2);
    }
}

#[test]
fn a_kaleidoscope_of_three_mirrors_makes_a_lattice_of_images() {
    let corners = [
        v(0.0, 0.0, -6.0),
        v(1.0, 0.0, -6.0),
        v(0.5, 0.75f64.sqrt(), -6.0),
    ];
    let eyes = eyes(&[
        (v(0.5, 0.3, 0.1), v(0.2, 1.0, 0.3)),
        (v(0.35, 0.2, -0.4), v(1.0, 0.1, 0.9)),
    ]);
    for (name, material, longest) in [
        ("glass", mirror(1.0, 1.5, 0.0), 13),
        ("part gold", mirror(0.3, 0.183, 3.43), 11),
    ] {
        let flats: Vec<Flat> = (0..3)
            .map(|i| Flat {
                origin: corners[i],
                u: corners[(i + 1) % 3] - corners[i],
                v: v(0.0, 0.0, 12.0),
                material,
            })
            .collect();
        let source = point(v(0.55, 0.41, 0.3));
        assert_images(name, &flats, &[source], &eyes, longest, 16_384, 1e-3);
    }
}

#[test]
fn mirrors_that_hide_one_another_make_no_image_where_they_do() {
    let gold = mirror(1.0, 0.183, 3.43);
    let aside = |origin: DVec3, u: DVec3, w: DVec3| Flat {
        origin,
        u,
        v: w,
        material: gold,
    };
    let flats = [
        floor(gold),
        // Stands on the floor between source and sensor, and one hangs over it.
        aside(v(0.3, -0.5, 0.0), v(0.1, 1.4, 0.0), v(0.0, 0.2, 0.6)),
        aside(v(-1.0, -1.0, 1.8), v(1.6, 0.0, 0.1), v(0.0, 2.0, 0.3)),
        aside(v(-0.9, -1.0, 0.2), v(0.0, 2.0, 0.3), v(0.2, 0.1, 1.3)),
    ];
    let eyes = eyes(&[
        (v(1.2, 0.4, 0.7), v(-0.3, 0.2, -1.0)),
        (v(0.1, 0.6, 0.4), v(1.0, 0.3, 0.1)),
        (v(-0.2, -0.3, 1.2), v(-0.5, 0.3, 0.8)),
    ]);
    let source = point(v(-0.1, 0.1, 0.5));
    // Light leaves by the gaps between them, so that no chain is longer.
    assert_images("gold", &flats, &[source], &eyes, 12, 4096, 0.0);
}

/// Parallel mirrors: images without end, drawn as chains to the third and as images beyond.
#[test]
fn two_parallel_mirrors_make_a_row_of_images() {
    let ceiling = |material| Flat {
        origin: v(-40.0, -40.0, 1.0),
        u: v(80.0, 0.0, 0.0),
        v: v(0.0, 80.0, 0.0),
        material,
    };
    let floor = |material| Flat {
        origin: v(-40.0, -40.0, 0.0),
        ..ceiling(material)
    };
    let eyes = eyes(&[
        (v(0.5, 0.3, 0.1), v(0.2, 0.1, 1.0)),
        (v(0.35, 0.2, 0.6), v(1.0, 0.1, -0.9)),
    ]);
    for (name, material) in [
        ("gold", mirror(0.8, 0.183, 3.43)),
        ("dense", mirror(1.0, 3.0, 0.0)),
    ] {
        let flats = [floor(material), ceiling(material)];
        let source = point(v(-0.3, 0.41, 0.3));
        assert_images(name, &flats, &[source], &eyes, 60, 16_384, 1e-3);
    }
}
