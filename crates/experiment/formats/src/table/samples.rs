//! Samples in CSV or Parquet: a row for each, without any time.

use super::head::Column;
use super::{GREATEST, csv, names};
use crate::FileError;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// What such a file holds, in words.
const WHAT: &str = "a table of samples";

/// Values of a column, a row each; none where a row has none.
pub type ColumnValues = Vec<Option<f64>>;

/// How tables of another format are read: by a room that holds its library, so that this one does not.
#[derive(Debug)]
pub struct OtherTable {
    /// Names and units of all columns of the file at a path.
    pub columns: fn(&Path) -> Result<Vec<Column>, FileError>,
    /// Those of the column of this number, the first is 0.
    pub values: fn(&Path, usize) -> Result<ColumnValues, FileError>,
}

static PARQUET: OnceLock<&'static OtherTable> = OnceLock::new();

/// Has `.parquet` read by `table`.
pub fn announce_parquet(table: &'static OtherTable) {
    PARQUET.get_or_init(|| table);
}

/// Chosen columns of all rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// The file.
    pub path: PathBuf,
    /// Names and units of the columns, in the order asked for.
    pub columns: Vec<Column>,
    /// Values, those of one row together, in the units of the columns.
    pub values: Vec<f64>,
    /// Line of each row in the file, the first is 1; in Parquet its row.
    pub lines: Vec<u64>,
}

impl Samples {
    /// Reads the columns `wanted` of the table at `path`: Parquet where its name ends so, else CSV, names in
    /// its first line.
    ///
    /// # Errors
    /// [`FileError`] with line and column: a name that the file has not, a row cut short, what is not a
    /// number, not finite or beyond ±1e30, and no row at all.
    pub fn read(path: &Path, wanted: &[&str]) -> Result<Self, FileError> {
        if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("parquet")) {
            return Self::read_parquet(path, wanted);
        }
        let (columns, mut rows) = csv::columns(path)?;
        let found = places(path, wanted, &columns)?;
        let mut all = Self::none(path, &found, &columns);
        let mut row = vec![0.0; wanted.len()];
        while rows.read(path, &columns, &found, &mut row)? {
            all.add("line", rows.line_number(), &row)?;
        }
        all.checked()
    }

    fn read_parquet(path: &Path, wanted: &[&str]) -> Result<Self, FileError> {
        let Some(table) = PARQUET.get() else {
            let problem = "this program was built without Parquet";
            let fix = "give it as CSV, or build the program with the feature `parquet`";
            return Err(FileError::content(WHAT, path, problem, fix));
        };
        let columns = (table.columns)(path)?;
        let found = places(path, wanted, &columns)?;
        let mut all = Self::none(path, &found, &columns);
        let values = found.iter().map(|column| (table.values)(path, *column));
        let values = values.collect::<Result<Vec<_>, FileError>>()?;
        let n_rows = values.first().map_or(0, Vec::len);
        for row in 0..n_rows {
            // A row of a shorter column has no value, as one that is left empty.
            let value = |column: &Vec<Option<f64>>| column.get(row).copied().flatten();
            let values: Vec<f64> =
                values.iter().map(|column| value(column).unwrap_or(f64::NAN)).collect();
            all.add("row", row as u64 + 1, &values)?;
        }
        all.checked()
    }

    /// The columns `found` of `columns`, and no row yet.
    fn none(path: &Path, found: &[usize], columns: &[Column]) -> Self {
        let columns = found.iter().map(|index| columns[*index].clone()).collect();
        Self { path: path.to_owned(), columns, values: Vec::new(), lines: Vec::new() }
    }

    /// Takes in the row at `line`, which is a line or a row of the file, as `word` says.
    fn add(&mut self, word: &str, line: u64, row: &[f64]) -> Result<(), FileError> {
        // Not so of what is not a number, too.
        let is_sound = |value: &f64| value.abs() <= GREATEST;
        if let Some(slot) = row.iter().position(|value| !is_sound(value)) {
            let (name, value) = (&self.columns[slot].name, row[slot]);
            let problem = format!(
                "{word} {line}: {name} is {value:?}, not a finite number within ±{GREATEST:e}"
            );
            let fix =
                "leave the row out, or find out why the program that wrote it had no number there";
            return Err(FileError::content(WHAT, &self.path, problem, fix));
        }
        self.values.extend_from_slice(row);
        self.lines.push(line);
        Ok(())
    }

    /// The same where there is any row.
    fn checked(self) -> Result<Self, FileError> {
        if self.lines.is_empty() {
            let fix = "give a row for each sample below the names";
            return Err(FileError::content(WHAT, &self.path, "it has no rows", fix));
        }
        Ok(self)
    }

    /// Row `index`.
    pub fn row(&self, index: usize) -> &[f64] {
        let n_columns = self.columns.len();
        &self.values[index * n_columns..(index + 1) * n_columns]
    }
}

/// Places of the columns `wanted` of the table at `path` among its `columns`.
fn places(path: &Path, wanted: &[&str], columns: &[Column]) -> Result<Vec<usize>, FileError> {
    let place = |name: &&str| {
        names::find(name, columns).map_err(|(problem, fix)| {
            let [problem, fix] = [problem, fix].map(|text| text.replace("channel", "column"));
            FileError::content(WHAT, path, problem, &fix)
        })
    };
    wanted.iter().map(place).collect()
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
