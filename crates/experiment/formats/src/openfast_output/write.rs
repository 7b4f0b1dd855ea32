//! Writing OpenFAST's binary output, row by row.

use super::{NAME_LENGTH, PLAIN, SHORT_NAME, WHAT};
use crate::FileError;
use crate::atomic::AtomicFile;
use crate::beside;
use crate::table::head::Column;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

const BUFFER: usize = 1 << 18;
/// Integers that 16 bits tell apart, less the two ends, which rounding may need.
const STEPS: f64 = 65_533.0;
/// Smallest range that is spread over the integers, relative to the largest value: below it, 32-bit offsets
/// are too coarse.
const LEAST_RANGE: f64 = 1e-6;
/// Largest value that 32-bit scales can serve.
const LARGEST: f64 = 1e30;
/// Smallest range that 32-bit scales can serve.
const SMALLEST: f64 = 1e-30;

/// What the file says above its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// What was simulated, in words.
    pub description: String,
    /// Channels without time.
    pub channels: Vec<Column>,
    /// Time of the first row (s).
    pub start: f64,
    /// Time between rows (s).
    pub interval: f64,
}

/// How values are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// 16-bit integers spread over each channel's range, as OpenFAST does by default: errors of at most
    /// 1/131000 of the range, names of any length, read by pyDatView and openfast_toolbox.
    Compressed,
    /// Doubles, to the last bit, as OpenFAST's regression tests write them; names of at most 10 characters.
    /// Not read by openfast_toolbox unless asked for `use_buffer`.
    Exact,
}

/// Writes one `.outb`; it appears whole with [`finish`](Self::finish), or not at all.
///
/// Until then rows gather in a hidden file beside it, so that memory does not grow with them.
#[derive(Debug)]
pub struct OutbWriter {
    path: PathBuf,
    layout: Layout,
    encoding: Encoding,
    spool: Spool,
    /// Least and greatest value of each channel.
    ranges: Vec<(f64, f64)>,
    n_rows: i32,
    row: Vec<u8>,
}

impl OutbWriter {
    /// Starts the file that will stand at `path`. The folder must exist.
    ///
    /// # Errors
    /// [`FileError::System`]; [`FileError::Content`] for no channels, a name that the format cannot hold, or
    /// no interval.
    pub fn create(path: &Path, layout: Layout, encoding: Encoding) -> Result<Self, FileError> {
        check(path, &layout, encoding)?;
        let n_channels = layout.channels.len();
        Ok(Self {
            path: path.to_owned(),
            encoding,
            spool: Spool::create(path)?,
            ranges: vec![(f64::INFINITY, f64::NEG_INFINITY); n_channels],
            n_rows: 0,
            row: Vec::with_capacity(8 * n_channels),
            layout,
        })
    }

    /// Whether the format has a place for `value`: not for what is no finite number.
    pub fn holds(value: f64) -> bool {
        value.abs() <= LARGEST
    }

    /// Adds one row: the channels in their order, without time.
    ///
    /// # Errors
    /// [`FileError::System`]; [`FileError::Content`] for a value that is not finite, naming channel and time,
    /// or one row more than the format counts.
    ///
    /// # Panics
    /// When `row` has not one value per channel.
    pub fn write(&mut self, row: &[f64]) -> Result<(), FileError> {
        assert_eq!(row.len(), self.ranges.len(), "a row has one value per channel");
        self.row.clear();
        for (index, (value, range)) in row.iter().zip(&mut self.ranges).enumerate() {
            if !Self::holds(*value) {
                let name = &self.layout.channels[index].name;
                let time = self.layout.start + self.layout.interval * f64::from(self.n_rows);
                let problem = format!("at {time} s {name} is {value}");
                let fix = "find out why the simulation gave no finite number there";
                return Err(FileError::content(WHAT, &self.path, problem, fix));
            }
            *range = (range.0.min(*value), range.1.max(*value));
            self.row.extend_from_slice(&value.to_le_bytes());
        }
        self.n_rows = self.n_rows.checked_add(1).ok_or_else(|| {
            let problem = format!("the format counts no more than {} rows", i32::MAX);
            FileError::content(WHAT, &self.path, problem, "write fewer rows a second")
        })?;
        self.spool.file.write_all(&self.row).map_err(|e| refused(&self.path, e))
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`FileError::System`]; [`FileError::Content`] when there was no row.
    pub fn finish(mut self) -> Result<(), FileError> {
        if self.n_rows == 0 {
            let fix = "simulate at least one step";
            return Err(FileError::content(WHAT, &self.path, "there was no row to write", fix));
        }
        let scales: Vec<(f32, f32)> = match self.encoding {
            Encoding::Compressed => self.ranges.iter().map(|range| scale(*range)).collect(),
            Encoding::Exact => Vec::new(),
        };
        let mut file = AtomicFile::create(&self.path, WHAT)?;
        file.write_all(&self.header(&scales)).map_err(|e| refused(&self.path, e))?;
        self.copy(&scales, &mut file).map_err(|e| refused(&self.path, e))?;
        file.commit()
    }

    fn header(&self, scales: &[(f32, f32)]) -> Vec<u8> {
        let Layout { description, channels, start, interval } = &self.layout;
        let mut bytes = Vec::new();
        let name_length = match self.encoding {
            Encoding::Compressed => {
                let longest = channels.iter().map(|c| c.name.len().max(c.unit.len() + 2)).max();
                longest.unwrap_or(0).max(SHORT_NAME)
            }
            Encoding::Exact => SHORT_NAME,
        };
        match self.encoding {
            Encoding::Compressed => {
                bytes.extend_from_slice(&NAME_LENGTH.to_le_bytes());
                bytes.extend_from_slice(&(name_length as i16).to_le_bytes());
            }
            Encoding::Exact => bytes.extend_from_slice(&PLAIN.to_le_bytes()),
        }
        bytes.extend_from_slice(&(channels.len() as i32).to_le_bytes());
        bytes.extend_from_slice(&self.n_rows.to_le_bytes());
        bytes.extend_from_slice(&start.to_le_bytes());
        bytes.extend_from_slice(&interval.to_le_bytes());
        let firsts = scales.iter().map(|scale| scale.0);
        for number in firsts.chain(scales.iter().map(|scale| scale.1)) {
            bytes.extend_from_slice(&number.to_le_bytes());
        }
        let description: String =
            description.chars().map(|c| if c.is_ascii() { c } else { '?' }).collect();
        bytes.extend_from_slice(&(description.len() as i32).to_le_bytes());
        bytes.extend_from_slice(description.as_bytes());
        let mut word = |word: &str| {
            bytes.extend_from_slice(word.as_bytes());
            bytes.resize(bytes.len() + name_length - word.len(), b' ');
        };
        word("Time");
        channels.iter().for_each(|channel| word(&channel.name));
        word("(s)");
        channels.iter().for_each(|channel| word(&format!("({})", channel.unit)));
        bytes
    }

    /// Copies the gathered rows to `file`, packed with `scales` unless there are none.
    fn copy(&mut self, scales: &[(f32, f32)], file: &mut AtomicFile) -> io::Result<()> {
        self.spool.file.flush()?;
        let gathered = self.spool.file.get_mut();
        gathered.rewind()?;
        let mut gathered = BufReader::with_capacity(BUFFER, gathered);
        if scales.is_empty() {
            return io::copy(&mut gathered, file).map(|_| ());
        }
        let mut packed = Vec::with_capacity(2 * scales.len());
        for _ in 0..self.n_rows {
            self.row.resize(8 * scales.len(), 0);
            gathered.read_exact(&mut self.row)?;
            packed.clear();
            for (bytes, (scale, offset)) in self.row.chunks_exact(8).zip(scales) {
                let value = f64::from_le_bytes(std::array::from_fn(|byte| bytes[byte]));
                let integer = (f64::from(*scale) * value + f64::from(*offset)).round();
                let ends = (f64::from(i16::MIN), f64::from(i16::MAX));
                packed.extend_from_slice(&(integer.clamp(ends.0, ends.1) as i16).to_le_bytes());
            }
            file.write_all(&packed)?;
        }
        Ok(())
    }
}

fn check(path: &Path, layout: &Layout, encoding: Encoding) -> Result<(), FileError> {
    let refusal = |problem: String, fix: &str| Err(FileError::content(WHAT, path, problem, fix));
    if layout.channels.is_empty() {
        return refusal("there is no channel to write".into(), "choose at least one channel");
    }
    let (start, interval) = (layout.start, layout.interval);
    if !(start.is_finite() && interval.is_finite() && interval > 0.0) {
        let problem = format!("rows every {interval} s from {start} s on are not a time");
        return refusal(problem, "give a start and a positive interval in seconds");
    }
    let longest = match encoding {
        Encoding::Compressed => 1000,
        Encoding::Exact => SHORT_NAME,
    };
    for Column { name, unit } in &layout.channels {
        let is_word = |text: &str| text.chars().all(|c| c.is_ascii_graphic());
        if name.is_empty() || !is_word(name) || !is_word(unit) {
            let problem = format!("the channel \"{name}\" in \"{unit}\" is not one word of ASCII");
            return refusal(problem, "use letters, digits and signs without blanks, such as kN-m");
        }
        if name.len() > longest || unit.len() + 2 > longest {
            let problem = format!("the channel \"{name}\" in \"{unit}\" is too long a name");
            return refusal(problem, "shorten it, or write compressed output");
        }
    }
    Ok(())
}

/// Scale and offset that spread the values from `least` to `most` over the integers.
///
/// Rounding to 32 bits shifts offsets by whole integers where the values lie far from zero: the ends keep as
/// much free.
fn scale((least, most): (f64, f64)) -> (f32, f32) {
    let largest = least.abs().max(most.abs());
    let range = (most - least).max(LEAST_RANGE * largest).max(SMALLEST);
    let middle = least + 0.5 * (most - least);
    let spare = 2.0 * f64::from(f32::EPSILON) * middle.abs() * STEPS / range;
    let scale = ((STEPS - 2.0 * spare.ceil()) / range) as f32;
    (scale, (-f64::from(scale) * middle) as f32)
}

fn refused(path: &Path, source: io::Error) -> FileError {
    FileError::system("write", WHAT, path, source)
}

/// A hidden file that rows gather in; gone when dropped.
#[derive(Debug)]
struct Spool {
    file: BufWriter<File>,
    path: PathBuf,
}

impl Spool {
    /// Rows of the file that will stand at `file`.
    fn create(file: &Path) -> Result<Self, FileError> {
        let path = beside::beside(file, beside::ROWS);
        let mut options = File::options();
        let rows = options.read(true).write(true).create(true).truncate(true).open(&path);
        let rows = rows.map_err(|source| refused(file, source))?;
        beside::claim(&rows);
        Ok(Self { file: BufWriter::with_capacity(BUFFER, rows), path })
    }
}

impl Drop for Spool {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}
