//! Samples in CSV: a row for each, without any time.

use super::head::Column;
use super::{GREATEST, csv, names};
use crate::FileError;
use std::path::{Path, PathBuf};

/// What such a file holds, in words.
const WHAT: &str = "a table of samples";

/// Chosen columns of all rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// The file.
    pub path: PathBuf,
    /// Names and units of the columns, in the order asked for.
    pub columns: Vec<Column>,
    /// Values, those of one row together, in the units of the columns.
    pub values: Vec<f64>,
    /// Line of each row in the file, the first is 1.
    pub lines: Vec<u64>,
}

impl Samples {
    /// Reads the columns `wanted` of the CSV at `path`, names in its first line.
    ///
    /// # Errors
    /// [`FileError`] with line and column: a name that the file has not, a row cut short, what is not a
    /// number, not finite or beyond ±1e30, and no row at all.
    pub fn read(path: &Path, wanted: &[&str]) -> Result<Self, FileError> {
        let refusal = |problem: String, fix: &str| FileError::content(WHAT, path, problem, fix);
        let (columns, mut rows) = csv::columns(path)?;
        let found = wanted.iter().map(|name| {
            names::find(name, &columns).map_err(|(problem, fix)| {
                refusal(problem.replace("channel", "column"), &fix.replace("channel", "column"))
            })
        });
        let found = found.collect::<Result<Vec<usize>, FileError>>()?;
        let (mut row, mut values, mut lines) = (vec![0.0; wanted.len()], Vec::new(), Vec::new());
        while rows.read(path, &columns, &found, &mut row)? {
            let line = rows.line_number();
            // Not so of what is not a number, too.
            let is_sound = |value: &f64| value.abs() <= GREATEST;
            if let Some(slot) = row.iter().position(|value| !is_sound(value)) {
                let (name, value) = (&columns[found[slot]].name, row[slot]);
                return Err(refusal(
                    format!(
                        "line {line}: {name} is {value:?}, not a finite number within ±{GREATEST:e}"
                    ),
                    "leave the row out, or find out why the program that wrote it had no number there",
                ));
            }
            values.extend_from_slice(&row);
            lines.push(line);
        }
        if lines.is_empty() {
            return Err(refusal(
                "it has no rows".into(),
                "give a row for each sample below the names",
            ));
        }
        let columns = found.iter().map(|index| columns[*index].clone()).collect();
        Ok(Self { path: path.to_owned(), columns, values, lines })
    }

    /// Row `index`.
    pub fn row(&self, index: usize) -> &[f64] {
        let n_columns = self.columns.len();
        &self.values[index * n_columns..(index + 1) * n_columns]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn columns_are_read_by_name_and_what_is_wrong_is_named_with_its_line() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("loads.csv");
        fs::write(&path, "wind [m/s],DEL [kN-m],yaw\n8,100,0\n9,120,5\n").expect("written");
        let found = Samples::read(&path, &["DEL", "wind"]).expect("a table");
        assert_eq!((found.row(1), &found.lines[..]), (&[120.0, 9.0][..], &[2, 3][..]));
        assert_eq!(found.columns[0].unit, "kN-m");
        let problem = |text: &str, name: &str| {
            fs::write(&path, text).expect("written");
            format!("{:?}", Samples::read(&path, &[name]).expect_err("bad"))
        };
        assert!(problem("a,b\n1,2\n1,nan\n", "b").contains("line 3: b is NaN"));
        assert!(problem("a,b\n1,2\n1\n", "b").contains("line 3"));
        assert!(problem("a,b\n", "b").contains("no rows"));
        assert!(problem("a,b\n1,2\n", "c").contains("no column \\\"c\\\""));
    }
}
