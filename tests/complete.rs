//! Every technique weighed against every other: `auto` against plain `gather`, reciprocity and thermal equilibrium.

mod alike;
mod lamps;
mod sources;

use crate::experiment::{assert_estimate, evaluate, measured, readings, s0, scene};
use alike::room;
use std::f64::consts::PI;

/// A black lamp of exitance M and reflectors that lose nothing, or Lambert surfaces that emit (1 − ρ)M: the light is that of a
/// cavity in equilibrium, M from every side and of no polarisation, whatever stands where.
#[test]
fn light_in_equilibrium_is_the_same_everywhere() {
    let cavity = "
        [[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'coated'
        [[shape]]
        kind = 'rectangle'
        origin = [0, 0, 0.001]
        u = [1, 0, 0]
        v = [0, 1, 0]
        material = 'warm'
        [[shape]]
        kind = 'rectangle'
        origin = [0.001, 0.1, 0.1]
        u = [0, 0.5, 0]
        v = [0, 0, 0.8]
        material = 'mirror'
        [[shape]]
        kind = 'rectangle'
        origin = [0.5, 0.1, 0.2]
        u = [0.1, 0.7, 0]
        v = [0, 0.1, 0.6]
        material = 'pane'
        [[shape]]
        kind = 'box'
        min = [0.7, 0.6, 0.3]
        max = [0.9, 0.8, 0.5]
        material = 'black'
        [material.coated]
        kind = 'coated'
        rho = 1
        n = 1.5
        [material.warm]
        rho = 0.6
        exitance = 0.8
        [material.mirror]
        rho = 1
        a = 0.7
        n = inf
        [material.pane]
        kind = 'pane'
        n = 1.6
        [material.black]
        rho = 0
        exitance = 2
        [[sensor]]
        name = 'irradiance'
        points = [[0.2, 0.5, 0.5], [0.52, 0.45, 0.5], [0.003, 0.99, 0.4], [0.5, 0.5, 0.999]]
        normal = [0.6, 0, -0.8]
        [[sensor]]
        name = 'radiance'
        quantity = 'radiance'
        points = [[0.2, 0.5, 0.5], [0.9, 0.1, 0.1]]
        direction = [0.5, -0.3, 0.2]";
    for (estimator, samples) in [("auto", 16_384), ("gather", 32_768)] {
        let run = format!(
            "[run]\nestimator = '{estimator}'\nrepresentation = 'full'\nsamples = {samples}"
        );
        for (i, reading) in measured(&format!("{cavity}\n{run}")).iter().enumerate() {
            let share = if i < 4 { 1.0 } else { 1.0 / PI };
            let what = format!("{estimator}, sensor {i}");
            assert_estimate(&what, s0(reading), 2.0 * share, 1e-2);
            for c in 1..4 {
                let (value, error) = (reading.stokes[c], reading.standard_error[c]);
                assert!(
                    value.abs() <= 4.5 * error,
                    "{what}: S{c} = {value} ± {error}"
                );
                assert!(
                    error < 1e-2 * 2.0 * share,
                    "{what}: S{c} = {value} ± {error}"
                );
            }
        }
    }
}

/// Helmholtz: of two equal black patches each sends the other as much, by way of all there is: metal walls, a coated floor,
/// a pane, a ball of mirrors that none looks into.
#[test]
fn two_patches_send_each_other_the_same() {
    let patches = [
        (
            "[0.2, 0.3, 1]",
            "[0, 0.12, 0]",
            "[0.12, 0, 0]",
            "[0, 0, -1]",
        ),
        (
            "[1, 0.55, 0.35]",
            "[0, 0, 0.12]",
            "[0, 0.12, 0]",
            "[-1, 0, 0]",
        ),
    ];
    let received = |from: usize| {
        let shapes: String = patches
            .iter()
            .enumerate()
            .map(|(index, (origin, u, v, _))| {
                let exitance = if index == from { 1 } else { 0 };
                format!(
                    "[[shape]]
                    kind = 'rectangle'
                    origin = {origin}
                    u = {u}
                    v = {v}
                    material = 'patch{index}'
                    [material.patch{index}]
                    rho = 0
                    exitance = {exitance}\n"
                )
            })
            .collect();
        let (origin, u, v, normal) = &patches[1 - from];
        let results = evaluate(&scene(&format!(
            "[[shape]]
            kind = 'box'
            min = [0, 0, 0]
            max = [1, 1, 1]
            inward = true
            material = 'wall'
            [material.wall]
            rho = 0.5
            a = 0.6
            n = 0.183
            k = 3.43
            [[shape]]
            kind = 'rectangle'
            origin = [0, 0, 0]
            u = [1, 0, 0]
            v = [0, 1, 0]
            material = 'floor'
            [material.floor]
            kind = 'coated'
            rho = 0.7
            n = 1.5
            [[shape]]
            kind = 'rectangle'
            origin = [0.6, 0.1, 0.1]
            u = [0.1, 0.8, 0]
            v = [-0.1, 0, 0.7]
            material = 'pane'
            [material.pane]
            kind = 'pane'
            n = 1.7
            tau = 0.8
            [[shape]]
            kind = 'sphere'
            centre = [0.35, 0.7, 0.3]
            radius = 0.15
            subdivisions = 2
            material = 'ball'
            [material.ball]
            rho = 0.2
            a = 0.9
            n = 3
            {shapes}
            [[sensor]]
            name = 'patch'
            grid = {{ origin = {origin}, u = {u}, v = {v}, counts = [3, 3] }}
            normal = {normal}
            [run]
            compare = ['scalar']
            samples = 2048"
        )));
        let group = &results.groups[0];
        (group.mean, group.mean_standard_error, group.scalar.unwrap())
    };
    let (one, other) = (received(0), received(1));
    let z = (one.0 - other.0) / one.1.hypot(other.1);
    assert!(z.abs() < 4.5, "{one:?} {other:?}: z = {z:.2}");
    assert!(
        one.1 < 2e-2 * one.0 && other.1 < 2e-2 * other.0,
        "{one:?} {other:?}"
    );
    let errors = [one.2, other.2].map(|it| it.difference_standard_error);
    let z = (one.2.difference - other.2.difference) / errors[0].hypot(errors[1]);
    assert!(z.abs() < 4.5, "{one:?} {other:?}: z = {z:.2}");
}

/// A source without size is what a tiny ball of the same intensity is.
#[test]
fn a_point_source_is_a_tiny_ball() {
    // A ball of radius r has the radiance M/π and the outline π r²: the intensity M r² to every side.
    let radius: f64 = 0.02;
    let exitance = 0.4 / (radius * radius);
    let ball = format!(
        "[[shape]]
        kind = 'sphere'
        centre = [0.62, 0.44, 0.7]
        radius = {radius}
        subdivisions = 4
        material = 'ball'
        [material.ball]
        rho = 0
        exitance = {exitance}"
    );
    let source = "[[source]]
        kind = 'point'
        position = [0.62, 0.44, 0.7]
        intensity = 0.4";
    let dark = room("rho = 0.5\na = 0.6\nn = 1.8").replace("exitance = 5", "exitance = 0");
    let by = |light: &str, estimator: &str, samples: u64| {
        measured(&format!(
            "{dark}
            {light}
            [run]
            estimator = '{estimator}'
            samples = {samples}"
        ))
    };
    let balls = by(&ball, "gather", 262_144);
    for (one, other) in by(source, "auto", 32_768).iter().zip(balls) {
        for c in 0..3 {
            // The ball covers less than a thousandth of what is seen, hides as much, and is a polyhedron.
            let model = 1.5e-3 * other.stokes[0];
            let error = one.standard_error[c].hypot(other.standard_error[c]);
            let z = (one.stokes[c] - other.stokes[c]) / error.hypot(model);
            assert!(z.abs() < 4.5, "S{c}: {one:?} {other:?}: z = {z:.2}");
            assert!(error < 3e-2 * other.stokes[0], "S{c}: {error}");
        }
    }
}

#[test]
fn every_technique_at_once_gives_the_same_bits_on_any_number_of_threads() {
    let pane = "
        [[shape]]
        kind = 'rectangle'
        origin = [0.1, 0.1, 0.5]
        u = [0.5, 0, 0.1]
        v = [0, 0.6, 0]
        material = 'pane'
        [material.pane]
        kind = 'pane'
        n = 1.5
        tau = 0.9
        [[shape]]
        kind = 'sphere'
        centre = [0.7, 0.7, 0.2]
        radius = 0.1
        subdivisions = 2
        material = 'coated'
        [material.coated]
        kind = 'coated'
        rho = 0.7
        n = 1.5
        [[source]]
        kind = 'point'
        position = [0.3, 0.3, 0.3]
        intensity = 0.2
        stokes = [1, 0.2, 0.3, 0.4]
        [[source]]
        kind = 'distant'
        direction = [0.1, 0.2, -1]
        irradiance = 1
        [[sensor]]
        name = 'sight'
        quantity = 'radiance'
        points = [[0.5, 0.5, 0.3]]
        direction = [0.4, 0.3, -0.2]
        [run]
        representation = 'full'
        compare = ['scalar', 'diffuse']
        samples = 2048";
    let scene = scene(&(room("rho = 0.5\na = 0.6\nn = 0.9") + pane));
    let bits = |threads: usize| -> Vec<u64> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let readings = pool.unwrap().install(|| readings(&evaluate(&scene)));
        let all = readings.iter().flat_map(|r| {
            let paired = [r.scalar, r.diffuse].into_iter().flatten();
            let paired = paired.flat_map(|p| [p.value, p.difference, p.difference_standard_error]);
            let own = r.stokes.into_iter().chain(r.standard_error);
            own.chain([r.dolp])
                .chain(paired)
                .map(f64::to_bits)
                .collect::<Vec<_>>()
        });
        all.collect()
    };
    let one = bits(1);
    assert_eq!(one, bits(2));
    assert_eq!(one, bits(5));
}
