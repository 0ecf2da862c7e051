//! The coated diffuser: a Lambertian base under a smooth clear coat.

use crate::{Analyser, Emergence, Incidence, Index, Reflection, Stokes, refraction::Refraction};

/// A Lambertian base of albedo ρ under a smooth coat of index n that absorbs nothing.
///
/// The coat reflects by Fresnel's formulae. What it lets through is scattered by the base, and leaves
/// through the coat after any number of reflections at it from inside. The Mueller kernel of this
/// scattered part, per steradian of projected solid angle, is
///
/// ρ **t**ₒ **t**ᵢᵀ/(π n² (1 − ρ r_i)), **t** = (1 − (Rs + Rp)/2, −(Rs − Rp)/2, 0, 0)
///
/// at the angles of emergence and of incidence, in the basis whose **x** is the s axis. Here
/// r_i = 1 − (1 − r_e)/n² is the reflectance of the coat for diffuse light from inside and r_e that
/// from outside. Reciprocal; at ρ = 1 no light is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coated {
    rho: f64,
    n: f64,
    /// 1 − r_e.
    entered: f64,
    /// ρ/(n² (1 − ρ r_i)).
    scale: f64,
}

impl Coated {
    /// The diffuser of albedo `rho`, 0 … 1, under a coat of the relative index `n` ≥ 1. Where n is
    /// infinite nothing passes the coat, and this is the ideal mirror.
    #[must_use]
    pub fn new(rho: f64, n: f64) -> Self {
        debug_assert!(
            (0.0..=1.0).contains(&rho) && n >= 1.0,
            "no coat: {rho}, {n}"
        );
        let entered = hemispherical_transmittance(n);
        // n² (1 − ρ r_i) = n² (1 − ρ) + ρ (1 − r_e), a sum.
        let scale = if entered > 0.0 {
            rho / (n * n * (1.0 - rho) + rho * entered)
        } else {
            0.0
        };
        Self {
            rho,
            n,
            entered,
            scale,
        }
    }

    /// Albedo ρ of the base.
    #[must_use]
    pub const fn rho(&self) -> f64 {
        self.rho
    }

    /// Refractive index n of the coat relative to the room.
    #[must_use]
    pub const fn n(&self) -> f64 {
        self.n
    }

    /// r_e, the share of unpolarised diffuse light that the coat reflects.
    #[must_use]
    pub const fn hemispherical_reflectance(&self) -> f64 {
        1.0 - self.entered
    }

    /// The reflection at the coat.
    #[inline]
    pub(crate) fn mirror(&self, cos_incidence: f64, sin2_incidence: f64) -> Reflection {
        Index::new(self.n, 0.0).reflection(cos_incidence, sin2_incidence)
    }

    /// π times the kernel is this times **t**ₒ **t**ᵢᵀ.
    #[inline]
    pub(crate) const fn scattering(&self) -> f64 {
        self.scale
    }

    /// **t**ᵢ as a row.
    #[inline]
    pub(crate) fn entering<const N: usize>(
        &self,
        cos_incidence: f64,
        sin2_incidence: f64,
    ) -> Analyser<N, Incidence> {
        Analyser::new(self.transmission(cos_incidence, sin2_incidence))
    }

    /// **t**ₒ as a column.
    #[inline]
    pub(crate) fn leaving<const N: usize>(
        &self,
        cos_emergence: f64,
        sin2_emergence: f64,
    ) -> Stokes<N, Emergence> {
        Stokes::new(self.transmission(cos_emergence, sin2_emergence))
    }

    /// The share of light entering the coat that leaves it scattered, ρ (1 − r_i)/(1 − ρ r_i).
    #[inline]
    pub(crate) const fn returned(&self) -> f64 {
        self.scale * self.entered
    }

    /// The share of unpolarised diffuse light that is scattered.
    #[inline]
    pub(crate) const fn albedo(&self) -> f64 {
        self.returned() * self.entered
    }

    /// The share of unpolarised light that arrives at this angle and is scattered.
    #[inline]
    pub(crate) fn scattered(&self, cos_incidence: f64, sin2_incidence: f64) -> f64 {
        let [t0] = self.transmission(cos_incidence, sin2_incidence);
        self.returned() * t0
    }

    /// The greatest such share for any state of polarisation, but no more than the mirror-like part
    /// leaves for every state.
    #[inline]
    pub(crate) fn diffuse_bound(&self, cos_incidence: f64, sin2_incidence: f64) -> f64 {
        let [t0, t1, _] = self.transmission(cos_incidence, sin2_incidence);
        let left = 1.0 - self.mirror(cos_incidence, sin2_incidence).bound();
        (self.returned() * (t0 + t1.abs())).min(left.max(0.0))
    }

    /// The leading components of **t**; its first is (Ts + Tp)/2, accurate relative to itself where it
    /// vanishes.
    #[inline]
    fn transmission<const N: usize>(&self, cos: f64, sin2: f64) -> [f64; N] {
        let mut transmission = [0.0; N];
        if let Some(refraction) = Refraction::new(self.n, cos, sin2) {
            transmission[0] = refraction.mean();
            if N > 1 {
                transmission[1] = -self.mirror(cos, sin2).half_difference();
            }
        }
        transmission
    }
}

/// 1 − r_e = ∫₀¹ (Ts + Tp)/2 dμ², for n ≥ 1.
///
/// In s = cos θ/cos θ′, from 0 to 1, the integrand is rational:
/// dμ² = 2(n² − 1) n² s/(n² − s²)² ds, Ts = 4ns/(s + n)², Tp = 4ns/(ns + 1)². The part of Ts is
/// 4(2n + 1)/(3(n + 1)²). The closed form of the other (Duntley 1942), rational terms and logarithms,
/// cancels for n next to 1, so that part is summed by Gauss's rule on intervals that shrink towards
/// both ends, next to which lie the poles −1/n and n.
fn hemispherical_transmittance(n: f64) -> f64 {
    if n - 1.0 == 0.0 {
        return 1.0;
    }
    if Refraction::new(n, 1.0, 0.0).is_none() {
        return 0.0;
    }
    // `ahead` is n − s.
    let of_p = |s: f64, ahead: f64| {
        let difference = ahead * (n + s);
        let passed = n * s / (n * s + 1.0);
        8.0 * ((n - 1.0) * (n + 1.0) / difference) * (n / difference) * (passed * passed)
    };
    let p = graded(1.0 / n, |s| of_p(s, n - s)) + graded(n - 1.0, |x| of_p(1.0 - x, n - 1.0 + x));
    let s = 4.0 / 3.0 * ((2.0 * n + 1.0) / (n + 1.0)) / (n + 1.0);
    0.5 * (s + p)
}

/// ∫ f from 0 to ½, on intervals halved towards 0 until none is wider than `scale`, the distance of
/// the nearest pole beyond 0.
fn graded(scale: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut edge) = (0.0, 0.5);
    while edge > scale {
        sum += gauss(0.5 * edge, edge, &f);
        edge *= 0.5;
    }
    sum + gauss(0.0, edge, &f)
}

/// Positive nodes and their weights of the twelve-point rule of Gauss and Legendre on [−1, 1].
const NODES: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_8),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_4, 0.203_167_426_723_065_92),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_23),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_43),
    (0.981_560_634_246_719_3, 0.047_175_336_386_511_83),
];

/// ∫ f from `from` to `to`. A pole as far from the nearer end as the interval is wide leaves an error
/// of some (3 + √8)⁻²⁴ = 4·10⁻¹⁹.
fn gauss(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    let sum: f64 = NODES
        .iter()
        .map(|&(node, weight)| weight * (f(centre - half * node) + f(centre + half * node)))
        .sum();
    half * sum
}

#[cfg(test)]
mod tests {
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
            assert_eq!(full[..3].as_ref().map_bits(), linear.as_ref().map_bits());
            assert_eq!(full[..1].as_ref().map_bits(), scalar.as_ref().map_bits());
            assert_eq!(
                full.as_ref().map_bits(),
                coated
                    .leaving::<4>(cos, sin2)
                    .components()
                    .as_ref()
                    .map_bits()
            );
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

    trait MapBits {
        fn map_bits(&self) -> Vec<u64>;
    }

    impl MapBits for [f64] {
        fn map_bits(&self) -> Vec<u64> {
            self.iter().map(|x| x.to_bits()).collect()
        }
    }
}
