use super::*;
use crate::document::Node;
use crate::reader::Reader;
use malus_optics::Index;
use malus_optics::Material::{Coated, Pane};

fn library(text: &str) -> Library {
    let node = Node::document(&"room.toml".into(), text).unwrap();
    let field = Reader::new("the scene file".into(), node)
        .unwrap()
        .take("material");
    Library::read(field).unwrap()
}

fn sources<'a>(library: &'a Library, custom: &'a Custom, fields: &'a Appearance) -> Sources<'a> {
    Sources {
        library,
        name: "Wall",
        holder: "object \"Cube\", material \"Wall\" (room.glb)".into(),
        object: None,
        custom: Some(custom),
        appearance: Some(fields),
        area: 2.0,
    }
}

fn carrier(custom: &Custom) -> Carrier<'_> {
    Carrier {
        name: "Cube",
        custom,
        local_x: DVec3::Y,
        area: Some(0.5),
    }
}

fn fields() -> Appearance {
    Appearance {
        rho: Some((0.1, "base colour")),
        a: Some((0.2, "specular")),
        exitance: Some((3.0, "emissive")),
        doubts: vec![
            Doubt::Value(&["rho"], "its texture is taken at its mean".into()),
            Doubt::Opaque("transmits light".into()),
        ],
        ..Appearance::default()
    }
}

fn rho(sources: &Sources<'_>) -> (String, String) {
    let material = sources.resolve().unwrap().0;
    let rho = &material.values[1];
    (rho.value.clone(), rho.origin.to_string())
}

#[test]
fn every_step_of_the_order_of_precedence_goes_before_the_next() {
    let (exact, glob, none) = (
        library("[material.\"W*\"]\nrho = 0.6\n[material.Wall]\nrho = 0.7"),
        library("[material.\"W*\"]\nrho = 0.6"),
        library(""),
    );
    let own = Custom {
        rho: Some(0.5),
        ..Custom::default()
    };
    let material = Custom {
        rho: Some(0.4),
        ..Custom::default()
    };
    let (plain, fields) = (Custom::default(), fields());
    let expect = |sources: Sources<'_>, value: &str, origin: &str| {
        let found = rho(&sources);
        assert_eq!(found.0, value);
        assert!(found.1.contains(origin), "{found:?}");
    };
    let with_object = |library, custom| Sources {
        object: Some(carrier(&own)),
        ..sources(library, custom, &fields)
    };
    expect(with_object(&exact, &material), "0.7", "room.toml:4:7");
    expect(
        with_object(&glob, &material),
        "0.6",
        "\"W*\" at room.toml:2:7",
    );
    expect(
        with_object(&none, &material),
        "0.5",
        "malus_rho of object \"Cube\"",
    );
    expect(
        sources(&none, &material, &fields),
        "0.4",
        "malus_rho of the material",
    );
    expect(sources(&none, &plain, &fields), "0.1", "base colour");
}

#[test]
fn what_nothing_gives_has_its_default() {
    let (library, custom) = (library("[material.Wall]\nrho = 0.5"), Custom::default());
    let bare = Appearance::default();
    let (material, doubts) = sources(&library, &custom, &bare).resolve().unwrap();
    let expected = malus_optics::Material::Mixture {
        rho: 0.5,
        fraction: 0.0,
        index: Index::new(1.5, 0.0),
    };
    assert_eq!(material.optics, expected);
    assert!(material.two_sided && material.emission.is_none() && doubts.is_empty());
    assert!(
        material.values[2..]
            .iter()
            .all(|value| value.origin == Origin::Default)
    );
}

#[test]
fn without_a_reflectance_the_error_shows_what_to_add() {
    let (library, custom, bare) = (library(""), Custom::default(), Appearance::default());
    let error = sources(&library, &custom, &bare)
        .resolve()
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("object \"Cube\", material \"Wall\" (room.glb)"),
        "{error}"
    );
    assert!(
        error.contains("[material.\"Wall\"]\n    rho = 0.5"),
        "{error}"
    );
}

#[test]
fn a_flux_is_spread_over_its_area() {
    let (library, fields) = (library(""), fields());
    let lamp = Custom {
        emitted: Some(Emitted::Flux(3600.0)),
        ..Custom::default()
    };
    let plain = Custom::default();
    let exitance = |sources: Sources<'_>| sources.resolve().unwrap().0.emission.unwrap().exitance;
    assert!((exitance(sources(&library, &lamp, &fields)) - 1800.0).abs() < 1e-9);
    let carried = Sources {
        object: Some(carrier(&lamp)),
        ..sources(&library, &plain, &fields)
    };
    assert!((exitance(carried) - 7200.0).abs() < 1e-9);
    assert!((exitance(sources(&library, &plain, &fields)) - 3.0).abs() < 1e-15);
}

#[test]
fn the_rim_of_a_lamp_does_not_take_part_in_the_object_s_flux() {
    let (library, fields) = (
        library(""),
        Appearance {
            rho: Some((0.5, "Kd")),
            ..Appearance::default()
        },
    );
    let lamp = Custom {
        emitted: Some(Emitted::Flux(3600.0)),
        ..Custom::default()
    };
    let plain = Custom::default();
    let rim = Sources {
        object: Some(Carrier {
            area: None,
            ..carrier(&lamp)
        }),
        ..sources(&library, &plain, &fields)
    };
    assert_eq!(rim.resolve().unwrap().0.emission, None);
}

#[test]
fn a_state_from_a_property_lies_along_the_object_s_local_x() {
    let fields = fields();
    let state = Custom {
        state: Some([1.0, 0.5, 0.0, 0.0]),
        ..Custom::default()
    };
    let plain = Custom::default();
    let emission = |text: &str| {
        let library = library(text);
        let lamp = Sources {
            object: Some(carrier(&plain)),
            ..sources(&library, &state, &fields)
        };
        lamp.resolve().unwrap().0.emission.unwrap()
    };
    assert!((emission("").state[1] - 0.5).abs() < 1e-15);
    assert_eq!(emission("").axis, DVec3::Y);
    let written = emission("[material.Wall]\nemission_stokes = [1, 0, 1, 0]");
    assert_eq!(
        (written.state, written.axis),
        ([1.0, 0.0, 1.0, 0.0], DVec3::X)
    );
    assert_eq!(
        emission("[material.Wall]\nemission_axis = [0, 0, 2]").axis,
        DVec3::Z
    );
}

#[test]
fn a_doubt_is_told_only_where_its_value_is_in_use() {
    let (none, exact) = (library(""), library("[material.Wall]\nrho = 0.5"));
    let (custom, fields) = (Custom::default(), fields());
    assert_eq!(
        sources(&none, &custom, &fields).resolve().unwrap().1.len(),
        2
    );
    assert_eq!(
        sources(&exact, &custom, &fields).resolve().unwrap().1,
        ["transmits light"]
    );
}

#[test]
fn a_field_out_of_range_is_an_error_unless_another_value_is_given_for_it() {
    let (none, exact) = (library(""), library("[material.Wall]\nrho = 0.5"));
    let custom = Custom::default();
    let glowing = Appearance {
        rho: Some((1.5, "base colour")),
        ..Appearance::default()
    };
    let error = sources(&none, &custom, &glowing)
        .resolve()
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("rho must be a number from 0 to 1, found 1.5 (from base colour)"),
        "{error}"
    );
    assert!(sources(&exact, &custom, &glowing).resolve().is_ok());
}

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
