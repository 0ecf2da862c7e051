//! Cameras and radiances that cannot be.

use super::{assert_each, assert_told, refusal, room_and};

const EYE: &str = "\n[[camera]]\nname = \"eye\"\nposition = [1, 1, 1.5]\nlook_at = [3, 2, 1]\n";

#[test]
fn a_camera_that_cannot_be() {
    for (line, parts) in [
        ("up = [2, 1, -0.5]", ["room.toml:28:6: ", "across the view"]),
        (
            "fov_deg = 180",
            ["room.toml:28:11: ", "> 0 and < 180 degrees, found 180"],
        ),
        (
            "width = 20000",
            ["room.toml:28:9: ", "from 1 to 16384, found 20000"],
        ),
        (
            "height = 0",
            ["room.toml:28:10: ", "from 1 to 16384, found 0"],
        ),
        (
            "samples = 0",
            ["room.toml:28:11: ", "a whole number ≥ 1, found 0"],
        ),
        (
            "fov = 60",
            [
                "room.toml:28:1: [[camera]] has no key \"fov\"",
                "nearest is \"fov_deg\"",
            ],
        ),
    ] {
        let told = refusal(&room_and(&format!("{EYE}{line}\n")), &[], &[]);
        assert_told(&told, &parts);
    }
    for (old, new, parts) in [
        (
            "\"eye\"",
            "\"Desk\"",
            ["room.toml:25:8: ", "the camera name \"Desk\" is used twice"],
        ),
        ("\"eye\"", "\"a/b\"", ["room.toml:25:8: ", "names a file"]),
        (
            "[3, 2, 1]",
            "[1, 1, 1.5]",
            ["room.toml:27:11: ", "another point than position"],
        ),
        (
            "[3, 2, 1]",
            "[1, 1, 0]",
            ["room.toml:27:11: ", "give up, such as [0, 1, 0]"],
        ),
        (
            "position = [1, 1, 1.5]\n",
            "",
            ["room.toml:24:1: ", "lacks the key \"position\""],
        ),
        (
            "look_at",
            "lookat",
            ["room.toml:27:1: ", "nearest is \"look_at\""],
        ),
    ] {
        let told = refusal(&room_and(&EYE.replace(old, new)), &[], &[]);
        assert_told(&told, &parts);
    }
}

#[test]
fn a_radiance_that_cannot_be() {
    let normal = "normal = [0, 0, 1]";
    let looks = "quantity = \"radiance\"\ndirection = [0, 0, 1]";
    assert_each(&[
        (
            normal,
            "quantity = \"radiance\"",
            &[
                "room.toml:16:1: ",
                "lacks the key \"direction\"",
                "where the sensor looks",
            ],
        ),
        (
            normal,
            &format!("{normal}\n{looks}"),
            &["room.toml:19:10: normal goes with quantity = \"irradiance\""],
        ),
        (
            normal,
            &format!("{looks}\nframe = \"fixed\""),
            &["room.toml:21:9: frame goes with quantity = \"irradiance\""],
        ),
        (
            normal,
            &format!("{normal}\ndirection = [0, 0, 1]"),
            &["room.toml:20:13: direction goes with quantity = \"radiance\""],
        ),
        (
            normal,
            "quantity = \"radiance\"\ndirection = [0, 0, 0]",
            &["room.toml:20:13: ", "not zero"],
        ),
    ]);
}
