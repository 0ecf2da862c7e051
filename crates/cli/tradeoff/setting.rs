//! Ways of running one scene that are compared with each other.

use crate::label;
use malus_estimator::unseen;
use malus_optics::Representation;
use malus_scene::{Estimator, Model, Quantity, Scene, Settings};

/// One way of running a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// How walks are joined to the sensors.
    pub estimator: Estimator,
    /// Stokes components carried.
    pub representation: Representation,
    /// Threads.
    pub threads: usize,
}

impl Setting {
    /// The settings that are compared: what the scene would be run with by itself, and what departs from that in one thing.
    ///
    /// Each choice moves the cost by a factor that hardly depends on the others, so their products would tell nothing
    /// more and leave less time for each.
    pub fn all(scene: &Scene, most_threads: usize) -> Vec<Self> {
        let plain = Self {
            estimator: Estimator::Auto,
            representation: own_representation(scene),
            threads: most_threads,
        };
        let estimators: &[Estimator] = if is_radiance_read(scene) {
            &[Estimator::Gather]
        } else {
            &[Estimator::Gather, Estimator::Local, Estimator::Direct]
        };
        let representations: &[Representation] = match scene.settings.model {
            Model::Polarised => &[
                Representation::Intensity,
                Representation::Linear,
                Representation::Full,
            ],
            Model::Scalar | Model::Diffuse => &[],
        };
        let threads = std::iter::successors(Some(1), |threads| Some(2 * threads))
            .take_while(|&threads| threads < most_threads);
        let mut settings = vec![plain];
        settings.extend(
            estimators
                .iter()
                .map(|&estimator| Self { estimator, ..plain }),
        );
        settings.extend(
            representations
                .iter()
                .filter(|&&representation| representation != plain.representation)
                .map(|&representation| Self {
                    representation,
                    ..plain
                }),
        );
        settings.extend(threads.map(|threads| Self { threads, ..plain }));
        settings
    }

    /// What a run by this setting is given; models that the scene asks to be computed beside the main one stay.
    pub fn settings(self, scene: &Scene, samples: u64, seed: u64) -> Settings {
        Settings {
            estimator: self.estimator,
            representation: Some(self.representation),
            cell: scene
                .settings
                .cell
                .filter(|_| self.estimator == Estimator::Direct),
            samples: Some(samples),
            relative_error: None,
            seconds: None,
            seed,
            ..scene.settings.clone()
        }
    }

    /// What keeps it from the right answer however long it runs, one sentence each.
    pub fn shortcomings(self, scene: &Scene) -> Vec<String> {
        let mut sentences = unseen(scene, &self.settings(scene, 1, 0));
        if self.estimator == Estimator::Direct {
            sentences.push("direct: what is read is the mean over a cell about the point".into());
        }
        if self.representation < scene.need.representation {
            sentences.push(format!(
                "{}: the scene needs {} ({})",
                label::representation(self.representation),
                label::representation(scene.need.representation),
                scene.need.reason
            ));
        }
        sentences
    }

    /// The setting in words.
    pub fn words(self) -> String {
        format!(
            "{}, {}, {} thread{}",
            label::estimator(self.estimator),
            label::representation(self.representation),
            self.threads,
            if self.threads == 1 { "" } else { "s" }
        )
    }

    /// Options of `malus run` that stand for it.
    pub fn options(self) -> String {
        format!(
            "--estimator {} --representation {} --threads {}",
            label::estimator(self.estimator),
            label::representation(self.representation),
            self.threads
        )
    }
}

/// The representation that the scene is run with.
fn own_representation(scene: &Scene) -> Representation {
    match scene.settings.model {
        Model::Polarised => scene
            .settings
            .representation
            .unwrap_or(scene.need.representation),
        Model::Scalar | Model::Diffuse => Representation::Intensity,
    }
}

/// Whether any sensor reads radiance: neither a local estimate nor a cell does.
fn is_radiance_read(scene: &Scene) -> bool {
    scene
        .sensors
        .iter()
        .any(|sensor| sensor.quantity == Quantity::Radiance)
}
