//! Plain data written piece by piece, so that no copy of it is made in memory first.

use serde::Serialize;
use std::io::{self, Write};

/// Writes `state` to `writer`.
///
/// # Errors
/// What `writer` says, which postcard does not hand on.
pub(super) fn write_state(state: &impl Serialize, writer: &mut dyn Write) -> io::Result<()> {
    let mut told = Told { writer, error: None };
    match postcard::to_io(state, &mut told) {
        Ok(_) => Ok(()),
        Err(error) => Err(told.error.unwrap_or_else(|| io::Error::other(error))),
    }
}

/// A writer that remembers what went wrong.
struct Told<'a> {
    writer: &'a mut dyn Write,
    error: Option<io::Error>,
}

impl Told<'_> {
    fn keep<T>(&mut self, done: io::Result<T>) -> io::Result<T> {
        done.map_err(|error| {
            let kind = error.kind();
            self.error = Some(error);
            kind.into()
        })
    }
}

impl Write for Told<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let done = self.writer.write(bytes);
        self.keep(done)
    }

    fn flush(&mut self) -> io::Result<()> {
        let done = self.writer.flush();
        self.keep(done)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Takes so many bytes, then says that it is full.
    struct Small(usize);

    impl Write for Small {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::StorageFull)?;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn the_bytes_are_those_of_a_copy_and_a_full_disk_is_named() {
        let state = (vec![1.5_f64; 300], "words".to_owned(), Some(7_u64));
        let mut bytes = Vec::new();
        write_state(&state, &mut bytes).unwrap();
        assert_eq!(bytes, postcard::to_stdvec(&state).unwrap());
        let error = write_state(&state, &mut Small(1000)).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}
