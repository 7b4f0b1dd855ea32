//! Planes as NetCDF files that xarray, ParaView and MATLAB open as they are, and back.
//!
//! The classic format (64-bit offsets where needed), which needs no HDF5 on either side. Velocity stands over
//! `time`, `z`, `y`, `x`, the axis across the plane having one point, so that a plane lies where it was
//! taken.

use crate::{FileError, atomic};
use basis::records::{Plane, PlaneAxes};
use netcdf_reader::{NcAttrValue as ReadValue, NcFile};
use netcdf_writer::{NcAttrValue, NcFileBuilder, NcWriteOptions};
use std::io;
use std::path::Path;

const WHAT: &str = "a plane of velocities (NetCDF)";
const FIX: &str = "restore the file, or make the run again";
/// Velocity components: name, meaning.
const COMPONENTS: [(&str, &str); 3] = [
    ("u", "velocity downwind"),
    ("v", "velocity to the left looking downwind"),
    ("w", "velocity upward"),
];

/// Names of the axes that a plane spans, and their places among x, y, z.
fn spanned(axes: PlaneAxes) -> (&'static str, [usize; 2]) {
    match axes {
        PlaneAxes::Horizontal => ("horizontal", [0, 1]),
        PlaneAxes::Streamwise => ("streamwise", [0, 2]),
        PlaneAxes::Crosswind => ("crosswind", [1, 2]),
    }
}

/// Writes `plane` of the run `run` to `path`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_plane(path: &Path, run: &str, plane: &Plane) -> Result<(), FileError> {
    let bytes = encode(run, plane).map_err(|error| {
        FileError::system("write", WHAT, path, io::Error::new(io::ErrorKind::InvalidInput, error))
    })?;
    atomic::write(path, WHAT, &bytes)
}

fn encode(run: &str, plane: &Plane) -> Result<Vec<u8>, netcdf_writer::Error> {
    let text = |text: &str| NcAttrValue::Chars(text.to_owned());
    let (axes, along) = spanned(plane.axes);
    let mut file = NcFileBuilder::new();
    let what = if plane.averaged > 0.0 { "mean" } else { "instantaneous" };
    file.add_attribute("Conventions", text("CF-1.8"))?;
    file.add_attribute("title", text(&format!("{what} velocity on the plane {}", plane.name)))?;
    file.add_attribute("source", text(concat!("wakemix ", env!("CARGO_PKG_VERSION"))))?;
    file.add_attribute("run", text(run))?;
    file.add_attribute("plane", text(&plane.name))?;
    file.add_attribute("axes", text(axes))?;
    file.add_attribute("origin_m", NcAttrValue::Doubles(plane.origin.to_vec()))?;
    file.add_attribute("spacing_m", NcAttrValue::Doubles(plane.spacing.to_vec()))?;
    file.add_attribute("averaging_time_s", NcAttrValue::Doubles(vec![plane.averaged]))?;

    let mut coordinates = plane.origin.map(|start| vec![start]);
    for (axis, (spacing, count)) in along.into_iter().zip(plane.spacing.iter().zip(plane.n_points))
    {
        coordinates[axis] = (0..count).map(|i| plane.origin[axis] + i as f64 * spacing).collect();
    }
    let time = [plane.time];
    let [x, y, z] = &coordinates;
    let described: [(&str, &[f64], &str, &str, &str); 4] = [
        ("time", &time, "s", "T", "time since the start of the run"),
        ("z", z, "m", "Z", "height above the ground"),
        ("y", y, "m", "Y", "distance to the left of the first turbine looking downwind"),
        ("x", x, "m", "X", "distance downwind of the first turbine"),
    ];
    let mut dimensions = Vec::with_capacity(described.len());
    for (name, values, unit, axis, long_name) in described {
        let dimension = file.add_dimension(name, values.len() as u64)?;
        let variable = file.add_variable::<f64>(name, &[dimension])?;
        file.add_variable_attribute(variable, "units", text(unit))?;
        file.add_variable_attribute(variable, "axis", text(axis))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        if name == "z" {
            file.add_variable_attribute(variable, "positive", text("up"))?;
        }
        file.write_variable(variable, values)?;
        dimensions.push(dimension);
    }
    for ((name, long_name), values) in COMPONENTS.iter().zip(&plane.velocity) {
        let variable = file.add_variable::<f32>(*name, &dimensions)?;
        file.add_variable_attribute(variable, "units", text("m s-1"))?;
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        let method = if plane.averaged > 0.0 { "time: mean" } else { "time: point" };
        file.add_variable_attribute(variable, "cell_methods", text(method))?;
        file.write_variable(variable, values)?;
    }
    Ok(file.to_vec(NcWriteOptions::default())?.1)
}

/// Reads a plane that [`write_plane`] wrote.
///
/// # Errors
/// [`FileError::System`] when it cannot be read, [`FileError::Content`] when it is something else.
pub fn read_plane(path: &Path) -> Result<Plane, FileError> {
    let bytes = atomic::read_bytes(path, WHAT)?;
    decode(&bytes).map_err(|problem| FileError::content(WHAT, path, problem, FIX))
}

fn decode(bytes: &[u8]) -> Result<Plane, String> {
    let most = bytes.len();
    let file = NcFile::from_bytes(bytes).map_err(|error| error.to_string())?;
    let attribute = |name: &str| {
        let attribute = file.global_attribute(name);
        attribute.map(|attribute| attribute.value.clone()).map_err(|_| lacks(name))
    };
    let text =
        |name: &str| attribute(name)?.as_string().ok_or_else(|| format!("`{name}` is no text"));
    let axes = text("axes")?;
    let axes = [PlaneAxes::Horizontal, PlaneAxes::Streamwise, PlaneAxes::Crosswind]
        .into_iter()
        .find(|known| spanned(*known).0 == axes)
        .ok_or_else(|| format!("`axes` = \"{axes}\" is unknown"))?;
    let mut n_points = [0_usize; 2];
    for (count, axis) in n_points.iter_mut().zip(spanned(axes).1) {
        let name = ["x", "y", "z"][axis];
        let size = file.dimension(name).map_err(|_| lacks(name))?.size;
        *count = usize::try_from(size).map_err(|_| format!("`{name}` has {size} points"))?;
    }
    let n_values = n_points[0].checked_mul(n_points[1]).filter(|n| *n <= most / size_of::<f32>());
    let n_values = n_values.ok_or("it holds fewer values than it says")?;
    let mut velocity = [const { Vec::new() }; 3];
    for ((name, _), values) in COMPONENTS.iter().zip(&mut velocity) {
        let shape = file.variable(name).map_err(|_| lacks(name))?.shape();
        if shape.iter().try_fold(1_u64, |n, m| n.checked_mul(*m)) != Some(n_values as u64) {
            return Err(format!(
                "`{name}` has the shape {shape:?} on a plane of {n_values} points"
            ));
        }
        values.resize(n_values, 0.0);
        file.read_variable_into::<f32>(name, values).map_err(|error| error.to_string())?;
    }
    let mut time = [0.0];
    if file.variable("time").map_err(|_| lacks("time"))?.shape() != [1] {
        return Err("it holds more than one instant".to_owned());
    }
    file.read_variable_into::<f64>("time", &mut time).map_err(|error| error.to_string())?;
    Ok(Plane {
        name: text("plane")?,
        axes,
        origin: numbers(&attribute("origin_m")?, "origin_m")?,
        spacing: numbers(&attribute("spacing_m")?, "spacing_m")?,
        n_points,
        time: time[0],
        averaged: numbers::<1>(&attribute("averaging_time_s")?, "averaging_time_s")?[0],
        velocity,
    })
}

fn lacks(name: &str) -> String {
    format!("it lacks `{name}`")
}

fn numbers<const N: usize>(value: &ReadValue, name: &str) -> Result<[f64; N], String> {
    let values = value.as_f64_vec().unwrap_or_default();
    values.try_into().map_err(|_| format!("`{name}` does not hold {N} numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn plane(axes: PlaneAxes) -> Plane {
        let values = |scale: f32| (0..12).map(|i| scale * (i as f32 + 0.1)).collect();
        Plane {
            name: "hub-height".into(),
            axes,
            origin: [-0.1 - 0.2, -37.5, 150.0],
            spacing: [15.0, 1.0 / 3.0],
            n_points: [4, 3],
            time: 1_500.000_000_1,
            averaged: 1200.0,
            velocity: [values(1.0), values(-0.3), values(1e-7)],
        }
    }

    #[test]
    fn a_plane_comes_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        for axes in [PlaneAxes::Horizontal, PlaneAxes::Streamwise, PlaneAxes::Crosswind] {
            let path = folder.path().join("plane.nc");
            write_plane(&path, "helix", &plane(axes)).unwrap();
            assert_eq!(read_plane(&path).unwrap(), plane(axes));
        }
    }

    #[test]
    fn coordinates_lie_where_the_plane_was_taken() {
        let file =
            NcFile::from_bytes(&encode("helix", &plane(PlaneAxes::Streamwise)).unwrap()).unwrap();
        let coordinate = |name| {
            let array = file.read_variable::<f64>(name).unwrap();
            array.iter().copied().collect::<Vec<f64>>()
        };
        let start = -0.1 - 0.2;
        assert_eq!(coordinate("x"), [start, start + 15.0, start + 30.0, start + 45.0]);
        assert_eq!(coordinate("y"), [-37.5]);
        assert_eq!(coordinate("z"), [150.0, 150.0 + 1.0 / 3.0, 150.0 + 2.0 / 3.0]);
        assert_eq!(file.variable("u").unwrap().shape(), [1, 3, 1, 4]);
        let unit = file.variable("u").unwrap().attribute("units").unwrap().value.as_string();
        assert_eq!(unit.as_deref(), Some("m s-1"));
    }

    #[test]
    fn another_file_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plane.nc");
        std::fs::write(&path, b"not NetCDF").unwrap();
        let error = read_plane(&path).unwrap_err();
        assert!(
            error.to_string().contains("plane.nc does not hold a plane of velocities"),
            "{error}"
        );
        let mut other = NcFileBuilder::new();
        other.add_dimension("x", 3).unwrap();
        let (_, bytes) = other.to_vec(NcWriteOptions::default()).unwrap();
        assert_eq!(decode(&bytes).unwrap_err(), "it lacks `axes`");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        #[test]
        fn no_damage_makes_the_reader_panic(
            cut in 0usize..4000,
            flips in prop::collection::vec((0usize..2000, any::<u8>()), 0..4),
        ) {
            let mut bytes = encode("helix", &plane(PlaneAxes::Crosswind)).unwrap();
            for (place, value) in flips {
                let place = place % bytes.len();
                bytes[place] = value;
            }
            bytes.truncate(cut);
            let _ = decode(&bytes);
        }
    }
}
