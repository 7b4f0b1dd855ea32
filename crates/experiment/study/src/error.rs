//! Why a study could not be made.

use analysis::AnalysisError;
use farm::FarmError;
use farm::assemble::AssemblyError;
use farm::pitch_response::CalibrationError;
use farm::plan::PlanError;
use farm::self_check::SelfCheckError;
use flow::FlowError;
use flow::inflow::InflowError;
use flow::lattice::{LatticeError, PlaneSizeError};
use formats::atomic::FileError;
use formats::case::{CaseError, Difference};
use formats::turbine_file::TurbineFileError;
use miette::Diagnostic;
use std::path::PathBuf;
use thiserror::Error;

/// What to do with a checkpoint that was made otherwise than the run at hand.
const MADE_OTHERWISE: &str = "it was made with other kinds of controllers, sensors or outputs: resume with the program that made it, or use --overwrite to make the run again";

/// Why a study could not be made.
#[derive(Debug, Error, Diagnostic)]
pub enum StudyError {
    /// The case file cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Case(#[from] CaseError),
    /// A turbine cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Turbine(#[from] TurbineFileError),
    /// A file cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// The layout does not fit.
    #[error("the case cannot be run as it stands")]
    Plan(#[from] PlanError),
    /// The flow cannot be set up.
    #[error("the flow cannot be set up")]
    Settings(#[from] LatticeError),
    /// The flow of a solver that is not the program's own cannot be set up.
    #[error("the flow cannot be set up")]
    Solver(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// The turbulence cannot be made.
    #[error("the turbulence cannot be made")]
    Inflow(#[from] InflowError),
    /// The turbines cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A checkpoint holds the state of another controller.
    #[error("the checkpoint does not fit the run's controllers")]
    #[diagnostic(help("{}", MADE_OTHERWISE))]
    ForeignController(#[from] control::ForeignState),
    /// A checkpoint holds the state of another sensor.
    #[error("the checkpoint does not fit the run's sensors")]
    #[diagnostic(help("{}", MADE_OTHERWISE))]
    ForeignSensor(#[from] sensing::ForeignState),
    /// A turbine's controller cannot be made.
    #[error("run {run}: the controller of {turbine} cannot be built")]
    Control {
        /// Run.
        run: String,
        /// Turbine.
        turbine: String,
        /// Why.
        source: Box<AssemblyError>,
    },
    /// A phase estimator cannot be calibrated.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// The self-check cannot be made.
    #[error(transparent)]
    SelfCheck(#[from] SelfCheckError),
    /// The records of a run cannot be analysed.
    #[error("the records cannot be analysed")]
    Analysis(#[from] AnalysisError),
    /// Velocity cannot be averaged by phase.
    #[error("velocity cannot be averaged by phase")]
    Phases(#[source] analysis::phases::PhaseError),
    /// A stored average by phase has other points or bins.
    #[error("the checkpoint does not fit the averages by phase that the case asks for")]
    #[diagnostic(help("{}", MADE_OTHERWISE))]
    OtherAverages,
    /// A stored average does not fit the grid.
    #[error("the checkpoint does not fit the grid")]
    #[diagnostic(help("{}", MADE_OTHERWISE))]
    PlaneSize(#[from] PlaneSizeError),
    /// The simulation broke down, or a controller ended it.
    #[error("run {run} {}: {source}", verb(source))]
    #[diagnostic(help("{}", kept(source, steadier, checkpoint, series)))]
    Diverged {
        /// Run.
        run: String,
        /// Where and when.
        source: Box<FarmError>,
        /// What may carry its air, see [`SolverKind::steadier`](farm::solvers::SolverKind::steadier).
        steadier: &'static str,
        /// Last good checkpoint, if there is one.
        checkpoint: Option<PathBuf>,
        /// Series up to that time.
        series: Option<PathBuf>,
    },
    /// A run that the command line names is not in the case.
    #[error("the case has no run called `{name}`")]
    #[diagnostic(help("its runs are {}", known.join(", ")))]
    UnknownRun {
        /// Name given.
        name: String,
        /// Names in the case.
        known: Vec<String>,
    },
    /// A case asks for an output of a kind that nobody writes.
    #[error("the output `{name}` is of kind `{kind}`, which has keys and nothing that writes it")]
    #[diagnostic(help(
        "add a study::outputs::OutputKind to farm::outputs::OUTPUTS, no other kind"
    ))]
    NotWritten {
        /// Name of the output.
        name: String,
        /// Its kind.
        kind: &'static str,
    },
    /// The output folder holds something that would be overwritten.
    #[error("{} already holds results", directory.display())]
    #[diagnostic(help(
        "use --resume to continue them, --overwrite to replace them, or another folder with -o"
    ))]
    OutputExists {
        /// The folder.
        directory: PathBuf,
    },
    /// There is nothing to resume.
    #[error("{} holds no run to resume", directory.display())]
    #[diagnostic(help("leave --resume out to begin, or name the folder of the results with -o"))]
    NothingToResume {
        /// The folder.
        directory: PathBuf,
    },
    /// A helix that turns too slowly to be followed.
    #[error(
        "a helix of Strouhal number {strouhal:?} in {wind_speed:?} m/s turns once in {period:.0} s, {most:.0} s are the most"
    )]
    #[diagnostic(help("take more wind, or a greater Strouhal number"))]
    SlowHelix {
        /// Strouhal number (–).
        strouhal: f64,
        /// Wind (m/s).
        wind_speed: f64,
        /// Period (s).
        period: f64,
        /// Longest period (s).
        most: f64,
    },
    /// Results of another case are to be resumed.
    #[error("run {run} in {} was made with another version of the case{}", directory.display(), told(differences))]
    #[diagnostic(help(
        "repeat the --set of the first call, use --overwrite to make it again (with the runs that compare with it), or another folder with -o"
    ))]
    OtherCase {
        /// Run.
        run: String,
        /// Its folder.
        directory: PathBuf,
        /// What differs; empty where that cannot be told.
        differences: Vec<Difference>,
    },
    /// A run is to go on for longer, and cannot.
    #[error("run {run} in {} cannot go on from {before} s to {now} s: {reason}", directory.display())]
    #[diagnostic(help(
        "put time.duration back, use --overwrite to make the run again, or another folder with -o"
    ))]
    NotLengthened {
        /// Run.
        run: String,
        /// Its folder.
        directory: PathBuf,
        /// Its duration (s).
        before: f64,
        /// The one asked for (s).
        now: f64,
        /// Why not.
        reason: String,
    },
    /// A folder holds files of which nothing tells what they are.
    #[error("{} holds files of a run, and no manifest.json that tells what made them", directory.display())]
    #[diagnostic(help(
        "put its manifest.json back to go on with --resume, use --overwrite to make the run in the place of what is there, or another folder with -o"
    ))]
    NoManifest {
        /// Folder of the run.
        directory: PathBuf,
    },
    /// A folder holds another sweep, or a study of its own where a sweep of studies is to be, or the reverse.
    #[error("{} holds {found}, and the case makes {expected}", directory.display())]
    #[diagnostic(help(
        "give it another folder with -o; values may be added to the lists of [sweep], keys that make studies may not"
    ))]
    OtherSweep {
        /// The folder.
        directory: PathBuf,
        /// What is there.
        found: String,
        /// What the case makes.
        expected: String,
    },
    /// A run whose manifest does not tell the files of wind.
    #[error("run {run} in {} does not tell which {file} it was made with: an earlier wakemix made it", directory.display())]
    #[diagnostic(help(
        "use --overwrite to make the run again (with the runs that compare with it), or another folder with -o"
    ))]
    UntoldWind {
        /// Run.
        run: String,
        /// Its folder.
        directory: PathBuf,
        /// The file as the case names it.
        file: String,
    },
    /// Results made with another turbine, controller's input or wind are to be resumed or compared with.
    #[error("run {run} in {} was made with another {file}", directory.display())]
    #[diagnostic(help("{}", put_back(file, sha256)))]
    OtherFile {
        /// Run.
        run: String,
        /// Its folder.
        directory: PathBuf,
        /// The file as the case names it.
        file: String,
        /// SHA-256 of the file with which the run was made; none where it was made without.
        sha256: Option<String>,
    },
    /// A file of wind is not what it was when the study began.
    #[error(
        "{file} has changed since the study began: run {run} would not meet the wind of the runs before it"
    )]
    #[diagnostic(help("{}", put_back(file, sha256)))]
    ChangedWind {
        /// Run that was about to begin.
        run: String,
        /// The file as the case names it.
        file: String,
        /// SHA-256 of the file when the study began; none where it was not there.
        sha256: Option<String>,
    },
    /// A rotor of one or two blades shall pitch them cyclically.
    #[error("run {run}: {turbine} has {n_blades} blades; tilt and yaw need three or more")]
    #[diagnostic(help(
        "let it pitch collectively, control.{turbine} = {{ kind = \"pulse\", ... }}, or give it another model"
    ))]
    TooFewBlades {
        /// Run.
        run: String,
        /// Turbine.
        turbine: String,
        /// Blades of its rotor (–).
        n_blades: usize,
    },
    /// The machine has too little memory.
    #[error("the study needs {needed:.1} GiB of memory, {available:.1} GiB are free")]
    #[diagnostic(help("lower {fix}; or make fewer runs at once with --jobs"))]
    Memory {
        /// Needed (GiB).
        needed: f64,
        /// Free (GiB).
        available: f64,
        /// What needs less where it is lower.
        fix: &'static str,
    },
    /// The disk has too little room.
    #[error(
        "the study needs up to {needed:.1} GB of disk, {available:.1} GB are free for {}", directory.display()
    )]
    #[diagnostic(help(
        "free some space, name a folder on another disk with -o, make some of the runs with --run, or keep less: a longer output.interval, fewer planes and volumes"
    ))]
    Disk {
        /// Needed (GB).
        needed: f64,
        /// Free, with what the runs' own folders hold (GB).
        available: f64,
        /// Folder of the results.
        directory: PathBuf,
    },
    /// A series lacks a channel that the summary needs.
    #[error("the series has no channel `{channel}`")]
    #[diagnostic(help("the file is of another version; run the case again"))]
    MissingChannel {
        /// Channel.
        channel: String,
    },
}

/// What differs, in words behind a colon; the first few.
fn told(differences: &[Difference]) -> String {
    const MOST: usize = 4;
    let mut words: Vec<String> = differences.iter().take(MOST).map(Difference::to_string).collect();
    if differences.len() > MOST {
        words.push(format!("and {} more", differences.len() - MOST));
    }
    if words.is_empty() { String::new() } else { format!(": {}", words.join("; ")) }
}

/// How to get the study going again where `file` is not the one of SHA-256 `sha256` any more.
fn put_back(file: &str, sha256: &Option<String>) -> String {
    let before = match sha256 {
        Some(sha256) => format!("put the file back that it was, of SHA-256 {sha256}"),
        None => format!("take {file} away, which was not there"),
    };
    format!(
        "{before}; or use --overwrite to make the run again (with the runs that compare with it), or another folder with -o"
    )
}

/// How `source` ended a run.
fn verb(source: &FarmError) -> &'static str {
    match source {
        FarmError::Controller { .. } | FarmError::Flow(FlowError::TurnedTooFar { .. }) => {
            "ended early"
        }
        _ => "diverged",
    }
}

/// What to do after `source` in air that `steadier` may carry, and what is left.
fn kept(
    source: &FarmError,
    steadier: &str,
    checkpoint: &Option<PathBuf>,
    series: &Option<PathBuf>,
) -> String {
    let mut text = String::from(match source {
        FarmError::Flow(FlowError::TurnedTooFar { .. }) => {
            "lower flow.step or raise flow.steps_per_turn, so that the rotor turns less in a step; where it turns faster than it is made for, look at its controller"
        }
        FarmError::Flow(_) => steadier,
        FarmError::Controller { .. } => {
            "the message is the controller's own: look into its input, and at what it saw before"
        }
        FarmError::Turbine { .. } => {
            "look at wind, rotor speed and loads before it: a shorter flow.step may carry the turbine, and no step does where wind or numbers of the case are beyond what a turbine is made for"
        }
    });
    if let Some(path) = series {
        text += &format!("; measured so far: {}", path.display());
    }
    if let Some(path) = checkpoint {
        text += &format!("; last good checkpoint: {}", path.display());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkpoint_that_does_not_fit_comes_with_a_fix() {
        let sensor = sensing::ForeignState { sensor: "beam".to_owned() };
        let errors =
            [StudyError::from(sensor), StudyError::from(PlaneSizeError { expected: 4, found: 5 })];
        for error in errors {
            let help = error.help().expect("a fix").to_string();
            assert!(help.contains("--overwrite"), "{error}: {help}");
        }
    }
}
