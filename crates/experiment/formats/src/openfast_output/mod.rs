//! OpenFAST's results: binary `.outb` read and written, text `.out` read.
//!
//! Reading goes through [`TableReader`](crate::table::TableReader), which knows other tables as well. Writing
//! streams: rows gather on disk beside the file's place, and the file appears, whole, when the last one is
//! in.
//!
//! The binary format (little-endian; OpenFAST's NWTC library, subroutine `WrBinFAST`):
//!
//! | what | type | in files of kind |
//! | --- | --- | --- |
//! | kind: 1 listed times, 2 regular times, 3 with doubles, 4 as 2 with the length of names | i16 | all |
//! | characters of a name or unit (10 in the others) | i16 | 4 |
//! | channels n without time, rows | 2 × i32 | all |
//! | scale and offset of time; or first time and interval (s) | 2 × f64 | 1; others |
//! | scales, then offsets | 2 n × f32 | 1, 2, 4 |
//! | length of the description, description | i32, bytes | all |
//! | names, then units, blank-filled, time first | 2 (n + 1) words | all |
//! | times | rows × i32 | 1 |
//! | values, row by row: (integer − offset) / scale, or the value itself | i16 or f64 | 1, 2, 4 or 3 |

mod binary;
mod text;
mod write;

pub(crate) use binary::{BinaryRows, open as open_binary};
pub(crate) use text::open as open_text;
pub use write::{Encoding, Layout, OutbWriter};

const WHAT: &str = "OpenFAST's binary output";

const LISTED_TIMES: i16 = 1;
const REGULAR_TIMES: i16 = 2;
const PLAIN: i16 = 3;
const NAME_LENGTH: i16 = 4;
/// Characters of a name where the file does not say.
const SHORT_NAME: usize = 10;

#[cfg(test)]
pub(crate) mod tests;
