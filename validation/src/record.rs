//! What a validation gave when it was last recorded: `validation/recorded/NAME.toml`, in the program and in
//! the repository.

use crate::row::{Row, Tolerance};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{error, fmt, fs, io};

/// Folder of the records, seen from the repository's root.
pub const FOLDER: &str = "validation/recorded";

/// How a record is weakened where that is meant.
const BY_HAND: &str = "if that is meant, take its row out of the record's file first, where a reader of the change sees it";

/// Share of a tolerance by which a recorded claim and one of today may differ: what rounding to six digits
/// leaves.
const SAME: f64 = 0.01;

/// The rows of one validation as they were recorded.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Day on which it was made (year-month-day).
    pub date: String,
    /// On what machine, and by what.
    pub conditions: String,
    /// Its rows, in their order.
    #[serde(rename = "row")]
    pub rows: Vec<RecordedRow>,
}

/// A row as it was recorded.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedRow {
    /// Name within its validation, [`Row::id`].
    pub id: String,
    /// What was measured, with its conditions.
    pub claim: String,
    /// Measured value, in `unit`; none where a claim was met and the figure was not kept.
    pub measured: Option<f64>,
    /// Expected value or limit, in `unit`.
    pub expected: f64,
    /// What is accepted around `expected`.
    pub tolerance: Tolerance,
    /// Unit of all three.
    pub unit: String,
    /// Where the expected value comes from.
    pub source: String,
    /// Whether the claim was met.
    pub verdict: Verdict,
}

/// What came out for a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Accepted.
    Met,
    /// Not accepted: a shortfall.
    Short,
}

/// Why rows cannot be recorded.
#[derive(Debug)]
pub enum RecordError {
    /// Two rows have one name.
    Twice(String),
    /// A claim is weaker than the recorded one, or about another figure: said with both.
    Loosened(String),
    /// Recorded claims that were not measured.
    Lost(String),
    /// The file cannot be read or written.
    File(PathBuf, io::Error),
    /// The file holds no record.
    Content(PathBuf, String),
}

impl fmt::Display for RecordError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Twice(claim) => {
                write!(out, "two rows are called `{claim}`; word one of them anew")
            }
            Self::Loosened(claims) => write!(
                out,
                "a claim is weaker than its record, or expects another figure: {claims}; {BY_HAND}"
            ),
            Self::Lost(claims) => write!(out, "recorded and not measured: {claims}; {BY_HAND}"),
            Self::File(path, cause) => {
                write!(out, "{}: {cause}; call this from the repository's root", path.display())
            }
            Self::Content(path, cause) => write!(out, "{}: {cause}", path.display()),
        }
    }
}

impl error::Error for RecordError {}

impl RecordedRow {
    /// `row` as it is today, to six digits.
    fn of(row: &Row) -> Self {
        let tolerance = match row.tolerance {
            Tolerance::Within(most) => Tolerance::Within(six_digits(most)),
            one_sided => one_sided,
        };
        Self {
            id: row.id(),
            claim: row.what.clone(),
            measured: Some(six_digits(row.measured)),
            expected: six_digits(row.expected),
            tolerance,
            unit: row.unit.to_owned(),
            source: row.source.to_owned(),
            verdict: if row.passes() { Verdict::Met } else { Verdict::Short },
        }
    }

    /// How far the recorded figure lies beyond what is accepted, in its unit; zero for a claim that was met.
    pub fn shortfall(&self) -> f64 {
        match (self.verdict, self.measured) {
            (Verdict::Short, Some(measured)) => self.tolerance.beyond(measured, self.expected),
            // Without a figure nothing may be shorter.
            (Verdict::Short, None) | (Verdict::Met, _) => 0.0,
        }
    }

    /// Whether `row` claims what was recorded, but for rounding.
    pub(crate) fn claims_as(&self, row: &Row) -> bool {
        let same = match (self.tolerance, row.tolerance) {
            (Tolerance::Within(then), Tolerance::Within(now)) => (now - then).abs() <= SAME * then,
            (then, now) => then == now,
        };
        same && self.expects_as(row)
    }

    /// Whether `row` expects the recorded figure, but for rounding.
    fn expects_as(&self, row: &Row) -> bool {
        let room = SAME * row.tolerance.scale(row.expected) + 2e-5 * row.expected.abs();
        (self.expected - row.expected).abs() <= room
    }

    /// Whether `row` accepts what the record does not.
    fn is_stricter_than(&self, row: &Row) -> bool {
        match (self.tolerance, row.tolerance) {
            (Tolerance::Within(then), Tolerance::Within(now)) => now > then * (1.0 + SAME),
            (then, now) => then != now,
        }
    }
}

impl Record {
    /// The record in `text`.
    ///
    /// # Errors
    /// When it is none, in the words of the reader.
    pub fn parse(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string())
    }

    /// The row of that name.
    pub fn row(&self, id: &str) -> Option<&RecordedRow> {
        self.rows.iter().find(|row| row.id == id)
    }

    /// How many claims were met.
    pub fn n_met(&self) -> usize {
        self.rows.iter().filter(|row| row.verdict == Verdict::Met).count()
    }

    /// `rows` recorded on the day `date` under `conditions`, where this record was before.
    ///
    /// # Errors
    /// [`RecordError::Twice`]; [`RecordError::Loosened`] when a row claims less than its record does, or
    /// expects another figure; [`RecordError::Lost`] when a recorded claim is not among `rows`.
    pub fn renewed(&self, rows: &[Row], date: &str, conditions: &str) -> Result<Self, RecordError> {
        let mut renewed: Vec<RecordedRow> = Vec::new();
        let mut loosened = Vec::new();
        for row in rows {
            let now = RecordedRow::of(row);
            if renewed.iter().any(|other| other.id == now.id) {
                return Err(RecordError::Twice(now.claim));
            }
            if let Some(then) = self.row(&now.id)
                && (!then.expects_as(row) || then.is_stricter_than(row))
            {
                loosened.push(format!(
                    "{}: {} {:?} before, {} {:?} now",
                    then.claim, then.expected, then.tolerance, now.expected, now.tolerance
                ));
            }
            renewed.push(now);
        }
        let kept = |then: &RecordedRow| renewed.iter().any(|now| now.id == then.id);
        let lost: Vec<&str> =
            self.rows.iter().filter(|row| !kept(row)).map(|row| row.claim.as_str()).collect();
        if !loosened.is_empty() {
            return Err(RecordError::Loosened(loosened.join("; ")));
        }
        if !lost.is_empty() {
            return Err(RecordError::Lost(lost.join("; ")));
        }
        Ok(Self { date: date.to_owned(), conditions: conditions.to_owned(), rows: renewed })
    }

    /// The record as its file holds it.
    pub fn text(&self) -> String {
        let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
        let number = |value: f64| toml::Value::Float(value).to_string();
        let mut text = String::from(
            "# Written by `wakemix validate NAME --record`; rows that fall short are recorded as short.\n",
        );
        let _ = writeln!(text, "date = {}", quoted(&self.date));
        let _ = writeln!(text, "conditions = {}", quoted(&self.conditions));
        for row in &self.rows {
            let tolerance = match row.tolerance {
                Tolerance::Within(most) => format!("{{ within = {} }}", number(most)),
                Tolerance::AtMost => quoted("at-most"),
                Tolerance::AtLeast => quoted("at-least"),
            };
            let verdict = if row.verdict == Verdict::Met { "met" } else { "short" };
            let measured = row.measured.map(|measured| ("measured", number(measured)));
            let head = [("\n[[row]]\nid", quoted(&row.id)), ("claim", quoted(&row.claim))];
            let rest = [
                ("expected", number(row.expected)),
                ("tolerance", tolerance),
                ("unit", quoted(&row.unit)),
                ("source", quoted(&row.source)),
                ("verdict", quoted(verdict)),
            ];
            for (key, value) in head.into_iter().chain(measured).chain(rest) {
                let _ = writeln!(text, "{key} = {value}");
            }
        }
        text
    }

    /// Reads the record of the validation `name` below `root`, the repository's.
    ///
    /// # Errors
    /// [`RecordError::File`] or [`RecordError::Content`].
    pub fn read(root: &Path, name: &str) -> Result<Self, RecordError> {
        let path = path_of(root, name);
        let text =
            fs::read_to_string(&path).map_err(|error| RecordError::File(path.clone(), error))?;
        Self::parse(&text).map_err(|cause| RecordError::Content(path, cause))
    }

    /// Writes it as the record of the validation `name` below `root`, the repository's.
    ///
    /// # Errors
    /// [`RecordError::File`].
    pub fn write(&self, root: &Path, name: &str) -> Result<(), RecordError> {
        let path = path_of(root, name);
        fs::write(&path, self.text()).map_err(|error| RecordError::File(path, error))
    }
}

fn path_of(root: &Path, name: &str) -> PathBuf {
    root.join(FOLDER).join(format!("{name}.toml"))
}

/// `value` to six significant digits.
fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Tolerance::{AtMost, Within};

    fn row(what: &str, measured: f64, expected: f64, tolerance: Tolerance) -> Row {
        Row { what: what.to_owned(), measured, expected, tolerance, unit: "MN m", source: "theory" }
    }

    fn empty() -> Record {
        Record { date: String::new(), conditions: String::new(), rows: Vec::new() }
    }

    #[test]
    fn a_record_reads_back_as_it_was_written() {
        let rows = [
            row("lift \"of\" a wing", 1.0 / 3.0, 0.3, Within(0.05)),
            row("drag", 2.0, 1.0, AtMost),
            row("not a number", f64::INFINITY, 1.0, AtMost),
        ];
        let record = empty().renewed(&rows, "2026-11-22", "here").unwrap();
        assert_eq!(record.rows[0].measured, Some(0.333333));
        assert_eq!(record.n_met(), 1);
        assert_eq!(record.rows[1].shortfall(), 1.0);
        assert_eq!(Record::parse(&record.text()).unwrap(), record);
    }

    #[test]
    fn a_claim_may_be_tightened_and_not_loosened() {
        let record = empty().renewed(&[row("lift", 1.0, 1.0, Within(0.1))], "", "").unwrap();
        for (now, allowed) in [
            (row("lift", 2.0, 1.0, Within(0.1)), true),
            (row("lift", 1.0, 1.0, Within(0.05)), true),
            (row("lift", 1.0, 1.0, Within(0.2)), false),
            (row("lift", 1.0, 1.1, Within(0.1)), false),
            (row("lift", 1.0, 1.0, AtMost), false),
        ] {
            let renewed = record.renewed(std::slice::from_ref(&now), "", "");
            assert_eq!(renewed.is_ok(), allowed, "{now:?}");
        }
        let drag = row("drag", 1.0, 5.0, Within(9.0));
        assert!(matches!(
            record.renewed(std::slice::from_ref(&drag), "", ""),
            Err(RecordError::Lost(_))
        ));
        let both = [row("lift", 1.0, 1.0, Within(0.1)), drag];
        assert_eq!(record.renewed(&both, "", "").unwrap().rows.len(), 2);
    }

    #[test]
    fn two_rows_of_one_name_are_refused() {
        let rows = [row("lift", 1.0, 1.0, AtMost), row("Lift:", 2.0, 2.0, AtMost)];
        assert!(matches!(empty().renewed(&rows, "", ""), Err(RecordError::Twice(_))));
    }
}
