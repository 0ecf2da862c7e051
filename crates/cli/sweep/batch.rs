//! Variants that the same walks serve, gathered until there are enough of them.

use anyhow::Result;
use malus_estimator::{Cohort, REPLICAS};
use malus_scene::{Estimator, Fingerprint, Scene, Settings};
use siphasher::sip128::{Hasher128, SipHasher13};
use std::hash::Hasher;
use std::sync::Arc;

/// Variants in one batch, at most: more of them cost as much one by one.
const MOST: usize = 64;

/// Batches that wait to be filled, at most.
const OPEN: usize = 4;

/// Memory for the sums of one batch, in bytes.
const MEMORY: usize = 256 << 20;

/// Bytes of sums that a sensor point has in one variant, rather too many: two kinds of walk, eight sums each.
const BYTES: usize = 2 * 8 * 8 * REPLICAS as usize;

/// One variant, loaded.
pub struct Loaded {
    /// Its name.
    pub name: String,
    /// The value of each key of the study, as text.
    pub values: Vec<Option<String>>,
    /// Its scene.
    pub scene: Scene,
}

/// Variants that the same walks serve.
pub struct Batch {
    cohort: Cohort,
    /// The variants.
    pub variants: Vec<Loaded>,
    /// Whether the walks serve the base too: differences to it are then those of the same walks.
    pub with_base: bool,
}

impl Batch {
    /// The base alone: differences to it need it first.
    pub fn base(base: &Scene) -> Self {
        Self {
            cohort: Cohort::of(base),
            variants: Vec::new(),
            with_base: true,
        }
    }

    /// The scenes that are evaluated, the base first where it is one of them.
    pub fn scenes<'a>(&'a self, base: &'a Scene) -> Vec<&'a Scene> {
        let own = self.variants.iter().map(|it| &it.scene);
        let base = self.with_base.then_some(base);
        base.into_iter().chain(own).collect()
    }

    /// How it is computed, with these stopping rules.
    pub fn settings(&self, base: &Scene, stops: &Settings) -> Settings {
        let first = match self.with_base {
            true => base,
            false => &self.variants[0].scene,
        };
        Settings {
            samples: stops.samples,
            relative_error: stops.relative_error,
            seconds: stops.seconds,
            ..first.settings.clone()
        }
    }

    /// Digest of what it is: of all that its sums depend on. `fingerprint` is that of the base.
    ///
    /// # Errors
    /// It cannot be written as bytes.
    pub fn digest(&self, base: &Scene, fingerprint: &Fingerprint) -> Result<u128> {
        let one = |it: &Loaded| {
            let scene = &it.scene;
            (
                it.name.clone(),
                scene.fingerprint_beside(&scene.settings, base, fingerprint),
            )
        };
        let all: Vec<_> = self.variants.iter().map(one).collect();
        let mut sum = SipHasher13::new();
        sum.write(&postcard::to_stdvec(&(self.with_base, all))?);
        Ok(sum.finish128().as_u128())
    }

    /// Names of its variants that have the base's geometry, and optics for which the base's walks would be bad.
    pub fn apart(&self, base: &Scene) -> impl Iterator<Item = &str> {
        let of_base = |it: &&Loaded| Arc::ptr_eq(&it.scene.surfaces, &base.surfaces);
        let variants = self.variants.iter().filter(|_| !self.with_base);
        variants.filter(of_base).map(|it| it.name.as_str())
    }
}

/// Batches under way.
#[derive(Default)]
pub struct Batches {
    open: Vec<Batch>,
}

impl Batches {
    /// Puts a variant to others that the same walks serve; gives back a batch that is full, or the oldest of too many.
    pub fn add(&mut self, base: &Scene, variant: Loaded) -> Option<Batch> {
        // Walks that are counted in cells carry the light of one scene.
        let alone = variant.scene.settings.estimator == Estimator::Direct;
        let mut open = self.open.iter_mut();
        let place = open.position(|batch| !alone && batch.cohort.admit(&variant.scene));
        let place = place.unwrap_or_else(|| {
            let mut cohort = Cohort::of(base);
            let with_base = !alone && cohort.admit(&variant.scene);
            self.open.push(Batch {
                cohort: if with_base {
                    cohort
                } else {
                    Cohort::of(&variant.scene)
                },
                variants: Vec::new(),
                with_base,
            });
            self.open.len() - 1
        });
        let points: usize = base.sensors.iter().map(|sensor| sensor.points.len()).sum();
        let most = (MEMORY / (BYTES * points.max(1))).clamp(1, MOST);
        self.open[place].variants.push(variant);
        if self.open[place].variants.len() >= most {
            Some(self.open.remove(place))
        } else if self.open.len() > OPEN {
            Some(self.open.remove(0))
        } else {
            None
        }
    }

    /// What is left at the end.
    pub fn rest(self) -> Vec<Batch> {
        self.open
    }
}
