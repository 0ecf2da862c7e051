//! Stokes vectors through the whole engine against electric fields followed by hand.

use crate::experiment::{assert_estimate, assert_exact, measured};
use glam::DVec3;
use malus_estimator::Reading;

/// Complex numbers as pairs: only what a field needs.
type Complex = (f64, f64);

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn over(a: Complex, b: Complex) -> Complex {
    let square = b.0 * b.0 + b.1 * b.1;
    times(a, (b.0 / square, -b.1 / square))
}

fn root(a: Complex) -> Complex {
    let modulus = a.0.hypot(a.1);
    let (re, im) = (
        ((modulus + a.0) / 2.0).sqrt(),
        ((modulus - a.0) / 2.0).sqrt(),
    );
    (re, if a.1 < 0.0 { -im } else { im })
}

/// r_s and r_p (Verdet signs) of the textbook, by the cosine of refraction.
fn amplitudes(index: Complex, cos: f64) -> (Complex, Complex) {
    let ratio = over(((1.0 - cos * cos).sqrt(), 0.0), index);
    let square = times(ratio, ratio);
    let inside = root((1.0 - square.0, -square.1));
    let (n_inside, n_cos) = (times(index, inside), times(index, (cos, 0.0)));
    let rs = over(
        (cos - n_inside.0, -n_inside.1),
        (cos + n_inside.0, n_inside.1),
    );
    let rp = over(
        (n_cos.0 - inside.0, n_cos.1 - inside.1),
        (n_cos.0 + inside.0, n_cos.1 + inside.1),
    );
    (rs, rp)
}

/// Stokes vector about x of a beam with the field (e_x, e_y): S1 > 0 along x, S2 > 0 along x + y.
fn stokes(x: Complex, y: Complex) -> [f64; 4] {
    let product = times(x, (y.0, -y.1));
    let (xx, yy) = (x.0 * x.0 + x.1 * x.1, y.0 * y.0 + y.1 * y.1);
    [xx + yy, xx - yy, 2.0 * product.0, 2.0 * product.1]
}

/// Fields whose incoherent sum has the state (1, q, u, v): one along the state, two orthogonal ones for the rest.
fn fields([_, q, u, v]: [f64; 4]) -> Vec<(f64, Complex, Complex)> {
    let degree = (q * q + u * u + v * v).sqrt();
    let (q, u, v) = (q / degree, u / degree, v / degree);
    let x = ((1.0 + q) / 2.0).sqrt();
    let rest = (1.0 - degree) / 2.0;
    // S2 + iS3 = 2 x y*.
    vec![
        (degree, (x, 0.0), (u / (2.0 * x), -v / (2.0 * x))),
        (rest, (1.0, 0.0), (0.0, 0.0)),
        (rest, (0.0, 0.0), (1.0, 0.0)),
    ]
}

fn axis_across(direction: DVec3, axis: DVec3) -> DVec3 {
    (axis - direction * direction.dot(axis)).normalize()
}

const STATE: [f64; 4] = [1.0, 0.3, -0.5, 0.4];
const LAMP_AXIS: DVec3 = DVec3::new(0.8, 0.6, 0.0);
const SENSOR: DVec3 = DVec3::new(-1.0, 0.4, 1.0);
const SENSOR_NORMAL: DVec3 = DVec3::new(0.36, 0.48, -0.8);
const FIXED_AXIS: DVec3 = DVec3::new(0.0, 1.0, 0.0);

/// Irradiance Stokes vector at the sensor from the lamp [0.5, 1.5] × [−0.5, 0.5] × {1}, facing down, M = 1, by way of a
/// mirror in z = 0: midpoint quadrature over the lamp's image, every beam followed as a field.
fn by_fields(index: Complex, fixed: bool) -> [f64; 4] {
    let cells = 200;
    let mut sum = [0.0; 4];
    for i in 0..cells {
        for j in 0..cells {
            let at = |k: i32| (f64::from(k) + 0.5) / f64::from(cells);
            let image = DVec3::new(0.5 + at(i), at(j) - 0.5, -1.0);
            let segment = SENSOR - image;
            let onward = segment.normalize();
            let cos_sensor = -onward.dot(SENSOR_NORMAL);
            if cos_sensor <= 0.0 {
                continue;
            }
            let down = DVec3::new(onward.x, onward.y, -onward.z);
            let irradiance = onward.z * cos_sensor
                / (std::f64::consts::PI * segment.length_squared() * f64::from(cells * cells));
            let (rs, rp) = amplitudes(index, onward.z);
            let s = down.cross(DVec3::Z).normalize();
            let (p_in, p_out) = (down.cross(s), onward.cross(s));
            let lamp_x = axis_across(down, LAMP_AXIS);
            let lamp_y = down.cross(lamp_x);
            let x = if fixed {
                axis_across(onward, FIXED_AXIS)
            } else {
                onward.cross(SENSOR_NORMAL).normalize()
            };
            let y = onward.cross(x);
            for (share, e_x, e_y) in fields(STATE) {
                let along = |axis: DVec3| {
                    (
                        e_x.0 * lamp_x.dot(axis) + e_y.0 * lamp_y.dot(axis),
                        e_x.1 * lamp_x.dot(axis) + e_y.1 * lamp_y.dot(axis),
                    )
                };
                let (e_s, e_p) = (times(rs, along(s)), times(rp, along(p_in)));
                let out = |axis: DVec3| {
                    (
                        e_s.0 * s.dot(axis) + e_p.0 * p_out.dot(axis),
                        e_s.1 * s.dot(axis) + e_p.1 * p_out.dot(axis),
                    )
                };
                for (total, component) in sum.iter_mut().zip(stokes(out(x), out(y))) {
                    *total += share * irradiance * component;
                }
            }
        }
    }
    sum
}

fn mirrored(n: f64, k: f64, frame: &str) -> Reading {
    measured(&format!(
        "[[shape]]
        kind = 'rectangle'
        origin = [-3, -3, 0]
        u = [6, 0, 0]
        v = [0, 6, 0]
        material = 'mirror'
        [material.mirror]
        rho = 0
        a = 1
        n = {n}
        k = {k}
        [[shape]]
        kind = 'rectangle'
        origin = [0.5, -0.5, 1]
        u = [0, 1, 0]
        v = [1, 0, 0]
        material = 'lamp'
        [material.lamp]
        rho = 0
        exitance = 1
        emission_stokes = {STATE:?}
        emission_axis = [0.8, 0.6, 0]
        [[sensor]]
        name = 'tilted'
        points = [[-1, 0.4, 1]]
        normal = [0.36, 0.48, -0.8]
        frame = '{frame}'
        axis = [0, 1, 0]
        [run]
        estimator = 'gather'
        representation = 'full'
        samples = 2097152"
    ))[0]
}

/// Gold, glass about Brewster's angle, and total reflection, in both frames: every component with its sign.
#[test]
fn a_polarised_lamp_in_a_mirror_is_what_its_fields_say() {
    for (n, k) in [(0.183, 3.43), (1.5, 0.0), (1.0 / 1.49661, 0.0)] {
        for frame in ["incidence", "fixed"] {
            let reading = mirrored(n, k, frame);
            let exact = by_fields((n, k), frame == "fixed");
            for i in 0..4 {
                let what = format!("n = {n}, k = {k}, {frame}, S{i}");
                let z = (reading.stokes[i] - exact[i]) / reading.standard_error[i];
                assert!(
                    z.abs() < 4.5,
                    "{what}: {} against {}: z = {z:.2}",
                    reading.stokes[i],
                    exact[i]
                );
                assert!(
                    reading.standard_error[i] < 0.015 * exact[0],
                    "{what}: {}",
                    reading.standard_error[i]
                );
            }
        }
    }
}

/// Straight from a point source nothing is left to chance: E = I cos θ/r², in the emitted state.
#[test]
fn a_beam_along_the_normal_arrives_in_the_state_it_left() {
    let reading = measured(
        "[[source]]
        kind = 'point'
        position = [0, 0, 2]
        intensity = 12
        stokes = [1, 0.5, -0.25, 0.125]
        axis = [1, 0, 0]
        [[sensor]]
        name = 'below'
        points = [[0, 0, 0]]
        normal = [0, 0, 1]
        [run]
        samples = 64",
    )[0];
    for (component, share) in reading.stokes.into_iter().zip([1.0, 0.5, -0.25, 0.125]) {
        assert_exact("component", component, 3.0 * share, 1e-15);
    }
    assert!(
        reading
            .standard_error
            .iter()
            .all(|&error| error.abs() == 0.0)
    );
    assert_exact("dolp", reading.dolp, 0.3125f64.sqrt(), 1e-15);
}

/// A polarised lamp overhead: nearly the same for every plane of incidence, plain to an analyser on the desk.
#[test]
fn a_polarised_lamp_overhead_shows_in_the_fixed_frame() {
    let overhead = |frame: &str| {
        measured(&format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [-1, -1, 1]
            u = [0, 2, 0]
            v = [2, 0, 0]
            material = 'lamp'
            [material.lamp]
            rho = 0
            exitance = 1
            emission_stokes = [1, 1, 0, 0]
            emission_axis = [1, 0, 0]
            [[sensor]]
            name = 'desk'
            points = [[0, 0, 0]]
            normal = [0, 0, 1]
            frame = '{frame}'
            [run]
            samples = 262144"
        ))[0]
    };
    // About d × N the lamp's axis, made perpendicular to a beam from (x, y, 1), has the components y and x cos θ up to
    // its length: S1/S0 = (y² − x² cos² θ)/(y² + x² cos² θ). Midpoint rule over the lamp.
    let (cells, mut exact) = (400, [0.0; 2]);
    for i in 0..cells * cells {
        let at = |k: i32| 2.0 * (f64::from(k) + 0.5) / f64::from(cells) - 1.0;
        let (x, y) = (at(i / cells), at(i % cells));
        let cos2 = 1.0 / (1.0 + x * x + y * y);
        let irradiance = cos2 * cos2 / std::f64::consts::PI * 4.0 / f64::from(cells * cells);
        exact[0] += irradiance;
        exact[1] += irradiance * (y * y - x * x * cos2) / (y * y + x * x * cos2);
    }
    let incidence = overhead("incidence");
    assert_estimate(
        "S0",
        (incidence.stokes[0], incidence.standard_error[0]),
        exact[0],
        2e-3,
    );
    assert_estimate(
        "S1",
        (incidence.stokes[1], incidence.standard_error[1]),
        exact[1],
        2e-2,
    );
    assert!(exact[1] < 0.1 * exact[0]);
    let fixed = overhead("fixed");
    // The same axis made perpendicular to the same beams at either end.
    assert_exact("fixed", fixed.stokes[1] / fixed.stokes[0], 1.0, 1e-11);
}
