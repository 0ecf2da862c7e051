//! Sensors of radiance, looking at a lamp, at a wall, by a mirror and through a pane.

use crate::coats::ROOM;
use crate::experiment::{assert_estimate, assert_exact, measured, s0};
use crate::images::assert_stokes;
use glam::DVec3;
use malus_estimator::Reading;
use malus_optics::{Basis, Coated, Emergence, Incidence, Index, Material, Rotator, Sensor, Stokes};
use std::f64::consts::PI;

/// What the sensors of a scene read, the last of which looks from a point along a direction.
fn sights(scene: &str, at: &str, direction: DVec3, samples: u64) -> Vec<Reading> {
    let vector = |it: DVec3| format!("[{}, {}, {}]", it.x, it.y, it.z);
    measured(&format!(
        "{scene}
        [[sensor]]
        name = 'sight'
        quantity = 'radiance'
        points = [{at}]
        direction = {}
        axis = {}
        [run]
        representation = 'full'
        samples = {samples}",
        vector(direction),
        vector(AXIS)
    ))
}

/// The same where there is no other sensor.
fn sight(scene: &str, at: &str, direction: DVec3, samples: u64) -> Reading {
    sights(scene, at, direction, samples)[0]
}

const PANEL: &str = "
    [[shape]]
    kind = 'rectangle'
    origin = [-9, -9, 3]
    u = [0, 18, 0]
    v = [18, 0, 0]
    material = 'lamp'
    [material.lamp]
    rho = 0
    exitance = 7
    emission_stokes = [1, 0.4, -0.5, 0.6]
    emission_axis = [0.6, 0.8, 0]
";

const AXIS: DVec3 = DVec3::new(0.2, 1.0, 0.4);

#[test]
fn a_radiance_looks_straight_at_a_lamp() {
    let looking = DVec3::new(0.2, -0.3, 1.0).normalize();
    let reading = sight(PANEL, "[0, 0, 0]", looking, 64);
    let emitted = Basis::<malus_optics::Carried>::new(-looking, DVec3::new(0.6, 0.8, 0.0));
    let sensor = Basis::<Sensor>::new(-looking, AXIS);
    let light = Rotator::new(&emitted, &sensor) * Stokes::<4, _>::new([1.0, 0.4, -0.5, 0.6]);
    let exact = light.components().map(|c| c * 7.0 / PI);
    // The standard error holds a walk that has met nothing yet, but the value does not depend on chance.
    for (c, exact) in exact.iter().enumerate() {
        assert!(
            (reading.stokes[c] - exact).abs() < 1e-13,
            "{reading:?} {exact:?}"
        );
    }
}

#[test]
fn a_radiance_looks_at_a_lamp_in_a_mirror_at_brewsters_angle() {
    let flats = [
        Material::Mixture {
            rho: 0.0,
            fraction: 1.0,
            index: Index::new(1.5, 0.0),
        },
        Material::Mixture {
            rho: 0.0,
            fraction: 1.0,
            index: Index::new(0.183, 3.43),
        },
        Material::Coated(Coated::new(0.0, 1.5)),
    ];
    let texts = [
        "rho = 0\na = 1\nn = 1.5",
        "rho = 0\na = 1\nn = 0.183\nk = 3.43",
        "kind = 'coated'\nrho = 0\nn = 1.5",
    ];
    for (material, text) in flats.iter().zip(texts) {
        let floor = format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [-5, -5, 0]
            u = [10, 0, 0]
            v = [0, 10, 0]
            material = 'floor'
            [material.floor]
            {text}"
        );
        // tan θ = 1.5.
        let looking = DVec3::new(1.5 * 0.8, 1.5 * 0.6, -1.0).normalize();
        let scene = format!("{PANEL}{floor}");
        let reading = sight(&scene, "[-0.8, -0.6, 0.6]", looking, 262_144);
        let down = DVec3::new(-looking.x, -looking.y, looking.z);
        let lamp = Basis::<malus_optics::Carried>::new(down, DVec3::new(0.6, 0.8, 0.0));
        let light = Stokes::<4, _>::new([1.0, 0.4, -0.5, 0.6]);
        let (cos, sin2) = malus_optics::angle_of_incidence(down, DVec3::Z);
        let (incidence, emergence) = Basis::<Incidence>::mirror(down, DVec3::Z);
        let mirrored = material.mirror(cos, sin2) * (Rotator::new(&lamp, &incidence) * light);
        let sensor = Basis::<Sensor>::new(-looking, AXIS);
        let light = Rotator::new(&emergence.carried(), &sensor) * mirrored.carried();
        let exact = light.components().map(|c| c * 7.0 / PI);
        assert_stokes(text, &reading, exact, 1e-9, 2e-2);
    }
}

#[test]
fn a_radiance_looks_at_a_lamp_through_a_pane() {
    let sheet = "[[shape]]
        kind = 'rectangle'
        origin = [-5, -5, 1.6]
        u = [10, 1, 1]
        v = [0, 10, 0]
        material = 'pane'
        [material.pane]
        kind = 'pane'
        n = 1.7
        tau = 0.9\n";
    let looking = DVec3::new(1.2, 0.5, 1.0).normalize();
    let scene = format!("{PANEL}{sheet}");
    let reading = sight(&scene, "[-0.8, -0.6, 0.6]", looking, 65_536);
    let lamp = Basis::<malus_optics::Carried>::new(-looking, DVec3::new(0.6, 0.8, 0.0));
    let light = Stokes::<4, _>::new([1.0, 0.4, -0.5, 0.6]);
    let normal = DVec3::new(10.0, 1.0, 1.0).cross(DVec3::Y).normalize();
    let (cos, sin2) = malus_optics::angle_of_incidence(-looking, normal);
    let (incidence, _) = Basis::<Incidence>::mirror(-looking, normal);
    let through = Material::Pane { n: 1.7, tau: 0.9 }.through(cos, sin2);
    let passed = through * (Rotator::new(&lamp, &incidence) * light);
    let onward = Basis::<Emergence>::new(-looking, incidence.axis()).carried();
    let light = Rotator::new(&onward, &Basis::<Sensor>::new(-looking, AXIS)) * passed.carried();
    let exact = light.components().map(|c| c * 7.0 / PI);
    assert_stokes("pane", &reading, exact, 1e-9, 2e-2);
}

/// L = ρ E/π with E from a sensor on the same place of the wall.
#[test]
fn a_radiance_looks_at_a_lambert_wall() {
    let walls = "
        [material.wall]
        rho = 0.6
        [material.table]
        rho = 0.8
        a = 0.6
        n = 2
        [[sensor]]
        name = 'wall'
        points = [[0, 0.5, 0.5]]
        normal = [1, 0, 0]";
    let looking = DVec3::new(-0.5, 0.1, 0.2);
    let text = format!("{ROOM}{walls}");
    let readings = sights(&text, "[0.5, 0.4, 0.3]", looking, 131_072);
    let (wall, sight) = (&readings[2], &readings[3]);
    let factor = 0.6 / PI;
    let (l, error) = s0(sight);
    let error = error.hypot(factor * wall.standard_error[0]);
    assert_estimate("L", (l, error), factor * wall.stokes[0], 1e-2);
    // What Lambert's law scatters has no polarisation.
    for c in 1..4 {
        assert_exact("S", sight.stokes[c], 0.0, 0.0);
    }
}
