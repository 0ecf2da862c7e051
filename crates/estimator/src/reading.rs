//! From tallies to readings: means with their errors, and what pairs of models say together.

use crate::pass::Channels;
use crate::receiver::Receiver;
use crate::results::{Group, Paired, Reading};
use crate::statistics::{Estimate, Means, Tally, degree_of_linear_polarisation};
use malus_scene::Scene;

/// How the sums of a run are read.
pub(crate) struct Readings<'a> {
    scene: &'a Scene,
    channels: Channels,
    receivers: &'a [Receiver],
    /// What is known without chance, one Stokes vector a sensor; S0 is the same in every model.
    exact: Vec<[f64; 4]>,
}

impl<'a> Readings<'a> {
    /// Readings of the scene's sensors, of which the `exact` part is known.
    #[must_use]
    pub(crate) fn new<const N: usize>(
        scene: &'a Scene,
        channels: Channels,
        receivers: &'a [Receiver],
        exact: &[[f64; N]],
    ) -> Self {
        let padded = |stokes: &[f64; N]| {
            std::array::from_fn(|component| stokes.get(component).copied().unwrap_or(0.0))
        };
        Self {
            scene,
            channels,
            receivers,
            exact: exact.iter().map(padded).collect(),
        }
    }

    fn s0(&self, tally: &Tally, sensor: usize) -> Estimate {
        let index = sensor * self.channels.count;
        let mut estimate = tally.estimate(|means| means.at(index));
        estimate.mean += self.exact[sensor][0];
        estimate
    }

    /// Largest standard error of S0 as a share of max(S0, 10⁻³ · mean S0) over the free sensors.
    #[must_use]
    pub(crate) fn relative_error(&self, tally: &Tally) -> f64 {
        let free: Vec<Estimate> = (0..self.receivers.len())
            .filter(|&sensor| !self.receivers[sensor].enclosed)
            .map(|sensor| self.s0(tally, sensor))
            .collect();
        let mean = free.iter().map(|e| e.mean).sum::<f64>() / free.len().max(1) as f64;
        free.iter()
            .filter(|e| e.standard_error > 0.0)
            .map(|e| e.standard_error / e.mean.max(1e-3 * mean))
            .fold(0.0, f64::max)
    }

    /// Every reading, by sensor group.
    #[must_use]
    pub(crate) fn groups(&self, tally: &Tally) -> Vec<Group> {
        let mut first = 0;
        self.scene
            .sensors
            .iter()
            .map(|sensor| {
                let range = first..first + sensor.points.len();
                first = range.end;
                self.group(tally, range)
            })
            .collect()
    }

    fn group(&self, tally: &Tally, range: std::ops::Range<usize>) -> Group {
        let free: Vec<usize> = range
            .clone()
            .filter(|&sensor| !self.receivers[sensor].enclosed)
            .collect();
        let count = free.len().max(1) as f64;
        let mean = |means: &Means, channel: usize| {
            let at = |&sensor: &usize| means.at(sensor * self.channels.count + channel);
            free.iter().map(at).sum::<f64>() / count
        };
        let exact = free.iter().map(|&s| self.exact[s][0]).sum::<f64>() / count;
        let main = tally.estimate(|means| mean(means, 0));
        let paired = |channel| Paired::new(tally, exact, channel, mean);
        Group {
            readings: range.map(|sensor| self.reading(tally, sensor)).collect(),
            mean: main.mean + exact,
            mean_standard_error: main.standard_error,
            scalar: self.channels.scalar.map(paired),
            diffuse: self.channels.diffuse.map(paired),
        }
    }

    fn reading(&self, tally: &Tally, sensor: usize) -> Reading {
        let first = sensor * self.channels.count;
        let mut stokes = self.exact[sensor];
        let mut standard_error = [0.0; 4];
        for component in 0..self.channels.components {
            let estimate = tally.estimate(|means| means.at(first + component));
            stokes[component] += estimate.mean;
            standard_error[component] = estimate.standard_error;
        }
        let dolp = if self.channels.components > 1 {
            degree_of_linear_polarisation(stokes, |[c0, c1, c2]| {
                tally.estimate(|m| c0 * m.at(first) + c1 * m.at(first + 1) + c2 * m.at(first + 2))
            })
        } else {
            Estimate {
                mean: 0.0,
                standard_error: 0.0,
            }
        };
        let at = |means: &Means, channel: usize| means.at(first + channel);
        let paired = |channel| Paired::new(tally, self.exact[sensor][0], channel, at);
        Reading {
            enclosed: self.receivers[sensor].enclosed,
            stokes,
            standard_error,
            dolp: dolp.mean,
            dolp_standard_error: dolp.standard_error,
            scalar: self.channels.scalar.map(paired),
            diffuse: self.channels.diffuse.map(paired),
        }
    }
}

impl Paired {
    /// A channel beside the main model's S0, both read by `at`; the `exact` part is the same in both.
    fn new(tally: &Tally, exact: f64, channel: usize, at: impl Fn(&Means, usize) -> f64) -> Self {
        let other = tally.estimate(|means| at(means, channel));
        let difference = tally.estimate(|means| at(means, 0) - at(means, channel));
        Self {
            value: other.mean + exact,
            standard_error: other.standard_error,
            difference: difference.mean,
            difference_standard_error: difference.standard_error,
        }
    }
}
