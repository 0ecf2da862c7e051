//! The part of the answer that needs no chance: light straight from sources without geometry.

use crate::evaluate::at_sensor;
use crate::receiver::Receiver;
use crate::trace::{Medium, unobstructed};
use glam::DVec3;

/// Irradiance Stokes vector at each receiver from all point, spot and distant sources that it sees, in unit/m².
pub(crate) fn from_sources<const N: usize>(
    medium: &Medium,
    receivers: &[Receiver],
) -> Vec<[f64; N]> {
    receivers
        .iter()
        .map(|receiver| from_sources_at(medium, receiver))
        .collect()
}

fn from_sources_at<const N: usize>(medium: &Medium, receiver: &Receiver) -> [f64; N] {
    let mut sum = [0.0; N];
    if receiver.enclosed {
        return sum;
    }
    for index in 0..medium.emitters.source_count() {
        let Some(incoming) = medium.emitters.light_of_source(index, receiver.origin) else {
            continue;
        };
        let cos = incoming.toward.dot(receiver.normal);
        if cos <= 0.0 || !unobstructed(medium.surfaces, receiver.origin, &incoming) {
            continue;
        }
        let light = at_sensor::<N>(receiver, -incoming.toward, incoming.state);
        for (sum, component) in sum.iter_mut().zip(light.components()) {
            *sum += component * (incoming.irradiance * cos);
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
