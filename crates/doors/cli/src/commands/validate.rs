//! `wakemix validate`: recorded validations, repeated.

use super::BAD_INPUT;
use clap::Args;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use validation::{Pictures, VALIDATIONS};

/// Arguments of `wakemix validate`.
#[derive(Args)]
pub(crate) struct ValidateArguments {
    /// Name of one validation; a list of them when left out
    name: Option<String>,
    /// Folder to draw the validation into, where it has pictures: figures/*.svg and *.png
    #[arg(long, value_name = "FOLDER", requires = "name")]
    pictures: Option<PathBuf>,
}

/// Prints measured against expected, and draws it where asked; exit code 1 when a row falls short, 2 for an unknown name, for
/// pictures of what has none, and for a folder that cannot be written.
pub(crate) fn run(arguments: &ValidateArguments) -> ExitCode {
    let Some(name) = &arguments.name else {
        println!("{:<20} {:>8}  what", "name", "minutes");
        for validation in VALIDATIONS {
            println!("{:<20} {:>8}  {}", validation.name, validation.minutes, validation.about);
        }
        return ExitCode::SUCCESS;
    };
    let Some(validation) = VALIDATIONS.iter().find(|validation| validation.name == name) else {
        let names: Vec<&str> = VALIDATIONS.iter().map(|validation| validation.name).collect();
        eprintln!("error: no validation is called `{name}`\nhint: one of {}", names.join(", "));
        return ExitCode::from(BAD_INPUT);
    };
    let drawing = match (&arguments.pictures, validation.pictures) {
        (None, _) => None,
        (Some(folder), Some(pictures)) => Some((folder, pictures)),
        (Some(_), None) => {
            let drawn = VALIDATIONS.iter().filter(|validation| validation.pictures.is_some());
            let names: Vec<&str> = drawn.map(|validation| validation.name).collect();
            eprintln!(
                "error: `{name}` has no pictures\nhint: leave out --pictures; those with pictures: {}",
                names.join(", ")
            );
            return ExitCode::from(BAD_INPUT);
        }
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
    if let Some((folder, pictures)) = drawing
        && let Err(error) = draw(folder, pictures)
    {
        let cause = error.source().map_or(String::new(), |cause| format!(": {cause}"));
        eprintln!("error: {error}{cause}\nhint: name another folder with --pictures");
        return ExitCode::from(BAD_INPUT);
    }
    if short == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Draws a validation into `folder` and prints where.
fn draw(folder: &Path, pictures: Pictures) -> Result<(), validation::ReportError> {
    for name in pictures(folder)? {
        println!("{}", folder.join("figures").join(format!("{name}.svg")).display());
    }
    Ok(())
}
