//! What the fields of a mesh file's material say of its kind, ρ, a, n, k, τ and the exitance.

use malus_geometry::load::{FileMaterial, Look};
use std::f64::consts::PI;
use std::fmt;

/// A value with the fields it comes from.
pub(crate) type Given = (f64, &'static str);

/// What the file's fields give; `docs/scene-format.md` has the table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Appearance {
    pub(crate) rho: Option<Given>,
    pub(crate) a: Option<Given>,
    pub(crate) n: Option<Given>,
    pub(crate) k: Option<Given>,
    /// Fields that speak of a pane.
    pub(crate) pane: Option<&'static str>,
    pub(crate) tau: Option<Given>,
    pub(crate) exitance: Option<Given>,
    pub(crate) doubts: Vec<Doubt>,
}

/// What the model cannot follow or had to assume, in words.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Doubt {
    /// Of the values under these keys: told where one of them is in use.
    Value(&'static [&'static str], String),
    /// Of light that would pass: told where the material is no pane and nobody says that this is meant.
    Opaque(String),
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value(_, text) | Self::Opaque(text) => f.write_str(text),
        }
    }
}

/// Origin of a = 0 where an MTL's illumination model knows no mirror-like reflection.
pub(crate) const NO_MIRROR: &str = "illum < 3";

/// Share of light transmitted from which on a material counts as a pane.
const CLEAR: f64 = 0.5;

/// Metallic factor from which on a material counts as a metal.
const METAL: f64 = 0.5;

/// Roughness above which a pane visibly scatters.
const ROUGH: f64 = 0.1;

/// Luminance of a linear colour, relative to white (Rec. 709 primaries).
pub(crate) fn luminance(color: [f64; 3]) -> f64 {
    0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
}

impl Appearance {
    /// What the fields of `material` give.
    pub(crate) fn of(material: &FileMaterial) -> Self {
        match material.look {
            Look::Gltf { .. } => Self::of_gltf(&material.look),
            Look::Mtl { .. } => Self::of_mtl(&material.look),
        }
    }

    fn of_gltf(look: &Look) -> Self {
        let &Look::Gltf {
            base_color,
            textured,
            metallic,
            roughness,
            specular,
            ior,
            transmission,
            emissive,
            alpha,
            opaque,
            ..
        } = look
        else {
            return Self::default();
        };
        let reflectance = share(luminance(base_color));
        let mut appearance = Self {
            rho: Some((
                share(reflectance * (1.0 - metallic) * (1.0 - transmission)),
                "base colour × (1 − metallic) × (1 − transmission)",
            )),
            a: Some((
                share(metallic + (1.0 - metallic) * gloss(specular, roughness)),
                "specular × (1 − roughness)², metallic: 1",
            )),
            n: ior.map(|ior| (ior, "KHR_materials_ior")),
            k: None,
            pane: None,
            tau: None,
            exitance: Some((PI * luminance(emissive), "π × emissive factor × strength")),
            doubts: Vec::new(),
        };
        if textured {
            let text = "its base-colour texture is taken at its mean";
            appearance.doubt(&["rho", "tau"], text.into());
        }
        let dark = luminance(emissive).abs() <= 0.0;
        if transmission >= CLEAR && metallic < METAL && dark {
            appearance.clear(transmission, roughness, reflectance);
        }
        if transmission > 0.0 {
            appearance.opaque(format!("transmits light (transmission {transmission})"));
        } else if !opaque && alpha < 1.0 {
            appearance.opaque(format!("is transparent (alpha {alpha})"));
        }
        if metallic > 0.0 {
            appearance.metal(metallic, reflectance);
        }
        appearance
    }

    fn of_mtl(look: &Look) -> Self {
        let &Look::Mtl {
            kd,
            ks,
            ke,
            ni,
            d,
            tf,
            illum,
            textured,
            pr,
            pm,
        } = look
        else {
            return Self::default();
        };
        // From illumination model 3 on, MTL knows mirror-like reflection.
        let mirrors = illum.is_some_and(|illum| illum >= 3);
        let metallic = if mirrors { pm.unwrap_or(0.0) } else { 0.0 };
        let specular = ks.map_or(0.0, luminance);
        let a = share(metallic + (1.0 - metallic) * gloss(specular, pr.unwrap_or(0.0)));
        let mut appearance = Self {
            rho: kd.map(|kd| (share(share(luminance(kd)) * (1.0 - metallic)), "Kd")),
            a: Some(if mirrors {
                (a, "Ks × (1 − Pr)², metallic: 1")
            } else {
                (0.0, NO_MIRROR)
            }),
            // Exporters write 1.0 where they know nothing.
            n: ni.filter(|ni| (ni - 1.0).abs() > 1e-6).map(|ni| (ni, "Ni")),
            k: None,
            pane: None,
            tau: None,
            exitance: ke.map(|ke| (PI * luminance(ke), "π × Ke")),
            doubts: Vec::new(),
        };
        if textured {
            let text = "its texture map_Kd is not read, Kd is used as it stands";
            appearance.doubt(&["rho"], text.into());
        }
        if d.is_some_and(|d| d < 1.0) {
            appearance.opaque(format!("is transparent (d {})", d.unwrap_or(1.0)));
        } else if illum.is_some_and(|illum| [4, 6, 7, 9].contains(&illum)) {
            appearance.opaque(format!("is glass (illum {})", illum.unwrap_or(0)));
        } else if pr.is_some() && tf.is_some_and(|tf| luminance(tf) > 0.0) {
            // Other programs write Tf 1 1 1 for opaque materials; Blender, told by its Pr, only for glass.
            appearance.opaque(format!("transmits light (Tf {:?})", tf.unwrap_or_default()));
        }
        if metallic > 0.0 {
            appearance.metal(metallic, kd.map_or(0.0, |kd| share(luminance(kd))));
        }
        appearance
    }

    fn doubt(&mut self, keys: &'static [&'static str], text: String) {
        self.doubts.push(Doubt::Value(keys, text));
    }

    /// A material that lets most light through is a pane whose inner transmittance is its base colour's luminance.
    fn clear(&mut self, transmission: f64, roughness: f64, luminance: f64) {
        self.pane = Some("KHR_materials_transmission ≥ 0.5");
        self.tau = Some((luminance, "base colour"));
        if transmission < 1.0 {
            let text = format!(
                "transmits a share of {transmission} by its file: as a pane it transmits all that it neither reflects nor absorbs"
            );
            self.doubt(&["kind"], text);
        }
        if roughness > ROUGH {
            let text = format!("is rough ({roughness}) by its file: as a pane it is clear");
            self.doubt(&["kind"], text);
        }
    }

    /// Light that would pass is lost: only panes let light through.
    fn opaque(&mut self, what: String) {
        self.doubts.push(Doubt::Opaque(format!(
            "{what}, which a mixture cannot follow: light that would pass is absorbed; kind = \"pane\" makes a single sheet let it through, kind = \"mixture\" says that it is meant to be opaque"
        )));
    }

    /// A metal's index: of all n + ik with the `reflectance` at normal incidence, the one with n = 1,
    /// k = 2 √(R/(1 − R)), which lies near aluminium's and keeps R for every R < 1; R = 1 is the ideal mirror.
    fn metal(&mut self, metallic: f64, reflectance: f64) {
        const ORIGIN: &str = "metallic: the base colour's luminance at normal incidence";
        let partly = if metallic < 1.0 { "partly " } else { "" };
        if metallic >= METAL {
            let (n, k) = if reflectance < 1.0 {
                (1.0, 2.0 * (reflectance / (1.0 - reflectance)).sqrt())
            } else {
                (f64::INFINITY, 0.0)
            };
            self.n = Some((n, ORIGIN));
            self.k = Some((k, ORIGIN));
            let white = if reflectance > 0.99 {
                "; white metal is also what Blender's Diffuse and Glass nodes arrive as"
            } else {
                ""
            };
            let text = format!(
                "is {partly}metallic: n = {n} and k = {k:.3} are guessed from its base colour's luminance {reflectance:.3}; give malus_n and malus_k{white}"
            );
            self.doubt(&["n", "k"], text);
        } else {
            let text = format!(
                "is partly metallic ({metallic}): taken as that share of mirror-like reflection with a dielectric's index"
            );
            self.doubt(&["a"], text);
        }
    }
}

/// min(1, specular) (1 − roughness)²: the smoother, the more of the Fresnel reflection is mirror-like.
fn gloss(specular: f64, roughness: f64) -> f64 {
    let smoothness = 1.0 - roughness;
    specular.min(1.0) * smoothness * smoothness
}

/// A share that single precision took over an end of 0 … 1 by a rounding is put back on it; what is further out stays.
fn share(value: f64) -> f64 {
    const ROUNDING: f64 = 1e-6;
    if (-ROUNDING..=1.0 + ROUNDING).contains(&value) {
        value.clamp(0.0, 1.0)
    } else {
        value
    }
}

#[cfg(test)]
mod tests;
