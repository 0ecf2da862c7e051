//! Mirror-like reflection at a surface, as a Mueller matrix of few elements.

use std::ops::Mul;

use crate::{Analyser, Emergence, Incidence, Mueller, Stokes};

/// A mirror-like reflection in the plane of incidence: takes the light of role [`Incidence`] to that
/// of role [`Emergence`], both in the basis whose **x** is the s axis. Eq. 7, with its signs and for
/// any index:
///
/// ```text
///     ½ (Rs + Rp)  ½ (Rs − Rp)   0    0
///     ½ (Rs − Rp)  ½ (Rs + Rp)   0    0
///          0            0        C   −W
///          0            0        W    C
/// ```
///
/// With the amplitude coefficients r_s and r_p (at normal incidence r_p = −r_s, Verdet's sign) in the
/// time factor of n + ik: Rs = |r_s|², Rp = |r_p|², C = Re(r_p r_s*), W = −Im(r_p r_s*).
/// It is applied by at most eight multiplications.
///
/// ```
/// # use malus_optics::*;
/// let reflection = Index::new(1.5, 0.0).reflection(1.0, 0.0);
/// let leaving = reflection * Stokes::<3, Incidence>::unpolarised(1.0);
/// let again = reflection * Stokes::<3, Incidence>::new(leaving.components());
/// ```
/// ```compile_fail
/// # use malus_optics::*;
/// let reflection = Index::new(1.5, 0.0).reflection(1.0, 0.0);
/// let leaving = reflection * Stokes::<3, Incidence>::unpolarised(1.0);
/// let again = reflection * leaving;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflection {
    mean: f64,
    half_difference: f64,
    c: f64,
    w: f64,
}

impl Reflection {
    /// No reflection at all.
    pub const NONE: Self = Self {
        mean: 0.0,
        half_difference: 0.0,
        c: 0.0,
        w: 0.0,
    };

    /// The ideal mirror: r_s = −1, r_p = +1 at any angle.
    pub const MIRROR: Self = Self {
        mean: 1.0,
        half_difference: 0.0,
        c: -1.0,
        w: 0.0,
    };

    /// The reflection of these elements, which the caller has from one pair of amplitudes.
    #[inline]
    pub(crate) fn from_elements(mean: f64, half_difference: f64, c: f64, w: f64) -> Self {
        Self {
            mean,
            half_difference,
            c,
            w,
        }
    }

    /// M00 = (Rs + Rp)/2, the reflectance for unpolarised light.
    #[must_use]
    #[inline]
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// M01 = (Rs − Rp)/2, accurate relative to itself down to normal incidence.
    #[must_use]
    #[inline]
    pub const fn half_difference(&self) -> f64 {
        self.half_difference
    }

    /// The reflectance Rs for light that oscillates across the plane of incidence.
    #[must_use]
    #[inline]
    pub const fn rs(&self) -> f64 {
        self.mean + self.half_difference
    }

    /// The reflectance Rp for light that oscillates in the plane of incidence.
    ///
    /// Of one pair of amplitudes, C² + W² = Rs Rp, from which this is accurate relative to itself next
    /// to Brewster's angle. A matrix that depolarises, as a pane's does, has C² + W² < Rs Rp: there
    /// this is M00 − M01, accurate to the rounding of M00.
    #[must_use]
    #[inline]
    pub fn rp(&self) -> f64 {
        let difference = self.mean - self.half_difference;
        let rs = self.rs();
        let of_amplitudes = if rs > 0.0 {
            (self.c * self.c + self.w * self.w) / rs
        } else {
            0.0
        };
        if difference - of_amplitudes > 8.0 * f64::EPSILON * self.mean {
            difference
        } else {
            of_amplitudes
        }
    }

    /// C = Re(r_p r_s*): what remains of U in U, and of V in V.
    #[must_use]
    #[inline]
    pub const fn c(&self) -> f64 {
        self.c
    }

    /// W = −Im(r_p r_s*): what U turns into V; V turns into U by −W.
    #[must_use]
    #[inline]
    pub const fn w(&self) -> f64 {
        self.w
    }

    /// The greatest reflectance for any state of polarisation, max(Rs, Rp) = M00 + |M01|, of a matrix
    /// that depolarises too: √(C² + W²) ≤ √(Rs Rp).
    #[must_use]
    #[inline]
    pub fn bound(&self) -> f64 {
        self.mean + self.half_difference.abs()
    }
}

impl Mul<f64> for Reflection {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self {
            mean: self.mean * factor,
            half_difference: self.half_difference * factor,
            c: self.c * factor,
            w: self.w * factor,
        }
    }
}

impl<const N: usize> Mul<Stokes<N, Incidence>> for Reflection {
    type Output = Stokes<N, Emergence>;

    #[inline]
    fn mul(self, light: Stokes<N, Incidence>) -> Stokes<N, Emergence> {
        Stokes::new(self.applied(light.components(), self.w))
    }
}

impl<const N: usize> Mul<Reflection> for Analyser<N, Emergence> {
    type Output = Analyser<N, Incidence>;

    #[inline]
    fn mul(self, reflection: Reflection) -> Analyser<N, Incidence> {
        // A row times the matrix is the transposed matrix times that row as a column.
        Analyser::new(reflection.applied(self.components(), -reflection.w))
    }
}

impl<const N: usize, To> Mul<Reflection> for Mueller<N, Emergence, To> {
    type Output = Mueller<N, Incidence, To>;

    #[inline]
    fn mul(self, reflection: Reflection) -> Mueller<N, Incidence, To> {
        self.map_rows(|row| row * reflection)
    }
}

impl Reflection {
    /// The matrix, with this W, times a column.
    #[inline]
    fn applied<const N: usize>(&self, old: [f64; N], w: f64) -> [f64; N] {
        let mut new = old;
        new[0] = self.mean * old[0];
        if N > 1 {
            new[0] += self.half_difference * old[1];
            new[1] = self.mean * old[1] + self.half_difference * old[0];
            new[2] = self.c * old[2];
        }
        if N > 3 {
            new[2] -= w * old[3];
            new[3] = self.c * old[3] + w * old[2];
        }
        new
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{Basis, Carried, Index, Rotator, angle_of_incidence};

    fn bits<const N: usize>(components: [f64; N]) -> [u64; N] {
        components.map(f64::to_bits)
    }

    #[test]
    fn the_matrix_is_that_of_eq_7_with_signs() {
        let (m, h, c, w) = (0.5, 0.25, -0.375, 0.125);
        let matrix: [[f64; 4]; 4] = Mueller::from(Reflection::from_elements(m, h, c, w)).rows();
        let expected = [
            [m, h, 0.0, 0.0],
            [h, m, 0.0, 0.0],
            [0.0, 0.0, c, -w],
            [0.0, 0.0, w, c],
        ];
        // Adding zero turns −0 into 0.
        assert_eq!(
            matrix.map(|row| bits(row.map(|x| x + 0.0))),
            expected.map(bits)
        );
    }

    #[test]
    fn the_bound_is_the_greater_reflectance_whichever_it_is() {
        // Small binary fractions: exact.
        for half_difference in [0.25, -0.25] {
            let bound = Reflection::from_elements(0.5, half_difference, 0.0, 0.0).bound();
            assert_eq!(bound.to_bits(), 0.75f64.to_bits());
        }
    }

    #[test]
    fn the_ideal_mirror_turns_a_field_as_a_looking_glass_does() {
        // Light along x + y (U > 0) lies along the same line of space after reflection at normal
        // incidence; seen against its new direction that is x − y.
        let light = Reflection::MIRROR * Stokes::<4, Incidence>::new([1.0, 0.0, 0.8, 0.6]);
        assert_eq!(bits(light.components()), bits([1.0, 0.0, -0.8, -0.6]));
    }

    #[test]
    fn two_glass_plates_at_brewsters_angle_with_crossed_planes_pass_nothing() {
        assert!(after_two_plates(DVec3::Y) < 1e-17);
    }

    #[test]
    fn two_glass_plates_at_brewsters_angle_with_parallel_planes_pass_half_the_square() {
        // Malus's experiment: Rs²/2 of unpolarised light, Rs = 25/169.
        assert!(
            (after_two_plates(DVec3::X) / (0.5 * (25.0f64 / 169.0).powi(2)) - 1.0).abs() < 1e-14
        );
    }

    /// Unpolarised light reflected at Brewster's angle by a first plate, whose plane of incidence is
    /// XZ, and then by a second, whose plane of incidence holds `aside`.
    fn after_two_plates(aside: DVec3) -> f64 {
        let glass = Index::new(1.5, 0.0);
        let (sin, cos) = (1.5 / 3.25f64.sqrt(), 1.0 / 3.25f64.sqrt());
        // The beam leaves the first plate along Z.
        let first_normal = DVec3::new(sin, 0.0, cos);
        let arriving = DVec3::NEG_Z - 2.0 * DVec3::NEG_Z.dot(first_normal) * first_normal;
        let mut light = Stokes::<4, Carried>::unpolarised(1.0);
        let mut basis = Basis::<Carried>::new(-arriving, DVec3::X);
        for normal in [first_normal, sin * aside + cos * DVec3::NEG_Z] {
            let (incidence, emergence) = Basis::<Incidence>::mirror(basis.direction(), normal);
            let (cos, sin2) = angle_of_incidence(basis.direction(), normal);
            light = (glass.reflection(cos, sin2) * (Rotator::new(&basis, &incidence) * light))
                .carried();
            basis = emergence.carried();
        }
        light.i()
    }

    #[test]
    fn reflections_in_one_plane_separate_the_two_polarisations() {
        // I = (Rs^N + Rp^N)/2, Q = (Rs^N − Rp^N)/2.
        let reflection = Index::new(1.5, 0.0).reflection(0.5f64.sqrt(), 0.5);
        let (rs, rp) = (reflection.rs(), reflection.rp());
        let mut light = Stokes::<4, Incidence>::unpolarised(1.0);
        for count in 1..=8 {
            light = Stokes::new((reflection * light).components());
            let (s, p) = (rs.powi(count), rp.powi(count));
            let [i, q, u, v] = light.components();
            assert!((i / (0.5 * (s + p)) - 1.0).abs() < 1e-14);
            assert!((q / i - (s - p) / (s + p)).abs() < 1e-14);
            assert!(u.abs() + v.abs() < 1e-300);
        }
    }

    #[test]
    fn fewer_components_give_the_same_bits_where_nothing_couples() {
        let dielectric = Index::new(1.5, 0.0).reflection(0.6, 0.64);
        let metal = Index::new(0.183, 3.43).reflection(0.6, 0.64);
        let state = [0.7, 0.3, -0.2, 0.1];
        for reflection in [dielectric, metal] {
            let full = reflection * Stokes::<4, Incidence>::new([state[0], state[1], 0.0, 0.0]);
            let linear = reflection * Stokes::<3, Incidence>::new([state[0], state[1], 0.0]);
            assert_eq!(bits(full.padded()), bits(linear.padded()));
            let full = reflection * Stokes::<4, Incidence>::unpolarised(state[0]);
            let scalar = reflection * Stokes::<1, Incidence>::unpolarised(state[0]);
            assert_eq!(full.i().to_bits(), scalar.i().to_bits());
        }
        let full = dielectric * Stokes::<4, Incidence>::new(state);
        let linear = dielectric * Stokes::<3, Incidence>::of_state(state);
        assert_eq!(bits(full.components())[..3], bits(linear.components()));
        let full = Analyser::<4, Emergence>::new(state) * dielectric;
        let linear = Analyser::<3, Emergence>::new([state[0], state[1], state[2]]) * dielectric;
        assert_eq!(bits(full.components())[..3], bits(linear.components()));
    }

    #[test]
    fn a_scaled_reflection_is_scaled_in_every_element() {
        let gold = Index::new(0.183, 3.43).reflection(0.6, 0.64);
        let half = gold * 0.5;
        assert_eq!(
            bits([half.mean(), half.half_difference()]),
            bits([0.5 * gold.mean(), 0.5 * gold.half_difference()])
        );
        assert_eq!(
            bits([half.c(), half.w(), half.bound()]),
            bits([0.5 * gold.c(), 0.5 * gold.w(), 0.5 * gold.bound()])
        );
        assert!((half.rp() / gold.rp() - 0.5).abs() < 1e-15);
    }
}
