//! Planes of wind and temperature across the mean wind, taken out of a periodic box.

use basis::Vector3;
use flow::WindField;
use flow::inflow::{InflowError, PlaneGrid};
use flow::lattice::Lattice;
use formats::FileError;
use formats::netcdf::TemperatureWriter;
use formats::records::PrecursorFolder;
use formats::turbulence_box::{self, Carried, WindRecorder};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A record of planes under way.
///
/// The planes stand in the middle of the box, across the wind that it was begun with. Where that is aslant to
/// the cells, points lie between them and the box goes on beyond its sides: a plane no wider than the shorter
/// side never meets itself.
pub(super) struct Recording {
    wind: WindRecorder,
    temperature: TemperatureWriter,
    state: RecordingState,
    /// Time between planes (s).
    interval: f64,
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
    plane: Vec<[f32; 3]>,
    temperatures: Vec<f64>,
}

/// Air that planes are taken out of.
pub(super) trait RecordedAir: WindField {
    /// Potential temperature (K) at each of `positions` (m) into `temperatures`, of the same length.
    fn temperatures(&self, positions: &[Vector3], temperatures: &mut [f64]);
}

impl RecordedAir for Lattice {
    fn temperatures(&self, positions: &[Vector3], temperatures: &mut [f64]) {
        let is_told = self.sample_temperature(positions, temperatures);
        debug_assert!(is_told, "a precursor's air has a temperature");
    }
}

/// What a checkpoint keeps of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct RecordingState {
    /// Steps before the first plane (–).
    pub(super) first_plane: u64,
    /// Bytes of wind that are sure, and planes of temperature (–).
    pub(super) n_bytes: u64,
    pub(super) n_planes: u64,
    /// Direction along which u of the planes blows, towards east and north (–).
    pub(super) along: [f64; 2],
}

/// What the planes of a file hold at hub height, linear between their rows.
pub(super) struct AtHub {
    /// Mean speed across the planes (m/s).
    pub(super) speed: f64,
    /// Mean of v over that (–).
    pub(super) aside: f64,
    /// Standard deviation of u over that (–).
    pub(super) intensity: f64,
    /// Planes (–).
    pub(super) n_planes: usize,
}

impl Recording {
    /// Begins a record in `folder` of planes as `grid` has them, across `wind` towards east and north (m/s).
    ///
    /// # Errors
    /// [`FileError`].
    pub(super) fn begin(
        folder: &PrecursorFolder,
        grid: &PlaneGrid,
        first_plane: u64,
        [east, north]: [f64; 2],
    ) -> Result<Self, FileError> {
        let wind = WindRecorder::create(&folder.planes_path(), grid.n_y * grid.n_z)?;
        let temperature = TemperatureWriter::create(&folder.temperature_path(), grid)?;
        let speed = east.hypot(north);
        let along = if speed > 0.0 { [east / speed, north / speed] } else { [1.0, 0.0] };
        let state = RecordingState { first_plane, n_bytes: 0, n_planes: 0, along };
        Ok(Self::new(wind, temperature, grid, state))
    }

    /// Goes on with the record in `folder` where `state` was kept.
    ///
    /// # Errors
    /// [`FileError`].
    pub(super) fn resume(
        folder: &PrecursorFolder,
        grid: &PlaneGrid,
        state: RecordingState,
    ) -> Result<Self, FileError> {
        let n_points = grid.n_y * grid.n_z;
        let wind = WindRecorder::resume(&folder.planes_path(), n_points, state.n_bytes)?;
        let path = folder.temperature_path();
        let temperature = TemperatureWriter::resume(&path, grid, state.n_planes)?;
        Ok(Self::new(wind, temperature, grid, state))
    }

    fn new(
        wind: WindRecorder,
        temperature: TemperatureWriter,
        grid: &PlaneGrid,
        state: RecordingState,
    ) -> Self {
        let [east, north] = state.along;
        let place = |row: usize, column: usize| {
            let left = grid.first[0] + column as f64 * grid.spacing[0];
            let height = grid.first[1] + row as f64 * grid.spacing[1];
            Vector3::new(-left * north, left * east, height)
        };
        let positions: Vec<Vector3> = (0..grid.n_z)
            .flat_map(|row| (0..grid.n_y).map(move |column| place(row, column)))
            .collect();
        let n_points = positions.len();
        Self {
            wind,
            temperature,
            state,
            interval: grid.interval,
            positions,
            velocities: vec![Vector3::ZERO; n_points],
            plane: vec![[0.0; 3]; n_points],
            temperatures: vec![0.0; n_points],
        }
    }

    /// Direction along which u blows, towards east and north (–).
    pub(super) fn along(&self) -> [f64; 2] {
        self.state.along
    }

    /// Keeps the wind and the temperature of `air` now.
    ///
    /// # Errors
    /// [`FileError`].
    pub(super) fn add(&mut self, air: &impl RecordedAir) -> Result<(), FileError> {
        air.sample(&self.positions, &mut self.velocities);
        air.temperatures(&self.positions, &mut self.temperatures);
        let [east, north] = self.state.along;
        for (wind, velocity) in self.plane.iter_mut().zip(&self.velocities) {
            let (u, v) =
                (velocity.x * east + velocity.y * north, velocity.y * east - velocity.x * north);
            *wind = [u, v, velocity.z].map(|component| component as f32);
        }
        self.wind.write(&self.plane)?;
        let time = self.state.n_planes as f64 * self.interval;
        self.state.n_planes += 1;
        self.temperature.write(time, &self.temperatures)
    }

    /// Puts all planes on the disk; gives what a checkpoint keeps.
    ///
    /// # Errors
    /// [`FileError`].
    pub(super) fn flush(&mut self) -> Result<RecordingState, FileError> {
        self.state.n_bytes = self.wind.flush()?;
        self.state.n_planes = self.temperature.flush()?;
        Ok(self.state)
    }

    /// Completes the files, for a hub at `hub_height` (m); what a longer record goes on from stays.
    ///
    /// # Errors
    /// [`FileError`].
    pub(super) fn finish(
        &mut self,
        grid: &PlaneGrid,
        hub_height: f64,
        description: &str,
    ) -> Result<(), FileError> {
        self.wind.finish(grid, hub_height, Carried::Width, description)?;
        self.temperature.finish()
    }
}

/// What the planes of the file at `path` hold at `hub_height` (m), linear between their rows.
///
/// # Errors
/// [`FileError`], and [`InflowError::Plane`] for a plane that cannot be read.
pub(super) fn at_hub(
    path: &Path,
    hub_height: f64,
) -> Result<Result<AtHub, InflowError>, FileError> {
    let mut planes = turbulence_box::open(path)?;
    let grid = planes.grid();
    let (rows, weight) = grid.rows_at(hub_height);
    let start = rows.map(|row| row * grid.n_y);
    let mut plane = vec![[0.0; 3]; grid.n_y * grid.n_z];
    let (mut u, mut v, mut uu) = (0.0, 0.0, 0.0);
    for step in 0..grid.n_steps {
        if let Err(error) = planes.read(step, &mut plane) {
            return Ok(Err(error));
        }
        for index in 0..grid.n_y {
            let wind = [0, 1].map(|axis| {
                let [below, above] = start.map(|start| f64::from(plane[start + index][axis]));
                below + weight * (above - below)
            });
            // From the file's own mean, so that squares of the mean do not drown the deviation.
            let departure = wind[0] - grid.speed;
            u += departure;
            uu += departure * departure;
            v += wind[1];
        }
    }
    let n = (grid.n_steps * grid.n_y) as f64;
    let speed = grid.speed + u / n;
    let deviation = (uu / n - (u / n).powi(2)).max(0.0).sqrt();
    let (aside, intensity) = (v / n / speed, deviation / speed);
    Ok(Ok(AtHub { speed, aside, intensity, n_planes: grid.n_steps }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use formats::netcdf::TemperatureReader;

    /// A wind of 8 m/s that comes from the south-west, and grows to its left.
    struct Aslant;

    impl WindField for Aslant {
        fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
            for (position, velocity) in positions.iter().zip(velocities) {
                let left = (position.y - position.x) / 2f64.sqrt();
                let speed = (8.0 + 0.01 * left) / 2f64.sqrt();
                *velocity = Vector3::new(speed, speed, 0.1);
            }
        }
    }

    impl RecordedAir for Aslant {
        fn temperatures(&self, positions: &[Vector3], temperatures: &mut [f64]) {
            for (position, temperature) in positions.iter().zip(temperatures) {
                *temperature = 288.0 + 0.01 * position.z;
            }
        }
    }

    #[test]
    fn planes_stand_across_the_wind_and_u_blows_along_it() {
        let folder = tempfile::tempdir().unwrap();
        let folder = PrecursorFolder::new(folder.path());
        let path = folder.planes_path();
        let grid = PlaneGrid {
            n_y: 5,
            n_z: 3,
            spacing: [20.0; 2],
            first: [-40.0, 10.0],
            interval: 1.0,
            speed: 8.0,
            n_steps: 3,
            repeats: false,
        };
        let mut recording = Recording::begin(&folder, &grid, 7, [3.0, 3.0]).unwrap();
        recording.add(&Aslant).unwrap();
        let state = recording.flush().unwrap();
        assert_eq!((state.first_plane, state.n_bytes, state.n_planes), (7, 5 * 3 * 12, 1));
        recording.add(&Aslant).unwrap();
        drop(recording);
        let mut recording = Recording::resume(&folder, &grid, state).unwrap();
        recording.add(&Aslant).unwrap();
        recording.finish(&grid, 30.0, "a trial").unwrap();
        let found = at_hub(&path, 30.0).unwrap().unwrap();
        assert_eq!(found.n_planes, 2);
        assert!((found.speed - 8.0).abs() < 1e-4 && found.aside.abs() < 1e-4);
        // Speeds of 7.6 to 8.4 m/s in five steps.
        assert!((found.intensity - 0.2 * 2f64.sqrt() / 8.0).abs() < 1e-4, "{}", found.intensity);
        let mut planes = turbulence_box::open(&path).unwrap();
        let mut plane = vec![[0.0; 3]; 15];
        planes.read(1, &mut plane).unwrap();
        // From the right to the left looking downwind.
        assert!((plane[0][0] - 7.6).abs() < 1e-3 && (plane[4][0] - 8.4).abs() < 1e-3);
        assert!((plane[7][2] - 0.1).abs() < 1e-3);
        let grid = PlaneGrid { n_steps: 2, ..grid };
        let warm = TemperatureReader::open(&folder.temperature_path(), &grid).unwrap();
        let mut temperatures = [0.0; 15];
        warm.read(1, &mut temperatures).unwrap();
        // Rows 20 m apart from 10 m on.
        assert!((temperatures[0] - 288.1).abs() < 1e-4 && (temperatures[14] - 288.5).abs() < 1e-4);
    }
}
