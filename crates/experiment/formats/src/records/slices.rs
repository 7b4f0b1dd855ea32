//! The slices of wind that a run has recorded: a file for each, `slices-NAME-3D.bts`.

use super::RunFolder;
use std::path::PathBuf;

/// What the name of a recorded slice begins with.
pub(super) const SLICES: &str = "slices-";

impl RunFolder {
    /// `slices-wake-3D.bts`: the slice called `3D` of the output `name`.
    pub fn slice_path(&self, name: &str, slice: &str) -> PathBuf {
        self.path.join(format!("{SLICES}{name}-{slice}.bts"))
    }
}
