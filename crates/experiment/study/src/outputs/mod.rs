//! Outputs: what a run leaves besides its summary, each written on a schedule of its own.
//!
//! An output is a file here and a line in [`STANDARD`]. Somebody else's is added to
//! [`OUTPUTS`], and cases ask for it by a name; or it is handed to
//! [`run_with`](crate::run_with) with [`Outputs::with`], and every run has it.
//!
//! Reading order: `output` (what an output is), `schedule` (when it is due), `section` (its state in a
//! checkpoint), `writers` (those of one run at work), then any output, `volumes` being the shortest.

mod cores;
mod filaments;
mod instant_planes;
mod last_planes;
mod lines;
pub(crate) mod mean_planes;
pub(crate) mod outb;
mod output;
pub(crate) mod phase_averages;
mod phase_planes;
mod scans;
mod schedule;
mod section;
pub(crate) mod series;
pub(crate) mod slices;
pub(crate) mod volumes;
mod wind_record;
mod wind_records;
pub(crate) mod wind_slices;
mod writers;

pub use output::{Begin, FedBy, Keys, Output, OutputKind, OwnKeys, Scene};
pub use schedule::Schedule;
pub use section::{Section, Stored};

pub(crate) use writers::{Stage, Writers};

use crate::prepared::Prepared;
use basis::keys::Values;
use farm::case::Run;
use farm::outputs::OUTPUTS;
use std::sync::Once;

/// The kinds of output that every study has; they finish in this order.
pub static STANDARD: [&OutputKind; 13] = [
    &series::KIND,
    &mean_planes::KIND,
    &phase_planes::KIND,
    &instant_planes::KIND,
    &last_planes::KIND,
    &volumes::KIND,
    &filaments::KIND,
    &cores::KIND,
    &wind_records::KIND,
    &wind_slices::KIND,
    &scans::KIND,
    &phase_averages::KIND,
    // From the complete series.
    &outb::KIND,
];

/// Makes those of [`STANDARD`] that cases ask for by a name known to the reader of case files.
///
/// # Panics
/// When a kind of such a name was added before.
pub fn announce() {
    static ANNOUNCED: Once = Once::new();
    ANNOUNCED.call_once(|| {
        for kind in STANDARD.into_iter().filter(|kind| kind.is_named()) {
            assert!(OUTPUTS.add(kind).is_ok(), "two outputs are called `{}`", kind.name);
        }
    });
}

/// Longest name of a kind (bytes); sections of a checkpoint have names of limited length.
const LONGEST_NAME: usize = 48;

/// The kinds of output that the runs of a study may have.
#[derive(Clone)]
pub struct Outputs(Vec<&'static OutputKind>);

impl Outputs {
    /// Those that every study has, [`STANDARD`].
    pub fn standard() -> Self {
        announce();
        Self(STANDARD.to_vec())
    }

    /// These, and `kind` after them.
    ///
    /// # Panics
    /// When there is one of this name, the name is longer than 48 bytes or has a point in it, or the kind has
    /// keys of its own: such a kind is added to [`OUTPUTS`].
    pub fn with(mut self, kind: &'static OutputKind) -> Self {
        let name = kind.name;
        assert!(!kind.is_named(), "the output `{name}` is asked for by name: add it to OUTPUTS");
        assert!(name.len() <= LONGEST_NAME, "the name `{name}` of an output is too long");
        assert!(!name.contains('.'), "the name `{name}` of an output has a point in it");
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
        let case = &setup.case;
        let nothing = Values::none();
        let usual = self.0.iter().filter(|kind| !kind.is_named() && kind.fed_by.admits(case));
        let usual: u64 = usual.map(|kind| (kind.disk)(setup, run, &nothing)).sum();
        let further = case.output.further.iter().map(|requested| {
            // One that nobody writes takes no room.
            writers::kind_of(requested).map_or(0, |kind| (kind.disk)(setup, run, &requested.values))
        });
        usual + further.sum::<u64>()
    }
}

impl Default for Outputs {
    fn default() -> Self {
        Self::standard()
    }
}

#[cfg(test)]
mod tests;
