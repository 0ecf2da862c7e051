//! A file that grows by records, of which as many are good as another file says: what ends the program spoils none.
//!
//! A record is its length (8 bytes, little-endian), its bytes, and a SipHash-1-3 of them and of the checksum before
//! (16 bytes), so that the last checksum stands for all of them.

use crate::output::{Directory, unwritten};
use anyhow::{Context, Result, anyhow};
use serde::{Deserialize, Serialize};
use siphasher::sip128::{Hasher128, SipHasher13};
use std::fs::{self, File, OpenOptions};
use std::hash::Hasher;
use std::io::{BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Bytes before a record, and after it.
const LENGTH: u64 = 8;
const CHECKSUM: u64 = 16;

/// How much of a journal counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Extent {
    /// Number of records.
    pub records: u64,
    /// Their bytes.
    pub bytes: u64,
    /// The last checksum.
    pub sum: u128,
}

impl Extent {
    /// The extent with one record more.
    fn with(self, record: &[u8]) -> Self {
        let mut sum = SipHasher13::new();
        sum.write(&self.sum.to_le_bytes());
        sum.write(record);
        Self {
            records: self.records + 1,
            bytes: self.bytes + LENGTH + record.len() as u64 + CHECKSUM,
            sum: sum.finish128().as_u128(),
        }
    }
}

/// A journal that grows.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    extent: Extent,
    /// Whether all of it is on the disk, and not on its way there.
    synced: bool,
}

impl Journal {
    /// Name of the journal that belongs to a file of that name.
    pub fn name_of(part: &str) -> String {
        let stem = part.strip_suffix(".malus").unwrap_or(part);
        format!("{stem}.journal")
    }

    /// Where the journal of a file lies.
    pub fn beside(part: &Path) -> PathBuf {
        part.with_extension("journal")
    }

    /// An empty one, in place of an earlier one of that name.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn create(directory: &Directory, name: &str) -> Result<Self> {
        Self::open(directory, name, Extent::default(), true)
    }

    /// One that is there where some of it counts, and else a new one.
    ///
    /// # Errors
    /// It cannot be made, is not there, or is damaged.
    pub fn resume_or_create(directory: &Directory, name: &str, extent: Extent) -> Result<Self> {
        match extent.records {
            0 => Self::create(directory, name),
            _ => Self::resume(directory, name, extent),
        }
    }

    /// One that is there, without what follows the records that count.
    ///
    /// # Errors
    /// It is not there, or damaged.
    fn resume(directory: &Directory, name: &str, extent: Extent) -> Result<Self> {
        check(&directory.path().join(name), extent)?;
        Self::open(directory, name, extent, false)
    }

    fn open(directory: &Directory, name: &str, extent: Extent, create: bool) -> Result<Self> {
        let path = directory.path().join(name);
        let opened = || {
            let mut options = OpenOptions::new();
            let options = options.read(true).write(true).create(create);
            let mut file = options.truncate(false).open(&path)?;
            file.set_len(extent.bytes)?;
            file.seek(SeekFrom::End(0))?;
            Ok::<_, std::io::Error>(file)
        };
        Ok(Self {
            file: opened().with_context(|| unwritten(&path))?,
            path,
            extent,
            synced: false,
        })
    }

    /// Adds a record; gives the place of its first byte.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn append(&mut self, record: &[u8]) -> Result<u64> {
        let place = self.extent.bytes + LENGTH;
        let extent = self.extent.with(record);
        let length = (record.len() as u64).to_le_bytes();
        let sum = extent.sum.to_le_bytes();
        let parts: [&[u8]; 3] = [&length, record, &sum];
        parts
            .into_iter()
            .try_for_each(|part| self.file.write_all(part))
            .with_context(|| unwritten(&self.path))?;
        self.extent = extent;
        self.synced = false;
        Ok(place)
    }

    /// Makes sure that all of it is on the disk; gives how much that is.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn sync(&mut self) -> Result<Extent> {
        if !self.synced {
            self.file
                .sync_data()
                .with_context(|| unwritten(&self.path))?;
            self.synced = true;
        }
        Ok(self.extent)
    }

    /// Bytes of a record, by their place.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn read(&self, place: u64, length: u64) -> Result<Vec<u8>> {
        let mut bytes = vec![0; usize::try_from(length)?];
        let mut file = &self.file;
        let mut read = || {
            file.seek(SeekFrom::Start(place))?;
            file.read_exact(&mut bytes)?;
            file.seek(SeekFrom::End(0))
        };
        read().with_context(|| format!("{}: cannot be read", self.path.display()))?;
        Ok(bytes)
    }

    /// Removes the file.
    ///
    /// # Errors
    /// It is there to stay.
    pub fn remove(self) -> Result<()> {
        drop(self.file);
        fs::remove_file(&self.path)
            .with_context(|| format!("{}: cannot be removed", self.path.display()))
    }
}

/// Reads a journal from its beginning.
#[derive(Debug)]
pub struct Records {
    file: BufReader<File>,
    path: PathBuf,
    read: Extent,
    extent: Extent,
}

impl Records {
    /// Those of a file that count.
    ///
    /// # Errors
    /// The file cannot be read, or is shorter than it was.
    pub fn open(path: &Path, extent: Extent) -> Result<Self> {
        let told = || {
            format!(
                "{}: cannot be read, and the file of that name that ends in .malus is of no use without it",
                path.display()
            )
        };
        let file = File::open(path).with_context(told)?;
        let length = file.metadata()?.len();
        if length < extent.bytes {
            return Err(damaged(path));
        }
        Ok(Self {
            file: BufReader::new(file),
            path: path.to_owned(),
            read: Extent::default(),
            extent,
        })
    }

    /// The next record with the place of its first byte, if there is one left.
    ///
    /// # Errors
    /// It is damaged.
    pub fn next(&mut self) -> Result<Option<(u64, Vec<u8>)>> {
        if self.read.records == self.extent.records {
            return match self.read == self.extent {
                true => Ok(None),
                false => Err(damaged(&self.path)),
            };
        }
        let place = self.read.bytes + LENGTH;
        let record = self.take().map_err(|_| damaged(&self.path))?;
        let read = self.read.with(&record);
        let mut sum = [0; CHECKSUM as usize];
        let whole = self.file.read_exact(&mut sum).is_ok();
        if !whole || read.sum.to_le_bytes() != sum {
            return Err(damaged(&self.path));
        }
        self.read = read;
        Ok(Some((place, record)))
    }

    fn take(&mut self) -> Result<Vec<u8>> {
        let mut length = [0; LENGTH as usize];
        self.file.read_exact(&mut length)?;
        let length = u64::from_le_bytes(length);
        let left = self.extent.bytes - self.read.bytes;
        // A length that is damaged asks for no memory.
        if length > left.saturating_sub(LENGTH + CHECKSUM) {
            return Err(damaged(&self.path));
        }
        let mut record = vec![0; usize::try_from(length)?];
        self.file.read_exact(&mut record)?;
        Ok(record)
    }
}

/// Makes sure that all records of a journal that count are as they were written.
///
/// # Errors
/// They are not; the error names the file.
pub fn check(path: &Path, extent: Extent) -> Result<()> {
    let mut records = Records::open(path, extent)?;
    while records.next()?.is_some() {}
    Ok(())
}

fn damaged(path: &Path) -> anyhow::Error {
    anyhow!(
        "{}: is damaged: its checksums are not those of its content; remove it and the file of that name that ends in \
         .malus, and compute them again",
        path.display()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn journal(records: &[&[u8]]) -> (tempfile::TempDir, Directory, Extent) {
        let temporary = tempfile::tempdir().expect("a directory");
        let directory = Directory::prepare(temporary.path()).expect("writable");
        let mut journal = Journal::create(&directory, "a.journal").expect("made");
        for record in records {
            journal.append(record).expect("written");
        }
        let extent = journal.sync().expect("written");
        (temporary, directory, extent)
    }

    #[test]
    fn what_follows_the_records_that_count_is_cut_off() {
        let (_kept, directory, extent) = journal(&[b"one", b"", b"three"]);
        let path = directory.path().join("a.journal");
        let whole = fs::read(&path).expect("there");
        fs::write(&path, [&whole[..], b"half a rec"].concat()).expect("written");
        let mut journal = Journal::resume(&directory, "a.journal", extent).expect("good");
        assert_eq!(fs::read(&path).expect("there"), whole);
        let place = journal.append(b"four").expect("written");
        assert_eq!(journal.read(place, 4).expect("there"), b"four");
        let extent = journal.sync().expect("written");
        let mut records = Records::open(&path, extent).expect("there");
        let mut found = Vec::new();
        while let Some((_, record)) = records.next().expect("good") {
            found.push(record);
        }
        assert_eq!(found, [&b"one"[..], b"", b"three", b"four"]);
    }

    #[test]
    fn a_byte_changed_or_missing_anywhere_is_found() {
        let (_kept, directory, extent) = journal(&[b"one", b"two"]);
        let path = directory.path().join("a.journal");
        let whole = fs::read(&path).expect("there");
        let spoiled = (0..whole.len()).map(|place| {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            bytes
        });
        let cut = (0..whole.len()).map(|length| whole[..length].to_vec());
        for bytes in spoiled.chain(cut) {
            fs::write(&path, bytes).expect("written");
            let error = check(&path, extent).expect_err("damaged").to_string();
            assert!(error.contains("a.journal: is damaged"), "{error}");
        }
        assert!(check(&directory.path().join("b.journal"), extent).is_err());
    }

    #[test]
    fn records_of_another_journal_are_none_of_this_one() {
        let (_kept, _, extent) = journal(&[b"one", b"two"]);
        let (_other, directory, _) = journal(&[b"two", b"one"]);
        assert!(check(&directory.path().join("a.journal"), extent).is_err());
    }
}
