//! Reflectors: what a surface does to light.

use crate::{
    Analyser, Coated, Emergence, Incidence, Index, Reflection, Representation, Stokes, pane::Pane,
};

/// A reflector.
///
/// It reflects in two ways. The mirror-like part, [`mirror`](Self::mirror), goes into one direction
/// and keeps polarisation; a pane also lets light [`through`](Self::through). The scattered part
/// forgets how the light came: it is the kernel
///
/// [`scattering`](Self::scattering)/π × [`leaving`](Self::leaving) × [`entering`](Self::entering)
///
/// per steradian of projected solid angle, an outer product, so light between two scatterings is one
/// number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Eq. 21: a·M_Fresnel + (1 − a)·M_Lambert, where M_Lambert is zero but for ρ in its corner.
    Mixture {
        /// Reflectance ρ of the Lambertian part, 0 … 1.
        rho: f64,
        /// Fraction a of the mirror-like part, 0 … 1.
        fraction: f64,
        /// Refractive index of the mirror-like part.
        index: Index,
    },
    /// A Lambertian base under a smooth clear coat.
    Coated(Coated),
    /// One plane-parallel sheet, thick against the length of coherence: the light that turns between
    /// its faces adds up without interference.
    Pane {
        /// Refractive index of the sheet relative to the room, > 0.
        n: f64,
        /// Transmittance of one crossing along the normal, its faces left out, 0 … 1.
        tau: f64,
    },
}

impl Material {
    /// The mirror-like reflection at the angle of incidence θ, given by cos θ and sin² θ; zero where
    /// the material has no such part. That of a pane comes from all its turns and depolarises.
    #[must_use]
    #[inline]
    pub fn mirror(&self, cos_incidence: f64, sin2_incidence: f64) -> Reflection {
        match self {
            Self::Mixture { fraction: 0.0, .. } => Reflection::NONE,
            Self::Mixture {
                fraction, index, ..
            } => index.reflection(cos_incidence, sin2_incidence) * *fraction,
            Self::Coated(coated) => coated.mirror(cos_incidence, sin2_incidence),
            Self::Pane { n, tau } => Pane::reflection(*n, *tau, cos_incidence, sin2_incidence),
        }
    }

    /// What passes a pane, at the angle of incidence θ, given by cos θ and sin² θ: a matrix of the same
    /// form as a reflection's, for light that keeps its direction and its s axis. Zero for any other
    /// material.
    #[must_use]
    #[inline]
    pub fn through(&self, cos_incidence: f64, sin2_incidence: f64) -> Reflection {
        match self {
            Self::Pane { n, tau } => Pane::transmission(*n, *tau, cos_incidence, sin2_incidence),
            Self::Mixture { .. } | Self::Coated(_) => Reflection::NONE,
        }
    }

    /// Whether light passes the material, in its own direction.
    #[must_use]
    #[inline]
    pub const fn is_pane(&self) -> bool {
        matches!(self, Self::Pane { .. })
    }

    /// π times the scale of the scattering kernel: (1 − a)ρ for the mixture, ρ/(n² (1 − ρ r_i)) under a
    /// coat.
    #[must_use]
    #[inline]
    pub const fn scattering(&self) -> f64 {
        match self {
            Self::Mixture { rho, fraction, .. } => (1.0 - *fraction) * *rho,
            Self::Coated(coated) => coated.scattering(),
            Self::Pane { .. } => 0.0,
        }
    }

    /// Whether scattered light is polarised, and the share scattered depends on polarisation.
    #[must_use]
    #[inline]
    pub fn polarises_scattering(&self) -> bool {
        matches!(self, Self::Coated(coated) if coated.n() > 1.0)
    }

    /// What the scattered part takes of light that arrives at the angle of incidence θ, given by cos θ
    /// and sin² θ, without the scale of the kernel: (1, 0, 0, 0) for the mixture.
    #[must_use]
    #[inline]
    pub fn entering<const N: usize>(
        &self,
        cos_incidence: f64,
        sin2_incidence: f64,
    ) -> Analyser<N, Incidence> {
        match self {
            Self::Coated(coated) => coated.entering(cos_incidence, sin2_incidence),
            Self::Mixture { .. } | Self::Pane { .. } => Analyser::intensity(),
        }
    }

    /// The state in which the scattered part leaves at the angle θ to the normal, given by cos θ and
    /// sin² θ, in the basis whose **x** is the s axis: (1, 0, 0, 0) for the mixture.
    #[must_use]
    #[inline]
    pub fn leaving<const N: usize>(
        &self,
        cos_emergence: f64,
        sin2_emergence: f64,
    ) -> Stokes<N, Emergence> {
        match self {
            Self::Coated(coated) => coated.leaving(cos_emergence, sin2_emergence),
            Self::Mixture { .. } | Self::Pane { .. } => Stokes::unpolarised(1.0),
        }
    }

    /// The probability with which a walk that meets the surface at the angle θ, given by cos θ and
    /// sin² θ, scatters: the greatest share scattered for any state of polarisation, as far as the
    /// mirror-like part leaves room for it.
    ///
    /// With the bound of [`mirror`](Self::mirror) it adds up to at most 1.
    #[must_use]
    #[inline]
    pub fn diffuse_bound(&self, cos_incidence: f64, sin2_incidence: f64) -> f64 {
        match self {
            Self::Coated(coated) => coated.diffuse_bound(cos_incidence, sin2_incidence),
            Self::Mixture { .. } | Self::Pane { .. } => self.scattering(),
        }
    }

    /// The share of unpolarised light from all sides that is scattered: (1 − a)ρ for the mixture,
    /// ρ (1 − r_e)²/(n² (1 − ρ r_i)) under a coat.
    #[must_use]
    #[inline]
    pub const fn albedo(&self) -> f64 {
        match self {
            Self::Coated(coated) => coated.albedo(),
            Self::Mixture { .. } | Self::Pane { .. } => self.scattering(),
        }
    }

    /// Whether no light is lost at any angle: all that is neither mirrored nor let through at normal
    /// incidence is scattered.
    #[must_use]
    pub fn is_lossless(&self) -> bool {
        let scattered = match self {
            Self::Coated(coated) => coated.scattered(1.0, 0.0),
            Self::Mixture { .. } | Self::Pane { .. } => self.scattering(),
        };
        let passed = self.mirror(1.0, 0.0).mean() + self.through(1.0, 0.0).mean();
        scattered + passed >= 1.0 - 1e-12
    }

    /// The least representation that is exact for this material.
    ///
    /// Without a mirror-like part, or where the index is the room's own, nothing is polarised.
    /// A dielectric met from the thinner side, alone, as a coat or as a pane, and the ideal mirror do
    /// not turn U into V; metals and total reflection do.
    #[must_use]
    pub fn representation(&self) -> Representation {
        let index = match *self {
            Self::Mixture { fraction: 0.0, .. } => return Representation::Intensity,
            Self::Mixture { index, .. } => index,
            Self::Coated(coated) => Index::new(coated.n(), 0.0),
            Self::Pane { n, .. } => Index::new(n, 0.0),
        };
        match index {
            Index::Relative { n: 1.0, k: 0.0 } => Representation::Intensity,
            Index::Relative { n, k } if n < 1.0 || k > 0.0 => Representation::Full,
            _ => Representation::Linear,
        }
    }

    /// The standard diffuse model of the same surface: a = 0, so ρ is reflected and nothing mirrored.
    /// Of a coated diffuser its base remains; a pane stays what it is.
    #[must_use]
    pub fn without_fresnel(self) -> Self {
        let (rho, index) = match self {
            Self::Mixture { rho, index, .. } => (rho, index),
            Self::Coated(coated) => (coated.rho(), Index::new(coated.n(), 0.0)),
            Self::Pane { .. } => return self,
        };
        Self::Mixture {
            rho,
            fraction: 0.0,
            index,
        }
    }
}

#[cfg(test)]
mod tests;
