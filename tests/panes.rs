//! Sheets that light passes, against closed forms.

use crate::experiment::{assert_estimate, assert_exact, measured, s0};
use crate::images::{
    Eye, Flat, Source, assert_images, assert_stokes, by_images, eyes, mirror, parallel, point,
    slab, written,
};
use glam::{DVec3, dvec3 as v};
use malus_estimator::Reading;
use malus_optics::Material;

const fn pane(n: f64, tau: f64) -> Material {
    Material::Pane { n, tau }
}

/// A horizontal sheet without end, or so.
fn sheet(z: f64, material: Material) -> Flat {
    Flat {
        origin: v(-50.0, -50.0, z),
        u: v(100.0, 0.0, 0.0),
        v: v(0.0, 100.0, 0.0),
        material,
    }
}

/// A sensor under the plate of CIE 171, case 5.5, with parallel light in a state about Y, which is its s axis.
fn under_a_plate(degrees: f64, state: [f64; 4]) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let eye = Eye {
        at: DVec3::ZERO,
        normal: DVec3::Z,
        axis: DVec3::Y,
        fixed: true,
    };
    let source = Source {
        state,
        axis: DVec3::Y,
        strength: 1.0,
        ..parallel(v(sin, 0.0, cos))
    };
    written(&[sheet(1.0, pane(1.52, 1.0))], &[source], &[eye])
}

/// Case 5.5 of CIE 171 through the whole program: parallel light across a plate, T about its plane of incidence.
#[test]
fn case_5_5_a_clear_plate() {
    for (degrees, ts, tp) in slab() {
        let cos = f64::to_radians(degrees).cos();
        let text = under_a_plate(degrees, [1.0, 0.0, 0.0, 0.0]);
        for estimator in ["auto", "gather", "local"] {
            let run = format!("[run]\nestimator = '{estimator}'\nsamples = 64");
            let reading = measured(&format!("{text}{run}"))[0];
            // Light along Y is s-polarised. The table has six digits.
            let (s, p) = (0.5 * cos * ts, 0.5 * cos * tp);
            assert!(
                reading.standard_error[0] <= 0.0,
                "nothing is left to chance"
            );
            assert_exact("T", reading.stokes[0], s + p, 2e-6);
            assert!((reading.stokes[1] - (s - p)).abs() < 1e-6, "{degrees}°");
        }
    }
}

/// Light along Y, which is s-polarised on the plate: S0 = E Ts, where both other models have E (Ts + Tp)/2.
#[test]
fn polarised_light_through_a_pane_differs_from_the_scalar_model() {
    for (degrees, ts, tp) in slab() {
        let cos = f64::to_radians(degrees).cos();
        let text = under_a_plate(degrees, [1.0, 1.0, 0.0, 0.0]);
        let run = "[run]\ncompare = ['scalar', 'diffuse']\nsamples = 64";
        let reading = measured(&format!("{text}{run}"))[0];
        // The table has six digits.
        assert_exact("Ts", reading.stokes[0], cos * ts, 2e-6);
        for other in [reading.scalar, reading.diffuse] {
            let difference = other.unwrap().difference;
            let exact = 0.5 * cos * (ts - tp);
            assert!(
                (difference - exact).abs() < 2e-6,
                "{degrees}°: {difference}, exactly {exact}"
            );
        }
    }
}

#[test]
fn a_point_source_behind_a_pane_is_dimmed_and_polarised() {
    let eyes = eyes(&[
        (v(1.2, 0.4, 0.2), v(0.3, 0.2, 1.0)),
        (v(-2.5, 0.9, 0.4), v(1.0, -0.3, 0.1)),
        (v(0.4, -1.3, 0.999), v(0.0, 0.5, 0.2)),
    ]);
    let tilted = Flat {
        origin: v(-2.0, -3.0, 1.1),
        u: v(6.0, 0.0, 1.0),
        v: v(0.0, 8.0, 0.3),
        material: pane(0.8, 1.0),
    };
    for source in [point(v(0.1, -0.2, 3.0)), parallel(v(0.3, -0.4, 0.8))] {
        let flats = [sheet(1.0, pane(1.5, 0.8))];
        assert_images("one", &flats, &[source], &eyes, 1, 4096, 1e-9);
        let flats = [sheet(1.0, pane(1.5, 0.8)), tilted.clone()];
        assert_images("two", &flats, &[source], &eyes, 7, 4096, 0.0);
    }
}

#[test]
fn a_lamp_is_mirrored_by_a_pane() {
    let eyes = eyes(&[
        (v(1.2, 0.4, 1.3), v(0.3, 0.2, -1.0)),
        (v(-2.5, 0.9, 2.4), v(1.0, -0.3, -0.1)),
    ]);
    for n in [1.5, 3.0, 0.7] {
        let flats = [sheet(1.0, pane(n, 0.9))];
        for source in [point(v(0.1, -0.2, 3.0)), parallel(v(0.3, -0.4, 0.8))] {
            assert_images("mirrored", &flats, &[source], &eyes, 1, 4096, 1e-9);
        }
    }
}

/// T = T₁ T₂/(1 − R₁ R₂) of each polarisation, and C_T likewise with the signed C_R.
#[test]
fn parallel_light_crosses_two_panes_by_all_turns_between_them() {
    let (outer, inner) = (pane(2.2, 1.0), pane(1.6, 0.9));
    // Light must not come in beside them after many turns.
    let wide = |flat: Flat| Flat {
        origin: v(-500.0, -500.0, flat.origin.z),
        u: flat.u * 10.0,
        v: flat.v * 10.0,
        ..flat
    };
    let flats = [sheet(2.0, outer), sheet(1.0, inner)].map(wide);
    for degrees in [10.0, 55.0, 75.0f64] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let source = Source {
            axis: DVec3::Y,
            ..parallel(v(sin, 0.0, cos))
        };
        let eye = Eye {
            at: v(0.3, 0.2, 0.1),
            normal: DVec3::Z,
            axis: DVec3::Y,
            fixed: true,
        };
        let at = |m: &Material| (m.mirror(cos, sin * sin), m.through(cos, sin * sin));
        let ((r1, t1), (r2, t2)) = (at(&outer), at(&inner));
        let ts = t1.rs() * t2.rs() / (1.0 - r1.rs() * r2.rs());
        let tp = t1.rp() * t2.rp() / (1.0 - r1.rp() * r2.rp());
        let c = t1.c() * t2.c() / (1.0 - r1.c() * r2.c());
        let [_, q, u, w] = source.state;
        let (s, p) = (ts * (1.0 + q) / 2.0, tp * (1.0 - q) / 2.0);
        let exact = [s + p, s - p, c * u, c * w].map(|x| x * 3.0 * cos);
        let text = written(&flats, &[source], &[eye]);
        let run = "[run]\nrepresentation = 'full'\nsamples = 65536";
        let reading = measured(&format!("{text}{run}"))[0];
        assert_stokes(&format!("{degrees}°"), &reading, exact, 1e-9, 1e-2);
        // The images on paper say the same.
        let images = by_images(&flats, &source, &eye, 60);
        for (one, other) in images.iter().zip(exact) {
            assert!(
                (one - other).abs() < 1e-10 * exact[0],
                "{images:?} {exact:?}"
            );
        }
    }
}

/// Turns between two sheets without end: the chains of more than three mirrors are drawn as images.
#[test]
fn a_point_source_before_and_between_two_panes_has_all_its_images() {
    let eyes = eyes(&[
        (v(1.2, 0.4, 0.2), v(0.3, 0.2, 1.0)),
        (v(0.5, 0.9, 1.4), v(0.2, -0.3, 1.0)),
        (v(0.4, -1.3, 1.5), v(0.3, 0.5, -1.2)),
    ]);
    let flats = [sheet(2.0, pane(4.0, 1.0)), sheet(1.0, pane(3.0, 1.0))];
    for source in [point(v(0.1, -0.2, 3.0)), point(v(0.1, -0.2, 1.6))] {
        assert_images("panes", &flats, &[source], &eyes, 60, 32_768, 2e-3);
    }
}

#[test]
fn a_point_source_between_a_mirror_and_a_pane_has_all_its_images() {
    let eyes = eyes(&[
        (v(1.2, 0.4, 0.6), v(0.3, 0.2, 1.0)),
        (v(0.5, 0.9, 1.4), v(0.2, -0.3, -1.0)),
    ]);
    let flats = [
        sheet(1.0, pane(4.0, 1.0)),
        sheet(0.0, mirror(0.95, f64::INFINITY, 0.0)),
    ];
    for source in [point(v(0.1, -0.2, 3.0)), point(v(0.1, -0.2, 0.7))] {
        assert_images(
            "pane and mirror",
            &flats,
            &[source],
            &eyes,
            80,
            65_536,
            2e-2,
        );
    }
}

const BOX: &str = "
    [[shape]]
    kind = 'box'
    min = [0, 0, 0]
    max = [1, 1, 1]
    inward = true
    material = 'wall'
    [[sensor]]
    name = 'inside'
    points = [[0.5, 0.4, 0.5], [0.01, 0.5, 0.5], [0.301, 0.3, 0.3], [0.9, 0.3, 0.999]]
    normal = [0.6, 0, -0.8]
    [[sensor]]
    name = 'sight'
    quantity = 'radiance'
    points = [[0.5, 0.4, 0.5]]
    direction = [-1, 0.1, 0.2]
";

const SHEET: &str = "
    [[shape]]
    kind = 'rectangle'
    origin = [0.3, 0.1, 0.1]
    u = [0, 0.8, 0]
    v = [0.05, 0, 0.7]
    material = 'pane'
";

/// A pane that takes nothing leaves a furnace as it is: E = M₀/(1 − ρ), L = E/π.
#[test]
fn a_clear_pane_in_a_furnace_changes_nothing() {
    for (rho, n) in [(0.5, 1.5), (0.8, 4.0)] {
        for (estimator, samples, ceiling) in [("auto", 262_144, 1e-2), ("gather", 32_768, 1e-2)] {
            let readings = measured(&format!(
                "{BOX}{SHEET}
                [material.wall]
                rho = {rho}
                exitance = 2
                [material.pane]
                kind = 'pane'
                n = {n}
                [run]
                estimator = '{estimator}'
                representation = 'full'
                samples = {samples}"
            ));
            for (i, reading) in readings.iter().enumerate() {
                let share = if i < 4 {
                    1.0
                } else {
                    std::f64::consts::FRAC_1_PI
                };
                let exact = 2.0 / (1.0 - rho) * share;
                assert_stokes(
                    &format!("{estimator}, ρ = {rho}, sensor {i}"),
                    reading,
                    [exact, 0.0, 0.0, 0.0],
                    1e-9,
                    ceiling,
                );
            }
        }
    }
}

fn assert_same(what: &str, one: &[Reading], other: &[Reading], ceiling: f64) {
    for (i, (a, b)) in one.iter().zip(other).enumerate() {
        for c in 0..4 {
            let error = a.standard_error[c].hypot(b.standard_error[c]);
            let z = (a.stokes[c] - b.stokes[c]) / error.max(1e-12 * b.stokes[0]);
            assert!(
                z.abs() < 4.5 && error < ceiling * b.stokes[0],
                "{what}, sensor {i}, S{c}: {a:?}\n{b:?}\nz = {z:.2}"
            );
        }
    }
}

/// A room of glossy walls, a lamp and panes: light through them, off them and caught between them.
#[test]
fn panes_in_a_glossy_room_are_the_same_by_both_estimators() {
    let room = |estimator: &str, samples: u64| {
        measured(&format!(
            "{BOX}{SHEET}
            [[shape]]
            kind = 'rectangle'
            origin = [0.6, 0.1, 0.1]
            u = [0, 0.8, 0]
            v = [0.05, 0, 0.7]
            material = 'pane'
            [[shape]]
            kind = 'rectangle'
            origin = [0.1, 0.3, 0.9]
            u = [0, 0.3, 0]
            v = [0.15, 0, 0]
            material = 'lamp'
            [material.wall]
            rho = 0.5
            a = 0.6
            n = 2
            [material.lamp]
            rho = 0
            exitance = 10
            emission_stokes = [1, 0.3, 0.5, 0.7]
            [material.pane]
            kind = 'pane'
            n = 2.5
            tau = 0.9
            [run]
            estimator = '{estimator}'
            representation = 'full'
            samples = {samples}"
        ))
    };
    assert_same(
        "room",
        &room("auto", 65_536),
        &room("gather", 262_144),
        6e-2,
    );
}

/// The sun through a pane in the window of a room without gloss: every estimator finds all of it, and straight light is
/// K cos θ T(θ).
#[test]
fn the_sun_shines_through_a_pane_in_a_window() {
    let room = |estimator: &str, samples: u64| {
        let wall = |origin: &str, u: &str, v: &str| {
            format!(
                "[[shape]]\nkind = 'rectangle'\norigin = {origin}\nu = {u}\nv = {v}\nmaterial = 'wall'\n"
            )
        };
        let walls = [
            wall("[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]"),
            wall("[0, 0, 1]", "[0, 1, 0]", "[1, 0, 0]"),
            wall("[0, 0, 0]", "[0, 0, 1]", "[1, 0, 0]"),
            wall("[0, 1, 0]", "[1, 0, 0]", "[0, 0, 1]"),
            wall("[0, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"),
            wall("[1, 0, 0]", "[0, 0, 0.4]", "[0, 1, 0]"),
            wall("[1, 0, 0.8]", "[0, 0, 0.2]", "[0, 1, 0]"),
        ];
        measured(&format!(
            "{}
            [[shape]]
            kind = 'rectangle'
            origin = [1, 0, 0.4]
            u = [0, 1, 0]
            v = [0, 0, 0.4]
            material = 'pane'
            [material.wall]
            rho = 0.5
            [material.pane]
            kind = 'pane'
            n = 1.6
            tau = 0.8
            [[source]]
            kind = 'distant'
            direction = [-0.8, 0, -0.6]
            irradiance = 5
            [[sensor]]
            name = 'floor'
            points = [[0.25, 0.5, 0], [0.6, 0.3, 0]]
            normal = [0, 0, 1]
            axis = [0, 1, 0]
            frame = 'fixed'
            [[sensor]]
            name = 'wall'
            points = [[0, 0.4, 0.6]]
            normal = [1, 0, 0]
            [run]
            estimator = '{estimator}'
            representation = 'full'
            samples = {samples}",
            walls.concat()
        ))
    };
    let [auto, gather] =
        [("auto", 262_144), ("gather", 131_072)].map(|(e, samples)| room(e, samples));
    assert_same("gather", &auto, &gather, 2e-2);
    // Of walks from the sun alone, light that a pane mirrors last is missing: where the pane is far above grazing it is
    // little, so this bounds it from one side.
    let local = room("local", 1_048_576);
    for (a, l) in auto.iter().zip(&local) {
        let (difference, error) = (
            a.stokes[0] - l.stokes[0],
            a.standard_error[0].hypot(l.standard_error[0]),
        );
        assert!(
            difference > -4.5 * error && difference < 0.1 * a.stokes[0],
            "{a:?} {l:?}"
        );
    }
    let through = pane(1.6, 0.8).through(0.8, 0.36);
    let dark = |i: usize| auto[i].stokes[1] / (5.0 * 0.6);
    // What is scattered has an S1 of its own only by the panes: the difference between the two points is the sun's, to within it.
    assert!(
        (dark(0) - dark(1) - through.half_difference()).abs() < 0.02,
        "{auto:?}"
    );
    let direct = 5.0 * 0.6 * through.mean();
    assert!(
        s0(&auto[0]).0 > direct && s0(&auto[0]).0 < 1.5 * direct,
        "{auto:?}"
    );
    assert_estimate("floor", s0(&auto[0]), s0(&gather[0]).0, 2e-2);
}
