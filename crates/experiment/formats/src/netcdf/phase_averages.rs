//! Averages by phase, bin by bin, in one file that is read without holding all of it.

use super::COMPONENTS;
use super::grid::{grid_of, shape_of};
use super::read::{lacks, variable};
use crate::{FileError, atomic};
use basis::records::{FieldSetting, Moments, PhaseAverages, PhaseBin};
use netcdf_reader::{NcFile, NcReadable, NcSliceInfo, NcSliceInfoElem};
use std::path::{Path, PathBuf};

pub(super) const WHAT: &str = "velocity averaged by phase (NetCDF)";
const FIX: &str = "restore the file, or average again with `wakemix analyse phases`";
/// Names of the stresses, as [`basis::records::STRESSES`] orders them.
pub(super) const STRESS_NAMES: [&str; 6] = ["uu", "vv", "ww", "uv", "uw", "vw"];
pub(super) const SAMPLES: &str = "n_samples";
pub(super) const PRESSURE: &str = "all_pressure";
/// Bytes of a bin beside its points.
pub(super) const BIN_BYTES: usize = 2 * size_of::<f64>() + 2 * size_of::<i32>();
/// Bytes of a point in a bin, and of a point over all.
pub(super) const POINT_BYTES: usize = size_of::<i32>() + 9 * size_of::<f32>();
/// Bytes of a file beside all of these.
const HEADER_BYTES: u64 = 8 << 10;

/// Bytes that averages by phase of `n_points` in `n_bins` take on the disk, pressure included.
pub fn phase_averages_bytes(n_points: u64, n_bins: u64) -> u64 {
    let pressure = n_points * size_of::<f32>() as u64;
    HEADER_BYTES + pressure + (n_bins + 1) * (n_points * POINT_BYTES as u64 + BIN_BYTES as u64)
}

/// Averages by phase in a file, whose bins are read one by one.
pub struct StoredPhaseAverages {
    path: PathBuf,
    file: NcFile,
    /// What they were taken of.
    pub setting: FieldSetting,
    /// All but the bins' own moments: of these there are none.
    pub head: PhaseAverages,
}

impl StoredPhaseAverages {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// [`FileError::System`] when it cannot be read, [`FileError::Content`] when it is something else.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let unreadable = |error| FileError::system("read", WHAT, path, error);
        // Asked before the library opens it: what is no file is refused here.
        let length = atomic::open(path).and_then(|file| file.metadata()).map_err(unreadable)?.len();
        let most = usize::try_from(length).unwrap_or(usize::MAX);
        let file = NcFile::open(path).map_err(|error| error.to_string());
        let read = file.and_then(|file| decode(&file, most).map(|(s, h)| (file, s, h)));
        let content = |problem| FileError::content(WHAT, path, problem, FIX);
        let (file, setting, head) = read.map_err(content)?;
        Ok(Self { path: path.to_owned(), file, setting, head })
    }

    /// Reads bin number `index`.
    ///
    /// # Errors
    /// [`FileError::Content`] when the file does not hold it.
    pub fn bin(&self, index: usize) -> Result<Moments, FileError> {
        let n_points = self.head.grid.len();
        let over = |name: &str| {
            let whole = NcSliceInfoElem::Slice { start: 0, end: u64::MAX, step: 1 };
            let selections =
                vec![NcSliceInfoElem::Index(index as u64), whole.clone(), whole.clone(), whole];
            (name.to_owned(), Some(NcSliceInfo { selections }))
        };
        moments(&self.file, n_points, over)
            .map_err(|problem| FileError::content(WHAT, &self.path, problem, FIX))
    }

    /// Reads all bins.
    ///
    /// # Errors
    /// Those of [`StoredPhaseAverages::bin`].
    pub fn averages(&self) -> Result<PhaseAverages, FileError> {
        let each = (0..self.head.bins.len()).map(|index| self.bin(index));
        Ok(PhaseAverages { each: each.collect::<Result<_, _>>()?, ..self.head.clone() })
    }
}

/// Whether `path` looks like a file of averages by phase.
pub fn is_phase_averages(path: &Path) -> bool {
    let file = atomic::open(path).ok().and_then(|_| NcFile::open(path).ok());
    file.is_some_and(|file| file.dimension("bin").is_ok() && file.variable(SAMPLES).is_ok())
}

/// What was averaged, and all but the bins' moments.
fn decode(file: &NcFile, most: usize) -> Result<(FieldSetting, PhaseAverages), String> {
    let found = |name: &str| file.global_attribute(name).ok().map(|found| found.value.clone());
    let list = |name: &str| found(name)?.as_f64_vec();
    let number = |name: &str| list(name)?.first().copied();
    let positive = |name: &str| {
        let value = number(name).filter(|value| value.is_finite() && *value > 0.0);
        value.ok_or_else(|| format!("its attribute `{name}` is no number above 0"))
    };
    let some = |name: &str, n: usize| {
        let values = list(name).filter(|values| values.iter().all(|value| value.is_finite()));
        let values = values.filter(|values| values.len() == n);
        values.ok_or_else(|| format!("its attribute `{name}` does not hold {n} numbers"))
    };
    let (hub, span) = (some("hub_m", 3)?, some("time_span_s", 2)?);
    let setting = FieldSetting {
        name: found("name").and_then(|name| name.as_string()).ok_or_else(|| lacks("name"))?,
        wind_speed: positive("wind_speed_m_s")?,
        turbulence_intensity: number("turbulence_intensity").filter(|value| value.is_finite()),
        diameter: positive("rotor_diameter_m")?,
        hub: [hub[0], hub[1], hub[2]],
    };
    let grid = grid_of(file, ["x", "y", "z"], most)?;
    let [rotor, helix, n_instants, n_visits] =
        ["rotor_azimuth", "helix_azimuth", "n_instants", "n_visits"];
    let (rotor, helix) = (variable(file, rotor, most)?, variable(file, helix, most)?);
    let (n_instants, n_visits) = (counts(file, n_instants, most)?, counts(file, n_visits, most)?);
    if [helix.len(), n_instants.len(), n_visits.len()].iter().any(|n| *n != rotor.len()) {
        return Err("its bins are not of one number".to_owned());
    }
    if rotor.iter().any(|azimuth| !azimuth.is_finite()) {
        return Err("a `rotor_azimuth` is no number".to_owned());
    }
    let bin = |index: usize| PhaseBin {
        rotor: rotor[index],
        helix: Some(helix[index]).filter(|azimuth| azimuth.is_finite()),
        n_instants: n_instants[index],
        n_visits: n_visits[index],
    };
    let [n_x, n_y, n_z] = grid.n_points;
    if shape_of(file, SAMPLES)? != [rotor.len(), n_z, n_y, n_x] {
        return Err(format!("`{SAMPLES}` is not of its bins and points"));
    }
    let pressure = match file.variable(PRESSURE) {
        Ok(_) => Some(read::<f32>(file, PRESSURE, None, grid.len())?),
        Err(_) => None,
    };
    let head = PhaseAverages {
        grid,
        rotor_width: positive("rotor_bin_width_rad")?,
        helix_width: number("helix_bin_width_rad").filter(|width| width.is_finite()),
        span: [span[0], span[1]],
        bins: (0..rotor.len()).map(bin).collect(),
        all: moments(file, grid.len(), |name| (format!("all_{name}"), None))?,
        pressure,
        each: Vec::new(),
    };
    Ok((setting, head))
}

/// The counts in the variable `name` of a file of `most` bytes.
fn counts(file: &NcFile, name: &str, most: usize) -> Result<Vec<u64>, String> {
    let n = shape_of(file, name)?.into_iter().try_fold(1_usize, usize::checked_mul);
    let n = n.filter(|n| *n <= most / size_of::<i32>());
    let n = n.ok_or_else(|| format!("`{name}` is longer than the file"))?;
    let values = read::<i32>(file, name, None, n)?;
    Ok(values.into_iter().map(|count| u64::try_from(count).unwrap_or(0)).collect())
}

/// The moments of `n_points` in `file`; `place` says how a variable is called there, and what of it is read.
fn moments(
    file: &NcFile,
    n_points: usize,
    place: impl Fn(&str) -> (String, Option<NcSliceInfo>),
) -> Result<Moments, String> {
    let (name, slice) = place(SAMPLES);
    let n_samples = read::<i32>(file, &name, slice, n_points)?;
    let mut found = Moments {
        n_samples: n_samples.into_iter().map(|count| u32::try_from(count).unwrap_or(0)).collect(),
        ..Moments::default()
    };
    let means = COMPONENTS.iter().map(|(name, _)| *name).zip(&mut found.mean);
    let stresses = STRESS_NAMES.into_iter().zip(&mut found.stress);
    for (name, values) in means.chain(stresses) {
        let (name, slice) = place(name);
        *values = read::<f32>(file, &name, slice, n_points)?;
    }
    Ok(found)
}

/// The `n` values of the variable `name`, or of a `slice` of it.
fn read<T: NcReadable>(
    file: &NcFile,
    name: &str,
    slice: Option<NcSliceInfo>,
    n: usize,
) -> Result<Vec<T>, String> {
    let shape = shape_of(file, name)?;
    let kept = if slice.is_some() { shape.get(1..).unwrap_or(&[]) } else { &shape[..] };
    if kept.iter().copied().try_fold(1_usize, usize::checked_mul) != Some(n) {
        return Err(format!("`{name}` has the shape {shape:?} for {n} points"));
    }
    let values = match slice {
        Some(slice) => file.read_variable_slice::<T>(name, &slice),
        None => file.read_variable::<T>(name),
    };
    let values = values.map_err(|error| error.to_string())?.into_raw_vec_and_offset().0;
    if values.len() == n { Ok(values) } else { Err(format!("`{name}` is cut short")) }
}
