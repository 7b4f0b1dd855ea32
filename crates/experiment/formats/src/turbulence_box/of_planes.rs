//! Planes that come from anywhere, such as a cut of a record, as a file that does not repeat.

use super::source::{Outline, Source};
use super::{Kind, in_order_of_arrival, kind, write_from};
use crate::FileError;
use flow::inflow::Planes;
use std::path::Path;

const WHAT: &str = "a part of recorded wind";

/// Where planes come from, and what a file tells of them beside their grid.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// The file that they are read from.
    pub path: &'a Path,
    /// Hub height (m).
    pub hub_height: f64,
    /// What they are, in words.
    pub description: &'a str,
}

/// Writes `planes` of `origin` to `path`, whose ending chooses TurbSim's format (`.bts`) or Bladed's
/// (`.wnd`): a record that does not repeat.
///
/// A plane at a time is in memory; all are read twice or three times before, for their means and ranges.
///
/// # Errors
/// [`FileError`]; files appear whole or not at all. A box of HAWC2 is refused, for these repeat.
pub fn write_planes(path: &Path, planes: &mut dyn Planes, origin: Origin) -> Result<(), FileError> {
    check_once(path)?;
    write_from(path, &mut PlanesSource::new(planes, origin)?)
}

/// Whether the ending of `path` names a format whose records may end, before the work of making one.
///
/// # Errors
/// [`FileError::Content`] when it names none, or a box of HAWC2.
pub fn check_once(path: &Path) -> Result<(), FileError> {
    match kind(path)? {
        Kind::TurbSim | Kind::Bladed => Ok(()),
        Kind::Hawc(_) => {
            let problem = "a box of HAWC2 repeats, and a part of a record does not";
            Err(FileError::content(WHAT, path, problem, "name it NAME.bts or NAME.wnd"))
        }
    }
}

/// Planes as writers take them.
struct PlanesSource<'a> {
    planes: &'a mut dyn Planes,
    path: &'a Path,
    outline: Outline,
    wind: Vec<[f32; 3]>,
    /// Fluctuations u, v, w (m/s) on the plane that was asked for.
    velocity: [Vec<f32>; 3],
}

impl<'a> PlanesSource<'a> {
    fn new(planes: &'a mut dyn Planes, origin: Origin<'a>) -> Result<Self, FileError> {
        let grid = planes.grid();
        let size = grid.n_y * grid.n_z;
        let outline = Outline {
            n_points: [grid.n_steps, grid.n_y, grid.n_z],
            spacing: [grid.speed * grid.interval, grid.spacing[0], grid.spacing[1]],
            hub_speed: grid.speed,
            hub_height: origin.hub_height,
            lowest_height: grid.first[1],
            mean_speeds: vec![0.0; grid.n_z],
            description: origin.description.to_owned(),
            repeats: false,
        };
        let (wind, velocity) = (vec![[0.0; 3]; size], std::array::from_fn(|_| vec![0.0; size]));
        let mut source = Self { planes, path: origin.path, outline, wind, velocity };
        let mut means = vec![0.0; grid.n_z];
        for step in 0..grid.n_steps {
            source.fetch(step)?;
            for (mean, row) in means.iter_mut().zip(source.wind.chunks(grid.n_y)) {
                *mean += row.iter().map(|wind| f64::from(wind[0])).sum::<f64>();
            }
        }
        let n_values = (grid.n_steps * grid.n_y) as f64;
        means.iter_mut().for_each(|mean| *mean /= n_values);
        source.outline.mean_speeds = means;
        Ok(source)
    }

    fn fetch(&mut self, step: usize) -> Result<(), FileError> {
        self.planes.read(step, &mut self.wind).map_err(|error| {
            FileError::content(WHAT, self.path, error.to_string(), "copy the record again")
        })
    }
}

impl Source for PlanesSource<'_> {
    fn outline(&self) -> Outline {
        self.outline.clone()
    }

    fn plane(&mut self, x: usize) -> Result<[&[f32]; 3], FileError> {
        let [n_x, n_y, _] = self.outline.n_points;
        self.fetch(in_order_of_arrival(x, n_x))?;
        for (point, wind) in self.wind.iter().enumerate() {
            let mean = self.outline.mean_speeds[point / n_y];
            self.velocity[0][point] = (f64::from(wind[0]) - mean) as f32;
            self.velocity[1][point] = wind[1];
            self.velocity[2][point] = wind[2];
        }
        Ok(self.velocity.each_ref().map(Vec::as_slice))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::turbulence_box::{Carried, WindRecorder, hub_height, open, read};
    use flow::inflow::{Cut, CutPlanes, PlaneGrid};

    const N_Y: usize = 21;
    const N_Z: usize = 12;
    const GRID: PlaneGrid = PlaneGrid {
        n_y: N_Y,
        n_z: N_Z,
        spacing: [10.0, 10.0],
        first: [-100.0, 35.0],
        interval: 0.5,
        speed: 0.0,
        n_steps: 0,
        repeats: false,
    };
    const CUT: Cut = Cut {
        from: 1.0,
        duration: Some(6.0),
        block: 2,
        width: Some(60.0),
        height: Some(70.0),
        spacing: None,
        shift: -30.0,
    };

    /// Slow air that crosses from the right to the left.
    fn plane(step: usize) -> Vec<[f32; 3]> {
        let wind = |point: usize| {
            let (y, z) = ((point % N_Y) as f32, (point / N_Y) as f32);
            let wave = (0.4 * y - 0.3 * step as f32).sin();
            [9.0 + 0.1 * z + wave, 0.5 * wave, 0.02 * (y - z)]
        };
        (0..N_Y * N_Z).map(wind).collect()
    }

    fn record(path: &Path) {
        let mut recorder = WindRecorder::create(path, N_Y * N_Z).unwrap();
        (0..40).for_each(|step| recorder.write(&plane(step)).unwrap());
        recorder.finish(&GRID, 90.0, Carried::Middle, "a wake").unwrap();
    }

    #[test]
    fn a_cut_of_a_record_is_the_same_in_files_of_turbsim_and_bladed_and_without_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("slices.bts");
        record(&path);
        assert!((hub_height(&path).unwrap() - 90.0).abs() < 1e-6);
        let cut = || CutPlanes::new(open(&path).unwrap(), &CUT, 90.0).unwrap();
        for (name, tolerance) in [("part.bts", 1e-3), ("part.wnd", 5e-3)] {
            let written = folder.path().join(name);
            let origin = Origin { path: &path, hub_height: 90.0, description: "block 2" };
            write_planes(&written, &mut cut(), origin).unwrap();
            let (mut direct, mut file) = (cut(), open(&written).unwrap());
            let (expected, found) = (direct.grid(), file.grid());
            assert_eq!([found.n_y, found.n_z, found.n_steps], [7, 8, 13], "{name}");
            assert!(!found.repeats && (found.speed - expected.speed).abs() < 1e-4, "{found:?}");
            assert!((0..2).all(|a| (found.first[a] - expected.first[a]).abs() < 1e-3));
            let [mut from_record, mut from_file] = [0, 1].map(|_| vec![[0.0; 3]; 7 * 8]);
            for step in 0..found.n_steps {
                direct.read(step, &mut from_record).unwrap();
                file.read(step, &mut from_file).unwrap();
                // What was simulated: 7 s into the record, 30 m to the right.
                let slice = plane(14 + step);
                for (point, wind) in from_file.iter().enumerate() {
                    let simulated = slice[(2 + point / 7) * N_Y + 4 + point % 7];
                    for axis in 0..3 {
                        assert!(
                            (wind[axis] - from_record[point][axis]).abs() < tolerance,
                            "{name}"
                        );
                        assert!((wind[axis] - simulated[axis]).abs() < tolerance, "{name}");
                    }
                }
            }
            assert_eq!(read(&written).unwrap().turbulence.n_points(), [13, 7, 8]);
        }
        // InflowWind takes any line with this word for a record that repeats.
        let summary = std::fs::read_to_string(folder.path().join("part.sum")).unwrap();
        assert!(!summary.to_uppercase().contains("PERIODIC"), "{summary}");
    }

    #[test]
    fn boxes_that_repeat_are_refused_and_a_record_that_is_gone_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("slices.bts");
        record(&path);
        let mut cut = CutPlanes::new(open(&path).unwrap(), &CUT, 90.0).unwrap();
        let origin = Origin { path: &path, hub_height: 90.0, description: "" };
        let error = write_planes(&folder.path().join("part.toml"), &mut cut, origin).unwrap_err();
        assert!(error.to_string().contains("repeats"), "{error}");
        std::fs::File::options().write(true).open(&path).unwrap().set_len(100).unwrap();
        let written = folder.path().join("part.bts");
        // Blocks of planes may still be in memory; a record that was cut short is told all the same.
        if let Err(error) = write_planes(&written, &mut cut, origin) {
            assert!(error.to_string().contains("slices.bts") && !written.exists(), "{error}");
        }
    }
}
