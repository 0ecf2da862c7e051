//! Chains of flat mirrors by which a point looks for a place of emission.
//!
//! A chain is drawn from the receiving end. Its last mirror, next to the emission, is chosen among all by what each
//! image would send were nothing in the way; those before it by a ray with density cos θ/π that is followed from
//! mirror to mirror. The probability that such a ray goes through a chain is the share of the beam that the mirrors'
//! outlines leave, which has a closed form. Whether a surface is really there, and nothing before it, is for rays to
//! tell once the chain is chosen.

mod image_sources;
mod images;
mod view;

use crate::cover::Cover;
use crate::direction::cosine_weighted;
use crate::random::{Fresh, Uniforms};
use glam::DVec3;
pub(crate) use image_sources::ImageSource;
use image_sources::ImageSources;
use malus_geometry::{Facet, Facets, Surfaces};
use malus_scene::Source;
use smallvec::SmallVec;
use std::f64::consts::PI;
use view::{Ray, View};

/// Mirrors one behind the other, on the stack where there are few.
pub(crate) type Chain = SmallVec<[u32; 4]>;

/// What is known of each mirror that may come next, or of each lamp, on the stack where there are few.
pub(crate) type Each<T> = SmallVec<[T; 16]>;

/// Flat mirrors that are looked into; light in others is met by chance.
const MOST: usize = 64;

/// Least area of such a mirror, as a share of that of the sphere about the scene.
const LEAST: f64 = 1e-4;

/// Chains of so many mirrors are all tested by rays, of longer ones as many as keeps the rays for one drawn constant.
const TESTED: f64 = 6.0;

/// Mirrors beyond which even less is spent on a chain: every doubling of the length has half of the light.
const FAR: f64 = 16.0;

/// Longest chain that is drawn by its beam.
const LONGEST_BEAM: usize = 3;

/// Mirrors after which a ray is not followed any further: between facing walls they lie so far away that what is left out is
/// below 1e-4 of the light.
const LONGEST_CHAIN: u32 = 1_000_000;

/// Distance within which two images are one, as a share of the scene's radius.
const APART: f64 = 1e-6;

/// How far a point source is moved aside before it is looked for in mirrors, in terms of the scene's radius, and parallel
/// light in terms of its direction's length. In the middle of a room it would be seen from points of a regular grid just
/// by edges, where neither wall is sure to be met.
pub(crate) const ASIDE: DVec3 = DVec3::new(0.71e-9, 0.53e-9, 0.43e-9);

/// Probability with which a ray is followed behind a mirror, relative to what it reflects at that angle.
const ONWARD: f64 = 2.0;

/// Least of that probability: the light may meet the mirror at a far more grazing angle than the ray.
const LEAST_ONWARD: f64 = 0.05;

/// The same behind the first mirror that a sensor looks into.
const LEAST_ONWARD_OF_SENSOR: f64 = 0.25;

/// Probability with which a vertex looks into mirrors, relative to the share of diffuse light that they reflect.
const LOOK: f64 = 0.5;

/// The same for a sensor, where neighbours do not share what is found, times the root of what a look costs there in facets.
const LOOK_OF_SENSOR: f64 = 54.0;

/// What a look costs beside that of the facets, in terms of one.
const COST_OF_LOOK: f64 = 14.0;

/// Least of that probability for a vertex.
const LEAST_LOOK: f64 = 0.05;

/// Least of that probability for a sensor.
const LEAST_LOOK_OF_SENSOR: f64 = 0.3;

/// The flat mirrors of a scene, as one model has them.
pub(crate) struct Mirrors {
    facets: Facets,
    /// Reflectors of each, those of its largest triangle.
    covers: Vec<Cover>,
    /// Probability with which a vertex of a walk looks into mirrors, and a sensor.
    look: f64,
    look_of_sensor: f64,
    /// Diffuse light that is mirrored by what belongs to no facet, as a share of what meets all surfaces.
    unseen: f64,
    /// Radius of the cone of directions about an image, where it stands, in m.
    spread: f64,
    /// Distance within which two images are one, in m.
    apart: f64,
    /// What sensors need not draw.
    image_sources: ImageSources,
}

/// What a chain of mirrors is to lead to.
#[derive(Clone, Copy)]
pub(crate) struct Target<'t> {
    /// Where it is, or for light from infinity the direction towards it.
    pub at: DVec3,
    /// False at infinity.
    pub finite: bool,
    /// Whether it is a point of a surface that walks may meet by chance, too.
    pub area: bool,
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
    /// True for a sensor, which looks more often.
    pub sensor: bool,
}

/// What was drawn: where to look for the target.
pub(crate) enum Drawn {
    /// In a chain of mirrors, in the order in which the viewer sees them; with the probability of drawing it, but for that
    /// of following the light behind all of them but the last.
    Chain(Chain, f64),
    /// At the place of an image behind so many mirrors, whichever they are: from a point the way there is unique, but for
    /// panes, at each of which it is drawn whether the way is mirrored or goes on.
    Image(DVec3, usize, Fresh),
}

impl Mirrors {
    /// The mirrors of a scene whose surfaces have these reflectors, and which is lit by these sources.
    pub(crate) fn new(surfaces: &Surfaces, covers: &[Cover], sources: &[Source]) -> Self {
        let wanted: Vec<bool> = covers.iter().map(Cover::is_mirrorlike).collect();
        let radius = surfaces.radius();
        let least = LEAST * 4.0 * PI * radius * radius;
        let (mut seen, mut unseen, mut area) = (0.0, 0.0, 0.0);
        let mut facets = Facets::default();
        // What reflects nothing like a mirror needs no patches.
        if wanted.contains(&true) {
            let patches = surfaces.patches();
            let mirrorlike = |surface: u32| wanted[surface as usize];
            facets = Facets::new(surfaces, patches, mirrorlike, least, MOST);
            let reflectances: Vec<f64> = covers.iter().map(reflectance).collect();
            for (own, patch) in patches.iter() {
                area += own;
                let mirrored = own * reflectances[surfaces.surface(patch[0]) as usize];
                if facets.of(patch[0]).is_some() {
                    seen += mirrored;
                } else {
                    unseen += mirrored;
                }
            }
        }
        let of_facets: Vec<Cover> = facets
            .list()
            .iter()
            .map(|facet| covers[surfaces.surface(facet.triangle) as usize].clone())
            .collect();
        let share = |part: f64| if area > 0.0 { part / area } else { 0.0 };
        let dear = (COST_OF_LOOK + of_facets.len() as f64).sqrt();
        let mut mirrors = Self {
            unseen: share(unseen),
            look: (LOOK * share(seen)).clamp(LEAST_LOOK, 1.0),
            look_of_sensor: (LOOK_OF_SENSOR / dear * share(seen)).clamp(LEAST_LOOK_OF_SENSOR, 1.0),
            facets,
            covers: of_facets,
            spread: images::SPREAD * radius,
            apart: APART * radius,
            image_sources: ImageSources::default(),
        };
        mirrors.image_sources = ImageSources::new(&mirrors, sources, ASIDE * radius);
        mirrors
    }

    /// Images of sources without geometry whose light sensors receive without chance.
    pub(crate) fn image_sources(&self) -> &[ImageSource] {
        &self.image_sources.list
    }

    /// Whether these are all, so that a sensor need not look for others.
    pub(crate) fn all_images_are_listed(&self) -> bool {
        self.image_sources.complete
    }

    /// A mirror.
    pub(crate) fn facet(&self, facet: u32) -> &Facet {
        &self.facets.list()[facet as usize]
    }

    /// Greatest reflectance of a mirror for light along a ray of any length.
    pub(crate) fn bound(&self, facet: u32, ray: DVec3) -> f64 {
        let cos = (ray.dot(self.facet(facet).normal).abs() / ray.length()).min(1.0);
        self.covers[facet as usize].mirror_bound(cos, 1.0 - cos * cos)
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

    /// Probability with which a `sensor`, or a vertex of a walk, looks into mirrors, if there are any.
    pub(crate) fn odds(&self, sensor: bool) -> f64 {
        match sensor {
            _ if self.is_empty() => 0.0,
            true => self.look_of_sensor,
            false => self.look,
        }
    }

    /// Diffuse light that is mirrored by what cannot be looked into, as a share of what meets all surfaces.
    pub(crate) fn unseen(&self) -> f64 {
        self.unseen
    }

    /// Draws ways by mirrors that may lead the viewer to the target; `found` is given each, with one over the probability
    /// of the draw.
    ///
    /// Every way has a chance, but for those to image sources that a sensor knows; the mean of what it brings, times that
    /// inverse, is the sum over all. A short chain is drawn as such, by its beam. Of longer ones many orders of the same
    /// mirrors make the same image, each for a sliver of directions, so there the image is drawn: its probability is that
    /// of a cone of directions about it to lead to it by any order, and one over that is estimated without bias by how
    /// many tries that takes.
    pub(crate) fn draw(
        &self,
        viewer: &Viewer,
        target: &Target,
        uniforms: Uniforms,
        depth: u32,
        mut found: impl FnMut(Drawn, f64),
    ) {
        let [first, look, s, t] = uniforms.in_chain(depth, 0);
        let look_odds = self.look_odds(viewer);
        if self.is_empty() || look >= look_odds {
            return;
        }
        let known = match viewer.sensor && !target.area {
            true if self.image_sources.complete => return,
            true => self.image_sources.longest,
            false => 0,
        };
        let direction = cosine_weighted(viewer.normal, [s, t]);
        let mut ray = Ray::new(viewer, direction);
        let mut view = View::new(viewer);
        // Probability that a ray through the chain so far is followed through it, by the choices that this one took.
        let mut followed = look_odds;
        let beams = match target.beam(known + 1) {
            true => LONGEST_CHAIN,
            false => 0,
        };
        for order in 0..beams {
            let last = match order {
                0 => first,
                _ => uniforms.in_chain(depth, order)[0],
            };
            let [test, onward, select, _] = uniforms.in_chain(depth, order | 1 << 31);
            let odds = tested(order + 1);
            if test < odds
                && order as usize + 1 > known
                && let Some((facet, share)) = self.last(&view, target, last)
            {
                let mut facets = view.facets.clone();
                facets.push(facet);
                let drawn = view.share * odds * share;
                found(
                    Drawn::Chain(facets, look_odds * drawn),
                    1.0 / (drawn * followed),
                );
            }
            if !target.beam(order as usize + 2) {
                break;
            }
            let Some((facet, chosen)) = self.met(&ray, select) else {
                break;
            };
            let goes_on = self.onward(viewer, order as usize, known, facet, ray.direction);
            if onward >= goes_on {
                break;
            }
            let Some(next) = view.behind(self, facet) else {
                break;
            };
            followed *= chosen * goes_on;
            view = next;
            ray.reflect(facet, self.facet(facet));
        }
        if target.has_images() {
            self.draw_images(viewer, target, uniforms, depth, (look_odds, known), found);
        }
    }

    /// Whether two images behind so many mirrors are one, but for rounding.
    pub(crate) fn same(&self, one: DVec3, other: DVec3, mirrors: usize) -> bool {
        let rounding = f64::EPSILON * mirrors as f64 * other.length();
        one.distance(other) <= self.apart + rounding
    }

    /// Probability with which the viewer draws this chain for the target, were the ray that draws it to meet all mirrors
    /// under the angles of the light and no others: 0 for a chain that is never drawn.
    pub(crate) fn probability(&self, viewer: &Viewer, target: &Target, chain: &[u32]) -> f64 {
        let Some((&last, before)) = chain.split_last() else {
            return 1.0;
        };
        let odds = self.look_odds(viewer)
            * self.onward_along(viewer, target, chain)
            * tested(chain.len() as u32);
        if !target.beam(chain.len()) {
            let image = self.image(chain, target);
            return odds * self.image_share(viewer, image);
        }
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
        odds * view.share * (own / sum)
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

    /// Probability with which a ray, of any length, is followed behind a mirror, the one of that order in its chain, to images
    /// behind more than `known`.
    fn onward(&self, viewer: &Viewer, order: usize, known: usize, facet: u32, ray: DVec3) -> f64 {
        // No image is looked at before, so there is nothing to be saved.
        if order < known {
            return 1.0;
        }
        let bound = self.bound(facet, ray);
        // What polarisation changes of what a sensor sees comes by two mirrors, and sensors look seldom.
        let least = if viewer.sensor && order == 0 {
            LEAST_ONWARD_OF_SENSOR
        } else {
            LEAST_ONWARD
        };
        // Below 1 where light is lost, so that rays between strong mirrors end as the light does.
        (ONWARD * bound).min(bound.sqrt()).max(least)
    }

    /// The same for the light itself, behind all mirrors of a chain but the last.
    pub(crate) fn onward_along(&self, viewer: &Viewer, target: &Target, chain: &[u32]) -> f64 {
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
        for (order, &facet) in before.iter().enumerate() {
            odds *= self.onward(viewer, order, 0, facet, ray);
            ray = self.facets.list()[facet as usize].mirrored(ray);
        }
        odds
    }

    fn look_odds(&self, viewer: &Viewer) -> f64 {
        self.odds(viewer.sensor)
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
    fn promises(&self, view: &View, target: &Target) -> Each<(u32, f64)> {
        let beam = &view.beam;
        let mut promises = Each::new();
        for (index, facet) in (0..).zip(self.facets.list()) {
            if view.facets.last() == Some(&index) {
                continue;
            }
            // Most mirrors do not stand on one side of both.
            if target.finite && facet.above(beam.apex) * facet.above(target.at) <= 0.0 {
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
            let mirror = self.covers[index as usize].image(cos);
            let leaving = facet.mirrored(-toward);
            let light = (target.strength)(leaving, square) * toward.dot(beam.normal) * mirror;
            if light > 0.0 && light.is_finite() {
                promises.push((index, light));
            }
        }
        promises
    }
}

impl Target<'_> {
    /// Whether a chain of so many mirrors is drawn by its beam: what is met by chance, too, has a bound to its weight.
    fn beam(&self, length: usize) -> bool {
        length <= LONGEST_BEAM || !self.has_images()
    }

    /// Whether it has images to be drawn, of which each point sees one at most in one direction.
    fn has_images(&self) -> bool {
        self.finite && !self.area
    }
}

/// Probability with which a chain of so many mirrors is tested by rays.
fn tested(mirrors: u32) -> f64 {
    let mirrors = f64::from(mirrors);
    (TESTED / mirrors).min(1.0) * (FAR / mirrors).sqrt().min(1.0)
}

/// Share of diffuse light that a reflector mirrors, for the state of light that it mirrors most of.
pub(crate) fn reflectance(cover: &Cover) -> f64 {
    const STEPS: i32 = 32;
    // ∫ R 2μ dμ by the midpoint rule in μ².
    let steps = (0..STEPS).map(|step| {
        let square = (f64::from(step) + 0.5) / f64::from(STEPS);
        cover.mirror_bound(square.sqrt(), 1.0 - square)
    });
    steps.sum::<f64>() / f64::from(STEPS)
}
