//! `wakemix validate`: recorded validations, repeated.

use super::BAD_INPUT;
use clap::Args;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use validation::{Pictures, VALIDATIONS, Validation};

/// Arguments of `wakemix validate`.
#[derive(Args)]
pub(crate) struct ValidateArguments {
    /// Names of validations; a list of them when left out
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Folder to draw the validations into, where they have pictures: figures/*.svg and *.png
    #[arg(long, value_name = "FOLDER", requires = "names")]
    pictures: Option<PathBuf>,
}

/// Prints measured against expected, and draws it where asked; exit code 1 when a row falls short, 2 for an unknown name, for
/// pictures of what has none, and for a folder that cannot be written.
pub(crate) fn run(arguments: &ValidateArguments) -> ExitCode {
    if arguments.names.is_empty() {
        println!("{:<20} {:>8}  what", "name", "minutes");
        for validation in VALIDATIONS {
            println!("{:<20} {:>8}  {}", validation.name, validation.minutes, validation.about);
        }
        return ExitCode::SUCCESS;
    }
    let mut wanted = Vec::new();
    for name in &arguments.names {
        let found = VALIDATIONS.iter().find(|validation| validation.name == name);
        let Some(validation) = found else {
            let names = listed(|_| true);
            eprintln!("error: no validation is called `{name}`\nhint: one of {names}");
            return ExitCode::from(BAD_INPUT);
        };
        if arguments.pictures.is_some() && validation.pictures.is_none() {
            let drawn = listed(|validation| validation.pictures.is_some());
            eprintln!(
                "error: `{name}` has no pictures\nhint: leave out --pictures; those with pictures: {drawn}"
            );
            return ExitCode::from(BAD_INPUT);
        }
        wanted.push(validation);
    }
    let mut short = 0;
    for validation in wanted {
        short += compare(validation);
        if let (Some(folder), Some(pictures)) = (&arguments.pictures, validation.pictures)
            && let Err(error) = draw(folder, pictures)
        {
            let cause = error.source().map_or(String::new(), |cause| format!(": {cause}"));
            eprintln!("error: {error}{cause}\nhint: name another folder with --pictures");
            return ExitCode::from(BAD_INPUT);
        }
    }
    if short == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Names of the validations that `counts`.
fn listed(counts: impl Fn(&Validation) -> bool) -> String {
    let names: Vec<&str> =
        VALIDATIONS.iter().filter(|validation| counts(validation)).map(|v| v.name).collect();
    names.join(", ")
}

/// Makes the comparison and prints it; gives how many rows fall short.
fn compare(validation: &Validation) -> usize {
    let rows = (validation.run)();
    println!(
        "{:<64} {:>12} {:>12} {:>10} {:<6} within",
        "what", "measured", "expected", "tolerance", "unit"
    );
    for row in &rows {
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
    let short = rows.iter().filter(|row| !row.passes()).count();
    println!("{} rows, {short} fall short", rows.len());
    short
}

/// Draws a validation into `folder` and prints where.
fn draw(folder: &Path, pictures: Pictures) -> Result<(), validation::ReportError> {
    for name in pictures(folder)? {
        println!("{}", folder.join("figures").join(format!("{name}.svg")).display());
    }
    Ok(())
}
