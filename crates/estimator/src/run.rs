//! A run: replicas taken further in steps until a stopping rule holds.

use crate::allocation::{Allocation, Sharing};
use crate::checkpoints::Checkpoints;
use crate::choose::{self, blind_spots, erratic};
use crate::direct::{self, Cells};
use crate::emitters::Emitters;
use crate::engine::Engine;
use crate::exact::{self, Known};
use crate::gather::Aims;
use crate::ledger::Ledger;
use crate::local::targets;
use crate::medium::Medium;
use crate::neighbours::{Neighbours, memberships};
use crate::pass::{Channels, Modelled, Passes, has_mirrors};
use crate::pilot::Stations;
use crate::radiosity::Radiosity;
use crate::reading::{Readings, Unmet};
use crate::receiver::Receiver;
use crate::results::{Answer, Group, Progress, Results, Stop};
use crate::sight::Sight;
use crate::state::{Shard, State, StateError};
use crate::statistics::REPLICAS;
use crate::trace::LONGEST;
use crate::variation::covering;
use malus_optics::Representation;
use malus_scene::{Estimator, Model, Scene, Settings};

/// Evaluates a scene.
///
/// `settings` stand in for the scene's own. `watch` is told between steps how far the run is, and answers whether it
/// goes on; its answers are the only thing besides scene and settings that a result depends on, and a run that it
/// stopped at n samples has the bytes of a run that was given `samples = n`.
pub fn run(
    scene: &Scene,
    settings: &Settings,
    watch: &mut dyn FnMut(&Progress) -> Answer,
) -> Results {
    let mut state = State::new(Shard::WHOLE);
    resume(scene, settings, &mut state, &mut |progress, _| {
        watch(progress)
    })
    .expect("a state without walks fits every scene")
}

/// The same, from a state that an earlier run of the same scene and settings has left, or that parts of it have been
/// joined to; the stopping rules alone may differ.
///
/// `watch` is shown the state between steps, and may keep it: a run that goes on from there has the bytes of one that was
/// never set aside. Afterwards `state` holds all that was summed. Of a shard, the results are those of its own
/// replicas.
///
/// # Errors
/// The state does not fit the scene, or has come further than `settings.samples`.
pub fn resume(
    scene: &Scene,
    settings: &Settings,
    state: &mut State,
    watch: &mut dyn FnMut(&Progress, &State) -> Answer,
) -> Result<Results, StateError> {
    let alone = Ensemble {
        scenes: &[scene],
        covering: scene,
        sharing: Sharing::Points,
        alone: true,
    };
    Ok(alone.run(settings, state, watch)?.first)
}

/// What several scenes give that were evaluated along the same walks.
#[derive(Debug)]
pub struct Together {
    /// The first scene.
    pub first: Results,
    /// The sensor groups of the others.
    pub others: Vec<Vec<Group>>,
}

/// Evaluates `scenes`, one at least, all of which the same walks serve (see [`Cohort`](crate::Cohort)), along these.
///
/// Stopping rules hold for the first of them. Everything else is as in [`run`].
pub fn run_together(
    scenes: &[&Scene],
    settings: &Settings,
    sharing: Sharing,
    watch: &mut dyn FnMut(&Progress) -> Answer,
) -> Together {
    let mut state = State::new(Shard::WHOLE);
    let together = resume_together(scenes, settings, sharing, &mut state, &mut |progress, _| {
        watch(progress)
    });
    together.expect("a state without walks fits every scene")
}

/// The same, from a state that is taken further as by [`resume`].
///
/// # Errors
/// The state does not fit the scenes, or has come further than `settings.samples`.
pub fn resume_together(
    scenes: &[&Scene],
    settings: &Settings,
    sharing: Sharing,
    state: &mut State,
    watch: &mut dyn FnMut(&Progress, &State) -> Answer,
) -> Result<Together, StateError> {
    let covering = covering(scenes);
    let ensemble = Ensemble {
        scenes,
        covering: &covering,
        sharing,
        alone: false,
    };
    ensemble.run(settings, state, watch)
}

/// Scenes that are evaluated along the same walks.
struct Ensemble<'a> {
    scenes: &'a [&'a Scene],
    /// The scene by which emitters are chosen.
    covering: &'a Scene,
    /// How walks are shared out.
    sharing: Sharing<'a>,
    /// Whether no other scene is to be compared with the one: walks that correct a guess keep no step with others.
    alone: bool,
}

impl Ensemble<'_> {
    fn run(
        &self,
        settings: &Settings,
        state: &mut State,
        watch: &mut dyn FnMut(&Progress, &State) -> Answer,
    ) -> Result<Together, StateError> {
        let representation = representation_of(self.covering, settings);
        match representation {
            Representation::Intensity => {
                run_with::<1>(self, settings, representation, state, watch)
            }
            Representation::Linear => run_with::<3>(self, settings, representation, state, watch),
            Representation::Full => run_with::<4>(self, settings, representation, state, watch),
        }
    }
}

/// How many components a run carries.
pub(crate) fn representation_of(scene: &Scene, settings: &Settings) -> Representation {
    match settings.model {
        Model::Polarised => settings.representation.unwrap_or(scene.need.representation),
        Model::Scalar | Model::Diffuse => Representation::Intensity,
    }
}

fn run_with<const N: usize>(
    ensemble: &Ensemble,
    settings: &Settings,
    representation: Representation,
    state: &mut State,
    watch: &mut dyn FnMut(&Progress, &State) -> Answer,
) -> Result<Together, StateError> {
    let limit = settings
        .samples
        .map(|samples| samples.div_ceil(u64::from(REPLICAS)).max(1));
    state.check(limit)?;
    let Ensemble {
        scenes,
        covering: scene,
        sharing,
        alone,
    } = *ensemble;
    let mirrors = scenes.iter().any(|it| has_mirrors(&it.materials));
    let channels = Channels::new(mirrors, settings, representation);
    let emitters = Emitters::new(scene);
    let mut receivers = Receiver::all(scene);
    let main = Modelled::new(scenes, scene, settings.model);
    let apart = channels.apart.map(|_| match settings.model {
        Model::Diffuse => Modelled::new(scenes, scene, Model::Scalar),
        Model::Polarised | Model::Scalar => Modelled::new(scenes, scene, Model::Diffuse),
    });
    let medium = main.medium(scene, &emitters);
    let radiosity = (settings.estimator == Estimator::Auto && alone && apart.is_none())
        .then(|| Radiosity::new(&medium, &receivers))
        .flatten();
    let (techniques, estimator_reason) = match radiosity {
        Some(_) => choose::CORRECTING,
        None => choose::techniques(settings.estimator, &scene.surfaces, &receivers),
    };
    let passes = Passes {
        main: Medium {
            radiosity: radiosity.as_ref(),
            ..medium
        },
        apart: apart.as_ref().map(|apart| apart.medium(scene, &emitters)),
        techniques,
    };
    let cells = (settings.estimator == Estimator::Direct).then(|| {
        let side = settings.cell.unwrap_or(direct::SIDE);
        Cells::new(&scene.surfaces, &receivers, side)
    });
    let panes = passes.media().any(|medium| medium.panes);
    let sight = techniques
        .gather
        .then(|| Sight::new(&scene.surfaces, &emitters, &mut receivers, panes));
    let known = match cells {
        // Counted like all other light.
        Some(_) => {
            let nothing = |_| Known::nothing(&channels, receivers.len());
            (0..scenes.len()).map(nothing).collect()
        }
        None => exact::known::<N>(&passes, &channels, &receivers, sight.as_ref()),
    };
    let targets = targets(&scene.surfaces, &receivers);
    let share = techniques.shared && !panes;
    let aims = Aims::all(&passes, &receivers);
    let memberships = match techniques.shared {
        false => (0..receivers.len()).collect(),
        true => memberships(&scene.surfaces, &receivers),
    };
    let allocation = match sharing {
        Sharing::Like(like) if like.fits(receivers.len()) => like.clone(),
        _ if techniques.shared => {
            let exact = |sensor: usize| known[0].at(sensor, 0);
            let stations = Stations {
                receivers: &receivers,
                targets: &targets,
                aims: &aims,
                share,
            };
            Allocation::piloted(
                &passes,
                stations,
                memberships,
                exact,
                settings.seed,
                sharing,
            )
        }
        _ => Allocation::even(memberships),
    };
    let neighbours = Neighbours::all(
        &scene.surfaces,
        &receivers,
        &allocation.memberships,
        allocation.times(),
        share,
    );
    let engine = Engine::<N> {
        passes,
        channels,
        receivers: &receivers,
        targets: &targets,
        share,
        neighbours: &neighbours,
        allocation: &allocation,
        aims: &aims,
        cells: cells.as_ref(),
        seed: settings.seed,
    };
    let unmet = match &cells {
        Some(cells) => vec![direct::unmet(&passes.main, cells); receivers.len()],
        None if techniques.gather => unmet(&passes, &emitters, &aims),
        None => vec![Unmet::default(); receivers.len()],
    };
    let readings = |variant: usize| Readings {
        scene,
        channels,
        receivers: &receivers,
        allocation: &allocation,
        known: &known[variant],
        unmet: unmet.clone(),
        counted: cells.is_some(),
        shared: techniques.mirrored,
        guessed: radiosity.is_some(),
        variant: (variant, scenes.len()),
    };
    let first = readings(0);

    let checkpoints = Checkpoints::new(settings.relative_error, |walks| {
        allocation.expected_error(walks * u64::from(REPLICAS))
    });
    engine.fit(&mut state.walks)?;
    let mut taken = state.walks.points();
    let mut reached = None;
    let stop = loop {
        // A run that goes on is judged where it was set aside, too: it may have been right before its end.
        if taken > 0 {
            let checkpoint = checkpoints.holds(taken) || Some(taken) == limit;
            if checkpoint {
                reached = Some(first.relative_error(&state.walks));
            }
            let progress = Progress {
                samples: taken * u64::from(REPLICAS),
                next_checkpoint: checkpoints.after(taken).min(limit.unwrap_or(u64::MAX))
                    * u64::from(REPLICAS),
                samples_limit: limit.map(|n| n * u64::from(REPLICAS)),
                checkpoint,
                relative_error: reached,
                relative_error_goal: settings.relative_error,
            };
            let answer = watch(&progress, state);
            if answer == Answer::Interrupt {
                break Stop::Interrupted;
            }
            if checkpoint {
                if let (Some(error), Some(goal)) = (reached, settings.relative_error)
                    && error <= goal
                {
                    break Stop::RelativeError;
                }
                if Some(taken) == limit {
                    break Stop::Samples;
                }
                if answer == Answer::Enough {
                    break Stop::Time;
                }
            }
        }
        let checkpoint = checkpoints.after(taken).min(limit.unwrap_or(u64::MAX));
        taken = checkpoint.min(taken + engine.step());
        engine.advance(&mut state.walks, taken);
    };

    let ledger = Ledger::keep(&engine, settings.estimator, taken, &mut state.books)?;
    let tally = &state.walks;
    let relative_error_max = first.relative_error(tally);
    // The scalar model beside the diffuse one has mirrors of its own.
    let blind = |medium: &Medium| blind_spots(medium, settings.estimator);
    let mut warnings = blind(&engine.passes.main);
    let unseen = warnings.last_mut().map(|last| {
        let unseen = ledger.unseen();
        last.push_str(&format!("; {unseen}"));
        unseen
    });
    warnings.extend(engine.passes.apart.iter().flat_map(blind));
    warnings.extend(erratic(&engine, settings.estimator));
    if let Some(cells) = &cells {
        warnings.push(direct::warning(cells));
    } else {
        warnings.extend(exact::singular(&engine.passes.main, &receivers));
    }
    warnings.extend(first.dark(tally));
    warnings.extend(ledger.leak(scenes[0]));
    let truncated: u64 = tally.replicas().map(|replica| replica.truncated).sum();
    if truncated > 0 {
        warnings.push(format!(
            "{truncated} walks were cut off after {LONGEST} reflections: what they still carried is missing"
        ));
    }
    let first = Results {
        groups: first.groups(tally),
        samples: taken * u64::from(REPLICAS),
        dof: REPLICAS - 1,
        representation,
        representation_reason: representation_reason(scene, settings),
        estimator: settings.estimator,
        estimator_reason: estimator_reason.into(),
        shares: first.shares(tally),
        allocation: allocation.clone(),
        complete: stop != Stop::Interrupted,
        stop,
        relative_error_max,
        energy: ledger.energy(engine.passes.main.materials),
        unseen,
        warnings,
    };
    let others = 1..scenes.len();
    Ok(Together {
        others: others
            .map(|variant| readings(variant).groups(tally))
            .collect(),
        first,
    })
}

/// What may lie for each sensor in mirrors that nothing looks into, and has not been met by chance yet.
fn unmet(passes: &Passes, emitters: &Emitters, aims: &[Aims]) -> Vec<Unmet> {
    let all = emitters.unmet();
    let share = |medium: &Medium| {
        if passes.techniques.mirrored {
            medium.mirrors.unseen()
        } else {
            f64::from(u8::from(has_mirrors(medium.materials)))
        }
    };
    // The most that there can be of it is what such mirrors can send on.
    let most = passes.media().map(share).fold(0.0, f64::max);
    let one = |aims: &Aims| match passes.techniques.mirrored {
        true => aims.greatest(),
        false => most,
    };
    let unmet = |aims: &Aims| Unmet {
        one: all.one * one(aims),
        most: all.most * most,
    };
    aims.iter().map(unmet).collect()
}

fn representation_reason(scene: &Scene, settings: &Settings) -> String {
    match (settings.model, settings.representation) {
        (Model::Scalar, _) => "the scalar model has no polarisation".into(),
        (Model::Diffuse, _) => "the diffuse model has no polarisation".into(),
        (Model::Polarised, None) => scene.need.reason.clone(),
        (Model::Polarised, Some(asked)) if asked < scene.need.representation => {
            format!(
                "asked for, although the scene needs more: {}",
                scene.need.reason
            )
        }
        (Model::Polarised, Some(_)) => "asked for".into(),
    }
}
