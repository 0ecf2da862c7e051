//! From tallies to readings: means with their errors, and what pairs of models say together.

use crate::allocation::Allocation;
use crate::exact::Known;
use crate::pass::Channels;
use crate::receiver::Receiver;
use crate::results::{Group, Paired, Reading, Replicates, Shares};
use crate::statistics::{Estimate, Means, Replica, Tally, degree_of_linear_polarisation};
use malus_scene::Scene;

/// How the sums of a run are read.
pub(crate) struct Readings<'a> {
    pub scene: &'a Scene,
    pub channels: Channels,
    pub receivers: &'a [Receiver],
    pub allocation: &'a Allocation,
    /// What is known without chance.
    pub known: &'a Known,
    /// One entry a sensor.
    pub unmet: Vec<Unmet>,
    /// Whether light is counted in cells, not joined to the sensors.
    pub counted: bool,
    /// Whether sensors tell each other what they have met.
    pub shared: bool,
    /// Whether walks correct a guess, of which a sensor's share is known but for its rounding.
    pub guessed: bool,
    /// Which of so many variants is read.
    pub variant: (usize, usize),
}

/// Light that a walk from a sensor meets by chance alone, off a mirror, and may not have met yet.
///
/// The spread between replicas tells nothing of what none of them has met. So every standard error counts one more
/// walk than there were: one that met the brightest emitter in a mirror, which adds its exitance/n in squares, or the
/// whole of what the emitters could send from half a scene's radius away where that is less. Where walks are aimed at such
/// mirrors, all sensors' walks count together, and none takes what it has met for surer than they do on average.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Unmet {
    /// Irradiance that one walk brings that meets the brightest emitter, in unit/m².
    pub one: f64,
    /// Most that there can be of it, in unit/m².
    pub most: f64,
}

impl Unmet {
    /// The mean over some sensors.
    fn mean(several: impl ExactSizeIterator<Item = Self>) -> Self {
        let count = several.len().max(1) as f64;
        several.fold(Self::default(), |sum, next| Self {
            one: sum.one + next.one / count,
            most: sum.most + next.most / count,
        })
    }

    /// Variance of so many walks that have not met what they might.
    fn variance(self, walks: f64) -> f64 {
        let unmet = (self.one / walks).min(self.most);
        unmet * unmet
    }
}

/// What rounding may leave of a sensor's share of a guess, as a share of S0: form factors of what lies at the horizon, next to a
/// corner, have 10 digits.
const ROUNDING: f64 = 1e-10;

/// A standard error with so much variance more.
fn widened(standard_error: f64, variance: f64) -> f64 {
    (standard_error * standard_error + variance).sqrt()
}

impl<'a> Readings<'a> {
    /// What walks from a sensor and walks from the emitters bring it, on average.
    fn parts(&self, means: &Means, sensor: usize, channel: usize) -> [f64; 2] {
        let (variant, variants) = self.variant;
        let index = (sensor * variants + variant) * self.channels.count + channel;
        let walks = self.allocation.walks(sensor, means.points());
        let half = self.receivers.len() * variants * self.channels.count;
        [means.over(index, walks), means.at(half + index)]
    }

    /// Both together.
    fn at(&self, means: &Means, sensor: usize, channel: usize) -> f64 {
        let [gathered, launched] = self.parts(means, sensor, channel);
        gathered + launched
    }

    /// Walks taken at a sensor by all replicas together.
    fn walks(&self, tally: &Tally, sensor: usize) -> f64 {
        let walks = |replica: &Replica| self.allocation.walks(sensor, replica.points);
        tally.replicas().map(walks).sum::<u64>() as f64
    }

    /// What each way of finding light has brought of S0, as shares of its sum over the free sensors.
    #[must_use]
    pub(crate) fn shares(&self, tally: &Tally) -> Shares {
        let mut shares = Shares::default();
        for sensor in 0..self.receivers.len() {
            if self.receivers[sensor].enclosed {
                continue;
            }
            let part = |channel: usize, kind: usize| {
                let read = |means: &Means| self.parts(means, sensor, channel)[kind];
                tally.estimate(read).mean
            };
            let [mirrored, met] = [0, 1].map(|found| part(self.channels.found + found, 0));
            shares.exact += self.known.at(sensor, 0);
            shares.looked += part(0, 0) - mirrored - met;
            shares.mirrored += mirrored;
            shares.met += met;
            shares.local += part(0, 1);
        }
        shares.normalised()
    }

    /// Variance at each sensor that the spread of its own replicas does not tell.
    fn hidden(&self, tally: &Tally) -> Vec<f64> {
        let mut hidden = self.unseen(tally);
        for (sensor, variance) in hidden.iter_mut().enumerate() {
            *variance += self.rounding(|| self.s0(tally, sensor, 0.0).mean);
        }
        hidden
    }

    /// Variance of the rounding of S0.
    fn rounding(&self, s0: impl FnOnce() -> f64) -> f64 {
        match self.guessed {
            true => (ROUNDING * s0()).powi(2),
            false => 0.0,
        }
    }

    /// Variance at each sensor of what no walk may have met yet.
    fn unseen(&self, tally: &Tally) -> Vec<f64> {
        let walks: Vec<f64> = (0..self.receivers.len())
            .map(|sensor| self.walks(tally, sensor))
            .collect();
        if !self.shared || self.unmet.iter().all(|u| u.one <= 0.0) {
            let each = self.unmet.iter().zip(&walks);
            return each.map(|(unmet, &walks)| unmet.variance(walks)).collect();
        }
        let met = |sensor: usize| {
            let read = |means: &Means| self.parts(means, sensor, self.channels.found + 1)[0];
            tally.estimate(read).standard_error.powi(2)
        };
        let met: Vec<f64> = (0..walks.len()).map(met).collect();
        let free: Vec<usize> = (0..walks.len())
            .filter(|&sensor| !self.receivers[sensor].enclosed)
            .collect();
        let all: f64 = free.iter().map(|&s| walks[s]).sum();
        let of_one: f64 = free.iter().map(|&s| met[s] * walks[s]).sum();
        let of_one = of_one / free.len().max(1) as f64;
        (0..walks.len())
            .map(|sensor| {
                let shared = of_one / walks[sensor].max(1.0);
                self.unmet[sensor].variance(all.max(1.0)) + (shared - met[sensor]).max(0.0)
            })
            .collect()
    }

    fn s0(&self, tally: &Tally, sensor: usize, hidden: f64) -> Estimate {
        let mut estimate = tally.estimate(|means| self.at(means, sensor, 0));
        estimate.mean += self.known.at(sensor, 0);
        estimate.standard_error = widened(estimate.standard_error, hidden);
        estimate
    }

    /// Largest standard error of S0 as a share of max(S0, 10⁻³ · mean S0) over the free sensors; 0 where no light has
    /// reached any of them, since there is no share of nothing.
    #[must_use]
    pub(crate) fn relative_error(&self, tally: &Tally) -> f64 {
        let hidden = self.hidden(tally);
        let free: Vec<Estimate> = (0..self.receivers.len())
            .filter(|&sensor| !self.receivers[sensor].enclosed)
            .map(|sensor| self.s0(tally, sensor, hidden[sensor]))
            .collect();
        let mean = free.iter().map(|e| e.mean).sum::<f64>() / free.len().max(1) as f64;
        if mean <= 0.0 {
            // What is only counted comes late.
            return if self.counted { f64::INFINITY } else { 0.0 };
        }
        free.iter()
            .filter(|e| e.standard_error > 0.0)
            .map(|e| e.standard_error / e.mean.max(1e-3 * mean))
            .fold(0.0, f64::max)
    }

    /// Says if no walk has brought light to any of the free sensors.
    #[must_use]
    pub(crate) fn dark(&self, tally: &Tally) -> Option<String> {
        let mut free = (0..self.receivers.len())
            .filter(|&sensor| !self.receivers[sensor].enclosed)
            .map(|sensor| self.s0(tally, sensor, 0.0).mean)
            .peekable();
        free.peek()?;
        free.all(|s0| s0 <= 0.0).then(|| {
            "no light has reached any sensor point: is a lamp inside a closed solid or behind a wall, or does it face away? \
             Surfaces emit on the side of their normals only"
                .into()
        })
    }

    /// Every reading, by sensor group.
    #[must_use]
    pub(crate) fn groups(&self, tally: &Tally) -> Vec<Group> {
        let mut first = 0;
        let hidden = self.hidden(tally);
        self.scene
            .sensors
            .iter()
            .map(|sensor| {
                let range = first..first + sensor.points.len();
                first = range.end;
                self.group(tally, range, &hidden)
            })
            .collect()
    }

    fn group(&self, tally: &Tally, range: std::ops::Range<usize>, hidden: &[f64]) -> Group {
        let free: Vec<usize> = range
            .clone()
            .filter(|&sensor| !self.receivers[sensor].enclosed)
            .collect();
        let count = free.len().max(1) as f64;
        let mean = |means: &Means, channel: usize| {
            let at = |&sensor: &usize| self.at(means, sensor, channel);
            free.iter().map(at).sum::<f64>() / count
        };
        let known = |channel: usize| {
            let at = |&sensor: &usize| self.known.at(sensor, channel);
            free.iter().map(at).sum::<f64>() / count
        };
        let main = tally.estimate(|means| mean(means, 0));
        // Points are walked from independently, so a mean over them has as many times the walks.
        let walks: f64 = free.iter().map(|&s| self.walks(tally, s)).sum();
        let unmet = Unmet::mean(free.iter().map(|&s| self.unmet[s]));
        let variance = unmet.variance(walks.max(1.0)) + self.rounding(|| main.mean + known(0));
        let widened = |error| widened(error, variance);
        let paired = |channel| Paired::new(tally, known, channel, mean, widened);
        let readings: Vec<Reading> = range
            .clone()
            .map(|s| self.reading(tally, s, hidden[s]))
            .collect();
        let s0 = |sensor: usize| readings[sensor - range.start].stokes[0];
        let darkest = free
            .iter()
            .copied()
            .min_by(|&a, &b| s0(a).total_cmp(&s0(b)));
        let at_darkest = |sensor: usize| {
            tally.values(|means| self.at(means, sensor, 0) + self.known.at(sensor, 0))
        };
        let means = |channel| tally.values(|means| mean(means, channel) + known(channel));
        let replicates = Replicates {
            mean: means(0),
            min: darkest.map_or_else(Vec::new, at_darkest),
            scalar: self.channels.scalar.map_or_else(Vec::new, means),
        };
        Group {
            mean: main.mean + known(0),
            mean_standard_error: widened(main.standard_error),
            scalar: self.channels.scalar.map(paired),
            diffuse: self.channels.diffuse.map(paired),
            replicates,
            readings,
        }
    }

    fn reading(&self, tally: &Tally, sensor: usize, hidden: f64) -> Reading {
        let enclosed = self.receivers[sensor].enclosed;
        let widened = |error| match enclosed {
            true => error,
            false => widened(error, hidden),
        };
        let mut stokes = [0.0; 4];
        let mut standard_error = [0.0; 4];
        for component in 0..self.channels.components {
            let estimate = tally.estimate(|means| self.at(means, sensor, component));
            stokes[component] = estimate.mean + self.known.at(sensor, component);
            standard_error[component] = widened(estimate.standard_error);
        }
        let dolp = if self.channels.components > 1 {
            degree_of_linear_polarisation(stokes, |[c0, c1, c2]| {
                let at = |means: &Means, channel| self.at(means, sensor, channel);
                tally.estimate(|m| c0 * at(m, 0) + c1 * at(m, 1) + c2 * at(m, 2))
            })
        } else {
            Estimate {
                mean: 0.0,
                standard_error: 0.0,
            }
        };
        let at = |means: &Means, channel: usize| self.at(means, sensor, channel);
        let known = |channel: usize| self.known.at(sensor, channel);
        let paired = |channel| Paired::new(tally, known, channel, at, widened);
        Reading {
            enclosed,
            stokes,
            standard_error,
            dolp: dolp.mean,
            dolp_standard_error: if stokes[0] > 0.0 && self.channels.components > 1 {
                widened(dolp.standard_error * stokes[0]) / stokes[0]
            } else {
                0.0
            },
            scalar: self.channels.scalar.map(paired),
            diffuse: self.channels.diffuse.map(paired),
        }
    }
}

impl Paired {
    /// A channel beside the main model's S0, both read by `at` and `known` in part.
    /// Errors are `widened` by what may not have been met, but where the two models are one and the same.
    fn new(
        tally: &Tally,
        known: impl Fn(usize) -> f64,
        channel: usize,
        at: impl Fn(&Means, usize) -> f64,
        widened: impl Fn(f64) -> f64,
    ) -> Self {
        let other = tally.estimate(|means| at(means, channel));
        let difference = tally.estimate(|means| at(means, 0) - at(means, channel));
        Self {
            value: other.mean + known(channel),
            standard_error: widened(other.standard_error),
            difference: difference.mean + (known(0) - known(channel)),
            difference_standard_error: if channel == 0 {
                0.0
            } else {
                widened(difference.standard_error)
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_walk_might_have_met_widens_an_error_until_it_is_all_there_is() {
        let unmet = Unmet {
            one: 30.0,
            most: 0.5,
        };
        // √(0.4² + (30/100)²) = 0.5; at ten walks 30/10 is more than there can be: √(1.2² + 0.5²) = 1.3.
        assert!((widened(0.4, unmet.variance(100.0)) - 0.5).abs() < 1e-15);
        assert!((widened(1.2, unmet.variance(10.0)) - 1.3).abs() < 1e-15);
        assert!((widened(0.4, Unmet::default().variance(1.0)) - 0.4).abs() < 1e-15);
    }
}
