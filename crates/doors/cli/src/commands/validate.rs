//! `wakemix validate`: recorded validations, repeated and set beside their records.

mod print;
mod record;

use super::BAD_INPUT;
use super::manner;
use super::output::{columns, detail, print, print_text, refuse, say, tell};
use clap::Args;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use validation::gate::{Judgement, holds, judge};
use validation::record::{Record, Worse};
use validation::{Cost, Pictures, VALIDATIONS, Validation, pages};

/// Arguments of `wakemix validate`.
#[derive(Args)]
pub(crate) struct ValidateArguments {
    /// Names of validations; a list of them when left out
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// All that take less than a minute
    #[arg(long, conflicts_with = "names")]
    quick: bool,
    /// Print all rows as JSON
    #[arg(long, conflicts_with = "record")]
    json: bool,
    /// Write what comes out as the new record (validation/recorded) and renew the pages; no claim is loosened
    #[arg(long)]
    record: bool,
    /// With --record: record what was met and falls short now, or falls shorter; otherwise that is refused
    #[arg(long, requires = "record")]
    accept_worse: bool,
    /// Renew verdicts and tables of docs/validation from the records, and repeat nothing
    #[arg(long, conflicts_with_all = ["names", "quick", "json", "record", "pictures"])]
    pages: bool,
    /// Put new pictures in the place of old ones
    #[arg(long, requires = "pictures")]
    overwrite: bool,
    /// Folder to draw the validations into, where they have pictures: figures/*.svg and *.png
    #[arg(long, value_name = "FOLDER", requires = "names")]
    pictures: Option<PathBuf>,
}

/// A validation that was repeated, beside its record.
struct Done {
    validation: &'static Validation,
    record: Record,
    judgements: Vec<Judgement>,
}

/// Prints each row beside its record, and draws it on request; exit code 1 when a row is not as recorded, 2
/// for an unknown name, for pictures of what has none, and for what cannot be read or written.
pub(crate) fn run(arguments: &ValidateArguments) -> ExitCode {
    if !manner::says_remarks() {
        validation::be_quiet();
    }
    if arguments.pages {
        return renew_pages();
    }
    let wanted = match wanted(arguments) {
        Ok(wanted) => wanted,
        Err(problem) => return refused(&problem),
    };
    if wanted.is_empty() {
        return if arguments.json || arguments.record {
            refused("no validation is named\nhint: name validations, or use --quick")
        } else {
            printed(&print::list(columns()))
        };
    }
    if let Some(folder) = arguments.pictures.as_ref().filter(|_| !arguments.overwrite)
        && folder.join("figures").exists()
    {
        let folder = folder.display();
        return refused(&format!(
            "{folder} has figures already\nhint: name another folder, or give --overwrite"
        ));
    }
    let mut done: Vec<Done> = Vec::new();
    for validation in wanted {
        match repeat(validation, arguments) {
            Ok(repeated) => done.push(repeated),
            Err(problem) => return refused(&problem),
        }
    }
    if arguments.record {
        return renew_pages();
    }
    if arguments.json {
        let code = printed(&print::json(&done));
        if code != ExitCode::SUCCESS {
            return code;
        }
    }
    let code = code_of(&done);
    if code != 0 {
        say(
            "not all is as recorded\nhint: fix what got worse; where a change is meant, renew the record with --record",
        );
    }
    ExitCode::from(code)
}

/// Exit code of what was repeated: 0 when all is as recorded, or 1.
fn code_of(done: &[Done]) -> u8 {
    u8::from(!done.iter().all(|done| holds(&done.judgements)))
}

/// Prints `text`; the exit code says whether that went well.
fn printed(text: &str) -> ExitCode {
    print(text).map_or_else(|report| refuse(&report), |()| ExitCode::SUCCESS)
}

/// Says what is wrong with the call.
fn refused(problem: &str) -> ExitCode {
    say(&format!("error: {problem}"));
    ExitCode::from(BAD_INPUT)
}

/// The validations that are named, or the quick ones; none where neither is given.
fn wanted(arguments: &ValidateArguments) -> Result<Vec<&'static Validation>, String> {
    if arguments.quick {
        return Ok(VALIDATIONS.iter().filter(|v| v.cost == Cost::UnderAMinute).collect());
    }
    let mut wanted = Vec::new();
    for name in &arguments.names {
        let found = VALIDATIONS.iter().find(|validation| validation.name == name);
        let Some(validation) = found else {
            let names = listed(|_| true);
            return Err(format!("no validation is called `{name}`\nhint: one of {names}"));
        };
        if arguments.pictures.is_some() && validation.pictures.is_none() {
            let drawn = listed(|validation| validation.pictures.is_some());
            return Err(format!(
                "`{name}` has no pictures\nhint: leave out --pictures; those with pictures: {drawn}"
            ));
        }
        wanted.push(validation);
    }
    Ok(wanted)
}

/// Names of the validations that `counts`.
fn listed(counts: impl Fn(&Validation) -> bool) -> String {
    let names: Vec<&str> =
        VALIDATIONS.iter().filter(|validation| counts(validation)).map(|v| v.name).collect();
    names.join(", ")
}

/// Repeats `validation`, and prints or records what came out.
fn repeat(validation: &'static Validation, arguments: &ValidateArguments) -> Result<Done, String> {
    let record = validation.record().map_err(|error| error.to_string())?;
    let began = Instant::now();
    let rows = (validation.run)();
    let seconds = began.elapsed().as_secs_f64();
    detail(&format!("time: {seconds:.2} s validation {}", validation.name));
    let judgements = judge(&rows, &record);
    let done = Done { validation, record, judgements };
    if !arguments.json {
        print_text(&print::table(&done, columns())).map_err(|error| error.to_string())?;
    }
    if arguments.record {
        let worse = if arguments.accept_worse { Worse::Accepted } else { Worse::Refused };
        record::renew(validation.name, &rows, worse)?;
    }
    if let (Some(folder), Some(pictures)) = (&arguments.pictures, validation.pictures) {
        draw(folder, pictures).map_err(|error| {
            let cause = error.source().map_or(String::new(), |cause| format!(": {cause}"));
            format!("{error}{cause}\nhint: name another folder with --pictures")
        })?;
    }
    Ok(done)
}

/// Draws a validation into `folder` and says where.
fn draw(folder: &Path, pictures: Pictures) -> Result<(), validation::ReportError> {
    for name in pictures(folder)? {
        let picture = folder.join("figures").join(format!("{name}.svg"));
        tell(&picture.display().to_string());
    }
    Ok(())
}

/// Writes the records into the pages, and says into which.
fn renew_pages() -> ExitCode {
    match pages::write(Path::new("")) {
        Ok(changed) => {
            let names = changed.iter().map(|name| format!("{}/{name}.md\n", pages::FOLDER));
            printed(&names.collect::<String>())
        }
        Err(problem) => refused(&problem),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use validation::gate::Finding;
    use validation::{Row, Tolerance};

    /// Met, short, worse than recorded, and a shortfall that is gone.
    fn wing() -> Vec<Row> {
        let row = |what: &str, measured: f64| Row {
            what: what.to_owned(),
            measured,
            expected: 1.0,
            tolerance: Tolerance::Within(0.1),
            unit: "MN",
            source: "made up",
        };
        vec![row("met", 1.05), row("short", 1.5), row("worse", 1.8), row("gone", 1.0)]
    }

    const RECORDED: &str = r#"
date = "2026-11-22"
conditions = "made up"
row = [
    { id = "met", claim = "met", measured = 1.0, expected = 1.0, tolerance = { within = 0.1 }, unit = "MN", source = "", verdict = "met" },
    { id = "short", claim = "short", measured = 1.5, expected = 1.0, tolerance = { within = 0.1 }, unit = "MN", source = "", verdict = "short" },
    { id = "worse", claim = "worse", measured = 1.5, expected = 1.0, tolerance = { within = 0.1 }, unit = "MN", source = "", verdict = "short" },
    { id = "gone", claim = "gone", measured = 1.5, expected = 1.0, tolerance = { within = 0.1 }, unit = "MN", source = "", verdict = "short" },
]
"#;

    const WING: Validation = Validation {
        name: "wing",
        about: "a made-up wing",
        cost: Cost::UnderAMinute,
        run: wing,
        pictures: None,
        page: "wing",
        recorded: RECORDED,
    };

    #[test]
    fn a_made_up_validation_has_the_right_verdicts_and_exit_code() {
        let judgements = judge(&(WING.run)(), &WING.record().unwrap());
        let findings: Vec<Finding> = judgements.iter().map(|row| row.finding).collect();
        use Finding::{AsRecorded, ShortfallGone, Worse};
        assert_eq!(findings, [AsRecorded, AsRecorded, Worse, ShortfallGone]);
        let code = |kept: &[usize]| {
            let judgements = kept.iter().map(|&place| judgements[place].clone()).collect();
            code_of(&[Done { validation: &WING, record: WING.record().unwrap(), judgements }])
        };
        assert_eq!(code(&[0, 1]), 0);
        assert_eq!([code(&[0, 1, 2]), code(&[0, 1, 3])], [1, 1]);
    }
}
