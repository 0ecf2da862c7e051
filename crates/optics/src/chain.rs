//! Whole chains of mirrors and panes, followed from either end.

use glam::DVec3;

use crate::{
    Basis, Carried, Incidence, Index, Material, Mueller, Reflection, Rotator, Sensor, Stokes,
    angle_of_incidence,
};

mod exact;
mod extremes;
mod properties;
mod thousand;
mod tracing;

/// What light meets on its way: a reflector, and whether the light that passes it is followed instead
/// of the light that it reflects.
#[derive(Clone, Copy, Debug)]
struct Surface {
    normal: DVec3,
    material: Material,
    through: bool,
}

impl Surface {
    fn mirror(normal: DVec3, index: Index) -> Self {
        Self {
            normal,
            material: Material::Mixture {
                rho: 0.0,
                fraction: 1.0,
                index,
            },
            through: false,
        }
    }
}

/// The way of light from a source past surfaces to a sensor; the directions after the first follow
/// from the normals.
struct Chain {
    steps: Vec<(Rotator<Carried, Incidence>, Reflection)>,
    arriving: Basis<Carried>,
    to_sensor: Rotator<Carried, Sensor>,
    /// The least n² |n² − sin² θ| of a surface and cos² θ of a pane passed. Next to a critical angle the
    /// first, and next to grazing incidence the second, is mostly the rounding of θ.
    conditioning: f64,
}

impl Chain {
    /// The light is given in the basis `source` and read in that of the x axis `axis`.
    fn new(source: Basis<Carried>, surfaces: &[Surface], axis: DVec3) -> Self {
        let mut carried = source;
        let mut steps = Vec::new();
        let mut conditioning = f64::INFINITY;
        for surface in surfaces {
            let direction = carried.direction();
            let (incidence, emergence) = Basis::<Incidence>::mirror(direction, surface.normal);
            let (cos, sin2) = angle_of_incidence(direction, surface.normal);
            let rotator = Rotator::new(&carried, &incidence);
            if let Material::Mixture {
                index: Index::Relative { n, .. },
                ..
            }
            | Material::Pane { n, .. } = surface.material
            {
                conditioning = conditioning.min(n * n * (n * n - sin2).abs());
            }
            if surface.through {
                conditioning = conditioning.min(cos * cos);
                steps.push((rotator, surface.material.through(cos, sin2)));
                carried = Basis::new(direction, incidence.axis());
            } else {
                steps.push((rotator, surface.material.mirror(cos, sin2)));
                carried = emergence.carried();
            }
        }
        let sensor = Basis::<Sensor>::new(carried.direction(), axis);
        Self {
            steps,
            arriving: carried,
            to_sensor: Rotator::new(&carried, &sensor),
            conditioning,
        }
    }

    /// What arrives of `light`, followed from the source.
    fn followed<const N: usize>(&self, light: Stokes<N, Carried>) -> Stokes<N, Sensor> {
        let arriving = self.steps.iter().fold(light, |light, &(rotator, matrix)| {
            (matrix * (rotator * light)).carried()
        });
        self.to_sensor * arriving
    }

    /// The matrix of the chain, built from the sensor's end as a walk from the sensor does.
    fn matrix<const N: usize>(&self) -> Mueller<N, Carried, Sensor> {
        let start = Mueller::<N, Sensor, Sensor>::identity() * self.to_sensor;
        self.steps
            .iter()
            .rev()
            .fold(start, |matrix, &(rotator, reflection)| {
                matrix.emergent() * reflection * rotator
            })
    }

    /// The product of max(Rs, Rp): no state keeps more of its light.
    fn bound(&self) -> f64 {
        self.steps
            .iter()
            .map(|(_, matrix)| matrix.bound())
            .product()
    }
}

/// A beam along Z with its axis along X, and surfaces that it meets one after the other: each at an
/// angle of incidence and with its s axis turned from that of the surface before (from X for the
/// first) by a dihedral angle, anticlockwise as seen looking into the beam; both in degrees.
fn in_turn(plates: &[(f64, f64, Index)]) -> (Basis<Carried>, Vec<Surface>) {
    let source = Basis::new(DVec3::Z, DVec3::X);
    let (mut direction, mut axis) = (DVec3::Z, DVec3::X);
    let mut surfaces = Vec::new();
    for &(incidence, dihedral, index) in plates {
        let (sin, cos) = dihedral.to_radians().sin_cos();
        axis = (cos * axis + sin * direction.cross(axis)).normalize();
        let (sin, cos) = incidence.to_radians().sin_cos();
        // d × N = sin θ · axis.
        let normal = (sin * axis.cross(direction) - cos * direction).normalize();
        direction = (direction - 2.0 * direction.dot(normal) * normal).normalize();
        surfaces.push(Surface::mirror(normal, index));
    }
    (source, surfaces)
}

/// The chain of [`in_turn`], read with **x** along the last s axis.
fn past(plates: &[(f64, f64, Index)]) -> Chain {
    let (source, surfaces) = in_turn(plates);
    let arriving = Chain::new(source, &surfaces, DVec3::X).arriving;
    Chain::new(source, &surfaces, arriving.axis())
}

/// Asserts that each component is within `tolerance` of the expected one.
fn assert_close<const N: usize>(actual: [f64; N], expected: [f64; N], tolerance: f64) {
    for (a, e) in actual.into_iter().zip(expected) {
        assert!((a - e).abs() <= tolerance, "{actual:?} is not {expected:?}");
    }
}
