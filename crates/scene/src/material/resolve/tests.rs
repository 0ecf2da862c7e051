mod kinds;

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
