//! Campaigns: thousands of short simulations of one case, in a folder that several processes work in.
//!
//! | wanted | use | on the command line |
//! | --- | --- | --- |
//! | tasks out of a file, and what they cost | [`plan`] | `wakemix campaign plan` |
//! | the tasks made | [`run`] | `wakemix campaign run`, `exec` |
//! | how far it is | [`status`] | `wakemix campaign status` |
//! | a table of factors and numbers | [`collect`] | `wakemix campaign collect` |
//! | a script for a scheduler | [`export`] | `wakemix campaign export` |
//!
//! A task is a study of its own, made by [`study::run`] with overrides, as `wakemix run --set` makes it, and
//! has the same bits. Where tasks stand is in an SQLite database in the folder.
//!
//! Tasks are made in this process, on threads: a study shares no state of the process but what a file or a
//! rotor always comes to, a panic ends its task alone, and one Ctrl-C reaches all. What a foreign controller
//! crashes is the process: tasks that come back are made alone, and after three such ends one is failed.

mod claim;
mod collect;
mod column;
mod error;
mod export;
mod make;
mod numbers;
#[cfg(feature = "parquet")]
mod parquet;
mod plan;
mod run;
mod status;
mod table;
mod task;
mod whole;
mod worker;

pub use collect::{Collected, collect};
pub use error::CampaignError;
pub use export::{Format, Script, export};
pub use numbers::{Number, numbers};
pub use plan::{Cost, Plan, PlannedFactor, plan};
pub use run::{Ended, Observer, Progress, RunOptions, Silent, run};
pub use status::{Failure, Status, status};
pub use table::Counts;

/// Has tables in Parquet read wherever tables of samples are, such as by surrogates: `collect` writes them.
#[cfg(feature = "parquet")]
pub fn announce_parquet() {
    formats::table::announce_parquet(&parquet::PARQUET);
}

#[cfg(test)]
mod tests;
