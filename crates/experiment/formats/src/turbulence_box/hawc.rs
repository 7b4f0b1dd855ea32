//! HAWC2-style binaries: one little-endian f32 file per component and a readable header.
//!
//! HAWC2's binaries carry no header; programs differ in which way they count. Ours is a TOML file beside them
//! that says so, and any other program's binaries can be read after writing one by hand. What we write is in
//! the order in which OpenFAST's InflowWind reads HAWC files: x slowest and in order of arrival, then y from
//! left to right looking downwind, then z upwards, fastest.

mod header;

use super::blocks::Blocks;
use super::source::{Outline, Source, whole};
use super::{FASTEST, StoredBox, in_order_of_arrival};
use crate::FileError;
use crate::atomic::{self, AtomicFile};
use flow::inflow::{InflowError, PlaneGrid, Planes};
use header::read_header;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

const WHAT: &str = "the header of a turbulence box";
const COMPONENT: &str = "one component of a turbulence box";

/// Which way a file counts along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// x: the first plane arrives first, so that the count runs against the wind.
    Upwind,
    /// x: the count runs with the wind, and the last plane arrives first.
    Downwind,
    /// y: from the right to the left, looking downwind.
    Left,
    /// y: from the left to the right, looking downwind.
    Right,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    description: String,
    #[serde(rename = "box")]
    layout: Layout,
    wind: Wind,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Layout {
    n_points: [usize; 3],
    spacing: [f64; 3],
    files: [String; 3],
    x_runs: Axis,
    y_runs: Axis,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Wind {
    hub_speed: f64,
    hub_height: f64,
    lowest_height: f64,
    mean_speeds: Vec<f64>,
}

const PREFACE: &str = "\
# Turbulence box: fluctuations u (downwind), v (left looking downwind), w (up), in m/s, one file each.
# Each file: little-endian 32-bit floats without header, x slowest, then y, z fastest and upwards.
#   box.n_points, box.spacing   along x, y, z (m)
#   box.x_runs                  \"upwind\": the first plane arrives first; \"downwind\": the last one does
#   box.y_runs                  \"right\" or \"left\", looking downwind
#   wind.mean_speeds            mean speed at each height (m/s), lowest first; not part of the fluctuations
";

/// Writes the box of `source` as NAME.toml at `path` with NAME_u.bin, NAME_v.bin, NAME_w.bin beside it.
///
/// # Errors
/// [`FileError`]; each file appears whole or not at all and none before the last plane is read, the header
/// last.
pub fn write(path: &Path, source: &mut dyn Source) -> Result<(), FileError> {
    let Outline {
        n_points,
        spacing,
        hub_speed,
        hub_height,
        lowest_height,
        mean_speeds,
        description,
        ..
    } = source.outline();
    let paths = &files_of(path)[1..];
    let name = |component: usize| {
        paths[component].file_name().unwrap_or_default().to_string_lossy().into_owned()
    };
    let files = [name(0), name(1), name(2)];
    let create = |component: usize| AtomicFile::create(&paths[component], COMPONENT);
    let mut written = [create(0)?, create(1)?, create(2)?];
    let [n_x, n_y, n_z] = n_points;
    let mut bytes = Vec::with_capacity(4 * n_y * n_z);
    for place in 0..n_x {
        let planes = source.plane(in_order_of_arrival(place, n_x))?;
        for ((file, plane), path) in written.iter_mut().zip(planes).zip(paths) {
            bytes.clear();
            for y in (0..n_y).rev() {
                for z in 0..n_z {
                    bytes.extend_from_slice(&plane[z * n_y + y].to_le_bytes());
                }
            }
            file.write_all(&bytes)
                .map_err(|source| FileError::system("write", COMPONENT, path, source))?;
        }
    }
    written.into_iter().try_for_each(AtomicFile::commit)?;
    let header = Header {
        description,
        layout: Layout { n_points, spacing, files, x_runs: Axis::Upwind, y_runs: Axis::Right },
        wind: Wind { hub_speed, hub_height, lowest_height, mean_speeds },
    };
    let text = toml::to_string(&header).map_err(|error| {
        FileError::content(WHAT, path, error.to_string(), "check the numbers of the box")
    })?;
    atomic::write(path, WHAT, format!("{PREFACE}\n{text}").as_bytes())
}

/// The files of a box whose header is at `path`.
pub(super) fn files_of(path: &Path) -> Vec<PathBuf> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let file = |component| path.with_file_name(format!("{stem}_{component}.bin"));
    vec![path.to_owned(), file("u"), file("v"), file("w")]
}

/// The header at `path` and the binaries that it names.
///
/// # Errors
/// As [`read`].
pub(super) fn files(path: &Path) -> Result<Vec<PathBuf>, FileError> {
    let header = read_header(path)?;
    let binaries = header.layout.files.iter().map(|name| path.with_file_name(name));
    Ok(std::iter::once(path.to_owned()).chain(binaries).collect())
}

/// Hub height of the box whose header is at `path` (m).
///
/// # Errors
/// As [`read`].
pub(super) fn hub_height(path: &Path) -> Result<f64, FileError> {
    Ok(read_header(path)?.wind.hub_height)
}

/// Reads the header at `path` and the binaries that it names, beside it.
///
/// # Errors
/// [`FileError`] names file, place and fix.
pub fn read(path: &Path) -> Result<StoredBox, FileError> {
    whole(path, &mut stream(path)?)
}

/// The box whose header is at `path`, read plane by plane.
///
/// # Errors
/// As [`read`].
pub(super) fn stream(path: &Path) -> Result<impl Source + use<>, FileError> {
    let header = read_header(path)?;
    let components = components(path, &header.layout)?;
    let Layout { n_points, spacing, .. } = header.layout;
    let Wind { hub_speed, hub_height, lowest_height, mean_speeds } = header.wind;
    let outline = Outline {
        n_points,
        spacing,
        hub_speed,
        hub_height,
        lowest_height,
        mean_speeds,
        description: header.description,
        repeats: true,
    };
    let velocity = std::array::from_fn(|_| vec![0.0; n_points[1] * n_points[2]]);
    Ok(HawcSource { components, outline, velocity })
}

/// Where the box whose header is at `path` says that it comes from.
///
/// # Errors
/// As [`read`].
pub(super) fn description(path: &Path) -> Result<String, FileError> {
    read_header(path).map(|header| header.description)
}

/// The file `name` of a component, which must stand beside the header at `path`.
fn beside(path: &Path, name: &str) -> Result<PathBuf, FileError> {
    let component = path.with_file_name(name);
    if component.is_file() {
        return Ok(component);
    }
    let problem = format!("box.files names `{name}`, and no such file stands beside it");
    Err(FileError::content(WHAT, path, problem, "copy the file there, or correct box.files"))
}

/// The planes of the box, of which the middle of the width stands at y = 0.
fn grid_of(header: &Header) -> PlaneGrid {
    let Layout { n_points: [n_steps, n_y, n_z], spacing, .. } = header.layout;
    let speed = header.wind.hub_speed;
    PlaneGrid {
        n_y,
        n_z,
        spacing: [spacing[1], spacing[2]],
        first: [-0.5 * (n_y - 1) as f64 * spacing[1], header.wind.lowest_height],
        interval: spacing[0] / speed,
        speed,
        n_steps,
        repeats: true,
    }
}

/// Planes of the box whose header is at `path`, read one at a time; the middle of its width stands at y = 0.
///
/// # Errors
/// As [`read`].
pub fn open(path: &Path) -> Result<impl Planes + use<>, FileError> {
    let header = read_header(path)?;
    let components = components(path, &header.layout)?;
    let mean_speeds = header.wind.mean_speeds.iter().map(|speed| *speed as f32).collect();
    Ok(HawcPlanes { components, mean_speeds, grid: grid_of(&header) })
}

/// The files that `layout`, of the header at `path`, names.
fn components(path: &Path, layout: &Layout) -> Result<[Component; 3], FileError> {
    let open = |name: &String| Component::open(&beside(path, name)?, layout);
    let [u, v, w] = &layout.files;
    Ok([open(u)?, open(v)?, open(w)?])
}

/// The box that three files are.
struct HawcSource {
    components: [Component; 3],
    outline: Outline,
    /// Fluctuations u, v, w (m/s) on the plane that was asked for.
    velocity: [Vec<f32>; 3],
}

impl Source for HawcSource {
    fn outline(&self) -> Outline {
        self.outline.clone()
    }

    fn plane(&mut self, x: usize) -> Result<[&[f32]; 3], FileError> {
        let step = in_order_of_arrival(x, self.outline.n_points[0]);
        for (component, values) in self.components.iter_mut().zip(&mut self.velocity) {
            component.read(step, |point, value| values[point] = value)?;
        }
        Ok(self.velocity.each_ref().map(Vec::as_slice))
    }
}

/// Planes in three files.
struct HawcPlanes {
    components: [Component; 3],
    mean_speeds: Vec<f32>,
    grid: PlaneGrid,
}

impl Planes for HawcPlanes {
    fn grid(&self) -> PlaneGrid {
        self.grid
    }

    /// As Mann's boxes do, for which the format was made.
    fn repeats_across(&self) -> bool {
        true
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        for (index, component) in self.components.iter_mut().enumerate() {
            component
                .read(step, |point, value| values[point][index] = value)
                .map_err(|error| super::plane_error(step, &error))?;
        }
        for (row, mean) in values.chunks_mut(self.grid.n_y).zip(&self.mean_speeds) {
            row.iter_mut().for_each(|[u, ..]| *u += mean);
        }
        Ok(())
    }
}

/// One component's file, of which a block of planes is in memory.
struct Component {
    planes: Blocks,
    n_points: [usize; 3],
    x_runs: Axis,
    y_runs: Axis,
}

impl Component {
    fn open(path: &Path, layout: &Layout) -> Result<Self, FileError> {
        let Layout { n_points, x_runs, y_runs, .. } = *layout;
        let [n_x, n_y, n_z] = n_points;
        let refused = |source| FileError::system("read", COMPONENT, path, source);
        let file = atomic::open(path).map_err(refused)?;
        let found = file.metadata().map_err(refused)?.len();
        let size = n_y * n_z;
        let needed = 4 * (n_x * size) as u64;
        if found != needed {
            let how = if found < needed {
                format!("ends within plane {} of {n_x}", found / (4 * size as u64) + 1)
            } else {
                "goes on behind the last plane".into()
            };
            let problem = format!(
                "{found} bytes instead of {needed} for {n_x} × {n_y} × {n_z} values: it {how}"
            );
            return Err(FileError::content(
                COMPONENT,
                path,
                problem,
                "copy or write the file again, or correct box.n_points in the header",
            ));
        }
        let planes = Blocks::new(file, path, COMPONENT, 0, 4 * size, n_x);
        Ok(Self { planes, n_points, x_runs, y_runs })
    }

    /// Calls `put(point, value)` for all points of the plane that arrives as number `step`; points y fastest.
    fn read(&mut self, step: usize, mut put: impl FnMut(usize, f32)) -> Result<(), FileError> {
        let [n_x, n_y, n_z] = self.n_points;
        let place = match self.x_runs {
            Axis::Downwind => in_order_of_arrival(step, n_x),
            _ => step,
        };
        let start = place * 4 * n_y * n_z;
        for (index, four) in self.planes.plane(place)?.chunks_exact(4).enumerate() {
            let four = [four[0], four[1], four[2], four[3]];
            let value = f32::from_le_bytes(four);
            let (column, z) = (index / n_z, index % n_z);
            if value.is_nan() || value.abs() > FASTEST {
                return Err(not_wind(
                    self.planes.path(),
                    four,
                    start + 4 * index,
                    [place, column, z],
                ));
            }
            let y = if self.y_runs == Axis::Left { column } else { n_y - 1 - column };
            put(z * n_y + y, value);
        }
        Ok(())
    }
}

/// Says what is wrong with the four bytes at `byte`, which are no wind.
fn not_wind(path: &Path, four: [u8; 4], byte: usize, [x, y, z]: [usize; 3]) -> FileError {
    let value = f32::from_le_bytes(four);
    let swapped = f32::from_be_bytes(four);
    let place = format!("byte {byte} (plane {}, column {}, row {})", x + 1, y + 1, z + 1);
    let (problem, fix) = if (1e-9..=FASTEST).contains(&swapped.abs()) {
        (
            format!(
                "{place} is {value:e} m/s, but {swapped} m/s with its bytes swapped: the byte order is big-endian"
            ),
            "write the file in little-endian order",
        )
    } else {
        (
            format!("{place} is {value} m/s, which is not a wind speed"),
            "make the box again; a box with a gap cannot be used",
        )
    };
    FileError::content(COMPONENT, path, problem, fix)
}
