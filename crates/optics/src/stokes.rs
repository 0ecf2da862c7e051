//! Stokes vectors.

use std::{
    marker::PhantomData,
    ops::{Add, AddAssign, Mul},
};

use crate::{Carried, Emergence, Sensor};

/// The Stokes vector (I, Q, U, V) of a beam, a column, in a basis of role `B`; the leading N of its
/// components, N = 1, 3 or 4.
///
/// It has the unit of the quantity described. With **x** the axis of the basis and **y** = **d** × **x**:
/// Q > 0, the field oscillates along **x**; U > 0, along **x** + **y**; V > 0, an observer who looks
/// into the beam sees the field turn clockwise. These are L₀ … L₃ of eq. 1.
///
/// Two beams have different bases, so only those brought into a sensor's frame can be added:
///
/// ```
/// # use malus_optics::*;
/// let sum = Stokes::<3, Sensor>::new([1.0, 0.5, 0.0]) + Stokes::new([1.0, 0.0, 0.5]);
/// assert_eq!(sum, Stokes::new([2.0, 0.5, 0.5]));
/// ```
/// ```compile_fail
/// # use malus_optics::*;
/// let sum = Stokes::<3, Carried>::new([1.0, 0.5, 0.0]) + Stokes::new([1.0, 0.0, 0.5]);
/// ```
/// There is no vector of two components:
///
/// ```
/// let stokes = malus_optics::Stokes::<4, malus_optics::Carried>::unpolarised(1.0);
/// ```
/// ```compile_fail
/// let stokes = malus_optics::Stokes::<2, malus_optics::Carried>::unpolarised(1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stokes<const N: usize, B>([f64; N], PhantomData<B>);

impl<const N: usize, B> Stokes<N, B> {
    /// The Stokes vector of these components.
    #[must_use]
    #[inline]
    pub const fn new(components: [f64; N]) -> Self {
        const { assert!(N == 1 || N == 3 || N == 4) }
        Self(components, PhantomData)
    }

    /// Unpolarised light, (i, 0, 0, 0).
    #[must_use]
    #[inline]
    pub const fn unpolarised(i: f64) -> Self {
        let mut components = [0.0; N];
        components[0] = i;
        Self::new(components)
    }

    /// The leading components of the state (I, Q, U, V).
    #[must_use]
    #[inline]
    pub fn of_state(state: [f64; 4]) -> Self {
        Self::new(std::array::from_fn(|component| state[component]))
    }

    /// The light that gives the readings J₀ … J₃ (as many as there are components) of
    /// [`Analyser::readings`](crate::Analyser::readings), eq. 1:
    ///
    /// I = 2J₀, Q = 2(J₀ − J₁), U = 2(J₂ − J₀), V = 2(J₃ − J₀)
    #[must_use]
    #[inline]
    pub fn from_readings(readings: [f64; N]) -> Self {
        Self::new(std::array::from_fn(|j| match j {
            0 => 2.0 * readings[0],
            1 => 2.0 * (readings[0] - readings[1]),
            _ => 2.0 * (readings[j] - readings[0]),
        }))
    }

    /// The components I, Q, U, V, as many as there are.
    #[must_use]
    #[inline]
    pub const fn components(&self) -> [f64; N] {
        self.0
    }

    /// The first component, I.
    #[must_use]
    #[inline]
    pub const fn i(&self) -> f64 {
        self.0[0]
    }

    /// All four components, those not carried being 0.
    #[must_use]
    #[inline]
    pub fn padded(&self) -> [f64; 4] {
        std::array::from_fn(|component| self.0.get(component).copied().unwrap_or(0.0))
    }
}

impl<const N: usize> Stokes<N, Emergence> {
    /// The same light, now carried to the next point, in [`Basis::carried`](crate::Basis::carried).
    #[must_use]
    #[inline]
    pub const fn carried(self) -> Stokes<N, Carried> {
        Stokes::new(self.0)
    }
}

impl<const N: usize, B> Mul<f64> for Stokes<N, B> {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.0.map(|component| component * factor))
    }
}

impl<const N: usize> Add for Stokes<N, Sensor> {
    type Output = Self;

    #[inline]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<const N: usize> AddAssign for Stokes<N, Sensor> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        for (sum, component) in self.0.iter_mut().zip(other.0) {
            *sum += component;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Analyser;

    #[test]
    fn readings_of_the_analysers_give_the_light_back() {
        // Eq. 1 by hand: J = (S0, S0 − S1, S0 + S2, S0 + S3)/2.
        let light = Stokes::<4, Sensor>::new([2.0, 1.0, -0.5, 0.25]);
        let readings = Analyser::readings().map(|analyser| analyser * light);
        assert_eq!(
            readings.map(f64::to_bits),
            [1.0, 0.5, 0.75, 1.125].map(f64::to_bits)
        );
        assert_eq!(Stokes::from_readings(readings), light);
        let [j0, j1, j2] = Analyser::<3, Sensor>::readings()
            .map(|analyser| analyser * Stokes::of_state(light.padded()));
        assert_eq!(
            [j0, j1, j2].map(f64::to_bits),
            [1.0, 0.5, 0.75].map(f64::to_bits)
        );
    }

    #[test]
    fn a_state_is_cut_to_the_components_carried_and_padded_with_zeros() {
        let state = [1.0, 0.5, 0.25, 0.125];
        assert_eq!(Stokes::<1, Sensor>::of_state(state), Stokes::new([1.0]));
        assert_eq!(Stokes::<4, Sensor>::of_state(state), Stokes::new(state));
        let padded = Stokes::<3, Sensor>::of_state(state).padded();
        assert_eq!(
            padded.map(f64::to_bits),
            [1.0, 0.5, 0.25, 0.0].map(f64::to_bits)
        );
    }
}
