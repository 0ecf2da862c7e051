//! The unit of flux that the user's numbers are in.

use serde::Serialize;

/// Unit of flux; every other unit follows from it. Numbers are never converted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Unit {
    /// Lumen: irradiance is illuminance in lm/m² = lx.
    #[serde(rename = "lm")]
    Lumen,
    /// Watt: irradiance in W/m².
    #[serde(rename = "W")]
    Watt,
}

impl Unit {
    /// Symbol of the flux unit, as in the scene file.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Lumen => "lm",
            Self::Watt => "W",
        }
    }
}
