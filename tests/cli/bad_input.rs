//! Every way to get an input wrong ends in exit status 2 and one error that says where, what was found, what is allowed.

mod arguments;
mod cameras;
mod kinds;
mod meshes;
mod sensors;
mod values;

use super::{Folder, ROOM, room_with, stderr};

/// Runs a scene that is wrong and returns what is said of it.
///
/// Asserts what holds for every error of an input: exit status 2, one error and nothing beside it, no table, no panic,
/// no results. `check` has to say the same as `run`.
#[track_caller]
pub fn refusal(scene: &[u8], files: &[(&str, &[u8])], options: &[&str]) -> String {
    let folder = Folder::new(scene, files);
    let output = folder.malus(&[&["run", "room.toml", "-o", "out"], options].concat());
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.starts_with("error: "), "{told}");
    assert_eq!(told.matches("error: ").count(), 1, "{told}");
    assert!(
        !told.contains("panicked") && !told.contains("RUST_BACKTRACE"),
        "{told}"
    );
    assert!(output.stdout.is_empty(), "a table beside the error");
    assert!(
        !folder.path("out").exists(),
        "results of a scene that is wrong"
    );
    if options.is_empty() {
        let output = folder.malus(&["check", "room.toml"]);
        assert_eq!(
            (output.status.code(), stderr(&output)),
            (Some(2), told.clone()),
            "check says something else"
        );
    }
    told
}

/// Asserts that a message has every part that is essential.
#[track_caller]
pub fn assert_told(told: &str, parts: &[&str]) {
    for part in parts {
        assert!(told.contains(part), "no {part:?} in:\n{told}");
    }
}

/// Changes one passage of the good room at a time and asserts what is said of it.
#[track_caller]
fn assert_each(cases: &[(&str, &str, &[&str])]) {
    for (old, new, parts) in cases {
        assert_told(&refusal(room_with(old, new).as_bytes(), &[], &[]), parts);
    }
}

/// The good room with a text after it.
fn room_and(text: &str) -> Vec<u8> {
    format!("{ROOM}{text}").into_bytes()
}

#[test]
fn the_room_that_is_spoiled_here_is_good_itself() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let output = folder.run("out", &[]);
    assert_eq!(stderr(&output), "");
}

#[test]
fn a_scene_file_that_is_none() {
    let folder = Folder::new(b"", &[("folder/", b"")]);
    for (scene, reason) in [
        ("absent.toml", "no such file"),
        ("folder", "is a directory"),
    ] {
        for command in ["run", "check"] {
            let output = folder.malus(&[command, scene]);
            assert_eq!(output.status.code(), Some(2));
            assert_told(&stderr(&output), &["error: ", scene, reason]);
        }
    }
    assert!(!folder.path("results").exists());
}

#[test]
fn text_that_is_no_toml_is_refused_at_its_line_and_column() {
    let latin = [ROOM.as_bytes(), b"# caf\xe9\n"].concat();
    assert_told(&refusal(&latin, &[], &[]), &["room.toml:23:6: ", "UTF-8"]);
    assert_each(&[
        ("rho = 0.5", "rho = ", &["room.toml:14:7: not valid TOML"]),
        (
            "rho = 0.5",
            "rho = 0.5\nrho = 0.4",
            &["room.toml:15:1: not valid TOML", "duplicate key"],
        ),
        (
            "[material.plaster]",
            "[material.plaster",
            &["room.toml:13:", "not valid TOML"],
        ),
    ]);
}

#[test]
fn an_unknown_key_is_told_with_the_nearest() {
    assert_each(&[
        (
            "rho = 0.5",
            "roh = 0.5",
            &[
                "room.toml:14:1: ",
                "[material.plaster]",
                "\"roh\"",
                "nearest is \"rho\"",
            ],
        ),
        (
            "[material.plaster]",
            "[materal.plaster]",
            &["room.toml:13:2: ", "\"materal\"", "nearest is \"material\""],
        ),
        (
            "[[source]]",
            "[[sources]]",
            &["room.toml:8:3: ", "\"sources\"", "nearest is \"source\""],
        ),
        (
            "inward = true",
            "inwards = true",
            &[
                "room.toml:5:1: ",
                "[[shape]]",
                "\"inwards\"",
                "nearest is \"inward\"",
            ],
        ),
        (
            "samples = 64",
            "sample = 64",
            &["room.toml:22:1: ", "\"sample\"", "nearest is \"samples\""],
        ),
    ]);
}

#[test]
fn an_unknown_kind_is_told_with_the_known_ones() {
    assert_each(&[
        (
            "\"box\"",
            "\"bocks\"",
            &[
                "room.toml:2:8: ",
                "kind",
                "\"bocks\"",
                "nearest is \"box\"",
                "\"sphere\"",
            ],
        ),
        (
            "\"point\"",
            "\"pont\"",
            &[
                "room.toml:9:8: ",
                "kind",
                "\"pont\"",
                "nearest is \"point\"",
                "\"distant\"",
            ],
        ),
        (
            "rho = 0.5",
            "kind = \"mixtur\"\nrho = 0.5",
            &["room.toml:14:8: ", "\"mixtur\"", "nearest is \"mixture\""],
        ),
        (
            "samples = 64",
            "model = \"polarized\"",
            &["room.toml:22:9: ", "model", "nearest is \"polarised\""],
        ),
        (
            "samples = 64",
            "compare = [\"scaler\"]",
            &["room.toml:22:12: ", "compare", "nearest is \"scalar\""],
        ),
        (
            "samples = 64",
            "representation = \"linaer\"",
            &["room.toml:22:18: ", "nearest is \"linear\""],
        ),
        (
            "name = \"desk\"",
            "name = \"desk\"\nframe = \"fix\"",
            &["room.toml:18:9: ", "frame", "nearest is \"fixed\""],
        ),
        (
            "name = \"desk\"",
            "name = \"desk\"\nquantity = \"iradiance\"",
            &["room.toml:18:12: ", "\"irradiance\""],
        ),
        (
            "[run]",
            "[scene]\nunit = \"lux\"\n[run]",
            &["room.toml:22:8: ", "unit", "\"lux\"", "\"lm\" or \"W\""],
        ),
    ]);
}

#[test]
fn all_that_is_wrong_with_several_meshes_is_told_at_once() {
    let scene = room_and("\n[[mesh]]\nfile = \"absent.glb\"\n[[mesh]]\nfile = \"empty.glb\"\n");
    let told = refusal(&scene, &[("empty.glb", b"")], &[]);
    assert_told(
        &told,
        &["room.toml:25:8: absent.glb", "room.toml:27:8: empty.glb"],
    );
    assert_eq!(told.lines().count(), 2, "{told}");
}
