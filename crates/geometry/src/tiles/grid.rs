//! The grid of one plane of a room.

use crate::polygon::Polygon;
use glam::{DVec2, DVec3};

/// A grid in one plane.
#[derive(Debug)]
pub struct Grid {
    /// Unit normal on the side of the room.
    pub normal: DVec3,
    corner: DVec3,
    /// Unit vectors in the plane, each across the other.
    pub(super) axes: [DVec3; 2],
    /// Sides of a cell, in m.
    pub(super) sides: [f64; 2],
    /// Cells along each axis.
    pub(super) counts: [usize; 2],
}

impl Grid {
    pub(super) fn new(corners: [DVec3; 4], normal: DVec3, side: f64) -> Self {
        let [corner, x, _, y] = corners;
        let spans = [x - corner, y - corner];
        let counts = spans.map(|span| (span.length() / side).ceil().max(1.0) as usize);
        Self {
            normal,
            corner,
            axes: spans.map(DVec3::normalize),
            sides: [0, 1].map(|axis| spans[axis].length() / counts[axis] as f64),
            counts,
        }
    }

    /// Cells along each axis.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// How far a point (in m) lies on the side of the room.
    #[must_use]
    pub fn above(&self, point: DVec3) -> f64 {
        (point - self.corner).dot(self.normal)
    }

    /// A point's place, in cells along each axis.
    #[must_use]
    #[inline]
    pub fn place(&self, point: DVec3) -> [f64; 2] {
        let span = point - self.corner;
        [0, 1].map(|axis| span.dot(self.axes[axis]) / self.sides[axis])
    }

    /// The point at a place, in m.
    #[must_use]
    pub fn point(&self, [x, y]: [f64; 2]) -> DVec3 {
        self.corner + self.axes[0] * (x * self.sides[0]) + self.axes[1] * (y * self.sides[1])
    }

    /// The place nearest to this one within the grid.
    #[must_use]
    #[inline]
    pub fn within(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| place[axis].clamp(0.0, self.counts[axis] as f64))
    }

    /// The cell at a place, or the one nearest to it.
    #[must_use]
    #[inline]
    pub fn cell(&self, place: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| (place[axis].max(0.0) as usize).min(self.counts[axis] - 1))
    }

    /// Parts of a polygon, given by places, with the cells that they lie in.
    pub(super) fn cut(&self, polygon: Polygon) -> Vec<([usize; 2], Polygon)> {
        let mut parts = Vec::new();
        strips(polygon, 0, self.counts[0], |x, strip| {
            strips(strip, 1, self.counts[1], |y, part| {
                parts.push(([x, y], part))
            });
        });
        parts
    }
}

/// Cuts a polygon across an axis at every whole number below `count`, and hands over what lies between.
fn strips(polygon: Polygon, axis: usize, count: usize, mut found: impl FnMut(usize, Polygon)) {
    let extent = |polygon: &Polygon| {
        let places = polygon.0.iter().map(|corner| corner[axis]);
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        })
    };
    let (low, high) = extent(&polygon);
    let cell = |at: f64| (at.max(0.0) as usize).min(count - 1);
    let mut rest = polygon;
    for index in cell(low)..cell(high) {
        let at = (index + 1) as f64;
        let (before, after) = match axis {
            0 => rest.split(DVec2::new(at, 0.0), DVec2::new(at, 1.0)),
            _ => rest.split(DVec2::new(1.0, at), DVec2::new(0.0, at)),
        };
        found(index, before);
        rest = after;
    }
    found(cell(high), rest);
}
