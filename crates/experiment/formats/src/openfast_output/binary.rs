//! Reading OpenFAST's binary output.

use super::{LISTED_TIMES, NAME_LENGTH, PLAIN, REGULAR_TIMES, SHORT_NAME, WHAT};
use crate::table::head::{Column, Head};
use crate::{FileError, atomic};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

const COPY: &str = "copy the file again, or let OpenFAST finish";

/// The rows of a file, one at a time.
#[derive(Debug)]
pub(crate) struct BinaryRows {
    file: BufReader<File>,
    n_rows: u64,
    n_read: u64,
    clock: Clock,
    values: Values,
    row: Vec<u8>,
}

#[derive(Debug)]
enum Clock {
    Regular { first: f64, interval: f64 },
    Listed { times: Vec<u8>, scale: f64, offset: f64 },
}

#[derive(Debug)]
enum Values {
    /// Scale and offset of each channel.
    Integers(Vec<(f64, f64)>),
    Doubles,
}

impl Values {
    fn size(&self) -> usize {
        match self {
            Self::Integers(_) => 2,
            Self::Doubles => 8,
        }
    }
}

/// Opens the `.outb` at `path`.
///
/// # Errors
/// [`FileError`].
pub(crate) fn open(path: &Path) -> Result<(Head, BinaryRows), FileError> {
    let refused = |source| FileError::system("read", WHAT, path, source);
    let file = atomic::open(path).map_err(refused)?;
    let length = file.metadata().map_err(refused)?.len();
    let file = BufReader::with_capacity(1 << 18, file);
    let mut fields = Fields { path, file, place: 0, length };

    let kind = fields.kind()?;
    let name_length = match kind {
        NAME_LENGTH => fields.count("characters of a name", 2, 1)?,
        _ => SHORT_NAME,
    };
    let n_channels = fields.count("channels", 4, 1)?;
    let n_rows = fields.count("rows", 4, 1)?;
    let (first, second) = (fields.double()?, fields.double()?);
    let values = if kind == PLAIN {
        Values::Doubles
    } else {
        let scales = fields.singles("scales", n_channels)?;
        let offsets = fields.singles("offsets", n_channels)?;
        Values::Integers(scales.into_iter().zip(offsets).collect())
    };
    let n_description = fields.count("characters of description", 4, 0)?;
    let description = latin(&fields.take("description", n_description)?);
    let names = fields.words("names", n_channels + 1, name_length)?;
    let units = fields.words("units", n_channels + 1, name_length)?;

    let row = n_channels * values.size();
    let listed = if kind == LISTED_TIMES { 4 } else { 0 };
    let needed = u128::from(fields.place) + n_rows as u128 * (row + listed) as u128;
    if u128::from(length) != needed {
        let start = fields.place + (n_rows * listed) as u64;
        return Err(fields.wrong_length(needed, start, row as u64, n_rows));
    }
    let clock = if kind == LISTED_TIMES {
        let times = fields.take("times", 4 * n_rows)?;
        Clock::Listed { times, scale: first, offset: second }
    } else {
        Clock::Regular { first, interval: second }
    };
    let is_clock = match clock {
        Clock::Regular { first, interval } => {
            first.is_finite() && interval.is_finite() && interval > 0.0
        }
        Clock::Listed { scale, offset, .. } => {
            scale.is_finite() && scale != 0.0 && offset.is_finite()
        }
    };
    if !is_clock {
        let problem = format!("its header has no valid time: {first} and {second}");
        return Err(FileError::content(WHAT, path, problem, COPY));
    }
    let columns = names.into_iter().zip(units).map(|(name, unit)| {
        let unit = unit.trim_matches(['(', ')']).trim().to_owned();
        Column { name, unit }
    });
    let head = Head { description, columns: columns.collect(), time: 0 };
    let (file, row) = (fields.file, vec![0; row]);
    Ok((head, BinaryRows { file, n_rows: n_rows as u64, n_read: 0, clock, values, row }))
}

impl BinaryRows {
    /// Rows given so far.
    pub(crate) fn n_read(&self) -> u64 {
        self.n_read
    }

    /// Reads the `wanted` columns (0 is time) of the next row into `row`. False at the end.
    pub(crate) fn read(
        &mut self,
        path: &Path,
        wanted: &[usize],
        row: &mut [f64],
    ) -> Result<bool, FileError> {
        if self.n_read == self.n_rows {
            return Ok(false);
        }
        self.file
            .read_exact(&mut self.row)
            .map_err(|source| FileError::system("read", WHAT, path, source))?;
        for (value, column) in row.iter_mut().zip(wanted) {
            *value = match column.checked_sub(1) {
                None => self.time(),
                Some(channel) => self.value(channel),
            };
        }
        self.n_read += 1;
        Ok(true)
    }

    fn time(&self) -> f64 {
        match &self.clock {
            Clock::Regular { first, interval } => first + interval * self.n_read as f64,
            Clock::Listed { times, scale, offset } => {
                let place = 4 * self.n_read as usize;
                let integer = [0, 1, 2, 3].map(|byte| times[place + byte]);
                (f64::from(i32::from_le_bytes(integer)) - offset) / scale
            }
        }
    }

    fn value(&self, channel: usize) -> f64 {
        match &self.values {
            Values::Integers(scales) => {
                let (scale, offset) = scales[channel];
                let integer =
                    i16::from_le_bytes([self.row[2 * channel], self.row[2 * channel + 1]]);
                (f64::from(integer) - offset) / scale
            }
            Values::Doubles => {
                f64::from_le_bytes(std::array::from_fn(|byte| self.row[8 * channel + byte]))
            }
        }
    }
}

/// The header, taken off field by field.
struct Fields<'p> {
    path: &'p Path,
    file: BufReader<File>,
    place: u64,
    length: u64,
}

impl Fields<'_> {
    fn take(&mut self, name: &str, n_bytes: usize) -> Result<Vec<u8>, FileError> {
        // Asked first, so that a damaged count never asks for more memory than the file has bytes.
        if n_bytes as u64 > self.length - self.place {
            let problem = format!(
                "it ends after {} bytes, within the {name} of its header at byte {}",
                self.length, self.place
            );
            return Err(FileError::content(WHAT, self.path, problem, COPY));
        }
        let mut bytes = vec![0; n_bytes];
        self.file
            .read_exact(&mut bytes)
            .map_err(|source| FileError::system("read", WHAT, self.path, source))?;
        self.place += n_bytes as u64;
        Ok(bytes)
    }

    fn kind(&mut self) -> Result<i16, FileError> {
        let bytes = self.take("kind", 2)?;
        let kind = i16::from_le_bytes([bytes[0], bytes[1]]);
        let is_known = |kind| [LISTED_TIMES, REGULAR_TIMES, PLAIN, NAME_LENGTH].contains(&kind);
        if is_known(kind) {
            return Ok(kind);
        }
        let (problem, fix) = if is_known(kind.swap_bytes()) {
            let problem = format!(
                "byte 0: its kind is {} with its bytes swapped: the byte order is big-endian",
                kind.swap_bytes()
            );
            (problem, "write the file in little-endian order")
        } else {
            let problem = format!("byte 0: its kind is {kind}, none of 1 to 4");
            (problem, "give a binary output of OpenFAST (OutFileFmt 2, 3, 4 or 5)")
        };
        Err(FileError::content(WHAT, self.path, problem, fix))
    }

    /// A count of `n_bytes` bytes that is not below `least`.
    fn count(&mut self, name: &str, n_bytes: usize, least: i32) -> Result<usize, FileError> {
        let place = self.place;
        let bytes = self.take(name, n_bytes)?;
        let count = match bytes[..] {
            [a, b] => i32::from(i16::from_le_bytes([a, b])),
            _ => i32::from_le_bytes(std::array::from_fn(|byte| bytes[byte])),
        };
        usize::try_from(count).ok().filter(|_| count >= least).ok_or_else(|| {
            let problem = format!("byte {place}: its header counts {count} {name}");
            FileError::content(WHAT, self.path, problem, COPY)
        })
    }

    fn double(&mut self) -> Result<f64, FileError> {
        let bytes = self.take("time", 8)?;
        Ok(f64::from_le_bytes(std::array::from_fn(|byte| bytes[byte])))
    }

    fn singles(&mut self, name: &str, count: usize) -> Result<Vec<f64>, FileError> {
        let bytes = self.take(name, 4 * count)?;
        let single = |four: &[u8]| f32::from_le_bytes(std::array::from_fn(|byte| four[byte]));
        Ok(bytes.chunks_exact(4).map(|four| f64::from(single(four))).collect())
    }

    fn words(&mut self, name: &str, count: usize, length: usize) -> Result<Vec<String>, FileError> {
        let bytes = self.take(name, count * length)?;
        Ok(bytes.chunks_exact(length).map(latin).collect())
    }

    fn wrong_length(&self, needed: u128, start: u64, row: u64, n_rows: usize) -> FileError {
        let how = if u128::from(self.length) > needed {
            "it goes on behind the last row".to_owned()
        } else if self.length < start {
            "it ends within the times".to_owned()
        } else {
            format!("it ends within row {} of {n_rows}", (self.length - start) / row + 1)
        };
        let problem = format!("{} bytes instead of {needed} for {n_rows} rows: {how}", self.length);
        FileError::content(WHAT, self.path, problem, COPY)
    }
}

/// Text of one byte a character, as Fortran and its readers take it, without blanks and zeros around.
fn latin(bytes: &[u8]) -> String {
    let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
    text.trim_matches(|character: char| character.is_whitespace() || character == '\0').to_owned()
}
