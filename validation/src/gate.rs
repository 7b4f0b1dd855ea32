//! Today's rows against the record: what is as recorded, what got worse, and what is better than the record
//! says.

use crate::record::{Record, RecordedRow, Verdict};
use crate::row::{Row, Tolerance};
use serde::Serialize;

/// Share of a recorded shortfall by which it may grow: a case gives the same bits on one kind of processor,
/// and another rounds in another order, which a turbulent flow makes visible. A tenth of a shortfall is no
/// new finding.
const GROWTH: f64 = 0.1;
/// The same for shortfalls next to nothing: share of the tolerance, or of the limit.
const LEAST_GROWTH: f64 = 0.01;

/// What a row is beside its record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// Met as recorded, or as short as recorded.
    AsRecorded,
    /// Recorded as met and short now, or shorter than recorded.
    Worse,
    /// Recorded as short and met now: the record is to be renewed.
    ShortfallGone,
    /// Expected value or tolerance are others than the recorded ones.
    ClaimChanged,
    /// The record knows nothing of it.
    NotRecorded,
    /// The record knows it, and it was not measured.
    Missing,
}

impl Finding {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::AsRecorded => "as recorded",
            Self::Worse => "WORSE",
            Self::ShortfallGone => "SHORTFALL GONE",
            Self::ClaimChanged => "CLAIM CHANGED",
            Self::NotRecorded => "NOT RECORDED",
            Self::Missing => "MISSING",
        }
    }
}

/// A row beside its record, as data.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judgement {
    /// Name of the row within its validation.
    pub id: String,
    /// What was measured, with its conditions.
    pub claim: String,
    /// Measured value, in `unit`; none where nothing was measured.
    pub measured: Option<f64>,
    /// Expected value or limit, in `unit`.
    pub expected: f64,
    /// What is accepted around `expected`.
    pub tolerance: Tolerance,
    /// Unit of all three.
    pub unit: String,
    /// Where the expected value comes from.
    pub source: String,
    /// Whether the claim is met now.
    pub verdict: Verdict,
    /// Whether it was met when it was recorded.
    pub recorded_verdict: Option<Verdict>,
    /// What was measured when it was recorded, in `unit`.
    pub recorded: Option<f64>,
    /// Both together.
    pub finding: Finding,
}

/// Each of `rows` beside `record`, then what the record has and they have not.
pub fn judge(rows: &[Row], record: &Record) -> Vec<Judgement> {
    let mut judgements: Vec<Judgement> = Vec::new();
    for row in rows {
        let id = row.id();
        // A second row of the same name has no record of its own.
        let first = judgements.iter().all(|judgement| judgement.id != id);
        let recorded = record.row(&id).filter(|_| first);
        judgements.push(Judgement {
            id,
            claim: row.what.clone(),
            measured: Some(row.measured),
            expected: row.expected,
            tolerance: row.tolerance,
            unit: row.unit.to_owned(),
            source: row.source.to_owned(),
            verdict: if row.passes() { Verdict::Met } else { Verdict::Short },
            recorded_verdict: recorded.map(|recorded| recorded.verdict),
            recorded: recorded.and_then(|recorded| recorded.measured),
            finding: recorded.map_or(Finding::NotRecorded, |recorded| beside(row, recorded)),
        });
    }
    for recorded in &record.rows {
        if judgements.iter().all(|judgement| judgement.id != recorded.id) {
            judgements.push(missing(recorded));
        }
    }
    judgements
}

/// Whether all is as recorded.
pub fn holds(judgements: &[Judgement]) -> bool {
    judgements.iter().all(|judgement| judgement.finding == Finding::AsRecorded)
}

fn beside(row: &Row, recorded: &RecordedRow) -> Finding {
    if !recorded.claims_as(row) {
        return Finding::ClaimChanged;
    }
    match (recorded.verdict, row.passes()) {
        (Verdict::Met, true) => Finding::AsRecorded,
        (Verdict::Met, false) => Finding::Worse,
        (Verdict::Short, true) => Finding::ShortfallGone,
        (Verdict::Short, false) => {
            let then = recorded.shortfall();
            let room = (GROWTH * then).max(LEAST_GROWTH * row.tolerance.scale(row.expected));
            let now = row.tolerance.beyond(row.measured, row.expected);
            if now > then + room { Finding::Worse } else { Finding::AsRecorded }
        }
    }
}

fn missing(recorded: &RecordedRow) -> Judgement {
    Judgement {
        id: recorded.id.clone(),
        claim: recorded.claim.clone(),
        measured: None,
        expected: recorded.expected,
        tolerance: recorded.tolerance,
        unit: recorded.unit.clone(),
        source: recorded.source.clone(),
        verdict: Verdict::Short,
        recorded_verdict: Some(recorded.verdict),
        recorded: recorded.measured,
        finding: Finding::Missing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Tolerance::{AtMost, Within};

    fn row(what: &str, measured: f64, expected: f64, tolerance: Tolerance) -> Row {
        Row { what: what.to_owned(), measured, expected, tolerance, unit: "%", source: "made up" }
    }

    fn recorded(rows: &[Row]) -> Record {
        let empty = Record { date: String::new(), conditions: String::new(), rows: Vec::new() };
        empty.renewed(rows, "2026-11-22", "made up").unwrap()
    }

    fn findings(then: &[Row], now: &[Row]) -> Vec<Finding> {
        judge(now, &recorded(then)).iter().map(|judgement| judgement.finding).collect()
    }

    #[test]
    fn met_short_worse_and_vanished_rows_are_distinguished() {
        let claim = |what: &str, measured: f64| row(what, measured, 1.0, Within(0.1));
        let then =
            [claim("met", 1.05), claim("short", 1.5), claim("worse", 1.05), claim("gone", 2.0)];
        let now =
            [claim("met", 0.95), claim("short", 1.52), claim("worse", 1.2), claim("gone", 1.0)];
        assert_eq!(
            findings(&then, &now),
            [Finding::AsRecorded, Finding::AsRecorded, Finding::Worse, Finding::ShortfallGone]
        );
        assert!(holds(&judge(&now[..2], &recorded(&then[..2]))));
        for place in 2..4 {
            let (then, now) = (&then[place..=place], &now[place..=place]);
            assert!(!holds(&judge(now, &recorded(then))));
        }
    }

    #[test]
    fn a_shortfall_may_grow_by_a_tenth_and_no_more() {
        let then = [row("short", 3.0, 1.0, AtMost)];
        for (measured, finding) in
            [(3.19, Finding::AsRecorded), (3.21, Finding::Worse), (f64::NAN, Finding::Worse)]
        {
            assert_eq!(findings(&then, &[row("short", measured, 1.0, AtMost)]), [finding]);
        }
        // Next to nothing: a hundredth of the tolerance.
        let then = [row("short", 1.1001, 1.0, Within(0.1))];
        assert_eq!(
            findings(&then, &[row("short", 1.1009, 1.0, Within(0.1))]),
            [Finding::AsRecorded]
        );
        assert_eq!(findings(&then, &[row("short", 1.1013, 1.0, Within(0.1))]), [Finding::Worse]);
    }

    #[test]
    fn other_claims_other_rows_and_lost_rows_do_not_pass() {
        let then = [row("one", 1.0, 1.0, Within(0.1)), row("two", 1.0, 1.0, AtMost)];
        let now = [row("one", 1.0, 1.0, Within(0.2)), row("three", 1.0, 1.0, AtMost)];
        assert_eq!(
            findings(&then, &now),
            [Finding::ClaimChanged, Finding::NotRecorded, Finding::Missing]
        );
        let tighter = [row("one", 1.0, 1.0, Within(0.05))];
        assert_eq!(findings(&then[..1], &tighter), [Finding::ClaimChanged]);
        let twice = [then[1].clone(), then[1].clone()];
        assert_eq!(findings(&then[1..], &twice), [Finding::AsRecorded, Finding::NotRecorded]);
    }
}
