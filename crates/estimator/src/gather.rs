//! Walks from the sensors, against the light: at every vertex one emitter is looked at, straight and in mirrors, and
//! emitters met by chance count where looking could not, or was less likely to, find them.

use crate::evaluate::Gathering;
use crate::medium::Medium;
use crate::pass::{Channels, Effort, Passes};
use crate::random::{Stream, Uniforms};
use crate::receiver::Receiver;
use crate::trace::{Path, Techniques, Walk};
use std::ops::Range;

/// Adds the walks `range` of one sensor to its sums; for each of them so many are `launched` from the emitters.
pub(crate) fn gather<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    receiver: &Receiver,
    launched: f64,
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
) -> Effort {
    let materials = passes.main.materials;
    let techniques = Techniques {
        local: launched * passes.techniques.local,
        ..passes.techniques
    };
    let mut effort = Effort::default();
    let mut path = Path::default();
    for index in range {
        let uniforms = stream.walk(index);
        let mut main = Gathering::<N>::new(receiver);
        if let Some(channel) = channels.along {
            let mut scalar = Gathering::<1>::new(receiver);
            effort += follow(
                techniques,
                &passes.main,
                receiver,
                uniforms,
                &mut path,
                |path, first| {
                    if first {
                        main.look(path);
                        scalar.look(path);
                    } else {
                        main.follow(path, materials);
                        scalar.follow(path, materials);
                    }
                },
            );
            sums[channel] += scalar.sum()[0];
        } else {
            effort += follow(
                techniques,
                &passes.main,
                receiver,
                uniforms,
                &mut path,
                |path, first| {
                    if first {
                        main.look(path);
                    } else {
                        main.follow(path, materials);
                    }
                },
            );
        }
        for (sum, value) in sums.iter_mut().zip(main.sum()) {
            *sum += value;
        }
        for (sum, value) in sums[channels.found..].iter_mut().zip(main.found()) {
            *sum += value;
        }
        if let (Some(medium), Some(channel)) = (&passes.apart, channels.apart) {
            let mut apart = Gathering::<1>::new(receiver);
            effort += follow(
                techniques,
                medium,
                receiver,
                uniforms,
                &mut path,
                |path, first| {
                    if first {
                        apart.look(path);
                    } else {
                        apart.follow(path, medium.materials);
                    }
                },
            );
            sums[channel] += apart.sum()[0];
        }
    }
    effort
}

/// Takes a walk to its end, piece by piece; `evaluate` is given first what the sensor itself sees.
pub(crate) fn follow<'a>(
    techniques: Techniques,
    medium: &Medium<'a>,
    receiver: &Receiver,
    uniforms: Uniforms,
    path: &mut Path<'a>,
    mut evaluate: impl FnMut(&Path<'a>, bool),
) -> Effort {
    path.clear();
    let mut walk = Walk::from_sensor(*medium, techniques, uniforms, receiver);
    walk.look(path);
    let mut rays = 1;
    evaluate(path, true);
    loop {
        path.clear();
        let more = walk.advance(path);
        evaluate(path, false);
        // Each vertex costs the segment that led to it and one look at an emitter.
        rays += 2 * path.vertices.len() as u64;
        if !more {
            return Effort {
                rays,
                joins: 0,
                truncated: u64::from(walk.truncated),
            };
        }
    }
}
