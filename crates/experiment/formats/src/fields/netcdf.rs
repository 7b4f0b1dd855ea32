//! Fields in NetCDF: those of this program, and others with coordinates x, y, z and components u, v, w.

use super::layout::Layout;
use super::numbers::Coding;
use super::placed::PlacedReader;
use super::{FoundSetting, Lengths, WHAT, length_in, speed_in, time_in};
use crate::{FileError, netcdf};
use basis::records::Grid;
use netcdf_reader::{NcFile, NcVariable};
use std::io::{self, ErrorKind};
use std::ops::Range;
use std::path::Path;

const FIX: &str = "give coordinates x, y, z and time, and velocities u, v, w over time, z, y, x; an axis with one point may be left out";
const RESTORE: &str = "copy the file again if it was cut short; NetCDF of the classic kinds is read (`nccopy -k 64-bit-offset` makes it of NetCDF-4)";
/// Names of the components, one set of them.
const COMPONENTS: [[&str; 3]; 4] = [
    ["u", "v", "w"],
    ["U", "V", "W"],
    ["Vx", "Vy", "Vz"],
    ["velocity_x", "velocity_y", "velocity_z"],
];
/// Axes in the order in which velocities stand over them.
const AXES: [&str; 3] = ["z", "y", "x"];

/// Bytes that are asked for ahead of need.
const AHEAD: usize = 8 << 20;

/// The components in a file.
pub(super) struct NetCdfFields {
    reader: PlacedReader,
    layouts: [Layout; 3],
    n_instants: usize,
    /// Points that were asked for, up to which chunk.
    advised: (Range<usize>, usize),
}

/// The fields, with their points, instants and what the file tells of them.
type Opened = (NetCdfFields, Grid, Vec<Option<f64>>, FoundSetting);

impl NetCdfFields {
    /// The fields at `path`, with their points, instants and what the file tells of them.
    pub(super) fn open(path: &Path, lengths: Lengths) -> Result<Opened, FileError> {
        let reader = PlacedReader::open(path);
        let reader = reader.map_err(|error| FileError::system("read", WHAT, path, error))?;
        let refused = |problem: String, fix| FileError::content(WHAT, path, problem, fix);
        let file = NcFile::open(path).map_err(|error| refused(error.to_string(), RESTORE))?;
        Self::decode(&file, reader, lengths).map_err(|problem| refused(problem, FIX))
    }

    fn decode(file: &NcFile, reader: PlacedReader, lengths: Lengths) -> Result<Opened, String> {
        let most = usize::try_from(reader.length()).unwrap_or(usize::MAX);
        let names = components(file)?;
        let grid = grid(file, lengths, most)?;
        let n_points = grid.len();
        let mut layouts = Vec::new();
        let mut over_time = Vec::new();
        let mut told = Vec::new();
        for name in &names {
            let variable = file.variable(name).map_err(|error| error.to_string())?;
            let has_time = is_over_time(variable, &grid)?;
            over_time.push(has_time);
            told.push(unit(variable).is_some());
            let scale = match unit(variable) {
                Some(unit) => speed_in(&unit).ok_or_else(|| {
                    format!("`{name}` is in {unit}; speeds in m/s or mm/s are read")
                })?,
                None => 1.0,
            };
            let coding = Coding::of(variable, scale);
            let coding = coding.ok_or_else(|| format!("`{name}` does not hold numbers"))?;
            layouts.push(Layout::of(file, variable, (n_points, has_time), coding)?);
        }
        if over_time != [over_time[0]; 3] {
            return Err(format!("of {} some stand over time, some do not", names.join(", ")));
        }
        if told != [told[0]; 3] {
            return Err(format!("of {} some tell a unit, some do not", names.join(", ")));
        }
        let times = times(file, over_time[0], most)?;
        let n_instants = times.len();
        for (layout, name) in layouts.iter().zip(&names) {
            let end = layout.end(n_points, n_instants);
            if n_instants > 0 && end.is_none_or(|end| end > reader.length()) {
                return Err(format!(
                    "it holds fewer values than it says: `{name}` at {n_instants} instants does not end within its {} bytes; it was cut short",
                    reader.length()
                ));
            }
        }
        let found = found(file);
        let layouts = layouts.try_into().map_err(|_| "it lacks a component".to_owned())?;
        let advised = (0..0, 0);
        Ok((Self { reader, layouts, n_instants, advised }, grid, times, found))
    }

    /// On return `velocity` is that at `instant` at `points`; `path` is the file's own.
    pub(super) fn read(
        &mut self,
        path: &Path,
        instant: usize,
        points: &Range<usize>,
        velocity: [&mut [f32]; 3],
    ) -> Result<(), FileError> {
        for (component, values) in velocity.into_iter().enumerate() {
            self.advise(3 * instant + component, points);
            let read = self.read_component(component, instant, points.clone(), values);
            read.map_err(|error| refusal(path, error))?;
        }
        Ok(())
    }

    /// Asks for `points` of the chunks after number `chunk`, counted over instants and components, as far
    /// ahead as is useful and was not asked for yet.
    fn advise(&mut self, chunk: usize, points: &Range<usize>) {
        let of_chunk = points.len().max(1) * self.layouts[0].coding.n_bytes();
        let end = (chunk + 1 + AHEAD.div_ceil(of_chunk)).min(3 * self.n_instants);
        let (asked, until) = &self.advised;
        let is_under_way = asked == points && (chunk + 1..=end).contains(until);
        let start = if is_under_way { *until } else { chunk + 1 };
        for chunk in start..end {
            let (instant, layout) = (chunk / 3, &self.layouts[chunk % 3]);
            if let Some((at, n_bytes, _)) = layout.place(instant, points) {
                self.reader.advise(at, n_bytes);
            }
        }
        self.advised = (points.clone(), end);
    }

    fn read_component(
        &mut self,
        component: usize,
        instant: usize,
        points: Range<usize>,
        mut values: &mut [f32],
    ) -> io::Result<()> {
        let layout = &self.layouts[component];
        let mut rest = points;
        while !rest.is_empty() {
            let place = layout.place(instant, &rest);
            let (at, n_bytes, after) = place.ok_or(ErrorKind::UnexpectedEof)?;
            self.reader.read(at, n_bytes, |bytes| {
                let n = bytes.len() / layout.coding.n_bytes();
                let (own, others) = std::mem::take(&mut values).split_at_mut(n);
                layout.coding.decode(bytes, own);
                values = others;
            })?;
            rest = after;
        }
        Ok(())
    }
}

/// That the file at `path` could not be read.
pub(super) fn refusal(path: &Path, error: io::Error) -> FileError {
    if error.kind() == ErrorKind::UnexpectedEof {
        let fix = "copy the file again: it became shorter while it was read";
        return FileError::content(WHAT, path, "its numbers are cut short", fix);
    }
    FileError::system("read", WHAT, path, error)
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
