//! Sensors that cannot be.

use super::super::room_with;
use super::{assert_each, assert_told, refusal, room_and};

#[test]
fn a_sensor_that_cannot_be() {
    let points = "points = [[2, 1.5, 0.75]]";
    let grid = |counts: &str| {
        format!("grid = {{ origin = [0, 0, 1], u = [1, 0, 0], v = [0, 1, 0], counts = {counts} }}")
    };
    let sensor = "[[sensor]]\nname = \"desk\"\npoints = [[2, 1.5, 0.75]]\nnormal = [0, 0, 1]\n";
    assert_each(&[
        (
            sensor,
            "",
            &["room.toml: there is no sensor", "[[sensor]]", "SENSOR_"],
        ),
        (
            "normal = [0, 0, 1]",
            "normal = [0, 0, 0]",
            &["room.toml:19:10: ", "normal must be a direction, not zero"],
        ),
        (
            "name = \"desk\"\n",
            "",
            &["room.toml:16:1: ", "[[sensor]]", "lacks the key \"name\""],
        ),
        (
            "name = \"desk\"",
            "name = \"../desk\"",
            &["room.toml:17:8: ", "names a file", "\"../desk\""],
        ),
        (
            points,
            &grid("[0, 3]"),
            &[
                "room.toml:18:",
                "counts[0]",
                "whole number from 1",
                "found 0",
            ],
        ),
        (
            points,
            &grid("[1000000, 1000000]"),
            &["room.toml:18:", "counts[0]", "found 1000000"],
        ),
        (
            points,
            "points = []",
            &["room.toml:18:10: ", "at least one point"],
        ),
        (
            points,
            "",
            &[
                "room.toml:16:1: ",
                "[[sensor]]",
                "lacks the key \"grid\"",
                "points, line, file and mesh",
            ],
        ),
        (
            points,
            "points = [[2, 1.5, 0.75]]\nline = { from = [0, 0, 1], to = [1, 0, 1], count = 3 }",
            &["room.toml:19:8: ", "points or line, not both"],
        ),
        (
            points,
            "grid = { origin = [0, 0, 1], u = [1, 0, 0], v = [2, 0, 0], counts = [2, 2] }",
            &["room.toml:18:", "spans an area"],
        ),
        (
            points,
            "mesh = \"Board*\"",
            &["room.toml:18:8: ", "no mesh object is called \"Board*\""],
        ),
    ]);
}

#[test]
fn two_sensors_of_one_name() {
    for name in ["desk", "Desk"] {
        let more =
            format!("\n[[sensor]]\nname = \"{name}\"\npoints = [[1, 1, 1]]\nnormal = [0, 0, 1]\n");
        let told = refusal(&room_and(&more), &[], &[]);
        assert_told(
            &told,
            &[
                "room.toml:25:8: ",
                &format!("{name:?} is used twice"),
                "names must differ",
            ],
        );
    }
}

#[test]
fn a_bad_line_of_a_file_of_points_is_told_by_its_number() {
    let scene = room_with("points = [[2, 1.5, 0.75]]", "file = \"desk.pts\"");
    let told = refusal(scene.as_bytes(), &[], &[]);
    assert_told(&told, &["room.toml:18:8: ", "desk.pts", "no such file"]);
    for (content, parts) in [
        (
            "1 1 1 0 0 1\n2 2 2 0 0\n",
            ["desk.pts:2:1: ", "x y z nx ny nz", "\"2 2 2 0 0\""],
        ),
        (
            "1 1 1 0 0 1\n\n2 two 2 0 0 1\n",
            ["desk.pts:3:1: ", "finite numbers", "\"2 two 2 0 0 1\""],
        ),
        (
            "1 nan 1 0 0 1\n",
            ["desk.pts:1:1: ", "finite numbers", "nan"],
        ),
        (
            "1 1 1 0 0 0\n",
            [
                "desk.pts:1:1: ",
                "normal that is not zero",
                "\"1 1 1 0 0 0\"",
            ],
        ),
        ("\n", ["room.toml:18:8: ", "desk.pts", "no point"]),
    ] {
        let told = refusal(scene.as_bytes(), &[("desk.pts", content.as_bytes())], &[]);
        assert_told(&told, &parts);
    }
}
