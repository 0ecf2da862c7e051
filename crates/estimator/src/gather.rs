//! Walks from the sensors, against the light: at every vertex one emitter is looked at, straight and in mirrors, and
//! emitters met by chance count where looking could not, or was less likely to, find them.

use crate::bridge::{self, Launches, Partners};
use crate::evaluate::{Gathering, Readings, Strands};
use crate::glints::Aim;
use crate::medium::Medium;
use crate::neighbours::{Member, Neighbours};
use crate::pass::{Channels, Effort, Passes};
use crate::path::Path;
use crate::random::{Stream, Uniforms};
use crate::receiver::Receiver;
use crate::techniques::Techniques;
use crate::trace::Walk;
use crate::variation::Variation;
use std::ops::Range;

/// Sensors that walks are taken from.
#[derive(Clone, Copy)]
pub(crate) struct Observers<'a> {
    /// Those that share their walks.
    pub neighbours: &'a Neighbours,
    /// All sensors.
    pub receivers: &'a [Receiver],
    /// How the companions of the walks of each sensor are aimed.
    pub aims: &'a [Aims<'a>],
    /// Weight of walks from the emitters against those from one of the neighbours.
    pub rivalry: f64,
    /// Walks from the emitters that those from sensors are joined to.
    pub launches: &'a Launches,
    /// Which of them a walk is joined to.
    pub partners: &'a dyn Fn(u64) -> Range<u64>,
}

/// Adds the rounds `range` of walks from the neighbours to their sums, one slice each, those of one variant after those of the
/// other.
pub(crate) fn gather<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    observers: Observers,
    stream: Stream,
    range: Range<u64>,
    sums: &mut [&mut [f64]],
) -> Effort {
    let Observers {
        neighbours,
        receivers,
        aims,
        rivalry,
        launches,
        partners,
    } = observers;
    let techniques = Techniques {
        bridged: bridge::worth(
            passes.techniques.block,
            rivalry / f64::from(neighbours.round()),
            passes.main.surfaces.has_cells(),
        ),
        ..passes.techniques
    };
    let mut effort = Effort::default();
    let mut path = Path::default();
    for round in range {
        let joined = |landings| {
            let block = (techniques.block > 0).then(|| partners(round))?;
            Some(Partners::new(landings, launches.first, &block))
        };
        let of_main = joined(&launches.main);
        let of_apart = passes.apart.and_then(|_| joined(&launches.apart));
        let walks = neighbours.members.iter().enumerate();
        let walks = walks.filter(|(_, sensor)| !receivers[**sensor].enclosed);
        let walks = walks.flat_map(|(place, &sensor)| {
            let times = u64::from(neighbours.times(place));
            (round * times..(round + 1) * times).map(move |index| (place, sensor, index))
        });
        for (place, sensor, index) in walks {
            let receiver = &receivers[sensor];
            let member = Member { neighbours, place };
            let rivalry = rivalry / f64::from(neighbours.times(place));
            let way = Way {
                techniques: Techniques {
                    local: rivalry * techniques.local,
                    ..techniques
                },
                medium: passes.main,
                receiver: *receiver,
                uniforms: stream.branch(sensor as u64).walk(index),
                aim: aims[sensor].main.as_ref(),
                partners: of_main,
                member: neighbours.share(place).then_some(member),
            };
            let mut sums = Sums {
                neighbours: sums,
                place,
                count: channels.count,
            };
            let variants = passes.main.variations.len();
            let found = Some(channels.found);
            let mut main = Reader::<N>::new(receiver, &passes.main, 0);
            if let Some(channel) = channels.along {
                let mut scalar = Reader::<1>::new(receiver, &passes.main, variants);
                effort += way.follow(&mut path, |path, part| {
                    main.read(path, part);
                    scalar.read(path, part);
                });
                sums.add(scalar.readings(), &path.shares, channel, None);
            } else {
                effort += way.follow(&mut path, |path, part| main.read(path, part));
            }
            sums.add(main.readings(), &path.shares, 0, found);
            if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
                let mut apart = Reader::<1>::new(receiver, &medium, 0);
                let way = Way {
                    medium,
                    aim: aims[sensor].apart.as_ref(),
                    partners: of_apart,
                    ..way
                };
                effort += way.follow(&mut path, |path, part| apart.read(path, part));
                sums.add(apart.readings(), &path.shares, channel, None);
            }
        }
    }
    effort
}

/// The sums that a walk adds to.
struct Sums<'s, 'r> {
    /// Those of all neighbours.
    neighbours: &'s mut [&'r mut [f64]],
    /// Whose walk it is.
    place: usize,
    /// How many a sensor has in each variant.
    count: usize,
}

impl Sums<'_, '_> {
    /// Adds what a walk has read in each variant: light from the `channel` on, and where it came from, if that is asked for, from
    /// the channel `found` on. Each neighbour takes its share of what is shared.
    fn add<const N: usize>(
        &mut self,
        readings: &[Readings<N>],
        shares: &[f64],
        channel: usize,
        found: Option<usize>,
    ) {
        for (variant, [own, shared]) in readings.iter().enumerate() {
            let first = variant * self.count;
            let sums = &mut self.neighbours[self.place][first..];
            for (sum, value) in sums[channel..].iter_mut().zip(own.light()) {
                *sum += value;
            }
            if let Some(found) = found {
                for (sum, value) in sums[found..].iter_mut().zip(own.found) {
                    *sum += value;
                }
            }
            // What is shared has left a surface unpolarised.
            let s0 = shared.light()[0];
            if s0 == 0.0 {
                continue;
            }
            for (sums, share) in self.neighbours.iter_mut().zip(shares) {
                let sums = &mut sums[first..];
                sums[channel] += s0 * share;
                if let Some(found) = found {
                    for (sum, value) in sums[found..].iter_mut().zip(shared.found) {
                        *sum += value * share;
                    }
                }
            }
        }
    }
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

    /// What was read in each variant.
    fn readings(&self) -> &[Readings<N>] {
        match self {
            Self::Alone(gathering, _) => std::slice::from_ref(gathering.readings()),
            Self::Several(strands) => strands.readings(),
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
    /// The sensor among those that share the walk.
    pub member: Option<Member<'w>>,
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
            member,
        } = *self;
        path.shares.clear();
        let walk = Walk::from_sensor(
            medium, techniques, uniforms, &receiver, aim, partners, member,
        );
        let companion =
            aim.and_then(|aim| Walk::aimed(medium, techniques, uniforms, &receiver, aim));
        let mut effort = Effort {
            bridges: partners.map_or(0, |it| it.landings.len() as u64),
            joins: member.map_or(0, |it| it.neighbours.members.len() as u64),
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
