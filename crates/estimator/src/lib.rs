//! Monte-Carlo estimates of polarised irradiance at the sensors of a scene.
//!
//! Walks are traced without light ([`run`] decides them from geometry and from bounds that hold for any
//! state of light) and evaluated afterwards for 1, 3 or 4 Stokes components and for several models at
//! once. The crate reads no files, prints nothing and knows no clock.

mod choose;
mod direct;
mod direction;
mod emitters;
mod engine;
mod evaluate;
mod exact;
mod gather;
mod journey;
mod ledger;
mod local;
mod pass;
mod random;
mod reading;
mod receiver;
mod results;
mod run;
mod statistics;
mod trace;

pub use results::{Absorbed, Answer, Energy, Group, Paired, Progress, Reading, Results, Stop};
pub use run::run;
pub use statistics::{Estimate, Means, MergeError, REPLICAS, Replica, Tally};
