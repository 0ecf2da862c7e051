//! Walks from the sensors, against the light: at every vertex one emitter is looked at, straight and in mirrors, and
//! emitters met by chance count where looking could not, or was less likely to, find them.

use crate::evaluate::Gathering;
use crate::medium::Medium;
use crate::pass::{Channels, Effort, Passes};
use crate::random::{Stream, Uniforms};
use crate::receiver::Receiver;
use crate::trace::{Path, Techniques, Walk};
use crate::variation::Variation;
use std::ops::Range;

/// Adds the walks `range` of one sensor to its sums, those of one variant after those of the other; for each walk so many
/// are `launched` from the emitters.
pub(crate) fn gather<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    receiver: &Receiver,
    launched: f64,
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
) -> Effort {
    let techniques = Techniques {
        local: launched * passes.techniques.local,
        ..passes.techniques
    };
    let mut effort = Effort::default();
    let mut path = Path::default();
    let variations = passes.main.variations;
    let mut main: Vec<Gathering<N>> = Vec::with_capacity(variations.len());
    let mut scalar: Vec<Gathering<1>> = Vec::new();
    for index in range {
        let uniforms = stream.walk(index);
        restart(&mut main, variations.len(), receiver);
        if channels.along.is_some() {
            restart(&mut scalar, variations.len(), receiver);
        }
        effort += follow(
            techniques,
            &passes.main,
            receiver,
            uniforms,
            &mut path,
            |path, first| {
                read(&mut main, variations, path, first);
                read(&mut scalar, variations, path, first);
            },
        );
        for (gathering, sums) in main.iter().zip(sums.chunks_mut(channels.count)) {
            for (sum, value) in sums.iter_mut().zip(gathering.sum()) {
                *sum += value;
            }
            for (sum, value) in sums[channels.found..].iter_mut().zip(gathering.found()) {
                *sum += value;
            }
        }
        if let Some(channel) = channels.along {
            for (gathering, sums) in scalar.iter().zip(sums.chunks_mut(channels.count)) {
                sums[channel] += gathering.sum()[0];
            }
        }
        if let (Some(medium), Some(channel)) = (&passes.apart, channels.apart) {
            let variations = medium.variations;
            restart(&mut scalar, variations.len(), receiver);
            effort += follow(
                techniques,
                medium,
                receiver,
                uniforms,
                &mut path,
                |path, first| read(&mut scalar, variations, path, first),
            );
            for (gathering, sums) in scalar.iter().zip(sums.chunks_mut(channels.count)) {
                sums[channel] += gathering.sum()[0];
            }
        }
    }
    effort
}

/// Makes room for what the variants read of one more walk.
fn restart<'r, const N: usize>(
    gatherings: &mut Vec<Gathering<'r, N>>,
    count: usize,
    receiver: &'r Receiver,
) {
    gatherings.clear();
    gatherings.extend((0..count).map(|_| Gathering::new(receiver)));
}

/// Reads the next piece of a walk, or `first` what the sensor itself sees.
fn read<const N: usize>(
    gatherings: &mut [Gathering<N>],
    variations: &[Variation],
    path: &Path,
    first: bool,
) {
    for (gathering, variation) in gatherings.iter_mut().zip(variations) {
        if first {
            gathering.look(path, variation);
        } else {
            gathering.follow(path, variation);
        }
    }
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
