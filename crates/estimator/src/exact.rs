//! The part of the answer that needs no chance: light of sources without geometry, straight and by their images in flat
//! mirrors, and light straight from the emitting surfaces that a sensor sees whole.

use crate::evaluate::seen;
use crate::medium::{Medium, Step};
use crate::mirrors::Viewer;
use crate::pass::{Channels, Passes};
use crate::receiver::Receiver;
use crate::sight::Sight;
use crate::site::Site;
use crate::variation::Variation;
use glam::DVec3;
use rayon::prelude::*;

/// What is known of each sensor in one variant of a scene: a value for each of the channels, in unit/m².
pub(crate) struct Known {
    values: Vec<f64>,
    count: usize,
}

impl Known {
    /// Nothing at so many sensors.
    pub(crate) fn nothing(channels: &Channels, sensors: usize) -> Self {
        let count = channels.count;
        Self {
            values: vec![0.0; sensors * count],
            count,
        }
    }

    /// One channel of one sensor.
    #[inline]
    pub(crate) fn at(&self, sensor: usize, channel: usize) -> f64 {
        self.values[sensor * self.count + channel]
    }
}

/// A way by which light of a source without geometry reaches a sensor.
struct Ray<'a> {
    site: Site<'a>,
    /// Direction in which it leaves the source.
    leaving: DVec3,
    /// Irradiance at the sensor if nothing is lost on the way, in unit/m².
    irradiance: f64,
    /// Mirrors and panes, as the sensor sees them.
    steps: Vec<Step>,
}

/// What each variant has at each sensor from the surfaces in `sight`, by a guess of what surfaces scatter, and from all point,
/// spot and distant sources that it sees: straight, and where walks look into mirrors by all listed images.
pub(crate) fn known<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    receivers: &[Receiver],
    sight: Option<&Sight>,
) -> Vec<Known> {
    let variants = passes.main.variations.len();
    let of_sensor = |(sensor, receiver): (usize, &Receiver)| {
        let mut values = vec![0.0; variants * channels.count];
        let mirrored = passes.techniques.mirrored;
        let rays = to_sources(&passes.main, receiver, mirrored);
        let apart = passes
            .apart
            .map(|medium| (medium, to_sources(&medium, receiver, mirrored)));
        for (variant, values) in values.chunks_mut(channels.count).enumerate() {
            let variation = &passes.main.variations[variant];
            let straight = sight.map_or(0.0, |s| s.irradiance(sensor, &variation.materials));
            let radiosity = passes.main.radiosity;
            let straight = straight + radiosity.map_or(0.0, |it| it.at_sensor(receiver));
            let main = sum::<N>(receiver, &rays, variation);
            values[..N].copy_from_slice(&main);
            values[0] += straight;
            if let Some(channel) = channels.along {
                let [light] = sum::<1>(receiver, &rays, variation);
                values[channel] = light + straight;
            }
            if let (Some((medium, rays)), Some(channel)) = (&apart, channels.apart) {
                let [light] = sum::<1>(receiver, rays, &medium.variations[variant]);
                values[channel] = light + straight;
            }
        }
        values
    };
    let values: Vec<Vec<f64>> = receivers.par_iter().enumerate().map(of_sensor).collect();
    let count = channels.count;
    let of_variant = |variant: usize| Known {
        values: values
            .iter()
            .flat_map(|of_sensor| &of_sensor[variant * count..(variant + 1) * count])
            .copied()
            .collect(),
        count,
    };
    (0..variants).map(of_variant).collect()
}

/// What comes by some rays, in the sensor's basis.
fn sum<const N: usize>(receiver: &Receiver, rays: &[Ray], variation: &Variation) -> [f64; N] {
    let mut sum = [0.0; N];
    for ray in rays {
        let Ray { site, leaving, .. } = *ray;
        let irradiance = ray.irradiance * variation.emitted(site.origin);
        let light = seen::<N>(receiver, leaving, site.state, &ray.steps, variation);
        for (sum, component) in sum.iter_mut().zip(light.components()) {
            *sum += component * irradiance;
        }
    }
    sum
}

/// The ways from a sensor straight to sources, and if it looks into mirrors to their images.
fn to_sources<'a>(medium: &Medium<'a>, receiver: &Receiver, mirrored: bool) -> Vec<Ray<'a>> {
    let mut rays = Vec::new();
    if receiver.enclosed || !receiver.is_irradiance() {
        return rays;
    }
    let sources = 0..medium.emitters.source_count();
    let sites: Vec<Site> = sources
        .map(|index| medium.emitters.site_of_source(index, 1.0))
        .collect();
    for site in &sites {
        let span = site
            .from
            .map_or(-site.direction(), |from| from - receiver.origin);
        let square = span.length_squared();
        let toward = span / square.sqrt();
        let irradiance = site.irradiance(-toward, square) * toward.dot(receiver.normal);
        // A point at the source itself has no direction to it.
        if !(irradiance > 0.0 && irradiance.is_finite()) || is_at(medium, receiver, site) {
            continue;
        }
        let mut steps = Vec::new();
        if medium
            .passage(receiver.origin, site.from, toward, &mut steps)
            .is_some()
        {
            rays.push(Ray {
                site: *site,
                leaving: -toward,
                irradiance,
                steps,
            });
        }
    }
    if mirrored {
        rays.extend(
            medium
                .mirrors
                .image_sources()
                .iter()
                .filter_map(|image| by_image(medium, receiver, &sites[image.source], &image.chain)),
        );
    }
    rays
}

/// The way from a sensor to an image of a source, if light comes by it.
fn by_image<'a>(
    medium: &Medium<'a>,
    receiver: &Receiver,
    site: &Site<'a>,
    chain: &[u32],
) -> Option<Ray<'a>> {
    let viewer = Viewer {
        point: receiver.origin,
        normal: receiver.normal,
        sensor: true,
    };
    if is_at(medium, receiver, site) {
        return None;
    }
    let mut steps = Vec::new();
    let way = medium.way_to(&viewer, site, chain, &mut steps)?;
    let leaving = -way.arriving;
    let irradiance = site.irradiance(leaving, way.square) * way.start.dot(viewer.normal);
    (irradiance > 0.0 && irradiance.is_finite()).then_some(Ray {
        site: *site,
        leaving,
        irradiance,
        steps,
    })
}

/// Whether a sensor lies in a point source, where its irradiance has no bound.
fn is_at(medium: &Medium, receiver: &Receiver, site: &Site) -> bool {
    let near = |from: DVec3| from.distance(receiver.origin) <= medium.surfaces.tolerance();
    site.from.is_some_and(near)
}

/// Says if sensor points lie in point sources.
pub(crate) fn singular(medium: &Medium, receivers: &[Receiver]) -> Option<String> {
    let sources = 0..medium.emitters.source_count();
    let sites: Vec<Site> = sources
        .map(|index| medium.emitters.site_of_source(index, 1.0))
        .collect();
    let within = |receiver: &&Receiver| {
        !receiver.enclosed && sites.iter().any(|site| is_at(medium, receiver, site))
    };
    let count = receivers.iter().filter(within).count();
    (count > 0).then(|| {
        format!(
            "{count} sensor points lie in a point source: its light, which has no bound there, is left out, but not what \
             surfaces next to it send back"
        )
    })
}
