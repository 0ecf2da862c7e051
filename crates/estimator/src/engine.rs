//! What a run works with: the walks it takes, and the sums they go to.

use crate::allocation::Allocation;
use crate::bridge::{self, Launches};
use crate::direct::{Cells, direct};
use crate::gather::{Aims, Observers, gather};
use crate::local::{Sensors, local};
use crate::neighbours::{Neighbours, shared_out};
use crate::pass::{Channels, Effort, Passes};
use crate::random::Stream;
use crate::receiver::Receiver;
use crate::statistics::{MergeError, REPLICAS, Replica, Tally};
use malus_geometry::Targets;
use rayon::prelude::*;
use std::ops::Range;

/// Walks that a step takes in all, so that a watcher is asked several times a second.
const STEP: u64 = 1 << 14;

/// How many it may take to end with a block of those that walks from sensors are joined to.
const LONGEST_STEP: u64 = 1 << 19;

/// A scene made ready for `N` components.
pub(crate) struct Engine<'a, const N: usize> {
    /// The walks.
    pub passes: Passes<'a>,
    /// The sums of each variant at each sensor.
    pub channels: Channels,
    /// The sensors.
    pub receivers: &'a [Receiver],
    /// The sensors, to be asked which of them a point sees.
    pub targets: &'a Targets,
    /// Whether sensors share walks of their own, and those that do.
    pub share: bool,
    pub neighbours: &'a [Neighbours],
    /// Walks from each sensor, relative to those from the emitters.
    pub allocation: &'a Allocation,
    /// How each sensor aims at small mirrors.
    pub aims: &'a [Aims<'a>],
    /// The cells in which `direct` counts, where that was asked for.
    pub cells: Option<&'a Cells>,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl<const N: usize> Engine<'_, N> {
    /// Gives the replicas of a run that begins their sums.
    ///
    /// # Errors
    /// Those of a run that goes on do not fit.
    pub(crate) fn fit(&self, tally: &mut Tally) -> Result<(), MergeError> {
        // Walks from sensors first, walks from emitters after them: each sum belongs to one kind of walk.
        tally.fit(2 * self.length())
    }

    /// Sums of one kind of walk.
    #[must_use]
    pub(crate) fn length(&self) -> usize {
        self.receivers.len() * self.width()
    }

    /// Sums of one kind of walk at one sensor.
    fn width(&self) -> usize {
        self.passes.main.variations.len() * self.channels.count
    }

    /// Walks a replica that make up one step.
    #[must_use]
    pub(crate) fn step(&self) -> u64 {
        // A walk that is only counted costs the same however many sensors there are.
        let joined = match self.cells {
            Some(_) => 1,
            None => self.receivers.len().max(1) as u64,
        };
        let joins = u64::from(REPLICAS) * joined;
        let step = (STEP / joins).max(1);
        // What is left of a block has to be launched again in the next step.
        let block = self.passes.techniques.block.max(1);
        if block * joins <= LONGEST_STEP {
            step.next_multiple_of(block)
        } else {
            step
        }
    }

    /// Takes every replica to `until` walks. Each sum is added to by one task, in the order of the walks.
    pub(crate) fn advance(&self, tally: &mut Tally, until: u64) {
        let replicas: Vec<&mut Replica> = tally.replicas_mut().collect();
        let techniques = self.passes.techniques;
        replicas.into_par_iter().for_each(|replica| {
            let mut effort = Effort::default();
            if let Some(cells) = self.cells {
                effort += self.advance_direct(cells, replica, until);
            } else {
                let mut launches = Launches::default();
                if techniques.local > 0.0 {
                    effort += self.advance_local(replica, until, &mut launches);
                }
                if techniques.gather {
                    effort += self.advance_gather(replica, until, &launches);
                }
            }
            replica.points = until;
            replica.truncated += effort.truncated;
        });
    }

    /// What walks from the emitters are joined to.
    fn sensors(&self) -> Sensors<'_> {
        Sensors {
            receivers: self.receivers,
            targets: self.targets,
            share: self.share,
            allocation: self.allocation,
        }
    }

    /// The walks from the emitters, of which this is one, that walks from sensors are joined to.
    fn block(&self, partner: u64) -> Range<u64> {
        bridge::block(partner, self.passes.techniques.block)
    }

    fn advance_local(&self, replica: &mut Replica, until: u64, launches: &mut Launches) -> Effort {
        let stream = Stream::new(self.seed, replica.id);
        // Walks from the sensors are joined to whole blocks of them.
        let mut whole = replica.points..until;
        if self.passes.techniques.block > 0 && !whole.is_empty() {
            whole = self.block(whole.start).start..self.block(whole.end - 1).end;
        }
        launches.first = whole.start;
        let mut launch = |sensors: &Sensors, range, sums: &mut [f64]| {
            local::<N>(
                &self.passes,
                &self.channels,
                sensors,
                stream,
                range,
                sums,
                launches,
            )
        };
        let nobody = Sensors {
            receivers: &[],
            ..self.sensors()
        };
        launch(&nobody, whole.start..replica.points, &mut []);
        let sums = &mut replica.sums[self.length()..];
        let effort = launch(&self.sensors(), replica.points..until, sums);
        launch(&nobody, until..whole.end, &mut []);
        effort
    }

    fn advance_direct(&self, cells: &Cells, replica: &mut Replica, until: u64) -> Effort {
        let stream = Stream::new(self.seed, replica.id);
        direct::<N>(
            &self.passes,
            &self.channels,
            self.receivers,
            cells,
            stream,
            replica.points..until,
            &mut replica.sums,
        )
    }

    fn advance_gather(&self, replica: &mut Replica, until: u64, launches: &Launches) -> Effort {
        let stream = Stream::new(self.seed, replica.id);
        let taken = replica.points;
        let sums = replica.sums[..self.length()].chunks_mut(self.width());
        let efforts: Vec<Effort> = shared_out(self.neighbours, sums)
            .into_par_iter()
            .zip(self.neighbours)
            .map(|(mut sums, neighbours)| {
                // All of them take as many rounds.
                let first = neighbours.members[0];
                let rounds = |launched| self.allocation.rounds(first, launched);
                gather::<N>(
                    &self.passes,
                    &self.channels,
                    Observers {
                        neighbours,
                        receivers: self.receivers,
                        aims: self.aims,
                        rivalry: self.allocation.rivalry(first),
                        launches,
                        partners: &|round| self.block(self.allocation.partner(first, round)),
                    },
                    stream,
                    rounds(taken)..rounds(until),
                    &mut sums,
                )
            })
            .collect();
        let mut total = Effort::default();
        for effort in efforts {
            total += effort;
        }
        total
    }
}
