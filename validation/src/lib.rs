//! Recorded validations: each compares the program with a closed form, a published figure or another program.
//!
//! `wakemix validate NAME` repeats one and sets it beside its record (`validation/recorded/`), of which the
//! pages in `docs/validation/` show the verdicts.

// What is told goes through `tell!`: a closed pipe is no reason to panic.
#![deny(clippy::print_stdout, clippy::print_stderr)]

/// A line on standard error, unless nothing is to be said; there is nobody to tell when that fails.
macro_rules! tell {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        if !$crate::IS_QUIET.load(std::sync::atomic::Ordering::Relaxed) {
            let _ = writeln!(std::io::stderr(), $($text)*);
        }
    }};
}

pub mod actuator_line;
pub mod aeroelastic;
pub mod atmosphere;
mod axisymmetric;
pub mod blade_element;
pub mod control_times;
pub mod flow;
mod folds;
mod four_winds;
pub mod free_vortex;
pub mod gate;
pub mod gaussian_process;
pub mod helix;
pub mod identification;
pub mod inflow;
mod least_squares;
mod lidar_amplitude;
pub mod lidar_family;
pub mod lidar_loop;
pub mod lidar_table;
mod list;
pub mod load_database;
pub mod meandering;
pub mod memory;
pub mod pages;
pub mod phase_estimator;
mod random;
pub mod record;
mod recorded;
pub mod refined_rotor;
pub mod resume;
pub mod row;
pub mod structure;
mod studies;
pub mod synthesis;
pub mod tuning;
pub mod tuning_array;
pub mod tunnel;
pub mod wake_analysis;

pub use list::{ELSEWHERE, VALIDATIONS};
use record::{Record, RecordError};
pub use report::ReportError;
pub use row::{Row, Tolerance};
use std::fmt;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether remarks and progress are left out.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// On return validations give their rows and say nothing beside them.
pub fn be_quiet() {
    IS_QUIET.store(true, Ordering::Relaxed);
}

/// A validation that can be repeated by name.
pub struct Validation {
    /// Name on the command line.
    pub name: &'static str,
    /// What is compared with what.
    pub about: &'static str,
    /// How long it takes.
    pub cost: Cost,
    /// Makes the comparison.
    pub run: fn() -> Vec<Row>,
    /// Draws it into a folder and gives the figures' names; none where there is nothing but rows.
    pub pictures: Option<Pictures>,
    /// Its page in `docs/validation/`, without `.md`.
    pub page: &'static str,
    /// What it gave when it was last recorded: the text of its file in `validation/recorded/`.
    pub recorded: &'static str,
}

impl Validation {
    /// What it gave when it was last recorded.
    ///
    /// # Errors
    /// [`RecordError::Content`] when the file that the program was built with holds no record.
    pub fn record(&self) -> Result<Record, RecordError> {
        Record::parse(self.recorded)
            .map_err(|cause| RecordError::Content(format!("{}.toml", self.name).into(), cause))
    }
}

/// A comparison that is recorded here and repeated by other means than `wakemix validate`.
pub struct Elsewhere {
    /// Name of its record.
    pub name: &'static str,
    /// What is compared with what.
    pub about: &'static str,
    /// The command that repeats it.
    pub repeat: &'static str,
    /// Its page in `docs/validation/`, without `.md`.
    pub page: &'static str,
    /// What it gave: the text of its file in `validation/recorded/`.
    pub recorded: &'static str,
}

/// How long a validation takes on two quiet cores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Less than a minute of one core, and no row measures time or memory: what is repeated with every
    /// change.
    UnderAMinute,
    /// About so many minutes.
    Minutes(u32),
}

impl fmt::Display for Cost {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnderAMinute => out.pad("under 1"),
            Self::Minutes(minutes) => out.pad(&minutes.to_string()),
        }
    }
}

/// Draws a validation into a folder; gives the figures' names.
pub type Pictures = fn(&Path) -> Result<Vec<String>, ReportError>;
