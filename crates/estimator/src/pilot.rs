//! A few walks of either kind, thrown away afterwards: how much each of them errs at every sensor, and what it costs.

use crate::allocation::Allocation;
use crate::bridge::Launches;
use crate::gather::{Aims, Observers, gather};
use crate::local::{Sensors, local};
use crate::medium::Medium;
use crate::neighbours::{Neighbours, shared_out};
use crate::pass::{Channels, Effort, Passes};
use crate::random::Stream;
use crate::receiver::Receiver;
use crate::statistics::REPLICAS;
use malus_geometry::Targets;
use rayon::prelude::*;

/// Rounds of the pilot: so few where these tell enough, and at most so many.
const FEWEST_ROUNDS: u64 = 8;
const MOST_ROUNDS: u64 = 12;

/// Walks of the pilot from the emitters, at least.
const LAUNCHED: u64 = 48;

/// Walks from all sensors in one round, of which each has one at least, and in all rounds that tell enough.
const GATHERED: u64 = 16;
const ENOUGH: u64 = 192;

/// By how much less walks from the emitters err in a run, whose points are many and spread evenly. Far from walls their
/// light is smooth; it is not where walks from the sensors are needed.
const EVEN: f64 = 5.0;

/// Walks from one sensor that tell as much of its variance as the mean over all sensors does.
const TELLING: f64 = 16.0;

/// The same where nothing is scattered and sensors see lamps by mirrors alone, of which each has some of its own.
const TELLING_BETWEEN_MIRRORS: f64 = 4.0;

/// Cost of a ray, of joining a vertex to a sensor, of looking into mirrors from a vertex, and of a bridge between two, relative to
/// each other.
const RAY: f64 = 1.0;
const JOIN: f64 = 0.2;
const LOOK: f64 = 4.0;
const BRIDGE: f64 = 0.03;

/// The sensors of a run, for a pilot to take walks from.
pub(crate) struct Stations<'a> {
    /// Each of them.
    pub receivers: &'a [Receiver],
    /// The same, to be asked which of them a point sees.
    pub targets: &'a Targets,
    /// How each aims at small mirrors.
    pub aims: &'a [Aims<'a>],
    /// Whether neighbours share walks.
    pub share: bool,
}

/// What the pilot works with.
pub(crate) struct Pilot<'a> {
    passes: Passes<'a>,
    channels: Channels,
    receivers: &'a [Receiver],
    targets: &'a Targets,
    share: bool,
    /// Those that share walks, of which each takes one a round.
    pub neighbours: Vec<Neighbours>,
    aims: &'a [Aims<'a>],
    /// How many rounds it takes.
    rounds: u32,
    /// Walks from the emitters and from each sensor in one round, and how many sensors take any.
    launched: u64,
    walks: u64,
    taking: usize,
    tried: &'a Allocation,
}

/// One round of the pilot: what a walk of either kind brings to S0 at each sensor, and what all of them cost.
struct Round {
    launched: Vec<f64>,
    gathered: Vec<f64>,
    cost_launched: f64,
    cost_gathered: f64,
}

/// What a pilot has found.
pub(crate) struct Findings {
    /// What each sensor needs that takes part.
    pub needs: Vec<Need>,
    /// What a walk from the emitters costs, and one from a sensor.
    pub costs: [f64; 2],
}

impl<'a> Pilot<'a> {
    /// A pilot of the main model of the first variant alone, and of that S0 alone: the walks are the same.
    pub(crate) fn new(passes: &Passes<'a>, stations: Stations<'a>, tried: &'a Allocation) -> Self {
        let Stations {
            receivers,
            targets,
            aims,
            share,
        } = stations;
        let free = receivers.iter().filter(|it| takes_part(it)).count();
        let free = free.max(1) as u64;
        let walks = (GATHERED / free).max(1);
        let rounds = ENOUGH
            .div_ceil(walks * free)
            .clamp(FEWEST_ROUNDS, MOST_ROUNDS);
        Self {
            rounds: rounds as u32,
            launched: LAUNCHED.div_ceil(rounds),
            walks,
            taking: receivers.iter().filter(|it| !it.enclosed).count(),
            passes: Passes {
                main: Medium {
                    variations: &passes.main.variations[..1],
                    ..passes.main
                },
                apart: None,
                ..*passes
            },
            channels: Channels::of_intensity(),
            receivers,
            targets,
            share,
            neighbours: Neighbours::all(
                passes.main.surfaces,
                receivers,
                &tried.memberships,
                &vec![1; receivers.len()],
                share,
            ),
            aims,
            tried,
        }
    }

    /// Takes its walks, for sensors of which the irradiance `exact` is known without.
    pub(crate) fn find(&self, exact: impl Fn(usize) -> f64, seed: u64) -> Findings {
        let rounds: Vec<Round> = (0..self.rounds)
            .into_par_iter()
            // Beyond the streams of the run and of its pictures, so that no walk of the run is known beforehand.
            .map(|round| self.round(Stream::new(seed, 2 * REPLICAS + round)))
            .collect();
        let free = (0..self.receivers.len()).filter(|&sensor| takes_part(&self.receivers[sensor]));
        let mut needs: Vec<Need> = free
            .map(|sensor| Need::of(&rounds, [self.launched, self.walks], sensor, exact(sensor)))
            .collect();
        let count = needs.len().max(1) as f64;
        let mean = needs.iter().map(|n| n.mean).sum::<f64>() / count;
        for need in &mut needs {
            let square = need.mean.max(1e-3 * mean).powi(2);
            need.launched /= square;
            need.gathered /= square;
        }
        // So few walks seldom meet what is rare and bright, and then at few sensors: what one has met warns the others.
        let gathered = needs.iter().map(|n| n.gathered).sum::<f64>() / count;
        let own = f64::from(self.rounds) * self.walks as f64;
        let guessed = self.passes.main.radiosity.is_some();
        let telling = match !guessed && needs.iter().all(|n| n.launched <= 0.0) {
            true => TELLING_BETWEEN_MIRRORS,
            false => TELLING,
        };
        for need in &mut needs {
            need.gathered = (own * need.gathered + telling * gathered) / (own + telling);
        }
        let launched = f64::from(self.rounds) * self.launched as f64;
        let gathered = own * needs.len() as f64;
        let costs = [
            rounds.iter().map(|r| r.cost_launched).sum::<f64>() / launched,
            rounds.iter().map(|r| r.cost_gathered).sum::<f64>() / gathered,
        ];
        Findings { needs, costs }
    }

    fn round(&self, stream: Stream) -> Round {
        let count = self.channels.count;
        let mut launched = vec![0.0; self.receivers.len() * count];
        let mut launches = Launches::default();
        let walks = match self.passes.techniques.local > 0.0 {
            true => self.launched,
            // They correct a guess alone.
            false => 0,
        };
        let local = local::<1>(
            &self.passes,
            &self.channels,
            &Sensors {
                receivers: self.receivers,
                targets: self.targets,
                share: self.share,
                allocation: self.tried,
            },
            stream,
            0..walks,
            &mut launched,
            &mut launches,
        );
        let mut gathered = vec![0.0; launched.len()];
        let mut effort = Effort::default();
        let sums = gathered.chunks_mut(count);
        let shared = shared_out(&self.neighbours, sums);
        for (neighbours, mut sums) in self.neighbours.iter().zip(shared) {
            let first = neighbours.members[0];
            effort += gather::<1>(
                &self.passes,
                &self.channels,
                Observers {
                    neighbours,
                    receivers: self.receivers,
                    aims: self.aims,
                    rivalry: self.tried.rivalry(first),
                    launches: &launches,
                    partners: &|_| 0..self.launched,
                },
                stream,
                0..self.walks,
                &mut sums,
            );
        }
        let rays = effort.rays as f64;
        let begun = (self.walks * self.taking as u64) as f64;
        let mirrors = &self.passes.main.mirrors;
        // Every other ray of a walk from a sensor leads to a vertex.
        let looks =
            mirrors.odds(true) * begun + mirrors.odds(false) * (0.5 * rays - begun).max(0.0);
        let joins = |effort: Effort| JOIN * effort.joins as f64;
        let means = |sums: &[f64], walks: u64| {
            let first = sums.iter().step_by(count);
            first.map(|sum| sum / walks as f64).collect()
        };
        Round {
            launched: means(&launched, self.launched),
            gathered: means(&gathered, self.walks),
            cost_launched: RAY * local.rays as f64 + joins(local),
            cost_gathered: RAY * rays
                + LOOK * looks
                + joins(effort)
                + BRIDGE * effort.bridges as f64,
        }
    }
}

/// Whether a sensor's error counts.
fn takes_part(receiver: &Receiver) -> bool {
    !receiver.enclosed && receiver.is_irradiance()
}

/// What a sensor needs: relative variance of one walk of either kind, and S0.
pub(crate) struct Need {
    /// Which sensor.
    pub sensor: usize,
    mean: f64,
    pub launched: f64,
    pub gathered: f64,
}

impl Need {
    /// A need of so much relative variance of one walk from the emitters, and of one from the sensor.
    #[cfg(test)]
    pub(crate) fn relative(launched: f64, gathered: f64) -> Self {
        Self {
            sensor: 0,
            mean: 1.0,
            launched,
            gathered,
        }
    }

    /// What one sensor needs, by so many walks from the emitters and from the sensor in each round.
    fn of(rounds: &[Round], [launched, walks]: [u64; 2], sensor: usize, exact: f64) -> Self {
        let (local, from_emitters) = moments(rounds.iter().map(|r| r.launched[sensor]));
        let (looked, from_sensor) = moments(rounds.iter().map(|r| r.gathered[sensor]));
        Self {
            sensor,
            mean: exact + local + looked,
            launched: from_emitters * launched as f64 / EVEN,
            gathered: from_sensor * walks as f64,
        }
    }
}

/// Mean and variance of some values.
fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|v| (v - mean) * (v - mean)).sum();
    (mean, squares / (count - 1.0))
}
