//! Empty convex rooms without mirrors: walks that correct a solution of the radiosity equation.

use crate::experiment::{assert_estimate, evaluate, measured, readings, s0, scene, scene_beside};
use malus_estimator::Results;

/// What the program says of such a run.
const CORRECTED: &str = "radiosity";

/// A house: a floor of 4 m by 3 m, walls of 2.2 m and a ridge at 3.4 m, so that two walls have five corners.
const HOUSE: &str = "
v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0
v 0 0 2.2\nv 4 0 2.2\nv 4 3 2.2\nv 0 3 2.2
v 2 0 3.4\nv 2 3 3.4
usemtl floor\nf 1 2 3 4
usemtl wall\nf 1 4 8 5\nf 2 6 7 3\nf 1 5 9 6 2\nf 4 3 7 10 8
usemtl roof\nf 5 8 10 9\nf 6 9 10 7
";

/// A lamp in one of those walls, a carpet that reaches over its edge of the floor, and sensors that face every way.
const FURNISHED: &str = "
    [[mesh]]
    file = 'house.obj'
    up = 'z'
    [[shape]]
    kind = 'rectangle'
    origin = [1.4, 0, 0.8]
    u = [0, 0, 0.7]
    v = [1.1, 0, 0]
    material = 'lamp'
    [[shape]]
    kind = 'rectangle'
    origin = [0.5, 0.4, 0]
    u = [1.7, 0.3, 0]
    v = [-0.2, 1.3, 0]
    material = 'carpet'
    [material.lamp]
    rho = 0.2
    exitance = 1000
    [material.floor]
    rho = 0.4
    [material.carpet]
    rho = 0.1
    [material.wall]
    rho = 0.6
    [material.roof]
    rho = 0.8
    [[sensor]]
    name = 'level'
    points = [[1, 1, 0.8], [2, 2.9, 0.8], [3.9, 0.2, 1.5], [1.2, 0.9, 0]]
    normal = [0, 0, 1]
    [[sensor]]
    name = 'tilted'
    points = [[2, 1.5, 2.2], [0.1, 0.1, 0.1], [2, 1.5, 3.3]]
    normal = [0.3, -0.5, -0.4]
";

fn house(estimator: &str, samples: u64) -> Results {
    let run = format!("[run]\nestimator = '{estimator}'\nsamples = {samples}");
    let toml = format!("{FURNISHED}{run}");
    evaluate(&scene_beside(&[("house.obj", HOUSE)], &toml))
}

#[test]
fn a_house_with_a_carpet_agrees_with_walks_alone() {
    let corrected = house("auto", 16_384);
    assert!(corrected.estimator_reason.contains(CORRECTED));
    let walked = readings(&house("gather", 524_288));
    for (reading, walked) in readings(&corrected).iter().zip(walked) {
        let ((value, error), (exact, of_exact)) = (s0(reading), s0(&walked));
        assert!(of_exact < 4e-3 * exact, "{exact} ± {of_exact}");
        assert!(error < 2e-3 * value, "{value} ± {error}");
        let together = (value, error.hypot(of_exact));
        assert_estimate("house", together, exact, 4e-3);
    }
}

fn cube(rho: f64, rest: &str) -> String {
    format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [material.wall]
        rho = {rho}
        {rest}"
    )
}

/// Where all walls send off 1 and all that they scatter is the same, nothing is left to correct: 1/(1 − ρ).
#[test]
fn a_furnace_is_even_to_the_last_digits() {
    let inside = "exitance = 1
        [[sensor]]
        name = 'inside'
        points = [[0.5, 0.5, 0.5], [0.01, 0.5, 0.5], [0.001, 0.001, 0.001], [0.3, 0.6, 1e-12], [0.2, 5e-10, 0]]
        normal = [0.1, 0.0, 0.8]
        [run]
        samples = 4096";
    for rho in [0.1, 0.5, 0.9, 0.99] {
        for reading in measured(&cube(rho, inside)) {
            let (value, error) = s0(&reading);
            assert_estimate("furnace", (value, error), 1.0 / (1.0 - rho), 1e-9);
            // What is left is rounding, and said to be no less.
            assert!(error > 0.99e-10 * value, "{value} ± {error}");
        }
    }
}

/// A small lamp in the ceiling, at that distance from two of the walls.
fn lamp_at(distance: f64) -> String {
    let rest = format!(
        "[[shape]]
        kind = 'rectangle'
        origin = [{distance}, {distance}, 1]
        u = [0, 0.05, 0]
        v = [0.05, 0, 0]
        material = 'lamp'
        [material.lamp]
        rho = 0
        exitance = 1
        [[sensor]]
        name = 'floor'
        points = [[0.5, 0.5, 0], [0.1, 0.2, 0]]
        normal = [0, 0, 1]
        [run]
        samples = 65536"
    );
    cube(0.5, &rest)
}

#[test]
fn light_too_uneven_for_tiles_is_found_by_walks_from_the_emitters() {
    let reason = |toml: &str| evaluate(&scene(toml)).estimator_reason;
    assert!(reason(&lamp_at(0.45)).contains(CORRECTED));
    assert!(!reason(&lamp_at(0.01)).contains(CORRECTED));
    let block = "[[shape]]
        kind = 'box'
        min = [0.2, 0.2, 0]
        max = [0.4, 0.4, 0.3]
        material = 'wall'
        [material.lamp]";
    let furnished = lamp_at(0.45).replace("[material.lamp]", block);
    assert!(!reason(&furnished).contains(CORRECTED));
    let polished = lamp_at(0.45).replace("rho = 0.5", "rho = 0.5\na = 0.1");
    assert!(!reason(&polished).contains(CORRECTED));
}
