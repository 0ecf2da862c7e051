//! The paper's estimator (eqs. 19–21): walks from the emitters, and at every vertex a local estimate to every sensor.

use crate::emitters::Start;
use crate::evaluate::{Carrying, at_sensor};
use crate::pass::{Channels, Effort, Passes};
use crate::random::Stream;
use crate::receiver::Receiver;
use crate::trace::{Medium, Path, Walk};
use glam::DVec3;
use malus_geometry::Surfaces;
use std::f64::consts::PI;
use std::ops::Range;

/// Adds the walks `range` to the sums of all sensors.
pub(crate) fn local<'a, const N: usize>(
    passes: &Passes<'a>,
    channels: &Channels,
    receivers: &[Receiver],
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
) -> Effort {
    let surfaces = passes.main.surfaces;
    let mut effort = Effort::default();
    for index in range {
        let uniforms = stream.walk(index);
        // A start on a hidden part of an emitter carries nothing.
        let Some(start) = passes.main.emitters.start(uniforms) else {
            continue;
        };
        effort += emit::<N>(passes, channels, receivers, &start, sums);

        let walk = |medium: Medium<'a>| {
            Walk::from_emitter(medium, uniforms, start.origin, start.direction)
        };
        let mut main = Carrying::<N>::new(&start);
        if let Some(channel) = channels.along {
            let mut scalar = Carrying::<1>::new(&start);
            effort += follow(
                surfaces,
                walk(passes.main),
                receivers,
                |path, exitances| {
                    main.follow(path, passes.main.materials, |i, m| exitances[i][0] = m);
                    scalar.follow(path, passes.main.materials, |i, m| exitances[i][1] = m);
                },
                |sensor, [one, two]| {
                    sums[sensor * channels.count] += one;
                    sums[sensor * channels.count + channel] += two;
                },
            );
        } else {
            effort += follow(
                surfaces,
                walk(passes.main),
                receivers,
                |path, exitances| {
                    main.follow(path, passes.main.materials, |i, m| exitances[i][0] = m);
                },
                |sensor, [one]| sums[sensor * channels.count] += one,
            );
        }
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let mut apart = Carrying::<1>::new(&start);
            effort += follow(
                surfaces,
                walk(medium),
                receivers,
                |path, exitances| {
                    apart.follow(path, medium.materials, |i, m| exitances[i][0] = m);
                },
                |sensor, [one]| sums[sensor * channels.count + channel] += one,
            );
        }
    }
    effort
}

/// The local estimate at the point of emission itself. A source without geometry has none: it is summed exactly.
fn emit<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    receivers: &[Receiver],
    start: &Start,
    sums: &mut [f64],
) -> Effort {
    let Some(normal) = start.normal else {
        return Effort::default();
    };
    for (receiver, sums) in receivers.iter().zip(sums.chunks_mut(channels.count)) {
        let Some(coupling) = coupling(passes.main.surfaces, start.origin, normal, receiver) else {
            continue;
        };
        let direction = (receiver.origin - start.origin).normalize();
        let stokes = at_sensor::<N>(receiver, direction, start.state).components();
        for (sum, component) in sums.iter_mut().zip(stokes) {
            *sum += start.flux * coupling * component;
        }
        for channel in [channels.along, channels.apart].into_iter().flatten() {
            sums[channel] += start.flux * coupling;
        }
    }
    Effort {
        rays: receivers.len() as u64,
        truncated: 0,
    }
}

/// Takes a walk to its end and joins each diffuse vertex to every sensor.
///
/// `evaluate` fills in what each vertex of a path sends out, for K models; `add` receives the irradiance at a sensor.
fn follow<'a, const K: usize>(
    surfaces: &Surfaces,
    mut walk: Walk<'a>,
    receivers: &[Receiver],
    mut evaluate: impl FnMut(&Path<'a>, &mut [[f64; K]]),
    mut add: impl FnMut(usize, [f64; K]),
) -> Effort {
    let mut effort = Effort::default();
    let mut path = Path::new();
    let mut exitances = Vec::new();
    loop {
        path.clear();
        let more = walk.advance(&mut path);
        effort.rays += path.len() as u64;
        exitances.clear();
        exitances.resize(path.len(), [0.0; K]);
        evaluate(&path, &mut exitances);
        for (vertex, exitance) in path.iter().zip(&exitances) {
            if exitance.iter().all(|&m| m <= 0.0) {
                continue;
            }
            effort.rays += receivers.len() as u64;
            for (sensor, receiver) in receivers.iter().enumerate() {
                let coupling = coupling(surfaces, vertex.position, vertex.normal, receiver);
                if let Some(coupling) = coupling {
                    add(sensor, exitance.map(|m| m * coupling));
                }
            }
        }
        if !more {
            effort.truncated += u64::from(walk.truncated);
            return effort;
        }
    }
}

/// Irradiance at the receiver per flux scattered by Lambert's law at a point: cos θ cos θ′ Θ/(π |r − r′|²) (eq. 16).
fn coupling(surfaces: &Surfaces, from: DVec3, normal: DVec3, receiver: &Receiver) -> Option<f64> {
    if receiver.enclosed {
        return None;
    }
    let segment = receiver.origin - from;
    let leaving = segment.dot(normal);
    let arriving = -segment.dot(receiver.normal);
    if leaving <= 0.0 || arriving <= 0.0 {
        return None;
    }
    let square = segment.length_squared();
    surfaces
        .visible(from, receiver.origin)
        .then(|| leaving * arriving / (PI * square * square))
}
