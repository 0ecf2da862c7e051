//! The paper's estimator (eqs. 19–21): walks from the emitters, and at every vertex a local estimate to every sensor.

mod joining;

use crate::allocation::Allocation;
use crate::bridge::Launches;
use crate::evaluate::{Carrying, sent};
use crate::pass::{Channels, Effort, Passes};
use crate::path::Path;
use crate::random::Stream;
use crate::receiver::Receiver;
use crate::site::Start;
use crate::variation::Variation;
use joining::{Joining, seen, straight};
use malus_geometry::{Surfaces, Targets};
use std::ops::Range;

/// The sensors that walks are joined to.
#[derive(Clone, Copy)]
pub(crate) struct Sensors<'a> {
    /// Each of them.
    pub receivers: &'a [Receiver],
    /// The same, to be asked which of them a point sees.
    pub targets: &'a Targets,
    /// Whether neighbours share walks of their own.
    pub share: bool,
    /// Walks of their own for one from the emitters.
    pub allocation: &'a Allocation,
}

/// Adds the walks `range` to the sums of all sensors, at each those of one variant after those of the other.
pub(crate) fn local<'a, const N: usize>(
    passes: &Passes<'a>,
    channels: &Channels,
    sensors: &Sensors,
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
    launches: &mut Launches,
) -> Effort {
    let mut effort = Effort::default();
    let variations = passes.main.variations;
    let count = channels.count;
    let width = variations.len() * count;
    let mut main: Vec<Carrying<N>> = Vec::with_capacity(variations.len());
    let mut scalar: Vec<Carrying<1>> = Vec::new();
    for index in range {
        let uniforms = stream.walk(index);
        // A start on a hidden part of an emitter carries nothing.
        let Some(start) = passes.main.emitters.start(uniforms) else {
            launches.main.start();
            launches.apart.start();
            continue;
        };
        // Where walks from the sensors look at emitters, they alone answer for light that comes straight.
        if !passes.techniques.gather {
            effort += emit::<N>(passes, channels, sensors, &start, sums);
        }
        let joining = Joining {
            techniques: passes.techniques,
            sensors,
            uniforms,
        };
        restart(&mut main, variations, &start);
        if let Some(channel) = channels.along {
            restart(&mut scalar, variations, &start);
            effort += joining.follow(
                passes.main,
                &start,
                2 * variations.len(),
                &mut launches.main,
                |path, fluxes| {
                    carry(&mut main, variations, path, fluxes, 0);
                    carry(&mut scalar, variations, path, fluxes, variations.len());
                },
                |sensor, fluxes, arrival| {
                    let sums = &mut sums[sensor * width..][..width];
                    let (of_main, of_scalar) = fluxes.split_at(variations.len());
                    arrival.add::<N>(sums, count, 0, of_main, variations);
                    arrival.add::<1>(sums, count, channel, of_scalar, variations);
                },
            );
        } else {
            effort += joining.follow(
                passes.main,
                &start,
                variations.len(),
                &mut launches.main,
                |path, fluxes| carry(&mut main, variations, path, fluxes, 0),
                |sensor, fluxes, arrival| {
                    let sums = &mut sums[sensor * width..][..width];
                    arrival.add::<N>(sums, count, 0, fluxes, variations);
                },
            );
        }
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let variations = medium.variations;
            restart(&mut scalar, variations, &start);
            effort += joining.follow(
                medium,
                &start,
                variations.len(),
                &mut launches.apart,
                |path, fluxes| carry(&mut scalar, variations, path, fluxes, 0),
                |sensor, fluxes, arrival| {
                    let sums = &mut sums[sensor * width..][..width];
                    arrival.add::<1>(sums, count, channel, fluxes, variations);
                },
            );
        }
    }
    effort
}

/// Makes room for what one more walk carries in each variant.
fn restart<const N: usize>(
    carrying: &mut Vec<Carrying<N>>,
    variations: &[Variation],
    start: &Start,
) {
    carrying.clear();
    carrying.extend(variations.iter().map(|it| Carrying::new(start, it)));
}

/// Carries light along the next piece of a walk; each vertex of `fluxes` takes what the variants scatter there, from the
/// `first` place on.
fn carry<const N: usize>(
    carrying: &mut [Carrying<N>],
    variations: &[Variation],
    path: &Path,
    fluxes: &mut [f64],
    first: usize,
) {
    let width = fluxes.len() / path.vertices.len().max(1);
    for (index, (carrying, variation)) in carrying.iter_mut().zip(variations).enumerate() {
        carrying.follow(&path.vertices, variation, |vertex, flux| {
            fluxes[vertex * width + first + index] = flux;
        });
    }
}

/// The local estimate at the point of emission itself. A source without geometry has none: it is summed exactly.
fn emit<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    sensors: &Sensors,
    start: &Start,
    sums: &mut [f64],
) -> Effort {
    let Sensors {
        receivers, targets, ..
    } = *sensors;
    let Some(normal) = start.normal else {
        return Effort::default();
    };
    let variations = passes.main.variations;
    let width = variations.len() * channels.count;
    let mut steps = Vec::new();
    let seen = seen(&passes.main, start.origin, normal, targets);
    for (sensor, (receiver, sums)) in receivers.iter().zip(sums.chunks_mut(width)).enumerate() {
        if !seen.as_ref().is_none_or(|seen| seen[sensor]) {
            continue;
        }
        steps.clear();
        let clear = seen.is_some();
        let way = straight(
            &passes.main,
            start.origin,
            normal,
            receiver,
            clear,
            &mut steps,
        );
        let Some(way) = way else {
            continue;
        };
        for (variation, sums) in variations.iter().zip(sums.chunks_mut(channels.count)) {
            let flux = start.flux * variation.emitted(start.site.origin) * way.coupling;
            let light = sent::<N>(receiver, way.direction, start.site.state, &steps, variation);
            for (sum, component) in sums.iter_mut().zip(light.components()) {
                *sum += flux * component;
            }
            for channel in [channels.along, channels.apart].into_iter().flatten() {
                let light = sent::<1>(receiver, way.direction, None, &steps, variation);
                sums[channel] += flux * light.i();
            }
        }
    }
    Effort {
        joins: receivers.len() as u64,
        ..Effort::default()
    }
}

/// The receivers as targets; those that light cannot be joined to straight are seen from nowhere.
pub(crate) fn targets(surfaces: &Surfaces, receivers: &[Receiver]) -> Targets {
    let targets = receivers.iter().map(|receiver| {
        let joined = receiver.is_irradiance() && !receiver.enclosed;
        (receiver.origin, receiver.normal * f64::from(joined))
    });
    surfaces.targets(&targets.collect::<Vec<_>>())
}
