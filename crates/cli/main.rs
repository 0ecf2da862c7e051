//! `malus`: polarised light in rooms.

mod analyse;
mod args;
mod bench_bvh;
mod chart;
mod check;
mod colour;
mod comparison;
mod computing;
mod conclusion;
mod contour;
mod digest;
mod failure;
mod field;
mod findings;
mod frame;
mod handing;
mod interrupt;
mod job;
mod journal;
mod keeper;
mod label;
mod merge;
mod number;
mod outcome;
mod output;
mod overview;
mod panel;
mod part;
mod picture;
mod plan;
mod portion;
mod progress;
mod report;
mod rows;
mod run;
mod scale;
mod sensitivity;
mod shards;
mod slurm;
mod stop;
mod submit;
mod summary;
mod svg;
mod sweep;
mod table;
mod tick;
mod trade;
mod tradeoff;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let end = match Arguments::parse().command {
        Command::Run(command) => run::run(&command),
        Command::Sweep(command) => sweep::sweep(&command),
        Command::Merge(command) => merge::merge(&command).map(|()| run::End::Complete),
        Command::Analyse(command) => analyse::analyse(&command).map(|()| run::End::Complete),
        Command::Tradeoff(command) => tradeoff::tradeoff(&command),
        Command::Check(command) => check::check(&command).map(|()| run::End::Complete),
        Command::BenchBvh(command) => bench_bvh::bench_bvh(&command).map(|()| run::End::Complete),
    };
    match end {
        Ok(run::End::Complete) => ExitCode::SUCCESS,
        Ok(run::End::Interrupted) => ExitCode::from(interrupt::STATUS),
        Err(failure) => {
            eprintln!("error: {:#}", failure.error);
            ExitCode::from(failure.status)
        }
    }
}
