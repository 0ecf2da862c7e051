//! Where light is measured: points with normals, in named groups.

mod aim;
pub(crate) mod described;
pub(crate) mod faces;
mod lattice;
pub(crate) mod marker;
pub(crate) mod name;
mod points_file;

use glam::DVec3;

/// A group of points at which light is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    /// Name, usable as a file name.
    pub name: String,
    /// What is measured.
    pub quantity: Quantity,
    /// Which x axis the Stokes vector belongs to; [`Frame::Fixed`] for a radiance.
    pub frame: Frame,
    /// x axis of [`Frame::Fixed`], and of [`Frame::Incidence`] for a beam along the normal: a unit vector, to be
    /// made perpendicular to each arriving direction.
    pub axis: DVec3,
    /// The points, in the order of the results.
    pub points: Vec<SensorPoint>,
    /// How the points lie to each other.
    pub layout: Layout,
}

/// One point at which light is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorPoint {
    /// Position in metres, as given: a point on a surface is not moved off it.
    pub position: DVec3,
    /// Normal, a unit vector; light is measured on its side. For a radiance the direction looked in.
    pub normal: DVec3,
    /// Inside a closed solid without an emitter: reported, but no part of means and of stopping.
    pub enclosed: bool,
}

/// What a sensor measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Irradiance, in unit/m².
    Irradiance,
    /// Radiance of the light that arrives from one direction, in unit/(m²·sr).
    Radiance,
}

/// Which x axis the Stokes vector belongs to (`docs/conventions.md`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// Each beam's own, along d × N.
    Incidence,
    /// The sensor's axis, made perpendicular to each beam.
    Fixed,
}

/// How the points of a sensor lie to each other.
#[derive(Clone, Debug, PartialEq)]
pub enum Layout {
    /// Centres of the cells of a parallelogram, along `u` fastest.
    Grid {
        /// Corner, in metres.
        origin: DVec3,
        /// First side, in metres.
        u: DVec3,
        /// Second side, in metres.
        v: DVec3,
        /// Number of cells along `u` and `v`.
        counts: [usize; 2],
    },
    /// Evenly spaced on a segment, its ends included.
    Line,
    /// In no particular order.
    Points,
}

impl SensorPoint {
    /// A point that is not known to be enclosed.
    pub(crate) fn new(position: DVec3, normal: DVec3) -> Self {
        Self {
            position,
            normal,
            enclosed: false,
        }
    }
}

/// The axis where none is given: the grid's u, else X, else Y, the first that lies along no point's normal.
pub(crate) fn default_axis(u: Option<DVec3>, points: &[SensorPoint]) -> DVec3 {
    let candidates = u.into_iter().chain([DVec3::X, DVec3::Y]);
    let mut free = candidates.filter(|axis| !points.iter().any(|point| along(*axis, point.normal)));
    free.next().unwrap_or(DVec3::Z)
}

/// Whether two unit vectors lie along one line, to within 10⁻⁶ of an angle.
pub(crate) fn along(axis: DVec3, normal: DVec3) -> bool {
    axis.cross(normal).length_squared() < 1e-12
}

/// Centres of the cells of a grid, along `u` fastest.
pub(crate) fn cell_centres(
    origin: DVec3,
    u: DVec3,
    v: DVec3,
    counts: [usize; 2],
    normal: DVec3,
) -> Vec<SensorPoint> {
    let share = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
    let mut points = Vec::with_capacity(counts[0] * counts[1]);
    for j in 0..counts[1] {
        for i in 0..counts[0] {
            let position = origin + u * share(i, counts[0]) + v * share(j, counts[1]);
            points.push(SensorPoint::new(position, normal));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_run_along_u_fastest() {
        let points = cell_centres(DVec3::Z, DVec3::X, DVec3::Y * 2.0, [2, 2], DVec3::Z);
        let expected = [(0.25, 0.5), (0.75, 0.5), (0.25, 1.5), (0.75, 1.5)];
        for (point, (x, y)) in points.iter().zip(expected) {
            assert_eq!(point.position, DVec3::new(x, y, 1.0));
        }
    }

    #[test]
    fn the_default_axis_lies_along_no_normal() {
        let point = |normal| [SensorPoint::new(DVec3::ZERO, normal)];
        assert_eq!(default_axis(None, &point(DVec3::Z)), DVec3::X);
        assert_eq!(default_axis(None, &point(DVec3::NEG_X)), DVec3::Y);
        assert_eq!(default_axis(Some(DVec3::Y), &point(DVec3::Z)), DVec3::Y);
        assert_eq!(default_axis(Some(DVec3::Y), &point(DVec3::Y)), DVec3::X);
        let crowd = [DVec3::X, DVec3::Y].map(|normal| SensorPoint::new(DVec3::ZERO, normal));
        assert_eq!(default_axis(None, &crowd), DVec3::Z);
    }
}
