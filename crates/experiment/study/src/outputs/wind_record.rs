//! Records of wind under way: planes as they come at some places, in the end a full field of each.

use super::output::{Output, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use crate::error::StudyError;
use basis::Vector3;
use flow::WindField;
use flow::inflow::PlaneGrid;
use formats::turbulence_box::{Carried, WindRecorder};
use std::path::{Path, PathBuf};

/// Disk of a point of a plane (bytes): three components as they come, which stay until the run is complete,
/// and three of the full field.
pub(super) const POINT_BYTES: u64 = 3 * (size_of::<f32>() + size_of::<i16>()) as u64;
/// Memory of a point (bytes): where it is, its wind, the same in single precision, and as bytes.
pub(super) const POINT_MEMORY: u64 = (2 * size_of::<Vector3>() + 6 * size_of::<f32>()) as u64;

/// Records that get their planes in the same steps.
pub(super) struct WindRecords {
    schedule: Schedule,
    records: Vec<WindRecord>,
}

/// One record under way, with room to work in.
struct WindRecord {
    recorder: WindRecorder,
    grid: PlaneGrid,
    hub_height: f64,
    description: String,
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
    wind: Vec<[f32; 3]>,
}

/// What a record is of.
pub(super) struct Recorded {
    /// Its points, about the place along y.
    pub(super) grid: PlaneGrid,
    /// Where it is, on the ground (m).
    pub(super) foot: Vector3,
    /// Height of the hub that it is for (m).
    pub(super) hub_height: f64,
    /// What it is, in words.
    pub(super) description: String,
}

impl WindRecords {
    /// Begins the records `wanted`, each with its file, or goes on with them as they are `stored`.
    ///
    /// # Errors
    /// [`StudyError`] when a file cannot be written, or is shorter than what is stored of it.
    pub(super) fn begin(
        schedule: Schedule,
        wanted: impl Iterator<Item = (PathBuf, Recorded)>,
        stored: Option<Stored>,
    ) -> Result<Option<Box<dyn Output>>, StudyError> {
        // So many bytes of each are sure.
        let n_bytes: Option<Vec<u64>> = stored.map(Stored::state).transpose()?;
        let records = wanted.enumerate().map(|(place, (path, recorded))| {
            let n_bytes = n_bytes.as_ref().and_then(|n_bytes| n_bytes.get(place)).copied();
            WindRecord::begin(&path, recorded, n_bytes)
        });
        let records = records.collect::<Result<_, _>>()?;
        Ok(Some(Box::new(Self { schedule, records })))
    }
}

impl Output for WindRecords {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        self.records.iter_mut().try_for_each(|record| record.write(scene.farm.flow()))
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let flushed = self.records.iter_mut().map(WindRecord::flush);
        let n_bytes: Vec<u64> = flushed.collect::<Result<_, _>>()?;
        section.keep(&n_bytes)
    }

    fn finish(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        self.records.iter_mut().try_for_each(WindRecord::finish)
    }
}

impl WindRecord {
    /// Begins the record of `recorded` that will stand at `path`, or goes on with it after its first
    /// `n_bytes`.
    fn begin(path: &Path, recorded: Recorded, n_bytes: Option<u64>) -> Result<Self, StudyError> {
        let Recorded { grid, foot, hub_height, description } = recorded;
        let positions: Vec<Vector3> = (0..grid.n_z)
            .flat_map(|row| (0..grid.n_y).map(move |column| (row, column)))
            .map(|(row, column)| {
                let y = grid.first[0] + column as f64 * grid.spacing[0];
                let z = grid.first[1] + row as f64 * grid.spacing[1];
                Vector3::new(foot.x, foot.y + y, z)
            })
            .collect();
        let n_points = positions.len();
        let recorder = match n_bytes {
            Some(n_bytes) => WindRecorder::resume(path, n_points, n_bytes)?,
            None => WindRecorder::create(path, n_points)?,
        };
        let (velocities, wind) = (vec![Vector3::ZERO; n_points], vec![[0.0; 3]; n_points]);
        Ok(Self { recorder, hub_height, description, velocities, wind, positions, grid })
    }

    /// Keeps the wind of `field` now.
    fn write(&mut self, field: &impl WindField) -> Result<(), StudyError> {
        field.sample(&self.positions, &mut self.velocities);
        for (wind, velocity) in self.wind.iter_mut().zip(&self.velocities) {
            *wind = [velocity.x, velocity.y, velocity.z].map(|component| component as f32);
        }
        Ok(self.recorder.write(&self.wind)?)
    }

    /// Puts all planes on the disk; gives the bytes that are there.
    fn flush(&mut self) -> Result<u64, StudyError> {
        Ok(self.recorder.flush()?)
    }

    /// Completes the full field.
    fn finish(&mut self) -> Result<(), StudyError> {
        let Self { recorder, grid, hub_height, description, .. } = self;
        Ok(recorder.finish(grid, *hub_height, Carried::Middle, description)?)
    }
}
