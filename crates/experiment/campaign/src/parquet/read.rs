//! Columns of numbers out of Parquet, of any program's: what surrogates are trained on.

use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::data_type::DataType;
use ::parquet::errors::{ParquetError, Result};
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use formats::FileError;
use formats::table::{Column, OtherTable};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// What such a file holds, in words.
const WHAT: &str = "a table of samples";

/// How tables in Parquet are read.
pub(crate) static PARQUET: OtherTable = OtherTable { columns, values };

fn refused(path: &Path, problem: impl ToString) -> FileError {
    let fix =
        "write it again with `wakemix campaign collect`, or as Parquet with Snappy, or as CSV";
    FileError::content(WHAT, path, problem.to_string(), fix)
}

fn opened(path: &Path) -> std::result::Result<SerializedFileReader<File>, FileError> {
    let file = File::open(path).map_err(|source| FileError::system("read", WHAT, path, source))?;
    SerializedFileReader::new(file).map_err(|error| refused(path, error))
}

/// Names of all columns of the file at `path`, and their units from its metadata `units`.
fn columns(path: &Path) -> std::result::Result<Vec<Column>, FileError> {
    let file = opened(path)?;
    let metadata = file.metadata().file_metadata();
    let pairs = metadata.key_value_metadata().into_iter().flatten();
    let told = pairs.filter(|pair| pair.key == "units").find_map(|pair| pair.value.as_deref());
    // Files of other programs have none, or something else of that name.
    let units: BTreeMap<String, String> =
        told.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default();
    let column = |name: &str| Column {
        name: name.to_owned(),
        unit: units.get(name).cloned().unwrap_or_default(),
    };
    Ok(metadata.schema_descr().columns().iter().map(|found| column(found.name())).collect())
}

/// Values of column number `index` of the file at `path`, a row each; none where a row has none.
fn values(path: &Path, index: usize) -> std::result::Result<Vec<Option<f64>>, FileError> {
    let file = opened(path)?;
    let descriptor = file.metadata().file_metadata().schema_descr().column(index);
    let not_numbers = || {
        let problem = format!("column {} holds no plain numbers", descriptor.name());
        FileError::content(WHAT, path, problem, "name another column")
    };
    if descriptor.max_rep_level() > 0 {
        return Err(not_numbers());
    }
    let level = descriptor.max_def_level();
    let mut all = Vec::new();
    for group in 0..file.num_row_groups() {
        let read = file.get_row_group(group).and_then(|group| group.get_column_reader(index));
        let read = match read.map_err(|error| refused(path, error))? {
            ColumnReader::Int32ColumnReader(reader) => read_all(reader, level, f64::from, &mut all),
            ColumnReader::Int64ColumnReader(reader) => {
                read_all(reader, level, |value| value as f64, &mut all)
            }
            ColumnReader::FloatColumnReader(reader) => read_all(reader, level, f64::from, &mut all),
            ColumnReader::DoubleColumnReader(reader) => {
                read_all(reader, level, |value| value, &mut all)
            }
            _ => return Err(not_numbers()),
        };
        read.map_err(|error| refused(path, error))?;
    }
    Ok(all)
}

/// Appends all values of `reader` to `all`; those whose definition is below `level` are none.
fn read_all<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    level: i16,
    number: impl Fn(T::T) -> f64,
    all: &mut Vec<Option<f64>>,
) -> Result<()>
where
    T::T: Copy,
{
    const AT_A_TIME: usize = 8192;
    loop {
        let (mut values, mut levels) = (Vec::new(), Vec::new());
        let told = (level > 0).then_some(&mut levels);
        let (n_rows, ..) = reader.read_records(AT_A_TIME, told, None, &mut values)?;
        if n_rows == 0 {
            return Ok(());
        }
        let mut there = values.into_iter();
        for row in 0..n_rows {
            let is_there = level == 0 || levels.get(row) == Some(&level);
            let value = if is_there { there.next() } else { None };
            if is_there && value.is_none() {
                return Err(ParquetError::General("a column ends before its rows do".to_owned()));
            }
            all.push(value.map(&number));
        }
    }
}
