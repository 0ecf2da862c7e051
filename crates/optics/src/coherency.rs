//! Whether a Mueller matrix can exist: Cloude's test by the eigenvalues of its coherency matrix.

use crate::complex::Complex;

/// The four eigenvalues of the coherency matrix of a Mueller matrix, in ascending order:
///
/// H = ¼ Σ M_ij σ_i ⊗ σ_j*
///
/// with the matrices σ of I, Q, U, V. A matrix is a sum of pairs of amplitudes, and so keeps all
/// light physical, if and only if none is negative; it is one pair where three vanish. Their sum is
/// M00. S. R. Cloude, Optik 75 (1986) 26.
pub(crate) fn eigenvalues(mueller: &[[f64; 4]; 4]) -> [f64; 4] {
    let (zero, one) = (Complex::real(0.0), Complex::real(1.0));
    let (minus, i) = (Complex::real(-1.0), Complex { re: 0.0, im: 1.0 });
    // J = ½ [[I + Q, U + iV], [U − iV, I − Q]].
    let sigma = [
        [[one, zero], [zero, one]],
        [[one, zero], [zero, minus]],
        [[zero, one], [one, zero]],
        [[zero, i], [i.conjugate(), zero]],
    ];
    // The Hermitian matrix A + iB as the symmetric [[A, −B], [B, A]], each eigenvalue twice.
    let mut real = [[0.0; 8]; 8];
    for row in 0..4 {
        for column in 0..4 {
            let mut element = zero;
            for (left, elements) in sigma.iter().zip(mueller) {
                for (right, m) in sigma.iter().zip(elements) {
                    let product =
                        left[row / 2][column / 2] * right[row % 2][column % 2].conjugate();
                    element = element + product * Complex::real(0.25 * m);
                }
            }
            real[row][column] = element.re;
            real[row + 4][column + 4] = element.re;
            real[row + 4][column] = element.im;
            real[row][column + 4] = -element.im;
        }
    }
    diagonalise(&mut real);
    let mut diagonal: [f64; 8] = std::array::from_fn(|index| real[index][index]);
    diagonal.sort_by(f64::total_cmp);
    std::array::from_fn(|index| diagonal[2 * index])
}

/// Whether no eigenvalue is below −10⁻¹² of the greatest. Numbers below the least normal one have
/// fewer digits and count as zero; a matrix of zeros passes.
pub(crate) fn is_physical(mueller: &[[f64; 4]; 4]) -> bool {
    let eigenvalues = eigenvalues(mueller);
    eigenvalues.iter().all(|value| value.is_finite())
        && eigenvalues[0] >= -1e-12 * eigenvalues[3] - f64::MIN_POSITIVE
}

/// Jacobi's rotations, sweep by sweep, until what is off the diagonal is rounding.
fn diagonalise(matrix: &mut [[f64; 8]; 8]) {
    for _ in 0..30 {
        for p in 0..8 {
            for q in p + 1..8 {
                let off = matrix[p][q];
                if off == 0.0 {
                    continue;
                }
                let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * off);
                let t = 1f64.copysign(theta) / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in matrix.iter_mut() {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let (upper, lower) = matrix.split_at_mut(q);
                for (a, b) in upper[p].iter_mut().zip(&mut lower[0]) {
                    (*a, *b) = (c * *a - s * *b, s * *a + c * *b);
                }
            }
        }
    }
}

#[test]
fn one_pair_of_amplitudes_has_one_eigenvalue() {
    // r_s = 1, r_p = i/2: Rs = 1, Rp = ¼, C = 0, W = −½.
    let (m, h, w) = (0.625, 0.375, -0.5);
    let matrix = [
        [m, h, 0.0, 0.0],
        [h, m, 0.0, 0.0],
        [0.0, 0.0, 0.0, -w],
        [0.0, 0.0, w, 0.0],
    ];
    let values = eigenvalues(&matrix);
    assert!((values[3] - m).abs() < 1e-15);
    assert!(values[..3].iter().all(|value| value.abs() < 1e-15));
}

#[test]
fn the_total_depolariser_has_four_equal_eigenvalues() {
    let mut matrix = [[0.0; 4]; 4];
    matrix[0][0] = 1.0;
    assert!(
        eigenvalues(&matrix)
            .iter()
            .all(|value| (value - 0.25).abs() < 1e-15)
    );
}

#[test]
fn a_matrix_that_reverses_v_alone_cannot_exist() {
    // It keeps every state of one beam physical and yet is no sum of amplitudes.
    let diagonal = [1.0, 1.0, 1.0, -1.0];
    let matrix = std::array::from_fn(|row| {
        std::array::from_fn(|column| if row == column { diagonal[row] } else { 0.0 })
    });
    assert!(eigenvalues(&matrix)[0] < -0.4 && !is_physical(&matrix));
}
