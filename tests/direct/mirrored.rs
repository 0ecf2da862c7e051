//! Counted light that mirrors have sent on, and its state of polarisation.

use super::readings_of;
use crate::experiment::{assert_estimate, s0};
use std::f64::consts::PI;

/// The same planes with a Fresnel fraction, as a box with ideal mirrors for side walls: flux on plane 1/(2π I0) without
/// and with polarisation. One cell as large as the floor has no bias at all; in a wide box few walks go from wall to wall for
/// long.
#[test]
fn mirrored_planes_have_their_flux_with_and_without_polarisation() {
    let table = [
        (1.5, 0.6, 1.497_205_45, 1.506_296_41, 2e-3, 0.06),
        (1.5, 0.9, 1.516_864_96, 1.551_665_49, 2e-3, 0.06),
        (3.0, 0.9, 1.719_757_70, 2.002_682_83, 2e-3, 0.03),
    ];
    for (n, f, scalar, polarised, ceiling, apart) in table {
        let toml = format!(
            "[[shape]]
            kind = 'box'
            min = [0, 0, 0]
            max = [20, 20, 1]
            inward = true
            material = 'mirror'
            [[shape]]
            kind = 'rectangle'
            origin = [0, 0, 0]
            u = [20, 0, 0]
            v = [0, 20, 0]
            material = 'plane'
            [[shape]]
            kind = 'rectangle'
            origin = [0, 0, 1]
            u = [0, 20, 0]
            v = [20, 0, 0]
            material = 'plane'
            [material.mirror]
            rho = 0
            a = 1
            n = inf
            [material.plane]
            rho = 0.5
            a = {f}
            n = {n}
            [[source]]
            kind = 'point'
            position = [4, 11, 0.5]
            intensity = 1
            [[sensor]]
            name = 'floor'
            points = [[10, 10, 0]]
            normal = [0, 0, 1]"
        );
        let reading = readings_of(&toml, 20.0, 524_288)[0];
        let flux = 2.0 * PI / 400.0;
        let per = |(value, error): (f64, f64)| (value / flux, error / flux);
        assert_estimate("polarised", per(s0(&reading)), polarised, ceiling);
        let paired = reading.scalar.unwrap();
        assert_estimate(
            "scalar",
            per((paired.value, paired.standard_error)),
            scalar,
            ceiling,
        );
        let difference = per((paired.difference, paired.difference_standard_error));
        assert_estimate("difference", difference, polarised - scalar, apart);
    }
}

/// Parallel light is the same over any cell: cos θ times its state in the sensor's basis, which takes no chance by the
/// other estimators.
#[test]
fn straight_polarised_light_arrives_in_its_state() {
    for frame in ["incidence", "fixed"] {
        let toml = format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [-1, -1, 0]
            u = [2, 0, 0]
            v = [0, 2, 0]
            material = 'black'
            [material.black]
            rho = 0
            [[source]]
            kind = 'distant'
            direction = [0.3, 0.5, -0.8]
            irradiance = 7
            stokes = [1, 0.6, -0.3, 0.5]
            axis = [1, 0.2, 0]
            [[sensor]]
            name = 'floor'
            points = [[0.1, 0.2, 0], [-0.2, 0.4, 0.3]]
            normal = [0, 0, 1]
            frame = '{frame}'
            axis = [0.2, 1, 0]
            [run]
            estimator = 'gather'
            representation = 'full'
            samples = 64"
        );
        let exact = crate::experiment::measured(&toml);
        for (reading, exact) in readings_of(&toml, 0.5, 1_048_576).iter().zip(&exact) {
            for i in 0..4 {
                let estimate = (reading.stokes[i], reading.standard_error[i]);
                assert_estimate(&format!("{frame}, S{i}"), estimate, exact.stokes[i], 2e-2);
            }
        }
    }
}

/// Parallel light mirrored by glass at 45° onto a cell across it, which no local estimate and no look at the source finds:
/// Rs = 0.09201336, Rp = Rs², degree of polarisation 0.83147942.
#[test]
fn light_off_a_mirror_is_counted_in_its_state() {
    let toml = "
        [[shape]]
        kind = 'rectangle'
        origin = [-1, -1, 0]
        u = [2, 0, 0]
        v = [0, 2, 0]
        material = 'glass'
        [material.glass]
        rho = 0
        a = 1
        n = 1.5
        [[source]]
        kind = 'distant'
        direction = [1, 0, -1]
        irradiance = 10
        [[sensor]]
        name = 'across'
        points = [[0, 0, 0.5]]
        normal = [-1, 0, -1]
        frame = 'fixed'
        axis = [0, 1, 0]";
    let reading = readings_of(toml, 0.4, 1_048_576)[0];
    let (rs, rp) = (0.092_013_36, 0.008_466_46);
    // 1 walk in 430 is mirrored (with the probability Rs) and counted.
    assert_estimate("S0", s0(&reading), 5.0 * (rs + rp), 2e-2);
    let s1 = (reading.stokes[1], reading.standard_error[1]);
    assert_estimate("S1", s1, 5.0 * (rs - rp), 2e-2);
    assert!(
        (reading.dolp - 0.831_479_42).abs() < 1e-6,
        "{}",
        reading.dolp
    );
}
