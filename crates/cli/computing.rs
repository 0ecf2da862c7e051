//! How a scene is to be computed, as typed.

use crate::failure::Failure;
use anyhow::anyhow;
use clap::Args;
use malus_scene::{Error, Override};

/// How a scene is to be computed.
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

/// `KEY=VALUE` as an override; the value may hold further equals signs.
pub fn assignment(text: &str) -> Result<Override, String> {
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

    /// What is wrong with a scene, an option named the way it was typed.
    pub fn refused(&self, error: &Error) -> Failure {
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
        threads(self.threads.as_deref())
    }
}

/// More threads than any machine has cores: beyond, starting them is all that a run would do.
const MOST_THREADS: usize = 1024;

/// Number of threads asked for, or as many as there are cores.
///
/// # Errors
/// No such number.
pub fn threads(asked: Option<&str>) -> Result<usize, Failure> {
    let Some(text) = asked else {
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

/// A word as a POSIX shell takes it.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.,=/:+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
