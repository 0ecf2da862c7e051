//! More components than a scene requires change nothing, to the bit; fewer are said to be a loss.

use crate::experiment::{evaluate, readings, scene};
use malus_estimator::Reading;
use malus_optics::Representation;
use malus_scene::Scene;

fn room(material: &str, lamp: &str) -> Scene {
    scene(&format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [2, 1, 1]
        inward = true
        material = 'wall'
        [[shape]]
        kind = 'rectangle'
        origin = [0.5, 0.2, 1]
        u = [0, 0.6, 0]
        v = [1, 0, 0]
        material = 'lamp'
        [material.wall]
        rho = 0.5
        {material}
        [material.lamp]
        rho = 0.2
        exitance = 1
        {lamp}
        [[sensor]]
        name = 'floor'
        grid = {{ origin = [0, 0, 0], u = [2, 0, 0], v = [0, 1, 0], counts = [3, 2] }}
        normal = [0, 0, 1]
        [run]
        samples = 4096"
    ))
}

fn forced(
    scene: &Scene,
    representation: Representation,
    estimator: malus_scene::Estimator,
) -> Vec<Reading> {
    let mut settings = scene.settings.clone();
    settings.representation = Some(representation);
    settings.estimator = estimator;
    readings(&malus_estimator::run(scene, &settings, &mut |_| {
        malus_estimator::Answer::Continue
    }))
}

/// Bits of what both readings have, and of the rest where `full` says that it is nothing.
fn assert_same_bits(lesser: &Reading, full: &Reading, components: usize) {
    for i in 0..4 {
        let expected = if i < components { full.stokes[i] } else { 0.0 };
        assert_eq!(lesser.stokes[i].to_bits(), expected.to_bits(), "S{i}");
        let expected = if i < components {
            full.standard_error[i]
        } else {
            0.0
        };
        assert_eq!(
            lesser.standard_error[i].to_bits(),
            expected.to_bits(),
            "standard error of S{i}"
        );
    }
    assert_eq!(lesser.scalar, full.scalar);
}

const BOTH: [malus_scene::Estimator; 2] = [
    malus_scene::Estimator::Gather,
    malus_scene::Estimator::Local,
];

#[test]
fn a_scene_without_polarisation_needs_intensity_and_the_rest_is_zero_to_the_bit() {
    let scene = room("a = 0", "");
    assert_eq!(evaluate(&scene).representation, Representation::Intensity);
    for estimator in BOTH {
        let intensity = forced(&scene, Representation::Intensity, estimator);
        let full = forced(&scene, Representation::Full, estimator);
        for (lesser, full) in intensity.iter().zip(&full) {
            assert_same_bits(lesser, full, 1);
            assert!(
                full.stokes[1..].iter().all(|s| s.abs() == 0.0),
                "{:?}",
                full.stokes
            );
        }
    }
}

#[test]
fn dielectrics_need_linear_and_v_is_zero_to_the_bit() {
    let scene = room("a = 0.6", "emission_stokes = [1, 0.3, 0.2, 0]");
    let results = evaluate(&scene);
    assert_eq!(results.representation, Representation::Linear);
    for estimator in BOTH {
        let linear = forced(&scene, Representation::Linear, estimator);
        let full = forced(&scene, Representation::Full, estimator);
        for (lesser, full) in linear.iter().zip(&full) {
            assert_same_bits(lesser, full, 3);
            assert!(full.stokes[3].abs() == 0.0);
        }
    }
}

#[test]
fn metals_and_circular_light_need_all_four_and_the_reason_names_them() {
    let metal = evaluate(&room("a = 0.6\nn = 0.183\nk = 3.43", ""));
    assert_eq!(metal.representation, Representation::Full);
    assert!(
        metal.representation_reason.contains("wall"),
        "{}",
        metal.representation_reason
    );
    let circular = evaluate(&room("a = 0", "emission_stokes = [1, 0, 0, 0.5]"));
    assert_eq!(circular.representation, Representation::Full);
    assert!(
        circular.representation_reason.contains("lamp"),
        "{}",
        circular.representation_reason
    );
}

/// The scalar model follows the polarised walks, so it does not know how many components they carry.
#[test]
fn intensity_forced_on_a_glossy_scene_is_its_scalar_model() {
    let scene = room("a = 0.6", "");
    let forced = forced(
        &scene,
        Representation::Intensity,
        malus_scene::Estimator::Auto,
    );
    for (intensity, linear) in forced.iter().zip(readings(&evaluate(&scene))) {
        assert_eq!(
            intensity.stokes[0].to_bits(),
            linear.scalar.unwrap().value.to_bits()
        );
    }
}
