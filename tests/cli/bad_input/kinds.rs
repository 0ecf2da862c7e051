//! Coats and panes that cannot be.

use super::super::room_with;
use super::{assert_each, assert_told, refusal, room_and};

#[test]
fn a_value_that_does_not_go_with_the_kind() {
    assert_each(&[
        (
            "rho = 0.5",
            "kind = \"coat\"\nrho = 0.5",
            &["room.toml:14:8: ", "\"coat\"", "nearest is \"coated\""],
        ),
        (
            "rho = 0.5",
            "kind = \"coated\"\nrho = 0.5\na = 0.2",
            &[
                "room.toml:16:5: a is given for material \"plaster\", whose kind is \"coated\" (room.toml:14:8)",
                "it is not read",
                "leave it out",
            ],
        ),
        (
            "rho = 0.5",
            "kind = \"coated\"\nrho = 0.5\nn = 0.9",
            &["room.toml:16:5: ", "a finite number ≥ 1, found 0.9"],
        ),
        (
            "rho = 0.5",
            "kind = \"coated\"",
            &["nothing gives its reflectance rho"],
        ),
        (
            "rho = 0.5",
            "kind = \"pane\"\nrho = 0.5",
            &["room.toml:15:7: rho is given", "\"pane\" (room.toml:14:8)"],
        ),
        (
            "rho = 0.5",
            "kind = \"pane\"\nn = inf",
            &["room.toml:15:5: ", "a number > 0, found inf"],
        ),
        (
            "rho = 0.5",
            "kind = \"pane\"\ntau = 1.2",
            &[
                "room.toml:15:7: ",
                "tau must be a number from 0 to 1, found 1.2",
            ],
        ),
        (
            "rho = 0.5",
            "kind = \"pane\"\ntwo_sided = false",
            &[
                "room.toml:15:13: ",
                "no black side",
                "leave two_sided = false out",
            ],
        ),
        (
            "rho = 0.5",
            "kind = \"pane\"\nexitance = 3",
            &["room.toml:15:12: ", "emits light", "give exitance = 0"],
        ),
        (
            "rho = 0.5",
            "rho = 0.5\ntau = 0.9",
            &["room.toml:15:7: tau is given", "give kind = \"pane\""],
        ),
    ]);
}

#[test]
fn a_pane_that_is_a_closed_solid() {
    let slab = "\n[[shape]]\nkind = \"box\"\nmin = [1, 1, 1]\nmax = [1.01, 2, 2]\nmaterial = \"glass\"\n\
        [material.glass]\nkind = \"pane\"\n";
    let told = refusal(&room_and(slab), &[], &[]);
    assert_told(
        &told,
        &[
            "room.toml:30:8: material \"glass\" is a pane",
            "closed solids: \"shape.1\"",
            "replace it by a single sheet",
            "[material.\"glass\"]\n    kind = \"mixture\"",
        ],
    );
}

#[test]
fn a_coated_room_that_loses_nothing() {
    let white = room_with("rho = 0.5", "kind = \"coated\"\nrho = 1");
    let told = refusal(white.as_bytes(), &[], &[]);
    assert_told(&told, &["room.toml: nothing absorbs light", "plaster"]);
}
