//! The command line as typed.

mod examples;

use crate::computing::{Computing, assignment};
use crate::portion::Portion;
use crate::submit::Cluster;
use anyhow::anyhow;
use clap::{Args, Parser, Subcommand};
use examples::{
    ANALYSE_EXAMPLES, BENCH_BVH_EXAMPLES, CHECK_EXAMPLES, EXAMPLES, MERGE_EXAMPLES, RUN_EXAMPLES,
    SWEEP_EXAMPLES, TRADEOFF_EXAMPLES,
};
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
