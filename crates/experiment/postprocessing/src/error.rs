//! Why records give no answer.

use crate::seeds::SeedsError;
use analysis::AnalysisError;
use farm::assemble::AssemblyError;
use farm::case::Case;
use flow::inflow::InflowError;
use formats::atomic::FileError;
use formats::case::CaseError;
use formats::records::{Manifest, RunFolder};
use formats::turbine_file::TurbineFileError;
use miette::Diagnostic;
use report::ReportError;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why records give no answer.
#[derive(Debug, Error, Diagnostic)]
pub enum PostprocessingError {
    /// The turbine in the records cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Turbine(#[from] TurbineFileError),
    /// A file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// An estimator or a loop cannot be set up for the records.
    #[error("no estimator or loop can be set up for {}", told(path))]
    #[diagnostic(help(
        "ask for other Strouhal numbers (--strouhal-low, --strouhal-high) or another estimator (--estimator), or make the run again with settings that its turbine and its output.interval carry"
    ))]
    Assembly {
        /// The records; none until who knows them has said so.
        path: Option<PathBuf>,
        /// Why.
        source: AssemblyError,
    },
    /// The records cannot be analysed.
    #[error("{} cannot be analysed: {source}", told(path))]
    #[diagnostic(help("{}", fix_of(source)))]
    Analysis {
        /// The records; none until who knows them has said so.
        path: Option<PathBuf>,
        /// Why.
        source: AnalysisError,
    },
    /// There are no curves in this program.
    #[error("this program was built without the curve through changes over the phase offset")]
    #[diagnostic(help("build it with its default features, without --no-default-features"))]
    NoCurves,
    /// The case that the records hold is not that of their run.
    #[error("{} does not hold run {run} where it says, number {index} of its case", path.display())]
    #[diagnostic(help(
        "restore the file, or make the run again with `wakemix run CASE --run {run} --overwrite`"
    ))]
    NoSuchRun {
        /// The manifest.
        path: PathBuf,
        /// Name of the run.
        run: String,
        /// Its place in the case, from 0.
        index: usize,
    },
    /// The file of a precursor is not understood.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Precursor(#[from] CaseError),
    /// Planes of wind cannot be read.
    #[error("the planes of wind cannot be read")]
    #[diagnostic(help("restore the file, or make the precursor again"))]
    Planes(#[from] InflowError),
    /// Several studies tell no gains together.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Seeds(#[from] SeedsError),
    /// The report cannot be made.
    #[error("the report cannot be made")]
    #[diagnostic(help("{}", fix_of_report(_0)))]
    Report(#[from] ReportError),
    /// No turbine of a run, or not the requested one, estimates the phase of a helix.
    #[error("{} in {}", nobody(run, requested), folder.display())]
    #[diagnostic(help("its turbines are {}; name one with --turbine", turbines.join(", ")))]
    NobodySeeks {
        /// Run.
        run: String,
        /// Turbine requested.
        requested: Option<String>,
        /// Turbines of the case.
        turbines: Vec<String>,
        /// Folder of the run.
        folder: PathBuf,
    },
    /// No turbine upstream pitches a helix.
    #[error(
        "no turbine upstream of {turbine} pitches a helix in run {run} in {}: there is no phase to estimate", folder.display()
    )]
    #[diagnostic(help(
        "name a run in which a turbine upstream pitches a helix, or with --turbine one that stands behind such a turbine"
    ))]
    NoHelix {
        /// Folder of the run.
        folder: PathBuf,
        /// Run.
        run: String,
        /// Turbine.
        turbine: String,
    },
    /// No run holds the true wind at a turbine's place.
    #[error("no run in {} holds the true wind at the place of {turbine}", directory.display())]
    #[diagnostic(help(
        "run the case with `output.lines_at = [\"{turbine}\"]` and a run in which {turbine} is absent and all upstream of it do as in this run, or name one with --truth"
    ))]
    NoTruth {
        /// Turbine.
        turbine: String,
        /// Folder of the study.
        directory: PathBuf,
    },
    /// No run joins a helix with an offset and compares with another.
    #[error("no run in {} joins a helix with an offset and compares with another", directory.display())]
    #[diagnostic(help(
        "give a turbine `kind = \"phase-sync\"` with an `amplitude_deg` above 0, and its run a `compare_with`"
    ))]
    NoOffsets {
        /// Folder of the study.
        directory: PathBuf,
    },
    /// Something set that is not understood.
    #[error("--{setting} {given}: {expected}")]
    #[diagnostic(help("{fix}"))]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// What was given.
        given: String,
        /// What was expected.
        expected: &'static str,
        /// What to write.
        fix: &'static str,
    },
    /// No run of a study holds what an analysis is about.
    #[error("no run in {} {lacking}", directory.display())]
    #[diagnostic(help("{fix}"))]
    NoSignals {
        /// Folder of the study.
        directory: PathBuf,
        /// What none of them does, such as `keeps the wind along lines`.
        lacking: &'static str,
        /// What to do.
        fix: &'static str,
    },
    /// Scans of a lidar are not there, or tell nothing.
    #[error("{} {problem}", path.display())]
    #[diagnostic(help("{fix}"))]
    Scans {
        /// Folder of the run, or the file of the scans.
        path: PathBuf,
        /// What about them, such as `holds no scans of a lidar of T1`.
        problem: String,
        /// What to do.
        fix: String,
    },
    /// Fields of a wake do not do.
    #[error("{} {problem}", path.display())]
    #[diagnostic(help("{fix}"))]
    Fields {
        /// Folder of the run, or the file.
        path: PathBuf,
        /// What about them, such as `does not tell the rotor diameter`.
        problem: String,
        /// What to do.
        fix: String,
    },
    /// A series lacks a channel.
    #[error("{} has no channel `{channel}`", told(path))]
    #[diagnostic(help(
        "the run did not keep it, or another version of the program made it: make the run again with `wakemix run CASE --overwrite`"
    ))]
    MissingChannel {
        /// The series; none until who knows it has said so.
        path: Option<PathBuf>,
        /// Channel.
        channel: String,
    },
}

impl From<AnalysisError> for PostprocessingError {
    fn from(source: AnalysisError) -> Self {
        Self::Analysis { path: None, source }
    }
}

impl From<AssemblyError> for PostprocessingError {
    fn from(source: AssemblyError) -> Self {
        Self::Assembly { path: None, source }
    }
}

/// What was found in records.
pub(crate) trait InRecords {
    /// The same; an error that does not say yet in which records says: in those at `file`.
    fn in_records(self, file: &Path) -> Self;
}

impl<T> InRecords for Result<T, PostprocessingError> {
    fn in_records(mut self, file: &Path) -> Self {
        use PostprocessingError::{Analysis, Assembly, MissingChannel};
        if let Err(Analysis { path, .. } | Assembly { path, .. } | MissingChannel { path, .. }) =
            &mut self
        {
            path.get_or_insert_with(|| file.to_owned());
        }
        self
    }
}

/// The case of the run in `folder`, whose manifest is `manifest`.
///
/// # Errors
/// [`PostprocessingError::File`] for one that cannot be read, [`PostprocessingError::NoSuchRun`] for one
/// without that run.
pub(crate) fn case_of(
    folder: &RunFolder,
    manifest: &Manifest,
) -> Result<Case, PostprocessingError> {
    let path = folder.manifest_path();
    let case = case_in(&path, &manifest.case_text)?;
    let (run, index) = (manifest.run.clone(), manifest.run_index);
    if case.runs.get(index).is_some_and(|found| found.name == run) {
        return Ok(case);
    }
    Err(PostprocessingError::NoSuchRun { path, run, index })
}

/// The case in `text`, which the records at `path` hold.
///
/// # Errors
/// [`PostprocessingError::File`] for one that cannot be read.
pub(crate) fn case_in(path: &Path, text: &str) -> Result<Case, PostprocessingError> {
    formats::case::parse("case_text", text, &[]).map_err(|error| {
        let fix = "restore the file, read it with the wakemix that it names, or make the run again with `wakemix run CASE --overwrite`";
        FileError::content("the case of a run", path, error.to_lines(), fix).into()
    })
}

fn told(path: &Option<PathBuf>) -> String {
    path.as_ref().map_or_else(|| "the records".to_owned(), |path| path.display().to_string())
}

/// How to get an answer in spite of `error`.
fn fix_of(error: &AnalysisError) -> &'static str {
    use AnalysisError as E;
    match error {
        E::TooShort { .. } => {
            "count from an earlier time with --from, or make a longer run (time.duration): a phase needs several periods of the helix after the spin-up"
        }
        E::UnequalLengths { .. } => {
            "make both runs again with one case: `wakemix run CASE --overwrite`"
        }
        E::NotFinite { .. } | E::UnevenTimes { .. } => {
            "the file is damaged or was edited: restore it, or make the run again with `wakemix run CASE --overwrite`"
        }
        E::ZeroMean | E::NoReference => {
            "compare with a run in which there is something to compare with (compare_with), or ask for other runs with --run"
        }
        E::TooFewBlades { .. } | E::TooFewLines { .. } => {
            "name a turbine of three blades or more with --turbine"
        }
        E::AboveNyquist { .. } | E::Band { .. } | E::NotPositive { .. } | E::Slope { .. } => {
            "ask for a frequency that the rows resolve, or make the run again with a shorter output.interval"
        }
        E::WrongPlane { .. } | E::OutsidePlane { .. } => {
            "make the run again with planes that reach the turbines (output.crosswind_diameters, the domain of [flow])"
        }
    }
}

/// How to get a report in spite of `error`.
fn fix_of_report(error: &ReportError) -> String {
    match error {
        ReportError::NoRuns { .. } => "complete a run with `wakemix run CASE --resume`".to_owned(),
        ReportError::Write { path, .. } => {
            let folder = path.parent().unwrap_or(path).display();
            format!("check the permissions of {folder} and the space on its disk")
        }
        ReportError::Picture { .. } | ReportError::Page(_) => {
            "the records may be damaged: make the run again with `wakemix run CASE --overwrite`"
                .to_owned()
        }
    }
}

fn nobody(run: &str, requested: &Option<String>) -> String {
    match requested {
        Some(name) => format!("run {run} has no turbine called `{name}`"),
        None => format!("no turbine of run {run} estimates the phase of a helix"),
    }
}
