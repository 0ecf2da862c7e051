//! Triangles and transforms of small glTF files.

use super::super::writer::{F32, U8, U16, U32, Writer, floats, integers};
use super::{area, only_part};
use crate::load::{Placement, Up};
use glam::{DMat3, DVec3};
use serde_json::json;

fn near(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

#[test]
fn y_up_becomes_z_up_then_scale_then_translation() {
    let file = Writer::triangle();
    let part = |p| only_part(&file.load_placed(&p).unwrap()).clone();
    // Facing +Z in the file is facing −Y in the world.
    assert_eq!(area(&part(Placement::default())), DVec3::NEG_Y);
    let placed = part(Placement {
        scale: 0.5,
        up: Up::Y,
        translate: DVec3::ONE,
    });
    assert_eq!(placed.positions[2], DVec3::new(1.0, 1.0, 1.5));
    let up_z = part(Placement {
        up: Up::Z,
        ..Placement::default()
    });
    assert_eq!(area(&up_z), DVec3::Z);
}

#[test]
fn a_mesh_under_several_nodes_is_there_several_times() {
    let mut file = Writer::triangle();
    file.json["nodes"] = json!([{"mesh": 0, "name": "A"}, {"mesh": 0, "name": "A", "translation": [5, 0, 0]}, {"mesh": 0}]);
    file.json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    let model = file.load().unwrap();
    let names: Vec<_> = model.objects.iter().map(|o| &*o.name).collect();
    assert_eq!(names, ["A", "A (2)", "TriMesh"]);
    let x: Vec<_> = model
        .objects
        .iter()
        .map(|o| o.parts[0].positions[0].x)
        .collect();
    assert_eq!(x, [0.0, 5.0, 0.0]);
}

#[test]
fn transforms_are_composed_down_the_tree_in_double_precision() {
    let mut file = Writer::triangle();
    // 16777216 + 1 is no single-precision number.
    file.json["nodes"] = json!([
        {"name": "Root", "translation": [16_777_216, 0, 0], "children": [1]},
        {"name": "Turned", "rotation": [0, 0, 0.5, 0.5], "children": [2]},
        {"name": "Leaf", "mesh": 0, "translation": [0, -1, 0], "scale": [3, 1, 1]}]);
    let model = file.load().unwrap();
    assert_eq!(
        model
            .objects
            .iter()
            .map(|o| o.parts.len())
            .collect::<Vec<_>>(),
        [0, 0, 1]
    );
    let positions = &model.objects[2].parts[0].positions;
    // By 90° about the file's Z: local (0, −1, 0) → (1, 0, 0), and local X, 6 long, → Y, the world's Z.
    assert!(
        (positions[0] - DVec3::new(16_777_217.0, 0.0, 0.0)).length() < 1e-8,
        "{}",
        positions[0]
    );
    assert!(
        (positions[1] - DVec3::new(16_777_217.0, 0.0, 6.0)).length() < 1e-8,
        "{}",
        positions[1]
    );
}

#[test]
fn a_matrix_is_the_same_as_its_parts() {
    let mut parts = Writer::triangle();
    parts.json["nodes"][0]["translation"] = json!([1, 2, 3]);
    parts.json["nodes"][0]["scale"] = json!([2, 3, 4]);
    let mut matrix = Writer::triangle();
    matrix.json["nodes"][0]["matrix"] = json!([2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1]);
    assert_eq!(parts.load().unwrap(), matrix.load().unwrap());
}

#[test]
fn a_mirrored_object_keeps_its_outside() {
    for scale in [[-1, 1, 1], [1, -1, 1], [-1, -1, 1]] {
        let mut file = Writer::triangle();
        file.json["nodes"][0]["scale"] = json!(scale);
        // Mirroring in the plane of the triangle's normal leaves the side it faces.
        assert!(
            near(area(only_part(&file.load().unwrap())), DVec3::NEG_Y),
            "{scale:?}"
        );
    }
}

#[test]
fn blenders_local_axes_are_the_frame() {
    // Blender's location (1, 2, 3) and scale (4, 5, 6), as its exporter writes them.
    let mut file = Writer::triangle();
    file.json["nodes"] = json!([{"name": "Empty", "translation": [1, 3, -2], "scale": [4, 6, 5]}]);
    let frame = file.load().unwrap().objects[0].frame;
    assert_eq!(frame.translation, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(
        frame.matrix3,
        DMat3::from_diagonal(DVec3::new(4.0, 5.0, 6.0))
    );
    // A file with Z up holds Blender's axes as they are.
    let as_is = Placement {
        up: Up::Z,
        ..Placement::default()
    };
    let frame = file.load_placed(&as_is).unwrap().objects[0].frame;
    assert_eq!(
        frame.matrix3,
        DMat3::from_diagonal(DVec3::new(4.0, 6.0, 5.0))
    );
}

#[test]
fn indices_of_every_width_and_none_give_the_same_triangle() {
    let expected = Writer::triangle().load().unwrap();
    for width in [U8, U16, U32] {
        let mut file = Writer::triangle();
        let indices = file.indices(width, &[0, 1, 2]);
        file.primitive()["indices"] = json!(indices);
        assert_eq!(file.load().unwrap(), expected);
    }
    let mut file = Writer::triangle();
    file.primitive().as_object_mut().unwrap().remove("indices");
    assert_eq!(file.load().unwrap(), expected);
}

#[test]
fn strips_and_fans_cover_what_they_should() {
    for (mode, indices) in [(5, [0, 1, 3, 2]), (6, [0, 1, 2, 3])] {
        let mut file = Writer::triangle();
        let square = file.positions(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        let indices = file.indices(U16, &indices);
        *file.primitive() =
            json!({"attributes": {"POSITION": square}, "indices": indices, "mode": mode});
        let model = file.load().unwrap();
        assert_eq!(only_part(&model).triangles.len(), 2);
        assert!(near(area(only_part(&model)), DVec3::NEG_Y), "mode {mode}");
    }
}

#[test]
fn points_lines_and_leftovers_are_noted() {
    for mode in [0, 1, 2, 3] {
        let mut file = Writer::triangle();
        file.primitive()["mode"] = json!(mode);
        let model = file.load().unwrap();
        assert_eq!(model.objects[0].parts, []);
        assert!(
            model.notes[0].contains("TriMesh") && model.notes[0].contains("lines"),
            "{:?}",
            model.notes
        );
    }
    let mut file = Writer::triangle();
    let indices = file.indices(U16, &[0, 1, 2, 1]);
    file.primitive()["indices"] = json!(indices);
    let model = file.load().unwrap();
    assert_eq!(only_part(&model).triangles.len(), 1);
    assert!(
        model.notes[0].contains("last 1 indices"),
        "{:?}",
        model.notes
    );
}

#[test]
fn morph_targets_and_skins_are_noted_and_the_mesh_is_read() {
    let mut file = Writer::triangle();
    let offsets = file.positions(&[[9.0; 3]; 3]);
    file.primitive()["targets"] = json!([{"POSITION": offsets}]);
    file.json["meshes"][0]["weights"] = json!([1]);
    file.json["skins"] = json!([{"joints": [0]}]);
    file.json["nodes"][0]["skin"] = json!(0);
    let model = file.load().unwrap();
    assert_eq!(area(only_part(&model)), DVec3::NEG_Y);
    assert!(
        model.notes.iter().any(|n| n.contains("shape keys")),
        "{:?}",
        model.notes
    );
    assert!(
        model.notes.iter().any(|n| n.contains("skin")),
        "{:?}",
        model.notes
    );
}

#[test]
fn an_empty_mesh_is_noted() {
    let mut file = Writer::triangle();
    let none = file.indices(U16, &[]);
    file.primitive()["indices"] = json!(none);
    let model = file.load().unwrap();
    assert_eq!(model.objects[0].parts, []);
    assert!(model.notes[0].contains("TriMesh") && model.notes[0].contains("no triangles"));
    let mut file = Writer::triangle();
    file.json["meshes"][0]["primitives"] = json!([]);
    assert_eq!(file.load().unwrap().objects[0].parts, []);
}

#[test]
fn sparse_positions_replace_those_of_the_base() {
    for component in [U8, U16, U32] {
        let mut file = Writer::triangle();
        let (at, to) = (
            file.view(&integers(component, &[1])),
            file.view(&floats(&[[4.0, 0.0, 0.0]])),
        );
        file.json["accessors"][0]["sparse"] = json!({"count": 1,
            "indices": {"bufferView": at, "componentType": component}, "values": {"bufferView": to}});
        assert_eq!(area(only_part(&file.load().unwrap())), 2.0 * DVec3::NEG_Y);
    }
    // Without a base all others are zero.
    let mut file = Writer::triangle();
    let (at, to) = (
        file.view(&[1, 2]),
        file.view(&floats(&[[4.0, 0.0, 0.0], [0.0, 2.0, 0.0]])),
    );
    file.json["accessors"][0] = json!({"componentType": F32, "type": "VEC3", "count": 3, "sparse": {"count": 2,
        "indices": {"bufferView": at, "componentType": U8}, "values": {"bufferView": to}}});
    assert_eq!(area(only_part(&file.load().unwrap())), 4.0 * DVec3::NEG_Y);
    file.json["accessors"][0]["sparse"]["count"] = json!(3);
    assert!(file.error().contains("accessors[0].sparse"));
}

#[test]
fn interleaved_positions_are_read_by_their_stride() {
    let mut file = Writer::triangle();
    let mixed = floats(&[
        [0.0; 3],
        [9.0; 3],
        [2.0, 0.0, 0.0],
        [9.0; 3],
        [0.0, 1.0, 0.0],
        [9.0; 3],
    ]);
    let view = file.view(&mixed);
    file.json["bufferViews"][view]["byteStride"] = json!(24);
    file.json["accessors"][0]["bufferView"] = json!(view);
    assert_eq!(area(only_part(&file.load().unwrap())), DVec3::NEG_Y);
    file.json["bufferViews"][view]["byteStride"] = json!(8);
    assert!(file.error().contains("byteStride of 8"));
}

#[test]
fn primitives_that_share_their_positions_keep_what_they_use() {
    let mut file = Writer::triangle();
    let positions = file.positions(&[
        [9.0; 3],
        [0.0; 3],
        [2.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [8.0; 3],
    ]);
    let indices = file.indices(U16, &[1, 2, 3]);
    *file.primitive() = json!({"attributes": {"POSITION": positions}, "indices": indices});
    assert_eq!(file.load().unwrap(), Writer::triangle().load().unwrap());
}
