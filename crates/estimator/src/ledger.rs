//! Where the emitted flux goes: into which material, out of the scene, or off the end of walks that were cut.
//!
//! The ledger has walks of its own, few beside those of the run, so that it says the same of every estimator. What a
//! surface keeps is booked as its expectation, before it is decided how the walk goes on: the books then close on
//! average only, and how well they do is the check.

use crate::engine::Engine;
use crate::evaluate::Carrying;
use crate::journey::{End, journey};
use crate::medium::Medium;
use crate::missing::Trail;
use crate::pass::Passes;
use crate::path::Path;
use crate::random::Stream;
use crate::results::{Absorbed, Energy, Unseen};
use crate::site::Start;
use crate::statistics::{Estimate, Means, MergeError, Replica, Tally};
use crate::student::half_width_95;
use crate::techniques::Techniques;
use crate::trace::Walk;
use malus_geometry::Surfaces;
use malus_scene::{Estimator, Material, Scene};
use rayon::prelude::*;

/// Branch of a replica's stream that is the ledger's: no sensor has that number.
const BRANCH: u64 = u64::MAX;

/// Walks of the run for one of the ledger.
const SHARE: u64 = 64;

/// Least and most walks a replica.
const WALKS: [u64; 2] = [4, 4096];

/// Which sum holds what; those of the materials follow.
const ESCAPED: usize = 0;
const LEAKED: usize = 1;
const TRUNCATED: usize = 2;
/// All light that meets surfaces, and how much of it the run's estimator would miss there.
const MET: usize = 3;
const MISSING: usize = 4;
const MATERIALS: usize = 5;

/// The books of a run.
pub(crate) struct Ledger<'t> {
    tally: &'t Tally,
    emitted: f64,
}

impl<'t> Ledger<'t> {
    /// Keeps books of the main model with a small share of the walks of a run that took `taken` a replica, in a tally that
    /// may hold some of them already.
    ///
    /// # Errors
    /// The tally is of another scene.
    pub(crate) fn keep<const N: usize>(
        engine: &Engine<N>,
        estimator: Estimator,
        taken: u64,
        tally: &'t mut Tally,
    ) -> Result<Self, MergeError> {
        let passes = &engine.passes;
        let medium = &passes.main;
        // A walk of the other estimators is joined to every sensor, or begun at every sensor.
        let joined = match estimator {
            Estimator::Direct => 1,
            Estimator::Auto | Estimator::Local | Estimator::Gather => engine.receivers.len() as u64,
        };
        let [least, most] = WALKS;
        let walks = (taken.saturating_mul(joined) / SHARE).clamp(least, most);
        tally.fit(MATERIALS + medium.materials.len())?;
        let replicas: Vec<&mut Replica> = tally.replicas_mut().collect();
        replicas.into_par_iter().for_each(|replica| {
            let stream = Stream::new(engine.seed, replica.id).branch(BRANCH);
            for index in replica.points..walks {
                book::<N>(passes, estimator, stream, index, &mut replica.sums);
            }
            replica.points = walks;
        });
        Ok(Self {
            tally,
            emitted: medium.emitters.exposed_flux(medium.first()),
        })
    }

    /// What the books say, with the materials by the names of the main model.
    #[must_use]
    pub(crate) fn energy(&self, materials: &[Material]) -> Energy {
        let absorbed = |means: &Means| {
            (0..materials.len())
                .map(|i| means.at(MATERIALS + i))
                .sum::<f64>()
        };
        let at = |index: usize| self.tally.estimate(|means| means.at(index));
        let booked = self
            .tally
            .estimate(|means| absorbed(means) + means.at(ESCAPED) + means.at(TRUNCATED));
        Energy {
            emitted: self.emitted,
            absorbed: self.tally.estimate(absorbed).mean,
            escaped: at(ESCAPED).mean,
            truncated: at(TRUNCATED).mean,
            standard_error: booked.standard_error,
            by_material: materials
                .iter()
                .enumerate()
                .map(|(index, material)| Absorbed::new(material, at(MATERIALS + index)))
                .collect(),
        }
    }

    /// How much of all light the run's estimator cannot see.
    #[must_use]
    pub(crate) fn unseen(&self) -> Unseen {
        // Where no light meets anything none is missing.
        let met = self.tally.estimate(|means| means.at(MET)).mean;
        let met = met.max(f64::MIN_POSITIVE);
        let Estimate {
            mean,
            standard_error,
        } = self.tally.estimate(|means| means.at(MISSING) / met);
        // What none of n walks has met is rarer than 3/n in 95 of 100 cases.
        let replicas = self.tally.replicas().count() as u32;
        let walks = self.tally.points() * u64::from(replicas);
        let half_width = half_width_95(replicas.saturating_sub(1).max(1)) * standard_error;
        Unseen {
            share: mean,
            standard_error,
            at_most: (mean + half_width).max(3.0 / walks as f64),
        }
    }

    /// Says if light from inside leaves a scene that looks closed from every sensor point.
    #[must_use]
    pub(crate) fn leak(&self, scene: &Scene) -> Option<String> {
        let leaked = self.tally.estimate(|means| means.at(LEAKED) / self.emitted);
        (leaked.mean > 0.0 && scene.is_closed()).then(|| {
            format!(
                "{:.2e} ± {:.0e} of the emitted flux leaves the scene, which looks closed from every sensor point: there are \
                 gaps between its surfaces, or an emitter shines outwards",
                leaked.mean, leaked.standard_error
            )
        })
    }
}

impl Absorbed {
    fn new(material: &Material, flux: Estimate) -> Self {
        Self {
            material: match &material.object {
                Some(object) => format!("{} ({object})", material.name),
                None => material.name.clone(),
            },
            flux: flux.mean,
            standard_error: flux.standard_error,
        }
    }
}

/// Books one walk.
fn book<const N: usize>(
    passes: &Passes,
    estimator: Estimator,
    stream: Stream,
    index: u64,
    sums: &mut [f64],
) {
    let medium: &Medium = &passes.main;
    let uniforms = stream.walk(index);
    // A start on a hidden part of an emitter carries nothing.
    let Some(start) = medium.emitters.start(uniforms) else {
        return;
    };
    let mut carrying = Carrying::<N>::new(&start, medium.first());
    let mut walk = Walk::from_emitter(*medium, Techniques::ALONE, uniforms, &start);
    let mut trail = Trail::new(estimator, &start);
    let end = journey(&mut walk, &mut Path::default(), |vertex| {
        sums[MET] += carrying.flux();
        if trail.is_missing() {
            sums[MISSING] += carrying.flux();
        }
        trail.pass(vertex);
        sums[MATERIALS + vertex.material as usize] +=
            carrying.absorbed(vertex, &medium.first().materials);
        carrying.follow(std::slice::from_ref(vertex), medium.first(), |_, _| {});
    });
    match end {
        End::Absorbed => {}
        End::Truncated => sums[TRUNCATED] += carrying.flux(),
        End::Escaped => {
            sums[ESCAPED] += carrying.flux();
            if !from_outside(medium.surfaces, &start) {
                sums[LEAKED] += carrying.flux();
            }
        }
    }
}

/// True of a walk that came into the scene from outside its bounding sphere.
fn from_outside(surfaces: &Surfaces, start: &Start) -> bool {
    start.origin.distance(surfaces.centre()) > surfaces.radius()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emitters::Emitters;
    use crate::pass::Modelled;
    use malus_scene::Model;

    /// Light to and fro between mirrors, too near the horizontal to reach the black floor in 10⁶ reflections.
    #[test]
    fn what_is_cut_off_is_booked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let toml = "
            [[shape]]
            kind = 'box'
            min = [0, 0, 0]
            max = [1, 1, 100]
            inward = true
            material = 'mirror'
            [[shape]]
            kind = 'rectangle'
            origin = [0, 0, 0]
            u = [1, 0, 0]
            v = [0, 1, 0]
            material = 'floor'
            [material.mirror]
            rho = 0
            a = 1
            n = inf
            [material.floor]
            rho = 0
            [[source]]
            kind = 'spot'
            position = [0.5, 0.5, 50]
            direction = [1, 0, 0]
            intensity = 1
            cone_deg = 1e-3
            [[sensor]]
            name = 'floor'
            points = [[0.5, 0.5, 0]]
            normal = [0, 0, 1]";
        std::fs::write(&path, toml).unwrap();
        let scene = Scene::load(&path, &[]).unwrap();
        let emitters = Emitters::new(&scene);
        let modelled = Modelled::alone(&scene, Model::Polarised);
        let passes = Passes {
            main: modelled.medium(&scene, &emitters),
            apart: None,
            techniques: Techniques::ALONE,
        };
        let mut sums = vec![0.0; MATERIALS + scene.materials.len()];
        book::<3>(&passes, Estimator::Auto, Stream::new(1, 0), 0, &mut sums);
        let flux = emitters.exposed_flux(passes.main.first());
        assert!(flux > 0.0 && (sums[TRUNCATED] / flux - 1.0).abs() < 1e-9);
        assert!(sums[ESCAPED] <= 0.0 && sums[MATERIALS..].iter().sum::<f64>() < 1e-9 * flux);
    }
}
