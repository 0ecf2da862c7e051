//! A thousand reflections in all directions.

use glam::DVec3;

use super::{Chain, Surface, extremes::reflectors};
use crate::{
    Basis, Emergence, Incidence, Index, Material, Mueller, Rotator, Sensor, Stokes,
    angle_of_incidence, coherency,
};

/// Directions that look random and are the same on every machine: a linear congruence, rejected
/// outside the unit ball.
struct Directions(u64);

impl Directions {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from((self.0 >> 33) as u32) / f64::from(1u32 << 30) - 1.0
    }
}

impl Iterator for Directions {
    type Item = DVec3;

    fn next(&mut self) -> Option<DVec3> {
        loop {
            let point = DVec3::new(self.uniform(), self.uniform(), self.uniform());
            if (0.01..1.0).contains(&point.length_squared()) {
                return Some(point.normalize());
            }
        }
    }
}

type Matrix = Mueller<4, Sensor, Sensor>;

/// A thousand reflections in all directions, each with the rotator before it, and scaled so that M00
/// of all up to it is 1: a thousand dielectrics leave less than f64 can tell from zero. Where they
/// leave nothing, the rest is not followed.
fn a_thousand_of(material: Material) -> Vec<Matrix> {
    let mut basis = Basis::new(DVec3::Z, DVec3::X);
    let mut product = Matrix::identity();
    let mut steps = Vec::new();
    for normal in Directions(1).take(1000) {
        let (incidence, emergence) = Basis::<Incidence>::mirror(basis.direction(), normal);
        let (cos, sin2) = angle_of_incidence(basis.direction(), normal);
        let rotator = Rotator::new(&basis, &incidence);
        let reflection =
            Mueller::<4, Emergence, Emergence>::identity() * material.mirror(cos, sin2);
        let step = Matrix::new((reflection * rotator).rows());
        let m00 = (step * product).rows()[0][0];
        if m00 < 1e-200 {
            break;
        }
        steps.push(step * (1.0 / m00));
        product = steps[steps.len() - 1] * product;
        basis = emergence.carried();
    }
    steps
}

#[test]
fn a_thousand_reflections_stay_physical() {
    for material in reflectors() {
        let mut product = Matrix::identity();
        let steps = a_thousand_of(material);
        assert!(steps.len() == 1000 || material.mirror(0.7, 0.51).mean() < 1e-199);
        for (count, &step) in steps.iter().enumerate() {
            product = step * product;
            // An earlier step left a rounding error of some 4·10⁻¹⁵ of M00 = 1 then (axes are unit
            // vectors to 10⁻¹⁵, and enter cos 2φ four times), and the later ones pass it on by at most
            // their own M00. That is more than 1 next to extinction, as by crossed polarisers, where
            // the greatest eigenvalue shrinks and an old rounding error does not.
            if count % 50 == 49 {
                let mut passed_on = Matrix::identity();
                let mut rounding = 0.0;
                for &later in steps[..=count].iter().rev() {
                    rounding += 4e-15 * passed_on.rows()[0][0];
                    passed_on = passed_on * later;
                }
                let [least, .., greatest] = coherency::eigenvalues(&product.rows());
                assert!(
                    least >= -rounding * greatest,
                    "{least:e} of {material:?}, {rounding:e}"
                );
            }
        }
    }
}

#[test]
fn a_thousand_reflections_far_from_extinction_leave_no_negative_eigenvalue() {
    // No Brewster's angle that a beam would meet: −10⁻¹² of the greatest holds after each reflection.
    for (n, k) in [(f64::INFINITY, 0.0), (1e-3, 0.0), (0.183, 3.43), (1e3, 1e3)] {
        let material = Surface::mirror(DVec3::Z, Index::new(n, k)).material;
        let mut product = Matrix::identity();
        for step in a_thousand_of(material) {
            product = step * product;
            assert!(coherency::is_physical(&product.rows()), "{n}, {k}");
        }
    }
}

#[test]
fn light_that_fades_out_over_a_thousand_reflections_stays_a_number() {
    let normals: Vec<DVec3> = Directions(2).take(1000).collect();
    for material in reflectors() {
        let surfaces: Vec<_> = normals
            .iter()
            .map(|&normal| Surface {
                normal,
                material,
                through: false,
            })
            .collect();
        let chain = Chain::new(Basis::new(DVec3::Z, DVec3::X), &surfaces, DVec3::X);
        let light = chain.followed(Stokes::<4, _>::new([1.0, 0.6, 0.0, 0.8]));
        assert!(
            light.components().iter().all(|it| it.is_finite()),
            "{material:?}"
        );
        assert!((0.0..=1.0 + 1e-12).contains(&light.i()));
    }
}
