//! A full field of wind that is written while it blows: planes as they come, in the end a `.bts` that does
//! not repeat.
//!
//! The format's 16-bit integers need the range of the whole record, so planes are kept as they are beside the
//! file to be, `.part` after its name, until the last one has come. That also lets a record go on after a
//! break.

use super::turbsim;
use crate::checkpoint::{ANEW, GONE};
use crate::{FileError, atomic};
use flow::inflow::PlaneGrid;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const WHAT: &str = "a record of wind";
const BUFFER: usize = 1 << 18;

/// Where the mean wind at hub height is taken with which planes are carried along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// In the middle of the width: behind a turbine, say.
    Middle,
    /// Over all of the width, where the wind is alike.
    Width,
}

/// Writes planes of wind as they come.
#[derive(Debug)]
pub struct WindRecorder {
    file: BufWriter<File>,
    part: PathBuf,
    path: PathBuf,
    bytes: Vec<u8>,
    n_points: usize,
    n_bytes: u64,
}

impl WindRecorder {
    /// Starts the record of planes of `n_points` that will stand at `path`, a `.bts`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, n_points: usize) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        let file = File::create(&part).map_err(|e| FileError::system("write", WHAT, &part, e))?;
        Ok(Self::new(file, part, path, n_points, 0))
    }

    /// Goes on with the record of planes of `n_points` that will stand at `path` after its first `n_bytes`;
    /// what came after them goes.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when it is shorter than that or does not end a plane
    /// there.
    pub fn resume(path: &Path, n_points: usize, n_bytes: u64) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        let failed = |source| FileError::system("read", WHAT, &part, source);
        if !part.exists() {
            return Err(FileError::content(WHAT, &part, GONE.to_owned(), ANEW));
        }
        let mut file = File::options().write(true).open(&part).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        if length < n_bytes || !n_bytes.is_multiple_of(12 * n_points as u64) {
            let problem = format!("it has {length} bytes, the checkpoint has {n_bytes}");
            return Err(FileError::content(WHAT, &part, problem, ANEW));
        }
        file.set_len(n_bytes).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(Self::new(file, part, path, n_points, n_bytes))
    }

    fn new(file: File, part: PathBuf, path: &Path, n_points: usize, n_bytes: u64) -> Self {
        let file = BufWriter::with_capacity(BUFFER, file);
        let bytes = Vec::with_capacity(12 * n_points);
        Self { file, part, path: path.to_owned(), bytes, n_points, n_bytes }
    }

    /// Adds a plane of wind u, v, w (m/s): rows of z upwards, in each, y from the right to the left looking
    /// downwind.
    ///
    /// # Errors
    /// [`FileError::System`].
    ///
    /// # Panics
    /// When `wind` has not one value per point.
    pub fn write(&mut self, wind: &[[f32; 3]]) -> Result<(), FileError> {
        assert_eq!(wind.len(), self.n_points, "a plane has one wind per point");
        self.bytes.clear();
        self.bytes.extend(wind.iter().flatten().flat_map(|value| value.to_le_bytes()));
        self.file.write_all(&self.bytes).map_err(|e| self.refused(e))?;
        self.n_bytes += self.bytes.len() as u64;
        Ok(())
    }

    /// Puts all planes on the disk; gives the bytes that are there, for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn flush(&mut self) -> Result<u64, FileError> {
        let done = self.file.flush().and_then(|()| self.file.get_ref().sync_data());
        done.map_err(|source| self.refused(source))?;
        Ok(self.n_bytes)
    }

    /// Completes the record: a full field in the format of TurbSim, whose planes lie as `grid` says, the
    /// number of steps, repetition and speed aside, for a hub at `hub_height` (m); `description` goes into
    /// the file.
    ///
    /// The file's hub speed, with which its planes are carried along, is the mean at hub height where
    /// `carried` says, linear between the rows. The planes stay beside it for a run that is killed before it
    /// can say that it is complete; nothing may be written after.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when fewer than two planes came, or wind that is no
    /// number.
    pub fn finish(
        &mut self,
        grid: &PlaneGrid,
        hub_height: f64,
        carried: Carried,
        description: &str,
    ) -> Result<(), FileError> {
        self.flush()?;
        let n_steps = (self.n_bytes / (12 * self.n_points as u64)) as usize;
        let wrong = |problem: String| {
            let fix = "run the case longer, or leave the record out";
            FileError::content(WHAT, &self.part, problem, fix)
        };
        if n_steps < 2 {
            return Err(wrong(format!("{n_steps} planes are too few for a record")));
        }
        let columns = match carried {
            Carried::Middle => grid.n_y / 2..grid.n_y / 2 + 1,
            Carried::Width => 0..grid.n_y,
        };
        let (rows, weight) = grid.rows_at(hub_height);
        let rows = rows.map(|row| row * grid.n_y + columns.start..row * grid.n_y + columns.end);
        let n_values = (n_steps * columns.len()) as f64;
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        let (mut speed, mut finite) = (0.0, true);
        self.each_plane(n_steps, |wind| {
            for (component, range) in ranges.iter_mut().enumerate() {
                for point in wind {
                    let value = f64::from(point[component]);
                    finite &= value.is_finite();
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
            let [below, above] = rows.clone().map(|row| {
                wind[row].iter().map(|point| f64::from(point[0])).sum::<f64>() / n_values
            });
            speed += below + weight * (above - below);
            Ok(())
        })?;
        if !finite || speed <= 0.0 {
            return Err(wrong("not all of its wind is a number that blows downwind".to_owned()));
        }
        let grid = PlaneGrid { n_steps, speed, repeats: false, ..*grid };
        let mut field = turbsim::Field::create(&self.path, &grid, hub_height, ranges, description)?;
        self.each_plane(n_steps, |wind| field.write(wind))?;
        field.commit()
    }

    /// Reads the `n_steps` planes back, one after the other.
    fn each_plane(
        &self,
        n_steps: usize,
        mut take: impl FnMut(&[[f32; 3]]) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let failed = |source| FileError::system("read", WHAT, &self.part, source);
        let mut file = BufReader::with_capacity(BUFFER, File::open(&self.part).map_err(failed)?);
        let mut bytes = vec![0; 12 * self.n_points];
        let mut wind = vec![[0.0; 3]; self.n_points];
        for _ in 0..n_steps {
            file.read_exact(&mut bytes).map_err(failed)?;
            for (point, bytes) in wind.iter_mut().zip(bytes.chunks_exact(12)) {
                let value = |at: usize| {
                    f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
                };
                *point = [value(0), value(4), value(8)];
            }
            take(&wind)?;
        }
        Ok(())
    }

    fn refused(&self, source: io::Error) -> FileError {
        FileError::system("write", WHAT, &self.part, source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flow::inflow::Planes;

    const GRID: PlaneGrid = PlaneGrid {
        n_y: 3,
        n_z: 4,
        spacing: [15.0, 15.0],
        first: [-15.0, 120.0],
        interval: 0.5,
        speed: 0.0,
        n_steps: 0,
        repeats: false,
    };

    fn plane(step: usize) -> Vec<[f32; 3]> {
        (0..12)
            .map(|p| [8.0 + 0.1 * p as f32 + 0.3 * (step % 7) as f32, -0.2 * p as f32, 0.5])
            .collect()
    }

    #[test]
    fn what_is_recorded_with_a_break_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("inflow-T2.bts");
        let mut recorder = WindRecorder::create(&path, 12).unwrap();
        (0..5).for_each(|step| recorder.write(&plane(step)).unwrap());
        let kept = recorder.flush().unwrap();
        // Written after the checkpoint, and lost.
        recorder.write(&plane(40)).unwrap();
        drop(recorder);
        assert!(WindRecorder::resume(&path, 12, kept + 1).is_err());
        let gone = WindRecorder::resume(&folder.path().join("none.bts"), 12, kept).unwrap_err();
        let advice = miette::Diagnostic::help(&gone).unwrap().to_string();
        assert!(
            gone.to_string().contains("it is gone") && advice.contains("--overwrite"),
            "{gone}"
        );
        assert!(WindRecorder::resume(&path, 12, 100 * kept).is_err());
        let mut recorder = WindRecorder::resume(&path, 12, kept).unwrap();
        (5..14).for_each(|step| recorder.write(&plane(step)).unwrap());
        recorder.finish(&GRID, 150.0, Carried::Middle, "wind behind T1").unwrap();
        let mut planes = turbsim::open(&path).unwrap();
        let grid = planes.grid();
        // Hub: third row, second column.
        let hub = (0..14).map(|step| f64::from(plane(step)[7][0])).sum::<f64>() / 14.0;
        assert!((grid.speed - hub).abs() < 1e-5);
        assert_eq!(PlaneGrid { speed: 0.0, n_steps: 0, ..grid }, GRID);
        assert_eq!(grid.n_steps, 14);
        let mut wind = vec![[0.0; 3]; 12];
        for step in 0..14 {
            planes.read(step, &mut wind).unwrap();
            for (read, written) in wind.iter().flatten().zip(plane(step).iter().flatten()) {
                assert!((read - written).abs() < 1e-4, "{read} {written}");
            }
        }
        // A quarter of the way from the third row to the fourth.
        recorder.finish(&GRID, 153.75, Carried::Middle, "between rows").unwrap();
        let between = turbsim::open(&path).unwrap().grid().speed;
        assert!((between - hub - 0.25 * 0.3).abs() < 1e-5, "{between} and {hub}");
        recorder.finish(&GRID, 150.0, Carried::Width, "wind of an atmosphere").unwrap();
        let row = (0..14).flat_map(|step| plane(step)[6..9].to_vec());
        let mean = row.map(|wind| f64::from(wind[0])).sum::<f64>() / 42.0;
        assert!((turbsim::open(&path).unwrap().grid().speed - mean).abs() < 1e-5);
    }

    #[test]
    fn one_plane_or_wind_that_is_no_number_makes_no_record() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("inflow-T2.bts");
        let mut recorder = WindRecorder::create(&path, 12).unwrap();
        recorder.write(&plane(0)).unwrap();
        let error = recorder.finish(&GRID, 150.0, Carried::Width, "").unwrap_err().to_string();
        assert!(error.contains("1 planes are too few for a record"), "{error}");
        let mut calm = plane(1);
        calm[3][2] = f32::NAN;
        recorder.write(&calm).unwrap();
        assert!(recorder.finish(&GRID, 150.0, Carried::Width, "").is_err());
        assert!(!path.exists());
    }
}
