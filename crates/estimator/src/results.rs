//! What a run gives back: a reading at every sensor point, padded to four Stokes components.

use crate::allocation::Allocation;
use malus_optics::Representation;
use malus_scene::Estimator;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The outcome of a run.
#[derive(Debug, Clone)]
pub struct Results {
    /// One entry a sensor group of the scene, in its order; inside, one reading a sensor point.
    pub groups: Vec<Group>,
    /// Walks taken: in all for `local` and `direct`, at each sensor point for `gather`, both for `auto`.
    /// Given as `--samples`, it repeats this run to the byte.
    pub samples: u64,
    /// Degrees of freedom of every standard error: the number of replicas less one.
    pub dof: u32,
    /// Stokes components that were computed.
    pub representation: Representation,
    /// Why that representation.
    pub representation_reason: String,
    /// The estimator used.
    pub estimator: Estimator,
    /// Why that estimator.
    pub estimator_reason: String,
    /// False where the run was interrupted before its stopping rule was met.
    pub complete: bool,
    /// What ended the run.
    pub stop: Stop,
    /// Largest se0 / max(S0, 10⁻³ · mean S0) over the free sensors.
    pub relative_error_max: f64,
    /// What each way of finding light has brought of S0.
    pub shares: Shares,
    /// How many walks each sensor has taken for one from the emitters.
    pub allocation: Allocation,
    /// Where the emitted flux goes, in the main model.
    pub energy: Energy,
    /// Light of the main model that the estimator cannot see; `None` where it sees all.
    pub unseen: Option<Unseen>,
    /// Paths that the estimator cannot see, walks that were truncated.
    pub warnings: Vec<String>,
}

/// What each way of finding light has brought, as shares of S0 summed over all free sensor points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shares {
    /// Summed exactly: sources without geometry, straight and by their images in few flat mirrors, emitters seen whole, and where
    /// walks correct a guess of what surfaces scatter, that guess.
    pub exact: f64,
    /// Emitters that walks from the sensors looked at, or what they corrected, which may be negative.
    pub looked: f64,
    /// Emitters that walks from the sensors looked at in mirrors.
    pub mirrored: f64,
    /// Emitters that walks from the sensors met by chance.
    pub met: f64,
    /// Walks from the emitters, joined to the sensors.
    pub local: f64,
}

impl Shares {
    /// The same, so that they sum to 1; all 0 where there is no light.
    pub(crate) fn normalised(self) -> Self {
        let sum = self.exact + self.looked + self.mirrored + self.met + self.local;
        let share = |part: f64| if sum > 0.0 { part / sum } else { 0.0 };
        Self {
            exact: share(self.exact),
            looked: share(self.looked),
            mirrored: share(self.mirrored),
            met: share(self.met),
            local: share(self.local),
        }
    }
}

/// The readings of one sensor group.
#[derive(Debug, Clone)]
pub struct Group {
    /// One reading a sensor point.
    pub readings: Vec<Reading>,
    /// Mean of S0 over the free points, unit/m².
    pub mean: f64,
    /// Standard error of `mean`; points that share walks are correlated, and this knows it.
    pub mean_standard_error: f64,
    /// Mean of the scalar model over the free points, where asked for.
    pub scalar: Option<Paired>,
    /// Mean of the diffuse model over the free points, where asked for.
    pub diffuse: Option<Paired>,
    /// What each replica gave.
    pub replicates: Replicates,
}

/// What each replica of a run gave for a sensor group: runs of one seed and number of samples differ by the mean of the
/// differences, with the standard error of those.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Replicates {
    /// Mean of S0 over the free points, unit/m².
    pub mean: Vec<f64>,
    /// S0 at the free point that has the least of the whole run, unit/m².
    pub min: Vec<f64>,
    /// Mean of the scalar model's S0 over the free points, unit/m²; empty where it was not asked for.
    pub scalar: Vec<f64>,
}

/// The irradiance Stokes vector at one sensor point, in unit/m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// True where the point lies inside a closed solid: everything else is then 0.
    pub enclosed: bool,
    /// S0, S1, S2, S3; 0 where the representation leaves a component out.
    pub stokes: [f64; 4],
    /// Their standard errors.
    pub standard_error: [f64; 4],
    /// Degree of linear polarisation √(S1² + S2²)/S0; 0 where S0 is 0.
    pub dolp: f64,
    /// Its standard error.
    pub dolp_standard_error: f64,
    /// The scalar model (same Fresnel reflectance, no polarisation) from the same walks, where asked for.
    pub scalar: Option<Paired>,
    /// The diffuse model (a = 0) from walks driven by the same random numbers, where asked for.
    pub diffuse: Option<Paired>,
}

/// Another model's S0 beside the main one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paired {
    /// S0 of the other model, unit/m².
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// S0 of the main model less `value`.
    pub difference: f64,
    /// Standard error of the difference, from paired replicas.
    pub difference_standard_error: f64,
}

/// Where the emitted flux goes, in the scene's unit: from walks of its own, few beside those of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Energy {
    /// Flux of all emitters, exact; of parallel light, what passes through the great circle of the scene.
    pub emitted: f64,
    /// Flux absorbed by surfaces.
    pub absorbed: f64,
    /// Flux that leaves the scene; of parallel light also what passes it by.
    pub escaped: f64,
    /// Flux of walks that were cut off.
    pub truncated: f64,
    /// Standard error of [`Energy::missing`].
    pub standard_error: f64,
    /// What each material of the scene absorbs.
    pub by_material: Vec<Absorbed>,
}

impl Energy {
    /// Emitted flux that is neither absorbed nor escaped nor truncated: 0 but for chance.
    #[must_use]
    pub fn missing(&self) -> f64 {
        self.emitted - self.absorbed - self.escaped - self.truncated
    }
}

/// Light that no technique of an estimator can find, as a share of all light that meets surfaces: the mean over all surfaces,
/// measured by the walks of the energy ledger. At single points, in a caustic say, it may be more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unseen {
    /// The share.
    pub share: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Upper end of its 95 % interval.
    pub at_most: f64,
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [share, error, most] =
            [self.share, self.standard_error, self.at_most].map(|x| 100.0 * x);
        write!(
            f,
            "on average over all surfaces that is {share:.2} ± {error:.2} % of the light there, at most {most:.2} %"
        )
    }
}

/// What a material absorbs.
#[derive(Debug, Clone, PartialEq)]
pub struct Absorbed {
    /// Its name, and where its values are those of one object the name of that in brackets.
    pub material: String,
    /// Absorbed flux, in the scene's unit.
    pub flux: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// What ended a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The relative error asked for was reached.
    RelativeError,
    /// The number of samples asked for was taken.
    Samples,
    /// [`Answer::Enough`] at a checkpoint: the time asked for is used up.
    Time,
    /// [`Answer::Interrupt`].
    Interrupted,
}

/// Where a run stands; handed to the `watch` callback of [`crate::run`] between steps.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Samples taken so far (as in [`Results::samples`]).
    pub samples: u64,
    /// Samples at the next checkpoint: stopping is decided at checkpoints only.
    pub next_checkpoint: u64,
    /// Samples at which the run ends at the latest, where given.
    pub samples_limit: Option<u64>,
    /// True where `samples` is a checkpoint: only here is [`Answer::Enough`] heeded.
    pub checkpoint: bool,
    /// Largest relative standard error at the last checkpoint, where one was reached.
    pub relative_error: Option<f64>,
    /// The relative error aimed at, where given.
    pub relative_error_goal: Option<f64>,
}

/// The watcher's answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// Go on.
    Continue,
    /// Stop at this checkpoint; the run counts as complete. Not heeded between checkpoints.
    Enough,
    /// Stop now with what is there; the run counts as incomplete.
    Interrupt,
}
