//! Bridges: from where a walk from a sensor first scatters to where walks from the emitters do.
//!
//! A walk from an emitter that is joined to the sensor itself brings noise beside surfaces, and one from a sensor that goes on
//! by itself is dear and finds light of many reflections by luck. Between them both may be short: what a sensor sees of a
//! surface is lit by walks that have been taken already (a connection of bidirectional path tracing, Veach & Guibas 1995).

use crate::launched::Rival;
use crate::medium::Medium;
use crate::path::Vertex;
use crate::random::{Purpose, Uniforms};
use glam::DVec3;
use malus_geometry::Surfaces;
use std::f64::consts::PI;
use std::ops::Range;

/// Walks from the emitters that one walk from a sensor is joined to: where no ray has to tell what they see, and elsewhere.
const WALKS_IN_CELLS: u64 = 16;
const WALKS: u64 = 4;

/// What bridges count for in the weights where a ray has to tell: one landing stands for all of them then, and its luck for
/// theirs.
const UNSEEN: f64 = 0.3;

/// How much of what such walks bring is chance that the walks from one sensor share, as they are joined to the same ones: to
/// all points of these in a cell, to one point elsewhere.
const SHARED_IN_CELLS: f64 = 0.03;
const SHARED: f64 = 0.2;

/// The least number of walks from the emitters in a block.
const FEWEST: u64 = 2;

/// How many of the points where one walk from an emitter scatters are surely kept, and of those where one from a sensor may
/// scatter first are surely joined: of later ones the i-th is as often as this over i. Between good mirrors a walk scatters a
/// little at each of a million.
const SURE: u32 = 16;

/// The probability with which the point of a walk at a depth takes part, where it does.
pub(crate) fn taking_part(uniforms: Uniforms, depth: u32) -> Option<f64> {
    let chance = (f64::from(SURE) / f64::from(depth)).min(1.0);
    let drawn = chance >= 1.0 || uniforms.at(depth, Purpose::Bridge)[0] < chance;
    drawn.then_some(chance)
}

/// How many walks from the emitters one from a sensor is joined to: a power of two.
pub(crate) fn walks(surfaces: &Surfaces) -> u64 {
    match surfaces.has_cells() {
        true => WALKS_IN_CELLS,
        false => WALKS,
    }
}

/// What a block of so many walks from the emitters, that a walk from a sensor is joined to, counts for in the weights where
/// `launched` of them are taken for one from the sensor, and by a ray to one of their points unless the scene has `cells`.
///
/// Where all walks from a sensor first scatter near one place, in a corner say, each is joined to about the same: then
/// there is as much luck in all these bridges as in the walks from the emitters themselves.
pub(crate) fn worth(block: u64, launched: f64, cells: bool) -> f64 {
    if block == 0 {
        return 0.0;
    }
    let (seen, shared) = match cells {
        true => (1.0, SHARED_IN_CELLS),
        false => (UNSEEN, SHARED),
    };
    seen / (1.0 / block as f64 + shared / launched)
}

/// The walks from the emitters, `partner` among them, that one from a sensor is joined to: so many, but fewer of the first, so
/// that hardly a walk is taken for the sake of bridges alone. A run that is looked at once an octave up to 16 walks, and twice
/// from then on, has launched whole blocks whenever it is.
pub(crate) fn block(partner: u64, walks: u64) -> Range<u64> {
    let octave = partner.max(FEWEST).ilog2();
    let size = 1 << if octave < 4 { octave } else { octave - 1 };
    let size = walks.min(size);
    let first = partner - partner % size;
    first..first + size
}

/// Where a walk from an emitter scatters.
#[derive(Debug, Clone)]
pub(crate) struct Landing {
    /// Index of the material.
    pub material: u32,
    /// Where, off the surface.
    pub position: DVec3,
    /// Unit normal on that side.
    pub normal: DVec3,
    /// Points of one cell see each other; `None`: a ray has to tell.
    pub cell: Option<u32>,
    /// Whether what it scatters is polarised, and by angle.
    pub polarises: bool,
    /// The greatest of its fluxes.
    pub most: f64,
    /// The first of those in a row up to this one that lie in its cell and scatter evenly; none where it does not.
    alike: usize,
    /// What competes with joining it to a sensor.
    rival: Rival,
    /// Walks from the sensor that find the emitter by themselves, where that is the same in all directions.
    searching: f64,
}

/// Where a walk from a sensor first scatters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Abutment {
    /// Where, off the surface.
    pub position: DVec3,
    /// Unit normal on that side.
    pub normal: DVec3,
    /// As in [`Landing::cell`].
    pub cell: Option<u32>,
    /// Probability with which the walk goes on from there into a random direction.
    pub onward: f64,
    /// Walks from emitters that it is joined to, as the weights have it.
    pub walks: f64,
}

impl Abutment {
    /// Irradiance for one unit of flux that a landing scatters, unless something is in the way, weighted against other
    /// techniques, in 1/m². `diffuse` says with which probability a walk that comes along a direction is scattered there.
    #[inline]
    pub(crate) fn weight(&self, landing: &Landing, diffuse: impl Fn(DVec3) -> f64) -> f64 {
        let searching = match landing.polarises {
            true => {
                let direction = (landing.position - self.position).normalize();
                landing.rival.searching(diffuse(direction))
            }
            false => landing.searching,
        };
        self.weight_beside(landing, searching)
    }

    /// The same beside walks from the sensor that find the emitter by themselves at a given density.
    #[inline]
    fn weight_beside(&self, landing: &Landing, searching: f64) -> f64 {
        let span = landing.position - self.position;
        let cosines = span.dot(self.normal).max(0.0) * -span.dot(landing.normal).min(0.0);
        let square = span.length_squared();
        // Of G/(1 + G r) with the coupling G = cosines/(π square²): next to each other in a corner points have a limit.
        let rivals = self.onward * searching / self.walks;
        let weight = cosines / (PI * square * square + cosines * rivals);
        if weight < f64::INFINITY { weight } else { 0.0 }
    }

    /// Adds what all landings bring that lie in its cell and scatter evenly.
    pub(crate) fn add_all(&self, partners: &Partners, lit: &mut [f64]) {
        match lit {
            [lit] => {
                for (landing, flux) in partners.landings.iter().zip(partners.fluxes) {
                    *lit += flux * self.weight_beside(landing, landing.searching);
                }
            }
            _ => {
                let fluxes = partners.fluxes.chunks_exact(partners.width.max(1));
                for (landing, fluxes) in partners.landings.iter().zip(fluxes) {
                    let weight = self.weight_beside(landing, landing.searching);
                    for (lit, flux) in lit.iter_mut().zip(fluxes) {
                        *lit += flux * weight;
                    }
                }
            }
        }
    }
}

/// What walks from the emitters, one after the other, bring to where they scatter, in one model.
#[derive(Debug, Default)]
pub(crate) struct Landings {
    walks: Vec<Range<usize>>,
    landings: Vec<Landing>,
    /// Variants and models that share the walks.
    width: usize,
    /// The flux that each scatters, in every variant and model that shares the walks.
    fluxes: Vec<f64>,
}

impl Landings {
    /// One more walk begins.
    pub(crate) fn start(&mut self) {
        let end = self.landings.len();
        self.walks.push(end..end);
    }

    /// Its next vertex that scatters, where it has met `depth` surfaces.
    pub(crate) fn push(
        &mut self,
        medium: &Medium,
        vertex: &Vertex,
        fluxes: &[f64],
        uniforms: Uniforms,
        depth: u32,
    ) {
        let Some(walk) = self.walks.last_mut() else {
            return;
        };
        // Nothing but the join to the sensor can find its light.
        if vertex.rival.alone {
            return;
        }
        let Some(chance) = taking_part(uniforms, depth) else {
            return;
        };
        let before = self.fluxes.len();
        self.width = fluxes.len();
        let cover = &medium.covers[vertex.material as usize];
        let polarises = cover.polarises_scattering();
        let cell = medium.surfaces.cell(vertex.position);
        let before_it = self.landings.last();
        let alike = match cell {
            Some(_) if !polarises => match before_it {
                Some(last) if last.cell == cell && last.alike < usize::MAX => last.alike,
                _ => self.landings.len(),
            },
            _ => usize::MAX,
        };
        self.fluxes.extend(fluxes.iter().map(|flux| flux / chance));
        self.landings.push(Landing {
            material: vertex.material,
            position: vertex.position,
            normal: vertex.normal,
            cell,
            polarises,
            alike,
            most: self.fluxes[before..].iter().copied().fold(0.0, f64::max),
            rival: vertex.rival,
            searching: vertex.rival.searching(cover.diffuse(1.0, 0.0)),
        });
        walk.end += 1;
    }
}

/// Walks from the emitters in a row, in every model that has walks of its own.
#[derive(Debug, Default)]
pub(crate) struct Launches {
    /// Index of the first.
    pub first: u64,
    /// Those of the main model.
    pub main: Landings,
    /// Those of the other.
    pub apart: Landings,
}

/// The walks from the emitters that one walk from a sensor is joined to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Partners<'a> {
    /// How many they are.
    pub walks: usize,
    /// Where they scatter.
    pub landings: &'a [Landing],
    /// Variants and models that share the walks.
    pub width: usize,
    /// The one cell that all of them lie in, and where they scatter evenly.
    pub cell: Option<u32>,
    fluxes: &'a [f64],
}

impl<'a> Partners<'a> {
    /// Those of a block of walks.
    pub(crate) fn new(landings: &'a Landings, first: u64, block: &Range<u64>) -> Self {
        let at = |walk: u64| (walk - first) as usize;
        let walks = &landings.walks[at(block.start)..at(block.end)];
        let range = walks[0].start..walks[walks.len() - 1].end;
        let width = landings.width;
        let landed = &landings.landings[range.clone()];
        let last = landed.last().filter(|it| it.alike <= range.start);
        Self {
            width,
            cell: last.and_then(|it| it.cell),
            walks: walks.len(),
            fluxes: &landings.fluxes[range.start * width..range.end * width],
            landings: landed,
        }
    }

    /// The flux that a landing scatters in every variant and model that shares the walks.
    pub(crate) fn fluxes(&self, landing: usize) -> &'a [f64] {
        &self.fluxes[landing * self.width..][..self.width]
    }
}

/// A landing that a ray may be sent to.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    landing: usize,
    /// The greatest of its fluxes.
    most: f64,
    /// Light that it and those before it would bring.
    until: f64,
}

/// Landings to choose from, in proportion to what they would bring.
#[derive(Debug, Default)]
pub(crate) struct Candidates(Vec<Candidate>);

impl Candidates {
    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Whether there is none.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// One more.
    pub(crate) fn push(&mut self, landing: usize, weight: f64, most: f64) {
        let until = self.0.last().map_or(0.0, |it| it.until) + weight * most;
        self.0.push(Candidate {
            landing,
            most,
            until,
        });
    }

    /// Chooses one by a uniform number, and gives its weight over the probability of that.
    pub(crate) fn choose(&self, uniform: f64) -> Option<(usize, f64)> {
        let total = self.0.last()?.until;
        let chosen = self.0.partition_point(|it| it.until <= uniform * total);
        let Candidate { landing, most, .. } = *self.0.get(chosen)?;
        Some((landing, total / most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_part_the_walks() {
        for walks in [WALKS, WALKS_IN_CELLS] {
            let mut end = 0;
            for partner in 0..1000 {
                let block = block(partner, walks);
                assert!(block.contains(&partner), "{partner} in {block:?}");
                assert!(block.start == end || block.end == end, "{block:?} {end}");
                assert!((FEWEST..=walks).contains(&(block.end - block.start)));
                end = block.end;
            }
            // A run that ends where it is looked at has launched no more.
            for looked in [2, 4, 8, 16, 24, 32, 48, 64, 96, 128] {
                assert_eq!(block(looked - 1, walks).end, looked);
            }
        }
    }

    #[test]
    fn candidates_are_chosen_without_bias() {
        // Weights for a unit of flux, and fluxes.
        let given = [(2.0, 0.5), (1e-6, 3.0), (0.25, 8.0), (7.0, 1e-3)];
        let mut candidates = Candidates::default();
        assert_eq!(candidates.choose(0.5), None);
        for (index, (weight, flux)) in given.into_iter().enumerate() {
            candidates.push(index, weight, flux);
        }
        const DRAWS: u32 = 1 << 20;
        let mut brought = [0.0; 4];
        for draw in 0..DRAWS {
            let uniform = (f64::from(draw) + 0.5) / f64::from(DRAWS);
            let (index, weight) = candidates.choose(uniform).unwrap();
            brought[index] += weight * given[index].1 / f64::from(DRAWS);
        }
        // Every draw brings all light, so one too many or too few is an error of 3.007/2²⁰.
        for (brought, (weight, flux)) in brought.into_iter().zip(given) {
            assert!((brought - weight * flux).abs() < 3.1 / f64::from(DRAWS));
        }
    }
}
