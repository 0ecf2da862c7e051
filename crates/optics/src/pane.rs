//! The pane: one plane-parallel sheet that light passes.

use crate::{Index, Reflection, refraction::Refraction};

/// Light to and fro between the two faces of a sheet, at one angle of incidence. The sheet is thick
/// against the length of coherence, so what leaves after different numbers of turns adds by Stokes
/// vectors.
///
/// With Rs, Rp and c = r_s r_p of its outer face, Tj = 1 − Rj, and A = τ^(1/cos θ′) the transmittance
/// of one crossing at the angle θ′ inside (τ that along the normal), the sheet reflects
///
/// Rj′ = Rj (1 + Tj² A²/(1 − Rj² A²)), C_R = c (1 + Ts Tp A²/(1 − c² A²))
///
/// and transmits
///
/// Tj′ = Tj² A/(1 − Rj² A²), C_T = Ts Tp A/(1 − c² A²).
///
/// Both depolarise: C² < the product of the two.
pub(crate) struct Pane {
    face: Reflection,
    inside: Refraction,
    /// A.
    crossing: f64,
    /// 1 − A².
    lost: f64,
    /// 1 − Rs² A² and 1 − Rp² A².
    across: (f64, f64),
    /// Ts Tp/(1 − c² A²).
    coherence: f64,
}

impl Pane {
    /// The sheet of the real relative index `n` > 0 and the inner transmittance `tau`, 0 … 1, at the
    /// angle of incidence given by cos θ and sin² θ; `None` where nothing enters.
    #[inline]
    fn new(n: f64, tau: f64, cos_incidence: f64, sin2_incidence: f64) -> Option<Self> {
        debug_assert!((0.0..=1.0).contains(&tau), "no transmittance: {tau}");
        let inside = Refraction::new(n, cos_incidence, sin2_incidence)?;
        let face = Index::new(n, 0.0).reflection(cos_incidence, sin2_incidence);
        let (crossing, lost) = if tau >= 1.0 {
            (1.0, 0.0)
        } else {
            let exponent = libm::log(tau) / inside.cos;
            (libm::exp(exponent), -libm::expm1(2.0 * exponent))
        };
        let (rs, rp) = (face.rs(), face.rp());
        let Refraction { ts, tp, .. } = inside;
        // 1 − Ra Rb A² = (1 − Ra Rb) + Ra Rb (1 − A²) and 1 − Ra Rb = Ta + Ra Tb: sums, which keep
        // their digits at grazing incidence.
        let remainder = |ta: f64, ra: f64, tb: f64, rb: f64| ta + ra * tb + ra * rb * lost;
        Some(Self {
            face,
            inside,
            crossing,
            lost,
            across: (remainder(ts, rs, ts, rs), remainder(tp, rp, tp, rp)),
            coherence: ts * share(tp, remainder(ts, rs, tp, rp)),
        })
    }

    /// What the sheet reflects.
    #[inline]
    pub(crate) fn reflection(
        n: f64,
        tau: f64,
        cos_incidence: f64,
        sin2_incidence: f64,
    ) -> Reflection {
        let Some(pane) = Self::new(n, tau, cos_incidence, sin2_incidence) else {
            return Index::new(n, 0.0).reflection(cos_incidence, sin2_incidence);
        };
        let (rs, rp) = (pane.face.rs(), pane.face.rp());
        let Refraction { ts, tp, .. } = pane.inside;
        let (s, p) = (share(ts, pane.across.0), share(tp, pane.across.1));
        let (lost_s, lost_p) = (
            share(pane.lost, pane.across.0),
            share(pane.lost, pane.across.1),
        );
        let twice = pane.crossing * pane.crossing;
        // (Rs′ − Rp′)/(Rs − Rp), from the difference of the two fractions by algebra.
        let steepness = 1.0
            - twice
                * (rs * rp * (s * lost_p + rs * p * lost_s) + s * p * (2.0 * rs * rp - ts * tp));
        Reflection::from_elements(
            pane.face.mean() + 0.5 * twice * (rs * ts * s + rp * tp * p),
            pane.face.half_difference() * steepness,
            pane.face.c() * (1.0 + twice * pane.coherence),
            0.0,
        )
    }

    /// What the sheet transmits, as a matrix of the same form: in the direction of the light that
    /// arrives, in the basis in which it arrives.
    #[inline]
    pub(crate) fn transmission(
        n: f64,
        tau: f64,
        cos_incidence: f64,
        sin2_incidence: f64,
    ) -> Reflection {
        let Some(pane) = Self::new(n, tau, cos_incidence, sin2_incidence) else {
            return Reflection::NONE;
        };
        let (rs, rp) = (pane.face.rs(), pane.face.rp());
        let Refraction { ts, tp, .. } = pane.inside;
        let (s, p) = (share(ts, pane.across.0), share(tp, pane.across.1));
        let (lost_s, lost_p) = (
            share(pane.lost, pane.across.0),
            share(pane.lost, pane.across.1),
        );
        // −(Ts′ − Tp′)/(A (Rs − Rp)), likewise.
        let steepness = 2.0 * s * p + s * rp * lost_p + p * rs * lost_s;
        Reflection::from_elements(
            0.5 * pane.crossing * (ts * s + tp * p),
            -pane.face.half_difference() * pane.crossing * steepness,
            pane.crossing * pane.coherence,
            0.0,
        )
    }
}

/// `part`/`whole`, both ≥ 0; 0 where both vanish, at grazing incidence itself, where all light is
/// reflected.
#[inline]
fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

#[cfg(test)]
mod tests;
