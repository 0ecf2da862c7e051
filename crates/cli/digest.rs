//! One line for a sensor group: what its points have in common.

use malus_estimator::{Group, Paired, Reading};

/// What the free points of a sensor group have in common; in the unit of the readings.
#[derive(Clone, Debug, PartialEq)]
pub struct Digest {
    /// Points in all.
    pub count: usize,
    /// Points inside a closed solid, which take no part in anything below.
    pub enclosed: usize,
    /// What the free points measure; `None` where there is none.
    pub free: Option<Free>,
}

/// What the free points measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// Mean of S0.
    pub mean: f64,
    /// Standard error of the mean.
    pub mean_standard_error: f64,
    /// Least S0.
    pub min: f64,
    /// Greatest S0.
    pub max: f64,
    /// Uniformity min/mean; 0 where the mean is 0.
    pub u0: f64,
    /// Mean degree of linear polarisation.
    pub dolp_mean: f64,
    /// Largest se0 / max(S0, 10⁻³ · mean S0) of the group.
    pub relative_error_max: f64,
    /// The scalar model, where it was computed beside the main one.
    pub scalar: Option<Difference>,
    /// The diffuse model, likewise.
    pub diffuse: Option<Difference>,
}

/// Mean of the main model less another's, as a share of the other's mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Mean difference / mean of the other model.
    pub share: f64,
    /// Its paired standard error, as a share too.
    pub standard_error: f64,
}

impl Digest {
    /// The digest of one group.
    pub fn of(group: &Group) -> Self {
        let free: Vec<&Reading> = group.readings.iter().filter(|r| !r.enclosed).collect();
        Self {
            count: group.readings.len(),
            enclosed: group.readings.len() - free.len(),
            free: (!free.is_empty()).then(|| Free::of(group, &free)),
        }
    }
}

impl Free {
    fn of(group: &Group, free: &[&Reading]) -> Self {
        let s0 = || free.iter().map(|reading| reading.stokes[0]);
        let min = s0().fold(f64::INFINITY, f64::min);
        let mean = group.mean;
        let relative_error = |reading: &&Reading| {
            ratio(
                reading.standard_error[0],
                reading.stokes[0].max(1e-3 * mean),
            )
        };
        Self {
            mean,
            mean_standard_error: group.mean_standard_error,
            min,
            max: s0().fold(f64::NEG_INFINITY, f64::max),
            u0: ratio(min, mean),
            dolp_mean: average(free.iter().map(|reading| reading.dolp)),
            relative_error_max: free.iter().map(relative_error).fold(0.0, f64::max),
            scalar: group.scalar.map(Difference::of),
            diffuse: group.diffuse.map(Difference::of),
        }
    }
}

impl Difference {
    fn of(pair: Paired) -> Self {
        Self {
            share: ratio(pair.difference, pair.value),
            standard_error: ratio(pair.difference_standard_error, pair.value),
        }
    }
}

fn average(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    ratio(values.sum(), count)
}

/// a / b, or 0 where b is 0.
fn ratio(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use malus_estimator::Replicates;

    /// A reading of S0 = `s0` with an error of a hundredth and a degree of linear polarisation of a tenth.
    pub fn reading(s0: f64) -> Reading {
        Reading {
            enclosed: false,
            stokes: [s0, 0.1 * s0, 0.0, 0.0],
            standard_error: [0.01 * s0, 0.001, 0.002, 0.0],
            dolp: if s0 > 0.0 { 0.1 } else { 0.0 },
            dolp_standard_error: 0.003,
            scalar: None,
            diffuse: None,
        }
    }

    /// A reading inside a solid.
    pub fn enclosed() -> Reading {
        Reading {
            enclosed: true,
            stokes: [0.0; 4],
            standard_error: [0.0; 4],
            dolp: 0.0,
            dolp_standard_error: 0.0,
            scalar: None,
            diffuse: None,
        }
    }

    #[test]
    fn enclosed_points_take_no_part() {
        let group = Group {
            readings: vec![reading(2.0), enclosed(), reading(4.0)],
            mean: 3.0,
            mean_standard_error: 0.02,
            scalar: None,
            diffuse: None,
            replicates: Replicates::default(),
        };
        let digest = Digest::of(&group);
        assert_eq!((digest.count, digest.enclosed), (3, 1));
        let free = digest.free.expect("two free points");
        assert_eq!((free.min, free.max, free.u0), (2.0, 4.0, 2.0 / 3.0));
        assert!((free.dolp_mean - 0.1).abs() < 1e-15);
        assert!((free.relative_error_max - 0.01).abs() < 1e-15);
        assert_eq!(free.scalar, None);
    }

    #[test]
    fn a_dark_group_divides_by_nothing() {
        let group = Group {
            readings: vec![reading(0.0)],
            mean: 0.0,
            mean_standard_error: 0.0,
            scalar: None,
            diffuse: None,
            replicates: Replicates::default(),
        };
        let free = Digest::of(&group).free.expect("one free point");
        assert_eq!(
            (free.u0, free.dolp_mean, free.relative_error_max),
            (0.0, 0.0, 0.0)
        );
    }

    #[test]
    fn differences_are_shares_of_the_other_model() {
        let scalar = Paired {
            value: 1.0,
            standard_error: 0.01,
            difference: -0.03,
            difference_standard_error: 0.002,
        };
        let group = Group {
            readings: vec![reading(0.97)],
            mean: 0.97,
            mean_standard_error: 0.0,
            scalar: Some(scalar),
            diffuse: None,
            replicates: Replicates::default(),
        };
        let scalar = Digest::of(&group).free.and_then(|free| free.scalar);
        let scalar = scalar.expect("compared");
        assert!((scalar.share + 0.03).abs() < 1e-15);
        assert!((scalar.standard_error - 0.002).abs() < 1e-15);
    }

    #[test]
    fn a_group_inside_a_solid_has_no_digest() {
        let group = Group {
            readings: vec![enclosed()],
            mean: 0.0,
            mean_standard_error: 0.0,
            scalar: None,
            diffuse: None,
            replicates: Replicates::default(),
        };
        assert_eq!(Digest::of(&group).free, None);
    }
}
