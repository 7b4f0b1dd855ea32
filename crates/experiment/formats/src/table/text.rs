//! Rows of numbers in text.

use super::head::{Column, WHAT};
use crate::{FileError, atomic};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::ops::Range;
use std::path::Path;

const BUFFER: usize = 1 << 18;
/// Longest line that is taken for one (bytes); beyond it the file is something else.
const LONGEST_LINE: usize = 1 << 24;

/// What stands between the values of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Separator {
    /// One character, such as a comma; blanks beside it do not matter.
    Byte(u8),
    /// Any number of blanks and tabs.
    Blanks,
}

/// The lines of a table, one at a time.
#[derive(Debug)]
pub(crate) struct TextRows {
    reader: BufReader<File>,
    line: Vec<u8>,
    line_number: u64,
    /// Whether the line in hand has yet to be given.
    kept: bool,
    /// Where the values of the line in hand stand.
    fields: Vec<Range<usize>>,
    /// What stands between values; to be set once known.
    pub(crate) separator: Separator,
    /// Whether a line that begins with a letter ends the table, as in OpenFAST's text.
    pub(crate) ends_with_words: bool,
}

impl TextRows {
    pub(crate) fn open(path: &Path) -> Result<Self, FileError> {
        let file = atomic::open(path).map_err(|e| FileError::system("read", WHAT, path, e))?;
        Ok(Self {
            reader: BufReader::with_capacity(BUFFER, file),
            line: Vec::new(),
            line_number: 0,
            kept: false,
            fields: Vec::new(),
            separator: Separator::Blanks,
            ends_with_words: false,
        })
    }

    /// Number of the line in hand, from one.
    pub(crate) fn line_number(&self) -> u64 {
        self.line_number
    }

    /// The next line, without its end; none at the end of the file.
    pub(crate) fn next_line(&mut self, path: &Path) -> Result<Option<&[u8]>, FileError> {
        if !std::mem::take(&mut self.kept) {
            self.line.clear();
            let mut limited = std::io::Read::take(&mut self.reader, LONGEST_LINE as u64);
            let n_bytes = limited
                .read_until(b'\n', &mut self.line)
                .map_err(|source| FileError::system("read", WHAT, path, source))?;
            if n_bytes == 0 {
                return Ok(None);
            }
            self.line_number += 1;
            if n_bytes == LONGEST_LINE {
                let problem =
                    format!("line {} is longer than {LONGEST_LINE} bytes", self.line_number);
                let fix = "give a table with one row a line";
                return Err(FileError::content(WHAT, path, problem, fix));
            }
            let length = self.line.trim_ascii_end().len();
            self.line.truncate(length);
        }
        Ok(Some(&self.line))
    }

    /// Gives the line in hand once more.
    pub(crate) fn keep_line(&mut self) {
        self.kept = true;
    }

    /// Reads the `wanted` ones of `columns` from the next row into `row`, one after the other. False at the
    /// end.
    pub(crate) fn read(
        &mut self,
        path: &Path,
        columns: &[Column],
        wanted: &[usize],
        row: &mut [f64],
    ) -> Result<bool, FileError> {
        loop {
            let ends_with_words = self.ends_with_words;
            let Some(line) = self.next_line(path)? else { return Ok(false) };
            let begins = line.trim_ascii_start().first();
            if ends_with_words && begins.is_some_and(u8::is_ascii_alphabetic) && !is_number(line) {
                return Ok(false);
            }
            if begins.is_some_and(|first| *first != b'#') {
                break;
            }
        }
        split(&self.line, self.separator, &mut self.fields);
        if self.fields.len() != columns.len() {
            return Err(self.refusal(path, self.wrong_count(columns.len())));
        }
        for (value, column) in row.iter_mut().zip(wanted) {
            let field = &self.line[self.fields[*column].clone()];
            *value = number(field).ok_or_else(|| {
                let text = String::from_utf8_lossy(&field[..field.len().min(40)]);
                self.refusal(path, format!("`{text}` in {} is not a number", columns[*column].name))
            })?;
        }
        Ok(true)
    }

    fn wrong_count(&self, n_columns: usize) -> String {
        let n_fields = self.fields.len();
        let cut = if n_fields < n_columns { ": the row is cut short" } else { "" };
        format!("{n_fields} values under {n_columns} names{cut}")
    }

    fn refusal(&self, path: &Path, problem: String) -> FileError {
        let problem = format!("line {}: {problem}", self.line_number);
        let fix = "let the program that writes it finish, copy the file again, or correct the line";
        FileError::content(WHAT, path, problem, fix)
    }
}

/// On return `fields` says where the values of `line` stand.
pub(crate) fn split(line: &[u8], separator: Separator, fields: &mut Vec<Range<usize>>) {
    fields.clear();
    let is_end = |byte: u8| match separator {
        Separator::Byte(separator) => byte == separator,
        Separator::Blanks => byte.is_ascii_whitespace(),
    };
    let mut start = 0;
    for end in (0..=line.len()).filter(|end| *end == line.len() || is_end(line[*end])) {
        if separator != Separator::Blanks || end > start {
            fields.push(start..end);
        }
        start = end + 1;
    }
}

/// The words of `line`, trimmed of blanks and quotes.
pub(crate) fn words(line: &[u8], separator: Separator) -> Vec<String> {
    let mut fields = Vec::new();
    split(line, separator, &mut fields);
    let word = |field: Range<usize>| {
        let text = String::from_utf8_lossy(&line[field]);
        text.trim().trim_matches(['"', '\'']).trim().to_owned()
    };
    fields.into_iter().map(word).collect()
}

fn is_number(line: &[u8]) -> bool {
    line.split(u8::is_ascii_whitespace).find(|word| !word.is_empty()).and_then(number).is_some()
}

/// The number that `field` is, Fortran's ways of writing one (`1.5D+03`, `1.5-103`) included.
pub(crate) fn number(field: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?.trim().trim_matches('"');
    text.parse().ok().or_else(|| fortran(text))
}

fn fortran(text: &str) -> Option<f64> {
    let exponent = text.find(['D', 'd']).or_else(|| text.rfind(['+', '-']))?;
    let (mantissa, exponent) = text.split_at(exponent);
    if !mantissa.ends_with(|last: char| last.is_ascii_digit() || last == '.') {
        return None;
    }
    format!("{mantissa}e{}", exponent.trim_start_matches(['D', 'd'])).parse().ok()
}
