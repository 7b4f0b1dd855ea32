//! A study, stage by stage: `Case` → [`Prepared`] → [`Ready`] → runs → summaries.
//!
//! | stage | what it is | file |
//! | --- | --- | --- |
//! | [`Case`](farm::case::Case) | plain data: what the case file says | |
//! | [`Prepared`] | checked, laid out; its cost is known | `prepared`, `models`, `warnings`, `self_check` |
//! | [`Ready`] | pitch responses identified, turbulence made | `ready`, `pitch_identification`, `air` |
//! | run | from time zero to the last step | `simulate` with its `outputs`, `channels` |
//! | | the same as values, without files | `in_memory` |
//! | summary | its numbers, and gains over another run | `summarise` from `columns`, `gains` |
//!
//! [`precursor`] makes wind for studies instead: a periodic box of atmosphere.
//!
//! No stage is ever half built: each comes whole from the one before. The stages need no files; [`run`] takes
//! a study through all of them in a folder, from the case file to the records; [`Ready::run_all`] makes the
//! runs as values.

mod air;
mod atmosphere;
mod azimuth_offset;
mod channels;
mod columns;
mod companion;
mod cost;
mod entry;
mod error;
mod file_of_wind;
mod gains;
mod hosting;
mod in_memory;
mod inputs;
mod jobs;
mod linear_laws;
mod loads;
mod models;
mod observer;
mod options;
pub mod outputs;
mod pitch_identification;
pub mod precursor;
mod prepared;
mod ready;
mod same_case;
mod sample;
mod self_check;
mod simulate;
mod slice_layout;
mod study;
mod summarise;
mod sweep;
mod threads;
mod tips;
mod warnings;

pub use azimuth_offset::{OffsetAnswer, OffsetQuestion, azimuth_offset};
pub use error::StudyError;
pub use in_memory::RunResult;
pub use inputs::Inputs;
pub use observer::{Estimate, IdentificationProgress, Observer, Progress, Silent};
pub use options::{Outcome, StudyOptions};
pub use outputs::Outputs;
pub use prepared::Prepared;
pub use ready::Ready;
pub use sample::Sample;
pub use self_check::SelfChecked;
pub use sweep::{run, run_with};
pub use threads::cores;
pub use warnings::SetupWarning;
