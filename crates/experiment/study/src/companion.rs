//! A precursor that goes on beside a run.

use crate::StudyError;
use crate::atmosphere::{folder_of, precursor_of};
use crate::precursor::standing;
use farm::case::Case;
use farm::precursor::Companion;
use std::path::Path;

/// The precursor of `case`, whose paths are relative to `folder`, to go on beside a run; none where none is
/// to.
///
/// # Errors
/// [`StudyError`] when it cannot be read, or was made by another program or on another machine.
pub(crate) fn companion(case: &Case, folder: &Path) -> Result<Option<Companion>, StudyError> {
    let Some(folder) = folder_of(case, folder).filter(|_| case.wind.precursor_beside) else {
        return Ok(None);
    };
    let (mut file, planes) = (precursor_of(&folder)?, folder.read_result()?.planes);
    file.precursor.domain.threads = case.flow.threads;
    let air = standing(&folder.checkpoint_path(), &file)
        .map_err(|error| StudyError::Solver(Box::new(error)))?;
    // Where it blows from, clockwise from north.
    let (s, c) = planes.direction_deg.to_radians().sin_cos();
    Ok(Some(Companion::new(air, [-s, -c], planes.hub_speed)))
}
