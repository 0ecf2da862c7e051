//! What sensors see straight of emitting surfaces, where nothing stands before them: a form factor, not a sample.

use crate::beam::form_factor;
use crate::emitters::Emitters;
use crate::receiver::Receiver;
use malus_geometry::Surfaces;
use malus_scene::Material;
use rayon::prelude::*;

/// The patches of emitters that a sensor sees whole or not at all: one bit each.
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

/// The form factors from sensors to what they see whole.
pub(crate) struct Sight {
    /// One entry a sensor: the surface index of each emitter in sight, and the form factor to it.
    views: Vec<Vec<(u32, f64)>>,
}

impl Sight {
    /// Looks at every patch of emitters from every sensor of irradiance, and tells each what it need not sample.
    pub(crate) fn new(
        surfaces: &Surfaces,
        emitters: &Emitters,
        receivers: &mut [Receiver],
    ) -> Self {
        let patches = Patches::new(surfaces, emitters);
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

    /// Irradiance at a sensor that comes straight from what it sees whole, for emitters of these materials; unpolarised.
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
}

impl<'a> Patches<'a> {
    fn new(surfaces: &'a Surfaces, emitters: &'a Emitters<'a>) -> Self {
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
            for &triangle in triangles {
                let factor = self.form_factor(receiver, triangle);
                let surface = self.surfaces.surface(triangle);
                match view[first..].iter_mut().find(|entry| entry.0 == surface) {
                    Some(entry) => entry.1 += factor,
                    None if factor > 0.0 => view.push((surface, factor)),
                    None => {}
                }
            }
            let dark = view.len() == first;
            if dark || self.surfaces.sees_whole(receiver.origin, &facet.hull) {
                seen.patches |= 1 << patch;
            } else {
                view.truncate(first);
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
}
