//! Chains at the ends of every range.

use glam::DVec3;

use super::{Chain, Surface, assert_close, past};
use crate::{
    Analyser, Basis, Coated, Emergence, Index, Material, Mueller, Stokes, coherency,
    complex::Complex,
};

/// Reflectors at the ends of their ranges, and ordinary ones.
pub(super) fn reflectors() -> Vec<Material> {
    let indices = [
        (1.0 + 1e-12, 0.0),
        (1.5, 0.0),
        (1e3, 0.0),
        (f64::INFINITY, 0.0),
        (1.0 - 1e-12, 0.0),
        (0.5, 0.0),
        (1e-3, 0.0),
        (0.183, 3.43),
        (1.0, 1e-9),
        (1e3, 1e3),
    ];
    let mirrors = indices.map(|(n, k)| Material::Mixture {
        rho: 0.0,
        fraction: 1.0,
        index: Index::new(n, k),
    });
    let real = indices.into_iter().filter(|&(_, k)| k <= 0.0);
    let panes = real
        .clone()
        .flat_map(|(n, _)| [0.0, 0.5, 1.0 - 1e-12, 1.0].map(|tau| Material::Pane { n, tau }));
    let coats = real
        .filter(|&(n, _)| n >= 1.0)
        .map(|(n, _)| Material::Coated(Coated::new(1.0, n)));
    mirrors.into_iter().chain(panes).chain(coats).collect()
}

#[test]
fn a_thousand_grazing_reflections_lose_light_to_first_order() {
    // A nanoradian from grazing, between two parallel plates: I = 1 − N(Ts + Tp)/2, Q = N(Tp − Ts)/2,
    // U and V as I, with Ts = 4μ/√(n² − 1), Tp = n² Ts; μ² N² leaves 10⁻¹¹.
    let glass = Index::new(1.5, 0.0);
    let (count, mu) = (1000, 1e-9);
    let degrees = 90.0 - f64::to_degrees(mu);
    // 90° − 10⁻⁹ rad has itself a rounding error of 10⁻¹⁶ rad · 90/1.6.
    let plates: Vec<_> = (0..count)
        .map(|plate| (degrees, if plate > 0 { 180.0 } else { 0.0 }, glass))
        .collect();
    let chain = past(&plates);
    let ts = 4.0 * mu / 1.25f64.sqrt();
    let lost = f64::from(count) * 0.5 * (ts + 2.25 * ts);
    let half = f64::from(count) * 0.5 * (2.25 * ts - ts);
    let light = chain.followed(Stokes::<4, _>::new([1.0, 0.0, 0.6, 0.8]));
    let kept = 1.0 - lost;
    assert_close(
        light.components(),
        [kept, half, 0.6 * kept, 0.8 * kept],
        2e-11,
    );
    assert!(lost > 5e-6 && half > 2e-6);
}

#[test]
fn a_metal_a_nanoradian_from_grazing_is_that_of_first_order() {
    // r_s = −(1 − 2μ/q), r_p = −(1 − 2μ n²/q), q = √(n² − 1):
    // 1 − Rs = 4μ Re 1/q, 1 − Rp = 4μ Re n²/q, W = 2μ Im q.
    // Rs and Rp are of some eight operations, next to 1.
    let (mu, rounding) = (1e-9, 8.0 * f64::EPSILON);
    for (re, im) in [(0.183, 3.43), (2.76, 3.79), (1.0, 0.1)] {
        let n = Complex { re, im };
        let q = (n * n - Complex::real(1.0)).root();
        let one = Complex::real(1.0);
        let metal = Index::new(re, im).reflection(mu, 1.0);
        let (lost_s, lost_p) = (4.0 * mu * (one / q).re, 4.0 * mu * (n * n / q).re);
        assert!((1.0 - metal.rs() - lost_s).abs() < rounding + 1e-6 * lost_s);
        assert!((1.0 - metal.rp() - lost_p).abs() < rounding + 1e-6 * lost_p);
        assert!((2.0 * metal.half_difference() / (lost_p - lost_s) - 1.0).abs() < 1e-6);
        assert!((metal.w() / (2.0 * mu * q.im) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn crossed_plates_a_nanoradian_off_brewsters_angle_pass_the_square_of_the_offset() {
    // Light of the s plane of the first is p at the second: I = Rs Rp of unpolarised light, with
    // r_s r_p = δ Rs (1 + n²)²/(2n³), whatever its sign; with 45° between, U has that sign.
    let (glass, brewster) = (Index::new(1.5, 0.0), 1.5f64.atan());
    let slope = 25.0 / 169.0 * 3.25 * 3.25 / (2.0 * 3.375);
    for offset in [1e-9, -1e-9] {
        let degrees = (brewster + offset).to_degrees();
        // The angle in degrees holds rounding errors of 10⁻¹⁶ rad, 10⁻⁷ of the offset, and each plate's
        // own cosine others of that size.
        let product = slope * offset;
        let [_, _, u, _] = past(&[(degrees, 0.0, glass)])
            .followed(Stokes::<4, _>::new([1.0, 0.0, 1.0, 0.0]))
            .components();
        assert!((u / product - 1.0).abs() < 1e-6);
        let light = past(&[(degrees, 0.0, glass), (degrees, 90.0, glass)])
            .followed(Stokes::<4, _>::unpolarised(1.0));
        // M00² − M01² leaves the rounding of M00² = 0.0055.
        assert_close(
            light.components(),
            [product * product, 0.0, 0.0, 0.0],
            2e-18,
        );
    }
}

#[test]
fn an_index_next_to_one_reflects_to_first_order() {
    // n = 1 + ε: q = μ + ε/μ, r_s = −ε/(2μ²), r_p = −r_s cos 2θ.
    let (n, epsilon) = (1.0 + 1e-12, (1.0 + 1e-12) - 1.0);
    for degrees in [1.0, 30.0, 44.0, 46.0, 60.0] {
        let theta = f64::to_radians(degrees);
        let (cos2, s) = ((2.0 * theta).cos(), epsilon / (2.0 * theta.cos().powi(2)));
        let state = Stokes::<4, _>::new([1.0, 0.0, 0.6, 0.8]);
        let light = past(&[(degrees, 0.0, Index::new(n, 0.0))]).followed(state);
        let (rs, rp, c) = (s * s, s * s * cos2 * cos2, -s * s * cos2);
        let expected = [0.5 * (rs + rp), 0.5 * (rs - rp), 0.6 * c, 0.8 * c];
        assert_close(light.components(), expected, 1e-11 * rs);
    }
}

#[test]
fn a_chain_of_high_index_comes_near_to_ideal_mirrors() {
    // 1 − Rp = 4/(nμ) and 1 − Rs = 4μ/n to first order.
    let normals = [(30.0, 20.0), (50.0, -70.0), (40.0, 110.0)];
    let after = |index| {
        let plates = normals.map(|(theta, dihedral)| (theta, dihedral, index));
        past(&plates)
            .followed(Stokes::<4, _>::new([1.0, 0.2, 0.4, -0.6]))
            .components()
    };
    let ideal = after(Index::Mirror);
    let lost = |n: f64| 4.0 / n * 3.0 / 50f64.to_radians().cos();
    for n in [1e3, 1e9] {
        assert_close(after(Index::new(n, 0.0)), ideal, lost(n));
    }
    assert_close(after(Index::new(f64::INFINITY, 0.0)), ideal, 0.0);
    assert_close(after(Index::new(1e200, 0.0)), ideal, 0.0);
}

#[test]
fn light_to_and_fro_along_a_normal_keeps_its_state_but_for_handedness() {
    // Normal incidence, d and −d in turn: each reflection at glass keeps 1/25 and turns U and V.
    for normal in [DVec3::Z, DVec3::X, DVec3::new(1.0, -2.0, 3.0).normalize()] {
        for (index, r) in [(Index::new(1.5, 0.0), 0.04), (Index::Mirror, 1.0)] {
            let plates = [Surface::mirror(normal, index); 5];
            let axis = normal.cross(DVec3::ONE).normalize();
            let chain = Chain::new(Basis::new(-normal, axis), &plates, axis);
            assert!(chain.arriving.direction().distance(normal) < 1e-15);
            let light = chain.followed(Stokes::<4, _>::new([1.0, 0.3, -0.5, 0.7]));
            let expected = [1.0, 0.3, 0.5, -0.7].map(|component| component * f64::powi(r, 5));
            assert_close(light.components(), expected, 1e-14 * expected[0]);
        }
    }
}

#[test]
fn a_hair_off_normal_incidence_nothing_jumps() {
    // The plane of incidence of a beam 10⁻³⁰⁰ to 10⁻⁸ off the normal is as good as any: what arrives in
    // a fixed basis is what arrives at normal incidence, to sin² θ.
    for offset in [0.0, 1e-300, 1e-160, 1e-100, 1e-16, 1e-13, 1e-8] {
        for turn in [0.0f64, 0.7, 2.0, 4.0] {
            let direction =
                (DVec3::NEG_Z + offset * DVec3::new(turn.cos(), turn.sin(), 0.0)).normalize();
            for index in [Index::new(1.5, 0.0), Index::new(0.183, 3.43), Index::Mirror] {
                let plate = [Surface::mirror(DVec3::Z, index)];
                let chain = Chain::new(Basis::new(direction, DVec3::X), &plate, DVec3::X);
                let light = chain.followed(Stokes::<4, _>::new([1.0, 0.3, -0.5, 0.7]));
                let r = index.reflection(1.0, 0.0).mean();
                assert_close(light.components(), [r, 0.3 * r, 0.5 * r, -0.7 * r], 1e-14);
            }
        }
    }
}

#[test]
fn every_reflector_gives_numbers_at_every_angle() {
    for material in reflectors() {
        for cos in [
            1.0,
            1.0 - 1e-16,
            0.7,
            1e-9,
            1e-17,
            1e-160,
            1e-300,
            5e-324,
            0.0,
        ] {
            for sin2 in [(1.0 - cos) * (1.0 + cos), 1e-300, 5e-324] {
                if cos < 0.99 && sin2 < 0.5 {
                    continue;
                }
                let row = Analyser::<4, Emergence>::intensity();
                let [mirror, through] = [material.mirror(cos, sin2), material.through(cos, sin2)]
                    .map(|matrix| Mueller::<4, _, _>::from(matrix).rows());
                let numbers = [
                    material.diffuse_bound(cos, sin2),
                    row * material.leaving(cos, sin2),
                    material.entering::<4>(cos, sin2).components()[0],
                ];
                assert!(
                    numbers.iter().all(|it| (0.0..=1.0 + 1e-15).contains(it)),
                    "{numbers:?}"
                );
                for matrix in [mirror, through] {
                    assert!(
                        coherency::is_physical(&matrix),
                        "{matrix:?} of {material:?} at {cos}, {sin2}"
                    );
                }
            }
        }
    }
}
