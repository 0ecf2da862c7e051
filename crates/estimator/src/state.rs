//! What a run has summed so far: enough to go on from, and to tell results from.

use crate::statistics::{MergeError, REPLICAS, Tally};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A part of a run that is computed by itself, `index` of `count`: whole replicas, and whole bands of pictures.
///
/// Those with the number r belong to it for which r mod `count` = `index` − 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "(u32, u32)", into = "(u32, u32)")]
pub struct Shard {
    index: u32,
    count: u32,
}

/// Why a shard cannot be.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("expected I/N with whole numbers 1 ≤ I ≤ N ≤ {REPLICAS}, found {found:?}")]
pub struct NoShard {
    found: String,
}

impl Shard {
    /// All of a run.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Shard `index` of `count`, where 1 ≤ `index` ≤ `count` ≤ [`REPLICAS`].
    ///
    /// # Errors
    /// There is no such shard.
    pub fn new(index: u32, count: u32) -> Result<Self, NoShard> {
        if (1..=count).contains(&index) && count <= REPLICAS {
            Ok(Self { index, count })
        } else {
            Err(NoShard {
                found: format!("{index}/{count}"),
            })
        }
    }

    /// Which one, from 1.
    #[must_use]
    pub fn index(self) -> u32 {
        self.index
    }

    /// Of how many.
    #[must_use]
    pub fn count(self) -> u32 {
        self.count
    }

    /// Whether the replica or band of that number belongs to it.
    #[must_use]
    pub fn owns(self, number: u32) -> bool {
        number % self.count == self.index - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = NoShard;

    fn from_str(text: &str) -> Result<Self, NoShard> {
        let numbers = text.split_once('/').and_then(|(index, count)| {
            let number = |text: &str| text.trim().parse::<u32>().ok();
            Some((number(index)?, number(count)?))
        });
        numbers
            .and_then(|(index, count)| Self::new(index, count).ok())
            .ok_or_else(|| NoShard { found: text.into() })
    }
}

impl TryFrom<(u32, u32)> for Shard {
    type Error = NoShard;

    fn try_from((index, count): (u32, u32)) -> Result<Self, NoShard> {
        Self::new(index, count)
    }
}

impl From<Shard> for (u32, u32) {
    fn from(shard: Shard) -> Self {
        (shard.index, shard.count)
    }
}

/// What a run, or a shard of one, has summed so far.
///
/// It is a function of scene, settings and the number of walks alone: not of the stopping rule, of threads, or of how
/// often it was set aside and taken up again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Sums at the sensors.
    pub(crate) walks: Tally,
    /// Sums of the energy ledger; they are made at the end of a run.
    pub(crate) books: Tally,
}

/// Why a run cannot go on from a state.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum StateError {
    /// It is of another scene or of other settings.
    #[error(transparent)]
    Other(#[from] MergeError),
    /// Its replicas have not come equally far.
    #[error("replica {id} has taken {found} walks, the others {expected}")]
    Uneven {
        /// The replica.
        id: u32,
        /// Walks that it has taken.
        found: u64,
        /// Walks that the others have taken.
        expected: u64,
    },
    /// It has come further than the run is to go.
    #[error("it holds {found} samples already, and {asked} are asked for")]
    Beyond {
        /// Samples taken.
        found: u64,
        /// Samples asked for.
        asked: u64,
    },
}

impl State {
    /// The beginning of a run, or of a shard of one.
    #[must_use]
    pub fn new(shard: Shard) -> Self {
        let empty = || Tally::new((0..REPLICAS).filter(|&id| shard.owns(id)), 0);
        Self {
            walks: empty(),
            books: empty(),
        }
    }

    /// Samples taken so far, as in [`crate::Results::samples`]: all replicas of the run count, also those of other shards.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.walks.points().saturating_mul(u64::from(REPLICAS))
    }

    /// Union with the replicas of another part of the same run.
    ///
    /// # Errors
    /// A replica stands on both sides, or the two are of different scenes or settings.
    pub fn merge(self, other: Self) -> Result<Self, MergeError> {
        Ok(Self {
            walks: self.walks.merge(other.walks)?,
            books: self.books.merge(other.books)?,
        })
    }

    /// Makes sure that it can be taken further by a run that ends after `limit` walks a replica.
    pub(crate) fn check(&self, limit: Option<u64>) -> Result<(), StateError> {
        let expected = self.walks.points();
        for replica in self.walks.replicas() {
            if replica.points != expected {
                return Err(StateError::Uneven {
                    id: replica.id,
                    found: replica.points,
                    expected,
                });
            }
        }
        match limit {
            Some(limit) if expected > limit => Err(StateError::Beyond {
                found: self.samples(),
                asked: limit.saturating_mul(u64::from(REPLICAS)),
            }),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_replica_belongs_to_one_shard() {
        for count in 1..=REPLICAS {
            let mut owned = vec![0; REPLICAS as usize];
            for index in 1..=count {
                let shard = Shard::new(index, count).unwrap();
                let replicas = State::new(shard);
                let before: u32 = owned.iter().sum();
                for replica in replicas.walks.replicas() {
                    owned[replica.id as usize] += 1;
                }
                // No shard has more than one replica above any other.
                let share = owned.iter().sum::<u32>() - before;
                assert!(share == REPLICAS / count || share == REPLICAS / count + 1);
            }
            assert!(owned.iter().all(|&times| times == 1), "{count}: {owned:?}");
        }
    }

    #[test]
    fn a_shard_reads_as_it_is_written() {
        let shard: Shard = "3/8".parse().unwrap();
        assert_eq!((shard.index(), shard.count()), (3, 8));
        assert_eq!(shard.to_string(), "3/8");
        for text in [
            "", "3", "0/8", "9/8", "1/33", "1/0", "-1/8", "1/8/2", "a/b", "1.5/8",
        ] {
            let error = text.parse::<Shard>().unwrap_err().to_string();
            assert!(
                error.contains("1 ≤ I ≤ N ≤ 32") && error.contains(text),
                "{error}"
            );
        }
    }

    #[test]
    fn a_state_that_cannot_be_taken_further_says_why() {
        let mut state = State::new(Shard::WHOLE);
        for replica in state.walks.replicas_mut() {
            replica.points = 16;
        }
        assert_eq!(state.samples(), 512);
        assert_eq!(state.check(None), Ok(()));
        assert_eq!(state.check(Some(16)), Ok(()));
        let beyond = StateError::Beyond {
            found: 512,
            asked: 480,
        };
        assert_eq!(state.check(Some(15)), Err(beyond));
        let last = state.walks.replicas_mut().last().unwrap();
        last.points = 17;
        let uneven = StateError::Uneven {
            id: REPLICAS - 1,
            found: 17,
            expected: 16,
        };
        assert_eq!(state.check(None), Err(uneven));
    }
}
