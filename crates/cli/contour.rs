//! Lines of equal value by marching squares.

use std::collections::HashMap;

/// Values at the corners of squares, row by row; a position is counted in squares.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Corners in a row.
    pub columns: usize,
    /// One value a corner; squares with a corner without one have no line.
    pub values: Vec<Option<f64>>,
}

/// A contour line; its last point is its first where it is closed.
pub type Line = Vec<[f64; 2]>;

/// The side of a square that a line crosses: its first corner, and whether it goes along the row.
type Side = (usize, bool);

impl Lattice {
    /// The lines on which the field, linear along the sides of the squares, has the value `level`.
    pub fn contours(&self, level: f64) -> Vec<Line> {
        let segments = self.segments(level);
        let mut at_side: HashMap<Side, Vec<usize>> = HashMap::new();
        for (index, segment) in segments.iter().enumerate() {
            for side in segment {
                at_side.entry(*side).or_default().push(index);
            }
        }
        let is_end = |side: &Side| at_side.get(side).is_some_and(|met| met.len() == 1);
        let mut used = vec![false; segments.len()];
        let mut lines = Vec::new();
        // Lines with ends first, from an end; what is left over is closed.
        for open in [true, false] {
            for start in 0..segments.len() {
                let ends = segments[start];
                let Some(&from) = ends.iter().find(|side| !open || is_end(side)) else {
                    continue;
                };
                if used[start] {
                    continue;
                }
                let mut line = vec![self.crossing(from, level)];
                let (mut side, mut next) = (from, Some(start));
                while let Some(segment) = next {
                    used[segment] = true;
                    let [a, b] = segments[segment];
                    side = if side == a { b } else { a };
                    line.push(self.crossing(side, level));
                    next = at_side[&side].iter().copied().find(|&other| !used[other]);
                }
                lines.push(line);
            }
        }
        lines
    }

    /// One or two segments for every square that the level passes through.
    fn segments(&self, level: f64) -> Vec<[Side; 2]> {
        let mut segments = Vec::new();
        let rows = self.values.len() / self.columns;
        for row in 1..rows {
            for column in 1..self.columns {
                // Corners and sides anticlockwise: low-left, low-right, high-right, high-left; side k joins corner k to k + 1.
                let upper = row * self.columns + column;
                let lower = upper - self.columns;
                let corners = [lower - 1, lower, upper, upper - 1];
                let sides = [
                    (lower - 1, true),
                    (lower, false),
                    (upper - 1, true),
                    (lower - 1, false),
                ];
                let Some(values) = self.all(corners) else {
                    continue;
                };
                let above = values.map(|value| value >= level);
                let crossed: Vec<Side> = (0..4)
                    .filter(|&k| above[k] != above[(k + 1) % 4])
                    .map(|k| sides[k])
                    .collect();
                match crossed[..] {
                    [a, b] => segments.push([a, b]),
                    [a, b, c, d] => {
                        // A saddle: corners that agree with the middle are joined through it.
                        let middle = values.iter().sum::<f64>() / 4.0 >= level;
                        if middle == above[0] {
                            segments.extend([[a, b], [c, d]]);
                        } else {
                            segments.extend([[d, a], [b, c]]);
                        }
                    }
                    _ => {}
                }
            }
        }
        segments
    }

    fn all(&self, corners: [usize; 4]) -> Option<[f64; 4]> {
        let [a, b, c, d] = corners.map(|corner| self.values[corner]);
        Some([a?, b?, c?, d?])
    }

    /// Where the level is met on a side whose ends lie on both sides of it.
    fn crossing(&self, (corner, along_row): Side, level: f64) -> [f64; 2] {
        let next = corner + if along_row { 1 } else { self.columns };
        let [a, b] = [corner, next].map(|corner| self.values[corner].unwrap_or(level));
        let part = if a < b || b < a {
            (level - a) / (b - a)
        } else {
            0.0
        };
        let (column, row) = (corner % self.columns, corner / self.columns);
        if along_row {
            [column as f64 + part, row as f64]
        } else {
            [column as f64, row as f64 + part]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(columns: usize, rows: usize, value: impl Fn(f64, f64) -> f64) -> Lattice {
        let values = (0..columns * rows)
            .map(|corner| Some(value((corner % columns) as f64, (corner / columns) as f64)))
            .collect();
        Lattice { columns, values }
    }

    #[test]
    fn a_plane_has_one_straight_line() {
        let lines = lattice(5, 4, |x, _| 2.0 * x).contours(3.0);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].len(), 4);
        assert!(lines[0].iter().all(|point| (point[0] - 1.5).abs() < 1e-15));
    }

    #[test]
    fn a_peak_has_one_closed_ring_at_the_right_distance() {
        let middle = 20.0;
        let cone = |x: f64, y: f64| -((x - middle).powi(2) + (y - middle).powi(2)).sqrt();
        let lines = lattice(41, 41, cone).contours(-10.5);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        for [x, y] in &lines[0] {
            // A chord of the cone's curvature over one side: 1/(8 · 10.5).
            let radius = ((x - middle).powi(2) + (y - middle).powi(2)).sqrt();
            assert!((radius - 10.5).abs() < 0.012, "{radius}");
        }
    }

    #[test]
    fn a_saddle_is_parted_by_its_middle() {
        for (level, joined) in [(0.4, [0.0, 1.0]), (0.6, [0.0, 0.0])] {
            // High at (0, 0) and (1, 1), low at the others; the middle is 0.5.
            let lines = lattice(2, 2, |x, y| 1.0 - (x - y).abs()).contours(level);
            assert_eq!(lines.len(), 2, "{level}");
            // Below the middle's value the lines cut off the low corners, above it the high ones.
            let cut_off = lines.iter().any(|line| {
                line.iter()
                    .all(|[x, y]| (x - joined[0]).abs() + (y - joined[1]).abs() < 1.0)
            });
            assert!(cut_off, "{level}: {lines:?}");
        }
    }

    #[test]
    fn a_level_outside_the_values_has_no_line() {
        assert!(lattice(3, 3, |x, y| x + y).contours(9.0).is_empty());
        assert!(lattice(3, 3, |_, _| 1.0).contours(1.0).is_empty());
    }

    #[test]
    fn squares_without_a_value_interrupt_a_line() {
        let mut lattice = lattice(3, 7, |x, _| x);
        lattice.values[3 * 3 + 1] = None;
        let lines = lattice.contours(0.5);
        assert_eq!(lines.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
    }
}
