//! Counting cells: squares about the sensor points, in the sensors' planes, and which of them a walk crosses.

use crate::receiver::Receiver;
use glam::DVec3;
use malus_geometry::Surfaces;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Rays in the plane of a cell that look for surfaces standing in it; one that stands between them all is overlooked, and
/// its shadow in the cell with it.
const SCOUTS: u32 = 256;

/// Rays that measure what the centre of a cut cell sees of it. Where an edge runs through the cell the area is right to
/// some 10⁻⁶ of itself.
const SURVEY: u32 = 4096;

/// The part of a square that its centre sees. It counts light that crosses it from the side of its normal.
///
/// So a cell that sticks out past a wall, or into a block, counts over less area, and one behind a screen counts nothing of
/// what the sensor point does not see.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cell {
    /// Index of the sensor point.
    pub sensor: usize,
    /// Area that counts, in m².
    pub area: f64,
    /// Whether surfaces cut something off the square.
    pub cut: bool,
    centre: DVec3,
    x: DVec3,
    y: DVec3,
}

/// Cells in one plane that face one way.
#[derive(Debug)]
struct Plane {
    normal: DVec3,
    /// Distance of the plane from the origin, along the normal.
    height: f64,
    /// The cells are in ascending order of their centres along this unit vector.
    sweep: DVec3,
    /// Greatest distance along `sweep` from a cell's centre to a point of it.
    reach: f64,
    cells: Vec<Cell>,
}

/// The way of a walk from one surface to the next.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leg {
    /// Where it starts.
    pub from: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Length up to the surface, in m; infinite where there is none.
    pub length: f64,
}

/// The counting cells of all sensor points.
#[derive(Debug)]
pub(crate) struct Cells {
    /// Side of the squares, in m.
    pub side: f64,
    planes: Vec<Plane>,
}

impl Cells {
    /// A cell of the given side about every free sensor point that sees anything of it.
    #[must_use]
    pub(crate) fn new(surfaces: &Surfaces, receivers: &[Receiver], side: f64) -> Self {
        let cells: Vec<(DVec3, Cell)> = receivers
            .par_iter()
            .enumerate()
            .filter(|(_, receiver)| !receiver.enclosed)
            .map(|(sensor, receiver)| {
                let cell = Cell::new(surfaces, sensor, receiver, side);
                (receiver.normal, cell)
            })
            .collect();
        let mut planes: Vec<Plane> = Vec::new();
        for (normal, cell) in cells.into_iter().filter(|(_, cell)| cell.area > 0.0) {
            let lies_in = |plane: &&mut Plane| {
                // A quarter of the distance that keeps rays off surfaces: no surface is between two such planes.
                (plane.normal - normal).length_squared() < 1e-24
                    && (cell.centre.dot(plane.normal) - plane.height).abs()
                        < 0.25 * surfaces.offset()
            };
            match planes.iter_mut().find(lies_in) {
                Some(plane) => plane.cells.push(cell),
                None => planes.push(Plane {
                    normal,
                    height: cell.centre.dot(normal),
                    sweep: cell.x,
                    reach: 0.0,
                    cells: vec![cell],
                }),
            }
        }
        for plane in &mut planes {
            plane.arrange(0.5 * side);
        }
        Self { side, planes }
    }

    /// All cells.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Cell> {
        self.planes.iter().flat_map(|plane| &plane.cells)
    }

    /// Fills `crossed` with the cells that a leg crosses from the front, and returns the rays that this took.
    ///
    /// Each plane costs two products, each crossing of a plane a search for the cells about that place.
    pub(crate) fn crossed(&self, surfaces: &Surfaces, leg: &Leg, crossed: &mut Vec<Cell>) -> u64 {
        crossed.clear();
        let mut rays = 0;
        for plane in &self.planes {
            let Some(place) = plane.crossing(leg) else {
                continue;
            };
            for cell in plane.about(place) {
                if !cell.holds(place, 0.5 * self.side) {
                    continue;
                }
                rays += u64::from(cell.cut);
                if !cell.cut || surfaces.visible(cell.centre, place) {
                    crossed.push(*cell);
                }
            }
        }
        rays
    }
}

impl Plane {
    /// Sorts the cells for [`Plane::about`].
    fn arrange(&mut self, half: f64) {
        let sweep = self.sweep;
        let along = |cell: &Cell| cell.centre.dot(sweep);
        self.cells
            .sort_by(|one, other| along(one).total_cmp(&along(other)));
        let reaches = self.cells.iter().map(|cell| {
            // A little more, for rounding: `holds` decides.
            1.000_001 * half * (cell.x.dot(sweep).abs() + cell.y.dot(sweep).abs())
        });
        self.reach = reaches.fold(0.0, f64::max);
    }

    /// Where a leg crosses the plane from its front.
    fn crossing(&self, leg: &Leg) -> Option<DVec3> {
        let falling = -leg.direction.dot(self.normal);
        let height = leg.from.dot(self.normal) - self.height;
        (falling > 0.0 && height > 0.0 && height <= falling * leg.length)
            .then(|| leg.from + leg.direction * (height / falling))
    }

    /// The cells that may hold a place of the plane.
    fn about(&self, place: DVec3) -> &[Cell] {
        let at = place.dot(self.sweep);
        let first = |least: f64| {
            self.cells
                .partition_point(|cell| cell.centre.dot(self.sweep) < least)
        };
        let end = first(at + self.reach);
        &self.cells[first(at - self.reach).min(end)..end]
    }
}

impl Cell {
    fn new(surfaces: &Surfaces, sensor: usize, receiver: &Receiver, side: f64) -> Self {
        // A beam along the normal has the sensor's own axis in either frame.
        let x = receiver.basis(-receiver.normal).axis();
        let y = receiver.normal.cross(x);
        let centre = receiver.origin;
        let (area, cut) = match seen(surfaces, centre, [x, y], 0.5 * side, SCOUTS) {
            (_, false) => (side * side, false),
            (_, true) => (seen(surfaces, centre, [x, y], 0.5 * side, SURVEY).0, true),
        };
        Self {
            sensor,
            area,
            cut,
            centre,
            x,
            y,
        }
    }

    /// Whether a place of the plane lies in the square: of two that share a side, in one.
    fn holds(&self, place: DVec3, half: f64) -> bool {
        let offset = place - self.centre;
        let within = |along: f64| -half <= along && along < half;
        within(offset.dot(self.x)) && within(offset.dot(self.y))
    }
}

/// Area of the part of a square that its centre sees, ∫ ½ r² dφ by `rays` rays in its plane, and whether any of them
/// met a surface inside it.
fn seen(
    surfaces: &Surfaces,
    centre: DVec3,
    [x, y]: [DVec3; 2],
    half: f64,
    rays: u32,
) -> (f64, bool) {
    let (mut sum, mut cut) = (0.0, false);
    for ray in 0..rays {
        let (sin, cos) = libm::sincos(TAU * (f64::from(ray) + 0.5) / f64::from(rays));
        let edge = half / sin.abs().max(cos.abs());
        let direction = (x * cos + y * sin).normalize();
        let hit = surfaces.nearest(centre, direction);
        let reach = hit.map_or(edge, |hit| hit.distance.min(edge));
        cut |= reach < edge;
        sum += reach * reach;
    }
    (sum * (0.5 * TAU / f64::from(rays)), cut)
}
