//! Sensor points as walks meet them: free of the surface they lie on, with the basis of their Stokes vector.

use crate::sight::Seen;
use glam::DVec3;
use malus_geometry::Surfaces;
use malus_optics::{Basis, Sensor as SensorRole};
use malus_scene::{Frame, Quantity, Scene, Sensor, SensorPoint};
use std::f64::consts::{FRAC_1_PI, PI};

/// One sensor point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Receiver {
    /// Where light is gathered, moved off a surface it may lie on towards its normal.
    pub origin: DVec3,
    /// Unit normal; light arrives from its side.
    pub normal: DVec3,
    /// Inside a closed solid: takes no part in anything.
    pub enclosed: bool,
    /// What a surface of unit exitance that fills the view gives: 1 as irradiance, 1/π as radiance.
    pub per_exitance: f64,
    /// Emitters whose light is known where it comes straight: nothing samples it.
    pub seen: Seen,
    frame: Frame,
    axis: DVec3,
}

impl Receiver {
    /// All sensor points of a scene, in its order.
    pub(crate) fn all(scene: &Scene) -> Vec<Self> {
        scene
            .sensors
            .iter()
            .flat_map(|sensor| {
                sensor
                    .points
                    .iter()
                    .map(|point| Self::new(&scene.surfaces, sensor, point))
            })
            .collect()
    }

    fn new(surfaces: &Surfaces, sensor: &Sensor, point: &SensorPoint) -> Self {
        Self {
            origin: free_of_surfaces(surfaces, point.position, point.normal),
            normal: point.normal,
            enclosed: point.enclosed,
            per_exitance: match sensor.quantity {
                Quantity::Irradiance => 1.0,
                Quantity::Radiance => FRAC_1_PI,
            },
            seen: Seen::default(),
            frame: match sensor.quantity {
                Quantity::Irradiance => sensor.frame,
                Quantity::Radiance => Frame::Fixed,
            },
            axis: sensor.axis,
        }
    }

    /// One that reads the radiance that arrives at a point against a unit vector, with the given x axis.
    pub(crate) fn of_radiance(origin: DVec3, direction: DVec3, axis: DVec3) -> Self {
        Self {
            origin,
            normal: direction,
            enclosed: false,
            per_exitance: FRAC_1_PI,
            seen: Seen::default(),
            frame: Frame::Fixed,
            axis,
        }
    }

    /// Whether it reads irradiance, which light from all directions of a hemisphere gives.
    pub(crate) fn is_irradiance(&self) -> bool {
        self.per_exitance >= 1.0
    }

    /// Basis in which a beam along `direction` is added here (physics: the last rotator of eq. 20, or the fixed axis).
    pub(crate) fn basis(&self, direction: DVec3) -> Basis<SensorRole> {
        match self.frame {
            Frame::Incidence => Basis::in_plane_of_incidence(direction, self.normal, self.axis),
            Frame::Fixed => Basis::new(direction, self.axis),
        }
    }
}

/// cos θ cos θ′/(π r²) between a surface and a sensor `segment` away that faces along a normal of its own, in 1/m²; 0 where one
/// is behind the other.
pub(crate) fn coupling(segment: DVec3, normal: DVec3, facing: DVec3) -> f64 {
    let cosines = segment.dot(normal).max(0.0) * (-segment.dot(facing)).max(0.0);
    let square = segment.length_squared();
    // At the sensor itself there is neither a direction nor a distance.
    if cosines > 0.0 {
        cosines / (PI * square * square)
    } else {
        0.0
    }
}

/// Cosine below which a surface stands along a sensor's normal, and has no side that the normal tells.
const ALONG: f64 = 1e-6;

/// By how much farther, relative to the first, a sensor keeps from each further one of several planes that meet in it: of two
/// mirrors it then meets one before the other in every direction in which an image may stand.
const UNEVEN: f64 = 0.314_159;

/// The point, moved off every surface that it touches: to the side of the sensor's normal, or where a surface stands
/// along the normal, as the walls do at the edge of a floor, to the side of the surface's own.
fn free_of_surfaces(surfaces: &Surfaces, position: DVec3, normal: DVec3) -> DVec3 {
    let touched = surfaces.touching(position);
    let planes = surfaces.planes_of(&touched);
    let side = |(&triangle, plane): (&u32, usize)| {
        let own = surfaces.normal(triangle);
        let side = if own.dot(normal) < -ALONG { -own } else { own };
        (
            triangle,
            side,
            surfaces.offset() * (1.0 + UNEVEN * plane as f64),
        )
    };
    let sides: Vec<_> = touched.iter().zip(planes).map(side).collect();
    surfaces.moved_off(position, &sides)
}
