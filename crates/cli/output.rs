//! The directory of results: every file in it is whole or not there.

use anyhow::{Context, Result};
use std::fs::{self, File};
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A directory that can be written to.
#[derive(Debug)]
pub struct Directory(PathBuf);

impl Directory {
    /// Makes the directory and tries to write into it, so that a long run does not end at a closed door.
    ///
    /// # Errors
    /// It cannot be made or not be written to.
    pub fn prepare(path: &Path) -> Result<Self> {
        fs::create_dir_all(path)
            .with_context(|| format!("{}: cannot make the directory of results", path.display()))?;
        let directory = Self(path.to_owned());
        let probe = directory.temporary("probe");
        File::create(&probe)
            .and_then(|_| removed(&probe))
            .with_context(|| format!("{}: cannot write results there", path.display()))?;
        Ok(directory)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file beside its place and moves it there when it is whole.
    ///
    /// # Errors
    /// It cannot be written; an earlier file of that name then stays as it was.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<()> {
        self.write_by(name, |file| Ok(file.write_all(content)?))
    }

    /// The same for a file that is written piece by piece: it need not be in memory as a whole.
    ///
    /// # Errors
    /// It cannot be written, or what writes it fails; an earlier file of that name then stays as it was.
    pub fn write_by(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<Growing>) -> Result<()>,
    ) -> Result<()> {
        let filled = || -> Result<()> {
            let mut file = BufWriter::new(self.begin(name)?);
            fill(&mut file)?;
            file.into_inner()
                .map_err(|error| error.into_error())?
                .finish()
        };
        filled().with_context(|| unwritten(&self.0.join(name)))
    }

    /// Begins a file beside its place, to which [`Growing::finish`] moves it.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn begin(&self, name: &str) -> Result<Growing> {
        let temporary = self.temporary(name);
        Ok(Growing {
            file: File::create(&temporary)?,
            temporary,
            path: self.0.join(name),
        })
    }

    /// A file that grows piece by piece in its place, and holds what there is at any moment.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn growing(&self, name: &str) -> Result<File> {
        let path = self.0.join(name);
        File::create(&path).with_context(|| unwritten(&path))
    }

    /// Removes a file, if it is there, and what a program left of it that was ended while it wrote.
    ///
    /// # Errors
    /// It is there to stay.
    pub fn remove(&self, name: &str) -> Result<()> {
        self.tidy(name);
        let path = self.0.join(name);
        removed(&path).with_context(|| format!("{}: cannot be removed", path.display()))
    }

    /// Removes what a program left of files that was ended while it wrote them, where their names begin with `name`.
    pub fn tidy(&self, name: &str) {
        let begun = format!(".{name}");
        for entry in fs::read_dir(&self.0).into_iter().flatten().flatten() {
            let found = entry.file_name();
            let found = found.to_string_lossy();
            if found.starts_with(&begun) && found.ends_with(".part") {
                // It is in nobody's way.
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    /// A name of our own, so that two runs into one directory do not mix their bytes.
    fn temporary(&self, name: &str) -> PathBuf {
        self.0.join(format!(".{name}.{}.part", std::process::id()))
    }
}

/// A file that is not in its place yet; left alone it is removed.
#[derive(Debug)]
pub struct Growing {
    file: File,
    temporary: PathBuf,
    path: PathBuf,
}

impl Growing {
    /// Moves the file to its place.
    ///
    /// # Errors
    /// It cannot be written; an earlier file of that name then stays as it was.
    pub fn finish(self) -> Result<()> {
        self.file.sync_all()?;
        Ok(fs::rename(&self.temporary, &self.path)?)
    }
}

impl Write for Growing {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Growing {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        self.file.seek(place)
    }
}

impl Drop for Growing {
    fn drop(&mut self) {
        // Where it is finished it is no longer there; and of errors the first one is to be reported.
        let _ = fs::remove_file(&self.temporary);
    }
}

/// What is said of a file that could not be written; why follows.
pub fn unwritten(path: &Path) -> String {
    format!("{}: cannot be written", path.display())
}

/// Removes a file; that it is not there is no error: another machine may have had the same name for its own.
fn removed(path: &Path) -> std::io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        result => result,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(path: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(path)
            .expect("a directory")
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .into_string()
                    .expect("text")
            })
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_written_file_is_whole_and_alone() {
        let temporary = tempfile::tempdir().expect("a directory");
        let directory = Directory::prepare(&temporary.path().join("a/b")).expect("writable");
        directory.write("grids.csv", b"old").expect("written");
        directory.write("grids.csv", b"new").expect("written again");
        assert_eq!(names(directory.path()), ["grids.csv"]);
        assert_eq!(
            fs::read(directory.path().join("grids.csv")).expect("there"),
            b"new"
        );
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let temporary = tempfile::tempdir().expect("a directory");
        let directory = Directory::prepare(temporary.path()).expect("writable");
        // A directory stands where the file should go, so the last step fails.
        fs::create_dir(temporary.path().join("sensors.csv")).expect("made");
        let error = directory.write("sensors.csv", b"1,2").expect_err("no file");
        assert!(format!("{error:#}").contains("sensors.csv: cannot be written"));
        assert_eq!(names(temporary.path()), ["sensors.csv"]);
    }

    #[test]
    fn a_file_in_the_way_is_found_before_anything_is_computed() {
        let temporary = tempfile::tempdir().expect("a directory");
        let path = temporary.path().join("results");
        fs::write(&path, b"a file").expect("written");
        let error = Directory::prepare(&path).expect_err("no directory");
        assert!(format!("{error:#}").contains("cannot make the directory of results"));
    }
}
