//! How many walks each sensor takes for one walk from the emitters.
//!
//! A walk from the emitters serves all sensors at once, and sees little of what lies close to one; a walk from a sensor is
//! dear, and does as well beside a wall as in the open. A few walks of either kind, thrown away afterwards, tell how much
//! each of them errs at every sensor. The shares are then those that bring all sensors to one relative error at the least
//! cost; as they depend on scene and seed alone, the sums of a run do not depend on when it stops.

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
use serde::{Deserialize, Serialize};

/// A sensor's share of walks is a multiple of one over this.
const PARTS: u32 = 64;

/// Greatest share, in parts: eight walks from the sensor for one from the emitters.
const MOST: u32 = 8 * PARTS;

/// Most walks that a sensor takes in a round, of which one of its neighbours takes one.
const TIMES: u32 = 4;

/// Share with which the pilot weighs the two kinds of walk against each other, in parts.
const TRIED: u32 = PARTS / 8;

/// Rounds of the pilot, and in one round the walks from the emitters and those from all sensors, of which each has one at
/// least.
const ROUNDS: u32 = 12;
const LAUNCHED: u64 = 4;
const GATHERED: u64 = 16;

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

/// How much a walk from the emitters counts for where differences between means over many points are asked for.
const IN_DIFFERENCES: f64 = 0.2;

/// By what walks are shared out between the emitters and the sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sharing<'a> {
    /// What brings each sensor point to its error at the least cost, as a pilot finds it.
    Points,
    /// What serves means over many points, and their differences between scenes of which each has walks of its own.
    ///
    /// All points share a walk from the emitters and err together by it, and where a lamp has moved such walks fall out of
    /// step at edges. Those from the sensors answer for more of the light here.
    Differences,
    /// An earlier run, with which this one is paired.
    Like(&'a Allocation),
}

impl Sharing<'_> {
    /// How much a walk from the emitters counts for, beside the density of its points.
    fn trust(self) -> f64 {
        match self {
            Self::Points => 1.0,
            Self::Differences => IN_DIFFERENCES,
            Self::Like(allocation) => allocation.trust,
        }
    }
}

/// The sensors of a run, for a pilot to take walks from.
pub(crate) struct Stations<'a> {
    /// Each of them.
    pub receivers: &'a [Receiver],
    /// The same, to be asked which of them a point sees.
    pub targets: &'a Targets,
    /// How each aims at small mirrors.
    pub aims: &'a [Aims<'a>],
    /// To which neighbours each belongs.
    pub memberships: Vec<usize>,
    /// Whether neighbours share walks.
    pub share: bool,
}

/// Walks from each sensor, relative to those from the emitters, as the pilot of a run has found them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Allocation {
    /// Rounds of walks from each sensor for [`PARTS`] walks from the emitters: the same for neighbours.
    parts: Vec<u32>,
    /// Walks that each sensor takes in a round.
    times: Vec<u32>,
    /// To which neighbours each sensor belongs.
    pub(crate) memberships: Vec<usize>,
    /// How much a walk from the emitters counts for.
    trust: f64,
    /// Relative variance at the worst sensor that one walk from the emitters, with its share of walks from the sensors, is
    /// expected to leave; infinite where no pilot has told.
    variance: f64,
}

impl Allocation {
    /// As many from each sensor as from all emitters together.
    pub(crate) fn even(memberships: Vec<usize>) -> Self {
        Self {
            parts: vec![PARTS; memberships.len()],
            times: vec![1; memberships.len()],
            memberships,
            trust: 1.0,
            variance: f64::INFINITY,
        }
    }

    /// Whether it is for so many sensors.
    pub(crate) fn fits(&self, sensors: usize) -> bool {
        self.parts.len() == sensors
    }

    /// Largest relative error that so many walks from the emitters in all are expected to leave.
    pub(crate) fn expected_error(&self, launched: u64) -> f64 {
        (self.variance / launched as f64).sqrt()
    }

    /// Rounds of walks that a sensor has taken in a replica once so many were taken from the emitters.
    #[inline]
    pub(crate) fn rounds(&self, sensor: usize, launched: u64) -> u64 {
        let rounds = u128::from(launched) * u128::from(self.parts[sensor]);
        u64::try_from(rounds.div_ceil(u128::from(PARTS))).unwrap_or(u64::MAX)
    }

    /// Walks that a sensor has taken by then.
    #[inline]
    pub(crate) fn walks(&self, sensor: usize, launched: u64) -> u64 {
        self.rounds(sensor, launched)
            .saturating_mul(u64::from(self.times[sensor]))
    }

    /// Walks that each sensor takes in a round.
    pub(crate) fn times(&self) -> &[u32] {
        &self.times
    }

    /// The last walk from the emitters that has been taken when a sensor's round of that index is.
    #[inline]
    pub(crate) fn partner(&self, sensor: usize, round: u64) -> u64 {
        let launched = u128::from(round) * u128::from(PARTS) / u128::from(self.parts[sensor]);
        u64::try_from(launched).unwrap_or(u64::MAX)
    }

    /// Walks from the emitters for one walk from this sensor.
    fn launched(&self, sensor: usize) -> f64 {
        f64::from(PARTS) / (f64::from(self.parts[sensor]) * f64::from(self.times[sensor]))
    }

    /// Weight of walks from the emitters against one walk a round from this sensor, beside the densities of their points.
    #[inline]
    pub(crate) fn rivalry(&self, sensor: usize) -> f64 {
        self.trust * f64::from(PARTS) / f64::from(self.parts[sensor])
    }

    /// The shares that a pilot run finds, for sensors of which the irradiance `exact` is known without walks.
    pub(crate) fn piloted(
        passes: &Passes,
        stations: Stations,
        exact: impl Fn(usize) -> f64,
        seed: u64,
        sharing: Sharing,
    ) -> Self {
        let Stations {
            receivers,
            targets,
            aims,
            memberships,
            share,
        } = stations;
        let trust = sharing.trust();
        let sensors = receivers.len();
        let free: Vec<usize> = (0..sensors)
            .filter(|&s| !receivers[s].enclosed && receivers[s].is_irradiance())
            .collect();
        let walks = (GATHERED / free.len().max(1) as u64).max(1);
        let pilot = Pilot {
            walks,
            taking: receivers.iter().filter(|it| !it.enclosed).count(),
            // The main model of the first variant alone, and of that S0 alone: the walks are the same.
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
                &memberships,
                &vec![1; sensors],
                share,
            ),
            aims,
            tried: Self {
                parts: vec![TRIED; sensors],
                trust,
                ..Self::even(memberships)
            },
        };
        let rounds: Vec<Round> = (0..ROUNDS)
            .into_par_iter()
            // Beyond the streams of the run and of its pictures, so that no walk of the run is known beforehand.
            .map(|round| pilot.round(Stream::new(seed, 2 * REPLICAS + round)))
            .collect();
        let mut needs: Vec<Need> = free
            .iter()
            .map(|&sensor| Need::of(&rounds, walks, sensor, exact(sensor)))
            .collect();
        let mean = needs.iter().map(|n| n.mean).sum::<f64>() / needs.len().max(1) as f64;
        for need in &mut needs {
            let square = need.mean.max(1e-3 * mean).powi(2);
            need.launched /= square;
            need.gathered /= square;
        }
        // So few walks seldom meet what is rare and bright, and then at few sensors: what one has met warns the others.
        let gathered = needs.iter().map(|n| n.gathered).sum::<f64>() / needs.len().max(1) as f64;
        let own = f64::from(ROUNDS) * walks as f64;
        let telling = match needs.iter().all(|n| n.launched <= 0.0) {
            true => TELLING_BETWEEN_MIRRORS,
            false => TELLING,
        };
        for need in &mut needs {
            need.gathered = (own * need.gathered + telling * gathered) / (own + telling);
        }
        let launched = f64::from(ROUNDS) * LAUNCHED as f64;
        let cost_launched = rounds.iter().map(|r| r.cost_launched).sum::<f64>() / launched;
        let gathered = own * free.len() as f64;
        let cost_gathered = rounds.iter().map(|r| r.cost_gathered).sum::<f64>() / gathered;
        let mut shares = Self {
            parts: vec![PARTS; sensors],
            ..pilot.tried
        };
        if let Some(shared) = cheapest(&needs, cost_launched, cost_gathered) {
            for (&sensor, need) in free.iter().zip(&needs) {
                let parts = f64::from(PARTS) * need.gathered / (shared - need.launched);
                // A share that is no number asks for nothing, and no share is nothing.
                shares.parts[sensor] = (parts.round() as u32).clamp(1, MOST);
            }
            for neighbours in &pilot.neighbours {
                shares.share_out(&neighbours.members);
            }
            let left = |(&sensor, need): (&usize, &Need)| {
                need.launched + need.gathered * shares.launched(sensor)
            };
            shares.variance = free.iter().zip(&needs).map(left).fold(0.0, f64::max);
        }
        shares
    }
}

impl Allocation {
    /// Gives sensors that share walks, and of which each has its own share by now, rounds in which they take as many in
    /// proportion.
    fn share_out(&mut self, members: &[usize]) {
        let parts = |&sensor: &usize| self.parts[sensor];
        let least = members.iter().map(parts).min().unwrap_or(PARTS);
        let most = members.iter().map(parts).max().unwrap_or(PARTS);
        let parts = least.max(most.div_ceil(TIMES));
        for &sensor in members {
            let times = f64::from(self.parts[sensor]) / f64::from(parts);
            self.times[sensor] = (times.round() as u32).max(1);
            self.parts[sensor] = parts;
        }
    }
}

/// What a sensor needs: relative variance of one walk of either kind, and S0.
struct Need {
    mean: f64,
    launched: f64,
    gathered: f64,
}

impl Need {
    fn of(rounds: &[Round], walks: u64, sensor: usize, exact: f64) -> Self {
        let (local, from_emitters) = moments(rounds.iter().map(|r| r.launched[sensor]));
        let (looked, from_sensor) = moments(rounds.iter().map(|r| r.gathered[sensor]));
        Self {
            mean: exact + local + looked,
            launched: from_emitters * LAUNCHED as f64 / EVEN,
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

/// The variance V that a run with one walk from the emitters is to have at every sensor; `None` where there is none.
///
/// With L and W the relative variances of a walk of either kind, a sensor that takes W/(V − L) walks for one from the emitters
/// comes to V/n after n of these. To any error the cost is in proportion to V c + Σ W/(1 − L/V) c′. Where walks from the
/// emitters bring nothing, there are as many from a sensor on average.
fn cheapest(needs: &[Need], cost_launched: f64, cost_gathered: f64) -> Option<f64> {
    let greatest = needs.iter().map(|n| n.launched).fold(0.0, f64::max);
    if greatest <= 0.0 {
        let mean = needs.iter().map(|n| n.gathered).sum::<f64>() / needs.len().max(1) as f64;
        return (mean > 0.0).then_some(mean);
    }
    let cost = |variance: f64| {
        let gathered = needs
            .iter()
            .map(|n| n.gathered / (1.0 - n.launched / variance));
        variance * cost_launched + gathered.sum::<f64>() * cost_gathered
    };
    let mut best: Option<(f64, f64)> = None;
    let mut variance = 1.05 * greatest;
    for _ in 0..40 {
        let cost = cost(variance);
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, variance));
        }
        variance *= 1.25;
    }
    best.map(|(_, variance)| variance)
}

/// What the pilot works with.
struct Pilot<'a> {
    passes: Passes<'a>,
    channels: Channels,
    receivers: &'a [Receiver],
    targets: &'a Targets,
    share: bool,
    neighbours: Vec<Neighbours>,
    aims: &'a [Aims<'a>],
    /// Walks from each sensor in one round, and how many sensors take any.
    walks: u64,
    taking: usize,
    tried: Allocation,
}

/// One round of the pilot: what a walk of either kind brings to S0 at each sensor, and what all of them cost.
struct Round {
    launched: Vec<f64>,
    gathered: Vec<f64>,
    cost_launched: f64,
    cost_gathered: f64,
}

impl Pilot<'_> {
    fn round(&self, stream: Stream) -> Round {
        let count = self.channels.count;
        let mut launched = vec![0.0; self.receivers.len() * count];
        let mut launches = Launches::default();
        let local = local::<1>(
            &self.passes,
            &self.channels,
            &Sensors {
                receivers: self.receivers,
                targets: self.targets,
                share: self.share,
                allocation: &self.tried,
            },
            stream,
            0..LAUNCHED,
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
                    partners: &|_| 0..LAUNCHED,
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
            launched: means(&launched, LAUNCHED),
            gathered: means(&gathered, self.walks),
            cost_launched: RAY * local.rays as f64 + joins(local),
            cost_gathered: RAY * rays
                + LOOK * looks
                + joins(effort)
                + BRIDGE * effort.bridges as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walks_of_a_share_are_rounded_up_so_that_every_sensor_has_one() {
        let shares = Allocation {
            parts: vec![1, 16, 64, 512],
            ..Allocation::even(vec![0, 1, 2, 3])
        };
        let walks = |launched| [0, 1, 2, 3].map(|sensor| shares.walks(sensor, launched));
        assert_eq!(walks(0), [0; 4]);
        assert_eq!(walks(1), [1, 1, 1, 8]);
        assert_eq!(walks(128), [2, 32, 128, 1024]);
        assert_eq!(shares.walks(3, u64::MAX), u64::MAX);
    }

    #[test]
    fn shares_bring_all_sensors_to_one_error_at_the_least_cost() {
        // One sensor, L = W = 1 and equal costs: V + 1/(1 − 1/V) is least at V = 2, and W/(V − L) = 1.
        let need = |launched, gathered| Need {
            mean: 1.0,
            launched,
            gathered,
        };
        let variance = cheapest(&[need(1.0, 1.0)], 1.0, 1.0).unwrap();
        assert!((variance / 2.0 - 1.0).abs() < 0.13, "{variance}");
        // Walks from a sensor that cost nothing are taken without end.
        let needs = [need(1.0, 1.0), need(0.1, 4.0)];
        let dear = cheapest(&needs, 1.0, 100.0).unwrap();
        let cheap = cheapest(&needs, 1.0, 1e-3).unwrap();
        assert!(cheap < 1.06 && dear > 4.0, "{cheap} {dear}");
        // Without walks from the emitters the mean share is one.
        assert_eq!(
            cheapest(&[need(0.0, 1.0), need(0.0, 2.0)], 1.0, 1.0),
            Some(1.5)
        );
        assert_eq!(cheapest(&[need(0.0, 0.0)], 1.0, 1.0), None);
    }
}
