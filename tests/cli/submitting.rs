//! Handing a run to a cluster, with commands in the place of Slurm's that do the tasks at once, or not at all.
//! `tests/cluster/two-nodes` does it with Slurm itself.

use super::shards::{assert_done, assert_same, shards};
use super::{Folder, ROOM, assert_told, stderr, stdout};
use std::os::unix::fs::PermissionsExt;
use std::process::Output;

/// Takes `--parsable --array LIST SCRIPT`, and does each task but the third on its first day.
const SBATCH: &str = r#"#!/bin/sh
echo "$3" >> arrays
for task in $(echo "$3" | tr , ' '); do
    [ "$task" = 3 ] && [ ! -f third ] && touch third && continue
    SLURM_ARRAY_TASK_ID=$task sh "$4" || exit
done
echo "$(wc -l < arrays)7;cluster"
"#;

/// Does nothing but take them.
const IDLE_SBATCH: &str = "#!/bin/sh\necho \"$3\" >> arrays\necho 7\n";

const SQUEUE: &str = "#!/bin/sh\ntest \"$1\" = --me && cat queue\n";

/// A folder with commands of its own and what its queue shows.
fn cluster(sbatch: &str, queue: &str) -> Folder {
    let commands: [(&str, &[u8]); 2] =
        [("sbatch", sbatch.as_bytes()), ("squeue", SQUEUE.as_bytes())];
    let folder = Folder::new(ROOM.as_bytes(), &[("queue", queue.as_bytes())]);
    for (name, text) in commands {
        std::fs::write(folder.path(name), text).unwrap();
        let mode = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(folder.path(name), mode).unwrap();
    }
    folder
}

/// `malus run room.toml -o out --submit slurm` and more words.
fn submitted(folder: &Folder, words: &[&str]) -> Output {
    handed_in(folder, &["run", "room.toml"], words)
}

fn handed_in(folder: &Folder, what: &[&str], words: &[&str]) -> Output {
    let path = std::env::var("PATH").unwrap();
    let mut command = folder.command(&[what, &["-o", "out", "--submit", "slurm"]].concat());
    command
        .args(words)
        .env("PATH", format!("{}:{path}", folder.path("").display()));
    command.output().unwrap()
}

#[test]
fn what_failed_is_submitted_again_and_all_is_merged() {
    let folder = cluster(SBATCH, "");
    folder.run("whole", &["--set", "material.plaster.rho=0.4"]);
    let words = [
        "--shards",
        "4",
        "--wait",
        "--set",
        "material.plaster.rho=0.4",
    ];
    let output = submitted(
        &folder,
        &[&words[..], &["--sbatch", "--time=5 --mem=1G"]].concat(),
    );
    assert_done(&output);
    assert_eq!(folder.text("arrays"), "1,2,3,4\n3\n");
    assert_told(
        &stdout(&output),
        &["4 of 4 shards submitted; jobs so far: 17\n", "desk"],
    );
    assert_told(&stderr(&output), &["submitted again: shards 3"]);
    let script = folder.text("out/shards.sbatch");
    assert_told(
        &script,
        &[
            "#SBATCH --requeue",
            "#SBATCH --time=5 --mem=1G\n",
            "ID/4\" --resume",
        ],
    );
    assert_eq!(folder.text("out/slurm-jobs.txt"), "17\n27\n");
    for name in ["shards.sbatch", "slurm-jobs.txt"] {
        std::fs::remove_file(folder.path(&format!("out/{name}"))).unwrap();
    }
    assert_same(&folder, "whole", "out");
}

#[test]
fn a_study_is_handed_in_and_merged_like_a_run() {
    let folder = cluster(SBATCH, "");
    let study = "scene = \"room.toml\"\n[grid]\n\"material.plaster.rho\" = [0.4, 0.6]\n";
    std::fs::write(folder.path("study.toml"), study).unwrap();
    let sweep = ["sweep", "study.toml"];
    assert_done(&folder.malus(&[&sweep[..], &["-o", "whole", "--sensors"]].concat()));
    let words = ["--shards", "4", "--wait", "--sensors"];
    let output = handed_in(&folder, &sweep, &words);
    assert_done(&output);
    assert_eq!(folder.text("arrays"), "1,2,3,4\n3\n");
    assert_told(&stdout(&output), &["4 of 4 shards submitted", "desk"]);
    assert_told(&stderr(&output), &["submitted again: shards 3"]);
    for name in ["variants.csv", "variants/002/sensors.csv", "desk-trade.svg"] {
        let [whole, merged] = ["whole", "out"].map(|it| folder.text(&format!("{it}/{name}")));
        assert_eq!(whole, merged, "{name}");
    }
    let output = handed_in(&folder, &sweep, &["--shards", "4", "--sensors"]);
    assert_told(&stdout(&output), &["nothing is left to submit"]);
    // Shards of a run or of another study do not lie among those of this one.
    for (what, told) in [
        (["run", "room.toml"], "is of a study"),
        (sweep, "--sensors"),
    ] {
        let output = handed_in(&folder, &what, &["--shards", "4"]);
        assert_eq!(output.status.code(), Some(2));
        assert_told(&stderr(&output), &["shard-01-of-04.malus: ", told]);
    }
}

#[test]
fn what_is_finished_or_in_the_queue_is_not_submitted() {
    // Shard 2 of our job waits; that of another job is nothing to us.
    let folder = cluster(IDLE_SBATCH, "7 2\n8 4\n");
    shards(&folder, "out", &["3/4"], &[]);
    assert_done(&submitted(&folder, &["--shards", "4"]));
    let output = submitted(&folder, &["--shards", "4"]);
    assert_done(&output);
    assert_eq!(folder.text("arrays"), "1,2,4\n1,4\n");
    assert_told(
        &stdout(&output),
        &["2 of 4 shards", "when they are finished: malus merge "],
    );
    shards(&folder, "out", &["1/4", "2/4", "4/4"], &[]);
    let output = submitted(&folder, &["--shards", "4"]);
    assert_told(&stdout(&output), &["nothing is left to submit"]);
    assert_eq!(folder.text("arrays").lines().count(), 2);
}

#[test]
fn a_shard_that_comes_no_further_ends_the_waiting_with_its_log() {
    let folder = cluster(IDLE_SBATCH, "");
    std::fs::create_dir(folder.path("out")).unwrap();
    std::fs::write(folder.path("out/shard-1.log"), "one\nno memory is left\n").unwrap();
    let output = submitted(&folder, &["--shards", "2", "--wait"]);
    assert_eq!(output.status.code(), Some(1));
    assert_told(
        &stderr(&output),
        &[
            "error: shard 1 was submitted 3 times",
            "shard-1.log ends with: no memory is left",
        ],
    );
    assert_eq!(folder.text("arrays"), "1,2\n1,2\n1,2\n");
}

#[test]
fn what_cannot_be_submitted_is_told() {
    let folder = cluster("#!/bin/sh\necho invalid partition >&2\nexit 1\n", "");
    let told = |words: &[&str], status: i32| {
        let output = submitted(&folder, words);
        assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
        stderr(&output)
    };
    assert_told(
        &told(&["--shards", "2"], 1),
        &["error: sbatch failed", "invalid partition"],
    );
    assert_told(
        &told(&["--shards", "0"], 2),
        &["--shards 0: must be a whole number from 1 to 32"],
    );
    assert_told(&told(&[], 2), &["--shards"]);
    let words = ["--shards", "2", "--relative-error", "0.1"];
    assert_told(&told(&words, 2), &["--submit: ", "relative_error = 0.1"]);
    shards(&folder, "out", &["1/3"], &[]);
    let words = ["--shards", "2"];
    assert_told(
        &told(&words, 2),
        &["shard-01-of-03.malus: is one of 3 shards, not of 2"],
    );
    let nowhere = folder
        .command(&[
            "run",
            "room.toml",
            "-o",
            "other",
            "--submit",
            "slurm",
            "--shards",
            "2",
        ])
        .env("PATH", folder.path("out"))
        .output()
        .unwrap();
    assert_eq!(nowhere.status.code(), Some(1));
    assert_told(
        &stderr(&nowhere),
        &["sbatch: there is no such command here"],
    );
}
