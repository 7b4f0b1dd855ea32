//! Why a precursor could not be made.

use flow::FlowError;
use flow::inflow::InflowError;
use flow::lattice::LatticeError;
use formats::FileError;
use formats::case::CaseError;
use miette::Diagnostic;
use std::path::PathBuf;
use thiserror::Error;

/// Why a precursor could not be made.
#[derive(Debug, Error, Diagnostic)]
pub enum PrecursorError {
    /// Its file cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Case(#[from] CaseError),
    /// A file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// The air cannot be set up.
    #[error("the air cannot be set up")]
    #[diagnostic(help("change what is named under [box] or [time]"))]
    Settings(#[from] LatticeError),
    /// The planes that were written cannot be read.
    #[error("the planes of wind cannot be read")]
    #[diagnostic(help("look at the disk that holds them, and make the precursor again"))]
    Planes(#[from] InflowError),
    /// The air broke down.
    #[error("the precursor diverged: {source}")]
    #[diagnostic(help("{}", kept(checkpoint, statistics)))]
    Diverged {
        /// Where and when.
        source: Box<FlowError>,
        /// Last good checkpoint, if there is one.
        checkpoint: Option<PathBuf>,
        /// Statistics up to that time, if there are any.
        statistics: Option<PathBuf>,
    },
    /// The folder holds something that would be overwritten.
    #[error("{} already holds a precursor", directory.display())]
    #[diagnostic(help(
        "use --resume to go on with it, --overwrite to replace it, or another folder with -o"
    ))]
    OutputExists {
        /// The folder.
        directory: PathBuf,
    },
    /// There is nothing to go on with.
    #[error("{} holds no precursor to resume", directory.display())]
    #[diagnostic(help("leave --resume out to begin, or name its folder with -o"))]
    NothingToResume {
        /// The folder.
        directory: PathBuf,
    },
    /// The folder holds another precursor.
    #[error("the precursor in {} was made with another version of the file", directory.display())]
    #[diagnostic(help(
        "undo the change (time.spin_up, time.record and box.threads may differ), repeat the --set of the first call, use --overwrite to begin again, or another folder with -o"
    ))]
    OtherCase {
        /// The folder.
        directory: PathBuf,
    },
    /// It is further than its times allow.
    #[error(
        "the precursor in {} stands at {time:.1} s{recorded}: {problem}", directory.display(),
        recorded = recorded.map_or_else(String::new, |time| format!(" and has recorded from {time:.1} s on"))
    )]
    #[diagnostic(help(
        "raise time.spin_up beyond {time:.1} s to record anew from then on, or time.record to record for longer; --overwrite begins again"
    ))]
    Passed {
        /// The folder.
        directory: PathBuf,
        /// Time of its checkpoint (s).
        time: f64,
        /// Time of its first plane (s), where it has one.
        recorded: Option<f64>,
        /// What of the file does not fit.
        problem: String,
    },
    /// The machine has too little memory.
    #[error("the precursor needs {needed:.1} GiB of memory, {available:.1} GiB are free")]
    #[diagnostic(help("use larger cells (box.cell) or a smaller box"))]
    Memory {
        /// Needed (GiB).
        needed: f64,
        /// Free (GiB).
        available: f64,
    },
    /// The disk has too little room.
    #[error(
        "the precursor needs up to {needed:.1} GB of disk, {available:.1} GB are free for {}", directory.display()
    )]
    #[diagnostic(help(
        "free some space, name a folder on another disk with -o, or record less: planes.height, planes.width, planes.interval, time.record"
    ))]
    Disk {
        /// Needed (GB).
        needed: f64,
        /// Free (GB).
        available: f64,
        /// Folder of the results.
        directory: PathBuf,
    },
}

/// What to do after a breakdown, and what is left.
fn kept(checkpoint: &Option<PathBuf>, statistics: &Option<PathBuf>) -> String {
    let mut text = "a shorter time.step may carry it".to_owned();
    for (what, path) in [("statistics so far", statistics), ("last good checkpoint", checkpoint)] {
        if let Some(path) = path {
            text += &format!("; {what}: {}", path.display());
        }
    }
    text
}
