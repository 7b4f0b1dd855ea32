//! Writing what a validation gave as its new record.

use std::path::Path;
use validation::Row;
use validation::record::{Record, Worse};
use wakemix::formats::records::{Machine, now};

/// Records `rows` of the validation `name`, made now and here, in the repository at the current folder; what
/// got worse only where `worse` is accepted.
///
/// # Errors
/// When a claim is weaker than its record, or got worse, and when the record cannot be read or written, in
/// words.
pub(super) fn renew(name: &str, rows: &[Row], worse: Worse) -> Result<(), String> {
    let root = Path::new("");
    let recorded = Record::read(root, name).map_err(|error| error.to_string())?;
    let Made { date, conditions } = Made::here();
    let renewed =
        recorded.renewed(rows, &date, &conditions, worse).map_err(|error| error.to_string())?;
    renewed.write(root, name).map_err(|error| error.to_string())
}

/// When and on what machine rows are made.
pub(super) struct Made {
    /// Day (year-month-day).
    pub(super) date: String,
    /// Machine and version of the program.
    pub(super) conditions: String,
}

impl Made {
    /// Today, on this machine.
    pub(super) fn here() -> Self {
        let Machine { processor, n_cores, system } = Machine::here();
        let processor = processor.unwrap_or_else(|| "processor not known".to_owned());
        let version = env!("CARGO_PKG_VERSION");
        let conditions = format!("{n_cores} cores, {processor}, {system}, version {version}");
        let date = now().split('T').next().unwrap_or_default().to_owned();
        Self { date, conditions }
    }
}
