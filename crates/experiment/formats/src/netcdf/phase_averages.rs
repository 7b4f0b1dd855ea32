//! Averages by phase, bin by bin, in one file that is written and read without holding all of it.

use super::grid::{add_grid, grid_of, shape_of};
use super::read::{lacks, variable};
use super::{COMPONENTS, text, unwritable_as};
use crate::FileError;
use crate::atomic::{self, AtomicFile};
use basis::records::{FieldSetting, Moments, PhaseAverages, PhaseBin, STRESSES};
use netcdf_reader::{NcFile, NcReadable, NcSliceInfo, NcSliceInfoElem};
use netcdf_writer::{DimensionId, Error, NcAttrValue, NcFileBuilder, NcWriteOptions, NcWriteType};
use std::io::Write;
use std::path::{Path, PathBuf};

const WHAT: &str = "velocity averaged by phase (NetCDF)";
const FIX: &str = "restore the file, or average again with `wakemix analyse phases`";
/// Where the number of records stands in the file.
const PLACE_OF_NUMBER: usize = 4;
/// Names of the stresses, as [`STRESSES`] orders them.
const STRESS_NAMES: [&str; 6] = ["uu", "vv", "ww", "uv", "uw", "vw"];
const SAMPLES: &str = "n_samples";
/// Bytes of a bin beside its points.
const BIN_BYTES: usize = 2 * size_of::<f64>() + 2 * size_of::<i32>();
/// Bytes of a point in a bin, and of a point over all.
const POINT_BYTES: usize = size_of::<i32>() + 9 * size_of::<f32>();
/// Bytes of a file beside all of these.
const HEADER_BYTES: u64 = 8 << 10;

/// Bytes that averages by phase of `n_points` in `n_bins` take on the disk.
pub fn phase_averages_bytes(n_points: u64, n_bins: u64) -> u64 {
    HEADER_BYTES + (n_bins + 1) * (n_points * POINT_BYTES as u64 + BIN_BYTES as u64)
}

/// Writes averages by phase in `setting` to `path`: `head`, whose own bins are not looked at, and what `bin`
/// gives of each. In memory there is one bin at a time.
///
/// # Errors
/// [`FileError::System`].
///
/// # Panics
/// Where a bin has other points than the grid of `head`.
pub fn write_phase_averages(
    path: &Path,
    setting: &FieldSetting,
    head: &PhaseAverages,
    bin: impl Fn(usize) -> Moments,
) -> Result<(), FileError> {
    let n_points = head.grid.len();
    let record_bytes = BIN_BYTES + n_points * POINT_BYTES;
    let whole = encode(setting, head).map_err(|error| unwritable_as(WHAT, path, error))?;
    let mut header = whole;
    header.truncate(header.len() - record_bytes);
    let n_bins = u32::try_from(head.bins.len()).unwrap_or(u32::MAX);
    header[PLACE_OF_NUMBER..][..4].copy_from_slice(&n_bins.to_be_bytes());
    let mut file = AtomicFile::create(path, WHAT)?;
    let mut write = |bytes: &[u8]| {
        file.write_all(bytes).map_err(|error| FileError::system("write", WHAT, path, error))
    };
    write(&header)?;
    let mut bytes = Vec::with_capacity(record_bytes);
    for (index, one) in head.bins.iter().enumerate() {
        bytes.clear();
        record(one, &bin(index), &mut bytes);
        assert_eq!(bytes.len(), record_bytes, "bins of one grid");
        write(&bytes)?;
    }
    file.commit()
}

/// Adds `bin` with its `moments` to `bytes`, in the order in which [`encode`] names the variables.
fn record(bin: &PhaseBin, moments: &Moments, bytes: &mut Vec<u8>) {
    bytes.extend(bin.rotor.to_be_bytes());
    bytes.extend(bin.helix.unwrap_or(f64::NAN).to_be_bytes());
    for count in [bin.n_instants, bin.n_visits] {
        bytes.extend(i32::try_from(count).unwrap_or(i32::MAX).to_be_bytes());
    }
    bytes.extend(moments.n_samples.iter().flat_map(|n| signed(*n).to_be_bytes()));
    for values in moments.mean.iter().chain(&moments.stress) {
        bytes.extend(values.iter().flat_map(|value| value.to_be_bytes()));
    }
}

fn signed(count: u32) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX)
}

/// The bytes of a file with one bin, empty.
fn encode(setting: &FieldSetting, head: &PhaseAverages) -> Result<Vec<u8>, Error> {
    let mut file = NcFileBuilder::new();
    file.add_attribute("Conventions", text("CF-1.8"))?;
    file.add_attribute("title", text("wind velocity averaged by phase"))?;
    file.add_attribute("source", text(concat!("wakemix ", env!("CARGO_PKG_VERSION"))))?;
    file.add_attribute("name", text(&setting.name))?;
    let comment = "x downwind, y to the left looking downwind, z upward; a bin goes half its width to either side of its middle; stresses are means of products of deviations from the means of the same bin; all_ tells of all instants";
    file.add_attribute("comment", text(comment))?;
    let numbers = [
        ("wind_speed_m_s", Some(setting.wind_speed)),
        ("turbulence_intensity", setting.turbulence_intensity),
        ("rotor_diameter_m", Some(setting.diameter)),
        ("rotor_bin_width_rad", Some(head.rotor_width)),
        ("helix_bin_width_rad", head.helix_width),
    ];
    for (name, value) in numbers {
        if let Some(value) = value {
            file.add_attribute(name, NcAttrValue::Doubles(vec![value]))?;
        }
    }
    file.add_attribute("hub_m", NcAttrValue::Doubles(setting.hub.to_vec()))?;
    file.add_attribute("time_span_s", NcAttrValue::Doubles(head.span.to_vec()))?;
    let [z, y, x] = add_grid(&mut file, &head.grid)?;
    let bin = file.add_unlimited_dimension("bin")?;
    add(&mut file, "all_", &[z, y, x], &head.all)?;
    let azimuths = [
        ("rotor_azimuth", "azimuth of blade 1 at the middle of the bin, from the top"),
        (
            "helix_azimuth",
            "angle of the tilting and yawing pitch at the middle of the bin, from yaw",
        ),
    ];
    for (name, long_name) in azimuths {
        add_one(&mut file, name, ("rad", long_name), &[bin], &[0.0_f64])?;
    }
    let counts = [
        ("n_instants", "instants in the bin"),
        ("n_visits", "times that the bin was entered: independent instants at least"),
    ];
    for (name, long_name) in counts {
        add_one(&mut file, name, ("1", long_name), &[bin], &[0_i32])?;
    }
    let n_points = head.grid.len();
    let empty = Moments {
        n_samples: vec![0; n_points],
        mean: std::array::from_fn(|_| vec![0.0; n_points]),
        stress: std::array::from_fn(|_| vec![0.0; n_points]),
    };
    add(&mut file, "", &[bin, z, y, x], &empty)?;
    Ok(file.to_vec(NcWriteOptions::offset64())?.1)
}

/// Adds the variables of `moments`, whose names begin with `prefix`, over `dimensions`.
fn add(
    file: &mut NcFileBuilder,
    prefix: &str,
    dimensions: &[DimensionId],
    moments: &Moments,
) -> Result<(), Error> {
    let counts: Vec<i32> = moments.n_samples.iter().copied().map(signed).collect();
    let meaning = ("1", "samples, of which holes are none");
    add_one(file, &format!("{prefix}{SAMPLES}"), meaning, dimensions, &counts)?;
    for ((name, long_name), values) in COMPONENTS.iter().zip(&moments.mean) {
        let meaning = ("m s-1", format!("mean {long_name}"));
        let meaning = (meaning.0, meaning.1.as_str());
        add_one(file, &format!("{prefix}{name}"), meaning, dimensions, values)?;
    }
    for ((name, [a, b]), values) in STRESS_NAMES.iter().zip(STRESSES).zip(&moments.stress) {
        let long_name = format!(
            "mean product of the deviations of {} and {}",
            COMPONENTS[a].1, COMPONENTS[b].1
        );
        let meaning = ("m2 s-2", long_name.as_str());
        add_one(file, &format!("{prefix}{name}"), meaning, dimensions, values)?;
    }
    Ok(())
}

/// Adds the variable `name` with its unit and its meaning.
fn add_one<T: NcWriteType>(
    file: &mut NcFileBuilder,
    name: &str,
    (unit, long_name): (&str, &str),
    dimensions: &[DimensionId],
    values: &[T],
) -> Result<(), Error> {
    let variable = file.add_variable::<T>(name, dimensions)?;
    file.add_variable_attribute(variable, "units", text(unit))?;
    file.add_variable_attribute(variable, "long_name", text(long_name))?;
    file.write_variable(variable, values)
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
    let head = PhaseAverages {
        grid,
        rotor_width: positive("rotor_bin_width_rad")?,
        helix_width: number("helix_bin_width_rad").filter(|width| width.is_finite()),
        span: [span[0], span[1]],
        bins: (0..rotor.len()).map(bin).collect(),
        all: moments(file, grid.len(), |name| (format!("all_{name}"), None))?,
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
