//! The command line as typed.

use crate::failure::Failure;
use anyhow::anyhow;
use clap::{Args, Parser, Subcommand};
use malus_scene::Override;
use std::path::PathBuf;

/// More threads than any machine has cores: beyond, starting them is all that a run would do.
const MOST_THREADS: usize = 1024;

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

const SWEEP_EXAMPLES: &str = "\
Examples:
  malus sweep study-floor.toml                    every variant of the study; results go to results/study-floor
  malus sweep study.toml --samples 4096 --sensors

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
sensitivities), a picture <sensor>-trade.svg of each sensor.

Exit status: 0 done, 1 a variant failed (the others are finished), 2 bad arguments, a bad scene or a bad study, 130 \
interrupted.";

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

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute a scene: writes tables, plans and a summary, prints a short table
    #[command(after_help = RUN_EXAMPLES)]
    Run(Box<Run>),
    /// Evaluate design variants of one scene, with the differences between them: which differ, and which key matters
    #[command(after_help = SWEEP_EXAMPLES)]
    Sweep(Box<Sweep>),
    /// Read a scene and say what was understood and what is wrong with it; compute nothing
    #[command(after_help = CHECK_EXAMPLES)]
    Check(Check),
    /// Look at a camera's picture through a linear polarising filter, and at how its light is polarised
    #[command(after_help = ANALYSE_EXAMPLES)]
    Analyse(Analyse),
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

    /// How to compute it
    #[command(flatten)]
    pub computing: Computing,

    /// Draw no plans
    #[arg(long)]
    pub no_pictures: bool,

    /// Show no progress and no table; warnings and errors stay
    #[arg(short, long)]
    pub quiet: bool,
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

    /// How to compute it
    #[command(flatten)]
    pub computing: Computing,

    /// Write each variant's sensor points to variants/NNN/sensors.csv
    #[arg(long)]
    pub sensors: bool,

    /// Draw nothing
    #[arg(long)]
    pub no_pictures: bool,

    /// Show no progress and no tables; warnings and errors stay
    #[arg(short, long)]
    pub quiet: bool,
}

/// How a scene is computed.
#[derive(Args, Debug)]
pub struct Computing {
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

impl Computing {
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

    /// What is wrong with a scene, an option named the way it was typed.
    pub fn refused(&self, error: &malus_scene::Error) -> Failure {
        let mut text = error.to_string();
        for entry in self.keys() {
            let as_set = format!("--set {}={}", entry.key, entry.value);
            text = text.replace(&as_set, &format!("--{} {}", entry.option, entry.value));
        }
        Failure::input(anyhow!(text))
    }

    /// Number of threads asked for, or as many as there are cores.
    ///
    /// # Errors
    /// No such number.
    pub fn threads(&self) -> Result<usize, Failure> {
        let Some(text) = &self.threads else {
            return Ok(std::thread::available_parallelism().map_or(1, usize::from));
        };
        text.parse()
            .ok()
            .filter(|count| (1..=MOST_THREADS).contains(count))
            .ok_or_else(|| {
                Failure::input(anyhow!(
                    "--threads {text}: must be a whole number from 1 to {MOST_THREADS}, found {text:?}"
                ))
            })
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
