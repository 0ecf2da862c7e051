//! Variants that the same walks serve, gathered until there are enough of them.

use malus_estimator::{Cohort, REPLICAS};
use malus_scene::{Estimator, Scene};

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
