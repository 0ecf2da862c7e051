//! Variants spread evenly over ranges: a seeded Latin hypercube.

use super::axis::leaves;
use super::{Study, Varied};
use crate::allowed::Allowed;
use crate::document::{Node, Value};
use crate::error::Error;
use crate::place::Place;
use crate::reader::{Field, Reader};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Variants of one sample, at most.
const MOST: u64 = 1_000_000;

/// Values that a key may take.
#[derive(Clone, Copy, Debug)]
struct Interval {
    from: f64,
    to: f64,
    /// Even in the logarithm.
    logarithmic: bool,
}

/// Reads `[sample]`: `count`, `seed`, and for every other key the range of its values.
///
/// Each range is cut into `count` parts of equal width, and each part holds one variant (McKay, Beckman & Conover 1979).
pub(super) fn sample(field: Field, study: &mut Study) -> Result<(), Error> {
    let mut table = field.table()?;
    let at = table.at().clone();
    let count = table
        .require("count", "the number of variants")?
        .whole(1, MOST)?;
    let seed = match table.take("seed") {
        Some(field) => field.whole(0, u64::MAX)?,
        None => 1,
    };
    let is_interval = |value: &Value| match value {
        Value::Table(entries) => entries.iter().any(|entry| is_end(&entry.key, &entry.node)),
        _ => true,
    };
    let (mut keys, mut columns) = (Vec::new(), Vec::new());
    for (index, (varied, node)) in leaves(table.rest(), is_interval)?.into_iter().enumerate() {
        let place = node.at.clone();
        let interval = Interval::read(&varied, node)?;
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(index as u64);
        columns.push(interval.column(count, &mut generator, &place));
        keys.push(varied);
    }
    if keys.is_empty() {
        return Err(Error::Conflict {
            at: at.to_string(),
            reason: "[sample] holds no range: give each key one, \"material.Floor.n\" = { from = 1.3, to = 2 }"
                .into(),
        });
    }
    let row = |row: usize| {
        columns
            .iter()
            .map(move |column: &Vec<Node>| Some(column[row].clone()))
    };
    let rows = (0..count as usize)
        .map(|index| row(index).collect())
        .collect();
    study.add(keys, rows)
}

/// Whether an entry is one end of a range, or is misspelt so that nothing else can be meant.
fn is_end(key: &str, node: &Node) -> bool {
    ["from", "to"].contains(&key) || !matches!(node.value, Value::Table(_))
}

impl Interval {
    fn read(varied: &Varied, node: Node) -> Result<Self, Error> {
        let name = format!("[sample] {}", varied.key);
        let mut table = Reader::new(name, node)?;
        let from = table.require("from", "the least value")?;
        let to = table.require("to", "the greatest value")?;
        let logarithmic = match table.take("scale") {
            Some(field) => field.choice(&[("linear", false), ("log", true)])?,
            None => false,
        };
        table.finish()?;
        let least = if logarithmic {
            Allowed::Positive
        } else {
            Allowed::Finite
        };
        let interval = Self {
            from: from.number(least)?,
            to: to.number(Allowed::Finite)?,
            logarithmic,
        };
        if interval.from < interval.to {
            Ok(interval)
        } else {
            Err(to.refused(
                &format!("a number above from = {}", interval.from),
                String::new(),
            ))
        }
    }

    /// One value in each of `count` parts, in random order.
    fn column(self, count: u64, generator: &mut ChaCha8Rng, at: &Place) -> Vec<Node> {
        // Numbers below 2²⁰ parts are picked with a bias below 2⁻⁴⁴.
        let mut parts: Vec<u64> = (0..count).collect();
        for last in (1..parts.len()).rev() {
            parts.swap(last, (generator.next_u64() % (last as u64 + 1)) as usize);
        }
        let value = |part| {
            let within = (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
            let number = self.at((part as f64 + within) / count as f64);
            Node {
                at: at.clone(),
                value: Value::Number(number),
            }
        };
        parts.into_iter().map(value).collect()
    }

    /// The value at a share of the range.
    fn at(self, share: f64) -> f64 {
        let value = if self.logarithmic {
            self.from * libm::pow(self.to / self.from, share)
        } else {
            self.from + (self.to - self.from) * share
        };
        value.clamp(self.from, self.to)
    }
}
