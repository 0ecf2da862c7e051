//! Every way to give a picture that is none: exit status 2, the path, what was found, what is needed; nothing written.

use super::files::Layout;
use super::{analysed, even};
use crate::cli::{Folder, assert_told, stderr};
use std::process::Output;

/// What the program says of a bad picture or bad options.
#[track_caller]
fn refusal(folder: &Folder, output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2), "{}", stderr(output));
    let entries = std::fs::read_dir(folder.path(".")).unwrap();
    let results = entries.filter(|entry| {
        let name = entry.as_ref().unwrap().file_name();
        name.to_string_lossy().starts_with("view-")
    });
    assert_eq!(results.count(), 0, "something was written");
    stderr(output)
}

#[track_caller]
fn assert_refused(file: &[u8], parts: &[&str]) {
    let (folder, output) = analysed(file, &["--angle", "30"]);
    let told = refusal(&folder, &output);
    assert_told(&told, &[&["error: view.tiff: "], parts].concat());
}

fn layout() -> Layout {
    Layout::of([2, 2], &[[1.0, 0.5, 0.0, 0.0]; 4])
}

const NEEDED: &str = "4 samples per pixel, 32-bit floats";

#[test]
fn a_file_that_is_no_tiff() {
    for file in [
        &b"P6 1 1 255 ..."[..],
        b"\x89PNG\r\n\x1a\n",
        b"II",
        b"IIx\0\x08\0\0\0",
        b"<svg/>",
    ] {
        let (folder, output) = analysed(file, &[]);
        let told = refusal(&folder, &output);
        assert!(
            told.contains("no TIFF") || told.contains("not whole"),
            "{file:?}: {told}"
        );
    }
    assert_refused(b"P6 1 1 255 ...", &["no TIFF file", NEEDED]);
    assert_refused(b"", &["no TIFF file", NEEDED]);
}

#[test]
fn a_file_that_is_not_there() {
    let folder = Folder::new(b"", &[("folder/", b"")]);
    for (path, reason) in [
        ("absent.tiff", "there is no such file"),
        ("folder", "is a directory"),
    ] {
        let output = folder.malus(&["analyse", path]);
        assert_told(&refusal(&folder, &output), &["error: ", path, reason]);
    }
}

#[test]
fn other_samples_than_four_floats() {
    let three = Layout {
        samples: 3,
        pixels: vec![0; 48],
        ..layout()
    };
    assert_refused(
        &three.bytes(),
        &["found 3 samples per pixel, 32-bit floats", NEEDED],
    );
    let one = Layout {
        samples: 1,
        pixels: vec![0; 16],
        ..layout()
    };
    assert_refused(&one.bytes(), &["found 1 sample per pixel", NEEDED]);
    let photograph = Layout {
        bits: 8,
        format: 1,
        photometric: 2,
        pixels: vec![0; 16],
        ..layout()
    };
    assert_refused(
        &photograph.bytes(),
        &["found 4 samples per pixel, 8-bit whole numbers", NEEDED],
    );
    let whole = Layout {
        format: 2,
        ..layout()
    };
    assert_refused(
        &whole.bytes(),
        &["32-bit whole numbers with a sign", NEEDED],
    );
    let double = Layout {
        bits: 64,
        pixels: vec![0; 128],
        ..layout()
    };
    assert_refused(&double.bytes(), &["64-bit floats", NEEDED]);
    let colours = Layout {
        photometric: 2,
        ..layout()
    };
    assert_refused(&colours.bytes(), &["stand for colours", NEEDED]);
}

#[test]
fn other_layouts_than_plain_strips() {
    let compressed = Layout {
        compression: 5,
        ..layout()
    };
    assert_refused(&compressed.bytes(), &["compression 5", "uncompressed"]);
    let planes = Layout {
        planar: 2,
        ..layout()
    };
    assert_refused(&planes.bytes(), &[NEEDED]);
}

#[test]
fn a_picture_of_no_size() {
    for sides in [[0, 2], [2, 0], [0, 0]] {
        let empty = Layout { sides, ..layout() };
        let found = format!("found a picture of {} × {} pixels", sides[0], sides[1]);
        assert_refused(&empty.bytes(), &[&found, "at least 1 × 1"]);
    }
}

#[test]
fn a_file_that_is_cut_off() {
    let whole = even([1.0, 0.0, 0.0, 0.0]);
    for left in [6, 9, 40, 160, whole.len() - 16, whole.len() - 1] {
        assert_refused(
            &whole[..left],
            &["is not whole", &format!("found {left} bytes")],
        );
    }
}

/// Sides that a file of this length cannot hold: told before memory is asked for.
#[test]
fn a_header_that_promises_more_than_there_is() {
    let vast = Layout {
        sides: [4_000_000_000, 4_000_000_000],
        ..layout()
    };
    assert_refused(
        &vast.bytes(),
        &["is not whole", "4000000000 × 4000000000 pixels"],
    );
}

#[test]
fn a_sample_that_is_no_number() {
    for (value, found) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf")] {
        let mut stokes = [[1.0, 0.0, 0.0, 0.0]; 6];
        stokes[5][1] = value;
        let file = Layout::of([3, 2], &stokes).bytes();
        let place = format!("found {found} for S1 in row 1, column 2");
        assert_refused(&file, &[&place, "finite"]);
    }
}

#[test]
fn options_that_are_no_numbers() {
    let file = even([1.0, 0.0, 0.0, 0.0]);
    for (option, value, range) in [
        ("--angle", "north", "from -360 to 360"),
        ("--angle", "nan", "from -360 to 360"),
        ("--angle", "inf", "from -360 to 360"),
        ("--angle", "400", "from -360 to 360"),
        ("--exposure", "bright", "from -30 to 30"),
        ("--exposure", "-31", "from -30 to 30"),
    ] {
        let (folder, output) = analysed(&file, &[option, value]);
        let told = refusal(&folder, &output);
        assert_told(&told, &[&format!("{option} {value}: "), range]);
    }
    let (folder, output) = analysed(&file, &["--colour", "red"]);
    assert_told(&refusal(&folder, &output), &["--colour"]);
    let output = folder.malus(&["analyse"]);
    assert_told(&refusal(&folder, &output), &["NAME.tiff"]);
}

#[test]
fn results_that_cannot_be_written_are_a_failure_of_the_run() {
    let (_, output) = analysed(&even([1.0, 0.0, 0.0, 0.0]), &["-o", "view.tiff"]);
    assert_eq!(output.status.code(), Some(1));
    assert_told(
        &stderr(&output),
        &["error: view.tiff: cannot make the directory"],
    );
}
