//! Mixtures, coats and panes, by the scene file and by custom properties.

use super::*;

/// The optics, kind and origin of the kind of the material `Wall` in these tables.
fn kind(text: &str, custom: &Custom, fields: &Appearance) -> Result<(Material, String), String> {
    let library = library(text);
    let resolved = sources(&library, custom, fields).resolve();
    let (material, _) = resolved.map_err(|error| error.to_string())?;
    let kind = &material.values[0];
    let told = format!("{} {} {}", kind.key, kind.value, kind.origin);
    Ok((material, told))
}

fn written(text: &str) -> Result<(Material, String), String> {
    kind(text, &Custom::default(), &Appearance::default())
}

fn keys(material: &Material) -> Vec<&str> {
    material.values.iter().map(|value| value.key).collect()
}

#[test]
fn each_kind_has_its_own_values() {
    let (mixture, told) = written("[material.Wall]\nrho = 0.5").unwrap();
    assert_eq!(told, "kind mixture default");
    assert_eq!(keys(&mixture)[..5], ["kind", "rho", "a", "n", "k"]);
    let text = "[material.Wall]\nkind = \"coated\"\nrho = 0.5\nn = 1.6\nk = 0";
    let (coated, told) = written(text).unwrap();
    assert_eq!(told, "kind coated room.toml:2:8");
    assert_eq!(coated.optics, Coated(malus_optics::Coated::new(0.5, 1.6)));
    assert_eq!(keys(&coated), ["kind", "rho", "n", "exitance", "two_sided"]);
    let (pane, _) = written("[material.Wall]\nkind = \"pane\"\nn = 1.52\ntau = 0.9").unwrap();
    assert_eq!(pane.optics, Pane { n: 1.52, tau: 0.9 });
    assert_eq!(keys(&pane), ["kind", "n", "tau", "exitance", "two_sided"]);
}

#[test]
fn a_coat_and_a_pane_have_defaults() {
    let (coated, _) = written("[material.Wall]\nkind = \"coated\"\nrho = 0.5").unwrap();
    assert_eq!(coated.optics, Coated(malus_optics::Coated::new(0.5, 1.5)));
    let (pane, _) = written("[material.Wall]\nkind = \"pane\"").unwrap();
    assert_eq!(pane.optics, Pane { n: 1.5, tau: 1.0 });
    let error = written("[material.Wall]\nkind = \"coated\"").unwrap_err();
    assert!(
        error.contains("nothing gives its reflectance rho"),
        "{error}"
    );
}

#[test]
fn a_value_that_its_kind_does_not_have_is_an_error_that_says_so() {
    for (kind, line, expected) in [
        (
            "coated",
            "rho = 1\na = 0",
            "a is given for material \"Wall\", whose kind is \"coated\" (room.toml:2:8): it is not read",
        ),
        ("coated", "rho = 1\nk = 0.1", "its k is 0"),
        (
            "coated",
            "rho = 1\ntau = 1",
            "leave it out, or give kind = \"pane\"",
        ),
        (
            "pane",
            "n = 1.5\nrho = 0",
            "rho is given for material \"Wall\", whose kind is \"pane\"",
        ),
        (
            "pane",
            "n = 1.5\na = 1",
            "leave it out, or give kind = \"mixture\"",
        ),
        ("pane", "n = 1.5\nk = 0", "its absorption is tau"),
        (
            "mixture",
            "rho = 0\ntau = 1",
            "a mixture lets no light through",
        ),
        (
            "coated",
            "rho = 1\nn = 0.9",
            "n of material \"Wall\", whose kind is \"coated\", must be a finite number ≥ 1, found 0.9",
        ),
        (
            "coated",
            "rho = 1\nn = inf",
            "a finite number ≥ 1, found inf",
        ),
        (
            "pane",
            "tau = 1\nn = inf",
            "must be a number > 0, found inf",
        ),
        (
            "pane",
            "n = 1.5\nexitance = 1",
            "emits light (room.toml:4:12), which a pane cannot",
        ),
        (
            "pane",
            "n = 1.5\ntwo_sided = false",
            "which has no black side",
        ),
    ] {
        let text = format!("[material.Wall]\nkind = \"{kind}\"\n{line}");
        let error = written(&text).unwrap_err();
        assert!(error.starts_with("room.toml:4:"), "{error}");
        assert!(error.contains(expected), "{error}");
    }
    let error = written("[material.Wall]\nrho = 0.5\ntau = 0.9").unwrap_err();
    assert!(
        error.starts_with("room.toml:3:7: ") && error.contains("\"mixture\" (default)"),
        "{error}"
    );
}

#[test]
fn a_value_for_many_is_no_reproach_to_one_of_another_kind() {
    let all = "[material.\"*\"]\nrho = 0.5\na = 0.2\nk = 0\n";
    let pane = written(&format!("{all}[material.Wall]\nkind = \"pane\""))
        .unwrap()
        .0;
    assert_eq!(pane.optics, Pane { n: 1.5, tau: 1.0 });
    let pane = written(&format!("{all}[material.\"Wal*\"]\nkind = \"pane\""))
        .unwrap()
        .0;
    assert_eq!(pane.optics, Pane { n: 1.5, tau: 1.0 });
    let all = "[material.\"Wal*\"]\nkind = \"pane\"\n";
    let error = written(&format!("{all}[material.Wall]\na = 0.5")).unwrap_err();
    assert!(
        error.starts_with("room.toml:4:5: ") && error.contains("(\"Wal*\" at room.toml:2:8)"),
        "{error}"
    );
    assert!(written(&format!("{all}[material.\"W*\"]\na = 0.5")).is_ok());
}

#[test]
fn custom_properties_give_kinds_and_are_judged_like_the_file() {
    let none = Appearance::default();
    let pane = Custom {
        kind: Some(Kind::Pane),
        tau: Some(0.8),
        ..Custom::default()
    };
    let (material, told) = kind("", &pane, &none).unwrap();
    assert_eq!(material.optics, Pane { n: 1.5, tau: 0.8 });
    assert_eq!(told, "kind pane malus_kind of the material");
    assert_eq!(
        material.values[2].origin.to_string(),
        "malus_tau of the material"
    );
    let both = Custom {
        a: Some(0.5),
        ..pane.clone()
    };
    let error = kind("", &both, &none).unwrap_err();
    assert!(
        error.starts_with(
            "object \"Cube\", material \"Wall\" (room.glb): malus_a of the material is given"
        ),
        "{error}"
    );
    // The scene file's kind is closer than the property's a, which it passes over.
    let text = "[material.Wall]\nkind = \"pane\"";
    assert_eq!(
        kind(text, &both, &none).unwrap().0.optics,
        Pane { n: 1.5, tau: 0.8 }
    );
    let error = kind(
        "[material.Wall]\nkind = \"coated\"\nrho = 0.5\ntau = 1",
        &pane,
        &none,
    );
    assert!(error.unwrap_err().contains("hides a base"));
}

/// What the fields of clear glass give.
fn clear() -> Appearance {
    Appearance {
        rho: Some((0.0, "base colour")),
        a: Some((1.0, "specular")),
        n: Some((1.45, "KHR_materials_ior")),
        pane: Some("KHR_materials_transmission"),
        tau: Some((0.9, "base colour")),
        exitance: Some((0.0, "emissive")),
        doubts: vec![
            Doubt::Value(&["kind"], "is rough".into()),
            Doubt::Opaque("transmits light".into()),
        ],
        ..Appearance::default()
    }
}

#[test]
fn glass_of_a_file_is_a_pane_until_someone_gives_what_no_pane_has() {
    let of = |text: &str| {
        let custom = Custom::default();
        let library = library(text);
        let (material, doubts) = sources(&library, &custom, &clear()).resolve().unwrap();
        (material, doubts.join(" "))
    };
    let (pane, doubts) = of("");
    assert_eq!(pane.optics, Pane { n: 1.45, tau: 0.9 });
    assert_eq!(
        pane.values[0].origin.to_string(),
        "KHR_materials_transmission"
    );
    assert_eq!(doubts, "is rough");
    for given in ["rho = 0", "a = 1", "exitance = 5", "two_sided = false"] {
        let (mixture, doubts) = of(&format!("[material.\"*\"]\n{given}"));
        let origin = mixture.values[0].origin.to_string();
        assert!(
            !mixture.optics.is_pane() && doubts == "transmits light",
            "{given}"
        );
        assert!(origin.starts_with("\"*\" at room.toml:2:"), "{origin}");
    }
    assert_eq!(of("[material.\"*\"]\nkind = \"mixture\"").1, "");
    assert_eq!(of("[material.\"*\"]\nkind = \"pane\"").1, "");
}

#[test]
fn the_index_guessed_for_a_metal_is_none_of_a_coat() {
    let metal = Appearance {
        rho: Some((0.5, "base colour")),
        n: Some((1.0, "metallic")),
        k: Some((2.0, "metallic")),
        ..Appearance::default()
    };
    let text = "[material.Wall]\nkind = \"coated\"";
    let coated = kind(text, &Custom::default(), &metal).unwrap().0;
    assert_eq!(coated.optics, Coated(malus_optics::Coated::new(0.5, 1.5)));
}
