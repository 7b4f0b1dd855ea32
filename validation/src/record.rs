//! What a validation gave when it was last recorded: `validation/recorded/NAME.toml`, in the program and in
//! the repository.

pub use crate::recorded::{RecordedRow, Verdict};
use crate::row::{Row, Tolerance};
use serde::Deserialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{error, fmt, fs, io};

/// Folder of the records, seen from the repository's root.
pub const FOLDER: &str = "validation/recorded";

/// How a record is weakened where that is meant.
const BY_HAND: &str = "if that is meant, take its row out of the record's file first, where a reader of the change sees it";

/// First line of a record by `--record`, and of one that was copied.
const RECORDED: &str =
    "# Written by `wakemix validate NAME --record`; rows that fall short are recorded as short.";
const FROM_A_NOTEBOOK: &str = "# Figures of the notebook in docs/validation with the digits that stand there; `wakemix validate NAME --record` writes all.";

/// What to do about a figure that is none.
const MEND: &str = "mend what makes it, or measure something that always has a value";

/// The rows of one validation as they were recorded.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Day on which it was made (year-month-day).
    pub date: String,
    /// On what machine, and by what.
    pub conditions: String,
    /// Whether the measured figures come from a notebook with the few digits that stand there, and not from
    /// `--record`.
    #[serde(default)]
    pub rounded: bool,
    /// Its rows, in their order.
    #[serde(rename = "row")]
    pub rows: Vec<RecordedRow>,
}

/// Why rows cannot be recorded.
#[derive(Debug)]
pub enum RecordError {
    /// Two rows have one name.
    Twice(String),
    /// Claims whose figures are no finite numbers.
    NotFinite(String),
    /// A claim is weaker than the recorded one, or about another figure or unit: said with both.
    Loosened(String),
    /// Claims that were met and are short now, or that fall shorter, said with both figures.
    Worse(String),
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
            Self::NotFinite(claims) => {
                write!(out, "not a finite number, which is no figure to record: {claims}; {MEND}")
            }
            Self::Loosened(claims) => write!(
                out,
                "a claim is weaker than its record, or expects another figure or unit: {claims}; {BY_HAND}"
            ),
            Self::Worse(claims) => write!(
                out,
                "worse than recorded: {claims}; mend it, or record it with --accept-worse and say why on the page"
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

/// Whether a claim that got worse may be recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Worse {
    /// It is refused by name.
    Refused,
    /// It is meant, and recorded as it is now.
    Accepted,
}

/// What speaks against a new record, each with the claims that it concerns.
#[derive(Default)]
struct Problems {
    not_finite: Vec<String>,
    loosened: Vec<String>,
    lost: Vec<String>,
    worse: Vec<String>,
}

impl Problems {
    /// Fails unless there is none, or none but rows that are worse where those are accepted.
    fn none_but(self, worse: Worse) -> Result<(), RecordError> {
        let met = |claims: Vec<String>, error: fn(String) -> RecordError| {
            if claims.is_empty() { Ok(()) } else { Err(error(claims.join("; "))) }
        };
        met(self.not_finite, RecordError::NotFinite)?;
        met(self.loosened, RecordError::Loosened)?;
        met(self.lost, RecordError::Lost)?;
        match worse {
            Worse::Refused => met(self.worse, RecordError::Worse),
            Worse::Accepted => Ok(()),
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

    /// Whether `row` is worse than `recorded`, a row of this record: short where that was met, or shorter.
    pub(crate) fn is_worse(&self, row: &Row, recorded: &RecordedRow) -> bool {
        let rounding = if self.rounded { recorded.half_a_digit() } else { 0.0 };
        recorded.is_worse_now(row, rounding)
    }

    /// `rows` recorded on the day `date` under `conditions`, where this record was before; what is worse than
    /// it only where `worse` is accepted. A claim that differs from its record by rounding stays as it was
    /// recorded, so that no number of records moves it.
    ///
    /// # Errors
    /// [`RecordError::Twice`]; [`RecordError::NotFinite`]; [`RecordError::Loosened`] when a row claims less
    /// than its record does, or expects another figure or unit; [`RecordError::Lost`] when a recorded claim
    /// is not among `rows`; [`RecordError::Worse`].
    pub fn renewed(
        &self,
        rows: &[Row],
        date: &str,
        conditions: &str,
        worse: Worse,
    ) -> Result<Self, RecordError> {
        let mut renewed: Vec<RecordedRow> = Vec::new();
        let mut problems = Problems::default();
        for row in rows {
            let mut now = RecordedRow::of(row);
            if renewed.iter().any(|other| other.id == now.id) {
                return Err(RecordError::Twice(now.claim));
            }
            if !(row.measured.is_finite() && row.expected.is_finite()) {
                problems.not_finite.push(now.claim.clone());
            }
            if let Some(then) = self.row(&now.id) {
                if !then.expects_as(row) || then.is_stricter_than(row) {
                    problems.loosened.push(then.beside(&now));
                } else if then.claims_as(row) {
                    (now.expected, now.tolerance) = (then.expected, then.tolerance);
                }
                if self.is_worse(row, then) {
                    problems.worse.push(then.figures_beside(&now));
                }
            }
            renewed.push(now);
        }
        let kept = |then: &RecordedRow| renewed.iter().any(|now| now.id == then.id);
        let lost = self.rows.iter().filter(|row| !kept(row)).map(|row| row.claim.clone());
        problems.lost.extend(lost);
        problems.none_but(worse)?;
        let (date, conditions) = (date.to_owned(), conditions.to_owned());
        Ok(Self { date, conditions, rounded: false, rows: renewed })
    }

    /// The record as its file holds it.
    pub fn text(&self) -> String {
        let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
        let number = |value: f64| toml::Value::Float(value).to_string();
        let mut text = format!("{}\n", if self.rounded { FROM_A_NOTEBOOK } else { RECORDED });
        let _ = writeln!(text, "date = {}", quoted(&self.date));
        let _ = writeln!(text, "conditions = {}", quoted(&self.conditions));
        if self.rounded {
            text.push_str("rounded = true\n");
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Tolerance::{AtLeast, AtMost, Within};

    fn row(what: &str, measured: f64, expected: f64, tolerance: Tolerance) -> Row {
        Row { what: what.to_owned(), measured, expected, tolerance, unit: "MN m", source: "theory" }
    }

    fn recorded(rows: &[Row]) -> Record {
        Record::default().renewed(rows, "2026-11-22", "here", Worse::Refused).unwrap()
    }

    fn again(record: &Record, rows: &[Row], worse: Worse) -> Result<Record, RecordError> {
        record.renewed(rows, "", "", worse)
    }

    #[test]
    fn a_record_reads_back_as_it_was_written() {
        let rows = [
            row("lift \"of\" a wing", 1.0 / 3.0, 0.3, Within(0.05)),
            row("drag", 2.0, 1.0, AtMost),
            row("moment", 2.0, 1.0, AtLeast),
        ];
        let record = recorded(&rows);
        assert_eq!(record.rows[0].measured, Some(0.333333));
        assert_eq!(record.n_met(), 2);
        assert_eq!(record.rows[1].shortfall(), 1.0);
        assert_eq!(Record::parse(&record.text()).unwrap(), record);
        let rounded = Record { rounded: true, ..record };
        assert!(rounded.text().starts_with("# Figures of the notebook"));
        assert_eq!(Record::parse(&rounded.text()).unwrap(), rounded);
        assert!(!again(&rounded, &rows, Worse::Refused).unwrap().rounded);
    }

    #[test]
    fn a_claim_may_be_tightened_and_not_loosened() {
        let record = recorded(&[row("lift", 1.0, 1.0, Within(0.1))]);
        let in_kilonewtons = Row { unit: "kN m", ..row("lift", 1.0, 1.0, Within(0.1)) };
        for (now, allowed) in [
            (row("lift", 1.05, 1.0, Within(0.1)), true),
            (row("lift", 1.0, 1.0, Within(0.05)), true),
            (row("lift", 1.0, 1.0, Within(0.2)), false),
            (row("lift", 1.0, 1.0, Within(0.1001)), false),
            (row("lift", 1.0, 1.1, Within(0.1)), false),
            (row("lift", 1.0, 1.0001, Within(0.1)), false),
            (row("lift", 1.0, 1.0, AtMost), false),
            (in_kilonewtons, false),
        ] {
            let renewed = again(&record, std::slice::from_ref(&now), Worse::Accepted);
            assert_eq!(renewed.is_ok(), allowed, "{now:?}");
        }
        let drag = row("drag", 1.0, 5.0, Within(9.0));
        let alone = again(&record, std::slice::from_ref(&drag), Worse::Accepted);
        assert!(matches!(alone, Err(RecordError::Lost(_))));
        let both = [row("lift", 1.0, 1.0, Within(0.1)), drag];
        assert_eq!(again(&record, &both, Worse::Refused).unwrap().rows.len(), 2);
    }

    #[test]
    fn no_number_of_records_moves_a_claim() {
        let mut record = recorded(&[row("lift", 1.0, 1.0, Within(0.1))]);
        let (mut expected, mut tolerance) = (1.0, 0.1);
        let mut n_records = 0;
        for _ in 0..100 {
            (expected, tolerance) = (expected * (1.0 + 5e-7), tolerance * (1.0 + 5e-6));
            match again(&record, &[row("lift", 1.0, expected, Within(tolerance))], Worse::Refused) {
                Ok(renewed) => record = renewed,
                Err(RecordError::Loosened(_)) => break,
                Err(other) => panic!("{other}"),
            }
            n_records += 1;
            let kept = record.row("lift").unwrap();
            assert_eq!((kept.expected, kept.tolerance), (1.0, Within(0.1)));
        }
        assert!((1..=2).contains(&n_records), "{n_records}");
    }

    #[test]
    fn what_got_worse_is_recorded_only_where_that_is_meant() {
        let then = [row("lift", 1.0, 1.0, Within(0.1)), row("drag", 3.0, 1.0, AtMost)];
        let record = recorded(&then);
        for (lift, drag, worse) in
            [(1.05, 3.1, false), (1.2, 3.0, true), (1.0, 4.0, true), (1.0, 0.5, false)]
        {
            let mut now = then.clone();
            (now[0].measured, now[1].measured) = (lift, drag);
            let refused =
                matches!(again(&record, &now, Worse::Refused), Err(RecordError::Worse(_)));
            assert_eq!(refused, worse, "{lift}, {drag}");
            let accepted = again(&record, &now, Worse::Accepted).unwrap();
            assert_eq!(accepted.rows[0].measured, Some(lift));
        }
        let now = [row("lift", 1.2, 1.0, Within(0.1)), then[1].clone()];
        let said = again(&record, &now, Worse::Refused).unwrap_err().to_string();
        assert!(said.contains("lift: 1, met before, 1.2, short now"), "{said}");
    }

    #[test]
    fn what_is_not_finite_is_no_figure_to_record() {
        for measured in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for tolerance in [Within(1.0), AtMost, AtLeast] {
                let rows = [row("lift", measured, 1.0, tolerance)];
                for worse in [Worse::Refused, Worse::Accepted] {
                    let renewed = again(&Record::default(), &rows, worse);
                    assert!(matches!(renewed, Err(RecordError::NotFinite(_))), "{rows:?}");
                }
            }
        }
    }

    #[test]
    fn two_rows_of_one_name_are_refused() {
        let rows = [row("lift", 1.0, 1.0, AtMost), row("Lift:", 2.0, 2.0, AtMost)];
        let renewed = again(&Record::default(), &rows, Worse::Accepted);
        assert!(matches!(renewed, Err(RecordError::Twice(_))));
    }
}
