use super::*;
use crate::Mueller;

const GLASS: Index = Index::Relative { n: 1.5, k: 0.0 };

#[test]
fn the_parts_of_a_mixture_are_those_of_eq_21() {
    let material = Material::Mixture {
        rho: 0.5,
        fraction: 0.6,
        index: GLASS,
    };
    let mirror: [[f64; 4]; 4] = Mueller::from(material.mirror(0.6, 0.64)).rows();
    let fresnel: [[f64; 4]; 4] = Mueller::from(GLASS.reflection(0.6, 0.64)).rows();
    for (scaled, plain) in mirror.iter().flatten().zip(fresnel.iter().flatten()) {
        assert_eq!((scaled + 0.0).to_bits(), (0.6 * plain + 0.0).to_bits());
    }
    let arriving = Stokes::<4, Incidence>::new([2.0, 1.0, -1.0, 0.5]);
    let taken = material.scattering() * (material.entering(0.6, 0.64) * arriving);
    assert_eq!(
        material.leaving::<4>(0.3, 0.91) * taken,
        Mueller::<4, Incidence, Emergence>::depolariser(0.4 * 0.5) * arriving
    );
}

/// Every kind of reflector, at settings from none to all.
fn reflectors() -> Vec<Material> {
    let mut all = Vec::new();
    for share in [0.0, 0.3, 1.0] {
        for n in [1.0, 1.0 + 1e-12, 1.5, 10.0, 1e3, f64::INFINITY] {
            all.push(Material::Coated(Coated::new(share, n)));
        }
        for n in [0.5, 1.0, 1.0 + 1e-12, 1.5, 10.0, 1e3, f64::INFINITY] {
            all.push(Material::Pane { n, tau: share });
        }
        for index in [
            GLASS,
            Index::Mirror,
            Index::new(0.5, 0.0),
            Index::new(0.183, 3.43),
        ] {
            for rho in [0.5, 1.0] {
                all.push(Material::Mixture {
                    rho,
                    fraction: share,
                    index,
                });
            }
        }
    }
    all
}

/// cos θ and sin² θ from normal to grazing incidence.
fn angles() -> impl Iterator<Item = (f64, f64)> {
    let cosines = (0..=1000).map(|step| f64::from(step) / 1000.0);
    cosines
        .chain([1e-9, 1e-300])
        .map(|cos| (cos, (1.0 - cos) * (1.0 + cos)))
}

#[test]
fn a_walk_has_probabilities_that_add_up_to_at_most_one() {
    for material in reflectors().into_iter().filter(|it| !it.is_pane()) {
        for (cos, sin2) in angles() {
            let (diffuse, mirror) = (
                material.diffuse_bound(cos, sin2),
                material.mirror(cos, sin2).bound(),
            );
            assert!(diffuse >= 0.0 && mirror >= 0.0, "{material:?} at {cos}");
            assert!(diffuse + mirror <= 1.0 + 1e-15, "{material:?} at {cos}");
        }
    }
}

#[test]
fn no_material_gives_back_more_than_arrives() {
    // For light polarised along s and along p, and so for any: the mean is linear between them.
    for material in reflectors() {
        let hemisphere = match material {
            Material::Coated(coated) => 1.0 - coated.hemispherical_reflectance(),
            _ => 1.0,
        };
        for (cos, sin2) in angles() {
            for q in [1.0, -1.0] {
                let light = Stokes::<4, Incidence>::new([1.0, q, 0.0, 0.0]);
                let sum = (material.mirror(cos, sin2) * light).i()
                    + (material.through(cos, sin2) * light).i()
                    + material.scattering() * hemisphere * (material.entering(cos, sin2) * light);
                assert!(
                    (0.0..=1.0 + 1e-14).contains(&sum),
                    "{sum}: {material:?} at {cos}"
                );
            }
        }
    }
}

#[test]
fn a_walk_scatters_with_the_greatest_share_that_any_light_has() {
    // ρ = 0.3 leaves room: the share of p-polarised light, of which Tp = 1 enters at Brewster's angle.
    let coated = Coated::new(0.3, 1.5);
    let (cos, sin2) = ((1.0 / 3.25f64).sqrt(), 2.25 / 3.25);
    let bound = Material::Coated(coated).diffuse_bound(cos, sin2);
    assert!((bound / coated.returned() - 1.0).abs() < 1e-15);
    // ρ = 1 does not: 1 − Rs = 144/169.
    let bound = Material::Coated(Coated::new(1.0, 1.5)).diffuse_bound(cos, sin2);
    assert!((bound - 144.0 / 169.0).abs() < 1e-15);
}

#[test]
fn only_a_white_or_clear_reflector_loses_nothing() {
    let whole = |share: f64| share >= 1.0;
    for material in reflectors() {
        let expected = match material {
            Material::Mixture {
                rho,
                fraction,
                index,
            } => match index {
                Index::Mirror => whole(rho) || whole(fraction),
                Index::Relative { .. } => whole(rho) && fraction <= 0.0,
            },
            Material::Coated(coated) => whole(coated.rho()) || coated.n().is_infinite(),
            Material::Pane { n, tau } => whole(tau) || n.is_infinite(),
        };
        assert_eq!(material.is_lossless(), expected, "{material:?}");
    }
}

#[test]
fn each_reflector_asks_for_the_components_it_couples() {
    let of = |fraction, n, k| {
        Material::Mixture {
            rho: 0.5,
            fraction,
            index: Index::new(n, k),
        }
        .representation()
    };
    assert_eq!(of(0.0, 0.183, 3.43), Representation::Intensity);
    assert_eq!(of(0.6, 1.5, 0.0), Representation::Linear);
    assert_eq!(of(0.6, f64::INFINITY, 0.0), Representation::Linear);
    assert_eq!(of(0.6, 0.9, 0.0), Representation::Full);
    assert_eq!(of(0.6, 1.5, 1e-3), Representation::Full);
    for (n, expected) in [
        (1.0, Representation::Intensity),
        (1.5, Representation::Linear),
        (f64::INFINITY, Representation::Linear),
    ] {
        let coated = Material::Coated(Coated::new(0.5, n));
        assert_eq!(coated.representation(), expected);
        assert_eq!(coated.polarises_scattering(), n > 1.0);
        let pane = Material::Pane { n, tau: 0.9 };
        assert_eq!(pane.representation(), expected);
        assert!(pane.is_pane() && !pane.polarises_scattering());
    }
    let thin = Material::Pane { n: 0.9, tau: 0.9 };
    assert_eq!(thin.representation(), Representation::Full);
}

#[test]
fn the_diffuse_counterpart_reflects_all_of_rho_and_mirrors_nothing() {
    let diffuse = Material::Mixture {
        rho: 0.5,
        fraction: 0.6,
        index: GLASS,
    }
    .without_fresnel();
    assert_eq!(diffuse.albedo().to_bits(), 0.5f64.to_bits());
    assert_eq!(diffuse.mirror(0.1, 0.99), Reflection::NONE);
    assert_eq!(diffuse.representation(), Representation::Intensity);
}

#[test]
fn the_diffuse_counterpart_of_a_coat_is_its_base_and_that_of_a_pane_itself() {
    let diffuse = Material::Coated(Coated::new(0.7, 1.5)).without_fresnel();
    assert_eq!(diffuse.albedo().to_bits(), 0.7f64.to_bits());
    assert_eq!(diffuse.representation(), Representation::Intensity);
    let pane = Material::Pane { n: 1.5, tau: 0.9 };
    assert_eq!(pane.without_fresnel(), pane);
}
