//! Walks from the sensors, against the light: at every vertex one emitter is looked at, straight and in mirrors, and
//! emitters met by chance count where looking could not, or was less likely to, find them.

use crate::bridge::{self, Launches, Partners};
use crate::evaluate::{Gathering, Strands};
use crate::glints::Aim;
use crate::medium::Medium;
use crate::pass::{Channels, Effort, Passes};
use crate::path::Path;
use crate::random::{Stream, Uniforms};
use crate::receiver::Receiver;
use crate::techniques::Techniques;
use crate::trace::Walk;
use crate::variation::Variation;
use std::ops::Range;

/// A sensor that walks are taken from.
#[derive(Clone, Copy)]
pub(crate) struct Observer<'a> {
    /// The sensor.
    pub receiver: &'a Receiver,
    /// How the companions of its walks are aimed.
    pub aims: &'a Aims<'a>,
    /// Weight of walks from the emitters against its own.
    pub rivalry: f64,
    /// Walks from the emitters that its own are joined to.
    pub launches: &'a Launches,
    /// Which of them a walk is joined to.
    pub partners: &'a dyn Fn(u64) -> Range<u64>,
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
        rivalry,
        launches,
        partners,
    } = observer;
    let techniques = Techniques {
        local: rivalry * passes.techniques.local,
        bridged: bridge::worth(passes.techniques.block, rivalry),
        ..passes.techniques
    };
    let mut effort = Effort::default();
    let mut path = Path::default();
    let count = channels.count;
    for index in range {
        let uniforms = stream.walk(index);
        let joined = |landings| {
            let block = (techniques.block > 0).then(|| partners(index))?;
            Some(Partners::new(landings, launches.first, &block))
        };
        let way = Way {
            techniques,
            medium: passes.main,
            receiver: *receiver,
            uniforms,
            aim: aims.main.as_ref(),
            partners: joined(&launches.main),
        };
        let variants = passes.main.variations.len();
        let mut main = Reader::<N>::new(receiver, &passes.main, 0);
        if let Some(channel) = channels.along {
            let mut scalar = Reader::<1>::new(receiver, &passes.main, variants);
            effort += way.follow(&mut path, |path, part| {
                main.read(path, part);
                scalar.read(path, part);
            });
            scalar.add(sums, count, channel, None);
        } else {
            effort += way.follow(&mut path, |path, part| main.read(path, part));
        }
        main.add(sums, count, 0, Some(channels.found));
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let mut apart = Reader::<1>::new(receiver, &medium, 0);
            let way = Way {
                medium,
                aim: aims.apart.as_ref(),
                partners: joined(&launches.apart),
                ..way
            };
            effort += way.follow(&mut path, |path, part| apart.read(path, part));
            apart.add(sums, count, channel, None);
        }
    }
    effort
}

/// What a sensor reads of one walk: in one variant, or in several.
enum Reader<'r, const N: usize> {
    Alone(Gathering<'r, N>, &'r Variation),
    Several(Strands<'r, N>),
}

impl<'r, const N: usize> Reader<'r, N> {
    /// Nothing read yet; of what walks from the emitters bring, it reads from the place `first` on.
    fn new(receiver: &'r Receiver, medium: &Medium<'r>, first: usize) -> Self {
        match medium.variations {
            [alone] => Self::Alone(Gathering::new(receiver, first), alone),
            _ => Self::Several(Strands::new(receiver, medium.spread, first)),
        }
    }

    fn read(&mut self, path: &Path, part: Part) {
        match self {
            Self::Alone(gathering, variation) => gathering.read(path, part, variation),
            Self::Several(strands) => strands.read(path, part),
        }
    }

    /// Adds what was read to the sums of each variant, of which there are `count`: light from the `channel` on, and where it
    /// came from, if that is asked for, from the channel `found` on.
    fn add(&self, sums: &mut [f64], count: usize, channel: usize, found: Option<usize>) {
        let add = |sums: &mut [f64], light: [f64; N], parts: [f64; 2]| {
            for (sum, value) in sums[channel..].iter_mut().zip(light) {
                *sum += value;
            }
            if let Some(found) = found {
                for (sum, value) in sums[found..].iter_mut().zip(parts) {
                    *sum += value;
                }
            }
        };
        match self {
            Self::Alone(gathering, _) => add(sums, gathering.sum(), gathering.found()),
            Self::Several(strands) => {
                for (sums, (light, parts)) in sums.chunks_mut(count).zip(strands.readings()) {
                    add(sums, light, parts);
                }
            }
        }
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
    /// The walks from the emitters that it is joined to.
    pub partners: Option<Partners<'w>>,
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
            partners,
        } = *self;
        let walk = Walk::from_sensor(medium, techniques, uniforms, &receiver, aim, partners);
        let companion =
            aim.and_then(|aim| Walk::aimed(medium, techniques, uniforms, &receiver, aim));
        let mut effort = Effort {
            bridges: partners.map_or(0, |it| it.landings.len() as u64),
            ..Effort::default()
        };
        let mut take = |mut walk: Walk<'w>| {
            path.clear();
            walk.look(path);
            read(path, Part::Start);
            effort.rays += 1;
            path.clear();
            let mut known = 0;
            loop {
                let more = walk.advance(path);
                read(path, Part::Onward);
                // Each new vertex costs the segment that led to it and one look at an emitter.
                effort.rays += 2 * (path.vertices.len() - known) as u64;
                path.clear();
                known = 0;
                if more {
                    continue;
                }
                effort.truncated += u64::from(walk.truncated);
                let Some(vertex) = walk.turn() else {
                    break;
                };
                read(path, Part::Start);
                path.vertices.push(vertex);
                known = 1;
            }
        };
        take(walk);
        if let Some(companion) = companion {
            take(companion);
        }
        effort
    }
}
