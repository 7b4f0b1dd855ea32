//! Fields in NetCDF: those of this program, and others with coordinates x, y, z and components u, v, w.

use super::{FoundSetting, Lengths, WHAT, length_in, speed_in, time_in};
use crate::{FileError, atomic, netcdf};
use basis::records::Grid;
use netcdf_reader::{NcFile, NcSliceInfo, NcSliceInfoElem, NcType, NcVariable};
use std::ops::Range;
use std::path::Path;

const FIX: &str = "give coordinates x, y, z and time, and velocities u, v, w over time, z, y, x; an axis with one point may be left out";
/// Names of the components, one set of them.
const COMPONENTS: [[&str; 3]; 4] = [
    ["u", "v", "w"],
    ["U", "V", "W"],
    ["Vx", "Vy", "Vz"],
    ["velocity_x", "velocity_y", "velocity_z"],
];
/// Axes in the order in which velocities stand over them.
const AXES: [&str; 3] = ["z", "y", "x"];

/// The components in a file.
pub(super) struct NetCdfFields {
    file: NcFile,
    names: [String; 3],
    /// Metres a second of one, of each component.
    scales: [f64; 3],
    /// Whether the numbers of all components are in single precision, as they stand.
    is_plain: bool,
    grid: Grid,
    n_points: usize,
}

/// The fields, with their points, instants and what the file tells of them.
type Opened = (NetCdfFields, Grid, Vec<Option<f64>>, FoundSetting);

impl NetCdfFields {
    /// The fields at `path`, with their points, instants and what the file tells of them.
    pub(super) fn open(path: &Path, lengths: Lengths) -> Result<Opened, FileError> {
        let unreadable = |error| FileError::system("read", WHAT, path, error);
        let length = atomic::open(path).and_then(|file| file.metadata()).map_err(unreadable)?.len();
        let most = usize::try_from(length).unwrap_or(usize::MAX);
        let opened = NcFile::open(path).map_err(|error| error.to_string());
        let read = opened.and_then(|file| Self::decode(file, lengths, most));
        read.map_err(|problem| FileError::content(WHAT, path, problem, FIX))
    }

    fn decode(file: NcFile, lengths: Lengths, most: usize) -> Result<Opened, String> {
        let names = components(&file)?;
        let grid = grid(&file, lengths, most)?;
        let n_points = grid.len();
        let mut scales = [1.0; 3];
        let mut over_time = Vec::new();
        let mut told = Vec::new();
        for (name, scale) in names.iter().zip(&mut scales) {
            let variable = file.variable(name).map_err(|error| error.to_string())?;
            over_time.push(is_over_time(variable, &grid)?);
            told.push(unit(variable).is_some());
            *scale = match unit(variable) {
                Some(unit) => speed_in(&unit).ok_or_else(|| {
                    format!("`{name}` is in {unit}; speeds in m/s or mm/s are read")
                })?,
                None => 1.0,
            };
        }
        let is_plain =
            scales == [1.0; 3] && names.iter().all(|name| file.variable(name).is_ok_and(is_plain));
        if over_time != [over_time[0]; 3] {
            return Err(format!("of {} some stand over time, some do not", names.join(", ")));
        }
        if told != [told[0]; 3] {
            return Err(format!("of {} some tell a unit, some do not", names.join(", ")));
        }
        let has_time = over_time[0];
        let times = times(&file, has_time, most)?;
        let n_values = times.len().checked_mul(n_points);
        if n_values.is_none_or(|n| n > most) {
            return Err("it holds fewer values than it says".to_owned());
        }
        let found = found(&file);
        let fields = Self { file, names, scales, is_plain, grid, n_points };
        Ok((fields, grid, times, found))
    }

    /// On return `velocity` is that of instant number `index`.
    pub(super) fn read(
        &self,
        path: &Path,
        index: usize,
        velocity: &mut [Vec<f32>; 3],
    ) -> Result<(), FileError> {
        let place = Place { instants: index..index + 1, strip: None, n: self.n_points };
        self.read_at(path, &place, velocity)
    }

    /// Velocity at the `instants`, one after the other, at the steps of `strip` along its axis.
    pub(super) fn read_strip(
        &self,
        path: &Path,
        instants: Range<usize>,
        strip: (usize, Range<usize>),
    ) -> Result<[Vec<f32>; 3], FileError> {
        let row = self.n_points / self.grid.n_points[strip.0];
        let n = instants.len() * row * strip.1.len();
        let mut velocity = [const { Vec::new() }; 3];
        self.read_at(path, &Place { instants, strip: Some(strip), n }, &mut velocity)?;
        Ok(velocity)
    }

    fn read_at(
        &self,
        path: &Path,
        place: &Place,
        velocity: &mut [Vec<f32>; 3],
    ) -> Result<(), FileError> {
        for ((name, scale), values) in self.names.iter().zip(self.scales).zip(velocity) {
            let read = self.values(name, scale, place);
            *values = read.map_err(|problem| FileError::content(WHAT, path, problem, FIX))?;
            if values.len() != place.n {
                let problem =
                    format!("`{name}` has {} values where {} are expected", values.len(), place.n);
                return Err(FileError::content(WHAT, path, problem, FIX));
            }
        }
        Ok(())
    }

    fn values(&self, name: &str, scale: f64, place: &Place) -> Result<Vec<f32>, String> {
        let variable = self.file.variable(name).map_err(|error| error.to_string())?;
        let slice = |range: &Range<usize>| NcSliceInfoElem::Slice {
            start: range.start as u64,
            end: range.end as u64,
            step: 1,
        };
        let along = |dimension: &str| match &place.strip {
            _ if dimension == "time" => slice(&place.instants),
            Some((axis, steps)) if dimension == ["x", "y", "z"][*axis] => slice(steps),
            _ => NcSliceInfoElem::Slice { start: 0, end: u64::MAX, step: 1 },
        };
        let selections = variable.dimensions.iter().map(|one| along(&one.name)).collect();
        let slice = NcSliceInfo { selections };
        if self.is_plain {
            let read = self.file.read_variable_slice::<f32>(name, &slice);
            return Ok(read.map_err(|error| error.to_string())?.into_raw_vec_and_offset().0);
        }
        // Fill values and packed numbers as the conventions have them.
        let read = self.file.read_variable_slice_unpacked_masked(name, &slice);
        let values = read.map_err(|error| error.to_string())?.into_raw_vec_and_offset().0;
        Ok(values.into_iter().map(|value| (scale * value) as f32).collect())
    }
}

/// What is read of a variable.
struct Place {
    instants: Range<usize>,
    /// An axis, and steps along it; the whole grid where there is none.
    strip: Option<(usize, Range<usize>)>,
    /// Values (–).
    n: usize,
}

/// Names of the three components in `file`.
fn components(file: &NcFile) -> Result<[String; 3], String> {
    let is_there = |name: &str| file.variable(name).is_ok();
    let set = COMPONENTS.iter().find(|set| set.iter().any(|name| is_there(name)));
    let set = set.ok_or("it lacks velocities: `u`, `v` and `w`")?;
    match set.iter().find(|name| !is_there(name)) {
        Some(name) => Err(format!("it lacks `{name}`")),
        None => Ok(set.map(str::to_owned)),
    }
}

/// Whether the numbers of `variable` are in single precision and mean what they say.
fn is_plain(variable: &NcVariable) -> bool {
    const CHANGES: [&str; 8] = [
        "_FillValue",
        "missing_value",
        "valid_range",
        "valid_min",
        "valid_max",
        "scale_factor",
        "add_offset",
        "_Unsigned",
    ];
    let changes = |name: &str| CHANGES.contains(&name);
    *variable.dtype() == NcType::Float
        && !variable.attributes.iter().any(|attribute| changes(&attribute.name))
}

/// The unit of `variable`, where it tells one.
fn unit(variable: &NcVariable) -> Option<String> {
    let unit = variable.attributes.iter().find(|attribute| attribute.name == "units")?;
    unit.value.as_string()
}

/// The points of `file`, in metres.
fn grid(file: &NcFile, lengths: Lengths, most: usize) -> Result<Grid, String> {
    let mut grid = Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [1; 3] };
    let mut told: Vec<(&str, Option<String>)> = Vec::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let Ok(variable) = file.variable(name) else { continue };
        told.push((name, unit(variable)));
        let values = netcdf::numbers_of(file, name, most)?;
        let (origin, spacing) =
            netcdf::even(&values).map_err(|problem| format!("`{name}` {problem}"))?;
        (grid.origin[axis], grid.spacing[axis]) = (origin, spacing);
        grid.n_points[axis] = values.len();
    }
    if told.is_empty() {
        return Err("it lacks the coordinates `x`, `y` and `z`".to_owned());
    }
    let silent = told.iter().find(|(_, unit)| unit.is_none());
    if let (Some((silent, _)), Some((name, Some(unit)))) =
        (silent, told.iter().find(|(_, unit)| unit.is_some()))
    {
        return Err(format!("`{name}` is in {unit}, `{silent}` tells no unit"));
    }
    for (name, unit) in told {
        let axis = ["x", "y", "z"].iter().position(|other| *other == name).unwrap_or(0);
        let scale = match unit {
            Some(unit) => length_in(&unit)
                .ok_or_else(|| format!("`{name}` is in {unit}; lengths in m or mm are read"))?,
            None => lengths.in_metres(),
        };
        grid.origin[axis] *= scale;
        if grid.n_points[axis] > 1 {
            grid.spacing[axis] *= scale;
        }
    }
    let n_points = grid.n_points.into_iter().try_fold(1_usize, usize::checked_mul);
    n_points.filter(|n| *n <= most).ok_or("it holds fewer values than it says")?;
    Ok(grid)
}

/// Whether `variable` stands over time first; the axes after it must be those of `grid` with their lengths.
fn is_over_time(variable: &NcVariable, grid: &Grid) -> Result<bool, String> {
    let names: Vec<&str> = variable.dimensions.iter().map(|one| one.name.as_str()).collect();
    let has_time = names.first() == Some(&"time");
    let rest = if has_time { &names[1..] } else { &names[..] };
    let mut expected = AXES.iter().filter(|axis| rest.contains(axis));
    if !rest.iter().all(|name| expected.next() == Some(name)) {
        return Err(format!(
            "`{}` stands over {}, not over time, z, y, x",
            variable.name,
            names.join(", ")
        ));
    }
    for (name, dimension) in names.iter().zip(&variable.dimensions) {
        let axis = ["x", "y", "z"].iter().position(|axis| axis == name);
        if axis.is_some_and(|axis| grid.n_points[axis] as u64 != dimension.size) {
            return Err(format!("`{name}` does not have as many values as `{}`", variable.name));
        }
    }
    let n_points: u64 =
        variable.dimensions.iter().skip(usize::from(has_time)).map(|one| one.size).product();
    if n_points != grid.len() as u64 {
        return Err(format!("`{}` does not have a value for each point", variable.name));
    }
    Ok(has_time)
}

/// The instants of `file` (s); one that is not told where its fields stand over no time.
fn times(file: &NcFile, has_time: bool, most: usize) -> Result<Vec<Option<f64>>, String> {
    if !has_time {
        return Ok(vec![None]);
    }
    let values = netcdf::numbers_of(file, "time", most)?;
    let variable = file.variable("time").map_err(|error| error.to_string())?;
    let scale = match unit(variable) {
        Some(unit) => time_in(&unit)
            .ok_or_else(|| format!("`time` is in {unit}; times in s or ms are read"))?,
        None => 1.0,
    };
    Ok(values.into_iter().map(|time| Some(scale * time)).collect())
}

/// What `file` tells of what its fields were taken of.
fn found(file: &NcFile) -> FoundSetting {
    let attribute = |name: &str| Some(file.global_attribute(name).ok()?.value.clone());
    let text = |name: &str| attribute(name)?.as_string();
    let number = |name: &str| {
        let value = attribute(name)?.as_f64_vec()?.first().copied()?;
        value.is_finite().then_some(value)
    };
    let first = |name: &str| netcdf::numbers_of(file, name, 1 << 16).ok()?.first().copied();
    let hub = match (first("hub_x"), first("hub_y"), first("hub_z")) {
        (Some(x), Some(y), Some(z)) => Some([x, y, z]),
        _ => None,
    };
    let (case, run) = (text("case"), text("run"));
    FoundSetting {
        name: match (case, run) {
            (Some(case), Some(run)) => Some(format!("{case}, {run}")),
            _ => text("title"),
        },
        wind_speed: number("wind_speed_m_s"),
        turbulence_intensity: number("turbulence_intensity"),
        diameter: number("rotor_diameter_m"),
        hub: hub.filter(|hub| hub.iter().all(|value| value.is_finite())),
    }
}
