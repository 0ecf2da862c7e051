//! Sensors that share their walks read what each would read alone.

use crate::experiment::{evaluate, readings, scene};
use malus_estimator::{Answer, Reading, Sharing, run_together};

/// A furnished room with a lamp that the furniture hides in part, and sensors of many kinds near one another: in a corner and
/// in the middle, upright, inside a box, and some that read what `kind` says.
fn room(kind: &str, run: &str) -> String {
    format!(
        "[[shape]]
         kind = 'box'
         min = [0, 0, 0]
         max = [3, 2, 2]
         inward = true
         material = 'wall'
         [[shape]]
         kind = 'box'
         min = [1.2, 0.6, 0.8]
         max = [1.7, 1.6, 1.1]
         material = 'dark'
         [[shape]]
         kind = 'rectangle'
         origin = [0.8, 0.7, 1.99]
         u = [0, 0.6, 0]
         v = [1.2, 0, 0]
         material = 'lamp'
         [material.wall]
         rho = 0.6
         a = 0.2
         n = 1.5
         [material.dark]
         kind = 'coated'
         rho = 0.3
         n = 1.5
         [material.lamp]
         rho = 0.5
         exitance = 10
         [[sensor]]
         name = 'table'
         grid = {{ origin = [0.02, 0.02, 0.7], u = [2.8, 0, 0], v = [0, 1.8, 0], counts = [5, 4] }}
         normal = [0, 0, 1]
         [[sensor]]
         name = 'upright'
         points = [[1.0, 1.0, 0.9], [1.4, 1.0, 0.9], [0.3, 1.9, 1.5]]
         normal = [0.6, -0.8, 0]
         [[sensor]]
         name = 'other'
         points = [[1.1, 0.9, 0.6], [1.5, 1.1, 0.6]]
         {kind}
         [run]
         representation = 'linear'
         {run}"
    )
}

const UPWARDS: &str = "normal = [0, 0, 1]";
const GLANCES: &str = "quantity = 'radiance'\ndirection = [0.2, 0.1, -1]";

/// Asserts that two sets of readings agree, S0 with errors of at most `ceiling`.
fn assert_alike(ones: &[Reading], others: &[Reading], ceiling: f64) {
    assert_eq!(ones.len(), others.len());
    for (sensor, (one, other)) in ones.iter().zip(others).enumerate() {
        assert_eq!(one.enclosed, other.enclosed);
        if one.enclosed {
            continue;
        }
        for component in 0..3 {
            let error = one.standard_error[component].hypot(other.standard_error[component]);
            let (a, b) = (one.stokes[component], other.stokes[component]);
            assert!(
                (a - b).abs() <= 4.5 * error.max(1e-12 * a.abs()),
                "sensor {sensor}, S{component}: {a} and {b}, ± {error}"
            );
            assert!(
                error < ceiling * one.stokes[0],
                "sensor {sensor}: ± {error}"
            );
        }
    }
}

#[test]
fn what_neighbours_share_is_what_each_gathers_alone() {
    let read = |run: &str| readings(&evaluate(&scene(&room(UPWARDS, run))));
    let shared = read("samples = 16384");
    assert!(shared.iter().any(|reading| reading.enclosed));
    assert_alike(
        &shared,
        &read("estimator = 'gather'\nsamples = 65536"),
        2e-2,
    );
}

/// A run that takes its shares from another scene's pilot shares walks as its own sensors can.
#[test]
fn shares_of_another_scene_do_for_sensors_of_another_kind() {
    let base = evaluate(&scene(&room(UPWARDS, "samples = 1024")));
    for kind in [GLANCES, "points = [[1.1, 0.9, 0.6]]\nnormal = [0, 0, -1]"] {
        let kind = match kind {
            GLANCES => room(GLANCES, "samples = 8192"),
            // One sensor fewer.
            _ => room(UPWARDS, "samples = 8192").replace(", [1.5, 1.1, 0.6]]", "]"),
        };
        let other = scene(&kind);
        let sharing = Sharing::Like(&base.allocation);
        let paired = run_together(&[&other], &other.settings, sharing, &mut |_| {
            Answer::Continue
        });
        let mut settings = other.settings.clone();
        settings.seed = 2;
        let alone = malus_estimator::run(&other, &settings, &mut |_| Answer::Continue);
        assert_alike(&readings(&paired.first), &readings(&alone), 3e-2);
    }
}
