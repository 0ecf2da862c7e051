use super::*;

const INDICES: [f64; 11] = [
    1.0,
    1.0 + 1e-12,
    1.0 + 1e-6,
    1.01,
    1.2,
    1.5,
    2.4,
    5.0,
    10.0,
    30.0,
    100.0,
];

/// ∫₀¹ 2μ f(μ) dμ, on intervals that shrink towards grazing emergence.
fn over_the_hemisphere(f: impl Fn(f64, f64) -> f64) -> f64 {
    let weighted = |mu: f64| 2.0 * mu * f(mu, (1.0 - mu) * (1.0 + mu));
    graded(1e-9, weighted) + gauss(0.5, 0.75, weighted) + gauss(0.75, 1.0, weighted)
}

#[test]
fn the_hemispherical_reflectance_is_that_of_the_closed_form() {
    // Duntley's closed form in 120 digits, at the f64 next to each index.
    for (n, expected) in [
        (1.0, 0.0),
        (1.0 + 1e-12, 3.333_629_668_474_076e-13),
        (1.000_001, 3.333_268_706_423_929e-7),
        (1.01, 3.146_302_682_353_434e-3),
        (1.33, 0.065_930_849_299_405_43),
        (1.5, 0.091_777_959_342_351_21),
        (2.4, 0.210_181_302_010_446_73),
        (10.0, 0.640_174_994_374_748_9),
        (100.0, 0.950_161_171_239_651_4),
        (1000.0, 0.994_719_939_327_603_6),
    ] {
        let reflectance = Coated::new(0.5, n).hemispherical_reflectance();
        assert!(
            (reflectance - expected).abs() < 2e-15,
            "{reflectance:e} is not {expected:e} at n = {n}"
        );
    }
}

#[test]
fn what_enters_a_coat_of_high_index_is_accurate_relative_to_itself() {
    // The same closed form: 1 − r_e, which tends to 16/(3n).
    let entered = Coated::new(1.0, 1000.0).entered;
    assert!((entered / 5.280_060_672_396_367e-3 - 1.0).abs() < 2e-15);
    let entered = Coated::new(1.0, 1e9).entered;
    assert!((entered * 1e9 * 3.0 / 16.0 - 1.0).abs() < 1e-7);
}

#[test]
fn a_coated_white_surface_loses_no_light_at_any_angle() {
    for n in INDICES {
        let coated = Coated::new(1.0, n);
        let leaving = over_the_hemisphere(|cos, sin2| coated.leaving::<1>(cos, sin2).i());
        for cos in [1.0, 0.99, 0.6, 0.1, 1e-3, 1e-9, 0.0] {
            let sin2 = (1.0 - cos) * (1.0 + cos);
            let scattered =
                coated.scattering() * leaving * coated.entering::<4>(cos, sin2).components()[0];
            let sum = scattered + coated.mirror(cos, sin2).mean();
            assert!((sum - 1.0).abs() < 1e-14, "{sum} at n = {n}, cos = {cos}");
        }
    }
}

#[test]
fn the_scattered_share_of_diffuse_light_is_the_albedo() {
    for (rho, n) in [(0.3, 1.5), (0.9, 1.01), (0.999, 50.0)] {
        let coated = Coated::new(rho, n);
        let passed = over_the_hemisphere(|cos, sin2| coated.leaving::<1>(cos, sin2).i());
        let scattered = coated.scattering() * passed * passed;
        assert!((scattered / coated.albedo() - 1.0).abs() < 1e-13);
    }
}

#[test]
fn light_inside_the_coat_adds_up_as_a_geometric_series() {
    // ρ(1 − r_i) leaves at once, and ρ r_i times what came before after each turn.
    let (rho, n) = (0.8, 1.5f64);
    let coated = Coated::new(rho, n);
    let inside = 1.0 - (1.0 - 0.091_777_959_342_351_21) / (n * n);
    let (mut turn, mut sum) = (rho, 0.0);
    for _ in 0..200 {
        sum += turn * (1.0 - inside);
        turn *= rho * inside;
    }
    assert!((sum / coated.returned() - 1.0).abs() < 1e-14);
}

#[test]
fn without_a_coat_the_base_is_lamberts() {
    let bare = Coated::new(0.7, 1.0);
    assert_eq!(bare.scattering().to_bits(), 0.7f64.to_bits());
    assert_eq!(bare.mirror(0.6, 0.64), Reflection::NONE);
    for cos in [1.0, 0.6, 0.0] {
        assert_eq!(
            bare.leaving::<4>(cos, 1.0 - cos * cos),
            Stokes::unpolarised(1.0)
        );
    }
}

#[test]
fn nothing_passes_a_coat_of_infinite_index() {
    for (rho, n) in [(0.5, f64::INFINITY), (1.0, f64::INFINITY), (1.0, 1e200)] {
        let coated = Coated::new(rho, n);
        assert_eq!(coated.albedo().to_bits(), 0);
        assert_eq!(coated.mirror(0.6, 0.64), Reflection::MIRROR);
        assert_eq!(coated.entering::<4>(0.6, 0.64), Analyser::unpolarised(0.0));
    }
}

#[test]
fn light_leaves_at_brewsters_angle_with_all_of_its_p_component() {
    // Ts = 1 − 25/169 and Tp = 1 for n = 1.5: t = (1 − 25/338, −25/338).
    let coated = Coated::new(0.5, 1.5);
    let [i, q, u, v] = coated
        .leaving::<4>((1.0 / 3.25f64).sqrt(), 2.25 / 3.25)
        .components();
    assert!((i - 313.0 / 338.0).abs() < 1e-15);
    assert!((q + 25.0 / 338.0).abs() < 1e-16);
    assert_eq!([u, v].map(f64::to_bits), [0; 2]);
}

#[test]
fn fewer_components_of_the_kernel_are_its_leading_ones() {
    let coated = Coated::new(0.5, 1.5);
    for cos in [1.0, 0.6, 1e-9] {
        let sin2 = (1.0 - cos) * (1.0 + cos);
        let full = coated.entering::<4>(cos, sin2).components();
        let linear = coated.entering::<3>(cos, sin2).components();
        let scalar = coated.entering::<1>(cos, sin2).components();
        let leaving = coated.leaving::<4>(cos, sin2).components();
        assert_eq!(bits(&full[..3]), bits(&linear));
        assert_eq!(bits(&full[..1]), bits(&scalar));
        assert_eq!(bits(&full), bits(&leaving));
    }
}

#[test]
fn grazing_light_enters_as_far_as_the_surface_lets_it() {
    // (Ts + Tp)/2 = 2μ(1 + n²)/√(n² − 1) to first order in μ.
    for n in [1.5f64, 10.0] {
        let t0 = Coated::new(0.5, n).entering::<1>(1e-9, 1.0).components()[0];
        let first_order = 2e-9 * (1.0 + n * n) / ((n - 1.0) * (n + 1.0)).sqrt();
        assert!((t0 / first_order - 1.0).abs() < 1e-7);
    }
}

fn bits(components: &[f64]) -> Vec<u64> {
    components
        .iter()
        .map(|component| component.to_bits())
        .collect()
}
