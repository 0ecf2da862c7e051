//! What sensors see straight of emitting surfaces, past little that stands before them: a form factor, not a sample.

use crate::beam::{form_factor, form_factor_behind};
use crate::emitters::Emitters;
use crate::receiver::Receiver;
use malus_geometry::Surfaces;
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
        Self {
            surfaces,
            emitters,
            triangles,
            complete,
            hidden: if panes { 0 } else { HIDDEN },
        }
    }

    fn from(&self, receiver: &Receiver) -> (Seen, Vec<(u32, f64)>) {
        let mut seen = Seen::default();
        let mut view: Vec<(u32, f64)> = Vec::new();
        for (patch, (facet, triangles)) in self
            .emitters
            .patches()
            .iter()
            .zip(&self.triangles)
            .enumerate()
        {
            let first = view.len();
            let mut add = |triangle: u32, factor: f64| {
                let surface = self.surfaces.surface(triangle);
                match view[first..].iter_mut().find(|entry| entry.0 == surface) {
                    Some(entry) => entry.1 += factor,
                    None if factor > 0.0 => view.push((surface, factor)),
                    None => {}
                }
            };
            let whole: Vec<(u32, f64)> = triangles
                .iter()
                .map(|&triangle| (triangle, self.form_factor(receiver, triangle)))
                .filter(|&(_, factor)| factor > 0.0)
                .collect();
            // In the dark nothing needs to be known of what stands before it.
            let before = match whole[..] {
                [] => Some(Vec::new()),
                _ => self
                    .surfaces
                    .before(receiver.origin, &facet.hull, self.hidden),
            };
            let left = |&(triangle, factor): &(u32, f64), before: &[u32]| match before {
                [] => Some((triangle, factor)),
                _ => Some((triangle, self.left(receiver, triangle, before)?)),
            };
            let seen_of_it: Option<Vec<(u32, f64)>> =
                before.and_then(|before| whole.iter().map(|it| left(it, &before)).collect());
            if let Some(seen_of_it) = seen_of_it {
                seen.patches |= 1 << patch;
                for (triangle, factor) in seen_of_it {
                    add(triangle, factor);
                }
            }
        }
        seen.all = self.complete && seen.patches.count_ones() as usize == self.triangles.len();
        (seen, view)
    }

    /// 0 behind the triangle and below the horizon.
    fn form_factor(&self, receiver: &Receiver, triangle: u32) -> f64 {
        let corners = self.surfaces.triangle(triangle).vertices;
        let above = (receiver.origin - corners[0]).dot(self.surfaces.normal(triangle));
        if above <= 0.0 {
            return 0.0;
        }
        form_factor(receiver.origin, receiver.normal, &corners)
    }

    /// The same of what is seen past others; `None` where these leave too many parts.
    fn left(&self, receiver: &Receiver, triangle: u32, before: &[u32]) -> Option<f64> {
        let corners = self.surfaces.triangle(triangle).vertices;
        let before = before.iter().map(|&it| self.surfaces.triangle(it).vertices);
        form_factor_behind(receiver.origin, receiver.normal, &corners, before)
    }
}
