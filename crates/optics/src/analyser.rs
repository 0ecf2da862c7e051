//! Analysers: the rows that read a Stokes vector.

use std::{marker::PhantomData, ops::Mul};

use crate::{Carried, Emergence, Stokes};

/// What a detector behind an optical element reads of a beam: a row, whose product with the Stokes
/// vector of the beam is a number. `B` is the role of the basis in which the beam must be given.
///
/// A walk from the sensor multiplies it from the right, against the order in which light passes:
///
/// ```
/// # use {glam::DVec3, malus_optics::*};
/// # let glass = Index::new(1.5, 0.0).reflection(1.0, 0.0);
/// # let (incidence, emergence) = Basis::<Incidence>::mirror(DVec3::NEG_Z, DVec3::Z);
/// # let carried = Basis::<Carried>::new(DVec3::NEG_Z, DVec3::X);
/// let to_surface: Rotator<Carried, Incidence> = Rotator::new(&carried, &incidence);
/// let row = Analyser::<4, Emergence>::intensity() * glass * to_surface;
/// let reading: f64 = row * Stokes::<4, Carried>::unpolarised(1.0);
/// assert!((reading - 0.04).abs() < 1e-16);
/// ```
/// ```compile_fail
/// # use {glam::DVec3, malus_optics::*};
/// # let glass = Index::new(1.5, 0.0).reflection(1.0, 0.0);
/// # let (incidence, emergence) = Basis::<Incidence>::mirror(DVec3::NEG_Z, DVec3::Z);
/// # let carried = Basis::<Carried>::new(DVec3::NEG_Z, DVec3::X);
/// let to_surface: Rotator<Carried, Incidence> = Rotator::new(&carried, &incidence);
/// let row = Analyser::<4, Emergence>::intensity() * to_surface * glass;
/// ```
/// It reads no beam in another basis:
///
/// ```
/// # use malus_optics::*;
/// let reading = Analyser::<4, Incidence>::intensity() * Stokes::<4, Incidence>::unpolarised(1.0);
/// ```
/// ```compile_fail
/// # use malus_optics::*;
/// let reading = Analyser::<4, Incidence>::intensity() * Stokes::<4, Carried>::unpolarised(1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Analyser<const N: usize, B>([f64; N], PhantomData<B>);

impl<const N: usize, B> Analyser<N, B> {
    /// The row of these components.
    #[must_use]
    #[inline]
    pub const fn new(components: [f64; N]) -> Self {
        const { assert!(N == 1 || N == 3 || N == 4) }
        Self(components, PhantomData)
    }

    /// A detector that reads I and does not see polarisation: (1, 0, 0, 0).
    #[must_use]
    #[inline]
    pub const fn intensity() -> Self {
        Self::unpolarised(1.0)
    }

    /// A detector that reads `i` times I: (i, 0, 0, 0).
    #[must_use]
    #[inline]
    pub const fn unpolarised(i: f64) -> Self {
        let mut components = [0.0; N];
        components[0] = i;
        Self::new(components)
    }

    /// The detectors J₀ … J₃ of eq. 1, as many as there are components:
    ///
    /// J₀ = I/2, a neutral filter; J₁ = (I − Q)/2, a linear analyser along **y**;
    /// J₂ = (I + U)/2, one along **x** + **y**; J₃ = (I + V)/2, one for right-handed circular light.
    ///
    /// J₁ has the sign of the paper's own equation. Their inverse is [`Stokes::from_readings`].
    #[must_use]
    pub fn readings() -> [Self; N] {
        std::array::from_fn(|j| {
            let mut components = [0.0; N];
            components[j] = if j == 1 { -0.5 } else { 0.5 };
            components[0] = 0.5;
            Self::new(components)
        })
    }

    /// The components of the row.
    #[must_use]
    #[inline]
    pub const fn components(&self) -> [f64; N] {
        self.0
    }
}

impl<const N: usize> Analyser<N, Carried> {
    /// The same detector, reading the carried beam where it leaves the surface it comes from.
    #[must_use]
    #[inline]
    pub const fn emergent(self) -> Analyser<N, Emergence> {
        Analyser::new(self.0)
    }
}

impl<const N: usize, B> Mul<Stokes<N, B>> for Analyser<N, B> {
    type Output = f64;

    #[inline]
    fn mul(self, light: Stokes<N, B>) -> f64 {
        dot(&self.0, &light.components())
    }
}

impl<const N: usize, B> Mul<f64> for Analyser<N, B> {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.0.map(|component| component * factor))
    }
}

/// The sum over components in their order, so that trailing zeros change no bit.
#[inline]
pub(crate) fn dot<const N: usize>(row: &[f64; N], column: &[f64; N]) -> f64 {
    let mut sum = row[0] * column[0];
    for component in 1..N {
        sum += row[component] * column[component];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sensor;

    #[test]
    fn each_analyser_passes_all_of_its_own_light_and_none_of_the_orthogonal() {
        let [_, along_y, diagonal, right_handed] = Analyser::<4, Sensor>::readings();
        for (analyser, passed) in [
            (along_y, [1.0, -1.0, 0.0, 0.0]),
            (diagonal, [1.0, 0.0, 1.0, 0.0]),
            (right_handed, [1.0, 0.0, 0.0, 1.0]),
        ] {
            let orthogonal = [1.0, -passed[1], -passed[2], -passed[3]];
            assert_eq!((analyser * Stokes::new(passed)).to_bits(), 1f64.to_bits());
            assert_eq!(
                (analyser * Stokes::new(orthogonal)).to_bits(),
                0f64.to_bits()
            );
        }
    }

    #[test]
    fn a_neutral_filter_reads_half_of_any_light() {
        let [neutral, ..] = Analyser::<4, Sensor>::readings();
        assert_eq!(
            (neutral * Stokes::new([3.0, 1.0, -2.0, 0.5])).to_bits(),
            1.5f64.to_bits()
        );
    }
}
