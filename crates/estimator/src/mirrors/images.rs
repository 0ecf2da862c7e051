//! Images of a point behind chains of mirrors too long to be drawn by their beams.

use super::view::Ray;
use super::{Drawn, LONGEST_CHAIN, Mirrors, Target, Viewer, tested};
use crate::direction::in_cone;
use crate::random::{Fresh, Uniforms};
use glam::DVec3;

/// Radius of the cone of directions about an image, as a share of the scene's.
pub(super) const SPREAD: f64 = 0.5;

/// Part of such a cone that leads to the image, or so: it only weighs techniques against each other.
const TRIED: f64 = 0.4;

/// Tries after which, and after twice as many each time, half of the images are tried no further and the tries of the others
/// count twice.
const TRIES: u64 = 64;

/// Directions about one that leads to an image.
struct Cone {
    axis: DVec3,
    cos: f64,
}

impl Cone {
    /// Solid angle as a share of the hemisphere's.
    fn share(&self) -> f64 {
        1.0 - self.cos
    }
}

impl Mirrors {
    /// The part of [`draw`](Self::draw) for chains too long for their beams.
    ///
    /// Far images stand low above a surface that sees many of them, so the ray is drawn evenly over the hemisphere.
    pub(super) fn draw_images(
        &self,
        viewer: &Viewer,
        target: &Target,
        uniforms: Uniforms,
        depth: u32,
        (look_odds, known): (f64, usize),
        mut found: impl FnMut(Drawn, f64),
    ) {
        let [s, t, ..] = uniforms.in_chain(depth, 1 << 30);
        let direction = in_cone(viewer.normal, 0.0, [s, t]);
        let mut ray = Ray::new(viewer, direction);
        let mut followed = look_odds;
        for order in 0..LONGEST_CHAIN {
            let [test, onward, select, _] = uniforms.in_chain(depth, order | 3 << 30);
            let Some((facet, _)) = self.met(&ray, select) else {
                return;
            };
            let goes_on = self.onward(viewer, order as usize, known, facet, ray.direction);
            ray.reflect(facet, self.facet(facet));
            let odds = tested(order + 1);
            if !target.beam(ray.facets.len()) && ray.facets.len() > known && test < odds {
                let image = self.image(&ray.facets, target);
                let tries = uniforms.fresh(depth, order);
                if let Some(inverse) = self.tried(viewer, target, direction, image, &ray, tries) {
                    let choices = uniforms.fresh(depth, order | 1 << 31);
                    let image = Drawn::Image(image, ray.facets.len(), choices);
                    found(image, inverse / (odds * followed));
                }
            }
            if onward >= goes_on {
                return;
            }
            followed *= goes_on;
        }
    }

    /// One over the probability with which a direction of the hemisphere lies in the cone about an image and leads to it
    /// as `ray` does, without bias; `None` where `direction`, which has led there, lies outside.
    ///
    /// It is the mean number of tries that this takes, Σ (1 − p)ᵗ. Where the mirrors of a room make images without number, p
    /// has no bound, but the tries that are made grow as log 1/p.
    fn tried(
        &self,
        viewer: &Viewer,
        target: &Target,
        direction: DVec3,
        image: DVec3,
        ray: &Ray,
        mut tries: Fresh,
    ) -> Option<f64> {
        let cone = self.cone(viewer, image);
        if direction.dot(cone.axis) < cone.cos {
            return None;
        }
        let leads = |[u, v, mut select, _]: [f64; 4], tries: &mut Fresh| {
            let tried = in_cone(cone.axis, cone.cos, [u, v]);
            if tried.dot(viewer.normal) <= 0.0 {
                return false;
            }
            let mut retraced = Ray::new(viewer, tried);
            while retraced.facets.len() < ray.facets.len()
                && let Some((facet, _)) = self.met(&retraced, select)
            {
                retraced.reflect(facet, self.facet(facet));
                [select, ..] = tries.next();
            }
            retraced.facets.len() == ray.facets.len()
                && self.same(
                    self.image(&retraced.facets, target),
                    image,
                    ray.facets.len(),
                )
        };
        let (mut sum, mut weight, mut count, mut octave) = (1.0, 1.0, 0, TRIES);
        loop {
            let numbers = tries.next();
            if leads(numbers, &mut tries) {
                break;
            }
            count += 1;
            if count == octave {
                if numbers[3] < 0.5 {
                    break;
                }
                weight *= 2.0;
                octave *= 2;
            }
            sum += weight;
        }
        Some(sum / cone.share())
    }

    /// Probability with which an image is drawn once a ray has come so far, or so.
    pub(super) fn image_share(&self, viewer: &Viewer, image: DVec3) -> f64 {
        self.cone(viewer, image).share() * TRIED
    }

    /// The directions about an image that are tried.
    fn cone(&self, viewer: &Viewer, image: DVec3) -> Cone {
        let span = image - viewer.point;
        let distance = span.length();
        let axis = span / distance;
        let sine = (self.spread / distance).min(0.5);
        Cone {
            axis,
            // As many digits as it takes to tell a narrow cone from none.
            cos: 1.0 - sine * sine / (1.0 + (1.0 - sine * sine).sqrt()),
        }
    }
}
