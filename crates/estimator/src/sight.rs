//! What sensors see straight of emitting surfaces, past little that stands before them: a form factor, not a sample.

use crate::beam::{form_factor, form_factor_behind, form_factor_within};
use crate::emitters::Emitters;
use crate::receiver::Receiver;
use glam::DVec3;
use malus_geometry::{Facet, Surfaces};
use malus_scene::Material;
use rayon::prelude::*;

/// The patches of emitters of which it is known how much a sensor sees: one bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Seen {
    patches: u64,
    /// Whether nothing else emits.
    all: bool,
}

impl Seen {
    /// Whether the light that comes straight from this patch is known.
    #[inline]
    pub(crate) fn holds(self, patch: Option<u32>) -> bool {
        patch.is_some_and(|patch| self.patches >> patch & 1 == 1)
    }

    /// Whether all light that comes straight from surfaces is known.
    #[inline]
    pub(crate) fn everything(self) -> bool {
        self.all
    }
}

/// The form factors from sensors to what they see.
pub(crate) struct Sight {
    /// One entry a sensor: the surface index of each emitter in sight, and the form factor to it.
    views: Vec<Vec<(u32, f64)>>,
}

impl Sight {
    /// Looks at every patch of emitters from every sensor of irradiance, and tells each what it need not sample; with
    /// `panes` in the scene, all that something stands before is to be sampled.
    pub(crate) fn new(
        surfaces: &Surfaces,
        emitters: &Emitters,
        receivers: &mut [Receiver],
        panes: bool,
    ) -> Self {
        let patches = Patches::new(surfaces, emitters, panes);
        let looked: Vec<(Seen, Vec<(u32, f64)>)> = receivers
            .par_iter()
            .map(|receiver| {
                if receiver.enclosed || !receiver.is_irradiance() {
                    return Default::default();
                }
                patches.from(receiver)
            })
            .collect();
        let mut views = Vec::with_capacity(receivers.len());
        for (receiver, (seen, view)) in receivers.iter_mut().zip(looked) {
            receiver.seen = seen;
            views.push(view);
        }
        Self { views }
    }

    /// Irradiance at a sensor that comes straight from patches of which it is known how much it sees, for emitters of these materials; unpolarised.
    pub(crate) fn irradiance(&self, sensor: usize, materials: &[Material]) -> f64 {
        let exitance = |surface: u32| {
            let emission = materials[surface as usize].emission.as_ref();
            emission.map_or(0.0, |e| e.exitance)
        };
        let view = &self.views[sensor];
        view.iter()
            .map(|&(surface, factor)| exitance(surface) * factor)
            .sum()
    }
}

/// The patches of emitters, with the triangles of each.
struct Patches<'a> {
    surfaces: &'a Surfaces,
    emitters: &'a Emitters<'a>,
    triangles: Vec<Vec<u32>>,
    /// Edges of each that belong to one triangle alone, as its normal has them run; none where its triangles face both ways.
    outlines: Vec<Vec<[DVec3; 2]>>,
    /// Whether every emitting triangle belongs to one.
    complete: bool,
    /// How much may stand before a patch.
    hidden: usize,
}

/// Triangles that may stand before a patch of which it is to be known how much is seen.
const HIDDEN: usize = 64;

impl<'a> Patches<'a> {
    fn new(surfaces: &'a Surfaces, emitters: &'a Emitters<'a>, panes: bool) -> Self {
        let mut triangles = vec![Vec::new(); emitters.patches().len()];
        let mut complete = true;
        for &triangle in emitters.triangles() {
            match emitters.patch(triangle) {
                Some(patch) => triangles[patch as usize].push(triangle),
                None => complete = false,
            }
        }
        let outline = |(facet, triangles): (&Facet, &Vec<u32>)| {
            let faces = |&t: &u32| surfaces.normal(t).dot(facet.normal) > 0.0;
            match triangles.iter().all(faces) {
                true => outline(surfaces, triangles),
                false => Vec::new(),
            }
        };
        let facets = emitters.patches().iter();
        Self {
            surfaces,
            emitters,
            outlines: facets.zip(&triangles).map(outline).collect(),
            triangles,
            complete,
            hidden: if panes { 0 } else { HIDDEN },
        }
    }

    fn from(&self, receiver: &Receiver) -> (Seen, Vec<(u32, f64)>) {
        let mut seen = Seen::default();
        let mut view: Vec<(u32, f64)> = Vec::new();
        for (patch, facet) in self.emitters.patches().iter().enumerate() {
            let whole = self.whole(receiver, patch);
            // In the dark nothing needs to be known of what stands before it.
            let seen_of_it = match whole > 0.0 {
                false => Some(0.0),
                true => self
                    .surfaces
                    .before(receiver.origin, &facet.hull, self.hidden)
                    .and_then(|before| match before[..] {
                        [] => Some(whole),
                        _ => self.left(receiver, patch, &before),
                    }),
            };
            let Some(factor) = seen_of_it else {
                continue;
            };
            seen.patches |= 1 << patch;
            let surface = self.surfaces.surface(facet.triangle);
            match view.iter_mut().find(|entry| entry.0 == surface) {
                Some(entry) => entry.1 += factor,
                None if factor > 0.0 => view.push((surface, factor)),
                None => {}
            }
        }
        seen.all = self.complete && seen.patches.count_ones() as usize == self.triangles.len();
        (seen, view)
    }

    /// The form factor to a patch before which nothing stands.
    fn whole(&self, receiver: &Receiver, patch: usize) -> f64 {
        let Receiver { origin, normal, .. } = *receiver;
        let facet = &self.emitters.patches()[patch];
        let outline = &self.outlines[patch];
        let horizon = origin.dot(normal);
        let risen = |[from, _]: &[DVec3; 2]| from.dot(normal) > horizon;
        if !outline.is_empty() && facet.above(origin) > 0.0 && outline.iter().all(risen) {
            return form_factor_within(origin, normal, outline);
        }
        let lit = self.lit(receiver, patch);
        lit.map(|corners| form_factor(origin, normal, &corners))
            .sum()
    }

    /// The same of what is seen past triangles that stand before it; `None` where these leave too many parts.
    fn left(&self, receiver: &Receiver, patch: usize, before: &[u32]) -> Option<f64> {
        let Receiver { origin, normal, .. } = *receiver;
        let before = before.iter().map(|&it| self.surfaces.triangle(it).vertices);
        self.lit(receiver, patch)
            .map(|corners| form_factor_behind(origin, normal, &corners, before.clone()))
            .sum()
    }

    /// Corners of the triangles of a patch that turn their front to a sensor.
    fn lit(&self, receiver: &Receiver, patch: usize) -> impl Iterator<Item = [DVec3; 3]> {
        let origin = receiver.origin;
        self.triangles[patch].iter().filter_map(move |&triangle| {
            let corners = self.surfaces.triangle(triangle).vertices;
            let above = (origin - corners[0]).dot(self.surfaces.normal(triangle));
            (above > 0.0).then_some(corners)
        })
    }
}

/// Edges that belong to one of these triangles alone.
fn outline(surfaces: &Surfaces, triangles: &[u32]) -> Vec<[DVec3; 2]> {
    let mesh = surfaces.mesh();
    let corners = |&triangle: &u32| mesh.triangles[triangle as usize];
    let edges = triangles
        .iter()
        .map(corners)
        .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut sorted: Vec<[u32; 2]> = edges.clone().collect();
    sorted.sort_unstable();
    edges
        .filter(|&[from, to]| sorted.binary_search(&[to, from]).is_err())
        .map(|edge| edge.map(|vertex| mesh.positions[vertex as usize]))
        .collect()
}
