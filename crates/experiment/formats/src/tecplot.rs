//! Tecplot's text: variables, zones, and their numbers line by line.

use crate::table::text::number;
use crate::{FileError, atomic};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

const BUFFER: usize = 1 << 18;
/// Longest line that is taken for one (bytes).
const LONGEST_LINE: u64 = 1 << 24;
/// What begins lines that hold nothing that is needed.
const ASIDE: [&str; 4] = ["DATASETAUXDATA", "VARAUXDATA", "AUXDATA", "TEXT"];
const FIX: &str = "write Tecplot's text: a line VARIABLES with names in quotes, a line ZONE with I, J and K, and DATAPACKING POINT or BLOCK";

/// A zone.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Zone {
    /// Points along its three directions (–); one each where it does not tell.
    pub(crate) n_points: [usize; 3],
    /// Whether the values of each variable stand together, rather than those of each point.
    pub(crate) is_block: bool,
    /// Its instant (s); none where it does not tell.
    pub(crate) time: Option<f64>,
}

/// What comes next in a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    /// A zone begins.
    Zone(Zone),
    /// A line of numbers, in [`TecplotReader::numbers`].
    Numbers,
    /// The end.
    End,
}

/// A file being read.
pub(crate) struct TecplotReader {
    path: PathBuf,
    what: &'static str,
    reader: BufReader<File>,
    line: Vec<u8>,
    line_number: u64,
    variables: Vec<String>,
    /// Whether the line in hand has yet to be looked at.
    is_kept: bool,
    last_zone: Option<Zone>,
    kept_zone: Option<Zone>,
    /// The numbers of the line in hand.
    pub(crate) numbers: Vec<f64>,
}

impl TecplotReader {
    /// Opens the file at `path`, which holds `what`, up to its names of variables.
    pub(crate) fn open(path: &Path, what: &'static str) -> Result<Self, FileError> {
        let file = atomic::open(path).map_err(|e| FileError::system("read", what, path, e))?;
        let mut opened = Self {
            path: path.to_owned(),
            what,
            reader: BufReader::with_capacity(BUFFER, file),
            line: Vec::new(),
            line_number: 0,
            variables: Vec::new(),
            is_kept: false,
            last_zone: None,
            kept_zone: None,
            numbers: Vec::new(),
        };
        opened.read_variables()?;
        Ok(opened)
    }

    /// Names of the variables.
    pub(crate) fn variables(&self) -> &[String] {
        &self.variables
    }

    /// That the file is not what it should be, at the line in hand.
    pub(crate) fn refusal(&self, problem: &str) -> FileError {
        let problem = format!("line {}: {problem}", self.line_number);
        FileError::content(self.what, &self.path, problem, FIX)
    }

    /// Passes to the next line that is neither empty nor a comment; false at the end.
    fn advance(&mut self) -> Result<bool, FileError> {
        if std::mem::take(&mut self.is_kept) {
            return Ok(true);
        }
        loop {
            self.line.clear();
            let mut limited = Read::take(&mut self.reader, LONGEST_LINE);
            let n_bytes = limited
                .read_until(b'\n', &mut self.line)
                .map_err(|e| FileError::system("read", self.what, &self.path, e))?;
            if n_bytes == 0 {
                return Ok(false);
            }
            self.line_number += 1;
            if n_bytes as u64 == LONGEST_LINE {
                return Err(self.refusal("it is longer than 16 MiB"));
            }
            let trimmed = self.line.trim_ascii();
            if !trimmed.is_empty() && trimmed[0] != b'#' {
                return Ok(true);
            }
        }
    }

    fn text(&self) -> String {
        String::from_utf8_lossy(&self.line).trim().to_owned()
    }

    fn begins_with(&self, word: &str) -> bool {
        let line = self.line.trim_ascii();
        line.len() >= word.len() && line[..word.len()].eq_ignore_ascii_case(word.as_bytes())
    }

    fn read_variables(&mut self) -> Result<(), FileError> {
        loop {
            if !self.advance()? {
                return Err(self.refusal("the file ends without VARIABLES"));
            }
            if self.begins_with("VARIABLES") {
                break;
            }
            if !self.begins_with("TITLE") && !self.begins_with("FILETYPE") {
                return Err(self.refusal("VARIABLES is expected here"));
            }
        }
        let mut text = self.text();
        text = text.split_once('=').map_or("", |(_, rest)| rest).to_owned();
        loop {
            self.variables.extend(names(&text));
            // Further names may stand in lines of their own.
            if !self.advance()? {
                break;
            }
            if !self.line.trim_ascii().starts_with(b"\"") {
                self.is_kept = true;
                break;
            }
            text = self.text();
        }
        if self.variables.is_empty() {
            return Err(self.refusal("VARIABLES names none"));
        }
        Ok(())
    }

    /// The zone that [`TecplotReader::next`] gave last is given once more; nothing but it was read since.
    pub(crate) fn keep(&mut self) {
        self.kept_zone = self.last_zone.take();
    }

    /// What comes next.
    pub(crate) fn next(&mut self) -> Result<Item, FileError> {
        if let Some(zone) = self.kept_zone.take() {
            return Ok(Item::Zone(zone));
        }
        loop {
            if !self.advance()? {
                return Ok(Item::End);
            }
            if self.begins_with("ZONE") {
                let zone = self.zone()?;
                self.last_zone = Some(zone.clone());
                return Ok(Item::Zone(zone));
            }
            if ASIDE.iter().any(|word| self.begins_with(word)) {
                continue;
            }
            self.numbers.clear();
            for word in self.line.split(|b| b.is_ascii_whitespace() || *b == b',') {
                if word.is_empty() {
                    continue;
                }
                let Some(value) = number(word) else {
                    let text = String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned();
                    return Err(self.refusal(&format!("`{text}` is not a number")));
                };
                self.numbers.push(value);
            }
            return Ok(Item::Numbers);
        }
    }

    /// The zone that begins in the line in hand; its words may go on in the lines below.
    fn zone(&mut self) -> Result<Zone, FileError> {
        let mut text = self.text()[4..].to_owned();
        while self.advance()? {
            let line = self.line.trim_ascii();
            let is_word = line[0].is_ascii_alphabetic() && line.contains(&b'=');
            if !is_word || self.begins_with("ZONE") {
                self.is_kept = true;
                break;
            }
            text.push(' ');
            text += &self.text();
        }
        let mut zone = Zone { n_points: [1; 3], ..Zone::default() };
        for (key, value) in pairs(&text) {
            let whole = || value.parse::<usize>().ok().filter(|n| *n > 0);
            match key.to_ascii_uppercase().as_str() {
                key @ ("I" | "J" | "K") => {
                    let axis = usize::from(key.as_bytes()[0] - b'I');
                    let n = whole().ok_or_else(|| {
                        self.refusal(&format!("{key} = {value} is no number of points"))
                    })?;
                    zone.n_points[axis] = n;
                }
                "F" | "DATAPACKING" => {
                    let word = value.to_ascii_uppercase();
                    zone.is_block = word == "BLOCK";
                    if !["BLOCK", "POINT"].contains(&word.as_str()) {
                        return Err(self.refusal(&format!("{key} = {value} is not read")));
                    }
                }
                "SOLUTIONTIME" => {
                    let time = number(value.as_bytes()).filter(|time| time.is_finite());
                    zone.time = Some(time.ok_or_else(|| {
                        self.refusal(&format!("SOLUTIONTIME = {value} is no finite number"))
                    })?);
                }
                _ => {}
            }
        }
        Ok(zone)
    }
}

/// The names in quotes, or between commas and blanks, of `text`.
fn names(text: &str) -> Vec<String> {
    if text.contains('"') {
        let parts = text.split('"').skip(1).step_by(2);
        return parts.map(|name| name.trim().to_owned()).collect();
    }
    let words = text.split(|c: char| c == ',' || c.is_whitespace());
    words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// Words with their values: `T="Snapshot 1", I=3 J = 4`.
fn pairs(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('=') {
        let key = before.trim_matches(|c: char| c == ',' || c.is_whitespace());
        let key = key.rsplit(|c: char| c == ',' || c.is_whitespace()).next().unwrap_or_default();
        let after = after.trim_start();
        let (value, left) = match after.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').unwrap_or((quoted, "")),
            None => {
                let end = after.find(|c: char| c == ',' || c.is_whitespace());
                after.split_at(end.unwrap_or(after.len()))
            }
        };
        found.push((key.to_owned(), value.to_owned()));
        rest = left;
    }
    found
}
