//! Values that cannot be, materials and lamps among them.

use super::super::room_with;
use super::{assert_each, assert_told, refusal};

#[test]
fn a_value_of_the_wrong_type_tells_both() {
    assert_each(&[
        (
            "rho = 0.5",
            "rho = \"half\"",
            &["room.toml:14:7: ", "rho must be a number", "\"half\""],
        ),
        (
            "[[sensor]]",
            "[sensor]",
            &[
                "room.toml:16:1: ",
                "sensor must be a list of tables",
                "[[sensor]]",
            ],
        ),
        (
            "position = [2, 1.5, 2]",
            "position = [2, 1.5]",
            &["room.toml:10:12: ", "list of 3 numbers", "a list of 2"],
        ),
        (
            "inward = true",
            "inward = 1",
            &[
                "room.toml:5:10: ",
                "inward must be true or false",
                "found 1",
            ],
        ),
        (
            "material = \"plaster\"",
            "material = 3",
            &["room.toml:6:12: ", "material must be a string", "found 3"],
        ),
    ]);
}

#[test]
fn a_number_out_of_its_range_tells_the_range() {
    let value = "rho = 0.5\n";
    for (new, allowed) in [
        ("a = -1", "a must be a number from 0 to 1, found -1"),
        ("a = nan", "a must be a number from 0 to 1, found NaN"),
        (
            "n = 0",
            "n must be a number > 0, or inf for an ideal mirror, found 0",
        ),
        (
            "n = nan",
            "n must be a number > 0, or inf for an ideal mirror, found NaN",
        ),
        ("k = -0.5", "k must be a number ≥ 0, found -0.5"),
        ("k = inf", "k must be a number ≥ 0, found inf"),
        ("exitance = -1", "exitance must be a number ≥ 0, found -1"),
    ] {
        let told = refusal(
            room_with(value, &format!("{value}{new}\n")).as_bytes(),
            &[],
            &[],
        );
        assert_told(&told, &["room.toml:15:", "[material.plaster]", allowed]);
    }
    assert_each(&[
        (
            "rho = 0.5",
            "rho = 1.2",
            &[
                "room.toml:14:7: ",
                "rho must be a number from 0 to 1, found 1.2",
            ],
        ),
        ("rho = 0.5", "rho = nan", &["room.toml:14:7: ", "found NaN"]),
        (
            "intensity = 10",
            "intensity = inf",
            &[
                "room.toml:11:13: ",
                "intensity must be a number ≥ 0, found inf",
            ],
        ),
        (
            "position = [2, 1.5, 2]",
            "position = [2, nan, 2]",
            &["room.toml:10:16: ", "finite number, found NaN"],
        ),
        (
            "max = [4, 3, 2.5]",
            "max = [4, -3, 2.5]",
            &["room.toml:4:7: ", "max must be greater than min"],
        ),
        (
            "samples = 64",
            "samples = 0",
            &[
                "room.toml:22:11: ",
                "samples must be a whole number ≥ 1, found 0",
            ],
        ),
        (
            "samples = 64",
            "samples = 1.5",
            &["room.toml:22:11: ", "a whole number ≥ 1, found 1.5"],
        ),
        (
            "samples = 64",
            "relative_error = 0",
            &[
                "room.toml:22:18: ",
                "relative_error must be a number > 0, found 0",
            ],
        ),
        (
            "samples = 64",
            "relative_error = -0.1",
            &["room.toml:22:18: ", "a number > 0, found -0.1"],
        ),
        (
            "samples = 64",
            "seconds = -1",
            &[
                "room.toml:22:11: ",
                "seconds must be a number > 0, found -1",
            ],
        ),
        (
            "samples = 64",
            "seed = -1",
            &[
                "room.toml:22:8: ",
                "seed must be a whole number ≥ 0, found -1",
            ],
        ),
    ]);
}

#[test]
fn a_material_that_is_missing_or_lacks_its_reflectance() {
    assert_each(&[
        (
            "rho = 0.5",
            "a = 0.5",
            &["material \"plaster\"", "reflectance rho", "rho = 0.5"],
        ),
        (
            "material = \"plaster\"",
            "material = \"plastre\"",
            &["room.toml:6:12: ", "\"plastre\"", "nearest is \"plaster\""],
        ),
        (
            "material = \"plaster\"\n",
            "",
            &["room.toml:1:1: ", "[[shape]]", "lacks the key \"material\""],
        ),
        (
            "[material.plaster]",
            "[material.\"Wall*\"]\nrho = 0.3\n[material.plaster]",
            &["room.toml:13:11: ", "\"Wall*\"", "nearest is \"plaster\""],
        ),
    ]);
}

#[test]
fn a_scene_without_light_says_that_gltf_drops_area_lights() {
    let source = "[[source]]\nkind = \"point\"\nposition = [2, 1.5, 2]\nintensity = 10\n";
    for (old, new) in [(source, ""), ("intensity = 10", "intensity = 0")] {
        let told = refusal(room_with(old, new).as_bytes(), &[], &[]);
        assert_told(
            &told,
            &[
                "room.toml: nothing emits light",
                "glTF drops Blender's area lights",
                "[[source]]",
                "exitance",
            ],
        );
    }
}

#[test]
fn a_source_or_an_emission_that_cannot_be() {
    let spot = |cone: &str| format!("\"spot\"\ndirection = [0, 0, -1]\ncone_deg = {cone}");
    for (cone, found) in [("181", "found 181"), ("360", "found 360"), ("0", "found 0")] {
        let told = refusal(room_with("\"point\"", &spot(cone)).as_bytes(), &[], &[]);
        assert_told(
            &told,
            &[
                "room.toml:11:12: ",
                "cone_deg must be an angle > 0 and at most 180 degrees",
                found,
            ],
        );
    }
    let intensity = "intensity = 10";
    for (new, parts) in [
        (
            "stokes = [1, 0.8, 0.8, 0]",
            ["room.toml:12:10: ", "q² + u² + v² ≤ 1", "0.8, 0.8"],
        ),
        (
            "stokes = [2, 0, 0, 0]",
            ["room.toml:12:10: ", "[1, q, u, v]", "[2"],
        ),
        (
            "axis = [0, 0, 0]",
            [
                "room.toml:12:8: ",
                "axis must be a direction, not zero",
                "[0, 0, 0]",
            ],
        ),
        (
            "distribution = \"cosine\"\ndirection = [0, 0, 0]",
            [
                "room.toml:13:13: ",
                "direction must be a direction, not zero",
                "[0, 0, 0]",
            ],
        ),
        (
            "distribution = \"cosine\"",
            [
                "room.toml:8:1: ",
                "[[source]]",
                "lacks the key \"direction\"",
            ],
        ),
    ] {
        let scene = room_with(intensity, &format!("{intensity}\n{new}"));
        assert_told(&refusal(scene.as_bytes(), &[], &[]), &parts);
    }
    for state in ["[1, 0.6, 0.6, 0.6]", "[0.5, 0, 0, 0]"] {
        let emission = format!("rho = 0.5\nexitance = 1\nemission_stokes = {state}");
        let told = refusal(room_with("rho = 0.5", &emission).as_bytes(), &[], &[]);
        assert_told(
            &told,
            &[
                "room.toml:16:19: ",
                "emission_stokes must be [1, q, u, v] with q² + u² + v² ≤ 1",
            ],
        );
    }
}
