//! The results of a study, written as its batches are finished.

use super::batch::Batch;
use super::course::Failed;
use super::outcomes::{Gave, Kept, Outcomes};
use super::variants::{Row, Variants};
use crate::conclusion::{self, Circumstances, Computed};
use crate::findings::Finding;
use crate::outcome::{Outcome, measured};
use crate::output::Directory;
use crate::report::print;
use crate::{rows, trade};
use anyhow::{Result, anyhow, ensure};
use malus_estimator::{Group, Together, half_width_95};
use malus_scene::{Base, Scene, Study};

/// Name of the scene as it stands among its variants.
const BASE: &str = "base";

/// What is written of a study, and how much of it.
pub struct Wanted<'a> {
    /// Where the files go.
    pub directory: &'a Directory,
    /// Name of the study.
    pub title: String,
    /// Whether the points of each variant are written.
    pub sensors: bool,
    /// Whether the table of variants is written as Parquet too.
    pub parquet: bool,
    /// Whether pictures are drawn.
    pub pictures: bool,
    /// Whether nothing is printed.
    pub quiet: bool,
}

/// How a study came about.
pub struct Made {
    /// What the variants have in common.
    pub computed: Computed,
    /// Time it took, in seconds.
    pub seconds: f64,
    /// Threads it ran on.
    pub threads: usize,
}

/// Results under way.
pub struct Results<'a> {
    study: &'a Study,
    base: &'a Base,
    wanted: &'a Wanted<'a>,
    /// Until the results are concluded.
    table: Option<Variants>,
    outcomes: Outcomes,
    /// Names of variants that failed.
    failed: Vec<String>,
    /// Sets of walks that were taken.
    batches: usize,
    /// Names of variants of the base's geometry that walks for the base would serve badly.
    apart: Vec<String>,
}

impl<'a> Results<'a> {
    /// None yet; what variants give is kept in `outcomes`.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn begin(
        study: &'a Study,
        base: &'a Base,
        wanted: &'a Wanted<'a>,
        outcomes: Outcomes,
    ) -> Result<Self> {
        Ok(Self {
            study,
            base,
            wanted,
            table: Some(Variants::create(wanted, study, base)?),
            outcomes,
            failed: Vec::new(),
            batches: 0,
            apart: Vec::new(),
        })
    }

    /// What variants gave so far.
    pub fn outcomes(&mut self) -> &mut Outcomes {
        &mut self.outcomes
    }

    /// What the scenes of a batch gave, as the journal keeps it; writes their points where they are wanted.
    ///
    /// # Errors
    /// The points cannot be written.
    pub fn gave(&self, batch: &Batch, together: &Together) -> Result<Gave> {
        let mut groups = std::iter::once(&together.first.groups).chain(&together.others);
        let base = batch.with_base.then(|| groups.next()).flatten();
        if let Some(base) = base.filter(|_| self.outcomes.count() == 0) {
            let written = self.write_points(BASE, &self.base.scene, base)?;
            written.map_err(|told| anyhow!("{BASE}: {told}"))?;
        }
        let variants = batch.variants.iter().zip(groups);
        let variants = variants.map(|(variant, groups)| {
            let written = self.write_points(&variant.name, &variant.scene, groups)?;
            Ok(written.map(|()| measured(groups)))
        });
        Ok(Gave {
            base: base.map(|groups| measured(groups)),
            variants: variants.collect::<Result<_>>()?,
        })
    }

    /// Writes the points of a variant; gives what is wrong with them, if anything.
    fn write_points(
        &self,
        name: &str,
        scene: &Scene,
        groups: &[Group],
    ) -> Result<Result<(), String>> {
        if !self.wanted.sensors {
            return Ok(Ok(()));
        }
        let points = match rows::sensors(scene, groups) {
            Ok(points) => points,
            Err(error) => return Ok(Err(format!("{error:#}"))),
        };
        let folder = self.wanted.directory.path().join("variants").join(name);
        let folder = Directory::prepare(&folder)?;
        folder.tidy("sensors.csv");
        folder.write("sensors.csv", &points)?;
        Ok(Ok(()))
    }

    /// Writes the rows of a batch, whose record lies in the journal at that place.
    ///
    /// # Errors
    /// The record is of another batch, or nothing can be written.
    pub fn keep(&mut self, batch: &Batch, record: (u64, &[u8]), digest: u128) -> Result<()> {
        let named = |name: &str, values: &[Option<String>]| Outcome {
            name: name.to_owned(),
            values: values.to_vec(),
        };
        let first = batch.with_base && self.outcomes.count() == 0;
        let first = first.then(|| named(BASE, &self.base.values(self.study)));
        let variants = batch.variants.iter();
        let variants = variants.map(|it| named(&it.name, &it.values)).collect();
        for kept in self.outcomes.read(record, digest, first, variants)? {
            self.keep_one(kept)?;
        }
        if !batch.variants.is_empty() {
            self.batches += 1;
        }
        let apart = batch.apart(&self.base.scene).map(str::to_owned);
        self.apart.extend(apart);
        Ok(())
    }

    fn keep_one(&mut self, kept: Kept) -> Result<()> {
        let row = match &kept.own {
            Ok(groups) => Variants::row(&kept.outcome, groups, &kept.base),
            Err(told) => Err(anyhow!(told.clone())),
        };
        match row {
            Ok(row) => {
                self.write_row(&row)?;
                self.outcomes.add(kept);
                Ok(())
            }
            Err(error) => self.fail(Failed {
                name: kept.outcome.name,
                values: kept.outcome.values,
                error,
            }),
        }
    }

    /// Names a variant that failed.
    ///
    /// # Errors
    /// Its row cannot be written.
    pub fn fail(&mut self, failed: Failed) -> Result<()> {
        let Failed {
            name,
            values,
            error,
        } = failed;
        eprintln!("error: variant {name}: {error:#}");
        let groups = self.base.scene.sensors.len();
        let row = Variants::failed_row(&name, &values, groups);
        self.write_row(&row)?;
        self.failed.push(name);
        Ok(())
    }

    fn write_row(&mut self, row: &Row) -> Result<()> {
        match &mut self.table {
            Some(table) => table.add(row),
            None => Ok(()),
        }
    }

    /// Says what the variants show, in files and on stdout.
    ///
    /// # Errors
    /// Something cannot be written.
    pub fn conclude(&mut self, made: &Made) -> Result<()> {
        if let Some(table) = self.table.take() {
            table.finish()?;
        }
        let scene = &self.base.scene;
        let Wanted {
            directory, title, ..
        } = self.wanted;
        let dof = made.computed.dof;
        let circumstances = Circumstances {
            study: title,
            computed: &made.computed,
            variants: self.study.count(),
            failed: &self.failed,
            batches: self.batches,
            apart: &self.apart,
            seconds: made.seconds,
            threads: made.threads,
        };
        let mut text = String::new();
        let outcomes = &self.outcomes;
        // One sensor group after the other: memory holds what variants gave at one of them.
        let mut finding = |group| -> Result<Option<Finding>> {
            let given = outcomes.at(group)?;
            let Some(finding) = Finding::of(self.study, scene, group, given, dof) else {
                return Ok(None);
            };
            text += &finding.text();
            text.push('\n');
            let drawn = trade::svg(&finding, title, half_width_95(dof));
            if let Some(drawn) = drawn.filter(|_| self.wanted.pictures) {
                let name = format!("{}-trade.svg", finding.sensor);
                directory.write(&name, drawn.as_bytes())?;
            }
            Ok(Some(finding))
        };
        let findings = (0..scene.sensors.len()).filter_map(|group| finding(group).transpose());
        directory.write_by("study.json", |file| {
            conclusion::write(file, scene, &circumstances, findings)
        })?;
        if !self.wanted.quiet {
            text += &conclusion::text(&circumstances, directory.path());
            print(&text)?;
        }
        Ok(())
    }

    /// Removes what was kept beside the results, and makes sure that no variant failed.
    ///
    /// # Errors
    /// Some did; the error names them.
    pub fn end(self) -> Result<()> {
        self.outcomes.remove()?;
        ensure!(
            self.failed.is_empty(),
            "{} of {} variants failed: {}; the others are in {}",
            self.failed.len(),
            self.study.count(),
            self.failed.join(", "),
            self.wanted.directory.path().display()
        );
        Ok(())
    }
}
