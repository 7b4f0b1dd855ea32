//! `wakemix campaign`: plan, run, exec, status, collect, export.

mod say;

use super::output::{print, print_json, print_text, refuse, say, tell, warn};
use super::{BAD_INPUT, DIVERGED, INTERRUPTED, arguments, stop};
use campaign::{CampaignError, Ended, Format, RunOptions, Script};
use clap::{Args, Subcommand, ValueEnum};
use miette::{IntoDiagnostic, Report};
use say::{Screen, planned, stands};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What there is to do with a campaign.
#[derive(Subcommand)]
pub(crate) enum CampaignCommand {
    /// Read a campaign's file, write its tasks into a folder, and print what they will cost
    Plan {
        /// The campaign's file (TOML)
        file: PathBuf,
        /// Folder of the campaign; `campaigns/NAME` when left out
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
    /// Make all tasks that are not done; go on after an end of any kind
    Run(CampaignRun),
    /// Make given tasks, failed ones again: what schedulers call
    Exec {
        /// Folder of the campaign
        directory: PathBuf,
        /// Number of a task, or a range such as 11-20; what is beyond the last task is left out
        #[arg(value_parser = range)]
        tasks: (i64, i64),
        /// Tasks at a time
        #[arg(long, value_name = "N", value_parser = arguments::jobs)]
        jobs: Option<usize>,
    },
    /// Print how many tasks are done, pending or failed, the pace, and why tasks failed
    Status {
        /// Folder of the campaign
        directory: PathBuf,
        /// Print JSON on stdout instead of text
        #[arg(long)]
        json: bool,
    },
    /// Write the results, a row for each task that is done: factors, seeds, numbers with units
    Collect {
        /// Folder of the campaign
        directory: PathBuf,
        /// File to write (.parquet or .csv); results.parquet, or results.csv in a build without Parquet, in
        /// the campaign's folder when left out
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
        /// Factors, such as the key of the seed, over which a row has the means of its tasks
        #[arg(long, value_name = "KEY", value_delimiter = ',')]
        mean_over: Vec<String>,
    },
    /// Print a script that has a scheduler make the tasks
    Export {
        /// Folder of the campaign
        directory: PathBuf,
        /// Scheduler
        #[arg(long, value_enum)]
        format: Scheduler,
        /// Tasks that one job makes one after the other
        #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(i64).range(1..))]
        chunk: i64,
    },
}

/// Arguments of `wakemix campaign run`.
#[derive(Args)]
pub(crate) struct CampaignRun {
    /// Folder of the campaign
    directory: PathBuf,
    /// Tasks at a time; as many as cores carry with a task's threads when left out
    #[arg(long, value_name = "N", value_parser = arguments::jobs)]
    jobs: Option<usize>,
    /// Make failed tasks again
    #[arg(long)]
    retry_failed: bool,
    /// End after so many tasks
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(i64).range(1..))]
    limit: Option<i64>,
}

/// Schedulers that scripts are written for.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Scheduler {
    /// An array job of Slurm
    Slurm,
    /// A task array of HyperQueue
    Hyperqueue,
    /// GNU parallel
    Parallel,
}

/// A task's number, or the first and the last of a range.
fn range(text: &str) -> Result<(i64, i64), String> {
    let number = |text: &str| text.trim().parse::<i64>().ok().filter(|number| *number > 0);
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    match (number(first), number(last)) {
        (Some(first), Some(last)) if first <= last => Ok((first, last)),
        _ => Err(format!("\"{text}\" is no task: give a number from 1, or a range such as 11-20")),
    }
}

/// Does what `command` asks for; exit code 0 done, 2 bad input, 3 some tasks failed, 130 interrupted.
pub(crate) fn run(command: CampaignCommand) -> ExitCode {
    let done = match command {
        CampaignCommand::Run(arguments) => {
            let options = RunOptions {
                jobs: arguments.jobs,
                retry_failed: arguments.retry_failed,
                only: None,
                limit: arguments.limit,
            };
            return make(&arguments.directory, &options);
        }
        CampaignCommand::Exec { directory, tasks, jobs } => {
            let options = RunOptions { jobs, retry_failed: true, only: Some(tasks), limit: None };
            return make(&directory, &options);
        }
        CampaignCommand::Plan { file, output } => plan(&file, output.as_deref()),
        CampaignCommand::Status { directory, json } => status(&directory, json),
        CampaignCommand::Collect { directory, output, mean_over } => {
            collect(&directory, output, &mean_over)
        }
        CampaignCommand::Export { directory, format, chunk } => export(&directory, format, chunk),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(report) => refuse(&report),
    }
}

fn plan(file: &Path, folder: Option<&Path>) -> miette::Result<()> {
    let plan = campaign::plan(file, folder)?;
    print_text(&planned(&plan))?;
    let folder = stop::shell_word(&plan.folder.display().to_string());
    tell(&format!("make its tasks with: wakemix campaign run {folder}"));
    Ok(())
}

/// Makes the tasks of the campaign in `folder` that `options` name.
fn make(folder: &Path, options: &RunOptions) -> ExitCode {
    let stop = stop::on_interrupt();
    let mut screen = Screen::new();
    let ended = campaign::run(folder, options, &stop, &mut screen);
    screen.clear();
    match ended {
        Ok(ended) => tell_end(folder, &ended),
        Err(error) => {
            let code = match error {
                CampaignError::Stopped { .. } => DIVERGED,
                _ => BAD_INPUT,
            };
            refuse(&Report::new(error));
            ExitCode::from(code)
        }
    }
}

fn tell_end(folder: &Path, ended: &Ended) -> ExitCode {
    let folder = stop::shell_word(&folder.display().to_string());
    let counts = &ended.counts;
    tell(&format!(
        "{} tasks made here, {} failed; of {} tasks {} are done, {} pending, {} running, {} failed",
        ended.n_done,
        ended.n_failed,
        counts.all(),
        counts.done,
        counts.pending,
        counts.running,
        counts.failed
    ));
    if ended.n_elsewhere > 0 {
        warn(&format!("{} tasks are being made by other processes", ended.n_elsewhere));
    }
    if ended.is_interrupted {
        say(&format!("interrupted; go on with: wakemix campaign run {folder}"));
        return ExitCode::from(INTERRUPTED);
    }
    if ended.n_failed > 0 {
        say(&format!(
            "tasks failed: `wakemix campaign status {folder}` tells why; make them again with: wakemix campaign run {folder} --retry-failed"
        ));
        return ExitCode::from(DIVERGED);
    }
    ExitCode::SUCCESS
}

fn status(folder: &Path, as_json: bool) -> miette::Result<()> {
    let status = campaign::status(folder)?;
    if as_json {
        return print_json(&say::json(&status));
    }
    print_text(&stands(&status))
}

fn collect(folder: &Path, output: Option<PathBuf>, mean_over: &[String]) -> miette::Result<()> {
    let usual = if cfg!(feature = "parquet") { "results.parquet" } else { "results.csv" };
    let path = output.unwrap_or_else(|| folder.join(usual));
    let found = campaign::collect(folder, &path, mean_over)?;
    let missing = match found.n_missing {
        0 => String::new(),
        n => format!(", {n} tasks are not done"),
    };
    tell(&format!(
        "{}: {} rows of {} columns{missing}",
        path.display(),
        found.n_rows,
        found.n_columns
    ));
    Ok(())
}

fn export(folder: &Path, scheduler: Scheduler, chunk: i64) -> miette::Result<()> {
    let format = match scheduler {
        Scheduler::Slurm => Format::Slurm,
        Scheduler::Hyperqueue => Format::HyperQueue,
        Scheduler::Parallel => Format::Parallel,
    };
    let program = std::env::current_exe().into_diagnostic()?.display().to_string();
    print(&campaign::export(folder, &Script { format, program, chunk })?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_is_a_number_or_a_range() {
        assert_eq!(range("7"), Ok((7, 7)));
        assert_eq!(range("11-20"), Ok((11, 20)));
        for wrong in ["0", "5-4", "a", "-3", "1-"] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
    }
}
