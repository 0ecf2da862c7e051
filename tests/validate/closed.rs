//! Closed rooms whose walls emit, and light straight from an area.

use crate::Row;
use malus_estimator::{Answer, Reading, run};
use malus_scene::Scene;

/// Readings of a scene given as text.
pub fn measured(toml: &str) -> Vec<Reading> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, toml).unwrap();
    let scene = Scene::load(&path, &[]).unwrap();
    let results = run(&scene, &scene.settings, &mut |_| Answer::Continue);
    results
        .groups
        .into_iter()
        .flat_map(|group| group.readings)
        .collect()
}

pub fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for rho in [0.5, 0.9] {
        let reading = measured(&format!(
            "[[shape]]
            kind = 'box'
            min = [0, 0, 0]
            max = [1, 1, 1]
            inward = true
            material = 'wall'
            [material.wall]
            rho = {rho}
            exitance = 1
            [[sensor]]
            name = 'corner'
            points = [[0.001, 0.001, 0.001]]
            normal = [0.6, 0, 0.8]
            [run]
            estimator = 'gather'
            samples = 1048576"
        ))[0];
        rows.push(Row {
            what: format!("furnace, ρ = {rho}, a millimetre from a corner"),
            source: "M/(1 − ρ)",
            expected: 1.0 / (1.0 - rho),
            got: reading.stokes[0],
            error: reading.standard_error[0],
            test: "furnace",
        });
    }
    let sphere = measured(
        "[[shape]]
        kind = 'sphere'
        centre = [0, 0, 0]
        radius = 1
        inward = true
        subdivisions = 6
        material = 'wall'
        [material.wall]
        rho = 0.5
        a = 0.6
        exitance = 1
        [[sensor]]
        name = 'centre'
        points = [[0, 0, 0]]
        normal = [0.36, 0.48, 0.8]
        [run]
        estimator = 'gather'
        samples = 4194304",
    )[0];
    // At the centre of a sphere every chain stays at normal incidence, R = 0.04: E = (M + (1 − f)ρ E_wall)/(1 − fR).
    let wall = 1.357_007_9;
    rows.push(Row {
        what: "glossy sphere (n = 1.5, f = 0.6, ρ = 0.5), at its centre".into(),
        source: "A/(1 − (1 − f)ρA) on the wall",
        expected: (1.0 + 0.2 * wall) / (1.0 - 0.6 * 0.04),
        got: sphere.stokes[0],
        error: sphere.standard_error[0],
        test: "furnace",
    });
    let area = measured(&format!(
        "[[shape]]
        kind = 'rectangle'
        origin = [1.5, 1.5, 3]
        u = [0, 1, 0]
        v = [1, 0, 0]
        material = 'lamp'
        [material.lamp]
        rho = 0
        exitance = {}
        [[sensor]]
        name = 'A'
        points = [[2, 0, 2.75]]
        normal = [0, 1, 0]
        [[sensor]]
        name = 'J'
        points = [[2, 1.75, 0]]
        normal = [0, 0, 1]
        [run]
        samples = 1048576",
        1000.0 * std::f64::consts::PI
    ));
    for (reading, (point, expected)) in area.iter().zip([("A", 32.6769), ("J", 105.778)]) {
        rows.push(Row {
            what: format!("CIE 5.3, area source, point {point}"),
            source: "Lambert's polygon formula",
            expected,
            got: reading.stokes[0],
            error: reading.standard_error[0].hypot(5e-6 * expected),
            test: "cie",
        });
    }
    rows
}
