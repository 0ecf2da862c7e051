//! The surfaces of an empty convex room, cut into tiles by a grid in each of its planes.

mod grid;

use crate::Surfaces;
use crate::contour::{Contour, Jumps};
use crate::facets::rectangle_about;
use crate::polygon::Polygon;
use glam::DVec3;
use std::collections::HashMap;

pub use grid::Grid;

/// Most triangles, and pieces that they may be cut into.
const MOST: usize = 2048;

/// Share of a room's size below which two corners of pieces are one.
const SAME: f64 = 1e-10;

/// The tiles of a room all of whose surfaces are seen whole from everywhere inside it.
///
/// A tile is what one surface has in one cell of the grid of its plane. Where a triangle lies under a later one, the tiles
/// of both are there.
#[derive(Debug)]
pub struct Tiles {
    grids: Vec<Grid>,
    sheets: Vec<Sheet>,
    /// The sheet of each triangle.
    sheet_of: Vec<u32>,
    /// Covering triangles with those that they hide in part, in order.
    under: Vec<(u32, u32)>,
    tiles: Vec<Tile>,
    pieces: Vec<Piece>,
    /// The lines in each plane at which a value that is constant on tiles may jump, and the tiles on both sides of each.
    borders: Vec<(Contour, Vec<Border>)>,
}

/// What one surface has in one plane.
#[derive(Debug)]
struct Sheet {
    surface: u32,
    plane: usize,
    /// The first of its tiles: it has one for each cell of the plane, though it may not reach into all.
    first: usize,
}

/// One of them.
#[derive(Debug, Clone)]
pub struct Tile {
    /// The surface.
    pub surface: u32,
    /// Which plane it lies in.
    pub plane: usize,
    /// Its cell there.
    pub cell: [usize; 2],
    /// Area in m²; 0 where the surface does not reach into that cell.
    pub area: f64,
    /// Centre of mass in m.
    pub centre: DVec3,
    /// The triangle that has the largest piece of it, the middle of that piece in m, and its area in m².
    triangle: u32,
    middle: DVec3,
    largest: f64,
    /// The tiles that lie under it.
    pub under: Vec<usize>,
}

/// A convex piece of a triangle within one tile.
#[derive(Debug)]
struct Piece {
    tile: usize,
    /// Corners in m, anticlockwise about the plane's normal.
    corners: Vec<DVec3>,
}

/// The tile to the left of a line, seen along it from the side of the normal, and that to its right, if there is one.
pub type Border = [Option<usize>; 2];

/// A value that is constant on tiles.
#[derive(Debug)]
pub struct Field {
    values: Vec<f64>,
    /// The lines of each plane at which it jumps, and how far.
    jumps: Vec<Jumps>,
}

impl Field {
    /// Its value on a tile.
    #[must_use]
    #[inline]
    pub fn at(&self, tile: usize) -> f64 {
        self.values[tile]
    }

    /// At how many lines it jumps.
    #[must_use]
    pub fn lines(&self) -> usize {
        self.jumps.iter().map(Jumps::len).sum()
    }

    /// The sum over all tiles of value times form factor, for a point (in m) of a plane with this unit normal.
    #[must_use]
    pub fn sum(&self, plane: usize, point: DVec3, normal: DVec3) -> f64 {
        let others = self.jumps.iter().enumerate();
        let others = others.filter(|(other, _)| *other != plane);
        others.map(|(_, jumps)| jumps.sum(point, normal)).sum()
    }
}

/// How far a value that is constant on tiles jumps at a line.
#[must_use]
pub fn jump(values: &[f64], [left, right]: Border) -> f64 {
    let value = |tile: Option<usize>| tile.map_or(0.0, |tile| values[tile]);
    value(left) - value(right)
}

impl Tiles {
    /// Cuts the surfaces about `inside` (in m) into some `wanted` cells; `None` where some surface is not seen whole from
    /// everywhere there, or that takes too many pieces.
    #[must_use]
    pub fn new(surfaces: &Surfaces, inside: DVec3, wanted: usize) -> Option<Self> {
        if surfaces.len() > MOST {
            return None;
        }
        let planes = surfaces.walls(inside)?;
        let mut of_plane: Vec<Vec<u32>> = vec![Vec::new(); planes.len()];
        for triangle in 0..surfaces.len() as u32 {
            of_plane[surfaces.wall_of(triangle)?].push(triangle);
        }
        let rectangles: Vec<[DVec3; 4]> = planes
            .iter()
            .zip(&of_plane)
            .map(|(&normal, triangles)| {
                let corners = triangles
                    .iter()
                    .flat_map(|&t| surfaces.triangle(t).vertices);
                rectangle_about(&corners.collect::<Vec<_>>(), normal)
            })
            .collect();
        let area = |[a, b, _, d]: &[DVec3; 4]| (*b - *a).length() * (*d - *a).length();
        let side = (rectangles.iter().map(area).sum::<f64>() / wanted as f64).sqrt();
        let grids = rectangles.iter().zip(&planes);
        let mut tiles = Self {
            grids: grids
                .map(|(corners, &normal)| Grid::new(*corners, normal, side))
                .collect(),
            sheets: Vec::new(),
            sheet_of: vec![0; surfaces.len()],
            under: Vec::new(),
            tiles: Vec::new(),
            pieces: Vec::new(),
            borders: Vec::new(),
        };
        for (plane, triangles) in of_plane.iter().enumerate() {
            for &triangle in triangles {
                tiles.add(surfaces, plane, triangle);
                if tiles.pieces.len() > MOST {
                    return None;
                }
                let over = surfaces.over(triangle).map(|over| (over, triangle));
                tiles.under.extend(over);
            }
        }
        tiles.under.sort_unstable();
        for index in 0..tiles.tiles.len() {
            let Tile {
                triangle, middle, ..
            } = tiles.tiles[index];
            tiles.tiles[index].under = tiles.at(surfaces, triangle, middle).skip(1).collect();
        }
        let same = SAME * surfaces.radius();
        tiles.borders = (0..planes.len())
            .map(|plane| tiles.borders_in(plane, same))
            .collect();
        Some(tiles)
    }

    fn add(&mut self, surfaces: &Surfaces, plane: usize, triangle: u32) {
        let surface = surfaces.surface(triangle);
        let own = |sheet: &Sheet| sheet.plane == plane && sheet.surface == surface;
        let grid = &self.grids[plane];
        let sheet = self.sheets.iter().position(own).unwrap_or_else(|| {
            let first = self.tiles.len();
            self.sheets.push(Sheet {
                surface,
                plane,
                first,
            });
            let [x, y] = grid.counts;
            self.tiles.extend((0..x * y).map(|index| Tile {
                surface,
                plane,
                cell: [index % x, index / x],
                area: 0.0,
                centre: DVec3::ZERO,
                triangle,
                middle: DVec3::ZERO,
                largest: 0.0,
                under: Vec::new(),
            }));
            self.sheets.len() - 1
        });
        self.sheet_of[triangle as usize] = sheet as u32;
        let corners = surfaces.triangle(triangle).vertices.map(|corner| {
            let [x, y] = grid.place(corner);
            DVec3::new(x, y, 0.0)
        });
        let mut polygon = Polygon(corners.to_vec());
        if polygon.area() < 0.0 {
            polygon.0.reverse();
        }
        let left_handed = grid.axes[0].cross(grid.axes[1]).dot(grid.normal) < 0.0;
        for ([x, y], part) in grid.cut(polygon) {
            let area = part.area() * grid.sides[0] * grid.sides[1];
            if area <= 0.0 {
                continue;
            }
            let places = part.0.iter().map(|corner| [corner.x, corner.y]);
            let mut corners: Vec<DVec3> = places.map(|place| grid.point(place)).collect();
            if left_handed {
                corners.reverse();
            }
            let index = self.sheets[sheet].first + y * grid.counts[0] + x;
            let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
            let tile = &mut self.tiles[index];
            tile.area += area;
            tile.centre += (middle - tile.centre) * (area / tile.area);
            if area > tile.largest {
                (tile.triangle, tile.middle, tile.largest) = (triangle, middle, area);
            }
            self.pieces.push(Piece {
                tile: index,
                corners,
            });
        }
    }

    /// Finds the lines between pieces of different tiles of a plane; corners so close are one.
    fn borders_in(&self, plane: usize, same: f64) -> (Contour, Vec<Border>) {
        let key = |point: DVec3| (point / same).round().to_array().map(|it| it as i64);
        // In the order in which they are found: sums over them are to be the same whenever they are made.
        let mut lines: Vec<([DVec3; 2], Border)> = Vec::new();
        let mut open: HashMap<[[i64; 3]; 2], usize> = HashMap::new();
        for piece in self.pieces_in(plane) {
            let next = piece.corners.iter().cycle().skip(1);
            for (&from, &to) in piece.corners.iter().zip(next) {
                let [start, end] = [from, to].map(key);
                if start == end {
                    continue;
                }
                if let Some(line) = open.remove(&[end, start]) {
                    lines[line].1[1] = Some(piece.tile);
                } else {
                    open.insert([start, end], lines.len());
                    lines.push(([from, to], [Some(piece.tile), None]));
                }
            }
        }
        lines.retain(|(_, [left, right])| left != right);
        let (ends, borders): (Vec<_>, _) = lines.into_iter().unzip();
        (Contour::new(&ends), borders)
    }

    fn pieces_in(&self, plane: usize) -> impl Iterator<Item = &Piece> {
        self.pieces
            .iter()
            .filter(move |piece| self.tiles[piece.tile].plane == plane)
    }

    /// All tiles.
    #[must_use]
    pub fn list(&self) -> &[Tile] {
        &self.tiles
    }

    /// The grid of each plane.
    #[must_use]
    pub fn grids(&self) -> &[Grid] {
        &self.grids
    }

    /// Which tiles lie to both sides of each line at which a value that is constant on tiles may jump.
    pub fn borders(&self) -> impl Iterator<Item = Border> {
        self.borders
            .iter()
            .flat_map(|(_, borders)| borders)
            .copied()
    }

    /// How much of the jump at each of these lines (there is a place for each) a point (in m) of a plane sees: the sum of jumps
    /// times shares is the sum over all tiles of value times form factor.
    pub fn shares(&self, plane: usize, point: DVec3, mut shares: &mut [f64]) {
        let normal = self.grids[plane].normal;
        for (other, (contour, _)) in self.borders.iter().enumerate() {
            let (own, rest) = shares.split_at_mut(contour.len());
            match other == plane {
                true => own.fill(0.0),
                false => contour.shares(point, normal, own),
            }
            shares = rest;
        }
    }

    /// A value for each tile, made ready for sums.
    #[must_use]
    pub fn field(&self, values: Vec<f64>) -> Field {
        let jumps = self.borders.iter().map(|(contour, borders)| {
            let jumps = borders.iter().map(|border| jump(&values, *border));
            contour.weighted(jumps)
        });
        Field {
            jumps: jumps.collect(),
            values,
        }
    }

    /// The sum over all tiles of a field's value times the form factor to the tile, for a point (in m) in the room with any
    /// unit normal; `form_factor` gives that to what lies above the horizon of a convex polygon.
    #[must_use]
    pub fn sum_in_room(
        &self,
        field: &Field,
        point: DVec3,
        normal: DVec3,
        form_factor: impl Fn(&[DVec3]) -> f64,
    ) -> f64 {
        let mut sum = 0.0;
        for (plane, grid) in self.grids.iter().enumerate() {
            let [x, y] = grid.counts.map(|count| count as f64);
            let corners = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]];
            let risen = |&place: &[f64; 2]| (grid.point(place) - point).dot(normal) > 0.0;
            sum += match corners.iter().filter(|place| risen(place)).count() {
                0 => 0.0,
                4 => field.jumps[plane].sum(point, normal),
                _ => {
                    let pieces = self.pieces_in(plane);
                    let part =
                        |piece: &Piece| field.values[piece.tile] * form_factor(&piece.corners);
                    pieces.map(part).sum()
                }
            };
        }
        sum
    }

    /// The plane in which a triangle lies.
    #[must_use]
    #[inline]
    pub fn plane(&self, triangle: u32) -> usize {
        self.sheets[self.sheet_of[triangle as usize] as usize].plane
    }

    /// The tiles at a point (in m) where a triangle is met: its own, and those that lie under it.
    #[inline]
    pub fn at(
        &self,
        surfaces: &Surfaces,
        triangle: u32,
        point: DVec3,
    ) -> impl Iterator<Item = usize> {
        let grid = &self.grids[self.plane(triangle)];
        let [x, y] = grid.cell(grid.place(point));
        let cell = y * grid.counts[0] + x;
        let tile = move |triangle: u32| {
            self.sheets[self.sheet_of[triangle as usize] as usize].first + cell
        };
        let first = self.under.partition_point(|pair| pair.0 < triangle);
        let hidden = self.under[first..].iter();
        let hidden = hidden
            .take_while(move |pair| pair.0 == triangle)
            .filter(move |pair| surfaces.triangle(pair.1).covers(point));
        std::iter::once(tile(triangle)).chain(hidden.map(move |pair| tile(pair.1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape;
    use crate::testing::surfaces;

    fn room() -> Surfaces {
        surfaces(&[
            shape::cuboid(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0), true),
            shape::disc(DVec3::new(1.4, 0.9, 1.0), DVec3::NEG_Z, 0.2, 32),
        ])
    }

    #[test]
    fn tiles_fill_a_room() {
        let room = room();
        let tiles = Tiles::new(&room, DVec3::splat(0.4), 200).unwrap();
        let area: f64 = tiles.list().iter().map(|tile| tile.area).sum();
        let all: f64 = (0..room.len() as u32)
            .map(|t| room.triangle(t).area())
            .sum();
        assert!((area - all).abs() < 1e-12 * all);
        let cells: usize = tiles
            .grids()
            .iter()
            .map(|grid| grid.counts().iter().product::<usize>())
            .sum();
        assert!((200..300).contains(&cells), "{cells}");
        for tile in tiles.list().iter().filter(|tile| tile.area > 0.0) {
            let at: Vec<usize> = tiles.at(&room, tile.triangle, tile.middle).collect();
            assert!(std::ptr::eq(&tiles.list()[at[0]], tile));
            assert_eq!(at[1..], tile.under);
        }
    }

    #[test]
    fn a_value_that_is_the_same_everywhere_is_seen_once() {
        let room = room();
        let tiles = Tiles::new(&room, DVec3::splat(0.4), 200).unwrap();
        let values = tiles
            .list()
            .iter()
            .map(|tile| if tile.under.is_empty() { 2.0 } else { 0.0 });
        let field = tiles.field(values.collect());
        for (plane, grid) in tiles.grids().iter().enumerate() {
            let point = grid.point(grid.counts().map(|count| 0.37 * count as f64));
            assert!((field.sum(plane, point, grid.normal) - 2.0).abs() < 1e-9);
        }
    }

    #[test]
    fn only_what_is_seen_whole_has_tiles() {
        let outside = DVec3::new(1.0, 1.0, 3.0);
        assert!(Tiles::new(&room(), outside, 200).is_none());
        let mut parts = vec![shape::cuboid(DVec3::ZERO, DVec3::ONE, true)];
        parts.push(shape::cuboid(DVec3::splat(0.5), DVec3::splat(0.6), false));
        assert!(Tiles::new(&surfaces(&parts), DVec3::splat(0.3), 200).is_none());
    }
}
