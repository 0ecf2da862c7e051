//! The rotator: a change of the reference basis of a beam.

use std::{marker::PhantomData, ops::Mul};

use crate::{Analyser, Basis, Mueller, Stokes};

/// The change of a beam's basis from one of role `From` to one of role `To`, eq. 2 and 3:
///
/// ```text
///     1     0        0     0
///     0   cos 2φ   sin 2φ  0
///     0  −sin 2φ   cos 2φ  0
///     0     0        0     1
/// ```
///
/// where the new axis is the old one turned by φ anticlockwise as seen by an observer who looks into
/// the beam. It is applied by four multiplications.
///
/// ```
/// # use {glam::DVec3, malus_optics::*};
/// # let carried = Basis::<Carried>::new(DVec3::Z, DVec3::X);
/// # let incidence = Basis::<Incidence>::new(DVec3::Z, DVec3::Y);
/// # let reflection = Index::Mirror.reflection(1.0, 0.0);
/// # let radiance = Stokes::<3, Carried>::unpolarised(1.0);
/// let at_surface = Rotator::new(&carried, &incidence) * radiance;
/// let reflected = reflection * at_surface;
/// ```
/// ```compile_fail
/// # use {glam::DVec3, malus_optics::*};
/// # let carried = Basis::<Carried>::new(DVec3::Z, DVec3::X);
/// # let incidence = Basis::<Incidence>::new(DVec3::Z, DVec3::Y);
/// # let reflection = Index::Mirror.reflection(1.0, 0.0);
/// # let radiance = Stokes::<3, Carried>::unpolarised(1.0);
/// let at_surface = Rotator::new(&incidence, &carried) * radiance;
/// let reflected = reflection * at_surface;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotator<From, To> {
    cos2: f64,
    sin2: f64,
    roles: PhantomData<(From, To)>,
}

impl<From, To> Rotator<From, To> {
    /// The rotator from one basis of a beam to another of the same beam.
    ///
    /// cos 2φ = c² − s², sin 2φ = 2cs with c = **x**·**x**′ and s = (**x** × **x**′)·**d**.
    #[must_use]
    #[inline]
    pub fn new(from: &Basis<From>, to: &Basis<To>) -> Self {
        debug_assert!(
            from.direction().distance(to.direction()) < 1e-9,
            "two beams, not two bases of one"
        );
        let c = from.axis().dot(to.axis());
        let s = from.axis().cross(to.axis()).dot(from.direction());
        Self {
            cos2: (c - s) * (c + s),
            sin2: 2.0 * c * s,
            roles: PhantomData,
        }
    }

    /// cos 2φ.
    #[must_use]
    #[inline]
    pub const fn cos2(&self) -> f64 {
        self.cos2
    }

    /// sin 2φ.
    #[must_use]
    #[inline]
    pub const fn sin2(&self) -> f64 {
        self.sin2
    }
}

impl<const N: usize, From, To> Mul<Stokes<N, From>> for Rotator<From, To> {
    type Output = Stokes<N, To>;

    #[inline]
    fn mul(self, light: Stokes<N, From>) -> Stokes<N, To> {
        let old = light.components();
        let mut new = old;
        if N > 1 {
            new[1] = self.cos2 * old[1] + self.sin2 * old[2];
            new[2] = self.cos2 * old[2] - self.sin2 * old[1];
        }
        Stokes::new(new)
    }
}

impl<const N: usize, From, To> Mul<Rotator<From, To>> for Analyser<N, To> {
    type Output = Analyser<N, From>;

    #[inline]
    fn mul(self, rotator: Rotator<From, To>) -> Analyser<N, From> {
        let old = self.components();
        let mut new = old;
        if N > 1 {
            new[1] = rotator.cos2 * old[1] - rotator.sin2 * old[2];
            new[2] = rotator.cos2 * old[2] + rotator.sin2 * old[1];
        }
        Analyser::new(new)
    }
}

impl<const N: usize, From, Over, To> Mul<Rotator<From, Over>> for Mueller<N, Over, To> {
    type Output = Mueller<N, From, To>;

    #[inline]
    fn mul(self, rotator: Rotator<From, Over>) -> Mueller<N, From, To> {
        let Rotator { cos2, sin2, .. } = rotator;
        self.map_rows(|row| {
            row * Rotator::<From, Over> {
                cos2,
                sin2,
                roles: PhantomData,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::{Carried, Incidence, Sensor, basis::tests::unit_vector};

    fn along_z<B>(degrees: f64) -> Basis<B> {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Basis::new(DVec3::Z, DVec3::new(cos, sin, 0.0))
    }

    fn turned_by(degrees: f64) -> Rotator<Carried, Incidence> {
        Rotator::new(&along_z(0.0), &along_z(degrees))
    }

    fn assert_close<const N: usize>(actual: [f64; N], expected: [f64; N], tolerance: f64) {
        for (a, e) in actual.into_iter().zip(expected) {
            assert!((a - e).abs() <= tolerance, "{actual:?} is not {expected:?}");
        }
    }

    #[test]
    fn the_angle_counts_anticlockwise_as_seen_looking_into_the_beam() {
        // The beam comes along +z towards the observer, who sees X to the right and Y up: from X,
        // the axis at 30° is an anticlockwise turn, φ = +30° in eq. 3.
        let rotator = turned_by(30.0);
        assert!((rotator.cos2() - 0.5).abs() < 1e-15);
        assert!((rotator.sin2() - 0.75f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn light_along_x_plus_y_has_positive_u_and_lies_along_an_axis_turned_by_45_degrees() {
        let light = turned_by(45.0) * Stokes::<4, Carried>::new([1.0, 0.0, 1.0, 0.0]);
        assert_close(light.components(), [1.0, 1.0, 0.0, 0.0], 1e-15);
    }

    #[test]
    fn a_quarter_turn_changes_the_sign_of_q_and_u_and_leaves_i_and_v() {
        let light = turned_by(90.0) * Stokes::<4, Carried>::new([1.0, 0.5, -0.25, 0.125]);
        assert_close(light.components(), [1.0, -0.5, 0.25, 0.125], 1e-15);
    }

    #[test]
    fn antiparallel_axes_are_one_basis() {
        let light = Stokes::<4, Carried>::new([1.0, 0.5, -0.25, 0.125]);
        let to = Basis::<Incidence>::new(DVec3::Z, DVec3::NEG_X);
        let same = Rotator::new(&Basis::<Carried>::new(DVec3::Z, DVec3::X), &to) * light;
        assert_close(same.components(), light.components(), 0.0);
    }

    #[test]
    fn the_matrix_is_that_of_eq_3() {
        let rotator = turned_by(20.0);
        let (sin2, cos2) = 40f64.to_radians().sin_cos();
        let matrix: [[f64; 4]; 4] = Mueller::from(rotator).rows();
        assert_close(matrix[0], [1.0, 0.0, 0.0, 0.0], 0.0);
        assert_close(matrix[1], [0.0, cos2, sin2, 0.0], 1e-15);
        assert_close(matrix[2], [0.0, -sin2, cos2, 0.0], 1e-15);
        assert_close(matrix[3], [0.0, 0.0, 0.0, 1.0], 0.0);
    }

    proptest! {
        #[test]
        fn rotators_compose(direction in unit_vector(), axes in [unit_vector(), unit_vector(), unit_vector()],
            state in prop::array::uniform4(-1.0..1.0)
        ) {
            let (first, over, last) = (Basis::<Carried>::new(direction, axes[0]),
                Basis::<Incidence>::new(direction, axes[1]), Basis::<Sensor>::new(direction, axes[2]));
            let light = Stokes::<4, Carried>::new(state);
            let by_steps = Rotator::new(&over, &last) * (Rotator::new(&first, &over) * light);
            assert_close(by_steps.components(), (Rotator::new(&first, &last) * light).components(), 1e-14);
        }

        #[test]
        fn rotators_invert(direction in unit_vector(), axes in [unit_vector(), unit_vector()],
            state in prop::array::uniform4(-1.0..1.0)
        ) {
            let (there, back) = (Basis::<Carried>::new(direction, axes[0]), Basis::<Sensor>::new(direction, axes[1]));
            let light = Stokes::<4, Carried>::new(state);
            let returned = Rotator::new(&back, &there) * (Rotator::new(&there, &back) * light);
            assert_close(returned.components(), state, 1e-14);
        }

        #[test]
        fn a_row_reads_the_same_light_before_and_after_the_rotator(
            direction in unit_vector(), axes in [unit_vector(), unit_vector()],
            row in prop::array::uniform4(-1.0..1.0), state in prop::array::uniform4(-1.0..1.0)
        ) {
            let rotator = Rotator::new(&Basis::<Carried>::new(direction, axes[0]), &Basis::<Sensor>::new(direction, axes[1]));
            let (row, light) = (Analyser::<4, Sensor>::new(row), Stokes::<4, Carried>::new(state));
            prop_assert!(((row * rotator) * light - row * (rotator * light)).abs() < 1e-14);
            let matrix = Mueller::<4, Sensor, Sensor>::identity() * rotator;
            assert_close((matrix * light).components(), (rotator * light).components(), 1e-15);
        }
    }
}
