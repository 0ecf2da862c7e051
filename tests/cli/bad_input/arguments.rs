//! Overrides and options that cannot be.

use super::super::ROOM;
use super::{assert_told, refusal};

#[test]
fn an_override_is_judged_like_the_file_and_told_as_typed() {
    for (entry, parts) in [
        (
            "material.plaster.roh=0.3",
            ["\"roh\"", "nearest is \"rho\""],
        ),
        (
            "materal.plaster.rho=0.3",
            ["\"materal\"", "nearest is \"material\""],
        ),
        (
            "sensor.dsek.frame=fixed",
            ["\"dsek\"", "nearest is \"desk\""],
        ),
        (
            "material.plaster.rho=1.2",
            ["rho must be a number from 0 to 1", "found 1.2"],
        ),
        (
            "material.plaster.rho=[1",
            ["not valid TOML", "unclosed array"],
        ),
        ("shape.7.material=plaster", ["1 entries", "no 7"]),
    ] {
        let told = refusal(ROOM.as_bytes(), &[], &["--set", entry]);
        assert_told(
            &told,
            &[&format!("error: --set {entry}: "), parts[0], parts[1]],
        );
    }
    let told = refusal(ROOM.as_bytes(), &[], &["--set", "material.plaster.rho"]);
    assert_told(&told, &["material.plaster.rho", "--set", "KEY=VALUE"]);
}

#[test]
fn an_option_is_judged_like_the_file_and_told_as_typed() {
    for (option, value, allowed) in [
        ("--samples", "0", "a whole number ≥ 1, found 0"),
        ("--samples", "many", "a whole number ≥ 1"),
        ("--seconds", "-1", "a number > 0, found -1"),
        ("--relative-error", "nan", "a number > 0, found NaN"),
        ("--seed", "-3", "a whole number ≥ 0, found -3"),
        ("--model", "polarized", "nearest is \"polarised\""),
        ("--estimator", "dirct", "nearest is \"direct\""),
        (
            "--representation",
            "stokes",
            "\"intensity\" or \"linear\" or \"full\"",
        ),
        ("--threads", "0", "a whole number from 1 to 1024"),
        ("--threads", "two", "a whole number from 1 to 1024"),
        ("--threads", "100000", "a whole number from 1 to 1024"),
    ] {
        let told = refusal(ROOM.as_bytes(), &[], &[option, value]);
        assert_told(&told, &[&format!("error: {option} {value}: "), allowed]);
    }
    let told = refusal(ROOM.as_bytes(), &[], &["--estimator", "direct"]);
    assert_told(&told, &["room.toml:21:1: [run] lacks the key \"cell\""]);
    let told = refusal(ROOM.as_bytes(), &[], &["--set", "run.cell=0.1"]);
    assert_told(
        &told,
        &["error: --set run.cell=0.1: cell goes with estimator = \"direct\""],
    );
    let told = refusal(ROOM.as_bytes(), &[], &["--sample", "64"]);
    assert_told(&told, &["'--sample'", "'--samples'"]);
}
