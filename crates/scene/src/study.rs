//! A study: one scene, and what varies in it.

mod axis;
mod list;
mod sample;

use crate::document::{Node, Value};
use crate::error::Error;
use crate::file::SceneFile;
use crate::fingerprint::digest;
use crate::foundation::{self, Foundation};
use crate::material::library::is_glob;
use crate::nearest::hint;
use crate::overrides::{Key, Override};
use crate::place::Place;
use crate::reader::{Reader, STUDY};
use crate::scene::Scene;
use axis::Axis;
use globset::Glob;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Variants of one study, at most.
const MOST: usize = 1_000_000;

/// Geometries of variants that are kept for others that have the same.
const KEPT: usize = 4;

/// Keys of `[run]` that belong to all variants together: differences between variants come from the same walks.
const SHARED: [&str; 4] = ["samples", "relative_error", "seconds", "seed"];

/// A study file: the scene that it starts from, and the values that keys take in its variants.
///
/// Every key of `[grid]` is an axis of its own, `[list]` and `[sample]` are one each, and the variants are all
/// combinations, numbered as the last axis turns fastest.
#[derive(Debug)]
pub struct Study {
    scene: PathBuf,
    keys: Vec<Varied>,
    axes: Vec<Axis>,
}

/// A key that varies, with the place where the study names it.
#[derive(Clone, Debug)]
struct Varied {
    key: Key,
    at: Place,
}

/// One variant: a row of each axis.
#[derive(Clone, Copy, Debug)]
pub struct Variant<'s> {
    study: &'s Study,
    index: usize,
}

/// The scene that a study starts from.
pub struct Base {
    /// The scene as it stands.
    pub scene: Scene,
    /// What is wrong with single values, each with its place: variants that have such a value will fail.
    pub doubts: Vec<String>,
    path: PathBuf,
    document: Node,
    foundation: Foundation,
    /// Geometries of variants before, the last that was founded first.
    founded: Mutex<VecDeque<Founded>>,
}

/// A geometry that is not the base's.
struct Founded {
    /// What it depends on: keys, by index, with their values as text.
    values: Vec<(usize, String)>,
    scene: Scene,
    foundation: Foundation,
}

impl Study {
    /// Reads the study file at `path` and the list that it names.
    ///
    /// # Errors
    /// The first things found wrong, each with its place: unknown keys, keys given twice, axes without values, more
    /// than a million variants.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut table = Reader::new(STUDY.into(), Node::read(path)?)?;
        let at = table.at().to_string();
        let scene = table.take("scene");
        let (grid, list, sample) = (table.take("grid"), table.take("list"), table.take("sample"));
        // What is left over may be any of these, misspelt.
        let Some(scene) = scene else {
            table.require("scene", "the path of the scene that is varied")?;
            unreachable!("the key is not there");
        };
        table.finish()?;
        let mut study = Self {
            scene: folder.join(scene.text()?.value),
            keys: Vec::new(),
            axes: Vec::new(),
        };
        if let Some(grid) = grid {
            axis::grid(grid, &mut study)?;
        }
        if let Some(list) = list {
            list::list(list, folder, &mut study)?;
        }
        if let Some(sample) = sample {
            sample::sample(sample, &mut study)?;
        }
        let count = study.axes.iter().try_fold(1usize, |count, axis| {
            count.checked_mul(axis.len()).filter(|&count| count <= MOST)
        });
        if study.axes.is_empty() {
            let reason = "the study varies nothing: it has neither [grid] nor [list] nor [sample]";
            return Err(conflict(at, reason.into()));
        }
        if count.is_none() {
            let reason =
                format!("the study has more than {MOST} variants: every combination counts");
            return Err(conflict(at, reason));
        }
        Ok(study)
    }

    /// The scene file that the study starts from.
    #[must_use]
    pub fn scene(&self) -> &Path {
        &self.scene
    }

    /// The keys that vary, dotted, in the order of the study file.
    #[must_use]
    pub fn keys(&self) -> Vec<String> {
        self.keys
            .iter()
            .map(|varied| varied.key.to_string())
            .collect()
    }

    /// Number of variants, ≥ 1.
    #[must_use]
    pub fn count(&self) -> usize {
        self.axes.iter().map(Axis::len).product()
    }

    /// Whether a key takes numbers only, for each key.
    #[must_use]
    pub fn numeric(&self) -> Vec<bool> {
        let mut numeric = vec![true; self.keys.len()];
        for axis in &self.axes {
            for (key, value) in (0..axis.len()).flat_map(|row| axis.row(row)) {
                let value = value.as_ref().map(|node| &node.value);
                numeric[key] &= matches!(value, None | Some(Value::Integer(_) | Value::Number(_)));
            }
        }
        numeric
    }

    /// Whether something is moved or turned, so that light takes other ways.
    #[must_use]
    pub fn moves(&self) -> bool {
        let mut keys = self.keys.iter();
        keys.any(|varied| !foundation::keeps_ways(&varied.key.segments()))
    }

    /// Digest of what varies: of all keys, and of all their values. The scene has a fingerprint of its own.
    #[must_use]
    pub fn digest(&self) -> u128 {
        let text = |(key, value): (usize, &Option<Node>)| {
            (key, value.as_ref().map(|node| node.value.to_string()))
        };
        let rows = |axis: &Axis| -> Vec<Vec<_>> {
            let rows = 0..axis.len();
            rows.map(|row| axis.row(row).map(text).collect()).collect()
        };
        digest(&(self.keys(), self.axes.iter().map(rows).collect::<Vec<_>>()))
    }

    /// All variants; those of one geometry follow each other where axes of geometry and of materials are apart.
    pub fn variants(&self) -> impl Iterator<Item = Variant<'_>> {
        let moves = |&axis: &usize| {
            let mut keys = self.axes[axis].row(0).map(|(key, _)| &self.keys[key].key);
            keys.any(|key| !foundation::keeps_geometry(&key.segments()))
        };
        let (slow, fast): (Vec<usize>, Vec<usize>) = (0..self.axes.len()).partition(moves);
        let order = [slow, fast].concat();
        (0..self.count()).map(move |turn| {
            let axes = self.axes.iter().zip(self.rows(&order, turn));
            let index = axes.fold(0, |index, (axis, row)| index * axis.len() + row);
            Variant { study: self, index }
        })
    }

    /// The row of each axis after so many turns, where the axes turn in this order, the last one fastest.
    fn rows(&self, order: &[usize], mut turn: usize) -> Vec<usize> {
        let mut rows = vec![0; self.axes.len()];
        for &axis in order.iter().rev() {
            let count = self.axes[axis].len();
            rows[axis] = turn % count;
            turn /= count;
        }
        rows
    }

    /// Loads the scene that the study starts from, with `overrides` in it, and checks every key of the study against it.
    ///
    /// # Errors
    /// What is wrong with the scene, or a key that means nothing in it.
    pub fn base(&self, overrides: &[Override]) -> Result<Base, Error> {
        let path = self.scene.clone();
        let mut document = Node::read(&path)?;
        for entry in overrides {
            entry.apply(&mut document)?;
        }
        let file = SceneFile::typed(document.clone(), &path)?;
        let (scene, foundation) = Scene::founded(file, &path)?;
        let mut doubts = Vec::new();
        let mut unknown = Vec::new();
        for axis in &self.axes {
            for row in 0..axis.len() {
                let mut document = document.clone();
                let read = self
                    .put(axis, row, &mut document)
                    .and_then(|()| SceneFile::typed(document, &path));
                let Err(error) = read else {
                    continue;
                };
                for error in error.parts() {
                    let told: &mut Vec<Error> = match error {
                        Error::UnknownKey { .. } | Error::Override { .. } => &mut unknown,
                        _ => &mut doubts,
                    };
                    if !told.iter().any(|it| it.to_string() == error.to_string()) {
                        told.push(error);
                    }
                }
            }
        }
        Error::all(unknown)?;
        Error::all(self.strangers(&scene))?;
        Ok(Base {
            scene,
            doubts: doubts.iter().map(ToString::to_string).collect(),
            path,
            document,
            foundation,
            founded: Mutex::default(),
        })
    }

    /// Keys of materials that the scene does not have. With another mesh there may be others.
    fn strangers(&self, scene: &Scene) -> Vec<Error> {
        let first = |varied: &Varied| varied.key.segments()[0].to_owned();
        if self
            .keys
            .iter()
            .any(|varied| ["mesh", "shape"].contains(&first(varied).as_str()))
        {
            return Vec::new();
        }
        let mut names: Vec<&str> = scene.materials.iter().map(|it| it.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        let mut errors = Vec::new();
        for varied in &self.keys {
            let ["material", name, ..] = varied.key.segments()[..] else {
                continue;
            };
            let glob = Glob::new(name).ok().filter(|_| is_glob(name));
            let glob = glob.map(|glob| glob.compile_matcher());
            let known =
                |used: &&str| *used == name || glob.as_ref().is_some_and(|it| it.is_match(used));
            if !names.iter().any(known) {
                errors.push(Error::NoMatch {
                    at: varied.at.to_string(),
                    what: "material".into(),
                    name: name.to_owned(),
                    hint: hint(name, names.iter().copied()),
                });
            }
        }
        errors
    }

    /// Puts one row of an axis into a document.
    fn put(&self, axis: &Axis, row: usize, document: &mut Node) -> Result<(), Error> {
        for (key, value) in axis.row(row) {
            let Varied { key, at } = &self.keys[key];
            if let Some(value) = value {
                key.put(value.clone(), at, document)?;
            }
        }
        Ok(())
    }

    /// A new axis of keys, each with its place; its rows hold one value a key.
    fn add(&mut self, keys: Vec<Varied>, rows: Vec<Vec<Option<Node>>>) -> Result<(), Error> {
        let first = self.keys.len();
        for varied in keys {
            if self.keys.iter().any(|known| known.key == varied.key) {
                let reason = format!("the key {} is given twice", varied.key);
                return Err(conflict(varied.at.to_string(), reason));
            }
            let segments = varied.key.segments();
            if segments[0] == "run" && segments.get(1).is_none_or(|key| SHARED.contains(key)) {
                let reason = format!(
                    "{} cannot vary: all variants take the same walks; give it in the scene or on the command line",
                    varied.key
                );
                return Err(conflict(varied.at.to_string(), reason));
            }
            self.keys.push(varied);
        }
        self.axes.push(Axis::new(first..self.keys.len(), rows));
        Ok(())
    }
}

impl Variant<'_> {
    /// Its number from 1, with as many digits as the last one has, three at least.
    #[must_use]
    pub fn name(&self) -> String {
        let digits = self.study.count().to_string().len().max(3);
        format!("{:0digits$}", self.index + 1)
    }

    /// The value of each key as text; `None` where it is that of the base.
    #[must_use]
    pub fn values(&self) -> Vec<Option<String>> {
        let mut values = vec![None; self.study.keys.len()];
        for (axis, row) in self.rows() {
            for (key, value) in axis.row(row) {
                values[key] = value.as_ref().map(|node| node.value.to_string());
            }
        }
        values
    }

    /// Each axis with the row of it that this variant has.
    fn rows(&self) -> Vec<(&Axis, usize)> {
        let axes = &self.study.axes;
        let order: Vec<usize> = (0..axes.len()).collect();
        axes.iter()
            .zip(self.study.rows(&order, self.index))
            .collect()
    }
}

impl Base {
    /// The scene of a variant.
    ///
    /// # Errors
    /// As [`Scene::load`]; what comes from the study names its place there.
    pub fn variant(&self, variant: &Variant) -> Result<Scene, Error> {
        let mut document = self.document.clone();
        // What of it moves geometry.
        let mut values: Vec<(usize, String)> = Vec::new();
        for (axis, row) in variant.rows() {
            variant.study.put(axis, row, &mut document)?;
            for (key, value) in axis.row(row) {
                let segments = variant.study.keys[key].key.segments();
                if let Some(value) = value
                    && !foundation::keeps_geometry(&segments)
                {
                    values.push((key, value.value.to_string()));
                }
            }
        }
        let file = SceneFile::typed(document, &self.path)?;
        if values.is_empty() {
            return self.foundation.scene(&self.scene, file, &self.path);
        }
        let mut founded = self.founded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(place) = founded.iter().position(|it| it.values == values) {
            let known = &founded[place];
            return known.foundation.scene(&known.scene, file, &self.path);
        }
        let (scene, foundation) = Scene::founded(file, &self.path)?;
        founded.truncate(KEPT - 1);
        founded.push_front(Founded {
            values,
            scene: scene.clone(),
            foundation,
        });
        Ok(scene)
    }

    /// The value of each key of a study in the base, as text: that of the scene file, or for a material the one that the
    /// model or a default gives; `None` where there is none, or objects have different ones.
    #[must_use]
    pub fn values(&self, study: &Study) -> Vec<Option<String>> {
        let value = |varied: &Varied| match varied.key.find(&self.document) {
            Some(node) => Some(node.value.to_string()),
            None => self.resolved(&varied.key),
        };
        study.keys.iter().map(value).collect()
    }

    /// The value that all materials of the key's name have.
    fn resolved(&self, key: &Key) -> Option<String> {
        let ["material", name, key] = key.segments()[..] else {
            return None;
        };
        let named = self.scene.materials.iter().filter(|it| it.name == name);
        let mut values = named.filter_map(|it| it.values.iter().find(|value| value.key == key));
        let first = &values.next()?.value;
        values.all(|it| it.value == *first).then(|| first.clone())
    }
}

fn conflict(at: String, reason: String) -> Error {
    Error::Conflict { at, reason }
}

#[cfg(test)]
mod tests;
