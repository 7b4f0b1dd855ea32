//! Why a campaign cannot go on.

use formats::FileError;
use formats::case::CaseError;
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use study::StudyError;
use thiserror::Error;

/// Why a campaign cannot be planned, go on or be read.
#[derive(Debug, Error, Diagnostic)]
pub enum CampaignError {
    /// The campaign's file cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Campaign(#[from] CaseError),
    /// A file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// The case with the levels of a task cannot be run.
    #[error("the case cannot be run with {settings}")]
    #[diagnostic(help(
        "correct these levels in the campaign's file, or leave them out by [[exclude]]"
    ))]
    Level {
        /// Factors with their levels.
        settings: String,
        /// What the case reader says.
        #[source]
        #[diagnostic_source]
        source: Box<dyn Diagnostic + Send + Sync>,
    },
    /// A sample of the tasks cannot be made.
    #[error("a task cannot be run: {settings}")]
    Sample {
        /// Factors with their levels.
        settings: String,
        /// Why.
        #[source]
        #[diagnostic_source]
        source: Box<dyn Diagnostic + Send + Sync>,
    },
    /// Two tasks are the same.
    #[error("two tasks are the same case: {first}; and {second}")]
    #[diagnostic(help(
        "let their levels differ in what the case uses, or leave one out by [[exclude]]"
    ))]
    Duplicate {
        /// One of them.
        first: String,
        /// The other.
        second: String,
    },
    /// No task is left.
    #[error("{} makes no task: all are excluded", path.display())]
    #[diagnostic(help("take an [[exclude]] out of it"))]
    NoTask {
        /// The campaign's file.
        path: PathBuf,
    },
    /// The folder belongs to another plan.
    #[error("{} holds the campaign `{found}`, and this is another plan: {difference}", folder.display())]
    #[diagnostic(help("give it another folder with -o, or remove that one"))]
    OtherPlan {
        /// The folder.
        folder: PathBuf,
        /// Name of the campaign there.
        found: String,
        /// What differs.
        difference: String,
    },
    /// There is no campaign.
    #[error("{} holds no campaign", folder.display())]
    #[diagnostic(help("plan one there with `wakemix campaign plan FILE -o FOLDER`"))]
    NoCampaign {
        /// The folder.
        folder: PathBuf,
    },
    /// What was planned has changed since.
    #[error("task {task} is not what was planned: its case or a file that it names has changed")]
    #[diagnostic(help(
        "put the files back, or plan the campaign again in another folder with `wakemix campaign plan`"
    ))]
    Changed {
        /// The task.
        task: i64,
    },
    /// Another version of the program planned it.
    #[error("{} was planned by wakemix {planned}, this is {here}", folder.display())]
    #[diagnostic(help("go on with that version, or plan it again in another folder"))]
    OtherVersion {
        /// The folder.
        folder: PathBuf,
        /// That version.
        planned: String,
        /// This one.
        here: String,
    },
    /// An earlier program planned it, whose job table is another one.
    #[error("{} was planned by an earlier wakemix, whose job table has other columns", folder.display())]
    #[diagnostic(help("go on with that one, or plan the campaign again in another folder"))]
    OtherLayout {
        /// The folder.
        folder: PathBuf,
    },
    /// Two numbers of a task have one name.
    #[error("two numbers of task {task} are called `{name}`")]
    #[diagnostic(help(
        "give turbines, runs and channels of the case names that stay apart when joined by dots"
    ))]
    TwiceNamed {
        /// The task.
        task: i64,
        /// The name.
        name: String,
    },
    /// There is no such task.
    #[error("there is no task {wanted}: the campaign has 1 to {n_tasks}")]
    #[diagnostic(help("give a number, or a range such as 11-20"))]
    NoSuchTask {
        /// What was asked for.
        wanted: String,
        /// Tasks of the campaign (–).
        n_tasks: i64,
    },
    /// The job table cannot be read or written.
    #[error("cannot {doing} the job table {}", path.display())]
    #[diagnostic(help("{}", fix_of(source)))]
    Table {
        /// What was to be done.
        doing: &'static str,
        /// The file.
        path: PathBuf,
        /// What SQLite says.
        source: rusqlite::Error,
    },
    /// Something that every further task would meet, too.
    #[error("the campaign stops at task {task}, which comes back; what is done stays done")]
    Stopped {
        /// The task.
        task: i64,
        /// What it met.
        #[source]
        #[diagnostic_source]
        source: Box<dyn Diagnostic + Send + Sync>,
    },
    /// No number is called so.
    #[error("no number of the runs is called `{pattern}`")]
    #[diagnostic(help("`collect` knows, for example, {known}; `*` stands for any part"))]
    NoNumber {
        /// What was asked for.
        pattern: String,
        /// Some that there are.
        known: String,
    },
    /// No factor is called so.
    #[error("the campaign varies no `{key}`, over which means are asked for")]
    #[diagnostic(help("it varies {known}"))]
    NoFactor {
        /// What was asked for.
        key: String,
        /// What is varied.
        known: String,
    },
    /// No task is done yet.
    #[error("{} has no task that is done", folder.display())]
    #[diagnostic(help("make some with `wakemix campaign run`"))]
    NothingDone {
        /// The folder.
        folder: PathBuf,
    },
    /// Parquet is left out.
    #[error("this program was built without Parquet")]
    #[diagnostic(help("name a file that ends with .csv, or build it with its default features"))]
    NoParquet,
    /// A file is to be written in a format that is not known.
    #[error("{} ends neither with .csv nor with .parquet", path.display())]
    #[diagnostic(help("name it so, such as loads.parquet"))]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
}

/// How to fix what SQLite says.
fn fix_of(error: &rusqlite::Error) -> String {
    use rusqlite::ErrorCode;
    let fix = match error.sqlite_error_code() {
        Some(ErrorCode::DiskFull) => {
            "the disk or quota is full: free some space and repeat the command; what is done stays done"
        }
        Some(ErrorCode::ReadOnly | ErrorCode::PermissionDenied | ErrorCode::CannotOpen) => {
            "check the permissions of its folder"
        }
        Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => {
            "other processes held it for some minutes: repeat the command"
        }
        Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase) => {
            "it is damaged: plan the campaign again in another folder"
        }
        _ => "check the disk that holds it",
    };
    fix.to_owned()
}

/// Whether `error` is nothing of the task at hand, but of the machine: every further task would meet it.
pub(crate) fn is_of_machine(error: &StudyError) -> bool {
    use std::io::ErrorKind::{QuotaExceeded, ReadOnlyFilesystem, StorageFull};
    match error {
        StudyError::Disk { .. } | StudyError::Memory { .. } => true,
        StudyError::File(FileError::System { source, .. }) => {
            matches!(source.kind(), StorageFull | QuotaExceeded | ReadOnlyFilesystem)
        }
        StudyError::File(FileError::Held { .. }) => true,
        _ => false,
    }
}

/// Whether `error` is of what an earlier process left in the folder `left`, with which no process can go on:
/// without it the task can be made.
pub(crate) fn is_of_what_was_left(error: &StudyError, left: &Path) -> bool {
    use std::io::ErrorKind::{InvalidData, NotFound, UnexpectedEof};
    match error {
        StudyError::File(FileError::Checkpoint { .. })
        | StudyError::ForeignController(_)
        | StudyError::ForeignSensor(_)
        | StudyError::PlaneSize(_)
        | StudyError::OtherCase { .. }
        | StudyError::OtherFile { .. }
        | StudyError::UntoldWind { .. }
        | StudyError::NotLengthened { .. }
        | StudyError::NoManifest { .. } => true,
        StudyError::File(FileError::Content { path, .. }) => path.starts_with(left),
        StudyError::File(FileError::System { path, source, .. }) => {
            path.starts_with(left)
                && matches!(source.kind(), InvalidData | NotFound | UnexpectedEof)
        }
        _ => false,
    }
}

/// `error` with its causes and its fix, in a line.
pub(crate) fn in_words(error: &StudyError) -> String {
    use std::error::Error;
    let mut text = error.to_string();
    if let StudyError::Case(case) = error {
        text = case.to_lines().trim_end().replace('\n', "; ");
    }
    let mut cause = error.source();
    while let Some(deeper) = cause {
        let words = deeper.to_string();
        if !text.contains(&words) {
            text += &format!(": {words}");
        }
        cause = deeper.source();
    }
    match error.help() {
        Some(help) => format!("{text}; {help}"),
        None => text,
    }
}
