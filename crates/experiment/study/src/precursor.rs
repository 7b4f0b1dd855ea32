//! A precursor in its folder: an atmosphere is spun up, told of, and recorded as wind for studies.

mod cost;
mod error;
mod history;
mod levels;
mod observer;
mod recording;
mod result;
mod simulation;

pub use cost::PrecursorEstimate;
pub(crate) use cost::memory;
pub use error::PrecursorError;
pub use observer::{PrecursorObserver, PrecursorProgress};

use farm::precursor::PrecursorPlan;
use formats::case::{PrecursorFile, parse_precursor};
use formats::records::{PrecursorFolder, PrecursorResult};
use formats::{atomic, shipped};
pub(crate) use simulation::standing;
use simulation::{Ending, Simulation};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// Length of a box over the height of its inversion from which on nobody is warned (–).
const LENGTH_TO_WARN: f64 = 5.0;

/// What is asked of a precursor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PrecursorOptions {
    /// Its file, or the name of a shipped one.
    pub case: PathBuf,
    /// Folder for what it leaves; `runs/NAME` when absent.
    pub output: Option<PathBuf>,
    /// Overrides of the file's keys, `key.path=value`.
    pub overrides: Vec<String>,
    /// Go on with what is there.
    pub resume: bool,
    /// Replace what is there.
    pub overwrite: bool,
    /// Say what it would cost, and stop.
    pub dry_run: bool,
}

/// How a precursor ended.
#[derive(Clone, Debug, PartialEq)]
pub enum PrecursorOutcome {
    /// It is complete.
    Done {
        /// What came of it.
        result: Box<PrecursorResult>,
        /// Its folder.
        folder: PrecursorFolder,
    },
    /// The cost was reported, nothing was run.
    Estimated,
    /// Stopped on request; it can be resumed.
    Interrupted {
        /// Its folder.
        folder: PrecursorFolder,
    },
}

/// A precursor that is to be made.
struct Job {
    file: PrecursorFile,
    plan: PrecursorPlan,
    folder: PrecursorFolder,
    resume: bool,
}

/// Makes the precursor that `options` ask for; `stop` asks it to leave a checkpoint and return.
///
/// # Errors
/// [`PrecursorError`]; the last good checkpoint stands.
pub fn precursor(
    options: &PrecursorOptions,
    stop: &AtomicBool,
    observer: &mut dyn PrecursorObserver,
) -> Result<PrecursorOutcome, PrecursorError> {
    let file = shipped::read_precursor(&options.case, &options.overrides)?;
    let directory = options.output.clone();
    let directory = directory.unwrap_or_else(|| PathBuf::from("runs").join(&file.precursor.name));
    let folder = PrecursorFolder::new(&directory);
    let (plan, resume) = (file.precursor.plan(), options.resume);
    let job = Job { file, plan, folder, resume };
    job.warnings().iter().for_each(|warning| observer.warned(warning));
    if options.dry_run {
        observer.estimated(&PrecursorEstimate::new(&job.file.precursor, &plan)?);
        return Ok(PrecursorOutcome::Estimated);
    }
    if let Some(result) = job.standing(options.overwrite)? {
        return Ok(PrecursorOutcome::Done { result: Box::new(result), folder: job.folder });
    }
    atomic::check_folder(&directory)?;
    let estimate = PrecursorEstimate::new(&job.file.precursor, &plan)?;
    observer.estimated(&estimate);
    estimate.check(&job.folder)?;
    let _lock = job.folder.lock()?;
    if options.overwrite {
        job.folder.clear()?;
    }
    match Simulation::begin(&job)?.run(stop, observer)? {
        Ending::Complete(result) => Ok(PrecursorOutcome::Done { result, folder: job.folder }),
        Ending::Interrupted => Ok(PrecursorOutcome::Interrupted { folder: job.folder }),
    }
}

impl Job {
    /// What a reader of the numbers must know.
    fn warnings(&self) -> Vec<String> {
        let (mut warnings, precursor) = (Vec::new(), &self.file.precursor);
        let (air, [length, width, _]) = (&precursor.air, precursor.domain.size);
        let lengths = length.min(width) / air.inversion_height;
        if lengths < LENGTH_TO_WARN {
            warnings.push(format!(
                "the box is {lengths:.1} times as wide as its layer is deep: its longest eddies meet themselves and last too long; {LENGTH_TO_WARN} and more are for results"
            ));
        }
        warnings
    }

    /// What came of it where its folder has it complete; nothing where it is to be made, or to go on.
    ///
    /// # Errors
    /// [`PrecursorError::OutputExists`], [`PrecursorError::NothingToResume`],
    /// [`PrecursorError::OtherCase`], and [`PrecursorError::File`] for what cannot be read.
    fn standing(&self, overwrite: bool) -> Result<Option<PrecursorResult>, PrecursorError> {
        let directory = || self.folder.path().to_owned();
        if !self.resume {
            return match self.folder.holds_results() && !overwrite {
                true => Err(PrecursorError::OutputExists { directory: directory() }),
                false => Ok(None),
            };
        }
        if !self.folder.checkpoint_path().is_file() {
            return Err(PrecursorError::NothingToResume { directory: directory() });
        }
        let path = self.folder.case_path();
        let text = atomic::read_text(&path, "the precursor's file")?;
        let before = parse_precursor(&path, &text, &[])?;
        if before.fingerprint() != self.file.fingerprint() {
            return Err(PrecursorError::OtherCase { directory: directory() });
        }
        if self.folder.is_complete() && before.precursor.time == self.file.precursor.time {
            return Ok(Some(self.folder.read_result()?));
        }
        Ok(None)
    }
}
