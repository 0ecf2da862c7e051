//! What the pixels of a picture have in common.

use super::exposure::BRIGHT;
use super::filter::{aolp_deg, dolp, linear};
use super::percentile::Percentiles;
use malus_estimator::Picture;

/// Share of the lit pixels whose degree of polarisation the colour scale covers.
const COVERED: f64 = 0.99;

/// Pixels darker than this share of the bright ones take no part in choosing a scale: theirs is mostly noise.
const DARK: f64 = 0.01;

/// Ends that a scale of the degree of polarisation may have.
const ENDS: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];

/// Polarised share of the whole picture's light below which a filter shows no more than a tenth of a per cent of it.
const NOTHING: f64 = 1e-3;

/// What the pixels of a picture have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Survey {
    /// Mean Stokes vector, in the unit of the picture.
    pub mean: [f64; 4],
    /// Degree of linear polarisation, each pixel weighed by its S0: mean √(S1² + S2²)/mean S0.
    pub dolp: f64,
    /// Degree of circular polarisation, likewise: mean |S3|/mean S0.
    pub docp: f64,
    /// Radiance that 95 % of the lit pixels do not exceed; 0 where there is no light.
    pub bright: f64,
    /// Median radiance of the lit pixels; 0 where there is no light.
    pub median: f64,
    /// Round end of a colour scale from 0 for the degree of linear polarisation.
    pub dolp_end: f64,
}

impl Survey {
    /// The survey of a picture; sums go by rows.
    pub fn of(picture: &Picture) -> Self {
        let (mut sums, mut linears, mut circulars) = ([0.0; 4], 0.0, 0.0);
        let mut radiances = Percentiles::new();
        for stokes in &picture.stokes {
            radiances.add(stokes[0]);
            let stokes = stokes.map(f64::from);
            for (sum, component) in sums.iter_mut().zip(stokes) {
                *sum += component;
            }
            linears += linear(stokes);
            circulars += stokes[3].abs();
        }
        let count = picture.stokes.len().max(1) as f64;
        let share = |part: f64| if sums[0] > 0.0 { part / sums[0] } else { 0.0 };
        let [bright, median] =
            [BRIGHT, 0.5].map(|share| f64::from(radiances.at(share).unwrap_or(0.0)));
        Self {
            mean: sums.map(|sum| sum / count),
            dolp: share(linears),
            docp: share(circulars),
            bright,
            median,
            dolp_end: dolp_end(picture, DARK * bright),
        }
    }

    /// Angle in degrees, 0 … 180, at which a filter darkens the whole picture most; `None` where all do alike.
    pub fn darkest_deg(&self) -> Option<f64> {
        let turned = linear(self.mean) > NOTHING * self.mean[0].abs();
        turned.then(|| (aolp_deg(self.mean) + 90.0) % 180.0)
    }
}

/// The first round end that covers the degrees of polarisation of what is lit, and stands clear of the noise: four
/// standard errors of S0, for S1 and S2 are no noisier.
fn dolp_end(picture: &Picture, dark: f64) -> f64 {
    let mut degrees = Percentiles::new();
    let lit = |stokes: &&[f32; 4]| f64::from(stokes[0]) >= dark;
    for stokes in picture.stokes.iter().filter(lit) {
        degrees.add(dolp(stokes.map(f64::from)) as f32);
    }
    let covered = f64::from(degrees.at(COVERED).unwrap_or(0.0));
    let wanted = covered.max(4.0 * picture.standard_error);
    ENDS.into_iter().find(|end| wanted <= *end).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn survey(stokes: &[[f32; 4]], standard_error: f64) -> Survey {
        Survey::of(&Picture {
            width: stokes.len() as u32,
            height: 1,
            stokes: stokes.to_vec(),
            standard_error,
            complete: true,
        })
    }

    #[test]
    fn degrees_are_weighed_by_radiance() {
        let survey = survey(
            &[[3.0, 0.0, 1.5, 0.0], [1.0, -0.5, 0.0, -0.25], [0.0; 4]],
            0.0,
        );
        assert_eq!((survey.dolp, survey.docp), (0.5, 0.0625));
        assert_eq!((survey.mean[0], survey.mean[2]), (4.0 / 3.0, 0.5));
    }

    #[test]
    fn the_darkest_angle_is_across_the_field() {
        for (stokes, angle) in [
            ([1.0, 0.5, 0.0, 0.0], 90.0),
            ([1.0, 0.0, 0.5, 0.0], 135.0),
            ([1.0, -0.5, 0.0, 0.0], 0.0),
            ([1.0, 0.0, -0.5, 0.0], 45.0),
        ] {
            assert_eq!(
                survey(&[stokes], 0.0).darkest_deg(),
                Some(angle),
                "{stokes:?}"
            );
        }
        for stokes in [[1.0, 0.0, 0.0, 1.0], [0.0; 4]] {
            assert_eq!(survey(&[stokes], 0.0).darkest_deg(), None);
        }
        let opposed = [[1.0, 0.5, 0.0, 0.0], [1.0, -0.5, 0.0, 0.0]];
        assert_eq!(survey(&opposed, 0.0).darkest_deg(), None);
    }

    #[test]
    fn the_scale_of_degrees_is_round_and_clear_of_noise() {
        let pixel = [1.0, 0.03, 0.0, 0.0];
        // Darker than a hundredth of what is bright, and all noise.
        let dark = [1e-4, 0.0, 1e-3, 0.0];
        for (stokes, standard_error, end) in [
            (&[pixel][..], 0.0, 0.05),
            (&[pixel], 0.02, 0.1),
            (&[pixel], f64::NAN, 0.05),
            (&[pixel, dark], 0.0, 0.05),
            (&[[1.0, 3.0, 0.0, 0.0]], 0.0, 1.0),
            (&[[0.0; 4]], 0.0, 0.01),
        ] {
            let found = survey(stokes, standard_error).dolp_end;
            assert!((found - end).abs() < 1e-15, "{stokes:?}: {found}");
        }
    }
}
