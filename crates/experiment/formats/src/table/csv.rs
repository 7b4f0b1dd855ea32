//! CSV: names in the first line, one row a line.

use super::head::{Column, Head, WHAT};
use super::names::find_time;
use super::text::{Separator, TextRows, number, words};
use crate::FileError;
use std::path::Path;

/// Opens the CSV at `path`: values between commas, semicolons, tabs or blanks, whichever the first line has;
/// units in the names (`RootMyc1 [kN-m]`, `RootMyc1_(kN-m)`) or in a line of their own below; lines that
/// begin with `#` are passed over.
///
/// # Errors
/// [`FileError`].
pub(super) fn open(path: &Path) -> Result<(Head, TextRows), FileError> {
    let (columns, rows) = columns(path)?;
    let refusal = |problem: String, fix: &str| FileError::content(WHAT, path, problem, fix);
    let time = find_time(&columns).map_err(|(problem, fix)| refusal(problem, &fix))?;
    Ok((Head { description: String::new(), columns, time }, rows))
}

/// Names and units of the CSV at `path`, and its rows.
///
/// # Errors
/// [`FileError`].
pub(crate) fn columns(path: &Path) -> Result<(Vec<Column>, TextRows), FileError> {
    let refusal = |problem: String, fix: &str| FileError::content(WHAT, path, problem, fix);
    let mut rows = TextRows::open(path)?;
    let (names, separator) = loop {
        let Some(line) = rows.next_line(path)? else {
            return Err(refusal(
                "it has no line of names".into(),
                "write the names in the first line",
            ));
        };
        let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
        if line.contains(&0) {
            return Err(refusal(
                "its first line is no text".into(),
                "name OpenFAST's binary output NAME.outb; give CSV as UTF-8 text",
            ));
        }
        if !line.is_empty() && line[0] != b'#' {
            let separator = separator(line);
            break (words(line, separator), separator);
        }
    };
    let place = rows.line_number();
    if names.iter().all(|name| number(name.as_bytes()).is_some()) {
        let problem = format!("line {place} has numbers where names are needed");
        return Err(refusal(problem, "write the names in the first line, such as time_s,RootMyc1"));
    }
    let mut columns: Vec<Column> = names.iter().map(|name| column(name)).collect();
    rows.separator = separator;
    if let Some(line) = rows.next_line(path)? {
        let below = words(line, separator);
        let are_units = below.len() == columns.len() && below.iter().all(|word| is_unit(word));
        if are_units {
            for (column, unit) in columns.iter_mut().zip(below) {
                column.unit = bare(&unit);
            }
        } else {
            rows.keep_line();
        }
    }
    Ok((columns, rows))
}

/// What stands between the values of `line`.
pub(crate) fn separator(line: &[u8]) -> Separator {
    let found = [b',', b';', b'\t'].into_iter().find(|separator| line.contains(separator));
    found.map_or(Separator::Blanks, Separator::Byte)
}

/// Name and unit out of `RootMyc1 [kN-m]` and the like.
fn column(text: &str) -> Column {
    let unit = text.strip_suffix(')').and_then(|rest| rest.rsplit_once('('));
    let unit = unit.or_else(|| text.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')));
    match unit {
        Some((name, unit)) if !name.is_empty() => {
            let name = name.trim_end_matches([' ', '_']).to_owned();
            Column { name, unit: unit.trim().to_owned() }
        }
        _ => Column { name: text.to_owned(), unit: String::new() },
    }
}

fn is_unit(word: &str) -> bool {
    let ends = [('(', ')'), ('[', ']')];
    ends.into_iter().any(|(open, close)| word.starts_with(open) && word.ends_with(close))
}

/// A unit without its parentheses or brackets.
pub(crate) fn bare(unit: &str) -> String {
    unit.trim_matches(['(', ')', '[', ']']).trim().to_owned()
}
