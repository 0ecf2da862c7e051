//! Runs in parts: shards that are merged, and runs that are set aside and taken up again, have the bytes of one piece.

mod refusals;

use super::{Folder, ROOM, room_with, stderr, stdout};
use std::process::Output;

/// A room with all that a run may sum: mirrors, both other models, several sensors, cameras.
const FURNISHED: &str = r#"[scene]
name = "furnished"

[[shape]]
kind = "box"
min = [0, 0, 0]
max = [4, 3, 2.5]
inward = true
material = "plaster"

[[shape]]
kind = "rectangle"
origin = [1, 1, 2.4]
u = [0, 1, 0]
v = [1, 0, 0]
material = "lamp"

[[source]]
kind = "spot"
position = [2, 1.5, 2]
direction = [0, 0, -1]
intensity = 10
cone_deg = 90

[material.plaster]
rho = 0.5
a = 0.4
n = 1.6
k = 0.1

[material.lamp]
rho = 0.1
exitance = 20

[[sensor]]
name = "desk"
grid = { origin = [0.5, 0.5, 0.75], u = [2, 0, 0], v = [0, 2, 0], counts = [4, 3] }

[[sensor]]
name = "wall"
points = [[0, 1.5, 1.2], [0, 2.5, 1.2]]
normal = [1, 0, 0]

[[camera]]
name = "eye"
position = [0.2, 0.2, 1.2]
look_at = [3, 2, 1]
width = 90
height = 70
samples = 64

[run]
compare = ["scalar", "diffuse"]
relative_error = 0.5
"#;

/// All files of results but the summary and the states: these have to be the same to the byte.
fn files(folder: &Folder, name: &str) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder.path(name)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut files: Vec<(String, Vec<u8>)> = paths
        .filter(|path| {
            let state = path.extension().is_some_and(|it| it == "malus");
            !state && !path.ends_with("summary.json")
        })
        .map(|path| {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, std::fs::read(path).unwrap())
        })
        .collect();
    files.sort();
    files
}

/// The summary without what the machine decides.
fn summary(folder: &Folder, name: &str) -> serde_json::Value {
    let mut summary = folder.json(&format!("{name}/summary.json"));
    let fields = summary.as_object_mut().unwrap();
    fields.remove("seconds").unwrap();
    fields.remove("threads").unwrap();
    summary
}

#[track_caller]
pub fn assert_same(folder: &Folder, one: &str, other: &str) {
    let [one_files, other_files] = [one, other].map(|name| files(folder, name));
    let names = |files: &[(String, Vec<u8>)]| -> Vec<String> {
        files.iter().map(|file| file.0.clone()).collect()
    };
    assert_eq!(names(&one_files), names(&other_files));
    for (one, other) in one_files.iter().zip(&other_files) {
        assert!(one == other, "{} differs", one.0);
    }
    assert_eq!(summary(folder, one), summary(folder, other));
}

#[track_caller]
pub fn assert_done(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
}

/// Computes shards of `room.toml` into one directory.
#[track_caller]
pub fn shards(folder: &Folder, name: &str, shards: &[&str], words: &[&str]) {
    for shard in shards {
        folder.run(name, &[&["--shard", shard], words].concat());
    }
}

#[test]
fn merged_shards_have_the_bytes_of_a_run_in_one_piece() {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    let words = [
        "--samples",
        "200",
        "--seed",
        "5",
        "--set",
        "material.plaster.a=0.3",
    ];
    folder.run("whole", &words);
    assert_eq!(
        files(&folder, "whole")
            .iter()
            .map(|file| file.0.as_str())
            .collect::<Vec<_>>(),
        [
            "desk.svg",
            "eye.png",
            "eye.tiff",
            "grids.csv",
            "sensors.csv"
        ]
    );
    // Any order, any directory, any number of threads.
    shards(
        &folder,
        "a",
        &["3/3", "1/3"],
        &[&words[..], &["--threads", "2"]].concat(),
    );
    shards(
        &folder,
        "b",
        &["2/3"],
        &[&words[..], &["--threads", "1"]].concat(),
    );
    assert!(files(&folder, "a").is_empty(), "a shard writes no results");
    let output = folder.malus(&["merge", "b", "a", "-o", "merged"]);
    assert_done(&output);
    assert!(stdout(&output).contains("desk") && stdout(&output).contains("merged"));
    assert_same(&folder, "whole", "merged");
    // Without a directory the results go beside the first shards; from anywhere.
    assert_done(&folder.malus(&["merge", "a", "b", "--quiet"]));
    assert_same(&folder, "whole", "a");
}

#[test]
fn the_most_shards_and_the_fewest_give_the_same_bytes() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    folder.run("whole", &["--samples", "300"]);
    let all: Vec<String> = (1..=32).map(|index| format!("{index}/32")).collect();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    shards(&folder, "many", &all, &["--samples", "300"]);
    shards(&folder, "one", &["1/1"], &["--samples", "300"]);
    for name in ["many", "one"] {
        assert_done(&folder.malus(&["merge", name]));
        assert_same(&folder, "whole", name);
    }
}

#[test]
fn a_finished_shard_is_not_computed_again() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    shards(&folder, "out", &["1/2"], &[]);
    let file = folder.path("out/shard-01-of-02.malus");
    let written = std::fs::metadata(&file).unwrap().modified().unwrap();
    let output = folder.run("out", &["--shard", "1/2", "--resume"]);
    assert!(
        stdout(&output).contains("is there already"),
        "{}",
        stdout(&output)
    );
    assert_eq!(
        std::fs::metadata(&file).unwrap().modified().unwrap(),
        written
    );
}

#[test]
fn a_finished_shard_is_taken_further_where_more_samples_are_asked_for() {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    shards(&folder, "out", &["1/2", "2/2"], &["--samples", "128"]);
    shards(
        &folder,
        "out",
        &["1/2", "2/2"],
        &["--samples", "320", "--resume"],
    );
    assert_done(&folder.malus(&["merge", "out"]));
    folder.run("whole", &["--samples", "320"]);
    assert_same(&folder, "whole", "out");
}

/// The merge reads the scene again: moved, it has to be given; changed, it is refused.
#[test]
fn a_scene_that_has_moved_is_given_anew() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    folder.run("whole", &[]);
    shards(&folder, "out", &["1/2", "2/2"], &[]);
    std::fs::rename(folder.path("room.toml"), folder.path("moved.toml")).unwrap();
    let output = folder.malus(&["merge", "out"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("no longer there; give it with --scene"),
        "{}",
        stderr(&output)
    );
    // The name of a scene that gives none is that of its file.
    std::fs::create_dir(folder.path("elsewhere")).unwrap();
    std::fs::rename(
        folder.path("moved.toml"),
        folder.path("elsewhere/room.toml"),
    )
    .unwrap();
    assert_done(&folder.malus(&["merge", "out", "--scene", "elsewhere/room.toml"]));
    assert_same(&folder, "whole", "out");
}

/// Starts a run so often, and kills it each time at some moment after it has set itself aside anew; then lets it end by
/// itself. Gives how often it was killed: less where it was over before.
#[cfg(unix)]
#[track_caller]
pub fn killed(folder: &Folder, words: &[&str], state: &str, times: u32) -> u32 {
    let written = || {
        std::fs::metadata(folder.path(state))
            .and_then(|it| it.modified())
            .ok()
    };
    let start = || {
        let mut command = folder.command(words);
        let silent = std::process::Stdio::null;
        command.stdout(silent()).stderr(silent()).spawn().unwrap()
    };
    for kill in 0..times {
        let before = written();
        let mut child = start();
        while written().is_none_or(|now| Some(now) == before) {
            if let Some(status) = child.try_wait().unwrap() {
                assert_eq!(status.code(), Some(0));
                return kill;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        // Between two checkpoints, or in the middle of one.
        std::thread::sleep(std::time::Duration::from_millis(u64::from(7 * kill % 40)));
        // SIGKILL.
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert_eq!(start().wait().unwrap().code(), Some(0));
    times
}

#[cfg(unix)]
#[test]
fn a_run_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    // A stop that is decided by what is summed.
    let words = ["run", "room.toml", "--relative-error", "0.02", "-o"];
    assert_done(&folder.malus(&[&words[..], &["whole"]].concat()));
    let words = [&words[..], &["out", "--resume", "--checkpoint", "0.02"]].concat();
    let times = killed(&folder, &words, "out/checkpoint.malus", 6);
    assert!(times > 2, "the run was over too soon to be killed");
    assert_same(&folder, "whole", "out");
    let left: Vec<_> = std::fs::read_dir(folder.path("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".malus") || name.starts_with('.'))
        .collect();
    assert!(left.is_empty(), "{left:?}");
}

#[cfg(unix)]
#[test]
fn a_shard_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    let words = ["--samples", "8192"];
    shards(&folder, "out", &["2/2"], &words);
    let killing = [
        "run",
        "room.toml",
        "-o",
        "out",
        "--shard",
        "1/2",
        "--resume",
        "--checkpoint",
        "0.02",
    ];
    let words_of_shard = [&killing[..], &words].concat();
    let times = killed(&folder, &words_of_shard, "out/shard-01-of-02.malus", 6);
    assert!(times > 2, "the shard was over too soon to be killed");
    assert_done(&folder.malus(&["merge", "out"]));
    folder.run("whole", &words);
    assert_same(&folder, "whole", "out");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_goes_on_to_the_same_bytes() {
    let folder = Folder::new(FURNISHED.as_bytes(), &[]);
    let words = ["run", "room.toml", "--samples", "8192", "-o"];
    let child = folder
        .command(&[&words[..], &["out"]].concat())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // The directory is made right before the first walk.
    while !folder.path("out").exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    std::thread::sleep(std::time::Duration::from_millis(200));
    let signalled = std::process::Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status();
    assert!(signalled.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("--resume goes on"),
        "{}",
        stderr(&output)
    );
    assert_eq!(folder.json("out/summary.json")["complete"], false);
    // Where the user forgets to resume, what was set aside is not passed over in silence.
    std::fs::create_dir(folder.path("again")).unwrap();
    std::fs::copy(
        folder.path("out/checkpoint.malus"),
        folder.path("again/checkpoint.malus"),
    )
    .unwrap();
    let again = folder.run("again", &["--samples", "64"]);
    assert!(
        stderr(&again).contains("--resume would go on with it"),
        "{}",
        stderr(&again)
    );
    folder.run("whole", &["--samples", "8192"]);
    folder.run("out", &["--samples", "8192", "--resume"]);
    assert_same(&folder, "whole", "out");
}

#[test]
fn resuming_where_nothing_was_set_aside_begins_anew() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    folder.run("whole", &[]);
    folder.run("out", &["--resume"]);
    assert_same(&folder, "whole", "out");
    // A room of another name is another scene, and this one is the very same.
    let plain = Folder::new(room_with("rho = 0.5", "rho = 0.50").as_bytes(), &[]);
    plain.run("out", &[]);
    assert_eq!(
        plain.text("out/sensors.csv"),
        folder.text("out/sensors.csv")
    );
}
