//! Whole studies as validations run them: with lines of progress, or silent in a process of their own; on
//! from where an earlier call stopped.

use crate::Row;
use crate::row::Tolerance::Within;
use basis::records::Summary;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::AtomicBool;
use study::{Observer, Options, Outcome};

/// Where the expected values come from.
const SOURCE: &str = "–";

/// Prints progress as plain lines.
struct Lines {
    last: String,
}

impl Observer for Lines {
    fn advanced(&mut self, progress: &study::Progress) {
        let share = 10 * progress.step / progress.n_steps.max(1);
        let line = format!("{} {share}0 %", progress.run);
        if line != self.last {
            tell!("{line}, {:.0} s left in all", progress.time_left);
            self.last = line;
        }
    }

    fn warned(&mut self, warning: &str) {
        tell!("warning: {warning}");
    }
}

/// Runs the case at `path` with `overrides` of its keys, or takes up what is left of it in
/// `runs/validate-NAME`; gives summaries and that folder.
pub(crate) fn summaries(
    path: &Path,
    name: &str,
    overrides: Vec<String>,
) -> Result<(Vec<Summary>, PathBuf), String> {
    let output = Path::new("runs").join(format!("validate-{name}"));
    let options = Options {
        case: path.to_owned(),
        output: Some(output.clone()),
        overrides,
        resume: formats::records::is_begun(&output),
        ..Options::default()
    };
    let mut observer = Lines { last: String::new() };
    match study::run(&options, &AtomicBool::new(false), &mut observer) {
        Ok(Outcome::Done { summaries, .. }) => Ok((summaries, output)),
        Ok(other) => Err(format!("the study ended early: {other:?}")),
        Err(error) => Err(error.to_string()),
    }
}

/// `wakemix run`, silent, of the case at `path`: what is left of it in the folder `output`.
pub(crate) fn command(path: &Path, output: &Path) -> Command {
    let program = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("wakemix"));
    let mut command = Command::new(program);
    command.arg("run").arg(path).arg("-o").arg(output);
    if formats::records::is_begun(output) {
        command.arg("--resume");
    }
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The one row of a validation that could not be made.
pub(crate) fn failure(problem: String) -> Vec<Row> {
    vec![Row {
        what: problem,
        measured: f64::NAN,
        expected: 0.0,
        tolerance: Within(0.0),
        unit: "-",
        source: SOURCE,
    }]
}

/// The summary of the run of this name.
pub(crate) fn find<'a>(summaries: &'a [Summary], run: &str) -> Option<&'a Summary> {
    summaries.iter().find(|summary| summary.run == run)
}
