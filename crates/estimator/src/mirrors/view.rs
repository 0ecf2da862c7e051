//! Following a beam and a ray from mirror to mirror.

use super::{Chain, Each, Mirrors, Viewer};
use crate::beam::Beam;
use glam::DVec3;
use malus_geometry::Facet;

/// Share of all directions below which a beam is not followed any further.
const NARROWEST: f64 = 1e-10;

/// What is seen of the mirrors behind the first of a chain.
pub(super) struct View {
    pub beam: Beam,
    pub facets: Chain,
    /// Share of all directions, weighted by the cosine, that goes through these mirrors.
    pub share: f64,
}

impl View {
    pub fn new(viewer: &Viewer) -> Self {
        Self {
            beam: Beam::hemisphere(viewer.point, viewer.normal),
            facets: Chain::new(),
            share: 1.0,
        }
    }

    /// What is seen in one more mirror, if that is wide enough to be followed.
    pub fn behind(&self, mirrors: &Mirrors, facet: u32) -> Option<Self> {
        self.in_mirror(mirrors, facet)
            .filter(|view| view.share >= NARROWEST)
    }

    /// What is seen in one more mirror, however little.
    pub fn in_mirror(&self, mirrors: &Mirrors, facet: u32) -> Option<Self> {
        let plane = &mirrors.facets.list()[facet as usize];
        let window = self
            .facets
            .last()
            .map(|&f| &mirrors.facets.list()[f as usize]);
        let beam = self.beam.through(plane, window)?;
        let share = beam.share();
        let mut facets = self.facets.clone();
        facets.push(facet);
        Some(Self {
            beam: beam.mirrored(plane),
            facets,
            share,
        })
    }

    /// The share of the way along `span` at which the last mirror is passed.
    pub fn window(&self, mirrors: &Mirrors, span: DVec3) -> Option<f64> {
        let plane = &mirrors.facets.list()[*self.facets.last()? as usize];
        let apex = self.beam.apex;
        Some((plane.height - apex.dot(plane.normal)) / span.dot(plane.normal))
    }
}

/// A ray that is followed from mirror to mirror, each taken as if nothing stood before it.
pub(super) struct Ray {
    /// Image of the viewer, in m.
    apex: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Distance from the apex to the last mirror, in m.
    passed: f64,
    pub facets: Chain,
}

impl Ray {
    pub fn new(viewer: &Viewer, direction: DVec3) -> Self {
        Self {
            apex: viewer.point,
            direction,
            passed: 0.0,
            facets: Chain::new(),
        }
    }

    pub fn reflect(&mut self, facet: u32, plane: &Facet) {
        let depth = plane.height - self.apex.dot(plane.normal);
        self.passed = depth / self.direction.dot(plane.normal);
        self.apex = plane.image(self.apex);
        self.direction = plane.mirrored(self.direction);
        self.facets.push(facet);
    }
}

impl Mirrors {
    /// One of the facets that a ray goes through next, with the probability of that choice: each is taken before those
    /// behind it as often as not.
    pub(super) fn met(&self, ray: &Ray, u: f64) -> Option<(u32, f64)> {
        let mut crossed: Each<(f64, u32)> = Each::new();
        for (index, facet) in (0..).zip(self.facets.list()) {
            if ray.facets.last() != Some(&index)
                && let Some(at) = facet.crossing(ray.apex, ray.direction)
                && at > ray.passed
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
