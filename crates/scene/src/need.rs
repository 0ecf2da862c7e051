//! How many Stokes components a scene needs.

use crate::{Material, Model, Source};
use malus_optics::Representation;

/// Number of Stokes components that a scene needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// The least representation that loses nothing.
    pub representation: Representation,
    /// What forces it, in words.
    pub reason: String,
}

impl Need {
    /// The greatest need of any material, emission or source; the first of equals is named.
    pub(crate) fn of(model: Model, materials: &[Material], sources: &[Source]) -> Self {
        let mut need = Self {
            representation: Representation::Intensity,
            reason: "all light is unpolarised and nothing reflects like a mirror".into(),
        };
        if model != Model::Polarised {
            let name = if model == Model::Scalar {
                "scalar"
            } else {
                "diffuse"
            };
            need.reason = format!("the model {name:?} knows no polarisation");
            return need;
        }
        for material in materials {
            let name = &material.name;
            let representation = material.optics.representation();
            let why = match (material.optics, representation) {
                (malus_optics::Material::Coated(_), _) => {
                    "polarises light by its coat, in reflecting and in scattering"
                }
                (malus_optics::Material::Pane { .. }, Representation::Linear) => {
                    "is a pane and polarises light that it reflects and lets through"
                }
                (_, Representation::Full) => {
                    "turns linear into circular polarisation (k > 0 or n < 1)"
                }
                _ => "polarises light by mirror-like reflection (a > 0)",
            };
            need.raise(representation, || format!("material {name:?} {why}"));
            if let Some(emission) = &material.emission {
                let state = emission.state;
                need.raise(Representation::of_state(state), || {
                    format!("material {name:?} emits polarised light {state:?}")
                });
            }
        }
        for source in sources {
            let (name, state) = (&source.name, source.state);
            need.raise(Representation::of_state(state), || {
                format!("source {name:?} emits polarised light {state:?}")
            });
        }
        need
    }

    fn raise(&mut self, representation: Representation, reason: impl Fn() -> String) {
        if representation > self.representation {
            self.representation = representation;
            self.reason = reason();
        }
    }
}

/// The word for a representation in scene files.
#[must_use]
pub(crate) fn word(representation: Representation) -> &'static str {
    match representation {
        Representation::Intensity => "intensity",
        Representation::Linear => "linear",
        Representation::Full => "full",
    }
}
