//! Planes of equal length in a file, read in blocks of neighbours.

use crate::FileError;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Bytes of a block, where a plane is not longer.
const BLOCK: usize = 1 << 18;

/// Planes of equal length in a file. One block of neighbours is in memory, so that planes may be asked for in
/// either direction without asking the system for each.
#[derive(Debug)]
pub(super) struct Blocks {
    file: File,
    path: PathBuf,
    what: &'static str,
    /// Byte of the first plane.
    start: u64,
    bytes_per_plane: usize,
    n_planes: usize,
    bytes: Vec<u8>,
    /// Planes of the file that are in memory.
    held: Range<usize>,
}

impl Blocks {
    /// The `n_planes` planes, at least one, that follow byte `start` of `file`, which stands at `path` and
    /// holds `what`.
    pub(super) fn new(
        file: File,
        path: &Path,
        what: &'static str,
        start: u64,
        bytes_per_plane: usize,
        n_planes: usize,
    ) -> Self {
        let per_block = (BLOCK / bytes_per_plane).clamp(1, n_planes);
        let bytes = vec![0; per_block * bytes_per_plane];
        let path = path.to_owned();
        Self { file, path, what, start, bytes_per_plane, n_planes, bytes, held: 0..0 }
    }

    /// Where the file stands.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The bytes of the plane at place `place` in the file, from 0.
    ///
    /// # Errors
    /// [`FileError::System`].
    pub(super) fn plane(&mut self, place: usize) -> Result<&[u8], FileError> {
        if !self.held.contains(&place) {
            self.fetch(place)
                .map_err(|source| FileError::system("read", self.what, &self.path, source))?;
        }
        let first = (place - self.held.start) * self.bytes_per_plane;
        Ok(&self.bytes[first..first + self.bytes_per_plane])
    }

    /// On return the block with the plane at `place` is in memory.
    fn fetch(&mut self, place: usize) -> io::Result<()> {
        let per_block = self.bytes.len() / self.bytes_per_plane;
        let first = place / per_block * per_block;
        let end = (first + per_block).min(self.n_planes);
        if place >= end {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        // After a failure it is not known what the bytes are.
        self.held = 0..0;
        let byte = self.start + first as u64 * self.bytes_per_plane as u64;
        self.file.seek(SeekFrom::Start(byte))?;
        self.file.read_exact(&mut self.bytes[..(end - first) * self.bytes_per_plane])?;
        self.held = first..end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Planes of 100 000 bytes, two to a block: forwards, backwards, across, and none behind the last one.
    #[test]
    fn planes_are_those_of_the_file_in_any_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("planes");
        let plane = |place: usize| vec![place as u8; 100_000];
        let planes: Vec<u8> = (0..7).flat_map(plane).collect();
        fs::write(&path, [&[9; 5][..], &planes].concat()).unwrap();
        let file = File::open(&path).unwrap();
        let mut blocks = Blocks::new(file, &path, "planes", 5, 100_000, 7);
        for place in [0, 1, 2, 3, 4, 5, 6, 5, 4, 3, 2, 1, 0, 6, 0, 3] {
            assert!(blocks.plane(place).unwrap() == plane(place), "{place}");
        }
        for place in [7, 8, 1000] {
            let error = blocks.plane(place).unwrap_err();
            assert!(matches!(error, FileError::System { path: named, .. } if named == path));
        }
        // What is gone is reported, and what came before it is still there.
        File::options().write(true).open(&path).unwrap().set_len(350_000).unwrap();
        assert!(blocks.plane(4).is_err());
        assert!(blocks.plane(3).is_err());
        assert!(blocks.plane(1).unwrap() == plane(1));
    }
}
