//! Bytes read where they lie in a file, each once, and asked for ahead of need.

use crate::atomic;
use std::fs::File;
use std::io;
use std::path::Path;

/// Bytes that are read at a time: they stay in a core's cache until they are numbers, and hold whole points.
const PIECE: usize = 24 << 13;

/// A file that is read in places.
pub(super) struct PlacedReader {
    file: File,
    length: u64,
    /// Room for a piece.
    bytes: Vec<u8>,
}

impl PlacedReader {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// What the system says, and what is no file.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let file = atomic::open(path)?;
        let length = file.metadata()?.len();
        Ok(Self { file, length, bytes: Vec::new() })
    }

    /// Bytes of the file when it was opened.
    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// The same with the file at `path`.
    ///
    /// # Errors
    /// Those of [`PlacedReader::open`].
    pub(super) fn turn_to(&mut self, path: &Path) -> io::Result<()> {
        let bytes = std::mem::take(&mut self.bytes);
        *self = Self { bytes, ..Self::open(path)? };
        Ok(())
    }

    /// Hands `take` the `n_bytes` from `offset` on, piece by piece.
    ///
    /// # Errors
    /// What the system says; an end that comes too early.
    pub(super) fn read(
        &mut self,
        offset: u64,
        n_bytes: usize,
        mut take: impl FnMut(&[u8]),
    ) -> io::Result<()> {
        self.bytes.resize(PIECE, 0);
        for start in (0..n_bytes).step_by(PIECE) {
            let piece = &mut self.bytes[..PIECE.min(n_bytes - start)];
            read_at(&self.file, offset + start as u64, piece)?;
            take(piece);
        }
        Ok(())
    }

    /// Asks the system for the `n_bytes` from `offset` on, which will be read soon. Advice only.
    pub(super) fn advise(&self, offset: u64, n_bytes: usize) {
        #[cfg(target_os = "linux")]
        for start in (0..n_bytes).step_by(PIECE) {
            let length = std::num::NonZeroU64::new(PIECE.min(n_bytes - start) as u64);
            let at = offset + start as u64;
            // A file system that takes no advice is read without it.
            let _ = rustix::fs::fadvise(&self.file, at, length, rustix::fs::Advice::WillNeed);
        }
        #[cfg(not(target_os = "linux"))]
        let _ = (offset, n_bytes);
    }
}

#[cfg(unix)]
fn read_at(file: &File, offset: u64, bytes: &mut [u8]) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, offset)
}

#[cfg(not(unix))]
fn read_at(mut file: &File, offset: u64, bytes: &mut [u8]) -> io::Result<()> {
    use std::io::{Read, Seek};
    file.seek(io::SeekFrom::Start(offset))?;
    file.read_exact(bytes)
}
