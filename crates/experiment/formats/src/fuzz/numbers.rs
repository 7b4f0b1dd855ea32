//! Every number of a TOML file, so that another can be put in its place.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What no number can be, as TOML writes it.
pub(crate) const NEVER: [&str; 4] = ["nan", "inf", "-inf", "1e308"];

/// A number in a TOML file: where it stands, and what leads to it.
pub(crate) struct Found {
    pub(crate) bytes: std::ops::Range<usize>,
    /// Keys, without rows.
    pub(crate) key: String,
    /// Place in its list, from 0.
    pub(crate) column: usize,
}

/// All numbers in `value` at `key`, which stands in `column` of its row.
fn find(value: &Spanned<DeValue>, key: &str, column: usize, found: &mut Vec<Found>) {
    match value.get_ref() {
        DeValue::Table(table) => find_in(table, key, found),
        DeValue::Array(items) => {
            for (column, item) in items.iter().enumerate() {
                find(item, key, column, found);
            }
        }
        DeValue::Integer(_) | DeValue::Float(_) => {
            found.push(Found { bytes: value.span(), key: key.to_owned(), column });
        }
        _ => {}
    }
}

fn find_in(table: &DeTable, above: &str, found: &mut Vec<Found>) {
    for (name, value) in table {
        let dot = if above.is_empty() { "" } else { "." };
        find(value, &format!("{above}{dot}{}", name.get_ref()), 0, found);
    }
}

/// All numbers of the TOML in `text`.
pub(crate) fn numbers_of(text: &str) -> Vec<Found> {
    let mut found = Vec::new();
    find_in(DeTable::parse(text).unwrap().get_ref(), "", &mut found);
    found
}
