//! An independent check of every sign: the electric field itself, as a complex vector in space.
//!
//! E(t) = Re(**E** exp(−iωt)). Stokes components are taken by their definition, and reflection by
//! the textbook's amplitude coefficients; nothing here uses the formulae under test.

use glam::DVec3;
use proptest::prelude::*;

use crate::{
    Basis, Carried, Incidence, Index, Rotator, Sensor, Stokes, angle_of_incidence,
    basis::tests::unit_vector, complex::Complex,
};

/// A plane wave: its direction and the real and imaginary parts of its amplitude.
#[derive(Clone, Copy)]
struct Field {
    direction: DVec3,
    re: DVec3,
    im: DVec3,
}

impl Field {
    fn along(self, axis: DVec3) -> Complex {
        Complex {
            re: self.re.dot(axis),
            im: self.im.dot(axis),
        }
    }

    /// I = |Ex|² + |Ey|², Q = |Ex|² − |Ey|², U = 2 Re(Ex Ey*), V = 2 Im(Ex Ey*).
    fn stokes(self, axis: DVec3) -> [f64; 4] {
        let (x, y) = (self.along(axis), self.along(self.direction.cross(axis)));
        let (xx, yy, xy) = (
            (x * x.conjugate()).re,
            (y * y.conjugate()).re,
            x * y.conjugate(),
        );
        [xx + yy, xx - yy, 2.0 * xy.re, 2.0 * xy.im]
    }

    /// Reflected by the textbook: r_s = (μ − q)/(μ + q), r_p = (n²μ − q)/(n²μ + q), with
    /// **p** = **d** × **s** before and after.
    fn reflected(self, normal: DVec3, n: Complex) -> Self {
        let normal = if normal.dot(self.direction) > 0.0 {
            -normal
        } else {
            normal
        };
        let s = self.direction.cross(normal).normalize();
        let mu = Complex::real(-self.direction.dot(normal));
        let n2 = n * n;
        let q = (n2 - Complex::real(1.0) + mu * mu).root();
        let direction = self.direction - 2.0 * self.direction.dot(normal) * normal;
        let along_s = (mu - q) / (mu + q) * self.along(s);
        let along_p = (n2 * mu - q) / (n2 * mu + q) * self.along(self.direction.cross(s));
        let p = direction.cross(s);
        Self {
            direction,
            re: along_s.re * s + along_p.re * p,
            im: along_s.im * s + along_p.im * p,
        }
    }

    /// The field at the phase ωt.
    fn at(self, phase: f64) -> DVec3 {
        phase.cos() * self.re + phase.sin() * self.im
    }
}

/// Positive where an observer who looks into the beam sees the field turn clockwise.
fn clockwise(field: Field) -> f64 {
    // Seen against d, anticlockwise is the right-handed turn about d.
    -field.at(0.0).cross(field.at(0.1)).dot(field.direction)
}

#[test]
fn v_is_positive_where_an_observer_who_looks_into_the_beam_sees_it_turn_clockwise() {
    let field = Field {
        direction: DVec3::Z,
        re: DVec3::X,
        im: DVec3::NEG_Y,
    };
    // At ωt = 0 along X, a little later towards −Y: clockwise for who sees X right and Y up.
    assert!(field.at(0.1).y < 0.0 && clockwise(field) > 0.0);
    assert!(field.stokes(DVec3::X)[3] > 0.0);
}

#[test]
fn light_at_45_degrees_leaves_gold_turning_clockwise_seen_into_the_beam() {
    let direction = DVec3::new(1.0, 0.0, -1.0).normalize();
    let (incidence, emergence) = Basis::<Incidence>::mirror(direction, DVec3::Z);
    let diagonal = incidence.axis() + direction.cross(incidence.axis());
    let field = Field {
        direction,
        re: diagonal,
        im: DVec3::ZERO,
    };
    assert!(field.stokes(incidence.axis())[2] > 0.0);

    let reflected = field.reflected(
        DVec3::Z,
        Complex {
            re: 0.183,
            im: 3.43,
        },
    );
    assert!(clockwise(reflected) > 0.0 && reflected.stokes(emergence.axis())[3] > 0.0);
    let gold = Index::new(0.183, 3.43).reflection(0.5f64.sqrt(), 0.5);
    let light = gold * Stokes::<4, Incidence>::of_state(field.stokes(incidence.axis()));
    assert!(light.components()[3] > 0.0);
}

/// The light of `field`, by way of `reflections` and of Stokes vectors, in the sensor's `axis`.
fn by_stokes(field: Field, surfaces: &[(DVec3, f64, f64)], start: DVec3, axis: DVec3) -> [f64; 4] {
    let mut basis = Basis::<Carried>::new(field.direction, start);
    let mut light = Stokes::<4, Carried>::of_state(field.stokes(basis.axis()));
    for &(normal, n, k) in surfaces {
        let (incidence, emergence) = Basis::<Incidence>::mirror(basis.direction(), normal);
        let (cos, sin2) = angle_of_incidence(basis.direction(), normal);
        light = (Index::new(n, k).reflection(cos, sin2)
            * (Rotator::new(&basis, &incidence) * light))
            .carried();
        basis = emergence.carried();
    }
    (Rotator::new(&basis, &Basis::<Sensor>::new(basis.direction(), axis)) * light).components()
}

fn assert_chain_agrees(direction: DVec3, vectors: [DVec3; 4], surfaces: &[(DVec3, f64, f64)]) {
    let [re, im, start, axis] = vectors;
    let across = |vector: DVec3| vector - vector.dot(direction) * direction;
    let field = Field {
        direction,
        re: across(re),
        im: across(im),
    };
    let reflected = surfaces.iter().fold(field, |field, &(normal, n, k)| {
        field.reflected(normal, Complex { re: n, im: k })
    });
    let expected = reflected.stokes(Basis::<Sensor>::new(reflected.direction, axis).axis());
    let actual = by_stokes(field, surfaces, start, axis);
    for (a, e) in actual.into_iter().zip(expected) {
        // The direct amplitudes lose up to 1/|sin θ| digits of the plane of incidence, and the root of
        // a square next to the critical angle half of them.
        assert!((a - e).abs() < 1e-9, "{actual:?} is not {expected:?}");
    }
}

proptest! {
    #[test]
    fn stokes_vectors_follow_the_field_through_metals(
        direction in unit_vector(),
        vectors in [unit_vector(), unit_vector(), unit_vector(), unit_vector()],
        surfaces in prop::collection::vec((unit_vector(), 0.05..5.0, 0.0..5.0), 1..5)
    ) {
        assert_chain_agrees(direction, vectors, &surfaces);
    }

    #[test]
    fn stokes_vectors_follow_the_field_through_dielectrics_and_total_reflection(
        direction in unit_vector(),
        vectors in [unit_vector(), unit_vector(), unit_vector(), unit_vector()],
        surfaces in prop::collection::vec((unit_vector(), 0.3..3.0, Just(0.0)), 1..5)
    ) {
        assert_chain_agrees(direction, vectors, &surfaces);
    }
}
