//! Sensor points as walks meet them: free of the surface they lie on, with the basis of their Stokes vector.

use glam::DVec3;
use malus_geometry::Surfaces;
use malus_optics::{Basis, Sensor as SensorRole};
use malus_scene::{Frame, Scene, Sensor, SensorPoint};

/// One sensor point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Receiver {
    /// Where light is gathered, moved off a surface it may lie on towards its normal.
    pub origin: DVec3,
    /// Unit normal; light arrives from its side.
    pub normal: DVec3,
    /// Inside a closed solid: takes no part in anything.
    pub enclosed: bool,
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
            frame: sensor.frame,
            axis: sensor.axis,
        }
    }

    /// Basis in which a beam along `direction` is added here (physics: the last rotator of eq. 20, or the fixed axis).
    pub(crate) fn basis(&self, direction: DVec3) -> Basis<SensorRole> {
        match self.frame {
            Frame::Incidence => Basis::in_plane_of_incidence(direction, self.normal, self.axis),
            Frame::Fixed => Basis::new(direction, self.axis),
        }
    }
}

/// The point, or where surfaces lie within their tolerance of it, the near side of the last of them along the normal.
fn free_of_surfaces(surfaces: &Surfaces, position: DVec3, normal: DVec3) -> DVec3 {
    let reach = surfaces.tolerance();
    let mut free = position;
    let mut from = position - normal * reach;
    while let Some(hit) = surfaces.nearest(from, normal) {
        if (hit.position - position).dot(normal) > reach {
            break;
        }
        free = hit.position + normal * surfaces.offset();
        from = free;
    }
    free
}
