//! Error against time: what is measured, against what, and what is left of it when time is up.

use super::{Folder, ROOM, room_with, stderr, stdout};
use std::process::Stdio;
use std::time::Duration;

const HEADER: &str = "estimator,representation,threads,samples,seconds,rms_error,max_error,se_mean";

/// The rows of `tradeoff.csv`: the setting's words and samples, then its four numbers.
fn rows(text: &str) -> Vec<([String; 4], [f64; 4])> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(HEADER));
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields.len(), 8, "{line}");
            (
                std::array::from_fn(|i| fields[i].to_owned()),
                std::array::from_fn(|i| fields[4 + i].parse().unwrap()),
            )
        })
        .collect()
}

/// The share before `%` behind a passage of a text.
fn percent(text: &str, before: &str) -> f64 {
    let behind = text
        .split(before)
        .nth(1)
        .unwrap_or_else(|| panic!("no {before:?} in:\n{text}"));
    0.01 * behind
        .split_whitespace()
        .next()
        .unwrap()
        .parse::<f64>()
        .unwrap()
}

/// A room that needs polarisation and has no mirrors: its lamp is polarised.
fn polarised() -> String {
    room_with("rho = 0.5", "rho = 0.8")
        .replace("intensity = 10", "intensity = 10\nstokes = [1, 0.5, 0, 0]")
}

#[test]
fn every_setting_is_measured_against_a_reference_five_times_finer() {
    let folder = Folder::new(polarised().as_bytes(), &[]);
    let words = [
        "tradeoff",
        "room.toml",
        "-o",
        "out",
        "--budget",
        "8",
        "--threads",
        "2",
    ];
    let output = folder.malus(&words);
    let told = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let rows = rows(&folder.text("out/tradeoff.csv"));
    for setting in [
        ["auto", "linear", "2"],
        ["gather", "linear", "2"],
        ["local", "linear", "2"],
        ["direct", "linear", "2"],
        ["auto", "intensity", "2"],
        ["auto", "full", "2"],
        ["auto", "linear", "1"],
    ] {
        assert!(
            rows.iter().any(|(words, _)| words[..3] == setting),
            "no {setting:?} in {rows:?}"
        );
    }
    assert!(told.contains("gather alone"), "{told}");
    let reference = percent(&told, "standard error ");
    let smallest = percent(&told, "smallest error shown ");
    // Both are printed to two digits.
    assert!(reference <= 0.2 * smallest * 1.12, "{told}");
    for (words, [seconds, rms, max, se]) in &rows {
        assert!(*seconds > 0.0 && *se > 0.0, "{words:?}");
        assert!(
            *rms >= 0.95 * smallest && *max >= *rms,
            "{words:?}: {rms} {max}"
        );
    }
    for target in ["3 %", "1 %", "0.3 %", "0.1 %"] {
        assert!(
            told.lines()
                .any(|line| line.trim_start().starts_with(target)),
            "no {target} in:\n{told}"
        );
    }
    let drawn = folder.text("out/tradeoff.svg");
    assert!(drawn.starts_with("<svg") && drawn.ends_with("</svg>\n"));
    assert!(
        drawn.contains("slope −") && drawn.contains("the least error for the time"),
        "{drawn}"
    );
}

#[test]
fn where_gather_is_blind_the_reference_is_not_made_by_it() {
    let folder = Folder::new(room_with("rho = 0.5", "rho = 0.5\na = 0.6").as_bytes(), &[]);
    let words = [
        "tradeoff",
        "room.toml",
        "-o",
        "out",
        "--budget",
        "2",
        "--no-pictures",
    ];
    let told = stdout(&folder.malus(&words));
    assert!(told.starts_with("reference by auto,"), "{told}");
    assert!(
        told.contains("gather: light of point, spot and distant sources"),
        "{told}"
    );
    assert!(
        told.contains(
            "local: light whose last reflection before the sensor is mirror-like is missing"
        ),
        "{told}"
    );
    assert!(!folder.path("out/tradeoff.svg").exists());
}

#[test]
fn an_interrupted_measurement_writes_what_it_has() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let words = ["tradeoff", "room.toml", "-o", "out", "--budget", "600"];
    let child = folder
        .command(&words)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    while !folder.path("out").exists() {
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(1500));
    let told = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(told.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("interrupted"),
        "{}",
        stderr(&output)
    );
    rows(&folder.text("out/tradeoff.csv"));
}

#[test]
fn a_budget_that_is_none_is_refused() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    for budget in ["0", "-1", "inf", "soon"] {
        let output = folder.malus(&["tradeoff", "room.toml", "-o", "out", "--budget", budget]);
        assert_eq!(output.status.code(), Some(2), "{budget}");
        let told = stderr(&output);
        assert!(told.contains("--budget") && told.contains(budget), "{told}");
        assert!(!folder.path("out").exists());
    }
}

#[test]
fn a_scene_without_light_at_its_sensors_has_no_error_to_measure() {
    let dark =
        room_with("normal = [0, 0, 1]", "normal = [0, 0, -1]").replace("rho = 0.5", "rho = 0");
    let folder = Folder::new(dark.as_bytes(), &[]);
    let output = folder.malus(&["tradeoff", "room.toml", "-o", "out", "--budget", "2"]);
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    assert!(
        stderr(&output).contains("no light reaches any sensor"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_budget_that_is_too_short_to_tell_any_error_fails_and_says_so() {
    let folder = Folder::new(ROOM.as_bytes(), &[]);
    let output = folder.malus(&["tradeoff", "room.toml", "-o", "out", "--budget", "1e-6"]);
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    assert!(stderr(&output).contains("--budget"), "{}", stderr(&output));
    assert!(!folder.path("out/tradeoff.csv").exists());
}
