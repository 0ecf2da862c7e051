//! Round numbers for axes, legends and contour lines.

use crate::number::exponent;

/// Evenly spaced round numbers k · m · 10^e with m = 1, 2 or 5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ticks {
    mantissa: i64,
    power: i32,
    /// First and last multiple of the step.
    first: i64,
    last: i64,
}

/// One round number.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// The number.
    pub value: f64,
    /// The number as text, without rounding errors.
    pub text: String,
}

impl Ticks {
    /// The round numbers in [low, high], at most `most` + 1 of them and none closer together than `least_step`.
    ///
    /// None where the interval is empty or not finite, or holds no multiple of the step.
    pub fn within(low: f64, high: f64, most: usize, least_step: f64) -> Option<Self> {
        let wanted = ((high - low) / most.max(1) as f64).max(least_step);
        if !(wanted.is_finite() && wanted > 0.0 && low < high) {
            return None;
        }
        let power = exponent(wanted, 17);
        // The next of 1, 2, 5, 10 at or above; a rounding error of the division does not double the step.
        let (mantissa, power) = [(1, power), (2, power), (5, power), (1, power + 1)]
            .into_iter()
            .find(|&(mantissa, power)| decimal(mantissa, power) >= wanted * (1.0 - 1e-9))?;
        let step = decimal(mantissa, power);
        let slack = 1e-9 * (high - low) / step;
        let first = (low / step - slack).ceil();
        let last = (high / step + slack).floor();
        // Beyond that, multiples of the step cannot be told apart in f64.
        let told_apart = first.abs().max(last.abs()) < 1e12;
        (told_apart && first <= last).then_some(Self {
            mantissa,
            power,
            first: first as i64,
            last: last as i64,
        })
    }

    /// The numbers m · 10^e with m = 1, 2 or 5 in [low, high]; m = 1 alone over more than three decades.
    pub fn by_decades(low: f64, high: f64) -> Vec<Tick> {
        if !(low > 0.0 && low < high && high.is_finite()) {
            return Vec::new();
        }
        let mantissas: &[i64] = if high > 1000.0 * low {
            &[1]
        } else {
            &[1, 2, 5]
        };
        (exponent(low, 17)..=exponent(high, 17))
            .flat_map(|power| mantissas.iter().map(move |&m| decimal(m, power)))
            .filter(|value| (low..=high).contains(value))
            .map(|value| Tick {
                value,
                text: value.to_string(),
            })
            .collect()
    }

    /// The numbers, ascending.
    pub fn iter(self) -> impl Iterator<Item = Tick> {
        (self.first..=self.last).map(move |k| {
            let value = decimal(k * self.mantissa, self.power);
            let decimals = (-self.power).clamp(0, 12) as usize;
            Tick {
                value,
                text: format!("{value:.decimals$}"),
            }
        })
    }
}

/// The number nearest to m · 10^e.
fn decimal(mantissa: i64, power: i32) -> f64 {
    format!("{mantissa}e{power}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64, most: usize, least: f64) -> Vec<String> {
        Ticks::within(low, high, most, least)
            .map(|ticks| ticks.iter().map(|tick| tick.text).collect())
            .unwrap_or_default()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(
            texts(0.0, 1.0, 5, 0.0),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(
            texts(3.09, 3.81, 8, 0.0),
            ["3.1", "3.2", "3.3", "3.4", "3.5", "3.6", "3.7", "3.8"]
        );
        assert_eq!(
            texts(220.0, 485.0, 6, 0.0),
            ["250", "300", "350", "400", "450"]
        );
        assert_eq!(texts(-1.0, 1.0, 2, 0.0), ["-1", "0", "1"]);
    }

    #[test]
    fn no_step_is_finer_than_asked_for() {
        assert_eq!(texts(0.0, 1.0, 100, 0.3), ["0.0", "0.5", "1.0"]);
        assert!(texts(0.6, 0.9, 10, 3.0).is_empty());
    }

    #[test]
    fn decades_have_three_numbers_while_they_are_few() {
        let texts = |low, high| -> Vec<String> {
            let ticks = Ticks::by_decades(low, high);
            ticks.into_iter().map(|tick| tick.text).collect()
        };
        assert_eq!(texts(0.04, 3.0), ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(texts(2.0, 20_000.0), ["10", "100", "1000", "10000"]);
        assert!(texts(0.0, 1.0).is_empty());
    }

    #[test]
    fn an_empty_interval_has_no_ticks() {
        assert!(texts(2.0, 2.0, 5, 0.0).is_empty());
        assert!(texts(0.0, f64::INFINITY, 5, 0.0).is_empty());
        assert!(texts(1e30, 1e30 * (1.0 + 1e-15), 5, 0.0).is_empty());
    }
}
