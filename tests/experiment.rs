//! How a scene is run and held against an exact answer.

use malus_estimator::{Answer, Reading, Results, run};
use malus_scene::Scene;
use std::path::{Path, PathBuf};

/// A scene from the text of its file.
pub fn scene(toml: &str) -> Scene {
    scene_beside(&[], toml)
}

/// The same with other files, by name and text, in its folder.
pub fn scene_beside(files: &[(&str, &str)], toml: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, toml).unwrap();
    Scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs a scene to its end.
pub fn evaluate(scene: &Scene) -> Results {
    run(scene, &scene.settings, &mut |_| Answer::Continue)
}

/// All readings of a run, group after group.
pub fn readings(results: &Results) -> Vec<Reading> {
    results
        .groups
        .iter()
        .flat_map(|group| group.readings.iter().copied())
        .collect()
}

/// Readings of a scene given as text.
pub fn measured(toml: &str) -> Vec<Reading> {
    readings(&evaluate(&scene(toml)))
}

/// Relative error that no standard error tells.
const ROUNDING: f64 = 1e-10;

/// Asserts that an estimate lies within 4.5 standard errors of the exact value, and that the standard error is at most
/// `ceiling` as a share of that value: one bound without the other would let noise pass. Where nothing is left to chance,
/// rounding is: in a corner the horizon cuts emitters within 10⁻¹² of the point, which leaves their form factor 10 digits.
#[track_caller]
pub fn assert_estimate(what: &str, (value, standard_error): (f64, f64), exact: f64, ceiling: f64) {
    let z = (value - exact) / standard_error.max(ROUNDING * exact.abs());
    assert!(
        z.abs() < 4.5,
        "{what}: {value} ± {standard_error}, exactly {exact}: z = {z:.2}"
    );
    let relative = standard_error / exact.abs();
    assert!(
        relative <= ceiling,
        "{what}: relative standard error {relative:.2e} above {ceiling:.1e}"
    );
}

/// Asserts a value that no chance enters.
#[track_caller]
pub fn assert_exact(what: &str, value: f64, exact: f64, relative: f64) {
    assert!(
        (value - exact).abs() <= relative * exact.abs(),
        "{what}: {value}, exactly {exact}, off by {:.1e}",
        (value - exact).abs() / exact.abs()
    );
}

/// S0 of a reading with its standard error.
pub fn s0(reading: &Reading) -> (f64, f64) {
    (reading.stokes[0], reading.standard_error[0])
}

/// A file of this repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A folder of third-party rooms, or `None` with a word that what needs it is skipped.
pub fn third_party(room: &str) -> Option<PathBuf> {
    match std::env::var_os("MALUS_TEST_ROOMS") {
        Some(folder) => Some(Path::new(&folder).join(room)),
        None => {
            eprintln!("skipped: {room} needs MALUS_TEST_ROOMS, a folder of third-party rooms");
            None
        }
    }
}
