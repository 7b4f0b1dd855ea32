//! Tables of channels over time, read row by row whatever their format: OpenFAST's `.outb` and `.out`, CSV,
//! the project's own series.
//!
//! A table of any length takes the memory of one row. The caller selects channels by name and reads rows of
//! time and those channels; what was not selected is neither parsed nor checked.

pub(crate) mod csv;
pub(crate) mod head;
pub(crate) mod names;
mod samples;
pub(crate) mod text;

pub use head::Column;
pub use samples::{ColumnValues, OtherTable, Samples, announce_parquet};

use crate::{FileError, openfast_output};
use head::{Head, WHAT};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use text::TextRows;

/// Greatest value that is taken for a measurement, in any unit; squares and sums of such are finite.
const GREATEST: f64 = 1e30;

/// A table being read.
#[derive(Debug)]
pub struct TableReader {
    path: PathBuf,
    head: Head,
    /// Columns that rows are made of: time, then what was selected.
    wanted: Vec<usize>,
    latest_time: f64,
    rows: Rows,
}

#[derive(Debug)]
enum Rows {
    Binary(openfast_output::BinaryRows),
    Text(TextRows),
}

impl TableReader {
    /// Opens the table at `path`: `.outb` and `.out` of OpenFAST, anything else as CSV with names in its
    /// first line. A folder stands for the `series.csv` in it.
    ///
    /// # Errors
    /// [`FileError`] names file, place and fix: another format, a file cut short, the wrong byte order, no
    /// column of time.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let path = if path.is_dir() { path.join("series.csv") } else { path.to_owned() };
        let extension = path.extension().and_then(OsStr::to_str).map(str::to_lowercase);
        let (head, rows) = match extension.as_deref() {
            Some("outb") => {
                let (head, rows) = openfast_output::open_binary(&path)?;
                (head, Rows::Binary(rows))
            }
            Some("out") => {
                let (head, rows) = openfast_output::open_text(&path)?;
                (head, Rows::Text(rows))
            }
            _ => {
                let (head, rows) = csv::open(&path)?;
                (head, Rows::Text(rows))
            }
        };
        let wanted = vec![head.time];
        Ok(Self { path, head, wanted, latest_time: f64::NEG_INFINITY, rows })
    }

    /// The file being read.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where the table comes from, in its own words; empty where it does not say.
    pub fn description(&self) -> &str {
        &self.head.description
    }

    /// All channels but time, in the order of the file.
    pub fn channels(&self) -> impl Iterator<Item = &Column> {
        let time = self.head.time;
        let columns = self.head.columns.iter().enumerate();
        columns.filter(move |(index, _)| *index != time).map(|(_, column)| column)
    }

    /// Chooses what [`read`](Self::read) gives beside time, in this order; replaces an earlier choice.
    ///
    /// A name is looked for as it is, then ignoring case, then as the beginning of one name up to `_` or a
    /// space, so that `RootMyc1` finds `RootMyc1_kN-m`; at last under the name that
    /// [`turbine::structure::canonical`] gives, so that `RootMFlp1` finds `RootMyb1`.
    /// [`selected`](Self::selected) tells what was found.
    ///
    /// # Errors
    /// [`FileError::Content`] for a name that the table has not, with those that may have been meant.
    pub fn select(&mut self, names: &[&str]) -> Result<(), FileError> {
        let mut wanted = vec![self.head.time];
        for name in names {
            let found = names::find(name, &self.head.columns);
            let refusal = |(problem, fix)| FileError::content(WHAT, &self.path, problem, fix);
            wanted.push(found.map_err(refusal)?);
        }
        self.wanted = wanted;
        Ok(())
    }

    /// What was selected, in that order.
    pub fn selected(&self) -> impl Iterator<Item = &Column> {
        self.wanted[1..].iter().map(|index| &self.head.columns[*index])
    }

    /// Reads the next row into `row`: time (s), then the selected channels. False at the end of the table.
    ///
    /// # Errors
    /// [`FileError`] with the place: a row cut short, what is not a number, not finite or beyond ±1e30, time
    /// that runs backwards.
    ///
    /// # Panics
    /// When `row` has not one value more than channels were selected.
    pub fn read(&mut self, row: &mut [f64]) -> Result<bool, FileError> {
        assert_eq!(row.len(), self.wanted.len(), "a row is time and the selected channels");
        let there = match &mut self.rows {
            Rows::Binary(rows) => rows.read(&self.path, &self.wanted, row)?,
            Rows::Text(rows) => rows.read(&self.path, &self.head.columns, &self.wanted, row)?,
        };
        if there {
            // Not so of what is not a number, too.
            let is_sound = |value: &f64| value.abs() <= GREATEST;
            if let Some(slot) = row.iter().position(|value| !is_sound(value)) {
                return Err(self.not_finite(slot, row));
            }
            if row[0] < self.latest_time {
                return Err(self.backwards(row[0]));
            }
            self.latest_time = row[0];
        }
        Ok(there)
    }

    fn not_finite(&self, slot: usize, row: &[f64]) -> FileError {
        let column = &self.head.columns[self.wanted[slot]];
        let place = self.place();
        let time = if slot > 0 { format!(" ({} s)", row[0]) } else { String::new() };
        let problem = format!(
            "{place}{time}: {} is {:?}, not a finite number within ±{GREATEST:e}",
            column.name, row[slot]
        );
        let fix = "find out why the program that wrote it had no number there";
        FileError::content(WHAT, &self.path, problem, fix)
    }

    fn backwards(&self, time: f64) -> FileError {
        let problem =
            format!("{}: time goes back from {} s to {time} s", self.place(), self.latest_time);
        let fix = "sort the rows by time, or take one simulation at a time";
        FileError::content(WHAT, &self.path, problem, fix)
    }

    fn place(&self) -> String {
        match &self.rows {
            Rows::Binary(rows) => format!("row {}", rows.n_read()),
            Rows::Text(rows) => format!("line {}", rows.line_number()),
        }
    }
}

#[cfg(test)]
mod tests;
