//! Walks from the sensors, against the light: at every vertex one emitter is looked at, and emitters met by chance
//! count where looking could not, or was less likely to, find them.

use crate::evaluate::Gathering;
use crate::pass::{Channels, Effort, Passes};
use crate::random::Stream;
use crate::receiver::Receiver;
use crate::trace::{Path, Walk};
use std::ops::Range;

/// Adds the walks `range` of one sensor to its sums.
pub(crate) fn gather<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    receiver: &Receiver,
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
) -> Effort {
    let Receiver { origin, normal, .. } = *receiver;
    let materials = passes.main.materials;
    let mut effort = Effort::default();
    let mut path = Path::new();
    for index in range {
        let uniforms = stream.walk(index);
        let mut walk = Walk::from_sensor(passes.main, uniforms, origin, normal);
        let direct = walk.first_connection(normal);
        effort.rays += 1;
        let mut main = Gathering::<N>::new(receiver);
        main.connect(direct.as_ref());
        if let Some(channel) = channels.along {
            let mut scalar = Gathering::<1>::new(receiver);
            scalar.connect(direct.as_ref());
            effort += follow(&mut walk, &mut path, |path| {
                main.follow(path, materials);
                scalar.follow(path, materials);
            });
            sums[channel] += scalar.sum()[0];
        } else {
            effort += follow(&mut walk, &mut path, |path| main.follow(path, materials));
        }
        for (sum, value) in sums.iter_mut().zip(main.sum()) {
            *sum += value;
        }
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let mut walk = Walk::from_sensor(medium, uniforms, origin, normal);
            let mut apart = Gathering::<1>::new(receiver);
            apart.connect(direct.as_ref());
            effort += follow(&mut walk, &mut path, |path| {
                apart.follow(path, medium.materials);
            });
            sums[channel] += apart.sum()[0];
        }
    }
    effort
}

/// Takes a walk to its end, piece by piece.
fn follow<'a>(
    walk: &mut Walk<'a>,
    path: &mut Path<'a>,
    mut evaluate: impl FnMut(&Path<'a>),
) -> Effort {
    let mut rays = 0;
    loop {
        path.clear();
        let more = walk.advance(path);
        evaluate(path);
        // Each vertex costs the segment that led to it and one look at an emitter.
        rays += 2 * path.len() as u64;
        if !more {
            return Effort {
                rays,
                truncated: u64::from(walk.truncated),
            };
        }
    }
}
