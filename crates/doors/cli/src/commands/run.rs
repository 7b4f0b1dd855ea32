//! `wakemix run`: one study from case file to report.

mod again;
mod pace;
mod screen;
mod so_far;
mod stages;

use super::output::{columns, detail, print, refuse, say, tell};
use super::{BAD_INPUT, DIVERGED, INTERRUPTED};
use crate::commands::{arguments, stop, sweep_table, table};
use again::interrupted;
use clap::Args;
use miette::IntoDiagnostic;
use screen::Screen;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use wakemix::farm::pitch_response::CalibrationError;
use wakemix::farm::self_check::SelfCheckError;
use wakemix::postprocessing;
use wakemix::study::{self, Outcome, StudyError, StudyOptions};

/// Arguments of `wakemix run`.
#[derive(Args)]
pub(crate) struct RunArguments {
    /// Case file (TOML), or the name of a case that `wakemix cases` lists
    case: PathBuf,
    /// Folder for the results; `runs/NAME-OF-THE-CASE` when left out
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Only this run of the case (may be repeated); of a sweep, all runs made from it, or STUDY/NAME for the
    /// run of one study
    #[arg(long = "run", value_name = "NAME")]
    runs: Vec<String>,
    /// Make every run in so many winds, of the case's seed and the following ones, and tell gains with
    /// intervals over them
    #[arg(long, value_name = "N", value_parser = arguments::seeds)]
    seeds: Option<usize>,
    /// Runs to make at a time, which share the cores; when left out as many as cores and memory carry. The
    /// results are the same
    #[arg(long, value_name = "N", value_parser = arguments::jobs)]
    jobs: Option<usize>,
    /// Override a key of the case, as in `--set wind.speed=8` (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Resume an interrupted or killed run, or go on with complete ones after `time.duration` is raised; the
    /// result has the same bits
    #[arg(long)]
    resume: bool,
    /// Replace old results
    #[arg(long, conflicts_with = "resume")]
    overwrite: bool,
    /// Print what the study would cost, and stop: every file that the case names is read, and the machine is
    /// timed for a moment
    #[arg(long)]
    dry_run: bool,
    /// With --dry-run: check the rotors against blade-element momentum as well, as a run does before it
    /// begins
    #[arg(long, requires = "dry_run")]
    check: bool,
    /// Print the summaries as JSON on stdout instead of the table
    #[arg(long)]
    json: bool,
}

/// Runs the study; exit code 0 done, 2 bad input, 3 diverged, 130 interrupted.
pub(crate) fn run(arguments: &RunArguments) -> ExitCode {
    let stop = stop::on_interrupt();
    let options = StudyOptions {
        case: arguments.case.clone(),
        output: arguments.output.clone(),
        runs: arguments.runs.clone(),
        overrides: arguments.overrides.clone(),
        resume: arguments.resume,
        overwrite: arguments.overwrite,
        dry_run: arguments.dry_run,
        check: arguments.check,
        jobs: arguments.jobs,
        seeds: arguments.seeds,
        ..StudyOptions::default()
    };
    let mut screen = Screen::new(&arguments.case);
    let outcome = study::run(&options, &stop, &mut screen);
    screen.bar.finish_and_clear();
    screen.enter("");
    match outcome {
        Ok(Outcome::Done { directory, .. }) => done(&directory, arguments.json),
        Ok(Outcome::Estimated) => ExitCode::SUCCESS,
        Ok(Outcome::Interrupted { directory }) => {
            say(&interrupted(arguments, &directory));
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            let code = match &error {
                StudyError::Diverged { .. }
                | StudyError::SelfCheck(SelfCheckError::Flow(_))
                | StudyError::Calibration(CalibrationError::Flow(_)) => DIVERGED,
                _ => BAD_INPUT,
            };
            refuse(&miette::Report::new(error));
            ExitCode::from(code)
        }
    }
}

/// Makes the report of the complete study or sweep in `directory`, and prints what came of it.
fn done(directory: &Path, as_json: bool) -> ExitCode {
    let began = Instant::now();
    let made = match postprocessing::report(directory) {
        Ok(made) => made,
        Err(error) => return refuse(&miette::Report::new(error)),
    };
    detail(&format!("time: {:.2} s report", began.elapsed().as_secs_f64()));
    tell(&format!("report: {}", made.page.display()));
    let json = |text: serde_json::Result<String>| text.map(|text| text + "\n").into_diagnostic();
    let text = match (&made.sweep, as_json) {
        (Some(table), true) => json(serde_json::to_string_pretty(table)),
        (None, true) => json(serde_json::to_string_pretty(&made.summaries)),
        (Some(table), false) => Ok(sweep_table::render(table, columns())),
        (None, false) => Ok(table::render(&made.summaries, columns())),
    };
    match text.and_then(|text| print(&text)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(report) => refuse(&report),
    }
}
