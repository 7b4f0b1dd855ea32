//! One file of a deck: lines of values followed by their key.

use crate::atomic;
use crate::turbine_file::TurbineFileError;
use std::path::{Path, PathBuf};

/// A text file of figures before their keys: `value  Key - description` or `value ! Key - description`.
pub(crate) struct Deck {
    path: PathBuf,
    name: String,
    lines: Vec<Line>,
}

struct Line {
    /// From 1.
    number: usize,
    text: String,
    values: Vec<String>,
    /// Key without brackets, underscores and capitals; empty where the line has none.
    key: String,
}

/// A value with its place.
pub(crate) struct Value<'a> {
    deck: &'a Deck,
    line: usize,
    key: &'a str,
    pub(crate) text: &'a str,
}

/// A table with named columns.
pub(crate) struct Table<'a> {
    deck: &'a Deck,
    key: &'a str,
    columns: Vec<String>,
    first_line: usize,
    rows: Vec<(usize, Vec<&'a str>)>,
}

impl Deck {
    /// The file at `path`.
    pub(crate) fn read(path: &Path) -> Result<Self, TurbineFileError> {
        // Decks carry degree signs in whatever encoding their author's editor had.
        let bytes = atomic::read_whole(path)
            .map_err(|source| TurbineFileError::unreadable(path, source))?;
        Ok(Self::parse(path, &String::from_utf8_lossy(&bytes)))
    }

    /// The file at `path`, which holds `text`.
    pub(crate) fn parse(path: &Path, text: &str) -> Self {
        let lines =
            text.lines().enumerate().map(|(index, text)| line_of(index + 1, text)).collect();
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
        Self { path: path.to_owned(), name, lines }
    }

    /// Name of the file, without folders.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// First line, which may state the version of the format.
    pub(super) fn heading(&self) -> &str {
        self.lines.first().map_or("", |line| line.text.trim())
    }

    /// Second line, which decks use for a title.
    pub(crate) fn title(&self) -> &str {
        self.lines.get(1).map_or("", |line| line.text.trim())
    }

    pub(super) fn error(
        &self,
        line: usize,
        key: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
        fix: impl Into<String>,
    ) -> TurbineFileError {
        TurbineFileError::Value {
            file: self.path.display().to_string().into(),
            line,
            key: key.into(),
            expected: expected.into().into(),
            found: found.into().into(),
            fix: fix.into().into(),
        }
    }

    fn position(&self, key: &str) -> Option<usize> {
        let wanted = normalised(key);
        self.lines.iter().position(|line| line.key == wanted)
    }

    fn required(&self, key: &str) -> Result<usize, TurbineFileError> {
        self.position(key).ok_or_else(|| {
            let fix = format!("add a line with the value followed by {key}");
            self.error(
                self.lines.len().max(1),
                key,
                format!("the key {key}"),
                "the end of the file",
                fix,
            )
        })
    }

    /// Whether the deck has `key`.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.position(key).is_some()
    }

    /// The first value before `key`.
    pub(crate) fn value<'a>(&'a self, key: &'a str) -> Result<Value<'a>, TurbineFileError> {
        let line = &self.lines[self.required(key)?];
        Ok(Value { deck: self, line: line.number, key, text: &line.values[0] })
    }

    /// The number before `key`.
    pub(crate) fn number(&self, key: &str) -> Result<f64, TurbineFileError> {
        self.value(key)?.number()
    }

    /// All numbers before `key`.
    pub(crate) fn numbers(&self, key: &str) -> Result<Vec<f64>, TurbineFileError> {
        let line = &self.lines[self.required(key)?];
        let number = |text: &String| Value { deck: self, line: line.number, key, text }.number();
        line.values.iter().map(number).collect()
    }

    /// The file that the text before `key` names, relative to this one.
    pub(crate) fn deck(&self, key: &str) -> Result<Self, TurbineFileError> {
        self.value(key)?.deck()
    }

    /// As [`Deck::deck`]; nothing when the key is missing or its value says that it is unused.
    pub(crate) fn optional_deck(&self, key: &str) -> Result<Option<Self>, TurbineFileError> {
        if !self.has(key) {
            return Ok(None);
        }
        let value = self.value(key)?;
        let unused = ["unused", "none", "na", "n/a", ""];
        if unused.contains(&value.text.trim().to_lowercase().as_str()) {
            return Ok(None);
        }
        value.deck().map(Some)
    }

    /// The value before `key` and those of the lines that follow, `count` in all.
    pub(crate) fn list<'a>(
        &'a self,
        key: &'a str,
        count: usize,
    ) -> Result<Vec<Value<'a>>, TurbineFileError> {
        let start = self.required(key)?;
        let lines = self.lines.get(start..start + count).ok_or_else(|| {
            let (expected, found) = (format!("{count} lines"), self.lines.len() - start);
            let fix = "add the missing lines, or correct their number";
            self.error(start + 1, key, expected, format!("{found} lines"), fix)
        })?;
        let value = |line: &'a Line| {
            let text = line.values.first().ok_or_else(|| {
                self.error(
                    line.number,
                    key,
                    "a value",
                    "an empty line",
                    "close the gap in the list",
                )
            })?;
            Ok(Value { deck: self, line: line.number, key, text })
        };
        lines.iter().map(value).collect()
    }

    /// The table with the number of rows before `count_key`, below a line that begins with one of `columns`.
    ///
    /// A table without such a line has the columns in the order of `columns`.
    pub(crate) fn table<'a>(
        &'a self,
        count_key: &'a str,
        columns: &[&str],
    ) -> Result<Table<'a>, TurbineFileError> {
        let start = self.required(count_key)?;
        let count = self.value(count_key)?.count()?;
        let is_number = |text: &str| number_of(text).is_some();
        let words = |line: &'a Line| -> Vec<&'a str> {
            let blank = |c: char| c.is_whitespace() || c == ',';
            line.text.split(blank).filter(|word| !word.is_empty()).collect()
        };
        let below = &self.lines[start + 1..];
        let head = below.iter().enumerate().find_map(|(index, line)| {
            let words: Vec<&str> = words(line).into_iter().filter(|word| *word != "!").collect();
            let first = words.first()?.trim_start_matches('!');
            column_index(columns, first).map(|_| (index, words))
        });
        let (skipped, head) = head.unwrap_or_else(|| (0, columns.to_vec()));
        let starts_number = |words: &Vec<&str>| words.first().is_some_and(|word| is_number(word));
        // Blank lines and remarks may stand between rows.
        let is_remark = |words: &Vec<&str>| words.first().is_none_or(|word| word.starts_with('!'));
        let rows: Vec<(usize, Vec<&str>)> = below[skipped..]
            .iter()
            .map(|line| (line.number, words(line)))
            .skip_while(|(_, words)| !starts_number(words))
            .take_while(|(_, words)| starts_number(words) || is_remark(words))
            .filter(|(_, words)| starts_number(words))
            .take(count)
            .collect();
        let first_line = self.lines[start].number;
        if rows.len() < count {
            let found = format!("{} rows of numbers", rows.len());
            let fix = format!("add the missing rows, or correct {count_key}");
            return Err(self.error(
                first_line,
                count_key,
                format!("{count} rows below"),
                found,
                fix,
            ));
        }
        let columns = head.iter().map(|word| normalised(word)).collect();
        Ok(Table { deck: self, key: count_key, columns, first_line, rows })
    }
}

impl Value<'_> {
    /// As a number.
    pub(crate) fn number(&self) -> Result<f64, TurbineFileError> {
        number_of(self.text).ok_or_else(|| self.error("a number"))
    }

    /// As a count, at least one.
    pub(crate) fn count(&self) -> Result<usize, TurbineFileError> {
        match number_of(self.text) {
            Some(count) if count >= 1.0 && count.fract() == 0.0 && count < 1e6 => {
                Ok(count as usize)
            }
            _ => Err(self.error("a whole number above zero")),
        }
    }

    /// As the name of a file relative to the deck's.
    pub(crate) fn path(&self) -> PathBuf {
        let name = self.text.trim().replace('\\', "/");
        self.deck.path.parent().unwrap_or(Path::new("")).join(name)
    }

    /// As the name of a deck relative to this one.
    pub(crate) fn deck(&self) -> Result<Deck, TurbineFileError> {
        Deck::read(&self.path()).map_err(|error| self.unread(error))
    }

    /// The error that the file named here cannot be read, where `error` is that; otherwise `error`.
    pub(crate) fn unread(&self, error: TurbineFileError) -> TurbineFileError {
        match error {
            TurbineFileError::Unreadable { path, source, .. } => {
                let fix = format!(
                    "put the file at {} (the system says: {source}), or correct the name here",
                    path.display()
                );
                self.deck.error(
                    self.line,
                    self.key,
                    "the name of a file",
                    format!("\"{}\"", self.text),
                    fix,
                )
            }
            other => other,
        }
    }

    /// The error that something else was expected here.
    pub(crate) fn error(&self, expected: &str) -> TurbineFileError {
        let fix = format!("put {expected} before {}", self.key);
        self.deck.error(self.line, self.key, expected, format!("\"{}\"", self.text), fix)
    }
}

impl Table<'_> {
    /// The numbers of the column `name`.
    pub(crate) fn column(&self, name: &str) -> Result<Vec<f64>, TurbineFileError> {
        let wanted = normalised(name);
        let Some(column) = self.columns.iter().position(|column| *column == wanted) else {
            let found = format!("the columns {}", self.columns.join(", "));
            let fix = format!("add the column {name} to the table below {}", self.key);
            return Err(self.deck.error(
                self.first_line,
                self.key,
                format!("a column {name}"),
                found,
                fix,
            ));
        };
        self.column_at(column, name)
    }

    /// The numbers of the column number `index` (from 0), called `name` in errors.
    pub(crate) fn column_at(&self, index: usize, name: &str) -> Result<Vec<f64>, TurbineFileError> {
        let cell = |(line, row): &(usize, Vec<&str>)| {
            let text = row.get(index).copied().unwrap_or("");
            number_of(text).ok_or_else(|| {
                let found = format!("\"{text}\"");
                let fix = format!("correct column {} of this row", index + 1);
                self.deck.error(*line, name, "a number", found, fix)
            })
        };
        self.rows.iter().map(cell).collect()
    }

    /// Line number of row `index` (from 0).
    pub(crate) fn line(&self, index: usize) -> usize {
        self.rows[index].0
    }

    /// The error that row `index` should hold something else in the column `name`.
    pub(crate) fn error(
        &self,
        index: usize,
        name: &str,
        expected: &str,
        found: &str,
    ) -> TurbineFileError {
        let fix = format!("correct {name} in this row");
        self.deck.error(self.line(index), name, expected, found, fix)
    }
}

/// Position of the column called `word`.
fn column_index(columns: &[&str], word: &str) -> Option<usize> {
    let word = normalised(word.trim_start_matches('!'));
    columns.iter().position(|column| normalised(column) == word)
}

/// A finite number as Fortran prints it.
fn number_of(text: &str) -> Option<f64> {
    if !text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
        return None;
    }
    let number: Option<f64> =
        text.parse().ok().or_else(|| text.replace(['d', 'D'], "e").parse().ok());
    number.filter(|number| number.is_finite())
}

/// A key as it is compared: versions differ in brackets, underscores and capitals.
fn normalised(key: &str) -> String {
    key.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Values and key of a line: the first word and all numbers and quoted texts after it, then the key.
fn line_of(number: usize, text: &str) -> Line {
    let mut words = words_of(text).into_iter().peekable();
    let mut values = Vec::new();
    let mut key = String::new();
    let starts_comment = text.trim_start().starts_with(['!', '#']);
    if !starts_comment {
        values.extend(words.next().map(|word| word.text));
        for word in words {
            // What is no finite number stands in the place of one, too; it is refused once it is asked for.
            if word.quoted || number_of(&word.text).is_some() || word.text.parse::<f64>().is_ok() {
                values.push(word.text);
            } else if !word.text.chars().all(|c| "!-#".contains(c)) {
                key = normalised(&word.text);
                break;
            }
        }
    }
    // Headings and rules have no value that could be asked for.
    if values.is_empty() {
        key.clear();
    }
    Line { number, text: text.to_owned(), values, key }
}

struct Word {
    text: String,
    quoted: bool,
}

fn words_of(text: &str) -> Vec<Word> {
    let mut words = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        if first == '"' || first == '\'' {
            let body = &rest[1..];
            let end = body.find(first).unwrap_or(body.len());
            words.push(Word { text: body[..end].to_owned(), quoted: true });
            rest = body.get(end + 1..).unwrap_or("");
        } else {
            let end = rest.find(|c: char| c.is_whitespace() || c == ',').unwrap_or(rest.len());
            words.push(Word { text: rest[..end].to_owned(), quoted: false });
            rest = &rest[end..];
        }
        rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
    }
    words
}
