//! Sources without geometry: lamps as points and parallel light.

use crate::allowed::Allowed;
use crate::error::Error;
use crate::polarisation;
use crate::reader::{Field, Reader};
use glam::DVec3;

/// A source without geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Where it comes from: `source.0`, or the lamp's name in its file.
    pub name: String,
    /// Where its light starts and where it goes.
    pub kind: SourceKind,
    /// State of the emitted light as a Stokes vector with S0 = 1.
    pub state: [f64; 4],
    /// x axis of that state, a unit vector, to be made perpendicular to each emitted direction.
    pub axis: DVec3,
}

/// Where a source's light starts and where it goes.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceKind {
    /// A point.
    Point {
        /// Position in metres: of a loaded scene free of the surfaces that it was given in.
        position: DVec3,
        /// Intensity along the direction in which it is greatest, in unit/sr, ≥ 0.
        intensity: f64,
        /// Intensity by direction, relative to `intensity`.
        distribution: Distribution,
    },
    /// Parallel light from infinity.
    Distant {
        /// Direction of propagation, a unit vector.
        direction: DVec3,
        /// Irradiance on a plane across the beam, in unit/m², ≥ 0.
        irradiance: f64,
    },
}

/// Intensity of a point by direction, relative to its greatest value.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// 1 everywhere.
    Isotropic,
    /// max(0, cos θ), θ from `direction`.
    Cosine {
        /// Direction of the greatest intensity, a unit vector.
        direction: DVec3,
    },
    /// smoothstep((cos θ − cos_outer)/(cos_inner − cos_outer)): 1 inside the inner cone, 0 outside the outer one.
    Spot {
        /// Axis of the cone, a unit vector.
        direction: DVec3,
        /// Cosine of the half angle within which the intensity is full; ≥ `cos_outer`.
        cos_inner: f64,
        /// Cosine of the half angle beyond which nothing is emitted.
        cos_outer: f64,
    },
}

impl Distribution {
    /// Intensity along the unit vector `towards`, as a share of the greatest, 0 … 1.
    #[must_use]
    pub fn share(&self, towards: DVec3) -> f64 {
        match *self {
            Self::Isotropic => 1.0,
            Self::Cosine { direction } => direction.dot(towards).max(0.0),
            Self::Spot {
                direction,
                cos_inner,
                cos_outer,
            } => {
                let cos = direction.dot(towards);
                if cos <= cos_outer {
                    0.0
                } else if cos >= cos_inner {
                    1.0
                } else {
                    let t = (cos - cos_outer) / (cos_inner - cos_outer);
                    t * t * (3.0 - 2.0 * t)
                }
            }
        }
    }

    /// ∫ share dω over all directions, in sr: flux = intensity × this.
    ///
    /// Spot: the smoothstep is odd about the middle of its interval of cosines, so it counts as half of it:
    /// 2π (1 − (cos_inner + cos_outer)/2). Exact.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        use std::f64::consts::PI;
        match *self {
            Self::Isotropic => 4.0 * PI,
            Self::Cosine { .. } => PI,
            Self::Spot {
                cos_inner,
                cos_outer,
                ..
            } => 2.0 * PI * (1.0 - 0.5 * (cos_inner + cos_outer)),
        }
    }
}

impl Source {
    /// Reads one `[[source]]`, called `name` in messages.
    pub(crate) fn read(name: String, field: Field) -> Result<Self, Error> {
        #[derive(Clone)]
        enum Kind {
            Point,
            Spot,
            Distant,
        }
        let mut table = field.table()?;
        let kind = table.require("kind", "\"point\", \"spot\" or \"distant\"")?;
        let kind = kind.choice(&[
            ("point", Kind::Point),
            ("spot", Kind::Spot),
            ("distant", Kind::Distant),
        ])?;
        let kind = match kind {
            Kind::Point => {
                let distribution = point_distribution(&mut table)?;
                point(&mut table, distribution)?
            }
            Kind::Spot => {
                let distribution = spot_distribution(&mut table)?;
                point(&mut table, distribution)?
            }
            Kind::Distant => SourceKind::Distant {
                direction: direction(&mut table)?,
                irradiance: table
                    .require("irradiance", "unit/m² on a plane across the light")?
                    .number(Allowed::NotNegative)?,
            },
        };
        let state = table
            .take("stokes")
            .map(|field| state(&field))
            .transpose()?;
        let axis = table
            .take("axis")
            .map(|field| field.direction())
            .transpose()?;
        table.finish()?;
        Ok(Self {
            name,
            kind,
            state: state.unwrap_or(polarisation::UNPOLARISED),
            axis: axis.unwrap_or(DVec3::X),
        })
    }

    /// Emitted flux in the scene's unit; `None` for a distant source, whose beam has no end.
    #[must_use]
    pub fn flux(&self) -> Option<f64> {
        match &self.kind {
            SourceKind::Point {
                intensity,
                distribution,
                ..
            } => Some(intensity * distribution.solid_angle()),
            SourceKind::Distant { .. } => None,
        }
    }

    /// Whether it emits anything.
    pub(crate) fn emits(&self) -> bool {
        match self.kind {
            SourceKind::Point { intensity, .. } => intensity > 0.0,
            SourceKind::Distant { irradiance, .. } => irradiance > 0.0,
        }
    }
}

/// Reads a state of polarisation.
pub(crate) fn state(field: &Field) -> Result<[f64; 4], Error> {
    let state = field.numbers()?;
    if polarisation::admits(state) {
        Ok(polarisation::normalised(state))
    } else {
        Err(field.refused(polarisation::ALLOWED, format!(" {state:?}")))
    }
}

fn direction(table: &mut Reader) -> Result<DVec3, Error> {
    table
        .require("direction", "[x, y, z], the way its light goes")?
        .direction()
}

fn point(table: &mut Reader, distribution: Distribution) -> Result<SourceKind, Error> {
    Ok(SourceKind::Point {
        position: table.require("position", "[x, y, z] in metres")?.vector()?,
        intensity: table
            .require("intensity", "unit/sr along its greatest direction")?
            .number(Allowed::NotNegative)?,
        distribution,
    })
}

fn point_distribution(table: &mut Reader) -> Result<Distribution, Error> {
    let cosine = match table.take("distribution") {
        Some(field) => field.choice(&[("isotropic", false), ("cosine", true)])?,
        None => false,
    };
    Ok(if cosine {
        Distribution::Cosine {
            direction: direction(table)?,
        }
    } else {
        Distribution::Isotropic
    })
}

/// Blender's spot: full within the cosine cos_outer + blend (1 − cos_outer), smoothstep in the cosine from there.
fn spot_distribution(table: &mut Reader) -> Result<Distribution, Error> {
    let direction = direction(table)?;
    let cone_deg = table
        .require("cone_deg", "the full angle of the cone in degrees")?
        .number(Allowed::Cone)?;
    let blend = table.number_or("blend", Allowed::Share, 0.0)?;
    let cos_outer = libm::cos(0.5 * cone_deg.to_radians());
    Ok(Distribution::Spot {
        direction,
        cos_inner: cos_outer + blend * (1.0 - cos_outer),
        cos_outer,
    })
}

#[cfg(test)]
mod tests;
