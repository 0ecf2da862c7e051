//! Walks from the sensors, against the light: at every vertex one emitter is looked at, straight and in mirrors, and
//! emitters met by chance count where looking could not, or was less likely to, find them.

use crate::evaluate::Gathering;
use crate::glints::Aim;
use crate::medium::Medium;
use crate::pass::{Channels, Effort, Passes};
use crate::random::{Stream, Uniforms};
use crate::receiver::Receiver;
use crate::trace::{Path, Techniques, Walk};
use crate::variation::Variation;
use std::ops::Range;

/// A sensor that walks are taken from.
#[derive(Clone, Copy)]
pub(crate) struct Observer<'a> {
    /// The sensor.
    pub receiver: &'a Receiver,
    /// How the companions of its walks are aimed.
    pub aims: &'a Aims<'a>,
    /// Walks from the emitters for one of its own.
    pub launched: f64,
}

/// Adds the walks `range` of one sensor to its sums, those of one variant after those of the other.
pub(crate) fn gather<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    observer: Observer,
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
) -> Effort {
    let Observer {
        receiver,
        aims,
        launched,
    } = observer;
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
        let way = Way {
            techniques,
            medium: passes.main,
            receiver: *receiver,
            uniforms,
            aim: aims.main.as_ref(),
        };
        restart(&mut main, variations, receiver);
        if channels.along.is_some() {
            restart(&mut scalar, variations, receiver);
        }
        effort += way.follow(&mut path, |path, part| {
            read(&mut main, variations, path, part);
            read(&mut scalar, variations, path, part);
        });
        for (gathering, sums) in main.iter().zip(sums.chunks_mut(channels.count)) {
            for (sum, value) in sums.iter_mut().zip(gathering.sum()) {
                *sum += value;
            }
            for (sum, value) in sums[channels.found..].iter_mut().zip(gathering.found()) {
                *sum += value;
            }
        }
        if let Some(channel) = channels.along {
            add(&scalar, sums, channels.count, channel);
        }
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let way = Way {
                medium,
                aim: aims.apart.as_ref(),
                ..way
            };
            restart(&mut scalar, medium.variations, receiver);
            effort += way.follow(&mut path, |path, part| {
                read(&mut scalar, medium.variations, path, part);
            });
            add(&scalar, sums, channels.count, channel);
        }
        scalar.clear();
    }
    effort
}

/// Makes room for what the variants read of one more walk.
fn restart<'r, const N: usize>(
    gatherings: &mut Vec<Gathering<'r, N>>,
    variations: &[Variation],
    receiver: &'r Receiver,
) {
    gatherings.clear();
    gatherings.extend(variations.iter().map(|_| Gathering::new(receiver)));
}

/// Reads a piece of a walk in every variant.
fn read<const N: usize>(
    gatherings: &mut [Gathering<N>],
    variations: &[Variation],
    path: &Path,
    part: Part,
) {
    for (gathering, variation) in gatherings.iter_mut().zip(variations) {
        gathering.read(path, part, variation);
    }
}

/// Adds S0 of every variant to its `channel`, of `count` that each has.
fn add(gatherings: &[Gathering<1>], sums: &mut [f64], count: usize, channel: usize) {
    for (gathering, sums) in gatherings.iter().zip(sums.chunks_mut(count)) {
        sums[channel] += gathering.sum()[0];
    }
}

/// How the companions of one sensor's walks are aimed at small mirrors.
#[derive(Default)]
pub(crate) struct Aims<'a> {
    main: Option<Aim<'a>>,
    apart: Option<Aim<'a>>,
}

impl<'a> Aims<'a> {
    /// Those of every sensor.
    pub(crate) fn all(passes: &Passes<'a>, receivers: &[Receiver]) -> Vec<Self> {
        let aim = |medium: Medium<'a>, receiver: &Receiver| {
            let small = passes.techniques.mirrored.then_some(medium.glints)?;
            Aim::new(small, medium.surfaces, receiver)
        };
        let aims = |receiver: &Receiver| Self {
            main: aim(passes.main, receiver),
            apart: passes.apart.and_then(|apart| aim(apart, receiver)),
        };
        receivers.iter().map(aims).collect()
    }

    /// Greatest share of an emitter's exitance that one walk may bring which meets it in a small mirror.
    pub(crate) fn greatest(&self) -> f64 {
        let aims = self.main.iter().chain(&self.apart);
        aims.map(Aim::greatest).fold(0.0, f64::max)
    }
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
