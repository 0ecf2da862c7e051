//! Mueller matrices.

use std::{array, marker::PhantomData, ops::Mul};

use crate::{Analyser, Carried, Emergence, Incidence, Reflection, Rotator, Stokes, analyser::dot};

/// A Mueller matrix: takes Stokes vectors in a basis of role `From` to such in one of role `To`; the
/// leading N × N block of the 4 × 4 matrix.
///
/// [`Rotator`] and [`Reflection`] have few distinct elements and their own cheap products; this type
/// holds what they add up to, such as the rows that a walk from the sensor carries.
///
/// ```
/// # use malus_optics::*;
/// # let reflection = Index::new(1.5, 0.0).reflection(1.0, 0.0);
/// let matrix: Mueller<4, Incidence, Emergence> = reflection.into();
/// let leaving: Stokes<4, Emergence> = matrix * Stokes::<4, Incidence>::unpolarised(1.0);
/// ```
/// ```compile_fail
/// # use malus_optics::*;
/// # let reflection = Index::new(1.5, 0.0).reflection(1.0, 0.0);
/// let matrix: Mueller<4, Incidence, Emergence> = reflection.into();
/// let leaving: Stokes<4, Emergence> = matrix * Stokes::<4, Carried>::unpolarised(1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mueller<const N: usize, From, To>([[f64; N]; N], PhantomData<(From, To)>);

impl<const N: usize, From, To> Mueller<N, From, To> {
    /// The matrix of these rows.
    #[must_use]
    #[inline]
    pub const fn new(rows: [[f64; N]; N]) -> Self {
        const { assert!(N == 1 || N == 3 || N == 4) }
        Self(rows, PhantomData)
    }

    /// The total depolariser: passes the fraction `albedo` of I and nothing else. ρ_ε of eq. 21.
    #[must_use]
    pub const fn depolariser(albedo: f64) -> Self {
        let mut rows = [[0.0; N]; N];
        rows[0][0] = albedo;
        Self::new(rows)
    }

    /// An ideal linear polariser that passes the field along **x**.
    #[must_use]
    pub fn linear_polariser() -> Self {
        Self::new(array::from_fn(|row| {
            array::from_fn(|column| if row.max(column) < 2 { 0.5 } else { 0.0 })
        }))
    }

    /// The elements, row by row.
    #[must_use]
    #[inline]
    pub const fn rows(&self) -> [[f64; N]; N] {
        self.0
    }

    /// Each row, as an analyser, changed by `change`.
    #[inline]
    pub(crate) fn map_rows<Before>(
        self,
        change: impl Fn(Analyser<N, From>) -> Analyser<N, Before>,
    ) -> Mueller<N, Before, To> {
        Mueller::new(self.0.map(|row| change(Analyser::new(row)).components()))
    }
}

impl<const N: usize, B> Mueller<N, B, B> {
    /// The matrix that changes nothing.
    #[must_use]
    #[inline]
    pub fn identity() -> Self {
        Self::new(array::from_fn(|row| {
            array::from_fn(|column| if row == column { 1.0 } else { 0.0 })
        }))
    }
}

impl<const N: usize, To> Mueller<N, Carried, To> {
    /// The same matrix, taking the carried beam where it leaves the surface it comes from.
    #[must_use]
    #[inline]
    pub fn emergent(self) -> Mueller<N, Emergence, To> {
        Mueller::new(self.0)
    }
}

impl<const N: usize, From, To> std::convert::From<Rotator<From, To>> for Mueller<N, From, To> {
    #[inline]
    fn from(rotator: Rotator<From, To>) -> Self {
        Mueller::<N, To, To>::identity() * rotator
    }
}

impl<const N: usize> std::convert::From<Reflection> for Mueller<N, Incidence, Emergence> {
    #[inline]
    fn from(reflection: Reflection) -> Self {
        Mueller::<N, Emergence, Emergence>::identity() * reflection
    }
}

impl<const N: usize, From, To> Mul<Stokes<N, From>> for Mueller<N, From, To> {
    type Output = Stokes<N, To>;

    #[inline]
    fn mul(self, light: Stokes<N, From>) -> Stokes<N, To> {
        Stokes::new(self.0.map(|row| dot(&row, &light.components())))
    }
}

impl<const N: usize, From, Over, To> Mul<Mueller<N, From, Over>> for Mueller<N, Over, To> {
    type Output = Mueller<N, From, To>;

    #[inline]
    fn mul(self, first: Mueller<N, From, Over>) -> Mueller<N, From, To> {
        let column = |column: usize| first.0.map(|row| row[column]);
        Mueller::new(
            self.0
                .map(|row| array::from_fn(|index| dot(&row, &column(index)))),
        )
    }
}

impl<const N: usize, From, To> Mul<f64> for Mueller<N, From, To> {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.0.map(|row| row.map(|element| element * factor)))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{Basis, Sensor};

    /// Transmittance of two polarisers, the second turned by `degrees`, for unpolarised light.
    fn through_two_polarisers(degrees: f64) -> f64 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let first = Basis::<Carried>::new(DVec3::Z, DVec3::X);
        let second = Basis::<Sensor>::new(DVec3::Z, DVec3::new(cos, sin, 0.0));
        let polariser = Mueller::<4, Carried, Carried>::linear_polariser();
        let turned =
            Mueller::<4, Sensor, Sensor>::linear_polariser() * Rotator::new(&first, &second);
        (turned * (polariser * Stokes::unpolarised(1.0))).i()
    }

    #[test]
    fn two_polarisers_obey_the_law_of_malus() {
        for degrees in [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 120.0] {
            let cos = f64::to_radians(degrees).cos();
            assert!((through_two_polarisers(degrees) - 0.5 * cos * cos).abs() < 1e-15);
        }
    }

    #[test]
    fn crossed_polarisers_pass_nothing() {
        assert!(through_two_polarisers(90.0).abs() < 1e-16);
    }

    #[test]
    fn a_depolariser_leaves_only_the_albedo() {
        let light = Stokes::<4, Incidence>::new([2.0, 1.0, -1.0, 0.5]);
        let depolariser = Mueller::<4, Incidence, Emergence>::depolariser(0.25);
        assert_eq!(depolariser * light, Stokes::unpolarised(0.5));
    }

    #[test]
    fn a_product_of_matrices_acts_as_one_after_the_other() {
        // Small integers: every sum is exact.
        let first = Mueller::<3, Carried, Incidence>::new([
            [1.0, 2.0, 3.0],
            [4.0, 5.0, 6.0],
            [7.0, 8.0, 9.0],
        ]);
        let second = Mueller::<3, Incidence, Emergence>::new([
            [2.0, 0.0, 1.0],
            [1.0, 3.0, 0.0],
            [0.0, 1.0, 4.0],
        ]);
        let light = Stokes::<3, Carried>::new([3.0, -1.0, 2.0]);
        assert_eq!((second * first) * light, second * (first * light));
        let rows = [[9.0, 12.0, 15.0], [13.0, 17.0, 21.0], [32.0, 37.0, 42.0]];
        assert_eq!(second * first, Mueller::new(rows));
    }
}
