//! A coarse solution of the radiosity equation, which walks from the sensors correct.
//!
//! In an empty convex room without mirrors let B be what surfaces scatter (their exitance), B̂ a guess that is constant on
//! tiles, and K the operator that gives the irradiance by an exitance. What a sensor has of B̂ is a sum of form factors, without
//! chance. The rest, Δ = B − B̂, obeys Δ = r + ρKΔ with r = ρ(D + KB̂) − B̂ and D the irradiance straight from the emitters:
//! walks from the sensors add up r as they would what surfaces emit, and r is small where the guess is good (B̂ is a control
//! variate; Lafortune & Willems 1995 have one that is constant in the whole scene).
//!
//! D and KB̂ are sums over lines at which an exitance jumps. Those of all tiles are too many for every vertex: there a table
//! stands for KB̂, and now and then what the table lacks is made up for, with a weight of one over how often.

mod solution;

use crate::beam::form_factor;
use crate::cover::Cover;
use crate::medium::Medium;
use crate::pass::has_mirrors;
use crate::receiver::Receiver;
use glam::DVec3;
use malus_geometry::{Field, Surfaces, Tiles};
use solution::{Room, Solution, Table};

/// Cells of a room, about.
const CELLS: usize = 150;

/// How often the table is made up for.
const CORRECTED: f64 = 0.125;

/// Most lines about emitters: beyond, looking at one of them costs less than their irradiance.
const LINES: usize = 512;

/// Root mean square of what the guess misses, relative to the mean exitance, from which on it is of no use: light so uneven is
/// found by walks from the emitters.
const UNEVEN: f64 = 0.7;

/// The guess.
pub(crate) struct Radiosity<'a> {
    surfaces: &'a Surfaces,
    tiles: Tiles,
    /// What emitters send off, in unit/m².
    emitted: Field,
    /// What each tile is guessed to scatter, less what the tiles under it are; in unit/m².
    scattered: Field,
    /// Irradiance by that guess, in unit/m².
    table: Table,
}

/// What is guessed of a point of a surface, in unit/m².
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Guess {
    /// Its irradiance by emitters and by all that is guessed to be scattered, without bias.
    pub irradiance: f64,
    /// What it is guessed to scatter itself.
    pub exitance: f64,
}

impl<'a> Radiosity<'a> {
    /// A guess, where sensors see the whole of a room and nothing in it polarises.
    pub(crate) fn new(medium: &Medium<'a>, receivers: &[Receiver]) -> Option<Self> {
        let Medium { surfaces, .. } = *medium;
        let mut free = receivers.iter().filter(|it| !it.enclosed);
        let inside = free.clone().next()?.origin;
        let cell = surfaces.cell(inside)?;
        let plain = medium.variations.len() == 1
            && !medium.panes
            && !has_mirrors(medium.materials)
            && !medium.covers.iter().any(Cover::polarises_scattering)
            && medium.emitters.source_count() == 0
            && free.all(|it| it.is_irradiance() && surfaces.cell(it.origin) == Some(cell));
        if !plain {
            return None;
        }
        let tiles = Tiles::new(surfaces, inside, CELLS)?;
        let materials = &medium.first().materials;
        let emitted = emitted(&tiles, medium)?;
        let room = Room::new(&tiles, &emitted, materials);
        let solution = room.solve();
        let of_use = room.unevenness(&solution) <= UNEVEN;
        let Solution { above, table, .. } = solution;
        of_use.then(|| Self {
            surfaces,
            scattered: tiles.field(above),
            emitted,
            table,
            tiles,
        })
    }

    /// Irradiance by the guess at a sensor, in unit/m².
    pub(crate) fn at_sensor(&self, receiver: &Receiver) -> f64 {
        let Receiver {
            origin,
            normal,
            enclosed,
            ..
        } = *receiver;
        match enclosed {
            true => 0.0,
            false => {
                let form_factor = |corners: &[DVec3]| form_factor(origin, normal, corners);
                let Self {
                    tiles, scattered, ..
                } = self;
                tiles.sum_in_room(scattered, origin, normal, form_factor)
            }
        }
    }

    /// The guess for a point (in m) with this unit normal where a triangle is met; `chance` is uniform in [0, 1).
    #[inline]
    pub(crate) fn at(&self, triangle: u32, point: DVec3, normal: DVec3, chance: f64) -> Guess {
        let plane = self.tiles.plane(triangle);
        let tiles = self.tiles.at(self.surfaces, triangle, point);
        let exitance = tiles.map(|tile| self.scattered.at(tile)).sum();
        // Off its plane, or past its edge, a point would see the back of others.
        let grid = &self.tiles.grids()[plane];
        let place = grid.within(grid.place(point));
        let point = grid.point(place);
        let table = self.table.at(plane, grid, place);
        let lacking = match chance < CORRECTED {
            true => self.scattered.sum(plane, point, normal) - table,
            false => 0.0,
        };
        Guess {
            irradiance: self.emitted.sum(plane, point, normal) + table + lacking / CORRECTED,
            exitance,
        }
    }
}

/// The exitances of emitters by tile; `None` where a tile does not say all of them.
fn emitted(tiles: &Tiles, medium: &Medium) -> Option<Field> {
    let Medium { surfaces, .. } = *medium;
    let materials = &medium.first().materials;
    let exitance = |surface: u32| {
        let emission = materials[surface as usize].emission.as_ref();
        emission.map_or(0.0, |it| it.exitance)
    };
    // One that shines into the room with all of its area, or not at all.
    let told = |triangle: u32| {
        let inward = tiles.grids()[tiles.plane(triangle)].normal;
        exitance(surfaces.surface(triangle)) <= 0.0
            || surfaces.normal(triangle).dot(inward) > 0.0
                && surfaces.exposed_area(triangle) >= surfaces.triangle(triangle).area()
    };
    let values = tiles.list().iter().map(|tile| exitance(tile.surface));
    let field = tiles.field(values.collect());
    ((0..surfaces.len() as u32).all(told) && field.lines() <= LINES).then_some(field)
}
