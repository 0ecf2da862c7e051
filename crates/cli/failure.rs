//! Why the program ends with an error, and with which exit status.

use anyhow::Error;

/// An error and the exit status that goes with it.
#[derive(Debug)]
pub struct Failure {
    /// What happened.
    pub error: Error,
    /// Exit status.
    pub status: u8,
}

impl Failure {
    /// A run that failed.
    pub fn run(error: Error) -> Self {
        Self { error, status: 1 }
    }

    /// Bad arguments or a bad scene.
    pub fn input(error: Error) -> Self {
        Self { error, status: 2 }
    }
}
