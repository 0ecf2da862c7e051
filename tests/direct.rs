//! Counting walks in cells: a mean over each cell, whatever way light took to it.

mod mirrored;

use crate::experiment::{assert_estimate, readings, s0, scene};
use malus_estimator::{Answer, Reading, Results, run};
use malus_scene::{Estimator, Scene, Settings};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

fn settings(scene: &Scene, cell: f64, samples: u64) -> Settings {
    Settings {
        estimator: Estimator::Direct,
        cell: Some(cell),
        samples: Some(samples),
        relative_error: None,
        ..scene.settings.clone()
    }
}

fn counted(toml: &str, cell: f64, samples: u64) -> Results {
    let scene = scene(toml);
    let settings = settings(&scene, cell, samples);
    run(&scene, &settings, &mut |_| Answer::Continue)
}

fn readings_of(toml: &str, cell: f64, samples: u64) -> Vec<Reading> {
    readings(&counted(toml, cell, samples))
}

/// The paper's room at a = 0, by a converged radiosity solution (4e-5). A cell of side ℓ reads E + ℓ²/24 ∇²E: by the
/// table's own second differences 0.2 % less than the point at ℓ = 0.1, a third of the error allowed.
#[test]
fn the_papers_room_has_its_illuminance() {
    let toml = "
        [[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'plaster'
        [[shape]]
        kind = 'disc'
        centre = [0.5, 0.5, 1]
        normal = [0, 0, -1]
        radius = 0.05
        material = 'lamp'
        [material.plaster]
        rho = 0.5
        [material.lamp]
        rho = 0
        exitance = 1
        [[sensor]]
        name = 'floor'
        line = { from = [0.1, 0.5, 0], to = [0.9, 0.5, 0], count = 9 }
        normal = [0, 0, 1]";
    let exact = [3.09795e-3, 3.37907e-3, 3.60136e-3, 3.74677e-3, 3.79783e-3];
    let readings = readings_of(toml, 0.1, 4_194_304);
    for (index, reading) in readings.iter().enumerate() {
        assert_estimate("floor", s0(reading), exact[index.min(8 - index)], 8e-3);
    }
}

/// A furnace is even, so the mean over any cell is M₀/(1 − ρ): in the open, at a wall, in a corner, beside a block, larger
/// than the room, and on a floor whose edges lie within the cell.
#[test]
fn cells_that_stick_out_of_the_room_count_over_what_is_left_of_them() {
    let toml = "
        [[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [[shape]]
        kind = 'box'
        min = [0.2, 0.6, 0]
        max = [0.4, 0.8, 0.7]
        material = 'wall'
        [material.wall]
        rho = 0.5
        exitance = 2
        [[sensor]]
        name = 'floor'
        points = [[0.5, 0.5, 0], [0, 0.5, 0], [0, 0, 0], [0.97, 0.2, 0], [0.45, 0.7, 0], [0.15, 0.55, 0]]
        [[sensor]]
        name = 'tilted'
        points = [[0.5, 0.5, 0.5], [0.01, 0.5, 0.5], [0.99, 0.3, 0.6], [0.5, 0.5, 0]]
        normal = [0.6, 0, 0.8]
        [[sensor]]
        name = 'wall'
        points = [[1, 0.1, 0.95]]
        normal = [-1, 0, 0]";
    // The cell in the corner, a quarter of 0.2 × 0.2, counts 1 walk in 300.
    for (cell, samples, ceiling) in [(0.2, 2_097_152, 1.3e-2), (3.0, 524_288, 5e-3)] {
        for reading in readings_of(toml, cell, samples) {
            assert_estimate("furnace", s0(&reading), 4.0, ceiling);
        }
    }
}

/// Solid angle of a rectangle with a corner under the point at height s: atan(xy/(s √(s² + x² + y²))), odd in x and y.
fn corner(x: f64, y: f64, s: f64) -> f64 {
    (x * y / (s * (s * s + x * x + y * y).sqrt())).atan()
}

/// Mean over a square of side ℓ about (r, 0) of the light straight from an isotropic source of unit intensity at height s:
/// its solid angle over its area.
fn straight(r: f64, l: f64, s: f64) -> f64 {
    let h = l / 2.0;
    2.0 * (corner(r + h, h, s) - corner(r - h, h, s)) / (l * l)
}

/// Sobolev's two planes: E1(r) by its Hankel integral. What is not straight from the source is smooth on the scale h = 1,
/// so its mean over a cell of 0.25 is its value; the straight part is averaged in closed form.
#[test]
fn sobolevs_planes_have_their_illuminance() {
    let table: [(f64, f64, [f64; 4], [f64; 4]); 2] = [
        (
            0.5,
            0.5,
            [
                4.528_129_525_8,
                1.860_290_080_7,
                0.653_442_317_2,
                0.166_497_749_9,
            ],
            [7e-3, 1e-2, 2e-2, 4e-2],
        ),
        (
            0.9,
            0.3,
            [
                12.613_745_714_0,
                2.883_014_187_7,
                1.350_458_205_6,
                0.645_843_364_6,
            ],
            [7e-3, 1e-2, 2e-2, 4e-2],
        ),
    ];
    let cell = 0.25;
    for (rho, s, exact, ceilings) in table {
        // Of the light that meets a plane of half side 30 beyond its rim less than 1e-5 would come back to these points.
        let toml = format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [-30, -30, 0]
            u = [60, 0, 0]
            v = [0, 60, 0]
            material = 'plane'
            [[shape]]
            kind = 'rectangle'
            origin = [-30, -30, 1]
            u = [0, 60, 0]
            v = [60, 0, 0]
            material = 'plane'
            [material.plane]
            rho = {rho}
            [[source]]
            kind = 'point'
            position = [0, 0, {s}]
            intensity = 1
            [[sensor]]
            name = 'plane'
            points = [[0, 0, 0], [0.5, 0, 0], [1, 0, 0], [2, 0, 0]]
            normal = [0, 0, 1]"
        );
        let readings = readings_of(&toml, cell, 2_097_152);
        for (i, reading) in readings.iter().enumerate() {
            let r = [0.0, 0.5, 1.0, 2.0][i];
            let point = s / (s * s + r * r).powf(1.5);
            let mean = exact[i] - point + straight(r, cell, s);
            assert_estimate(
                &format!("ρ = {rho}, r = {r}"),
                s0(reading),
                mean,
                ceilings[i],
            );
        }
    }
}

/// Light that only skims a cell, or arrives from behind, is not counted.
#[test]
fn only_light_from_the_front_counts() {
    let toml = "
        [[shape]]
        kind = 'rectangle'
        origin = [-1, -1, 0]
        u = [2, 0, 0]
        v = [0, 2, 0]
        material = 'black'
        [material.black]
        rho = 0
        [[source]]
        kind = 'distant'
        direction = [0, 0, -1]
        irradiance = 10
        [[sensor]]
        name = 'down'
        points = [[0, 0, 0.5]]
        normal = [0, 0, -1]
        [[sensor]]
        name = 'upright'
        points = [[0, 0, 0.5]]
        normal = [1, 0, 0]";
    for reading in readings_of(toml, 0.5, 65_536) {
        assert!(reading.stokes[0] <= 0.0);
        // One walk more than there were might have been counted: that much is the error.
        assert!(reading.standard_error[0] > 0.0);
    }
}

/// A grid whose cells tile the floor counts each walk once: it is the cell of the whole floor, by the same walks.
#[test]
fn cells_that_tile_a_floor_add_up_to_it() {
    let room = |sensor: &str| {
        format!(
            "[[shape]]
            kind = 'box'
            min = [0, 0, 0]
            max = [1, 1, 1]
            inward = true
            material = 'plaster'
            [material.plaster]
            rho = 0.6
            a = 0.3
            [[source]]
            kind = 'spot'
            position = [0.4, 0.6, 0.8]
            direction = [0.2, 0.1, -1]
            intensity = 3
            cone_deg = 90
            [[sensor]]
            name = 'floor'
            {sensor}
            normal = [0, 0, 1]"
        )
    };
    let grid = room("grid = { origin = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0], counts = [4, 4] }");
    let whole = readings_of(&room("points = [[0.5, 0.5, 0]]"), 1.0, 65_536)[0];
    let results = counted(&grid, 0.25, 65_536);
    let mean = results.groups[0].mean;
    // Areas of cells that touch walls are measured by rays, to 1e-6.
    assert!(
        (mean / whole.stokes[0] - 1.0).abs() < 3e-6,
        "{mean} {whole:?}"
    );
}

/// At the first look, after 512 walks, hardly a walk has crossed the cell, of 1 in 630: a run that stops by its error
/// goes on until it knows better.
#[test]
fn a_run_that_has_counted_little_does_not_stop() {
    let scene = scene(
        "[[shape]]
        kind = 'rectangle'
        origin = [-1, -1, 0]
        u = [2, 0, 0]
        v = [0, 2, 0]
        material = 'black'
        [material.black]
        rho = 0
        [[source]]
        kind = 'distant'
        direction = [0, 0, -1]
        irradiance = 10
        [[sensor]]
        name = 'floor'
        points = [[0.3, 0.2, 0]]
        normal = [0, 0, 1]",
    );
    for seed in 1..=10 {
        let settings = Settings {
            samples: None,
            relative_error: Some(0.05),
            seed,
            ..settings(&scene, 0.1, 1)
        };
        let results = run(&scene, &settings, &mut |_| Answer::Continue);
        let (value, error) = s0(&readings(&results)[0]);
        // The rule compares the error with what was read.
        assert_estimate("floor", (value, error), 10.0, 0.05 * value / 10.0);
    }
}

#[test]
fn what_is_counted_and_what_it_means_is_said() {
    let toml = "
        [[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'plaster'
        [material.plaster]
        rho = 0.5
        a = 0.5
        [[source]]
        kind = 'point'
        position = [0.5, 0.5, 0.5]
        intensity = 1
        [[sensor]]
        name = 'floor'
        points = [[0.5, 0.5, 0], [0.02, 0.5, 0]]
        normal = [0, 0, 1]";
    let results = counted(toml, 0.125, 64);
    assert_eq!(results.estimator, Estimator::Direct);
    let told = results.warnings.join("\n");
    assert!(
        told.contains("mean over a square cell of side 0.125 m"),
        "{told}"
    );
    assert!(told.contains("cut 1 of them"), "{told}");
    assert!(!told.contains("missing"), "{told}");
}

#[test]
fn one_thread_and_many_count_to_the_same_bits() {
    let scene = scene(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [material.wall]
        rho = 0.6
        a = 0.5
        n = 1.8
        k = 0.5
        [[source]]
        kind = 'spot'
        position = [0.8, 0.2, 0.9]
        direction = [-0.3, 0.2, -1]
        intensity = 0.05
        cone_deg = 60
        stokes = [1, 0.5, 0.1, 0.2]
        [[sensor]]
        name = 'floor'
        grid = { origin = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0], counts = [5, 5] }
        normal = [0, 0, 1]
        [run]
        compare = ['scalar', 'diffuse']",
    );
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let settings = settings(&scene, 0.2, 20_000);
        let results = pool.install(|| run(&scene, &settings, &mut |_| Answer::Continue));
        let readings = readings(&results).into_iter();
        let numbers = readings.flat_map(|r| r.stokes.into_iter().chain(r.standard_error));
        let energy = results.energy;
        let books = [energy.absorbed, energy.standard_error];
        numbers.chain(books).map(f64::to_bits).collect::<Vec<_>>()
    };
    let one = bits(1);
    assert_eq!(one, bits(2));
    assert_eq!(one, bits(7));
}

/// A closer look at the geometry that the tests above rest on.
#[test]
fn the_solid_angle_of_a_square_is_that_of_a_sixth_of_space() {
    // The face of a cube seen from its centre: 4π/6.
    assert!((straight(0.0, 1.0, 0.5) - 2.0 * PI / 3.0).abs() < 1e-14);
    let far = straight(100.0, 1.0, 100.0) * 2.0 * 100.0 * 100.0;
    assert!((far - FRAC_1_SQRT_2).abs() < 1e-4);
}
