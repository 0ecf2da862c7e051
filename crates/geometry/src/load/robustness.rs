//! Damaged files: whatever the bytes, an import returns.

use super::{Placement, load};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

const FOLDER: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../scenes/meshes/blender_office"
);

fn original(name: &str) -> Vec<u8> {
    fs::read(Path::new(FOLDER).join(name)).unwrap()
}

/// Whether these bytes, as a file of that name beside the office's other files, are imported.
fn imports(name: &str, bytes: &[u8]) -> bool {
    let folder = tempfile::tempdir().unwrap();
    for companion in ["office.bin", "office.mtl"] {
        fs::write(folder.path().join(companion), original(companion)).unwrap();
    }
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    load(&path, &Placement::default()).is_ok()
}

#[test]
fn a_glb_cut_short_at_any_length_is_an_error() {
    let whole = original("office.glb");
    assert!(imports("cut.glb", &whole));
    let lengths = (0..64)
        .chain((64..whole.len()).step_by(997))
        .chain([whole.len() - 1]);
    for length in lengths {
        assert!(!imports("cut.glb", &whole[..length]), "{length} bytes");
    }
}

#[test]
fn a_gltf_or_a_companion_cut_short_is_an_error() {
    let whole = original("office.gltf");
    for length in (0..whole.len() - 1).step_by(499) {
        assert!(!imports("cut.gltf", &whole[..length]), "{length} bytes");
    }
    let data = original("office.bin");
    for length in [0, 1, data.len() / 2, data.len() - 1] {
        assert!(!imports("office.bin", &data[..length]));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("office.gltf");
        fs::write(&path, &whole).unwrap();
        fs::write(folder.path().join("office.bin"), &data[..length]).unwrap();
        let message = load(&path, &Placement::default()).unwrap_err().to_string();
        assert!(
            message.contains("buffers[0]") && message.contains(&data.len().to_string()),
            "{message}"
        );
    }
}

#[test]
fn an_obj_cut_short_anywhere_returns() {
    let whole = original("office.obj");
    let complete = (0..whole.len())
        .step_by(991)
        .filter(|&n| imports("cut.obj", &whole[..n]))
        .count();
    assert!(
        complete > 10,
        "only {complete} were still readable: the cuts test little"
    );
}

/// A file of the office with up to 16 bytes changed, some of them in the JSON or the text.
fn spoiled(name: &'static str, within: usize) -> impl Strategy<Value = Vec<u8>> {
    let whole = original(name);
    let within = within.min(whole.len());
    let digits = prop_oneof![any::<u8>(), b'0'..=b'9', Just(b'-'), Just(b'e'), Just(b' ')];
    proptest::collection::vec((0..within, digits), 1..16).prop_map(move |changes| {
        let mut bytes = whole.clone();
        for (place, byte) in changes {
            bytes[place] = byte;
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_glb_with_changed_bytes_returns(bytes in spoiled("office.glb", usize::MAX)) {
        imports("spoiled.glb", &bytes);
    }

    #[test]
    fn a_glb_with_changed_json_returns(bytes in spoiled("office.glb", 30_000)) {
        imports("spoiled.glb", &bytes);
    }

    #[test]
    fn a_gltf_with_a_changed_digit_returns(
        place in 0..30_000usize,
        digit in prop_oneof![b'0'..=b'9', Just(b'-')],
    ) {
        // One digit of the JSON changed keeps the syntax: this reaches the indices, counts and offsets.
        let mut bytes = original("office.gltf");
        let digits = bytes.iter().enumerate().skip(place).find(|b| b.1.is_ascii_digit());
        let place = digits.map_or(place, |d| d.0);
        bytes[place] = digit;
        imports("spoiled.gltf", &bytes);
    }

    #[test]
    fn an_obj_with_changed_bytes_returns(bytes in spoiled("office.obj", usize::MAX)) {
        imports("spoiled.obj", &bytes);
    }

    #[test]
    fn any_bytes_return(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        for name in ["a.glb", "a.gltf", "a.obj"] {
            imports(name, &bytes);
        }
        imports("b.glb", &[b"glTF\x02\0\0\0", &bytes[..]].concat());
    }
}
