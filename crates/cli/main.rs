//! `malus`: polarised light in rooms.

mod analyse;
mod args;
mod bench_bvh;
mod check;
mod colour;
mod contour;
mod digest;
mod failure;
mod field;
mod frame;
mod interrupt;
mod label;
mod number;
mod output;
mod overview;
mod panel;
mod picture;
mod plan;
mod progress;
mod rows;
mod run;
mod scale;
mod stop;
mod student;
mod summary;
mod svg;
mod table;
mod tick;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let end = match Arguments::parse().command {
        Command::Run(command) => run::run(&command),
        Command::Analyse(command) => analyse::analyse(&command).map(|()| run::End::Complete),
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
