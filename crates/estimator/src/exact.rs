//! The part of the answer that needs no chance: light straight from sources without geometry, and from the emitting
//! surfaces that a sensor sees whole.

use crate::evaluate::seen;
use crate::medium::Medium;
use crate::receiver::Receiver;
use crate::sight::Sight;
use crate::variation::Variation;
use glam::DVec3;

/// Irradiance Stokes vector at each receiver from all point, spot and distant sources that it sees and from the surfaces in
/// `sight`, in unit/m².
pub(crate) fn straight<const N: usize>(
    medium: &Medium,
    receivers: &[Receiver],
    sight: Option<&Sight>,
    variation: &Variation,
) -> Vec<[f64; N]> {
    receivers
        .iter()
        .enumerate()
        .map(|(sensor, receiver)| {
            let mut sum = from_sources_at(medium, receiver, variation);
            sum[0] += sight.map_or(0.0, |s| s.irradiance(sensor, &variation.materials));
            sum
        })
        .collect()
}

fn from_sources_at<const N: usize>(
    medium: &Medium,
    receiver: &Receiver,
    variation: &Variation,
) -> [f64; N] {
    let mut sum = [0.0; N];
    if receiver.enclosed {
        return sum;
    }
    if !receiver.is_irradiance() {
        return sum;
    }
    let mut steps = Vec::new();
    for index in 0..medium.emitters.source_count() {
        let site = medium.emitters.site_of_source(index, 1.0);
        let span = site
            .from
            .map_or(-site.direction(), |from| from - receiver.origin);
        let square = span.length_squared();
        let toward = span / square.sqrt();
        let irradiance = site.irradiance(-toward, square) * toward.dot(receiver.normal);
        let irradiance = irradiance * variation.emitted(site.origin);
        // A point at the source itself has no direction to it.
        if !(irradiance > 0.0 && irradiance.is_finite()) {
            continue;
        }
        steps.clear();
        if medium
            .passage(receiver.origin, site.from, toward, &mut steps)
            .is_some()
        {
            let light = seen::<N>(receiver, -toward, site.state, &steps, variation);
            for (sum, component) in sum.iter_mut().zip(light.components()) {
                *sum += component * irradiance;
            }
        }
    }
    sum
}

/// Says if sensor points lie in point sources, where their irradiance has no bound.
pub(crate) fn singular(medium: &Medium, receivers: &[Receiver]) -> Option<String> {
    let reach = medium.surfaces.tolerance();
    let within = |receiver: &&Receiver| {
        let near = |p: DVec3| p.distance(receiver.origin) <= reach;
        !receiver.enclosed && medium.emitters.source_positions().any(near)
    };
    let count = receivers.iter().filter(within).count();
    (count > 0).then(|| {
        format!("{count} sensor points lie in a point source: its direct light, which has no bound there, is left out")
    })
}
