//! How many Stokes components a calculation carries.

/// The Stokes components that a calculation carries.
///
/// Ordered by what they hold: the maximum over a scene's parts is what the scene requires, and it is
/// exact, because a part's representation leaves out only what nothing there couples to the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Representation {
    /// I alone: unpolarised light that meets no mirror-like reflector.
    Intensity,
    /// I, Q, U: linear polarisation; exact where nothing turns U into V or V into U.
    Linear,
    /// I, Q, U, V.
    Full,
}

impl Representation {
    /// Number of components N: 1, 3 or 4.
    #[must_use]
    pub const fn components(self) -> usize {
        match self {
            Self::Intensity => 1,
            Self::Linear => 3,
            Self::Full => 4,
        }
    }

    /// The least representation that holds the state (I, Q, U, V).
    #[must_use]
    pub fn of_state([_, q, u, v]: [f64; 4]) -> Self {
        if v != 0.0 {
            Self::Full
        } else if q != 0.0 || u != 0.0 {
            Self::Linear
        } else {
            Self::Intensity
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Representation::{self, Full, Intensity, Linear};

    #[test]
    fn a_state_needs_no_component_that_it_lacks() {
        assert_eq!(Representation::of_state([1.0, 0.0, 0.0, 0.0]), Intensity);
        assert_eq!(Representation::of_state([1.0, 0.0, -0.0, 0.0]), Intensity);
        assert_eq!(Representation::of_state([1.0, 0.3, 0.0, 0.0]), Linear);
        assert_eq!(Representation::of_state([1.0, 0.0, -0.3, 0.0]), Linear);
        assert_eq!(Representation::of_state([1.0, 0.0, 0.0, -0.3]), Full);
    }

    #[test]
    fn the_maximum_holds_both_parts() {
        assert_eq!(Linear.max(Intensity), Linear);
        assert_eq!(Linear.max(Full), Full);
        assert_eq!(
            [Intensity, Linear, Full].map(Representation::components),
            [1, 3, 4]
        );
    }
}
