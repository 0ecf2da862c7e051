//! How a run ends: done, failed, by the clock, by the user.

use super::{Folder, ROOM, room_with, stderr, stdout};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A run that would go on for ever.
const ENDLESS: [&str; 6] = ["run", "room.toml", "-o", "out", "--relative-error", "1e-9"];

/// A run with results in `out`.
fn started(folder: &Folder, words: &[&str]) -> Child {
    let mut command = folder.command(words);
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Ends a run by a signal once it has begun to compute.
fn interrupted(folder: &Folder, words: &[&str], signal: &str) -> Output {
    let child = started(folder, words);
    let started = Instant::now();
    // The folder is made right before the first round.
    while !folder.path("out").exists() {
        assert!(
            started.elapsed() < Duration::from_secs(20),
            "nothing begins"
        );
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(600));
    let told = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status()
        .unwrap();
    assert!(told.success());
    let told = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(
        told.elapsed() < Duration::from_secs(5),
        "{:?} to stop",
        told.elapsed()
    );
    output
}

/// The number after `--samples` in what is printed of a run that is to be repeated.
fn repeating(output: &Output) -> String {
    let text = stdout(output);
    let line = text
        .lines()
        .find(|line| line.contains("--samples"))
        .unwrap_or_else(|| panic!("{text}"));
    let mut words = line
        .split_whitespace()
        .skip_while(|word| *word != "--samples");
    words.nth(1).unwrap().to_owned()
}

#[test]
fn an_interrupted_run_writes_what_it_has_and_marks_it() {
    for signal in ["-INT", "-TERM"] {
        let folder = Folder::new(ROOM.as_bytes(), &[]);
        let output = interrupted(&folder, &ENDLESS, signal);
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("incomplete"),
            "{}",
            stderr(&output)
        );
        let summary = folder.json("out/summary.json");
        assert_eq!(summary["complete"], false);
        let samples = summary["samples"].as_u64().unwrap();
        assert!(samples > 0);
        // What is there is as good as if it had been asked for.
        assert_eq!(repeating(&output), samples.to_string());
        folder.run("again", &["--samples", &samples.to_string()]);
        assert_eq!(folder.json("again/summary.json")["complete"], true);
        assert_eq!(
            folder.text("again/sensors.csv"),
            folder.text("out/sensors.csv")
        );
    }
}

#[test]
fn a_run_interrupted_while_it_takes_a_picture_is_marked() {
    let camera = r#"
[[camera]]
name = "endless"
position = [1, 1, 1]
look_at = [3, 2, 1]
samples = 8192
width = 512
height = 512
"#;
    let folder = Folder::new((ROOM.to_owned() + camera).as_bytes(), &[]);
    let output = interrupted(&folder, &["run", "room.toml", "-o", "out"], "-INT");
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let summary = folder.json("out/summary.json");
    assert_eq!(
        (&summary["complete"], &summary["stop"]),
        (&false.into(), &"samples".into())
    );
    // What the sensors read was there before.
    folder.run("again", &["--no-pictures"]);
    assert_eq!(
        folder.text("again/sensors.csv"),
        folder.text("out/sensors.csv")
    );
}

/// Errors are shares of the light, and here is none; what curved mirrors might still bring keeps every error above zero.
#[test]
fn a_room_in_the_dark_ends_by_its_rule_and_says_so() {
    let closed = r#"
[[shape]]
kind = "box"
min = [1, 1, 1]
max = [1.5, 1.5, 1.5]
material = "plaster"

[[shape]]
kind = "disc"
centre = [1.25, 1.25, 1.25]
normal = [0, 0, 1]
radius = 0.1
material = "lamp"

[[shape]]
kind = "sphere"
centre = [3, 1, 1]
radius = 0.3
material = "chrome"

[material.lamp]
rho = 0
exitance = 1000

[material.chrome]
rho = 0
a = 1
n = inf
"#;
    let scene = room_with("intensity = 10", "intensity = 0") + closed;
    let folder = Folder::new(
        scene.replace("samples = 64\n", "seconds = 60\n").as_bytes(),
        &[],
    );
    let output = folder.run("out", &["--relative-error", "0.01"]);
    let told = stderr(&output);
    assert!(told.contains("no light has reached any sensor"), "{told}");
    let summary = folder.json("out/summary.json");
    assert_eq!(summary["stop"], "relative_error");
}

#[test]
fn a_limit_of_time_is_kept_and_tells_how_to_repeat_the_run() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let output = folder.run("out", &["--seconds", "1"]);
    let summary = folder.json("out/summary.json");
    let seconds = summary["seconds"].as_f64().unwrap();
    // Checkpoints lie so close that at least a third of the time is used; above, one checkpoint on a busy machine.
    assert!((0.33..2.0).contains(&seconds), "{seconds} s");
    assert_eq!(summary["complete"], true);
    let samples = repeating(&output);
    assert_eq!(summary["samples"].to_string(), samples);
    folder.run("again", &["--samples", &samples]);
    assert_eq!(
        folder.text("again/sensors.csv"),
        folder.text("out/sensors.csv")
    );
}

#[test]
fn a_limit_of_error_is_reached_and_tells_how_to_repeat_the_run() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let output = folder.run("out", &["--relative-error", "0.002"]);
    let summary = folder.json("out/summary.json");
    assert!(
        summary["relative_error_max"].as_f64().unwrap() <= 0.002,
        "{summary}"
    );
    folder.run("again", &["--samples", &repeating(&output)]);
    assert_eq!(
        folder.text("again/sensors.csv"),
        folder.text("out/sensors.csv")
    );
}

#[test]
fn the_first_rule_that_is_reached_stops_the_run_in_any_mixture() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let near = ["samples=128", "relative_error=0.2", "seconds=0.3"];
    let far = [
        "samples=1000000000000",
        "relative_error=1e-9",
        "seconds=600",
    ];
    let key = |rule: &str| rule.split('=').next().unwrap().to_owned();
    for (first, rule) in near.iter().enumerate() {
        for others in 0..4 {
            let others = (0..3)
                .filter(|&rule| rule != first)
                .zip([others & 1, others >> 1]);
            let others = others
                .filter(|(_, given)| *given == 1)
                .map(|(rule, _)| far[rule]);
            let rules: Vec<String> = std::iter::once(*rule)
                .chain(others)
                .map(|rule| format!("--{}", rule.replace('_', "-")))
                .collect();
            let words: Vec<&str> = rules.iter().map(String::as_str).collect();
            folder.run("out", &words);
            let summary = folder.json("out/summary.json");
            assert_eq!(
                (&summary["stop"], &summary["complete"]),
                (&key(rule).into(), &true.into()),
                "{words:?}"
            );
        }
    }
}

#[test]
fn rules_of_the_scene_file_hold_together_until_one_is_given_on_the_command_line() {
    let rules = "samples = 192\nrelative_error = 1e-9\nseconds = 600";
    let folder = Folder::new(room_with("samples = 64", rules).as_bytes(), &[]);
    folder.run("out", &[]);
    assert_eq!(folder.json("out/summary.json")["samples"], 192);
    // `samples` no longer stops the run, nor does the error of the file.
    folder.run("out", &["--relative-error", "0.002"]);
    let summary = folder.json("out/summary.json");
    assert_eq!(summary["stop"], "relative_error");
    assert!(summary["samples"].as_u64().unwrap() > 192, "{summary}");
}

#[test]
fn results_that_cannot_be_written_fail_the_run_before_it_begins() {
    let folder = Folder::new(ROOM.as_bytes(), &[("out", b"a file")]);
    for directory in ["out", "out/deeper"] {
        let words = [
            "run",
            "room.toml",
            "-o",
            directory,
            "--relative-error",
            "1e-9",
        ];
        let output = folder.malus(&words);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{told}");
        assert!(
            told.starts_with("error: ") && told.contains(directory),
            "{told}"
        );
        assert!(!told.contains("panicked"), "{told}");
    }
    assert_eq!(folder.text("out"), "a file");
}

/// A file that stands in the place of one table: found at the end, and nothing half-written is left.
#[test]
fn a_table_that_cannot_be_written_fails_the_run() {
    let folder = Folder::new(ROOM.as_bytes(), &[("out/", b""), ("out/sensors.csv/", b"")]);
    let output = folder.malus(&["run", "room.toml", "-o", "out"]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("error: ") && told.contains("sensors.csv"),
        "{told}"
    );
    let left: Vec<_> = std::fs::read_dir(folder.path("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert!(!left.iter().any(|name| name == "summary.json"), "{left:?}");
    assert!(
        !left
            .iter()
            .any(|name| name.to_string_lossy().ends_with(".part")),
        "{left:?}"
    );
}

#[test]
fn a_useless_command_line_is_a_bad_argument() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    for words in [
        &[][..],
        &["rum", "room.toml"],
        &["run"],
        &["run", "room.toml", "more.toml"],
    ] {
        let output = folder.malus(words);
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert!(!stderr(&output).is_empty(), "{words:?}");
    }
    for words in [["--help", ""], ["run", "--help"], ["--version", ""]] {
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        let output = folder.malus(&words);
        assert_eq!(output.status.code(), Some(0), "{words:?}");
        assert!(stdout(&output).contains("malus"), "{words:?}");
    }
}

/// Where nothing absorbs, light never dies away and no answer exists: the run has to say so, or to stop by its rules.
#[test]
fn a_room_that_absorbs_nothing_does_not_run_for_ever() {
    for white in ["rho = 1", "rho = 0.5\na = 1\nn = inf"] {
        let folder = Folder::new(room_with("rho = 0.5", white).as_bytes(), &[]);
        let mut child = folder
            .command(&["run", "room.toml", "-o", "out", "--seconds", "1"])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let started = Instant::now();
        while child.try_wait().unwrap().is_none() {
            if started.elapsed() > Duration::from_secs(10) {
                child.kill().unwrap();
                panic!("{white}: not ended after ten times its limit");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let told = stderr(&child.wait_with_output().unwrap());
        assert!(told.contains("absorb"), "{white}: {told}");
    }
}
