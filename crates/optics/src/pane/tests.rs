use super::*;
use crate::{Mueller, coherency};

const INDICES: [f64; 10] = [
    0.5,
    0.9,
    1.0,
    1.0 + 1e-12,
    1.01,
    1.5,
    3.0,
    10.0,
    1e3,
    f64::INFINITY,
];
const TRANSMITTANCES: [f64; 7] = [0.0, 1e-300, 0.1, 0.5, 0.9, 1.0 - 1e-15, 1.0];

fn both(n: f64, tau: f64, cos: f64, sin2: f64) -> (Reflection, Reflection) {
    (
        Pane::reflection(n, tau, cos, sin2),
        Pane::transmission(n, tau, cos, sin2),
    )
}

/// (Rs, Rp, C) or (Ts, Tp, C).
fn parts(matrix: Reflection) -> [f64; 3] {
    [matrix.rs(), matrix.rp(), matrix.c()]
}

fn assert_close(actual: [f64; 3], expected: [f64; 3], tolerance: f64) {
    for (a, e) in actual.into_iter().zip(expected) {
        assert!((a - e).abs() <= tolerance, "{actual:?} is not {expected:?}");
    }
}

/// cos θ and sin² θ from normal to grazing incidence.
fn angles() -> impl Iterator<Item = (f64, f64)> {
    let cosines = (0..=200).map(|step| f64::from(step) / 200.0);
    cosines
        .chain([1e-9, 1e-17, 1e-300])
        .map(|cos| (cos, (1.0 - cos) * (1.0 + cos)))
}

/// The turns of the light one by one: amplitudes r and t of each face, products of amplitudes of s and
/// s, p and p, s and p within a turn, and their sum over turns, which do not interfere.
fn by_turns(n: f64, tau: f64, cos: f64) -> ([f64; 3], [f64; 3]) {
    let inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let crossing = tau.powf(1.0 / inside);
    // Textbook amplitudes from outside, and t t′ from energy: (r, t t′).
    let s = (cos - n * inside) / (cos + n * inside);
    let p = (n * cos - inside) / (n * cos + inside);
    let of_pair = |r1: f64, r2: f64| {
        let both_faces = (1.0 - r1 * r1) * (1.0 - r2 * r2);
        let (mut reflected, mut transmitted) = (r1 * r2, 0.0);
        let mut turn = both_faces * crossing;
        for _ in 0..20_000 {
            transmitted += turn;
            // Reflected inside at the far face, once more across: leaves at the near face.
            turn *= r1 * r2 * crossing;
            reflected += turn;
            turn *= r1 * r2 * crossing;
        }
        (reflected, transmitted)
    };
    let sums = [of_pair(s, s), of_pair(p, p), of_pair(s, p)];
    (sums.map(|sum| sum.0), sums.map(|sum| sum.1))
}

#[test]
fn the_closed_forms_are_the_sums_over_all_turns() {
    for n in [0.9, 1.01, 1.5, 3.0] {
        for tau in [0.1, 0.7, 0.99] {
            // 0.5 is beyond no critical angle: sin θ = 0.866 < 0.9.
            for cos in [1.0, 0.9, 0.5547, 0.5] {
                let (reflected, transmitted) = both(n, tau, cos, (1.0 - cos) * (1.0 + cos));
                let (expected_r, expected_t) = by_turns(n, tau, cos);
                assert_close(parts(reflected), expected_r, 2e-14);
                assert_close(parts(transmitted), expected_t, 2e-14);
            }
        }
    }
}

#[test]
fn a_clear_plate_of_1_52_transmits_as_cie_171_case_5_5_says() {
    // T_j = (1 − R_j)/(1 + R_j), to the six digits of tests/data/cie171.json, case 5.5-slab.
    for (degrees, ts, tp) in [
        (0.0, 0.918_318, 0.918_318),
        (10.0, 0.915_117, 0.921_471),
        (20.0, 0.904_748, 0.931_06),
        (30.0, 0.884_643, 0.947_271),
        (40.0, 0.849_539, 0.969_375),
        (50.0, 0.789_875, 0.992_449),
        (60.0, 0.689_991, 0.996_95),
        (70.0, 0.529_181, 0.920_245),
        (80.0, 0.293_358, 0.618_729),
        (85.0, 0.150_964, 0.340_327),
    ] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let plate = Pane::transmission(1.52, 1.0, cos, sin * sin);
        assert!((plate.rs() - ts).abs() < 6e-7, "Ts at {degrees}°");
        assert!((plate.rp() - tp).abs() < 6e-7, "Tp at {degrees}°");
        assert!((plate.mean() - 0.5 * (ts + tp)).abs() < 1.1e-6);
    }
}

#[test]
fn a_clear_pane_loses_no_light_of_either_polarisation() {
    for n in INDICES {
        for (cos, sin2) in angles() {
            let (reflected, transmitted) = both(n, 1.0, cos, sin2);
            for sum in [
                reflected.rs() + transmitted.rs(),
                reflected.rp() + transmitted.rp(),
                reflected.mean() + transmitted.mean(),
            ] {
                assert!((sum - 1.0).abs() < 4e-15, "{sum} at n = {n}, cos = {cos}");
            }
            let halves = reflected.half_difference() + transmitted.half_difference();
            assert!(halves.abs() < 2e-15 * reflected.half_difference().abs() + 1e-300);
        }
    }
}

#[test]
fn a_black_pane_reflects_at_its_outer_face_alone() {
    for n in INDICES {
        for (cos, sin2) in angles() {
            let (reflected, transmitted) = both(n, 0.0, cos, sin2);
            assert_eq!(reflected, Index::new(n, 0.0).reflection(cos, sin2));
            assert!(parts(transmitted).iter().all(|part| part.to_bits() == 0));
        }
    }
}

#[test]
fn a_pane_of_the_rooms_own_index_only_absorbs() {
    // A = τ^(1/cos θ), and polarisation stays.
    for (tau, cos) in [
        (1.0, 0.6),
        (0.5, 1.0),
        (0.5, 0.6),
        (0.5, 1e-9),
        (1.0, 0.0),
        (0.5, 0.0),
    ] {
        let (reflected, transmitted) = both(1.0, tau, cos, 1.0 - cos * cos);
        assert_eq!(reflected, Reflection::NONE);
        let crossing = if tau < 1.0 {
            f64::powf(tau, 1.0 / cos)
        } else {
            1.0
        };
        assert_close(parts(transmitted), [crossing; 3], 1e-15);
        assert_eq!(transmitted.half_difference().abs().to_bits(), 0);
    }
}

#[test]
fn the_inner_transmittance_counts_along_the_path_inside() {
    // sin θ = 0.9, n = 1.5: cos θ′ = 0.8, A = τ^1.25; where A is small T → (1 − R)² A.
    let (cos, sin2) = (0.19f64.sqrt(), 0.81);
    let face = Index::new(1.5, 0.0).reflection(cos, sin2);
    let pane = Pane::transmission(1.5, 1e-8, cos, sin2);
    let expected = (1.0 - face.rs()).powi(2) * 1e-10;
    assert!((pane.rs() / expected - 1.0).abs() < 1e-14);
}

#[test]
fn at_normal_incidence_a_pane_knows_no_polarisation() {
    for n in INDICES {
        for tau in TRANSMITTANCES {
            let (reflected, transmitted) = both(n, tau, 1.0, 0.0);
            for matrix in [reflected, transmitted] {
                assert_eq!(matrix.half_difference().abs().to_bits(), 0);
                assert!((matrix.c().abs() - matrix.mean()).abs() < 1e-15);
            }
            // The sign of a looking glass in reflection, none in transmission.
            assert!(reflected.c() <= 0.0 && transmitted.c() >= 0.0);
        }
    }
}

#[test]
fn next_to_normal_incidence_the_difference_is_accurate_relative_to_itself() {
    // f(Rs) − f(Rp) = f′(R)(Rs − Rp), with Rs − Rp = 4 sin² θ R/n to first order and, at τ = 1,
    // f = 2R/(1 + R), f′ = 2/(1 + R)².
    for n in [1.0 + 1e-12, 1.5, 1e3] {
        let (sin2, r) = (1e-20, ((n - 1.0) / (n + 1.0f64)).powi(2));
        let (reflected, transmitted) = both(n, 1.0, 1.0, sin2);
        let expected = 2.0 / (1.0 + r).powi(2) * 2.0 * sin2 * r / n;
        assert!((reflected.half_difference() / expected - 1.0).abs() < 1e-14);
        assert!((transmitted.half_difference() / expected + 1.0).abs() < 1e-14);
    }
}

#[test]
fn the_differences_are_those_of_the_closed_forms() {
    for n in [0.9, 1.01, 1.5, 3.0, 30.0] {
        for tau in TRANSMITTANCES {
            for (cos, sin2) in angles().filter(|it| it.0 > 0.5) {
                let (reflected, transmitted) = both(n, tau, cos, sin2);
                let face = Index::new(n, 0.0).reflection(cos, sin2);
                let inside = (1.0 - sin2 / (n * n)).sqrt();
                let a = tau.powf(1.0 / inside);
                let within = |r: f64| (1.0 - r).powi(2) / (1.0 - r * r * a * a);
                let of_r = |r: f64| r * (1.0 + a * a * within(r));
                let (rs, rp) = (face.rs(), face.rp());
                let r = 0.5 * (of_r(rs) - of_r(rp));
                let t = 0.5 * a * (within(rs) - within(rp));
                assert!((reflected.half_difference() - r).abs() < 2e-15);
                assert!((transmitted.half_difference() - t).abs() < 2e-15);
            }
        }
    }
}

#[test]
fn at_brewsters_angle_a_clear_pane_passes_all_p_light() {
    // n = 1.5: Rs = 25/169, so Ts = 144/194 and Rs′ = 50/194.
    let (reflected, transmitted) = both(1.5, 1.0, (1.0 / 3.25f64).sqrt(), 2.25 / 3.25);
    assert_close(parts(reflected), [50.0 / 194.0, 0.0, 0.0], 1e-15);
    // 1 − c² A² = 1 for c = 0: C_T = 1 − Rs.
    assert_close(
        parts(transmitted),
        [144.0 / 194.0, 1.0, 144.0 / 169.0],
        1e-15,
    );
}

#[test]
fn the_signed_product_of_a_pane_changes_sign_at_brewsters_angle() {
    // As of its face: slope Rs(1 + n²)²/(2n³), here times 1 + Ts A², Ts = 144/169.
    let (sin, cos) = (1.5 / 3.25f64.sqrt(), 1.0 / 3.25f64.sqrt());
    let slope = 25.0 / 169.0 * 3.25 * 3.25 / (2.0 * 3.375);
    // n cos θ′ = n sin θ, since θ + θ′ is a right angle: cos θ′ = sin θ.
    let twice = 0.8f64.powf(2.0 / sin);
    for offset in [1e-9, -1e-9] {
        let pane = Pane::reflection(
            1.5,
            0.8,
            cos - offset * sin,
            sin * sin + 2.0 * offset * sin * cos,
        );
        let expected = slope * offset * (1.0 + 144.0 / 169.0 * twice);
        assert!((pane.c() / expected - 1.0).abs() < 2e-6);
        assert!(pane.rp() < 1e-15);
    }
}

#[test]
fn a_nanoradian_from_grazing_half_of_what_enters_passes() {
    // τ = 1: T = (1 − R)/(1 + R) = (1 − R)/2, and 1 − Rs = 4μ/√(n² − 1), 1 − Rp = n² times that.
    for n in [1.5f64, 10.0] {
        let pane = Pane::transmission(n, 1.0, 1e-9, 1.0);
        let ts = 2e-9 / ((n - 1.0) * (n + 1.0)).sqrt();
        assert!((pane.rs() / ts - 1.0).abs() < 1e-7);
        assert!((pane.rp() / (n * n * ts) - 1.0).abs() < 1e-7);
    }
}

#[test]
fn beyond_the_critical_angle_a_pane_is_its_face() {
    // sin θ = 0.8 > 0.5: total reflection, which turns U into V.
    let (reflected, transmitted) = both(0.5, 0.9, 0.6, 0.64);
    assert_eq!(reflected, Index::new(0.5, 0.0).reflection(0.6, 0.64));
    assert!(reflected.w() > 0.1);
    assert_eq!(transmitted, Reflection::NONE);
}

#[test]
fn no_setting_gives_anything_but_physical_matrices() {
    for n in INDICES {
        for tau in TRANSMITTANCES {
            for (cos, sin2) in angles() {
                let (reflected, transmitted) = both(n, tau, cos, sin2);
                for matrix in [reflected, transmitted] {
                    let what = format!("{matrix:?} at n = {n}, τ = {tau}, cos = {cos}");
                    assert!(
                        coherency::is_physical(&Mueller::from(matrix).rows()),
                        "{what}"
                    );
                    assert!((0.0..=1.0 + 2e-15).contains(&matrix.bound()), "{what}");
                    assert!(matrix.rs() >= 0.0 && matrix.rp() >= 0.0, "{what}");
                }
                let sum = reflected.mean() + transmitted.mean();
                assert!((0.0..=1.0 + 2e-15).contains(&sum), "{sum}");
            }
        }
    }
}

#[test]
fn a_pane_depolarises_and_its_p_parts_are_no_product_of_amplitudes() {
    // At 75° Rs ≠ Rp by far: C² is well below the product of the two, and `rp` must not be C²/Rs.
    let (sin, cos) = 75f64.to_radians().sin_cos();
    let (reflected, transmitted) = both(1.5, 0.9, cos, sin * sin);
    let (expected_r, expected_t) = by_turns(1.5, 0.9, cos);
    for (matrix, [_, p, c]) in [(reflected, expected_r), (transmitted, expected_t)] {
        assert!((matrix.rp() - p).abs() < 1e-15);
        assert!(c * c / matrix.rs() < 0.99 * p);
        assert!((matrix.bound() - matrix.rs().max(p)).abs() < 1e-15);
        let [lesser, ..] = coherency::eigenvalues(&Mueller::from(matrix).rows());
        assert!(lesser > -1e-15);
    }
}
