//! What each surface and each source is in every variant that walks serve, surface by surface.

use crate::medium::Step;
use crate::variation::{Origin, Variation};
use malus_optics::{Material as Optics, angle_of_incidence};
use malus_scene::Emission;

/// All surfaces and sources.
#[derive(Debug)]
pub(crate) struct Spread {
    surfaces: Vec<Surface>,
    /// Emitted light of each source in every variant, as a share of that by which it is chosen.
    sources: Vec<Vec<f64>>,
}

/// One surface; its lists have an entry a variant.
#[derive(Debug)]
pub(crate) struct Surface {
    /// Scale of what it scatters.
    pub scattering: Vec<f64>,
    /// Exitance, in unit/m².
    pub exitance: Vec<f64>,
    /// Emission in any variant: all have its state.
    pub emission: Option<Emission>,
    /// Emitted light as a share of that by which emitters are chosen.
    emitted: Vec<f64>,
    /// Scale of what it mirrors, by the matrices of its kind.
    mirrored: Vec<f64>,
    /// Which of its kinds it is.
    kind: Vec<usize>,
    /// Reflectors that differ in more than scales.
    kinds: Vec<Optics>,
    /// Whether it is the same in all variants.
    fixed: bool,
}

impl Spread {
    /// What surfaces and sources are in these variants.
    pub(crate) fn new(variations: &[Variation]) -> Self {
        let first = &variations[0];
        let surface = |index: usize| {
            let optics: Vec<Optics> = variations
                .iter()
                .map(|it| it.materials[index].optics)
                .collect();
            let emissions = || {
                variations
                    .iter()
                    .map(|it| it.materials[index].emission.as_ref())
            };
            let mut kinds: Vec<Optics> = Vec::new();
            let kind = optics.iter().map(|own| {
                let (kind, _) = of_full_strength(own);
                kinds.iter().position(|it| *it == kind).unwrap_or_else(|| {
                    kinds.push(kind);
                    kinds.len() - 1
                })
            });
            Surface {
                kind: kind.collect(),
                scattering: optics.iter().map(Optics::scattering).collect(),
                exitance: emissions()
                    .map(|it| it.map_or(0.0, |it| it.exitance))
                    .collect(),
                emission: emissions().flatten().next().cloned(),
                emitted: variations
                    .iter()
                    .map(|it| it.emitted(Origin::Surface(index as u32)))
                    .collect(),
                mirrored: optics.iter().map(|own| of_full_strength(own).1).collect(),
                kinds,
                fixed: optics.iter().all(|own| *own == optics[0]),
            }
        };
        let source = |index: usize| {
            let share = |it: &Variation| it.emitted(Origin::Source(index));
            variations.iter().map(share).collect()
        };
        Self {
            surfaces: (0..first.materials.len()).map(surface).collect(),
            sources: (0..first.sources()).map(source).collect(),
        }
    }

    /// Number of variants.
    pub(crate) fn count(&self) -> usize {
        self.surfaces
            .first()
            .map_or(1, |surface| surface.kind.len())
    }

    /// A surface.
    #[inline]
    pub(crate) fn surface(&self, index: u32) -> &Surface {
        &self.surfaces[index as usize]
    }

    /// Light that an emitter sends in every variant, as a share of that by which it is chosen.
    #[inline]
    pub(crate) fn emitted(&self, origin: Origin) -> &[f64] {
        match origin {
            Origin::Surface(surface) => &self.surface(surface).emitted,
            Origin::Source(source) => &self.sources[source],
        }
    }

    /// A mirror or a pane as all variants of one kind have it, at full strength.
    #[inline]
    pub(crate) fn step(&self, step: &Step, variant: usize) -> Step {
        let surface = self.surface(step.surface);
        if surface.fixed {
            return *step;
        }
        let optics = surface.kind(variant);
        let (cos, sin2) = angle_of_incidence(step.arriving, step.normal);
        Step {
            matrix: match step.through {
                true => optics.through(cos, sin2),
                false => optics.mirror(cos, sin2),
            },
            ..*step
        }
    }

    /// What is left of that strength in a variant.
    #[inline]
    pub(crate) fn strength(&self, step: &Step, variant: usize) -> f64 {
        let surface = self.surface(step.surface);
        if surface.fixed || step.through {
            1.0
        } else {
            surface.mirrored[variant]
        }
    }

    /// Whether two variants have a mirror or a pane of one kind.
    #[inline]
    pub(crate) fn alike(&self, step: &Step, one: usize, other: usize) -> bool {
        self.surface(step.surface).alike(one, other)
    }
}

impl Surface {
    /// The reflector of a variant's kind.
    #[inline]
    pub(crate) fn kind(&self, variant: usize) -> &Optics {
        &self.kinds[self.kind[variant]]
    }

    /// Whether variants differ in more than scales.
    #[inline]
    pub(crate) fn has_kinds(&self) -> bool {
        self.kinds.len() > 1
    }

    /// Whether two variants do not.
    #[inline]
    pub(crate) fn alike(&self, one: usize, other: usize) -> bool {
        self.kind[one] == self.kind[other]
    }
}

/// A reflector whose mirror-like part has its full strength, and the strength. Of a mixture all that is scattered is left
/// out: it has no direction and no polarisation.
fn of_full_strength(optics: &Optics) -> (Optics, f64) {
    match *optics {
        Optics::Mixture {
            fraction, index, ..
        } => {
            let full = Optics::Mixture {
                rho: 0.0,
                fraction: 1.0,
                index,
            };
            (full, fraction)
        }
        Optics::Coated(_) | Optics::Pane { .. } => (*optics, 1.0),
    }
}
