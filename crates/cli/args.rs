//! The command line as typed.

use anyhow::anyhow;
use clap::{Args, Parser, Subcommand};
use malus_geometry::Preset;
use malus_scene::Override;
use std::path::PathBuf;
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
  malus analyse results/office/view.tiff          how a camera's picture is polarised

Exit status: 0 done, 1 the run failed, 2 bad arguments or a bad scene, 130 interrupted.";

const RUN_EXAMPLES: &str = "\
Examples:
  malus run office.toml -o results/glossy --set material.floor.a=0.6
  malus run office.toml --seconds 60 --threads 4
  malus run office.toml --samples 65536 --seed 7     repeats to the byte on any machine

Results: sensors.csv (one row a sensor point), grids.csv (one row a sensor), a plan <sensor>.svg of each \
grid, and summary.json. A stop by error or by time prints the --samples that repeats it.

Exit status: 0 done, 1 the run failed, 2 bad arguments or a bad scene, 130 interrupted (Ctrl-C \
once: what is there is written and marked incomplete; twice: at once, without results).";

const CHECK_EXAMPLES: &str = "\
Examples:
  malus check office.toml
  malus check office.toml --set material.floor.rho=0.2 --json

Exit status: 0 the scene can be run (there may be warnings), 2 bad arguments or a bad scene.";

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
    /// Read a scene and say what was understood and what is wrong with it; compute nothing
    #[command(after_help = CHECK_EXAMPLES)]
    Check(Check),
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

    /// Stop after so many walks of light, rounded up to whole rounds.
    /// A stopping rule given here replaces all those of the scene file; of several, the first one reached stops the run
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub samples: Option<String>,

    /// Stop when the standard error is at most this share at every sensor, e.g. 0.01 for 1 %
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pub relative_error: Option<String>,

    /// Stop before this time is over, at a checkpoint
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub seconds: Option<String>,

    /// Seed of the random numbers: the same seed and samples give the same results
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub seed: Option<String>,

    /// Threads to compute with; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub threads: Option<String>,

    /// What surfaces do: polarised, scalar (the same Fresnel reflectance without polarisation) or
    /// diffuse (no mirror-like part)
    #[arg(long, value_name = "MODEL")]
    pub model: Option<String>,

    /// How light is joined to the sensors: auto, local (walks from the lamps), gather (walks from the sensors) or
    /// direct (hits of walks from the lamps, counted in cells of the size run.cell)
    #[arg(long, value_name = "ESTIMATOR")]
    pub estimator: Option<String>,

    /// Stokes components carried: auto (what the scene needs), intensity (1), linear (3) or full (4)
    #[arg(long, value_name = "COMPONENTS")]
    pub representation: Option<String>,

    /// Put a value in place of the scene file's, by its dotted path, e.g. material.floor.a=0.3 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE", value_parser = assignment)]
    pub set: Vec<Override>,

    /// Draw no plans
    #[arg(long)]
    pub no_pictures: bool,

    /// Show no progress and no table; warnings and errors stay
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

/// `KEY=VALUE` as an override; the value may hold further equals signs.
fn assignment(text: &str) -> Result<Override, String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok(Override {
            key: key.trim().to_owned(),
            value: value.to_owned(),
        }),
        _ => Err("expected KEY=VALUE, such as material.floor.a=0.3".to_owned()),
    }
}

/// An option of `run` that stands for a key of the table `[run]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunKey<'a> {
    /// The option, without its dashes.
    pub option: &'static str,
    /// The key of the scene file.
    pub key: &'static str,
    /// The value as typed.
    pub value: &'a str,
}

impl RunKey<'_> {
    /// The same as an override: one set of rules checks what is typed and what is in the file.
    pub fn as_override(&self) -> Override {
        Override {
            key: self.key.to_owned(),
            value: self.value.to_owned(),
        }
    }
}

impl Run {
    /// The options given that stand for keys of the scene file.
    pub fn keys(&self) -> Vec<RunKey<'_>> {
        [
            ("samples", "run.samples", &self.samples),
            ("relative-error", "run.relative_error", &self.relative_error),
            ("seconds", "run.seconds", &self.seconds),
            ("seed", "run.seed", &self.seed),
            ("model", "run.model", &self.model),
            ("estimator", "run.estimator", &self.estimator),
            ("representation", "run.representation", &self.representation),
        ]
        .into_iter()
        .filter_map(|(option, key, value)| {
            let value = value.as_deref()?;
            Some(RunKey { option, key, value })
        })
        .collect()
    }

    /// All overrides: those of `--set`, then the options, which win.
    pub fn overrides(&self) -> Vec<Override> {
        let options = self.keys();
        let options = options.iter().map(RunKey::as_override);
        self.set.iter().cloned().chain(options).collect()
    }

    /// Options that repeat this run to the byte, as a shell takes them.
    pub fn repeating(&self, samples: u64) -> String {
        const STOPS: [&str; 3] = ["run.samples", "run.relative_error", "run.seconds"];
        let mut words = vec!["--samples".to_owned(), samples.to_string()];
        for entry in &self.set {
            if !STOPS.contains(&entry.key.as_str()) {
                words.push("--set".to_owned());
                words.push(quoted(&format!("{}={}", entry.key, entry.value)));
            }
        }
        for entry in self.keys() {
            if !STOPS.contains(&entry.key) {
                words.push(format!("--{}", entry.option));
                words.push(quoted(entry.value));
            }
        }
        words.join(" ")
    }
}

/// A word as a POSIX shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.,=/:+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
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
        let values: Vec<String> = run.overrides().into_iter().map(|o| o.value).collect();
        assert_eq!(values, ["32", "64"]);
    }

    #[test]
    fn a_set_value_may_hold_an_equals_sign() {
        let run = run(&["--set", "sensor.desk.grid={ counts = [2, 2] }"]);
        assert_eq!(run.set[0].key, "sensor.desk.grid");
        assert_eq!(run.set[0].value, "{ counts = [2, 2] }");
        let words = ["malus", "run", "room.toml", "--set", "material.a"];
        assert!(Arguments::try_parse_from(words).is_err());
    }

    #[test]
    fn a_negative_number_is_a_value_to_be_judged_and_no_option() {
        assert_eq!(run(&["--samples", "-5"]).samples.as_deref(), Some("-5"));
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
            run.repeating(4096),
            "--samples 4096 --set 'material.\"Wall 1\".a=0' --model scalar"
        );
    }
}
