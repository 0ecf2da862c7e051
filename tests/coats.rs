//! Diffusers under a clear coat, against closed forms.

use crate::experiment::{assert_estimate, measured, s0};
use crate::images::assert_stokes;
use glam::DVec3;
use malus_estimator::Reading;
use malus_optics::{Basis, Emergence, Incidence, Index, Rotator, Sensor, Stokes};
use std::f64::consts::FRAC_1_PI;

/// Rs and Rp of an uncoated face.
fn reflectances(n: f64, mu: f64) -> (f64, f64) {
    let face = Index::new(n, 0.0).reflection(mu, (1.0 - mu) * (1.0 + mu));
    (face.rs(), face.rp())
}

/// ∫₀¹ f dμ by the midpoint rule in μ = x², which flattens what is steep at grazing angles.
fn over_cosines(f: impl Fn(f64) -> f64) -> f64 {
    let count = 20_000;
    let cell = |i: i32| {
        let x = (f64::from(i) + 0.5) / f64::from(count);
        f(x * x) * 2.0 * x / f64::from(count)
    };
    (0..count).map(cell).sum()
}

/// ρ/(n² (1 − ρ r_i)) and the share that enters, 1 − r_e, by quadrature.
fn kernel(rho: f64, n: f64) -> (f64, f64) {
    let entered = over_cosines(|mu| {
        let (rs, rp) = reflectances(n, mu);
        (2.0 - rs - rp) * mu
    });
    let inside = 1.0 - entered / (n * n);
    (rho / (n * n * (1.0 - rho * inside)), entered)
}

/// A sphere that emits M from its coated wall. A chord meets the wall at one angle at either end and in one plane, so for each
/// polarisation L_j = M/2π + R_j L_j + s T_j Φ/2π, with Φ = M/(1 − s(1 − r_e)) the diffuse flux that enters the coat:
/// E = M ∫ μ (1/Ts + 1/Tp) dμ + sΦ, and S1 = M ∫ μ (1/Ts − 1/Tp) dμ about the planes of incidence.
#[test]
fn a_coated_sphere_that_emits_has_its_exact_answer() {
    let (rho, n) = (0.6, 1.5);
    let count = 24;
    let (positions, triangles) = malus_geometry::shape::sphere(DVec3::ZERO, 1.0, true, 7);
    let stride = triangles.len() / count;
    let sensors: String = (0..count)
        .map(|i| {
            let [a, b, c] = triangles[i * stride + 7].map(|v| positions[v as usize]);
            let (p, m) = ((a + b + c) / 3.0, (b - a).cross(c - a));
            format!(
                "[[sensor]]\nname = 's{i}'\npoints = [[{}, {}, {}]]\nnormal = [{}, {}, {}]\n",
                p.x, p.y, p.z, m.x, m.y, m.z
            )
        })
        .collect();
    let readings = measured(&format!(
        "[[shape]]
        kind = 'sphere'
        centre = [0, 0, 0]
        radius = 1
        inward = true
        subdivisions = 7
        material = 'wall'
        [material.wall]
        kind = 'coated'
        rho = {rho}
        n = {n}
        exitance = 1
        {sensors}
        [run]
        samples = 65536"
    ));
    // Walks from the wall are common to all points, so the error of the mean is up to the mean of the errors.
    let mean = |of: &dyn Fn(&Reading) -> (f64, f64)| {
        let parts = readings.iter().map(of);
        let (sum, errors) = parts.fold((0.0, 0.0), |(sum, errors), (value, error)| {
            (sum + value, errors + error)
        });
        (sum / count as f64, errors / count as f64)
    };
    let (scale, entered) = kernel(rho, n);
    let scattered = scale / (1.0 - scale * entered);
    let of = |sign: f64| {
        over_cosines(|mu| {
            let (rs, rp) = reflectances(n, mu);
            mu * (1.0 / (1.0 - rs) + sign / (1.0 - rp))
        })
    };
    // Facets end chains at grazing angles: five subdivisions make E low by 3.9e-3, seven by less than a fifth of that.
    let (value, error) = mean(&s0);
    let exact = of(1.0) + scattered;
    assert_estimate("E", (value, error.hypot(3e-4 * exact)), exact, 1e-3);
    let (value, error) = mean(&|r| (r.stokes[1], r.standard_error[1]));
    assert_estimate("S1", (value, error.hypot(3e-4 * exact)), of(-1.0), 1e-2);
    let scalar = over_cosines(|mu| {
        let (rs, rp) = reflectances(n, mu);
        4.0 * mu / (2.0 - rs - rp)
    });
    let (value, error) = mean(&|r| r.scalar.map(|s| (s.value, s.standard_error)).unwrap());
    let exact = scalar + scattered;
    assert_estimate("scalar", (value, error.hypot(3e-4 * exact)), exact, 1e-3);
}

/// A coated plane without end, or so, in parallel light; `sensors` read it.
fn lit_plane(
    rho: f64,
    n: f64,
    from: DVec3,
    state: [f64; 4],
    sensors: &str,
    samples: u64,
) -> Vec<Reading> {
    let DVec3 { x, y, z } = -from;
    measured(&format!(
        "[[shape]]
        kind = 'rectangle'
        origin = [-500, -500, 0]
        u = [1000, 0, 0]
        v = [0, 1000, 0]
        material = 'coat'
        [material.coat]
        kind = 'coated'
        rho = {rho}
        n = {n}
        [[source]]
        kind = 'distant'
        direction = [{x}, {y}, {z}]
        irradiance = 3
        stokes = {state:?}
        axis = [0.3, 0.8, 0.1]
        {sensors}
        [run]
        representation = 'full'
        samples = {samples}"
    ))
}

/// K cos θᵢ **t**ᵢ·**S**: what enters the coat.
fn entering(n: f64, from: DVec3, state: [f64; 4]) -> f64 {
    let (rs, rp) = reflectances(n, from.z);
    let (incidence, _) = Basis::<Incidence>::mirror(-from, DVec3::Z);
    let carried = Basis::<malus_optics::Carried>::new(-from, DVec3::new(0.3, 0.8, 0.1));
    let arriving = Rotator::new(&carried, &incidence) * Stokes::<4, _>::new(state);
    let [i, q, ..] = arriving.components();
    3.0 * from.z * ((1.0 - (rs + rp) / 2.0) * i - (rs - rp) / 2.0 * q)
}

#[test]
fn a_coated_plane_in_parallel_light_has_its_radiance() {
    let state = [1.0, 0.6, -0.5, 0.4];
    for (from, looking) in [
        (DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.48, 0.6, -0.64)),
        (DVec3::new(-0.8, 0.52, 0.3), DVec3::new(0.9, 0.3, -0.2)),
    ] {
        let (from, looking) = (from.normalize(), looking.normalize());
        for n in [1.0, 1.5, 2.5] {
            let sensor = format!(
                "[[sensor]]
                name = 'sight'
                quantity = 'radiance'
                points = [[0, 0, 2]]
                direction = [{}, {}, {}]
                axis = [0.5, 0.1, 0.7]",
                looking.x, looking.y, looking.z
            );
            let reading = lit_plane(0.7, n, from, state, &sensor, 65_536)[0];
            let (rs, rp) = reflectances(n, -looking.z);
            let (scale, _) = kernel(0.7, n);
            let radiance = entering(n, from, state) * scale * FRAC_1_PI;
            let column = [1.0 - (rs + rp) / 2.0, -(rs - rp) / 2.0, 0.0, 0.0];
            // x along the s axis, across the plane of emergence.
            let leaving = Basis::<Emergence>::new(-looking, looking.cross(DVec3::Z)).carried();
            let sensor = Basis::<Sensor>::new(-looking, DVec3::new(0.5, 0.1, 0.7));
            let light = Rotator::new(&leaving, &sensor) * Stokes::<4, _>::new(column);
            let exact = light.components().map(|c| c * radiance);
            assert_stokes(&format!("n = {n}"), &reading, exact, 1e-6, 1e-2);
        }
    }
}

/// Facing the plane: E = K cos θᵢ t·S ρ′ of the scattered light, ρ′ = s (1 − r_e), with S1 = s ∫ 2μ t₁ dμ about the planes of
/// incidence, and the mirrored sun.
#[test]
fn a_coated_plane_in_parallel_light_gives_its_irradiance() {
    let state = [1.0, 0.0, 0.0, 0.0];
    let from = DVec3::new(0.6, 0.0, 0.8);
    for n in [1.2, 1.5] {
        let sensor = "[[sensor]]
            name = 'down'
            points = [[0, 0, 0.2]]
            normal = [0, 0, -1]";
        let reading = lit_plane(0.7, n, from, state, sensor, 131_072)[0];
        let (scale, entered) = kernel(0.7, n);
        let inside = entering(n, from, state);
        let polarised = over_cosines(|mu| {
            let (rs, rp) = reflectances(n, mu);
            -mu * (rs - rp)
        });
        let (rs, rp) = reflectances(n, 0.8);
        let exact = [
            inside * scale * entered + 3.0 * 0.8 * (rs + rp) / 2.0,
            inside * scale * polarised + 3.0 * 0.8 * (rs - rp) / 2.0,
            0.0,
            0.0,
        ];
        assert_stokes(&format!("n = {n}"), &reading, exact, 1e-6, 1e-2);
    }
}

/// A room with a table, seen by two sensors; its materials are still to be said.
pub const ROOM: &str = "
    [[shape]]
    kind = 'box'
    min = [0, 0, 0]
    max = [1, 1, 1]
    inward = true
    material = 'wall'
    [[shape]]
    kind = 'rectangle'
    origin = [0.1, 0.1, 0.05]
    u = [0.8, 0, 0]
    v = [0, 0.8, 0]
    material = 'table'
    [[shape]]
    kind = 'rectangle'
    origin = [0.35, 0.3, 0.98]
    u = [0, 0.3, 0]
    v = [0.3, 0, 0]
    material = 'lamp'
    [material.lamp]
    rho = 0.2
    exitance = 5
    emission_stokes = [1, 0.4, -0.5, 0.6]
    emission_axis = [0.6, 0.8, 0]
    [[sensor]]
    name = 'up'
    points = [[0.5, 0.4, 0.3], [0.9, 0.2, 0.4]]
    normal = [0, 0, 1]
    frame = 'fixed'
";

fn room(materials: &str, estimator: &str, samples: u64) -> Vec<Reading> {
    measured(&format!(
        "{ROOM}
        {materials}
        [run]
        estimator = '{estimator}'
        representation = 'full'
        compare = ['scalar', 'diffuse']
        samples = {samples}"
    ))
}

fn assert_same(what: &str, one: &[Reading], other: &[Reading], ceiling: f64) {
    for (i, (a, b)) in one.iter().zip(other).enumerate() {
        let parts = |r: &Reading| {
            let (scalar, diffuse) = (r.scalar.unwrap(), r.diffuse.unwrap());
            let stokes = (0..4).map(|c| (r.stokes[c], r.standard_error[c]));
            let differences = [
                (scalar.difference, scalar.difference_standard_error),
                (diffuse.difference, diffuse.difference_standard_error),
            ];
            stokes.chain(differences).collect::<Vec<_>>()
        };
        for (part, (p, q)) in parts(a).into_iter().zip(parts(b)).enumerate() {
            let error = p.1.hypot(q.1);
            let z = (p.0 - q.0) / error.max(1e-12 * b.stokes[0]);
            assert!(
                z.abs() < 4.5 && error < ceiling * b.stokes[0],
                "{what}, sensor {i}, part {part}: {p:?} against {q:?}: z = {z:.2}"
            );
        }
    }
}

/// The sensors look up at Lambert walls, so that walks from the lamp joined to them lose nothing either.
#[test]
fn a_coated_table_is_the_same_by_three_estimators() {
    let materials = "
        [material.wall]
        rho = 0.6
        [material.table]
        kind = 'coated'
        rho = 0.8
        n = 1.7";
    let auto = room(materials, "auto", 65_536);
    assert_same("gather", &auto, &room(materials, "gather", 131_072), 1e-2);
    assert_same("local", &auto, &room(materials, "local", 524_288), 1e-2);
}

#[test]
fn a_coated_room_is_the_same_by_both_estimators() {
    let materials = "
        [material.wall]
        kind = 'coated'
        rho = 0.7
        n = 1.6
        [material.table]
        kind = 'coated'
        rho = 0.9
        n = 2.5";
    assert_same(
        "coated",
        &room(materials, "auto", 65_536),
        &room(materials, "gather", 131_072),
        2e-2,
    );
}

#[test]
fn a_coat_of_the_rooms_own_index_is_none() {
    let of = |material: &str| {
        let text = format!("[material.wall]\n{material}\n[material.table]\n{material}");
        room(&text, "auto", 8192)
    };
    let (bare, coated) = (of("rho = 0.6"), of("kind = 'coated'\nrho = 0.6\nn = 1"));
    for (a, b) in bare.iter().zip(&coated) {
        for c in 0..4 {
            assert!(
                (a.stokes[c] - b.stokes[c]).abs() < 1e-12 * a.stokes[0],
                "{a:?} {b:?}"
            );
        }
    }
}

/// White coats lose nothing, so what a black lamp sends off returns to it: M everywhere, of no polarisation.
#[test]
fn white_coats_return_all_light_to_the_lamp() {
    let materials = "
        [material.wall]
        kind = 'coated'
        rho = 1
        n = 1.5
        [material.table]
        kind = 'coated'
        rho = 1
        n = 3";
    let black = ROOM
        .replace("rho = 0.2", "rho = 0")
        .replace("[1, 0.4, -0.5, 0.6]", "[1, 0, 0, 0]");
    let whole = [5.0, 0.0, 0.0, 0.0];
    // Flush with the ceiling the lamp has no back, and a large one soon gets its light back.
    let flush = black.replace("[0.35, 0.3, 0.98]", "[0.1, 0.1, 1]").replace(
        "u = [0, 0.3, 0]\n    v = [0.3, 0, 0]",
        "u = [0, 0.8, 0]\n    v = [0.8, 0, 0]",
    );
    let readings = measured(&format!(
        "{flush}
        {materials}
        [run]
        representation = 'full'
        samples = 16384"
    ));
    for reading in &readings {
        assert_stokes("flush", reading, whole, 0.0, 2e-2);
    }
}
