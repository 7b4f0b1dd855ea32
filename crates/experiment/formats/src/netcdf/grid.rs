//! Points of regular grids as the coordinates of a file.

use super::read::{lacks, variable};
use super::text;
use basis::records::Grid;
use netcdf_reader::NcFile;
use netcdf_writer::{DimensionId, Error, NcFileBuilder};

/// By how much a coordinate may lie away from where even spacing has it (steps).
const UNEVEN: f64 = 1e-3;

/// Adds the coordinates z, y and x of `grid`; gives their dimensions.
pub(super) fn add_grid(file: &mut NcFileBuilder, grid: &Grid) -> Result<[DimensionId; 3], Error> {
    let described = [
        ("z", 2, "Z", "height above the ground"),
        ("y", 1, "Y", "distance to the left of the first turbine looking downwind"),
        ("x", 0, "X", "distance downwind of the first turbine"),
    ];
    let mut dimensions = Vec::with_capacity(described.len());
    for (name, axis, letter, long_name) in described {
        let values: Vec<f64> =
            (0..grid.n_points[axis]).map(|step| grid.coordinate(axis, step)).collect();
        let dimension = file.add_dimension(name, values.len() as u64)?;
        let variable = file.add_variable::<f64>(name, &[dimension])?;
        file.add_variable_attribute(variable, "units", text("m"))?;
        file.add_variable_attribute(variable, "axis", text(letter))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        file.write_variable(variable, &values)?;
        dimensions.push(dimension);
    }
    Ok([dimensions[0], dimensions[1], dimensions[2]])
}

/// The points of the coordinates `names` of `file`, x, y and z, in a file of `most` bytes.
pub(super) fn grid_of(file: &NcFile, names: [&str; 3], most: usize) -> Result<Grid, String> {
    let mut grid = Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [1; 3] };
    for (axis, name) in names.into_iter().enumerate() {
        let values = variable(file, name, most)?;
        let (origin, spacing) = even(&values).map_err(|problem| format!("`{name}` {problem}"))?;
        (grid.origin[axis], grid.spacing[axis]) = (origin, spacing);
        grid.n_points[axis] = values.len();
    }
    let n_points = grid.n_points.into_iter().try_fold(1_usize, usize::checked_mul);
    match n_points.filter(|n| *n <= most / size_of::<f32>()) {
        Some(_) => Ok(grid),
        None => Err("it holds fewer values than it says".to_owned()),
    }
}

/// First and spacing of coordinates that must grow evenly; a spacing of 1 where there is one coordinate.
pub(crate) fn even(values: &[f64]) -> Result<(f64, f64), String> {
    let [first, rest @ ..] = values else { return Err("has no value".to_owned()) };
    if let Some(place) = values.iter().position(|value| !value.is_finite()) {
        return Err(format!("is no number at its value {place}"));
    }
    let Some(last) = rest.last() else { return Ok((*first, 1.0)) };
    let spacing = (last - first) / rest.len() as f64;
    if spacing <= 0.0 {
        return Err("does not grow".to_owned());
    }
    let off = |(step, value): (usize, &f64)| {
        (value - first - (step + 1) as f64 * spacing).abs() > UNEVEN * spacing
    };
    match rest.iter().enumerate().find(|pair| off(*pair)) {
        Some((step, value)) => {
            let expected = first + (step + 1) as f64 * spacing;
            Err(format!("is not evenly spaced: value {} is {value}, not {expected}", step + 1))
        }
        None => Ok((*first, spacing)),
    }
}

/// The values of the variable `name`, of whatever type, in a file of `most` bytes.
pub(crate) fn numbers_of(file: &NcFile, name: &str, most: usize) -> Result<Vec<f64>, String> {
    let n = shape_of(file, name)?.into_iter().try_fold(1_usize, usize::checked_mul);
    n.filter(|n| *n <= most).ok_or_else(|| format!("`{name}` is longer than the file"))?;
    let values = file.read_variable_as_f64(name).map_err(|error| error.to_string())?;
    Ok(values.into_raw_vec_and_offset().0)
}

/// The shape of the variable `name`, of `dimensions` in all.
pub(super) fn shape_of(file: &NcFile, name: &str) -> Result<Vec<usize>, String> {
    let shape = file.variable(name).map_err(|_| lacks(name))?.shape();
    let whole: Option<Vec<usize>> = shape.iter().map(|n| usize::try_from(*n).ok()).collect();
    whole.ok_or_else(|| format!("`{name}` has the shape {shape:?}"))
}
