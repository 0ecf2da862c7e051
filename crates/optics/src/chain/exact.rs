//! Chains whose Stokes vectors have a closed form.

use glam::DVec3;

use super::{Chain, Surface, assert_close, past};
use crate::{Basis, Index, Material, Stokes};

const GOLD: Index = Index::Relative { n: 0.183, k: 3.43 };

/// M00, M01 and r_s r_p of a dielectric, by the textbook's amplitudes.
fn dielectric(n: f64, degrees: f64) -> [f64; 3] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let inside = (1.0 - sin * sin / (n * n)).sqrt();
    let s = (cos - n * inside) / (cos + n * inside);
    let p = (n * cos - inside) / (n * cos + inside);
    [0.5 * (s * s + p * p), 0.5 * (s * s - p * p), s * p]
}

#[test]
fn three_glass_plates_have_the_sign_of_the_product_of_amplitudes() {
    // At 65°, 30° and 65° with 45° between the planes, unpolarised light: the middle plate sends on
    // U alone of the first one's Q, by r_s r_p < 0, so
    // I = M00 M00′ M00 − M01 r_s r_p′ M01, in 20 digits 0.0010449179140228801806.
    let glass = Index::new(1.5, 0.0);
    let after = |turn: f64| {
        past(&[(65.0, 0.0, glass), (30.0, 45.0, glass), (65.0, turn, glass)])
            .followed(Stokes::<4, _>::unpolarised(1.0))
            .i()
    };
    let (signed, unsigned) = (1.044_917_914_022_880_2e-3, 1.611_835_022_757_293_5e-4);
    assert!((after(45.0) / signed - 1.0).abs() < 1e-14);
    // +√(Rs Rp) in its place is 6.48 times off. It is what the third plate reflects if turned back.
    assert!((signed / unsigned - 6.482_784_523_662_888).abs() < 1e-14);
    assert!((after(-45.0) / unsigned - 1.0).abs() < 1e-13);
}

#[test]
fn two_plates_at_general_angles_polarise_by_both_planes() {
    // Unpolarised light: (M00 M00′ + M01 M01′ cos 2φ, M00 M01′ + M01 M00′ cos 2φ, −M01 c′ sin 2φ, 0).
    for (n, first, dihedral, second) in [
        (1.5, 20.0, 10.0, 70.0),
        (1.5, 65.0, 35.0, 30.0),
        (2.4, 50.0, -65.0, 80.0),
        (1.1, 45.0, 100.0, 45.0),
    ] {
        let ([m1, h1, _], [m2, h2, c2]) = (dielectric(n, first), dielectric(n, second));
        let (sin2, cos2) = f64::to_radians(2.0 * dihedral).sin_cos();
        let index = Index::new(n, 0.0);
        let light = past(&[(first, 0.0, index), (second, dihedral, index)])
            .followed(Stokes::<4, _>::unpolarised(1.0));
        let expected = [
            m1 * m2 + h1 * h2 * cos2,
            m1 * h2 + h1 * m2 * cos2,
            -h1 * c2 * sin2,
            0.0,
        ];
        assert_close(light.components(), expected, 1e-14 * expected[0]);
    }
}

#[test]
fn three_plates_at_general_angles_and_planes() {
    for (n, [first, second, third], [a, b]) in [
        (1.5, [20.0, 70.0, 55.0], [10.0, 25.0]),
        (2.0, [65.0, 40.0, 75.0], [-50.0, 35.0]),
        (4.0, [80.0, 15.0, 60.0], [110.0, -70.0]),
    ] {
        let [m1, h1, _] = dielectric(n, first);
        let [m2, h2, c2] = dielectric(n, second);
        let [m3, h3, c3] = dielectric(n, third);
        let (sin_a, cos_a) = f64::to_radians(2.0 * a).sin_cos();
        let (sin_b, cos_b) = f64::to_radians(2.0 * b).sin_cos();
        // After the second plate, then in the plane of the third.
        let (i, q, u) = (
            m2 * m1 + h2 * h1 * cos_a,
            h2 * m1 + m2 * h1 * cos_a,
            -c2 * h1 * sin_a,
        );
        let (q, u) = (cos_b * q + sin_b * u, cos_b * u - sin_b * q);
        let expected = [m3 * i + h3 * q, h3 * i + m3 * q, c3 * u, 0.0];
        let index = Index::new(n, 0.0);
        let light = past(&[(first, 0.0, index), (second, a, index), (third, b, index)])
            .followed(Stokes::<4, _>::unpolarised(1.0));
        assert_close(light.components(), expected, 1e-14 * expected[0]);
    }
}

#[test]
fn crossed_planes_at_equal_angles_undo_the_polarisation() {
    // I = (M00² − M01²) = Rs Rp of n = 1.5 at 45°, 0.09201336 · 0.00846646, and Q = 0.
    let glass = Index::new(1.5, 0.0);
    let [i, q, u, v] = past(&[(45.0, 0.0, glass), (45.0, 90.0, glass)])
        .followed(Stokes::<4, _>::unpolarised(1.0))
        .components();
    assert!((i / (0.092_013_36 * 0.008_466_46) - 1.0).abs() < 6e-7);
    assert!(q.abs() + u.abs() + v.abs() < 1e-18);
}

#[test]
fn two_plates_at_brewsters_angle_obey_the_law_of_malus() {
    // Rs²/2 cos² φ of unpolarised light, Rs = 25/169, all of it s-polarised; crossed planes pass nothing.
    let (glass, degrees) = (Index::new(1.5, 0.0), 1.5f64.atan().to_degrees());
    for dihedral in [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 135.0] {
        let light = past(&[(degrees, 0.0, glass), (degrees, dihedral, glass)])
            .followed(Stokes::<4, _>::unpolarised(1.0));
        let cos = f64::to_radians(dihedral).cos();
        let expected = 0.5 * (25.0f64 / 169.0).powi(2) * cos * cos;
        let rounding = 4e-15 * 0.5 * (25.0f64 / 169.0).powi(2);
        assert_close(light.components(), [expected, expected, 0.0, 0.0], rounding);
    }
}

#[test]
fn gold_turns_light_at_plus_45_degrees_right_handed_and_at_minus_45_left_handed() {
    // The gold row: C = −0.86882241, W = +0.36478036.
    let gold = past(&[(45.0, 0.0, GOLD)]);
    for sign in [1.0, -1.0] {
        let light = gold.followed(Stokes::<4, _>::new([1.0, 0.0, sign, 0.0]));
        let expected = [
            0.942_478_48,
            0.018_670_71,
            -0.868_822_41 * sign,
            0.364_780_36 * sign,
        ];
        assert_close(light.components(), expected, 6e-9);
    }
}

#[test]
fn two_gold_mirrors_make_unpolarised_light_circular_in_part() {
    // The second turns the U = −M01 sin 2φ of the first into U = −C M01 sin 2φ, V = −W M01 sin 2φ:
    // left-handed if it is turned anticlockwise as seen looking into the beam.
    let (m, h, c, w) = (0.942_478_48, 0.018_670_71, -0.868_822_41, 0.364_780_36);
    for dihedral in [30.0, 45.0, -45.0, 90.0] {
        let (sin2, cos2) = f64::to_radians(2.0 * dihedral).sin_cos();
        let light = past(&[(45.0, 0.0, GOLD), (45.0, dihedral, GOLD)])
            .followed(Stokes::<4, _>::unpolarised(1.0));
        let expected = [
            m * m + h * h * cos2,
            m * h + h * m * cos2,
            -c * h * sin2,
            -w * h * sin2,
        ];
        assert_close(light.components(), expected, 2e-8);
    }
    let [.., v] = past(&[(45.0, 0.0, GOLD), (45.0, 45.0, GOLD)])
        .followed(Stokes::<4, _>::unpolarised(1.0))
        .components();
    assert!(v < -0.0068);
}

#[test]
fn three_gold_mirrors_turn_part_of_v_back_into_q() {
    // In one plane, U + iV turns by (C + iW)³; the last 45° to the sensor's axis by the basis alone.
    let plates = [(45.0, 0.0, GOLD); 3];
    let light = past(&plates).followed(Stokes::<4, _>::new([1.0, 0.0, 1.0, 0.0]));
    let (c, w) = (-0.868_822_41, 0.364_780_36f64);
    let (u, v) = (c * (c * c - 3.0 * w * w), w * (3.0 * c * c - w * w));
    let [_, _, actual_u, actual_v] = light.components();
    assert!((actual_u - u).abs() < 3e-8 && (actual_v - v).abs() < 3e-8);

    // With 45° between second and third plane, that U becomes Q: I gains M01 of it.
    let (m, h) = (0.942_478_48, 0.018_670_71);
    let light = past(&[(45.0, 0.0, GOLD), (45.0, 0.0, GOLD), (45.0, 45.0, GOLD)])
        .followed(Stokes::<4, _>::new([1.0, 0.0, 1.0, 0.0]));
    let (i, q, u, v) = (m * m + h * h, 2.0 * m * h, c * c - w * w, 2.0 * c * w);
    let expected = [m * i + h * u, h * i + m * u, -c * q - w * v, c * v - w * q];
    assert_close(light.components(), expected, 5e-8);
}

#[test]
fn a_fresnel_rhomb_turns_light_at_45_degrees_into_circular_light() {
    // One total reflection delays by δ, tan(δ/2) = cos θ √(sin² θ − ν)/sin² θ, ν = 1/n². For δ = 45°
    // a quadratic in sin² θ; n = 1.51 has 48°37′ and 54°37′: Born and Wolf, Principles of Optics, 1.5.4.
    let nu = 1.0 / (1.51f64 * 1.51);
    let t2 = (0.5f64.sqrt() / (1.0 + 0.5f64.sqrt())).powi(2);
    let root = ((1.0 + nu).powi(2) - 4.0 * nu * (1.0 + t2)).sqrt();
    let glass_to_air = Index::new(1.0 / 1.51, 0.0);
    for (sign, degrees) in [(-1.0, 48.0 + 37.0 / 60.0), (1.0, 54.0 + 37.0 / 60.0)] {
        let sin2: f64 = (1.0 + nu + sign * root) / (2.0 * (1.0 + t2));
        let theta = sin2.sqrt().asin().to_degrees();
        assert!((theta - degrees).abs() < 0.5 / 60.0);
        // Two parallel faces: the second plane of incidence is the first, met from the other side.
        let rhomb = past(&[(theta, 0.0, glass_to_air), (theta, 180.0, glass_to_air)]);
        for handed in [1.0, -1.0] {
            let light = rhomb.followed(Stokes::<4, _>::new([1.0, 0.0, handed, 0.0]));
            assert_close(light.components(), [1.0, 0.0, 0.0, handed], 1e-14);
            let light = rhomb.followed(Stokes::<4, _>::new([1.0, 0.0, 0.0, handed]));
            assert_close(light.components(), [1.0, 0.0, -handed, 0.0], 1e-14);
        }
        let light = rhomb.followed(Stokes::<4, _>::new([1.0, 1.0, 0.0, 0.0]));
        assert_close(light.components(), [1.0, 1.0, 0.0, 0.0], 1e-14);
    }
}

#[test]
fn light_between_two_parallel_plates_keeps_its_plane() {
    // N reflections: I = (Rs^N + Rp^N)/2, Q = (Rs^N − Rp^N)/2, U → (r_s r_p)^N U.
    for degrees in [20.0, 60.0, 80.0] {
        let [m, h, c] = dielectric(1.5, degrees);
        let glass = Index::new(1.5, 0.0);
        for count in 1..=8 {
            let plates: Vec<_> = (0..count)
                .map(|plate| (degrees, if plate > 0 { 180.0 } else { 0.0 }, glass))
                .collect();
            let (s, p, u) = ((m + h).powi(count), (m - h).powi(count), c.powi(count));
            let light = past(&plates).followed(Stokes::<4, _>::new([1.0, 0.0, 0.5, 0.5]));
            let expected = [0.5 * (s + p), 0.5 * (s - p), 0.5 * u, 0.5 * u];
            assert_close(light.components(), expected, 2e-13 * expected[0]);
        }
    }
}

#[test]
fn a_corner_of_ideal_mirrors_sends_the_field_back_along_the_same_line() {
    // Each takes E to −(1 − 2NNᵀ)E, all three to E, while the direction is reversed: y = d × x changes
    // its sign, and so do U and V.
    let mirrors =
        [DVec3::X, DVec3::Y, DVec3::Z].map(|normal| Surface::mirror(normal, Index::Mirror));
    let direction = -DVec3::new(1.0, 2.0, 3.0).normalize();
    let source = Basis::new(direction, DVec3::X);
    let corner = Chain::new(source, &mirrors, source.axis());
    assert!(corner.arriving.direction().distance(-direction) < 1e-15);
    let light = corner.followed(Stokes::<4, _>::new([1.0, 0.3, -0.5, 0.7]));
    assert_close(light.components(), [1.0, 0.3, 0.5, -0.7], 1e-14);
}

#[test]
fn a_way_out_of_its_plane_turns_the_polarisation() {
    // Ideal mirrors at 45° from Z to X to Y and back to Z: E goes from X to −Z to Z to −Y, and from Y
    // to −Y to −X to −X: Q and V change their signs.
    let mirrors = [
        DVec3::new(1.0, 0.0, -1.0),
        DVec3::new(-1.0, 1.0, 0.0),
        DVec3::new(0.0, -1.0, 1.0),
    ]
    .map(|normal| Surface::mirror(normal.normalize(), Index::Mirror));
    let chain = Chain::new(Basis::new(DVec3::Z, DVec3::X), &mirrors, DVec3::X);
    assert!(chain.arriving.direction().distance(DVec3::Z) < 1e-15);
    let light = chain.followed(Stokes::<4, _>::new([1.0, 0.3, -0.5, 0.7]));
    assert_close(light.components(), [1.0, -0.3, -0.5, -0.7], 1e-14);
}

#[test]
fn two_clear_panes_at_brewsters_angle_pass_p_light() {
    // n = 1.5: Tp = 1, Ts = 144/194. Parallel planes pass (Ts² + 1)/2, crossed ones Ts.
    let ts = 144.0 / 194.0;
    let degrees = 1.5f64.atan().to_degrees();
    for (dihedral, expected) in [
        (
            0.0,
            [0.5 * (ts * ts + 1.0), 0.5 * (ts * ts - 1.0), 0.0, 0.0],
        ),
        (90.0, [ts, 0.0, 0.0, 0.0]),
    ] {
        let axis = |turn: f64| DVec3::new(turn.to_radians().cos(), turn.to_radians().sin(), 0.0);
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let panes = [0.0, dihedral].map(|turn| Surface {
            normal: sin * axis(turn).cross(DVec3::Z) - cos * DVec3::Z,
            material: Material::Pane { n: 1.5, tau: 1.0 },
            through: true,
        });
        let chain = Chain::new(Basis::new(DVec3::Z, DVec3::X), &panes, axis(dihedral));
        let light = chain.followed(Stokes::<4, _>::unpolarised(1.0));
        assert_close(light.components(), expected, 4e-15);
    }
}
