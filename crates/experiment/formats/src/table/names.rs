//! Which column a name means.

use super::head::Column;
use crate::case::nearest;
use turbine::structure::canonical;

/// Names that a refusal lists at most.
const LISTED: usize = 8;

/// Index of the column that `name` means: as it is, ignoring case, as the beginning of one name up to `_` or
/// a space, or all that again with OpenFAST's other name of the same channel.
///
/// # Errors
/// The problem and its fix, in words.
pub(crate) fn find(name: &str, columns: &[Column]) -> Result<usize, (String, String)> {
    if let Some(found) = find_name(name, columns) {
        return found;
    }
    if let Some(found) = other_name(name).and_then(|other| find_name(&other, columns)) {
        return found;
    }
    let suggestion = suggestion(name, &name.to_lowercase(), columns);
    Err((format!("it has no channel \"{name}\""), suggestion))
}

/// Name under which turbines write the channel that OpenFAST also calls `name`; what stands before a dot is
/// the turbine's.
fn other_name(name: &str) -> Option<String> {
    match name.rsplit_once('.') {
        Some((turbine, channel)) => Some(format!("{turbine}.{}", canonical(channel)?)),
        None => canonical(name),
    }
}

/// As [`find`] but for other names; None where no column is called so.
fn find_name(name: &str, columns: &[Column]) -> Option<Result<usize, (String, String)>> {
    let lower = name.to_lowercase();
    let is_beginning = |column: &Column| {
        let rest = column.name.to_lowercase();
        rest.strip_prefix(&lower).is_some_and(|rest| rest.starts_with(['_', ' ']))
    };
    let rules: [&dyn Fn(&Column) -> bool; 3] = [
        &|column| column.name == name,
        &|column| column.name.to_lowercase() == lower,
        &is_beginning,
    ];
    for rule in rules {
        let found: Vec<usize> = (0..columns.len()).filter(|index| rule(&columns[*index])).collect();
        match found[..] {
            [] => {}
            [one] => return Some(Ok(one)),
            [first, ..] => return Some(Err(ambiguous(name, &found, first, columns))),
        }
    }
    None
}

/// Problem and fix where `name` means all the columns `found`, `first` among them.
fn ambiguous(name: &str, found: &[usize], first: usize, columns: &[Column]) -> (String, String) {
    let n_found = found.len();
    if found.iter().all(|index| columns[*index].name == columns[first].name) {
        let problem = format!("{n_found} channels are called \"{name}\"");
        return (problem, "leave only one of them in the file".to_owned());
    }
    let names = list(found.iter().map(|index| &columns[*index].name));
    let problem = format!("the channel \"{name}\" is one of {n_found}: {names}");
    (problem, "give the whole name of one of them".to_owned())
}

fn suggestion(name: &str, lower: &str, columns: &[Column]) -> String {
    let names = || columns.iter().map(|column| column.name.as_str());
    let alike: Vec<&str> =
        names().filter(|other| !lower.is_empty() && other.to_lowercase().contains(lower)).collect();
    // A unit at the end may be what keeps a name from being near.
    let stem = |other: &str| other.rfind(['_', ' ']).unwrap_or(other.len());
    let meant = nearest(name, names()).or_else(|| {
        let stem_meant = nearest(name, names().map(|other| &other[..stem(other)]))?;
        names().find(|other| &other[..stem(other)] == stem_meant)
    });
    if let Some(meant) = meant {
        return format!("did you mean \"{meant}\"?");
    }
    let all: Vec<&str> = if alike.is_empty() { names().collect() } else { alike };
    format!("give one of its {} channels: {}", all.len(), list(all.iter()))
}

fn list<T: AsRef<str>>(names: impl ExactSizeIterator<Item = T>) -> String {
    let n_names = names.len();
    let mut text: Vec<String> = names.take(LISTED).map(|name| name.as_ref().to_owned()).collect();
    if n_names > LISTED {
        text.push("…".to_owned());
    }
    text.join(", ")
}

/// Which of `columns` is time, in seconds.
///
/// # Errors
/// The problem and its fix, in words: no such column, or one in another unit.
pub(crate) fn find_time(columns: &[Column]) -> Result<usize, (String, String)> {
    let found = columns.iter().enumerate().find_map(|(index, column)| {
        let lower = column.name.to_lowercase();
        let rest = if lower == "t" { Some("") } else { lower.strip_prefix("time") };
        let rest = rest.filter(|rest| !rest.starts_with(char::is_alphanumeric))?;
        let rest = rest.trim_start_matches(['_', ' ', '-', '.']).to_owned();
        Some((index, if column.unit.is_empty() { rest } else { column.unit.to_lowercase() }))
    });
    match found {
        Some((index, unit)) if ["", "s", "sec", "second", "seconds"].contains(&unit.as_str()) => {
            Ok(index)
        }
        Some((index, unit)) => Err((
            format!("its time \"{}\" is in \"{unit}\"", columns[index].name),
            "give time in seconds, in a column called time_s".to_owned(),
        )),
        None => Err((
            format!("none of its {} columns is time", columns.len()),
            "call the column of time (in seconds) time_s, time or t".to_owned(),
        )),
    }
}
