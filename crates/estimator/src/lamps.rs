//! Which lamp a point of a walk looks at: mostly one that would send it much were nothing in the way.
//!
//! Of the lamps of a large room a point sees two or three well. Were they chosen by flux alone, the variance of what one look
//! brings would grow as their number.

use crate::cumulated::Cumulated;
use crate::mirrors::{Each, Viewer};
use glam::DVec3;
use malus_geometry::Facet;
use malus_scene::SourceKind;
use std::f64::consts::PI;

/// Share of the looks that go by what lamps would send. The others go by flux: for what is seen in mirrors, and past what
/// stands before the best.
const GUIDED: f64 = 0.75;

/// All entries of a table of emitters, parted into lamps.
#[derive(Debug)]
pub(crate) struct Lamps {
    lamps: Vec<Lamp>,
    /// Whether there is something to choose between.
    several: bool,
    /// Share of all flux that has no place.
    rest: f64,
}

/// Emitters that lie together.
#[derive(Debug)]
struct Lamp {
    /// Its flux, and its share of all flux.
    flux: f64,
    share: f64,
    /// Its entries of the table, and their flux.
    entries: Vec<u32>,
    fluxes: Cumulated,
    reach: Reach,
}

/// What of a lamp tells how much it sends to a point.
#[derive(Debug)]
pub(crate) enum Reach {
    /// A flat patch that emits on the side of its normal, and a ball about it.
    Patch {
        centre: DVec3,
        normal: DVec3,
        radius: f64,
    },
    /// A source without geometry.
    Source(SourceKind),
    /// Here and there: chosen by flux alone.
    Unknown,
}

/// An emitter that a point looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Chosen {
    /// Its entry of the table.
    pub entry: usize,
    /// Where within that: a uniform number, so that points next to each other look at places next to each other.
    pub within: f64,
    /// Probability of the choice relative to one by flux.
    pub preference: f64,
}

impl Lamps {
    /// Parts a table into lamps; `entries` are the flux of each entry and the number of its lamp.
    pub(crate) fn new(reaches: Vec<Reach>, entries: impl Iterator<Item = (f64, usize)>) -> Self {
        let mut parts = vec![(Vec::new(), Vec::new()); reaches.len()];
        for (entry, (flux, lamp)) in (0..).zip(entries) {
            parts[lamp].0.push(entry);
            parts[lamp].1.push(flux);
        }
        let flux = |part: &(Vec<u32>, Vec<f64>)| part.1.iter().sum::<f64>();
        let total: f64 = parts.iter().map(flux).sum();
        let lamps = parts.into_iter().zip(reaches).map(|(part, reach)| {
            let flux = flux(&part);
            Lamp {
                flux,
                share: flux / total,
                entries: part.0,
                fluxes: Cumulated::new(part.1.into_iter()),
                reach,
            }
        });
        let lamps: Vec<Lamp> = lamps.collect();
        let unknown = |lamp: &&Lamp| matches!(lamp.reach, Reach::Unknown);
        let rest = lamps.iter().filter(unknown).map(|lamp| lamp.share).sum();
        let shining = lamps.iter().filter(|lamp| lamp.share > 0.0).count();
        Self {
            several: shining > 1 && rest < 1.0,
            rest,
            lamps,
        }
    }

    /// Whether a viewer prefers some of them: sensors know what they see straight.
    pub(crate) fn guide(&self, viewer: &Viewer) -> bool {
        self.several && !viewer.sensor
    }

    /// Chooses an emitter for a viewer that they guide, by a uniform number.
    pub(crate) fn choose(&self, viewer: &Viewer, u: f64) -> Chosen {
        let promises = self.promises(viewer);
        let all: f64 = promises.iter().sum();
        let mut below = 0.0;
        let mut chosen = (&self.lamps[0], 0.0, 1.0);
        for (lamp, promise) in self.lamps.iter().zip(promises) {
            let preference = self.preferred(lamp, promise, all);
            let probability = lamp.share * preference;
            if probability > 0.0 {
                let within = ((u - below) / probability).clamp(0.0, 1.0 - f64::EPSILON);
                chosen = (lamp, within, preference);
            }
            below += probability;
            if u < below {
                break;
            }
        }
        let (lamp, within, preference) = chosen;
        let (entry, within) = lamp.fluxes.choose(lamp.entries.len(), within);
        Chosen {
            entry: lamp.entries[entry] as usize,
            within,
            preference,
        }
    }

    /// Probability with which a viewer chooses an emitter of a lamp, relative to a choice by flux.
    pub(crate) fn preference(&self, viewer: &Viewer, lamp: usize) -> f64 {
        if !self.guide(viewer) {
            return 1.0;
        }
        let promises = self.promises(viewer);
        self.preferred(&self.lamps[lamp], promises[lamp], promises.iter().sum())
    }

    fn preferred(&self, lamp: &Lamp, promise: f64, all: f64) -> f64 {
        match lamp.reach {
            Reach::Unknown => 1.0,
            _ if all <= 0.0 || lamp.share <= 0.0 => 1.0,
            _ => 1.0 - GUIDED + GUIDED * (1.0 - self.rest) * promise / (all * lamp.share),
        }
    }

    /// About the irradiance that a viewer receives from each, were nothing in the way.
    fn promises(&self, viewer: &Viewer) -> Each<f64> {
        let promise = |lamp: &Lamp| {
            let promise = lamp.reach.promise(viewer, lamp.flux);
            if promise.is_finite() { promise } else { 0.0 }
        };
        self.lamps.iter().map(promise).collect()
    }
}

impl Reach {
    /// That of a flat patch.
    pub(crate) fn of(patch: &Facet) -> Self {
        let (centre, square) = patch.ball();
        Self::Patch {
            centre,
            normal: patch.normal,
            radius: square.sqrt(),
        }
    }

    /// About the irradiance that a viewer receives of a lamp of this flux, were nothing in the way.
    fn promise(&self, viewer: &Viewer, flux: f64) -> f64 {
        match self {
            Self::Patch {
                centre,
                normal,
                radius,
            } => {
                let span = centre - viewer.point;
                let square = span.length_squared() + radius * radius;
                // Some of it may stand above the horizon where its centre does not.
                let received = (span.dot(viewer.normal) + radius).max(0.0);
                let sent = -span.dot(*normal).min(0.0);
                flux / PI * received * sent / (square * square)
            }
            Self::Source(SourceKind::Point {
                position,
                intensity,
                distribution,
            }) => {
                let span = position - viewer.point;
                let square = span.length_squared();
                let toward = span / square.sqrt();
                let received = toward.dot(viewer.normal).max(0.0);
                intensity * distribution.share(-toward) * received / square
            }
            Self::Source(SourceKind::Distant {
                direction,
                irradiance,
            }) => irradiance * -direction.dot(viewer.normal).min(0.0),
            Self::Unknown => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use malus_scene::Distribution;

    fn point(position: DVec3, intensity: f64) -> Reach {
        Reach::Source(SourceKind::Point {
            position,
            intensity,
            distribution: Distribution::Isotropic,
        })
    }

    #[test]
    fn every_emitter_is_chosen_as_often_as_its_preference_says() {
        let (near, far) = (point(DVec3::Z, 1.0), point(DVec3::new(9.0, 0.0, 1.0), 4.0));
        // The last two have no place.
        let fluxes = [1.0, 4.0, 2.0, 3.0];
        let lamps = Lamps::new(
            vec![near, far, Reach::Unknown],
            fluxes.into_iter().zip([0, 1, 2, 2]),
        );
        let viewer = Viewer {
            point: DVec3::ZERO,
            normal: DVec3::Z,
            sensor: false,
        };
        assert!(lamps.guide(&viewer));
        assert!(!lamps.guide(&Viewer {
            sensor: true,
            ..viewer
        }));
        const DRAWS: u32 = 100_000;
        let mut counts = [0u32; 4];
        for draw in 0..DRAWS {
            let u = (f64::from(draw) + 0.5) / f64::from(DRAWS);
            let chosen = lamps.choose(&viewer, u);
            assert!((0.0..1.0).contains(&chosen.within));
            let lamp = [0, 1, 2, 2][chosen.entry];
            let preference = lamps.preference(&viewer, lamp);
            assert!((chosen.preference - preference).abs() < 1e-15);
            counts[chosen.entry] += 1;
        }
        for ((count, flux), lamp) in counts.into_iter().zip(fluxes).zip([0, 1, 2, 2]) {
            let expected = flux / 10.0 * lamps.preference(&viewer, lamp);
            assert!((f64::from(count) / f64::from(DRAWS) - expected).abs() < 1.1e-5);
        }
        // Of the half that has a place, three quarters are guided: E = I cos θ/r² is 1 and 4/82^(3/2).
        let promised = [1.0, 4.0 / 82f64.powf(1.5)];
        let guided = 0.75 * 0.5 * promised[0] / (promised[0] + promised[1]);
        assert!((0.1 * lamps.preference(&viewer, 0) - (0.1 * 0.25 + guided)).abs() < 1e-14);
    }
}
