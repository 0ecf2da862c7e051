//! Transmission through a surface that absorbs nothing.

use crate::fresnel::LARGEST;

/// Light that passes the surface of a medium without absorption.
///
/// With μ = cos θ outside, q = √(n² − sin² θ) = n cos θ′ and θ′ inside:
///
/// Ts = 1 − Rs = 4μq/(μ + q)², Tp = 1 − Rp = 4n²μq/(n²μ + q)²
///
/// Neither is a difference, so both are accurate relative to themselves at grazing incidence, where
/// they vanish.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Refraction {
    /// Transmittance for light that oscillates across the plane of incidence.
    pub(crate) ts: f64,
    /// Transmittance for light that oscillates in the plane of incidence.
    pub(crate) tp: f64,
    /// cos θ′, the cosine of the angle inside.
    pub(crate) cos: f64,
}

impl Refraction {
    /// Into the relative index `n` > 0, at the angle of incidence given by cos θ and sin² θ; `None`
    /// where all light is reflected.
    #[inline]
    pub(crate) fn new(n: f64, cos_incidence: f64, sin2_incidence: f64) -> Option<Self> {
        let (mu, s2) = (cos_incidence, sin2_incidence);
        if n > LARGEST {
            return None;
        }
        let e = (n - 1.0) * (n + 1.0);
        if e == 0.0 {
            return Some(Self {
                ts: 1.0,
                tp: 1.0,
                cos: mu,
            });
        }
        // n² − sin² θ = (n² − 1) + μ²: of the two forms, the one whose terms cancel less.
        let square = if s2 < 0.5 { n * n - s2 } else { e + mu * mu };
        if square <= 0.0 {
            return None;
        }
        let q = square.sqrt();
        let (s, p) = (mu + q, n * n * mu + q);
        Some(Self {
            ts: 4.0 * (mu / s) * (q / s),
            tp: 4.0 * (n * n * mu / p) * (q / p),
            cos: q / n,
        })
    }

    /// (Ts + Tp)/2, the transmittance for unpolarised light.
    #[inline]
    pub(crate) fn mean(&self) -> f64 {
        0.5 * (self.ts + self.tp)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::Index;

    #[test]
    fn nothing_is_transmitted_beyond_the_critical_angle() {
        // sin θ = 0.8 > 1/1.5.
        assert!(Refraction::new(1.0 / 1.5, 0.6, 0.64).is_none());
        assert!(Refraction::new(1.0 / 1.2, 0.6, 0.64).is_some());
        assert!(Refraction::new(f64::INFINITY, 1.0, 0.0).is_none());
    }

    #[test]
    fn the_angle_inside_is_snells() {
        // sin θ = 0.9, n = 1.5: sin θ′ = 0.6.
        let inside = Refraction::new(1.5, 0.19f64.sqrt(), 0.81).unwrap();
        assert!((inside.cos - 0.8).abs() < 1e-15);
    }

    #[test]
    fn a_nanoradian_from_grazing_the_transmittance_is_of_first_order() {
        // Ts = 4μ/√(n² − 1), Tp = n² Ts, less terms of μ².
        for n in [1.5f64, 10.0] {
            let grazing = Refraction::new(n, 1e-9, 1.0).unwrap();
            let ts = 4e-9 / ((n - 1.0) * (n + 1.0)).sqrt();
            assert!((grazing.ts / ts - 1.0).abs() < 1e-8);
            assert!((grazing.tp / (n * n * ts) - 1.0).abs() < 1e-7);
        }
    }

    proptest! {
        #[test]
        fn reflected_and_transmitted_light_add_up(n in 0.1..20.0, mu in 0.0..=1.0) {
            let s2 = (1.0 - mu) * (1.0 + mu);
            let reflection = Index::new(n, 0.0).reflection(mu, s2);
            let (ts, tp) = Refraction::new(n, mu, s2).map_or((0.0, 0.0), |inside| (inside.ts, inside.tp));
            prop_assert!((reflection.rs() + ts - 1.0).abs() < 2e-15);
            prop_assert!((reflection.rp() + tp - 1.0).abs() < 2e-15);
            prop_assert!(ts <= 1.0 + 1e-15 && tp <= 1.0 + 1e-15);
        }
    }
}
