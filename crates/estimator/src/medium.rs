//! What light moves through: surfaces, what they do, and where light comes from.

use crate::cover::{Cover, Odds};
use crate::emitters::Emitters;
use crate::glints::Glints;
use crate::mirrors::{ASIDE, Chain, Drawn, Mirrors, Target, Viewer};
use crate::radiosity::Radiosity;
use crate::random::Fresh;
use crate::site::Site;
use crate::spread::Spread;
use crate::variation::Variation;
use glam::DVec3;
use malus_geometry::{Hit, Surfaces};
use malus_optics::{Material as Optics, Reflection, angle_of_incidence};
use malus_scene::Material;

/// What a walk moves through.
#[derive(Clone, Copy)]
pub(crate) struct Medium<'a> {
    /// Where surfaces are.
    pub surfaces: &'a Surfaces,
    /// Their materials by surface index, as the first variant has them; emitters are as strong as in any.
    pub materials: &'a [Material],
    /// What decides how walks go on, by surface index.
    pub covers: &'a [Cover],
    /// What they do to light, in each variant that the walks are for.
    pub variations: &'a [Variation],
    /// The same, surface by surface.
    pub spread: &'a Spread,
    /// Where light comes from.
    pub emitters: &'a Emitters<'a>,
    /// Flat mirrors that can be looked into.
    pub mirrors: &'a Mirrors,
    /// Mirrors that cannot.
    pub glints: &'a Glints,
    /// Whether anything lets light through.
    pub panes: bool,
    /// A guess of what surfaces scatter, which walks from sensors correct.
    pub radiosity: Option<&'a Radiosity<'a>>,
}

/// A mirror or a pane on the way of light, met along a direction of tracing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    /// Index of the surface.
    pub surface: u32,
    /// Unit normal on the side that tracing came from.
    pub normal: DVec3,
    /// Direction of tracing on arrival.
    pub arriving: DVec3,
    /// What it does to the light in the first variant, in the basis with the s axis as x.
    pub matrix: Reflection,
    /// Whether the light goes on straight.
    pub through: bool,
}

/// A unit vector that meets a normal under the given cosine, mirrored.
fn mirrored(arriving: DVec3, normal: DVec3, cos: f64) -> DVec3 {
    (arriving + normal * (2.0 * cos)).normalize()
}

impl Step {
    /// The same surface met along a direction, if this is what it does to light.
    #[inline]
    pub(crate) fn met(&self, arriving: DVec3, optics: &Optics) -> Self {
        let (cos, sin2) = angle_of_incidence(arriving, self.normal);
        Self {
            arriving,
            matrix: match self.through {
                true => optics.through(cos, sin2),
                false => optics.mirror(cos, sin2),
            },
            ..*self
        }
    }

    /// Direction of tracing behind it.
    fn onward(&self) -> DVec3 {
        match self.through {
            true => self.arriving,
            false => {
                let (cos, _) = angle_of_incidence(self.arriving, self.normal);
                mirrored(self.arriving, self.normal, cos)
            }
        }
    }
}

/// How a surface is met.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meeting<'a> {
    /// Index of the material.
    pub index: u32,
    /// The material.
    pub material: &'a Material,
    /// What decides how a walk goes on.
    pub cover: &'a Cover,
    /// Whether on the side that emits.
    pub front: bool,
    /// Unit normal on the side met.
    pub normal: DVec3,
    /// Cosine and sine² of the angle of incidence.
    pub angle: (f64, f64),
    /// The mirror that the triangle is part of, if it is one that can be looked into.
    pub facet: Option<u32>,
}

/// Panes between two points, and the probability with which a walk would pass them.
pub(crate) struct Passage {
    /// Product of the probabilities of all events on the way.
    pub odds: f64,
}

/// A way by mirrors and panes.
pub(crate) struct Way {
    /// Direction of tracing at its start.
    pub start: DVec3,
    /// Direction of tracing at its end.
    pub arriving: DVec3,
    /// Square of its length, in m².
    pub square: f64,
    /// Probability with which a walk would pass all its mirrors and panes.
    pub odds: f64,
    /// Probability with which the way was drawn where panes left a choice.
    pub drawn: f64,
}

impl Meeting<'_> {
    /// True where the back of a one-sided surface is met: it neither reflects nor emits.
    pub(crate) fn black(&self) -> bool {
        !self.front && !self.material.two_sided
    }

    /// A direction that arrives here, mirrored.
    pub(crate) fn mirrored(&self, arriving: DVec3) -> DVec3 {
        mirrored(arriving, self.normal, self.angle.0)
    }

    /// The mirror-like part and what is let through.
    pub(crate) fn matrices(&self) -> (Reflection, Reflection) {
        let (cos, sin2) = self.angle;
        let optics = &self.material.optics;
        let through = if optics.is_pane() {
            optics.through(cos, sin2)
        } else {
            Reflection::NONE
        };
        (optics.mirror(cos, sin2), through)
    }

    /// How a walk that meets the surface like this goes on.
    pub(crate) fn odds(&self, mirror: &Reflection, through: &Reflection) -> Odds {
        self.cover.odds(self.angle, mirror, through)
    }
}

impl<'a> Medium<'a> {
    /// The first of the variants that the walks are for.
    pub(crate) fn first(&self) -> &'a Variation {
        &self.variations[0]
    }

    /// The first surface along a ray.
    pub(crate) fn meet(&self, from: DVec3, direction: DVec3) -> Option<(Hit, Meeting<'a>)> {
        let hit = self.surfaces.nearest(from, direction)?;
        let outward = self.surfaces.normal(hit.triangle);
        let front = direction.dot(outward) < 0.0;
        let normal = if front { outward } else { -outward };
        let index = self.surfaces.surface(hit.triangle);
        let meeting = Meeting {
            index,
            material: &self.materials[index as usize],
            cover: &self.covers[index as usize],
            front,
            normal,
            angle: angle_of_incidence(direction, normal),
            facet: self.mirrors.of(hit.triangle),
        };
        Some((hit, meeting))
    }

    /// Θ along a segment, or up to infinity where `to` is `None`: `None` where something is in the way, and otherwise the
    /// panes that are passed, appended to `steps`.
    pub(crate) fn passage(
        &self,
        from: DVec3,
        to: Option<DVec3>,
        toward: DVec3,
        steps: &mut Vec<Step>,
    ) -> Option<Passage> {
        let clear = Passage { odds: 1.0 };
        if !self.panes {
            let seen = match to {
                Some(to) => self.surfaces.visible(from, to),
                None => self.surfaces.escapes(from, toward),
            };
            return seen.then_some(clear);
        }
        let mut passage = clear;
        let mut from = from;
        loop {
            let left = to.map_or(f64::INFINITY, |to| to.distance(from));
            let Some((hit, meeting)) = self.meet(from, toward) else {
                return Some(passage);
            };
            if hit.distance >= left {
                return Some(passage);
            }
            let (mirror, matrix) = meeting.matrices();
            let odds = meeting.odds(&mirror, &matrix).through;
            if odds <= 0.0 {
                return None;
            }
            passage.odds *= odds;
            steps.push(Step {
                surface: meeting.index,
                normal: meeting.normal,
                arriving: toward,
                matrix,
                through: true,
            });
            from = hit.position - meeting.normal * self.surfaces.offset();
        }
    }

    /// The way from a viewer to a target by a chain of mirrors: `None` where a mirror is missed or something stands in
    /// the way.
    fn chained(
        &self,
        viewer: &Viewer,
        target: &Target,
        chain: &[u32],
        steps: &mut Vec<Step>,
    ) -> Option<Way> {
        let image = self.mirrors.image(chain, target);
        let span = if target.finite {
            image - viewer.point
        } else {
            image
        };
        let square = span.length_squared();
        let start = span / square.sqrt();
        let mut odds = 1.0;
        let (mut from, mut toward) = (viewer.point, start);
        let before = steps.len();
        for &facet in chain {
            loop {
                let (hit, meeting) = self.meet(from, toward)?;
                let (mirror, through) = meeting.matrices();
                let own = meeting.facet == Some(facet);
                let chances = meeting.odds(&mirror, &through);
                let (matrix, chance) = if own {
                    let first = viewer.sensor && steps.len() == before;
                    (mirror, chances.mirrored(first))
                } else {
                    (through, chances.through)
                };
                if chance <= 0.0 || meeting.black() {
                    return None;
                }
                odds *= chance;
                steps.push(Step {
                    surface: meeting.index,
                    normal: meeting.normal,
                    arriving: toward,
                    matrix,
                    through: !own,
                });
                let side = if own { 1.0 } else { -1.0 };
                from = hit.position + meeting.normal * (side * self.surfaces.offset());
                if own {
                    toward = meeting.mirrored(toward);
                    break;
                }
            }
        }
        let to = target.finite.then_some(target.at);
        let passage = self.passage(from, to, toward, steps)?;
        Some(Way {
            start,
            square,
            arriving: toward,
            odds: odds * passage.odds,
            drawn: 1.0,
        })
    }

    /// The way from a viewer to a source without area by a chain of mirrors, where there is one.
    ///
    /// It is traced to a point beside the source, so that one of two mirrors is sure to be met where they meet; the light
    /// comes from the source itself.
    pub(crate) fn way_to(
        &self,
        viewer: &Viewer,
        site: &Site,
        chain: &[u32],
        steps: &mut Vec<Step>,
    ) -> Option<Way> {
        let strength = |leaving, square| site.irradiance(leaving, square);
        let beside = target(site, self.surfaces.radius(), &strength);
        if !self.mirrors.leads(viewer, &beside, chain) {
            return None;
        }
        let way = self.chained(viewer, &beside, chain, steps)?;
        let at = site.from.unwrap_or(-site.direction());
        let image = self.mirrors.image(chain, &Target { at, ..beside });
        let span = match beside.finite {
            true => image - viewer.point,
            false => image,
        };
        let square = span.length_squared();
        let start = span / square.sqrt();
        let mut arriving = start;
        for step in steps {
            *step = step.met(arriving, &self.materials[step.surface as usize].optics);
            arriving = step.onward();
        }
        Some(Way {
            start,
            square,
            arriving,
            ..way
        })
    }

    /// The way from a viewer to an image of the target behind so many mirrors, by whichever it leads.
    ///
    /// Like [`chained`](Self::chained); the mirrors met are given too. A pane mirrors the way or is passed as often as a
    /// walk would do either.
    fn imaged(
        &self,
        viewer: &Viewer,
        target: &Target,
        (image, mirrors): (DVec3, usize),
        mut choices: Fresh,
        steps: &mut Vec<Step>,
    ) -> Option<(Way, Chain)> {
        let span = image - viewer.point;
        if span.dot(viewer.normal) <= 0.0 {
            return None;
        }
        let mut left = span.length();
        let start = span / left;
        let mut chain = Chain::new();
        let (mut odds, mut drawn) = (1.0, 1.0);
        let (mut from, mut toward) = (viewer.point, start);
        let before = steps.len();
        while chain.len() < mirrors {
            let (hit, meeting) = self.meet(from, toward)?;
            if hit.distance >= left {
                return None;
            }
            left -= hit.distance;
            let (mirror, through) = meeting.matrices();
            let chances = meeting.odds(&mirror, &through);
            let mut pass = meeting.material.optics.is_pane();
            if pass && meeting.facet.is_some() && chain.len() < mirrors {
                let share = chances.through / (chances.through + chances.mirror);
                let [choice, ..] = choices.next();
                pass = choice < share;
                drawn *= if pass { share } else { 1.0 - share };
            }
            let (matrix, chance) = if pass {
                (through, chances.through)
            } else {
                chain.push(meeting.facet?);
                let first = viewer.sensor && steps.len() == before;
                (mirror, chances.mirrored(first))
            };
            if chance <= 0.0 || meeting.black() {
                return None;
            }
            odds *= chance;
            steps.push(Step {
                surface: meeting.index,
                normal: meeting.normal,
                arriving: toward,
                matrix,
                through: pass,
            });
            let side = if pass { -1.0 } else { 1.0 };
            from = hit.position + meeting.normal * (side * self.surfaces.offset());
            if !pass {
                toward = meeting.mirrored(toward);
            }
        }
        if !self
            .mirrors
            .same(self.mirrors.image(&chain, target), image, chain.len())
        {
            return None;
        }
        // Rays leave mirrors by an offset, so after many of them `left` no longer tells the target from the surface that
        // it lies on: the last leg leads to the target itself.
        let passage = self.passage(from, Some(target.at), toward, steps)?;
        let way = Way {
            start,
            square: span.length_squared(),
            arriving: toward,
            odds: odds * passage.odds,
            drawn,
        };
        Some((way, chain))
    }

    /// The way from a viewer to a target as it was drawn, and the probability with which the viewer draws its mirrors (see
    /// [`Mirrors::probability`]); `None` where there is none.
    pub(crate) fn drawn(
        &self,
        viewer: &Viewer,
        target: &Target,
        drawn: Drawn,
        steps: &mut Vec<Step>,
    ) -> Option<(Way, f64)> {
        match drawn {
            Drawn::Chain(chain, odds) => {
                let way = self.chained(viewer, target, &chain, steps)?;
                Some((
                    way,
                    odds * self.mirrors.onward_along(viewer, target, &chain),
                ))
            }
            Drawn::Image(image, mirrors, choices) => {
                let (way, chain) = self.imaged(viewer, target, (image, mirrors), choices, steps)?;
                Some((way, self.mirrors.probability(viewer, target, &chain)))
            }
        }
    }

    /// The probability of a chain of mirrors to a site as seen by a viewer.
    pub(crate) fn chain_probability(&self, viewer: &Viewer, site: &Site, chain: &[u32]) -> f64 {
        let strength = |leaving, square| site.irradiance(leaving, square);
        let target = target(site, self.surfaces.radius(), &strength);
        self.mirrors.probability(viewer, &target, chain)
    }
}

/// A site as what a chain of mirrors leads to.
pub(crate) fn target<'t>(
    site: &Site,
    radius: f64,
    strength: &'t dyn Fn(DVec3, f64) -> f64,
) -> Target<'t> {
    let aside = match (site.area_density(), site.from) {
        (Some(_), _) => DVec3::ZERO,
        (None, Some(_)) => ASIDE * radius,
        (None, None) => ASIDE,
    };
    Target {
        at: site.from.unwrap_or(-site.direction()) + aside,
        finite: site.from.is_some(),
        area: site.area_density().is_some(),
        strength,
    }
}
