//! The runs that are measured, all settings in alternation, so that what else the machine does befalls all alike.

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::number::significant;
use crate::progress::Reporter;
use crate::run::pool;
use crate::stop;
use crate::tradeoff::curve::Curve;
use crate::tradeoff::reference::Reference;
use crate::tradeoff::setting::Setting;
use crate::tradeoff::trial::Trial;
use malus_estimator::{Answer, REPLICAS, Results, unseen};
use malus_scene::{Estimator, Scene, Settings};
use rayon::ThreadPool;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

/// Ratio of one number of samples to the one before: each trial halves the error of the last.
const STEP: u64 = 4;

/// What all smaller trials take together with the largest, 1 + 1/4 + 1/16 + …, as a multiple of the largest.
const LADDER: f64 = 4.0 / 3.0;

/// The relative standard error at which the reference is good enough for any use: a fifth of half of 0.1 %.
const ENOUGH: f64 = 1e-4;

/// Trials of fewer runs are not shown where others have more: they may have been lucky.
const LEAST_RUNS: usize = 3;

/// Share of the limit of the reference down to which trials count as told while they are being made: what chance makes of
/// it is seen afterwards.
const BARELY: f64 = 0.7;

/// Share of the budget that is kept for writing.
const WRITING: f64 = 0.01;

/// Time that the whole command may take.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    started: Instant,
    /// All of it, in seconds.
    pub seconds: f64,
}

impl Budget {
    /// So many seconds from a moment on.
    pub fn new(started: Instant, seconds: f64) -> Self {
        Self { started, seconds }
    }

    /// Seconds that are used up.
    pub fn elapsed(self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Seconds left to compute in.
    pub fn left(self) -> f64 {
        ((1.0 - WRITING) * self.seconds - self.elapsed()).max(0.0)
    }
}

/// All runs of one command.
pub struct Series<'a> {
    scene: &'a Scene,
    /// The time there is.
    pub budget: Budget,
    interrupt: &'a Interrupt,
    pools: BTreeMap<usize, ThreadPool>,
    ladders: Vec<(Setting, Vec<Trial>)>,
    passes: u64,
}

impl<'a> Series<'a> {
    /// No runs yet.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn new(
        scene: &'a Scene,
        most_threads: usize,
        budget: Budget,
        interrupt: &'a Interrupt,
    ) -> Result<Self, Failure> {
        let settings = Setting::all(scene, most_threads);
        let counts: BTreeSet<usize> = settings.iter().map(|it| it.threads).collect();
        let pools: Result<_, Failure> = counts
            .into_iter()
            .map(|threads| Ok((threads, pool(threads)?)))
            .collect();
        Ok(Self {
            scene,
            budget,
            interrupt,
            pools: pools?,
            ladders: settings.into_iter().map(|it| (it, Vec::new())).collect(),
            passes: 0,
        })
    }

    /// One run of each setting with each number of samples, one seed for all, the settings in alternation.
    ///
    /// The greatest numbers of samples are those of which all settings can be run `runs` times in `time` seconds, or
    /// whose error the reference, where there is one, can still tell. Returns the number of runs.
    pub fn pass(
        &mut self,
        reference: Option<&Reference>,
        time: f64,
        runs: u32,
        reporter: &mut Reporter,
    ) -> usize {
        self.passes += 1;
        let longest = time / (f64::from(runs) * LADDER * self.ladders.len() as f64);
        let count = self.ladders.len();
        let mut done = 0;
        let mut rung = 0;
        let mut open = vec![true; count];
        while open.contains(&true) {
            for turn in 0..count {
                let index = (turn + self.passes as usize) % count;
                open[index] &= self.is_due(index, rung, longest, reference);
                if open[index] && self.take(index, rung, reporter) {
                    done += 1;
                }
            }
            rung += 1;
        }
        done
    }

    /// Whether a trial is to be run once more.
    fn is_due(
        &self,
        index: usize,
        rung: usize,
        longest: f64,
        reference: Option<&Reference>,
    ) -> bool {
        let trials = &self.ladders[index].1;
        let below = rung.checked_sub(1).and_then(|below| trials.get(below));
        let seconds = match (trials.get(rung), below) {
            (Some(trial), _) => trial.median_seconds(),
            (None, Some(below)) => STEP as f64 * below.median_seconds(),
            (None, None) if rung == 0 => 0.0,
            (None, None) => return false,
        };
        // One step beyond what can be told, so that where the limit is crossed can be told.
        let told = below
            .zip(reference)
            .is_none_or(|(trial, reference)| trial.stated(reference) > BARELY * reference.limit());
        let left = self.budget.left();
        let fits = seconds < left && (seconds <= longest || rung == 0);
        !self.interrupt.asked() && left > 0.0 && fits && told
    }

    /// Runs a trial once more; whether it came to its end.
    fn take(&mut self, index: usize, rung: usize, reporter: &mut Reporter) -> bool {
        let setting = self.ladders[index].0;
        let samples = u64::from(REPLICAS) * STEP.saturating_pow(rung as u32);
        // The reference has the scene's own seed.
        let seed = self.scene.settings.seed.wrapping_add(self.passes);
        let settings = setting.settings(self.scene, samples, seed);
        let stage = format!(
            "pass {}: {}, {samples} samples",
            self.passes,
            setting.words()
        );
        let (results, seconds) = self.run(
            &settings,
            setting.threads,
            None,
            |_| stage.clone(),
            reporter,
        );
        if !results.complete {
            return false;
        }
        let trials = &mut self.ladders[index].1;
        if trials.len() == rung {
            trials.push(Trial::new(samples));
        }
        trials[rung].add(&results, seconds);
        true
    }

    /// A reference by `gather` alone in so many seconds, or by all techniques where `gather` does not see all light;
    /// `None` where no light reaches any sensor.
    pub fn reference(&mut self, seconds: f64, reporter: &mut Reporter) -> Option<Reference> {
        let (plain, _) = self.ladders[0];
        let need = plain.representation.max(self.scene.need.representation);
        let mut settings = Settings {
            compare_scalar: false,
            compare_diffuse: false,
            estimator: Estimator::Gather,
            cell: None,
            samples: None,
            relative_error: Some(ENOUGH),
            ..plain.settings(self.scene, 1, self.scene.settings.seed)
        };
        settings.representation = Some(need);
        if !unseen(self.scene, &settings).is_empty() {
            settings.estimator = Estimator::Auto;
        }
        let stage = |error: Option<f64>| {
            let percent = |share: f64| format!("{} %", significant(100.0 * share, 2));
            let now = error.map_or(String::new(), |error| {
                format!(", error {} (goal {})", percent(error), percent(ENOUGH))
            });
            format!("reference{now}")
        };
        let (results, seconds) = self.run(&settings, plain.threads, Some(seconds), stage, reporter);
        Reference::of(&results, seconds)
    }

    /// A run and the time it took; incomplete where the user or the budget has ended it. With a `limit` in seconds it
    /// ends by itself at the last checkpoint before.
    fn run(
        &self,
        settings: &Settings,
        threads: usize,
        limit: Option<f64>,
        stage: impl Fn(Option<f64>) -> String + Sync,
        reporter: &mut Reporter,
    ) -> (Results, f64) {
        let budget = self.budget;
        let compute = |reporter: &mut Reporter| {
            let started = Instant::now();
            let results = malus_estimator::run(self.scene, settings, &mut |progress| {
                reporter.show_stage(&stage(progress.relative_error), budget.elapsed());
                if self.interrupt.asked() || budget.left() <= 0.0 {
                    Answer::Interrupt
                } else {
                    stop::answer(progress, started.elapsed().as_secs_f64(), limit)
                }
            });
            (results, started.elapsed().as_secs_f64())
        };
        match self.pools.get(&threads) {
            Some(pool) => pool.install(|| compute(reporter)),
            None => compute(reporter),
        }
    }

    /// The curves, in the order of the settings.
    pub fn curves(&self, reference: &Reference) -> Vec<Curve> {
        let trials = || self.ladders.iter().flat_map(|(_, trials)| trials);
        let most = trials().map(Trial::runs).max().unwrap_or(0);
        self.ladders
            .iter()
            .map(|(setting, trials)| Curve {
                setting: *setting,
                outcomes: trials
                    .iter()
                    .filter(|trial| trial.runs() >= LEAST_RUNS.min(most))
                    .filter_map(|trial| trial.outcome(reference))
                    .collect(),
                limit: reference.limit(),
                is_unbiased: setting.shortcomings(self.scene).is_empty(),
            })
            .filter(|curve| !curve.outcomes.is_empty())
            .collect()
    }
}
