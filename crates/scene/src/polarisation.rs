//! States of polarisation as written by users: four numbers, or a word.

/// Unpolarised light.
pub(crate) const UNPOLARISED: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// What a state may be, in words.
pub(crate) const ALLOWED: &str = "[1, q, u, v] with q² + u² + v² ≤ 1";

/// States that have a name: along the axis, across it, halfway between, and the two circular ones.
pub(crate) const NAMED: [(&str, [f64; 4]); 7] = [
    ("unpolarised", UNPOLARISED),
    ("horizontal", [1.0, 1.0, 0.0, 0.0]),
    ("vertical", [1.0, -1.0, 0.0, 0.0]),
    ("diagonal", [1.0, 0.0, 1.0, 0.0]),
    ("antidiagonal", [1.0, 0.0, -1.0, 0.0]),
    ("right-circular", [1.0, 0.0, 0.0, 1.0]),
    ("left-circular", [1.0, 0.0, 0.0, -1.0]),
];

/// Whether four numbers are a state of light with S0 = 1: q² + u² + v² ≤ 1.
///
/// A tolerance of 10⁻⁶ lets a fully polarised state through that a file holds in single precision.
pub(crate) fn admits(state: [f64; 4]) -> bool {
    let [intensity, q, u, v] = state;
    (intensity - 1.0).abs() <= 1e-6 && q * q + u * u + v * v <= 1.0 + 1e-6
}

/// The state with its polarised part scaled so that nothing exceeds full polarisation, S0 = 1 exactly.
pub(crate) fn normalised(state: [f64; 4]) -> [f64; 4] {
    let [_, q, u, v] = state;
    let square = q * q + u * u + v * v;
    if square <= 1.0 {
        return [1.0, q, u, v];
    }
    let degree = square.sqrt();
    [1.0, q / degree, u / degree, v / degree]
}

/// The state called `word`; American spelling counts as well.
pub(crate) fn named(word: &str) -> Option<[f64; 4]> {
    let word = word.to_lowercase().replace("polarized", "polarised");
    let found = NAMED.iter().find(|(name, _)| *name == word);
    found.map(|(_, state)| *state)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_fully_polarised_light_does_not_exist() {
        assert!(admits([1.0, 0.6, 0.0, 0.8]));
        assert!(!admits([1.0, 0.8, 0.0, 0.8]));
        assert!(!admits([0.5, 0.0, 0.0, 0.0]));
        assert!(!admits([1.0, f64::NAN, 0.0, 0.0]));
    }

    #[test]
    fn single_precision_full_polarisation_becomes_exact() {
        let third = f64::from(0.577_350_3_f32);
        let state = [1.0, third, third, third];
        assert!(admits(state));
        let [_, q, u, v] = normalised(state);
        assert!(q * q + u * u + v * v <= 1.0 + f64::EPSILON);
        assert!((q - 1.0 / 3f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn every_named_state_is_a_state() {
        for (name, state) in NAMED {
            assert!(admits(state), "{name}");
            assert_eq!(named(name), Some(state));
        }
        assert_eq!(named("Unpolarized"), Some(UNPOLARISED));
        assert_eq!(named("polarised"), None);
    }
}
