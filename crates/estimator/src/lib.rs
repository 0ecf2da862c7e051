//! Monte-Carlo estimates of polarised irradiance at the sensors of a scene.
//!
//! Walks are traced without light ([`run`] decides them from geometry and from bounds that hold for any
//! state of light) and evaluated afterwards for 1, 3 or 4 Stokes components and for several models at
//! once. The crate reads no files, prints nothing and knows no clock.

mod allocation;
mod beam;
mod bridge;
mod checkpoints;
mod choose;
mod cover;
mod cumulated;
mod direct;
mod direction;
mod emitters;
mod engine;
mod evaluate;
mod exact;
mod gather;
mod glints;
mod journey;
mod lamps;
mod launched;
mod ledger;
mod local;
mod lookout;
mod medium;
mod mirrors;
mod missing;
mod neighbours;
mod pass;
mod path;
mod picture;
mod pilot;
mod radiosity;
mod random;
mod reading;
mod receiver;
mod results;
mod run;
mod sight;
mod site;
mod sobol;
mod spread;
mod state;
mod statistics;
mod student;
mod techniques;
mod trace;
mod variation;

pub use allocation::{Allocation, Sharing};
pub use choose::unseen;
pub use picture::{Film, Picture, expose};
pub use results::{
    Absorbed, Answer, Energy, Group, Paired, Progress, Reading, Replicates, Results, Shares, Stop,
    Unseen,
};
pub use run::{Together, resume, resume_together, run, run_together};
pub use state::{NoShard, Shard, State, StateError};
pub use statistics::{Estimate, Means, MergeError, REPLICAS, Replica, Tally};
pub use student::{half_width, half_width_95, two_sided};
pub use variation::Cohort;
