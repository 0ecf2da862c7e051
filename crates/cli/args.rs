//! The command line as typed.

use crate::computing::{Computing, assignment};
use crate::portion::Portion;
use crate::submit::Cluster;
use anyhow::anyhow;
use clap::{Args, Parser, Subcommand};
use malus_geometry::Preset;
use malus_scene::Override;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Polarised light in rooms: illuminance or irradiance as a Stokes vector, with an error bar on every number.
#[derive(Debug, Parser)]
#[command(name = "malus", version, about, max_term_width = 100, after_help = EXAMPLES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  malus check office.toml                         what is in it, and what is wrong
  malus run office.toml                           compute it; results go to results/office
  malus run office.toml --relative-error 0.005    the same, to 0.5 % everywhere
  malus tradeoff office.toml                      how long which error takes
  malus analyse results/office/view.tiff          how a camera's picture is polarised

Exit status: 0 done, 1 the run failed, 2 bad arguments or a bad scene, 130 interrupted.";

const RUN_EXAMPLES: &str = "\
Examples:
  malus run office.toml -o results/glossy --set material.floor.a=0.6
  malus run office.toml --seconds 60 --threads 4
  malus run office.toml --samples 65536 --seed 7     repeats to the byte on any machine
  malus run office.toml --relative-error 1e-4 --resume        goes on after a reboot
  malus run office.toml --samples 1048576 --shard 3/8         one part of eight, for malus merge
  malus run office.toml --samples 1048576 --submit slurm --shards 8 --sbatch=--cpus-per-task=16 --wait

Results: sensors.csv (one row a sensor point), grids.csv (one row a sensor), a plan <sensor>.svg of each \
grid, and summary.json. A stop by error or by time prints the --samples that repeats it.

Exit status: 0 done, 1 the run failed, 2 bad arguments or a bad scene, 130 interrupted (Ctrl-C \
once: what is there is written and marked incomplete; twice: at once, without results).";

const MERGE_EXAMPLES: &str = "\
Examples:
  malus merge results/office                       all shards lie in one directory
  malus merge a/office b/office -o results/office  they were brought together from two machines

Scene or study is read again, from where it was when the shards were computed or from --scene, and has to be the same: the \
results have the bytes of one piece. Shards stay where they are.

Exit status: 0 done, 1 nothing can be written or a variant failed, 2 a shard is missing, there twice, unfinished, \
damaged or of another run.";

const SWEEP_EXAMPLES: &str = "\
Examples:
  malus sweep study-floor.toml                    every variant of the study; results go to results/study-floor
  malus sweep study.toml --samples 4096 --sensors
  malus sweep study.toml --resume                           goes on after a reboot
  malus sweep study.toml --samples 65536 --shard 3/8        one part of eight, for malus merge
  malus sweep study.toml --samples 65536 --submit slurm --shards 8 --wait

A study file names a scene and what varies in it, by the keys that --set takes:
  scene = \"office.toml\"
  [grid]                                          every combination
  \"material.Floor.a\" = [0, 0.2, 0.4]
  [list]                                          rows of a table whose header holds keys
  file = \"variants.csv\"
  [sample]                                        a seeded Latin hypercube
  count = 32
  \"material.Floor.n\" = { from = 1.3, to = 2.0 }
Several tables combine, each row of one with each of another. All variants take the walks that the stopping rule \
gives the base, the scene as it stands.

Results: variants.csv (a row a variant, written as it is finished), study.json (which variants differ, a ranking, \
sensitivities), a picture <sensor>-trade.svg of each sensor; with --parquet variants.parquet.

Exit status: 0 done, 1 a variant failed (the others are finished), 2 bad arguments, a bad scene or a bad study, 130 \
interrupted.";

const CHECK_EXAMPLES: &str = "\
Examples:
  malus check office.toml
  malus check office.toml --set material.floor.rho=0.2 --json

Exit status: 0 the scene can be run (there may be warnings), 2 bad arguments or a bad scene.";

const TRADEOFF_EXAMPLES: &str = "\
Examples:
  malus tradeoff office.toml
  malus tradeoff office.toml --budget 60 -o results/tradeoff
  malus tradeoff office.toml --set run.compare=[]    without the models computed beside

Results: tradeoff.csv (one row a setting and number of samples), tradeoff.svg (error against time), and the \
cheapest setting for 3 %, 1 %, 0.3 % and 0.1 % on stdout. Errors are against a reference of this command's own; \
the longer the budget, the smaller the errors that it can tell apart.

Exit status: 0 done, 1 nothing could be measured, 2 bad arguments or a bad scene, 130 interrupted (Ctrl-C once: \
what is measured is written; twice: at once, without results).";

const ANALYSE_EXAMPLES: &str = "\
Examples:
  malus analyse view.tiff                  how much is polarised, and along which axis
  malus analyse view.tiff --angle 90       what polarising sunglasses show
  malus analyse view.tiff --angle 0 --angle 45 -o filtered --exposure 1

Results: NAME-s0.png (what the eye sees), NAME-dolp.png (degree of linear polarisation), NAME-aolp.png (its \
angle) and for each angle NAME-filter-DEG.png and .tiff (radiance that passes, 32-bit floats). S0 and what \
passes a filter are shown with one exposure: unpolarised light looks half as bright through any filter.

Exit status: 0 done, 1 nothing can be written, 2 bad arguments or a bad picture.";

const BENCH_BVH_EXAMPLES: &str = "\
Examples:
  malus bench-bvh office.toml                      rates of all trees, with the scene's own sensors
  malus bench-bvh kitchen.obj --seconds 60 --json  of a mesh alone, measured longer
  malus bench-bvh office.toml --preset all         how much care in building is worth

wide is the tree that malus uses; bvh2 and cwbvh are those of the crate obvhs, for comparison. Answers are checked by \
trying every triangle; a wrong one of wide ends in exit status 1.

Exit status: 0 done, 1 wrong answers, 2 bad arguments or a bad file.";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute a scene: writes tables, plans and a summary, prints a short table
    #[command(after_help = RUN_EXAMPLES)]
    Run(Box<Run>),
    /// Evaluate design variants of one scene, with the differences between them: which differ, and which key matters
    #[command(after_help = SWEEP_EXAMPLES)]
    Sweep(Box<Sweep>),
    /// Join the shards of a run or of a study: writes the results of the whole
    #[command(after_help = MERGE_EXAMPLES)]
    Merge(Merge),
    /// Read a scene and say what was understood and what is wrong with it; compute nothing
    #[command(after_help = CHECK_EXAMPLES)]
    Check(Check),
    /// Measure error against time on a scene: which estimator, representation and number of samples to take
    #[command(after_help = TRADEOFF_EXAMPLES)]
    Tradeoff(Tradeoff),
    /// Look at a camera's picture through a linear polarising filter, and at how its light is polarised
    #[command(after_help = ANALYSE_EXAMPLES)]
    Analyse(Analyse),
    /// Measure how fast rays go through a scene or a mesh, and check that they are right
    #[command(after_help = BENCH_BVH_EXAMPLES)]
    BenchBvh(BenchBvh),
}

/// `malus run`.
#[derive(Args, Debug)]
pub struct Run {
    /// Scene file
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,

    /// Directory of the results [default: results/<scene file's name without .toml>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// How to compute it.
    #[command(flatten)]
    pub computing: Computing,

    /// Draw no plans
    #[arg(long)]
    pub no_pictures: bool,

    /// Show no progress and no table; warnings and errors stay
    #[arg(short, long)]
    pub quiet: bool,

    /// What of the run is computed, and how it survives.
    #[command(flatten)]
    pub portion: Portion,

    /// Where it is computed.
    #[command(flatten)]
    pub cluster: Cluster,
}

/// `malus sweep`.
#[derive(Args, Debug)]
pub struct Sweep {
    /// Study file
    #[arg(value_name = "STUDY.toml")]
    pub study: PathBuf,

    /// Directory of the results [default: results/<study file's name without .toml>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// How to compute it.
    #[command(flatten)]
    pub computing: Computing,

    /// Write each variant's sensor points to variants/NNN/sensors.csv
    #[arg(long)]
    pub sensors: bool,

    /// Write variants.parquet beside variants.csv, for a program that was built with the feature parquet
    #[arg(long)]
    pub parquet: bool,

    /// Draw nothing
    #[arg(long)]
    pub no_pictures: bool,

    /// Show no progress and no tables; warnings and errors stay
    #[arg(short, long)]
    pub quiet: bool,

    /// What of the study is computed, and how it survives.
    #[command(flatten)]
    pub portion: Portion,

    /// Where it is computed.
    #[command(flatten)]
    pub cluster: Cluster,
}

/// `malus merge`.
#[derive(Args, Debug)]
pub struct Merge {
    /// Directories with shards, as `malus run --shard` and `malus sweep --shard` write them
    #[arg(value_name = "DIR", required = true)]
    pub shards: Vec<PathBuf>,

    /// Directory of the results [default: the first of the directories]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// The scene file or study file, where it is no longer where the shards were computed
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,

    /// Draw no plans and write no pictures
    #[arg(long)]
    pub no_pictures: bool,

    /// Show no table; warnings and errors stay
    #[arg(short, long)]
    pub quiet: bool,
}

/// `malus check`.
#[derive(Args, Debug)]
pub struct Check {
    /// Scene file
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,

    /// Put a value in place of the scene file's, by its dotted path, e.g. material.floor.a=0.3 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE", value_parser = assignment)]
    pub set: Vec<Override>,
}

/// `malus tradeoff`.
#[derive(Args, Debug)]
pub struct Tradeoff {
    /// Scene file; its stopping rules are not used
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,

    /// Directory of the results [default: results/<scene file's name without .toml>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Time that the whole command may take [default: 300]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub budget: Option<String>,

    /// Most threads to compute with [default: all cores]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub threads: Option<String>,

    /// Put a value in place of the scene file's, by its dotted path, e.g. material.floor.a=0.3 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE", value_parser = assignment)]
    pub set: Vec<Override>,

    /// Draw no diagram
    #[arg(long)]
    pub no_pictures: bool,

    /// Show no progress and no table; warnings and errors stay
    #[arg(short, long)]
    pub quiet: bool,
}

/// `malus analyse`.
#[derive(Args, Debug)]
pub struct Analyse {
    /// Picture of a camera, as `malus run` writes it: 32-bit floats S0, S1, S2, S3
    #[arg(value_name = "NAME.tiff")]
    pub picture: PathBuf,

    /// Angle of a filter's transmission axis in degrees, from the picture's right, counter-clockwise as seen in the
    /// picture, -360 to 360 (may be repeated)
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub angle: Vec<String>,

    /// Brighter by so many powers of two, or darker, -30 to 30 [default: 0, at which half of the lit pixels are middle
    /// grey or brighter]
    #[arg(long, value_name = "EV", allow_hyphen_values = true)]
    pub exposure: Option<String>,

    /// Directory of the results [default: the picture's]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// `malus bench-bvh`.
#[derive(Args, Debug)]
pub struct BenchBvh {
    /// Scene file, or mesh file (.gltf, .glb, .obj)
    #[arg(value_name = "FILE")]
    pub file: PathBuf,

    /// Measure for so long, after building; every ray is traced at least once
    #[arg(
        long,
        value_name = "T",
        allow_hyphen_values = true,
        default_value = "10"
    )]
    pub seconds: String,

    /// Threads to compute with beside one alone [default: all cores]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub threads: Option<String>,

    /// How much care is taken in building a tree (may be repeated)
    #[arg(long, value_enum, default_value = "medium")]
    pub preset: Vec<PresetName>,

    /// Write the geometry and the rays to this directory, as arrays that other programs can read: little-endian
    /// vertices.f64 and triangles.u32, primary.f64 and cosine.f64 (origin, direction), pairs.f64 and sensors.f64 (ends)
    #[arg(long, value_name = "DIR")]
    pub rays: Option<PathBuf>,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}

/// A preset by name.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum PresetName {
    /// Half the speed
    Fastest,
    /// In between
    VeryFast,
    /// In between
    Fast,
    /// What malus uses
    Medium,
    /// In between
    Slow,
    /// Ten times the build time
    VerySlow,
    /// Each of them
    All,
}

impl BenchBvh {
    /// How long to measure.
    pub fn seconds(&self) -> anyhow::Result<Duration> {
        let text = &self.seconds;
        text.parse()
            .ok()
            .filter(|seconds| (0.0..=1e6).contains(seconds))
            .map(Duration::from_secs_f64)
            .ok_or_else(|| {
                anyhow!("--seconds {text}: must be a number from 0 to 1e6, found {text:?}")
            })
    }

    /// The presets asked for, each once.
    pub fn presets(&self) -> Vec<Preset> {
        let all = [
            (PresetName::Fastest, Preset::Fastest),
            (PresetName::VeryFast, Preset::VeryFast),
            (PresetName::Fast, Preset::Fast),
            (PresetName::Medium, Preset::Medium),
            (PresetName::Slow, Preset::Slow),
            (PresetName::VerySlow, Preset::VerySlow),
        ];
        let asked = |name| self.preset.contains(&name) || self.preset.contains(&PresetName::All);
        all.into_iter()
            .filter_map(|(name, preset)| asked(name).then_some(preset))
            .collect()
    }
}

impl Run {
    /// The run that [`Computing::words`] tells of, with a number of samples.
    ///
    /// # Errors
    /// The words are none that it gives.
    pub fn told(scene: &Path, words: &[String], samples: u64) -> Result<Self, clap::Error> {
        let samples = ["--samples".to_owned(), samples.to_string()];
        match told("run", scene, words.iter().chain(&samples))? {
            Command::Run(run) => Ok(*run),
            _ => unreachable!("run was asked for"),
        }
    }
}

impl Sweep {
    /// The study that [`Computing::words`] tells of.
    ///
    /// # Errors
    /// The words are none that it gives.
    pub fn told(study: &Path, words: &[String]) -> Result<Self, clap::Error> {
        match told("sweep", study, words.iter())? {
            Command::Sweep(sweep) => Ok(*sweep),
            _ => unreachable!("sweep was asked for"),
        }
    }
}

/// A command with the file that it reads and further words.
fn told<'w>(
    command: &str,
    file: &Path,
    words: impl Iterator<Item = &'w String>,
) -> Result<Command, clap::Error> {
    let before = ["malus".into(), command.into(), file.as_os_str().to_owned()];
    let words = before.into_iter().chain(words.map(OsString::from));
    Ok(Arguments::try_parse_from(words)?.command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn run(words: &[&str]) -> Run {
        let words = ["malus", "run", "room.toml"].iter().chain(words);
        match Arguments::try_parse_from(words)
            .expect("good arguments")
            .command
        {
            Command::Run(run) => *run,
            _ => unreachable!("run was asked for"),
        }
    }

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn options_follow_sets_so_that_they_win() {
        let run = run(&["--samples", "64", "--set", "run.samples=32"]);
        let values: Vec<String> = run
            .computing
            .overrides()
            .into_iter()
            .map(|o| o.value)
            .collect();
        assert_eq!(values, ["32", "64"]);
    }

    #[test]
    fn a_set_value_may_hold_an_equals_sign() {
        let run = run(&["--set", "sensor.desk.grid={ counts = [2, 2] }"]);
        assert_eq!(run.computing.set[0].key, "sensor.desk.grid");
        assert_eq!(run.computing.set[0].value, "{ counts = [2, 2] }");
        let words = ["malus", "run", "room.toml", "--set", "material.a"];
        assert!(Arguments::try_parse_from(words).is_err());
    }

    #[test]
    fn a_negative_number_is_a_value_to_be_judged_and_no_option() {
        assert_eq!(
            run(&["--samples", "-5"]).computing.samples.as_deref(),
            Some("-5")
        );
    }

    #[test]
    fn a_run_is_told_again_by_its_words() {
        let run = run(&[
            "--seconds",
            "60",
            "--seed",
            "7",
            "--set",
            "material.\"Wall 1\".a=0",
        ]);
        let again = Run::told(&run.scene, &run.computing.words(), 128).expect("the same");
        assert_eq!(again.scene, run.scene);
        let (again, run) = (again.computing, run.computing);
        assert_eq!(again.words(), run.words());
        assert_eq!(again.repeating(128), run.repeating(128));
        let stops = [&again.samples, &again.seconds, &again.relative_error];
        assert_eq!(stops, [&Some("128".to_owned()), &None, &None]);
    }

    #[test]
    fn the_options_that_repeat_a_run_replace_its_stopping_rules() {
        let run = run(&[
            "--seconds",
            "60",
            "--model",
            "scalar",
            "--set",
            "material.\"Wall 1\".a=0",
            "--set",
            "run.relative_error=0.1",
            "--quiet",
        ]);
        assert_eq!(
            run.computing.repeating(4096),
            "--samples 4096 --set 'material.\"Wall 1\".a=0' --model scalar"
        );
    }
}
