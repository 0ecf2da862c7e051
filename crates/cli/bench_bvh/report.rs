//! What was measured, as a table and as JSON.

use super::rates::{Kind, Rate};
use crate::number::significant;
use crate::table::{Edge, Table};
use malus_geometry::{Layout, Preset, TreeFacts};
use serde::Serialize;

/// Everything that is printed.
#[derive(Serialize)]
pub struct Report {
    pub file: String,
    pub cpu: String,
    pub features: Vec<&'static str>,
    pub threads: usize,
    pub triangles: usize,
    pub sensors: usize,
    pub repetitions: usize,
    pub trees: Vec<TreeReport>,
}

/// One tree.
#[derive(Serialize)]
pub struct TreeReport {
    pub layout: &'static str,
    pub preset: &'static str,
    pub unit: &'static str,
    pub build_seconds: f64,
    pub nodes: usize,
    pub bytes: usize,
    pub sah_cost: f64,
    pub depth: usize,
    /// Answers compared with those of trying every triangle.
    pub checked: usize,
    pub differing: usize,
    /// Rays aimed at edges and vertices.
    pub aimed: usize,
    pub leaks: usize,
    /// In 10⁶ rays a second.
    pub rates: Vec<Rate>,
}

impl TreeReport {
    pub fn new(facts: &TreeFacts, build_seconds: f64) -> Self {
        Self {
            layout: layout(facts.layout),
            preset: preset(facts.preset),
            unit: facts.unit,
            build_seconds,
            nodes: facts.nodes,
            bytes: facts.bytes,
            sah_cost: facts.sah_cost,
            depth: facts.depth,
            checked: 0,
            differing: 0,
            aimed: 0,
            leaks: 0,
            rates: Vec::new(),
        }
    }

    /// What is wrong with it, if anything is.
    pub fn fault(&self) -> Option<String> {
        let Self {
            layout,
            preset,
            checked,
            differing,
            aimed,
            leaks,
            ..
        } = self;
        (differing + leaks > 0).then(|| {
            format!(
                "{layout} {preset}: {differing} of {checked} answers differ from those of trying every triangle, \
                 {leaks} of {aimed} rays aimed at edges leak"
            )
        })
    }

    fn rate(&self, kind: Kind, threads: usize) -> String {
        let rates = self.rates.iter();
        let mut found = rates.filter(|rate| rate.rays == kind && rate.threads == threads);
        found.next().map_or(String::new(), |rate| {
            format!(
                "{} ({})",
                significant(rate.median, 3),
                significant(rate.best, 3)
            )
        })
    }
}

impl Report {
    /// As people read it.
    pub fn text(&self) -> String {
        let mut text = format!(
            "{}: {} triangles\n{}, {} threads; {}\n\n",
            self.file,
            self.triangles,
            self.cpu,
            self.threads,
            self.features.join(" ")
        );
        text += &self.trees().text("  ");
        text += &format!(
            "\n10⁶ rays a second, median (best) of {} repetitions; the last two columns ask for {} sensors from a vertex\n",
            self.repetitions, self.sensors
        );
        text += &self.rates().text("  ");
        text.push('\n');
        for tree in &self.trees {
            text += &format!(
                "{} {}: {} answers checked by trying every triangle, {} differ; {} rays aimed at edges, {} leak\n",
                tree.layout, tree.preset, tree.checked, tree.differing, tree.aimed, tree.leaks
            );
        }
        text
    }

    fn trees(&self) -> Table {
        let mut table = Table::new(
            [
                ("layout", Edge::Left),
                ("preset", Edge::Left),
                ("unit", Edge::Left),
                ("build, ms", Edge::Right),
                ("nodes", Edge::Right),
                ("memory, MB", Edge::Right),
                ("SAH cost", Edge::Right),
                ("depth", Edge::Right),
            ]
            .map(|(title, edge)| (title.to_owned(), edge)),
        );
        for tree in &self.trees {
            table.row([
                tree.layout.to_owned(),
                tree.preset.to_owned(),
                tree.unit.to_owned(),
                significant(1e3 * tree.build_seconds, 3),
                tree.nodes.to_string(),
                significant(tree.bytes as f64 / 1e6, 3),
                significant(tree.sah_cost, 3),
                tree.depth.to_string(),
            ]);
        }
        table
    }

    fn rates(&self) -> Table {
        let named = ["layout", "preset"].map(|title| (title.to_owned(), Edge::Left));
        let threads = std::iter::once(("threads".to_owned(), Edge::Right));
        let kinds = Kind::ALL.map(|kind| (kind.title().to_owned(), Edge::Right));
        let mut table = Table::new(named.into_iter().chain(threads).chain(kinds));
        for tree in &self.trees {
            let mut counts = vec![1, self.threads];
            counts.dedup();
            for threads in counts {
                let head = [tree.layout, tree.preset].map(str::to_owned).into_iter();
                let rates = Kind::ALL.map(|kind| tree.rate(kind, threads));
                table.row(head.chain([threads.to_string()]).chain(rates));
            }
        }
        table
    }
}

fn layout(layout: Layout) -> &'static str {
    match layout {
        Layout::Wide => "wide",
        Layout::Bvh2 => "bvh2",
        Layout::Cwbvh => "cwbvh",
        Layout::List => "list",
    }
}

fn preset(preset: Preset) -> &'static str {
    match preset {
        Preset::Fastest => "fastest",
        Preset::VeryFast => "very-fast",
        Preset::Fast => "fast",
        Preset::Medium => "medium",
        Preset::Slow => "slow",
        Preset::VerySlow => "very-slow",
    }
}

/// The processor's name, where the system tells it.
pub fn cpu() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'))
        .map(|(_, name)| name.trim().to_owned());
    name.unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

/// The processor's vector units.
#[cfg(target_arch = "x86_64")]
pub fn features() -> Vec<&'static str> {
    [
        ("sse4.2", is_x86_feature_detected!("sse4.2")),
        ("avx", is_x86_feature_detected!("avx")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ]
    .into_iter()
    .filter_map(|(name, there)| there.then_some(name))
    .collect()
}

/// The processor's vector units.
#[cfg(not(target_arch = "x86_64"))]
pub fn features() -> Vec<&'static str> {
    Vec::new()
}
