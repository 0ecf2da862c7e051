//! Fresnel's formulae in forms that hold at any angle and for any index.

use crate::Reflection;

/// Refractive index of a reflector relative to the room.
///
/// ```
/// use malus_optics::Index;
///
/// let glass = Index::new(1.5, 0.0).reflection(1.0, 0.0);
/// assert!((glass.mean() - 0.04).abs() < 1e-16);
/// assert_eq!(Index::new(f64::INFINITY, 0.0), Index::Mirror);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Index {
    /// The ideal mirror, n = ∞: a reflector of its own, which reflects all light at any angle.
    Mirror,
    /// The index n + ik, in the time factor exp(−iωt).
    Relative {
        /// Refractive index n > 0. Below 1, light meets the reflector from the denser side.
        n: f64,
        /// Extinction k ≥ 0; 0 for a dielectric.
        k: f64,
    },
}

/// Beyond this |n + ik| its square nears the end of f64, and a reflector is the ideal mirror to more
/// digits than f64 has at any angle that f64 tells from grazing.
pub(crate) const LARGEST: f64 = 1e100;

impl Index {
    /// The index n + ik with n > 0 and k ≥ 0; the ideal mirror where either is infinite.
    #[must_use]
    pub fn new(n: f64, k: f64) -> Self {
        debug_assert!(n > 0.0 && k >= 0.0, "no index: {n} + {k}i");
        if n.is_infinite() || k.is_infinite() {
            Self::Mirror
        } else {
            Self::Relative { n, k }
        }
    }

    /// The reflection of light that arrives at the angle of incidence θ, given by cos θ ≥ 0 and
    /// sin² θ (see [`angle_of_incidence`](crate::angle_of_incidence)).
    ///
    /// With μ = cos θ, e = n² − 1 (n complex) and q = √(e + μ²), Im q ≥ 0:
    ///
    /// r_s = −e/(μ + q)², r_p = −r_s (μq − sin² θ)/(μq + sin² θ)
    ///
    /// Rs − Rp = Rs · 4μ sin² θ Re q/|μq + sin² θ|²
    ///
    /// Exact to rounding at normal and grazing incidence, next to Brewster's angle, for n next to 1,
    /// and in total reflection. Nothing is reflected where n is 1 and k is 0.
    #[must_use]
    #[inline]
    pub fn reflection(self, cos_incidence: f64, sin2_incidence: f64) -> Reflection {
        let Self::Relative { n, k } = self else {
            return Reflection::MIRROR;
        };
        if n.max(k) > LARGEST {
            return Reflection::MIRROR;
        }
        let (mu, s2) = (cos_incidence, sin2_incidence);
        let e = ((n - 1.0) * (n + 1.0) - k * k, 2.0 * n * k);
        let e_modulus = modulus(e.0, e.1);
        if e_modulus == 0.0 {
            return Reflection::NONE;
        }
        // e + μ² = n² − sin² θ: of the two forms, the one whose terms cancel less.
        let square = if s2 < 0.5 {
            (n - k) * (n + k) - s2
        } else {
            e.0 + mu * mu
        };
        let (q_re, q_im) = principal_root(square, e.1);

        let amplitude = e_modulus / ((mu + q_re) * (mu + q_re) + q_im * q_im);
        let rs = amplitude * amplitude;

        // μq = a + ib; then |μq ± s2|² = a² + b² + s2² ± 2a·s2 gives every element without cancellation
        // but that of a − s2, which is Brewster's zero itself.
        let (a, b) = (mu * q_re, mu * q_im);
        let across = (a + s2) * (a + s2) + b * b;
        if across == 0.0 {
            // Normal incidence on an index whose square underflows: r_p = −r_s as at any normal incidence.
            return Reflection::from_elements(rs, 0.0, -rs, 0.0);
        }
        let share = rs / across;
        Reflection::from_elements(
            share * (a * a + b * b + s2 * s2),
            share * (2.0 * a * s2),
            -share * ((a - s2) * (a + s2) + b * b),
            share * (2.0 * b * s2),
        )
    }
}

/// |re + i·im|, without overflow or underflow of the squares.
#[inline]
fn modulus(re: f64, im: f64) -> f64 {
    let (re, im) = (re.abs(), im.abs());
    let (large, small) = if re > im { (re, im) } else { (im, re) };
    if small == 0.0 {
        return large;
    }
    let ratio = small / large;
    large * (1.0 + ratio * ratio).sqrt()
}

/// √(re + i·im) for im ≥ 0: both parts of the root are ≥ 0, and neither is a difference.
#[inline]
fn principal_root(re: f64, im: f64) -> (f64, f64) {
    let greater = (0.5 * (modulus(re, im) + re.abs())).sqrt();
    if greater == 0.0 {
        return (0.0, 0.0);
    }
    let lesser = if im > 0.0 { 0.5 * im / greater } else { 0.0 };
    if re >= 0.0 {
        (greater, lesser)
    } else {
        (lesser, greater)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Asserts agreement relative to the expected value.
    fn assert_relative(actual: f64, expected: f64, tolerance: f64) {
        assert!(
            (actual / expected - 1.0).abs() <= tolerance,
            "{actual} is not {expected}"
        );
    }

    fn at_degrees(n: f64, k: f64, degrees: f64) -> Reflection {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Index::new(n, k).reflection(cos, sin * sin)
    }

    #[test]
    fn glass_at_45_degrees() {
        let glass = at_degrees(1.5, 0.0, 45.0);
        assert_relative(glass.rs(), 0.092_013_36, 5e-8);
        assert_relative(glass.rp(), 0.008_466_46, 6e-7);
        assert_relative(glass.rp(), glass.rs() * glass.rs(), 1e-14);
        assert_relative(glass.c(), -0.027_911_06, 2e-7);
        assert_relative(glass.half_difference() / glass.mean(), 0.831_479_42, 1e-8);
        assert_eq!(glass.w().to_bits(), 0f64.to_bits());
    }

    #[test]
    fn glass_at_brewsters_angle_reflects_s_light_only() {
        // tan θ = n; eq. 9: ½ cos² 2θ in the leading block of ones, and cos² 2θ = Rs = 25/169.
        let glass = Index::new(1.5, 0.0).reflection(1.0 / 3.25f64.sqrt(), 2.25 / 3.25);
        assert_relative(glass.mean(), 25.0 / 338.0, 1e-15);
        assert_relative(glass.half_difference(), 25.0 / 338.0, 1e-15);
        assert!(glass.rp() < 1e-32 && glass.c().abs() < 1e-16);
    }

    #[test]
    fn the_signed_product_passes_through_zero_at_brewsters_angle() {
        // d(r_s r_p)/dθ there is Rs (1 + n²)²/(2n³), with Rs = ((n² − 1)/(n² + 1))².
        let n = 1.5f64;
        let (sin, cos) = (n / 3.25f64.sqrt(), 1.0 / 3.25f64.sqrt());
        let slope = 25.0 / 169.0 * 3.25 * 3.25 / (2.0 * n * n * n);
        for offset in [1e-9, -1e-9] {
            // cos(θ + δ) and sin²(θ + δ) to first order, which δ² = 10⁻¹⁸ makes exact.
            let beside = Index::new(n, 0.0)
                .reflection(cos - offset * sin, sin * sin + 2.0 * offset * sin * cos);
            // μq − sin² θ ≈ 10⁻⁹ holds rounding errors of some 10⁻¹⁶.
            assert_relative(beside.c(), slope * offset, 2e-6);
            assert_relative(beside.rp(), (slope * offset).powi(2) / (25.0 / 169.0), 4e-6);
            assert_relative(beside.mean(), 25.0 / 338.0, 1e-8);
        }
    }

    #[test]
    fn normal_incidence_is_eq_8() {
        for n in [0.2, 0.9, 1.0 + 1e-12, 1.5, 4.0, 1e3, 1e9] {
            let normal = Index::new(n, 0.0).reflection(1.0, 0.0);
            let r = (n - 1.0) / (n + 1.0);
            assert_relative(normal.mean(), r * r, 4e-15);
            assert_relative(normal.c(), -r * r, 4e-15);
            assert_eq!(
                [normal.half_difference(), normal.w()].map(f64::to_bits),
                [0; 2]
            );
        }
    }

    #[test]
    fn the_difference_of_reflectances_is_accurate_next_to_normal_incidence() {
        // Rs − Rp = 4 sin² θ · R0/n to first order in sin² θ, since μ, Re q → 1, n.
        for n in [1.0 + 1e-12, 1.5, 1e3] {
            for sin in [1e-4, 1e-8, 1e-12, 1e-100] {
                let (cos, sin2) = (f64::sqrt(1.0 - sin * sin), sin * sin);
                let near = Index::new(n, 0.0).reflection(cos, sin2);
                let r = (n - 1.0) / (n + 1.0);
                assert_relative(
                    2.0 * near.half_difference(),
                    4.0 * sin2 * r * r / n,
                    4.0 * sin2 + 1e-14,
                );
            }
        }
    }

    #[test]
    fn gold_turns_light_at_plus_45_degrees_into_right_handed() {
        // W > 0: U > 0 before, V > 0 after.
        let gold = at_degrees(0.183, 3.43, 45.0);
        assert_relative(gold.mean(), 0.942_478_48, 6e-9);
        assert_relative(gold.half_difference(), 0.018_670_71, 3e-7);
        assert_relative(gold.c(), -0.868_822_41, 6e-9);
        assert_relative(gold.w(), 0.364_780_36, 2e-8);
    }

    #[test]
    fn total_reflection_in_half_a_fresnel_rhomb_delays_by_an_eighth() {
        let rhomb = at_degrees(1.0 / 1.49661, 0.0, 51.782);
        // The index and the angle are given to five digits.
        assert_relative(rhomb.c(), 0.5f64.sqrt(), 1e-4);
        assert_relative(rhomb.w(), 0.5f64.sqrt(), 1e-4);
        assert_relative(rhomb.mean(), 1.0, 1e-15);
        assert!(rhomb.half_difference().abs() < 1e-15);
    }

    #[test]
    fn the_hemispherical_reflectance_of_glass() {
        // ∫₀¹ 2μ (Rs + Rp)/2 dμ by Simpson's rule on 2000 intervals.
        let glass = Index::new(1.5, 0.0);
        let at = |step: u32| {
            let mu = f64::from(step) / 2000.0;
            2.0 * mu * glass.reflection(mu, (1.0 - mu) * (1.0 + mu)).mean()
        };
        let weight = |step: u32| if step % 2 == 1 { 4.0 } else { 2.0 };
        let sum: f64 =
            at(0) + at(2000) + (1..2000).map(|step| weight(step) * at(step)).sum::<f64>();
        assert!((sum / 6000.0 - 0.091_777_959_3).abs() < 1e-10);
    }

    #[test]
    fn all_light_is_reflected_at_grazing_incidence() {
        for (n, k) in [
            (1.0 + 1e-12, 0.0),
            (1.000_003, 0.0),
            (1.5, 0.0),
            (1e3, 0.0),
            (0.5, 0.0),
            (0.183, 3.43),
            (1.0, 1e-9),
            (1.0, 1e-200),
        ] {
            let grazing = Index::new(n, k).reflection(0.0, 1.0);
            assert_relative(grazing.rs(), 1.0, 1e-15);
            assert_relative(grazing.rp(), 1.0, 1e-15);
            // r_s = r_p = −1 in Verdet's sign.
            assert_relative(grazing.c(), 1.0, 1e-15);
        }
    }

    #[test]
    fn a_nanoradian_from_grazing_the_loss_is_of_first_order() {
        // 1 − Rs = 4μ/√e and 1 − Rp = 4μ n²/√e, for μ = 10⁻⁹.
        for n in [1.5f64, 10.0] {
            let near = Index::new(n, 0.0).reflection(1e-9, 1.0);
            let root = (n * n - 1.0).sqrt();
            assert_relative(1.0 - near.rs(), 4e-9 / root, 1e-6);
            assert_relative(1.0 - near.rp(), 4e-9 * n * n / root, 1e-6);
        }
    }

    #[test]
    fn nothing_is_reflected_where_nothing_differs() {
        for (cos, sin2) in [(1.0, 0.0), (0.6, 0.64), (1e-9, 1.0), (0.0, 1.0)] {
            assert_eq!(Index::new(1.0, 0.0).reflection(cos, sin2), Reflection::NONE);
        }
    }

    #[test]
    fn the_ideal_mirror_reflects_all_light_alike() {
        for index in [
            Index::new(f64::INFINITY, 0.0),
            Index::new(1.0, f64::INFINITY),
            Index::new(1e200, 0.0),
        ] {
            for (cos, sin2) in [(1.0, 0.0), (0.6, 0.64), (0.0, 1.0)] {
                assert_eq!(index.reflection(cos, sin2), Reflection::MIRROR);
            }
        }
        assert_eq!(Index::new(1.0, f64::INFINITY), Index::Mirror);
        // A large index comes near to it away from grazing: 1 − Rp = 4/(nμ) to first order.
        let near = Index::new(1e9, 0.0).reflection(0.6, 0.64);
        assert_relative(1.0 - near.rp(), 4e-9 / 0.6, 1e-6);
        assert_relative(1.0 + near.c(), 2e-9 * (0.6 + 1.0 / 0.6), 1e-6);
    }

    #[test]
    fn no_index_and_no_angle_give_anything_but_numbers() {
        for n in [
            1e-300,
            1e-9,
            0.5,
            1.0 - 1e-16,
            1.0,
            1.0 + 3e-16,
            2.0,
            1e99,
            1e101,
            1e300,
        ] {
            for k in [0.0, 1e-300, 1e-9, 1.0, 1e99, 1e300] {
                for sin in [0.0, 1e-300, 1e-150, 1e-9, 0.5, n, 1.0] {
                    let sin2 = f64::min(sin * sin, 1.0);
                    let reflection = Index::new(n, k).reflection((1.0 - sin2).sqrt(), sin2);
                    let (rs, rp) = (reflection.rs(), reflection.rp());
                    assert!(
                        (0.0..=1.0 + 1e-15).contains(&rs),
                        "Rs = {rs} at n = {n}, k = {k}, sin = {sin}"
                    );
                    assert!(
                        (0.0..=1.0 + 1e-15).contains(&rp),
                        "Rp = {rp} at n = {n}, k = {k}, sin = {sin}"
                    );
                    assert!(
                        reflection.c().abs() <= 1.0 + 1e-15 && reflection.w().abs() <= 1.0 + 1e-15
                    );
                    assert!(reflection.bound() <= 1.0 + 1e-15);
                }
            }
        }
    }

    proptest! {
        #[test]
        fn reflected_and_transmitted_light_add_up(n in 1.0..20.0, mu in 0.0..=1.0) {
            // T_s = 4μq/(μ + q)², T_p = 4n²μq/(n²μ + q)².
            let s2 = (1.0 - mu) * (1.0 + mu);
            let reflection = Index::new(n, 0.0).reflection(mu, s2);
            let q = f64::sqrt((n - 1.0) * (n + 1.0) + mu * mu);
            let ts = 4.0 * mu * q / ((mu + q) * (mu + q));
            let tp = 4.0 * n * n * mu * q / ((n * n * mu + q) * (n * n * mu + q));
            prop_assert!((reflection.rs() + ts - 1.0).abs() < 2e-15);
            prop_assert!((reflection.rp() + tp - 1.0).abs() < 2e-15);
        }

        #[test]
        fn the_forms_of_eq_7_agree_where_they_hold(n in 1.05..4.0f64, theta in 0.05..1.5f64) {
            let refracted = (f64::sin(theta) / n).asin();
            let (difference, sum) = (theta - refracted, theta + refracted);
            let rs = (difference.sin() / sum.sin()).powi(2);
            let rp = (difference.tan() / sum.tan()).powi(2);
            let reflection = Index::new(n, 0.0).reflection(theta.cos(), theta.sin().powi(2));
            // θ − θ′ cancels for n next to 1, and tan(θ + θ′) is sensitive next to Brewster's angle.
            prop_assert!((reflection.rs() - rs).abs() < 1e-13 * (rs + 1e-3));
            prop_assert!((reflection.rp() - rp).abs() < 1e-13 * (rp + 1e-3));
        }

        #[test]
        fn one_pair_of_amplitudes_makes_all_elements(n in 0.05..10.0, k in 0.0..10.0, mu in 0.0..=1.0) {
            let reflection = Index::new(n, k).reflection(mu, (1.0 - mu) * (1.0 + mu));
            let (mean, half) = (reflection.mean(), reflection.half_difference());
            let product = reflection.c().powi(2) + reflection.w().powi(2);
            prop_assert!((mean * mean - half * half - product).abs() < 1e-15);
            prop_assert!(half >= 0.0 && reflection.w() >= 0.0);
        }
    }
}
