//! What all variants of a study gave, kept in a journal: memory does not grow with what they measured.

use crate::findings::Given;
use crate::journal::Journal;
use crate::outcome::{Groups, Measured, Outcome};
use anyhow::{Context, Error, Result, ensure};
use std::sync::Arc;

/// What the scenes of one batch gave.
#[derive(Debug)]
pub struct Gave {
    /// The base, where it is evaluated along the same walks.
    pub base: Option<Groups>,
    /// The variants, or why one of them failed.
    pub variants: Vec<Result<Groups, String>>,
}

/// Where each sensor group of a scene begins in the journal, and where the last one ends.
type Places = Arc<[u64]>;

/// One scene of a batch, as the journal holds it.
pub struct Kept {
    /// What it is.
    pub outcome: Outcome,
    /// What it gave, or why it failed.
    pub own: Result<Groups, String>,
    /// What the base gave along the same walks, or by the same random numbers.
    pub base: Arc<Groups>,
    /// Where both are in the journal.
    places: [Places; 2],
}

/// The base and the variants, the base first.
pub struct Outcomes {
    journal: Journal,
    /// What they are.
    all: Vec<Outcome>,
    /// For each of them, where it is, and what the base gave along the same walks.
    places: Vec<[Places; 2]>,
}

impl Gave {
    /// The record of a batch with that digest.
    ///
    /// # Errors
    /// It cannot be written as bytes.
    pub fn record(&self, digest: u128) -> Result<Vec<u8>> {
        let head = (digest, self.base.is_some(), self.variants.len());
        let mut bytes = postcard::to_stdvec(&head)?;
        let base = self.base.iter().map(Ok);
        for scene in base.chain(self.variants.iter().map(Result::as_ref)) {
            let head = scene.map(Vec::len);
            bytes = postcard::to_extend(&head, bytes)?;
            for group in scene.into_iter().flatten() {
                bytes = postcard::to_extend(group, bytes)?;
            }
        }
        Ok(bytes)
    }

    /// What a record holds that lies at `place`, and where in the journal each scene's groups are.
    ///
    /// # Errors
    /// It is no record of a batch with that digest.
    fn read(record: &[u8], place: u64, digest: u128) -> Result<(Self, Vec<Places>)> {
        let ((found, base, variants), mut rest): ((u128, bool, usize), _) =
            postcard::take_from_bytes(record)?;
        ensure!(found == digest, CHANGED);
        let mut places = Vec::new();
        let mut scene = || -> Result<Result<Groups, String>> {
            let (head, left): (Result<usize, String>, _) = postcard::take_from_bytes(rest)?;
            rest = left;
            let here = |rest: &[u8]| place + (record.len() - rest.len()) as u64;
            let (mut own, mut groups) = (vec![here(rest)], Groups::new());
            for _ in 0..*head.as_ref().unwrap_or(&0) {
                let (group, left) = postcard::take_from_bytes(rest)?;
                rest = left;
                groups.push(group);
                own.push(here(rest));
            }
            places.push(own.into());
            Ok(head.map(|_| groups))
        };
        let base = base.then(&mut scene).transpose()?;
        let gave = Self {
            base: base.map(|it| it.map_err(Error::msg)).transpose()?,
            variants: (0..variants).map(|_| scene()).collect::<Result<_>>()?,
        };
        Ok((gave, places))
    }
}

/// What is said of a record of other variants than those that are to be there.
pub const CHANGED: &str =
    "holds other variants than those of the study as it is now: what it names has changed since";

impl Outcomes {
    /// None yet; those to come are kept in that journal.
    pub fn new(journal: Journal) -> Self {
        Self {
            journal,
            all: Vec::new(),
            places: Vec::new(),
        }
    }

    /// The journal in which they are kept.
    pub fn journal(&mut self) -> &mut Journal {
        &mut self.journal
    }

    /// How many there are, the base with them.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// What lies in the journal at `place`, of a batch with that digest: the base where it is not known yet and `first` says
    /// what it is, then the variants, which are `named`.
    ///
    /// # Errors
    /// The record is of another batch.
    pub fn read(
        &self,
        (place, record): (u64, &[u8]),
        digest: u128,
        first: Option<Outcome>,
        named: Vec<Outcome>,
    ) -> Result<Vec<Kept>> {
        let (gave, places) = Gave::read(record, place, digest)?;
        ensure!(gave.variants.len() == named.len(), CHANGED);
        let mut places = places.into_iter();
        let (of_base, base) = match gave.base {
            Some(base) => (places.next().context(CHANGED)?, base),
            None => self.base()?,
        };
        let base = Arc::new(base);
        let kept = |outcome, own, places| Kept {
            outcome,
            own,
            base: Arc::clone(&base),
            places: [places, Arc::clone(&of_base)],
        };
        let first = first.map(|it| kept(it, Ok(base.to_vec()), Arc::clone(&of_base)));
        let named = named.into_iter().zip(gave.variants).zip(places);
        let named = named.map(|((outcome, own), places)| kept(outcome, own, places));
        Ok(first.into_iter().chain(named).collect())
    }

    /// Counts one of them in.
    pub fn add(&mut self, kept: Kept) {
        self.all.push(kept.outcome);
        self.places.push(kept.places);
    }

    /// Where the base is, and what it gave.
    fn base(&self) -> Result<(Places, Groups)> {
        let [places, _] = self.places.first().context(CHANGED)?.clone();
        let groups = 0..places.len() - 1;
        let base = groups.map(|group| measured(&self.journal, &places, group));
        Ok((Arc::clone(&places), base.collect::<Result<_>>()?))
    }

    /// What all of them gave at one sensor group, those that have free points there.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn at(&self, group: usize) -> Result<Vec<Given<'_>>> {
        // Batches that share walks share what the base gave.
        let mut last: Option<(Places, Option<Arc<Measured>>)> = None;
        let mut given = Vec::new();
        for (outcome, [own, base]) in self.all.iter().zip(&self.places) {
            let known = last
                .as_ref()
                .filter(|(places, _)| Arc::ptr_eq(places, base));
            let of_base = match known {
                Some((_, known)) => known.clone(),
                None => {
                    let read = measured(&self.journal, base, group)?.map(Arc::new);
                    last = Some((Arc::clone(base), read.clone()));
                    read
                }
            };
            let Some(own) = measured(&self.journal, own, group)? else {
                if given.is_empty() {
                    // Without the base nothing is compared.
                    break;
                }
                continue;
            };
            given.push(Given {
                outcome,
                own,
                base: of_base,
            });
        }
        Ok(given)
    }

    /// Removes the journal.
    ///
    /// # Errors
    /// It is there to stay.
    pub fn remove(self) -> Result<()> {
        self.journal.remove()
    }
}

fn measured(journal: &Journal, places: &Places, group: usize) -> Result<Option<Measured>> {
    let [from, to] = [places[group], places[group + 1]];
    Ok(postcard::from_bytes(&journal.read(from, to - from)?)?)
}
