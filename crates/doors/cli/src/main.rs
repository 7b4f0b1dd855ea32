//! The command line: words in, words out; the work is done in the rooms behind it.

// What is printed goes through `commands::output`: a closed pipe or a full disk is no reason to panic.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod commands;
#[cfg(test)]
mod reference;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use commands::manner::{self, Manner};
use commands::output;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use wakemix::formats::case;

/// Wind-farm wake mixing, from wind to report.
#[derive(Parser)]
#[command(name = "wakemix", version, about, max_term_width = 100)]
struct Arguments {
    #[command(flatten)]
    manner: Manner,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a study: prints the cost, simulates every run of the case, leaves tables, records and a report
    Run(commands::run::RunArguments),
    /// Write a commented case file to begin with
    Init(commands::init::InitArguments),
    /// List the cases that come with the program, or write one of them out
    Cases(commands::cases::CasesArguments),
    /// Thousands of short simulations of one case: plan, run, resume, collect
    #[cfg(feature = "campaign")]
    #[command(subcommand)]
    Campaign(commands::campaign::CampaignCommand),
    /// Not in this build
    #[cfg(not(feature = "campaign"))]
    #[command(hide = true)]
    Campaign {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Rebuild report.html and its figures from the records of a study or a precursor
    Report {
        /// Folder that `wakemix run` wrote
        directory: PathBuf,
    },
    /// The turbine library: list, show, import, steady coefficients
    #[command(subcommand)]
    Turbine(commands::turbine::TurbineCommand),
    /// Turbulent inflow: generate, inspect, convert boxes; record planes of an atmosphere
    #[command(subcommand)]
    Inflow(commands::inflow::InflowCommand),
    /// Damage-equivalent loads of channels, or of a pitch bearing, in OpenFAST output, CSV or the records of
    /// a run
    Fatigue(commands::fatigue::FatigueArguments),
    /// Analyse the records of runs: the phase of a helix, gains in several winds, what a loop would lock to
    #[command(subcommand)]
    Analyse(commands::analyse::AnalyseCommand),
    /// Identify a linear model from a record of inputs and outputs, by subspaces (PBSID-opt)
    #[cfg(feature = "design")]
    Identify(commands::identify::IdentifyArguments),
    /// Synthesise a controller for a model: H-infinity, H2 or LQG, with a Smith predictor for its delay
    #[cfg(feature = "design")]
    Synthesize(commands::synthesize::SynthesizeArguments),
    /// Gaussian processes from tables of samples: train, predict, validate, show
    #[cfg(feature = "design")]
    #[command(subcommand)]
    Surrogate(commands::surrogate::SurrogateCommand),
    /// Not in this build
    #[cfg(not(feature = "design"))]
    #[command(hide = true, aliases = ["synthesize", "surrogate"])]
    Identify {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Tune a controller of a case from few simulations: Gaussian processes choose the runs
    #[cfg(feature = "tune")]
    Tune(commands::tune::TuneArguments),
    /// Not in this build
    #[cfg(not(feature = "tune"))]
    #[command(hide = true)]
    Tune {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Repeat recorded validations and print measured against expected
    #[cfg(feature = "validate")]
    Validate(commands::validate::ValidateArguments),
    /// Not in this build
    #[cfg(not(feature = "validate"))]
    #[command(hide = true)]
    Validate {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Print the JSON Schema of the case file, for editors
    Schema {
        /// That of the file of a precursor, which `wakemix inflow precursor` reads
        #[arg(long)]
        precursor: bool,
    },
    /// Print completions of commands and options for a shell
    Completions {
        /// Shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page of the program or of a command, or write all of them
    Man(commands::definition::ManArguments),
}

fn main() -> ExitCode {
    let began = Instant::now();
    wakemix::study::outputs::announce();
    #[cfg(feature = "parquet")]
    campaign::announce_parquet();
    let arguments = match arguments() {
        Ok(arguments) => arguments,
        Err(error) => return output::usage(&error),
    };
    arguments.manner.hold();
    let code = run(arguments.command);
    output::detail(&format!("time: {:.2} s in all", began.elapsed().as_secs_f64()));
    code
}

/// The command line, read.
///
/// # Errors
/// What is wrong with it; help and version, likewise.
fn arguments() -> Result<Arguments, clap::Error> {
    let mut program = Arguments::command().color(manner::color_of(std::env::args_os()));
    let mut matches = program.try_get_matches_from_mut(std::env::args_os())?;
    Arguments::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut program))
}

/// Does what `command` asks for; the exit code says how that ended.
fn run(command: Command) -> ExitCode {
    let done = match command {
        Command::Run(run) => return commands::run::run(&run),
        Command::Init(arguments) => commands::init::run(&arguments),
        Command::Cases(arguments) => commands::cases::run(&arguments),
        #[cfg(feature = "campaign")]
        Command::Campaign(command) => return commands::campaign::run(command),
        #[cfg(not(feature = "campaign"))]
        Command::Campaign { .. } => Err(left_out("campaigns")),
        Command::Report { directory } => commands::report::run(&directory),
        Command::Turbine(command) => commands::turbine::run(command),
        Command::Inflow(command) => return commands::inflow::run(command),
        Command::Fatigue(arguments) => commands::fatigue::run(&arguments),
        Command::Analyse(command) => commands::analyse::run(&command),
        #[cfg(feature = "design")]
        Command::Identify(arguments) => commands::identify::run(&arguments),
        #[cfg(feature = "design")]
        Command::Synthesize(arguments) => commands::synthesize::run(&arguments),
        #[cfg(feature = "design")]
        Command::Surrogate(command) => commands::surrogate::run(&command),
        #[cfg(not(feature = "design"))]
        Command::Identify { .. } => Err(left_out("control design and surrogates")),
        #[cfg(feature = "tune")]
        Command::Tune(arguments) => return commands::tune::run(&arguments),
        #[cfg(not(feature = "tune"))]
        Command::Tune { .. } => Err(left_out("tuning")),
        #[cfg(feature = "validate")]
        Command::Validate(arguments) => return commands::validate::run(&arguments),
        #[cfg(not(feature = "validate"))]
        Command::Validate { .. } => Err(left_out("validations")),
        Command::Schema { precursor } => {
            let case = if precursor { case::precursor_schema() } else { case::schema() };
            output::print(&(case + "\n"))
        }
        Command::Completions { shell } => {
            commands::definition::completions(shell, Arguments::command())
        }
        Command::Man(arguments) => commands::definition::man(&arguments, Arguments::command()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(report) => output::refuse(&report),
    }
}

/// Why `what` cannot be had here.
#[cfg(not(all(feature = "campaign", feature = "design", feature = "tune", feature = "validate")))]
fn left_out(what: &str) -> miette::Report {
    miette::miette!(
        help = "build it with its default features, without --no-default-features",
        "this program was built without {what}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_every_command_stand_before_and_behind_it() {
        Arguments::command().debug_assert();
        for words in [
            &["wakemix", "-q", "turbine", "list"][..],
            &["wakemix", "turbine", "list", "-v", "--color", "never"],
            &["wakemix", "analyse", "lock", "a", "--quiet"],
        ] {
            assert!(Arguments::try_parse_from(words).is_ok(), "{words:?}");
        }
    }
}
