//! A run or a study, or a shard of one, as far as it has come, and the file that keeps it.
//!
//! The file is a line that names its form, then head, sums, films and shares of walks, each as postcard writes it, then a
//! SipHash-1-3 of all that stands before, 16 bytes. A study has a journal beside it, of what is finished.

use crate::computing::Computing;
use crate::journal::Extent;
use crate::output::Directory;
use crate::portion::rounded_up;
use anyhow::{Context, Error, Result, anyhow, bail, ensure};
use malus_estimator::{Allocation, Film, Shard, State};
use malus_scene::{Fingerprint, Scene, Settings};
use serde::{Deserialize, Serialize};
use siphasher::sip128::{Hasher128, SipHasher13};
use std::fs::{self, File};
use std::hash::Hasher;
use std::io::{Read, Write};
use std::path::Path;

/// First line of a file; the number rises whenever what follows it is laid out anew.
const FORM: &str = "malus state 12\n";

/// What is said of a file that is not as it was written.
const DAMAGED: &str =
    "is damaged: its checksum is not that of its content; remove it, and compute it again";

/// Beginning of the first line of files of any form.
const ANY_FORM: &str = "malus state ";

/// Bytes of the checksum at the end.
const CHECKSUM: usize = 16;

/// Bytes within which a head ends, but for one of some thousand options.
const HEAD: u64 = 1 << 20;

/// Name of the file in which a run that is not sharded is set aside.
pub const CHECKPOINT: &str = "checkpoint.malus";

/// What a file says of itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// Version of the program.
    pub version: String,
    /// Scene and settings.
    pub fingerprint: Fingerprint,
    /// Which part of the run it is.
    pub shard: Shard,
    /// Samples that the run is to take, in whole rounds; `None` where another rule stops it.
    pub goal: Option<u64>,
    /// Samples that it has taken.
    pub samples: u64,
    /// Pictures that are taken, the present one by its share.
    pub shot: f64,
    /// Whether nothing is left to do, pictures included.
    pub complete: bool,
    /// Time that it has taken, in seconds.
    pub seconds: f64,
    /// Threads that it ran on the last time.
    pub threads: usize,
    /// The scene file, from the root.
    pub scene: String,
    /// Options of `malus run` that say the same of the scene again, stopping rules left out.
    pub words: Vec<String>,
    /// Whether cameras take pictures.
    pub pictures: bool,
    /// Of a study: what varies, and how far it has come. `scene` is then the study's file.
    pub study: Option<Studied>,
}

/// What the file of a study says of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Studied {
    /// Digest of what varies.
    pub digest: u128,
    /// What stops the base, in words.
    pub rule: String,
    /// Whether the points of each variant are written.
    pub sensors: bool,
    /// Whether the table of variants is written as Parquet too.
    pub parquet: bool,
    /// Samples that the base has taken, and every variant takes; `None` while the base is computed.
    pub samples: Option<u64>,
    /// How much of the journal holds batches that are finished.
    pub finished: Extent,
    /// Share of the variants that is computed, 0 … 1.
    pub share: f64,
}

/// A run or a study, or a shard of one, as far as it has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What it is.
    pub head: Head,
    /// Sums; of a study, those of the batch that is computed.
    pub state: State,
    /// What the cameras have taken, in the scene's order.
    pub films: Vec<Film>,
    /// How walks are shared out between the sensors; of a study, once its base is computed.
    pub allocation: Option<Allocation>,
}

impl Head {
    /// What a file says at its beginning of the run or the study that computes a scene, read from `path`.
    pub fn new(
        path: &Path,
        scene: &Scene,
        settings: &Settings,
        computing: &Computing,
        no_pictures: bool,
    ) -> Self {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            fingerprint: scene.fingerprint(settings),
            shard: Shard::WHOLE,
            goal: settings.samples.map(rounded_up),
            samples: 0,
            shot: 0.0,
            complete: false,
            seconds: 0.0,
            threads: 1,
            scene: path.to_string_lossy().into_owned(),
            words: computing.words(),
            pictures: !no_pictures,
            study: None,
        }
    }

    /// Checks that a file goes on with this run.
    ///
    /// # Errors
    /// It is of another version of the program, another scene, other settings, another shard or other pictures; the
    /// error tells which.
    pub fn check(&self, found: &Self) -> Result<()> {
        self.check_run(found)?;
        ensure!(
            found.shard == self.shard,
            "is shard {} and not {}",
            found.shard,
            self.shard
        );
        Ok(())
    }

    /// The same, whichever shard it is.
    ///
    /// # Errors
    /// As of [`check`](Self::check).
    pub fn check_run(&self, found: &Self) -> Result<()> {
        ensure!(
            found.version == self.version,
            "was written by malus {}, this is {}",
            found.version,
            self.version
        );
        let differences = self.fingerprint.differences(&found.fingerprint);
        ensure!(
            differences.is_empty(),
            "is of another scene or other settings: they differ in {}",
            differences.join(", ")
        );
        match (&self.study, &found.study) {
            (None, None) => {}
            (Some(study), Some(found)) => study.check(found)?,
            (None, Some(_)) => bail!("is of a study, this is a run"),
            (Some(_), None) => bail!("is of a run, this is a study"),
        }
        Ok(())
    }

    /// Whether nothing is left to do of a shard for a run that `run` tells of.
    pub fn finishes(&self, run: &Self) -> bool {
        self.complete && self.goal == run.goal && self.pictures == run.pictures
    }

    /// How much of the journal beside it counts.
    pub fn finished(&self) -> Extent {
        self.study
            .as_ref()
            .map_or(Extent::default(), |study| study.finished)
    }

    /// Share of it that is computed, where there are so many cameras.
    pub fn share(&self, cameras: usize) -> f64 {
        match &self.study {
            Some(study) => study.share,
            None => {
                let goal = self.goal.unwrap_or(self.samples).max(1);
                (self.samples as f64 / goal as f64 + self.shot) / (1 + cameras) as f64
            }
        }
    }
}

impl Studied {
    /// Checks that a file goes on with this study.
    ///
    /// # Errors
    /// Something else varies, or variants are computed or written otherwise; the error tells which.
    fn check(&self, found: &Self) -> Result<()> {
        ensure!(
            found.digest == self.digest,
            "is of another study: other keys vary, or they have other values"
        );
        ensure!(
            found.rule == self.rule,
            "was computed with {}, and {} is asked for: a study is not taken further",
            found.rule,
            self.rule
        );
        let with = |sensors: bool| if sensors { "with" } else { "without" };
        ensure!(
            found.sensors == self.sensors,
            "was computed {} --sensors, this is one {}",
            with(found.sensors),
            with(self.sensors)
        );
        Ok(())
    }
}

impl Part {
    /// Name of the file of a shard.
    pub fn name_of(shard: Shard) -> String {
        format!("shard-{:02}-of-{:02}.malus", shard.index(), shard.count())
    }

    /// Whether a file is called as that of a shard.
    pub fn is_shard(path: &Path) -> bool {
        let name = path.file_name().and_then(|name| name.to_str());
        name.is_some_and(|name| name.starts_with("shard-") && name.ends_with(".malus"))
    }

    /// Reads a file.
    ///
    /// # Errors
    /// There is none, it is of another kind or form, or it is damaged. The error names the file.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes =
            fs::read(path).with_context(|| format!("{}: cannot be read", path.display()))?;
        parsed(&bytes).map_err(|error| anyhow!("{}: {error}", path.display()))
    }

    /// What a file says of itself, without a look at whether it is whole; `None` where there is no such file.
    pub fn peek(path: &Path) -> Option<Head> {
        let mut bytes = Vec::new();
        let mut file = File::open(path).ok()?.take(HEAD);
        file.read_to_end(&mut bytes).ok()?;
        let body = bytes.strip_prefix(FORM.as_bytes())?;
        Some(postcard::take_from_bytes(body).ok()?.0)
    }
}

/// Writes a part in one go: the file of that name is the old one or the new one, whatever happens.
///
/// # Errors
/// It cannot be written; an earlier file of that name is still there.
pub fn write<'f>(
    directory: &Directory,
    name: &str,
    head: &Head,
    state: &State,
    films: impl Iterator<Item = &'f Film>,
    allocation: Option<&Allocation>,
) -> Result<()> {
    let films: Vec<&Film> = films.collect();
    directory.write_by(name, |file| {
        let mut summed = Summed {
            file: &mut *file,
            sum: SipHasher13::new(),
            failure: None,
        };
        summed.write_all(FORM.as_bytes())?;
        summed.put(head)?;
        summed.put(state)?;
        summed.put(&films)?;
        summed.put(&allocation)?;
        let checksum = summed.sum.finish128().as_bytes();
        Ok(file.write_all(&checksum)?)
    })
}

/// A file, and the checksum of what is written to it.
struct Summed<'w, W> {
    file: &'w mut W,
    sum: SipHasher13,
    /// Why the file could not be written, which postcard does not tell.
    failure: Option<std::io::Error>,
}

impl<W: Write> Summed<'_, W> {
    fn put(&mut self, value: &impl Serialize) -> Result<()> {
        match postcard::to_io(value, &mut *self) {
            Ok(_) => Ok(()),
            Err(error) => Err(self.failure.take().map_or(error.into(), Error::from)),
        }
    }

    /// Keeps why the file could not be written.
    fn failed(&mut self, error: std::io::Error) -> std::io::Error {
        let kind = error.kind();
        self.failure = Some(error);
        kind.into()
    }
}

impl<W: Write> Write for Summed<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.file.write(bytes);
        let written = written.map_err(|error| self.failed(error))?;
        self.sum.write(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush().map_err(|error| self.failed(error))
    }
}

/// The part that the bytes of a file hold.
fn parsed(bytes: &[u8]) -> Result<Part> {
    if !bytes.starts_with(FORM.as_bytes()) {
        let form = bytes.strip_prefix(ANY_FORM.as_bytes());
        let Some(form) = form else {
            bail!("is no state of a run, as malus run and malus sweep write it");
        };
        // Without the end of the line the number may have been cut off.
        let end = form.iter().position(|&byte| byte == b'\n');
        let form = end.and_then(|end| str::from_utf8(&form[..end]).ok()?.parse::<u32>().ok());
        let ours = FORM.trim_start_matches(ANY_FORM).trim_end();
        match form {
            Some(form) if form.to_string() != ours => {
                bail!("is of form {form}, this version of malus reads form {ours}")
            }
            _ => bail!(DAMAGED),
        }
    }
    let split = bytes.len().checked_sub(CHECKSUM).context(DAMAGED)?;
    let (content, checksum) = bytes.split_at(split);
    let mut sum = SipHasher13::new();
    sum.write(content);
    ensure!(sum.finish128().as_bytes() == *checksum, DAMAGED);
    let body = content.get(FORM.len()..).context(DAMAGED)?;
    let (head, body) = postcard::take_from_bytes(body).context(DAMAGED)?;
    let (state, body) = postcard::take_from_bytes(body).context(DAMAGED)?;
    let (films, body) = postcard::take_from_bytes(body).context(DAMAGED)?;
    let allocation = postcard::from_bytes(body).context(DAMAGED)?;
    Ok(Part {
        head,
        state,
        films,
        allocation,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufWriter;

    /// A disk with so many bytes left.
    struct Disk(usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            if self.0 == 0 {
                return Err(std::io::ErrorKind::StorageFull.into());
            }
            let written = bytes.len().min(self.0);
            self.0 -= written;
            Ok(written)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_told_as_such() {
        // With the smaller buffer it is found as the state is written, with the larger one as the buffer is emptied after it.
        for buffer in [0, 1 << 20] {
            let mut disk = BufWriter::with_capacity(buffer, Disk(100));
            let mut summed = Summed {
                file: &mut disk,
                sum: SipHasher13::new(),
                failure: None,
            };
            let state = State::new(Shard::WHOLE);
            let error = summed.put(&state).expect_err("no room for its replicas");
            let error = error
                .downcast_ref::<std::io::Error>()
                .map(std::io::Error::kind);
            assert_eq!(error, Some(std::io::ErrorKind::StorageFull));
        }
    }

    #[test]
    fn names_of_shards_line_up() {
        let name = Part::name_of("3/8".parse().expect("a shard"));
        assert_eq!(name, "shard-03-of-08.malus");
        assert!(Part::is_shard(Path::new("a/shard-03-of-08.malus")));
        assert!(!Part::is_shard(Path::new("a/.shard-03-of-08.malus.7.part")));
        assert!(!Part::is_shard(Path::new("a/shard-3.log")));
    }
}
