//! Error against time of one setting: its slope, its end, and the time to a given error.

use crate::tradeoff::setting::Setting;
use crate::tradeoff::trial::Outcome;

/// Points at the end of a curve that its slope is taken from.
const TAIL: usize = 4;

/// Factor of samples beyond the last point up to which a curve is carried on.
const BEYOND: f64 = 100.0;

/// Samples are whole rounds of so many replicas.
const ROUND: u64 = malus_estimator::REPLICAS as u64;

/// One setting's outcomes, by ascending numbers of samples.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The setting.
    pub setting: Setting,
    /// Its outcomes, of which the first at least one, and beyond those that are shown one that is not.
    pub outcomes: Vec<Outcome>,
    /// The smallest error that the reference can tell: what is below is known to be below, and no more.
    pub limit: f64,
    /// Whether more samples bring it to the right answer.
    pub is_unbiased: bool,
}

/// Where a curve comes down to an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Time of a run.
    pub seconds: f64,
    /// Its samples.
    pub samples: u64,
    /// Whether no measured point lies beyond it.
    pub is_foretold: bool,
}

impl Curve {
    /// The outcomes that the reference can tell: those that are shown.
    pub fn points(&self) -> impl DoubleEndedIterator<Item = &Outcome> {
        self.outcomes
            .iter()
            .filter(|outcome| outcome.rms_error >= self.limit)
    }

    /// The first outcome that is finer than the reference can tell.
    pub fn untold(&self) -> Option<&Outcome> {
        self.outcomes
            .iter()
            .find(|outcome| outcome.rms_error < self.limit)
    }

    /// Power of the time that the error goes with at the end of the curve, −½ where it is chance alone; from two points on.
    pub fn slope(&self) -> Option<f64> {
        let logarithms: Vec<[f64; 2]> = self
            .points()
            .filter(|point| point.rms_error > 0.0)
            .map(|point| [point.seconds.ln(), point.rms_error.ln()])
            .collect();
        let tail = &logarithms[logarithms.len().saturating_sub(TAIL)..];
        let count = tail.len() as f64;
        let [x, y] = [0, 1].map(|side| tail.iter().map(|at| at[side]).sum::<f64>() / count);
        let product: f64 = tail.iter().map(|at| (at[0] - x) * (at[1] - y)).sum();
        let square: f64 = tail.iter().map(|at| (at[0] - x) * (at[0] - x)).sum();
        (tail.len() > 1 && square > 0.0).then(|| product / square)
    }

    /// The error that more samples do not take away; told by the last two points, or by one where there is no other.
    pub fn floor(&self) -> Option<f64> {
        let mut backwards = self.points().rev();
        let last = backwards.next()?;
        let told = backwards.next().is_none_or(|point| point.bias.is_some());
        last.bias.filter(|_| told)
    }

    /// Where the curve comes down to an error, between outcomes by straight lines of the logarithms and beyond what can be
    /// told by the square root of the samples; `None` where it ends above, or is not known so far.
    pub fn reach(&self, error: f64) -> Option<Reach> {
        if error < self.limit {
            return self.foretold(error);
        }
        let above = self.outcomes.iter().rposition(|it| it.rms_error > error);
        let Some(above) = above else {
            let first = self.outcomes.first()?;
            return Some(Reach {
                seconds: first.seconds,
                samples: first.samples,
                is_foretold: false,
            });
        };
        let Some(to) = self.outcomes.get(above + 1) else {
            return self.foretold(error);
        };
        let from = self.outcomes[above];
        let share = if to.rms_error > 0.0 {
            (from.rms_error / error).ln() / (from.rms_error / to.rms_error).ln()
        } else {
            1.0
        };
        let between = |a: f64, b: f64| a * (b / a).powf(share);
        Some(Reach {
            seconds: between(from.seconds, to.seconds),
            samples: rounds(between(from.samples as f64, to.samples as f64)),
            is_foretold: false,
        })
    }

    /// The same beyond the last point that the reference can tell, or beyond the first outcome where it can tell none.
    ///
    /// Of a setting that leaves something out nothing is foretold: nobody knows where it ends.
    fn foretold(&self, error: f64) -> Option<Reach> {
        let last = self.points().next_back().or(self.outcomes.first())?;
        let factor = (last.rms_error / error) * (last.rms_error / error);
        let goes_on = self.is_unbiased && self.floor().is_none();
        (goes_on && factor <= BEYOND).then(|| Reach {
            seconds: last.seconds * factor.max(1.0),
            samples: rounds(last.samples as f64 * factor.max(1.0)),
            is_foretold: true,
        })
    }
}

/// Samples, rounded up to whole rounds.
fn rounds(samples: f64) -> u64 {
    (samples.ceil() as u64).div_ceil(ROUND) * ROUND
}

/// The points that no other one beats in both time and error, by ascending time.
pub fn frontier(curves: &[Curve]) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = curves
        .iter()
        .flat_map(Curve::points)
        .map(|point| [point.seconds, point.rms_error])
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut least = f64::INFINITY;
    points.retain(|point| {
        let better = point[1] < least;
        least = least.min(point[1]);
        better
    });
    points
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use malus_optics::Representation;
    use malus_scene::Estimator;

    /// A curve through points of time and error; 64 samples at the first, four times as many at each next.
    pub fn curve(points: &[[f64; 2]]) -> Curve {
        let outcome = |(index, &[seconds, rms_error]): (usize, &[f64; 2])| Outcome {
            samples: 64 << (2 * index),
            runs: 5,
            seconds,
            rms_error,
            max_error: 2.0 * rms_error,
            se_mean: rms_error,
            bias: None,
        };
        Curve {
            setting: Setting {
                estimator: Estimator::Auto,
                representation: Representation::Linear,
                threads: 2,
            },
            outcomes: points.iter().enumerate().map(outcome).collect(),
            limit: 0.0,
            is_unbiased: true,
        }
    }

    #[test]
    fn the_error_of_chance_has_the_slope_of_minus_a_half() {
        let chance = curve(&[[1.0, 0.08], [4.0, 0.04], [16.0, 0.02]]);
        assert!((chance.slope().unwrap() + 0.5).abs() < 1e-12);
        assert_eq!(curve(&[[1.0, 0.1]]).slope(), None);
    }

    #[test]
    fn time_to_an_error_is_read_off_the_line_between_two_points() {
        let curve = curve(&[[1.0, 0.08], [4.0, 0.04], [16.0, 0.02]]);
        // (0.08/0.05)² times the time and the samples, these in whole rounds: 163.84 is two of them and a part.
        let reach = curve.reach(0.05).unwrap();
        assert!((reach.seconds - 2.56).abs() < 1e-12 && !reach.is_foretold);
        assert_eq!(reach.samples, 192);
        // Before the first point nothing is known of less time.
        assert_eq!(curve.reach(0.5).unwrap().samples, 64);
    }

    #[test]
    fn beyond_the_last_point_a_quarter_of_the_error_takes_sixteen_times_the_time() {
        let reach = curve(&[[1.0, 0.08], [4.0, 0.04]]).reach(0.01).unwrap();
        assert!((reach.seconds - 64.0).abs() < 1e-12 && reach.is_foretold);
        assert_eq!(reach.samples, 4096);
        assert_eq!(curve(&[[1.0, 0.08]]).reach(1e-4), None);
    }

    #[test]
    fn below_the_limit_of_the_reference_an_error_is_known_to_be_below_and_no_more() {
        let mut curve = curve(&[[1.0, 0.08], [4.0, 0.02]]);
        curve.limit = 0.04;
        assert_eq!(curve.points().count(), 1);
        assert_eq!(curve.untold().map(|outcome| outcome.samples), Some(256));
        let reach = curve.reach(0.04).unwrap();
        assert!((reach.seconds - 2.0).abs() < 1e-12 && !reach.is_foretold);
        // Foretold from the last point that can be told, not from the one that cannot.
        let reach = curve.reach(0.02).unwrap();
        assert!((reach.seconds - 16.0).abs() < 1e-12 && reach.is_foretold);
        curve.limit = 0.1;
        assert!((curve.reach(0.1).unwrap().seconds - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_curve_with_a_floor_does_not_come_below_it() {
        let mut blind = curve(&[[1.0, 0.06], [4.0, 0.055]]);
        for point in &mut blind.outcomes {
            point.bias = Some(0.05);
        }
        assert_eq!(blind.floor(), Some(0.05));
        assert_eq!(blind.reach(0.03), None);
        blind.outcomes[0].bias = None;
        assert_eq!(blind.floor(), None);
        blind.is_unbiased = false;
        assert_eq!(blind.reach(0.03), None);
    }

    #[test]
    fn the_frontier_holds_what_nothing_beats() {
        let curves = [
            curve(&[[1.0, 0.08], [4.0, 0.04]]),
            curve(&[[2.0, 0.09], [3.0, 0.03]]),
        ];
        assert_eq!(frontier(&curves), [[1.0, 0.08], [3.0, 0.03]]);
    }
}
