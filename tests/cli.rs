//! The program itself: files, columns, exit statuses, and every way to get an input wrong.

mod analyse;
mod bad_input;
mod bench_bvh;
mod printed;
mod results;
mod shards;
mod stopping;
#[cfg(unix)]
mod submitting;
mod tradeoff;

pub use bad_input::{assert_told, refusal};
pub use shards::assert_done;
#[cfg(unix)]
pub use shards::killed;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A room without a fault or a warning: a box, a lamp in it, one sensor point.
pub const ROOM: &str = r#"[[shape]]
kind = "box"
min = [0, 0, 0]
max = [4, 3, 2.5]
inward = true
material = "plaster"

[[source]]
kind = "point"
position = [2, 1.5, 2]
intensity = 10

[material.plaster]
rho = 0.5

[[sensor]]
name = "desk"
points = [[2, 1.5, 0.75]]
normal = [0, 0, 1]

[run]
samples = 64
"#;

/// [`ROOM`] with one passage changed.
#[track_caller]
pub fn room_with(old: &str, new: &str) -> String {
    assert_eq!(
        ROOM.matches(old).count(),
        1,
        "{old:?} is not there, or not once"
    );
    ROOM.replace(old, new)
}

/// A folder of its own, with a scene file and whatever belongs to it.
pub struct Folder(tempfile::TempDir);

impl Folder {
    /// A folder with `room.toml` and other files; a name that ends in `/` makes a folder.
    pub fn new(scene: &[u8], files: &[(&str, &[u8])]) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        std::fs::write(folder.path("room.toml"), scene).unwrap();
        for (name, content) in files {
            if name.ends_with('/') {
                std::fs::create_dir(folder.path(name)).unwrap();
            } else {
                std::fs::write(folder.path(name), content).unwrap();
            }
        }
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// The program, to be run in this folder.
    pub fn command(&self, words: &[&str]) -> Command {
        let mut command = malus(words);
        command.current_dir(self.0.path());
        command
    }

    /// Runs the program in this folder to its end.
    pub fn malus(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    /// What is said of a command line that is refused as a bad input, with nothing written to `merged`.
    #[track_caller]
    pub fn refused(&self, words: &[&str]) -> String {
        let output = self.malus(words);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(
            told.starts_with("error: ") && !told.contains("panicked"),
            "{told}"
        );
        assert!(!self.path("merged").exists(), "results beside an error");
        told
    }

    /// What `malus merge` says of directories whose shards cannot be joined.
    #[track_caller]
    pub fn unmerged(&self, directories: &[&str]) -> String {
        self.refused(&[&["merge"], directories, &["-o", "merged"]].concat())
    }

    /// `malus run room.toml` with results in `name` and further words, which has to succeed.
    #[track_caller]
    pub fn run(&self, name: &str, words: &[&str]) -> Output {
        let output = self.malus(&[&["run", "room.toml", "-o", name], words].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        output
    }
}

/// The program with arguments.
pub fn malus(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_malus"));
    command.args(words);
    command
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// A word for a path, as arguments take it.
pub fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}
