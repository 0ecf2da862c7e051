//! Shards that are not those of one run, and states that a run cannot go on from, are refused by name.

use super::super::assert_told;
use super::*;

/// A folder with both shards of the plain room in `out`.
fn halves() -> Folder {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    shards(&folder, "out", &["1/2", "2/2"], &[]);
    folder
}

#[test]
fn missing_shards_are_told_by_their_numbers() {
    let folder = Folder::new(ROOM.as_bytes(), &[("empty/", b"")]);
    shards(&folder, "out", &["1/4", "3/4"], &[]);
    assert_told(
        &folder.unmerged(&["out"]),
        &["of 4 shards", "missing: 2, 4", "--shard I/4"],
    );
    assert_told(&folder.unmerged(&["empty"]), &["empty: holds no shards"]);
    assert_told(&folder.unmerged(&["absent"]), &["absent: cannot be read"]);
}

#[test]
fn a_shard_that_is_there_twice_is_told_with_both_files() {
    let folder = halves();
    shards(&folder, "other", &["2/2"], &[]);
    let told = folder.unmerged(&["out", "other"]);
    assert_told(
        &told,
        &[
            "other/shard-02-of-02.malus: shard 2/2 is there twice",
            "out/shard-02-of-02.malus",
        ],
    );
}

#[test]
fn a_shard_of_another_run_is_told_with_what_differs() {
    let folder = halves();
    for (name, shard, words, differs) in [
        ("seed", "2/2", &["--seed", "2"][..], "differ in run.seed"),
        (
            "material",
            "2/2",
            &["--set", "material.plaster.rho=0.4"],
            "differ in materials",
        ),
        (
            "samples",
            "2/2",
            &["--samples", "128"],
            "128 samples, not 64",
        ),
        ("count", "2/3", &[], "one of 3 shards, not of 2"),
        ("pictures", "2/2", &["--no-pictures"], "--no-pictures"),
    ] {
        shards(&folder, name, &[shard], words);
        let file = format!("shard-{}.malus", shard.replace('/', "-of-0"));
        let told = folder.unmerged(&["out", name]);
        let file = format!("{name}/{}", file.replace("shard-2", "shard-02"));
        assert_told(
            &told,
            &[
                &file,
                "of another run than out/shard-01-of-02.malus",
                differs,
            ],
        );
    }
}

#[test]
fn a_scene_that_has_changed_since_is_refused() {
    let folder = halves();
    std::fs::write(
        folder.path("room.toml"),
        room_with("rho = 0.5", "rho = 0.6"),
    )
    .unwrap();
    assert_told(
        &folder.unmerged(&["out"]),
        &["room.toml: is not the scene that the shards were computed of: they differ in materials"],
    );
}

/// Wherever a byte is changed, and wherever the file is cut off.
#[test]
fn a_damaged_shard_is_told_by_its_name() {
    let folder = halves();
    let path = folder.path("out/shard-02-of-02.malus");
    let whole = std::fs::read(&path).unwrap();
    let mut spoiled: Vec<Vec<u8>> = [0, 14, 15, 50, whole.len() / 2, whole.len() - 1]
        .map(|place| {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            bytes
        })
        .to_vec();
    spoiled.extend([0, 13, 14, 15, 30, 32, whole.len() - 1].map(|length| whole[..length].to_vec()));
    spoiled.push([&whole[..], b"\0"].concat());
    for bytes in spoiled {
        std::fs::write(&path, bytes).unwrap();
        let told = folder.unmerged(&["out"]);
        assert!(
            told.starts_with("error: out/shard-02-of-02.malus: is "),
            "{told}"
        );
        assert!(
            told.contains("is damaged") || told.contains("no state"),
            "{told}"
        );
    }
    std::fs::write(&path, b"malus state 9\n...").unwrap();
    assert_told(
        &folder.unmerged(&["out"]),
        &["is of form 9, this version of malus reads form 12"],
    );
}

#[cfg(unix)]
#[test]
fn a_shard_that_is_not_finished_is_told_by_its_name() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let words = [
        "run",
        "room.toml",
        "-o",
        "out",
        "--samples",
        "1000000000",
        "--shard",
        "1/1",
    ];
    let mut child = folder
        .command(&[&words[..], &["--checkpoint", "0.01"]].concat())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    while !folder.path("out/shard-01-of-01.malus").exists() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_told(
        &folder.unmerged(&["out"]),
        &[
            "out/shard-01-of-01.malus: is not finished",
            "of 1000000000 samples",
            "--resume",
        ],
    );
    // Fewer samples than it has taken cannot be made of it.
    let told = folder.refused(&[
        "run",
        "room.toml",
        "-o",
        "out",
        "--samples",
        "64",
        "--shard",
        "1/1",
        "--resume",
    ]);
    assert_told(
        &told,
        &["out/shard-01-of-01.malus: holds ", "and 64 are asked for"],
    );
}

#[test]
fn a_shard_needs_samples_and_no_other_rule() {
    let folder = Folder::new(
        room_with("samples = 64", "relative_error = 0.1").as_bytes(),
        &[],
    );
    let told = |words: &[&str]| {
        let told = folder.refused(&[&["run", "room.toml", "-o", "merged"], words].concat());
        assert_told(&told, &[&words[..2].join(" ")]);
        told
    };
    assert_told(
        &told(&["--shard", "1/2"]),
        &["found relative_error = 0.1", "give --samples N"],
    );
    assert_told(
        &told(&["--shard", "1/2", "--samples", "64", "--seconds", "5"]),
        &["found seconds = 5"],
    );
    for shard in ["0/2", "3/2", "1/33", "1", "-1/2"] {
        assert_told(
            &told(&["--shard", shard, "--samples", "64"]),
            &["1 ≤ I ≤ N ≤ 32"],
        );
    }
    assert_told(
        &told(&["--checkpoint", "soon"]),
        &["must be a number of seconds"],
    );
    shards(&folder, "out", &["1/2"], &["--samples", "64"]);
}

#[test]
fn a_run_goes_on_with_its_own_state_only() {
    let folder = halves();
    // A shard serves as a checkpoint: it is the same kind of file.
    let state = folder.path("out/checkpoint.malus");
    std::fs::copy(folder.path("out/shard-01-of-02.malus"), &state).unwrap();
    for (words, part) in [
        (&["--seed", "2"][..], "differ in run.seed"),
        (
            &["--set", "material.plaster.rho=0.4"],
            "differ in materials",
        ),
        (
            &["--set", "sensor.desk.normal=[0,0,-1]"],
            "differ in sensors",
        ),
        (&["--set", "shape.0.max=[4,3,2.6]"], "differ in geometry"),
    ] {
        let words = [&["run", "room.toml", "-o", "out", "--resume"], words].concat();
        let told = folder.refused(&words);
        assert_told(
            &told,
            &[
                "out/checkpoint.malus: is of another scene",
                part,
                "leave it out",
            ],
        );
    }
    let told = folder.refused(&["run", "room.toml", "-o", "out", "--resume"]);
    assert_told(&told, &["out/checkpoint.malus: is shard 1/2"]);
    std::fs::write(&state, b"malus state 12\nabc").unwrap();
    let told = folder.refused(&["run", "room.toml", "-o", "out", "--resume"]);
    assert_told(&told, &["out/checkpoint.malus: is damaged"]);
    assert_eq!(std::fs::read(&state).unwrap(), b"malus state 12\nabc");
}

/// A directory stands where the file should go, as for a disk that is full or may not be written to.
#[test]
fn a_checkpoint_that_cannot_be_written_ends_the_run_with_its_reason() {
    let folder = Folder::new(
        ROOM.as_bytes(),
        &[("out/", b""), ("out/checkpoint.malus/", b"")],
    );
    let output = folder.malus(&[
        "run",
        "room.toml",
        "-o",
        "out",
        "--relative-error",
        "1e-9",
        "--checkpoint",
        "0.01",
    ]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert_told(
        &told,
        &[
            "error: a checkpoint failed",
            "out/checkpoint.malus: cannot be written",
            "--resume",
        ],
    );
    let left = std::fs::read_dir(folder.path("out")).unwrap().count();
    assert_eq!(left, 1, "half a file is left");
}
