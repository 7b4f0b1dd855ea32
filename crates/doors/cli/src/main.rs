//! The command line: words in, words out; the work is done in the rooms behind it.

// What is printed goes through `commands::output`: a closed pipe or a full disk is no reason to panic.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod commands;
#[cfg(test)]
mod reference;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Wind-farm wake mixing, from wind to report.
#[derive(Parser)]
#[command(name = "wakemix", version, about, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a study: prints the cost, simulates every run of the case, leaves tables, records and a report
    Run(commands::run::RunArguments),
    /// Rebuild report.html and its figures from the records of a study
    Report {
        /// Folder that `wakemix run` wrote
        directory: PathBuf,
    },
    /// The turbine library: list, show, import, steady coefficients
    #[command(subcommand)]
    Turbine(commands::turbine::TurbineCommand),
    /// Turbulent inflow: generate, inspect, convert boxes
    #[command(subcommand)]
    Inflow(commands::inflow::InflowCommand),
    /// Damage-equivalent loads of channels, or of a pitch bearing, in OpenFAST output, CSV or the records of
    /// a run
    Fatigue(commands::fatigue::FatigueArguments),
    /// Analyse the records of runs: the phase of a helix, gains in several winds, what a loop would lock to
    #[command(subcommand)]
    Analyse(commands::analyse::AnalyseCommand),
    /// Repeat recorded validations and print measured against expected
    Validate(commands::validate::ValidateArguments),
    /// Print the JSON Schema of the case file, for editors
    Schema,
}

fn main() -> ExitCode {
    wakemix::study::outputs::announce();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return commands::output::usage(&error),
    };
    let done = match arguments.command {
        Command::Run(run) => return commands::run::run(&run),
        Command::Report { directory } => commands::report::run(&directory),
        Command::Turbine(command) => commands::turbine::run(command),
        Command::Inflow(command) => commands::inflow::run(command),
        Command::Fatigue(arguments) => commands::fatigue::run(&arguments),
        Command::Analyse(command) => commands::analyse::run(&command),
        Command::Validate(arguments) => return commands::validate::run(&arguments),
        Command::Schema => commands::output::print(&(wakemix::formats::case::schema() + "\n")),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(report) => commands::output::refuse(&report),
    }
}
