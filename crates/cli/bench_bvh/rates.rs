//! How many rays a second.

use super::rays::Rays;
use glam::DVec3;
use malus_geometry::{Surfaces, Targets};
use rayon::prelude::*;
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;

/// Rays that are timed together: a few milliseconds, within which a busy machine seldom interrupts.
const CHUNK: usize = 2048;

/// A kind of ray and a way of asking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Nearest hit, rays of one origin.
    Primary,
    /// Nearest hit, rays of no order.
    Cosine,
    /// Any hit between places of no order.
    Pairs,
    /// Any hit between a vertex and all sensors, one by one.
    Sensors,
    /// The same, in packets.
    SensorPackets,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Primary,
        Self::Cosine,
        Self::Pairs,
        Self::Sensors,
        Self::SensorPackets,
    ];

    /// As a column is titled.
    pub fn title(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Cosine => "cosine",
            Self::Pairs => "pairs",
            Self::Sensors => "sensors",
            Self::SensorPackets => "in packets",
        }
    }
}

/// Rays made ready to be traced.
pub struct Work<'a> {
    rays: &'a Rays,
    targets: Targets,
    asked: Vec<[DVec3; 2]>,
}

impl<'a> Work<'a> {
    pub fn new(surfaces: &Surfaces, rays: &'a Rays) -> Self {
        Self {
            rays,
            targets: surfaces.targets(&rays.sensors),
            asked: rays.asked(),
        }
    }

    /// How many rays of a kind there are.
    fn len(&self, kind: Kind) -> usize {
        match kind {
            Kind::Primary => self.rays.primary.len(),
            Kind::Cosine => self.rays.cosine.len(),
            Kind::Pairs => self.rays.pairs.len(),
            Kind::Sensors | Kind::SensorPackets => self.asked.len(),
        }
    }

    /// In how many pieces they are timed.
    fn chunks(&self, kind: Kind) -> usize {
        match kind {
            Kind::SensorPackets => self.rays.vertices.len().div_ceil(self.group()),
            _ => self.len(kind).div_ceil(CHUNK),
        }
    }

    /// Vertices to one piece.
    fn group(&self) -> usize {
        (CHUNK / self.rays.sensors.len()).max(1)
    }

    /// Traces one piece.
    fn trace(&self, surfaces: &Surfaces, kind: Kind, chunk: usize) {
        let nearest = |rays: &[(DVec3, DVec3)]| {
            for &(from, direction) in part(rays, chunk, CHUNK) {
                black_box(surfaces.nearest(from, direction));
            }
        };
        let visible = |pairs: &[[DVec3; 2]]| {
            for &[from, to] in part(pairs, chunk, CHUNK) {
                black_box(surfaces.visible(from, to));
            }
        };
        match kind {
            Kind::Primary => nearest(&self.rays.primary),
            Kind::Cosine => nearest(&self.rays.cosine),
            Kind::Pairs => visible(&self.rays.pairs),
            Kind::Sensors => visible(&self.asked),
            Kind::SensorPackets => {
                let mut seen = Vec::new();
                for &(from, normal) in part(&self.rays.vertices, chunk, self.group()) {
                    surfaces.visible_from(from, normal, &self.targets, &mut seen);
                    black_box(&seen);
                }
            }
        }
    }
}

fn part<T>(all: &[T], chunk: usize, size: usize) -> &[T] {
    all.chunks(size).nth(chunk).unwrap_or(&[])
}

/// Times of one tree with one kind of ray, in s.
pub struct Times {
    kind: Kind,
    rays: usize,
    /// On one thread: for each piece, one a repetition.
    pieces: Vec<Vec<f64>>,
    /// On all threads: one a repetition.
    together: Vec<f64>,
}

/// A rate in 10⁶ rays a second.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Rate {
    /// Which rays, and how.
    pub rays: Kind,
    /// On how many threads.
    pub threads: usize,
    /// By the median of the repetitions.
    pub median: f64,
    /// By the fastest of the repetitions.
    pub best: f64,
}

impl Times {
    pub fn new(work: &Work, kind: Kind) -> Self {
        Self {
            kind,
            rays: work.len(kind),
            pieces: vec![Vec::new(); work.chunks(kind)],
            together: Vec::new(),
        }
    }

    /// One more repetition.
    pub fn repeat(&mut self, work: &Work, surfaces: &Surfaces, pool: &rayon::ThreadPool) {
        for (chunk, times) in self.pieces.iter_mut().enumerate() {
            let started = Instant::now();
            work.trace(surfaces, self.kind, chunk);
            times.push(started.elapsed().as_secs_f64());
        }
        if pool.current_num_threads() > 1 {
            let started = Instant::now();
            pool.install(|| {
                (0..self.pieces.len())
                    .into_par_iter()
                    .for_each(|chunk| work.trace(surfaces, self.kind, chunk));
            });
            self.together.push(started.elapsed().as_secs_f64());
        }
    }

    /// What they come to: on one thread, and on all if there are more; nothing where there are no such rays.
    pub fn rates(&self, threads: usize) -> Vec<Rate> {
        if self.rays == 0 {
            return Vec::new();
        }
        let rate = |threads, [median, best]: [f64; 2]| Rate {
            rays: self.kind,
            threads,
            median: self.rays as f64 / median / 1e6,
            best: self.rays as f64 / best / 1e6,
        };
        let single = self.pieces.iter().map(|times| summary(times));
        let single = single.fold([0.0; 2], |sum, piece| {
            [sum[0] + piece[0], sum[1] + piece[1]]
        });
        let mut rates = vec![rate(1, single)];
        if !self.together.is_empty() {
            rates.push(rate(threads, summary(&self.together)));
        }
        rates
    }
}

/// The median and the least of some times.
fn summary(times: &[f64]) -> [f64; 2] {
    let mut sorted = times.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    let median = if sorted.len().is_multiple_of(2) {
        0.5 * (sorted[middle - 1] + sorted[middle])
    } else {
        sorted[middle]
    };
    [median, sorted[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_the_sum_of_medians_and_of_the_fastest() {
        let times = Times {
            kind: Kind::Cosine,
            rays: 6_000_000,
            pieces: vec![vec![3.0, 1.0, 2.0], vec![5.0, 1.0]],
            together: vec![2.0],
        };
        let rates = times.rates(4);
        let values: Vec<_> = rates
            .iter()
            .map(|r| (r.threads, r.median, r.best))
            .collect();
        assert_eq!(values, [(1, 1.2, 3.0), (4, 3.0, 3.0)]);
    }
}
