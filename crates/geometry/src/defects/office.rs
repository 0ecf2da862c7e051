//! The office as Blender exported it, and the same with defects built in on purpose.

use super::of;
use crate::load::{Placement, load};
use crate::testing::Uniform;
use crate::{Mesh, Surfaces};
use glam::DVec3;
use std::path::Path;

/// The geometry of a file, without its sensors, and the names of its objects.
fn office(file: &str) -> (Mesh, Vec<String>) {
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../scenes/meshes/blender_office"
    );
    let model = load(&Path::new(folder).join(file), &Placement::default()).unwrap();
    let mut mesh = Mesh::default();
    let mut names = Vec::new();
    for object in model.objects {
        if object.name.starts_with("SENSOR") || object.parts.is_empty() {
            continue;
        }
        let index = u32::try_from(names.len()).unwrap();
        for part in &object.parts {
            let surface = u32::try_from(part.material.unwrap_or(0)).unwrap();
            mesh.append(&part.positions, &part.triangles, surface, index);
        }
        names.push(object.name);
    }
    (mesh, names)
}

#[test]
fn a_sound_office_has_one_rim_that_of_its_hanging_banner() {
    for file in ["office.glb", "office.gltf", "office.obj"] {
        let (mesh, names) = office(file);
        let report = of(&mesh);
        assert_eq!((report.inside_out.len(), report.turned.len()), (0, 0));
        assert!(report.objects.iter().all(|object| {
            let waste = object.degenerate + object.duplicates;
            waste + object.non_manifold.count + object.mixed_winding.count == 0
        }));
        assert_eq!(report.holes.len(), 1, "{file}");
        assert_eq!(names[report.holes[0].objects[0] as usize], "Banner");
        assert!((report.holes[0].area - 0.8).abs() < 1e-6);
    }
}

#[test]
fn a_spoiled_office_shows_each_of_its_defects() {
    let (mesh, names) = office("office_defects.glb");
    let name = |object: u32| names[object as usize].as_str();
    let report = of(&mesh);

    assert_eq!(report.inside_out.len(), 1);
    let cabinet = report.inside_out[0];
    assert_eq!(name(cabinet.object), "Cabinet");
    assert!((cabinet.volume + 0.5 * 0.9 * 1.2).abs() < 1e-6);

    assert_eq!(report.turned.len(), 1);
    let reveal = report.turned[0];
    assert_eq!(
        (name(reveal.object), reveal.triangles),
        ("Window_Reveal", 8)
    );
    assert!((reveal.area - 0.2 * 9.8).abs() < 1e-6 && reveal.area >= reveal.of);

    let doubled: Vec<_> = report
        .objects
        .iter()
        .filter(|object| object.duplicates > 0)
        .map(|object| (name(object.object), object.duplicates))
        .collect();
    assert_eq!(doubled, [("Floor", 2)]);

    let wall = &report.holes[0];
    assert!((wall.area - 4.0 * 2.8).abs() < 1e-5);
    assert!(wall.min.distance(DVec3::ZERO) < 1e-6);
    assert!(wall.max.distance(DVec3::new(0.0, 4.0, 2.8)) < 1e-6);
    let around: Vec<_> = wall.objects.iter().copied().map(name).collect();
    assert_eq!(
        around,
        ["Wall_South", "Wall_North", "Ceiling", "Floor_copy"]
    );

    let surfaces = Surfaces::new(mesh).unwrap();
    let hidden = surfaces
        .coincidences()
        .iter()
        .find(|row| name(row.hidden_object) == "Floor")
        .unwrap();
    assert_eq!(name(hidden.covering_object), "Floor_copy");
    assert!((hidden.area - 24.0).abs() < 1e-9);
}

#[test]
fn no_ray_leaves_the_office_at_its_vertices_and_edges() {
    for file in ["office.glb", "office.obj"] {
        let (mesh, _) = office(file);
        let office = Surfaces::new(mesh).unwrap();
        let mut uniform = Uniform(8);
        for index in 0..100_000 {
            let triangle = u32::try_from(uniform.index(office.len())).unwrap();
            let [a, b, _] = office.triangle(triangle).vertices;
            let place = if index % 2 == 0 { 0.0 } else { uniform.next() };
            let from = DVec3::new(3.0, 2.0, 1.5) + DVec3::new(5.0, 3.0, 2.0) * uniform.point();
            let direction = (a + place * (b - a) - from).normalize();
            assert!(
                !office.escapes(from, direction),
                "{file}: {from} {direction}"
            );
            assert!(office.nearest(from, direction).is_some());
        }
    }
}
