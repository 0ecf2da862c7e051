//! Numbers as text: to the last bit in files, to the last meaningful digit for people.

use anyhow::{Result, ensure};

/// The shortest decimal that reads back to the same bits; 0 is `0`.
///
/// # Errors
/// A number that is infinite or no number: no result may hold one.
pub fn exact(value: f64) -> Result<String> {
    ensure!(
        value.is_finite(),
        "found {value} among the results, expected a finite number"
    );
    let size = value.abs();
    // Display never uses an exponent, and would write hundreds of zeros.
    Ok(if size != 0.0 && !(1e-5..1e16).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    })
}

/// A value to `digits` significant digits.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = digits.max(1);
    let exponent = exponent(value, digits);
    if (-4..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.*e}", digits - 1)
    }
}

/// A value and its standard error, the error to two significant digits and the value to the same decimal place.
pub fn with_error(value: f64, error: f64) -> (String, String) {
    /// Digits of a value whose error is far below what anyone reads.
    const MOST: i32 = 7;
    if !(error.is_finite() && error > 0.0 && value.is_finite()) {
        return (significant(value, 6), significant(error, 2));
    }
    let last = exponent(error, 2) - 1;
    let first = if value == 0.0 {
        last
    } else {
        exponent(value, 1).max(last)
    };
    let digits = (first - last + 1).min(MOST);
    if (-4..7).contains(&first) && last < 7 {
        let decimals = (digits - 1 - first).max(0) as usize;
        let shown = if (decimals as i32) < -last {
            significant(error, 2)
        } else {
            format!("{error:.decimals$}")
        };
        (format!("{value:.decimals$}"), shown)
    } else {
        let decimals = (digits - 1) as usize;
        (format!("{value:.decimals$e}"), format!("{error:.1e}"))
    }
}

/// `value ± error` in one text, as [`with_error`] has them.
pub fn measured(value: f64, error: f64) -> String {
    let (value, error) = with_error(value, error);
    format!("{value} ± {error}")
}

/// Power of ten of a finite value other than 0, after rounding it to `digits` significant digits.
pub fn exponent(value: f64, digits: usize) -> i32 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.split_once('e')
        .and_then(|(_, power)| power.parse().ok())
        .unwrap_or(0)
}

/// A coordinate in metres, to the millimetre or as far as it goes.
pub fn metres(value: f64) -> String {
    let text = format!("{value:.3}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}

/// Three coordinates.
pub fn triple(vector: [f64; 3]) -> String {
    format!("({})", vector.map(metres).join(", "))
}

/// A length of time as people say it, rounded up to whole seconds.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.ceil().max(0.0);
    if whole < 120.0 {
        format!("{whole} s")
    } else if whole < 7200.0 {
        format!("{} min", (whole / 60.0).round())
    } else if whole < 172_800.0 {
        format!("{:.1} h", whole / 3600.0)
    } else {
        format!("{:.0} days", whole / 86_400.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_numbers_read_back_to_the_same_bits() {
        for value in [
            0.0,
            -0.0,
            1.0,
            0.1,
            -1.0 / 3.0,
            5e-324,
            f64::MAX,
            f64::MIN_POSITIVE,
            123_456_789.123_456_78,
            1e16,
            9.999_999e-6,
        ] {
            let text = exact(value).expect("finite");
            let back: f64 = text.parse().expect("a number");
            assert_eq!(back.to_bits(), value.to_bits(), "{text}");
            assert!(text.len() <= 24, "{text}");
        }
        assert_eq!(exact(0.0).expect("finite"), "0");
        assert_eq!(exact(325.0).expect("finite"), "325");
    }

    #[test]
    fn what_is_no_number_is_refused() {
        assert!(exact(f64::NAN).is_err());
        assert!(exact(f64::NEG_INFINITY).is_err());
    }

    #[test]
    fn a_value_ends_where_its_error_ends() {
        assert_eq!(measured(325.1234, 1.234), "325.1 ± 1.2");
        assert_eq!(measured(0.003_797_83, 0.000_001_2), "0.0037978 ± 0.0000012");
        assert_eq!(measured(1234.5, 99.6), "1234 ± 100");
        assert_eq!(measured(0.0, 0.02), "0.000 ± 0.020");
        assert_eq!(measured(3.2e-6, 1.2e-8), "3.200e-6 ± 1.2e-8");
        assert_eq!(measured(2.0, 1e-15), "2.000000 ± 1.0e-15");
        assert_eq!(measured(2.0, 0.0), "2.00000 ± 0");
    }

    #[test]
    fn significant_digits_are_counted_after_rounding() {
        assert_eq!(significant(0.099_96, 3), "0.100");
        assert_eq!(significant(99.96, 3), "100");
        assert_eq!(significant(0.680_1, 3), "0.680");
        assert_eq!(significant(1.5e9, 2), "1.5e9");
    }

    #[test]
    fn coordinates_end_with_their_last_digit() {
        let values = [0.0, -0.0, 0.25, -1.0, 1.0 / 3.0, 100.0];
        assert_eq!(values.map(metres), ["0", "0", "0.25", "-1", "0.333", "100"]);
    }

    #[test]
    fn durations_are_said_in_the_largest_fitting_unit() {
        assert_eq!(duration(0.2), "1 s");
        assert_eq!(duration(119.0), "119 s");
        assert_eq!(duration(600.0), "10 min");
        assert_eq!(duration(9000.0), "2.5 h");
    }
}
