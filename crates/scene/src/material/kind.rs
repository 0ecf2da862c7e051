//! What kinds of reflector there are, and which values belong to each.

use super::library::Written;
use crate::allowed::Allowed;
use crate::appearance::{Appearance, Given};
use crate::place::Located;
use crate::properties::Custom;

/// Kind of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Eq. 21: a mirror-like part beside a Lambertian one.
    Mixture,
    /// A diffuser under a smooth coat.
    Coated,
    /// One plane-parallel sheet that lets light through.
    Pane,
}

/// A number that belongs to some kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    Rho,
    A,
    N,
    K,
    Tau,
}

impl Kind {
    /// Every kind under its word in scene files.
    pub(crate) const CHOICES: [(&'static str, Self); 3] = [
        ("mixture", Self::Mixture),
        ("coated", Self::Coated),
        ("pane", Self::Pane),
    ];

    /// The word for it in scene files.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Mixture => "mixture",
            Self::Coated => "coated",
            Self::Pane => "pane",
        }
    }

    /// Why a number does not belong to this kind; `None` where it does.
    ///
    /// The k of a coat is there and is 0.
    pub(crate) fn lacks(self, number: Number, value: f64) -> Option<&'static str> {
        match (self, number) {
            (Self::Mixture, Number::Tau) => Some("a mixture lets no light through"),
            (Self::Coated, Number::A) => Some(
                "it is not read, because a coat reflects all that Fresnel's formulae say and leaves the rest to rho",
            ),
            (Self::Coated, Number::K) if value > 0.0 => Some("a coat absorbs nothing, its k is 0"),
            (Self::Coated, Number::Tau) => Some("a coat absorbs nothing and hides a base"),
            (Self::Pane, Number::Rho | Number::A) => {
                Some("a pane scatters nothing and reflects all that Fresnel's formulae say")
            }
            (Self::Pane, Number::K) => Some("the index of a pane is real, its absorption is tau"),
            _ => None,
        }
    }
}

impl Number {
    /// All of them.
    pub(crate) const ALL: [Self; 5] = [Self::Rho, Self::A, Self::N, Self::K, Self::Tau];

    /// Its key in scene files.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::Rho => "rho",
            Self::A => "a",
            Self::N => "n",
            Self::K => "k",
            Self::Tau => "tau",
        }
    }

    /// The values that it may have in a material of this `kind`.
    pub(crate) fn allowed(self, kind: Kind) -> Allowed {
        match (self, kind) {
            (Self::Rho | Self::A | Self::Tau, _) => Allowed::Share,
            (Self::N, Kind::Mixture) => Allowed::Index,
            (Self::N, Kind::Coated) => Allowed::Coat,
            (Self::N, Kind::Pane) => Allowed::Positive,
            (Self::K, _) => Allowed::NotNegative,
        }
    }

    pub(crate) fn written(self, written: &Written) -> Option<&Located<f64>> {
        match self {
            Self::Rho => written.rho.as_ref(),
            Self::A => written.a.as_ref(),
            Self::N => written.n.as_ref(),
            Self::K => written.k.as_ref(),
            Self::Tau => written.tau.as_ref(),
        }
    }

    pub(crate) fn custom(self, custom: &Custom) -> Option<f64> {
        match self {
            Self::Rho => custom.rho,
            Self::A => custom.a,
            Self::N => custom.n,
            Self::K => custom.k,
            Self::Tau => custom.tau,
        }
    }

    pub(crate) fn field(self, appearance: &Appearance) -> Option<Given> {
        match self {
            Self::Rho => appearance.rho,
            Self::A => appearance.a,
            Self::N => appearance.n,
            Self::K => appearance.k,
            Self::Tau => appearance.tau,
        }
    }
}
