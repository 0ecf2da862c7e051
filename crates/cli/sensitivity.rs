//! How much each key of a study moves a result, to first order.

use malus_estimator::Estimate;

/// What a key does to a quantity; errors are those that chance leaves in the quantity itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivity {
    /// Change per unit of the key, all other numeric keys held: least squares over the variants. `None` for a key whose
    /// values are not all numbers, or that never changes but together with others.
    pub slope: Option<Estimate>,
    /// Change over the range of the key: by the slope, or between the two values of it that lie farthest apart in the mean.
    pub effect: Option<Estimate>,
    /// Share of the variance between variants that the key explains by itself, 0 … 1: of a straight line in a number,
    /// of the means of a word's variants.
    pub share: Estimate,
}

/// The values of a key, one a variant.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// All of them numbers.
    Numbers(Vec<f64>),
    /// The number of its word, counted from 0.
    Words(Vec<usize>),
}

impl Column {
    /// The values as written; numbers if all of them are.
    pub fn of(values: &[&str]) -> Self {
        let number = |text: &&str| text.parse::<f64>().ok().filter(|it| it.is_finite());
        if let Some(numbers) = values.iter().map(number).collect() {
            return Self::Numbers(numbers);
        }
        let mut words: Vec<&str> = Vec::new();
        let places = values.iter().map(|value| {
            words
                .iter()
                .position(|word| word == value)
                .unwrap_or_else(|| {
                    words.push(value);
                    words.len() - 1
                })
        });
        Self::Words(places.collect())
    }

    /// The numbers, where it holds some that differ.
    pub fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Numbers(numbers) if self.varies() => Some(numbers),
            _ => None,
        }
    }

    fn varies(&self) -> bool {
        match self {
            Self::Numbers(numbers) => numbers
                .iter()
                .any(|it| it.to_bits() != numbers[0].to_bits()),
            Self::Words(words) => words.iter().any(|it| *it != words[0]),
        }
    }

    /// Share of the variance of `values` that this key explains by itself.
    fn share(&self, values: &[f64]) -> f64 {
        let centred = centred(values);
        let total: f64 = dot(&centred, &centred);
        let explained = match self {
            Self::Numbers(numbers) => {
                let numbers = self::centred(numbers);
                dot(&numbers, &centred).powi(2) / dot(&numbers, &numbers)
            }
            Self::Words(words) => {
                let mut sums = vec![(0.0, 0.0); words.len()];
                for (&word, value) in words.iter().zip(&centred) {
                    sums[word].0 += value;
                    sums[word].1 += 1.0;
                }
                let groups = sums.iter().filter(|(_, count)| *count > 0.0);
                groups.map(|(sum, count)| sum * sum / count).sum()
            }
        };
        if total > 0.0 { explained / total } else { 0.0 }
    }
}

/// The sensitivity of a quantity to every key; `values` holds it for each variant in every replica. `None` for a key that
/// does not vary.
pub fn sensitivities(keys: &[Column], values: &[Vec<f64>]) -> Vec<Option<Sensitivity>> {
    let means: Vec<f64> = values.iter().map(|it| Estimate::of(it).mean).collect();
    let sensitivity = |(index, key): (usize, &Column)| {
        key.varies().then(|| {
            let slope = key.numbers().and_then(|numbers| {
                let weights = alone(numbers, keys, index)?;
                let span = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max)
                    - numbers.iter().copied().fold(f64::INFINITY, f64::min);
                Some((weights, span))
            });
            let effect = match (key, &slope) {
                (_, Some((weights, span))) => Some(weights.iter().map(|it| it * span).collect()),
                (Column::Words(words), None) => Some(farthest(words, &means)),
                (Column::Numbers(_), None) => None,
            };
            Sensitivity {
                slope: slope.map(|(weights, _)| combined(&weights, values)),
                effect: effect.map(|weights: Vec<f64>| combined(&weights, values)),
                share: jackknife(values, &means, |means| key.share(means)),
            }
        })
    };
    keys.iter().enumerate().map(sensitivity).collect()
}

/// The weights of the variants in the slope of one key: what the other numeric keys leave of it, over its own square.
fn alone(numbers: &[f64], keys: &[Column], index: usize) -> Option<Vec<f64>> {
    /// Part of a key, in squares, below which it is no more than the others together.
    const LEFT: f64 = 1e-9;
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let left_of = |column: Vec<f64>, basis: &[Vec<f64>]| {
        basis.iter().fold(column, |left, other| {
            let share = dot(&left, other) / dot(other, other);
            left.iter().zip(other).map(|(a, b)| a - share * b).collect()
        })
    };
    for (other, key) in keys.iter().enumerate() {
        if let Some(others) = key.numbers().filter(|_| other != index) {
            let centred = centred(others);
            let left = left_of(centred.clone(), &basis);
            if dot(&left, &left) > LEFT * dot(&centred, &centred) {
                basis.push(left);
            }
        }
    }
    let centred = centred(numbers);
    let left = left_of(centred.clone(), &basis);
    let square = dot(&left, &left);
    (square > LEFT * dot(&centred, &centred)).then(|| left.iter().map(|it| it / square).collect())
}

/// The weights of the variants in the difference between the two words that lie farthest apart in the mean.
fn farthest(words: &[usize], means: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); words.len()];
    for (&word, mean) in words.iter().zip(means) {
        sums[word].0 += mean;
        sums[word].1 += 1.0;
    }
    let levels = || {
        let levels = sums
            .iter()
            .enumerate()
            .filter(|(_, (_, count))| *count > 0.0);
        levels.map(|(word, (sum, count))| (word, sum / count))
    };
    let by_mean = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
    let ends = levels().max_by(by_mean).zip(levels().min_by(by_mean));
    let weight = |&word: &usize| {
        ends.map_or(0.0, |((high, _), (low, _))| {
            (f64::from(u8::from(word == high)) - f64::from(u8::from(word == low))) / sums[word].1
        })
    };
    words.iter().map(weight).collect()
}

/// Σ weight · value over the variants, in every replica.
fn combined(weights: &[f64], values: &[Vec<f64>]) -> Estimate {
    let replicas = values.first().map_or(0, Vec::len);
    let of_replica = |replica: usize| {
        let terms = weights.iter().zip(values);
        terms.map(|(weight, value)| weight * value[replica]).sum()
    };
    Estimate::of(&(0..replicas).map(of_replica).collect::<Vec<f64>>())
}

/// Any function of the variants' means, with the standard error that leaving out one replica after the other shows.
fn jackknife(values: &[Vec<f64>], means: &[f64], function: impl Fn(&[f64]) -> f64) -> Estimate {
    let replicas = values.first().map_or(0, Vec::len);
    let count = replicas as f64;
    let without = |replica: usize| {
        let left = means.iter().zip(values);
        let left = left.map(|(mean, value)| (count * mean - value[replica]) / (count - 1.0));
        function(&left.collect::<Vec<f64>>())
    };
    let others: Vec<f64> = (0..replicas)
        .filter(|_| replicas > 1)
        .map(without)
        .collect();
    Estimate {
        mean: function(means),
        standard_error: if replicas > 1 {
            // √((R − 1)/R Σ(…)²) = (R − 1) · √(Σ(…)²/(R (R − 1))).
            (count - 1.0) * Estimate::of(&others).standard_error
        } else {
            0.0
        },
    }
}

fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values 3 + 2x − y in two replicas that differ by ±0.1 everywhere, on the grid x = 0, 1; y = 0, 1, 2.
    fn plane() -> ([Column; 2], Vec<Vec<f64>>) {
        let points = [
            (0.0, 0.0),
            (0.0, 1.0),
            (0.0, 2.0),
            (1.0, 0.0),
            (1.0, 1.0),
            (1.0, 2.0),
        ];
        let value = |&(x, y): &(f64, f64)| {
            let value = 3.0 + 2.0 * x - y;
            vec![value - 0.1, value + 0.1]
        };
        let columns = [points.map(|it| it.0), points.map(|it| it.1)];
        (
            columns.map(|it| Column::Numbers(it.to_vec())),
            points.iter().map(value).collect(),
        )
    }

    #[test]
    fn the_slopes_of_a_plane_are_found_without_error() {
        let (keys, values) = plane();
        let found = sensitivities(&keys, &values);
        for (sensitivity, (slope, effect, share)) in
            found.iter().zip([(2.0, 2.0, 0.6), (-1.0, -2.0, 0.4)])
        {
            let sensitivity = sensitivity.expect("the key varies");
            let got = sensitivity.slope.expect("a number");
            assert!((got.mean - slope).abs() < 1e-12 && got.standard_error < 1e-12);
            assert!((sensitivity.effect.expect("a number").mean - effect).abs() < 1e-12);
            // Variances 4 · 1/4 and 1 · 2/3 of 5/3.
            assert!((sensitivity.share.mean - share).abs() < 1e-12);
        }
    }

    #[test]
    fn a_key_that_changes_with_another_has_no_slope_of_its_own() {
        let (keys, values) = plane();
        let Column::Numbers(x) = &keys[0] else {
            unreachable!("x is a number")
        };
        let twice = Column::Numbers(x.iter().map(|x| 2.0 * x).collect());
        let found = sensitivities(&[keys[0].clone(), twice], &values);
        assert!(
            found
                .iter()
                .flatten()
                .all(|it| it.slope.is_none() && it.effect.is_none())
        );
        let still = Column::Numbers(vec![1.0; 6]);
        assert!(sensitivities(&[still], &values)[0].is_none());
    }

    #[test]
    fn words_are_compared_by_the_means_of_their_variants() {
        let (_, values) = plane();
        let words = Column::of(&["oak", "oak", "oak", "inf", "inf", "inf"]);
        let found = sensitivities(&[words], &values)[0].expect("the key varies");
        assert!(found.slope.is_none());
        assert!((found.effect.expect("two words").mean - 2.0).abs() < 1e-12);
        assert!((found.share.mean - 0.6).abs() < 1e-12);
    }

    #[test]
    fn an_error_is_what_differs_between_replicas() {
        let keys = [Column::Numbers(vec![0.0, 1.0])];
        // Slopes 1 and 3 in the two replicas: 2 ± 1.
        let found = sensitivities(&keys, &[vec![0.0, 0.0], vec![1.0, 3.0]])[0].expect("varies");
        assert_eq!(
            found.slope.map(|it| (it.mean, it.standard_error)),
            Some((2.0, 1.0))
        );
    }
}
