//! Sensors that stand near one another and share what their walks find.
//!
//! What a surface scatters unpolarised goes to all of them alike. So a walk that one sensor has taken to where it first
//! scatters serves every other that sees this point, each by its density over the sum of all densities with which the
//! walks of the sensors come there (re-use of paths; Bekaert, Sbert & Halton 2002, with the balance heuristic).

use crate::receiver::{Receiver, coupling};
use glam::DVec3;
use malus_geometry::{Surfaces, Targets};

/// Sensors that share their walks.
#[derive(Debug)]
pub(crate) struct Neighbours {
    /// Which sensors they are.
    pub members: Vec<usize>,
    /// Where each stands, its normal, and how many walks it takes in a round; no normal of one that does not share.
    places: Vec<(DVec3, DVec3, u32)>,
    targets: Targets,
}

/// One of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Member<'a> {
    /// All of them.
    pub neighbours: &'a Neighbours,
    /// Its place among them.
    pub place: usize,
}

/// To which neighbours each sensor belongs, by where they stand; those that do not read irradiance are alone.
pub(crate) fn memberships(surfaces: &Surfaces, receivers: &[Receiver]) -> Vec<usize> {
    let near: Vec<usize> = (0..receivers.len())
        .filter(|&sensor| receivers[sensor].is_irradiance())
        .collect();
    let place = |&sensor: &usize| (receivers[sensor].origin, receivers[sensor].normal);
    let targets = surfaces.targets(&near.iter().map(place).collect::<Vec<_>>());
    let mut memberships = vec![usize::MAX; receivers.len()];
    let mut count = 0;
    for cluster in targets.clusters() {
        for &index in cluster {
            memberships[near[index as usize]] = count;
        }
        count += 1;
    }
    for membership in &mut memberships {
        if *membership == usize::MAX {
            *membership = count;
            count += 1;
        }
    }
    memberships
}

impl Neighbours {
    /// All sensors of a run, by their `memberships`, with the `times` of walks that each takes in a round; whether they
    /// `share` them.
    pub(crate) fn all(
        surfaces: &Surfaces,
        receivers: &[Receiver],
        memberships: &[usize],
        times: &[u32],
        share: bool,
    ) -> Vec<Self> {
        let count = memberships.iter().max().map_or(0, |last| last + 1);
        let mut members = vec![Vec::new(); count];
        for (sensor, &membership) in memberships.iter().enumerate() {
            members[membership].push(sensor);
        }
        let neighbours = |members: Vec<usize>| {
            let place = |&sensor: &usize| {
                let Receiver {
                    origin,
                    normal,
                    enclosed,
                    ..
                } = receivers[sensor];
                let takes_part = share && receivers[sensor].is_irradiance() && !enclosed;
                let facing = if takes_part { normal } else { DVec3::ZERO };
                (origin, facing, times[sensor])
            };
            let places: Vec<_> = members.iter().map(place).collect();
            let targets: Vec<_> = places.iter().map(|it| (it.0, it.1)).collect();
            Self {
                targets: surfaces.targets(&targets),
                places,
                members,
            }
        };
        members.into_iter().map(neighbours).collect()
    }

    /// Walks in a round that serve the same sensor.
    pub(crate) fn round(&self) -> u32 {
        let sharing = (0..self.places.len()).filter(|&place| self.share(place));
        sharing.map(|place| self.times(place)).sum::<u32>().max(1)
    }

    /// Walks that one of them takes in a round.
    pub(crate) fn times(&self, place: usize) -> u32 {
        self.places[place].2
    }

    /// Whether what one finds goes to others, and what they find to it.
    pub(crate) fn share(&self, place: usize) -> bool {
        self.places[place].1 != DVec3::ZERO
    }
}

/// The sums of each sensor, given to those that it shares walks with.
pub(crate) fn shared_out<'s>(
    neighbours: &[Neighbours],
    sums: impl Iterator<Item = &'s mut [f64]>,
) -> Vec<Vec<&'s mut [f64]>> {
    let mut left: Vec<Option<&mut [f64]>> = sums.map(Some).collect();
    let taken = |neighbours: &Neighbours| {
        let members = neighbours.members.iter();
        members.filter_map(|&sensor| left[sensor].take()).collect()
    };
    neighbours.iter().map(taken).collect()
}

impl Member<'_> {
    /// Sets for each neighbour its share in what a walk of this one finds behind a point that it has met straight, given with
    /// the same point moved off its surface; they add up to 1. Returns its own.
    pub(crate) fn share(
        self,
        surfaces: &Surfaces,
        [point, off]: [DVec3; 2],
        normal: DVec3,
        seen: &mut Vec<bool>,
        shares: &mut Vec<f64>,
    ) -> f64 {
        let Self { neighbours, place } = self;
        surfaces.visible_from(off, normal, &neighbours.targets, seen);
        // The walk has come from there.
        seen[place] = true;
        shares.clear();
        let places = neighbours.places.iter().zip(&*seen);
        shares.extend(places.map(|(&(sensor, facing, times), &seen)| match seen {
            true => f64::from(times) * coupling(sensor - point, normal, facing),
            false => 0.0,
        }));
        let all: f64 = shares.iter().sum();
        if !(shares[place] > 0.0 && all < f64::INFINITY) {
            shares.fill(0.0);
            shares[place] = 1.0;
        } else {
            for share in &mut *shares {
                *share /= all;
            }
        }
        shares[place]
    }
}
