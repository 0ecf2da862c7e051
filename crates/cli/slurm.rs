//! Slurm: arrays of shards, handed in and watched.

use crate::computing::quoted;
use crate::output::Directory;
use anyhow::{Context, Result, anyhow, bail, ensure};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::process::{Command, Output};

/// The job script, in the directory of the results: to be read, and to be handed in by hand where that is wanted.
const SCRIPT: &str = "shards.sbatch";

/// Numbers of the jobs handed in so far, one a line, in the directory of the results.
const JOBS: &str = "slurm-jobs.txt";

/// An array of shards, one task each.
pub struct Array<'a> {
    /// Directory of the results; the script, logs and numbers of jobs go there.
    pub directory: &'a Directory,
    /// What the job is called.
    pub title: &'a str,
    /// The program and all arguments but `--shard`, `--resume` and `--threads`; it has to do nothing but what is left to
    /// be done of a shard.
    pub words: &'a [String],
    /// Number of shards.
    pub count: u32,
    /// The site's own options of sbatch, one line.
    pub options: &'a str,
}

impl Array<'_> {
    /// Hands in the tasks of some shards; gives the number of the job.
    ///
    /// # Errors
    /// The script cannot be written, or Slurm does not take it.
    pub fn submit(&self, shards: &[u32]) -> Result<u64> {
        let script = self.script()?;
        self.directory.write(SCRIPT, script.as_bytes())?;
        let tasks: Vec<String> = shards.iter().map(u32::to_string).collect();
        let mut command = Command::new("sbatch");
        command
            .args(["--parsable", "--array", &tasks.join(",")])
            .arg(self.directory.path().join(SCRIPT));
        let told = output(&mut command)?;
        // With several clusters the number is followed by the cluster's name.
        let number = told.trim().split(';').next().unwrap_or_default();
        let job = number
            .parse()
            .map_err(|_| anyhow!("sbatch: found {told:?}, expected the number of a job"))?;
        let mut jobs = self.jobs();
        jobs.insert(job);
        let lines: String = jobs.iter().map(|job| format!("{job}\n")).collect();
        self.directory.write(JOBS, lines.as_bytes())?;
        Ok(job)
    }

    /// The shards whose tasks wait or run, of all jobs handed in for this directory.
    ///
    /// # Errors
    /// Slurm does not answer.
    pub fn active(&self) -> Result<BTreeSet<u32>> {
        let jobs = self.jobs();
        if jobs.is_empty() {
            return Ok(BTreeSet::new());
        }
        let mut command = Command::new("squeue");
        // The whole array's number, and the task's within it.
        command.args(["--me", "--noheader", "--array", "--format", "%F %K"]);
        Ok(active(&output(&mut command)?, &jobs))
    }

    /// Numbers of the jobs handed in for this directory, as words.
    pub fn job_words(&self) -> String {
        let jobs: Vec<String> = self.jobs().iter().map(u64::to_string).collect();
        jobs.join(" ")
    }

    /// Where a shard's task writes what it says.
    pub fn log(&self, shard: u32) -> std::path::PathBuf {
        self.directory.path().join(format!("shard-{shard}.log"))
    }

    fn jobs(&self) -> BTreeSet<u64> {
        let text = fs::read_to_string(self.directory.path().join(JOBS)).unwrap_or_default();
        text.lines().filter_map(|line| line.parse().ok()).collect()
    }

    /// The job script: the site's options come last, so that they win.
    fn script(&self) -> Result<String> {
        ensure!(
            !self.options.contains(['\n', '\r']),
            "--sbatch: must be one line of options, found {:?}",
            self.options
        );
        let path = self.directory.path();
        let path = path
            .to_str()
            .with_context(|| format!("{}: sbatch takes names in UTF-8 only", path.display()))?;
        let output = format!("{}/shard-%a.log", path.replace('%', "%%"));
        let words: Vec<String> = self.words.iter().map(|word| quoted(word)).collect();
        let mut script = "#!/bin/sh\n".to_owned();
        let mut option = |text: &str| {
            let _ = writeln!(script, "#SBATCH {text}");
        };
        option(&format!("--job-name={}", in_quotes(self.title)));
        option(&format!("--output={}", in_quotes(&output)));
        option("--open-mode=append");
        option("--requeue");
        // Before a task is killed at its limit of time, it is asked to set its shard aside.
        option("--signal=B:TERM@30");
        if !self.options.trim().is_empty() {
            option(self.options.trim());
        }
        let _ = write!(
            script,
            "# One task a shard: it goes on where it was set aside, and does nothing where it is finished.\n\
             exec {} --shard \"$SLURM_ARRAY_TASK_ID/{}\" --resume --threads \"${{SLURM_CPUS_ON_NODE:-1}}\"\n",
            words.join(" "),
            self.count
        );
        Ok(script)
    }
}

/// A value as sbatch reads it in a script.
fn in_quotes(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', r"\\").replace('"', "\\\""))
}

/// Tasks of some jobs in what squeue prints.
fn active(printed: &str, jobs: &BTreeSet<u64>) -> BTreeSet<u32> {
    let tasks = printed.lines().filter_map(|line| {
        let (job, task) = line.trim().split_once(' ')?;
        let job = job.parse().ok()?;
        jobs.contains(&job).then(|| task.trim().parse().ok())?
    });
    tasks.collect()
}

/// What a command of Slurm prints.
fn output(command: &mut Command) -> Result<String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => anyhow!(
            "{name}: there is no such command here; --submit slurm has to be run where Slurm's commands are"
        ),
        _ => anyhow!("{name}: {error}"),
    })?;
    if !status.success() {
        let told = String::from_utf8_lossy(&stderr);
        bail!("{name} failed ({status}): {}", told.trim());
    }
    Ok(String::from_utf8_lossy(&stdout).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_quotes_what_needs_it_and_lets_the_site_have_the_last_word() {
        let temporary = tempfile::tempdir().expect("a directory");
        let directory = Directory::prepare(&temporary.path().join("100 %")).expect("writable");
        let words = ["/opt/malus", "run", "/home/me/my room.toml"].map(str::to_owned);
        let array = Array {
            directory: &directory,
            title: "malus \"room\"",
            words: &words,
            count: 8,
            options: " --time=2:00:00 --requeue ",
        };
        let script = array.script().expect("a script");
        let lines: Vec<&str> = script.lines().collect();
        assert_eq!(lines[0], "#!/bin/sh");
        assert_eq!(lines[1], r#"#SBATCH --job-name="malus \"room\"""#);
        assert!(lines[2].ends_with("100 %%/shard-%a.log\""), "{script}");
        assert_eq!(lines[6], "#SBATCH --time=2:00:00 --requeue");
        assert_eq!(
            lines[8],
            "exec /opt/malus run '/home/me/my room.toml' --shard \"$SLURM_ARRAY_TASK_ID/8\" --resume --threads \
             \"${SLURM_CPUS_ON_NODE:-1}\""
        );
        let options = "--time=1\nrm";
        assert!(Array { options, ..array }.script().is_err());
    }

    #[test]
    fn only_tasks_of_our_own_jobs_are_ours() {
        let printed = "12 3\n12 5\n13 1\n14 N/A\n 15 2\n";
        assert_eq!(
            active(printed, &BTreeSet::from([12, 14, 15])),
            BTreeSet::from([2, 3, 5])
        );
    }
}
