//! The series of a run read back: whole, or no more of it than is wanted.

use super::series::{BUFFER, WHAT};
use crate::{FileError, atomic};
use basis::channels::{GEN_PWR, TIME};
use basis::records::Series;
use basis::{Channel, Unit};
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};

/// What earlier programs called the column of time.
const TIME_BEFORE: &str = "time_s";

/// A series on the disk: its channels and its length are known, its numbers are read as they are wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeriesFile {
    path: PathBuf,
    names: Vec<String>,
    units: Vec<Unit>,
    n_rows: usize,
    n_bytes: usize,
}

impl SeriesFile {
    /// Looks at the series at `path`: reads its channels, counts its rows and holds none.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Content`] when its first line is not text,
    /// or has names of an earlier program, whose units are not those of today.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let failed = |source| refused_reading(path, source);
        let (mut reader, header) = started(path)?;
        let (mut names, mut units) = (Vec::new(), Vec::new());
        for Channel { name, unit } in channels(path, header.trim_end())? {
            names.push(name.into_owned());
            units.push(unit);
        }
        let (mut n_rows, mut n_bytes) = (0, header.len());
        loop {
            let n_skipped = reader.skip_until(b'\n').map_err(failed)?;
            if n_skipped == 0 {
                break;
            }
            n_rows += 1;
            n_bytes += n_skipped;
        }
        Ok(Self { path: path.to_owned(), names, units, n_rows, n_bytes })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Names of its channels without their units, in the order of its columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Units of its columns.
    pub fn units(&self) -> &[Unit] {
        &self.units
    }

    /// Rows of numbers in it (–).
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// The channels for whose names `wanted` holds, in the order of the file and in SI units, in one pass
    /// over it; the numbers of others are skipped unread.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Content`] with line and column when it is
    /// something else.
    pub fn read(&self, wanted: impl Fn(&str) -> bool) -> Result<Series, FileError> {
        let mut series = Series::default();
        let mut units = Vec::new();
        for (name, unit) in self.names.iter().zip(&self.units).filter(|(name, _)| wanted(name)) {
            series.names.push(name.clone());
            series.columns.push(Vec::with_capacity(self.most_rows()));
            units.push(*unit);
        }
        self.each_row(wanted, |row| {
            for ((column, value), unit) in series.columns.iter_mut().zip(row).zip(&units) {
                column.push(unit.to_si(*value));
            }
            Ok::<(), FileError>(())
        })?;
        Ok(series)
    }

    /// Gives `take` the numbers of the channels for whose names `wanted` holds, row by row, as they stand in
    /// the file, in its units.
    ///
    /// # Errors
    /// As [`read`](Self::read), and those of `take`.
    pub fn each_row<E: From<FileError>>(
        &self,
        wanted: impl Fn(&str) -> bool,
        mut take: impl FnMut(&[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let Self { path, names, .. } = self;
        let failed = |source| refused_reading(path, source);
        let (mut reader, mut line) = started(path)?;
        let is_wanted: Vec<bool> = names.iter().map(|name| wanted(name)).collect();
        let mut row = Vec::with_capacity(names.len());
        for number in 2.. {
            line.clear();
            row.clear();
            if reader.read_line(&mut line).map_err(failed)? == 0 {
                break;
            }
            let refusal = |problem: String| {
                let fix = "restore the file, or make the run again";
                FileError::content(WHAT, path, format!("line {number}: {problem}"), fix)
            };
            let mut n_values = 0;
            for (index, value) in line.trim_end().split(',').enumerate() {
                let is_wanted = is_wanted.get(index);
                let is_wanted = is_wanted
                    .ok_or_else(|| refusal(format!("more than {} values", names.len())))?;
                n_values = index + 1;
                if !is_wanted {
                    continue;
                }
                let name = || &names[index];
                let value = value.parse().map_err(|_| {
                    refusal(format!("`{value}` in column {} is not a number", name()))
                })?;
                row.push(value);
            }
            if n_values != names.len() {
                let problem = format!("{n_values} values, the header has {}", names.len());
                return Err(refusal(problem).into());
            }
            take(&row)?;
        }
        Ok(())
    }

    /// Rows that the file can hold: each value takes two bytes or more, so a broken file asks for little
    /// memory.
    fn most_rows(&self) -> usize {
        self.n_rows.min(self.n_bytes / (2 * self.names.len()) + 1)
    }
}

/// Reads the channels for which `wanted` holds of the series at `path`.
///
/// # Errors
/// As [`SeriesFile::open`] and [`SeriesFile::read`].
pub fn read_series(path: &Path, wanted: impl Fn(&str) -> bool) -> Result<Series, FileError> {
    SeriesFile::open(path)?.read(wanted)
}

/// The channels whose columns the `header` of the series at `path` names.
fn channels(path: &Path, header: &str) -> Result<Vec<Channel>, FileError> {
    let columns: Vec<&str> = header.split(',').collect();
    if columns[0] == TIME_BEFORE {
        let other = columns.get(1..).and_then(<[_]>::last).copied().unwrap_or_default();
        let problem = format!(
            "line 1: its channels have the names and units of an earlier program (`{TIME_BEFORE}`, …, `{other}`); \
             today they are others (`{}`, …)",
            TIME.column()
        );
        let fix = "make the run again, or read it with the program that made it";
        return Err(FileError::content(WHAT, path, problem, fix));
    }
    let channel = |(index, column): (usize, &&str)| {
        Channel::of_column(column).ok_or_else(|| {
            let problem = format!(
                "line 1: channel {} is `{column}`, not a name and its unit, such as `{}`",
                index + 1,
                GEN_PWR.of("T1").column()
            );
            FileError::content(WHAT, path, problem, "restore the file, or make the run again")
        })
    };
    columns.iter().enumerate().map(channel).collect()
}

/// The series at `path` behind its first line, and that line.
fn started(path: &Path) -> Result<(BufReader<File>, String), FileError> {
    let failed = |source| refused_reading(path, source);
    let mut reader = BufReader::with_capacity(BUFFER, atomic::open(path).map_err(failed)?);
    let mut line = String::new();
    reader.read_line(&mut line).map_err(failed)?;
    Ok((reader, line))
}

fn refused_reading(path: &Path, source: io::Error) -> FileError {
    match source.kind() {
        ErrorKind::InvalidData => FileError::content(WHAT, path, "it is not text", "restore it"),
        _ => FileError::system("read", WHAT, path, source),
    }
}

#[cfg(test)]
mod tests {
    use super::super::SeriesWriter;
    use super::*;
    use basis::channels::BLD_PITCH;
    use proptest::prelude::*;
    use std::fs;

    #[test]
    fn a_broken_row_is_reported_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        let cases = [
            ("a_m,b_s\n1,2\n3\n", "line 3: 1 values, the header has 2"),
            ("a_m,b_s\n1,2,3\n", "line 2: more than 2 values"),
            ("a_m,b_s\n1,two\n", "line 2: `two` in column b is not a number"),
            (
                "a_m,b\n1,2\n",
                "line 1: channel 2 is `b`, not a name and its unit, such as `T1.GenPwr_kW`",
            ),
            ("", "line 1: channel 1 is ``"),
        ];
        for (text, expected) in cases {
            fs::write(&path, text).unwrap();
            let error = read_series(&path, |_| true).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn wanted_columns_are_those_of_the_whole_and_the_rest_is_known_unread() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        let channels = [TIME, GEN_PWR.of("T1"), BLD_PITCH.of_blade(1).of("T1")];
        let mut writer = SeriesWriter::create(&path, &channels).unwrap();
        for time in (0..50).map(f64::from) {
            writer.write(&[time, 5e6 * time.sin(), 1e-9 * time.cos()]).unwrap();
        }
        writer.finish().unwrap();
        let file = SeriesFile::open(&path).unwrap();
        assert_eq!((file.names().len(), file.n_rows()), (3, 50));
        assert_eq!(file.units(), [Unit::Second, Unit::Kilowatt, Unit::Degree]);
        let whole = file.read(|_| true).unwrap();
        let some = file.read(|name| name != "T1.GenPwr").unwrap();
        assert_eq!(some.names, ["Time", "T1.BldPitch1"]);
        assert_eq!(some.columns, [whole.columns[0].clone(), whole.columns[2].clone()]);
        assert_eq!(file.read(|_| false).unwrap(), Series::default());
        // Memory is asked for once: what was counted is what came.
        assert!(whole.columns.iter().all(|column| column.capacity() == 50));
    }

    /// The same name may stand for another unit there, so that nothing of it is read.
    #[test]
    fn a_series_of_an_earlier_program_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        fs::write(&path, "time_s,wind.u_m_s,T1.power_w\n0.1,9,2e6\n").unwrap();
        let error = read_series(&path, |_| true).unwrap_err();
        let said = error.to_string();
        assert!(said.contains("series.csv") && said.contains("`T1.power_w`"), "{said}");
        let help = miette::Diagnostic::help(&error).unwrap().to_string();
        assert!(help.contains("make the run again"), "{help}");
    }

    #[test]
    fn rows_are_counted_to_the_end_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        for (text, expected) in [("a_m,b_s", 0), ("a_m,b_s\n", 0), ("a_m,b_s\n1,2\n3,4", 2)] {
            fs::write(&path, text).unwrap();
            let file = SeriesFile::open(&path).unwrap();
            assert_eq!(file.n_rows(), expected, "{text}");
            assert_eq!(file.read(|_| true).unwrap().columns[0].len(), expected, "{text}");
        }
    }

    #[test]
    fn a_number_that_nobody_wants_is_skipped_but_a_short_row_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        fs::write(&path, "a_m,b_s\n1,two\n").unwrap();
        let first = |name: &str| name == "a";
        assert_eq!(read_series(&path, first).unwrap().columns, [[1.0]]);
        fs::write(&path, "a_m,b_s\n1\n").unwrap();
        let error = read_series(&path, first).unwrap_err().to_string();
        assert!(error.contains("line 2: 1 values, the header has 2"), "{error}");
    }

    proptest! {
        #[test]
        fn no_bytes_make_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("series.csv");
            fs::write(&path, bytes).unwrap();
            let _ = read_series(&path, |_| true);
        }
    }
}
