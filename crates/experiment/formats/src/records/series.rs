//! The series of a run: one row a control instant, as CSV that pandas and spreadsheets open. Rows are given
//! in SI units and written in those of the channels.

use crate::checkpoint::{ANEW, GONE};
use crate::{FileError, atomic};
use basis::{Channel, Unit};
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

pub(super) const WHAT: &str = "the series";
pub(super) const BUFFER: usize = 1 << 18;

/// Writes rows as they come; the file bears its name once it is whole, until then `.part` after it.
///
/// Numbers have the fewest digits that read back to the same bits, so a resumed series equals an
/// uninterrupted one.
#[derive(Debug)]
pub struct SeriesWriter {
    file: BufWriter<File>,
    part: PathBuf,
    path: PathBuf,
    line: Vec<u8>,
    units: Vec<Unit>,
    n_bytes: u64,
}

impl SeriesWriter {
    /// Starts the series that will stand at `path`, with these `channels`.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn create(path: &Path, channels: &[Channel]) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        let file = File::create(&part).map_err(|e| FileError::system("write", WHAT, &part, e))?;
        let mut writer = Self::new(file, part, path, channels, 0);
        writer.line = columns(channels).join(",").into_bytes();
        writer.end_line()?;
        Ok(writer)
    }

    /// Goes on with the series that will stand at `path`, with these `channels`, after its first `n_bytes`;
    /// what came after them goes.
    ///
    /// # Errors
    /// [`FileError::System`], and [`FileError::Content`] when it is shorter than that, does not end a row
    /// there or has other channels.
    pub fn resume(path: &Path, channels: &[Channel], n_bytes: u64) -> Result<Self, FileError> {
        let part = atomic::part_of(path);
        let failed = |source| FileError::system("read", WHAT, &part, source);
        if !part.exists() && path.exists() {
            // Completed, but its run was killed before it could say so.
            fs::rename(path, &part).map_err(failed)?;
        }
        if !part.exists() {
            return Err(FileError::content(WHAT, &part, GONE.to_owned(), ANEW));
        }
        let mut file = File::options().read(true).write(true).open(&part).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        if length < n_bytes || n_bytes == 0 {
            let problem = format!("it has {length} bytes, the checkpoint has {n_bytes}");
            return Err(FileError::content(WHAT, &part, problem, ANEW));
        }
        let mut header = String::new();
        let names = columns(channels);
        let most = names.iter().map(|name| name.len() as u64 + 1).sum::<u64>() + 1;
        BufReader::new((&file).take(most)).read_line(&mut header).map_err(failed)?;
        check_names(&part, header.trim_end(), &names)?;
        let mut last = [0];
        file.seek(SeekFrom::Start(n_bytes - 1)).map_err(failed)?;
        file.read_exact(&mut last).map_err(failed)?;
        if last != *b"\n" {
            let problem = format!("no row ends at byte {n_bytes}, as the checkpoint says");
            return Err(FileError::content(WHAT, &part, problem, ANEW));
        }
        file.set_len(n_bytes).map_err(failed)?;
        Ok(Self::new(file, part, path, channels, n_bytes))
    }

    fn new(file: File, part: PathBuf, path: &Path, channels: &[Channel], n_bytes: u64) -> Self {
        let file = BufWriter::with_capacity(BUFFER, file);
        let units = channels.iter().map(|channel| channel.unit).collect();
        Self { file, part, path: path.to_owned(), line: Vec::new(), units, n_bytes }
    }

    /// Adds one row, in the order of the channels and in SI units.
    ///
    /// # Errors
    /// [`FileError::System`].
    ///
    /// # Panics
    /// When `row` has not one value per channel.
    pub fn write(&mut self, row: &[f64]) -> Result<(), FileError> {
        assert_eq!(row.len(), self.units.len(), "a row has one value per channel");
        self.line.clear();
        for (index, (value, unit)) in row.iter().zip(&self.units).enumerate() {
            if index > 0 {
                self.line.push(b',');
            }
            // Writing to memory cannot fail.
            let _ = write!(self.line, "{:?}", unit.of_si(*value));
        }
        self.end_line()
    }

    fn end_line(&mut self) -> Result<(), FileError> {
        self.line.push(b'\n');
        self.file.write_all(&self.line).map_err(|e| self.refused(e))?;
        self.n_bytes += self.line.len() as u64;
        Ok(())
    }

    /// Puts all rows on the disk; gives the bytes that are there, for [`resume`](Self::resume).
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn flush(&mut self) -> Result<u64, FileError> {
        let done = self.file.flush().and_then(|()| self.file.get_ref().sync_data());
        done.map_err(|source| self.refused(source))?;
        Ok(self.n_bytes)
    }

    /// Completes the series: it now bears its name. Nothing may be written after it.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub fn finish(&mut self) -> Result<(), FileError> {
        self.flush()?;
        fs::rename(&self.part, &self.path).map_err(|source| self.refused(source))?;
        atomic::sync_folder(&self.path);
        Ok(())
    }

    /// Where the rows are until the series is complete.
    pub fn part_path(&self) -> &Path {
        &self.part
    }

    fn refused(&self, source: io::Error) -> FileError {
        FileError::system("write", WHAT, &self.part, source)
    }
}

/// What the columns of `channels` are called.
fn columns(channels: &[Channel]) -> Vec<String> {
    channels.iter().map(Channel::column).collect()
}

/// Whether the series at `part`, which begins with `header`, has the channels `names`.
fn check_names(part: &Path, header: &str, names: &[String]) -> Result<(), FileError> {
    let mut found = header.split(',');
    for (index, name) in names.iter().enumerate() {
        let here = found.next().unwrap_or_default();
        if here != name {
            let problem = format!(
                "line 1: channel {} is `{here}`, this run writes `{name}` there, one of {}",
                index + 1,
                names.len()
            );
            return Err(FileError::content(WHAT, part, problem, ANEW));
        }
    }
    if found.next().is_some() {
        let problem = format!("line 1: it has more than the {} channels of this run", names.len());
        return Err(FileError::content(WHAT, part, problem, ANEW));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::read_series;
    use super::*;
    use basis::channels::{BLD_PITCH, GEN_PWR, TIME};
    use proptest::prelude::*;

    fn channels() -> Vec<Channel> {
        vec![TIME, GEN_PWR.of("T1"), BLD_PITCH.of_blade(1).of("T1")]
    }

    fn row(step: usize) -> [f64; 3] {
        let time = step as f64 * (60.0 / 419.0);
        [time, 5e6 * (0.3 * time).sin(), 1e-9 * (1.7 * time).cos()]
    }

    #[test]
    fn a_resumed_series_equals_an_uninterrupted_one() {
        let folder = tempfile::tempdir().unwrap();
        let [whole, broken] = ["whole.csv", "broken.csv"].map(|name| folder.path().join(name));
        let mut writer = SeriesWriter::create(&whole, &channels()).unwrap();
        (0..300).for_each(|step| writer.write(&row(step)).unwrap());
        writer.finish().unwrap();

        let mut writer = SeriesWriter::create(&broken, &channels()).unwrap();
        (0..120).for_each(|step| writer.write(&row(step)).unwrap());
        let n_bytes = writer.flush().unwrap();
        // Rows after the checkpoint, the last one torn by the kill.
        (120..150).for_each(|step| writer.write(&row(step)).unwrap());
        writer.flush().unwrap();
        fs::OpenOptions::new()
            .append(true)
            .open(writer.part_path())
            .unwrap()
            .write_all(b"17.2,4")
            .unwrap();
        drop(writer);
        assert!(!broken.exists());

        let mut writer = SeriesWriter::resume(&broken, &channels(), n_bytes).unwrap();
        (120..300).for_each(|step| writer.write(&row(step)).unwrap());
        writer.finish().unwrap();
        assert_eq!(fs::read(&whole).unwrap(), fs::read(&broken).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);

        let series = read_series(&broken, |_| true).unwrap();
        assert_eq!(series.names, ["Time", "T1.GenPwr", "T1.BldPitch1"]);
        let text = fs::read_to_string(&broken).unwrap();
        assert!(text.starts_with("Time_s,T1.GenPwr_kW,T1.BldPitch1_deg\n0.0,0.0,"), "{text}");
        // Kilowatts and degrees in the file, SI beside it.
        let close = |value: f64, written: f64| (value - written).abs() <= 1e-15 * written.abs();
        for step in 0..300 {
            let read = |column: usize| series.columns[column][step];
            assert_eq!(read(0).to_bits(), row(step)[0].to_bits());
            assert!(close(read(1), row(step)[1]) && close(read(2), row(step)[2]), "{step}");
        }
        let line: Vec<f64> =
            text.lines().nth(8).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(close(line[1], row(7)[1] / 1e3) && close(line[2], row(7)[2].to_degrees()));
    }

    #[test]
    fn a_finished_series_can_be_taken_up_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        let mut writer = SeriesWriter::create(&path, &channels()).unwrap();
        writer.write(&row(0)).unwrap();
        let n_bytes = writer.flush().unwrap();
        writer.write(&row(1)).unwrap();
        writer.finish().unwrap();
        let mut writer = SeriesWriter::resume(&path, &channels(), n_bytes).unwrap();
        writer.write(&row(1)).unwrap();
        writer.finish().unwrap();
        assert_eq!(read_series(&path, |_| true).unwrap().columns[0].len(), 2);
    }

    #[test]
    fn a_series_that_does_not_fit_the_checkpoint_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        let mut writer = SeriesWriter::create(&path, &channels()).unwrap();
        writer.write(&row(1)).unwrap();
        let n_bytes = writer.flush().unwrap();
        let error = SeriesWriter::resume(&path, &channels(), n_bytes + 10).unwrap_err();
        assert!(error.to_string().contains("the checkpoint has"), "{error}");
        let error = SeriesWriter::resume(&path, &channels(), n_bytes - 3).unwrap_err();
        assert!(error.to_string().contains("no row ends at byte"), "{error}");
        let error =
            SeriesWriter::resume(&folder.path().join("other.csv"), &channels(), 5).unwrap_err();
        assert!(error.to_string().contains("it is gone"), "{error}");
        let advice = miette::Diagnostic::help(&error).unwrap().to_string();
        assert!(advice.contains("--overwrite"), "{advice}");
    }

    #[test]
    fn a_series_of_other_channels_is_told_and_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("series.csv");
        let fewer: Vec<Channel> = channels()[..2].to_vec();
        let renamed = vec![TIME, GEN_PWR.of("T22"), BLD_PITCH.of_blade(1).of("T22")];
        for (written, said) in [
            (fewer, "channel 3 is ``, this run writes `T1.BldPitch1_deg` there, one of 3"),
            ([channels(), channels()].concat(), "more than the 3 channels of this run"),
            (renamed, "channel 2 is `T22.GenPwr_kW`, this run writes `T1.GenPwr_kW`"),
        ] {
            let mut writer = SeriesWriter::create(&path, &written).unwrap();
            writer.write(&vec![0.5; written.len()]).unwrap();
            let n_bytes = writer.flush().unwrap();
            drop(writer);
            let before = fs::read(folder.path().join("series.csv.part")).unwrap();
            let error = SeriesWriter::resume(&path, &channels(), n_bytes).unwrap_err();
            assert!(error.to_string().contains(said), "{error}");
            assert!(error.to_string().contains("series.csv.part"), "{error}");
            let help = miette::Diagnostic::help(&error).unwrap().to_string();
            assert!(help.contains("--overwrite"), "{help}");
            assert!(fs::read(folder.path().join("series.csv.part")).unwrap() == before);
        }
    }

    proptest! {
        #[test]
        fn every_number_comes_back_bit_for_bit(bits in prop::collection::vec(any::<u64>(), 1..20)) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("series.csv");
            let mut writer = SeriesWriter::create(&path, &[TIME]).unwrap();
            for bits in &bits {
                writer.write(&[f64::from_bits(*bits)]).unwrap();
            }
            writer.finish().unwrap();
            for (value, bits) in read_series(&path, |_| true).unwrap().columns[0].iter().zip(bits) {
                let same = value.to_bits() == bits;
                prop_assert!(same || value.is_nan() && f64::from_bits(bits).is_nan());
            }
        }
    }
}
