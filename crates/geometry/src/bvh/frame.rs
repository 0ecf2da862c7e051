//! The frame in which boxes are held in single precision.

use crate::crossing::Line;
use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::ray::{Ray, safe_inverse};

/// Extent to which the scene is scaled, to within a factor of two.
const EXTENT: f64 = 1024.0;

/// A frame around the scene in which single precision is enough for culling.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub centre: DVec3,
    /// A power of two.
    pub scale: f64,
    /// Radius of the scene, in the frame's units.
    pub radius: f64,
    /// Radius of the sphere about the centre in which single precision is enough for an origin, in m.
    pub sphere: f64,
    /// By how much triangles are thicker for rays, in the frame's units.
    pub slack: f64,
    /// By how much boxes grow, in the frame's units.
    pad: f64,
    /// More than a distance along a ray, or its product with an edge of length 1 as a packet sees it, may be wrong.
    pub margin: f32,
}

impl Frame {
    /// A box test errs by at most 4.5 ε·radius: ½ from rounding the origin, 1 from the difference to the box's side,
    /// 3 from the direction, its inverse and the product. The padding is 4 ε·extent = 8 ε·radius.
    pub fn new(centre: DVec3, radius: f64, slack: f64) -> Self {
        let mut scale = 1.0;
        while 2.0 * radius * scale > EXTENT {
            scale *= 0.5;
        }
        while radius > 0.0 && 2.0 * radius * scale <= 0.5 * EXTENT {
            scale *= 2.0;
        }
        let extent = 2.0 * radius * scale;
        let sphere = radius * (1.0 + 1e-3);
        let (radius, slack) = (radius * scale, slack * scale);
        let ulp = 0.5 * f64::from(f32::EPSILON) * radius;
        Self {
            centre,
            scale,
            radius,
            sphere,
            slack,
            pad: 4.0 * f64::from(f32::EPSILON) * extent + slack,
            margin: rounded_up(128.0 * ulp + 4.0 * slack),
        }
    }

    /// Rounding error of a coordinate at most, in the frame's units.
    pub fn ulp(&self) -> f64 {
        0.5 * f64::from(f32::EPSILON) * self.radius
    }

    /// A point of the scene, in the frame's units.
    pub fn point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }

    pub fn boxed(&self, corners: &[DVec3]) -> Aabb {
        let least = corners
            .iter()
            .fold(DVec3::INFINITY, |least, &corner| least.min(corner));
        let most = corners
            .iter()
            .fold(DVec3::NEG_INFINITY, |most, &corner| most.max(corner));
        let least = self.point(least) - self.pad;
        let most = self.point(most) + self.pad;
        Aabb::new(
            Vec3A::from_array(least.to_array().map(rounded_down)),
            Vec3A::from_array(most.to_array().map(rounded_up)),
        )
    }

    /// A ray without end.
    pub fn ray(&self, line: &Line) -> Ray {
        let origin = self.point(line.origin).as_vec3a();
        // A negative zero would turn its inverse to the wrong side of a box.
        let direction = line.direction.as_vec3a() + Vec3A::ZERO;
        Ray {
            origin,
            direction,
            inv_direction: Vec3A::from_array(direction.to_array().map(safe_inverse)),
            tmin: 0.0,
            tmax: f32::INFINITY,
        }
    }
}

#[allow(clippy::cast_possible_truncation)]
pub(super) fn rounded_up(value: f64) -> f32 {
    let single = value as f32;
    if f64::from(single) < value {
        single.next_up()
    } else {
        single
    }
}

pub(super) fn rounded_down(value: f64) -> f32 {
    -rounded_up(-value)
}
