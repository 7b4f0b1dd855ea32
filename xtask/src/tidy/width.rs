//! Lines are short enough to read beside each other.

use super::Finding;
use std::path::Path;

/// Longest line of a source file (columns).
const MAXIMUM_WIDTH: usize = 110;

/// Adds every line of the source `text` of `file` that is too long.
///
/// What stands in a string literal does not count: sentences of the program, such as those of the tables of
/// keys, stay in one piece, where a search finds them.
pub(super) fn check(file: &Path, text: &str, findings: &mut Vec<Finding>) {
    if file.extension().is_none_or(|extension| extension != "rs") {
        return;
    }
    let mut place = Place::Code;
    for (index, line) in text.lines().enumerate() {
        let width = width(line, &mut place);
        if width > MAXIMUM_WIDTH {
            let message = format!("{width} columns besides text, {MAXIMUM_WIDTH} are the most");
            findings.push(Finding { file: file.to_owned(), line: Some(index + 1), message });
        }
    }
}

/// Where in a source file a character stands.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Code,
    /// In a string literal.
    Text,
    /// In a raw one, with so many `#`.
    Raw(usize),
}

/// Columns of `line` without what stands in string literals; on return `place` is that of the next line's
/// first.
fn width(line: &str, place: &mut Place) -> usize {
    let characters: Vec<char> = line.chars().collect();
    let (mut width, mut at) = (0, 0);
    while let Some(&character) = characters.get(at) {
        let rest = &characters[at..];
        match *place {
            Place::Code if rest.starts_with(&['/', '/']) => return width + rest.len(),
            Place::Code if rest.starts_with(&['\'', '"', '\'']) => {
                (width, at) = (width + 3, at + 3)
            }
            Place::Code => {
                if character == '"' {
                    *place = opened(&characters[..at]);
                }
                (width, at) = (width + 1, at + 1);
            }
            Place::Text if character == '\\' => at += 2,
            Place::Text | Place::Raw(_) => {
                if character == '"' && is_closed(*place, &rest[1..]) {
                    *place = Place::Code;
                    width += 1;
                }
                at += 1;
            }
        }
    }
    width
}

/// What a quote opens behind the characters `before`.
fn opened(before: &[char]) -> Place {
    let n_marks = before.iter().rev().take_while(|character| **character == '#').count();
    match before.len().checked_sub(n_marks + 1).map(|last| before[last]) {
        Some('r') => Place::Raw(n_marks),
        _ => Place::Text,
    }
}

/// Whether a quote in `place` with the characters `after` behind it ends the literal.
fn is_closed(place: Place, after: &[char]) -> bool {
    match place {
        Place::Raw(n_marks) => after.iter().take_while(|mark| **mark == '#').count() >= n_marks,
        Place::Code | Place::Text => true,
    }
}
