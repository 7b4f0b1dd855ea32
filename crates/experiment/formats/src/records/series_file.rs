//! The series of a run read back: whole, or no more of it than is wanted.

use super::series::{BUFFER, WHAT};
use crate::{FileError, atomic};
use basis::records::Series;
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};

/// A series on the disk: its channels and its length are known, its numbers are read as they are wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeriesFile {
    path: PathBuf,
    names: Vec<String>,
    n_rows: usize,
    n_bytes: usize,
}

impl SeriesFile {
    /// Looks at the series at `path`: reads its channels, counts its rows and holds none.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Content`] when its first line is not text.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let failed = |source| refused_reading(path, source);
        let (mut reader, header) = started(path)?;
        let names = header.trim_end().split(',').map(str::to_owned).collect();
        let (mut n_rows, mut n_bytes) = (0, header.len());
        loop {
            let n_skipped = reader.skip_until(b'\n').map_err(failed)?;
            if n_skipped == 0 {
                break;
            }
            n_rows += 1;
            n_bytes += n_skipped;
        }
        Ok(Self { path: path.to_owned(), names, n_rows, n_bytes })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Names of its channels, in the order of its columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Rows of numbers in it (–).
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// The channels for which `wanted` holds, in the order of the file, in one pass over it; the numbers of
    /// others are skipped unread.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Content`] with line and column when it is
    /// something else.
    pub fn read(&self, wanted: impl Fn(&str) -> bool) -> Result<Series, FileError> {
        let Self { path, names, .. } = self;
        let failed = |source| refused_reading(path, source);
        let (mut reader, mut line) = started(path)?;
        let mut series = Series::default();
        let mut places = Vec::with_capacity(names.len());
        for name in names {
            let place = wanted(name).then_some(series.names.len());
            places.push(place);
            if place.is_some() {
                series.names.push(name.clone());
                series.columns.push(Vec::with_capacity(self.most_rows()));
            }
        }
        for number in 2.. {
            line.clear();
            if reader.read_line(&mut line).map_err(failed)? == 0 {
                break;
            }
            let refusal = |problem: String| {
                let fix = "restore the file, or make the run again";
                FileError::content(WHAT, path, format!("line {number}: {problem}"), fix)
            };
            let mut n_values = 0;
            for (index, value) in line.trim_end().split(',').enumerate() {
                let place = places.get(index);
                let place =
                    place.ok_or_else(|| refusal(format!("more than {} values", names.len())))?;
                n_values = index + 1;
                let Some(place) = *place else { continue };
                let name = || &names[index];
                let value = value.parse().map_err(|_| {
                    refusal(format!("`{value}` in column {} is not a number", name()))
                })?;
                series.columns[place].push(value);
            }
            if n_values != names.len() {
                return Err(refusal(format!("{n_values} values, the header has {}", names.len())));
            }
        }
        Ok(series)
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
    use proptest::prelude::*;
    use std::fs;

    #[test]
    fn a_broken_row_is_reported_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        let cases = [
            ("a,b\n1,2\n3\n", "line 3: 1 values, the header has 2"),
            ("a,b\n1,2,3\n", "line 2: more than 2 values"),
            ("a,b\n1,two\n", "line 2: `two` in column b is not a number"),
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
        let names = ["time_s", "T1.power_w", "T1.pitch_1_rad"].map(str::to_owned);
        let mut writer = SeriesWriter::create(&path, &names).unwrap();
        for time in (0..50).map(f64::from) {
            writer.write(&[time, 5e6 * time.sin(), 1e-9 * time.cos()]).unwrap();
        }
        writer.finish().unwrap();
        let file = SeriesFile::open(&path).unwrap();
        assert_eq!((file.names(), file.n_rows()), (&names[..], 50));
        let whole = file.read(|_| true).unwrap();
        let some = file.read(|name| name != "T1.power_w").unwrap();
        assert_eq!(some.names, ["time_s", "T1.pitch_1_rad"]);
        assert_eq!(some.columns, [whole.columns[0].clone(), whole.columns[2].clone()]);
        assert_eq!(file.read(|_| false).unwrap(), Series::default());
        // Memory is asked for once: what was counted is what came.
        assert!(whole.columns.iter().all(|column| column.capacity() == 50));
    }

    #[test]
    fn rows_are_counted_to_the_end_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        for (text, expected) in [("", 0), ("a,b", 0), ("a,b\n", 0), ("a,b\n1,2\n3,4", 2)] {
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
        fs::write(&path, "a,b\n1,two\n").unwrap();
        let first = |name: &str| name == "a";
        assert_eq!(read_series(&path, first).unwrap().columns, [[1.0]]);
        fs::write(&path, "a,b\n1\n").unwrap();
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
