//! Chains against polarisation ray tracing: the field in the axes of space, taken from one end of a
//! chain to the other by one complex 3 × 3 matrix, without any basis of a beam on the way.
//!
//! G. Yun, K. Crabtree, R. A. Chipman, *Three-dimensional polarization ray-tracing calculus I*,
//! Applied Optics 50 (2011) 2855. Nothing here uses the formulae under test.

use glam::DVec3;
use proptest::prelude::*;

use super::{Chain, Surface};
use crate::{Basis, Index, basis::tests::unit_vector, complex::Complex};

type Matrix = [[Complex; 3]; 3];

/// Σ r_k **after**_k **before**_kᵀ.
fn sum_of_dyads(dyads: [(Complex, DVec3, DVec3); 3]) -> Matrix {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            dyads
                .iter()
                .fold(Complex::real(0.0), |sum, &(factor, after, before)| {
                    sum + factor * Complex::real(after[row] * before[column])
                })
        })
    })
}

fn product(left: &Matrix, right: &Matrix) -> Matrix {
    left.map(|row| {
        std::array::from_fn(|column| {
            (0..3).fold(Complex::real(0.0), |sum, k| sum + row[k] * right[k][column])
        })
    })
}

/// The direction after a reflection and its matrix P = r_s **s s**ᵀ + r_p **p**′**p**ᵀ + **d**′**d**ᵀ,
/// with the textbook's amplitudes r_s = (cos θ − n cos θ′)/(cos θ + n cos θ′),
/// r_p = (n cos θ − cos θ′)/(n cos θ + cos θ′) for **p** = **d** × **s**, cos θ′ by Snell's law.
fn reflected(direction: DVec3, normal: DVec3, index: Index) -> (DVec3, Matrix) {
    let facing = if normal.dot(direction) > 0.0 {
        -normal
    } else {
        normal
    };
    let after = direction - 2.0 * direction.dot(facing) * facing;
    let s = direction.cross(facing).normalize();
    let one = Complex::real(1.0);
    let (r_s, r_p) = match index {
        // A perfect conductor: no field along the surface.
        Index::Mirror => (Complex::real(-1.0), one),
        Index::Relative { n, k } => {
            let n = Complex { re: n, im: k };
            let cos = Complex::real(-direction.dot(facing));
            let sin = Complex::real(direction.cross(facing).length()) / n;
            // n cos θ′ has Im > 0: the wave inside decays.
            let inside = ((one - sin * sin) * n * n).root() / n;
            (
                (cos - n * inside) / (cos + n * inside),
                (n * cos - inside) / (n * cos + inside),
            )
        }
    };
    let matrix = sum_of_dyads([
        (r_s, s, s),
        (r_p, after.cross(s), direction.cross(s)),
        (one, after, direction),
    ]);
    (after, matrix)
}

/// I, Q, U, V of the field **E** exp(−iωt) by their definition, **x** being `axis` made perpendicular to
/// the direction.
fn stokes(field: [Complex; 3], direction: DVec3, axis: DVec3) -> [f64; 4] {
    let x = (axis - axis.dot(direction) * direction).normalize();
    let along = |axis: DVec3| {
        (0..3).fold(Complex::real(0.0), |sum, k| {
            sum + field[k] * Complex::real(axis[k])
        })
    };
    let (x, y) = (along(x), along(direction.cross(x)));
    let (xx, yy, xy) = (
        (x * x.conjugate()).re,
        (y * y.conjugate()).re,
        x * y.conjugate(),
    );
    [xx + yy, xx - yy, 2.0 * xy.re, 2.0 * xy.im]
}

/// Dielectrics, total reflection, metals and ideal mirrors, away from n = 1, next to which the
/// textbook's amplitudes are differences of nearly equal numbers.
fn index() -> impl Strategy<Value = Index> {
    prop_oneof![
        (1.1..5.0).prop_map(|n| Index::new(n, 0.0)),
        (0.3..0.9).prop_map(|n| Index::new(n, 0.0)),
        (0.05..5.0, 0.05..8.0).prop_map(|(n, k)| Index::new(n, k)),
        Just(Index::Mirror),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// All four components agree to 10⁻¹² of the most that any state keeps of its I on this chain, the
    /// product of max(Rs, Rp). Relative to the I that does arrive no bound can hold: next to
    /// extinction, crossed planes at Brewster's angle, it is the rounding of much greater numbers.
    #[test]
    fn all_components_are_those_of_the_traced_field(
        direction in unit_vector(), axes in [unit_vector(), unit_vector()], re in unit_vector(), im in unit_vector(),
        mirrors in prop::collection::vec((unit_vector(), index()), 1..7)
    ) {
        let across = |vector: DVec3| vector - vector.dot(direction) * direction;
        let (re, im) = (across(re), across(im));
        let scale = (re.length_squared() + im.length_squared()).sqrt();
        let field: [Complex; 3] = std::array::from_fn(|k| Complex { re: re[k] / scale, im: im[k] / scale });

        let one = Complex::real(1.0);
        let mut traced = sum_of_dyads([(one, DVec3::X, DVec3::X), (one, DVec3::Y, DVec3::Y), (one, DVec3::Z, DVec3::Z)]);
        let mut last = direction;
        for &(normal, index) in &mirrors {
            let (after, matrix) = reflected(last, normal, index);
            (last, traced) = (after, product(&matrix, &traced));
        }
        let arriving = traced.map(|row| (0..3).fold(Complex::real(0.0), |sum, k| sum + row[k] * field[k]));
        let expected = stokes(arriving, last, axes[1]);

        let surfaces: Vec<_> = mirrors.iter().map(|&(normal, index)| Surface::mirror(normal, index)).collect();
        let chain = Chain::new(Basis::new(direction, axes[0]), &surfaces, axes[1]);
        let light = crate::Stokes::<4, _>::new(stokes(field, direction, axes[0]));
        let matrix = chain.matrix::<4>();
        for actual in [chain.followed(light), matrix * light] {
            for (a, e) in actual.components().into_iter().zip(expected) {
                prop_assert!((a - e).abs() <= 1e-12 * chain.bound(), "{actual:?} is not {expected:?}");
            }
        }
    }
}
