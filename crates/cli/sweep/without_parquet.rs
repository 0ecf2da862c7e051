//! What stands in for `variants.parquet` where the program is built without the feature `parquet`.

use super::variants::Row;
use crate::output::Directory;
use anyhow::{Result, bail};
use malus_scene::{Base, Study};

/// A file that there is none of.
pub enum Columnar {}

/// Makes sure that the program can write such files.
///
/// # Errors
/// It cannot.
pub fn check() -> Result<()> {
    bail!(
        "--parquet: this malus was built without Parquet; build it with it: cargo install --path malus --features parquet"
    )
}

impl Columnar {
    /// No file.
    ///
    /// # Errors
    /// Always.
    pub fn create(_: &Directory, _: &Study, _: &Base, _: &[String]) -> Result<Self> {
        check()?;
        unreachable!("the check fails")
    }

    /// Adds a row.
    ///
    /// # Errors
    /// None.
    pub fn add(&mut self, _: &Row) -> Result<()> {
        match *self {}
    }

    /// Ends the file.
    ///
    /// # Errors
    /// None.
    pub fn finish(self) -> Result<()> {
        match self {}
    }
}
