//! Walks from the sensors, against the light: at every vertex one emitter is looked at, straight and in mirrors, and
//! emitters met by chance count where looking could not, or was less likely to, find them.

use crate::evaluate::Gathering;
use crate::glints::Aim;
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
    let main_aim = aim(techniques, passes.main, receiver);
    let apart_aim = passes.apart.and_then(|apart| aim(techniques, apart, receiver));
    let mut effort = Effort::default();
    let mut path = Path::default();
    for index in range {
        let uniforms = stream.walk(index);
        let mut main = Gathering::<N>::new(receiver);
        let way = Way {
            techniques,
            medium: passes.main,
            receiver: *receiver,
            uniforms,
            aim: main_aim.as_ref(),
        };
        if let Some(channel) = channels.along {
            let mut scalar = Gathering::<1>::new(receiver);
            effort += way.follow(&mut path, |path, part| {
                main.read(path, part, materials);
                scalar.read(path, part, materials);
            });
            sums[channel] += scalar.sum()[0];
        } else {
            effort += way.follow(&mut path, |path, part| main.read(path, part, materials));
        }
        for (sum, value) in sums.iter_mut().zip(main.sum()) {
            *sum += value;
        }
        for (sum, value) in sums[channels.found..].iter_mut().zip(main.found()) {
            *sum += value;
        }
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let mut apart = Gathering::<1>::new(receiver);
            let way = Way {
                medium,
                aim: apart_aim.as_ref(),
                ..way
            };
            effort += way.follow(&mut path, |path, part| {
                apart.read(path, part, medium.materials);
            });
            sums[channel] += apart.sum()[0];
        }
    }
    effort
}

/// How companions are aimed at small mirrors.
fn aim<'a>(techniques: Techniques, medium: Medium<'a>, receiver: &Receiver) -> Option<Aim<'a>> {
    let small = techniques.mirrored.then_some(medium.glints)?;
    Aim::new(small, medium.surfaces, receiver)
}

/// A piece of what a walk from a sensor finds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// What the sensor itself sees: a walk starts.
    Start,
    /// The next vertices.
    Onward,
}

/// A walk from a sensor, before it is taken.
#[derive(Clone, Copy)]
pub(crate) struct Way<'w> {
    /// How it finds light.
    pub techniques: Techniques,
    /// What it goes through.
    pub medium: Medium<'w>,
    /// The sensor.
    pub receiver: Receiver,
    /// Its numbers.
    pub uniforms: Uniforms,
    /// How its companion is aimed.
    pub aim: Option<&'w Aim<'w>>,
}

impl<'w> Way<'w> {
    /// Takes the walk and its companion to their ends, piece by piece.
    pub(crate) fn follow(
        &self,
        path: &mut Path<'w>,
        mut read: impl FnMut(&Path<'w>, Part),
    ) -> Effort {
        let Self {
            techniques,
            medium,
            receiver,
            uniforms,
            aim,
        } = *self;
        let walk = Walk::from_sensor(medium, techniques, uniforms, &receiver, aim);
        let companion =
            aim.and_then(|aim| Walk::aimed(medium, techniques, uniforms, &receiver, aim));
        let mut effort = Effort::default();
        for mut walk in std::iter::once(walk).chain(companion) {
            path.clear();
            walk.look(path);
            read(path, Part::Start);
            effort.rays += 1;
            let mut more = true;
            while more {
                path.clear();
                more = walk.advance(path);
                read(path, Part::Onward);
                // Each vertex costs the segment that led to it and one look at an emitter.
                effort.rays += 2 * path.vertices.len() as u64;
            }
            effort.truncated += u64::from(walk.truncated);
        }
        effort
    }
}
