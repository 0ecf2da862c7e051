//! A study from its first batch to its last: which variants the same walks serve depends on the study alone, so the order is
//! the same in every run, and in every shard.

use super::batch::{Batch, Batches, Loaded};
use anyhow::{Error, Result, anyhow, ensure};
use malus_scene::{Base, Scene, Study, Variant};
use std::collections::VecDeque;

/// What comes next in a study.
pub enum Step {
    /// A batch to be computed.
    Batch(Box<Batch>),
    /// A variant that cannot be computed.
    Failed(Failed),
}

/// A variant that failed.
pub struct Failed {
    /// Its name.
    pub name: String,
    /// The value of each key of the study, as text.
    pub values: Vec<Option<String>>,
    /// Why.
    pub error: Error,
}

/// All steps of a study.
pub struct Course<'a> {
    base: &'a Base,
    variants: Box<dyn Iterator<Item = Variant<'a>> + 'a>,
    batches: Option<Batches>,
    next: VecDeque<Step>,
    /// Whether a batch has come that the base is in.
    begun: bool,
}

impl<'a> Course<'a> {
    /// A study from its beginning.
    pub fn new(study: &'a Study, base: &'a Base) -> Self {
        Self {
            base,
            variants: Box::new(study.variants()),
            batches: Some(Batches::default()),
            next: VecDeque::new(),
            begun: false,
        }
    }

    /// Puts a batch in its place.
    fn push(&mut self, batch: Batch) {
        if !self.begun && !batch.with_base {
            let base = Batch::base(&self.base.scene);
            self.next.push_back(Step::Batch(Box::new(base)));
        }
        self.begun = true;
        self.next.push_back(Step::Batch(Box::new(batch)));
    }

    fn take(&mut self, variant: &Variant) {
        let (name, values) = (variant.name(), variant.values());
        match load(self.base, variant) {
            Ok(scene) => {
                let loaded = Loaded {
                    name,
                    values,
                    scene,
                };
                let batches = self.batches.as_mut();
                let full = batches.and_then(|it| it.add(&self.base.scene, loaded));
                if let Some(batch) = full {
                    self.push(batch);
                }
            }
            Err(error) => self.next.push_back(Step::Failed(Failed {
                name,
                values,
                error,
            })),
        }
    }
}

impl Iterator for Course<'_> {
    type Item = Step;

    fn next(&mut self) -> Option<Step> {
        loop {
            if let Some(step) = self.next.pop_front() {
                return Some(step);
            }
            match self.variants.next() {
                Some(variant) => self.take(&variant),
                None => {
                    for batch in self.batches.take()?.rest() {
                        self.push(batch);
                    }
                }
            }
        }
    }
}

/// The scene of a variant, with the sensors of the base.
fn load(base: &Base, variant: &Variant) -> Result<Scene> {
    let scene = base.variant(variant).map_err(|error| anyhow!("{error}"))?;
    let alike = names(&scene).eq(names(&base.scene));
    ensure!(alike, "its sensors are not those of the base");
    Ok(scene)
}

fn names(scene: &Scene) -> impl Iterator<Item = &str> {
    scene.sensors.iter().map(|sensor| sensor.name.as_str())
}
