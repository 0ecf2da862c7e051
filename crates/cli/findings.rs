//! What a study says: which variants differ, in which order they stand, and which key matters.

use crate::comparison::{Difference, Rank, differences, ranking};
use crate::label;
use crate::number::{measured, significant};
use crate::outcome::{Measured, Outcome, Quantity};
use crate::sensitivity::{Column, Sensitivity, sensitivities};
use crate::table::{Table, left, right};
use malus_estimator::Estimate;
use malus_scene::{Scene, Study};
use serde::Serialize;
use std::sync::Arc;

/// Rows at each end of a long ranking that are printed.
const SHOWN: usize = 10;

/// What a study says of one sensor group.
pub struct Finding<'a> {
    /// The sensor's name.
    pub sensor: &'a str,
    /// Its unit.
    pub unit: &'static str,
    /// The base first, then the variants that have free points there.
    pub members: Vec<Member<'a>>,
    /// Parts of the differences to the base that a model without polarisation does not have.
    of_polarisation: Vec<Difference>,
    /// Order by the mean.
    ranks: Vec<Rank>,
    /// The keys of the study.
    pub keys: Vec<String>,
    /// Their values in the variants.
    pub columns: Vec<Column>,
    /// What each key does to the mean.
    pub to_mean: Vec<Option<Sensitivity>>,
    /// What each key does to u0.
    pub to_u0: Vec<Option<Sensitivity>>,
}

/// A variant at one sensor group.
pub struct Member<'a> {
    /// The variant.
    pub outcome: &'a Outcome,
    /// What it gave.
    pub measured: Measured,
    /// u0 with its error.
    pub u0: Option<Estimate>,
    /// Its mean less the base's; `None` for the base.
    difference: Option<Difference>,
    /// The part of that difference that a model without polarisation does not have.
    of_polarisation: Option<Estimate>,
}

/// What a variant gave at one sensor group, with what the base gave there along the same walks or by the same random
/// numbers.
pub struct Given<'a> {
    /// The variant.
    pub outcome: &'a Outcome,
    /// What it gave.
    pub own: Measured,
    /// What the base gave.
    pub base: Option<Arc<Measured>>,
}

impl Given<'_> {
    fn less(&self, quantity: Quantity) -> Option<Estimate> {
        self.own.less(self.base.as_ref()?, quantity)
    }
}

impl<'a> Finding<'a> {
    /// What the base, which comes first, and the variants that have free points at a sensor group say of it; `None` where
    /// the base has none.
    pub fn of(
        study: &Study,
        scene: &'a Scene,
        group: usize,
        given: Vec<Given<'a>>,
        dof: u32,
    ) -> Option<Self> {
        let sensor = &scene.sensors[group];
        let first = given.first()?.outcome;
        let less = |quantity| {
            let others = given[1..].iter();
            others
                .map(|it| it.less(quantity))
                .collect::<Vec<Option<Estimate>>>()
        };
        let of_mean: Vec<Estimate> = less(Quantity::Mean).into_iter().flatten().collect();
        let of_mean = differences(&of_mean, dof).into_iter().map(Some);
        let differences = std::iter::once(None).chain(of_mean);
        let parts = less(Quantity::Polarisation);
        let known: Vec<Estimate> = parts.iter().copied().flatten().collect();
        let of_polarisation = std::iter::once(None).chain(parts);
        let members: Vec<Member> = given
            .into_iter()
            .zip(differences.zip(of_polarisation))
            .map(|(given, (difference, of_polarisation))| Member {
                outcome: given.outcome,
                u0: given
                    .own
                    .replicas(Quantity::Uniformity)
                    .map(|it| Estimate::of(&it)),
                measured: given.own,
                difference,
                of_polarisation,
            })
            .collect();
        let replicas = |quantity| -> Option<Vec<Vec<f64>>> {
            members
                .iter()
                .map(|member| member.measured.replicas(quantity))
                .collect()
        };
        let means = replicas(Quantity::Mean)?;
        let ranks = ranking(&means.iter().map(Vec::as_slice).collect::<Vec<_>>(), dof);
        let columns: Vec<Column> = (0..study.keys().len())
            .map(|key| {
                let value = |member: &Member<'a>| member.outcome.value(key, first);
                Column::of(&members[1..].iter().map(value).collect::<Vec<_>>())
            })
            .collect();
        let uniformities = replicas(Quantity::Uniformity);
        Some(Self {
            sensor: &sensor.name,
            unit: label::unit(sensor.quantity, scene.unit),
            of_polarisation: self::differences(&known, dof),
            ranks,
            keys: study.keys(),
            to_mean: sensitivities(&columns, &means[1..]),
            to_u0: match uniformities {
                Some(values) => sensitivities(&columns, &values[1..]),
                None => vec![None; columns.len()],
            },
            columns,
            members,
        })
    }

    /// The finding in tables.
    pub fn text(&self) -> String {
        let mut text = format!("{}, {}\n", self.sensor, self.unit);
        text += &self.ranking().text("  ");
        let differ = self.members.iter().filter_map(|it| it.difference);
        let differ = differ.filter(Difference::is_one).count();
        text += &format!(
            "  {differ} of {} variants differ from the base, marked * (paired, 95 % for all together)\n",
            self.members.len() - 1
        );
        let ends = self.of_polarisation.iter().flat_map(|it| it.interval);
        if let Some(most) = ends.map(f64::abs).reduce(f64::max) {
            let beyond = self.of_polarisation.iter().filter(|it| it.is_one()).count();
            text += &format!(
                "  polarisation makes at most {} of any difference, and is beyond chance in {beyond} of them\n",
                significant(most, 2)
            );
        }
        if self.to_mean.iter().any(Option::is_some) {
            text.push('\n');
            text += &self.keys_table().text("  ");
        }
        text
    }

    fn ranking(&self) -> Table {
        let polarised = self.members.iter().any(|it| it.of_polarisation.is_some());
        let mut columns = vec![right("rank"), left("variant")];
        columns.extend(self.keys.iter().map(|key| right(key)));
        columns.extend([right("mean ± se"), right("less base ± se"), left("")]);
        columns.extend(polarised.then(|| right("of it polarisation")));
        columns.push(right("u0 ± se"));
        let mut table = Table::new(columns);
        let count = self.ranks.len();
        for (place, rank) in self.ranks.iter().enumerate() {
            if place == SHOWN && count > 2 * SHOWN + 1 {
                table.row(["…".to_owned(), format!("({} more)", count - 2 * SHOWN)]);
            }
            if (SHOWN..count.saturating_sub(SHOWN)).contains(&place) && count > 2 * SHOWN + 1 {
                continue;
            }
            let member = &self.members[rank.index];
            let base = self.members[0].outcome;
            let mut row = vec![places(rank.places), member.outcome.name.clone()];
            let keys = 0..self.keys.len();
            row.extend(keys.map(|key| short(member.outcome.value(key, base))));
            let Measured {
                mean,
                mean_standard_error,
                ..
            } = member.measured;
            row.push(measured(mean, mean_standard_error));
            let difference = member.difference;
            row.push(difference.map_or_else(String::new, |it| estimated(&it.estimate)));
            let mark = match difference {
                Some(it) if it.is_one() => "*",
                _ => "",
            };
            row.push(mark.to_owned());
            let of_polarisation = member.of_polarisation.as_ref();
            row.extend(polarised.then(|| of_polarisation.map_or_else(String::new, estimated)));
            row.push(member.u0.as_ref().map_or_else(String::new, estimated));
            table.row(row);
        }
        table
    }

    fn keys_table(&self) -> Table {
        let mean = format!("mean over its range, {}", self.unit);
        let mut table = Table::new([
            left("key"),
            right(&mean),
            right("share, %"),
            right("u0 over its range"),
            right("share, %"),
        ]);
        for (key, (to_mean, to_u0)) in self.keys.iter().zip(self.to_mean.iter().zip(&self.to_u0)) {
            let mut row = vec![key.clone()];
            for sensitivity in [to_mean, to_u0] {
                let effect = sensitivity.and_then(|it| it.effect);
                row.push(effect.as_ref().map_or_else(String::new, estimated));
                row.push(sensitivity.map_or_else(String::new, |it| {
                    measured(100.0 * it.share.mean, 100.0 * it.share.standard_error)
                }));
            }
            table.row(row);
        }
        table
    }

    /// The finding as a part of `study.json`.
    pub fn json(&self) -> impl Serialize + use<'_> {
        let base = &self.members[0];
        Json {
            sensor: self.sensor,
            unit: self.unit,
            base: Level {
                mean: base.measured.mean,
                se_mean: base.measured.mean_standard_error,
                u0: base.u0.map(Plain::of),
            },
            variants: self.members[1..].iter().filter_map(Compared::of).collect(),
            ranking: self.ranks.iter().map(|rank| self.ranked(rank)).collect(),
            sensitivity: self
                .keys
                .iter()
                .zip(self.to_mean.iter().zip(&self.to_u0))
                .map(|(key, (mean, u0))| Moved {
                    key,
                    mean: mean.map(Moves::of),
                    u0: u0.map(Moves::of),
                })
                .collect(),
        }
    }

    fn ranked(&self, rank: &Rank) -> Ranked<'_> {
        let member = &self.members[rank.index];
        Ranked {
            variant: &member.outcome.name,
            mean: member.measured.mean,
            places: rank.places,
        }
    }
}

/// What a study says of one sensor group, as a file has it.
#[derive(Serialize)]
struct Json<'a> {
    sensor: &'a str,
    unit: &'a str,
    base: Level,
    /// Each variant less the base.
    variants: Vec<Compared<'a>>,
    /// The greatest mean first.
    ranking: Vec<Ranked<'a>>,
    sensitivity: Vec<Moved<'a>>,
}

#[derive(Serialize)]
struct Level {
    mean: f64,
    se_mean: f64,
    u0: Option<Plain>,
}

/// A value and its standard error.
#[derive(Serialize)]
struct Plain {
    value: f64,
    se: f64,
}

impl Plain {
    fn of(estimate: Estimate) -> Self {
        Self {
            value: estimate.mean,
            se: estimate.standard_error,
        }
    }
}

#[derive(Serialize)]
struct Compared<'a> {
    variant: &'a str,
    dmean: f64,
    se_dmean: f64,
    /// Holds the difference, with 95 % for all variants together.
    interval: [f64; 2],
    p: f64,
    /// Corrected for the number of variants (Holm).
    p_corrected: f64,
    differs: bool,
    /// Part of the difference that a model without polarisation does not have.
    polarisation: Option<Plain>,
    u0: Option<Plain>,
}

impl<'a> Compared<'a> {
    fn of(member: &'a Member) -> Option<Self> {
        let difference = member.difference?;
        Some(Self {
            variant: &member.outcome.name,
            dmean: difference.estimate.mean,
            se_dmean: difference.estimate.standard_error,
            interval: difference.interval,
            p: difference.p,
            p_corrected: difference.p_corrected,
            differs: difference.is_one(),
            polarisation: member.of_polarisation.map(Plain::of),
            u0: member.u0.map(Plain::of),
        })
    }
}

#[derive(Serialize)]
struct Ranked<'a> {
    variant: &'a str,
    mean: f64,
    /// First and last place that it may have, with 95 % for all together.
    places: [usize; 2],
}

#[derive(Serialize)]
struct Moved<'a> {
    key: &'a str,
    mean: Option<Moves>,
    u0: Option<Moves>,
}

#[derive(Serialize)]
struct Moves {
    /// Change per unit of the key.
    slope: Option<Plain>,
    /// Change over the range of the key.
    effect: Option<Plain>,
    /// Share of the variance between variants.
    share: Plain,
}

impl Moves {
    fn of(sensitivity: Sensitivity) -> Self {
        Self {
            slope: sensitivity.slope.map(Plain::of),
            effect: sensitivity.effect.map(Plain::of),
            share: Plain::of(sensitivity.share),
        }
    }
}

fn places([first, last]: [usize; 2]) -> String {
    if first == last {
        first.to_string()
    } else {
        format!("{first}–{last}")
    }
}

/// A value of a key, a number to as many digits as a table bears.
fn short(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(number) if text.len() > 7 && number.is_finite() => significant(number, 4),
        _ => text.to_owned(),
    }
}

fn estimated(estimate: &Estimate) -> String {
    measured(estimate.mean, estimate.standard_error)
}
