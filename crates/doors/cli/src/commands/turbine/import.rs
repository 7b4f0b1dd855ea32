//! `wakemix turbine import`: decks and files of others as turbine files, and what they lack.

use crate::commands::output::{detail, say, tell};
use miette::{Result, miette};
use std::path::Path;
use wakemix::formats::{atomic, openfast, turbine_file, windio};

/// On return the turbine of `file` stands in `output`.
///
/// # Errors
/// Input that cannot be read, and a turbine that lacks figures: `output` is written then too.
pub(super) fn import(
    file: &Path,
    output: &Path,
    options: &openfast::ImportOptions,
    further: &windio::WindioOptions,
) -> Result<()> {
    let extension = file.extension().map(|end| end.to_string_lossy().to_lowercase());
    let (document, is_windio) = match extension.as_deref() {
        Some("fst") if *further != windio::WindioOptions::default() => {
            return Err(miette!(
                help = "leave them out, and edit the turbine file that the import writes",
                "--polars, --reynolds and --complete are for windIO files (.yaml)"
            ));
        }
        Some("fst") => (openfast::import(file, options)?, false),
        Some("yaml" | "yml") => {
            let windio::Imported { document, notes } = windio::import_with(file, options, further)?;
            notes.iter().for_each(|note| say(note));
            (document, true)
        }
        _ => {
            let found = file.display();
            return Err(miette!(
                help = "give the main file of an OpenFAST deck (.fst) or a windIO file (.yaml)",
                "cannot tell what {found} is"
            ));
        }
    };
    detail(&format!("read: {}", file.display()));
    let written = turbine_file::write(&document);
    atomic::write(output, "the turbine file", written.text.as_bytes())?;
    tell(&format!("wrote {}", output.display()));
    if written.missing.is_empty() {
        turbine_file::read(output)?;
        return Ok(());
    }
    say(&format!("{} lacks these groups and keys:", file.display()));
    for key in &written.missing {
        say(&format!("  {key}"));
    }
    let help = if is_windio {
        to_complete(output, &written.missing, further)?
    } else {
        let place = output.display();
        format!(
            "each has a commented line or heading in {place}: write the figures there, with their source, until `wakemix turbine show {place}` describes the turbine"
        )
    };
    Err(miette!(
        help = help,
        "{} cannot be run yet: {} groups and keys are missing",
        output.display(),
        written.missing.len()
    ))
}

/// What to do about the figures that are `missing` in `output`; leaves a template for them beside it, unless
/// the user has filled one in.
fn to_complete(
    output: &Path,
    missing: &[String],
    further: &windio::WindioOptions,
) -> Result<String> {
    let deck =
        "the OpenFAST deck (.fst) of the same turbine, imported instead, usually has them all";
    if let Some(completion) = &further.completion {
        return Ok(format!("add them to {} and import again; {deck}", completion.display()));
    }
    let template = output.with_extension("missing.toml");
    if template.exists() {
        let place = template.display();
        return Ok(format!(
            "{place} is there: complete it and import again with --complete {place} --overwrite, or take it away to have it written anew; {deck}"
        ));
    }
    atomic::write(&template, "the template", windio::template(missing).as_bytes())?;
    let place = template.display();
    tell(&format!("wrote {place}"));
    Ok(format!("fill in {place} and import again with --complete {place} --overwrite; {deck}"))
}
