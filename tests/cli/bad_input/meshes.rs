//! Mesh files that are missing, damaged or not what they should be.

use super::super::Folder;
use super::{assert_told, refusal, room_and};
use crate::experiment::repository;
use serde_json::{Value, json};

/// The line and column of `file` in the scenes of [`with_mesh`].
const PLACE: &str = "room.toml:25:8: ";

/// The good room with a mesh file in it.
fn with_mesh(file: &str) -> Vec<u8> {
    room_and(&format!("\n[[mesh]]\nfile = \"{file}\"\n"))
}

const OBJ: &str = "mtllib room.mtl
o Floor
v 0 0 0
v 1 0 0
v 1 0 -1
v 0 0 -1
usemtl Wall
f 1 2 3 4
";

const MTL: &str = "newmtl Wall\nKd 0.5 0.5 0.5\n";

/// What is said of the good OBJ file with one passage changed.
#[track_caller]
fn obj_refusal(old: &str, new: &str) -> String {
    assert_eq!(
        OBJ.matches(old).count(),
        1,
        "{old:?} is not there, or not once"
    );
    let obj = OBJ.replace(old, new);
    let files: [(&str, &[u8]); 2] = [("room.obj", obj.as_bytes()), ("room.mtl", MTL.as_bytes())];
    refusal(&with_mesh("room.obj"), &files, &[])
}

/// A triangle as glTF, its three vertices in `room.bin`.
fn gltf() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "Floor" }],
        "meshes": [{ "name": "Plane", "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
        "materials": [{ "name": "Wall", "extras": { "malus_rho": 0.5, "malus_a": 0 } }],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, -1], "max": [1, 0, 0]
        }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": "room.bin" }]
    })
}

fn triangle(corner: f32) -> Vec<u8> {
    let vertices = [0.0, 0.0, 0.0, corner, 0.0, 0.0, 0.0, 0.0, -1.0];
    vertices
        .iter()
        .copied()
        .flat_map(f32::to_le_bytes)
        .collect()
}

/// What is said of the good glTF file after `change`, with `bin` beside it.
#[track_caller]
fn gltf_refusal(bin: &[u8], change: impl FnOnce(&mut Value)) -> String {
    let mut document = gltf();
    change(&mut document);
    let text = document.to_string();
    let files: [(&str, &[u8]); 2] = [("room.gltf", text.as_bytes()), ("room.bin", bin)];
    refusal(&with_mesh("room.gltf"), &files, &[])
}

#[test]
fn the_files_that_are_spoiled_here_are_good_themselves() {
    let (gltf, bin) = (gltf().to_string(), triangle(1.0));
    let files: [(&str, &[u8]); 4] = [
        ("room.obj", OBJ.as_bytes()),
        ("room.mtl", MTL.as_bytes()),
        ("room.gltf", gltf.as_bytes()),
        ("room.bin", &bin),
    ];
    for file in ["room.obj", "room.gltf"] {
        Folder::new(&with_mesh(file), &files).run("out", &[]);
    }
}

#[test]
fn a_mesh_file_that_is_missing_or_a_directory() {
    let told = refusal(&with_mesh("meshes/absent.glb"), &[], &[]);
    assert_told(&told, &[PLACE, "meshes/absent.glb", "No such file"]);
    for folder in ["room.glb", "room"] {
        let told = refusal(&with_mesh(folder), &[(&format!("{folder}/"), b"")], &[]);
        assert_told(&told, &[PLACE, folder, "directory"]);
    }
}

#[test]
fn a_format_that_is_not_read_tells_how_to_export() {
    for file in ["room.fbx", "room.blend", "room.stl"] {
        let told = refusal(&with_mesh(file), &[(file, b"Kaydara")], &[]);
        assert_told(&told, &[PLACE, file, ".gltf, .glb and .obj", "Export"]);
    }
}

#[test]
fn a_glb_cut_short_tells_how_much_is_missing() {
    let office = std::fs::read(repository("scenes/meshes/blender_office/office.glb")).unwrap();
    let needed = format!("needs {} bytes", office.len());
    for length in [50_000, office.len() - 1] {
        let told = refusal(
            &with_mesh("room.glb"),
            &[("room.glb", &office[..length])],
            &[],
        );
        assert_told(
            &told,
            &[PLACE, "room.glb", "cut short", &needed, &length.to_string()],
        );
    }
}

#[test]
fn a_glb_that_is_empty_or_text() {
    for (content, found) in [("", "\"\""), ("hello, this is text\n", "\"hello, t\"")] {
        let told = refusal(
            &with_mesh("room.glb"),
            &[("room.glb", content.as_bytes())],
            &[],
        );
        assert_told(
            &told,
            &[PLACE, "room.glb", found, "a .glb begins with \"glTF\""],
        );
    }
}

#[test]
fn a_companion_that_is_missing_is_named() {
    let text = gltf().to_string();
    let told = refusal(
        &with_mesh("room.gltf"),
        &[("room.gltf", text.as_bytes())],
        &[],
    );
    assert_told(
        &told,
        &[
            PLACE,
            "room.gltf",
            "buffers[0]",
            "room.bin",
            "No such file",
            ".glb",
        ],
    );
    let told = refusal(&with_mesh("room.obj"), &[("room.obj", OBJ.as_bytes())], &[]);
    assert_told(
        &told,
        &[PLACE, "room.obj", "line 1", "room.mtl", "No such file"],
    );
}

#[test]
fn a_buffer_shorter_than_it_says() {
    let told = gltf_refusal(&triangle(1.0)[..20], |_| ());
    assert_told(
        &told,
        &[
            PLACE,
            "room.gltf",
            "buffers[0]",
            "needs 36 bytes",
            "there are 20",
        ],
    );
}

#[test]
fn an_extension_without_which_the_file_cannot_be_read_tells_what_to_untick() {
    for (extension, remedy) in [
        ("KHR_draco_mesh_compression", "untick Data > Compression"),
        ("EXT_meshopt_compression", "without compression"),
    ] {
        let told = gltf_refusal(&triangle(1.0), |document| {
            document["extensionsUsed"] = json!([extension]);
            document["extensionsRequired"] = json!([extension]);
        });
        assert_told(&told, &[PLACE, "room.gltf", extension, remedy]);
        assert_eq!(told.lines().count(), 1, "{told}");
    }
}

#[test]
fn a_coordinate_that_is_no_number_names_its_vertex() {
    for (word, found) in [("nan", "(NaN, 0, 0)"), ("1e999", "(inf, 0, 0)")] {
        let told = obj_refusal("v 1 0 0\n", &format!("v {word} 0 0\n"));
        assert_told(
            &told,
            &[PLACE, "room.obj", "line 4", "vertex 2", found, "finite"],
        );
    }
    let told = obj_refusal("v 1 0 0\n", "v one 0 0\n");
    assert_told(
        &told,
        &[PLACE, "room.obj", "line 4", "one", "three numbers"],
    );
    let told = gltf_refusal(&triangle(f32::NAN), |_| ());
    assert_told(
        &told,
        &[PLACE, "room.gltf", "meshes[0]", "vertex 1", "NaN", "finite"],
    );
}

#[test]
fn an_index_without_a_vertex_tells_how_many_there_are() {
    for index in ["9", "0", "-5"] {
        let told = obj_refusal("f 1 2 3 4", &format!("f 1 2 3 {index}"));
        assert_told(
            &told,
            &[
                PLACE,
                "room.obj",
                "line 8",
                &format!("index {index}"),
                "4 vertices",
            ],
        );
    }
    let told = gltf_refusal(&triangle(1.0), |document| {
        document["meshes"][0]["primitives"][0]["material"] = json!(7);
    });
    assert_told(
        &told,
        &[PLACE, "room.gltf", "meshes[0].primitives[0].material"],
    );
}

#[test]
fn a_face_without_a_reflectance_names_object_and_material() {
    let told = obj_refusal("usemtl Wall\n", "");
    assert_told(
        &told,
        &["\"Floor\"", "room.obj", "without a material", "rho = 0.5"],
    );
    let told = obj_refusal("usemtl Wall", "usemtl Wal");
    assert_told(&told, &["\"Floor\"", "room.obj", "\"Wal\"", "rho = 0.5"]);
}

#[test]
fn a_custom_property_is_judged_like_the_file() {
    for (key, value, parts) in [
        (
            "malus_roh",
            json!(0.5),
            ["\"malus_roh\"", "nearest is \"malus_rho\""],
        ),
        (
            "malus_rho",
            json!(1.5),
            ["\"malus_rho\"", "a number from 0 to 1, found 1.5"],
        ),
        ("malus_n", json!("glass"), ["\"malus_n\"", "a number > 0"]),
        (
            "malus_polarisation",
            json!([1, 0.8, 0.8, 0]),
            ["\"malus_polarisation\"", "q² + u² + v² ≤ 1"],
        ),
    ] {
        let told = gltf_refusal(&triangle(1.0), |document| {
            document["materials"][0]["extras"] = json!({ key: value });
        });
        assert_told(
            &told,
            &["material \"Wall\"", "room.gltf", parts[0], parts[1]],
        );
    }
}

#[test]
fn a_placement_that_cannot_be() {
    for (line, parts) in [
        (
            "scale = 0",
            ["room.toml:26:9: ", "scale must be a number > 0", "found 0"],
        ),
        (
            "scale = -1",
            ["room.toml:26:9: ", "scale must be a number > 0", "found -1"],
        ),
        (
            "scale = inf",
            [
                "room.toml:26:9: ",
                "scale must be a number > 0",
                "found inf",
            ],
        ),
        (
            "up = \"x\"",
            [
                "room.toml:26:6: ",
                "\"y\" or \"z\"",
                "found the string \"x\"",
            ],
        ),
        (
            "scael = 1",
            ["room.toml:26:1: ", "\"scael\"", "nearest is \"scale\""],
        ),
    ] {
        let scene = [with_mesh("room.obj"), line.as_bytes().to_vec()].concat();
        assert_told(&refusal(&scene, &[], &[]), &parts);
    }
}

#[test]
fn coordinates_beyond_all_bounds_are_refused() {
    let scene = [with_mesh("room.obj"), b"scale = 1e300\n".to_vec()].concat();
    let files: [(&str, &[u8]); 2] = [("room.obj", OBJ.as_bytes()), ("room.mtl", MTL.as_bytes())];
    let told = refusal(&scene, &files, &[]);
    assert_told(&told, &["room.toml", "1e30"]);
}

#[test]
fn a_mesh_file_with_nothing_in_it_is_refused() {
    let told = obj_refusal("f 1 2 3 4\n", "");
    assert_told(&told, &[PLACE, "room.obj", "no faces"]);
    let told = gltf_refusal(&triangle(1.0), |document| document["nodes"] = json!([{}]));
    assert_told(&told, &[PLACE, "room.gltf", "no faces"]);
}

/// A key that is required and misspelt: what is wrong is the spelling, not that it lacks.
#[test]
fn a_misspelt_required_key_is_told_with_the_nearest() {
    let scene = room_and("\n[[mesh]]\nfiel = \"room.obj\"\n");
    let told = refusal(&scene, &[], &[]);
    assert_told(&told, &["room.toml:25:1: ", "\"fiel\"", "\"file\""]);
}
