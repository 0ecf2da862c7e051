//! The guess as such: exitances of tiles that nearly solve the radiosity equation, found by Jacobi's iteration.

use glam::DVec3;
use malus_geometry::{Field, Grid, Tile, Tiles, jump};
use malus_scene::Material;
use rayon::prelude::*;

/// Share of a cell by which the outermost nodes of a table stand off the edges of walls, where irradiance jumps.
const ASIDE: f64 = 0.02;

/// Reflections after which the guess is good enough, at most, and the share of the brightest tile by which it may still change.
const REFLECTIONS: u32 = 64;
const SETTLED: f64 = 2e-3;

/// The least that a room is taken to keep of its light at each reflection, on average: where it keeps none, no guess is right.
const KEPT: f64 = 1e-4;

/// Where irradiances are tabled: at the corners of all cells, those of each plane row by row.
struct Nodes {
    /// Plane and place, in m.
    list: Vec<(usize, DVec3)>,
    /// The first of each plane.
    starts: Vec<usize>,
}

impl Nodes {
    /// Those of a room; where a corner lies outside it, one in the largest tile about.
    fn new(tiles: &Tiles) -> Self {
        let mut nodes = Self {
            list: Vec::new(),
            starts: Vec::new(),
        };
        for (plane, grid) in tiles.grids().iter().enumerate() {
            nodes.starts.push(nodes.list.len());
            let [x, y] = grid.counts();
            for j in 0..=y {
                let row = (0..=x).map(|i| (plane, node(tiles, plane, [i, j])));
                nodes.list.extend(row);
            }
        }
        nodes
    }

    /// A table of values at all of them.
    fn table(&self, value: impl Fn(usize, DVec3) -> f64 + Sync) -> Table {
        let values = self.list.par_iter();
        let values = values.map(|&(plane, point)| value(plane, point));
        self.filled(values.collect())
    }

    fn filled(&self, values: Vec<f64>) -> Table {
        Table {
            values,
            starts: self.starts.clone(),
        }
    }
}

/// Where to ask for what is to stand at a corner of cells.
fn node(tiles: &Tiles, plane: usize, corner: [usize; 2]) -> DVec3 {
    let grids = tiles.grids();
    let grid = &grids[plane];
    let point = grid.point(aside(grid, corner.map(|it| it as f64)));
    let mut others = grids.iter().enumerate().filter(|it| it.0 != plane);
    if others.all(|(_, wall)| wall.above(point) >= 0.0) {
        return point;
    }
    let about = |tile: &&Tile| {
        let near =
            |axis: usize| tile.cell[axis] == corner[axis] || tile.cell[axis] + 1 == corner[axis];
        tile.plane == plane && near(0) && near(1)
    };
    let about = tiles.list().iter().filter(about);
    let largest = about.max_by(|a, b| a.area.total_cmp(&b.area));
    // About corners without a tile nothing is asked for.
    let largest = largest.filter(|tile| tile.area > 0.0);
    largest.map_or(point, |tile| tile.centre)
}

/// Irradiances at such nodes, in unit/m².
pub(super) struct Table {
    values: Vec<f64>,
    starts: Vec<usize>,
}

impl Table {
    /// The value at a place of a plane: in a cell, linear along either axis.
    #[inline]
    pub(super) fn at(&self, plane: usize, grid: &Grid, place: [f64; 2]) -> f64 {
        let cell = grid.cell(place);
        let [x, y] = [0, 1].map(|axis| place[axis] - cell[axis] as f64);
        let [a, b, c, d] = self.corners(plane, grid, cell);
        (a * (1.0 - x) + b * x) * (1.0 - y) + (c * (1.0 - x) + d * x) * y
    }

    /// The values at the corners of one cell.
    #[inline]
    fn corners(&self, plane: usize, grid: &Grid, [x, y]: [usize; 2]) -> [f64; 4] {
        let row = grid.counts()[0] + 1;
        let first = self.starts[plane] + y * row + x;
        [first, first + 1, first + row, first + row + 1].map(|index| self.values[index])
    }
}

/// The place nearest to this one that stands off the edges of a plane.
fn aside(grid: &Grid, place: [f64; 2]) -> [f64; 2] {
    let counts = grid.counts();
    [0, 1].map(|axis| place[axis].clamp(ASIDE, counts[axis] as f64 - ASIDE))
}

/// A room of tiles, with its light.
pub(super) struct Room<'a> {
    tiles: &'a Tiles,
    emitted: &'a Field,
    /// What each tile scatters of its irradiance, and what of that comes straight from emitters, in unit/m².
    albedos: Vec<f64>,
    direct: Vec<f64>,
    nodes: Nodes,
}

/// What each tile of it is guessed to scatter, in unit/m².
pub(super) struct Solution {
    scattered: Vec<f64>,
    /// The same, less what the tiles under each are guessed to.
    pub above: Vec<f64>,
    /// Irradiance by it.
    pub table: Table,
}

impl<'a> Room<'a> {
    pub(super) fn new(tiles: &'a Tiles, emitted: &'a Field, materials: &[Material]) -> Self {
        let albedo = |tile: &Tile| materials[tile.surface as usize].optics.scattering();
        let direct = |tile: &Tile| match tile.area > 0.0 {
            true => emitted.sum(tile.plane, tile.centre, tiles.grids()[tile.plane].normal),
            false => 0.0,
        };
        Self {
            albedos: tiles.list().iter().map(albedo).collect(),
            direct: tiles.list().par_iter().map(direct).collect(),
            nodes: Nodes::new(tiles),
            tiles,
            emitted,
        }
    }

    /// A sum over all tiles, by their areas.
    fn sum(&self, value: impl Fn(usize) -> f64) -> f64 {
        let tiles = self.tiles.list().iter().enumerate();
        tiles.map(|(index, tile)| tile.area * value(index)).sum()
    }

    /// What each tile scatters of light straight from emitters and of this.
    fn scattered(&self, reflected: impl Fn(usize) -> f64) -> Vec<f64> {
        let tiles = 0..self.albedos.len();
        let scattered =
            |index: usize| self.albedos[index] * (self.direct[index] + reflected(index));
        tiles.map(scattered).collect()
    }

    pub(super) fn solve(&self) -> Solution {
        let (tiles, list) = (self.tiles, self.tiles.list());
        let borders: Vec<_> = tiles.borders().collect();
        // How much each node sees of each jump, node after node.
        let width = borders.len().max(1);
        let mut shares = vec![0.0; self.nodes.list.len() * width];
        let rows = shares.par_chunks_mut(width).zip(&self.nodes.list);
        rows.for_each(|(row, &(plane, node))| tiles.shares(plane, node, row));
        // At first as if light were even that is reflected more than once.
        let kept = self.sum(|tile| 1.0 - self.albedos[tile]);
        let least = KEPT * self.sum(|_| 1.0);
        let even = self.sum(|tile| self.albedos[tile] * self.direct[tile]) / kept.max(least);
        let mut scattered = self.scattered(|_| even);
        let mut reflections = 1;
        loop {
            // Those that lie under others come first.
            let mut above = scattered.clone();
            for (index, tile) in list.iter().enumerate() {
                above[index] -= tile.under.iter().map(|&it| above[it]).sum::<f64>();
            }
            let jumps: Vec<f64> = borders.iter().map(|&it| jump(&above, it)).collect();
            let rows = shares.par_chunks(width);
            let table = self
                .nodes
                .filled(rows.map(|row| product(row, &jumps)).collect());
            let next = self.scattered(|index| {
                let Tile { plane, cell, .. } = list[index];
                let corners = table.corners(plane, &tiles.grids()[plane], cell);
                0.25 * corners.iter().sum::<f64>()
            });
            let most = next.iter().copied().fold(0.0, f64::max);
            let changes = next
                .iter()
                .zip(&scattered)
                .map(|(new, old)| (new - old).abs());
            if changes.fold(0.0, f64::max) <= SETTLED * most || reflections == REFLECTIONS {
                return Solution {
                    scattered,
                    above,
                    table,
                };
            }
            scattered = next;
            reflections += 1;
        }
    }

    /// Root mean square over all surfaces of what a solution misses, relative to the mean of what they scatter; it is looked for
    /// at the corners of tiles and where walls are nearest to emitters.
    pub(super) fn unevenness(&self, solution: &Solution) -> f64 {
        let Solution {
            scattered, table, ..
        } = solution;
        let (grids, list) = (self.tiles.grids(), self.tiles.list());
        let emitted =
            |plane: usize, point: DVec3| self.emitted.sum(plane, point, grids[plane].normal);
        let direct = self.nodes.table(emitted);
        let mut squares = self.sum(|index| {
            let Tile { plane, cell, .. } = list[index];
            let [direct, reflected] =
                [&direct, table].map(|it| it.corners(plane, &grids[plane], cell));
            let light = direct
                .iter()
                .zip(reflected)
                .map(|(direct, reflected)| direct + reflected);
            let missed = light.map(|light| self.albedos[index] * light - scattered[index]);
            0.25 * missed.map(|it| it * it).sum::<f64>()
        });
        let lamps = list.iter().enumerate();
        let lamps = lamps.filter(|(index, lamp)| lamp.area > 0.0 && self.emitted.at(*index) > 0.0);
        for (_, lamp) in lamps {
            for (plane, grid) in grids.iter().enumerate().filter(|it| it.0 != lamp.plane) {
                let place = aside(grid, grid.place(lamp.centre));
                let (point, cell) = (grid.point(place), grid.cell(place));
                let here = |it: &Tile| it.plane == plane && it.cell == cell && it.area > 0.0;
                let Some(index) = list.iter().position(here) else {
                    continue;
                };
                let light = emitted(plane, point) + table.at(plane, grid, place);
                let missed = self.albedos[index] * light - scattered[index];
                // So bright it is about as far around as the lamp is away.
                let area = point.distance_squared(lamp.centre).min(list[index].area);
                squares += area * missed * missed;
            }
        }
        let mean = self.sum(|index| scattered[index]);
        (squares * self.sum(|_| 1.0)).sqrt() / mean
    }
}

/// The sum of products of two lists of one length, in an order that does well on any vector unit.
fn product(one: &[f64], other: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut sums = [0.0; LANES];
    let (ones, rest) = one.as_chunks::<LANES>();
    let (others, last) = other.as_chunks::<LANES>();
    for (one, other) in ones.iter().zip(others) {
        for lane in 0..LANES {
            sums[lane] += one[lane] * other[lane];
        }
    }
    let rest = rest.iter().zip(last).map(|(a, b)| a * b);
    sums.iter().sum::<f64>() + rest.sum::<f64>()
}
