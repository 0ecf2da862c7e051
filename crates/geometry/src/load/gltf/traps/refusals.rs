//! What is no glTF, or not one that can be read, and how the error says so.

use super::super::writer::{F32, U8, U16, Writer, floats};
use crate::load::{LoadError, Look, Placement, load};
use serde_json::json;

#[test]
fn an_extension_that_hides_geometry_is_refused_with_the_option_to_change() {
    for (extension, option) in [
        ("KHR_draco_mesh_compression", "Compression"),
        ("EXT_meshopt_compression", "Compression"),
        ("KHR_mesh_quantization", "-noq"),
        ("EXT_mesh_gpu_instancing", "GPU Instances"),
        ("XYZ_unheard_of", "without it"),
    ] {
        let mut file = Writer::triangle();
        file.json["extensionsRequired"] = json!([extension]);
        // As Draco leaves them: accessors without data.
        file.json["accessors"][0]
            .as_object_mut()
            .unwrap()
            .remove("bufferView");
        let message = file.error();
        assert!(
            message.contains(extension) && message.contains(option),
            "{message}"
        );
    }
}

#[test]
fn instances_on_the_gpu_are_refused_even_where_not_required() {
    let mut file = Writer::triangle();
    file.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {}}});
    assert!(
        matches!(file.load(), Err(LoadError::Extension { extension, .. }) if extension == "EXT_mesh_gpu_instancing")
    );
}

#[test]
fn extensions_of_materials_and_textures_may_be_required() {
    let mut file = Writer::triangle();
    let required = [
        "KHR_materials_specular",
        "KHR_materials_volume",
        "KHR_materials_variants",
        "KHR_materials_clearcoat",
        "EXT_texture_webp",
    ];
    file.json["extensionsRequired"] = json!(required);
    file.json["extensionsUsed"] = json!(required);
    file.json["materials"] = json!([{"name": "Pane", "extensions": {
        "KHR_materials_specular": {"specularFactor": 0.25, "specularColorFactor": [1, 0.5, 0]},
        "KHR_materials_volume": {"thicknessFactor": 0.02}}}]);
    let model = file.load().unwrap();
    assert!(matches!(
        model.materials[0].look,
        Look::Gltf {
            specular: 0.25,
            specular_color: [1.0, 0.5, 0.0],
            thickness: 0.02,
            ..
        }
    ));
    let note = &model.notes[0];
    assert!(
        note.contains("clearcoat") && note.contains("variants") && !note.contains("specular"),
        "{note}"
    );
}

#[test]
fn indices_without_a_vertex_are_an_error_with_numbers() {
    let mut file = Writer::triangle();
    let indices = file.indices(U16, &[0, 1, 3]);
    file.primitive()["indices"] = json!(indices);
    let message = file.error();
    assert!(
        message.contains("TriMesh")
            && message.contains("index 3")
            && message.contains("3 vertices"),
        "{message}"
    );
}

#[test]
fn a_vertex_that_is_no_number_is_an_error_with_the_meshs_name() {
    for bad in [f32::NAN, f32::INFINITY] {
        let mut file = Writer::triangle();
        let positions = file.positions(&[[0.0; 3], [2.0, bad, 0.0], [0.0, 1.0, 0.0]]);
        file.primitive()["attributes"]["POSITION"] = json!(positions);
        let message = file.error();
        assert!(
            message.contains("TriMesh") && message.contains("vertex 1"),
            "{message}"
        );
    }
}

#[test]
fn data_outside_their_container_are_an_error_with_numbers() {
    let mut file = Writer::triangle();
    file.json["accessors"][0]["count"] = json!(4);
    let message = file.error();
    assert!(
        message.contains("accessors[0]")
            && message.contains("needs 48 bytes")
            && message.contains("there are 36"),
        "{message}"
    );
    let mut file = Writer::triangle();
    file.json["bufferViews"][0]["byteLength"] = json!(4000);
    assert!(
        file.error()
            .contains("bufferViews[0]: needs 4000 bytes, but there are 42")
    );
    for field in ["byteOffset", "count"] {
        for value in [u64::MAX, u64::MAX / 2, 1 << 40] {
            let mut file = Writer::triangle();
            file.json["accessors"][0][field] = json!(value);
            assert!(
                matches!(file.load(), Err(LoadError::Range { .. })),
                "{field} = {value}"
            );
        }
    }
}

#[test]
fn an_implied_accessor_cannot_ask_for_all_memory() {
    let mut file = Writer::triangle();
    let (at, to) = (file.view(&[0]), file.view(&floats(&[[0.0; 3]])));
    file.json["accessors"][0] = json!({"componentType": F32, "type": "VEC3", "count": 1u64 << 50, "sparse": {"count": 1,
        "indices": {"bufferView": at, "componentType": U8}, "values": {"bufferView": to}}});
    assert!(file.error().contains("without a bufferView"));
}

#[test]
fn references_that_lead_nowhere_are_errors_with_their_path() {
    for (pointer, value) in [
        ("/meshes/0/primitives/0/attributes/POSITION", 99),
        ("/meshes/0/primitives/0/indices", 99),
        ("/accessors/0/bufferView", 99),
        ("/bufferViews/0/buffer", 99),
        ("/nodes/0/mesh", 99),
        ("/scenes/0/nodes/0", 99),
        ("/scene", 99),
    ] {
        let mut file = Writer::triangle();
        *file.json.pointer_mut(pointer).unwrap() = json!(value);
        let message = file.error();
        let field = pointer.trim_end_matches("/0").rsplit('/').next().unwrap();
        assert!(message.contains(field), "{pointer}: {message}");
    }
}

#[test]
fn positions_that_are_no_floats_are_an_error() {
    let mut file = Writer::triangle();
    file.json["accessors"][0]["componentType"] = json!(U16);
    let message = file.error();
    assert!(
        message.contains("TriMesh") && message.contains("U16"),
        "{message}"
    );
}

#[test]
fn a_node_that_is_its_own_ancestor_or_has_two_parents_is_an_error() {
    let mut file = Writer::triangle();
    file.json["nodes"][0]["children"] = json!([0]);
    assert!(file.error().contains("nodes[0] \"Tri\": reached twice"));
    file.json["nodes"] =
        json!([{"children": [2]}, {"children": [2]}, {"mesh": 0, "name": "Shared"}]);
    file.json["scenes"] = json!([{"nodes": [0, 1]}]);
    assert!(file.error().contains("Shared"));
}

#[test]
fn a_tree_of_a_hundred_thousand_levels_is_no_overflow() {
    let mut file = Writer::triangle();
    let nodes: Vec<_> = (0..100_000)
        .map(|i| json!({"children": [i + 1]}))
        .chain([json!({"mesh": 0})])
        .collect();
    file.json["nodes"] = json!(nodes);
    assert_eq!(file.load().unwrap().objects.len(), 100_001);
}

#[test]
fn transforms_without_meaning_are_errors_with_the_nodes_name() {
    for (field, value) in [
        ("rotation", json!([0, 0, 0, 0])),
        ("scale", json!([1e300, 1, 1])),
        ("translation", json!([1e39, 0, 0])),
    ] {
        let mut file = Writer::triangle();
        file.json["nodes"][0][field] = value;
        assert!(file.error().contains("\"Tri\""), "{field}");
    }
}

#[test]
fn a_missing_bin_is_an_error_with_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.gltf");
    std::fs::write(
        &path,
        r#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "my%20room.bin"}]}"#,
    )
    .unwrap();
    let message = load(&path, &Placement::default()).unwrap_err().to_string();
    assert!(
        message.contains("room.gltf: buffers[0]") && message.contains("my room.bin"),
        "{message}"
    );
    std::fs::write(folder.path().join("my room.bin"), [0; 4]).unwrap();
    assert!(load(&path, &Placement::default()).is_ok());
}

#[test]
fn other_uris_are_errors() {
    for uri in [
        "https://example.org/a.bin",
        "data:text/plain,abc",
        "data:;base64,!!!!",
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.gltf");
        let text = json!({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": uri}]});
        std::fs::write(&path, text.to_string()).unwrap();
        let message = load(&path, &Placement::default()).unwrap_err().to_string();
        assert!(message.contains("buffers[0]"), "{message}");
    }
}

#[test]
fn what_is_no_gltf_is_told_from_its_first_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut old = b"glTF".to_vec();
    old.extend([1, 0, 0, 0, 12, 0, 0, 0]);
    for (bytes, reason) in [
        (&b"\x89PNG\r\n"[..], "x89PNG"),
        (b"", "start of the file"),
        (b"glTF\x02", "GLB"),
        (&old, "version 1"),
        (b"glTF\x02\0\0\0\x0c\0\0\0", "no JSON chunk"),
        (b"{ \"asset\": ", "line 1"),
    ] {
        let path = folder.path().join("room.glb");
        std::fs::write(&path, bytes).unwrap();
        let message = load(&path, &Placement::default()).unwrap_err().to_string();
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn a_glb_and_a_gltf_of_the_same_scene_are_the_same_whatever_they_are_called() {
    let folder = tempfile::tempdir().unwrap();
    let file = Writer::triangle();
    let expected = file.load().unwrap();
    for (name, bytes) in [
        ("a.glb", file.glb()),
        ("a.GLTF", file.glb()),
        ("b.glb", file.text().into()),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(load(&path, &Placement::default()).unwrap(), expected);
    }
}
