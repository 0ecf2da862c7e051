//! Which value has which place on a colour scale.

use crate::field::Field;
use crate::number::exponent;
use crate::tick::{Tick, Ticks};

/// Numbers on a legend, and levels of contour lines, at most (on a linear scale).
const STEPS: usize = 8;

/// Ratio of the greatest value to the mean beyond which a linear scale would show one bright spot on black.
const STRONG_PEAK: f64 = 8.0;

/// Ratio of the ends of a logarithmic scale, at most.
const LOGARITHMIC_RANGE: f64 = 1e4;

/// The range of values that colours stand for, in a power of ten that keeps the numbers short.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Whether all values are the same.
    even: bool,
    /// Power of ten by which values are divided before they are shown.
    power: i32,
}

impl Scale {
    /// A scale from 0 to the greatest value; `None` where the field has no value.
    pub fn from_zero(field: &Field) -> Option<Self> {
        let [low, high] = field.range()?;
        Some(Self::linear(low.min(0.0), high.max(0.0), low >= high))
    }

    /// A scale over the values, logarithmic where there is a strong peak; `None` where the field has no value.
    pub fn over(field: &Field) -> Option<Self> {
        let [low, high] = field.range()?;
        if high - low <= 1e-9 * low.abs().max(high.abs()) {
            return Some(Self::linear(0.9 * low, 1.1 * high, true));
        }
        if low < 0.0 || high < STRONG_PEAK * field.mean() {
            return Some(Self::linear(low, high, false));
        }
        Some(Self::by_decades(low.max(high / LOGARITHMIC_RANGE), high))
    }

    /// A logarithmic scale between two values, 0 < low < high.
    pub fn by_decades(low: f64, high: f64) -> Self {
        Self {
            logarithmic: true,
            ..Self::linear(low, high, false)
        }
    }

    fn linear(low: f64, high: f64, even: bool) -> Self {
        let high = if high > low { high } else { low + 1.0 };
        let power = match exponent(low.abs().max(high.abs()), 3) {
            -2..=4 => 0,
            power => power.div_euclid(3) * 3,
        };
        Self {
            low,
            high,
            logarithmic: false,
            even,
            power,
        }
    }

    /// Powers of ten between the ends.
    pub fn decades(&self) -> f64 {
        (self.high / self.low).log10()
    }

    /// Place of a value between the ends, 0 … 1.
    pub fn share(&self, value: f64) -> f64 {
        let share = if self.logarithmic {
            (value.max(self.low) / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        share.clamp(0.0, 1.0)
    }

    /// Round numbers on the scale: the value of each, and its text in the scale's power of ten.
    pub fn ticks(&self) -> Vec<Tick> {
        self.ticks_apart(0.0)
    }

    /// Values of contour lines: none where all values are the same, and on a linear scale none closer together than
    /// twice the typical standard error `noise`, or they would trace the noise.
    pub fn levels(&self, noise: f64) -> Vec<Tick> {
        if self.even {
            Vec::new()
        } else {
            self.ticks_apart(2.0 * noise)
        }
    }

    fn ticks_apart(&self, least_step: f64) -> Vec<Tick> {
        let unit: f64 = format!("1e{}", self.power).parse().unwrap_or(1.0);
        let [low, high] = [self.low, self.high].map(|end| end / unit);
        let ticks: Vec<Tick> = if self.logarithmic {
            Ticks::by_decades(low, high)
        } else {
            let ticks = Ticks::within(low, high, STEPS, least_step / unit);
            ticks.into_iter().flat_map(Ticks::iter).collect()
        };
        let in_full = |tick: Tick| Tick {
            value: tick.value * unit,
            ..tick
        };
        ticks.into_iter().map(in_full).collect()
    }

    /// The unit with the power of ten before it.
    pub fn heading(&self, unit: &str) -> String {
        match self.power {
            0 => unit.to_owned(),
            power => format!("10{} {unit}", superscript(power)),
        }
    }

    /// Whether colours go by the logarithm.
    pub fn is_logarithmic(&self) -> bool {
        self.logarithmic
    }
}

/// An integer in raised digits.
fn superscript(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| match c.to_digit(10) {
        Some(digit) => DIGITS[digit as usize],
        None => '⁻',
    };
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(values: &[f64]) -> Scale {
        let field = Field::new(
            [values.len(), 1],
            values.iter().copied().map(Some).collect(),
        );
        Scale::over(&field.expect("fits")).expect("values")
    }

    fn texts(ticks: Vec<Tick>) -> Vec<String> {
        ticks.into_iter().map(|tick| tick.text).collect()
    }

    #[test]
    fn small_numbers_are_shown_in_a_power_of_ten() {
        let scale = over(&[0.0031, 0.0032, 0.0037, 0.0038]);
        assert_eq!(scale.heading("lx"), "10⁻³ lx");
        let expected = ["3.1", "3.2", "3.3", "3.4", "3.5", "3.6", "3.7", "3.8"];
        assert_eq!(texts(scale.ticks()), expected);
        assert!((scale.ticks()[0].value - 0.0031).abs() < 1e-15);
    }

    #[test]
    fn an_even_field_has_a_legend_and_no_contours() {
        for value in [0.0, 500.0] {
            let scale = over(&[value; 4]);
            assert!(scale.ticks().len() > 2);
            assert!(scale.levels(0.0).is_empty());
            assert!(scale.share(value).is_finite());
        }
    }

    #[test]
    fn contours_keep_out_of_the_noise() {
        let scale = over(&[100.0, 101.0, 102.0, 103.0]);
        assert!(scale.levels(0.0).len() > 4);
        assert!(scale.levels(20.0).len() <= 1);
    }

    #[test]
    fn a_strong_peak_makes_the_scale_logarithmic() {
        let mut values = vec![200.0; 99];
        values.push(20_000.0);
        let scale = over(&values);
        assert!(scale.is_logarithmic());
        assert_eq!(
            texts(scale.ticks()),
            ["200", "500", "1000", "2000", "5000", "10000", "20000"]
        );
        assert!((scale.share(2000.0) - 0.5).abs() < 1e-12);
        values[0] = 0.0;
        let dark = over(&values);
        assert!(dark.is_logarithmic() && dark.share(0.0) <= 0.0);
        assert!(!over(&[200.0, 300.0, 400.0]).is_logarithmic());
    }
}
