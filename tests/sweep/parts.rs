//! Studies in parts: shards that are merged, and studies that are set aside and taken up again, have the bytes of one piece.

use super::{folder, sweep};
use crate::cli::{Folder, assert_done, assert_told, stderr, stdout};
use std::collections::BTreeMap;
use std::path::Path;

/// Batches with the base and without it, of its geometry and of others, and a variant that fails.
const STUDY: &str = "[grid]\n\"shape.0.max\" = [[4, 3, 2.5], [4, 3, 2.6]]\n\"run.model\" = [\"polarised\", \"scalar\"]\n\
                     \"material.plaster.a\" = [0.1, 1.5, 0.6]\n";

/// One whose base has to be computed alone.
const MOVED: &str = "[grid]\n\"shape.0.max\" = [[4, 3, 2.4], [4, 3, 2.6], [4, 3, 2.7]]\n";

/// All files of results by their paths; without the states, and without what the machine decides in `study.json`.
fn results(folder: &Folder, name: &str) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    gather(&folder.path(name), "", &mut found);
    found
}

fn gather(directory: &Path, before: &str, found: &mut BTreeMap<String, Vec<u8>>) {
    for entry in std::fs::read_dir(directory).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{before}{name}");
        if entry.path().is_dir() {
            gather(&entry.path(), &format!("{path}/"), found);
        } else if !name.ends_with(".malus") && !name.ends_with(".journal") {
            let mut content = std::fs::read(entry.path()).unwrap();
            if name == "study.json" {
                let mut json: serde_json::Value = serde_json::from_slice(&content).unwrap();
                let fields = json.as_object_mut().unwrap();
                fields.remove("seconds").unwrap();
                fields.remove("threads").unwrap();
                content = json.to_string().into_bytes();
            }
            found.insert(path, content);
        }
    }
}

#[track_caller]
fn assert_same(folder: &Folder, one: &str, other: &str) {
    let [one, other] = [one, other].map(|name| results(folder, name));
    assert!(one.keys().eq(other.keys()), "{:?}", other.keys());
    for (name, content) in one {
        assert!(content == other[&name], "{name} differs");
    }
}

/// `malus sweep study.toml` with results in `name` and further words; gives its exit status.
fn status(folder: &Folder, name: &str, words: &[&str]) -> Option<i32> {
    let words = [&["sweep", "study.toml", "-o", name], words].concat();
    folder.malus(&words).status.code()
}

#[track_caller]
fn shards(folder: &Folder, name: &str, shards: &[&str], words: &[&str]) {
    for shard in shards {
        let words = [&["--shard", shard], words].concat();
        assert_eq!(status(folder, name, &words), Some(0), "{shard}");
    }
}

#[test]
fn merged_shards_of_a_study_have_the_bytes_of_one_piece() {
    for (study, expected) in [(STUDY, Some(1)), (MOVED, Some(0))] {
        let folder = folder(study, &[]);
        let words = ["--samples", "200", "--seed", "5", "--sensors"];
        assert_eq!(status(&folder, "whole", &words), expected);
        // Any order, any directory, any number of threads.
        let of = |threads| [&words[..], &["--threads", threads]].concat();
        shards(&folder, "a", &["3/4", "1/4"], &of("2"));
        shards(&folder, "b", &["4/4", "2/4"], &of("1"));
        assert!(
            results(&folder, "a").is_empty(),
            "a shard writes no results"
        );
        let output = folder.malus(&["merge", "b", "a", "-o", "merged"]);
        assert_eq!(output.status.code(), expected, "{}", stderr(&output));
        assert!(stdout(&output).contains("desk"), "{}", stdout(&output));
        assert_same(&folder, "whole", "merged");
        let names: Vec<String> = results(&folder, "merged").into_keys().collect();
        assert!(
            names.contains(&"variants/001/sensors.csv".into()),
            "{names:?}"
        );
    }
}

#[test]
fn the_most_shards_of_a_study_give_the_same_bytes() {
    let folder = folder(STUDY, &[]);
    status(&folder, "whole", &["--samples", "64"]);
    let all: Vec<String> = (1..=32).map(|index| format!("{index}/32")).collect();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    shards(&folder, "out", &all, &["--samples", "64"]);
    folder.malus(&["merge", "out"]);
    assert_same(&folder, "whole", "out");
}

#[test]
fn a_finished_shard_of_a_study_is_not_computed_again() {
    let folder = folder(MOVED, &[]);
    shards(&folder, "out", &["1/2"], &[]);
    let written = || {
        std::fs::metadata(folder.path("out/shard-01-of-02.malus"))
            .unwrap()
            .modified()
    };
    let before = written().unwrap();
    let output = sweep(&folder, &["--shard", "1/2", "--resume"]);
    assert_done(&output);
    assert_told(&stdout(&output), &["shard 1/2 is there already"]);
    assert_eq!(written().unwrap(), before);
}

#[test]
fn numbers_of_samples_that_make_the_same_rounds_are_of_one_study() {
    let folder = folder(MOVED, &[]);
    shards(&folder, "out", &["1/2"], &["--samples", "100"]);
    let output = sweep(&folder, &["--samples", "128", "--shard", "1/2", "--resume"]);
    assert_done(&output);
    assert_told(&stdout(&output), &["shard 1/2 is there already"]);
    shards(&folder, "out", &["2/2"], &["--samples", "128"]);
    assert_done(&folder.malus(&["merge", "out"]));
}

#[cfg(unix)]
#[test]
fn a_study_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = folder(MOVED, &[]);
    let words = [
        "sweep",
        "study.toml",
        "--relative-error",
        "0.0004",
        "--sensors",
        "-o",
    ];
    assert_done(&folder.malus(&[&words[..], &["whole"]].concat()));
    let words = [&words[..], &["out", "--resume", "--checkpoint", "0.01"]].concat();
    let times = crate::cli::killed(&folder, &words, "out/checkpoint.malus", 8);
    assert!(
        times > 3,
        "the study was over too soon to be killed: {times}"
    );
    assert_same(&folder, "whole", "out");
    let left = std::fs::read_dir(folder.path("out")).unwrap();
    let left: Vec<_> = left
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.contains("checkpoint") || name.starts_with('.'))
        .collect();
    assert!(left.is_empty(), "{left:?}");
}

#[cfg(unix)]
#[test]
fn a_shard_of_a_study_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = folder(MOVED, &[]);
    let samples = ["--samples", "60000"];
    shards(&folder, "out", &["2/2"], &samples);
    let words = [
        "sweep",
        "study.toml",
        "-o",
        "out",
        "--shard",
        "1/2",
        "--resume",
        "--checkpoint",
        "0.01",
    ];
    let words = [&words[..], &samples].concat();
    let times = crate::cli::killed(&folder, &words, "out/shard-01-of-02.malus", 8);
    assert!(
        times > 3,
        "the shard was over too soon to be killed: {times}"
    );
    assert_eq!(status(&folder, "whole", &samples), Some(0));
    assert_done(&folder.malus(&["merge", "out"]));
    assert_same(&folder, "whole", "out");
}

/// Ends a study at its second batch; what it has written stays where it is.
#[cfg(unix)]
fn interrupted(folder: &Folder) {
    let words = [
        "sweep",
        "study.toml",
        "-o",
        "out",
        "--samples",
        "400000",
        "--sensors",
        "--quiet",
    ];
    let mut child = folder
        .command(&words)
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    while !folder.path("out/variants/001/sensors.csv").exists() {
        assert!(child.try_wait().unwrap().is_none(), "the study is over");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let signalled = std::process::Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status();
    assert!(signalled.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[cfg(unix)]
#[test]
fn batches_that_are_finished_are_not_computed_again() {
    let folder = folder(MOVED, &[]);
    interrupted(&folder);
    assert_eq!(folder.json("out/study.json")["complete"], false);
    let written = || {
        std::fs::metadata(folder.path("out/variants/001/sensors.csv"))
            .unwrap()
            .modified()
    };
    let before = written().unwrap();
    let words = ["--samples", "400000", "--sensors", "--resume"];
    assert_eq!(status(&folder, "out", &words), Some(0));
    assert_eq!(written().unwrap(), before);
    assert_eq!(status(&folder, "whole", &words), Some(0));
    assert_same(&folder, "whole", "out");
}

/// What was set aside stays as it was.
#[cfg(unix)]
#[test]
fn a_study_goes_on_with_its_own_state_only() {
    let folder = folder(MOVED, &[]);
    interrupted(&folder);
    let files = ["out/checkpoint.malus", "out/checkpoint.journal"];
    let kept = files.map(|name| std::fs::read(folder.path(name)).unwrap());
    let refused = |words: &[&str], expected: &[&str], status: i32| {
        let words = [&["--samples", "400000", "--sensors", "--resume"], words].concat();
        let output = sweep(&folder, &words);
        assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
        assert_told(&stderr(&output), expected);
    };
    let state = "error: out/checkpoint.malus: ";
    refused(&["--seed", "2"], &[state, "differ in run.seed"], 2);
    refused(
        &["--set", "material.plaster.rho=0.4"],
        &[state, "differ in materials"],
        2,
    );
    let study = folder.text("study.toml");
    std::fs::write(folder.path("study.toml"), study.replace("2.7", "2.8")).unwrap();
    refused(&[], &[state, "is of another study"], 2);
    std::fs::write(folder.path("study.toml"), study).unwrap();
    let output = sweep(&folder, &["--samples", "64", "--sensors", "--resume"]);
    assert_told(
        &stderr(&output),
        &[state, "samples = 400000, and samples = 64 is asked for"],
    );
    let output = sweep(&folder, &["--samples", "400000", "--resume"]);
    assert_told(
        &stderr(&output),
        &[state, "with --sensors, this is one without"],
    );
    let run = [
        "run",
        "room.toml",
        "-o",
        "out",
        "--samples",
        "400000",
        "--resume",
    ];
    assert_told(
        &stderr(&folder.malus(&run)),
        &[state, "is of a study, this is a run"],
    );
    assert_eq!(
        files.map(|name| std::fs::read(folder.path(name)).unwrap()),
        kept
    );
    for (file, content) in files.iter().zip(&kept) {
        for place in [20, content.len() / 2, content.len() - 1] {
            let mut spoiled = content.clone();
            spoiled[place] ^= 1;
            std::fs::write(folder.path(file), &spoiled).unwrap();
            let output = sweep(&folder, &["--samples", "400000", "--sensors", "--resume"]);
            assert_eq!(output.status.code(), Some(2));
            assert_told(&stderr(&output), &[&format!("error: {file}: is damaged")]);
            assert_eq!(std::fs::read(folder.path(file)).unwrap(), spoiled);
        }
        std::fs::write(folder.path(file), content).unwrap();
    }
    assert_eq!(
        status(
            &folder,
            "out",
            &["--samples", "400000", "--sensors", "--resume"]
        ),
        Some(0)
    );
}

#[test]
fn shards_that_do_not_belong_together_are_refused_by_name() {
    let folder = folder(MOVED, &[]);
    shards(&folder, "out", &["1/2"], &[]);
    assert_told(
        &folder.unmerged(&["out"]),
        &["of 2 shards", "missing: 2", "malus sweep"],
    );
    shards(&folder, "twice", &["1/2", "2/2"], &[]);
    assert_told(
        &folder.unmerged(&["out", "twice"]),
        &[
            "twice/shard-01-of-02.malus: shard 1/2 is there twice",
            "out/shard-01-of-02.malus",
        ],
    );
    for (name, words, differs) in [
        ("seed", &["--seed", "2"][..], "differ in run.seed"),
        ("samples", &["--samples", "128"], "samples = 128"),
        ("sensors", &["--sensors"], "--sensors"),
        ("pictures", &["--no-pictures"], "--no-pictures"),
    ] {
        shards(&folder, name, &["2/2"], words);
        let file =
            format!("{name}/shard-02-of-02.malus: is of another run than out/shard-01-of-02.malus");
        assert_told(&folder.unmerged(&["out", name]), &[&file, differs]);
    }
    folder.run(
        "run",
        &["--shard", "2/2", "--set", "material.plaster.rho=0.5"],
    );
    assert_told(
        &folder.unmerged(&["out", "run"]),
        &["run/shard-02-of-02.malus: ", "is of a run"],
    );
    let study = folder.text("study.toml");
    std::fs::write(folder.path("study.toml"), study.replace("2.7", "2.8")).unwrap();
    shards(&folder, "study", &["2/2"], &[]);
    assert_told(
        &folder.unmerged(&["out", "study"]),
        &["study/shard-02-of-02.malus: ", "another study"],
    );
    shards(&folder, "out", &["2/2"], &[]);
    std::fs::remove_file(folder.path("out/shard-01-of-02.malus")).unwrap();
    shards(&folder, "out", &["1/2"], &[]);
    std::fs::write(folder.path("study.toml"), study).unwrap();
    assert_told(
        &folder.unmerged(&["out"]),
        &["study.toml: is not the study that"],
    );
}

#[test]
fn a_damaged_shard_of_a_study_is_refused_by_name() {
    let folder = folder(MOVED, &[]);
    shards(&folder, "out", &["1/2", "2/2"], &[]);
    for name in ["out/shard-02-of-02.malus", "out/shard-02-of-02.journal"] {
        let whole = std::fs::read(folder.path(name)).unwrap();
        let spoiled = [3, whole.len() / 2, whole.len() - 1].map(|place| {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            bytes
        });
        let cut = [0, whole.len() / 2, whole.len() - 1].map(|length| whole[..length].to_vec());
        for bytes in spoiled.into_iter().chain(cut) {
            std::fs::write(folder.path(name), bytes).unwrap();
            assert_told(
                &folder.unmerged(&["out"]),
                &[&format!("error: {name}: is ")],
            );
        }
        std::fs::remove_file(folder.path(name)).unwrap();
        let told = folder.unmerged(&["out"]);
        assert!(
            told.contains("missing: 2") || told.contains(&format!("{name}: cannot be read")),
            "{told}"
        );
        std::fs::write(folder.path(name), whole).unwrap();
    }
    assert_done(&folder.malus(&["merge", "out"]));
}

#[test]
fn shards_of_a_study_need_samples() {
    let folder = folder(MOVED, &[]);
    for (words, told) in [
        (
            &["--relative-error", "0.1"][..],
            "found relative_error = 0.1",
        ),
        (&["--samples", "64", "--seconds", "5"], "found seconds = 5"),
    ] {
        let output = sweep(&folder, &[&["--shard", "1/2"], words].concat());
        assert_eq!(output.status.code(), Some(2));
        assert_told(
            &stderr(&output),
            &["--shard 1/2: ", told, "give --samples N"],
        );
        assert!(!folder.path("out").exists());
    }
}
