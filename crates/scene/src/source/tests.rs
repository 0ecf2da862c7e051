use super::*;
use crate::document::Node;
use std::f64::consts::PI;

fn read(text: &str) -> Result<Source, String> {
    let node = Node::document(&"room.toml".into(), text).unwrap();
    Source::read("source.0".into(), Field::new("[[source]]".into(), node))
        .map_err(|error| error.to_string())
}

fn spot(cone_deg: f64, blend: f64) -> Distribution {
    let text = format!(
        "kind = \"spot\"\nposition = [0, 0, 2]\ndirection = [0, 0, -1]\nintensity = 1\ncone_deg = {cone_deg}\nblend = {blend}"
    );
    match read(&text).unwrap().kind {
        SourceKind::Point { distribution, .. } => distribution,
        SourceKind::Distant { .. } => panic!("a spot is a point"),
    }
}

/// Midpoint rule over the cosine of the angle from `-z`.
fn integral(distribution: &Distribution) -> f64 {
    let steps = 200_000;
    let sum: f64 = (0..steps)
        .map(|i| {
            let cos = -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(steps);
            distribution.share(DVec3::new((1.0 - cos * cos).sqrt(), 0.0, -cos))
        })
        .sum();
    2.0 * PI * sum * 2.0 / f64::from(steps)
}

#[test]
fn solid_angles_are_the_integrals_of_the_distributions() {
    let cosine = Distribution::Cosine {
        direction: DVec3::NEG_Z,
    };
    for distribution in [
        Distribution::Isotropic,
        cosine,
        spot(50.0, 0.2),
        spot(120.0, 1.0),
    ] {
        let exact = distribution.solid_angle();
        assert!(
            (integral(&distribution) - exact).abs() < 1e-4 * exact,
            "{distribution:?}"
        );
    }
}

#[test]
fn a_spot_is_half_as_bright_in_the_middle_of_its_blend() {
    let outer = libm::cos(25f64.to_radians());
    let middle = outer + 0.1 * (1.0 - outer);
    let towards = DVec3::new((1.0 - middle * middle).sqrt(), 0.0, -middle);
    assert!((spot(50.0, 0.2).share(towards) - 0.5).abs() < 1e-12);
    assert!((spot(50.0, 0.2).share(DVec3::NEG_Z) - 1.0).abs() < 1e-15);
    assert!(spot(50.0, 0.2).share(DVec3::X).abs() < 1e-15);
}

#[test]
fn a_spot_without_blend_has_a_sharp_edge() {
    let sharp = spot(90.0, 0.0);
    let at = |degrees: f64| {
        let angle = degrees.to_radians();
        sharp.share(DVec3::new(libm::sin(angle), 0.0, -libm::cos(angle)))
    };
    assert!((at(44.9) - 1.0).abs() < 1e-15 && at(45.1).abs() < 1e-15);
}

#[test]
fn a_point_is_isotropic_and_unpolarised_unless_told_otherwise() {
    let source = read("kind = \"point\"\nposition = [0, 0, 1]\nintensity = 2").unwrap();
    assert_eq!(format!("{:?}", source.state), "[1.0, 0.0, 0.0, 0.0]");
    assert_eq!(source.axis, DVec3::X);
    assert!((source.flux().unwrap() - 8.0 * PI).abs() < 1e-14);
}

#[test]
fn a_distant_source_has_a_direction_of_length_one_and_no_flux() {
    let source = read("kind = \"distant\"\ndirection = [0, 0, -9]\nirradiance = 5").unwrap();
    let expected = SourceKind::Distant {
        direction: DVec3::NEG_Z,
        irradiance: 5.0,
    };
    assert_eq!(source.kind, expected);
    assert_eq!(source.flux(), None);
}

#[test]
fn every_kind_says_what_it_lacks() {
    for (text, key) in [
        ("", "kind"),
        ("kind = \"point\"\nintensity = 1", "position"),
        ("kind = \"point\"\nposition = [0, 0, 0]", "intensity"),
        ("kind = \"point\"\ndistribution = \"cosine\"", "direction"),
        ("kind = \"spot\"\ndirection = [0, 0, 1]", "cone_deg"),
        ("kind = \"distant\"\ndirection = [0, 0, 1]", "irradiance"),
    ] {
        let error = read(text).unwrap_err();
        assert!(
            error.contains(&format!("lacks the key {key:?}")),
            "{text}: {error}"
        );
    }
}

#[test]
fn a_key_of_another_kind_is_an_error() {
    let error =
        read("kind = \"point\"\nposition = [0, 0, 0]\nintensity = 1\ncone_deg = 50").unwrap_err();
    assert!(
        error.starts_with("room.toml:4:1: ") && error.contains("\"cone_deg\""),
        "{error}"
    );
}

#[test]
fn a_state_that_no_light_has_is_an_error() {
    for state in ["[1, 1, 1, 0]", "[2, 0, 0, 0]", "[1, 0, 0]"] {
        let text =
            format!("kind = \"point\"\nposition = [0, 0, 0]\nintensity = 1\nstokes = {state}");
        let error = read(&text).unwrap_err();
        assert!(error.starts_with("room.toml:4:10: "), "{error}");
    }
}

#[test]
fn negative_intensity_is_an_error() {
    let error = read("kind = \"point\"\nposition = [0, 0, 0]\nintensity = -1").unwrap_err();
    assert!(
        error.contains("a number ≥ 0") && error.contains("found -1"),
        "{error}"
    );
}
