//! Directions as functions of uniform numbers.

use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Sine and cosine of a share of a full turn, 0 … 1: within an eighth of one, where neither needs a reduction, and turned
/// by quarters.
fn turned(turn: f64) -> (f64, f64) {
    let quarters = (4.0 * turn + 0.5) as i32;
    let (sin, cos) = libm::sincos(FRAC_PI_2 * (4.0 * turn - f64::from(quarters)));
    match quarters & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// A unit vector about `axis` at the given cosine and azimuth (a share of a full turn).
fn about(axis: DVec3, cos: f64, sin: f64, turn: f64) -> DVec3 {
    let (sin_azimuth, cos_azimuth) = turned(turn);
    let (x, y) = axis.any_orthonormal_pair();
    x * (sin * cos_azimuth) + y * (sin * sin_azimuth) + axis * cos
}

/// Direction with density cos θ/π about the unit vector `axis`.
#[must_use]
pub(crate) fn cosine_weighted(axis: DVec3, [u, v]: [f64; 2]) -> DVec3 {
    // 1 − u lies in (0, 1]: the cosine is never zero.
    about(axis, (1.0 - u).sqrt(), u.sqrt(), v)
}

/// Direction with uniform density 1/(2π(1 − cos_edge)) in the cone about `axis`; cos_edge = −1 is the sphere.
#[must_use]
pub(crate) fn in_cone(axis: DVec3, cos_edge: f64, [u, v]: [f64; 2]) -> DVec3 {
    let rise = u * (1.0 - cos_edge);
    // sin² θ = (1 − cos θ)(1 + cos θ), without the cancellation of 1 − cos².
    about(axis, 1.0 - rise, (rise * (2.0 - rise)).max(0.0).sqrt(), v)
}

/// Point with uniform density on the disc of the given radius about `centre`, across `axis`.
#[must_use]
pub(crate) fn on_disc(centre: DVec3, axis: DVec3, radius: f64, [u, v]: [f64; 2]) -> DVec3 {
    let (sin_azimuth, cos_azimuth) = turned(v);
    let (x, y) = axis.any_orthonormal_pair();
    centre + (x * cos_azimuth + y * sin_azimuth) * (radius * u.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Means of cos θ and cos² θ over a midpoint lattice of `n` × `n` uniforms.
    fn moments(direction: impl Fn([f64; 2]) -> DVec3, axis: DVec3) -> [f64; 2] {
        let n = 400;
        let mut sums = [0.0; 2];
        for i in 0..n {
            for j in 0..n {
                let at = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
                let d = direction([at(i), at(j)]);
                assert!((d.length() - 1.0).abs() < 1e-14);
                let cos = d.dot(axis);
                sums[0] += cos;
                sums[1] += cos * cos;
            }
        }
        sums.map(|s| s / f64::from(n * n))
    }

    #[test]
    fn sine_and_cosine_go_around() {
        for step in 0..=1024 {
            let turn = f64::from(step) / 1024.0;
            let (sin, cos) = turned(turn);
            let expected = libm::sincos(TAU * turn);
            assert!((sin - expected.0).abs() < 1e-15 && (cos - expected.1).abs() < 1e-15);
        }
    }

    #[test]
    fn cosine_weighted_directions_have_the_moments_of_lambert() {
        // ∫ cos · cos/π dω = 2/3, ∫ cos² · cos/π dω = 1/2; the midpoint rule in √ converges as n^−3/2.
        let axis = DVec3::new(0.36, -0.48, 0.8);
        let [first, second] = moments(|u| cosine_weighted(axis, u), axis);
        assert!((first - 2.0 / 3.0).abs() < 2e-5 && (second - 0.5).abs() < 1e-12);
    }

    #[test]
    fn cone_directions_are_uniform_in_the_cosine() {
        // Cosine uniform on [c, 1]: mean (1 + c)/2, mean square (1 + c + c²)/3.
        let axis = DVec3::NEG_Z;
        for edge in [-1.0, 0.5, 0.999] {
            let [first, second] = moments(|u| in_cone(axis, edge, u), axis);
            assert!((first - (1.0 + edge) / 2.0).abs() < 1e-12);
            assert!((second - (1.0 + edge + edge * edge) / 3.0).abs() < 1e-5);
        }
    }

    #[test]
    fn disc_points_lie_across_the_axis_within_the_radius() {
        let (centre, axis) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.6, 0.0, 0.8));
        for i in 0..100 {
            let u = f64::from(i) / 100.0;
            let p = on_disc(centre, axis, 2.0, [u, u * 7.0 % 1.0]) - centre;
            assert!(p.dot(axis).abs() < 1e-14);
            assert!((p.length() - 2.0 * u.sqrt()).abs() < 1e-14);
        }
    }
}
