//! What a run works with: the walks it takes, and the sums they go to.

use crate::direct::{Cells, direct};
use crate::gather::gather;
use crate::local::local;
use crate::pass::{Channels, Effort, Passes};
use crate::random::Stream;
use crate::receiver::Receiver;
use crate::statistics::{REPLICAS, Replica, Tally};
use malus_scene::Estimator;
use rayon::prelude::*;

/// Walks that a step takes in all, so that a watcher is asked several times a second.
const STEP: u64 = 1 << 16;

/// Sensors of one replica that one task gathers at.
const TASK: usize = 16;

/// A scene made ready for `N` components.
pub(crate) struct Engine<'a, const N: usize> {
    /// The walks.
    pub passes: Passes<'a>,
    /// The sums at each sensor.
    pub channels: Channels,
    /// The sensors.
    pub receivers: &'a [Receiver],
    /// The cells in which `direct` counts, where that was asked for.
    pub cells: Option<&'a Cells>,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl<const N: usize> Engine<'_, N> {
    /// All replicas of a run, empty.
    #[must_use]
    pub(crate) fn tally(&self) -> Tally {
        Tally::new(0..REPLICAS, self.receivers.len() * self.channels.count)
    }

    /// Walks a replica that make up one step.
    #[must_use]
    pub(crate) fn step(&self) -> u64 {
        // A walk that is only counted costs the same however many sensors there are.
        let joined = match self.cells {
            Some(_) => 1,
            None => self.receivers.len().max(1) as u64,
        };
        (STEP / (u64::from(REPLICAS) * joined)).max(1)
    }

    /// Takes every replica to `until` walks. Each sum is added to by one task, in the order of the walks.
    pub(crate) fn advance(&self, estimator: Estimator, tally: &mut Tally, until: u64) -> Effort {
        let replicas: Vec<&mut Replica> = tally.replicas_mut().collect();
        let efforts: Vec<Effort> = if let (Estimator::Direct, Some(cells)) = (estimator, self.cells)
        {
            replicas
                .into_par_iter()
                .map(|replica| self.advance_direct(cells, replica, until))
                .collect()
        } else if estimator == Estimator::Local {
            replicas
                .into_par_iter()
                .map(|replica| self.advance_local(replica, until))
                .collect()
        } else {
            replicas
                .into_par_iter()
                .map(|replica| self.advance_gather(replica, until))
                .collect()
        };
        let mut total = Effort::default();
        for effort in efforts {
            total += effort;
        }
        total
    }

    fn advance_local(&self, replica: &mut Replica, until: u64) -> Effort {
        let stream = Stream::new(self.seed, replica.id);
        let effort = local::<N>(
            &self.passes,
            &self.channels,
            self.receivers,
            stream,
            replica.points..until,
            &mut replica.sums,
        );
        replica.points = until;
        effort
    }

    fn advance_direct(&self, cells: &Cells, replica: &mut Replica, until: u64) -> Effort {
        let stream = Stream::new(self.seed, replica.id);
        let effort = direct::<N>(
            &self.passes,
            &self.channels,
            self.receivers,
            cells,
            stream,
            replica.points..until,
            &mut replica.sums,
        );
        replica.points = until;
        effort
    }

    fn advance_gather(&self, replica: &mut Replica, until: u64) -> Effort {
        let stream = Stream::new(self.seed, replica.id);
        let range = replica.points..until;
        let efforts: Vec<Effort> = replica
            .sums
            .par_chunks_mut(self.channels.count)
            .zip(self.receivers)
            .enumerate()
            .with_min_len(TASK)
            .map(|(sensor, (sums, receiver))| {
                if receiver.enclosed {
                    return Effort::default();
                }
                let stream = stream.branch(sensor as u64);
                gather::<N>(
                    &self.passes,
                    &self.channels,
                    receiver,
                    stream,
                    range.clone(),
                    sums,
                )
            })
            .collect();
        replica.points = until;
        let mut total = Effort::default();
        for effort in efforts {
            total += effort;
        }
        total
    }
}
