//! What a sweep leaves beside its studies: `sweep.json`, which tells what is swept, and `table.json` and
//! `table.csv` with what came of it.

use super::{read_layout, write_json};
use crate::{FileError, atomic};
use basis::records::{SWEEP_SCHEMA_VERSION, Statistic, Sweep, SweepTable};
use std::path::{Path, PathBuf};

const WHAT: &str = "what is swept";
const TABLE: &str = "the table of a sweep";

/// `sweep.json` in the folder `folder` of a sweep.
pub fn sweep_path(folder: &Path) -> PathBuf {
    folder.join("sweep.json")
}

/// Reads what is swept in the folder `folder`; none where that is no sweep.
///
/// # Errors
/// [`FileError::System`], and [`FileError::Content`] when it is something else or of another version of the
/// layout.
pub fn read_sweep(folder: &Path) -> Result<Option<Sweep>, FileError> {
    let path = sweep_path(folder);
    if path.is_file() { read_layout(&path, WHAT, SWEEP_SCHEMA_VERSION).map(Some) } else { Ok(None) }
}

/// Writes what is swept into `folder`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_sweep(folder: &Path, sweep: &Sweep) -> Result<(), FileError> {
    atomic::create_folder(folder)?;
    write_json(&sweep_path(folder), WHAT, sweep)
}

/// Takes away what tells of an earlier sweep in `folder`, where there was one.
///
/// # Errors
/// [`FileError::System`].
pub fn remove_sweep(folder: &Path) -> Result<(), FileError> {
    if !sweep_path(folder).is_file() {
        return Ok(());
    }
    let files = [sweep_path(folder), folder.join("table.json"), folder.join("table.csv")];
    files.iter().try_for_each(|file| super::gone(std::fs::remove_file(file), file))
}

/// Writes `table` into `folder`: `table.json`, and `table.csv` with a line for each row and turbine.
///
/// # Errors
/// [`FileError::System`].
pub fn write_table(folder: &Path, table: &SweepTable) -> Result<(), FileError> {
    write_json(&folder.join("table.json"), TABLE, table)?;
    atomic::write(&folder.join("table.csv"), TABLE, csv(table).as_bytes())
}

/// Powers in W, gains as ratios; empty where there is none.
fn csv(table: &SweepTable) -> String {
    let mut text = String::from("run,compare_with");
    for key in &table.keys {
        text += &format!(",{}", key.key);
    }
    text += ",turbine,n_winds,power_w,power_half_width_95_w,gain,gain_half_width_95\n";
    for row in &table.rows {
        for part in &row.parts {
            let of = |statistic: Option<&Statistic>| {
                let half = statistic.and_then(|statistic| statistic.half_width_95);
                let mean = statistic.map_or(String::new(), |s| format!("{:?}", s.mean));
                format!("{mean},{}", half.map_or(String::new(), |half| format!("{half:?}")))
            };
            text += &format!("{},{}", row.run, row.compare_with.as_deref().unwrap_or_default());
            for key in &table.keys {
                let value = row.value(&key.key).map(|value| value.words()).unwrap_or_default();
                text += &format!(",{}", quoted(&value));
            }
            let (power, gain) = (of(Some(&part.power)), of(part.gain.as_ref()));
            text += &format!(",{},{},{power},{gain}\n", part.name, row.seeds.len().max(1));
        }
    }
    text
}

/// `value` as a field of CSV.
fn quoted(value: &str) -> String {
    if value.contains([',', '"', '\n']) {
        format!("\"{}\"", value.replace('"', "\"\""))
    } else {
        value.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::{Setting, SweptStudy, SweptValue};

    #[test]
    fn what_is_swept_comes_back_as_it_was() {
        let values = [
            SweptValue::Whole(3),
            SweptValue::Number(0.25),
            SweptValue::Number(3.0),
            SweptValue::Text("ccw".into()),
            SweptValue::Numbers(vec![5.0, -0.5]),
        ];
        let study = |value: SweptValue| SweptStudy {
            folder: value.words(),
            settings: vec![Setting { key: "a".into(), value }],
        };
        let sweep = Sweep {
            schema_version: SWEEP_SCHEMA_VERSION,
            case: "case".into(),
            keys: Vec::new(),
            studies: values.map(study).to_vec(),
            runs: Vec::new(),
        };
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(read_sweep(folder.path()).unwrap(), None);
        write_sweep(folder.path(), &sweep).unwrap();
        assert_eq!(read_sweep(folder.path()).unwrap(), Some(sweep.clone()));
        write_sweep(folder.path(), &Sweep { schema_version: 1, ..sweep }).unwrap();
        let told = read_sweep(folder.path()).unwrap_err().to_string();
        assert!(told.contains("sweep.json") && told.contains("an earlier wakemix"), "{told}");
    }

    #[test]
    fn a_field_with_a_comma_is_quoted() {
        assert_eq!(quoted("a,b"), "\"a,b\"");
        assert_eq!(quoted("0.25"), "0.25");
    }
}
