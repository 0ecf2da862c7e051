use super::*;
use std::collections::BTreeSet;
use std::sync::Arc;

const ROOM: &str = "[[shape]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [4, 3, 2.5]\ninward = true\nmaterial = \"plaster\"\n\
    [material.plaster]\nrho = 0.5\na = 0.1\n[[source]]\nkind = \"point\"\nposition = [2, 1.5, 2]\nintensity = 10\n\
    [[sensor]]\nname = \"desk\"\npoints = [[2, 1.5, 0.75]]\nnormal = [0, 0, 1]\n";

/// A folder with `room.toml`, `study.toml` and other files.
fn folder(study: &str, files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("room.toml", ROOM);
    write("study.toml", &format!("scene = \"room.toml\"\n{study}"));
    for (name, text) in files {
        write(name, text);
    }
    folder
}

fn load(study: &str, files: &[(&str, &str)]) -> Result<Study, String> {
    let folder = folder(study, files);
    Study::load(&folder.path().join("study.toml")).map_err(|error| told(&folder, &error))
}

/// A study that is right, with its base, in a folder that lives as long.
fn opened(study: &str) -> (tempfile::TempDir, Study, Base) {
    let folder = folder(study, &[]);
    let study = Study::load(&folder.path().join("study.toml")).unwrap();
    let base = study.base(&[]).unwrap();
    (folder, study, base)
}

fn told(folder: &tempfile::TempDir, error: &Error) -> String {
    let path = format!("{}/", folder.path().display());
    error.to_string().replace(&path, "")
}

fn table(study: &Study) -> Vec<Vec<String>> {
    let filled = |variant: Variant| {
        let values = variant.values().into_iter();
        values.map(|value| value.unwrap_or_default()).collect()
    };
    study.variants().map(filled).collect()
}

#[test]
fn a_grid_has_every_combination_the_last_key_turning_fastest() {
    let study = load(
        "[grid]\n\"material.plaster.a\" = [0, 0.2]\nmaterial.plaster.n = [1.5, inf]",
        &[],
    )
    .unwrap();
    assert_eq!(study.keys(), ["material.plaster.a", "material.plaster.n"]);
    let expected = [["0", "1.5"], ["0", "inf"], ["0.2", "1.5"], ["0.2", "inf"]];
    assert_eq!(table(&study), expected);
    let names: Vec<String> = study.variants().map(|variant| variant.name()).collect();
    assert_eq!(names, ["001", "002", "003", "004"]);
}

#[test]
fn a_list_is_rows_and_an_empty_field_leaves_the_base() {
    let csv = "material.plaster.a, shape.0.max\n# a comment\n0.2,\"[4, 3, 3]\"\n,\"[4, 3, 2]\"\n";
    let study = load(
        "[list]\nfile = \"v.csv\"\n[grid]\n\"run.model\" = [\"scalar\"]",
        &[("v.csv", csv)],
    )
    .unwrap();
    assert_eq!(
        study.keys(),
        ["run.model", "material.plaster.a", "shape.0.max"]
    );
    assert_eq!(
        table(&study),
        [["scalar", "0.2", "[4, 3, 3]"], ["scalar", "", "[4, 3, 2]"]]
    );
}

#[test]
fn a_sample_holds_one_value_in_each_part_of_every_range() {
    let text = "[sample]\ncount = 16\nseed = 7\n\"material.plaster.a\" = { from = 0, to = 1 }\n\
        material.plaster.n = { from = 1, to = 65536, scale = \"log\" }";
    let study = load(text, &[]).unwrap();
    let number = |text: &String| text.parse::<f64>().unwrap();
    let parts = |share: &dyn Fn(&Vec<String>) -> f64| -> BTreeSet<usize> {
        table(&study)
            .iter()
            .map(|row| share(row) as usize)
            .collect()
    };
    let all: BTreeSet<usize> = (0..16).collect();
    assert_eq!(parts(&|row| 16.0 * number(&row[0])), all);
    assert_eq!(parts(&|row| number(&row[1]).log2()), all);
    // The ranges are shuffled apart, by the seed alone.
    let ascending = |study: &Study| {
        table(study)
            .windows(2)
            .all(|pair| number(&pair[0][0]) < number(&pair[1][0]))
    };
    assert!(!ascending(&study));
    assert_eq!(table(&study), table(&load(text, &[]).unwrap()));
    assert_ne!(
        table(&study),
        table(&load(&text.replace("= 7", "= 8"), &[]).unwrap())
    );
}

#[test]
fn what_is_wrong_with_a_study_is_told_where_it_stands() {
    for (study, expected) in [
        ("", "study.toml:1:1: the study varies nothing"),
        (
            "[gird]\n\"material.plaster.a\" = [1]",
            "study.toml:2:2: the study has no key \"gird\"; the nearest is \"grid\"",
        ),
        ("[grid]", "study.toml:2:1: [grid] holds no key"),
        (
            "[grid]\n\"material.plaster.a\" = []",
            "study.toml:3:24: [grid] material.plaster.a must be a list of one value or more, found a list of 0",
        ),
        (
            "[grid]\n\"material.plaster.a\" = 0.2",
            "study.toml:3:24: [grid] material.plaster.a must be the list of its values, found 0.2",
        ),
        (
            "[grid]\n\"material..a\" = [0.2]",
            "study.toml:3:1: \"material..a\" is no dotted key",
        ),
        (
            "[grid]\n\"material.plaster.a\" = [1]\nmaterial.plaster.a = [0.5]",
            "study.toml:4:18: the key material.plaster.a is given twice",
        ),
        (
            "[grid]\n\"run.seed\" = [1, 2]",
            "study.toml:3:1: run.seed cannot vary: all variants take the same walks",
        ),
        (
            "[list]\nfile = \"none.csv\"",
            "none.csv: there is no such file (named at study.toml:3:8)",
        ),
        (
            "[list]\nfile = \"empty.csv\"",
            "empty.csv: holds no variants",
        ),
        (
            "[list]\nfile = \"ragged.csv\"",
            "ragged.csv: CSV error: record 2 (line: 3",
        ),
        ("[list]\nfile = \"bad.csv\"", "bad.csv:2:5: not valid TOML"),
        (
            "[list]\nfiel = \"bad.csv\"",
            "study.toml:3:1: [list] has no key \"fiel\"; the nearest is \"file\"",
        ),
        (
            "[sample]\ncount = 0",
            "study.toml:3:9: [sample] count must be a whole number from 1 to 1000000, found 0",
        ),
        (
            "[sample]\ncount = 4",
            "study.toml:2:1: [sample] holds no range",
        ),
        (
            "[sample]\ncount = 4\n\"shape.0.max.2\" = [1, 2]",
            "study.toml:4:19: [sample] shape.0.max.2 must be a table",
        ),
        (
            "[sample]\ncount = 4\n\"shape.0.max.2\" = { form = 1, to = 2 }",
            "has no key \"form\"; the nearest is \"from\"",
        ),
        (
            "[sample]\ncount = 4\n\"shape.0.max.2\" = { from = 2, to = 2 }",
            "study.toml:4:36: [sample] shape.0.max.2 to must be a number above from = 2, found 2",
        ),
        (
            "[sample]\ncount = 4\n\"shape.0.max.2\" = { from = 0, to = 2, scale = \"log\" }",
            "from must be a number > 0, found 0",
        ),
        (
            "[sample]\ncount = 1000000\n\"shape.0.max.2\" = { from = 0, to = 2 }\n[grid]\n\"material.plaster.a\" = [0, 1]",
            "study.toml:1:1: the study has more than 1000000 variants",
        ),
    ] {
        let files = [
            ("empty.csv", "material.plaster.a\n"),
            (
                "ragged.csv",
                "material.plaster.a,material.plaster.n\n1,2\n1\n",
            ),
            (
                "bad.csv",
                "material.plaster.a,material.plaster.n\n0.1,\"[1\"\n",
            ),
        ];
        let error = load(study, &files).unwrap_err();
        assert!(error.contains(expected), "{study}: {error}");
    }
}

fn base(study: &str) -> Result<Base, String> {
    let folder = folder(study, &[]);
    let study = Study::load(&folder.path().join("study.toml")).unwrap();
    study.base(&[]).map_err(|error| told(&folder, &error))
}

#[test]
fn an_unknown_key_is_told_before_any_variant_is_loaded() {
    for (key, expected) in [
        (
            "material.plaster.rhoo",
            "study.toml:3:1: [material.plaster] has no key \"rhoo\"; the nearest is \"rho\"",
        ),
        (
            "material.plastr.rho",
            "study.toml:3:1: no material is called \"plastr\"; the nearest is \"plaster\"",
        ),
        (
            "material.pl?ster?.rho",
            "study.toml:3:1: no material is called \"pl?ster?\"",
        ),
        (
            "shape.1.min",
            "study.toml:3:1: \"shape\" has 1 entries, counted from 0: no 1",
        ),
        (
            "sensor.dsek.frame",
            "study.toml:3:1: \"sensor\" has no entry called \"dsek\"; the nearest is \"desk\"",
        ),
        (
            "materail.plaster.rho",
            "study.toml:3:1: the scene file has no key \"materail\"; the nearest is \"material\"",
        ),
    ] {
        let error = base(&format!("[grid]\n{key:?} = [0.1, 0.2]"))
            .err()
            .unwrap();
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(error.starts_with(expected), "{error}");
    }
    assert!(base("[grid]\n\"material.pla*.rho\" = [0.1]").is_ok());
}

#[test]
fn a_bad_value_is_a_doubt_and_fails_its_variant_alone() {
    let (_folder, study, base) =
        opened("[grid]\n\"material.plaster.a\" = [0.3, 1.5]\n\"shape.0.max\" = [[4, 3, 3]]");
    let wrong = "study.toml:3:30: [material.plaster] a must be a number from 0 to 1, found 1.5";
    assert_eq!(base.doubts.len(), 1);
    assert!(base.doubts[0].ends_with(wrong), "{}", base.doubts[0]);
    assert_eq!(
        base.values(&study),
        [Some("0.1".to_owned()), Some("[4, 3, 2.5]".to_owned())]
    );
    let variants: Vec<Variant> = study.variants().collect();
    let good = base.variant(&variants[0]).unwrap();
    let a = |scene: &Scene| match scene.materials[0].optics {
        malus_optics::Material::Mixture { fraction, .. } => fraction,
        _ => unreachable!("plaster is a mixture"),
    };
    assert!((a(&base.scene) - 0.1).abs() < 1e-15 && (a(&good) - 0.3).abs() < 1e-15);
    assert!(good.surfaces.radius() > base.scene.surfaces.radius());
    let error = base.variant(&variants[1]).err().unwrap().to_string();
    assert!(error.ends_with(wrong), "{error}");
}

#[test]
fn what_moves_is_told_from_what_only_looks_otherwise() {
    for (key, values, moves) in [
        ("material.plaster.a", "[0.1, 0.3]", false),
        ("source.0.intensity", "[5, 10]", false),
        ("source.0.position", "[[1, 1, 2]]", true),
        ("shape.0.max", "[[4, 3, 3]]", true),
    ] {
        let study = load(&format!("[grid]\n{key:?} = {values}"), &[]).unwrap();
        assert_eq!(study.moves(), moves, "{key}");
    }
}

#[test]
fn variants_of_one_geometry_follow_each_other_and_share_it() {
    let (folder, study, base) = opened(
        "[grid]\n\"material.plaster.a\" = [0.1, 0.3]\n\"shape.0.max\" = [[4, 3, 3], [4, 3, 2.8]]",
    );
    let names: Vec<String> = study.variants().map(|it| it.name()).collect();
    assert_eq!(names, ["001", "003", "002", "004"]);
    let scenes: Vec<Scene> = study
        .variants()
        .map(|it| base.variant(&it).unwrap())
        .collect();
    for pair in scenes.chunks(2) {
        assert!(Arc::ptr_eq(&pair[0].surfaces, &pair[1].surfaces));
        assert_ne!(pair[0].materials[0].optics, pair[1].materials[0].optics);
    }
    assert!(!Arc::ptr_eq(&scenes[0].surfaces, &scenes[2].surfaces));
    // As if it were loaded by itself.
    let path = folder.path().join("room.toml");
    let overrides = ["material.plaster.a=0.3", "shape.0.max=[4,3,3]"].map(|it| {
        let (key, value) = it.split_once('=').unwrap();
        Override {
            key: key.into(),
            value: value.into(),
        }
    });
    let alone = Scene::load(&path, &overrides).unwrap();
    assert_eq!(scenes[1].materials[0].optics, alone.materials[0].optics);
    let fingerprint = |scene: &Scene| scene.fingerprint(&scene.settings);
    assert!(
        fingerprint(&alone)
            .differences(&fingerprint(&scenes[1]))
            .is_empty()
    );
}
