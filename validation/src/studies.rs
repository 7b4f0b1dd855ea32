//! Whole studies as validations run them: with lines of progress, or silent in a process of their own; on
//! from where an earlier call of the same build stopped.

use crate::Row;
use crate::row::Tolerance::Within;
use basis::records::Summary;
use formats::atomic;
use formats::lock::Lock;
use formats::records::{PrecursorFolder, PrecursorResult, sha256};
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::{env, fs, io};
use study::precursor::{PrecursorObserver, PrecursorOptions, PrecursorOutcome, PrecursorProgress};
use study::{Observer, Outcome, StudyError, StudyOptions};

/// Where the expected values come from.
const SOURCE: &str = "–";

/// Prints progress as plain lines.
#[derive(Default)]
pub(crate) struct Lines {
    last: String,
}

impl Observer for Lines {
    fn advanced(&mut self, progress: &study::Progress) {
        // Of all runs together: several go on at a time, and their turns would be a line each.
        let line = format!("{:.0}0 %", (10.0 * progress.share_of_all).floor());
        if line != self.last {
            let (run, left) = (progress.run, progress.time_left);
            tell!("{line} of {} runs, now {run}, {left:.0} s left", progress.n_runs);
            self.last = line;
        }
    }

    fn warned(&mut self, warning: &str) {
        tell!("warning: {warning}");
    }
}

impl PrecursorObserver for Lines {
    fn advanced(&mut self, progress: &PrecursorProgress) {
        let share = 10 * progress.step / progress.n_steps.max(1);
        let line = format!("precursor {share}0 %");
        if line != self.last {
            tell!("{line}, {:.0} s left", progress.time_left);
            self.last = line;
        }
    }

    fn warned(&mut self, warning: &str) {
        tell!("warning: {warning}");
    }
}

impl campaign::Observer for Lines {
    fn ended(&mut self, progress: &campaign::Progress) {
        let counts = &progress.counts;
        let line = format!("{}0 %", 10 * counts.done / counts.all().max(1));
        if line != self.last {
            tell!("{line} of {} tasks, {:.0} s left", counts.all(), progress.time_left);
            self.last = line;
        }
        if let Some(failure) = &progress.failure {
            tell!("task {} failed: {failure}", progress.task);
        }
    }
}

impl tuning::Watch for Lines {
    fn proposed(&mut self, first: usize, n_runs: usize, words: &[String], gain: Option<f64>) {
        let expected = gain.map_or_else(String::new, |gain| {
            format!(
                "; {:.2} % of the array's power more than the best so far are expected",
                100.0 * gain
            )
        });
        for (place, words) in words.iter().enumerate() {
            tell!("run {} of {n_runs} at most: {words}{expected}", first + place + 1);
        }
    }
}

/// Name of the file in a study's folder that tells which build of the program made it.
const MADE_BY: &str = "made-by.sha256";

/// The case of a validation, which the program carries with it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Carried {
    /// The shipped case of this name.
    Shipped(&'static str),
    /// One of the validation's own, its text.
    Own(&'static str),
}

/// Runs the `case` with `overrides` of its keys, or takes up what this very build of the program left of it
/// in `runs/validate-NAME` of the current folder, and says where that is; gives summaries and that folder.
///
/// No other process can do so at the same time: what is not of this build is taken away there.
pub(crate) fn summaries(
    case: Carried,
    name: &str,
    overrides: Vec<String>,
) -> Result<(Vec<Summary>, PathBuf), String> {
    summaries_of(case, name, overrides, &[])
}

/// The same of these `runs` alone; of all where none is named.
pub(crate) fn summaries_of(
    case: Carried,
    name: &str,
    overrides: Vec<String>,
    runs: &[&str],
) -> Result<(Vec<Summary>, PathBuf), String> {
    let (output, _lock) = folder_of(name)?;
    let path = match case {
        Carried::Shipped(name) => PathBuf::from(name),
        Carried::Own(text) => {
            let path = output.join("case.toml");
            atomic::write(&path, "the case file", text.as_bytes())
                .map_err(|error| words(&error))?;
            path
        }
    };
    let options = StudyOptions {
        case: path,
        output: Some(output.clone()),
        runs: runs.iter().map(|&run| run.to_owned()).collect(),
        overrides,
        resume: formats::records::is_begun(&output),
        ..StudyOptions::default()
    };
    let mut observer = Lines::default();
    match study::run(&options, &AtomicBool::new(false), &mut observer) {
        Ok(Outcome::Done { summaries, .. }) => Ok((summaries, output)),
        Ok(other) => Err(format!("the study ended early: {other:?}")),
        Err(StudyError::Case(error)) => Err(error.to_lines().trim_end().to_owned()),
        Err(error) => Err(words(&error)),
    }
}

/// The folder of what is made under this `name`, claimed for this build, and the lock on it.
pub(crate) fn folder_of(name: &str) -> Result<(PathBuf, Lock), String> {
    let output = Path::new("runs").join(format!("validate-{name}"));
    let lock = Path::new("runs").join(format!(".validate-{name}.lock"));
    let what = format!("{} of this validation", output.display());
    let lock = Lock::take(&lock, &what).map_err(|error| words(&error))?;
    let there = claimed(&output, &this_build()?)?;
    tell!("{there} {}", output.display());
    Ok((output, lock))
}

/// Makes the shipped precursor `case` with `overrides` of its keys, likewise; gives what came of it and the
/// file of its planes.
pub(crate) fn precursor(
    case: &str,
    name: &str,
    overrides: Vec<String>,
) -> Result<(PrecursorResult, PathBuf), String> {
    let (output, _lock) = folder_of(name)?;
    let options = PrecursorOptions {
        case: PathBuf::from(case),
        output: Some(output.clone()),
        overrides,
        resume: PrecursorFolder::new(&output).case_path().exists(),
        ..PrecursorOptions::default()
    };
    let mut observer = Lines::default();
    match study::precursor::precursor(&options, &AtomicBool::new(false), &mut observer) {
        Ok(PrecursorOutcome::Done { result, folder }) => {
            let planes = fs::canonicalize(folder.planes_path());
            let planes = planes.map_err(|error| format!("the planes: {error}"))?;
            Ok((*result, planes))
        }
        Ok(other) => Err(format!("the precursor ended early: {other:?}")),
        Err(error) => Err(words(&error)),
    }
}

/// `error` with its causes and its fix, on one line.
pub(crate) fn words(error: &dyn Diagnostic) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(deeper) = cause {
        text += &format!(": {deeper}");
        cause = deeper.source();
    }
    match error.help() {
        Some(help) => format!("{text}; {help}"),
        None => text,
    }
}

/// Hash of the program that is running.
fn this_build() -> Result<String, String> {
    let program = env::current_exe().and_then(fs::read);
    let program = program.map_err(|error| format!("the program cannot read itself: {error}"))?;
    Ok(sha256(&program))
}

/// Makes `folder` that of `build`: what another build left there, or nobody knows which, is taken away, so
/// that it is neither read as what the program gives now nor gone on with. Gives what is done there.
fn claimed(folder: &Path, build: &str) -> Result<&'static str, String> {
    let mark = folder.join(MADE_BY);
    let named = |error: io::Error| {
        format!("{}: {error}; take that folder away and repeat", folder.display())
    };
    let done = match fs::read_to_string(&mark) {
        Ok(found) if found.trim() == build => return Ok("continuing what this build left in"),
        _ if !folder.exists() => "running in",
        _ => {
            fs::remove_dir_all(folder).map_err(named)?;
            "made by another build and taken away, running anew in"
        }
    };
    fs::create_dir_all(folder).map_err(named)?;
    fs::write(&mark, build).map_err(named)?;
    Ok(done)
}

/// `wakemix run`, silent, of the case at `path` or the shipped one of that name: what is left of it in the
/// folder `output`.
pub(crate) fn command(path: &Path, output: &Path) -> Command {
    let program = env::current_exe().unwrap_or_else(|_| PathBuf::from("wakemix"));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_else_validates_is_named_and_errors_keep_their_fix() {
        let folder = env::temp_dir().join(format!("wakemix-held-{}", std::process::id()));
        let lock = folder.join(".validate-a.lock");
        let held = Lock::take(&lock, "a").unwrap();
        let refused = words(&Lock::take(&lock, "a").unwrap_err());
        assert!(refused.contains(&format!("process {}", std::process::id())), "{refused}");
        assert!(refused.contains("; wait until that ends"), "{refused}");
        drop(held);
        fs::remove_dir_all(&folder).unwrap_or_default();
        let gone = words(&atomic::read_text(Path::new("no/such/file"), "a case").unwrap_err());
        assert!(gone.contains("No such file") && gone.contains("; "), "{gone}");
    }

    #[test]
    fn what_another_build_left_is_not_taken_up() {
        let folder = env::temp_dir().join(format!("wakemix-made-by-{}", std::process::id()));
        let summary = folder.join("baseline").join("summary.json");
        let leave = || {
            fs::create_dir_all(folder.join("baseline")).unwrap();
            fs::write(&summary, "{}").unwrap();
        };
        assert_eq!(claimed(&folder, "one").unwrap(), "running in");
        leave();
        assert!(claimed(&folder, "one").unwrap().starts_with("continuing"));
        assert!(summary.exists());
        assert!(claimed(&folder, "other").unwrap().starts_with("made by another build"));
        assert!(!summary.exists());
        // Made before builds were told apart.
        leave();
        fs::remove_file(folder.join(MADE_BY)).unwrap();
        assert!(claimed(&folder, "other").unwrap().starts_with("made by another build"));
        assert!(!summary.exists());
        assert!(claimed(&folder, "other").unwrap().starts_with("continuing"));
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(this_build().unwrap().len(), 64);
    }
}
