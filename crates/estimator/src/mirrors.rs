//! Chains of flat mirrors by which a point looks for a place of emission.
//!
//! A chain is drawn from the receiving end. Its last mirror, next to the emission, is chosen among all by what each
//! image would send were nothing in the way; those before it by a ray with density cos θ/π that is followed from
//! mirror to mirror. The probability that such a ray goes through a chain is the share of the beam that the mirrors'
//! outlines leave, which has a closed form. Whether a surface is really there, and nothing before it, is for rays to
//! tell once the chain is chosen.

use crate::beam::Beam;
use crate::pass::is_mirrorlike;
use crate::random::Uniforms;
use glam::DVec3;
use malus_geometry::{Facets, Surfaces};
use malus_scene::Material;
use std::f64::consts::PI;

/// Flat mirrors that are looked into; light in others is met by chance.
const MOST: usize = 64;

/// Least area of such a mirror, as a share of that of the sphere about the scene.
const LEAST: f64 = 1e-4;

/// Share of all directions below which a beam is not followed any further.
const NARROWEST: f64 = 1e-10;

/// Mirrors of a chain up to which every chain drawn is tested; of longer ones as many as keeps the rays per chain drawn
/// constant.
const TESTED: f64 = 3.0;

/// Probability with which a ray is followed behind a mirror, relative to what it reflects at that angle.
const ONWARD: f64 = 2.0;

/// Least of that probability: the light may meet the mirror at a far more grazing angle than the ray.
const LEAST_ONWARD: f64 = 0.05;

/// Probability with which a vertex looks into mirrors, relative to what the best of them reflects of diffuse light.
const LOOK: f64 = 4.0;

/// Least of that probability.
const LEAST_LOOK: f64 = 0.25;

/// The flat mirrors of a scene, as one model has them.
pub(crate) struct Mirrors {
    facets: Facets,
    /// Reflector of each, that of its largest triangle.
    optics: Vec<malus_optics::Material>,
    /// Probability with which a vertex of a walk looks into mirrors.
    look: f64,
    /// Whether all that is mirror-like belongs to some facet.
    complete: bool,
}

/// What a chain of mirrors is to lead to.
#[derive(Clone, Copy)]
pub(crate) struct Target<'t> {
    /// Where it is, or for light from infinity the direction towards it.
    pub at: DVec3,
    /// False at infinity.
    pub finite: bool,
    /// Light across the beam that leaves the target along a unit vector and goes a way of the given square.
    pub strength: &'t dyn Fn(DVec3, f64) -> f64,
}

/// Who looks into the mirrors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Viewer {
    /// Where, in m.
    pub point: DVec3,
    /// Unit normal; light is received by the cosine to it.
    pub normal: DVec3,
    /// True for a sensor, which looks every time.
    pub sensor: bool,
}

/// A chain of mirrors that was drawn.
pub(crate) struct Chain {
    /// Facets in the order in which the viewer sees them.
    pub facets: Vec<u32>,
    /// Probability of the chain, as [`Mirrors::probability`] has it.
    pub probability: f64,
    /// One over that with which it was drawn here: the two differ where the ray that drew it could have gone elsewhere.
    pub inverse: f64,
}

impl Mirrors {
    /// The mirrors of a scene whose surfaces have these materials.
    pub(crate) fn new(surfaces: &Surfaces, materials: &[Material]) -> Self {
        let wanted: Vec<bool> = materials.iter().map(is_mirrorlike).collect();
        let radius = surfaces.radius();
        let least = LEAST * 4.0 * PI * radius * radius;
        let mirrorlike = |triangle| wanted[surfaces.surface(triangle) as usize];
        let facets = Facets::new(surfaces, mirrorlike, least, MOST);
        let optics: Vec<_> = facets
            .list()
            .iter()
            .map(|facet| materials[surfaces.surface(facet.triangle) as usize].optics)
            .collect();
        let best = optics.iter().map(reflectance).fold(0.0, f64::max);
        let count = surfaces.len() as u32;
        Self {
            complete: (0..count).all(|t| !mirrorlike(t) || facets.of(t).is_some()),
            look: (LOOK * best).clamp(LEAST_LOOK, 1.0),
            facets,
            optics,
        }
    }

    /// The mirror that a triangle is part of.
    #[inline]
    pub(crate) fn of(&self, triangle: u32) -> Option<u32> {
        self.facets.of(triangle)
    }

    /// Whether there is nothing to look into.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.facets.list().is_empty()
    }

    /// Whether everything mirror-like can be looked into.
    pub(crate) fn is_complete(&self) -> bool {
        self.complete
    }

    /// Draws chains of mirrors that may lead the viewer to the target; `found` is given each.
    ///
    /// Every chain has a chance; the mean of what it brings, times its `inverse`, is the sum over all.
    pub(crate) fn draw(
        &self,
        viewer: &Viewer,
        target: &Target,
        uniforms: Uniforms,
        depth: u32,
        mut found: impl FnMut(Chain),
    ) {
        let [_, look, s, t] = uniforms.in_chain(depth, 0);
        let look_odds = self.look_odds(viewer);
        if self.is_empty() || look >= look_odds {
            return;
        }
        let direction = crate::direction::cosine_weighted(viewer.normal, [s, t]);
        let mut view = View::new(viewer);
        let mut ray = direction;
        // Probability that a ray which goes through the chain so far is followed through it.
        let mut followed = look_odds;
        for order in 0.. {
            let [last, ..] = uniforms.in_chain(depth, order);
            let [test, onward, select, _] = uniforms.in_chain(depth, order | 1 << 31);
            let tested = tested(order + 1);
            if test < tested
                && let Some((facet, share)) = self.last(&view, target, last)
            {
                let mut facets = view.facets.clone();
                facets.push(facet);
                let drawn = view.share * tested * share;
                let onward = self.onward_along(viewer, target, &facets);
                found(Chain {
                    facets,
                    probability: look_odds * onward * drawn,
                    inverse: 1.0 / (followed * drawn),
                });
            }
            let Some((facet, odds)) = self.met(&view, ray, select) else {
                return;
            };
            let goes_on = self.onward(facet, ray);
            if onward >= goes_on {
                return;
            }
            followed *= odds * goes_on;
            let Some(next) = view.behind(self, facet) else {
                return;
            };
            ray = self.facets.list()[facet as usize].mirrored(ray);
            view = next;
        }
    }

    /// Probability with which the viewer draws this chain for the target, were the ray that draws it to meet all mirrors
    /// under the angles of the light and no others: 0 for a chain that is never drawn.
    pub(crate) fn probability(&self, viewer: &Viewer, target: &Target, chain: &[u32]) -> f64 {
        let Some((&last, before)) = chain.split_last() else {
            return 1.0;
        };
        let mut view = View::new(viewer);
        for &facet in before {
            match view.behind(self, facet) {
                Some(next) => view = next,
                None => return 0.0,
            }
        }
        let promises = self.promises(&view, target);
        let sum: f64 = promises.iter().map(|p| p.1).sum();
        let own = promises.iter().find(|p| p.0 == last).map_or(0.0, |p| p.1);
        if own <= 0.0 {
            return 0.0;
        }
        self.look_odds(viewer)
            * self.onward_along(viewer, target, chain)
            * view.share
            * tested(chain.len() as u32)
            * (own / sum)
    }

    /// The target's image behind the chain, as the viewer sees it.
    pub(crate) fn image(&self, chain: &[u32], target: &Target) -> DVec3 {
        let list = self.facets.list();
        chain.iter().rev().fold(target.at, |at, &facet| {
            let facet = &list[facet as usize];
            if target.finite {
                facet.image(at)
            } else {
                facet.mirrored(at)
            }
        })
    }

    /// Probability with which a ray, of any length, is followed behind a mirror.
    fn onward(&self, facet: u32, ray: DVec3) -> f64 {
        let normal = self.facets.list()[facet as usize].normal;
        let cos = (ray.dot(normal).abs() / ray.length()).min(1.0);
        let mirror = self.optics[facet as usize].mirror(cos, 1.0 - cos * cos);
        (ONWARD * mirror.bound()).clamp(LEAST_ONWARD, 1.0)
    }

    /// The same for the light itself, behind all mirrors of a chain but the last.
    fn onward_along(&self, viewer: &Viewer, target: &Target, chain: &[u32]) -> f64 {
        let [before @ .., _] = chain else {
            return 1.0;
        };
        if before.is_empty() {
            return 1.0;
        }
        let image = self.image(chain, target);
        let mut ray = if target.finite {
            image - viewer.point
        } else {
            image
        };
        let mut odds = 1.0;
        for &facet in before {
            odds *= self.onward(facet, ray);
            ray = self.facets.list()[facet as usize].mirrored(ray);
        }
        odds
    }

    fn look_odds(&self, viewer: &Viewer) -> f64 {
        if viewer.sensor { 1.0 } else { self.look }
    }

    /// One facet for the end of a chain, with its probability among all.
    fn last(&self, view: &View, target: &Target, u: f64) -> Option<(u32, f64)> {
        let promises = self.promises(view, target);
        let sum: f64 = promises.iter().map(|p| p.1).sum();
        let mut left = u * sum;
        let chosen = promises.iter().find(|p| {
            left -= p.1;
            left < 0.0
        });
        let &(facet, promise) = chosen.or(promises.last())?;
        Some((facet, promise / sum))
    }

    /// What the target's image in each facet would send to the viewer were nothing in the way; those that send nothing
    /// are left out.
    fn promises(&self, view: &View, target: &Target) -> Vec<(u32, f64)> {
        let beam = &view.beam;
        let mut promises = Vec::new();
        for (index, facet) in (0..).zip(self.facets.list()) {
            if view.facets.last() == Some(&index) {
                continue;
            }
            let span = if target.finite {
                facet.image(target.at) - beam.apex
            } else {
                facet.mirrored(target.at)
            };
            let Some(crossed) = facet.crossing(beam.apex, span) else {
                continue;
            };
            if target.finite && crossed >= 1.0
                || !beam.contains(span)
                || view
                    .window(self, span)
                    .is_some_and(|window| crossed <= window)
            {
                continue;
            }
            let square = span.length_squared();
            let toward = span / square.sqrt();
            let cos = toward.dot(facet.normal).abs();
            let mirror = self.optics[index as usize]
                .mirror(cos, 1.0 - cos * cos)
                .bound();
            let leaving = facet.mirrored(-toward);
            let light = (target.strength)(leaving, square) * toward.dot(beam.normal) * mirror;
            if light > 0.0 && light.is_finite() {
                promises.push((index, light));
            }
        }
        promises
    }

    /// One of the facets that a ray goes through next, with the probability of that choice: each is taken before those
    /// behind it as often as not.
    fn met(&self, view: &View, ray: DVec3, u: f64) -> Option<(u32, f64)> {
        let window = view.window(self, ray).unwrap_or(0.0);
        let mut crossed: Vec<(f64, u32)> = Vec::new();
        for (index, facet) in (0..).zip(self.facets.list()) {
            if view.facets.last() != Some(&index)
                && let Some(at) = facet.crossing(view.beam.apex, ray)
                && at > window
            {
                crossed.push((at, index));
            }
        }
        crossed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let count = crossed.len();
        let mut odds = 1.0;
        let mut left = u;
        for (index, &(_, facet)) in crossed.iter().enumerate() {
            if index + 1 < count {
                odds *= 0.5;
            }
            if left < odds || index + 1 == count {
                return Some((facet, odds));
            }
            left -= odds;
        }
        None
    }
}

/// What is seen of the mirrors behind the first of a chain.
struct View {
    beam: Beam,
    facets: Vec<u32>,
    /// Share of all directions, weighted by the cosine, that goes through these mirrors.
    share: f64,
}

impl View {
    fn new(viewer: &Viewer) -> Self {
        Self {
            beam: Beam::hemisphere(viewer.point, viewer.normal),
            facets: Vec::new(),
            share: 1.0,
        }
    }

    /// What is seen in one more mirror.
    fn behind(&self, mirrors: &Mirrors, facet: u32) -> Option<Self> {
        let plane = &mirrors.facets.list()[facet as usize];
        let window = self
            .facets
            .last()
            .map(|&f| &mirrors.facets.list()[f as usize]);
        let beam = self.beam.through(plane, window)?;
        let share = beam.share();
        if share < NARROWEST {
            return None;
        }
        let mut facets = self.facets.clone();
        facets.push(facet);
        Some(Self {
            beam: beam.mirrored(plane),
            facets,
            share,
        })
    }

    /// The share of the way along `span` at which the last mirror is passed.
    fn window(&self, mirrors: &Mirrors, span: DVec3) -> Option<f64> {
        let plane = &mirrors.facets.list()[*self.facets.last()? as usize];
        let apex = self.beam.apex;
        Some((plane.height - apex.dot(plane.normal)) / span.dot(plane.normal))
    }
}

/// Probability with which a chain of so many mirrors is tested by rays.
fn tested(mirrors: u32) -> f64 {
    (TESTED / f64::from(mirrors)).min(1.0)
}

/// Share of diffuse light that a reflector mirrors, for the state of light that it mirrors most of.
fn reflectance(optics: &malus_optics::Material) -> f64 {
    const STEPS: i32 = 32;
    // ∫ R 2μ dμ by the midpoint rule in μ².
    let steps = (0..STEPS).map(|step| {
        let square = (f64::from(step) + 0.5) / f64::from(STEPS);
        optics.mirror(square.sqrt(), 1.0 - square).bound()
    });
    steps.sum::<f64>() / f64::from(STEPS)
}
