//! Names of quantities, units and choices, as they are printed.

use malus_optics::Representation;
use malus_scene::{Estimator, Model, Quantity, Unit};

/// Name of what a sensor measures, in the words that go with the unit.
pub fn quantity(quantity: Quantity, unit: Unit) -> &'static str {
    match (quantity, unit) {
        (Quantity::Irradiance, Unit::Lumen) => "illuminance",
        (Quantity::Irradiance, Unit::Watt) => "irradiance",
        (Quantity::Radiance, Unit::Lumen) => "luminance",
        (Quantity::Radiance, Unit::Watt) => "radiance",
    }
}

/// Unit of what a sensor measures.
pub fn unit(quantity: Quantity, unit: Unit) -> &'static str {
    match (quantity, unit) {
        (Quantity::Irradiance, Unit::Lumen) => "lm/m² (lx)",
        (Quantity::Irradiance, Unit::Watt) => "W/m²",
        (Quantity::Radiance, Unit::Lumen) => "cd/m²",
        (Quantity::Radiance, Unit::Watt) => "W/(m²·sr)",
    }
}

/// The model, as the scene file spells it.
pub fn model(model: Model) -> &'static str {
    match model {
        Model::Polarised => "polarised",
        Model::Scalar => "scalar",
        Model::Diffuse => "diffuse",
    }
}

/// The representation, as the scene file spells it.
pub fn representation(representation: Representation) -> &'static str {
    match representation {
        Representation::Intensity => "intensity",
        Representation::Linear => "linear",
        Representation::Full => "full",
    }
}

/// The estimator, as the scene file spells it.
pub fn estimator(estimator: Estimator) -> &'static str {
    match estimator {
        Estimator::Auto => "auto",
        Estimator::Local => "local",
        Estimator::Gather => "gather",
        Estimator::Direct => "direct",
    }
}
