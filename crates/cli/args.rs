//! The command line as typed.

use crate::portion::Portion;
use crate::submit::Cluster;
use clap::{Args, Parser, Subcommand};
use malus_scene::Override;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

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

The scene is read again, from where it was when the shards were computed or from --scene, and has to be the same: the \
results have the bytes of a run in one piece. Shards stay where they are.

Exit status: 0 done, 1 nothing can be written, 2 a shard is missing, there twice, unfinished, damaged or of another run.";

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

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute a scene: writes tables, plans and a summary, prints a short table
    #[command(after_help = RUN_EXAMPLES)]
    Run(Box<Run>),
    /// Join the shards of a run: writes the tables, plans, pictures and summary of the whole
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

    /// What of the run is computed, and how it survives.
    #[command(flatten)]
    pub portion: Portion,

    /// Where it is computed.
    #[command(flatten)]
    pub cluster: Cluster,
}

/// `malus merge`.
#[derive(Args, Debug)]
pub struct Merge {
    /// Directories with shards, as `malus run --shard` writes them
    #[arg(value_name = "DIR", required = true)]
    pub shards: Vec<PathBuf>,

    /// Directory of the results [default: the first of the directories]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// The scene file, where it is no longer where the shards were computed
    #[arg(long, value_name = "SCENE.toml")]
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

    /// Options that say the same of the scene again, stopping rules left out.
    pub fn words(&self) -> Vec<String> {
        const STOPS: [&str; 3] = ["run.samples", "run.relative_error", "run.seconds"];
        let mut words = Vec::new();
        for entry in &self.set {
            if !STOPS.contains(&entry.key.as_str()) {
                words.push("--set".to_owned());
                words.push(format!("{}={}", entry.key, entry.value));
            }
        }
        for entry in self.keys() {
            if !STOPS.contains(&entry.key) {
                words.push(format!("--{}", entry.option));
                words.push(entry.value.to_owned());
            }
        }
        words
    }

    /// Options that repeat this run to the byte, as a shell takes them.
    pub fn repeating(&self, samples: u64) -> String {
        let words = self.words();
        let samples = ["--samples".to_owned(), samples.to_string()];
        let words: Vec<String> = samples.iter().chain(&words).map(|it| quoted(it)).collect();
        words.join(" ")
    }

    /// The run that [`words`](Self::words) tells of, with a number of samples.
    ///
    /// # Errors
    /// The words are none that it gives.
    pub fn told(scene: &Path, words: &[String], samples: u64) -> Result<Self, clap::Error> {
        let before = ["malus".into(), "run".into(), scene.as_os_str().to_owned()];
        let samples = ["--samples".to_owned(), samples.to_string()];
        let words = words.iter().chain(&samples).map(OsString::from);
        match Arguments::try_parse_from(before.into_iter().chain(words))?.command {
            Command::Run(run) => Ok(*run),
            _ => unreachable!("run was asked for"),
        }
    }
}

/// A word as a POSIX shell takes it.
pub fn quoted(word: &str) -> String {
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
    fn a_run_is_told_again_by_its_words() {
        let run = run(&[
            "--seconds",
            "60",
            "--seed",
            "7",
            "--set",
            "material.\"Wall 1\".a=0",
        ]);
        let again = Run::told(&run.scene, &run.words(), 128).expect("the same");
        assert_eq!((again.words(), &again.scene), (run.words(), &run.scene));
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
            run.repeating(4096),
            "--samples 4096 --set 'material.\"Wall 1\".a=0' --model scalar"
        );
    }
}
