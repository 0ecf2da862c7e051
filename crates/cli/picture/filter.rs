//! What linear polarising filters and the eye make of a Stokes vector.

/// An ideal linear polarising filter before every pixel, square to the line of sight.
///
/// In a picture **d** points from the scene to the viewer and **x** to the right. With **u** upwards, the triple (right, up,
/// towards the viewer) is right-handed, so **y** = **d** × **x** = (**x** × **u**) × **x** = **u**: y points up.
/// A transmission axis turned by φ counter-clockwise, as the viewer sees it, is therefore **x** cos φ + **y** sin φ, a turn
/// anticlockwise as seen looking into the beam: φ > 0 of the rotator (eq. 3). The filter passes half of S0 and half of the
/// turned S1:
///
/// ```text
/// transmitted = ½ (S0 + S1 cos 2φ + S2 sin 2φ)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    cos2: f64,
    sin2: f64,
}

impl Filter {
    /// The filter whose transmission axis stands at `angle_deg`, counter-clockwise from the picture's right.
    ///
    /// Exact at multiples of 45°: a filter that should be dark there is dark to the last bit.
    pub fn at(angle_deg: f64) -> Self {
        let twice = (2.0 * angle_deg) % 360.0;
        let quarters = (twice / 90.0).round();
        let rest = (twice - 90.0 * quarters).to_radians();
        let (sin, cos) = (libm::sin(rest), libm::cos(rest));
        let (sin2, cos2) = match (quarters as i32).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        };
        Self { cos2, sin2 }
    }

    /// Radiance that passes, in the unit of the Stokes vector.
    ///
    /// Below 0 where the noise of an estimate makes S1 and S2 larger than S0: cut off there, it would be biased.
    pub fn transmitted(&self, [s0, s1, s2, _]: [f64; 4]) -> f64 {
        0.5 * (s0 + s1 * self.cos2 + s2 * self.sin2)
    }
}

/// Length of the linear part, √(S1² + S2²), in the unit of the Stokes vector.
pub fn linear([_, s1, s2, _]: [f64; 4]) -> f64 {
    libm::hypot(s1, s2)
}

/// Degree of linear polarisation √(S1² + S2²)/S0; 0 without light, and noise can lift it above 1.
pub fn dolp(stokes: [f64; 4]) -> f64 {
    if stokes[0] > 0.0 {
        linear(stokes) / stokes[0]
    } else {
        0.0
    }
}

/// Angle of linear polarisation in degrees, 0 … 180, counter-clockwise from the picture's right; 0 where there is none.
pub fn aolp_deg([_, s1, s2, _]: [f64; 4]) -> f64 {
    let angle = 0.5 * libm::atan2(s2, s1).to_degrees();
    if angle < 0.0 { angle + 180.0 } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use malus_optics::{Basis, Carried, Rotator, Sensor, Stokes};

    const RIGHT: [f64; 4] = [1.0, 1.0, 0.0, 0.0];
    const UP: [f64; 4] = [1.0, -1.0, 0.0, 0.0];
    const RISING: [f64; 4] = [1.0, 0.0, 1.0, 0.0];
    const FALLING: [f64; 4] = [1.0, 0.0, -1.0, 0.0];
    const CLOCKWISE: [f64; 4] = [1.0, 0.0, 0.0, 1.0];
    const ANTICLOCKWISE: [f64; 4] = [1.0, 0.0, 0.0, -1.0];

    /// What makes numbers equal to the last bit; the sum makes 0 of −0.
    fn bits<const N: usize>(values: [f64; N]) -> [u64; N] {
        values.map(|value| (value + 0.0).to_bits())
    }

    /// Shares of the six states that pass filters at 0°, 45°, 90° and 135°: exact, by the definition of each state.
    #[test]
    fn the_six_pure_states_pass_as_they_are_defined() {
        for (state, shares) in [
            (RIGHT, [1.0, 0.5, 0.0, 0.5]),
            (UP, [0.0, 0.5, 1.0, 0.5]),
            (RISING, [0.5, 1.0, 0.5, 0.0]),
            (FALLING, [0.5, 0.0, 0.5, 1.0]),
            (CLOCKWISE, [0.5; 4]),
            (ANTICLOCKWISE, [0.5; 4]),
        ] {
            let passed = [0.0, 45.0, 90.0, 135.0].map(|at| Filter::at(at).transmitted(state));
            assert_eq!(bits(passed), bits(shares), "{state:?}");
            let half_a_turn = [-180.0, 225.0, 270.0, -45.0];
            let passed = half_a_turn.map(|at| Filter::at(at).transmitted(state));
            assert_eq!(bits(passed), bits(shares), "{state:?}");
        }
    }

    /// The law of Malus, cos² of the angle between the filter and the field.
    #[test]
    fn light_along_the_right_obeys_the_law_of_malus() {
        for angle in (-360..=360).step_by(7).map(f64::from) {
            let expected = angle.to_radians().cos().powi(2);
            let passed = Filter::at(angle).transmitted(RIGHT);
            assert!((passed - expected).abs() < 1e-15, "{angle}°: {passed}");
        }
    }

    #[test]
    fn two_crossed_filters_share_all_light() {
        let light = [3.0, 0.7, -1.1, 2.0];
        for angle in [0.0, 12.5, 77.0, -33.0] {
            let [one, other] = [angle, angle + 90.0].map(|at| Filter::at(at).transmitted(light));
            assert!((one + other - 3.0).abs() < 1e-15);
        }
    }

    /// The sign of S2 from the geometry of a camera alone: a field along right + up, by the conventions of `Basis` and
    /// `Rotator`, is what a filter at +45° lets through and a filter at −45° holds back.
    #[test]
    fn a_field_along_right_and_up_is_brightest_at_plus_45_degrees() {
        // A camera on its side that looks along (1, 2, −1), whatever its position.
        let forward = DVec3::new(1.0, 2.0, -1.0).normalize();
        let right = forward.cross(DVec3::new(0.3, 0.1, 1.0)).normalize();
        let up = right.cross(forward);
        let towards_the_viewer = -forward;
        for (field, angle) in [
            (right, 0.0),
            (right + up, 45.0),
            (up, 90.0),
            (right - up, -45.0),
            (right * 0.5 + up * 0.75_f64.sqrt(), 60.0),
        ] {
            let along_the_field = Basis::<Carried>::new(towards_the_viewer, field);
            let pixel = Basis::<Sensor>::new(towards_the_viewer, right);
            let light = Stokes::<4, Carried>::of_state([1.0, 1.0, 0.0, 0.0]);
            let seen = (Rotator::new(&along_the_field, &pixel) * light).padded();
            assert!((Filter::at(angle).transmitted(seen) - 1.0).abs() < 1e-15);
            assert!(Filter::at(angle + 90.0).transmitted(seen).abs() < 1e-15);
            let off = (aolp_deg(seen) - angle).rem_euclid(180.0);
            assert!(off.min(180.0 - off) < 1e-12, "{angle}°: {seen:?}");
        }
    }

    #[test]
    fn angles_of_polarisation_run_from_0_to_180_degrees() {
        let angles = [RIGHT, RISING, UP, FALLING, CLOCKWISE].map(aolp_deg);
        assert_eq!(bits(angles), bits([0.0, 45.0, 90.0, 135.0, 0.0]));
    }

    #[test]
    fn degrees_of_polarisation_need_light() {
        let degrees = [[2.0, 0.6, -0.8, 1.0], CLOCKWISE, [0.0; 4]].map(dolp);
        assert_eq!(bits(degrees), bits([0.5, 0.0, 0.0]));
    }
}
