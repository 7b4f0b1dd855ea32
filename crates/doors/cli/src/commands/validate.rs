//! `wakemix validate`: recorded validations, repeated.

use super::BAD_INPUT;
use clap::Args;
use std::process::ExitCode;
use validation::VALIDATIONS;

/// Arguments of `wakemix validate`.
#[derive(Args)]
pub(crate) struct ValidateArguments {
    /// Name of one validation; a list of them when left out
    name: Option<String>,
}

/// Prints measured against expected; exit code 1 when a row falls short, 2 for an unknown name.
pub(crate) fn run(arguments: &ValidateArguments) -> ExitCode {
    let Some(name) = &arguments.name else {
        println!("{:<16} {:>10}  what", "name", "minutes");
        for validation in VALIDATIONS {
            println!("{:<16} {:>10}  {}", validation.name, validation.minutes, validation.about);
        }
        return ExitCode::SUCCESS;
    };
    let Some(validation) = VALIDATIONS.iter().find(|validation| validation.name == name) else {
        let names: Vec<&str> = VALIDATIONS.iter().map(|validation| validation.name).collect();
        eprintln!("error: no validation is called `{name}`\nhint: one of {}", names.join(", "));
        return ExitCode::from(BAD_INPUT);
    };
    let rows = (validation.run)();
    println!(
        "{:<64} {:>12} {:>12} {:>10} {:<6} within",
        "what", "measured", "expected", "tolerance", "unit"
    );
    let mut short = 0;
    for row in &rows {
        short += usize::from(!row.passes());
        println!(
            "{:<64} {:>12.6} {:>12.6} {:>10.2e} {:<6} {}",
            row.what,
            row.measured,
            row.expected,
            row.tolerance,
            row.unit,
            if row.passes() { "yes" } else { "NO" }
        );
    }
    println!("{} rows, {short} fall short", rows.len());
    if short == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
