//! Reference bases of beams and the roles they play.

use std::marker::PhantomData;

use glam::DVec3;

/// Role of a beam on its way from one point to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carried {}

/// Role of a beam that arrives at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Incidence {}

/// Role of a beam that leaves a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Emergence {}

/// Role of a beam that arrives at a sensor, in the sensor's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sensor {}

/// The basis that a Stokes vector refers to, in the role `B`.
///
/// `direction` **d** is that of propagation, `axis` **x** ⟂ **d**; both are unit vectors, and
/// **y** = **d** × **x** completes the right-handed triple (**x**, **y**, **d**).
///
/// A beam that leaves a surface becomes the beam carried to the next one by an explicit step, and no
/// other step changes a role:
///
/// ```
/// # use {glam::DVec3, malus_optics::*};
/// let leaving = Basis::<Emergence>::new(DVec3::Z, DVec3::X);
/// let arriving = Basis::<Incidence>::new(DVec3::Z, DVec3::Y);
/// let rotator: Rotator<Carried, Incidence> = Rotator::new(&leaving.carried(), &arriving);
/// ```
/// ```compile_fail
/// # use {glam::DVec3, malus_optics::*};
/// let leaving = Basis::<Emergence>::new(DVec3::Z, DVec3::X);
/// let arriving = Basis::<Incidence>::new(DVec3::Z, DVec3::Y);
/// let rotator: Rotator<Carried, Incidence> = Rotator::new(&leaving, &arriving);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis<B> {
    direction: DVec3,
    axis: DVec3,
    role: PhantomData<B>,
}

impl<B> Basis<B> {
    /// The basis of a beam along the unit vector `direction` whose x axis is `axis` made
    /// perpendicular to it.
    ///
    /// `axis` may have any length. Where it is zero, not finite, or parallel to `direction` to
    /// within rounding (10⁻¹⁴), any perpendicular axis is taken: Duff et al., *Building an
    /// Orthonormal Basis, Revisited*, JCGT 6 (2017).
    #[must_use]
    #[inline]
    pub fn new(direction: DVec3, axis: DVec3) -> Self {
        // The scale keeps the squares below within range; a zero axis becomes NaN and fails the test.
        let scaled = axis / axis.abs().max_element();
        let across = scaled - scaled.dot(direction) * direction;
        let axis = if across.length_squared() > 1e-28 {
            // Where the two are nearly parallel, cancellation leaves a part along the direction that
            // a second projection removes.
            let across = across.normalize();
            (across - across.dot(direction) * direction).normalize()
        } else {
            direction.any_orthonormal_vector()
        };
        Self::with_unit_axis(direction, axis)
    }

    /// Direction of propagation **d**, a unit vector.
    #[must_use]
    #[inline]
    pub const fn direction(&self) -> DVec3 {
        self.direction
    }

    /// The x axis, a unit vector perpendicular to the direction.
    #[must_use]
    #[inline]
    pub const fn axis(&self) -> DVec3 {
        self.axis
    }

    #[inline]
    fn with_unit_axis(direction: DVec3, axis: DVec3) -> Self {
        debug_assert!(
            (direction.length_squared() - 1.0).abs() < 1e-9,
            "{direction} is no unit vector"
        );
        debug_assert!(
            (axis.length_squared() - 1.0).abs() < 1e-9 && axis.dot(direction).abs() < 1e-9
        );
        Self {
            direction,
            axis,
            role: PhantomData,
        }
    }
}

impl Basis<Incidence> {
    /// The bases of a beam along `direction` before and after its mirror reflection at a surface
    /// whose unit normal is `normal`, on either side.
    ///
    /// Both have the s axis **x** ∥ **d** × **N**, perpendicular to the plane of incidence. At normal
    /// incidence that plane is undefined and reflection is the same in any basis: any axis
    /// perpendicular to the beam is taken. The reflected direction is **d** − 2(**N**·**d**)**N**
    /// (eq. 6), of unit length to rounding however often it is reflected.
    #[must_use]
    #[inline]
    pub fn mirror(direction: DVec3, normal: DVec3) -> (Self, Basis<Emergence>) {
        let s = across_incidence(direction, normal);
        // The limit only keeps the squares from underflow: the axis is accurate down to there.
        let axis = if s.length_squared() > 1e-200 {
            s.normalize()
        } else {
            direction.any_orthonormal_vector()
        };
        let reflected = (direction - 2.0 * direction.dot(normal) * normal).normalize();
        (
            Self::with_unit_axis(direction, axis),
            Basis::with_unit_axis(reflected, axis),
        )
    }
}

impl Basis<Emergence> {
    /// The same basis, of the beam now carried to the next point.
    #[must_use]
    #[inline]
    pub const fn carried(self) -> Basis<Carried> {
        Basis {
            direction: self.direction,
            axis: self.axis,
            role: PhantomData,
        }
    }
}

impl Basis<Sensor> {
    /// The frame `"incidence"` of an irradiance sensor: **x** along **d** × **N**, so that Q > 0 is an
    /// excess of s-polarised light on the surface.
    ///
    /// A beam along the unit vector `normal` (sine below 10⁻¹³, which is rounding) has no plane of
    /// incidence and takes `axis` made perpendicular, as the frame `"fixed"` does for every beam:
    /// that one is [`Basis::new`].
    #[must_use]
    #[inline]
    pub fn in_plane_of_incidence(direction: DVec3, normal: DVec3, axis: DVec3) -> Self {
        let s = across_incidence(direction, normal);
        if s.length_squared() > 1e-26 {
            Self::with_unit_axis(direction, s.normalize())
        } else {
            Self::new(direction, axis)
        }
    }
}

/// (cos θ, sin² θ) of the angle between a beam along `direction` and a surface's `normal`, both unit
/// vectors: |**d**·**N**|, whichever side is met, and |**N** × **d**|².
///
/// The square of the sine is accurate relative to itself at any angle, where 1 − cos² θ is not.
#[must_use]
#[inline]
pub fn angle_of_incidence(direction: DVec3, normal: DVec3) -> (f64, f64) {
    (
        direction.dot(normal).abs(),
        across_incidence(direction, normal).length_squared(),
    )
}

/// **d** × **N**, computed as (**d** ∓ **N**) × **N**: near normal incidence that difference is exact,
/// and the product does not cancel.
#[inline]
fn across_incidence(direction: DVec3, normal: DVec3) -> DVec3 {
    let nearest = if direction.dot(normal) < 0.0 {
        -normal
    } else {
        normal
    };
    (direction - nearest).cross(normal)
}

#[cfg(test)]
pub(crate) mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Unit vectors, uniform on the sphere.
    pub(crate) fn unit_vector() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0, 0.0..std::f64::consts::TAU).prop_map(|(z, azimuth): (f64, f64)| {
            let (sin, cos) = azimuth.sin_cos();
            DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z).normalize()
        })
    }

    fn assert_orthonormal<B>(basis: &Basis<B>) {
        assert!((basis.direction().length() - 1.0).abs() < 1e-15);
        assert!((basis.axis().length() - 1.0).abs() < 1e-15);
        assert!(basis.axis().dot(basis.direction()).abs() < 1e-15);
    }

    /// **a** × **b** to the last bit or two of each component: Kahan's difference of products.
    fn accurate_cross(a: DVec3, b: DVec3) -> DVec3 {
        let difference = |a: f64, b: f64, c: f64, d: f64| {
            let product = c * d;
            a.mul_add(b, -product) + (-c).mul_add(d, product)
        };
        DVec3::new(
            difference(a.y, b.z, a.z, b.y),
            difference(a.z, b.x, a.x, b.z),
            difference(a.x, b.y, a.y, b.x),
        )
    }

    #[test]
    fn an_axis_along_the_direction_is_replaced_by_a_perpendicular_one() {
        for direction in [
            DVec3::X,
            DVec3::Y,
            DVec3::Z,
            DVec3::NEG_Z,
            DVec3::ONE.normalize(),
        ] {
            for axis in [
                direction,
                -3.0 * direction,
                DVec3::ZERO,
                DVec3::NAN,
                DVec3::INFINITY,
            ] {
                assert_orthonormal(&Basis::<Carried>::new(direction, axis));
            }
        }
    }

    #[test]
    fn the_length_of_the_axis_is_of_no_account() {
        for length in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let basis = Basis::<Sensor>::new(DVec3::Z, length * DVec3::new(3.0, 4.0, 5.0));
            assert!(basis.axis().distance(DVec3::new(0.6, 0.8, 0.0)) < 1e-15);
        }
    }

    #[test]
    fn the_s_axis_is_perpendicular_to_the_plane_of_incidence() {
        let direction = DVec3::new(0.6, 0.0, -0.8);
        let (incidence, emergence) = Basis::<Incidence>::mirror(direction, DVec3::Z);
        // (0.6, 0, −0.8) × (0, 0, 1) = (0, −0.6, 0)
        assert!(incidence.axis().distance(DVec3::NEG_Y) < 1e-15);
        assert!(emergence.axis().distance(DVec3::NEG_Y) < 1e-15);
        assert!(emergence.direction().distance(DVec3::new(0.6, 0.0, 0.8)) < 1e-15);
    }

    #[test]
    fn at_normal_incidence_any_axis_serves() {
        for normal in [
            DVec3::X,
            DVec3::Z,
            DVec3::NEG_Z,
            DVec3::new(1.0, -2.0, 3.0).normalize(),
        ] {
            let (incidence, emergence) = Basis::<Incidence>::mirror(-normal, normal);
            assert_orthonormal(&incidence);
            assert_orthonormal(&emergence);
            assert!(emergence.direction().distance(normal) < 1e-15);
        }
    }

    #[test]
    fn a_reflected_direction_keeps_its_length_over_a_million_reflections() {
        let (above, below) = (
            DVec3::new(1.0, 2.0, 3.0).normalize(),
            DVec3::new(-3.0, 1.0, 2.0).normalize(),
        );
        let mut direction = DVec3::new(0.3, -0.5, 0.7).normalize();
        for _ in 0..500_000 {
            direction = Basis::<Incidence>::mirror(direction, above).1.direction();
            direction = Basis::<Incidence>::mirror(direction, below).1.direction();
        }
        assert!((direction.length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_beam_along_the_sensors_normal_takes_the_fixed_axis() {
        let axis = DVec3::new(1.0, 1.0, 0.5);
        for direction in [DVec3::NEG_Z, DVec3::new(3e-15, -4e-15, -1.0)] {
            let basis = Basis::<Sensor>::in_plane_of_incidence(direction, DVec3::Z, axis);
            assert_eq!(basis, Basis::<Sensor>::new(direction, axis));
        }
    }

    #[test]
    fn any_other_beam_has_the_sensors_axis_across_the_plane_of_incidence() {
        let direction = DVec3::new(0.0, 0.6, -0.8);
        let basis = Basis::<Sensor>::in_plane_of_incidence(direction, DVec3::Z, DVec3::Y);
        // (0, 0.6, −0.8) × (0, 0, 1) = (0.6, 0, 0)
        assert!(basis.axis().distance(DVec3::X) < 1e-15);
    }

    proptest! {
        #[test]
        fn every_basis_is_orthonormal(direction in unit_vector(), axis in unit_vector(), exponent in -16..0) {
            assert_orthonormal(&Basis::<Carried>::new(direction, axis));
            let nearly_along = direction + 10f64.powi(exponent) * axis;
            assert_orthonormal(&Basis::<Carried>::new(direction, nearly_along));
        }

        #[test]
        fn the_s_axis_is_accurate_however_near_to_normal(
            normal in unit_vector(), aside in unit_vector(), exponent in -15..0, side in prop::bool::ANY
        ) {
            let direction = (10f64.powi(exponent) * aside + if side { normal } else { -normal }).normalize();
            let exact = accurate_cross(direction, normal);
            prop_assume!(exact.length() > 0.0);
            let (incidence, emergence) = Basis::<Incidence>::mirror(direction, normal);
            assert_orthonormal(&incidence);
            assert_orthonormal(&emergence);
            prop_assert!(incidence.axis().distance(exact.normalize()) < 2e-15);
            let (cos, sin2) = angle_of_incidence(direction, normal);
            prop_assert!((sin2 / exact.length_squared() - 1.0).abs() < 4e-15);
            prop_assert!((cos * cos + sin2 - 1.0).abs() < 2e-15);
        }
    }
}
