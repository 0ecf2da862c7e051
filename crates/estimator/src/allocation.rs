//! How many walks each sensor takes for one walk from the emitters.
//!
//! A walk from the emitters serves all sensors at once, and sees little of what lies close to one; a walk from a sensor is
//! dear, and does as well beside a wall as in the open. A few walks of either kind, thrown away afterwards, tell how much
//! each of them errs at every sensor. The shares are then those that bring all sensors to one relative error at the least
//! cost; as they depend on scene and seed alone, the sums of a run do not depend on when it stops.

use crate::pass::Passes;
use crate::pilot::{Findings, Need, Pilot, Stations};
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;

/// A sensor's share of walks is a multiple of one over this.
const PARTS: u32 = 64;

/// Greatest share, in parts: eight walks from the sensor for one from the emitters.
const MOST: u32 = 8 * PARTS;

/// Most walks that a sensor takes in a round, of which one of its neighbours takes one.
const TIMES: u32 = 2;

// Points of a sequence are spread best where their number is a power of two. So are all shares.
const _: () = assert!(PARTS.is_power_of_two() && MOST.is_power_of_two() && TIMES.is_power_of_two());

/// Share with which the pilot weighs the two kinds of walk against each other, in parts.
const TRIED: u32 = PARTS / 8;

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
        memberships: Vec<usize>,
        exact: impl Fn(usize) -> f64,
        seed: u64,
        sharing: Sharing,
    ) -> Self {
        let sensors = memberships.len();
        let tried = Self {
            parts: vec![TRIED; sensors],
            trust: sharing.trust(),
            ..Self::even(memberships)
        };
        let pilot = Pilot::new(passes, stations, &tried);
        let Findings { needs, costs } = pilot.find(exact, seed);
        let mut shares = Self {
            parts: vec![PARTS; sensors],
            ..tried.clone()
        };
        if let Some(shared) = cheapest(&needs, costs) {
            for need in &needs {
                let parts = f64::from(PARTS) * need.gathered / (shared - need.launched);
                // A share that is no number asks for nothing, and no share is nothing.
                shares.parts[need.sensor] = (parts.round() as u32).clamp(1, MOST);
            }
            for neighbours in &pilot.neighbours {
                shares.share_out(&neighbours.members);
            }
            let left = |need: &Need| need.launched + need.gathered * shares.launched(need.sensor);
            shares.variance = needs.iter().map(left).fold(0.0, f64::max);
        }
        shares
    }

    /// Gives sensors that share walks, and of which each has its own share by now, rounds in which they take as many in
    /// proportion: all by powers of two.
    fn share_out(&mut self, members: &[usize]) {
        let parts = |&sensor: &usize| self.parts[sensor];
        let least = members.iter().map(parts).min().unwrap_or(PARTS);
        let most = members.iter().map(parts).max().unwrap_or(PARTS);
        let parts = power_of_two(f64::from(least.max(most.div_ceil(TIMES))));
        for &sensor in members {
            let times = f64::from(self.parts[sensor]) / f64::from(parts);
            self.times[sensor] = power_of_two(times).min(TIMES);
            self.parts[sensor] = parts;
        }
    }
}

/// The power of two nearest to a number by ratio; 1 of all that is less.
fn power_of_two(number: f64) -> u32 {
    let mut power = 1;
    while power < MOST && f64::from(power) * SQRT_2 < number {
        power *= 2;
    }
    power
}

/// The variance V that a run with one walk from the emitters is to have at every sensor; `None` where there is none.
///
/// With L and W the relative variances of a walk of either kind, a sensor that takes W/(V − L) walks for one from the emitters
/// comes to V/n after n of these. To any error the cost is in proportion to V c + Σ W/(1 − L/V) c′, with c and c′ what a walk
/// of either kind costs. Where walks from the emitters bring nothing, there are as many from a sensor on average.
fn cheapest(needs: &[Need], [cost_launched, cost_gathered]: [f64; 2]) -> Option<f64> {
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
    fn neighbours_take_walks_by_powers_of_two() {
        let mut shares = Allocation {
            parts: vec![150, 66, 49, 300, 7],
            ..Allocation::even(vec![0, 0, 0, 0, 1])
        };
        shares.share_out(&[0, 1, 2, 3]);
        shares.share_out(&[4]);
        // Half of the greatest is more than the least; the nearest power of two to 150 is 128.
        assert_eq!(shares.parts, [128, 128, 128, 128, 8]);
        assert_eq!(shares.times, [1, 1, 1, 2, 1]);
        let nearest = [0.3, 1.4, 1.5, 2.8, 2.9, 45.0, 46.0, 1e9].map(power_of_two);
        assert_eq!(nearest, [1, 1, 2, 2, 4, 32, 64, MOST]);
    }

    #[test]
    fn shares_bring_all_sensors_to_one_error_at_the_least_cost() {
        // One sensor, L = W = 1 and equal costs: V + 1/(1 − 1/V) is least at V = 2, and W/(V − L) = 1.
        let need = Need::relative;
        let variance = cheapest(&[need(1.0, 1.0)], [1.0, 1.0]).unwrap();
        assert!((variance / 2.0 - 1.0).abs() < 0.13, "{variance}");
        // Walks from a sensor that cost nothing are taken without end.
        let needs = [need(1.0, 1.0), need(0.1, 4.0)];
        let dear = cheapest(&needs, [1.0, 100.0]).unwrap();
        let cheap = cheapest(&needs, [1.0, 1e-3]).unwrap();
        assert!(cheap < 1.06 && dear > 4.0, "{cheap} {dear}");
        // Without walks from the emitters the mean share is one.
        assert_eq!(
            cheapest(&[need(0.0, 1.0), need(0.0, 2.0)], [1.0, 1.0]),
            Some(1.5)
        );
        assert_eq!(cheapest(&[need(0.0, 0.0)], [1.0, 1.0]), None);
    }
}
