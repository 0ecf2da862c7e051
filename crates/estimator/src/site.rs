//! A place of emission, and a walk that starts there.

use crate::variation::Origin;
use glam::DVec3;
use malus_scene::{Distribution, Material};
use std::f64::consts::PI;

/// State of emitted light: (1, q, u, v) about an axis; `None` where unpolarised.
pub(crate) type State<'a> = Option<(&'a [f64; 4], DVec3)>;

/// A place of emission that a point looks at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Site<'a> {
    /// Who emits there.
    pub origin: Origin,
    /// Where it is; `None` at infinity.
    pub from: Option<DVec3>,
    /// State of the light.
    pub state: State<'a>,
    /// One over the probability with which this emitter was chosen, per area where it is a surface.
    pub inverse: f64,
    /// The flat patch of emitters that it belongs to, if it does.
    pub patch: Option<u32>,
    pub shape: Shape<'a>,
}

/// How a place of emission sends light off.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape<'a> {
    /// Point of a surface, with its normal and the share of the table's flux per area, in 1/m².
    Area { normal: DVec3, density: f64 },
    /// Point source: intensity in unit/sr, by direction.
    Point {
        intensity: f64,
        distribution: &'a Distribution,
    },
    /// Parallel light along a direction: irradiance across it, and the area that walks from it start on, in m².
    Distant {
        direction: DVec3,
        irradiance: f64,
        area: f64,
    },
}

impl Site<'_> {
    /// Irradiance across the beam that leaves along the unit vector `leaving`, after a way of the given square, divided
    /// by the probability with which this site was chosen, in unit/m².
    #[inline]
    pub(crate) fn irradiance(&self, leaving: DVec3, square: f64) -> f64 {
        self.inverse
            * match self.shape {
                // Radiance M/π; M is in the inverse, whose probability is by flux.
                Shape::Area { normal, .. } => leaving.dot(normal).max(0.0) / (PI * square),
                Shape::Point {
                    intensity,
                    distribution,
                } => intensity * distribution.share(leaving) / square,
                Shape::Distant { irradiance, .. } => irradiance,
            }
    }

    /// Density per area across the beam with which a walk that starts at this site arrives there.
    #[inline]
    pub(crate) fn launched(&self, leaving: DVec3, square: f64) -> f64 {
        match self.shape {
            Shape::Area { normal, .. } => leaving.dot(normal).max(0.0) / (PI * square),
            Shape::Point { distribution, .. } => launch_density(distribution, leaving) / square,
            Shape::Distant { area, .. } => 1.0 / area,
        }
    }

    /// Density per area with which the site was chosen on its surface; `None` for a source without geometry.
    pub(crate) fn area_density(&self) -> Option<f64> {
        match self.shape {
            Shape::Area { density, .. } => Some(density),
            Shape::Point { .. } | Shape::Distant { .. } => None,
        }
    }

    /// Direction of light from infinity.
    pub(crate) fn direction(&self) -> DVec3 {
        match self.shape {
            Shape::Distant { direction, .. } => direction,
            Shape::Area { .. } | Shape::Point { .. } => DVec3::ZERO,
        }
    }
}

/// Where a walk from an emitter starts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start<'a> {
    /// On or at the emitter, moved off its surface.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Flux that the walk carries, in unit; the mean over walks is the flux of the scene.
    pub flux: f64,
    /// Normal of the emitting surface; `None` for a source without geometry.
    pub normal: Option<DVec3>,
    /// The same place as one that a point looks at.
    pub site: Site<'a>,
}

pub(crate) fn state_of<'a>(state: &'a [f64; 4], axis: DVec3) -> State<'a> {
    let polarised = state[1..].iter().any(|&component| component.abs() > 0.0);
    polarised.then_some((state, axis))
}

/// State of the light that a surface emits.
pub(crate) fn emitted_state(material: &Material) -> State<'_> {
    let emission = material.emission.as_ref()?;
    state_of(&emission.state, emission.axis)
}

/// Density per solid angle with which a walk leaves a point source along a direction (see [`Emitters::start`](crate::emitters::Emitters::start)).
fn launch_density(distribution: &Distribution, leaving: DVec3) -> f64 {
    match *distribution {
        Distribution::Isotropic => 0.25 / PI,
        Distribution::Cosine { direction } => direction.dot(leaving).max(0.0) / PI,
        Distribution::Spot {
            direction,
            cos_outer,
            ..
        } if direction.dot(leaving) > cos_outer => 0.5 / (PI * (1.0 - cos_outer)),
        Distribution::Spot { .. } => 0.0,
    }
}
