//! Properties of whole chains of mirror reflections, followed from either end.

use glam::DVec3;
use proptest::prelude::*;

use crate::{
    Basis, Carried, Incidence, Index, Mueller, Rotator, Sensor, Stokes, angle_of_incidence,
    basis::tests::unit_vector,
};

/// A chain of up to six mirror reflections between random surfaces: the directions after the first
/// follow from the normals.
fn chain() -> impl Strategy<Value = (DVec3, Vec<(DVec3, Index)>)> {
    let index = prop_oneof![
        (0.05..5.0, Just(0.0)).prop_map(|(n, k)| Index::new(n, k)),
        (0.05..5.0, 0.0..8.0).prop_map(|(n, k)| Index::new(n, k)),
        Just(Index::Mirror),
    ];
    (
        unit_vector(),
        prop::collection::vec((unit_vector(), index), 1..7),
    )
}

/// The Mueller matrix of a chain, built from the sensor's end as a walk from the sensor does, and
/// what becomes of `light` on the way, followed from the source's end.
fn along(
    chain: &(DVec3, Vec<(DVec3, Index)>),
    light: Stokes<4, Carried>,
) -> ([[f64; 4]; 4], Stokes<4, Sensor>) {
    let mut carried = Basis::<Carried>::new(chain.0, DVec3::X);
    let mut steps = Vec::new();
    let mut followed = light;
    for &(normal, index) in &chain.1 {
        let (incidence, emergence) = Basis::<Incidence>::mirror(carried.direction(), normal);
        let (cos, sin2) = angle_of_incidence(carried.direction(), normal);
        let (rotator, reflection) = (
            Rotator::new(&carried, &incidence),
            index.reflection(cos, sin2),
        );
        followed = (reflection * (rotator * followed)).carried();
        steps.push((rotator, reflection));
        carried = emergence.carried();
    }
    let to_sensor = Rotator::new(
        &carried,
        &Basis::<Sensor>::new(carried.direction(), DVec3::Y),
    );
    let mut matrix = Mueller::<4, Sensor, Sensor>::identity() * to_sensor;
    for &(rotator, reflection) in steps.iter().rev() {
        matrix = matrix.emergent() * reflection * rotator;
    }
    (matrix.rows(), to_sensor * followed)
}

proptest! {
    #[test]
    fn products_keep_light_physical(chain in chain(), axis in unit_vector(), degree in 0.0..=1.0f64) {
        // The coherency matrix ½ [[I+Q, U+iV], [U−iV, I−Q]] has the eigenvalues
        // ½ (I ± √(Q² + U² + V²)), which no chain may make negative.
        let polarised: DVec3 = degree * axis;
        let light = Stokes::new([1.0, polarised.x, polarised.y, polarised.z]);
        let (_, followed) = along(&chain, light);
        let [i, q, u, v] = followed.components();
        let lesser = 0.5 * (i - (q * q + u * u + v * v).sqrt());
        prop_assert!(i <= 1.0 + 1e-14);
        prop_assert!(lesser >= -1e-14 * i, "eigenvalue {lesser} of {i}");
    }

    #[test]
    fn a_walk_from_the_sensor_gives_what_the_light_gives(chain in chain(), state in unit_vector()) {
        let light = Stokes::new([1.0, state.x, state.y, state.z]);
        let (matrix, followed) = along(&chain, light);
        let read = Mueller::<4, Carried, Sensor>::new(matrix) * light;
        for (a, b) in read.components().into_iter().zip(followed.components()) {
            prop_assert!((a - b).abs() < 1e-13);
        }
    }

    #[test]
    fn mirrors_do_not_depolarise(chain in chain()) {
        // tr(M Mᵀ) = 4 M00² holds for the matrix of one pair of amplitudes and of no mixture:
        // Gil and Bernabeu, Optica Acta 32 (1985) 259.
        let (matrix, _) = along(&chain, Stokes::unpolarised(1.0));
        let trace: f64 = matrix.iter().flatten().map(|element| element * element).sum();
        prop_assert!((trace - 4.0 * matrix[0][0] * matrix[0][0]).abs() < 1e-13);
    }

    #[test]
    fn fewer_components_of_a_chain_of_dielectrics_are_its_leading_ones(
        n in 1.0..5.0, axes in [unit_vector(), unit_vector()], state in unit_vector()
    ) {
        let light = [1.0, state.x, state.y, state.z];
        let (incidence, _) = Basis::<Incidence>::mirror(axes[0], axes[1]);
        let (cos, sin2) = angle_of_incidence(axes[0], axes[1]);
        let rotator = Rotator::new(&Basis::<Carried>::new(axes[0], DVec3::Z), &incidence);
        let reflection = Index::new(n, 0.0).reflection(cos, sin2);
        let full = reflection * (rotator * Stokes::<4, _>::of_state(light));
        let linear = reflection * (rotator * Stokes::<3, _>::of_state(light));
        prop_assert_eq!(&full.components().map(f64::to_bits)[..3], &linear.components().map(f64::to_bits)[..]);
    }
}
