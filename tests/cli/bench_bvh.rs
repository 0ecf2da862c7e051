//! `bench-bvh`: what it prints of a scene and of a mesh, and what it refuses. Rates themselves are not judged.

use super::{Folder, ROOM, assert_told, stderr, stdout};

/// A box of 2 × 3 × 2.5 as an OBJ file.
const BOX: &str = "\
v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 2.5\nv 2 0 2.5\nv 2 3 2.5\nv 0 3 2.5\n\
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn measured(folder: &Folder, words: &[&str]) -> serde_json::Value {
    let words = [&["bench-bvh", "--seconds", "0", "--json"], words].concat();
    let output = folder.malus(&words);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

#[test]
fn every_tree_of_a_scene_and_of_a_mesh_is_measured_and_right() {
    let folder = Folder::new(ROOM.as_bytes(), &[("box.obj", BOX.as_bytes())]);
    for (file, sensors) in [("room.toml", 1), ("box.obj", 256)] {
        let report = measured(&folder, &[file, "--threads", "2"]);
        assert_eq!(report["triangles"], 12);
        assert_eq!(report["sensors"], sensors);
        let trees = report["trees"].as_array().unwrap();
        let layouts: Vec<_> = trees.iter().map(|tree| tree["layout"].clone()).collect();
        assert_eq!(layouts, ["wide", "bvh2", "cwbvh"]);
        for tree in trees {
            assert_eq!((&tree["differing"], &tree["leaks"]), (&0.into(), &0.into()));
            assert!(tree["checked"].as_u64().unwrap() > 1000);
            for key in ["build_seconds", "nodes", "bytes", "sah_cost", "depth"] {
                assert!(tree[key].as_f64().unwrap() > 0.0, "{key}");
            }
            // Five kinds of ray, on one thread and on two.
            let rates = tree["rates"].as_array().unwrap();
            assert_eq!(rates.len(), 10);
            for rate in rates {
                let [median, best] = ["median", "best"].map(|key| rate[key].as_f64().unwrap());
                assert!(0.0 < median && median <= best, "{rate}");
            }
        }
    }
}

#[test]
fn presets_are_measured_as_asked_for() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let words = ["room.toml", "--threads", "1", "--preset"];
    let presets = |preset: &str| -> Vec<String> {
        let report = measured(&folder, &[&words[..], &[preset]].concat());
        let trees = report["trees"].as_array().unwrap().clone();
        let wide = trees.iter().filter(|tree| tree["layout"] == "wide");
        wide.map(|tree| tree["preset"].as_str().unwrap().to_owned())
            .collect()
    };
    assert_eq!(presets("very-slow"), ["very-slow"]);
    assert_eq!(
        presets("all"),
        [
            "fastest",
            "very-fast",
            "fast",
            "medium",
            "slow",
            "very-slow"
        ]
    );
}

#[test]
fn the_table_names_everything_and_the_rays_can_be_had() {
    let folder = Folder::new(ROOM.as_bytes(), &[("box.obj", BOX.as_bytes())]);
    let output = folder.malus(&["bench-bvh", "box.obj", "--seconds", "0", "--rays", "rays"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_told(
        &stdout(&output),
        &[
            "box.obj: 12 triangles",
            "SAH cost",
            "depth",
            "primary",
            "in packets",
            "wide",
            "0 differ",
            "0 leak",
        ],
    );
    let bytes = |name: &str| {
        folder
            .path(&format!("rays/{name}"))
            .metadata()
            .unwrap()
            .len()
    };
    assert_eq!(bytes("triangles.u32"), 12 * 3 * 4);
    assert_eq!(bytes("vertices.f64"), 8 * 3 * 8);
    for name in ["cosine.f64", "pairs.f64"] {
        assert_eq!(bytes(name), 32_768 * 6 * 8);
    }
}

#[test]
fn what_cannot_be_measured_is_told() {
    let empty = "v 0 0 0\n";
    let files: [(&str, &[u8]); 2] = [("empty.obj", empty.as_bytes()), ("room.stl", b"solid")];
    let folder = Folder::new(ROOM.as_bytes(), &files);
    let cases: [(&[&str], &[&str]); 5] = [
        (&["absent.glb"], &["absent.glb", "No such file"]),
        (
            &["room.stl"],
            &["room.stl", ".toml", ".gltf, .glb, .obj", "found .stl"],
        ),
        (&["empty.obj"], &["empty.obj"]),
        (
            &["room.toml", "--seconds", "-1"],
            &["--seconds -1", "from 0 to 1e6"],
        ),
        (
            &["room.toml", "--threads", "0"],
            &["--threads 0", "1 to 1024"],
        ),
    ];
    for (words, parts) in cases {
        let output = folder.malus(&[&["bench-bvh"], words].concat());
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert_told(&stderr(&output), parts);
    }
}
