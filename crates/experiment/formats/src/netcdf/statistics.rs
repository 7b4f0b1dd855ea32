//! Statistics over time and height in a NetCDF file, for xarray, Panoply and the like.

use super::read::variable;
use super::{text, unwritable};
use crate::{FileError, atomic};
use netcdf_reader::NcFile;
use netcdf_writer::{DimensionId, Error, NcFileBuilder, NcWriteOptions};
use std::path::Path;

const WHAT: &str = "statistics over time and height (NetCDF)";
const FIX: &str = "restore the file, or make the precursor again";

/// Values of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Column<'a> {
    /// Name in the file.
    pub name: &'a str,
    /// Unit as CF writes it, such as `m s-1`.
    pub unit: &'a str,
    /// What it is.
    pub meaning: &'a str,
    /// The values: one for each time, or for each time and height, heights fastest.
    pub values: &'a [f64],
}

/// Statistics over time, and over time and height.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeHeight<'a> {
    /// What they are of, in words.
    pub title: &'a str,
    /// Times (s).
    pub times: &'a [f64],
    /// Heights (m).
    pub heights: &'a [f64],
    /// What has one value for each time.
    pub series: Vec<Column<'a>>,
    /// What has one for each time and height.
    pub profiles: Vec<Column<'a>>,
}

/// Statistics as a file holds them.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredStatistics {
    /// Times (s).
    pub times: Vec<f64>,
    /// Heights (m).
    pub heights: Vec<f64>,
    /// Names with their values: one for each time, or for each time and height, heights fastest.
    columns: Vec<(String, Vec<f64>)>,
}

impl StoredStatistics {
    /// Values of the column called `name`: one for each time, or for each time and height, heights fastest;
    /// empty where there is none.
    pub fn column(&self, name: &str) -> &[f64] {
        let column = self.columns.iter().find(|(other, _)| other == name);
        column.map_or(&[], |(_, values)| values)
    }
}

/// Reads the columns called `series`, over time, and `profiles`, over time and height, out of `path`.
///
/// # Errors
/// [`FileError::System`] when it cannot be read, [`FileError::Content`] when it is something else.
pub fn read_statistics(
    path: &Path,
    series: &[&str],
    profiles: &[&str],
) -> Result<StoredStatistics, FileError> {
    let bytes = atomic::read_bytes(path, WHAT)?;
    decode(&bytes, series, profiles).map_err(|problem| FileError::content(WHAT, path, problem, FIX))
}

/// The columns called `series` and `profiles` in `bytes`.
pub(crate) fn decode(
    bytes: &[u8],
    series: &[&str],
    profiles: &[&str],
) -> Result<StoredStatistics, String> {
    let most = bytes.len();
    let file = NcFile::from_bytes(bytes).map_err(|error| error.to_string())?;
    let (times, heights) = (variable(&file, "time", most)?, variable(&file, "z", most)?);
    let mut columns = Vec::new();
    for (names, n_each) in [(series, 1), (profiles, heights.len())] {
        for name in names {
            let values = variable(&file, name, most)?;
            if Some(values.len()) != times.len().checked_mul(n_each) {
                return Err(format!("`{name}` holds {} values", values.len()));
            }
            columns.push(((*name).to_owned(), values));
        }
    }
    Ok(StoredStatistics { times, heights, columns })
}

/// Writes `statistics` to `path`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_statistics(path: &Path, statistics: &TimeHeight) -> Result<(), FileError> {
    let encoded = encode(statistics).map_err(|error| unwritable(path, error))?;
    atomic::write(path, WHAT, &encoded)
}

fn encode(statistics: &TimeHeight) -> Result<Vec<u8>, Error> {
    let TimeHeight { title, times, heights, series, profiles } = statistics;
    let mut file = NcFileBuilder::new();
    file.add_attribute("Conventions", text("CF-1.8"))?;
    file.add_attribute("title", text(title))?;
    file.add_attribute("source", text(concat!("wakemix ", env!("CARGO_PKG_VERSION"))))?;
    let time = file.add_dimension("time", times.len() as u64)?;
    let height = file.add_dimension("z", heights.len() as u64)?;
    let column = |name, unit, meaning, values| Column { name, unit, meaning, values };
    add(&mut file, &[time], &column("time", "s", "time since the start", times))?;
    add(&mut file, &[height], &column("z", "m", "height above the ground", heights))?;
    for column in series {
        add(&mut file, &[time], column)?;
    }
    for column in profiles {
        add(&mut file, &[time, height], column)?;
    }
    Ok(file.to_vec(NcWriteOptions::default())?.1)
}

fn add(file: &mut NcFileBuilder, over: &[DimensionId], column: &Column) -> Result<(), Error> {
    let variable = file.add_variable::<f64>(column.name, over)?;
    file.add_variable_attribute(variable, "units", text(column.unit))?;
    file.add_variable_attribute(variable, "long_name", text(column.meaning))?;
    file.write_variable(variable, column.values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use netcdf_reader::NcFile;

    #[test]
    fn times_and_heights_come_back_in_their_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("statistics.nc");
        let series = [0.25, 0.26];
        let profile = [5.0, 6.0, 7.0, 5.5, 6.5, 7.5];
        let column = |name, values| Column { name, unit: "m s-1", meaning: "a speed", values };
        let statistics = TimeHeight {
            title: "a box",
            times: &[0.0, 60.0],
            heights: &[10.0, 30.0, 50.0],
            series: vec![column("friction_velocity", &series)],
            profiles: vec![column("speed", &profile)],
        };
        write_statistics(&path, &statistics).unwrap();
        let file = NcFile::open(&path).unwrap();
        let read = |name: &str| -> Vec<f64> {
            file.read_variable::<f64>(name).unwrap().iter().copied().collect()
        };
        assert_eq!((read("time"), read("z")), (vec![0.0, 60.0], vec![10.0, 30.0, 50.0]));
        assert_eq!((read("friction_velocity"), read("speed")), (series.to_vec(), profile.to_vec()));
        let stored = read_statistics(&path, &["friction_velocity"], &["speed"]).unwrap();
        assert_eq!(
            (&stored.times[..], &stored.heights[..]),
            (&[0.0, 60.0][..], statistics.heights)
        );
        assert_eq!(stored.column("friction_velocity"), series);
        assert_eq!((stored.column("speed"), stored.column("other")), (&profile[..], &[][..]));
        let lacking = read_statistics(&path, &["speed"], &[]).unwrap_err().to_string();
        assert!(lacking.contains("`speed` holds 6 values"), "{lacking}");
        let lacking = read_statistics(&path, &["depth"], &[]).unwrap_err().to_string();
        assert!(lacking.contains("it lacks `depth`"), "{lacking}");
        let speed = file.variable("speed").unwrap();
        assert_eq!(speed.shape(), [2, 3]);
    }
}
