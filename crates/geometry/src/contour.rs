//! What lies within contours, as a point sees it: Lambert's sum over their lines.

use glam::DVec3;
use pulp::{Arch, Simd, WithSimd};
use std::f64::consts::{PI, TAU};

/// Lines that are summed at once.
const LANES: usize = 8;

/// Coefficients of arccos x/√(1 − x²) in [0, 1], the highest first: the polynomial of this degree that errs least
/// (Chebyshev), by 7·10⁻¹⁴.
const ANGLE: [f64; 17] = [
    0.0006085619653744684,
    -0.005808597590519145,
    0.026115987357625138,
    -0.07419324994425795,
    0.1515026854745219,
    -0.24155677597211828,
    0.32168777107072677,
    -0.3804374854745279,
    0.42153491130233556,
    -0.45529076094959686,
    0.49055899159932126,
    -0.5332956171404206,
    0.5890456114068265,
    -0.6666665195234605,
    0.7853981595839817,
    -0.9999999999606062,
    1.5707963267948286,
];

/// So many lines: start and end of each, coordinate by coordinate.
type Lines = [[f64; LANES]; 6];

/// Lines between points, each of which runs around what lies to its left.
#[derive(Debug)]
pub(crate) struct Contour {
    lines: Vec<Lines>,
    len: usize,
    arch: Arch,
}

/// Some of them, each with a weight.
#[derive(Debug)]
pub(crate) struct Jumps {
    contour: Contour,
    weights: Vec<[f64; LANES]>,
}

impl Contour {
    /// Lines with these ends, in m.
    #[must_use]
    pub fn new(lines: &[[DVec3; 2]]) -> Self {
        let packed = lines.chunks(LANES).map(|chunk| {
            // A line without length sees nothing.
            let mut packed = [[0.0; LANES]; 6];
            for (lane, [from, to]) in chunk.iter().enumerate() {
                let ends = [from.to_array(), to.to_array()];
                for (row, value) in packed.iter_mut().zip(ends.as_flattened()) {
                    row[lane] = *value;
                }
            }
            packed
        });
        Self {
            lines: packed.collect(),
            len: lines.len(),
            arch: Arch::new(),
        }
    }

    /// For each line (there is a place for each), what it adds to the form factors (shares of density cos θ/π) of all that
    /// lies to its left, seen from a point (in m) of a surface with this unit normal, before and above which that lies whole.
    pub fn shares(&self, point: DVec3, normal: DVec3, shares: &mut [f64]) {
        self.arch.dispatch(Shares {
            lines: &self.lines,
            point,
            normal,
            shares,
        });
    }

    /// How many lines there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Those of weights that are not 0.
    pub fn weighted(&self, weights: impl Iterator<Item = f64>) -> Jumps {
        let kept = weights.enumerate().filter(|(_, weight)| *weight != 0.0);
        let (kept, weights): (Vec<usize>, Vec<f64>) = kept.unzip();
        let line = |&index: &usize| {
            let [ax, ay, az, bx, by, bz] = self.lines[index / LANES].map(|row| row[index % LANES]);
            [DVec3::new(ax, ay, az), DVec3::new(bx, by, bz)]
        };
        let weights = weights.chunks(LANES).map(|chunk| {
            let mut packed = [0.0; LANES];
            packed[..chunk.len()].copy_from_slice(chunk);
            packed
        });
        Jumps {
            weights: weights.collect(),
            contour: Self::new(&kept.iter().map(line).collect::<Vec<_>>()),
        }
    }
}

impl Jumps {
    /// How many lines there are.
    pub fn len(&self) -> usize {
        self.contour.len()
    }

    /// The sum of weights times [shares](Contour::shares).
    #[must_use]
    pub fn sum(&self, point: DVec3, normal: DVec3) -> f64 {
        if self.weights.is_empty() {
            return 0.0;
        }
        self.contour.arch.dispatch(Sum {
            jumps: self,
            point,
            normal,
        })
    }
}

/// Work for the vector unit that the machine has: what is inlined into it is compiled for that.
struct Shares<'a> {
    lines: &'a [Lines],
    point: DVec3,
    normal: DVec3,
    shares: &'a mut [f64],
}

impl WithSimd for Shares<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (lines, shares) in self.lines.iter().zip(self.shares.chunks_mut(LANES)) {
            let all = lambert(lines, self.point, self.normal);
            shares.copy_from_slice(&all[..shares.len()]);
        }
    }
}

/// The same.
struct Sum<'a> {
    jumps: &'a Jumps,
    point: DVec3,
    normal: DVec3,
}

impl WithSimd for Sum<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let mut sums = [0.0; LANES];
        for (lines, weights) in self.jumps.contour.lines.iter().zip(&self.jumps.weights) {
            let shares = lambert(lines, self.point, self.normal);
            for lane in 0..LANES {
                sums[lane] += shares[lane] * weights[lane];
            }
        }
        sums.iter().sum()
    }
}

/// −γ **N**·(**e** × **e**′)/(2π |**e** × **e**′|) of some lines, with γ the angle between their ends.
#[inline(always)]
fn lambert(lines: &Lines, point: DVec3, normal: DVec3) -> [f64; LANES] {
    let [ax, ay, az, bx, by, bz] = lines;
    let mut angles = [0.0; LANES];
    let mut heights = [0.0; LANES];
    let mut sines = [0.0; LANES];
    let mut cosines = [0.0; LANES];
    for lane in 0..LANES {
        let (ax, ay, az) = (ax[lane] - point.x, ay[lane] - point.y, az[lane] - point.z);
        let (bx, by, bz) = (bx[lane] - point.x, by[lane] - point.y, bz[lane] - point.z);
        let (x, y, z) = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
        let sine = x * x + y * y + z * z;
        let cosine = ax * bx + ay * by + az * bz;
        let inverse = 1.0 / (sine + cosine * cosine).sqrt();
        let along = (cosine * inverse).abs();
        let mut ratio = ANGLE[0];
        for coefficient in &ANGLE[1..] {
            ratio = ratio * along + coefficient;
        }
        // The angle, or what it lacks to 180°, over its sine, and from there over the product of lengths and sine.
        angles[lane] = ratio * inverse;
        heights[lane] = x * normal.x + y * normal.y + z * normal.z;
        (sines[lane], cosines[lane]) = (sine, cosine);
    }
    // Next to long lines alone.
    if cosines.iter().any(|&cosine| cosine < 0.0) {
        for lane in 0..LANES {
            let obtuse = PI / sines[lane].max(f64::MIN_POSITIVE).sqrt() - angles[lane];
            angles[lane] = if cosines[lane] < 0.0 {
                obtuse
            } else {
                angles[lane]
            };
        }
    }
    let mut shares = [0.0; LANES];
    for lane in 0..LANES {
        let share = -angles[lane] * heights[lane] / TAU;
        shares[lane] = if sines[lane] > 0.0 { share } else { 0.0 };
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Uniform;

    #[test]
    fn lines_have_the_angles_of_the_library() {
        let mut uniform = Uniform(3);
        let mut point = || 2.0 * uniform.point() - 1.0;
        for _ in 0..1000 {
            let (lines, from) = (vec![[point(), point()]; 11], 0.3 * point());
            let normal = point().normalize();
            let [start, end] = lines[0].map(|it| it - from);
            let across = start.cross(end);
            let angle = across.length().atan2(start.dot(end));
            let exact = -angle * across.normalize().dot(normal) / TAU;
            let mut shares = [0.0; 11];
            Contour::new(&lines).shares(from, normal, &mut shares);
            assert!(shares.iter().all(|share| (share - exact).abs() < 1e-12));
        }
    }

    #[test]
    fn every_vector_unit_gives_the_same_bits() {
        let mut uniform = Uniform(5);
        let lines: Vec<_> = (0..45)
            .map(|_| [uniform.point(), uniform.point()])
            .collect();
        let best = Contour::new(&lines);
        let portable = Contour {
            arch: Arch::Scalar,
            ..Contour::new(&lines)
        };
        let sums = [best, portable].map(|contour| {
            let weights = (0..lines.len()).map(|line| f64::from(line as u32 % 3));
            contour.weighted(weights).sum(DVec3::splat(0.4), DVec3::Z)
        });
        assert_eq!(sums[0].to_bits(), sums[1].to_bits());
    }
}
