//! OpenFAST's text output: some lines about the run, names from `Time` on, units, rows.

use crate::FileError;
use crate::table::head::{Column, Head};
use crate::table::names::find_time;
use crate::table::text::{Separator, TextRows, words};
use std::path::Path;

const WHAT: &str = "OpenFAST's text output";
/// Lines before the names at most.
const LONGEST_HEAD: u64 = 100;

/// Opens the `.out` at `path`, with values between blanks or tabs.
///
/// # Errors
/// [`FileError`].
pub(crate) fn open(path: &Path) -> Result<(Head, TextRows), FileError> {
    let refusal = |problem: String, fix: &str| FileError::content(WHAT, path, problem, fix);
    let mut rows = TextRows::open(path)?;
    let mut description: Vec<String> = Vec::new();
    let names = loop {
        let line = if rows.line_number() < LONGEST_HEAD { rows.next_line(path)? } else { None };
        let Some(line) = line else {
            let problem = format!("none of its first {LONGEST_HEAD} lines begins with Time");
            let fix = "give a text output of OpenFAST (OutFileFmt 1 or 3), or name CSV .csv";
            return Err(refusal(problem, fix));
        };
        let words = tokens(line);
        if words.first().is_some_and(|word| word.eq_ignore_ascii_case("time")) {
            break words;
        }
        if !words.is_empty() {
            description.push(words.join(" "));
        }
    };
    rows.ends_with_words = true;
    let mut units = Vec::new();
    if let Some(line) = rows.next_line(path)? {
        if line.trim_ascii_start().starts_with(b"(") {
            units = tokens(line);
        } else {
            rows.keep_line();
        }
    }
    if units.len() != names.len() {
        // A unit without a separator of its own is unknown.
        units = vec![String::new(); names.len()];
    }
    let columns: Vec<Column> = names
        .into_iter()
        .zip(units)
        .map(|(name, unit)| Column { name, unit: unit.trim_matches(['(', ')']).to_owned() })
        .collect();
    let time = find_time(&columns).map_err(|(problem, fix)| refusal(problem, &fix))?;
    Ok((Head { description: description.join("; "), columns, time }, rows))
}

/// The words of a line of names or units.
fn tokens(line: &[u8]) -> Vec<String> {
    let separator = if line.contains(&b'\t') { Separator::Byte(b'\t') } else { Separator::Blanks };
    words(line, separator).into_iter().filter(|word| !word.is_empty()).collect()
}
