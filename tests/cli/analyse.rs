//! Pictures of cameras: what filters show of known light, and every way to give a picture that is none.

mod bad_picture;
mod files;

use super::{Folder, stderr, stdout};
use files::{Layout, Pixels, read_floats, read_png};
use std::process::Output;

/// Runs `malus analyse view.tiff` in a folder that holds that file.
fn analysed(file: &[u8], words: &[&str]) -> (Folder, Output) {
    let folder = Folder::new(b"", &[("view.tiff", file)]);
    let output = folder.malus(&[&["analyse", "view.tiff"], words].concat());
    (folder, output)
}

/// The same where it has to succeed without a warning.
#[track_caller]
fn good(file: &[u8], words: &[&str]) -> (Folder, Output) {
    let (folder, output) = analysed(file, words);
    assert_eq!(
        (output.status.code(), stderr(&output)),
        (Some(0), String::new())
    );
    (folder, output)
}

/// A picture of 6 × 4 pixels that are all alike.
fn even(stokes: [f32; 4]) -> Vec<u8> {
    Layout::of([6, 4], &[stokes; 24]).bytes()
}

#[track_caller]
fn assert_says(output: &Output, parts: &[&str]) {
    let text = stdout(output);
    for part in parts {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}

/// By the conventions S2 > 0 is a field along x + y. In a picture x is right and y up, so the viewer sees it rise to the right,
/// and a filter lets it through at +45°, counter-clockwise from the right.
#[test]
fn light_with_s2_above_0_is_brightest_at_plus_45_degrees() {
    let (folder, output) = good(
        &even([2.0, 0.0, 2.0, 0.0]),
        &["--angle", "45", "--angle", "-45"],
    );
    assert_eq!(read_floats(&folder, "view-filter-45.tiff"), [2.0; 24]);
    assert_eq!(read_floats(&folder, "view-filter--45.tiff"), [0.0; 24]);
    let whole = read_png(&folder, "view-s0.png");
    assert_eq!(read_png(&folder, "view-filter-45.png"), whole);
    let dark = read_png(&folder, "view-filter--45.png");
    assert!(dark.pixels.iter().all(|pixel| *pixel == [0; 3]));
    assert_says(
        &output,
        &[
            "most at 135.0°: 0.0 % passes; least at 45.0°: 100.0 %",
            "linear 100.0 %, circular 0.0 %",
        ],
    );
}

/// Ideal filters by definition: all, half or nothing of each pure state.
#[test]
fn known_states_pass_as_they_are_defined() {
    for (state, angle, passed) in [
        ([1.0, 1.0, 0.0, 0.0], "0", 1.0),
        ([1.0, 1.0, 0.0, 0.0], "90", 0.0),
        ([1.0, -1.0, 0.0, 0.0], "90", 1.0),
        ([1.0, -1.0, 0.0, 0.0], "180", 0.0),
        ([1.0, 0.0, -1.0, 0.0], "135", 1.0),
        ([1.0, 0.0, -1.0, 0.0], "45", 0.0),
        ([1.0, 0.0, 0.0, 1.0], "30", 0.5),
        ([1.0, 0.0, 0.0, -1.0], "90", 0.5),
        ([1.0, 0.0, 0.0, 0.0], "-270", 0.5),
        ([1.0, 1.0, 0.0, 0.0], "60", 0.25),
    ] {
        let (folder, _) = good(&even(state), &["--angle", angle]);
        let found = read_floats(&folder, &format!("view-filter-{angle}.tiff"));
        // Half a unit in the last place of a 32-bit float.
        assert!(
            found.iter().all(|value| (value - passed).abs() <= 3e-8),
            "{state:?} {angle}: {found:?}"
        );
    }
}

#[test]
fn rows_run_from_the_top_and_pixels_from_the_left() {
    let stokes: Vec<[f32; 4]> = (1..=6)
        .map(|radiance| [radiance as f32, 0.0, 0.0, 0.0])
        .collect();
    let (folder, _) = good(&Layout::of([3, 2], &stokes).bytes(), &["--angle", "0"]);
    assert_eq!(
        read_floats(&folder, "view-filter-0.tiff"),
        [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]
    );
    let picture = read_png(&folder, "view-s0.png");
    assert_eq!(picture.sides, [3, 2]);
    let greys: Vec<u8> = picture.pixels.iter().map(|pixel| pixel[0]).collect();
    assert!(greys.windows(2).all(|pair| pair[0] < pair[1]), "{greys:?}");
}

/// One exposure for both: half the light is half the luminance of the screen, whatever the exposure.
#[test]
fn unpolarised_light_looks_half_as_bright_through_any_filter() {
    for words in [
        ["--angle", "20", "--exposure", "0"],
        ["--angle", "20", "--exposure", "-1"],
    ] {
        let (folder, output) = good(&even([300.0, 0.0, 0.0, 0.0]), &words);
        let [whole, half] = ["view-s0.png", "view-filter-20.png"]
            .map(|name| Pixels::luminance(read_png(&folder, name).pixels[0]));
        // One code of 255 is 1 % of the luminance.
        assert!((half / whole - 0.5).abs() < 0.01, "{half} of {whole}");
        assert_says(
            &output,
            &["a filter darkens the picture alike at all angles", "50.0"],
        );
    }
}

#[test]
fn the_pictures_of_polarisation_have_a_legend_beside_the_pixels() {
    let mut stokes = vec![[1.0, 0.5, 0.0, 0.0]; 24];
    stokes[0] = [1.0, 0.0, 0.0, 0.0];
    let (folder, _) = good(&Layout::of([6, 4], &stokes).bytes(), &[]);
    for name in ["view-dolp.png", "view-aolp.png"] {
        let picture = read_png(&folder, name);
        let [width, height] = picture.sides;
        assert!(width > 100 && height > 200, "{name}: {width} × {height}");
        let row = &picture.pixels[..6];
        assert!(
            row[0] != row[1] && row[1..].iter().all(|pixel| *pixel == row[1]),
            "{name}: {row:?}"
        );
        let legend = picture
            .pixels
            .iter()
            .filter(|[r, g, b]| *r < 60 && r == g && g == b);
        assert!(legend.count() > 1000, "{name}: no letters");
        let colours: std::collections::BTreeSet<_> = picture.pixels.iter().collect();
        assert!(colours.len() > 50, "{name}: no bar");
    }
}

/// The colour of an angle does not depend on the sense of its axis, and unpolarised light has none.
#[test]
fn the_angle_of_polarisation_is_a_hue_and_its_degree_the_strength() {
    let turned = |degree: f32, angle_deg: f32| {
        let twice = 2.0 * angle_deg.to_radians();
        [1.0, degree * twice.cos(), degree * twice.sin(), 0.0]
    };
    let stokes = [
        turned(1.0, 30.0),
        turned(1.0, 210.0),
        turned(1.0, 120.0),
        turned(0.0, 30.0),
    ];
    let (folder, _) = good(&Layout::of([4, 1], &stokes).bytes(), &[]);
    let pixels = &read_png(&folder, "view-aolp.png").pixels[..4];
    assert_eq!(pixels[0], pixels[1]);
    let apart =
        |one: usize, other: usize| (0..3).any(|c| pixels[one][c].abs_diff(pixels[other][c]) > 60);
    assert!(apart(0, 2), "{pixels:?}");
    let [r, g, b] = pixels[3];
    assert!(r == g && g == b, "{pixels:?}");
}

#[test]
fn files_go_beside_the_picture_or_where_they_are_asked_for_and_leave_it_as_it_is() {
    let file = even([1.0, 0.2, 0.0, 0.0]);
    let names = |folder: &Folder, name: &str| {
        let entries = std::fs::read_dir(folder.path(name)).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    let written = [
        "view-aolp.png",
        "view-dolp.png",
        "view-filter-22.5.png",
        "view-filter-22.5.tiff",
        "view-s0.png",
    ];
    let (folder, output) = good(&file, &["--angle", "22.50", "-o", "a/b"]);
    assert_eq!(names(&folder, "a/b"), written);
    assert_eq!(names(&folder, "."), ["a", "room.toml", "view.tiff"]);
    assert_says(&output, &written);
    assert_says(&output, &["a/b", "6 × 4 pixels", "lm/(m²·sr)"]);
    let (folder, _) = good(&file, &["--angle", "22.5"]);
    assert_eq!(
        names(&folder, "."),
        [&["room.toml"][..], &written, &["view.tiff"]].concat()
    );
    assert_eq!(std::fs::read(folder.path("view.tiff")).unwrap(), file);
    assert!(
        !String::from_utf8_lossy(&std::fs::read(folder.path("view-filter-22.5.tiff")).unwrap())
            .contains("S3")
    );
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    let stokes: Vec<[f32; 4]> = (0_u8..=255)
        .map(|i| [f32::from(i), f32::from(i) / 3.0, -1.0, 0.1])
        .collect();
    let file = Layout::of([16, 16], &stokes).bytes();
    let [one, other] = [0, 1].map(|_| good(&file, &["--angle", "17"]).0);
    for name in [
        "view-s0.png",
        "view-dolp.png",
        "view-aolp.png",
        "view-filter-17.png",
        "view-filter-17.tiff",
    ] {
        let [one, other] = [&one, &other].map(|folder| std::fs::read(folder.path(name)).unwrap());
        assert!(one == other, "{name}");
    }
}

#[test]
fn an_incomplete_picture_is_told() {
    let layout = Layout {
        description: "unit = W/(m^2 sr)\ncomplete = no".to_owned(),
        ..Layout::of([1, 1], &[[1.0, 0.0, 0.0, 0.0]])
    };
    let (_, output) = analysed(&layout.bytes(), &[]);
    assert_eq!(output.status.code(), Some(0));
    assert!(
        stderr(&output).starts_with("warning: view.tiff: "),
        "{}",
        stderr(&output)
    );
    assert_says(&output, &["W/(m²·sr)"]);
}

#[test]
fn a_picture_without_light_is_no_failure() {
    let (folder, output) = good(&even([0.0; 4]), &["--angle", "10"]);
    assert_says(&output, &["mean S0 0 ", "linear 0.0 %"]);
    assert!(
        read_png(&folder, "view-s0.png")
            .pixels
            .iter()
            .all(|pixel| *pixel == [0; 3])
    );
}
