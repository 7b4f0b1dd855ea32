//! Outputs: what a run leaves besides its summary, each written on a schedule of its own.
//!
//! An output is a file here and a line in [`STANDARD`]; somebody else's is handed to
//! [`run_with`](crate::run_with) with [`Outputs::with`]. Reading order: `output` (what an output is),
//! `schedule` (when it is due), `section` (its state in a checkpoint), `writers` (those of one run at work),
//! then any output, `volumes` being the shortest.

mod instant_planes;
mod last_planes;
mod lines;
pub(crate) mod mean_planes;
mod outb;
mod output;
mod phase_planes;
mod schedule;
mod section;
pub(crate) mod series;
pub(crate) mod slices;
mod volumes;
mod wind_records;
mod writers;

pub use output::{Begin, FedBy, Output, OutputKind, Scene};
pub use schedule::Schedule;
pub use section::{Section, Stored};

pub(crate) use writers::Writers;

use crate::prepared::Prepared;
use farm::case::Run;

/// The kinds of output that every study has; they finish in this order.
pub static STANDARD: [&OutputKind; 8] = [
    &series::KIND,
    &mean_planes::KIND,
    &phase_planes::KIND,
    &instant_planes::KIND,
    &last_planes::KIND,
    &volumes::KIND,
    &wind_records::KIND,
    // From the complete series.
    &outb::KIND,
];

/// Longest name of a kind (bytes); sections of a checkpoint have names of limited length.
const LONGEST_NAME: usize = 48;

/// The kinds of output that the runs of a study may have.
#[derive(Clone)]
pub struct Outputs(Vec<&'static OutputKind>);

impl Outputs {
    /// Those that every study has, [`STANDARD`].
    pub fn standard() -> Self {
        Self(STANDARD.to_vec())
    }

    /// These, and `kind` after them.
    ///
    /// # Panics
    /// When there is one of this name, or the name is longer than 48 bytes.
    pub fn with(mut self, kind: &'static OutputKind) -> Self {
        let name = kind.name;
        assert!(name.len() <= LONGEST_NAME, "the name `{name}` of an output is too long");
        assert!(
            self.0.iter().all(|other| other.name != name),
            "two outputs are called `{name}`: one would read the other's checkpoint"
        );
        self.0.push(kind);
        self
    }

    /// The kinds, in the order in which they finish.
    pub fn kinds(&self) -> &[&'static OutputKind] {
        &self.0
    }

    /// How much `run` of `setup` puts on the disk at most at any time (bytes), what these outputs add to two
    /// checkpoints included.
    pub fn disk_of_run(&self, setup: &Prepared, run: &Run) -> u64 {
        let fed = self.0.iter().filter(|kind| kind.fed_by.admits(&setup.case));
        fed.map(|kind| (kind.disk)(setup, run)).sum()
    }
}

impl Default for Outputs {
    fn default() -> Self {
        Self::standard()
    }
}

#[cfg(test)]
mod tests;
