//! The recorded wind of a case, and the atmosphere of the precursor that it may come from.

use crate::StudyError;
use crate::precursor::memory;
use farm::Plan;
use farm::case::Case;
use farm::wind::Surroundings;
use flow::inflow::{ColumnLevel, CutError, CutPlanes, InflowError, PlaneGrid, Planes};
use formats::case::{CaseFile, PrecursorFile, objection, parse_precursor};
use formats::netcdf::{TemperatureReader, read_statistics};
use formats::records::PrecursorFolder;
use formats::{FileError, atomic, turbulence_box};
use std::error::Error;
use std::path::{Path, PathBuf};

const WHAT: &str = "the precursor";
const AGAIN: &str = "make the precursor again with `wakemix inflow precursor CASE --overwrite`";
/// What drove the box over time, in its statistics.
const GEOSTROPHIC: [&str; 2] = ["geostrophic_speed", "geostrophic_direction"];

/// Planes of wind with their temperature.
struct WarmPlanes {
    wind: Box<dyn Planes>,
    temperature: TemperatureReader,
}

impl Planes for WarmPlanes {
    fn grid(&self) -> PlaneGrid {
        self.wind.grid()
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        self.wind.read(step, values)
    }

    fn read_temperature(&mut self, step: usize, values: &mut [f32]) -> Result<bool, InflowError> {
        self.temperature.read(step, values)?;
        Ok(true)
    }
}

/// The folder of the precursor of `case`, whose paths are relative to `folder`; none where it names none.
pub(crate) fn folder_of(case: &Case, folder: &Path) -> Option<PrecursorFolder> {
    Some(PrecursorFolder::new(&folder.join(case.wind.precursor.as_ref()?)))
}

/// Paths of the files of recorded wind that `case` reads, relative to `folder`; none where it reads none.
///
/// # Errors
/// [`FileError`] for a name that is none of such a file, and for a header that cannot be read.
pub(crate) fn files(case: &Case, folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    if let Some(of) = folder_of(case, folder) {
        let wind = match case.wind.precursor_beside {
            true => vec![of.checkpoint_path()],
            false => vec![of.planes_path(), of.temperature_path(), of.statistics_path()],
        };
        return Ok([wind, vec![of.case_path(), of.result_path()]].concat());
    }
    let Some(name) = &case.wind.planes else { return Ok(Vec::new()) };
    turbulence_box::files(&folder.join(name))
}

/// The recorded planes that `case` names, relative to `folder`, opened.
///
/// # Errors
/// [`FileError`] when they cannot be read.
pub(crate) fn open_planes(case: &Case, folder: &Path) -> Result<Box<dyn Planes>, FileError> {
    let Some(of) = folder_of(case, folder) else {
        let name = case.wind.planes.as_deref().unwrap_or_default();
        return turbulence_box::open(&folder.join(name));
    };
    check_complete(&of)?;
    let wind = turbulence_box::open(&of.planes_path())?;
    let temperature = TemperatureReader::open(&of.temperature_path(), &wind.grid())?;
    Ok(Box::new(WarmPlanes { wind, temperature }))
}

/// What `case`, laid out as `plan`, takes of its recorded `planes`.
///
/// # Errors
/// [`CutError`] where they do not hold it.
pub(crate) fn cut(
    case: &Case,
    plan: &Plan,
    planes: Box<dyn Planes>,
) -> Result<Box<dyn Planes>, CutError> {
    Ok(match &case.wind.cut {
        None => planes,
        Some(cut) => Box::new(CutPlanes::new(planes, cut, plan.hub_height)?),
    })
}

/// Whether the precursor in `folder` is there, and complete.
fn check_complete(folder: &PrecursorFolder) -> Result<(), FileError> {
    if folder.is_complete() {
        return Ok(());
    }
    let (problem, fix) = if folder.holds_results() {
        ("it is not complete", "finish it: wakemix inflow precursor CASE --resume")
    } else {
        ("there is none", "make it: wakemix inflow precursor CASE, or name its folder")
    };
    Err(FileError::content(WHAT, folder.path(), problem, fix))
}

/// Whether the precursor in `folder` has kept what it goes on from.
fn check_goes_on(folder: &PrecursorFolder) -> Result<(), FileError> {
    check_complete(folder)?;
    let path = folder.checkpoint_path();
    if path.is_file() {
        return Ok(());
    }
    let problem = "it goes on from its checkpoint, which is gone";
    Err(FileError::content(
        WHAT,
        &path,
        problem,
        "make it again, or take wind.precursor_wind = \"planes\"",
    ))
}

/// The atmosphere of the precursor of the case of `file`, laid out as `plan`; none where it names none.
///
/// # Errors
/// [`StudyError::Case`] at the key with which it does not fit, or at `wind.precursor`.
pub(crate) fn surroundings(
    file: &CaseFile,
    plan: &Plan,
) -> Result<Option<Surroundings>, StudyError> {
    let refuse = |key: &[&str], message| StudyError::Case(objection(file, key, message));
    let Some(folder) = folder_of(&file.case, file.folder()) else { return Ok(None) };
    let read = match file.case.wind.precursor_beside {
        true => check_goes_on(&folder).and_then(|()| read(&folder, true)),
        false => read(&folder, false),
    };
    let found = read.map_err(|error| refuse(&["wind", "precursor"], unreadable(&error)))?;
    let fits = found.check(&file.case, plan);
    fits.map_err(|error| refuse(&error.key(), error.to_string()))?;
    Ok(Some(found))
}

/// Memory (bytes) that the precursor of `case`, whose paths are relative to `folder`, takes beside each run;
/// 0 where it does not go on.
///
/// # Errors
/// [`FileError`] when its file cannot be read.
pub(crate) fn memory_beside(case: &Case, folder: &Path) -> Result<u64, FileError> {
    let Some(folder) = folder_of(case, folder).filter(|_| case.wind.precursor_beside) else {
        return Ok(0);
    };
    let precursor = precursor_of(&folder)?.precursor;
    Ok(memory(&precursor, &precursor.plan()))
}

/// The file of the precursor in `folder`, as it was run.
pub(crate) fn precursor_of(folder: &PrecursorFolder) -> Result<PrecursorFile, FileError> {
    let path = folder.case_path();
    let text = atomic::read_text(&path, "the precursor's file")?;
    parse_precursor(&path, &text, &[])
        .map_err(|error| FileError::content(WHAT, &path, error.to_string(), AGAIN))
}

/// The atmosphere that the precursor in `folder` has left: as it was while its planes were recorded, or where
/// it `goes_on`, with the ground's heat and what drives it as they are at the end.
fn read(folder: &PrecursorFolder, goes_on: bool) -> Result<Surroundings, FileError> {
    check_complete(folder)?;
    let precursor = precursor_of(folder)?.precursor;
    let (plan, result) = (precursor.plan(), folder.read_result()?);
    let end = [result.geostrophic_speed, result.geostrophic_direction_deg];
    let (begin, driving) = match goes_on {
        true => (plan.time(plan.n_steps), end),
        false => {
            let begin = plan.time(plan.first_plane);
            (begin, geostrophic(folder, begin)?.unwrap_or(end))
        }
    };
    let along = |wind| turned(wind, result.planes.direction_deg);
    let levels = result.profile.iter().map(|row| ColumnLevel {
        height: row.height,
        wind: along([row.speed, row.direction_deg]),
        temperature: row.temperature,
    });
    let found = precursor.surroundings(begin, levels.collect(), along(driving));
    found.ok_or_else(|| {
        let problem = "its record holds no means over height".to_owned();
        FileError::content(WHAT, &folder.result_path(), problem, AGAIN)
    })
}

/// Wind of a speed (m/s) that comes from a direction (deg), along x and y (m/s) of planes whose x blows from
/// `from` (deg).
fn turned([speed, direction]: [f64; 2], from: f64) -> [f64; 2] {
    // Directions grow clockwise, y is to the left.
    let (s, c) = (from - direction).to_radians().sin_cos();
    [speed * c, speed * s]
}

/// Mean speed of the geostrophic wind (m/s) from `begin` (s) on, when planes were recorded, and where it came
/// from (deg); none of a record shorter than the time between two statistics.
fn geostrophic(folder: &PrecursorFolder, begin: f64) -> Result<Option<[f64; 2]>, FileError> {
    let path = folder.statistics_path();
    let statistics = read_statistics(&path, &GEOSTROPHIC, &[])?;
    let [speeds, directions] = GEOSTROPHIC.map(|name| statistics.column(name));
    let (mut sum, mut n) = ([0.0; 2], 0);
    for ((time, speed), direction) in statistics.times.iter().zip(speeds).zip(directions) {
        if *time > begin - 1e-6 {
            let (s, c) = direction.to_radians().sin_cos();
            sum = [sum[0] + speed * s, sum[1] + speed * c];
            n += 1;
        }
    }
    let [east, north] = sum.map(|sum| sum / f64::from(n));
    Ok((n > 0).then(|| [east.hypot(north), east.atan2(north).to_degrees()]))
}

/// Why wind cannot be read, with the cause.
pub(crate) fn unreadable(error: &dyn Error) -> String {
    let mut message = format!("the wind cannot be read: {error}");
    if let Some(cause) = error.source() {
        message += &format!(": {cause}");
    }
    message
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wind_that_veers_clockwise_blows_to_the_right_of_the_planes() {
        let speed = 8.0;
        for (direction, expected) in [(240.0, [8.0, 0.0]), (270.0, [6.9282, -4.0])] {
            let found = turned([speed, direction], 240.0);
            assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-4), "{found:?}");
        }
    }
}
