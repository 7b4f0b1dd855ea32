//! Points of a campaign in a table: CSV whose columns are keys.

use crate::FileError;
use crate::case::text::quoted;
use crate::table::csv::separator;
use crate::table::text::{TextRows, words};
use basis::records::SweptValue;
use std::path::Path;

/// What the file holds, in words.
const WHAT: &str = "the points of a campaign";
/// Most rows (–).
pub(super) const MOST_ROWS: usize = 1_000_000;

/// Keys, and a row of values for each point with the number of its line.
pub(super) struct Points {
    pub(super) keys: Vec<String>,
    pub(super) rows: Vec<(u64, Vec<SweptValue>)>,
}

/// Reads the table at `path`.
///
/// # Errors
/// [`FileError`] names line and column.
pub(super) fn read(path: &Path) -> Result<Points, FileError> {
    const FIX: &str = "write keys of the case in the first line, such as wind.speed,wind.seed, and a point in each line below";
    let refuse = |problem: String| FileError::content(WHAT, path, problem, FIX);
    let mut lines = TextRows::open(path)?;
    let (mut keys, mut comma) = (Vec::new(), None);
    let mut rows = Vec::new();
    while let Some(line) = lines.next_line(path)? {
        let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
        if line.is_empty() || line[0] == b'#' {
            continue;
        }
        let between = *comma.get_or_insert_with(|| separator(line));
        let cells = words(line, between);
        let number = lines.line_number();
        if keys.is_empty() {
            keys = cells;
            if let Some(twice) = keys.iter().enumerate().find(|(at, key)| keys[..*at].contains(key))
            {
                return Err(refuse(format!("line {number} has the column `{}` twice", twice.1)));
            }
            continue;
        }
        if cells.len() != keys.len() {
            let (found, expected) = (cells.len(), keys.len());
            return Err(refuse(format!("line {number}: {found} values under {expected} keys")));
        }
        if let Some((key, _)) = keys.iter().zip(&cells).find(|(_, cell)| cell.is_empty()) {
            return Err(refuse(format!("line {number}: nothing stands under `{key}`")));
        }
        rows.push((number, cells.iter().map(|cell| value_of(cell)).collect()));
        if rows.len() > MOST_ROWS {
            return Err(refuse(format!("it has more than {MOST_ROWS} points")));
        }
    }
    if rows.is_empty() {
        return Err(refuse("it has no point".to_owned()));
    }
    Ok(Points { keys, rows })
}

/// What a cell holds.
fn value_of(cell: &str) -> SweptValue {
    let number = || cell.parse().ok().filter(|number: &f64| number.is_finite());
    match (cell.parse(), number()) {
        (Ok(whole), _) => SweptValue::Whole(whole),
        (_, Some(number)) => SweptValue::Number(number),
        _ => SweptValue::Text(cell.to_owned()),
    }
}

/// `value` as TOML.
pub(super) fn text_of(value: &SweptValue) -> String {
    match value {
        SweptValue::Whole(number) => number.to_string(),
        SweptValue::Number(number) => format!("{number:?}"),
        SweptValue::Text(text) => quoted(text),
        SweptValue::Numbers(numbers) => format!("{numbers:?}"),
    }
}
