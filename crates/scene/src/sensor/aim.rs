//! What a sensor measures: light on a side of it, or light from one direction.

use super::{Frame, Quantity};
use crate::error::Error;
use crate::reader::{Field, Reader};
use glam::DVec3;

/// What a sensor measures, and where it faces or looks where it says so.
#[derive(Debug)]
pub(super) struct Aim {
    pub(super) quantity: Quantity,
    pub(super) direction: Option<DVec3>,
}

/// Reads `quantity` with the one of `normal` and `direction` that goes with it.
///
/// A file of points may say on each line where it looks; all others need the direction.
pub(super) fn aim(table: &mut Reader) -> Result<Aim, Error> {
    let quantity = match table.take("quantity") {
        Some(field) => field.choice(&[
            ("irradiance", Quantity::Irradiance),
            ("radiance", Quantity::Radiance),
        ])?,
        None => Quantity::Irradiance,
    };
    let normal = table.take("normal");
    let refused = |field: &Field, reason: &str| Error::Conflict {
        at: field.at().to_string(),
        reason: reason.into(),
    };
    if quantity == Quantity::Irradiance {
        return match table.take("direction") {
            Some(direction) => Err(refused(
                &direction,
                "direction goes with quantity = \"radiance\"; an irradiance has a normal, on whose side light is measured",
            )),
            None => Ok(Aim {
                quantity,
                direction: normal.map(|field| field.direction()).transpose()?,
            }),
        };
    }
    if let Some(normal) = normal {
        return Err(refused(
            &normal,
            "normal goes with quantity = \"irradiance\"; a radiance is that of light from one direction: direction is where the sensor looks",
        ));
    }
    Ok(Aim {
        quantity,
        direction: table
            .take("direction")
            .map(|field| field.direction())
            .transpose()?,
    })
}

/// Reads which x axis the Stokes vector belongs to; of a radiance it is always the sensor's own.
pub(super) fn frame(field: Option<Field>, quantity: Quantity) -> Result<Frame, Error> {
    match (field, quantity) {
        (None, Quantity::Irradiance) => Ok(Frame::Incidence),
        (None, Quantity::Radiance) => Ok(Frame::Fixed),
        (Some(field), Quantity::Irradiance) => {
            field.choice(&[("incidence", Frame::Incidence), ("fixed", Frame::Fixed)])
        }
        (Some(field), Quantity::Radiance) => Err(Error::Conflict {
            at: field.at().to_string(),
            reason: "frame goes with quantity = \"irradiance\"; a radiance is that of one beam, whose x axis is the sensor's axis made perpendicular to it".into(),
        }),
    }
}
