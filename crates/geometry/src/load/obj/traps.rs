//! What OBJ files do to an importer, one test each.

use crate::load::{LoadError, Look, Model, Part, Placement, load};
use std::fs;

/// Loads an OBJ text beside a `room.mtl` with the materials A (grey 0.5) and B.
fn read(obj: &[u8]) -> Result<Model, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.obj");
    fs::write(&path, obj).unwrap();
    fs::write(
        folder.path().join("room.mtl"),
        "newmtl A\nKd 0.5\nnewmtl B\nKd 1 0 0\n",
    )
    .unwrap();
    load(&path, &Placement::default())
}

fn error(obj: &str) -> String {
    let message = read(obj.as_bytes()).unwrap_err().to_string();
    assert!(
        message.contains("room.obj"),
        "the file is not named: {message}"
    );
    message
}

fn area(part: &Part) -> f64 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| part.positions[i as usize]);
        0.5 * (b - a).cross(c - a).length()
    };
    part.triangles.iter().map(area).sum()
}

/// Four corners of the unit square.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn the_ceiling_of_a_hidden_room_keeps_its_48_square_metres() {
    // A U of 10 × 6 m around a court of 4 × 3 m, as one polygon: a fan from its first corner covers the court.
    let ceiling = b"o Ceiling\nv 10 3 0\nv 10 3 6\nv 0 3 6\nv 0 3 0\nv 3 3 0\nv 3 3 3\nv 7 3 3\nv 7 3 0\nf 1 2 3 4 5 6 7 8\n";
    let model = read(ceiling).unwrap();
    let part = &model.objects[0].parts[0];
    assert!((area(part) - 48.0).abs() < 1e-12, "{}", area(part));
    assert_eq!(part.triangles.len(), 6);
    assert_eq!(part.faces, [0; 6]);
    // (x, y, z) → (x, −z, y): the ceiling is up.
    assert!(part.positions.iter().all(|p| p.z == 3.0 && p.y <= 0.0));
    assert_eq!(model.notes, Vec::<String>::new());
}

#[test]
fn an_object_without_usemtl_inherits_the_material_before_it_and_is_noted() {
    let text = format!(
        "mtllib room.mtl\n{SQUARE}o One\nusemtl A\nf 1 2 3\no Two\nf 1 3 4\no Three\nusemtl B\nf 1 2 4\n"
    );
    let model = read(text.as_bytes()).unwrap();
    let materials: Vec<_> = model.objects.iter().map(|o| o.parts[0].material).collect();
    assert_eq!(materials, [Some(0), Some(0), Some(1)]);
    assert_eq!(model.notes.len(), 1);
    assert!(model.notes[0].contains("Two (A)"), "{:?}", model.notes);
}

#[test]
fn an_undefined_material_keeps_its_name_and_is_noted_with_its_line() {
    let model =
        read(format!("mtllib room.mtl\n{SQUARE}usemtl Wall Paint\nf 1 2 3\n").as_bytes()).unwrap();
    let used = &model.materials[model.objects[0].parts[0].material.unwrap()];
    assert_eq!(used.name, "Wall Paint");
    assert!(matches!(
        used.look,
        Look::Mtl {
            kd: None,
            ks: None,
            ke: None,
            ni: None,
            ..
        }
    ));
    assert!(
        model.notes[0].contains("\"Wall Paint\" (line 6)"),
        "{:?}",
        model.notes
    );
}

#[test]
fn a_one_value_kd_is_a_grey() {
    let model = read(format!("mtllib room.mtl\n{SQUARE}usemtl A\nf 1 2 3\n").as_bytes()).unwrap();
    assert!(matches!(
        model.materials[0].look,
        Look::Mtl {
            kd: Some([0.5, 0.5, 0.5]),
            ..
        }
    ));
}

#[test]
fn a_missing_mtl_is_an_error_with_its_name_and_line() {
    let message = error("# x\nmtllib absent one.mtl\n");
    assert!(
        message.contains("line 2") && message.contains("absent"),
        "{message}"
    );
}

#[test]
fn a_bad_value_in_the_mtl_is_an_error_with_the_mtls_name_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.obj");
    fs::write(&path, "mtllib my room.mtl\n").unwrap();
    fs::write(folder.path().join("my room.mtl"), "newmtl A\nKd 0,5\n").unwrap();
    let message = load(&path, &Placement::default()).unwrap_err().to_string();
    assert!(
        message.contains("my room.mtl: line 2") && message.contains("0,5"),
        "{message}"
    );
}

#[test]
fn a_latin1_mtl_and_obj_name_the_same_material() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.obj");
    fs::write(
        &path,
        [
            b"mtllib room.mtl\nusemtl T\xfcr\n".as_slice(),
            SQUARE.as_bytes(),
            b"f 1 2 3\n",
        ]
        .concat(),
    )
    .unwrap();
    fs::write(folder.path().join("room.mtl"), b"newmtl T\xfcr\nKd 0.25\n").unwrap();
    let model = load(&path, &Placement::default()).unwrap();
    assert_eq!(model.materials.len(), 1);
    assert_eq!(model.materials[0].name, "Tür");
    assert!(matches!(
        model.materials[0].look,
        Look::Mtl {
            kd: Some([0.25, ..]),
            ..
        }
    ));
}

#[test]
fn a_library_may_come_after_its_use_and_twice() {
    let text = format!("{SQUARE}usemtl B\nf 1 2 3\nmtllib room.mtl\nmtllib room.mtl\n");
    let model = read(text.as_bytes()).unwrap();
    assert_eq!(model.notes, Vec::<String>::new());
    let used = &model.materials[model.objects[0].parts[0].material.unwrap()];
    assert!(matches!(
        used.look,
        Look::Mtl {
            kd: Some([1.0, 0.0, 0.0]),
            ..
        }
    ));
}

#[test]
fn lines_and_points_are_no_triangles_and_noted() {
    let model =
        read(format!("{SQUARE}o A\nl 1 2 3\np 1\nl 2 3\nf 1 2 3\no Curve\nl 1 4\n").as_bytes())
            .unwrap();
    assert_eq!(model.objects.len(), 1);
    assert_eq!(model.objects[0].parts[0].triangles.len(), 1);
    assert!(
        model.notes[0].contains("3 l elements (first in line 6)"),
        "{:?}",
        model.notes
    );
    assert!(model.notes[1].contains("1 p elements (first in line 7)"));
    assert!(model.notes[2].contains("Curve"));
}

#[test]
fn indices_without_a_vertex_are_errors_with_line_object_and_numbers() {
    for bad in ["9", "0", "-5", "99999999999"] {
        let message = error(&format!("{SQUARE}o Wall\nf 1 2 {bad}/1/1\n"));
        assert!(message.contains("line 6, object Wall"), "{message}");
        assert!(
            message.contains(&format!("index {bad},")) && message.contains("4 vertices"),
            "{message}"
        );
    }
    for bad in ["x", "1.5", "/1", "99999999999999999999"] {
        let message = error(&format!("{SQUARE}f 1 2 {bad}\n"));
        assert!(
            message.contains("line 5") && message.contains(bad),
            "{message}"
        );
    }
}

#[test]
fn a_vertex_must_be_three_finite_numbers() {
    for bad in ["nan 0 0", "0 inf 0", "0 0 -infinity", "1e999 0 0"] {
        let message = error(&format!("o Wall\n{SQUARE}v {bad}\n"));
        assert!(
            message.contains("line 6, object Wall: vertex 5"),
            "{message}"
        );
    }
    for bad in ["0 0", "0 0 x", "0,5 0 0", "-nan(ind) 0 0"] {
        let message = error(&format!("o Wall\n{SQUARE}v {bad}\n"));
        assert!(
            message.contains("line 6, object Wall") && message.contains(bad),
            "{message}"
        );
    }
}

#[test]
fn indices_count_from_the_end_where_negative_and_normals_are_passed_over() {
    let model = read(
        format!("{SQUARE}vt 0 0\nvn 0 0 1\nf -4//1 -3/1/1 2/1 -1 # quad with a doubled corner\n")
            .as_bytes(),
    )
    .unwrap();
    let part = &model.objects[0].parts[0];
    assert!((area(part) - 0.5).abs() < 1e-15);
    assert_eq!(model.objects[0].name, "room");
}

#[test]
fn names_that_repeat_make_objects_of_their_own_with_names_of_their_own() {
    let model = read(format!("{SQUARE}o Leg\nf 1 2 3\no Leg\nf 1 3 4\n").as_bytes()).unwrap();
    let names: Vec<_> = model.objects.iter().map(|o| &*o.name).collect();
    assert_eq!(names, ["Leg", "Leg (2)"]);
}

#[test]
fn groups_make_objects_only_where_there_are_none_and_may_be_continued() {
    let model =
        read(format!("{SQUARE}g Wall\nf 1 2 3\ng Door\nf 1 2 4\ng Wall\nf 1 3 4\n").as_bytes())
            .unwrap();
    let faces: Vec<_> = model
        .objects
        .iter()
        .map(|o| (&*o.name, o.parts[0].triangles.len()))
        .collect();
    assert_eq!(faces, [("Wall", 2), ("Door", 1)]);
    let model =
        read(format!("{SQUARE}o Room\ng Wall\nf 1 2 3\ng Door\nf 1 2 4\n").as_bytes()).unwrap();
    assert_eq!(model.objects.len(), 1);
    assert_eq!(model.objects[0].name, "Room");
}

#[test]
fn materials_that_alternate_make_one_part_each() {
    let faces = "usemtl A\nf 1 2 3\nusemtl B\nf 1 3 4\n".repeat(3);
    let model = read(format!("mtllib room.mtl\n{SQUARE}o Wall\n{faces}").as_bytes()).unwrap();
    let parts = &model.objects[0].parts;
    assert_eq!(parts.len(), 2);
    assert_eq!(parts[0].triangles.len(), 3);
    assert_eq!(parts[1].faces, [0, 1, 2]);
    // Vertex 2 is not in the second part, vertex 4 not in the first.
    assert_eq!((parts[0].positions.len(), parts[1].positions.len()), (3, 3));
}

#[test]
fn an_object_of_very_many_faces_stays_one_part_with_each_vertex_once() {
    let side = 300;
    let mut text = "o Terrain\n".to_owned();
    for i in 0..=side {
        for j in 0..=side {
            text += &format!("v {i} 0 {j}\n");
        }
    }
    for i in 0..side {
        for j in 1..=side {
            let near = i * (side + 1) + j;
            let far = near + side + 1;
            text += &format!("f {near} {} {} {far}\n", near + 1, far + 1);
        }
    }
    let model = read(text.as_bytes()).unwrap();
    assert_eq!((model.objects.len(), model.objects[0].parts.len()), (1, 1));
    let part = &model.objects[0].parts[0];
    assert_eq!(part.positions.len(), 301 * 301);
    assert!(part.faces.iter().copied().eq((0..180_000).map(|t| t / 2)));
    assert!((area(part) - 90_000.0).abs() < 1e-6, "{}", area(part));
}

#[test]
fn a_material_defined_twice_is_the_later_one_and_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.obj");
    let first = format!("mtllib one.mtl\n{SQUARE}usemtl A\nf 1 2 3\n");
    fs::write(&path, first + "mtllib two.mtl\nusemtl A\nf 1 3 4\n").unwrap();
    fs::write(folder.path().join("one.mtl"), "newmtl A\nKd 1\n").unwrap();
    fs::write(folder.path().join("two.mtl"), "newmtl A\nKd 0.5\n").unwrap();
    let model = load(&path, &Placement::default()).unwrap();
    let [part] = &model.objects[0].parts[..] else {
        panic!("{:?}", model.objects)
    };
    let Look::Mtl { kd, .. } = model.materials[part.material.unwrap()].look else {
        panic!()
    };
    assert_eq!(kd, Some([0.5; 3]));
    assert!(
        model.notes[0].contains("material A is defined twice"),
        "{:?}",
        model.notes
    );
}

#[test]
fn a_usemtl_without_a_name_is_an_error_with_its_line() {
    let message = error(&format!("{SQUARE}usemtl\nf 1 2 3\n"));
    assert!(
        message.contains("line 5") && message.contains("usemtl"),
        "{message}"
    );
}

#[test]
fn a_face_that_crosses_itself_or_has_two_corners_is_noted() {
    let model = read(format!("{SQUARE}f 1 3 2 4\nf 1 2\nf 1 2 3\n").as_bytes()).unwrap();
    assert!(
        model.notes[0].contains("2 faces (first in line 5)"),
        "{:?}",
        model.notes
    );
}

#[test]
fn a_frame_is_the_worlds_in_the_place_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.obj");
    fs::write(&path, format!("{SQUARE}f 1 2 3\n")).unwrap();
    let placement = Placement {
        scale: 2.0,
        translate: glam::DVec3::X,
        ..Placement::default()
    };
    let frame = load(&path, &placement).unwrap().objects[0].frame;
    assert_eq!(
        frame.matrix3,
        glam::DMat3::from_diagonal(glam::DVec3::splat(2.0))
    );
    assert_eq!(frame.translation, glam::DVec3::X);
}
