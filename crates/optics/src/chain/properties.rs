//! What holds for every chain.

use glam::DVec3;
use proptest::prelude::*;

use super::{Chain, Surface};
use crate::{
    Basis, Carried, Coated, Incidence, Index, Material, Mueller, Stokes, angle_of_incidence,
    basis::tests::unit_vector, coherency,
};

fn index() -> impl Strategy<Value = Index> {
    prop_oneof![
        (0.05..5.0, Just(0.0)).prop_map(|(n, k)| Index::new(n, k)),
        (0.05..5.0, 0.0..8.0).prop_map(|(n, k)| Index::new(n, k)),
        Just(Index::Mirror),
    ]
}

/// Up to six mirrors.
fn mirrors() -> impl Strategy<Value = Vec<Surface>> {
    let mirror =
        (unit_vector(), index()).prop_map(|(normal, index)| Surface::mirror(normal, index));
    prop::collection::vec(mirror, 1..7)
}

/// Up to six surfaces of any kind, panes met or passed.
fn surfaces() -> impl Strategy<Value = Vec<Surface>> {
    let any = (unit_vector(), index(), 0.4..4.0f64, 0.0..=1.0, 0..4).prop_map(
        |(normal, index, n, share, kind)| {
            let mut surface = Surface::mirror(normal, index);
            match kind {
                0 => {}
                1 => surface.material = Material::Coated(Coated::new(share, n.max(1.0))),
                _ => {
                    surface.material = Material::Pane { n, tau: share };
                    surface.through = kind == 3;
                }
            }
            surface
        },
    );
    prop::collection::vec(any, 1..7)
}

/// The bits of each component; adding zero turns −0 into 0.
fn bits<const N: usize>(components: [f64; N]) -> [u64; N] {
    components.map(|component| (component + 0.0).to_bits())
}

/// A beam along its first vector with its axis along the second.
fn source() -> impl Strategy<Value = Basis<Carried>> {
    [unit_vector(), unit_vector()].prop_map(|[direction, axis]| Basis::new(direction, axis))
}

/// A whole path: mirrors and panes, a coated diffuser, mirrors and panes again.
struct Path {
    matrix: [[f64; 4]; 4],
    arriving: DVec3,
    conditioning: f64,
    /// No element is greater.
    bound: f64,
}

impl Path {
    /// The diffuser stands across `normal` and sends light on along `scattered`; what arrives is read with x along `axis`.
    fn new(
        source: Basis<Carried>,
        before: &[Surface],
        (diffuser, normal): (&Material, DVec3),
        scattered: DVec3,
        after: &[Surface],
        axis: DVec3,
    ) -> Self {
        let across = |direction| Basis::<Incidence>::mirror(direction, normal).0.axis();
        let taken = Chain::new(source, before, axis).arriving.direction();
        let before = Chain::new(source, before, across(taken));
        let after = Chain::new(Basis::new(scattered, across(scattered)), after, axis);
        let ((cos_in, sin2_in), (cos_out, sin2_out)) = (
            angle_of_incidence(taken, normal),
            angle_of_incidence(scattered, normal),
        );
        let row = diffuser.entering::<4>(cos_in, sin2_in).components();
        let column = diffuser.leaving::<4>(cos_out, sin2_out).components();
        let (first, last) = (before.matrix::<4>().rows(), after.matrix::<4>().rows());
        let sum = |of: &dyn Fn(usize) -> f64| (0..4).map(of).sum::<f64>();
        let read: [f64; 4] = std::array::from_fn(|j| sum(&|k| row[k] * first[k][j]));
        let sent: [f64; 4] = std::array::from_fn(|i| sum(&|k| last[i][k] * column[k]));
        Self {
            matrix: sent.map(|left| read.map(|right| diffuser.scattering() * left * right)),
            arriving: after.arriving.direction(),
            conditioning: before.conditioning.min(after.conditioning),
            bound: before.bound() * after.bound(),
        }
    }
}

proptest! {
    #[test]
    fn a_whole_path_reversed_has_the_transposed_matrix(
        source in source(), before in surfaces(), coat in (0.0..=1.0, 1.0..3.0), [normal, scattered] in [unit_vector(), unit_vector()],
        after in surfaces(), axis in unit_vector()
    ) {
        // M′ = D Mᵀ D, as for chains without scattering.
        let diffuser = (&Material::Coated(Coated::new(coat.0, coat.1)), normal);
        let there = Path::new(source, &before, diffuser, scattered, &after, axis);
        prop_assume!(there.conditioning > 1e-3);
        let turned = |surfaces: &[Surface]| surfaces.iter().rev().copied().collect::<Vec<_>>();
        let taken = Chain::new(source, &before, axis).arriving.direction();
        let start = Basis::new(-there.arriving, axis);
        let back = Path::new(start, &turned(&after), diffuser, -taken, &turned(&before), source.axis());
        prop_assert!(back.arriving.distance(-source.direction()) < 1e-13);
        for (row, elements) in back.matrix.iter().enumerate() {
            for (column, element) in elements.iter().enumerate() {
                let sign = if (row == 2) == (column == 2) { 1.0 } else { -1.0 };
                prop_assert!((element - sign * there.matrix[column][row]).abs() <= 1e-12 * there.bound + 1e-14);
            }
        }
    }

    #[test]
    fn products_keep_light_physical(
        source in source(), surfaces in surfaces(), polarised in unit_vector(), degree in 0.0..=1.0f64
    ) {
        // The coherency matrix ½ [[I+Q, U+iV], [U−iV, I−Q]] has the eigenvalues
        // ½ (I ± √(Q² + U² + V²)), which no chain may make negative.
        let polarised = degree * polarised;
        let light = Stokes::<4, _>::new([1.0, polarised.x, polarised.y, polarised.z]);
        let chain = Chain::new(source, &surfaces, DVec3::Y);
        let [i, q, u, v] = chain.followed(light).components();
        let lesser = 0.5 * (i - (q * q + u * u + v * v).sqrt());
        prop_assert!(i <= 1.0 + 1e-14);
        // Next to extinction, I is the rounding of what the bound lets through.
        prop_assert!(lesser >= -1e-14 * chain.bound(), "eigenvalue {lesser} of {i}");
    }

    #[test]
    fn products_are_matrices_that_can_exist(source in source(), surfaces in surfaces()) {
        let rows = Chain::new(source, &surfaces, DVec3::Y).matrix().rows();
        prop_assert!(coherency::is_physical(&rows), "{:?}", coherency::eigenvalues(&rows));
    }

    #[test]
    fn a_walk_from_the_sensor_gives_what_the_light_gives(
        source in source(), surfaces in surfaces(), state in unit_vector()
    ) {
        let light = Stokes::<4, _>::new([1.0, state.x, state.y, state.z]);
        let chain = Chain::new(source, &surfaces, DVec3::Y);
        let read = chain.matrix() * light;
        for (a, b) in read.components().into_iter().zip(chain.followed(light).components()) {
            prop_assert!((a - b).abs() <= 1e-13 * chain.bound());
        }
    }

    #[test]
    fn mirrors_do_not_depolarise(source in source(), mirrors in mirrors()) {
        // tr(M Mᵀ) = 4 M00² holds for the matrix of one pair of amplitudes and of no mixture:
        // Gil and Bernabeu, Optica Acta 32 (1985) 259.
        let chain = Chain::new(source, &mirrors, DVec3::Y);
        let matrix = chain.matrix::<4>().rows();
        let trace: f64 = matrix.iter().flatten().map(|element| element * element).sum();
        prop_assert!((trace - 4.0 * matrix[0][0] * matrix[0][0]).abs() <= 1e-13 * chain.bound().powi(2));
    }

    #[test]
    fn a_chain_reversed_has_the_transposed_matrix(source in source(), surfaces in surfaces(), axis in unit_vector()) {
        // Reversed light keeps the axes x at both ends, and y = d × x changes its sign: M′ = D Mᵀ D with
        // D = diag(1, 1, −1, 1). Z. Sekera, J. Opt. Soc. Am. 56 (1966) 1732.
        let chain = Chain::new(source, &surfaces, axis);
        prop_assume!(chain.conditioning > 1e-3);
        let there = chain.matrix::<4>().rows();
        let back: Vec<_> = surfaces.iter().rev().copied().collect();
        let reversed = Basis::new(-chain.arriving.direction(), axis);
        let back = Chain::new(reversed, &back, source.axis());
        prop_assert!(back.arriving.direction().distance(-source.direction()) < 1e-13);
        for (row, elements) in back.matrix::<4>().rows().into_iter().enumerate() {
            for (column, element) in elements.into_iter().enumerate() {
                let sign = if (row == 2) == (column == 2) { 1.0 } else { -1.0 };
                prop_assert!((element - sign * there[column][row]).abs() <= 1e-12 * chain.bound() + 1e-14);
            }
        }
    }

    #[test]
    fn scattering_reversed_has_the_transposed_kernel(rho in 0.0..=1.0, n in 1.0..5.0, angles in [0.0..=1.0, 0.0..=1.0]) {
        let material = Material::Coated(Coated::new(rho, n));
        let [first, second] = angles.map(|cos: f64| (cos, (1.0 - cos) * (1.0 + cos)));
        let kernel = |from: (f64, f64), to: (f64, f64)| -> [[f64; 4]; 4] {
            let row = material.entering::<4>(from.0, from.1).components();
            let column = material.leaving::<4>(to.0, to.1).components();
            column.map(|left| row.map(|right| material.scattering() * (left * right)))
        };
        let (there, back) = (kernel(first, second), kernel(second, first));
        for row in 0..4 {
            for column in 0..4 {
                prop_assert_eq!(there[row][column].to_bits(), back[column][row].to_bits());
            }
        }
        prop_assert!(coherency::is_physical(&there));
    }

    #[test]
    fn fewer_components_are_the_leading_ones_where_nothing_couples_v(
        source in source(), normals in prop::collection::vec((unit_vector(), 1.0..5.0, 0.0..=1.0, 0..4), 1..7),
        state in unit_vector()
    ) {
        let surfaces: Vec<_> = normals.into_iter().map(|(normal, n, tau, kind)| {
            let mut surface = Surface::mirror(normal, if kind == 0 { Index::Mirror } else { Index::new(n, 0.0) });
            if kind > 1 {
                surface.material = Material::Pane { n, tau };
                surface.through = kind == 3;
            }
            surface
        }).collect();
        let light = [1.0, state.x, state.y, state.z];
        let chain = Chain::new(source, &surfaces, DVec3::Y);
        let full = chain.followed(Stokes::<4, _>::of_state(light)).components();
        let linear = chain.followed(Stokes::<3, _>::of_state(light)).components();
        prop_assert_eq!(&bits(full)[..3], &bits(linear)[..]);
        let (full, linear): (Mueller<4, _, _>, Mueller<3, _, _>) = (chain.matrix(), chain.matrix());
        for (full, linear) in full.rows().iter().zip(linear.rows()) {
            prop_assert_eq!(&bits(*full)[..3], &bits(linear)[..]);
        }
    }

    #[test]
    fn one_component_is_the_leading_one_where_nothing_polarises(
        normal in unit_vector(), indices in prop::collection::vec((0.05..5.0, 0.0..8.0), 1..7)
    ) {
        // To and fro along one normal: Rs = Rp at each mirror.
        let surfaces: Vec<_> = indices.into_iter().map(|(n, k)| Surface::mirror(normal, Index::new(n, k))).collect();
        let chain = Chain::new(Basis::new(normal, DVec3::X), &surfaces, DVec3::Y);
        let full = chain.followed(Stokes::<4, _>::unpolarised(1.0)).i();
        let linear = chain.followed(Stokes::<3, _>::unpolarised(1.0)).i();
        let scalar = chain.followed(Stokes::<1, _>::unpolarised(1.0)).i();
        prop_assert_eq!([full, linear].map(f64::to_bits), [scalar; 2].map(f64::to_bits));
    }
}
