//! Changes over the phase offset, with the curves through them, of all turbines of a study that join a helix.

use crate::PostprocessingError;
use crate::synchronisation::synchronisation;
use formats::records;
use report::OffsetFigure;
use std::path::Path;

/// What the study in `directory` tells over the phase offset: for each turbine that joins a helix, by its
/// name, its figures of power and loads.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be read, and [`PostprocessingError::NoOffsets`] where no
/// run with an offset compares with another.
pub fn over_offset(
    directory: &Path,
) -> Result<Vec<(String, Vec<OffsetFigure>)>, PostprocessingError> {
    let study = records::read_study(directory)?;
    let found: Vec<_> = synchronisation(&study, directory)?
        .into_iter()
        .filter(|joined| !joined.offsets.is_empty())
        .map(|joined| (joined.name, joined.offsets))
        .collect();
    if found.is_empty() {
        return Err(PostprocessingError::NoOffsets { directory: directory.to_owned() });
    }
    Ok(found)
}
