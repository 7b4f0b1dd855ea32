//! The doors to the first stage: a case from a file or as a value. Here the reader of case files learns of
//! the study's own outputs.

use crate::StudyError;
use crate::models::Machines;
use crate::outputs::announce;
use crate::prepared::Prepared;
use farm::assemble::TurbineModel;
use farm::case::Case;
use formats::case::CaseFile;
use std::collections::BTreeMap;
use std::path::Path;

impl Prepared {
    /// Reads the case at `path`, or the shipped one of that name, with `overrides`, loads its turbines and
    /// lays out its domain.
    ///
    /// # Errors
    /// [`StudyError`] for a case, a turbine or a layout that cannot be used.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, StudyError> {
        announce();
        Self::of_file(&formats::shipped::read(path, overrides)?)
    }

    /// The same of a `case` that stands in no file; files that it names are relative to the current folder.
    ///
    /// # Errors
    /// Those of [`read`](Self::read); they point at the case as [`formats::case::write()`] writes it.
    pub fn of(case: Case) -> Result<Self, StudyError> {
        announce();
        Self::of_file(&CaseFile::of(case)?)
    }

    /// The same of a `case` whose turbines are `models`, by the names of
    /// [`Placement::machine`](farm::case::Placement::machine), rather than those of library or files.
    ///
    /// # Errors
    /// Those of [`of`](Self::of); [`StudyError::Plan`] names a model that is not there.
    pub fn with_models(
        case: Case,
        models: BTreeMap<String, TurbineModel>,
    ) -> Result<Self, StudyError> {
        announce();
        let file = CaseFile::of(case)?;
        let machines = Machines { models, ..Machines::default() };
        Self::of_machines(&file, machines)
    }
}
