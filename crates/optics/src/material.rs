//! Reflectors: what a surface does to light.

use crate::{Analyser, Emergence, Incidence, Index, Reflection, Representation, Stokes};

/// A reflector.
///
/// It reflects in two ways. The mirror-like part, [`mirror`](Self::mirror), goes into one direction
/// and keeps polarisation. The scattered part forgets how the light came: it is the outer product
/// [`leaving`](Self::leaving) × [`entering`](Self::entering) over π, a kernel per steradian of
/// projected solid angle, so light between two scatterings is one number.
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
    /// A diffuser under a smooth dielectric coat.
    Coated(Coated),
    /// One plane-parallel sheet.
    Pane {
        /// Refractive index n > 0, real.
        n: f64,
        /// Inner transmittance at normal incidence, 0 … 1.
        tau: f64,
    },
}

/// A diffuser of albedo ρ under a smooth coat of index n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coated {
    rho: f64,
    n: f64,
}

impl Coated {
    /// Albedo ρ of the base, 0 … 1, under a coat of index n ≥ 1.
    #[must_use]
    pub const fn new(rho: f64, n: f64) -> Self {
        Self { rho, n }
    }
}

impl Material {
    /// Whether light passes through.
    #[must_use]
    pub const fn is_pane(&self) -> bool {
        matches!(self, Self::Pane { .. })
    }

    /// The mirror-like reflection at the angle of incidence θ, given by cos θ and sin² θ; zero where
    /// the material has no such part.
    #[must_use]
    #[inline]
    pub fn mirror(&self, cos_incidence: f64, sin2_incidence: f64) -> Reflection {
        let (fraction, index) = match *self {
            Self::Mixture {
                fraction, index, ..
            } => (fraction, index),
            Self::Coated(Coated { n, .. }) | Self::Pane { n, .. } => (1.0, Index::new(n, 0.0)),
        };
        if fraction == 0.0 {
            return Reflection::NONE;
        }
        index.reflection(cos_incidence, sin2_incidence) * fraction
    }

    /// The greatest mirror-like reflectance for any state of polarisation, a·max(Rs, Rp), at most 1.
    ///
    /// A walk decides by this bound, which no Stokes vector enters, so that it is the same walk
    /// whatever the number of components.
    #[must_use]
    #[inline]
    pub fn mirror_bound(&self, cos_incidence: f64, sin2_incidence: f64) -> f64 {
        self.mirror(cos_incidence, sin2_incidence).bound().min(1.0)
    }

    /// What the scattered part takes of light that arrives: ((1 − a)ρ, 0, 0, 0) for the mixture.
    ///
    /// The factor 1/π of the kernel is the estimator's.
    #[must_use]
    #[inline]
    pub fn entering<const N: usize>(&self, _cos_incidence: f64) -> Analyser<N, Incidence> {
        Analyser::unpolarised(self.albedo())
    }

    /// The state in which the scattered part leaves: (1, 0, 0, 0) for the mixture.
    #[must_use]
    #[inline]
    pub const fn leaving<const N: usize>(&self, _cos_emergence: f64) -> Stokes<N, Emergence> {
        Stokes::unpolarised(1.0)
    }

    /// The share of arriving unpolarised light that is scattered, (1 − a)ρ.
    #[must_use]
    #[inline]
    pub fn albedo(&self) -> f64 {
        match *self {
            Self::Mixture { rho, fraction, .. } => (1.0 - fraction) * rho,
            Self::Coated(Coated { rho, .. }) => rho,
            Self::Pane { .. } => 0.0,
        }
    }

    /// Whether no light is lost at any angle: all that is not mirrored at normal incidence is scattered.
    #[must_use]
    pub fn is_lossless(&self) -> bool {
        match *self {
            Self::Mixture { .. } => self.albedo() + self.mirror(1.0, 0.0).mean() >= 1.0 - 1e-12,
            Self::Coated(Coated { rho, .. }) => rho >= 1.0 - 1e-12,
            Self::Pane { tau, .. } => tau >= 1.0 - 1e-12,
        }
    }

    /// The least representation that is exact for this material.
    ///
    /// Without a mirror-like part, or where the index is the room's own, nothing is mirrored.
    /// A dielectric met from the thinner side and the ideal mirror do not turn U into V; metals and
    /// total reflection do.
    #[must_use]
    pub fn representation(&self) -> Representation {
        match *self {
            Self::Mixture { fraction: 0.0, .. }
            | Self::Mixture {
                index: Index::Relative { n: 1.0, k: 0.0 },
                ..
            } => Representation::Intensity,
            Self::Mixture {
                index: Index::Relative { n, k },
                ..
            } if n < 1.0 || k > 0.0 => Representation::Full,
            Self::Mixture { .. } | Self::Coated(_) | Self::Pane { .. } => Representation::Linear,
        }
    }

    /// The standard diffuse model of the same surface: a = 0, so ρ is reflected and nothing mirrored.
    #[must_use]
    pub const fn without_fresnel(self) -> Self {
        let (rho, index) = match self {
            Self::Mixture { rho, index, .. } => (rho, index),
            Self::Coated(Coated { rho, .. }) => (rho, Index::Mirror),
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
mod tests {
    use super::*;
    use crate::Mueller;

    const GLASS: Index = Index::Relative { n: 1.5, k: 0.0 };

    #[test]
    fn the_parts_of_a_mixture_are_those_of_eq_21() {
        let material = Material::Mixture {
            rho: 0.5,
            fraction: 0.6,
            index: GLASS,
        };
        let mirror: [[f64; 4]; 4] = Mueller::from(material.mirror(0.6, 0.64)).rows();
        let fresnel: [[f64; 4]; 4] = Mueller::from(GLASS.reflection(0.6, 0.64)).rows();
        for (scaled, plain) in mirror.iter().flatten().zip(fresnel.iter().flatten()) {
            assert_eq!((scaled + 0.0).to_bits(), (0.6 * plain + 0.0).to_bits());
        }
        let arriving = Stokes::<4, Incidence>::new([2.0, 1.0, -1.0, 0.5]);
        let scattered = material.leaving::<4>(0.3) * (material.entering(0.6) * arriving);
        assert_eq!(
            scattered,
            Mueller::<4, Incidence, Emergence>::depolariser(0.4 * 0.5) * arriving
        );
    }

    #[test]
    fn the_bound_is_the_greater_reflectance() {
        let material = Material::Mixture {
            rho: 0.5,
            fraction: 0.5,
            index: Index::new(3.0, 0.0),
        };
        let reflection = Index::new(3.0, 0.0).reflection(0.6, 0.64);
        assert!((material.mirror_bound(0.6, 0.64) / (0.5 * reflection.rs()) - 1.0).abs() < 1e-15);
        assert!(reflection.rs() > reflection.rp());
    }

    #[test]
    fn no_material_reflects_more_than_arrives() {
        for index in [
            GLASS,
            Index::Mirror,
            Index::new(0.5, 0.0),
            Index::new(0.183, 3.43),
        ] {
            for fraction in [0.0, 0.3, 1.0] {
                let material = Material::Mixture {
                    rho: 1.0,
                    fraction,
                    index,
                };
                for step in 0..=1000 {
                    let cos = f64::from(step) / 1000.0;
                    let bound = material.mirror_bound(cos, (1.0 - cos) * (1.0 + cos));
                    assert!(bound <= 1.0 && bound + material.albedo() <= 1.0 + 1e-15);
                }
            }
        }
    }

    #[test]
    fn each_reflector_asks_for_the_components_it_couples() {
        let of = |fraction, n, k| {
            Material::Mixture {
                rho: 0.5,
                fraction,
                index: Index::new(n, k),
            }
            .representation()
        };
        assert_eq!(of(0.0, 0.183, 3.43), Representation::Intensity);
        assert_eq!(of(0.6, 1.5, 0.0), Representation::Linear);
        assert_eq!(of(0.6, f64::INFINITY, 0.0), Representation::Linear);
        assert_eq!(of(0.6, 0.9, 0.0), Representation::Full);
        assert_eq!(of(0.6, 1.5, 1e-3), Representation::Full);
    }

    #[test]
    fn the_diffuse_counterpart_reflects_all_of_rho_and_mirrors_nothing() {
        let diffuse = Material::Mixture {
            rho: 0.5,
            fraction: 0.6,
            index: GLASS,
        }
        .without_fresnel();
        assert_eq!(diffuse.albedo().to_bits(), 0.5f64.to_bits());
        assert_eq!(diffuse.mirror(0.1, 0.99), Reflection::NONE);
        assert_eq!(diffuse.representation(), Representation::Intensity);
    }
}
