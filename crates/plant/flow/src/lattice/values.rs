//! Values written out and read back, bit for bit.

use std::io::{Read, Result, Write};

/// Values that are converted at a time.
const CHUNK: usize = 16 * 1024;

/// Writes `values`, converted in `bytes` bit by bit.
pub(super) fn write_values(
    writer: &mut dyn Write,
    bytes: &mut Vec<u8>,
    values: &[f32],
) -> Result<()> {
    for chunk in values.chunks(CHUNK) {
        bytes.clear();
        for value in chunk {
            bytes.extend_from_slice(&value.to_le_bytes());
        }
        writer.write_all(bytes)?;
    }
    Ok(())
}

/// Reads as many values as `values` has room for, through `bytes`.
pub(super) fn read_values(
    reader: &mut dyn Read,
    bytes: &mut Vec<u8>,
    values: &mut [f32],
) -> Result<()> {
    for chunk in values.chunks_mut(CHUNK) {
        bytes.resize(size_of_val(chunk), 0);
        reader.read_exact(bytes)?;
        let (words, _) = bytes.as_chunks::<4>();
        for (value, word) in chunk.iter_mut().zip(words) {
            *value = f32::from_le_bytes(*word);
        }
    }
    Ok(())
}
