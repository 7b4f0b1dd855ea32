//! Writing what a validation gave as its new record.

use std::path::Path;
use validation::Row;
use validation::record::Record;
use wakemix::formats::records::{Machine, now};

/// Records `rows` of the validation `name`, made now and here, in the repository at the current folder.
///
/// # Errors
/// When a claim is weaker than its record, and when the record cannot be read or written, in words.
pub(super) fn renew(name: &str, rows: &[Row]) -> Result<(), String> {
    let root = Path::new("");
    let recorded = Record::read(root, name).map_err(|error| error.to_string())?;
    let Machine { processor, n_cores, system } = Machine::here();
    let processor = processor.unwrap_or_else(|| "processor not known".to_owned());
    let version = env!("CARGO_PKG_VERSION");
    let conditions = format!("{n_cores} cores, {processor}, {system}, version {version}");
    let moment = now();
    let date = moment.split('T').next().unwrap_or_default();
    let renewed = recorded.renewed(rows, date, &conditions).map_err(|error| error.to_string())?;
    renewed.write(root, name).map_err(|error| error.to_string())
}
