//! Public models, read where `MALUS_TEST_ROOMS` names their folder.

use super::{bounds, triangles};
use crate::load::{Look, Model, Placement, Up, load};
use glam::DVec3;
use std::path::PathBuf;

/// The folder of the public rooms, where it is known.
fn public_rooms() -> Option<PathBuf> {
    let folder = std::env::var_os("MALUS_TEST_ROOMS").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: MALUS_TEST_ROOMS does not name the folder of the public rooms");
    }
    folder
}

#[test]
fn both_cornell_boxes_and_the_living_room_have_their_published_triangles() {
    let Some(folder) = public_rooms() else {
        return;
    };
    let millimetres = Placement {
        scale: 0.001,
        ..Placement::default()
    };
    let read = |file: &str, placement: &Placement| load(&folder.join(file), placement).unwrap();
    let embree = read("cornell_embree/cornell_box.obj", &millimetres);
    assert_eq!(triangles(&embree), 34);
    assert!(
        embree.notes.iter().any(|n| n.contains("light")),
        "{:?}",
        embree.notes
    );
    let high = embree
        .objects
        .iter()
        .map(|o| bounds(o)[1])
        .fold(DVec3::NEG_INFINITY, DVec3::max);
    assert!((high.z - 0.5488).abs() < 1e-9, "the ceiling is up: {high}");
    let bevy = read("cornell_bevy/CornellBox.glb", &millimetres);
    assert_eq!(triangles(&bevy), 36);
    let glowing = bevy
        .materials
        .iter()
        .filter(|m| matches!(m.look, Look::Gltf { emissive, .. } if emissive[0] > 0.0));
    assert_eq!(glowing.count(), 1);
    let godot = read("godot_living_room/living_room.glb", &Placement::default());
    assert_eq!(triangles(&godot), 5088);
    let as_it_is = read(
        "godot_living_room/living_room.glb",
        &Placement {
            up: Up::Z,
            ..Placement::default()
        },
    );
    let size = |m: &Model| {
        let all: Vec<_> = m.objects.iter().map(bounds).collect();
        all.iter()
            .map(|b| b[1])
            .fold(DVec3::NEG_INFINITY, DVec3::max)
            - all.iter().map(|b| b[0]).fold(DVec3::INFINITY, DVec3::min)
    };
    // 10 × 5.5 × 14.5 m with Y up.
    let (turned, plain) = (size(&godot), size(&as_it_is));
    assert!((turned - DVec3::new(plain.x, plain.z, plain.y)).length() < 1e-9);
}
