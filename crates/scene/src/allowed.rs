//! Ranges of numbers: the one place that says what is allowed, in figures and in words.

/// What a number may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Allowed {
    /// Any finite number.
    Finite,
    /// Finite and > 0.
    Positive,
    /// Finite and ≥ 0.
    NotNegative,
    /// 0 … 1.
    Share,
    /// > 0, infinity included: a refractive index.
    Index,
    /// Finite and ≥ 1: the refractive index of a coat.
    Coat,
    /// More than 0, at most 180: the full angle of a cone in degrees.
    Cone,
    /// More than 0, less than 180: the angle across a picture in degrees.
    View,
}

impl Allowed {
    /// Whether `number` is allowed; never true of a NaN.
    pub(crate) fn admits(self, number: f64) -> bool {
        match self {
            Self::Finite => number.is_finite(),
            Self::Positive => number.is_finite() && number > 0.0,
            Self::NotNegative => number.is_finite() && number >= 0.0,
            Self::Share => (0.0..=1.0).contains(&number),
            Self::Index => number > 0.0,
            Self::Coat => number.is_finite() && number >= 1.0,
            Self::Cone => number > 0.0 && number <= 180.0,
            Self::View => number > 0.0 && number < 180.0,
        }
    }

    /// What is allowed, in words.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Finite => "a finite number",
            Self::Positive => "a number > 0",
            Self::NotNegative => "a number ≥ 0",
            Self::Share => "a number from 0 to 1",
            Self::Index => "a number > 0, or inf for an ideal mirror",
            Self::Coat => "a finite number ≥ 1",
            Self::Cone => "an angle > 0 and at most 180 degrees",
            Self::View => "an angle > 0 and < 180 degrees",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_admits_a_nan_and_only_an_index_admits_infinity() {
        for allowed in [
            Allowed::Finite,
            Allowed::Positive,
            Allowed::NotNegative,
            Allowed::Share,
            Allowed::Index,
            Allowed::Coat,
            Allowed::Cone,
            Allowed::View,
        ] {
            assert!(!allowed.admits(f64::NAN), "{allowed:?}");
            assert_eq!(allowed.admits(f64::INFINITY), allowed == Allowed::Index);
        }
    }

    #[test]
    fn the_ends_of_ranges() {
        assert!(Allowed::Share.admits(0.0) && Allowed::Share.admits(1.0));
        assert!(!Allowed::Share.admits(1.0 + f64::EPSILON));
        assert!(!Allowed::Index.admits(0.0) && !Allowed::Positive.admits(0.0));
        assert!(Allowed::Coat.admits(1.0) && !Allowed::Coat.admits(1.0 - f64::EPSILON));
        assert!(Allowed::Cone.admits(180.0) && !Allowed::View.admits(180.0));
        assert!(Allowed::NotNegative.admits(0.0) && !Allowed::NotNegative.admits(-1e-300));
    }
}
