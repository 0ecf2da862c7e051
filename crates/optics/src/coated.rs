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
mod tests;
